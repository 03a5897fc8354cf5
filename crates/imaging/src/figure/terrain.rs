//! The ground's shape: heights under a point, and the ground in the z-buffer.

use glam::Vec3;
use muybridge_core::{Ground, Surface};

use super::Terrain;
use super::camera::Camera;
use super::canvas::{Canvas, Corner};
use super::stepped::Closely;

/// The mesh of the ground has squares of several sizes, the smallest around the target: so many sizes, each twice the one before,
/// and so many squares from the middle to the edge.
const LEVELS: i32 = 5;
const REACH: i32 = 16;
/// The smallest squares are this share of the camera's distance, or a little less.
const SQUARE_SHARE: f32 = 0.05;
/// Where the sun is: it makes slopes light and dark. Unit length.
const SUN: Vec3 = Vec3::new(0.37, 0.8, 0.47);
/// How much a slope's brightness changes with its normal's part towards the sun.
const RELIEF: f32 = 1.1;
/// Bounds of the brightness of a slope.
const RELIEF_BOUNDS: [f32; 2] = [0.45, 1.25];

/// The ground below any point.
#[derive(Clone, Copy)]
pub(super) struct Floor<'a>(pub(super) Terrain<'a>);

/// A corner of the mesh.
#[derive(Clone, Copy)]
pub(super) struct Node {
    pub(super) at: Vec3,
    pub(super) light: f32,
}

/// How bright the ground is where it rises so much along X and Z, metres for each metre.
pub(super) fn light(slope: [f32; 2]) -> f32 {
    let normal = Vec3::new(-slope[0], 1.0, -slope[1]).normalize_or(Vec3::Y);
    let light = 1.0 + RELIEF * (normal.dot(SUN) - SUN.y);
    light.clamp(RELIEF_BOUNDS[0], RELIEF_BOUNDS[1])
}

impl Floor<'_> {
    /// Height at a place, metres; what is no number is a hole.
    fn height_m(&self, x: f32, z: f32) -> f32 {
        match self.0 {
            Terrain::Height(height) | Terrain::Stepped(height) => height(x, z),
            Terrain::Hidden | Terrain::Flat => 0.0,
        }
    }

    /// The ground below a point; below is nothing but a hole, it is level ground at the point.
    pub(super) fn surface(&self, point: Vec3) -> Surface {
        let height = |x: f32, z: f32| self.height_m(x, z);
        let surface = height.surface(point.x, point.z);
        let holds = surface.height_m.is_finite() && surface.normal.is_finite();
        if holds { surface } else { Surface { height_m: point.y, normal: Vec3::Y } }
    }

    /// Depth and brightness of the ground in a picture.
    pub(super) fn draw(&self, camera: &Camera, size: [usize; 2]) -> Canvas<f32> {
        let mut canvas = Canvas::new([0, 0], size);
        match self.0 {
            Terrain::Hidden => {}
            Terrain::Flat => flat(&mut canvas, camera),
            Terrain::Height(_) => self.mesh(&mut canvas, camera),
            Terrain::Stepped(_) => {
                self.mesh(&mut canvas, camera);
                canvas.close_slits();
            }
        }
        canvas
    }

    fn mesh(&self, canvas: &mut Canvas<f32>, camera: &Camera) {
        // A power of two, so that the mesh stays the same while the view is zoomed a little.
        let finest = (camera.distance_m() * SQUARE_SHARE).log2().floor().exp2();
        let mut inner: Option<[i32; 2]> = None;
        for level in 0..LEVELS {
            let square = finest * (1 << level) as f32;
            let target = camera.target();
            let middle = [target.x, target.z].map(|v| 2 * (v / (2.0 * square)).round() as i32);
            // The squares of the level before have an edge half as long.
            let hole = inner.map(|inner| inner.map(|v| v / 2));
            let left_out = |i: i32, k: i32| {
                hole.is_some_and(|hole| {
                    let within = |at: i32, hole: i32| (hole - REACH / 2..hole + REACH / 2).contains(&at);
                    within(middle[0] + i, hole[0]) && within(middle[1] + k, hole[1])
                })
            };
            if let Terrain::Stepped(height) = self.0 {
                let closely = Closely::new(height, camera);
                let kept = (-REACH..REACH).flat_map(|i| (-REACH..REACH).map(move |k| (i, k)));
                for (i, k) in kept.filter(|&(i, k)| !left_out(i, k)) {
                    let corner = [middle[0] + i, middle[1] + k].map(|v| v as f32 * square);
                    closely.square(canvas, corner, square);
                }
            } else {
                draw_level(canvas, camera, &self.nodes(middle, square), left_out);
            }
            inner = Some(middle);
        }
    }

    /// The corners of one size of squares, by rows of x. Every second one along the edge lies on the line between its neighbours,
    /// as the larger squares beyond have it.
    fn nodes(&self, middle: [i32; 2], square: f32) -> Vec<Vec<Node>> {
        let across = 2 * REACH + 3;
        let place = |i: i32, from: i32| (from + i - REACH - 1) as f32 * square;
        let heights: Vec<Vec<f32>> = (0..across)
            .map(|i| (0..across).map(|k| self.height_m(place(i, middle[0]), place(k, middle[1]))).collect())
            .collect();
        let last = across as usize - 2;
        let height = |i: usize, k: usize| match (i == 1 || i == last, k == 1 || k == last) {
            (true, false) if k.is_multiple_of(2) => (heights[i][k - 1] + heights[i][k + 1]) / 2.0,
            (false, true) if i.is_multiple_of(2) => (heights[i - 1][k] + heights[i + 1][k]) / 2.0,
            _ => heights[i][k],
        };
        let node = |i: usize, k: usize| {
            let slope =
                [heights[i + 1][k] - heights[i - 1][k], heights[i][k + 1] - heights[i][k - 1]].map(|rise| {
                    let slope = rise / (2.0 * square);
                    if slope.is_finite() { slope } else { 0.0 }
                });
            Node {
                at: Vec3::new(place(i as i32, middle[0]), height(i, k), place(k as i32, middle[1])),
                light: light(slope),
            }
        };
        (1..=last).map(|i| (1..=last).map(|k| node(i, k)).collect()).collect()
    }
}

/// The plane of height zero: as the camera stands upright, its depth is the same along a row.
fn flat(canvas: &mut Canvas<f32>, camera: &Camera) {
    let height = camera.eye().y;
    canvas.pixels.fill(1.0);
    for y in 0..canvas.size[1] {
        let inverse = -camera.ray([0.0, y as f32 + 0.5]).y / height;
        let row = y * canvas.size[0];
        canvas.depths[row..row + canvas.size[0]].fill(if height > 0.0 { inverse.max(0.0) } else { 0.0 });
    }
}

/// Draws the squares of one size but those left out, which are drawn smaller; they are counted from the middle.
fn draw_level(
    canvas: &mut Canvas<f32>,
    camera: &Camera,
    nodes: &[Vec<Node>],
    left_out: impl Fn(i32, i32) -> bool,
) {
    for i in 0..nodes.len() - 1 {
        for k in 0..nodes[i].len() - 1 {
            if !left_out(i as i32 - REACH, k as i32 - REACH) {
                let [a, b] = [i, i + 1].map(|i| [nodes[i][k], nodes[i][k + 1]]);
                draw_clipped(canvas, camera, [a[0], a[1], b[0]]);
                draw_clipped(canvas, camera, [b[0], a[1], b[1]]);
            }
        }
    }
}

/// Draws the part of a triangle that is not too near.
pub(super) fn draw_clipped(canvas: &mut Canvas<f32>, camera: &Camera, triangle: [Node; 3]) {
    let mut kept: Vec<Node> = Vec::new();
    if triangle.iter().all(|node| camera.clearance_m(node.at) > 0.0) {
        kept.extend(triangle);
    } else {
        for i in 0..3 {
            let (from, to) = (triangle[i], triangle[(i + 1) % 3]);
            let (here, there) = (camera.clearance_m(from.at), camera.clearance_m(to.at));
            if here > 0.0 {
                kept.push(from);
            }
            if (here > 0.0) != (there > 0.0) {
                // A little on the far side, so that rounding does not bring it too near again.
                let share = (here / (here - there)).clamp(0.0, 1.0);
                let share = if here > 0.0 { share * 0.999 } else { 1.0 - (1.0 - share) * 0.999 };
                let light = from.light + (to.light - from.light) * share;
                kept.push(Node { at: from.at.lerp(to.at, share), light });
            }
        }
    }
    let corner =
        |node: &Node| camera.project(node.at).map(|at| Corner { at, value: Vec3::splat(node.light) });
    let corners: Vec<Option<Corner>> = kept.iter().map(corner).collect();
    for i in 2..corners.len() {
        if let [Some(a), Some(b), Some(c)] = [corners[0], corners[i - 1], corners[i]] {
            canvas.triangle([a, b, c], |value| value.x);
        }
    }
}
