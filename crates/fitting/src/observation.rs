//! What the fit sees: placed points through each panel's camera, contact labels and times.

use muybridge_capture::{
    BodyPoint, Facing, KEYPOINT_COUNT, Keypoint, KeypointState, NearOff, PanelCamera, Plate,
    PlateCalibration, StanceLabel,
};
use muybridge_core::{Limb, Side};

use crate::chain::{Attachment, Chain};
use crate::weights::Weights;

/// One placed point.
#[derive(Clone, Debug, PartialEq)]
pub struct PointObservation {
    /// Its type.
    pub keypoint: Keypoint,
    /// Where the person put it, plate px.
    pub at_px: [f64; 2],
    /// Standard deviation of a coordinate, px, the landmark's included.
    pub sd_px: f64,
    /// Whether it was seen or guessed.
    pub state: KeypointState,
}

/// One panel.
#[derive(Clone, Debug, PartialEq)]
pub struct PanelObservation {
    /// Its camera and time.
    pub camera: PanelCamera,
    /// The points.
    pub points: Vec<PointObservation>,
    /// Contact label of each leg, in the order of [`Limb::ALL`].
    pub contacts: [StanceLabel; 4],
}

/// All panels of a stride, in order of time.
#[derive(Clone, Debug, PartialEq)]
pub struct StrideObservation {
    /// Which side is near.
    pub facing: Facing,
    /// Mean speed, m/s.
    pub speed_m_s: f64,
    /// Withers height, m, where the pictures tell it: the size the animal's bones are drawn to.
    pub withers_height_m: Option<f64>,
    /// The panels.
    pub panels: Vec<PanelObservation>,
}

/// Where a keypoint sits on the skeleton.
pub fn attachment(keypoint: Keypoint, facing: Facing) -> Attachment {
    match (keypoint, keypoint.bone(facing)) {
        (Keypoint::Body(BodyPoint::Dock), _) => Attachment::Dock,
        (_, Some(bone)) => Attachment::Tip(bone),
        (_, None) => Attachment::Root,
    }
}

/// Distance of a point of the skeleton towards the camera from the near hooves' plane, m (negative: behind it).
pub fn depth_m(chain: &Chain, point: Attachment, facing: Facing) -> f64 {
    let towards_right = match facing.side(NearOff::Near) {
        Side::Right => 1.0,
        Side::Left => -1.0,
    };
    let lateral = match point {
        Attachment::Tip(bone) => chain.lateral_m[bone] * towards_right,
        Attachment::Root | Attachment::Dock => 0.0,
    };
    lateral - chain.lateral_m[Limb::RF.hoof_bone()].abs()
}

impl StrideObservation {
    /// Collects a plate's stride panels.
    pub fn new(plate: &Plate, calibration: &PlateCalibration, weights: &Weights) -> Self {
        let annotation = &plate.annotation;
        let facing = plate.facing;
        let panels = calibration
            .stride
            .iter()
            .filter_map(|camera| {
                let panel = annotation.panels.iter().find(|p| p.panel == camera.panel)?;
                let points = Keypoint::all().filter_map(|keypoint| {
                    let placed = panel.keypoints.get(keypoint)?;
                    let of_state = match placed.state {
                        KeypointState::Visible => annotation.visible_sd_px,
                        KeypointState::Occluded | KeypointState::Absent => annotation.occluded_sd_px,
                    };
                    let hand_sd_px = placed.sd_px.unwrap_or(of_state);
                    Some(PointObservation {
                        keypoint,
                        at_px: placed.place()?,
                        sd_px: hand_sd_px.hypot(weights.landmark_sd_m * camera.px_per_m),
                        state: placed.state,
                    })
                });
                let contacts =
                    Limb::ALL.map(|limb| panel.contacts.of(facing.near_off(limb.side()), limb.pair()));
                Some(PanelObservation { camera: *camera, points: points.collect(), contacts })
            })
            .collect();
        let withers_height_m = calibration.withers_height_m.map(|height| height.value);
        Self { facing, speed_m_s: calibration.speed_m_s.value, withers_height_m, panels }
    }

    /// Seconds from the first to the last panel.
    pub fn duration_s(&self) -> f64 {
        match (self.panels.first(), self.panels.last()) {
            (Some(first), Some(last)) => last.camera.time_s - first.camera.time_s,
            _ => 0.0,
        }
    }

    /// The same stride without one keypoint type.
    pub fn without(&self, keypoint: Keypoint) -> Self {
        let mut left = self.clone();
        for panel in &mut left.panels {
            panel.points.retain(|point| point.keypoint != keypoint);
        }
        left
    }

    /// How often each keypoint type is placed.
    pub fn counts(&self) -> [usize; KEYPOINT_COUNT] {
        let mut counts = [0; KEYPOINT_COUNT];
        for point in self.panels.iter().flat_map(|panel| &panel.points) {
            counts[point.keypoint.index()] += 1;
        }
        counts
    }
}
