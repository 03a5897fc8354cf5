//! From what is known of a plate to one camera per panel, the time of each panel, and how far the sources disagree.

use muybridge_core::SpeedSource;

use crate::annotation::{Annotation, PanelAnnotation, PanelUse};
use crate::keypoint::{BodyPoint, Keypoint};
use crate::line::GroundLine;
use crate::manifest::{Calibration, Facing, KnownLength, Manifest, Position};
use crate::scales::Scales;
use crate::timing::panel_times;

/// A number with its standard deviation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Best value.
    pub value: f64,
    /// Standard deviation, same unit.
    pub sd: f64,
}

/// Two sources that speak of the same quantity.
#[derive(Clone, Debug, PartialEq)]
pub struct Disagreement {
    /// The quantity with its unit.
    pub quantity: &'static str,
    /// Source that drives the fit and its value.
    pub used: (String, Estimate),
    /// The other source and its value.
    pub other: (String, Estimate),
}

impl Disagreement {
    /// Other over used, minus one, in percent.
    pub fn percent(&self) -> f64 {
        100.0 * (self.other.1.value / self.used.1.value - 1.0)
    }

    /// Difference in standard deviations of the difference; infinite when both claim to be exact.
    pub fn sigmas(&self) -> f64 {
        (self.other.1.value - self.used.1.value).abs() / self.used.1.sd.hypot(self.other.1.sd)
    }
}

/// Maps world metres to plate px for one panel: a pinhole camera that looks square at the track.
///
/// World here is the *filmed side's* frame: `x_m` forward along the track, `y_m` up, `z_m` towards the camera with the
/// near legs' plane at zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PanelCamera {
    /// Panel number.
    pub panel: u32,
    /// When the panel was taken, s after the stride's first panel.
    pub time_s: f64,
    /// Scale in the near legs' plane, px/m.
    pub px_per_m: f64,
    /// Foot of the camera's axis on the ground line, plate px.
    pub axis_foot_px: [f64; 2],
    /// Unit vector forward (the way the animal faces) in plate px.
    pub forward: [f64; 2],
    /// Unit vector upwards in plate px.
    pub up: [f64; 2],
    /// Place of the camera along the track, m.
    pub camera_x_m: f64,
    /// Distance of the camera from the near legs' plane, m.
    pub distance_m: f64,
    /// Height of the camera over the track, m.
    pub height_m: f64,
}

impl PanelCamera {
    /// The linear map of the plane at `z_m`: plate px = `offset + x_m * x_column + y_m * y_column`.
    pub fn plane(&self, z_m: f64) -> ([f64; 2], [[f64; 2]; 2]) {
        let k = self.distance_m / (self.distance_m - z_m);
        let scale = self.px_per_m * k;
        let x_column = self.forward.map(|f| f * scale);
        let y_column = self.up.map(|u| u * scale);
        let lift = self.px_per_m * self.height_m * (1.0 - k);
        let offset = [0, 1]
            .map(|axis| self.axis_foot_px[axis] - self.camera_x_m * x_column[axis] + lift * self.up[axis]);
        (offset, [x_column, y_column])
    }

    /// A world point in plate px.
    pub fn plate_from_world(&self, [x_m, y_m, z_m]: [f64; 3]) -> [f64; 2] {
        let (offset, [x_column, y_column]) = self.plane(z_m);
        [0, 1].map(|axis| offset[axis] + x_m * x_column[axis] + y_m * y_column[axis])
    }

    /// The world point of the plane at `z_m` that is seen at a plate px.
    pub fn world_from_plate(&self, point_in_plate_px: [f64; 2], z_m: f64) -> [f64; 3] {
        let k = self.distance_m / (self.distance_m - z_m);
        let scale = self.px_per_m * k;
        let lift = self.px_per_m * self.height_m * (1.0 - k);
        let d = [0, 1].map(|axis| point_in_plate_px[axis] - self.axis_foot_px[axis]);
        let ahead_px = d[0] * self.forward[0] + d[1] * self.forward[1];
        let above_px = d[0] * self.up[0] + d[1] * self.up[1];
        [self.camera_x_m + ahead_px / scale, (above_px - lift) / scale, z_m]
    }
}

/// A calibrated plate.
#[derive(Clone, Debug, PartialEq)]
pub struct PlateCalibration {
    /// Cameras of the stride's panels, in order of time.
    pub stride: Vec<PanelCamera>,
    /// Cameras of the standing panels; their `time_s` is zero and means nothing.
    pub standing: Vec<PanelCamera>,
    /// Mean forward speed over the panels, m/s.
    pub speed_m_s: Estimate,
    /// How the speed is known.
    pub speed_source: SpeedSource,
    /// Mean interval between panels, s.
    pub interval_s: Estimate,
    /// Relative standard deviation of the scale.
    pub scale_relative_sd: f64,
    /// Scale on the track over scale on the wall, where a wall is the source.
    pub parallax: Option<Estimate>,
    /// Withers height that follows from the scale, m: from the standing panels, else the mean over the stride's, which is within
    /// a few hundredths of the standing height at any gait.
    pub withers_height_m: Option<Estimate>,
    /// Every quantity that two sources speak of.
    pub disagreements: Vec<Disagreement>,
}

/// Why a plate cannot be calibrated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CalibrationError {
    /// Nobody has said yet.
    #[error("{field}: not known yet; say it in the manifest")]
    Missing {
        /// The manifest's field.
        field: &'static str,
    },
    /// No source for the scale.
    #[error(
        "panel {panel}: marks: fewer than two marks, so the known length gives no scale; mark two or drive the scale by the withers height"
    )]
    TooFewMarks {
        /// The panel.
        panel: u32,
    },
    /// The fixed mark is missing.
    #[error("panel {panel}: marks: mark {mark} is not placed, but positions are measured from it")]
    NoMark {
        /// The panel.
        panel: u32,
        /// The mark's number.
        mark: f64,
    },
    /// The ground line is missing.
    #[error("panel {panel}: ground_px: not drawn yet; draw the ground line under the near hooves")]
    NoGround {
        /// The panel.
        panel: u32,
    },
    /// Nothing to measure the withers on.
    #[error("keypoints.withers: placed in no panel, but the scale is driven by the withers height")]
    NoWithers,
    /// Parallax asked from stance, but no hoof is seen twice.
    #[error(
        "calibration.scale: no hoof is labelled stance in two neighbouring panels, so the parallax cannot be measured from stance; give distances or a ratio"
    )]
    NoStance,
    /// The advance of the trunk asked from stance, but no hoof is seen twice.
    #[error(
        "calibration.position: no hoof is labelled stance in two neighbouring panels, so the advance of the trunk cannot be measured; say it (per_panel_m)"
    )]
    NoAdvance,
    /// A speed asked by dynamic similarity, but something it follows from is missing.
    #[error("calibration.time: the speed cannot be inferred by dynamic similarity: {0}")]
    NoSimilarity(&'static str),
    /// The numbers contradict each other so far that no camera results.
    #[error("calibration: {0}")]
    Contradiction(String),
}

/// Relative difference between the withers' mean height over a stride and standing: a few hundredths at any gait.
const MOVING_WITHERS_SD: f64 = 0.03;

/// Scale on a panel's marks: px per metre and the px (along the ground line) of mark zero.
#[derive(Clone, Copy)]
pub(crate) struct MarkScale {
    pub(crate) px_per_m: f64,
    pub(crate) zero_along_px: f64,
    /// +1 when mark numbers grow to the right.
    pub(crate) sign: f64,
}

/// Everything the steps share.
pub(crate) struct Context<'a> {
    pub(crate) manifest: &'a Manifest,
    pub(crate) calibration: &'a Calibration,
    pub(crate) facing: Facing,
    pub(crate) annotation: &'a Annotation,
}

impl<'a> Context<'a> {
    pub(crate) fn stride_panels(&self) -> Vec<&'a PanelAnnotation> {
        let span = self.annotation.stride;
        let used =
            |p: &&PanelAnnotation| p.usage == PanelUse::Stride && (span.first..=span.last).contains(&p.panel);
        self.annotation.panels.iter().filter(used).collect()
    }

    pub(crate) fn standing_panels(&self) -> Vec<&'a PanelAnnotation> {
        self.annotation.panels.iter().filter(|p| p.usage == PanelUse::Standing).collect()
    }

    /// Least-squares line through a panel's marks; none with fewer than two.
    pub(crate) fn mark_scale(&self, panel: &PanelAnnotation, spacing_m: f64) -> Option<MarkScale> {
        let ground = GroundLine::through(panel.ground_px?);
        let points: Vec<(f64, f64)> =
            panel.marks.iter().map(|m| (m.mark * spacing_m, ground.along_and_above(m.at_px)[0])).collect();
        let n = points.len() as f64;
        let (mean_x, mean_y) = points.iter().fold((0.0, 0.0), |(sx, sy), (x, y)| (sx + x / n, sy + y / n));
        let sxx: f64 = points.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
        let sxy: f64 = points.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
        let slope = sxy / sxx;
        (points.len() >= 2 && slope.is_finite() && slope != 0.0).then(|| MarkScale {
            px_per_m: slope.abs(),
            zero_along_px: mean_y - slope * mean_x,
            sign: slope.signum(),
        })
    }

    /// Px along the ground line of the camera's axis, and the camera's place on the track, m.
    fn axis(
        &self,
        panel: &PanelAnnotation,
        index: f64,
        ground: &GroundLine,
        scale: Option<MarkScale>,
    ) -> Result<(f64, AxisOrigin), CalibrationError> {
        let centre_px = self
            .manifest
            .panels
            .iter()
            .find(|p| p.panel == panel.panel)
            .map_or([0.0, 0.0], crate::manifest::Panel::centre_px);
        let centre = ground.along_and_above(centre_px)[0];
        match &self.calibration.position {
            Position::FixedCamera => Ok((centre, AxisOrigin::At(0.0))),
            Position::EvenAdvance { .. } => Ok((centre, AxisOrigin::TrunkAt(panel.panel, index))),
            Position::FixedMark { mark } => {
                let at =
                    panel.marks.iter().find(|m| m.mark == *mark).map(|m| ground.along_and_above(m.at_px)[0]);
                let at = at.ok_or(CalibrationError::NoMark { panel: panel.panel, mark: *mark })?;
                Ok((centre, AxisOrigin::PxFromAxis(at - centre)))
            }
            Position::CameraSpacing { spacing_m, first_axis_mark } => {
                let camera_x_m = spacing_m.value * index;
                let Some((scale, spacing)) = scale.zip(self.known_length()) else {
                    return Ok((centre, AxisOrigin::At(camera_x_m)));
                };
                let forward_in_marks = scale.sign * self.facing.sign();
                let mark_m = first_axis_mark * spacing.mark_spacing_m.value + forward_in_marks * camera_x_m;
                Ok((scale.zero_along_px + scale.sign * scale.px_per_m * mark_m, AxisOrigin::At(camera_x_m)))
            }
        }
    }

    pub(crate) fn known_length(&self) -> Option<&'a KnownLength> {
        self.calibration.scale.known_length.as_ref()
    }
}

/// Where the camera stands on the track.
enum AxisOrigin {
    /// At this place, m.
    At(f64),
    /// The track's origin is seen this many px from the axis.
    PxFromAxis(f64),
    /// Where the trunk of this panel is as many even advances on as the number says.
    TrunkAt(u32, f64),
}

/// Calibrates a validated plate.
///
/// # Errors
/// When the chosen source of scale or position lacks the marks it needs, or the results are no possible camera.
pub fn calibrate(manifest: &Manifest, annotation: &Annotation) -> Result<PlateCalibration, CalibrationError> {
    let missing = |field| CalibrationError::Missing { field };
    let calibration = manifest.calibration.as_ref().ok_or(missing("calibration"))?;
    let facing = manifest.facing.ok_or(missing("facing"))?;
    let context = Context { manifest, calibration, facing, annotation };
    let scales = Scales::new(&context)?;
    let mut disagreements = scales.disagreements.clone();
    let mut stride = context.cameras(&context.stride_panels(), &scales)?;
    let standing = context.cameras(&context.standing_panels(), &scales)?;
    let timing = panel_times(&context, &stride, &scales)?;
    for (camera, time_s) in stride.iter_mut().zip(&timing.times_s) {
        camera.time_s = *time_s;
    }
    disagreements.extend(timing.disagreements);
    Ok(PlateCalibration {
        withers_height_m: withers_height(&context, [&standing, &stride], scales.relative_sd),
        stride,
        standing,
        speed_m_s: timing.speed_m_s,
        speed_source: timing.speed_source,
        interval_s: timing.interval_s,
        scale_relative_sd: scales.relative_sd,
        parallax: scales.parallax,
        disagreements,
    })
}

/// Withers height over the ground in standing panels, else in the stride's, m.
fn withers_height(
    context: &Context<'_>,
    [standing, stride]: [&[PanelCamera]; 2],
    relative_sd: f64,
) -> Option<Estimate> {
    let withers = Keypoint::Body(BodyPoint::Withers);
    let mean = |panels: Vec<&PanelAnnotation>, cameras: &[PanelCamera]| {
        let heights: Vec<f64> = panels
            .iter()
            .zip(cameras)
            .filter_map(|(panel, camera)| {
                Some(camera.world_from_plate(panel.keypoints.place(withers)?, 0.0)[1])
            })
            .collect();
        let n = heights.len() as f64;
        (n > 0.0).then(|| heights.iter().sum::<f64>() / n)
    };
    let standing = mean(context.standing_panels(), standing).map(|value| (value, 0.0));
    let moving = || mean(context.stride_panels(), stride).map(|value| (value, MOVING_WITHERS_SD));
    let (value, moving_sd) = standing.or_else(moving)?;
    Some(Estimate { value, sd: value * relative_sd.hypot(moving_sd) })
}

impl Context<'_> {
    fn cameras(
        &self,
        panels: &[&PanelAnnotation],
        scales: &Scales,
    ) -> Result<Vec<PanelCamera>, CalibrationError> {
        let first = self.annotation.stride.first;
        panels
            .iter()
            .map(|panel| self.camera(panel, f64::from(panel.panel) - f64::from(first), scales))
            .collect()
    }

    fn camera(
        &self,
        panel: &PanelAnnotation,
        index: f64,
        scales: &Scales,
    ) -> Result<PanelCamera, CalibrationError> {
        let drawn = panel.ground_px.ok_or(CalibrationError::NoGround { panel: panel.panel })?;
        let ground = GroundLine::through(drawn);
        let marks =
            self.known_length().and_then(|length| self.mark_scale(panel, length.mark_spacing_m.value));
        let ratio = scales.parallax.map_or(1.0, |p| p.value);
        let px_per_m = scales
            .of_withers
            .map(|scale| scale.at(index))
            .or(marks.map(|m| m.px_per_m * ratio))
            .ok_or(CalibrationError::TooFewMarks { panel: panel.panel })?;
        let (axis_px, origin) = self.axis(panel, index, &ground, marks)?;
        let sign = self.facing.sign();
        let camera_x_m = match origin {
            AxisOrigin::At(x_m) => x_m,
            AxisOrigin::PxFromAxis(px) => -sign * px / px_per_m,
            AxisOrigin::TrunkAt(number, panels_on) => {
                let ahead_px = scales.advance.as_ref().map_or(0.0, |advance| advance.trunk_ahead_px(number));
                let per_panel_m = scales.advance_m(px_per_m).map_or(0.0, |advance| advance.value);
                panels_on * per_panel_m - ahead_px / px_per_m
            }
        };
        let camera = &self.calibration.camera;
        let possible =
            px_per_m.is_finite() && px_per_m > 0.0 && camera_x_m.is_finite() && axis_px.is_finite();
        if !possible {
            return Err(CalibrationError::Contradiction(format!(
                "panel {}: scale {px_per_m} px/m is no possible camera; check the marks and the ground line",
                panel.panel
            )));
        }
        Ok(PanelCamera {
            panel: panel.panel,
            time_s: 0.0,
            px_per_m,
            axis_foot_px: ground.point_at(axis_px),
            forward: ground.along().map(|a| a * sign),
            up: ground.up(),
            camera_x_m,
            distance_m: camera.distance_m.value,
            height_m: camera.height_m.value,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn camera_maps_both_ways_and_shrinks_the_off_side() {
        let camera = PanelCamera {
            panel: 1,
            time_s: 0.0,
            px_per_m: 120.0,
            axis_foot_px: [300.0, 400.0],
            forward: [0.8f64.cos(), 0.8f64.sin()],
            up: [0.8f64.sin(), -0.8f64.cos()],
            camera_x_m: 2.0,
            distance_m: 12.0,
            height_m: 1.1,
        };
        for z_m in [0.0, -0.3] {
            let point = [2.7, 0.9, z_m];
            let back = camera.world_from_plate(camera.plate_from_world(point), z_m);
            assert!((0..3).all(|i| (back[i] - point[i]).abs() < 1e-12));
        }
        let size = |z_m: f64| {
            let [a, b] = [[2.0, 0.0, z_m], [2.0, 1.0, z_m]].map(|p| camera.plate_from_world(p));
            (a[0] - b[0]).hypot(a[1] - b[1])
        };
        assert!((size(0.0) - 120.0).abs() < 1e-9);
        assert!((size(-0.3) - 120.0 * 12.0 / 12.3).abs() < 1e-9);
        let foot = |z_m: f64| camera.plate_from_world([2.0, 0.0, z_m]);
        let rise =
            (foot(-0.3)[1] - foot(0.0)[1]) * camera.up[1] + (foot(-0.3)[0] - foot(0.0)[0]) * camera.up[0];
        assert!(rise > 0.0, "off hooves on the ground appear higher");
    }
}
