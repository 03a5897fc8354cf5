//! Legs that stand still while they carry and fold while they swing, under any trunk.
//!
//! In stance the hoof rolls over its toe, which stays in one place, and the two long links above the fetlock reach
//! for it: the foreleg with a straight knee, the hind leg with stifle and hock folding as one. In swing each joint
//! passes from its last angle to its next with its speed at both ends, and folds between them.

use std::f64::consts::PI;

use muybridge_core::{Limb, Pair, Skeleton, SwingFetlock};

use crate::chain::{Attachment, Chain, Vec2};
use crate::layout::{BENDS, PANEL_DOF, SHARED, SLIDES};

/// A pose in the layout of the fit's unknowns.
pub(super) type PoseVector = [f64; PANEL_DOF];

/// The scapula slides this far either way as the foreleg swings, share of withers height.
const SLIDE: f64 = 0.009;
/// The heel begins to rise at this share of the stance.
const HEEL_OFF: f64 = 0.7;
/// The knee begins to give at this share of the stance, and has given so far when the hoof leaves, degrees.
const KNEE_BREAKS: f64 = 0.85;
const KNEE_AT_LIFT_OFF_DEG: f64 = -8.0;
/// The straightest elbow and stifle a stance may ask for, degrees from straight: as galloping horses have them.
const STRAIGHTEST_ELBOW_DEG: f64 = 20.0;
const STRAIGHTEST_STIFLE_DEG: f64 = -40.0;
/// Joints lose the speed they have in stance over this share of the swing, the fetlock sooner; in a leap's long swing
/// over this time, s; and so fast that they run on by no more than this, rad.
const FADE: f64 = 0.35;
const FETLOCK_FADE: f64 = 0.22;
const FADE_S: f64 = 0.13;
const RUN_ON_RAD: f64 = 0.12;
/// Exponent of a fold: its rise and fall are smooth at both ends of the swing.
const FOLD_POWER: f64 = 5.0;
/// Swinging toes clear the ground by at least half of this in the middle of the swing, share of withers height.
const CLEARANCE: f64 = 0.03;
/// Sense in which the second, third and fourth joint of a leg fold; the shoulder has none of its own.
const FORE_FOLDS: [f64; 3] = [0.0, 1.0, -1.0];
const HIND_FOLDS: [f64; 3] = [1.0, -1.0, 1.0];
/// Steps of lifting a toe, the most a joint turns in one of them, rad, and the least arm that still counts, m.
const LIFT_STEPS: usize = 8;
const LIFT_RAD: f64 = 0.1;
const LEAST_LIFT_M: f64 = 0.05;
/// Step of the differences that give joint speeds, s.
const STEP_S: f64 = 1e-4;

/// A fold of one joint in the air.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fold {
    /// Greatest turn, degrees, in the sense of the joint's bend.
    pub(super) degrees: f64,
    /// Share of the swing at which it is reached, 0.3 to 0.7.
    pub(super) at: f64,
}

impl Fold {
    /// Turn at a share of the swing, rad.
    fn turn_rad(self, share: f64) -> f64 {
        let (rise, fall) = (FOLD_POWER * self.at, FOLD_POWER * (1.0 - self.at));
        let shape = (share / self.at).powf(rise) * ((1.0 - share) / (1.0 - self.at)).powf(fall);
        self.degrees.to_radians() * shape
    }
}

/// How a pair of legs moves.
#[derive(Clone, Copy, Debug)]
pub(super) struct LegStyle {
    /// Bend of scapula or pelvis from rest in the middle of the stance, degrees.
    pub(super) girdle_deg: f64,
    /// Turn of scapula or pelvis either way as the leg swings, degrees. At the pelvis it stands for its turn about the
    /// upright as well, which carries the hips to and fro.
    pub(super) girdle_swing_deg: f64,
    /// Direction of the pastern against the ground at strike, under full load and at lift-off, degrees.
    pub(super) pastern_deg: [f64; 3],
    /// Folds of the second to fourth joint: shoulder, elbow, knee; hip, stifle, hock.
    pub(super) folds: [Fold; 3],
}

/// One hoof on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Stance {
    pub(super) strike_s: f64,
    pub(super) lift_off_s: f64,
    /// Where the toe stands along the track, m.
    pub(super) print_x_m: f64,
}

impl Stance {
    fn share(&self, time_s: f64) -> f64 {
        (time_s - self.strike_s) / (self.lift_off_s - self.strike_s)
    }
}

/// What a leg does at a moment.
#[derive(Clone, Copy, Debug)]
pub(super) enum Step {
    /// It stands.
    On(Stance),
    /// It swings from one stance to the next.
    Between { from: Stance, to: Stance, folds: [Fold; 3] },
}

impl Step {
    /// How far the leg is swung forward, from 1 at strike to -1 at lift-off and back.
    fn protraction(&self, time_s: f64) -> f64 {
        match self {
            Self::On(stance) => (PI * stance.share(time_s)).cos(),
            Self::Between { from, to, .. } => -(PI * swing_share(from, to, time_s)).cos(),
        }
    }
}

fn swing_share(from: &Stance, to: &Stance, time_s: f64) -> f64 {
    (time_s - from.lift_off_s) / (to.strike_s - from.lift_off_s)
}

/// A motion of the trunk with the steps of the legs.
pub(super) trait Course {
    /// The pose at a time with the legs at rest.
    fn trunk(&self, time_s: f64) -> PoseVector;
    /// What a leg does at a time.
    fn step(&self, limb: Limb, time_s: f64) -> Step;
}

/// The legs of one horse.
#[derive(Clone, Debug)]
pub(super) struct Legs {
    chain: Chain,
    withers_height_m: f64,
    fetlocks: [SwingFetlock; 2],
    fore: LegStyle,
    hind: LegStyle,
}

/// The links between the girdle and the fetlock: `upper` turns with the second joint, `lower` also with the third.
/// Each has a length and a direction against the bone that leads it.
struct Links {
    upper: (f64, f64),
    lower: (f64, f64),
    /// Greatest distance they may span, m.
    longest_m: f64,
}

/// Where a standing leg has to reach.
struct Reach {
    links: Links,
    girdle_rad: f64,
    girdle_tip: Vec2,
    fetlock: Vec2,
    pastern_rad: f64,
    knee_rad: f64,
}

impl Legs {
    pub(super) fn new(horse: &Skeleton, fore: LegStyle, hind: LegStyle) -> Self {
        let fetlocks = [horse.fetlock.fore, horse.fetlock.hind];
        Self {
            chain: Chain::new(horse),
            withers_height_m: f64::from(horse.withers_height_m),
            fetlocks,
            fore,
            hind,
        }
    }

    pub(super) fn style(&self, pair: Pair) -> &LegStyle {
        match pair {
            Pair::Fore => &self.fore,
            Pair::Hind => &self.hind,
        }
    }

    /// The whole pose of a course at a time.
    pub(super) fn pose(&self, course: &impl Course, time_s: f64) -> PoseVector {
        let mut pose = course.trunk(time_s);
        for limb in Limb::ALL {
            let step = course.step(limb, time_s);
            self.set_girdle(&mut pose, limb, &step, time_s);
            let bends = match step {
                Step::On(stance) => self.stance_bends(&pose, limb, &stance, time_s),
                Step::Between { from, to, folds } => {
                    let mut bends = self.swing_bends(course, limb, [&from, &to], folds, time_s);
                    bends[0] = pose[BENDS + limb.first_bone()];
                    self.clear_ground(&mut pose, limb, bends, swing_share(&from, &to, time_s))
                }
            };
            set_bends(&mut pose, limb, bends);
        }
        pose
    }

    /// How much lower the girdle has to be for a standing leg to reach its print, m; negative where there is room.
    pub(super) fn shortfall_m(&self, course: &impl Course, limb: Limb, stance: &Stance, time_s: f64) -> f64 {
        let mut pose = course.trunk(time_s);
        self.set_girdle(&mut pose, limb, &Step::On(*stance), time_s);
        let reach = self.reach(&pose, limb, stance, time_s);
        let [dx, dy] = [0, 1].map(|axis| reach.girdle_tip[axis] - reach.fetlock[axis]);
        dy - (reach.links.longest_m.powi(2) - dx * dx).max(0.0).sqrt()
    }

    /// Turns scapula or pelvis with the leg, and slides the scapula.
    fn set_girdle(&self, pose: &mut PoseVector, limb: Limb, step: &Step, time_s: f64) {
        let (first, style) = (limb.first_bone(), self.style(limb.pair()));
        let protraction = step.protraction(time_s);
        let turn_deg = style.girdle_deg + style.girdle_swing_deg * protraction;
        pose[BENDS + first] = self.chain.rest_rad[first] + turn_deg.to_radians();
        if limb.pair() == Pair::Fore {
            pose[SLIDES + limb.index()] = SLIDE * self.withers_height_m * protraction;
        }
    }

    fn links(&self, limb: Limb, knee_rad: f64) -> Links {
        let first = limb.first_bone();
        let [upper, middle, cannon] = [1, 2, 3].map(|i| self.chain.reference_lengths_m[first + i]);
        let (upper, lower, straightest_deg) = match limb.pair() {
            Pair::Fore => ((upper, 0.0), joined(middle, cannon, knee_rad), STRAIGHTEST_ELBOW_DEG),
            // Stifle and hock fold by equal turns, so the cannon keeps its direction against the femur.
            Pair::Hind => {
                let folded = self.chain.rest_rad[first + 2] + self.chain.rest_rad[first + 3];
                (joined(upper, cannon, folded), (middle, 0.0), STRAIGHTEST_STIFLE_DEG)
            }
        };
        let between = straightest_deg.to_radians() + lower.1 - upper.1;
        let longest_m = joined(upper.0, lower.0, between).0;
        Links { upper, lower, longest_m }
    }

    fn reach(&self, pose: &PoseVector, limb: Limb, stance: &Stance, time_s: f64) -> Reach {
        let (first, share) = (limb.first_bone(), stance.share(time_s));
        let [base, tip] = self.chain.kinematics(pose, &[0.0; SHARED]).bone(first);
        let broken = ((share - KNEE_BREAKS) / (1.0 - KNEE_BREAKS)).max(0.0);
        let knee_rad = KNEE_AT_LIFT_OFF_DEG.to_radians() * broken * broken;
        let pastern_rad = pastern_rad(self.style(limb.pair()).pastern_deg, share);
        let length_m = self.chain.reference_lengths_m[limb.hoof_bone()];
        let (sin, cos) = pastern_rad.sin_cos();
        Reach {
            links: self.links(limb, knee_rad),
            girdle_rad: (tip[1] - base[1]).atan2(tip[0] - base[0]),
            girdle_tip: tip,
            fetlock: [stance.print_x_m - length_m * cos, -length_m * sin],
            pastern_rad,
            knee_rad,
        }
    }

    /// Bends of a standing leg; `pose` holds the trunk and the girdle.
    fn stance_bends(&self, pose: &PoseVector, limb: Limb, stance: &Stance, time_s: f64) -> [f64; 5] {
        let first = limb.first_bone();
        let reach = self.reach(pose, limb, stance, time_s);
        let ((upper_m, upper_rad), (lower_m, lower_rad)) = (reach.links.upper, reach.links.lower);
        let [dx, dy] = [0, 1].map(|axis| reach.fetlock[axis] - reach.girdle_tip[axis]);
        let cosine = (dx * dx + dy * dy - upper_m * upper_m - lower_m * lower_m) / (2.0 * upper_m * lower_m);
        let between = cosine.clamp(-1.0, 1.0).acos();
        let third = match limb.pair() {
            Pair::Fore => between - lower_rad + upper_rad,
            Pair::Hind => upper_rad - lower_rad - between,
        };
        let spanned = upper_rad + joined(upper_m, lower_m, third + lower_rad - upper_rad).1;
        let upper_world = dy.atan2(dx) - spanned;
        let fourth = match limb.pair() {
            Pair::Fore => reach.knee_rad,
            Pair::Hind => self.chain.rest_rad[first + 2] + self.chain.rest_rad[first + 3] - third,
        };
        let second = wrapped(upper_world - reach.girdle_rad);
        let fetlock = wrapped(reach.pastern_rad - upper_world - third - fourth);
        [pose[BENDS + first], second, third, fourth, fetlock]
    }

    /// Bends of the stance at one of its ends, and their speed there, rad/s. `inward_s` leads into the stance.
    fn stance_end(
        &self,
        course: &impl Course,
        limb: Limb,
        stance: &Stance,
        end_s: f64,
        inward_s: f64,
    ) -> [[f64; 5]; 2] {
        let at = |time_s: f64| {
            let mut pose = course.trunk(time_s);
            self.set_girdle(&mut pose, limb, &Step::On(*stance), time_s);
            self.stance_bends(&pose, limb, stance, time_s)
        };
        let (end, inside) = (at(end_s), at(end_s + inward_s));
        [end, std::array::from_fn(|j| (inside[j] - end[j]) / inward_s)]
    }

    /// Bends of a swinging leg.
    fn swing_bends(
        &self,
        course: &impl Course,
        limb: Limb,
        [from, to]: [&Stance; 2],
        folds: [Fold; 3],
        time_s: f64,
    ) -> [f64; 5] {
        let first = limb.first_bone();
        let swing_s = to.strike_s - from.lift_off_s;
        let share = swing_share(from, to, time_s);
        let [start, start_speed] = self.stance_end(course, limb, from, from.lift_off_s, -STEP_S);
        let [end, end_speed] = self.stance_end(course, limb, to, to.strike_s, STEP_S);
        let mut bends = [0.0; 5];
        let passed = share * share * (3.0 - 2.0 * share);
        for joint in 1..4 {
            let slopes = [start_speed[joint] * swing_s, end_speed[joint] * swing_s];
            bends[joint] = start[joint]
                + passed * (end[joint] - start[joint])
                + folds[joint - 1].turn_rad(share)
                + eased([0.0; 2], slopes, share, FADE.min(FADE_S / swing_s));
        }
        // The unloaded fetlock follows the joints above it.
        let law = self.fetlocks[usize::from(limb.pair() == Pair::Hind)];
        let [upper, cannon] = [law.per_upper_bend, law.per_cannon_bend].map(f64::from);
        let rest = |joint: usize| self.chain.rest_rad[first + joint];
        let follow = |b: &[f64; 5]| upper * (b[1] - rest(1)) + cannon * (b[3] - rest(3));
        let free = |b: &[f64; 5]| f64::from(law.swing_bend_rad) + follow(b);
        let slope = |speed: &[f64; 5]| (speed[4] - upper * speed[1] - cannon * speed[3]) * swing_s;
        let ends = [start[4] - free(&start), end[4] - free(&end)];
        let slopes = [slope(&start_speed), slope(&end_speed)];
        bends[4] = free(&bends) + eased(ends, slopes, share, FETLOCK_FADE.min(FADE_S / swing_s));
        bends
    }

    /// Folds a swinging leg a little more where its toe would touch the ground, at the joints whose folding lifts it.
    fn clear_ground(&self, pose: &mut PoseVector, limb: Limb, mut bends: [f64; 5], share: f64) -> [f64; 5] {
        let (first, pair) = (limb.first_bone(), limb.pair());
        let senses = if pair == Pair::Fore { FORE_FOLDS } else { HIND_FOLDS };
        let clearance_m = CLEARANCE * self.withers_height_m * 16.0 * (share * (1.0 - share)).powi(2);
        let mut wanted_m = None;
        for _ in 0..LIFT_STEPS {
            set_bends(pose, limb, bends);
            let kinematics = self.chain.kinematics(pose, &[0.0; SHARED]);
            let [toe_x, toe_y] = kinematics.place(Attachment::Tip(limb.hoof_bone()));
            let wanted_m = *wanted_m.get_or_insert(0.5 * (toe_y + toe_y.hypot(clearance_m)));
            // A joint lifts the toe by its distance behind it, per radian.
            let lift = [1, 2, 3].map(|j| {
                let ahead_m = toe_x - kinematics.bone(first + j)[0][0];
                senses[j - 1] * (senses[j - 1] * ahead_m).max(0.0)
            });
            let square = lift.iter().map(|v| v * v).sum::<f64>();
            let by = (wanted_m - toe_y) / square.max(LEAST_LIFT_M * LEAST_LIFT_M);
            (1..4).for_each(|j| bends[j] += (by * lift[j - 1]).clamp(-LIFT_RAD, LIFT_RAD));
        }
        bends
    }
}

/// Length and direction of two links joined at an angle, against the first.
fn joined(first_m: f64, second_m: f64, angle_rad: f64) -> (f64, f64) {
    let (sin, cos) = angle_rad.sin_cos();
    let [x, y] = [first_m + second_m * cos, second_m * sin];
    (x.hypot(y), y.atan2(x))
}

fn wrapped(angle_rad: f64) -> f64 {
    (angle_rad + PI).rem_euclid(2.0 * PI) - PI
}

fn set_bends(pose: &mut PoseVector, limb: Limb, bends: [f64; 5]) {
    let first = BENDS + limb.first_bone();
    pose[first..first + 5].copy_from_slice(&bends);
}

/// Direction of the pastern at a share of the stance: it sinks under load, then the heel rises over the toe.
fn pastern_rad([strike, loaded, lift_off]: [f64; 3], share: f64) -> f64 {
    let load = (PI * share).sin().powi(2);
    let rolled = ((share - HEEL_OFF) / (1.0 - HEEL_OFF)).max(0.0);
    let angle_deg = strike + (loaded - strike) * load + (lift_off - strike) * rolled * rolled;
    angle_deg.to_radians()
}

/// A curve that has these values and slopes at the ends of the swing and fades within `fade` of them, or sooner.
pub(crate) fn eased(
    [start, end]: [f64; 2],
    [start_slope, end_slope]: [f64; 2],
    share: f64,
    fade: f64,
) -> f64 {
    let piece = |value: f64, slope: f64, past: f64| {
        let held = 1.0 - (past / fade).min(1.0);
        // A slope that fades over a length runs on by 4/27 of their product.
        let slope_fade = fade.min(RUN_ON_RAD * 6.75 / slope.abs());
        let u = (past / slope_fade).min(1.0);
        value * held * held * (3.0 - 2.0 * held) + slope * past * (1.0 - u).powi(2)
    };
    piece(start, start_slope, share) + piece(end, -end_slope, 1.0 - share)
}
