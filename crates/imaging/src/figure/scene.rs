//! From a scene to pixels.

use glam::{Vec2, Vec3};
use image::RgbaImage;
use muybridge_core::{Limb, Side};

use super::body::{Part, Tone, bones, parts};
use super::camera::Camera;
use super::canvas::{Canvas, Corner};
use super::frames::Frames;
use super::ground::{self, blend, color, in_bands, opaque};
use super::terrain::Floor;
use super::{Figure, FigureColors, Scene, Trace, Tube};

/// How much a ghost covers what is behind it, and how much of it is seen through what is before it.
const GHOST_OPACITY: [f32; 2] = [0.6, 0.25];
/// Mane and tail against the trunk.
const HAIR_SHADE: f32 = 0.42;
const HOOF: Vec3 = Vec3::new(58.0, 50.0, 44.0);
const EYE: Vec3 = Vec3::new(22.0, 16.0, 14.0);
/// What is less than this share of its distance behind the ground is seen: hooves and traces lie in it.
const SUNK: f32 = 0.012;
/// Half thickness of a trace, pixels.
const TRACE_PX: f32 = 1.3;

/// Red, green, blue and alpha, which is not premultiplied.
type Pixel = [u8; 4];

impl FigureColors {
    /// The colour of a leg when `filmed` is the horse's side towards the cameras.
    pub(super) fn limb(&self, limb: Limb, filmed: Side) -> [u8; 3] {
        if limb.side() == filmed { self.near } else { self.off }
    }

    fn tone(&self, tone: Tone, filmed: Side) -> Vec3 {
        match tone {
            Tone::Trunk => color(self.trunk),
            Tone::Hair => color(self.trunk) * HAIR_SHADE,
            Tone::Limb(limb) => color(self.limb(limb, filmed)),
            Tone::Hoof => HOOF,
            Tone::Eye => EYE,
            Tone::Own(own) => color(own),
        }
    }
}

/// A pixel under way, and one over its distance.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    pub(super) pixel: Pixel,
    pub(super) depth: f32,
}

/// A picture under way.
struct Picture {
    size: [usize; 2],
    cells: Vec<Cell>,
}

/// See [`super::render`].
pub(super) fn render(scene: &Scene<'_>, camera: &Camera, size: [usize; 2], smooth: bool) -> RgbaImage {
    let floor = Floor(scene.terrain);
    let figures: Vec<(&Figure, Frames)> =
        scene.figures.iter().filter_map(|figure| Some((figure, Frames::of(&figure.joints)?))).collect();
    let ground = floor.draw(camera, size);
    let sky = Cell { pixel: scene.colors.sky.unwrap_or_default(), depth: 0.0 };
    let mut picture = Picture { size, cells: vec![sky; size[0] * size[1]] };
    ground::paint(scene, &figures, camera, &ground, &mut picture.cells);
    scene.traces.iter().for_each(|trace| picture.trace(camera, trace));
    let finer = if smooth { 2 } else { 1 };
    let drawer = Drawer { scene, camera: camera.finer(finer as f32), finer };
    let solid = figures.iter().filter(|(figure, _)| !figure.ghost);
    let mut solid: Vec<Part> =
        solid.flat_map(|(figure, frames)| parts(frames, figure.standing, &floor)).collect();
    solid.extend(scene.tubes.iter().filter_map(Tube::part));
    drawer.draw(&solid, &mut picture, None);
    for (figure, frames) in figures.iter().filter(|(figure, _)| figure.ghost) {
        drawer.draw(&bones(&figure.joints, frames), &mut picture, Some(GHOST_OPACITY));
    }
    let (width, height) = (size[0] as u32, size[1] as u32);
    let mut bytes = vec![0; 4 * picture.cells.len()];
    for (bytes, cell) in bytes.chunks_exact_mut(4).zip(&picture.cells) {
        bytes.copy_from_slice(&cell.pixel);
    }
    RgbaImage::from_raw(width, height, bytes).unwrap_or_else(|| RgbaImage::new(width, height))
}

/// Draws bodies, at a multiple of the picture's pixels.
struct Drawer<'a> {
    scene: &'a Scene<'a>,
    /// Of the finer picture.
    camera: Camera,
    finer: usize,
}

impl Drawer<'_> {
    /// Draws parts over the picture, where nothing is before them. A ghost has one opacity where it is nearer and one where hidden.
    fn draw(&self, parts: &[Part], picture: &mut Picture, ghost: Option<[f32; 2]>) {
        let corners: Vec<Vec<Option<Corner>>> = parts.iter().map(|part| self.corners(part)).collect();
        let places = corners.iter().flatten().flatten().map(|corner| corner.at);
        let Some(([left, top], size)) = window(places, picture.size, self.finer) else { return };
        let (width, finer) = (picture.size[0], self.finer);
        let rows = &mut picture.cells[top * width..(top + size[1]) * width];
        in_bands(rows, width, |from, band| {
            let height = band.len() / width;
            let mut canvas: Canvas<Pixel> =
                Canvas::new([left * finer, (top + from) * finer], [size[0] * finer, height * finer]);
            for (part, corners) in parts.iter().zip(&corners) {
                for triangle in &part.surface.triangles {
                    if let [Some(a), Some(b), Some(c)] = triangle.map(|i| corners[i as usize]) {
                        canvas.triangle([a, b, c], opaque);
                    }
                }
            }
            for (y, row) in band.chunks_exact_mut(width).enumerate() {
                let drawn = canvas.drawn(y * finer..(y + 1) * finer);
                for x in drawn.start / finer..drawn.end.div_ceil(finer) {
                    resolve(&canvas, finer, [x, y], &mut row[left + x], ghost);
                }
            }
        });
    }

    fn corners(&self, part: &Part) -> Vec<Option<Corner>> {
        let surface = &part.surface;
        let tones = part.tones.map(|tone| self.scene.colors.tone(tone, self.scene.filmed));
        let corner = |((&point, &normal), &tint): ((&Vec3, &Vec3), &f32)| {
            let at = self.camera.project(point)?;
            let [lit, shine] = self.camera.light(normal);
            let value = tones[0].lerp(tones[1], tint) * lit + shine * 255.0;
            Some(Corner { at, value: value.clamp(Vec3::ZERO, Vec3::splat(255.0)) })
        };
        surface.points.iter().zip(&surface.normals).zip(&surface.tints).map(corner).collect()
    }
}

/// Lays the mean of a pixel's samples over the picture.
fn resolve(
    canvas: &Canvas<Pixel>,
    finer: usize,
    [x, y]: [usize; 2],
    cell: &mut Cell,
    ghost: Option<[f32; 2]>,
) {
    let before = cell.depth * (1.0 - SUNK);
    // Of the samples before and behind what is there: sums of the channels, and how many.
    let (mut sums, mut nearest) = ([[0_u32; 4]; 2], cell.depth);
    for row in y * finer..(y + 1) * finer {
        let from = row * canvas.size[0] + x * finer;
        let samples = canvas.depths[from..from + finer].iter().zip(&canvas.pixels[from..from + finer]);
        for (&depth, &[r, g, b, _]) in samples.filter(|(depth, _)| **depth > 0.0) {
            let sum = &mut sums[usize::from(depth <= before)];
            for (sum, value) in sum.iter_mut().zip([r, g, b, 1]) {
                *sum += u32::from(value);
            }
            nearest = nearest.max(depth);
        }
    }
    let samples = (finer * finer) as u32;
    if ghost.is_none() && sums[0][3] == samples {
        let [r, g, b] = [0, 1, 2].map(|i| ((sums[0][i] + samples / 2) / samples) as u8);
        *cell = Cell { pixel: [r, g, b, 255], depth: nearest };
        return;
    }
    let opacities = ghost.unwrap_or([1.0, 0.0]);
    for ([r, g, b, count], opacity) in sums.into_iter().zip(opacities) {
        if count > 0 && opacity > 0.0 {
            let mean = Vec3::new(r as f32, g as f32, b as f32) / count as f32;
            blend(&mut cell.pixel, mean, opacity * count as f32 / samples as f32);
        }
    }
    if ghost.is_none() {
        cell.depth = nearest;
    }
}

/// The part of a picture, left and top and size, in which places of a finer one are; none when they are all outside.
fn window(
    places: impl Iterator<Item = Vec3>,
    size: [usize; 2],
    finer: usize,
) -> Option<([usize; 2], [usize; 2])> {
    let (mut low, mut high) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
    for place in places {
        (low, high) = (low.min(place.truncate()), high.max(place.truncate()));
    }
    let from = (low / finer as f32).floor().max(Vec2::ZERO);
    let to = (high / finer as f32).ceil().min(Vec2::new(size[0] as f32, size[1] as f32));
    let extent = to - from;
    let within = extent.is_finite() && extent.min_element() >= 1.0;
    within.then_some(([from.x as usize, from.y as usize], [extent.x as usize, extent.y as usize]))
}

impl Picture {
    /// Draws a line in space where nothing is before it.
    fn trace(&mut self, camera: &Camera, trace: &Trace<'_>) {
        let place = |point: &Vec3| if point.is_finite() { camera.project(*point) } else { None };
        for ends in trace.points.windows(2) {
            if let [Some(from), Some(to)] = [place(&ends[0]), place(&ends[1])] {
                self.segment([from, to], color(trace.color));
            }
        }
    }

    fn segment(&mut self, [from, to]: [Vec3; 2], color: Vec3) {
        let margin = Vec3::splat(TRACE_PX + 1.0);
        let places = [from.min(to) - margin, from.max(to) + margin];
        let Some(([left, top], size)) = window(places.into_iter(), self.size, 1) else { return };
        let edge = (to - from).truncate();
        let length_squared = edge.length_squared().max(1e-6);
        for y in top..top + size[1] {
            for x in left..left + size[0] {
                let away = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) - from.truncate();
                let share = (away.dot(edge) / length_squared).clamp(0.0, 1.0);
                let cover = (TRACE_PX + 0.5 - away.distance(edge * share)).clamp(0.0, 1.0);
                let depth = from.z + (to.z - from.z) * share;
                let cell = &mut self.cells[y * self.size[0] + x];
                if cover > 0.0 && depth > cell.depth * (1.0 - SUNK) {
                    blend(&mut cell.pixel, color, cover);
                    if cover > 0.5 {
                        cell.depth = cell.depth.max(depth);
                    }
                }
            }
        }
    }
}
