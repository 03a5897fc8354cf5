//! One leg of any pose brought to a place: the ride's inverse kinematics for others who make motion.

use std::f32::consts::{PI, TAU};

use glam::{DVec3, Vec3};

use super::retarget::leg_bends;
use super::rig::{Aim, Rig};
use crate::limb::Limb;
use crate::pose::Pose;
use crate::skeleton::Skeleton;

/// Brings the toe of one leg of a [`Pose`] to a place in world space, as the anatomy allows: within the limits of the joints, hock and
/// stifle flexing together, the carpus of a loaded foreleg locked straight where it can be.
///
/// Made once for a skeleton; a reach allocates nothing, and equal inputs give equal results.
#[derive(Clone, Debug)]
pub struct LegReach {
    rig: Rig,
}

/// Where a toe is wanted, and how its leg may go there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ToeAim {
    /// Wanted place of the toe, world space, metres.
    pub toe_in_world: DVec3,
    /// Wanted heading of the hoof, about the world's Y axis, left of X positive, radians.
    pub hoof_heading_rad: f32,
    /// 1 in stance, 0 in the air: a loaded foreleg keeps its carpus straight, a foot in the air is passive.
    pub load: f32,
    /// How much the hoof keeps the bend it has against the ground, 0 to 1: as it does where it lies on sloping ground.
    pub keeps_hoof: f32,
}

/// What a leg misses its place by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ReachMiss {
    /// Distance from the toe to its place, metres; below 0.02 mm for a loaded leg that is there, infinite where the place is no number.
    pub miss_m: f32,
    /// The way from the toe to its place in the plane of the trunk, world space, metres: the body would have to go there.
    pub missing_in_world: Vec3,
}

impl LegReach {
    /// Lays a skeleton out for speed.
    pub fn new(skeleton: &Skeleton) -> Self {
        Self { rig: Rig::new(skeleton) }
    }

    /// Greatest distance from shoulder or hip to toe that a leg reaches, metres.
    pub fn span_m(&self, limb: Limb) -> f32 {
        self.rig.legs[limb.index()].span_m
    }

    /// Distance of a leg's toe from the median plane, metres, to the right positive.
    pub fn toe_lateral_m(&self, limb: Limb) -> f32 {
        self.rig.legs[limb.index()].toe_lateral_m
    }

    /// Shoulders and hips of a pose (upper ends of humerus and femur) in the root's frame, metres, in the order of [`Limb::ALL`].
    pub fn joints_in_root(&self, pose: &Pose) -> [Vec3; 4] {
        self.rig.girdles(pose).map(|girdle| girdle.joint)
    }

    /// Turns a leg's joints below scapula or pelvis from where they are, as little as it takes to bring the toe to its place; what it
    /// misses is returned.
    pub fn reach(&self, pose: &mut Pose, limb: Limb, aim: &ToeAim) -> ReachMiss {
        let girdle = self.rig.girdles(pose)[limb.index()];
        let ahead = pose.world_from_root * Vec3::X;
        let turn = aim.hoof_heading_rad - (-ahead.z).atan2(ahead.x);
        let from_root = (aim.toe_in_world - pose.root_in_world.as_dvec3()).as_vec3();
        let aim = Aim {
            toe: pose.world_from_root.inverse() * from_root,
            hoof_turn_rad: (turn + PI).rem_euclid(TAU) - PI,
            load: aim.load,
            keeps_hoof: aim.keeps_hoof,
        };
        let reached = self.rig.legs[limb.index()].solve(&girdle, &leg_bends(pose, limb), &aim);
        let first = limb.first_bone() + 1;
        pose.bends_rad[first..first + 4].copy_from_slice(&reached.bends_rad);
        pose.limb_turns_rad[limb.index()] = reached.limb_turn_rad;
        pose.abductions_rad[limb.index()] = reached.abduction_rad;
        let missing_in_world = pose.world_from_root * reached.missing_m.extend(0.0);
        ReachMiss { miss_m: reached.miss_m, missing_in_world }
    }
}

#[cfg(test)]
mod tests {
    use glam::Quat;

    use super::*;

    fn turned_pose(skeleton: &Skeleton) -> Pose {
        let mut pose = Pose::standing(skeleton);
        pose.root_in_world += Vec3::new(12.0, -0.08, -7.0);
        pose.world_from_root = Quat::from_rotation_y(2.5) * Quat::from_rotation_z(0.05);
        pose.lateral_bends_rad[..4].fill(0.02);
        pose
    }

    #[test]
    fn the_toe_comes_to_its_place_in_any_direction_of_the_horse() {
        let skeleton = Skeleton::reference();
        let reach = LegReach::new(&skeleton);
        for limb in Limb::ALL {
            let mut pose = turned_pose(&skeleton);
            let toe_in_world = pose.joints(&skeleton).toe(limb).as_dvec3() + DVec3::new(0.05, 0.04, -0.06);
            let aim = ToeAim { toe_in_world, hoof_heading_rad: 2.6, load: 1.0, keeps_hoof: 0.0 };
            let missed = reach.reach(&mut pose, limb, &aim);
            let there = pose.joints(&skeleton).toe(limb).as_dvec3();
            assert!(missed.miss_m < 2e-5, "{limb:?}: {}", missed.miss_m);
            assert!(there.distance(toe_in_world) < 5e-5, "{limb:?}: {there} {toe_in_world}");
        }
    }

    #[test]
    fn the_body_that_goes_where_it_is_missing_reaches() {
        let skeleton = Skeleton::reference();
        let reach = LegReach::new(&skeleton);
        let mut pose = turned_pose(&skeleton);
        let toe_in_world = pose.joints(&skeleton).toe(Limb::LH).as_dvec3() - DVec3::Y * 0.3;
        let aim = ToeAim { toe_in_world, hoof_heading_rad: 2.5, load: 1.0, keeps_hoof: 0.0 };
        let missed = reach.reach(&mut pose, Limb::LH, &aim);
        assert!(missed.miss_m > 0.1, "{missed:?}");
        pose.root_in_world += 1.1 * missed.missing_in_world;
        assert!(reach.reach(&mut pose, Limb::LH, &aim).miss_m < 1e-4);
    }

    #[test]
    fn a_place_that_is_none_is_missed_and_harms_nothing() {
        let skeleton = Skeleton::reference();
        let mut pose = Pose::standing(&skeleton);
        let aim = ToeAim { toe_in_world: DVec3::NAN, hoof_heading_rad: f32::NAN, load: 1.0, keeps_hoof: 1.0 };
        let missed = LegReach::new(&skeleton).reach(&mut pose, Limb::RF, &aim);
        assert!(missed.miss_m.is_infinite());
        assert!(pose.bends_rad.iter().all(|bend| bend.is_finite()));
    }
}
