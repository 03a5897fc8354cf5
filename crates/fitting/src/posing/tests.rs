//! What a person would miss if posing went wrong, on plates and strides of known truth.

mod drags;
mod plates;
mod points;

use std::path::{Path, PathBuf};

use muybridge_capture::{Facing, PanelAnnotation, PanelCamera, Plate, PlateCalibration, calibrate};
use muybridge_core::Skeleton;

use super::{HandScatter, PanelPose, PanelPoser, PlacedPanel, plate_lengths};
use crate::layout::SHARED;

const SPECIMENS: [&str; 7] = ["walk", "amble", "trot", "rack", "canter", "gallop", "leap"];
const CAREFUL: HandScatter = HandScatter { visible_px: 1.0, occluded_px: 2.0 };

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// A specimen with its true cameras and points.
struct Specimen {
    plate: Plate,
    calibration: PlateCalibration,
    lengths: [f64; SHARED],
}

impl Specimen {
    fn load(gait: &str) -> Self {
        let path = repository().join(format!("plates/specimens/annotations/specimen-{gait}.json"));
        let plate = Plate::load(&path).unwrap();
        let calibration = calibrate(&plate.manifest, &plate.annotation).unwrap();
        let mut specimen = Self { plate, calibration, lengths: [0.0; SHARED] };
        let placed: Vec<PlacedPanel<'_>> = specimen
            .panels()
            .map(|(camera, panel)| PlacedPanel { camera, keypoints: &panel.keypoints })
            .collect();
        specimen.lengths = plate_lengths(&Skeleton::reference(), specimen.facing(), &placed);
        specimen
    }

    fn facing(&self) -> Facing {
        self.plate.facing
    }

    fn panels(&self) -> impl Iterator<Item = (&PanelCamera, &PanelAnnotation)> {
        self.calibration.stride.iter().map(|camera| {
            (camera, self.plate.annotation.panels.iter().find(|p| p.panel == camera.panel).unwrap())
        })
    }

    fn poser(&self, camera: &PanelCamera, panel: &PanelAnnotation) -> PanelPoser {
        PanelPoser::new(&Skeleton::reference(), self.facing(), &self.lengths, *camera, &panel.contacts)
    }

    /// A poser and the pose through all points of each panel.
    fn posed(&self) -> Vec<(PanelPoser, PanelPose)> {
        let pose = |(camera, panel): (&PanelCamera, &PanelAnnotation)| {
            let poser = self.poser(camera, panel);
            let pose = poser.pose_from_points(&panel.keypoints, CAREFUL, None);
            (poser, pose)
        };
        self.panels().map(pose).collect()
    }
}

fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    (ax - bx).hypot(ay - by)
}

fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values
}

/// The value that a share of the values lies below.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    sorted[((sorted.len() - 1) as f64 * share).round() as usize]
}

fn assert_within_limits(poser: &PanelPoser, pose: &PanelPose) {
    for (value, [low, high]) in pose.iter().zip(poser.bounds()) {
        assert!((low..=high).contains(value), "{value} beyond {low} to {high}");
    }
}
