//! What is on a specimen: every joint, contact, panel and line.

use muybridge_capture::{
    BodyPoint, Facing, Keypoint, KeypointState, Keypoints, LegContacts, LimbJoint, NearOff, PanelCamera,
    Placed, PlacedBy, StanceLabel,
};
use muybridge_core::{Gait, Pair};
use serde::{Deserialize, Serialize};

use super::layout::{Layout, PanelLayout};
use super::limb::Viewer;
use super::paint::Part;
use super::photograph::Photograph;
use super::print::printed;
use super::raster::Point;
use super::scene::Scene;
use super::style::SpecimenStyle;
use super::{Hurdle, PosedHorse, SpecimenMotion};

/// Schema version of a truth file.
pub const SPECIMEN_SCHEMA: u32 = 1;
/// Says what the picture is, in the file.
const STATEMENT: &str = "This plate is a drawing made by a program from a known motion, for tests and lessons. It is not a photograph.";

/// The truth of a specimen.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SpecimenTruth {
    /// [`SPECIMEN_SCHEMA`].
    pub schema: u32,
    /// That the plate is a drawing.
    pub statement: String,
    /// Lines of print on the mount.
    pub printed: Vec<String>,
    /// Width and height of the picture, px.
    pub size_px: [u32; 2],
    /// The gait.
    pub gait: Gait,
    /// Which way the horse faces.
    pub facing: Facing,
    /// Height of the withers when it stands, m.
    pub withers_height_m: f64,
    /// Mean speed, m/s.
    pub speed_m_s: f64,
    /// Panels after which the movement repeats.
    pub closes_after_panels: Option<f64>,
    /// Distance between neighbouring cameras, m.
    pub camera_spacing_m: f64,
    /// The obstacle of a leap.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hurdle: Option<Hurdle>,
    /// How the plate was drawn.
    pub style: SpecimenStyle,
    /// The panels in order of time.
    pub panels: Vec<PanelTruth>,
}

/// The truth of a panel; places in plate px, to a hundredth but for the camera's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PanelTruth {
    /// Corners of the photograph: top left, top right, bottom right, bottom left.
    pub quad_px: [[f64; 2]; 4],
    /// Its camera, with the panel's number and time.
    #[serde(with = "CameraNumbers")]
    pub camera: PanelCamera,
    /// What each leg does.
    pub contacts: LegContacts,
    /// Two points on the ground line under the near hooves, left to right, at the panel's edges.
    pub ground_px: [[f64; 2]; 2],
    /// The line where the wall meets the track, left to right.
    pub wall_foot_px: Option<[[f64; 2]; 2]>,
    /// The uprights that are seen, in order of their numbers.
    pub uprights: Vec<UprightTruth>,
    /// The fine horizontal lines of the wall, from the lowest up, left to right.
    pub grid_lines_px: Vec<[[f64; 2]; 2]>,
    /// All 26 points; occluded where something is drawn in front.
    pub keypoints: Keypoints,
}

/// A numbered upright of the wall.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct UprightTruth {
    /// Its number; neighbours differ by 1.
    pub mark: f64,
    /// Foot and top as far as they are in the panel, plate px.
    pub ends_px: [[f64; 2]; 2],
}

/// How a camera is written.
#[derive(Serialize, Deserialize)]
#[serde(remote = "PanelCamera", deny_unknown_fields)]
struct CameraNumbers {
    panel: u32,
    time_s: f64,
    px_per_m: f64,
    axis_foot_px: [f64; 2],
    forward: [f64; 2],
    up: [f64; 2],
    camera_x_m: f64,
    distance_m: f64,
    height_m: f64,
}

impl SpecimenTruth {
    pub(super) fn new(
        layout: &Layout,
        motion: &SpecimenMotion,
        style: &SpecimenStyle,
        panels: Vec<PanelTruth>,
    ) -> Self {
        Self {
            schema: SPECIMEN_SCHEMA,
            statement: STATEMENT.to_string(),
            printed: printed(motion, style),
            size_px: layout.size_px,
            gait: motion.gait,
            facing: motion.facing,
            withers_height_m: motion.withers_height_m,
            speed_m_s: motion.speed_m_s,
            closes_after_panels: motion.closes_after_panels,
            camera_spacing_m: layout.camera_spacing_m,
            hurdle: motion.hurdle.map(|hurdle| Hurdle { x_m: hurdle.x_m - layout.origin_x_m, ..hurdle }),
            style: style.clone(),
            panels,
        }
    }
}

pub(super) fn panel_truth(
    panel: &PanelLayout,
    pose: &PosedHorse,
    motion: &SpecimenMotion,
    style: &SpecimenStyle,
    photograph: &Photograph,
) -> PanelTruth {
    let view = Viewer::new(&panel.camera, motion.withers_height_m);
    let scene = Scene { panel, style, view: &view };
    let mut keypoints = Keypoints::default();
    for keypoint in Keypoint::all() {
        let exact = panel.camera.plate_from_world(place(keypoint, pose, motion.facing));
        let hidden = photograph.hides(part(keypoint), exact);
        let state = if hidden { KeypointState::Occluded } else { KeypointState::Visible };
        let at_px = Some(hundredths(exact));
        keypoints.insert(keypoint, Placed { at_px, state, by: PlacedBy::Fitted, sd_px: None });
    }
    let line = |ends: [Point; 2]| ends.map(hundredths);
    let uprights = scene.uprights().into_iter();
    PanelTruth {
        quad_px: panel.quad_px.map(hundredths),
        camera: panel.camera,
        contacts: contacts(pose, motion.facing),
        ground_px: line(ground_line(panel)),
        wall_foot_px: scene.level(0.0).map(line),
        uprights: uprights
            .map(|upright| UprightTruth { mark: upright.mark, ends_px: line(upright.ends_px) })
            .collect(),
        grid_lines_px: scene.grid_lines().into_iter().map(line).collect(),
        keypoints,
    }
}

/// A point to a hundredth of a px.
fn hundredths(at_px: Point) -> Point {
    at_px.map(|v| (100.0 * v).round() / 100.0)
}

/// Where a keypoint is, m.
fn place(keypoint: Keypoint, pose: &PosedHorse, facing: Facing) -> [f64; 3] {
    match (keypoint, keypoint.bone(facing)) {
        (Keypoint::Body(BodyPoint::Dock), _) => pose.dock,
        (_, Some(bone)) => pose.tip(bone),
        (_, None) => pose.croup,
    }
}

/// The layer a keypoint lies on. Hip and shoulder of the near side lie on the trunk.
fn part(keypoint: Keypoint) -> Part {
    match keypoint {
        Keypoint::Body(_) | Keypoint::Limb(NearOff::Near, _, LimbJoint::Root | LimbJoint::Upper) => {
            Part::NearFore
        }
        Keypoint::Limb(NearOff::Near, Pair::Fore, _) => Part::NearFore,
        Keypoint::Limb(NearOff::Near, Pair::Hind, _) => Part::NearHind,
        Keypoint::Limb(NearOff::Off, Pair::Fore, _) => Part::OffFore,
        Keypoint::Limb(NearOff::Off, Pair::Hind, _) => Part::OffHind,
    }
}

fn contacts(pose: &PosedHorse, facing: Facing) -> LegContacts {
    let label = |side, pair| {
        if pose.down[facing.limb(side, pair).index()] { StanceLabel::Stance } else { StanceLabel::Swing }
    };
    LegContacts {
        near_fore: label(NearOff::Near, Pair::Fore),
        off_fore: label(NearOff::Off, Pair::Fore),
        near_hind: label(NearOff::Near, Pair::Hind),
        off_hind: label(NearOff::Off, Pair::Hind),
    }
}

/// The ground line at the panel's edges, the left end first.
fn ground_line(panel: &PanelLayout) -> [Point; 2] {
    let camera = &panel.camera;
    let at = |x_m: f64| camera.plate_from_world([camera.camera_x_m + x_m, 0.0, 0.0]);
    let ends = [at(-1000.0), at(1000.0)];
    let [a, b] = panel.clip(ends).unwrap_or([at(-1.0), at(1.0)]);
    if a[0] <= b[0] { [a, b] } else { [b, a] }
}
