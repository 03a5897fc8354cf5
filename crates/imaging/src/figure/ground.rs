//! What is seen on the ground: grid, footprints, shadows, standing hooves and the polygon between them.

use std::ops::Range;

use glam::{Vec2, Vec3};
use muybridge_core::{Limb, Side, bone};

use super::camera::Camera;
use super::canvas::Canvas;
use super::frames::Frames;
use super::scene::Cell;
use super::terrain::Floor;
use super::{Decal, Figure, FigureColors, Scene, Terrain, Tube};

/// The ground fades from here to there, in distances of the camera from its target.
const FADE: [f32; 2] = [2.0, 7.0];
/// Lines of the grid are this thick, metres, and at least this thick, pixels.
const LINE_M: f32 = 0.018;
const LINE_PX: f32 = 1.1;
/// Brightness of a line against the ground.
const LINE_SHADE: f32 = 0.72;
/// Where fewer pixels than this are between two lines, they are left out.
const LEAST_PX: f32 = 3.0;
/// A disc under a standing hoof, metres.
const DISC_M: f32 = 0.105;
/// Half axes of the shadows under trunk and head, and how dark they are in the middle.
const TRUNK_SHADOW_M: [f32; 2] = [1.05, 0.42];
const HEAD_SHADOW_M: [f32; 2] = [0.62, 0.24];
const TRUNK_SHADOW: f32 = 0.52;
const HEAD_SHADOW: f32 = 0.3;
/// The shadow at a hoof: its half axis, metres, its darkness, and the height at which it is gone, metres.
const HOOF_SHADOW_M: f32 = 0.15;
const HOOF_SHADOW: f32 = 0.45;
const HOOF_SHADOW_GONE_M: f32 = 0.6;
/// Less cannot be seen: half a step of a channel.
const LEAST_OPACITY: f32 = 0.002;
/// Opacity of a disc or a polygon, and of its rim, and the rim's thickness, metres.
const FILL: f32 = 0.38;
/// Opacity of a footprint.
const PRINT: f32 = 0.7;
const RIM: f32 = 0.9;
const RIM_M: f32 = 0.014;

/// A picture is painted in at most so many bands at once, of at least so many pixels: starting a thread costs as much as these.
const MOST_BANDS: usize = 4;
const LEAST_BAND_PX: usize = 40_000;

/// On a slope, what is within a circle as seen from above is within one so much larger.
const ON_SLOPES: f32 = 1.5;

/// The shadow of a tube in contact with the ground, and the height at which it is half as dark, in half widths.
const TUBE_SHADOW: f32 = 0.26;
const TUBE_SHADOW_HALF: f32 = 5.0;
/// A shadow's edge gets so much softer with height: metres for each metre.
const PENUMBRA: f32 = 0.06;

/// Something on the ground, seen from above: x and z, metres.
struct Mark {
    shape: Shape,
    color: Vec3,
    /// All of it is within this circle.
    middle: Vec2,
    radius: f32,
}

enum Shape {
    /// Half axes, the direction of the first, and the opacity in the middle.
    Shadow {
        half_axes: Vec2,
        along: Vec2,
        opacity: f32,
    },
    Disc,
    /// Convex.
    Polygon(Vec<Vec2>),
    /// Of any form.
    Outline(Vec<Vec2>),
}

/// Paints the ground over the picture.
pub(super) fn paint(
    scene: &Scene<'_>,
    figures: &[(&Figure, Frames)],
    camera: &Camera,
    ground: &Canvas<f32>,
    picture: &mut [Cell],
) {
    let marks = Marks::of(scene, figures, camera);
    let painter = Painter::new(scene, camera, ground);
    let width = ground.size[0];
    in_bands(picture, width, |from, band| {
        let mut row = Row { axes: [Axis::new(width), Axis::new(width)] };
        if from > 0 {
            painter.places(from - 1, &mut row);
        }
        for (i, cells) in band.chunks_exact_mut(width).enumerate() {
            painter.places(from + i, &mut row);
            painter.cover(from + i, &row, cells);
            marks.paint(from + i, &row, cells);
        }
    });
}

/// Where on the ground the pixels of a row are. The loops over it are simple, so that a processor does several pixels at once.
struct Row {
    /// World X and Z.
    axes: [Axis; 2],
}

/// One coordinate along a row of pixels; no numbers where there is no ground.
struct Axis {
    at: Vec<f32>,
    /// The same in the row above.
    above: Vec<f32>,
    /// How far it is to the neighbours' places, metres.
    px_m: Vec<f32>,
    /// How much of the pixel a line of the grid covers, 0 to 1; no number where the neighbours' places are none.
    lined: Vec<f32>,
}

impl Axis {
    fn new(width: usize) -> Self {
        let none = || vec![f32::NAN; width];
        Self { at: none(), above: none(), px_m: none(), lined: vec![0.0; width] }
    }

    /// Goes on to the next row, whose pixels are seen along rays from the eye.
    fn next(&mut self, eye: f32, [first, step]: [f32; 2], inverse_depths: &[f32]) {
        std::mem::swap(&mut self.at, &mut self.above);
        for (x, (at, depth)) in self.at.iter_mut().zip(inverse_depths).enumerate() {
            *at = eye + (first + step * x as f32) / depth;
        }
        for ((px_m, at), above) in self.px_m.iter_mut().zip(&self.at).zip(&self.above) {
            *px_m = (at - above).abs();
        }
        // Where one neighbour is unknown, the other counts.
        for (px_m, pair) in self.px_m[1..].iter_mut().zip(self.at.windows(2)) {
            *px_m = px_m.max((pair[1] - pair[0]).abs());
        }
    }

    /// Finds the lines of a grid.
    fn rule(&mut self, every: f32) {
        let per_m = 1.0 / every;
        for ((lined, at), px_m) in self.lined.iter_mut().zip(&self.at).zip(&self.px_m) {
            let lines = at * per_m;
            let away = (lines - nearest_whole(lines)).abs() * every;
            let half = (LINE_M / 2.0).max(LINE_PX / 2.0 * px_m);
            let px_per_m = 1.0 / px_m.max(1e-6);
            let covered = (half - away) * px_per_m + 0.5;
            let clear = every * px_per_m / LEAST_PX - 1.0;
            *lined = covered.clamp(0.0, 1.0) * clear.clamp(0.0, 1.0);
        }
    }
}

impl Row {
    /// The place of a pixel, and how far from its neighbours' it is, metres.
    pub(super) fn spot(&self, x: usize) -> (Vec2, f32) {
        let [east, south] = &self.axes;
        (Vec2::new(east.at[x], south.at[x]), east.px_m[x].max(south.px_m[x]))
    }
}

struct Painter<'a> {
    camera: &'a Camera,
    ground: &'a Canvas<f32>,
    eye: Vec3,
    color: Vec3,
    /// Distance of the grid's lines, metres.
    grid_m: Option<f32>,
    target: Vec2,
    /// The ground begins to fade, and is gone, so far from the target, metres.
    fade_m: [f32; 2],
}

impl<'a> Painter<'a> {
    fn new(scene: &Scene<'_>, camera: &'a Camera, ground: &'a Canvas<f32>) -> Self {
        let every = scene.grid_m;
        Self {
            camera,
            ground,
            eye: camera.eye(),
            color: color(scene.colors.ground),
            grid_m: (every.is_finite() && every > 0.0).then_some(every),
            target: level(camera.target()),
            fade_m: FADE.map(|share| share * camera.distance_m()),
        }
    }

    /// Goes on to a row of the picture.
    fn places(&self, y: usize, row: &mut Row) {
        let [first, second] = [0.5, 1.5].map(|x| self.camera.ray([x, y as f32 + 0.5]));
        let step = second - first;
        let width = self.ground.size[0];
        let depths = &self.ground.depths[y * width..(y + 1) * width];
        let [east, south] = &mut row.axes;
        if depths.iter().all(|&depth| depth <= 0.0) {
            east.at.fill(f32::NAN);
            south.at.fill(f32::NAN);
            return;
        }
        east.next(self.eye.x, [first.x, step.x], depths);
        south.next(self.eye.z, [first.z, step.z], depths);
        if let Some(every) = self.grid_m {
            east.rule(every);
            south.rule(every);
        }
    }

    /// Paints a row of bare ground.
    fn cover(&self, y: usize, row: &Row, cells: &mut [Cell]) {
        let from = y * cells.len();
        let (depths, lights) = (&self.ground.depths[from..], &self.ground.pixels[from..]);
        let ([near, far], plain) = (self.fade_m, opaque(self.color));
        let [east, south] = &row.axes;
        let places = east.at.iter().zip(&south.at);
        let lined = east.lined.iter().zip(&south.lined).map(|(east, south)| east.max(*south).max(0.0));
        let seen = depths.iter().zip(lights).zip(places).zip(lined);
        for (cell, (((&depth, &light), (&x, &z)), lined)) in cells.iter_mut().zip(seen) {
            let away = Vec2::new(x, z).distance_squared(self.target);
            // What is no number is no ground.
            let is_seen = depth > 0.0 && away < far * far;
            if depth > 0.0 {
                cell.depth = depth;
            }
            if is_seen {
                let shade = light * (1.0 - lined * (1.0 - LINE_SHADE));
                if away > near * near {
                    let clear = (far - away.sqrt()) / (far - near);
                    blend(&mut cell.pixel, self.color * shade, clear * clear * (3.0 - 2.0 * clear));
                } else {
                    cell.pixel = if shade == 1.0 { plain } else { opaque(self.color * shade) };
                }
            }
        }
    }
}

/// The nearest whole number, for numbers up to four million: much quicker than `round`, which is a call.
fn nearest_whole(value: f32) -> f32 {
    const LARGE: f32 = 12_582_912.0;
    (value + LARGE) - LARGE
}

/// Works on bands of rows of a picture side by side: `work` has the first row and the pixels of one.
pub(super) fn in_bands<P: Send>(pixels: &mut [P], width: usize, work: impl Fn(usize, &mut [P]) + Sync) {
    let rows = pixels.len().checked_div(width).unwrap_or(0);
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let bands = cores.min(MOST_BANDS).min(pixels.len() / LEAST_BAND_PX).max(1);
    let (band_rows, work) = (rows.div_ceil(bands).max(1), &work);
    let mut bands = pixels.chunks_mut(band_rows * width.max(1)).enumerate();
    let Some((_, first)) = bands.next() else { return };
    std::thread::scope(|scope| {
        for (i, band) in bands {
            scope.spawn(move || work(i * band_rows, band));
        }
        work(0, first);
    });
}

/// All that is on the ground, and the columns and rows of the picture around each.
struct Marks(Vec<(Mark, [Range<usize>; 2])>);

impl Marks {
    fn of(scene: &Scene<'_>, figures: &[(&Figure, Frames)], camera: &Camera) -> Self {
        let mut all = Vec::new();
        let floor = Floor(scene.terrain);
        let is_hidden = matches!(scene.terrain, Terrain::Hidden);
        if !is_hidden {
            all.extend(scene.decals.iter().filter_map(decal));
            all.extend(scene.tubes.iter().filter_map(|tube| tube_shadow(tube, floor)));
        }
        for (figure, frames) in figures.iter().filter(|(figure, _)| !figure.ghost && !is_hidden) {
            shadows(figure, frames, floor, &mut all);
            if scene.support_polygon {
                stance(figure, scene.colors, scene.filmed, &mut all);
            }
        }
        let height = figures.first().map_or(0.0, |(figure, _)| figure.joints.root.y);
        let on_ground = |at: Vec2| {
            let below = floor.surface(Vec3::new(at.x, height, at.y));
            Vec3::new(at.x, below.height_m, at.y)
        };
        let around = |mark: &Mark| camera.around(on_ground(mark.middle), mark.radius * ON_SLOPES);
        Self(all.into_iter().filter_map(|mark| around(&mark).map(|around| (mark, around))).collect())
    }

    fn paint(&self, y: usize, row: &Row, cells: &mut [Cell]) {
        for (mark, [columns, rows]) in &self.0 {
            if rows.contains(&y) {
                for x in columns.start..columns.end.min(cells.len()) {
                    mark.paint(row.spot(x), &mut cells[x].pixel);
                }
            }
        }
    }
}

impl Mark {
    fn paint(&self, (at, px_m): (Vec2, f32), pixel: &mut [u8; 4]) {
        let from_middle = at - self.middle;
        // A spot that is no number is not inside either.
        let is_inside = from_middle.length_squared() < self.radius * self.radius;
        if !is_inside {
            return;
        }
        let px_m = if px_m.is_finite() { px_m } else { RIM_M };
        let opacity = match &self.shape {
            Shape::Shadow { half_axes, along, opacity } => {
                let turned = Vec2::new(from_middle.dot(*along), from_middle.dot(along.perp())) / *half_axes;
                let inside = (1.0 - turned.length_squared()).max(0.0);
                opacity * inside * inside * (3.0 - 2.0 * inside)
            }
            Shape::Disc => rimmed(from_middle.length() - DISC_M, px_m, FILL),
            Shape::Polygon(corners) => rimmed(outside(corners, at), px_m, FILL),
            Shape::Outline(corners) => rimmed(outside_any(corners, at), px_m, PRINT),
        };
        if opacity > LEAST_OPACITY {
            let alpha = pixel[3];
            blend(pixel, self.color, opacity);
            pixel[3] = alpha;
        }
    }
}

/// Opacity of a shape this far beyond its edge (metres), which covers so much inside.
fn rimmed(outside: f32, px_m: f32, fill: f32) -> f32 {
    let cover = |outside: f32| (0.5 - outside / px_m).clamp(0.0, 1.0);
    let rim = cover(outside.abs() - RIM_M.max(px_m) / 2.0);
    (fill * cover(outside)).max(RIM * rim)
}

/// How far a place is outside a convex polygon, metres; negative inside. Two corners make a line.
fn outside(corners: &[Vec2], at: Vec2) -> f32 {
    let edges = (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
    let (mut furthest, mut nearest) = (f32::NEG_INFINITY, f32::INFINITY);
    for (from, to) in edges {
        let edge = to - from;
        let share = ((at - from).dot(edge) / edge.length_squared().max(1e-9)).clamp(0.0, 1.0);
        nearest = nearest.min(at.distance(from + edge * share));
        furthest = furthest.max((at - from).perp_dot(edge));
    }
    if furthest > 0.0 || corners.len() < 3 { nearest } else { -nearest }
}

/// How far a place is outside a polygon of any form, metres; negative inside.
fn outside_any(corners: &[Vec2], at: Vec2) -> f32 {
    let (mut is_inside, mut nearest) = (false, f32::INFINITY);
    for i in 0..corners.len() {
        let (from, to) = (corners[i], corners[(i + 1) % corners.len()]);
        let edge = to - from;
        let share = ((at - from).dot(edge) / edge.length_squared().max(1e-9)).clamp(0.0, 1.0);
        nearest = nearest.min(at.distance(from + edge * share));
        if (from.y > at.y) != (to.y > at.y) && at.x < from.x + edge.x * (at.y - from.y) / edge.y {
            is_inside = !is_inside;
        }
    }
    if is_inside { -nearest } else { nearest }
}

/// A shape to paint; none without three corners.
fn decal(decal: &Decal) -> Option<Mark> {
    let corners: Vec<Vec2> =
        decal.points.iter().filter(|point| point.is_finite()).copied().map(level).collect();
    if corners.len() < 3 {
        return None;
    }
    let middle = corners.iter().sum::<Vec2>() / corners.len() as f32;
    let radius = corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f32::max) + RIM_M * 2.0;
    Some(Mark { shape: Shape::Outline(corners), color: color(decal.color), middle, radius })
}

/// What a tube takes of the sky's light from the ground below it: the higher it is, the wider and fainter.
fn tube_shadow(tube: &Tube, floor: Floor<'_>) -> Option<Mark> {
    let (ends, wide_m) = tube.extent()?;
    let middle = (ends[0] + ends[1]) / 2.0;
    let height_m = (middle.y - floor.surface(middle).height_m - wide_m).max(0.0);
    let soft_m = wide_m + PENUMBRA * height_m;
    let half_length_m = level(ends[1] - ends[0]).length() / 2.0;
    let opacity = TUBE_SHADOW / (1.0 + height_m / (TUBE_SHADOW_HALF * wide_m.max(0.01)));
    Some(shadow(ends, [half_length_m + 1.4 * soft_m, 1.4 * soft_m], opacity))
}

fn level(point: Vec3) -> Vec2 {
    Vec2::new(point.x, point.z)
}

fn shadow(ends: [Vec3; 2], half_axes_m: [f32; 2], opacity: f32) -> Mark {
    let [from, to] = ends.map(level);
    let half_axes = Vec2::from(half_axes_m);
    let along = (to - from).normalize_or(Vec2::X);
    let shape = Shape::Shadow { half_axes, along, opacity };
    Mark { shape, color: Vec3::ZERO, middle: (from + to) / 2.0, radius: half_axes.max_element() }
}

fn shadows(figure: &Figure, frames: &Frames, floor: Floor<'_>, marks: &mut Vec<Mark>) {
    let joints = &figure.joints;
    let scaled = |axes: [f32; 2]| axes.map(|v| v * frames.size);
    let (withers, muzzle) = (joints.tips[bone::SPINE_LAST], joints.tips[bone::HEAD]);
    marks.push(shadow(
        [joints.dock, withers + (withers - joints.root) * 0.2],
        scaled(TRUNK_SHADOW_M),
        TRUNK_SHADOW,
    ));
    marks.push(shadow([withers, muzzle], scaled(HEAD_SHADOW_M), HEAD_SHADOW));
    for limb in Limb::ALL {
        let (toe, fetlock) = (joints.toe(limb), joints.bases[limb.hoof_bone()]);
        let height = (toe.y - floor.surface(toe).height_m).max(0.0) / frames.size;
        let near = (1.0 - height / HOOF_SHADOW_GONE_M).max(0.0);
        marks.push(shadow([toe, fetlock], scaled([HOOF_SHADOW_M, HOOF_SHADOW_M * 0.7]), HOOF_SHADOW * near));
    }
}

/// The polygon between the standing hooves, and a disc under each.
fn stance(figure: &Figure, colors: &FigureColors, filmed: Side, marks: &mut Vec<Mark>) {
    let standing = || Limb::ALL.into_iter().filter(|limb| figure.standing[limb.index()]);
    let mut feet: Vec<Vec2> = standing().map(|limb| level(figure.joints.toe(limb))).collect();
    let middle = feet.iter().sum::<Vec2>() / feet.len().max(1) as f32;
    let angle = |foot: &Vec2| (*foot - middle).to_angle();
    feet.sort_by(|a, b| angle(b).total_cmp(&angle(a)));
    if feet.len() > 1 {
        let radius = feet.iter().map(|foot| foot.distance(middle)).fold(0.0, f32::max) + RIM_M * 2.0;
        marks.push(Mark { shape: Shape::Polygon(feet), color: color(colors.trunk), middle, radius });
    }
    for limb in standing() {
        let color = color(colors.limb(limb, filmed));
        let middle = level(figure.joints.toe(limb));
        marks.push(Mark { shape: Shape::Disc, color, middle, radius: DISC_M + RIM_M * 2.0 });
    }
}

/// A colour to reckon with, 0 to 255.
pub(super) fn color(color: [u8; 3]) -> Vec3 {
    Vec3::from(color.map(f32::from))
}

/// The pixel of a colour, 0 to 255. Adding two to the 23rd leaves the nearest whole number in a float's lowest bits: quicker than a
/// conversion that holds every float.
pub(super) fn opaque(color: Vec3) -> [u8; 4] {
    const LOWEST_BITS: f32 = 8_388_608.0;
    let byte = |v: f32| (v.clamp(0.0, 255.0) + LOWEST_BITS).to_bits() as u8;
    [byte(color.x), byte(color.y), byte(color.z), 255]
}

/// Lays a colour (0 to 255) over a pixel whose alpha is not premultiplied.
#[inline]
pub(super) fn blend(pixel: &mut [u8; 4], over: Vec3, opacity: f32) {
    if opacity >= 1.0 {
        *pixel = opaque(over);
        return;
    }
    let [r, g, b, a] = pixel.map(f32::from);
    let below = a / 255.0 * (1.0 - opacity);
    let alpha = opacity + below;
    if alpha > 0.0 {
        let [r, g, b, _] = opaque((over * opacity + Vec3::new(r, g, b) * below) / alpha);
        *pixel = [r, g, b, (alpha * 255.0 + 0.5) as u8];
    }
}
