//! The figure in three dimensions on its ground, with its prints and the way of its centre of mass.

use egui::{Color32, Ui};
use glam::{DVec3, Vec3};
use muybridge_core::{Side, bone};
use muybridge_footprints::{
    BipedPose, Character, Figure, Foot, Model, Motion, Print, Terrain, Tube as WalkerTube, tubes,
};
use muybridge_imaging::figure::{Decal, Terrain as DrawnTerrain, Trace, Tube};

use super::curve::Curve;
use super::drawing::FootShape;
use crate::colors;
use crate::figure::{FigurePose, FigureView, Follow, NamedView, SceneParts};
use crate::footprints::Editor;
use crate::footprints::wandering::Wandering;
use crate::views::ride_page::scene_colors;

/// The cameras in the order in which they follow one another.
const CAMERAS: [(NamedView, &str); 4] = [
    (NamedView::Side, "Side"),
    (NamedView::ThreeQuarter, "3/4"),
    (NamedView::Front, "Front"),
    (NamedView::Follow, "Follow"),
];
/// Against a figure that fills its box: room for the way ahead.
const ROOM: f32 = 0.8;
/// Lines of the ground are this far apart, metres.
const GRID_M: f32 = 0.5;
/// Prints and curves farther from the figure than this are not drawn, sizes of the figure.
const NEAR: f64 = 25.0;
/// Prints and points of the curve drawn at most.
const MOST_PRINTS: usize = 200;
const MOST_POINTS: usize = 3000;
/// The camera's height follows the mean height of so much ground before and behind, sizes of the figure.
const LEVELLED: f32 = 1.2;
/// Places on that way.
const LEVELS: i16 = 24;
/// The way of the wanderer that is drawn, s, and the time between its points.
const TRAIL_S: [f64; 2] = [20.0, 1.0 / 30.0];
/// A tree: sides of its trunk's rings and its height, in radii.
const TREE_HEIGHT: f32 = 14.0;
const BARK: [u8; 3] = [112, 86, 62];

/// How the figure is looked at.
pub(super) struct SceneView {
    figure: FigureView,
    camera: usize,
    /// The ground drawn last, and how many there were before it.
    ground: (Terrain, u64),
}

impl Default for SceneView {
    fn default() -> Self {
        let mut view = Self { figure: FigureView::new(Side::Right), camera: 0, ground: (Terrain::Flat, 0) };
        view.figure.buttons = false;
        view.look(1);
        view
    }
}

/// What is drawn.
#[derive(Default)]
struct Parts {
    figures: Vec<FigurePose>,
    tubes: Vec<Tube>,
    decals: Vec<Decal>,
    ways: Vec<(Vec<Vec3>, [u8; 3])>,
}

impl SceneView {
    /// The camera after this one.
    pub(super) fn next_camera(&mut self) {
        self.look((self.camera + 1) % CAMERAS.len());
    }

    fn look(&mut self, camera: usize) {
        self.camera = camera;
        self.figure.look(CAMERAS[camera].0);
        self.figure.zoom *= ROOM;
    }

    fn ground_version(&mut self, terrain: &Terrain) -> u64 {
        if self.ground.0 != *terrain {
            self.ground = (terrain.clone(), self.ground.1 + 1);
        }
        self.ground.1
    }

    /// The cameras as buttons.
    pub(super) fn controls(&mut self, ui: &mut Ui, hover: &str) {
        ui.horizontal(|ui| {
            for (camera, (_, name)) in CAMERAS.iter().enumerate() {
                let button = egui::Button::selectable(self.camera == camera, *name).frame_when_inactive(true);
                if ui.add(button).on_hover_text(hover).clicked() {
                    self.look(camera);
                }
            }
        });
    }

    /// The figure of the track at the present moment.
    pub(super) fn show(&mut self, ui: &mut Ui, editor: &Editor, curve: &Curve, shape: &FootShape) {
        let Some(motion) = editor.motion() else {
            ui.centered_and_justified(|ui| ui.weak("The figure appears when the track can be walked"));
            return;
        };
        let mut parts = Parts::default();
        let time_s = editor.playback.time_s();
        let placed = Self::place(motion, time_s, curve.down(time_s), &mut parts);
        let Some((at, heading_rad, size)) = placed else { return };
        let near_m = NEAR * f64::from(size);
        let is_near = |place: DVec3| place.distance(at) < near_m;
        let terrain = motion.track.terrain.clone();
        let near = motion.placed.prints.iter().zip(&motion.track.prints);
        let near = near.filter(|(placed, _)| is_near(placed.middle)).take(MOST_PRINTS);
        parts.decals = near.map(|(_, print)| decal(shape, print, &terrain)).collect();
        let mut points = 0;
        for run in curve.runs.iter().filter(|run| run.points.iter().any(|point| is_near(*point))) {
            points += run.points.len();
            if points < MOST_POINTS {
                parts.ways.push((run.points.iter().map(|at| at.as_vec3()).collect(), rgb(run.color)));
            }
        }
        self.draw(ui, &parts, &terrain, (at, heading_rad, size));
    }

    /// Adds the figure to what is drawn; its place, heading (radians) and size in reference horses.
    fn place(motion: &Motion, time_s: f64, down: &[Foot], parts: &mut Parts) -> Option<(DVec3, f32, f32)> {
        let figure = motion.figure(time_s);
        match &figure {
            Figure::Biped(pose) => {
                parts.tubes = motion.tubes(&figure).into_iter().map(drawn_tube).collect();
                let Character::Biped(model) = motion.character() else { return None };
                Some((pose.centre_of_mass, heading_rad(pose), size(&model)))
            }
            Figure::Horse(pose) => {
                let Character::Horse(horse) = motion.character() else { return None };
                let joints = pose.joints(horse.skeleton());
                let standing = Foot::QUADRUPED.map(|foot| down.contains(&foot));
                let figure = FigurePose { joints, standing, ghost: false };
                let trunk = joints.tips[bone::SPINE_LAST] - joints.root;
                let size = figure.size()?;
                parts.figures.push(figure);
                Some((joints.root.as_dvec3(), (-trunk.z).atan2(trunk.x), size))
            }
        }
    }

    /// The wanderer among its trees.
    pub(super) fn show_wandering(&mut self, ui: &mut Ui, walk: &Wandering, shape: &FootShape) {
        let Some(pose) = walk.pose() else { return };
        let size = size(walk.model());
        let at = pose.centre_of_mass;
        let mut parts = Parts {
            tubes: tubes(walk.model(), &pose).into_iter().map(drawn_tube).collect(),
            ..Parts::default()
        };
        let near_m = NEAR * f64::from(size);
        let newest = walk.prints().iter().rev();
        let near = newest.filter(|print| (print.at_m[0] - at.x).hypot(print.at_m[1] - at.z) < near_m);
        parts.decals = near.take(MOST_PRINTS).map(|print| decal(shape, print, &Terrain::Flat)).collect();
        parts.tubes.extend(walk.trees().iter().map(|tree| {
            let [x, z] = tree.at_m.map(|v| v as f32);
            let radius_m = tree.radius_m as f32;
            Tube {
                points: vec![Vec3::new(x, 0.0, z), Vec3::new(x, TREE_HEIGHT * radius_m, z)],
                radii_m: vec![glam::Vec2::splat(radius_m), glam::Vec2::splat(0.8 * radius_m)],
                up: Vec3::X,
                color: BARK,
            }
        }));
        let steps = (TRAIL_S[0].min(walk.time_s()) / TRAIL_S[1]) as usize;
        let trail = (0..=steps).rev().map(|back| {
            walk.planner().trajectory().at(walk.time_s() - back as f64 * TRAIL_S[1]).at.as_vec3()
        });
        parts.ways.push((trail.collect(), rgb(colors::FIT)));
        self.draw(ui, &parts, &Terrain::Flat, (at, heading_rad(&pose), size));
    }

    fn draw(
        &mut self,
        ui: &mut Ui,
        parts: &Parts,
        terrain: &Terrain,
        (at, heading_rad, size): (DVec3, f32, f32),
    ) {
        let height = |x: f32, z: f32| terrain.at(f64::from(x), f64::from(z)).0 as f32;
        let ahead = Vec3::new(heading_rad.cos(), 0.0, -heading_rad.sin()) * (LEVELLED * size);
        let at = at.as_vec3();
        let levels = (-LEVELS..=LEVELS).map(|i| {
            let place = at + ahead * (f32::from(i) / f32::from(LEVELS));
            height(place.x, place.z)
        });
        let ground_m = levels.sum::<f32>() / f32::from(2 * LEVELS + 1);
        let traces: Vec<Trace<'_>> =
            parts.ways.iter().map(|(points, color)| Trace { points, color: *color }).collect();
        let scene = SceneParts {
            figures: &parts.figures,
            tubes: &parts.tubes,
            decals: &parts.decals,
            terrain: match terrain {
                Terrain::Flat => DrawnTerrain::Flat,
                Terrain::Slope { .. } | Terrain::HeightField { .. } => DrawnTerrain::Height(&height),
                Terrain::Stairs { .. } | Terrain::SpiralStairs { .. } => DrawnTerrain::Stepped(&height),
            },
            terrain_version: self.ground_version(terrain),
            grid_m: GRID_M,
            traces: &traces,
            support_polygon: false,
            colors: &scene_colors(ui.visuals().dark_mode),
            follow: Follow { at: at.with_y(ground_m), heading_rad, size },
        };
        let room = ui.available_size();
        self.figure.ui_scene(ui, room, &scene);
    }
}

fn heading_rad(pose: &BipedPose) -> f32 {
    let ahead = pose.world_from_body * DVec3::X;
    (-ahead.z).atan2(ahead.x) as f32
}

/// The size that the camera's distances are given in, a reference horse's being 1: by the height of the centre of mass.
fn size(model: &Model) -> f32 {
    let leg = &model.leg;
    (leg.foot.ankle_m[1] + leg.nominal_m - leg.hip_from_com_m[1]) as f32
}

fn drawn_tube(tube: WalkerTube) -> Tube {
    let WalkerTube { points, radii_m, up, color } = tube;
    Tube { points, radii_m, up, color }
}

fn decal(shape: &FootShape, print: &Print, terrain: &Terrain) -> Decal {
    let corner = |[x, z]: [f64; 2]| Vec3::new(x as f32, terrain.at(x, z).0 as f32, z as f32);
    Decal {
        points: shape.outline(print).into_iter().map(corner).collect(),
        color: rgb(colors::foot(print.foot)),
    }
}

fn rgb(color: Color32) -> [u8; 3] {
    [color.r(), color.g(), color.b()]
}
