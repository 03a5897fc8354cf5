//! How far apart two passes over the same plate place the same points.

use std::fmt;

use muybridge_capture::{Annotation, Keypoint, KeypointState, Placed, PlateCalibration};

use crate::held_out::quantile;
use crate::stride_fit::rms;

/// Distances between two passes.
#[derive(Clone, Debug, PartialEq)]
pub struct Repeatability {
    /// Every point placed in both passes, panel by panel.
    pub points: Vec<PointDistance>,
    /// Withers height that percentages refer to, m.
    pub withers_height_m: f64,
}

/// How far apart a point was placed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointDistance {
    /// Panel number.
    pub panel: u32,
    /// Keypoint.
    pub keypoint: Keypoint,
    /// Whether it was called visible in both passes.
    pub visible: bool,
    /// Distance, px.
    pub px: f64,
    /// Distance in the near legs' plane, m.
    pub metres: f64,
}

/// The distances of one keypoint type.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KeypointRepeatability {
    /// Keypoint.
    pub keypoint: Keypoint,
    /// Panels in which both passes placed it.
    pub count: usize,
    /// Median distance, px.
    pub median_px: f64,
    /// Median distance, cm.
    pub median_cm: f64,
}

impl Repeatability {
    /// Compares all points placed in both passes; none when there are none, or when neither a standing panel nor the
    /// stride shows the withers.
    pub fn new(first: &Annotation, second: &Annotation, calibration: &PlateCalibration) -> Option<Self> {
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
                let metres = px / camera.px_per_m;
                points.push(PointDistance { panel: panel.panel, keypoint, visible, px, metres });
            }
        }
        let withers_height_m = calibration.withers_height_m?.value;
        (!points.is_empty()).then_some(Self { points, withers_height_m })
    }

    /// Standard deviation of one coordinate of one pass, px, of points visible in both passes or of the others; none
    /// without such points. Two passes scatter twice as much in variance as one, and a distance has two coordinates.
    pub fn sd_px(&self, visible: bool) -> Option<f64> {
        let px: Vec<f64> = self.points.iter().filter(|p| p.visible == visible).map(|p| p.px).collect();
        (!px.is_empty()).then(|| rms(px.into_iter()) / 2.0)
    }

    /// One entry per keypoint type that both passes placed, in the fixed order.
    pub fn by_keypoint(&self) -> Vec<KeypointRepeatability> {
        let of_type = |keypoint: Keypoint| {
            let points = self.points.iter().filter(|p| p.keypoint == keypoint);
            let (px, cm): (Vec<f64>, Vec<f64>) = points.map(|p| (p.px, 100.0 * p.metres)).unzip();
            let count = px.len();
            (count > 0).then(|| KeypointRepeatability {
                keypoint,
                count,
                median_px: quantile(&px, 0.5),
                median_cm: quantile(&cm, 0.5),
            })
        };
        Keypoint::all().filter_map(of_type).collect()
    }
}

impl fmt::Display for Repeatability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (name, visible) in [("visible in both", true), ("guessed in one or both", false)] {
            let group: Vec<&PointDistance> = self.points.iter().filter(|p| p.visible == visible).collect();
            let px: Vec<f64> = group.iter().map(|p| p.px).collect();
            let percent: Vec<f64> = group.iter().map(|p| 100.0 * p.metres / self.withers_height_m).collect();
            let one_coordinate = self.sd_px(visible).unwrap_or(0.0);
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
        let mut worst: Vec<&PointDistance> = self.points.iter().collect();
        worst.sort_by(|a, b| b.px.total_cmp(&a.px));
        let named: Vec<String> =
            worst.iter().take(5).map(|p| format!("{} in {} ({:.1} px)", p.keypoint, p.panel, p.px)).collect();
        writeln!(f, "farthest apart: {}", named.join(", "))
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use muybridge_capture::{ANNOTATION_SCHEMA, Plate, calibrate, read_json};

    use super::*;

    #[test]
    fn two_passes_over_the_plate_of_1878_are_compared_joint_by_joint() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../annotations");
        let first = Plate::load(&folder.join("sallie-gardner-1878.json")).unwrap();
        let second: Annotation =
            read_json(&folder.join("second-pass/sallie-gardner-1878.json"), ANNOTATION_SCHEMA).unwrap();
        let calibration = calibrate(&first.manifest, &first.annotation).unwrap();
        let compared = Repeatability::new(&first.annotation, &second, &calibration).unwrap();
        let types = compared.by_keypoint();
        assert_eq!(types.len(), 26);
        assert_eq!(types.iter().map(|t| t.count).sum::<usize>(), compared.points.len());
        for of_type in types {
            assert!(of_type.count <= 4, "four panels were placed twice");
            let scale = 100.0 * of_type.median_px / of_type.median_cm;
            assert!(of_type.median_px < 12.0 && (100.0..150.0).contains(&scale), "{of_type:?}");
        }
        let same = Repeatability::new(&first.annotation, &first.annotation, &calibration).unwrap();
        assert!(same.by_keypoint().iter().all(|t| t.median_px == 0.0));
    }
}
