//! The heading of a body that follows its feet.

use std::f64::consts::TAU;

use glam::{DQuat, DVec3};

use super::smooth;
use crate::placed::PlacedPrint;

/// Time between two entries, s: a frame of a film.
const STEP_S: f64 = 1.0 / 60.0;
/// Most entries: an hour and a half at that step. A longer motion has longer steps.
const MOST_ENTRIES: f64 = 324_000.0;
/// Feet of a figure at most.
const FEET: usize = 4;

/// Heading of the toes or of a body, radians to the left of X.
pub(crate) fn heading_rad(world_from: DQuat) -> f64 {
    let ahead = world_from * DVec3::X;
    f64::atan2(-ahead.z, ahead.x)
}

/// Headings at fixed steps from time 0, of figures on two or on four legs.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Headings {
    /// Time between two, s.
    pub(crate) step_s: f64,
    /// To the left of X, unwrapped: a body that turns round and round goes on counting.
    pub(crate) radians: Vec<f64>,
}

impl Headings {
    /// The mean heading of the feet that leave prints, as a moving mean over a window, s; up to the end of the motion, s.
    ///
    /// A foot on the ground heads as its print does; in the air it turns evenly to the next one. Successive prints turn the shorter way.
    pub(crate) fn of(prints: &[PlacedPrint], end_s: f64, window_s: f64) -> Self {
        let end_s = if end_s.is_finite() { end_s.max(0.0) } else { 0.0 };
        let step_s = STEP_S.max(end_s / MOST_ENTRIES);
        let entries = (end_s / step_s).ceil() as usize + 1;
        let mut feet = feet(prints);
        feet.retain(|foot| !foot.prints.is_empty());
        let mean = |at_s: f64, feet: &mut [FootHeading]| {
            let sum: f64 = feet.iter_mut().map(|foot| foot.at(at_s)).sum();
            sum / feet.len().max(1) as f64
        };
        let raw: Vec<f64> = (0..entries).map(|i| mean(i as f64 * step_s, &mut feet)).collect();
        Self { step_s, radians: moving_mean(&raw, window_s / step_s) }
    }
}

/// Footfall and lift-off of a print, s, and its heading, radians.
type HeadedPrint = (f64, f64, f64);

/// One foot's heading, asked for at rising times.
#[derive(Default)]
struct FootHeading {
    prints: Vec<HeadedPrint>,
    at: usize,
}

/// The feet with their prints' headings, unwrapped in the order of all footfalls.
fn feet(prints: &[PlacedPrint]) -> Vec<FootHeading> {
    let mut feet: Vec<FootHeading> = (0..FEET).map(|_| FootHeading::default()).collect();
    let mut last_rad = None;
    for print in prints {
        let heading_rad = heading_rad(print.world_from_foot);
        let from_rad = last_rad.unwrap_or(heading_rad);
        let turn_rad = heading_rad - from_rad;
        let turn_rad = turn_rad - TAU * (turn_rad / TAU).round();
        let heading_rad = if turn_rad.is_finite() { from_rad + turn_rad } else { 0.0 };
        last_rad = Some(heading_rad);
        feet[print.foot.index()].prints.push((print.strike_s, print.lift_off_s, heading_rad));
    }
    feet
}

impl FootHeading {
    /// The heading at a time, not before the last one asked for.
    fn at(&mut self, time_s: f64) -> f64 {
        while self.prints.get(self.at + 1).is_some_and(|next| next.0 <= time_s) {
            self.at += 1;
        }
        let (_, lift_off_s, heading_rad) = self.prints[self.at];
        match self.prints.get(self.at + 1) {
            Some((strike_s, _, next_rad)) if time_s > lift_off_s => {
                let share = (time_s - lift_off_s) / (strike_s - lift_off_s);
                heading_rad + (next_rad - heading_rad) * smooth(share)
            }
            _ => heading_rad,
        }
    }
}

/// The mean over a window of so many entries around each; outside, the ends are held.
fn moving_mean(values: &[f64], window: f64) -> Vec<f64> {
    let (Some(&first), Some(&last)) = (values.first(), values.last()) else { return Vec::new() };
    if window.is_nan() || window <= 0.0 {
        return values.to_vec();
    }
    // The integral of the values, joined by straight lines, from the first one on.
    let mut sums = vec![0.0; values.len()];
    for i in 1..values.len() {
        sums[i] = sums[i - 1] + (values[i - 1] + values[i]) / 2.0;
    }
    let end = values.len() - 1;
    let integral = |at: f64| {
        if at <= 0.0 {
            return first * at;
        }
        let i = at as usize;
        if i >= end {
            return sums[end] + last * (at - end as f64);
        }
        let share = at - i as f64;
        sums[i] + share * (values[i] + share * (values[i + 1] - values[i]) / 2.0)
    };
    let mean = |i: usize| {
        let (from, to) = (i as f64 - window / 2.0, i as f64 + window / 2.0);
        (integral(to) - integral(from)) / window
    };
    (0..values.len()).map(mean).collect()
}
