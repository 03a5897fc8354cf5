//! A pose, and forward kinematics from it to joint positions.

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

use crate::limb::{Limb, Pair, Side};
use crate::skeleton::{BODY_BONE_COUNT, BONE_COUNT, Skeleton, bone};

/// Root and joint angles of one moment.
///
/// A horse on a straight line moves in planes along its track: bends alone pose it, as in a fitted plate. Turning, uneven ground
/// and feet set aside need the lateral angles as well; they are zero in every stride of the database.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pose {
    /// Top of the croup in world space, metres.
    pub root_in_world: Vec3,
    /// Turns the root's frame (X along the trunk, Y up, Z right) into world space.
    pub world_from_root: Quat,
    /// Bend from straight of each bone, radians.
    pub bends_rad: [f32; BONE_COUNT],
    /// How far the left and right scapula are slid towards the head along the rib cage, metres.
    pub scapula_slides_m: [f32; 2],
    /// Turn of each bone of the body against the one before it, about the root's Y axis, to the left positive, radians.
    pub lateral_bends_rad: [f32; BODY_BONE_COUNT],
    /// Turn of each leg below shoulder or hip about the root's Y axis, to the left positive, radians.
    pub limb_turns_rad: [f32; 4],
    /// Swing of each leg sideways about the shoulder or hip, after its turn; the hoof to the left positive, radians.
    pub abductions_rad: [f32; 4],
}

/// Ends of every bone in the root's frame.
struct Places {
    bases: [Vec3; BONE_COUNT],
    tips: [Vec3; BONE_COUNT],
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
        let root_in_world = Vec3::new(0.0, skeleton.croup_height_m, 0.0);
        Self { root_in_world, world_from_root: Quat::IDENTITY, bends_rad, ..Self::default() }
    }

    /// Forward kinematics. Bends turn about the Z axis of the body bone they hang on; in a leg that is neither turned nor abducted
    /// a bone's tip lies at its own distance from the median plane, so that bone lengths are the same in every pose.
    pub fn joints(&self, skeleton: &Skeleton) -> Joints {
        let mut places = Places { bases: [Vec3::ZERO; BONE_COUNT], tips: [Vec3::ZERO; BONE_COUNT] };
        let [spine_angle, spine_turn] = self.place_body(skeleton, &mut places);
        for limb in Limb::ALL {
            let hangs_on = if limb.pair() == Pair::Fore {
                let withers = places.tips[bone::SPINE_LAST];
                let attachment = self.scapula_offset(skeleton, spine_angle, limb);
                (spine_angle, spine_turn, withers + Quat::from_rotation_y(spine_turn) * attachment)
            } else {
                (0.0, 0.0, Vec3::ZERO)
            };
            self.place_limb(skeleton, limb, hangs_on, &mut places);
        }
        let world = |point: Vec3| self.root_in_world + self.world_from_root * point;
        let [dock_x, dock_y] = skeleton.dock_from_croup_m;
        Joints {
            root: self.root_in_world,
            dock: world(Vec3::new(dock_x, dock_y, 0.0)),
            bases: places.bases.map(world),
            tips: places.tips.map(world),
        }
    }

    /// Places spine, neck and head; returns the last spine bone's angle and turn, radians.
    fn place_body(&self, skeleton: &Skeleton, places: &mut Places) -> [f32; 2] {
        let (mut angle, mut turn, mut at) = (0.0, 0.0, Vec3::ZERO);
        let mut withers = [0.0; 2];
        for (i, bone) in skeleton.bones[..BODY_BONE_COUNT].iter().enumerate() {
            angle += self.bends_rad[i];
            turn += self.lateral_bends_rad[i];
            places.bases[i] = at;
            at += bone.length_m * (Quat::from_rotation_y(turn) * Vec3::new(angle.cos(), angle.sin(), 0.0));
            places.tips[i] = at;
            if i == bone::SPINE_LAST {
                withers = [angle, turn];
            }
        }
        withers
    }

    /// Places a leg's five bones from the angle, the turn and the place of what it hangs on.
    fn place_limb(
        &self,
        skeleton: &Skeleton,
        limb: Limb,
        (mut angle, turn, base): (f32, f32, Vec3),
        places: &mut Places,
    ) {
        let first = limb.first_bone();
        let root_from_girdle = Quat::from_rotation_y(turn);
        let root_from_leg = root_from_girdle
            * Quat::from_rotation_y(self.limb_turns_rad[limb.index()])
            * Quat::from_rotation_x(self.abductions_rad[limb.index()]);
        let (mut at, mut lateral_m) = (base, 0.0);
        for i in first..=limb.hoof_bone() {
            let bone = &skeleton.bones[i];
            angle += self.bends_rad[i];
            places.bases[i] = at;
            let (sin, cos) = angle.sin_cos();
            let along = Vec3::new(bone.length_m * cos, bone.length_m * sin, bone.lateral_m - lateral_m);
            at += if i == first { root_from_girdle * along } else { root_from_leg * along };
            lateral_m = bone.lateral_m;
            places.tips[i] = at;
        }
    }

    /// From the withers to where the scapula hangs, in the plane of the last spine bone.
    fn scapula_offset(&self, skeleton: &Skeleton, spine_angle: f32, limb: Limb) -> Vec3 {
        let [along, up] = skeleton.scapula_attachment_from_withers_m;
        let along = along + self.scapula_slides_m[limb.index()];
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
        mirrored.lateral_bends_rad = self.lateral_bends_rad.map(std::ops::Neg::neg);
        for side_angles in [&mut mirrored.limb_turns_rad, &mut mirrored.abductions_rad] {
            *side_angles = [1, 0, 3, 2].map(|twin: usize| -side_angles[twin]);
        }
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
        pose.lateral_bends_rad = [0.03, 0.02, 0.05, -0.02, 0.1, 0.1, -0.04, 0.2];
        pose.limb_turns_rad = [0.1, -0.2, 0.0, 0.15];
        pose.abductions_rad = [0.1, 0.2, -0.15, 0.05];
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
