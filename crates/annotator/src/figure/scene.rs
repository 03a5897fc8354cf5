//! From poses to pixels.

use egui::{Color32, ColorImage};
use muybridge_core::{Limb, Side};

use super::body::{Part, Tone, parts};
use super::camera::Camera;
use super::pose::{FigurePose, Frame};
use super::raster::{Canvas, Corner};

/// How much a ghost covers what is behind it, and how much of it is seen through what is before it.
const GHOST_OPACITY: [f32; 2] = [0.6, 0.25];
/// Mane, tail and ears against the trunk.
const HAIR_SHADE: f32 = 0.55;

/// The figure's colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FigureColors {
    /// Limbs on the filmed side.
    pub near: Color32,
    /// Limbs on the other side.
    pub off: Color32,
    /// Neck, head, barrel.
    pub trunk: Color32,
}

impl FigureColors {
    /// The colour of a limb when `filmed` is the horse's side towards the cameras.
    pub(super) fn limb(&self, limb: Limb, filmed: Side) -> Color32 {
        if limb.side() == filmed { self.near } else { self.off }
    }

    fn tone(&self, tone: Tone, filmed: Side) -> [f32; 3] {
        let (color, shade) = match tone {
            Tone::Trunk => (self.trunk, 1.0),
            Tone::Hair => (self.trunk, HAIR_SHADE),
            Tone::Limb(limb) => (self.limb(limb, filmed), 1.0),
        };
        [color.r(), color.g(), color.b()].map(|channel| f32::from(channel) * shade)
    }
}

/// Draws poses into a picture of `size` pixels, `smooth` computed at twice the size and averaged.
/// The camera is that of the picture.
pub(super) fn render(
    poses: &[FigurePose],
    camera: &Camera,
    size: [usize; 2],
    smooth: bool,
    colors: &FigureColors,
    filmed: Side,
) -> ColorImage {
    let finer = if smooth { 2 } else { 1 };
    let camera = camera.finer(finer as f32);
    let blank = || Canvas::new(size[0] * finer, size[1] * finer);
    let mut canvas = blank();
    let draw = |canvas: &mut Canvas, pose: &FigurePose| {
        let frame = Frame::of(&pose.joints);
        for part in frame.iter().flat_map(|frame| parts(&pose.joints, frame, pose.ghost)) {
            draw_part(canvas, &camera, &part, colors.tone(part.tone, filmed));
        }
    };
    poses.iter().filter(|pose| !pose.ghost).for_each(|pose| draw(&mut canvas, pose));
    for pose in poses.iter().filter(|pose| pose.ghost) {
        let mut ghost = blank();
        draw(&mut ghost, pose);
        canvas.blend(&ghost, GHOST_OPACITY);
    }
    if smooth { canvas.halved() } else { canvas.whole() }
}

fn draw_part(canvas: &mut Canvas, camera: &Camera, part: &Part, color: [f32; 3]) {
    let surface = &part.surface;
    let corners: Vec<Option<Corner>> = surface
        .points
        .iter()
        .zip(&surface.normals)
        .map(|(&point, &normal)| {
            let brightness = camera.brightness(normal).clamp(0.0, 1.0);
            camera.project(point).map(|at| Corner { at, brightness })
        })
        .collect();
    for triangle in &surface.triangles {
        if let [Some(a), Some(b), Some(c)] = triangle.map(|i| corners[i as usize]) {
            canvas.triangle([a, b, c], color);
        }
    }
}
