//! A leap: the end of a canter stride, a push from both hinds, ballistic flight over a hurdle, and the landing.

use muybridge_core::{Limb, Pair, Random, Side, Skeleton, bone};

use super::carriage::{raise_neck, resting, round_loins};
use super::curve::{Curve, Samples};
use super::hurdle::{Hurdle, hurdle_under};
use super::leap_numbers::{
    COM_HEIGHT, DURATION_S, FORE, HIND, NECK_DEG, PITCH_DEG, PLANTED, ROUNDING_DEG, SPEED_M_S, TAKE_OFF_S,
    TOUCH_DOWN_S, folds,
};
use super::legs::{Course, Fold, Legs, PoseVector, Stance, Step};
use crate::chain::{Attachment, Chain, Vec2};
use crate::layout::{BENDS, PITCH, ROOT_X, ROOT_Y, SHARED};

/// Rounds in which trunk and legs settle on one centre of mass: the legs hold a fifth of the mass, so each round
/// leaves a fifth of the error.
const SETTLING_ROUNDS: usize = 4;
/// Rounds of lowering the horse until every standing leg reaches the ground.
const REACH_ROUNDS: usize = 3;
/// Samples of a stance at which the legs' reach is tried.
const REACH_SAMPLES: usize = 16;
/// Spacing of the samples of the root's place, s; they run from before the first to after the last stance.
const SAMPLE_S: f64 = 0.02;
const SAMPLES_FROM_S: f64 = -0.6;
const SAMPLES_TO_S: f64 = 2.2;

/// Neck and head give back these shares of the trunk's pitch and of the neck's raising.
const NECK_LEVELS: f64 = 0.7;
const HEAD_STEADIES: f64 = 0.5;

/// A leap as one horse does it.
#[derive(Clone, Debug)]
pub(super) struct Leap {
    pub(super) hurdle: Hurdle,
    chain: Chain,
    legs: Legs,
    mass: Vec<f64>,
    /// Which leg each of the planned ones is; another on the left lead.
    side: Side,
    /// Lengths and times against those of the reference horse.
    size: f64,
    pace: f64,
    neck_deg: f64,
    strength: f64,
    /// Height of the centre of mass of the standing horse, less what the legs' reach takes away, m.
    standing_m: f64,
    /// Root as seen from the centre of mass.
    root_from_mass: Samples,
    stances: [Vec<Stance>; 4],
}

impl Leap {
    pub(super) fn new(horse: &Skeleton, side: Side, size: f64, random: &mut Random) -> Self {
        let neck_deg = random.between(-5.0, 5.0);
        Self::of_habit(horse, side, size, neck_deg, random.between(0.98, 1.02))
    }

    /// As the plan has it: the neck carried this much higher, the legs folded this much more strongly.
    pub(super) fn of_habit(horse: &Skeleton, side: Side, size: f64, neck_deg: f64, strength: f64) -> Self {
        let chain = Chain::new(horse);
        let mass = horse.bones.iter().map(|bone| f64::from(bone.mass_fraction)).collect();
        let mut leap = Self {
            hurdle: Hurdle { x_m: 0.0, height_m: 0.0 },
            legs: Legs::new(horse, FORE, HIND),
            chain,
            mass,
            side,
            size,
            pace: size.sqrt(),
            neck_deg,
            strength,
            standing_m: 0.0,
            root_from_mass: Samples::new(SAMPLES_FROM_S, SAMPLES_TO_S, SAMPLE_S, size.sqrt()),
            stances: Default::default(),
        };
        leap.stances = Limb::ALL.map(|limb| leap.planted(limb));
        let mut standing = resting(&leap.chain);
        standing[ROOT_Y] = f64::from(horse.croup_height_m);
        leap.standing_m = leap.centre_of_mass(&standing)[1];
        for _ in 0..REACH_ROUNDS {
            leap.settle();
            leap.standing_m -= leap.shortfall_m();
        }
        leap.settle();
        leap.hurdle = hurdle_under(&leap);
        leap
    }

    pub(super) fn chain(&self) -> &Chain {
        &self.chain
    }

    pub(super) fn size(&self) -> f64 {
        self.size
    }

    /// Times against those of the reference horse.
    pub(super) fn pace(&self) -> f64 {
        self.pace
    }

    pub(super) fn speed_m_s(&self) -> f64 {
        SPEED_M_S * self.pace
    }

    pub(super) fn duration_s(&self) -> f64 {
        DURATION_S * self.pace
    }

    pub(super) fn pose(&self, time_s: f64) -> PoseVector {
        self.legs.pose(self, time_s)
    }

    /// Where the centre of mass goes, m.
    pub(super) fn path(&self, time_s: f64) -> Vec2 {
        let height_m = self.size * COM_HEIGHT.at(time_s / self.pace);
        [self.speed_m_s() * time_s, self.standing_m + height_m]
    }

    fn centre_of_mass(&self, pose: &PoseVector) -> Vec2 {
        let kinematics = self.chain.kinematics(pose, &[0.0; SHARED]);
        let mut sum = [0.0; 2];
        for (i, mass) in self.mass.iter().enumerate() {
            let [base, tip] = kinematics.bone(i);
            (0..2).for_each(|axis| sum[axis] += 0.5 * mass * (base[axis] + tip[axis]));
        }
        sum
    }

    /// Moves the root to where it has to be for the centre of mass to keep to its path.
    fn settle(&mut self) {
        for _ in 0..SETTLING_ROUNDS {
            let places = self.root_from_mass.times_s().map(|time_s| {
                let pose = self.pose(time_s);
                let mass = self.centre_of_mass(&pose);
                [pose[ROOT_X] - mass[0], pose[ROOT_Y] - mass[1]]
            });
            let places = places.collect();
            self.root_from_mass.replace(places);
            self.stances = Limb::ALL.map(|limb| self.planted(limb));
        }
    }

    /// The most that any stance lacks, m.
    fn shortfall_m(&self) -> f64 {
        let mut most = f64::MIN;
        for limb in Limb::ALL {
            for stance in &self.stances[limb.index()] {
                for k in 0..=REACH_SAMPLES {
                    let share = k as f64 / REACH_SAMPLES as f64;
                    let time_s = stance.strike_s + share * (stance.lift_off_s - stance.strike_s);
                    most = most.max(self.legs.shortfall_m(self, limb, stance, time_s));
                }
            }
        }
        most
    }

    /// The leg of the plan, which leads on the right, that a leg takes the part of.
    pub(super) fn part(&self, limb: Limb) -> Limb {
        match self.side {
            Side::Right => limb,
            Side::Left => Limb::new(limb.pair(), limb.side().opposite()),
        }
    }

    /// Where and when a leg stands, by the trunk's motion as it is so far.
    fn planted(&self, limb: Limb) -> Vec<Stance> {
        let stances = PLANTED[self.part(limb).index()].iter().map(|planted| {
            let [strike_s, lift_off_s] = planted.span_s.map(|s| s * self.pace);
            let middle = self.chain.kinematics(&self.trunk(0.5 * (strike_s + lift_off_s)), &[0.0; SHARED]);
            let from_x = match limb.pair() {
                Pair::Fore => middle.bone(limb.first_bone())[0][0],
                Pair::Hind => middle.place(Attachment::Root)[0],
            };
            Stance { strike_s, lift_off_s, print_x_m: from_x + planted.toe_ahead_m * self.size }
        });
        stances.collect()
    }

    /// The stance that began last, at a time or before it.
    pub(super) fn last_stance(&self, limb: Limb, time_s: f64) -> Option<Stance> {
        self.stances[limb.index()].iter().take_while(|stance| stance.strike_s <= time_s).last().copied()
    }

    /// The middle of the jump along the track, m: between the last hind print and the first fore print.
    pub(super) fn middle_x_m(&self) -> f64 {
        let middle_s = 0.5 * self.pace * (TAKE_OFF_S + TOUCH_DOWN_S);
        let (fores, hinds) = self.stances.split_at(2);
        let landings = fores.iter().flatten().filter(|s| s.strike_s > middle_s);
        let take_offs = hinds.iter().flatten().filter(|s| s.strike_s < middle_s);
        let landing_m = landings.map(|s| s.print_x_m).fold(f64::INFINITY, f64::min);
        let take_off_m = take_offs.map(|s| s.print_x_m).fold(f64::NEG_INFINITY, f64::max);
        0.5 * (landing_m + take_off_m)
    }
}

impl Course for Leap {
    fn trunk(&self, time_s: f64) -> PoseVector {
        let at = |curve: &Curve| curve.at(time_s / self.pace).to_radians();
        let [x, y] = self.path(time_s);
        let [dx, dy] = self.root_from_mass.at(time_s);
        let (pitch, neck) = (at(&PITCH_DEG), at(&NECK_DEG) + self.neck_deg.to_radians());
        let mut pose = resting(&self.chain);
        pose[ROOT_X] = x + dx;
        pose[ROOT_Y] = y + dy;
        pose[PITCH] = pitch;
        raise_neck(&mut pose, neck - NECK_LEVELS * pitch);
        pose[BENDS + bone::HEAD] -= HEAD_STEADIES * neck;
        round_loins(&mut pose, at(&ROUNDING_DEG));
        pose
    }

    fn step(&self, limb: Limb, time_s: f64) -> Step {
        let stances = &self.stances[limb.index()];
        let next = stances.partition_point(|stance| stance.strike_s <= time_s).max(1);
        let from = stances[next - 1];
        let to = stances.get(next).copied();
        match to {
            Some(to) if time_s >= from.lift_off_s => {
                let strong = |fold: Fold| Fold { degrees: fold.degrees * self.strength, ..fold };
                Step::Between { from, to, folds: folds(self.part(limb), next).map(strong) }
            }
            _ => Step::On(from),
        }
    }
}
