//! Putting a toe where it is wanted: damped least squares on the five joints of a leg (spec 4.4), in f64.

use muybridge_core::{Limb, Pair, Pose, Skeleton};
use nalgebra::{Matrix2, SMatrix, Vector2};

/// Greatest damping of the leg solution, m per rad: large enough to stay calm at full stretch, small against a leg of a metre.
const DAMPING_M: f64 = 0.02;
/// Solver steps; the error falls by far more than half at each until the leg is stretched.
const STEPS: usize = 60;
/// A toe this near its place is there, m: a tenth of what the database's rounding moves it.
const THERE_M: f64 = 2e-6;

/// What solved bends keep from the skeleton's limits, rad (one degree): curves between samples overshoot by as much.
const LIMIT_MARGIN_RAD: f64 = 0.0175;
/// Greatest bend of a fetlock under load, rad: 70 degrees of dorsiflexion are what racehorses reach at full gallop.
const LOADED_FETLOCK_RAD: f64 = 1.22;
/// Greatest bend of a free fetlock, rad; the skeleton's own limit is nearer.
const FREE_FETLOCK_RAD: f64 = 1.6;

/// Least height of a loaded fetlock over the toe, as a share of the pastern's length: it comes near the ground at full gallop, but does
/// not touch it.
const FETLOCK_HEIGHT: f64 = 0.2;

/// Angles of a cannon are counted from minus this, rad: from 45 degrees over forward, where none ever points. One that hangs down is at
/// minus 90 degrees, one folded back past the horizontal at less than minus 180.
const WRAP_RAD: f64 = 1.75 * std::f64::consts::PI;

/// Bends of a leg from its root (scapula, pelvis) to its hoof, rad.
pub(crate) type LegBends = [f64; 5];

/// How readily each joint of a leg turns, root to fetlock, and how far it may.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Willingness {
    turns: LegBends,
    /// Greatest bend of the fetlock, rad.
    fetlock_rad: f64,
    load: f64,
}

/// The willingness of a leg that carries weight, or none.
pub(crate) fn willingness(limb: Limb, loaded: bool) -> Willingness {
    Willingness::under(limb, if loaded { 1.0 } else { 0.0 })
}

impl Willingness {
    /// The willingness under a load from 0, in the air, to 1, in stance.
    ///
    /// Scapula and pelvis carry the trunk and give way last. The carpus of a loaded foreleg is locked straight, so that a bent,
    /// loaded foreleg never comes out of it; a loaded fetlock sinks to [`LOADED_FETLOCK_RAD`] at most.
    pub(crate) fn under(limb: Limb, load: f64) -> Self {
        let carpus = if limb.pair() == Pair::Fore { 1.0 - 0.9 * load } else { 1.0 };
        let fetlock_rad = FREE_FETLOCK_RAD + load * (LOADED_FETLOCK_RAD - FREE_FETLOCK_RAD);
        Self { turns: [0.3, 1.0, 1.0, carpus, 1.0], fetlock_rad, load }
    }

    /// Limits of a leg's bends, a little inside the skeleton's.
    fn limits(&self, skeleton: &Skeleton, limb: Limb) -> [[f64; 2]; 5] {
        std::array::from_fn(|joint| {
            let [low, high] = skeleton.bones[limb.first_bone() + joint].limits_rad.map(f64::from);
            let high = if joint == 4 { high.min(self.fetlock_rad) } else { high };
            [low + LIMIT_MARGIN_RAD, high - LIMIT_MARGIN_RAD]
        })
    }
}

/// A pose's bends of a leg.
pub(crate) fn leg_bends(pose: &Pose, limb: Limb) -> LegBends {
    std::array::from_fn(|joint| f64::from(pose.bends_rad[limb.first_bone() + joint]))
}

/// Turns the joints of a leg from a start as little as it takes to bring its toe to a place in the root's plane (metres along
/// the track and over the ground), within the joint limits; trunk and limb roots are the pose's. Returns the bends and what
/// is left, m.
pub(crate) fn reach_from(
    start: LegBends,
    pose: &Pose,
    skeleton: &Skeleton,
    limb: Limb,
    willing: Willingness,
    [x, y]: [f64; 2],
) -> (LegBends, f64) {
    let leg = Leg::new(pose, skeleton, limb);
    let mut limits = willing.limits(skeleton, limb);
    let most_bent = limits[4][1];
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
        limits[4][1] =
            most_bent.min(leg.fetlock_over_ground(&places, &bends, willing.load)).max(limits[4][0]);
        let Some(turn) = turn(&places, &bends, &limits, &willing.turns, miss) else { break };
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

    /// The bend of the fetlock, rad, at which it is [`FETLOCK_HEIGHT`] over a toe that stands on the ground; less and less strict as
    /// the load goes.
    fn fetlock_over_ground(&self, places: &[[f64; 2]; 6], bends: &LegBends, load: f64) -> f64 {
        let pastern = [places[5][0] - places[4][0], places[5][1] - places[4][1]];
        let cannon_angle = pastern[1].atan2(pastern[0]) - bends[4];
        let height = FETLOCK_HEIGHT - 2.0 * (1.0 - load);
        // A folded leg carries its cannon back past the horizontal: were angles counted from there, the limit would jump by a turn.
        let hanging = (cannon_angle + WRAP_RAD).rem_euclid(std::f64::consts::TAU) - WRAP_RAD;
        -height.clamp(-1.0, 1.0).asin() - hanging
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
                let (bends, left) = reach_from(
                    leg_bends(&pose, limb),
                    &pose,
                    &skeleton,
                    limb,
                    willingness(limb, false),
                    wanted,
                );
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
        let carpus = |loaded| {
            let start = leg_bends(&pose, Limb::LF);
            reach_from(start, &pose, &skeleton, Limb::LF, willingness(Limb::LF, loaded), wanted).0[3]
        };
        assert!(carpus(true).abs() < 0.05 && carpus(true).abs() < carpus(false).abs());
    }

    #[test]
    fn the_fetlock_s_limit_does_not_jump_where_a_folding_cannon_passes_the_horizontal() {
        let skeleton = Skeleton::reference();
        let leg = Leg::new(&Pose::standing(&skeleton), &skeleton, Limb::LF);
        // The bend of the radius that lays the cannon back and level, and a little to either side.
        let at = |beyond: f64| {
            let mut bends: LegBends = [-1.0, -1.3, 0.3, 0.0, -0.1];
            bends[3] = -std::f64::consts::PI - leg.parent_angle - bends[..3].iter().sum::<f64>() - beyond;
            leg.fetlock_over_ground(&leg.joints(&bends), &bends, 0.2)
        };
        assert!((at(0.01) - at(-0.01) - 0.02).abs() < 1e-6, "{} and {}", at(-0.01), at(0.01));
        assert!(at(0.5) > FREE_FETLOCK_RAD, "a leg in the air is not held");
    }

    #[test]
    fn out_of_reach_is_said() {
        let skeleton = Skeleton::reference();
        let pose = Pose::standing(&skeleton);
        let willing = willingness(Limb::RH, true);
        let start = leg_bends(&pose, Limb::RH);
        let (bends, left) = reach_from(start, &pose, &skeleton, Limb::RH, willing, [3.0, 0.0]);
        assert!(left > 1.0 && bends.iter().all(|bend| bend.is_finite()));
    }
}
