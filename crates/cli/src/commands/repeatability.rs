//! How far apart two passes over the same plate place the same points.

use std::fmt;

use muybridge_capture::{Annotation, Keypoint, KeypointState, Placed, PlateCalibration};
use muybridge_fitting::held_out::quantile;
use muybridge_fitting::stride_fit::rms;

/// Distances between two passes.
pub(super) struct Repeatability {
    points: Vec<Pair>,
    withers_height_m: f64,
}

struct Pair {
    panel: u32,
    keypoint: Keypoint,
    /// Seen in both passes.
    visible: bool,
    px: f64,
    metres: f64,
}

impl Repeatability {
    /// Compares all points placed in both passes; none when there are none, or the plate's withers height is unknown.
    pub(super) fn new(
        first: &Annotation,
        second: &Annotation,
        calibration: &PlateCalibration,
    ) -> Option<Self> {
        let mut points = Vec::new();
        for panel in &first.panels {
            let cameras = calibration.stride.iter().chain(&calibration.standing);
            let Some(camera) = cameras.into_iter().find(|camera| camera.panel == panel.panel) else {
                continue;
            };
            let Some(other) = second.panels.iter().find(|p| p.panel == panel.panel) else { continue };
            for (keypoint, placed) in panel.keypoints.iter() {
                let again = other.keypoints.get(keypoint);
                let places = placed.place().zip(again.and_then(Placed::place));
                let Some(([ax, ay], [bx, by])) = places else { continue };
                let px = (ax - bx).hypot(ay - by);
                let visible =
                    [Some(placed), again].iter().flatten().all(|p| p.state == KeypointState::Visible);
                points.push(Pair { panel: panel.panel, keypoint, visible, px, metres: px / camera.px_per_m });
            }
        }
        (!points.is_empty()).then_some(Self { points, withers_height_m: calibration.withers_height_m?.value })
    }
}

impl fmt::Display for Repeatability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, visible) in [("visible in both", true), ("guessed in one or both", false)] {
            let group: Vec<&Pair> = self.points.iter().filter(|p| p.visible == visible).collect();
            let px: Vec<f64> = group.iter().map(|p| p.px).collect();
            let percent: Vec<f64> = group.iter().map(|p| 100.0 * p.metres / self.withers_height_m).collect();
            // Two passes scatter twice as much in variance as one, and a distance has two coordinates.
            let one_coordinate = rms(px.iter().copied()) / 2.0;
            writeln!(
                f,
                "{name}: {} points; distance median {:.1} px ({:.1} % of withers height), 90th percentile {:.1} px ({:.1} %); \
                 sd of one coordinate of one pass {one_coordinate:.1} px",
                group.len(),
                quantile(&px, 0.5),
                quantile(&percent, 0.5),
                quantile(&px, 0.9),
                quantile(&percent, 0.9),
            )?;
        }
        let mut worst: Vec<&Pair> = self.points.iter().collect();
        worst.sort_by(|a, b| b.px.total_cmp(&a.px));
        let named: Vec<String> =
            worst.iter().take(5).map(|p| format!("{} in {} ({:.1} px)", p.keypoint, p.panel, p.px)).collect();
        writeln!(f, "farthest apart: {}", named.join(", "))
    }
}
