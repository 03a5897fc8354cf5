//! The periodic motion of a gait: a trunk that bounces, rocks and nods, over legs that step in their order.

use std::f64::consts::TAU;

use muybridge_core::{Limb, Pair, Random, Skeleton, bone};

use super::carriage::{raise_neck, resting, round_loins};
use super::gaits::{GaitNumbers, Wave};
use super::legs::{Course, Fold, Legs, PoseVector, Stance, Step};
use crate::chain::{Attachment, Chain};
use crate::layout::{BENDS, PITCH, ROOT_X, ROOT_Y, SHARED};

/// Samples of a stance at which the legs' reach is tried, and rounds of setting the trunk's height by them.
const REACH_SAMPLES: usize = 16;
const REACH_ROUNDS: usize = 8;
/// The head gives back this share of the neck's nod, so that the face keeps its direction.
const HEAD_STEADIES: f64 = 0.6;

/// What is particular to one horse's way of going.
#[derive(Clone, Copy, Debug)]
struct Habit {
    neck_deg: [f64; 3],
    head_deg: f64,
    back_deg: f64,
    nod: f64,
}

/// A gait as one horse goes it.
#[derive(Clone, Debug)]
pub(super) struct Stepping {
    pub(super) gait: GaitNumbers,
    /// Phase at time zero.
    start: f64,
    chain: Chain,
    legs: Legs,
    habit: Habit,
    /// Half the length of the trunk, m: it rocks about its middle.
    half_trunk_m: f64,
    croup_height_m: f64,
    pitch_rad: f64,
    first: [Stance; 4],
}

impl Stepping {
    pub(super) fn new(horse: &Skeleton, gait: GaitNumbers, random: &mut Random) -> Self {
        let chain = Chain::new(horse);
        let mut vary = |sd: f64| sd * random.normal().clamp(-2.0, 2.0);
        let habit = Habit {
            neck_deg: [vary(3.0), vary(2.0), vary(2.0)],
            head_deg: vary(3.0),
            back_deg: vary(0.5),
            nod: 1.0 + vary(0.1),
        };
        let mut strong = |fold: Fold| Fold { degrees: fold.degrees * (1.0 + vary(0.04)), ..fold };
        let (mut fore, mut hind) = (gait.fore, gait.hind);
        fore.folds = fore.folds.map(&mut strong);
        hind.folds = hind.folds.map(&mut strong);
        let trunk_m: f64 = chain.reference_lengths_m[bone::SPINE..=bone::SPINE_LAST].iter().sum();
        let mut stepping = Self {
            gait,
            start: random.uniform(),
            legs: Legs::new(horse, fore, hind),
            chain,
            habit,
            half_trunk_m: 0.5 * trunk_m,
            croup_height_m: f64::from(horse.croup_height_m),
            pitch_rad: 0.0,
            first: [Stance { strike_s: 0.0, lift_off_s: 1.0, print_x_m: 0.0 }; 4],
        };
        stepping.first = Limb::ALL.map(|limb| stepping.first_stance(limb));
        stepping.stand_on_the_ground();
        stepping
    }

    pub(super) fn pose(&self, time_s: f64) -> PoseVector {
        self.legs.pose(self, time_s)
    }

    /// The stance of a leg that began last before a time.
    pub(super) fn stance(&self, limb: Limb, time_s: f64) -> Stance {
        let stride_s = self.gait.stride_time_s;
        let first = self.first[limb.index()];
        let turns = ((time_s - first.strike_s) / stride_s).floor();
        Stance {
            strike_s: first.strike_s + turns * stride_s,
            lift_off_s: first.lift_off_s + turns * stride_s,
            print_x_m: first.print_x_m + turns * stride_s * self.gait.speed_m_s,
        }
    }

    fn phase(&self, time_s: f64) -> f64 {
        time_s / self.gait.stride_time_s + self.start
    }

    /// A leg's stance of the stride that time zero lies in.
    fn first_stance(&self, limb: Limb) -> Stance {
        let (gait, pair) = (&self.gait, usize::from(limb.pair() == Pair::Hind));
        let strike_s = (gait.strikes[limb.index()] - self.start) * gait.stride_time_s;
        let lift_off_s = strike_s + gait.duty_factor[pair] * gait.stride_time_s;
        let middle = self.chain.kinematics(&self.trunk(0.5 * (strike_s + lift_off_s)), &[0.0; SHARED]);
        let from_x = match limb.pair() {
            Pair::Fore => middle.bone(limb.first_bone())[0][0],
            Pair::Hind => middle.place(Attachment::Root)[0],
        };
        Stance { strike_s, lift_off_s, print_x_m: from_x + gait.toe_ahead_m[pair] }
    }

    /// Sets the mean height of croup and withers as high as the legs' reach allows.
    fn stand_on_the_ground(&mut self) {
        for _ in 0..REACH_ROUNDS {
            let [fore_m, hind_m] = [Pair::Fore, Pair::Hind].map(|pair| self.shortfall_m(pair));
            self.croup_height_m -= hind_m;
            self.pitch_rad -= (fore_m - hind_m) / (2.0 * self.half_trunk_m);
            self.first = Limb::ALL.map(|limb| self.first_stance(limb));
        }
    }

    /// The most that any stance of a pair lacks, m.
    fn shortfall_m(&self, pair: Pair) -> f64 {
        let limbs = Limb::ALL.into_iter().filter(|limb| limb.pair() == pair);
        let lacks = limbs.flat_map(|limb| {
            let stance = self.first[limb.index()];
            (0..=REACH_SAMPLES).map(move |k| {
                let share = k as f64 / REACH_SAMPLES as f64;
                let time_s = stance.strike_s + share * (stance.lift_off_s - stance.strike_s);
                self.legs.shortfall_m(self, limb, &stance, time_s)
            })
        });
        lacks.fold(f64::MIN, f64::max)
    }
}

impl Course for Stepping {
    fn trunk(&self, time_s: f64) -> PoseVector {
        let (gait, habit, phase) = (&self.gait, &self.habit, self.phase(time_s));
        let at = |wave: Wave| wave.amplitude * (TAU * wave.per_stride * (phase - wave.peak)).cos();
        let rocking = at(gait.pitch_deg).to_radians();
        let nod_deg = habit.nod * at(gait.nod_deg);
        let mut pose = resting(&self.chain);
        pose[ROOT_X] = gait.speed_m_s * time_s;
        pose[ROOT_Y] = self.croup_height_m + at(gait.bounce_m) - self.half_trunk_m * rocking;
        pose[PITCH] = self.pitch_rad + rocking;
        round_loins(&mut pose, at(gait.rounding_deg).to_radians());
        pose[BENDS + bone::SPINE + 1] += habit.back_deg.to_radians();
        raise_neck(&mut pose, (gait.neck_deg + nod_deg).to_radians());
        (0..3).for_each(|i| pose[BENDS + bone::NECK + i] += habit.neck_deg[i].to_radians());
        // The neck is carried against the ground rather than against the trunk.
        pose[BENDS + bone::NECK] -= self.pitch_rad + rocking;
        let head_deg = gait.head_deg + habit.head_deg - HEAD_STEADIES * nod_deg;
        pose[BENDS + bone::HEAD] += head_deg.to_radians();
        pose
    }

    fn step(&self, limb: Limb, time_s: f64) -> Step {
        let from = self.stance(limb, time_s);
        if time_s < from.lift_off_s {
            return Step::On(from);
        }
        let stride_s = self.gait.stride_time_s;
        let to = Stance {
            strike_s: from.strike_s + stride_s,
            lift_off_s: from.lift_off_s + stride_s,
            print_x_m: from.print_x_m + self.gait.speed_m_s * stride_s,
        };
        Step::Between { from, to, folds: self.legs.style(limb.pair()).folds }
    }
}
