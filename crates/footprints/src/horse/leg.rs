//! A leg through the whole motion: the prints it stands on, and where it is in its step at any time.

use glam::{DQuat, DVec3};
use muybridge_core::{Ground, Limb};

use super::gait::{GaitLeg, HorseGait};
use super::swing::Swing;
use crate::placed::{Placed, PlacedPrint};

/// Times nearer than this are the same, s.
const SAME_S: f64 = 1e-6;
/// Heights beyond this are no ground, metres.
const MOST_HEIGHT_M: f32 = 1e5;
/// Strides that a running horse is thought to make before the first moment and after the last one.
pub(super) const RUN_STRIDES: usize = 2;
/// However short its steps, a leg is posed as if the body went over so much of the gait's way over it.
const LEAST_SWEEP: f64 = 0.3;
/// Steepest ground a hoof lies flat on, rad: 35 degrees.
const STEEPEST_RAD: f64 = 0.6;

/// A leg on a print.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stand {
    /// Place of the print among all; none where the motion has no print for it: before the leg's first one and after its last.
    pub(super) print: Option<usize>,
    /// Footfall and lift-off, s; of a stance that the motion's beginning or end cuts, those of the whole one.
    pub(super) from_s: f64,
    pub(super) to_s: f64,
    /// Place of the toe, world space, metres.
    pub(super) toe: DVec3,
    /// Heading of the hoof, rad; counts whole turns.
    pub(super) heading_rad: f64,
    /// Angle at which the ground rises along it, rad.
    pub(super) rise_rad: f64,
    /// Share of the gait's way over a standing foot that the body goes over this one.
    sweep: f64,
}

/// All of a leg's stands, with the swings between them.
#[derive(Clone, Debug)]
pub(super) struct LegCourse {
    pub(super) limb: Limb,
    strike_phase: f64,
    duty: f64,
    pub(super) stands: Vec<Stand>,
    /// One fewer than stands.
    pub(super) swings: Vec<Swing>,
}

/// What a leg does.
#[derive(Clone, Copy, Debug)]
pub(super) enum Doing<'a> {
    /// Stands.
    Stands(&'a Stand),
    /// Is in the air between two stands, so far from one to the other.
    Swings([&'a Stand; 2], &'a Swing, f64),
}

/// A leg at a moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct LegNow<'a> {
    /// Phase of the gait's stride at which this leg is as far in its step: stance to stance and swing to swing.
    pub(super) phase: f64,
    /// Phase at which it is posed most like it: of a shorter step the stance is the middle part of the gait's.
    pub(super) posture_phase: f64,
    /// Share of its stance or its swing that is over.
    pub(super) through: f64,
    pub(super) doing: Doing<'a>,
}

/// Whether the horse comes to its first prints in its gait, and goes on beyond the last ones: not where it stands on all four feet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Running {
    pub(super) comes: bool,
    pub(super) goes: bool,
}

impl Running {
    fn new(gait: &HorseGait, placed: &Placed) -> Self {
        let of = |limb: &Limb| {
            let foot = limb.index();
            placed.prints.iter().filter(move |print| print.foot.index() == foot)
        };
        let is_cut = |limb: &Limb, print: &PlacedPrint| {
            let stance_s = gait.legs[limb.index()].duty * gait.stride_time_s;
            print.lift_off_s - print.strike_s < stance_s - SAME_S
        };
        let stands = |limb: &Limb, print: &PlacedPrint, stood: bool| stood && !is_cut(limb, print);
        let comes =
            |limb: &Limb| of(limb).next().is_some_and(|print| !stands(limb, print, print.strike_s < SAME_S));
        let ends_s = placed.end_s - SAME_S;
        let goes = |limb: &Limb| {
            of(limb).next_back().is_some_and(|print| !stands(limb, print, print.lift_off_s > ends_s))
        };
        Self { comes: Limb::ALL.iter().any(comes), goes: Limb::ALL.iter().any(goes) }
    }
}

/// The four legs' courses over the prints of a track, and over those that the horse would make before and after it.
pub(super) fn courses(gait: &HorseGait, placed: &Placed, ground: &impl Ground) -> ([LegCourse; 4], Running) {
    let headings_rad = headings_rad(&placed.prints);
    let running = Running::new(gait, placed);
    let courses = Limb::ALL.map(|limb| {
        let prints = placed.prints.iter().enumerate().zip(&headings_rad);
        let own = prints.filter(|((_, print), _)| print.foot.index() == limb.index());
        let stands = own.map(|((i, print), heading_rad)| Stand::new(i, print, *heading_rad)).collect();
        LegCourse::new(limb, gait, stands, placed.end_s, running, ground)
    });
    (courses, running)
}

/// Headings of prints, each less than half a turn from the one before, rad.
fn headings_rad(prints: &[PlacedPrint]) -> Vec<f64> {
    let mut before = 0.0;
    let heading = |print: &PlacedPrint| {
        let ahead = print.world_from_foot * DVec3::X;
        let heading = (-ahead.z).atan2(ahead.x);
        before += (heading - before + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU)
            - std::f64::consts::PI;
        before
    };
    prints.iter().map(heading).collect()
}

impl Stand {
    fn new(index: usize, print: &PlacedPrint, heading_rad: f64) -> Self {
        let ahead = print.world_from_foot * DVec3::X;
        let rise_rad = ahead.y.atan2(ahead.x.hypot(ahead.z));
        Self {
            print: Some(index),
            from_s: print.strike_s,
            to_s: print.lift_off_s,
            toe: print.middle,
            heading_rad,
            rise_rad: rise_rad.clamp(-STEEPEST_RAD, STEEPEST_RAD),
            sweep: 1.0,
        }
    }

    /// The stand one step before or after on the ground, as far from this one as that is from another.
    fn beyond(&self, other: Option<&Self>, sign: f64, gait: &HorseGait, ground: &impl Ground) -> Self {
        let (way, turn) = match other {
            Some(other) => (self.toe - other.toe, self.heading_rad - other.heading_rad),
            None => {
                let (sin, cos) = self.heading_rad.sin_cos();
                let ahead = DVec3::new(cos, self.rise_rad.tan(), -sin);
                (ahead * (sign * gait.stride_length_m), 0.0)
            }
        };
        let mut toe = self.toe + DQuat::from_rotation_y(turn) * way;
        let height_m = ground.surface(toe.x as f32, toe.z as f32).height_m;
        if height_m.abs() < MOST_HEIGHT_M {
            toe.y = f64::from(height_m);
        }
        Self { print: None, toe, heading_rad: self.heading_rad + turn, ..*self }
    }
}

/// How long a leg's steps before and after a stand are against the gait's, at most 1.
fn sweep(stands: &[Stand], i: usize, stride_length_m: f64) -> f64 {
    let [before, after] = [i.saturating_sub(1), (i + 1).min(stands.len() - 1)];
    let way = stands[after].toe - stands[before].toe;
    let share = way.x.hypot(way.z) / (stride_length_m * (after - before).max(1) as f64);
    if share.is_nan() || before == after { 1.0 } else { share.clamp(LEAST_SWEEP, 1.0) }
}

/// Duration of a leg's stance and swing in the gait, s.
#[derive(Clone, Copy, Debug)]
struct Step {
    stance_s: f64,
    swing_s: f64,
}

impl Step {
    /// Makes the first stance whole, and puts others before it.
    fn run_in(self, stands: &mut Vec<Stand>, gait: &HorseGait, ground: &impl Ground) {
        let Some(first) = stands.first_mut() else { return };
        let lift_off_s = if first.from_s > SAME_S {
            (first.from_s - self.swing_s).min(0.0)
        } else {
            first.from_s = first.from_s.min(first.to_s - self.stance_s);
            first.from_s - self.swing_s
        };
        for k in 0..=RUN_STRIDES {
            let to_s = lift_off_s - gait.stride_time_s * k as f64;
            let before = stands[0].beyond(stands.get(1), -1.0, gait, ground);
            stands.insert(0, Stand { from_s: to_s - self.stance_s, to_s, ..before });
        }
    }

    /// Makes the last stance whole, and puts others after it.
    fn run_out(self, stands: &mut Vec<Stand>, end_s: f64, gait: &HorseGait, ground: &impl Ground) {
        let Some(last) = stands.last_mut() else { return };
        let strike_s = if last.to_s < end_s - SAME_S {
            (last.to_s + self.swing_s).max(end_s)
        } else {
            last.to_s = last.to_s.max(last.from_s + self.stance_s);
            last.to_s + self.swing_s
        };
        for k in 0..=RUN_STRIDES {
            let from_s = strike_s + gait.stride_time_s * k as f64;
            let last = stands[stands.len() - 1];
            let other = stands.len().checked_sub(2).map(|i| stands[i]);
            let after = last.beyond(other.as_ref(), 1.0, gait, ground);
            stands.push(Stand { from_s, to_s: from_s + self.stance_s, ..after });
        }
    }
}

impl LegCourse {
    fn new(
        limb: Limb,
        gait: &HorseGait,
        mut stands: Vec<Stand>,
        end_s: f64,
        running: Running,
        ground: &impl Ground,
    ) -> Self {
        let GaitLeg { strike_phase, duty, .. } = gait.legs[limb.index()];
        let step = Step { stance_s: duty * gait.stride_time_s, swing_s: (1.0 - duty) * gait.stride_time_s };
        if running.comes {
            step.run_in(&mut stands, gait, ground);
        }
        if running.goes {
            step.run_out(&mut stands, end_s, gait, ground);
        }
        let sweeps: Vec<f64> = (0..stands.len()).map(|i| sweep(&stands, i, gait.stride_length_m)).collect();
        stands.iter_mut().zip(sweeps).for_each(|(stand, sweep)| stand.sweep = sweep);
        Self { limb, strike_phase, duty, stands, swings: Vec::new() }
    }

    /// Phase in the gait's stance of a stand of which a share is over.
    fn stance_phase(&self, stand: &Stand, through: f64) -> f64 {
        self.strike_phase + self.duty * (0.5 + (through - 0.5) * stand.sweep)
    }

    /// The leg at a time, s; none of a leg without prints.
    pub(super) fn at(&self, time_s: f64) -> Option<LegNow<'_>> {
        let i = self.stands.partition_point(|stand| stand.from_s <= time_s).saturating_sub(1);
        let stand = self.stands.get(i)?;
        if let (true, Some(next), Some(swing)) =
            (time_s > stand.to_s, self.stands.get(i + 1), self.swings.get(i))
        {
            let share = ((time_s - stand.to_s) / (next.from_s - stand.to_s)).clamp(0.0, 1.0);
            let phase = self.strike_phase + self.duty + share * (1.0 - self.duty);
            let [left, strikes] = [self.stance_phase(stand, 1.0), self.stance_phase(next, 0.0) + 1.0];
            let posture_phase = left + share * (strikes - left);
            return Some(LegNow {
                phase,
                posture_phase,
                through: share,
                doing: Doing::Swings([stand, next], swing, share),
            });
        }
        let through = ((time_s - stand.from_s) / (stand.to_s - stand.from_s)).clamp(0.0, 1.0);
        let through = if through.is_nan() { 0.0 } else { through };
        let phase = self.strike_phase + self.duty * through;
        let posture_phase = self.stance_phase(stand, through);
        Some(LegNow { phase, posture_phase, through, doing: Doing::Stands(stand) })
    }
}

impl<'a> LegNow<'a> {
    /// The print of the track that it stands on.
    pub(super) fn stand(&self) -> Option<&'a Stand> {
        match self.doing {
            Doing::Stands(stand) => Some(stand).filter(|stand| stand.print.is_some()),
            Doing::Swings(..) => None,
        }
    }
}
