//! A specimen's manifest and annotation, so that it goes through everything a real plate goes through.

use muybridge_capture::{
    ANNOTATION_SCHEMA, Annotation, Calibration, Camera, Known, KnownLength, MANIFEST_SCHEMA, Manifest, Mark,
    Panel, PanelAnnotation, PanelUse, Parallax, Plane, PlateImage, Position, Scale, ScaleSource, StrideSpan,
    Time, TimeSource,
};

use super::NOTICE;
use super::truth::{PanelTruth, SpecimenTruth};

/// Coordinates of the truth are rounded to a hundredth: the standard deviation of a placed point, px. Validation wants more
/// than nothing.
const PLACED_SD_PX: f64 = 0.01;

fn exact(value: f64) -> Known {
    Known { value, sd: 0.0, assumed: false, from: "the truth of a drawn specimen".to_string() }
}

impl SpecimenTruth {
    /// What is known of the plate, exactly, when its picture is kept as `file` (relative to the manifest) with this SHA-256
    /// (lower-case hexadecimal).
    pub fn manifest(&self, id: &str, file: &str, sha256: &str) -> Manifest {
        let [width_px, height_px] = self.size_px;
        Manifest {
            schema: MANIFEST_SCHEMA,
            id: id.to_string(),
            catalogue_number: None,
            title: format!("Specimen: {}", self.gait),
            animal: "none: a drawing".to_string(),
            gait: self.gait,
            date: "none: a drawing".to_string(),
            source: format!("drawn by this program with seed {}. {NOTICE}", self.style.seed),
            holder: "none".to_string(),
            licence: "as this program".to_string(),
            printed: self.printed.clone(),
            facing: Some(self.facing),
            images: vec![PlateImage {
                file: file.to_string(),
                sha256: sha256.to_string(),
                width_px,
                height_px,
            }],
            panels: self
                .panels
                .iter()
                .map(|panel| Panel { panel: panel.camera.panel, image: 0, quad_px: panel.quad_px })
                .collect(),
            calibration: Some(self.calibration()),
        }
    }

    fn calibration(&self) -> Calibration {
        let style = &self.style;
        let interval_s = match (self.panels.first(), self.panels.last()) {
            (Some(first), Some(last)) if self.panels.len() > 1 => {
                (last.camera.time_s - first.camera.time_s) / (self.panels.len() - 1) as f64
            }
            _ => f64::NAN,
        };
        Calibration {
            scale: Scale {
                driven_by: ScaleSource::KnownLength,
                known_length: Some(KnownLength {
                    mark_spacing_m: exact(style.upright_spacing_m),
                    plane: Plane::Wall(Parallax::Distances {
                        camera_to_track_m: style.camera_distance_m,
                        camera_to_wall_m: style.camera_distance_m + style.wall_distance_m,
                    }),
                }),
                withers_height_m: None,
            },
            position: Position::CameraSpacing {
                spacing_m: exact(self.camera_spacing_m),
                first_axis_mark: style.first_axis_mark,
            },
            time: Time {
                driven_by: TimeSource::Interval,
                interval_s: Some(exact(interval_s)),
                intervals_s: self.uneven_intervals_s(interval_s),
                speed_m_s: None,
                stride_time_s: None,
            },
            camera: Camera {
                distance_m: exact(style.camera_distance_m),
                height_m: exact(style.camera_height_m),
            },
        }
    }

    /// Every interval, when they differ by more than a microsecond.
    fn uneven_intervals_s(&self, mean_s: f64) -> Option<Vec<f64>> {
        let intervals: Vec<f64> =
            self.panels.windows(2).map(|two| two[1].camera.time_s - two[0].camera.time_s).collect();
        intervals.iter().any(|interval| (interval - mean_s).abs() > 1e-6).then_some(intervals)
    }

    /// The truth as if a person had placed it, for the manifest at `plate` (a path relative to the annotation) whose picture
    /// has this SHA-256.
    pub fn annotation(&self, plate: &str, sha256: &str) -> Annotation {
        Annotation {
            schema: ANNOTATION_SCHEMA,
            plate: plate.to_string(),
            images_sha256: vec![sha256.to_string()],
            annotator: "the truth of a drawn specimen".to_string(),
            visible_sd_px: PLACED_SD_PX,
            occluded_sd_px: PLACED_SD_PX,
            gait: None,
            stride: StrideSpan {
                first: 1,
                last: self.panels.len() as u32,
                closes_after_panels: self.closes_after_panels,
            },
            notes: vec![self.statement.clone()],
            panels: self.panels.iter().map(annotated).collect(),
            instants: Vec::new(),
        }
    }
}

fn annotated(panel: &PanelTruth) -> PanelAnnotation {
    PanelAnnotation {
        panel: panel.camera.panel,
        usage: PanelUse::Stride,
        ground_px: Some(panel.ground_px),
        marks: panel
            .uprights
            .iter()
            .map(|upright| Mark { mark: upright.mark, at_px: upright.ends_px[0] })
            .collect(),
        contacts: panel.contacts,
        keypoints: panel.keypoints.clone(),
    }
}
