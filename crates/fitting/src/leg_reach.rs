//! Putting a toe where it is wanted: damped least squares on the five joints of a leg (spec 4.4), in f64.

use muybridge_core::{Limb, Pair, Pose, Skeleton};
use nalgebra::{Matrix2, SMatrix, Vector2};

/// Greatest damping of the leg solution, m per rad: large enough to stay calm at full stretch, small against a leg of a metre.
const DAMPING_M: f64 = 0.02;
/// Solver steps; the error falls by far more than half at each until the leg is stretched.
const STEPS: usize = 60;
/// A toe this near its place is there, m: a tenth of what the database's rounding moves it.
const THERE_M: f64 = 2e-6;

/// Bends of a leg from its root (scapula, pelvis) to its hoof, rad.
pub(crate) type LegBends = [f64; 5];

/// Willingness of each joint to turn, root to fetlock.
///
/// Scapula and pelvis carry the trunk and give way last. The carpus of a loaded foreleg is locked straight, so that a bent,
/// loaded foreleg never comes out of it; in the air it turns as freely as the others.
pub(crate) fn willingness(limb: Limb, loaded: bool) -> LegBends {
    match (limb.pair(), loaded) {
        (Pair::Fore, true) => [0.3, 1.0, 1.0, 0.1, 1.0],
        (Pair::Fore, false) | (Pair::Hind, _) => [0.3, 1.0, 1.0, 1.0, 1.0],
    }
}

/// Turns the joints of a leg as little as it takes to bring its toe to a place in the root's plane (metres along the track
/// and over the ground), within the joint limits. Returns the bends and what is left, m.
pub(crate) fn reach(
    pose: &Pose,
    skeleton: &Skeleton,
    limb: Limb,
    willing: LegBends,
    at_m: [f64; 2],
) -> (LegBends, f64) {
    reach_from(leg_bends(pose, limb), pose, skeleton, limb, willing, at_m)
}

/// A pose's bends of a leg.
pub(crate) fn leg_bends(pose: &Pose, limb: Limb) -> LegBends {
    std::array::from_fn(|joint| f64::from(pose.bends_rad[limb.first_bone() + joint]))
}

/// The same from other bends than the pose's own.
pub(crate) fn reach_from(
    start: LegBends,
    pose: &Pose,
    skeleton: &Skeleton,
    limb: Limb,
    willing: LegBends,
    [x, y]: [f64; 2],
) -> (LegBends, f64) {
    let leg = Leg::new(pose, skeleton, limb);
    let limits: [[f64; 2]; 5] =
        std::array::from_fn(|joint| skeleton.bones[limb.first_bone() + joint].limits_rad.map(f64::from));
    let mut bends: LegBends =
        std::array::from_fn(|joint| start[joint].clamp(limits[joint][0], limits[joint][1]));
    let mut best = (bends, f64::INFINITY);
    for _ in 0..STEPS {
        let places = leg.joints(&bends);
        let toe = places[5];
        let miss = Vector2::new(x - toe[0], y - toe[1]);
        if miss.norm() < best.1 {
            best = (bends, miss.norm());
        }
        if miss.norm() < THERE_M {
            break;
        }
        let Some(turn) = turn(&places, &bends, &limits, &willing, miss) else { break };
        for joint in 0..5 {
            bends[joint] = (bends[joint] + turn[joint]).clamp(limits[joint][0], limits[joint][1]);
        }
    }
    best
}

/// The damped step of all joints that are not held by a limit.
fn turn(
    places: &[[f64; 2]; 6],
    bends: &LegBends,
    limits: &[[f64; 2]; 5],
    willing: &LegBends,
    miss: Vector2<f64>,
) -> Option<LegBends> {
    let mut free = *willing;
    // Each round lets go of at least one joint, or none is held.
    for _ in 0..=5 {
        let jacobian = SMatrix::<f64, 2, 5>::from_fn(|axis, joint| {
            let lever = [places[5][0] - places[joint][0], places[5][1] - places[joint][1]];
            free[joint] * if axis == 0 { -lever[1] } else { lever[0] }
        });
        // The nearer the place, the less damping: far off it keeps calm, close by it would only slow down.
        let damping = DAMPING_M.min(miss.norm());
        let damped = jacobian * jacobian.transpose() + Matrix2::identity() * damping * damping;
        let solved = jacobian.transpose() * damped.lu().solve(&miss)?;
        let step: LegBends = std::array::from_fn(|joint| free[joint] * solved[joint]);
        let held = |joint: usize| {
            let [low, high] = limits[joint];
            free[joint] > 0.0
                && ((bends[joint] <= low && step[joint] < 0.0) || (bends[joint] >= high && step[joint] > 0.0))
        };
        if !(0..5).any(held) {
            return Some(step);
        }
        free = std::array::from_fn(|joint| if held(joint) { 0.0 } else { free[joint] });
    }
    None
}

/// A leg in the sagittal plane of a pose whose trunk is given.
struct Leg {
    root: [f64; 2],
    parent_angle: f64,
    lengths_m: [f64; 5],
}

impl Leg {
    fn new(pose: &Pose, skeleton: &Skeleton, limb: Limb) -> Self {
        let first = limb.first_bone();
        let joints = pose.joints(skeleton);
        let base = joints.bases[first];
        // The angle of the bone the leg hangs on, from the leg's own first bone and its bend.
        let bone = joints.tips[first] - base;
        let angle = f64::from(bone.y.atan2(bone.x));
        Self {
            root: [f64::from(base.x), f64::from(base.y)],
            parent_angle: angle - f64::from(pose.bends_rad[first]),
            lengths_m: std::array::from_fn(|joint| f64::from(skeleton.bones[first + joint].length_m)),
        }
    }

    /// Proximal ends of the five bones, and the toe.
    fn joints(&self, bends: &LegBends) -> [[f64; 2]; 6] {
        let mut places = [self.root; 6];
        let mut angle = self.parent_angle;
        for joint in 0..5 {
            angle += bends[joint];
            let [x, y] = places[joint];
            places[joint + 1] =
                [x + self.lengths_m[joint] * angle.cos(), y + self.lengths_m[joint] * angle.sin()];
        }
        places
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_leg_of_a_standing_horse_reaches_a_step_about_it() {
        let skeleton = Skeleton::reference();
        let pose = Pose::standing(&skeleton);
        for limb in Limb::ALL {
            let toe = pose.joints(&skeleton).toe(limb);
            for [dx, dy] in [[0.2, 0.02], [-0.25, 0.03], [0.0, 0.2], [0.1, 0.1]] {
                let wanted = [f64::from(toe.x) + dx, f64::from(toe.y) + dy];
                let (bends, left) = reach(&pose, &skeleton, limb, willingness(limb, false), wanted);
                assert!(left < 1e-5, "{limb:?} misses {wanted:?} by {left}");
                let mut there = pose;
                for (joint, bend) in bends.iter().enumerate() {
                    there.bends_rad[limb.first_bone() + joint] = *bend as f32;
                }
                let place = there.joints(&skeleton).toe(limb);
                assert!((f64::from(place.x) - wanted[0]).abs() < 1e-4, "the solver's leg is the pose's");
                assert!((f64::from(place.y) - wanted[1]).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn a_loaded_foreleg_stays_straight() {
        let skeleton = Skeleton::reference();
        let pose = Pose::standing(&skeleton);
        let toe = pose.joints(&skeleton).toe(Limb::LF);
        let wanted = [f64::from(toe.x) + 0.15, f64::from(toe.y) + 0.02];
        let carpus = |loaded| reach(&pose, &skeleton, Limb::LF, willingness(Limb::LF, loaded), wanted).0[3];
        assert!(carpus(true).abs() < 0.05 && carpus(true).abs() < carpus(false).abs());
    }

    #[test]
    fn out_of_reach_is_said() {
        let skeleton = Skeleton::reference();
        let pose = Pose::standing(&skeleton);
        let (bends, left) = reach(&pose, &skeleton, Limb::RH, willingness(Limb::RH, true), [3.0, 0.0]);
        assert!(left > 1.0 && bends.iter().all(|bend| bend.is_finite()));
    }
}
