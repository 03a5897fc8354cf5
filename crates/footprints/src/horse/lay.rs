//! Prints of four hooves along a path, by a gait's support sequence.

use glam::DVec2;
use muybridge_core::Limb;

use super::gait::HorseGait;
use super::model::HorseModel;
use super::pacing::Pacing;
use crate::bounds::{LEAST_TIME_S, MOST_PRINTS};
use crate::lay::{LayError, Laying};
use crate::path::Path;
use crate::terrain::Terrain;
use crate::timing::StepTiming;
use crate::track::{Foot, Print, TrackGait};

/// Distances of the lines of left and right prints that are taken, metres.
const WIDTHS_M: [f64; 2] = [0.0, 1.0];
/// What is left of a stance at the beginning or the end of the motion counts from this share of a stride on.
const LEAST_SHARE: f64 = 0.03;

/// A stance in strides of the motion.
struct Step {
    limb: Limb,
    strike: f64,
    /// From footfall to lift-off, cut at the ends of the motion, s.
    from_s: f64,
    to_s: f64,
    along_m: f64,
}

/// Prints laid along a path by a gait at a speed.
///
/// The horse is in full gait from the first moment to the last. The motion begins at phase 0 of a stride, as the trailing hind foot
/// strikes, with every foot down that is down then: their prints come first and have what is left of their stances. It ends after as
/// many whole strides as have their prints on the path, one at least; stances under way are cut there. On level ground the hindmost
/// print lies at the beginning of the path. A print's middle is beside the path where its hoof is at the middle of its stance, and
/// points along it. On slopes the steps are shorter and quicker, as in the core's ride, so that the legs reach.
///
/// The width between left and right prints is the laying's or else the skeleton's; its step length and times are not for four legs.
///
/// # Errors
/// When there is no path, the gait is unknown at this speed, or more than 10,000 prints would be needed.
pub(crate) fn lay_horse(
    laying: &Laying,
    gait: &TrackGait,
    terrain: &Terrain,
    model: &HorseModel,
) -> Result<Vec<Print>, LayError> {
    let path = Path::through(&laying.points).ok_or(LayError::NoPath)?;
    let gait = HorseGait::new(model, gait).map_err(LayError::Gait)?;
    let [least_m, most_m] = WIDTHS_M;
    if let Some(value_m) = laying.step_width_m.filter(|width_m| !(least_m..=most_m).contains(width_m)) {
        return Err(LayError::Length { what: "step_width_m", value_m, least_m, most_m });
    }
    let (steps, end_s) = steps(&gait, &path, terrain)?;
    let print = |i: usize, step: &Step| {
        let leg = gait.legs[step.limb.index()];
        let half_width = laying.step_width_m.map(|width_m| 0.5 * width_m * leg.lateral_m.signum());
        let (at, along): (DVec2, DVec2) = path.at(step.along_m);
        let at = at + DVec2::new(-along.y, along.x) * half_width.unwrap_or(leg.lateral_m);
        let next_s = steps.get(i + 1).map_or(end_s, |next| next.from_s);
        let timing = StepTiming { stance_time_s: step.to_s - step.from_s, step_time_s: next_s - step.from_s };
        Print {
            foot: Foot::QUADRUPED[step.limb.index()],
            at_m: at.into(),
            heading_deg: (-along.y).atan2(along.x).to_degrees(),
            timing: Some(timing),
        }
    };
    Ok(steps.iter().enumerate().map(|(i, step)| print(i, step)).collect())
}

/// The steps along a path in the order of their footfalls, and the end of the motion, s.
fn steps(gait: &HorseGait, path: &Path, terrain: &Terrain) -> Result<(Vec<Step>, f64), LayError> {
    let length_m = path.length_m();
    let most = MOST_PRINTS / Foot::QUADRUPED.len() - 2;
    let first_m = -stances(gait, 1.0)
        .map(|(limb, strike)| along_in_gait_m(gait, limb, strike))
        .fold(f64::INFINITY, f64::min);
    let pacing = Pacing::new(gait, path, terrain, first_m, most);
    let along_m = |(limb, strike): (Limb, f64)| {
        let leg = gait.legs[limb.index()];
        pacing.along_m(strike + 0.5 * leg.duty, leg.print_m)
    };
    let fits = |strides: usize| stances(gait, strides as f64).all(|stance| along_m(stance) <= length_m);
    let strides = (2..=most + 1).find(|&strides| !fits(strides)).map_or(most + 1, |beyond| beyond - 1);
    if strides > most {
        let steps = (4.0 * length_m / gait.stride_length_m) as usize;
        return Err(LayError::TooMany { steps: steps.max(MOST_PRINTS + 1), most: MOST_PRINTS });
    }
    let end = strides as f64;
    let step = |(limb, strike): (Limb, f64)| {
        let lift_off = strike + gait.legs[limb.index()].duty;
        let [from_s, to_s] = [strike.max(0.0), lift_off.min(end)].map(|phase| pacing.time_s(phase));
        Step { limb, strike, from_s, to_s, along_m: along_m((limb, strike)) }
    };
    let mut steps: Vec<Step> = stances(gait, end).map(step).collect();
    steps.sort_by(|a, b| a.from_s.total_cmp(&b.from_s).then(a.strike.total_cmp(&b.strike)));
    // Feet that fall nearly together fall together: what is between two footfalls has to be long enough for a curve.
    let mut fallen_s = f64::NEG_INFINITY;
    for step in &mut steps {
        if step.from_s - fallen_s < LEAST_TIME_S {
            step.from_s = fallen_s;
        }
        fallen_s = step.from_s;
    }
    Ok((steps, pacing.time_s(end)))
}

/// Legs and strikes of all stances of which enough is within so many strides from phase 0.
fn stances(gait: &HorseGait, strides: f64) -> impl Iterator<Item = (Limb, f64)> {
    Limb::ALL.into_iter().flat_map(move |limb| {
        let leg = gait.legs[limb.index()];
        let strikes = (-1..strides as i32).map(move |k| leg.strike_phase + f64::from(k));
        strikes
            .filter(move |strike| (strike + leg.duty).min(strides) - strike.max(0.0) > LEAST_SHARE)
            .map(move |strike| (limb, strike))
    })
}

/// Where a stance's print is on level ground, from the root's place at phase 0, metres.
fn along_in_gait_m(gait: &HorseGait, limb: Limb, strike: f64) -> f64 {
    let leg = gait.legs[limb.index()];
    gait.stride_length_m * (strike + 0.5 * leg.duty) + leg.print_m
}
