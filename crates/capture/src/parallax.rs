//! Parallax measured from the plate itself: a hoof in stance stays where it is while the camera changes.
//!
//! With camera `i` at `X_i`, a toe seen `e_i` metres ahead of the axis *at the wall's scale* stands at
//! `X_i + e_i / r`, where `r` is the scale on the track over the scale on the wall. Equal places in two panels of the
//! same stance give `r = (e_i - e_j) / (X_j - X_i)`; all pairs together by robust least squares, because a toe slips
//! where it pushes off.

use muybridge_core::{Limb, Pair, Skeleton};

use crate::annotation::{KeypointState, PanelAnnotation, StanceLabel};
use crate::calibration::{Context, Estimate};
use crate::keypoint::{Keypoint, NearOff};
use crate::line::GroundLine;
use crate::manifest::{KnownLength, Position};

/// Rounds of reweighting; the weights settle to rounding in fewer than twenty.
const ROUNDS: usize = 40;

/// A toe in stance: place of its panel's camera and px ahead of the axis at wall scale, both metres.
struct StanceToe {
    panel: u32,
    camera_x_m: f64,
    ahead_m: f64,
    /// Standard deviation of `ahead_m`.
    sd_m: f64,
}

/// Two panels of one stance, all in one unit.
pub(crate) struct StancePair {
    /// How far the camera, or the trunk, moved on, in the unit the ratio is to be counted in.
    pub(crate) step: f64,
    /// How far the toe fell back.
    pub(crate) back: f64,
    /// Standard deviation of `back`.
    pub(crate) sd: f64,
}

/// Scale on the track over scale on the wall; none when no hoof is labelled stance and seen in two neighbouring panels.
pub(crate) fn scale_ratio_from_stance(context: &Context<'_>, length: &KnownLength) -> Option<Estimate> {
    let Position::CameraSpacing { spacing_m, first_axis_mark } = &context.calibration.position else {
        return None;
    };
    let mut pairs = Vec::new();
    for side in [NearOff::Near, NearOff::Off] {
        for pair in [Pair::Fore, Pair::Hind] {
            let toes: Vec<Option<StanceToe>> = context
                .stride_panels()
                .iter()
                .map(|panel| {
                    stance_toe(context, panel, length, side, pair, spacing_m.value, *first_axis_mark)
                })
                .collect();
            pairs.extend(toes.windows(2).filter_map(|two| match two {
                [Some(a), Some(b)] if b.panel == a.panel + 1 => Some(StancePair {
                    step: b.camera_x_m - a.camera_x_m,
                    back: a.ahead_m - b.ahead_m,
                    sd: a.sd_m.hypot(b.sd_m),
                }),
                _ => None,
            }));
        }
    }
    robust_ratio(&pairs)
}

/// Ratio of `back` to `step`, with Cauchy weights at one standard deviation.
pub(crate) fn robust_ratio(pairs: &[StancePair]) -> Option<Estimate> {
    let mut ratio = f64::NAN;
    let mut weights: Vec<f64> = pairs.iter().map(|pair| pair.sd.powi(-2)).collect();
    let chi_sq = |pair: &StancePair, ratio: f64| ((pair.back - ratio * pair.step) / pair.sd).powi(2);
    for _ in 0..ROUNDS {
        let sums = pairs.iter().zip(&weights).fold((0.0, 0.0), |(xy, xx), (pair, weight)| {
            (xy + weight * pair.step * pair.back, xx + weight * pair.step * pair.step)
        });
        ratio = sums.0 / sums.1;
        for (weight, pair) in weights.iter_mut().zip(pairs) {
            *weight = pair.sd.powi(-2) / (1.0 + chi_sq(pair, ratio));
        }
    }
    if !(ratio.is_finite() && ratio > 0.0) {
        return None;
    }
    let information: f64 = pairs.iter().zip(&weights).map(|(pair, w)| w * pair.step * pair.step).sum();
    Some(Estimate { value: ratio, sd: information.powf(-0.5) })
}

fn stance_toe(
    context: &Context<'_>,
    panel: &PanelAnnotation,
    length: &KnownLength,
    side: NearOff,
    pair: Pair,
    spacing_m: f64,
    first_axis_mark: f64,
) -> Option<StanceToe> {
    if panel.contacts.of(side, pair) != StanceLabel::Stance {
        return None;
    }
    let mark_m = length.mark_spacing_m.value;
    let scale = context.mark_scale(panel, mark_m)?;
    let toe = Keypoint::hoof(side, pair);
    let place = panel.keypoints.place(toe)?;
    let along_px = GroundLine::through(panel.ground_px?).along_and_above(place)[0];
    let camera_x_m = spacing_m * (f64::from(panel.panel) - f64::from(context.annotation.stride.first));
    let facing = context.facing.sign();
    let axis_mark_m = first_axis_mark * mark_m + scale.sign * facing * camera_x_m;
    let axis_px = scale.zero_along_px + scale.sign * scale.px_per_m * axis_mark_m;
    let ahead_m = facing * (along_px - axis_px) / (scale.px_per_m * shrink(context, side));
    let sd_m = toe_sd_px(context, panel, toe)? / scale.px_per_m;
    Some(StanceToe { panel: panel.panel, camera_x_m, ahead_m, sd_m })
}

/// How much smaller than near hooves the hooves of a side are seen.
pub(crate) fn shrink(context: &Context<'_>, side: NearOff) -> f64 {
    let distance_m = context.calibration.camera.distance_m.value;
    match side {
        NearOff::Near => 1.0,
        NearOff::Off => distance_m / (distance_m + hoof_track_width_m()),
    }
}

/// Standard deviation of a placed point, px; none where it is not placed.
pub(crate) fn toe_sd_px(context: &Context<'_>, panel: &PanelAnnotation, toe: Keypoint) -> Option<f64> {
    let placed = panel.keypoints.get(toe)?;
    let of_state = match placed.state {
        KeypointState::Visible => context.annotation.visible_sd_px,
        KeypointState::Occluded | KeypointState::Absent => context.annotation.occluded_sd_px,
    };
    Some(placed.sd_px.unwrap_or(of_state))
}

/// Distance between the planes of near and off hooves, m: the reference horse's. It is small against the camera's
/// distance, so that the animal's own width does not matter.
fn hoof_track_width_m() -> f64 {
    let horse = Skeleton::reference();
    let lateral_m = |limb: Limb| f64::from(horse.bones[limb.hoof_bone()].lateral_m);
    lateral_m(Limb::RF) - lateral_m(Limb::LF)
}
