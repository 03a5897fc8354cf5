//! A pose, and forward kinematics from it to joint positions.

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

use crate::limb::{Limb, Pair, Side};
use crate::skeleton::{BONE_COUNT, Skeleton};

/// Root and joint angles of one moment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Top of the croup in world space, metres.
    pub root_in_world: Vec3,
    /// Turns the root's frame (X along the trunk, Y up, Z right) into world space.
    pub world_from_root: Quat,
    /// Bend from straight of each bone, radians.
    pub bends_rad: [f32; BONE_COUNT],
    /// How far the left and right scapula are slid towards the head along the rib cage, metres.
    pub scapula_slides_m: [f32; 2],
}

/// World positions of every joint of a pose.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Joints {
    /// Root: top of the croup.
    pub root: Vec3,
    /// Root of the tail.
    pub dock: Vec3,
    /// Proximal end of each bone.
    pub bases: [Vec3; BONE_COUNT],
    /// Distal end of each bone.
    pub tips: [Vec3; BONE_COUNT],
}

impl Joints {
    /// Tip of a leg's hoof.
    pub fn toe(&self, limb: Limb) -> Vec3 {
        self.tips[limb.hoof_bone()]
    }
}

impl Pose {
    /// The skeleton's rest pose, standing on the ground plane with the root over the world's origin.
    pub fn standing(skeleton: &Skeleton) -> Self {
        let mut bends_rad = [0.0; BONE_COUNT];
        for (bend, bone) in bends_rad.iter_mut().zip(&skeleton.bones) {
            *bend = bone.rest_bend_rad;
        }
        Self {
            root_in_world: Vec3::new(0.0, skeleton.croup_height_m, 0.0),
            world_from_root: Quat::IDENTITY,
            bends_rad,
            scapula_slides_m: [0.0; 2],
        }
    }

    /// Forward kinematics. Bends turn about the root's Z axis; a bone's tip lies at its own distance from the
    /// median plane, so that bone lengths are the same in every pose.
    pub fn joints(&self, skeleton: &Skeleton) -> Joints {
        let mut angles = [0.0f32; BONE_COUNT];
        let mut bases = [Vec3::ZERO; BONE_COUNT];
        let mut tips = [Vec3::ZERO; BONE_COUNT];
        for (i, bone) in skeleton.bones.iter().enumerate() {
            let parent_angle = bone.parent.map_or(0.0, |parent| angles[parent]);
            angles[i] = parent_angle + self.bends_rad[i];
            bases[i] = bone.parent.map_or(Vec3::ZERO, |parent| tips[parent]);
            if i == Limb::LF.first_bone() || i == Limb::RF.first_bone() {
                bases[i] += self.scapula_offset(skeleton, parent_angle, i);
            }
            let (sin, cos) = angles[i].sin_cos();
            tips[i] = (bases[i] + bone.length_m * Vec3::new(cos, sin, 0.0)).with_z(bone.lateral_m);
        }
        let world = |point: Vec3| self.root_in_world + self.world_from_root * point;
        let [dock_x, dock_y] = skeleton.dock_from_croup_m;
        Joints {
            root: self.root_in_world,
            dock: world(Vec3::new(dock_x, dock_y, 0.0)),
            bases: bases.map(world),
            tips: tips.map(world),
        }
    }

    /// From the withers to where the scapula hangs, in the root's frame.
    fn scapula_offset(&self, skeleton: &Skeleton, spine_angle: f32, scapula: usize) -> Vec3 {
        let side = if scapula == Limb::LF.first_bone() { 0 } else { 1 };
        let [along, up] = skeleton.scapula_attachment_from_withers_m;
        let along = along + self.scapula_slides_m[side];
        let (sin, cos) = spine_angle.sin_cos();
        Vec3::new(cos * along - sin * up, sin * along + cos * up, 0.0)
    }

    /// Centre of mass: each bone's share at the middle of the bone, world space.
    pub fn centre_of_mass(&self, skeleton: &Skeleton) -> Vec3 {
        let joints = self.joints(skeleton);
        (0..BONE_COUNT)
            .map(|i| (joints.bases[i] + joints.tips[i]) * 0.5 * skeleton.bones[i].mass_fraction)
            .sum()
    }

    /// Angle of a leg's fetlock between cannon and pastern on the palmar side, radians; pi is straight.
    pub fn fetlock_angle_rad(&self, limb: Limb) -> f32 {
        std::f32::consts::PI + self.bends_rad[limb.hoof_bone()]
    }

    /// The pose of the same horse seen in a mirror: left and right change places.
    pub fn mirrored(&self) -> Self {
        let mut mirrored = *self;
        for pair in [Pair::Fore, Pair::Hind] {
            let left = Limb::new(pair, Side::Left).first_bone();
            let right = Limb::new(pair, Side::Right).first_bone();
            for i in 0..5 {
                mirrored.bends_rad.swap(left + i, right + i);
            }
        }
        mirrored.scapula_slides_m.swap(0, 1);
        mirrored.root_in_world.z = -self.root_in_world.z;
        let q = self.world_from_root;
        mirrored.world_from_root = Quat::from_xyzw(-q.x, -q.y, q.z, q.w);
        mirrored
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bent(skeleton: &Skeleton) -> Pose {
        let mut pose = Pose::standing(skeleton);
        for (i, bend) in pose.bends_rad.iter_mut().enumerate() {
            *bend += 0.1 * ((i * 7) as f32).sin();
        }
        pose.scapula_slides_m = [0.03, -0.02];
        pose.world_from_root = Quat::from_rotation_y(0.4) * Quat::from_rotation_z(0.1);
        pose
    }

    #[test]
    fn bones_keep_their_length_in_any_pose() {
        let skeleton = Skeleton::reference();
        let (standing, bent) =
            (Pose::standing(&skeleton).joints(&skeleton), bent(&skeleton).joints(&skeleton));
        for i in 0..BONE_COUNT {
            if i == Limb::LF.first_bone() || i == Limb::RF.first_bone() {
                continue; // The scapula slides on the rib cage, so its base is not its parent's tip.
            }
            let rest = standing.bases[i].distance(standing.tips[i]);
            let now = bent.bases[i].distance(bent.tips[i]);
            assert!((rest - now).abs() < 1e-5, "{}: {rest} {now}", skeleton.bones[i].name);
        }
    }

    #[test]
    fn a_mirrored_pose_mirrors_every_joint() {
        let skeleton = Skeleton::reference();
        let pose = bent(&skeleton);
        let (here, there) = (pose.joints(&skeleton), pose.mirrored().joints(&skeleton));
        for (limb, twin) in [(Limb::LF, Limb::RF), (Limb::RH, Limb::LH)] {
            let expected = here.toe(limb) * Vec3::new(1.0, 1.0, -1.0);
            assert!(there.toe(twin).distance(expected) < 1e-5);
        }
    }

    #[test]
    fn centre_of_mass_lies_behind_the_withers_and_over_the_feet() {
        let skeleton = Skeleton::reference();
        let pose = Pose::standing(&skeleton);
        let (joints, mass) = (pose.joints(&skeleton), pose.centre_of_mass(&skeleton));
        assert!(mass.x > joints.toe(Limb::LH).x && mass.x < joints.toe(Limb::LF).x);
        assert!(mass.z.abs() < 1e-6);
        assert!(mass.y > 1.0 && mass.y < 1.6, "{mass}");
    }
}
