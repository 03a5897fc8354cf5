//! Ground with edges in the z-buffer: squares of the mesh are divided where they are not flat, so that a step is sharp.

use glam::{Vec2, Vec3};

use super::camera::Camera;
use super::canvas::Canvas;
use super::terrain::{Node, draw_clipped, light};

/// A square of the mesh is looked at in so many places along its side, and a part of it in fewer: an edge has been found already.
const PLACES: usize = 8;
const PART_PLACES: usize = 4;
/// The smallest squares, and what counts as flat, in distances from the eye: a pixel or two of a usual picture, and a third of one.
const LEAST: f32 = 0.0012;
const FLAT: f32 = 0.0003;
/// Where an edge faces is measured over so many of the smallest squares to both sides, and it is lit as a wall of this slope.
const AROUND: f32 = 5.0;
const WALL: f32 = 8.0;

/// Draws squares of a ground, closely where it is not flat.
pub(super) struct Closely<'a> {
    height: &'a dyn Fn(f32, f32) -> f32,
    camera: &'a Camera,
    eye: Vec3,
}

/// A square of the ground and heights in it.
struct Square<const N: usize> {
    /// The corner with least x and z, metres.
    from: Vec2,
    side_m: f32,
    heights: [[f32; N]; N],
}

impl<'a> Closely<'a> {
    pub(super) fn new(height: &'a dyn Fn(f32, f32) -> f32, camera: &'a Camera) -> Self {
        Self { height, camera, eye: camera.eye() }
    }

    /// Draws a square whose corner with least x and z is given, unless it is out of the picture.
    pub(super) fn square(&self, canvas: &mut Canvas<f32>, from: [f32; 2], side_m: f32) {
        self.draw::<{ PLACES + 1 }>(canvas, from.into(), side_m);
    }

    fn draw<const N: usize>(&self, canvas: &mut Canvas<f32>, from: Vec2, side_m: f32) {
        let part_m = side_m / (N - 1) as f32;
        let heights = std::array::from_fn(|i| {
            std::array::from_fn(|k| (self.height)(from.x + i as f32 * part_m, from.y + k as f32 * part_m))
        });
        let square = Square::<N> { from, side_m, heights };
        let Some([low, high]) = square.range() else { return };
        if !self.is_in_sight(canvas, &square, [low, high]) {
            return;
        }
        let middle = from + side_m / 2.0;
        let away_m = Vec3::new(middle.x, (low + high) / 2.0, middle.y).distance(self.eye);
        let is_flat = square.flatness_m() <= FLAT * away_m;
        if is_flat {
            // A little beyond its edge, so that no crack is left beside squares of another size.
            self.fill(canvas, square.corners(FLAT * away_m, |i, k| square.slope(i, k)));
        } else if side_m > LEAST * away_m {
            let half_m = side_m / 2.0;
            for beyond in [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE] {
                self.draw::<{ PART_PLACES + 1 }>(canvas, from + beyond * half_m, half_m);
            }
        } else {
            let wall = self.wall(middle, AROUND * side_m);
            self.fill(canvas, square.corners(0.0, |_, _| wall));
        }
    }

    fn fill(&self, canvas: &mut Canvas<f32>, [a, b]: [[Node; 2]; 2]) {
        draw_clipped(canvas, self.camera, [a[0], a[1], b[0]]);
        draw_clipped(canvas, self.camera, [b[0], a[1], b[1]]);
    }

    /// The slope of the wall that an edge is.
    fn wall(&self, at: Vec2, around_m: f32) -> Vec2 {
        let rise =
            |by: Vec2| (self.height)(at.x + by.x, at.y + by.y) - (self.height)(at.x - by.x, at.y - by.y);
        Vec2::new(rise(Vec2::X * around_m), rise(Vec2::Y * around_m)).normalize_or_zero() * WALL
    }

    fn is_in_sight<const N: usize>(
        &self,
        canvas: &Canvas<f32>,
        square: &Square<N>,
        [low, high]: [f32; 2],
    ) -> bool {
        let (from, to) = (square.from, square.from + square.side_m);
        let corner = |i: u8| {
            let at = |bit: u8, from: f32, to: f32| if i >> bit & 1 == 0 { from } else { to };
            Vec3::new(at(0, from.x, to.x), at(1, low, high), at(2, from.y, to.y))
        };
        let (mut least, mut most) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        for i in 0..8 {
            // What reaches behind the camera may be anywhere.
            let Some(at) = self.camera.project(corner(i)) else { return true };
            (least, most) = (least.min(at), most.max(at));
        }
        let [width, height] = canvas.size.map(|v| v as f32);
        most.x > 0.0 && most.y > 0.0 && least.x < width && least.y < height
    }
}

impl<const N: usize> Square<N> {
    /// Least and greatest height, metres; none where there is no ground at all.
    fn range(&self) -> Option<[f32; 2]> {
        let known = || self.heights.as_flattened().iter().copied().filter(|height| height.is_finite());
        let [low, high] = [known().fold(f32::INFINITY, f32::min), known().fold(f32::NEG_INFINITY, f32::max)];
        (low <= high).then_some([low, high])
    }

    /// How far it is from the surface its corners span, metres; a hole in it is very far.
    fn flatness_m(&self) -> f32 {
        let [first, last] = [&self.heights[0], &self.heights[N - 1]];
        let mut most = 0.0_f32;
        for (i, row) in self.heights.iter().enumerate() {
            let u = i as f32 / (N - 1) as f32;
            for (k, height) in row.iter().enumerate() {
                let v = k as f32 / (N - 1) as f32;
                let [from, to] = [first, last].map(|edge| edge[0] + (edge[N - 1] - edge[0]) * v);
                let away = (height - from - (to - from) * u).abs();
                most = most.max(if away.is_finite() { away } else { f32::MAX });
            }
        }
        most
    }

    /// The slope beside a corner, within the square.
    fn slope(&self, i: usize, k: usize) -> Vec2 {
        let inner = |at: usize| if at == 0 { 1 } else { at - 1 };
        let sign = |at: usize| if at == 0 { 1.0 } else { -1.0 };
        let here = self.heights[i][k];
        let rise =
            [(self.heights[inner(i)][k] - here) * sign(i), (self.heights[i][inner(k)] - here) * sign(k)];
        Vec2::from(rise) * (N - 1) as f32 / self.side_m
    }

    /// Its corners, so far beyond its edge, lit by a slope at each.
    fn corners(&self, beyond_m: f32, slope: impl Fn(usize, usize) -> Vec2) -> [[Node; 2]; 2] {
        let place =
            |from: f32, at: usize| if at == 0 { from - beyond_m } else { from + self.side_m + beyond_m };
        let node = |i: usize, k: usize| {
            let slope = slope(i, k);
            let at = Vec3::new(place(self.from.x, i), self.heights[i][k], place(self.from.y, k));
            Node { at, light: light(if slope.is_finite() { slope.to_array() } else { [0.0; 2] }) }
        };
        [0, N - 1].map(|i| [node(i, 0), node(i, N - 1)])
    }
}
