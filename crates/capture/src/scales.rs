//! How large a panel's photograph is: from a known length, or from the withers; and the even advance of pictures cut out around
//! the animal.

use crate::annotation::PanelAnnotation;
use crate::calibration::{CalibrationError, Context, Disagreement, Estimate};
use crate::even_advance::{advance_px, trunk_ahead_px};
use crate::keypoint::{BodyPoint, Keypoint};
use crate::line::GroundLine;
use crate::manifest::{Known, KnownLength, Parallax, Plane, Position, ScaleSource};
use crate::parallax::scale_ratio_from_stance;

/// The scale of each panel.
pub(crate) struct Scales {
    pub(crate) parallax: Option<Estimate>,
    pub(crate) relative_sd: f64,
    /// Where the withers height drives the scale.
    pub(crate) of_withers: Option<WithersScale>,
    pub(crate) disagreements: Vec<Disagreement>,
    /// Where only the trunk's even advance is known.
    pub(crate) advance: Option<Advance>,
}

/// The scale that makes the withers as high as they are known to be.
#[derive(Clone, Copy)]
pub(crate) struct WithersScale {
    /// Px per metre in the near legs' plane, at the middle of the panels.
    px_per_m: f64,
    /// Relative change per panel: an animal that comes nearer or goes away from a camera that stays is seen larger or smaller.
    /// Zero for a battery, whose cameras are all as far from the track.
    per_panel: f64,
    /// Index of the middle of the panels, counted from the stride's first.
    middle: f64,
}

impl WithersScale {
    fn new(context: &Context<'_>, px_per_m: f64) -> Self {
        let first = f64::from(context.annotation.stride.first);
        let panels = context.stride_panels();
        let heights: Vec<[f64; 2]> = panels
            .iter()
            .filter_map(|panel| Some([f64::from(panel.panel) - first, panel_withers_px(panel)?]))
            .collect();
        let n = heights.len() as f64;
        let mean = |axis: usize| heights.iter().map(|h| h[axis]).sum::<f64>() / n;
        let (middle, height) = (mean(0), mean(1));
        let sum = |axis: usize| -> f64 {
            heights.iter().map(|h| (h[0] - middle) * (h[axis] - [middle, height][axis])).sum()
        };
        let slope = sum(1) / sum(0) / height;
        let stays = matches!(context.calibration.position, Position::FixedCamera);
        let per_panel = if stays && slope.is_finite() { slope } else { 0.0 };
        Self { px_per_m, per_panel, middle: if middle.is_finite() { middle } else { 0.0 } }
    }

    pub(crate) fn at(self, index: f64) -> f64 {
        self.px_per_m * (1.0 + self.per_panel * (index - self.middle))
    }
}

/// The trunk's even advance, and where the trunk is seen in each panel.
pub(crate) struct Advance {
    stated: Option<Known>,
    /// From the hooves in stance; missing where the advance is stated and no hoof shows it.
    measured_px: Option<Estimate>,
    trunk_ahead_px: Vec<(u32, f64)>,
}

impl Advance {
    fn new(context: &Context<'_>) -> Result<Option<Self>, CalibrationError> {
        let Position::EvenAdvance { per_panel_m } = &context.calibration.position else { return Ok(None) };
        let ahead_px = trunk_ahead_px(context);
        let measured_px = match (advance_px(context, &ahead_px), per_panel_m) {
            (Err(error), None) => return Err(error),
            (measured, _) => measured.ok(),
        };
        let panels = context.stride_panels().into_iter().map(|panel| panel.panel);
        let trunk_ahead_px = panels.zip(ahead_px).collect();
        Ok(Some(Self { stated: per_panel_m.clone(), measured_px, trunk_ahead_px }))
    }

    /// Px the trunk is ahead of a panel's middle; zero where it has no trunk points.
    pub(crate) fn trunk_ahead_px(&self, panel: u32) -> f64 {
        let found = self.trunk_ahead_px.iter().find(|(number, px)| *number == panel && px.is_finite());
        found.map_or(0.0, |(_, px)| *px)
    }
}

impl Scales {
    /// Distance of the trunk per panel, m, as stated or as measured at a scale.
    pub(crate) fn advance_m(&self, px_per_m: f64) -> Option<Estimate> {
        let advance = self.advance.as_ref()?;
        let measured =
            advance.measured_px.map(|px| Estimate { value: px.value / px_per_m, sd: px.sd / px_per_m });
        advance.stated.as_ref().map(|known| Estimate { value: known.value, sd: known.sd }).or(measured)
    }

    pub(crate) fn new(context: &Context<'_>) -> Result<Self, CalibrationError> {
        let scale = &context.calibration.scale;
        let parallax = match &scale.known_length {
            Some(length) => parallax(context, length)?,
            None => None,
        };
        let from_length = mean_mark_scale(context).map(|wall| wall * parallax.map_or(1.0, |p| p.value));
        let length_sd = scale.known_length.as_ref().map_or(0.0, |length| {
            let spacing = &length.mark_spacing_m;
            (spacing.sd / spacing.value).hypot(parallax.map_or(0.0, |p| p.sd / p.value))
        });
        let from_withers = scale
            .withers_height_m
            .as_ref()
            .and_then(|known| Some((withers_px(context)? / known.value, known.sd / known.value, known)));
        let named = |name: &str, value: f64, relative: f64| {
            (name.to_string(), Estimate { value, sd: value * relative })
        };
        let mut disagreements = Vec::new();
        let advance = Advance::new(context)?;
        let scales = match scale.driven_by {
            ScaleSource::KnownLength => {
                let used = from_length.ok_or_else(|| first_panel_without_marks(context))?;
                if let Some((px_per_m, relative, known)) = from_withers {
                    disagreements.push(Disagreement {
                        quantity: "scale on the track, px/m",
                        used: named("known length", used, length_sd),
                        other: named(&format!("withers height ({})", known.from), px_per_m, relative),
                    });
                }
                Self { parallax, relative_sd: length_sd, of_withers: None, disagreements, advance }
            }
            ScaleSource::WithersHeight => {
                let (used, relative, _) = from_withers.ok_or(CalibrationError::NoWithers)?;
                let withers = WithersScale::new(context, used);
                if let Some(px_per_m) = from_length {
                    disagreements.push(Disagreement {
                        quantity: "scale on the track, px/m",
                        used: named("withers height", used, relative),
                        other: named("known length", px_per_m, length_sd),
                    });
                }
                Self { parallax, relative_sd: relative, of_withers: Some(withers), disagreements, advance }
            }
        };
        Ok(scales)
    }
}

fn first_panel_without_marks(context: &Context<'_>) -> CalibrationError {
    let panels = context.stride_panels();
    let bare = panels.iter().find(|p| p.marks.len() < 2).or(panels.first());
    CalibrationError::TooFewMarks { panel: bare.map_or(0, |p| p.panel) }
}

fn parallax(context: &Context<'_>, length: &KnownLength) -> Result<Option<Estimate>, CalibrationError> {
    Ok(match &length.plane {
        Plane::Track => None,
        Plane::Wall(Parallax::Distances { camera_to_track_m, camera_to_wall_m }) => {
            Some(Estimate { value: camera_to_wall_m / camera_to_track_m, sd: 0.0 })
        }
        Plane::Wall(Parallax::Ratio(known)) => Some(Estimate { value: known.value, sd: known.sd }),
        Plane::Wall(Parallax::FromStance) => {
            Some(scale_ratio_from_stance(context, length).ok_or(CalibrationError::NoStance)?)
        }
    })
}

/// Mean px per metre on the marks over the stride's panels.
fn mean_mark_scale(context: &Context<'_>) -> Option<f64> {
    let spacing_m = context.known_length()?.mark_spacing_m.value;
    let scales: Vec<f64> = context
        .stride_panels()
        .iter()
        .filter_map(|panel| context.mark_scale(panel, spacing_m).map(|scale| scale.px_per_m))
        .collect();
    (!scales.is_empty()).then(|| scales.iter().sum::<f64>() / scales.len() as f64)
}

/// Height of the withers over the ground line, px: from standing panels if there are any, else from all.
pub(crate) fn withers_px(context: &Context<'_>) -> Option<f64> {
    let mut panels = context.standing_panels();
    if panels.is_empty() {
        panels = context.stride_panels();
    }
    let heights: Vec<f64> = panels.iter().filter_map(|panel| panel_withers_px(panel)).collect();
    (!heights.is_empty()).then(|| heights.iter().sum::<f64>() / heights.len() as f64).filter(|px| *px > 1.0)
}

/// Height of the withers over a panel's ground line, px.
fn panel_withers_px(panel: &PanelAnnotation) -> Option<f64> {
    let place = panel.keypoints.place(Keypoint::Body(BodyPoint::Withers))?;
    Some(GroundLine::through(panel.ground_px?).along_and_above(place)[1])
}
