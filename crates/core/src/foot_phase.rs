//! The paper's test of whether a hoof is down, from the pose alone (Huang 2012, section 3.4.1).

use glam::Vec3;

use crate::limb::Limb;
use crate::pose::Pose;
use crate::skeleton::Skeleton;

/// A hoof in front of its hip or shoulder is down when the angle in front of its fetlock is less than this, degrees, in the order of
/// [`Limb::ALL`] (section 3.4.1).
pub const LANDED_FETLOCK_DEG: [f32; 4] = [158.0, 152.0, 165.0, 169.0];
/// A hoof behind its hip or shoulder is in the air when the angle in front of its fetlock is more than this, degrees, in the order
/// of [`Limb::ALL`] (section 3.4.1).
pub const LIFTED_FETLOCK_DEG: [f32; 4] = [181.0, 181.0, 180.0, 180.0];
/// A hoof that is nearer in height to its hip or shoulder than this share of the distance in standing is in the air. The paper gives
/// no number; the lowest legs in stance of the captured strides, the fore of a gallop, are at 0.77.
pub const LEAST_HEIGHT_SHARE: f32 = 0.75;

/// What the test says of a hoof, with what decided.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FootPhase {
    /// In front of the hip or shoulder, the pastern loaded: down.
    Landed,
    /// Behind the hip or shoulder, the pastern not folded back: down.
    NotYetLifted,
    /// Too near the hip or shoulder in height: in the air.
    DrawnUp,
    /// In front of where it strikes: in the air.
    BeforeStrike,
    /// In front of the hip or shoulder, the pastern not loaded: in the air.
    Unloaded,
    /// Behind the hip or shoulder, the pastern folded back: in the air.
    Lifted,
}

impl FootPhase {
    /// Everything the test says, in the order of the discriminants.
    pub const ALL: [Self; 6] =
        [Self::Landed, Self::NotYetLifted, Self::DrawnUp, Self::BeforeStrike, Self::Unloaded, Self::Lifted];

    /// Whether the hoof is taken to be down.
    pub fn is_on_ground(self) -> bool {
        matches!(self, Self::Landed | Self::NotYetLifted)
    }
}

/// The test for one skeleton.
///
/// Readings taken where the paper leaves something open:
///
/// - *Fetlock Joint Angle* is the one in front, between cannon and pastern on the dorsal side: a loaded pastern sinks and makes it
///   less than 180 degrees, and it grows past 180 as the pastern folds back in the air. "Beyond" is less than the first thresholds
///   and more than the second. [`Pose::fetlock_angle_rad`] is the angle behind, so this one is a full turn less that.
/// - *Hip/Shoulder Position* is the upper end of femur or humerus, *Foot Position* the toe; in front and behind are along the root's
///   heading.
/// - *Too close in height*: the paper gives no number; see [`LEAST_HEIGHT_SHARE`].
/// - *Striking position*: saved "when we build a motion", in place, so that it is seen from the hip or shoulder. Against a print
///   in the world every hoof of a horse that goes forward is behind the place it is about to strike, and the test would say nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FootPhaseTest {
    least_heights_m: [f32; 4],
}

impl FootPhaseTest {
    /// Measures the skeleton in standing.
    pub fn new(skeleton: &Skeleton) -> Self {
        let standing = Pose::standing(skeleton);
        let least = |limb| LEAST_HEIGHT_SHARE * reach_m(&standing, skeleton, limb)[0];
        Self { least_heights_m: Limb::ALL.map(least) }
    }

    /// The phase of a leg in a pose of the skeleton the test was made for. `strike_ahead_m` is how far the toe is ahead of the hip
    /// or shoulder when it strikes ([`toe_ahead_m`] of the pose at the strike).
    pub fn phase(&self, pose: &Pose, skeleton: &Skeleton, limb: Limb, strike_ahead_m: f32) -> FootPhase {
        let [height_m, ahead_m] = reach_m(pose, skeleton, limb);
        let dorsal_deg = 360.0 - pose.fetlock_angle_rad(limb).to_degrees();
        let leg = limb.index();
        if height_m < self.least_heights_m[leg] {
            FootPhase::DrawnUp
        } else if ahead_m > strike_ahead_m {
            FootPhase::BeforeStrike
        } else if ahead_m > 0.0 {
            if dorsal_deg < LANDED_FETLOCK_DEG[leg] { FootPhase::Landed } else { FootPhase::Unloaded }
        } else if dorsal_deg > LIFTED_FETLOCK_DEG[leg] {
            FootPhase::Lifted
        } else {
            FootPhase::NotYetLifted
        }
    }
}

/// From the toe up to the hip or shoulder joint of a leg, and how far the toe is ahead of that joint along the root's heading, metres.
fn reach_m(pose: &Pose, skeleton: &Skeleton, limb: Limb) -> [f32; 2] {
    let joints = pose.joints(skeleton);
    let toe_from_hip = joints.toe(limb) - joints.bases[limb.first_bone() + 1];
    let forward = (pose.world_from_root * Vec3::X).with_y(0.0).normalize_or_zero();
    [-toe_from_hip.y, toe_from_hip.dot(forward)]
}

/// How far a leg's toe is ahead of its hip or shoulder joint along the root's heading, metres; in the pose of its strike the striking
/// position that [`FootPhaseTest::phase`] asks for.
pub fn toe_ahead_m(pose: &Pose, skeleton: &Skeleton, limb: Limb) -> f32 {
    reach_m(pose, skeleton, limb)[1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::skeleton::bone;

    const LEG: Limb = Limb::LF;
    /// A strike so far ahead that it does not matter.
    const FAR_M: f32 = 9.0;

    /// The standing pose with a leg swung from its shoulder or hip (forward positive) and its pastern bent, degrees.
    fn phase(swing_deg: f32, pastern_deg: f32, strike_ahead_m: f32) -> FootPhase {
        let skeleton = Skeleton::reference();
        let mut pose = Pose::standing(&skeleton);
        pose.bends_rad[LEG.first_bone() + 1] += swing_deg.to_radians();
        pose.bends_rad[LEG.hoof_bone()] = pastern_deg.to_radians();
        FootPhaseTest::new(&skeleton).phase(&pose, &skeleton, LEG, strike_ahead_m)
    }

    #[test]
    fn a_leg_in_front_is_down_when_its_pastern_has_sunk() {
        assert_eq!(phase(20.0, 40.0, FAR_M), FootPhase::Landed);
        assert_eq!(phase(20.0, 10.0, FAR_M), FootPhase::Unloaded);
    }

    #[test]
    fn a_leg_behind_is_up_when_its_pastern_has_folded_back() {
        assert_eq!(phase(-20.0, 20.0, FAR_M), FootPhase::NotYetLifted);
        assert_eq!(phase(-20.0, -10.0, FAR_M), FootPhase::Lifted);
    }

    #[test]
    fn a_hoof_ahead_of_its_strike_or_drawn_up_is_in_the_air() {
        assert_eq!(phase(20.0, 40.0, 0.1), FootPhase::BeforeStrike);
        let skeleton = Skeleton::reference();
        let mut pose = Pose::standing(&skeleton);
        pose.bends_rad[LEG.first_bone() + 2] += 1.5;
        pose.bends_rad[LEG.first_bone() + 3] -= 2.2;
        let phase = FootPhaseTest::new(&skeleton).phase(&pose, &skeleton, LEG, FAR_M);
        assert_eq!(phase, FootPhase::DrawnUp);
        assert!(!phase.is_on_ground());
    }

    #[test]
    fn the_test_does_not_depend_on_where_the_horse_is_and_where_it_faces() {
        let skeleton = Skeleton::reference();
        let test = FootPhaseTest::new(&skeleton);
        let mut pose = Pose::standing(&skeleton);
        pose.bends_rad[bone::LIMBS + 1] += 0.3;
        let here = Limb::ALL.map(|limb| toe_ahead_m(&pose, &skeleton, limb));
        let phases = Limb::ALL.map(|limb| test.phase(&pose, &skeleton, limb, FAR_M));
        pose.root_in_world += Vec3::new(40.0, 2.0, -7.0);
        pose.world_from_root = glam::Quat::from_rotation_y(2.0) * pose.world_from_root;
        for limb in Limb::ALL {
            assert!((toe_ahead_m(&pose, &skeleton, limb) - here[limb.index()]).abs() < 1e-5);
            assert_eq!(test.phase(&pose, &skeleton, limb, FAR_M), phases[limb.index()]);
        }
    }
}
