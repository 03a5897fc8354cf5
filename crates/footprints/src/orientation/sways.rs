//! Pitch and roll that go with the steps.
//!
//! The left foot's strike is phase 0 of the stride, the right foot's 0.5. Pitch has one period for each step, roll one for two steps.
//! Feet that fall together make one event without a side: pitch goes on, roll rests. A hop from a foot to the same one holds its roll.
//! Both fade out towards the first and the last footfall and in steps that take long: a figure that stands still does not sway.

use std::f64::consts::TAU;

use super::headings::Headings;
use super::smooth;
use crate::model::Sway;
use crate::placed::PlacedPrint;
use crate::track::Foot;

/// Footfalls this close are together, s.
const TOGETHER_S: f64 = 0.08;
/// A step so short sways fully, s; shorter ones less.
const SHORT_S: f64 = 0.2;
/// The window of the body is about a stride; a step that takes that long sways fully still, one of twice the time not at all.
const LEAST_WINDOW_S: f64 = 0.6;

/// One footfall, or several together.
#[derive(Clone, Copy)]
struct Footfall {
    at_s: f64,
    /// None: of both feet.
    foot: Option<Foot>,
    /// Share of the sways' amplitude.
    strength: f64,
}

/// Pitch and roll, radians, at the times of a table of headings.
pub(super) fn table(
    prints: &[PlacedPrint],
    headings: &Headings,
    window_s: f64,
    sways: [Sway; 2],
) -> Vec<[f64; 2]> {
    let footfalls = footfalls(prints, window_s.max(LEAST_WINDOW_S));
    let mut at = 0;
    let sway = |i: usize| {
        let time_s = i as f64 * headings.step_s;
        while footfalls.get(at + 1).is_some_and(|next| next.at_s <= time_s) {
            at += 1;
        }
        match footfalls.get(at..at + 2) {
            Some([from, to]) if time_s >= from.at_s => between(from, to, time_s, sways),
            _ => [0.0; 2],
        }
    };
    (0..headings.radians.len()).map(sway).collect()
}

/// The footfalls of two feet, with their strengths.
fn footfalls(prints: &[PlacedPrint], window_s: f64) -> Vec<Footfall> {
    let mut all: Vec<Footfall> = Vec::new();
    for print in prints.iter().filter(|print| print.foot.is_biped() && print.strike_s.is_finite()) {
        match all.last_mut() {
            Some(last) if print.strike_s - last.at_s < TOGETHER_S => {
                last.foot = last.foot.filter(|foot| *foot == print.foot);
            }
            _ => all.push(Footfall { at_s: print.strike_s, foot: Some(print.foot), strength: 0.0 }),
        }
    }
    let strength = |pair: &[Footfall]| {
        let step_s = pair[1].at_s - pair[0].at_s;
        let long = 1.0 - smooth(step_s / window_s - 1.0);
        long * smooth((step_s - TOGETHER_S) / (SHORT_S - TOGETHER_S))
    };
    let steps: Vec<f64> = all.windows(2).map(strength).collect();
    for (i, pair) in steps.windows(2).enumerate() {
        all[i + 1].strength = pair[0].min(pair[1]);
    }
    all
}

/// Phase of the stride at the footfall of a foot.
fn phase(foot: Foot) -> f64 {
    if foot == Foot::Left { 0.0 } else { 0.5 }
}

/// Pitch and roll between two footfalls, radians.
fn between(from: &Footfall, to: &Footfall, time_s: f64, [pitch, roll]: [Sway; 2]) -> [f64; 2] {
    let share = (time_s - from.at_s) / (to.at_s - from.at_s);
    let mixed = |from: f64, to: f64| from + (to - from) * smooth(share);
    let strength = mixed(from.strength, to.strength);
    let steps = share - 2.0 * pitch.greatest_at;
    // Without a side there is no roll, and any phase will do.
    let begun = from.foot.map(phase).or(to.foot.map(|foot| phase(foot) - 0.5)).unwrap_or(0.0);
    let hop = from.foot.is_some() && from.foot == to.foot;
    let strides = begun + if hop { 0.0 } else { share / 2.0 } - roll.greatest_at;
    let sided = |footfall: &Footfall| if footfall.foot.is_some() { footfall.strength } else { 0.0 };
    [
        strength * pitch.amplitude_deg.to_radians() * (TAU * steps).cos(),
        mixed(sided(from), sided(to)) * roll.amplitude_deg.to_radians() * (TAU * strides).cos(),
    ]
}
