//! Prints laid along a path.

use std::ops::RangeInclusive;

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::bounds::MOST_PRINTS;
use crate::model::Model;
use crate::path::{Path, PathPoint};
use crate::timing::StepTiming;
use crate::track::{Foot, Print};

/// Steps and their width, metres.
const STEP_M: RangeInclusive<f64> = 0.01..=20.0;
const WIDTH_M: RangeInclusive<f64> = 0.0..=20.0;
/// A step is so much longer than asked before the path gets one more of them, steps.
const LONGER_STEPS: f64 = 0.05;
/// Prints besides one at the end of each step: two where the figure stands first, one where it closes its feet.
const STANDING_PRINTS: usize = 3;
/// The first swing takes this share of a step time at least, however long the stances.
const LEAST_SWING: f64 = 0.25;

/// How prints are laid along a path.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Laying {
    /// The path.
    pub points: Vec<PathPoint>,
    /// Distance between successive prints along the path, metres; absent: the model's. Not for four legs: the gait says it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_length_m: Option<f64>,
    /// Distance between the lines of left and right prints, metres; absent: the model's.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub step_width_m: Option<f64>,
    /// Times of every print; absent: automatic.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub timing: Option<StepTiming>,
}

/// Why prints cannot be laid.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum LayError {
    /// No path.
    #[error("a path needs at least two points that differ, all of them numbers")]
    NoPath,
    /// Steps that are not between a centimetre and 20 m.
    #[error("{what} is {value_m} m; it must be between {least_m} and {most_m} m")]
    Length {
        /// Which number.
        what: &'static str,
        /// Its value, metres.
        value_m: f64,
        /// Least, metres.
        least_m: f64,
        /// Most, metres.
        most_m: f64,
    },
    /// More prints than a track takes.
    #[error("the path is {steps} steps long; {most} are the most")]
    TooMany {
        /// Wanted.
        steps: usize,
        /// Most.
        most: usize,
    },
    /// A gait that the database does not have at this speed, or none.
    #[error("{0}")]
    Gait(String),
}

/// Prints of a biped: it stands with its feet side by side, walks the whole path in even steps, left foot first, and closes its feet.
///
/// Steps are as long as asked or a little shorter, so that the path ends with one. The first two prints have times of their own, for
/// which the figure stands on both feet for a step time; the others have the laying's, or none.
pub(crate) fn lay_biped(laying: &Laying, model: &Model) -> Result<Vec<Print>, LayError> {
    let step_m = length("step_length_m", laying.step_length_m.unwrap_or(model.step_m[0]), &STEP_M)?;
    let width_m = length("step_width_m", laying.step_width_m.unwrap_or(model.step_m[1]), &WIDTH_M)?;
    let path = Path::through(&laying.points).ok_or(LayError::NoPath)?;
    let steps = (path.length_m() / step_m - LONGER_STEPS).ceil().max(1.0) as usize;
    let most = MOST_PRINTS - STANDING_PRINTS;
    if steps > most {
        return Err(LayError::TooMany { steps, most });
    }
    let step_m = path.length_m() / steps as f64;
    let places = [0, 0].into_iter().chain(1..=steps).chain([steps]);
    let mut prints: Vec<Print> = places
        .zip(Foot::BIPED.into_iter().cycle())
        .map(|(step, foot)| {
            let (middle, ahead) = path.at(step as f64 * step_m);
            let (at_m, heading_deg) = beside(middle, ahead, foot, width_m);
            Print { foot, at_m, heading_deg, timing: laying.timing }
        })
        .collect();
    let timing = laying.timing.unwrap_or_else(|| model.timing.timing(step_m.hypot(width_m)));
    for (print, timing) in prints.iter_mut().zip(setting_out(timing)) {
        print.timing = Some(timing);
    }
    if let (Some(timing), [.., last_step, closing]) = (laying.timing, &mut prints[..]) {
        let [last, end] = coming_to_rest(timing);
        (last_step.timing, closing.timing) = (Some(last), Some(end));
    }
    Ok(prints)
}

/// Place (x and z, metres) and heading (degrees) of a foot beside the line on which the figure goes in a direction.
pub(crate) fn beside(middle: DVec2, ahead: DVec2, foot: Foot, width_m: f64) -> ([f64; 2], f64) {
    let to_left = DVec2::new(ahead.y, -ahead.x) * if foot == Foot::Left { 0.5 } else { -0.5 };
    ((middle + to_left * width_m).to_array(), (-ahead.y).atan2(ahead.x).to_degrees())
}

/// Times of the first two prints of a figure that goes on in steps of a timing: it stands on both feet for a step time, lifts the
/// first one and swings it for as long as later ones.
pub(crate) fn setting_out(timing: StepTiming) -> [StepTiming; 2] {
    let StepTiming { stance_time_s, step_time_s } = timing;
    let both_s = (stance_time_s - step_time_s).clamp(0.0, (1.0 - LEAST_SWING) * step_time_s.max(0.0));
    let flight_s = (step_time_s - stance_time_s).max(0.0);
    let until_strike_s = 2.0 * step_time_s - both_s;
    [
        StepTiming { stance_time_s: step_time_s, step_time_s: 0.0 },
        StepTiming { stance_time_s: until_strike_s + both_s - flight_s, step_time_s: until_strike_s },
    ]
}

/// Times of the last two prints, which stand to the end.
fn coming_to_rest(timing: StepTiming) -> [StepTiming; 2] {
    let rest_s = timing.step_time_s.max(timing.stance_time_s);
    [
        StepTiming { stance_time_s: timing.step_time_s + rest_s, step_time_s: timing.step_time_s },
        StepTiming { stance_time_s: rest_s, step_time_s: rest_s },
    ]
}

fn length(what: &'static str, value_m: f64, range: &RangeInclusive<f64>) -> Result<f64, LayError> {
    let (least_m, most_m) = (*range.start(), *range.end());
    if range.contains(&value_m) {
        Ok(value_m)
    } else {
        Err(LayError::Length { what, value_m, least_m, most_m })
    }
}

#[cfg(test)]
mod tests;
