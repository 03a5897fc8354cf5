//! A skeleton laid out for speed, and the inverse kinematics of a leg: damped least squares with the couplings of the anatomy.

use glam::{Quat, Vec2, Vec3};

use crate::limb::{Limb, Pair};
use crate::pose::Pose;
use crate::skeleton::{BONE_COUNT, Skeleton, bone};

/// A toe this near its place is there, metres: a tenth of what may slide.
const THERE_M: f32 = 1e-5;
/// A loaded leg that misses by more than this is solved again with its joints unlocked, metres.
const NEAR_M: f32 = 1.5e-5;
/// The same for a toe in the air, metres.
const THERE_IN_AIR_M: f32 = 2e-4;
/// Steps of the solution; three do for a foot that is nearly in place, more when a joint runs into its limit.
const STEPS: usize = 12;
/// Greatest damping, m/rad: calm at full stretch, small against a leg of a metre.
const DAMPING_M: f32 = 0.02;
/// Variance of the carpus of a loaded foreleg against the other joints: it is locked straight.
const LOCKED: f32 = 0.01;
/// Variance of a fetlock in the air against the other joints: nothing but the tendons moves it.
const PASSIVE: f32 = 0.1;
/// Variance of a fetlock whose hoof keeps its turn.
const KEPT: f32 = 0.01;
/// Rounds of turning a hoof back to the ground and solving the leg above it.
const HOOF_ROUNDS: usize = 3;
/// Usual deviation of a stifle, rad: what the skeleton's deviation of the hock from its coupling is measured by.
const STIFLE_SD_RAD: f32 = 0.35;
/// How far solved bends keep from the skeleton's limits, rad: rounding must not carry them over.
const LIMIT_MARGIN_RAD: f32 = 1e-5;
/// A leg is never stretched beyond this share of its greatest length: nearer to it a millimetre of the body is degrees at the
/// joints.
const STRETCH: f32 = 0.985;
/// No joint is turned by more than this in one step, rad: the place moves on a curve, the step on its tangent.
const MOST_STEP_RAD: f32 = 0.3;
/// A joint is turned from its start by no more than this, rad: a solution farther off is another posture.
const MOST_TURNED_RAD: LegBends = [1.0, 1.0, 1.0, 0.5];
/// A leg turns and swings sideways no more than this, rad.
const SIDEWAYS_RAD: f32 = 0.7;

/// Bends of a leg below its first bone: humerus or femur to hoof, rad.
pub(super) type LegBends = [f32; 4];

/// One leg's numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct LegRig {
    /// Lengths of the five bones, metres.
    lengths_m: [f32; 5],
    /// Distance of the shoulder or hip from the median plane, metres, to the right positive.
    joint_lateral_m: f32,
    /// Distance of the toe from the median plane, metres, to the right positive.
    pub(super) toe_lateral_m: f32,
    /// Limits of the four bends below the first bone, rad.
    limits_rad: [[f32; 2]; 4],
    /// Greatest distance from shoulder or hip to toe in the leg's plane, metres.
    reach_m: f32,
    /// The same in space.
    pub(super) span_m: f32,
    /// Covariance of hock and stifle, and variance of the hock, against the stifle's; none of it in a foreleg.
    coupling: [f32; 2],
    is_fore: bool,
}

/// Where a leg hangs: its shoulder or hip in the root's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Girdle {
    /// Shoulder or hip, root's frame, metres.
    pub(super) joint: Vec3,
    /// Angle of the first bone, rad.
    pub(super) angle_rad: f32,
    /// Turn of what the leg hangs on, rad, to the left positive.
    pub(super) turn_rad: f32,
}

/// Where a toe is wanted, and how the leg may go there.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aim {
    /// Wanted place of the toe, root's frame, metres.
    pub(super) toe: Vec3,
    /// Wanted turn of the hoof against the root, rad, to the left positive.
    pub(super) hoof_turn_rad: f32,
    /// 1 in stance, 0 in the air.
    pub(super) load: f32,
    /// How much the hoof keeps the turn it begins with, 0 to 1: as it does where it lies on sloping ground.
    pub(super) keeps_hoof: f32,
}

/// A solved leg.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Reached {
    pub(super) bends_rad: LegBends,
    pub(super) limb_turn_rad: f32,
    pub(super) abduction_rad: f32,
    /// What the toe misses its place by, metres.
    pub(super) miss_m: f32,
    /// The same in the leg's plane: from the toe to its place, ahead and up, metres.
    pub(super) missing_m: Vec2,
}

/// A skeleton laid out for speed.
#[derive(Clone, Debug)]
pub(super) struct Rig {
    spine_m: [f32; 4],
    attachment_m: Vec2,
    /// The four legs.
    pub(super) legs: [LegRig; 4],
    /// Limits of every bend, rad.
    pub(super) limits_rad: [[f32; 2]; BONE_COUNT],
    /// Croup to withers, metres: the distance of the girdles.
    pub(super) trunk_m: f32,
}

impl Rig {
    pub(super) fn new(skeleton: &Skeleton) -> Self {
        let spine_m: [f32; 4] = std::array::from_fn(|i| skeleton.bones[bone::SPINE + i].length_m);
        Self {
            spine_m,
            attachment_m: skeleton.scapula_attachment_from_withers_m.into(),
            legs: Limb::ALL.map(|limb| LegRig::new(skeleton, limb)),
            limits_rad: std::array::from_fn(|i| inside(skeleton.bones[i].limits_rad)),
            trunk_m: spine_m.iter().sum(),
        }
    }

    /// Where the legs hang, for the bends, slides and lateral bends of a pose.
    pub(super) fn girdles(&self, pose: &Pose) -> [Girdle; 4] {
        let (mut angle, mut turn, mut withers) = (0.0f32, 0.0f32, Vec3::ZERO);
        for i in 0..4 {
            angle += pose.bends_rad[bone::SPINE + i];
            turn += pose.lateral_bends_rad[bone::SPINE + i];
            withers += self.spine_m[i] * along(angle, turn);
        }
        let (sin, cos) = angle.sin_cos();
        let turned = Turned::new(turn);
        Limb::ALL.map(|limb| {
            let leg = &self.legs[limb.index()];
            let bend = pose.bends_rad[limb.first_bone()];
            if limb.pair() == Pair::Hind {
                return leg.girdle(Vec3::ZERO, bend, &Turned::new(0.0));
            }
            let ahead = self.attachment_m.x + pose.scapula_slides_m[limb.index()];
            let up = self.attachment_m.y;
            let base = Vec3::new(cos * ahead - sin * up, sin * ahead + cos * up, 0.0);
            leg.girdle(withers + turned.apply(base), angle + bend, &turned)
        })
    }
}

/// Limits with the margin kept.
fn inside([low, high]: [f32; 2]) -> [f32; 2] {
    [low + LIMIT_MARGIN_RAD, high - LIMIT_MARGIN_RAD]
}

/// Unit vector of an angle in a plane that is turned about Y.
fn along(angle: f32, turn: f32) -> Vec3 {
    let (sin, cos) = angle.sin_cos();
    if turn == 0.0 {
        return Vec3::new(cos, sin, 0.0);
    }
    let (sin_turn, cos_turn) = turn.sin_cos();
    Vec3::new(cos * cos_turn, sin, -cos * sin_turn)
}

/// The angle of a cross and a dot product, rad; small ones, which most are, by the series of the arc tangent to its ninth power.
fn angle_of(cross: f32, dot: f32) -> f32 {
    if cross.abs() >= 0.2 * dot {
        return cross.atan2(dot);
    }
    let t = cross / dot;
    let square = t * t;
    t * (1.0 - square * (1.0 / 3.0 - square * (0.2 - square / 7.0)))
}

/// A turn about Y, to the left positive.
#[derive(Clone, Copy, Debug)]
struct Turned {
    turn: f32,
    sin: f32,
    cos: f32,
}

impl Turned {
    fn new(turn: f32) -> Self {
        let (sin, cos) = if turn == 0.0 { (0.0, 1.0) } else { turn.sin_cos() };
        Self { turn, sin, cos }
    }

    fn apply(&self, v: Vec3) -> Vec3 {
        Vec3::new(self.cos * v.x + self.sin * v.z, v.y, self.cos * v.z - self.sin * v.x)
    }

    fn undo(&self, v: Vec3) -> Vec3 {
        Vec3::new(self.cos * v.x - self.sin * v.z, v.y, self.cos * v.z + self.sin * v.x)
    }
}

impl LegRig {
    fn new(skeleton: &Skeleton, limb: Limb) -> Self {
        let bones = &skeleton.bones[limb.first_bone()..=limb.hoof_bone()];
        let limits_rad = std::array::from_fn(|i| inside(bones[i + 1].limits_rad));
        let is_fore = limb.pair() == Pair::Fore;
        let ratio = skeleton.reciprocal.ratio;
        let freedom = skeleton.reciprocal.sd_rad / STIFLE_SD_RAD;
        let mut leg = Self {
            lengths_m: std::array::from_fn(|i| bones[i].length_m),
            joint_lateral_m: bones[0].lateral_m,
            toe_lateral_m: bones[4].lateral_m,
            limits_rad,
            reach_m: 0.0,
            span_m: 0.0,
            coupling: if is_fore { [0.0, 1.0] } else { [ratio, ratio * ratio + freedom * freedom] },
            is_fore,
        };
        leg.reach_m = STRETCH * leg.greatest_length_m();
        leg.span_m = leg.reach_m.hypot(leg.toe_lateral_m - leg.joint_lateral_m);
        leg
    }

    /// Distance from shoulder or hip to toe with every joint as straight as its limits allow, metres.
    fn greatest_length_m(&self) -> f32 {
        let straight: LegBends = self.limits_rad.map(|[low, high]| 0.0f32.clamp(low.min(high), high));
        self.places(0.0, &straight)[4].length()
    }

    /// Sum of the bones below the first, metres.
    pub(super) fn length_m(&self) -> f32 {
        self.lengths_m[1..].iter().sum()
    }

    fn girdle(&self, base: Vec3, angle_rad: f32, turned: &Turned) -> Girdle {
        let (sin, cos) = angle_rad.sin_cos();
        let bone = Vec3::new(self.lengths_m[0] * cos, self.lengths_m[0] * sin, self.joint_lateral_m);
        Girdle { joint: base + turned.apply(bone), angle_rad, turn_rad: turned.turn }
    }

    /// Distal ends of the five bones below a joint at the origin, in the leg's plane; the first is the origin itself.
    fn places(&self, mut angle: f32, bends: &LegBends) -> [Vec2; 5] {
        let mut places = [Vec2::ZERO; 5];
        for i in 0..4 {
            angle += bends[i];
            let (sin, cos) = angle.sin_cos();
            places[i + 1] = places[i] + self.lengths_m[i + 1] * Vec2::new(cos, sin);
        }
        places
    }

    /// Where the toe of a leg that is neither turned nor abducted is, root's frame, metres.
    pub(super) fn toe(&self, girdle: &Girdle, bends: &LegBends) -> Vec3 {
        let toe = self.places(girdle.angle_rad, bends)[4];
        let lateral = self.toe_lateral_m - self.joint_lateral_m;
        girdle.joint + Turned::new(girdle.turn_rad).apply(toe.extend(lateral))
    }

    /// Turns the joints of a leg from a start as little as it takes to bring its toe to its place, within their limits.
    pub(super) fn solve(&self, girdle: &Girdle, start: &LegBends, aim: &Aim) -> Reached {
        let (sideways, place, beside_m) = self.sideways(girdle, aim);
        let there_m = if aim.load > 0.0 { THERE_M } else { THERE_IN_AIR_M };
        let in_plane = |start: &LegBends, load: f32| {
            let fetlock = (PASSIVE + load * (1.0 - PASSIVE)) * (1.0 - aim.keeps_hoof) + KEPT;
            self.solve_in_plane([girdle.angle_rad, there_m], start, place, [load, fetlock])
        };
        let (mut bends_rad, mut missing_m) = in_plane(start, aim.load);
        if aim.load > 0.0 && missing_m.length() > NEAR_M {
            // Where a leg would otherwise not do, its locked joints give way before the body does.
            (bends_rad, missing_m) = in_plane(&bends_rad, 0.0);
        }
        let hoof_rad: f32 = start.iter().sum();
        for _ in 0..if aim.keeps_hoof > 0.0 { HOOF_ROUNDS } else { 0 } {
            // What the joints above have turned the hoof by, its own joint takes back.
            let off_rad = hoof_rad - bends_rad.iter().sum::<f32>();
            let mut turned_rad = bends_rad;
            turned_rad[3] += aim.keeps_hoof * off_rad;
            let solved = in_plane(&turned_rad, aim.load);
            if solved.1.length() > NEAR_M {
                break;
            }
            (bends_rad, missing_m) = solved;
        }
        let miss_m = if missing_m.is_finite() { missing_m.length() + beside_m } else { f32::INFINITY };
        Reached { bends_rad, limb_turn_rad: sideways[0], abduction_rad: sideways[1], miss_m, missing_m }
    }

    /// Turn and abduction that bring the leg's plane over the toe, the toe's place in that plane as seen from the joint, and how far
    /// beside it the place is that was wanted, metres.
    fn sideways(&self, girdle: &Girdle, aim: &Aim) -> ([f32; 2], Vec2, f32) {
        let away = aim.toe - girdle.joint;
        if !away.is_finite() {
            return ([0.0; 2], Vec2::NAN, 0.0);
        }
        let limb_turn = (aim.hoof_turn_rad - girdle.turn_rad).clamp(-SIDEWAYS_RAD, SIDEWAYS_RAD);
        let seen = Turned::new(girdle.turn_rad + limb_turn).undo(away);
        let lateral = self.toe_lateral_m - self.joint_lateral_m;
        let radius_squared = seen.y * seen.y + seen.z * seen.z;
        let down = -(radius_squared - lateral * lateral).max(1e-4).sqrt();
        // The turn about X that carries (down, lateral) to (seen.y, seen.z).
        let cross = down * seen.z - lateral * seen.y;
        let dot = down * seen.y + lateral * seen.z;
        let abduction = angle_of(cross, dot);
        if abduction.abs() <= SIDEWAYS_RAD {
            return ([limb_turn, abduction], Vec2::new(seen.x, down), 0.0);
        }
        let abduction = abduction.clamp(-SIDEWAYS_RAD, SIDEWAYS_RAD);
        let seen = Quat::from_rotation_x(-abduction) * seen;
        ([limb_turn, abduction], Vec2::new(seen.x, seen.y), (seen.z - lateral).abs())
    }

    /// Solves a leg whose first bone has an angle (rad) until its toe is within a distance (metres) of a place seen from the joint, under a
    /// load and with a variance of the fetlock; returns what it misses.
    fn solve_in_plane(
        &self,
        [angle, there_m]: [f32; 2],
        start: &LegBends,
        place: Vec2,
        willing: [f32; 2],
    ) -> (LegBends, Vec2) {
        let limits: [[f32; 2]; 4] = std::array::from_fn(|i| {
            let [low, high] = self.limits_rad[i];
            let most = MOST_TURNED_RAD[i];
            [low.max((start[i] - most).min(high)), high.min((start[i] + most).max(low))]
        });
        let wanted = place;
        let place = if place.length() > self.reach_m { place.clamp_length_max(self.reach_m) } else { place };
        let mut bends: LegBends = std::array::from_fn(|i| start[i].clamp(limits[i][0], limits[i][1]));
        // The whole leg is turned towards the place first, so that only its length is left to be solved.
        let mut places = self.places(angle, &bends);
        let aside = angle_of(places[4].perp_dot(place), places[4].dot(place));
        if aside.is_finite() {
            let turned = (bends[0] + aside).clamp(limits[0][0], limits[0][1]) - bends[0];
            bends[0] += turned;
            let turn = Vec2::from_angle(turned);
            places = places.map(|place| turn.rotate(place));
        }
        let mut best = (bends, Vec2::INFINITY);
        for _ in 0..STEPS {
            let miss = place - places[4];
            let miss_m = miss.length();
            if miss_m < best.1.length() {
                best = (bends, miss);
            }
            if miss_m < there_m || miss_m.is_nan() {
                break;
            }
            let turn = self.turn(&places, &bends, &limits, miss, willing);
            let most = turn.iter().fold(MOST_STEP_RAD, |most, turn| turn.abs().max(most));
            for i in 0..4 {
                let turn = turn[i] * MOST_STEP_RAD / most;
                bends[i] = (bends[i] + turn).clamp(limits[i][0], limits[i][1]);
            }
            places = self.places(angle, &bends);
        }
        (best.0, best.1 + (wanted - place))
    }

    /// The damped step of all joints that are not held by a limit: `W J' (J W J' + d^2)^-1 miss`, with W the joints' covariance.
    fn turn(
        &self,
        places: &[Vec2; 5],
        bends: &LegBends,
        limits: &[[f32; 2]; 4],
        miss: Vec2,
        [load, fetlock]: [f32; 2],
    ) -> LegBends {
        let carpus = if self.is_fore { 1.0 + load * (LOCKED - 1.0) } else { self.coupling[1] };
        let mut free = [1.0f32; 4];
        let mut step = [0.0; 4];
        // The nearer the place, the less damping: far off it keeps calm, close by it would only slow down.
        let damping = DAMPING_M.min(miss.length());
        for _ in 0..4 {
            let lever: [Vec2; 4] = std::array::from_fn(|i| (places[4] - places[i]).perp() * free[i]);
            let cross = self.coupling[0];
            let pulled = [
                lever[0],
                lever[1] + cross * lever[2],
                carpus * lever[2] + cross * lever[1],
                fetlock * lever[3],
            ];
            let (mut xx, mut xy, mut yy) = (damping * damping, 0.0, damping * damping);
            for i in 0..4 {
                xx += lever[i].x * pulled[i].x;
                xy += lever[i].x * pulled[i].y;
                yy += lever[i].y * pulled[i].y;
            }
            let determinant = xx * yy - xy * xy;
            let solved = Vec2::new(yy * miss.x - xy * miss.y, xx * miss.y - xy * miss.x) / determinant;
            if !solved.is_finite() {
                return [0.0; 4];
            }
            step = std::array::from_fn(|i| free[i] * pulled[i].dot(solved));
            let mut is_held = false;
            for i in 0..4 {
                let [low, high] = limits[i];
                let held = (bends[i] <= low && step[i] < 0.0) || (bends[i] >= high && step[i] > 0.0);
                if held && free[i] > 0.0 {
                    (free[i], is_held) = (0.0, true);
                }
            }
            if !is_held {
                break;
            }
        }
        step
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn solve_leg(limb: Limb, by: Vec3, load: f32) -> (Pose, Vec3, f32) {
        let skeleton = Skeleton::reference();
        let rig = Rig::new(&skeleton);
        let mut pose = Pose::standing(&skeleton);
        pose.lateral_bends_rad[..4].fill(0.03);
        let girdle = rig.girdles(&pose)[limb.index()];
        let leg = &rig.legs[limb.index()];
        let first = limb.first_bone();
        let start: LegBends = std::array::from_fn(|i| pose.bends_rad[first + 1 + i]);
        let toe = leg.toe(&girdle, &start) + by;
        let aim = Aim { toe, hoof_turn_rad: 0.1, load, keeps_hoof: 0.0 };
        let reached = leg.solve(&girdle, &start, &aim);
        pose.bends_rad[first + 1..first + 5].copy_from_slice(&reached.bends_rad);
        pose.limb_turns_rad[limb.index()] = reached.limb_turn_rad;
        pose.abductions_rad[limb.index()] = reached.abduction_rad;
        (pose, toe, reached.miss_m)
    }

    #[test]
    fn the_solved_leg_is_where_forward_kinematics_puts_it() {
        let skeleton = Skeleton::reference();
        for limb in Limb::ALL {
            for by in [Vec3::new(0.1, 0.02, 0.0), Vec3::new(-0.2, 0.05, 0.1), Vec3::new(0.0, 0.3, -0.15)] {
                let (mut pose, toe, miss_m) = solve_leg(limb, by, 0.0);
                pose.root_in_world = Vec3::ZERO;
                let there = pose.joints(&skeleton).toe(limb);
                assert!(miss_m < 1e-4, "{limb:?} {by}: {miss_m}");
                assert!(there.distance(toe) < 2e-4, "{limb:?} {by}: {there} {toe}");
            }
        }
    }

    #[test]
    fn a_loaded_foreleg_keeps_its_carpus() {
        let rest = Skeleton::reference().bones[Limb::LF.first_bone() + 3].rest_bend_rad;
        let carpus = |load| {
            let (pose, _, _) = solve_leg(Limb::LF, Vec3::new(0.15, 0.03, 0.0), load);
            (pose.bends_rad[Limb::LF.first_bone() + 3] - rest).abs()
        };
        assert!(carpus(1.0) < 0.3 * carpus(0.0) + 0.02);
    }

    #[test]
    fn stifle_and_hock_flex_together() {
        let skeleton = Skeleton::reference();
        let (pose, _, _) = solve_leg(Limb::RH, Vec3::new(0.1, 0.25, 0.0), 0.0);
        let bend = |i: usize| {
            let bone = Limb::RH.first_bone() + i;
            pose.bends_rad[bone] - skeleton.bones[bone].rest_bend_rad
        };
        assert!(bend(2) < -0.1 && bend(3) > 0.1, "stifle {} hock {}", bend(2), bend(3));
    }

    #[test]
    fn out_of_reach_is_said_and_stays_finite() {
        for by in [Vec3::new(3.0, 0.0, 0.0), Vec3::new(0.0, 0.0, 2.0), Vec3::new(f32::NAN, 0.0, 0.0)] {
            let (pose, _, miss_m) = solve_leg(Limb::LH, by, 1.0);
            assert!(miss_m > 0.1);
            assert!(pose.bends_rad.iter().all(|bend| bend.is_finite()));
        }
    }
}
