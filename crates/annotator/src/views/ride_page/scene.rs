//! The horse in three dimensions on its ground, with what is drawn around it.

use egui::{Align2, Color32, FontId, Painter, Pos2, Stroke, Ui, vec2};
use glam::Vec3;
use muybridge_core::{Joints, Limb, Side, bone};
use muybridge_imaging::figure::{Terrain as DrawnTerrain, Trace};

use super::command_button;
use crate::app::PageContext;
use crate::colors;
use crate::command::Command;
use crate::figure::{FigureColors, FigurePose, FigureView, Follow, NamedView, SceneParts};
use crate::ride::record::RiderFrame;
use crate::ride::terrain::Terrain;
use crate::ride::{RideSession, Which, moved_over};
use crate::session::Session;

/// The cameras in the order in which they follow one another.
const CAMERAS: [(NamedView, &str); 4] = [
    (NamedView::Side, "Side"),
    (NamedView::ThreeQuarter, "Three-quarter"),
    (NamedView::Front, "Front"),
    (NamedView::Follow, "Follow"),
];
/// Against a figure that fills its box: room for the way ahead and for the photographs.
const ROOM: f32 = 0.78;
/// Hoof traces are so long, s.
const TRACE_S: f64 = 2.0;
/// Lines of the ground are this far apart, metres.
const GRID_M: f32 = 1.0;
/// The camera's height follows the mean height of so much ground before and behind the horse, metres: stairs do not shake it.
const LEVELLED_M: f32 = 1.5;
/// Horses farther apart than this do not fit into one picture, metres.
const TOGETHER_M: f32 = 6.0;
/// The follow camera's height as an angle, radians: so low that the horizon is seen.
const FOLLOW_PITCH: f32 = 0.27;
/// The name of a horse is so far above its poll, metres.
const NAME_ABOVE_M: f32 = 0.45;
/// Near and off legs: orange and blue as on the plates' pages, muted towards the bay of the trunk.
const NEAR: [u8; 3] = [222, 138, 62];
const OFF: [u8; 3] = [78, 132, 196];
const BAY: [u8; 3] = [166, 110, 68];
/// Traces of hooves, left and right.
const TRACES: [[u8; 3]; 2] = [[70, 165, 255], [255, 150, 30]];

/// How the ride is looked at.
pub(super) struct View {
    figure: FigureView,
    camera: usize,
    traces: bool,
    polygon: bool,
    body: bool,
    skeleton: bool,
    joints: bool,
    /// Whether horse B is drawn within A.
    pub(super) second_as_ghost: bool,
    /// Whether the photographs of the open plate are shown beside the horse.
    pub(super) photographs: bool,
    /// The ground drawn last, and how many there were before it.
    ground: (Terrain, u64),
}

impl Default for View {
    fn default() -> Self {
        let mut view = Self {
            figure: FigureView::new(Side::Right),
            camera: 0,
            traces: true,
            polygon: true,
            body: true,
            skeleton: false,
            joints: false,
            second_as_ghost: false,
            photographs: true,
            ground: (Terrain::default(), 0),
        };
        // The page has its own, which say their key.
        view.figure.buttons = false;
        view.look(1);
        view
    }
}

impl View {
    /// The camera after this one.
    pub(super) fn next_camera(&mut self) {
        self.look((self.camera + 1) % CAMERAS.len());
    }

    fn look(&mut self, camera: usize) {
        self.camera = camera;
        self.figure.look(CAMERAS[camera].0);
        self.figure.zoom *= ROOM;
        if CAMERAS[camera].0 == NamedView::Follow {
            self.figure.pitch = FOLLOW_PITCH;
        }
    }

    /// A number that changes with the ground.
    fn ground_version(&mut self, terrain: Terrain) -> u64 {
        if self.ground.0 != terrain {
            self.ground = (terrain, self.ground.1 + 1);
        }
        self.ground.1
    }

    /// A horse as it is to be drawn: as a body, as a skeleton, or both.
    fn figures(&self, joints: Joints, standing: [bool; 4], is_ghost: bool) -> Vec<FigurePose> {
        let is_body = self.body && !is_ghost;
        let figure = FigurePose { joints, standing, ghost: !is_body };
        let sticks = FigurePose { standing: [false; 4], ghost: true, ..figure };
        [Some(figure), (is_body && self.skeleton).then_some(sticks)].into_iter().flatten().collect()
    }
}

/// The view over all the space there is.
pub(super) fn show(ui: &mut Ui, ride: &RideSession, view: &mut View) {
    let size = ui.available_size();
    let frame = ride.shown();
    let (Some(first), Some(rider)) = (ride.joints(Which::A), &frame.riders[0]) else { return };
    let mut figures = view.figures(first, rider.readout.on_ground, false);
    let second = ride.joints(Which::B).map(|b| if view.second_as_ghost { moved_over(&b, &first) } else { b });
    if let (Some(joints), Some(rider)) = (second, &frame.riders[1]) {
        figures.extend(view.figures(joints, rider.readout.on_ground, view.second_as_ghost));
    }
    let ways = ways(view, ride);
    let traces: Vec<Trace<'_>> = ways.iter().map(|(points, color)| Trace { points, color: *color }).collect();
    let terrain = frame.terrain;
    let height = |x: f32, z: f32| terrain.height_m(x, z);
    let beside = second.filter(|_| !view.second_as_ghost);
    let Some(follow) = follow(ride, rider, [Some(first), beside], &terrain) else { return };
    let parts = SceneParts {
        figures: &figures,
        tubes: &[],
        decals: &[],
        terrain: if terrain.is_plain() { DrawnTerrain::Flat } else { DrawnTerrain::Height(&height) },
        terrain_version: view.ground_version(terrain),
        grid_m: GRID_M,
        traces: &traces,
        support_polygon: view.polygon,
        colors: &scene_colors(ui.visuals().dark_mode),
        follow,
    };
    let rect = view.figure.ui_scene(ui, size, &parts).rect;
    let Some(camera) = view.figure.camera() else { return };
    let painter = ui.painter_at(rect);
    let screen = |at: Vec3| camera.project(at).map(|at| rect.min + vec2(at.x, at.y));
    for joints in [Some(first), second].into_iter().flatten().filter(|_| view.joints) {
        draw_joints(&painter, &joints, screen);
    }
    for (which, joints) in [(Which::A, Some(first)), (Which::B, beside)] {
        if let (Some(joints), true) = (joints, beside.is_some()) {
            let above = joints.tips[bone::NECK_LAST] + Vec3::Y * NAME_ABOVE_M;
            name(&painter, which.name(), screen(above));
        }
    }
}

/// A dot on each joint, seen through the body.
fn draw_joints(painter: &Painter, joints: &Joints, screen: impl Fn(Vec3) -> Option<Pos2>) {
    let places = joints.bases.iter().chain(&joints.tips).chain([&joints.dock]);
    for at in places.filter_map(|at| screen(*at)) {
        painter.circle(at, 3.0, colors::TRUNK, Stroke::new(1.0, Color32::from_black_alpha(180)));
    }
}

/// The name of a horse.
fn name(painter: &Painter, text: &str, at: Option<Pos2>) {
    let Some(at) = at else { return };
    painter.circle_filled(at, 11.0, Color32::from_black_alpha(150));
    painter.text(at, Align2::CENTER_CENTER, text, FontId::proportional(14.0), Color32::WHITE);
}

/// Whom the camera follows: horse A, or the middle between the two, over the ground around it.
fn follow(
    ride: &RideSession,
    rider: &RiderFrame,
    joints: [Option<Joints>; 2],
    terrain: &Terrain,
) -> Option<Follow> {
    let heading_rad = ride.heading_rad(Which::A)? as f32;
    let figure = |joints| FigurePose { joints, standing: rider.readout.on_ground, ghost: false };
    let of = |joints: Joints| Follow::figure(&figure(joints), 0.0, heading_rad);
    let mut follow = of(joints[0]?)?;
    if let Some(second) = joints[1].and_then(of).filter(|second| second.at.distance(follow.at) < TOGETHER_M) {
        follow.at = (follow.at + second.at) / 2.0;
    }
    let ahead = Vec3::new(heading_rad.cos(), 0.0, -heading_rad.sin());
    let samples = [-1.0, -0.75, -0.5, -0.25, 0.0, 0.25, 0.5, 0.75, 1.0];
    let heights = samples.map(|share| {
        let at = follow.at + ahead * (share * LEVELLED_M);
        terrain.height_m(at.x, at.z)
    });
    let ground_m = heights.iter().sum::<f32>() / heights.len() as f32;
    Some(Follow { at: follow.at.with_y(ground_m), ..follow })
}

/// The ways of the hooves.
fn ways(view: &View, ride: &RideSession) -> Vec<(Vec<Vec3>, [u8; 3])> {
    if !view.traces {
        return Vec::new();
    }
    let second = !view.second_as_ghost && ride.shown().riders[1].is_some();
    let horses = [Some(Which::A), second.then_some(Which::B)];
    let each = horses.into_iter().flatten().flat_map(|which| Limb::ALL.map(|limb| (which, limb)));
    let color = |limb: Limb| TRACES[usize::from(limb.side() == Side::Right)];
    each.map(|(which, limb)| (ride.trace(which, limb, TRACE_S), color(limb))).collect()
}

/// A scene that suits the window.
pub(in crate::views) fn scene_colors(is_dark: bool) -> FigureColors {
    let (ground, sky) =
        if is_dark { ([104, 100, 92], [44, 52, 62, 255]) } else { ([200, 184, 154], [214, 225, 235, 255]) };
    FigureColors { near: NEAR, off: OFF, trunk: BAY, ground, sky: Some(sky) }
}

/// Cameras, and what is drawn.
pub(super) fn controls(ui: &mut Ui, view: &mut View, plate: Option<&Session>, page: &mut PageContext<'_>) {
    ui.horizontal(|ui| {
        for (camera, (_, name)) in CAMERAS.iter().enumerate() {
            let button = egui::Button::selectable(view.camera == camera, *name).frame_when_inactive(true);
            if ui.add(button).on_hover_text(super::with_key(page, Command::RideCamera)).clicked() {
                view.look(camera);
            }
        }
        command_button(ui, page, Command::RideCamera, "Next", false);
    });
    ui.horizontal_wrapped(|ui| {
        let mut toggle = |on: &mut bool, name: &str, hover: &str| {
            ui.checkbox(on, name).on_hover_text(hover);
        };
        toggle(&mut view.body, "Body", "Otherwise the skeleton alone");
        toggle(&mut view.skeleton, "Skeleton", "The bones within the body");
        toggle(&mut view.joints, "Joints", "A dot on each joint");
        toggle(&mut view.traces, "Hoof traces", "Where each toe was in the last two seconds");
        toggle(&mut view.polygon, "Support", "The polygon between the hooves that stand");
    });
    let photographs = ui.add_enabled(
        plate.is_some(),
        egui::Checkbox::new(&mut view.photographs, "Photographs of the open plate"),
    );
    photographs
        .on_hover_text("The photograph nearest in phase, beside the horse from the same side")
        .on_disabled_hover_text("Open a plate to compare the horse with its photographs");
}
