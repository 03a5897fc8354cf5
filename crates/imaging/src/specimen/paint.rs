//! Painting layers with tone: flat ones, and rounded ones with light from above.

use image::Luma;
use imageproc::filter::gaussian_blur_f32;

use super::raster::{Field, Mask, Point, Shape, Window, sub};

/// Towards the light, in the picture: mostly from above, a little from the left.
const LIGHT: [f32; 2] = [-0.3, -0.95];
/// Strength of light from the side and of the darker rim, chosen by eye beside the horses of 1887.
const RELIEF: f32 = 0.85;
const RIM: f32 = 0.55;
/// A coat is never blacker than this on a print.
const BLACKEST: f32 = 14.0;
/// Nor is anything brighter than this but bare paper.
const WHITEST: f32 = 226.0;

/// What a layer shows; later ones stand in front of earlier ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Part {
    OffHind,
    OffFore,
    Tail,
    Body,
    NearHind,
    NearFore,
    Rider,
    Hurdle,
}

/// A soft patch of light (or shade, when its gain is negative).
#[derive(Clone, Copy, Debug)]
pub(super) struct Blob {
    pub(super) centre: Point,
    /// From the centre to where it fades, along its longer side, px.
    pub(super) arm: Point,
    /// The same across, px.
    pub(super) across: f64,
    pub(super) gain: f64,
}

impl Blob {
    fn at(&self, point: Point) -> f64 {
        let ([px, py], [ax, ay]) = (sub(point, self.centre), self.arm);
        let length = ax.hypot(ay).max(1e-6);
        let (along, across) = ((px * ax + py * ay) / length, (px * ay - py * ax) / length);
        let far = (along / length).powi(2) + (across / self.across.max(1e-6)).powi(2);
        // Nothing is seen of it beyond three times its reach.
        if far < 9.0 { self.gain * (-far).exp() } else { 0.0 }
    }
}

/// A rounded thing of one tone.
#[derive(Clone, Debug)]
pub(super) struct Layer {
    pub(super) part: Part,
    pub(super) shapes: Vec<Shape>,
    /// How far light reaches round the edge, px.
    pub(super) round_px: f64,
    /// Factor of the coat's tone.
    pub(super) light: f64,
    pub(super) blobs: Vec<Blob>,
    /// Where it grows out of what is behind it, without an edge: centre and radius, px.
    pub(super) root: Option<(Point, f64)>,
}

impl Layer {
    pub(super) fn new(part: Part, shapes: Vec<Shape>, round_px: f64) -> Self {
        Self { part, shapes, round_px, light: 1.0, blobs: Vec::new(), root: None }
    }

    /// Paints the layer and tells what it covers.
    pub(super) fn paint(&self, onto: &mut Canvas, tone: f64, shading: f64) -> Mask {
        let mask = Mask::of(&self.shapes, onto.window, 2.0);
        if mask.window.width == 0 || mask.window.height == 0 {
            return mask;
        }
        let body = gaussian_blur_f32(&mask.cover, self.round_px.max(0.3) as f32);
        let round = self.round_px as f32;
        for (x, y, cover) in mask.cover.enumerate_pixels().filter(|(_, _, cover)| cover.0[0] > 0.0) {
            let at = |dx: i64, dy: i64| {
                let (x, y) = (i64::from(x) + dx, i64::from(y) + dy);
                let inside = x >= 0 && y >= 0;
                body.get_pixel_checked(x as u32, y as u32).filter(|_| inside).map_or(0.0, |p| p.0[0])
            };
            let slope = [at(1, 0) - at(-1, 0), at(0, 1) - at(0, -1)].map(|v| 0.5 * round * v);
            let lit = -(slope[0] * LIGHT[0] + slope[1] * LIGHT[1]);
            let place = [f64::from(mask.window.left + x) + 0.5, f64::from(mask.window.top + y) + 0.5];
            let blobs: f64 = self.blobs.iter().map(|blob| blob.at(place)).sum();
            let shade = RELIEF * lit + RIM * (at(0, 0) - 0.8) + blobs as f32;
            let value =
                ((tone * self.light) as f32 * (1.0 + shading as f32 * shade)).clamp(BLACKEST, WHITEST);
            onto.blend(mask.window.left + x, mask.window.top + y, value, cover.0[0] * self.grown_out(place));
        }
        mask
    }

    /// How much of the layer is seen at a place: nothing at its root, all of it away from there.
    fn grown_out(&self, place: Point) -> f32 {
        self.root.map_or(1.0, |(centre, radius)| {
            let share =
                (2.0 * (sub(place, centre)[0].hypot(sub(place, centre)[1]) / radius - 0.5)).clamp(0.0, 1.0);
            (share * share * (3.0 - 2.0 * share)) as f32
        })
    }
}

/// Tones of a window of the plate, 0 to 255.
#[derive(Clone, Debug)]
pub(super) struct Canvas {
    pub(super) window: Window,
    pub(super) tones: Field,
}

impl Canvas {
    pub(super) fn new(window: Window, tone: f64) -> Self {
        Self { window, tones: Field::from_pixel(window.width, window.height, Luma([tone as f32])) }
    }

    /// Lays a tone over a pixel of the plate; the pixel must lie in the window.
    fn blend(&mut self, x: u32, y: u32, tone: f32, opacity: f32) {
        let (x, y) = (x - self.window.left, y - self.window.top);
        let here = &mut self.tones.get_pixel_mut(x, y).0[0];
        *here += (tone - *here) * opacity;
    }

    /// Lays one tone over a region.
    pub(super) fn fill(&mut self, shapes: &[Shape], tone: f64, opacity: f64) {
        let mask = Mask::of(shapes, self.window, 1.0);
        self.lay(&mask, |_, _| tone as f32, opacity);
    }

    /// Lays one tone over a region with soft edges: `soft_px` is the standard deviation of the blur.
    pub(super) fn shade(&mut self, shapes: &[Shape], tone: f64, opacity: f64, soft_px: f64) {
        let mut mask = Mask::of(shapes, self.window, 3.0 * soft_px);
        if mask.window.width > 0 && mask.window.height > 0 && soft_px > 0.0 {
            mask.cover = gaussian_blur_f32(&mask.cover, soft_px as f32);
        }
        self.lay(&mask, |_, _| tone as f32, opacity);
    }

    /// Lays tones over a region: a function of the mask's pixel.
    pub(super) fn lay(&mut self, mask: &Mask, tone: impl Fn(u32, u32) -> f32, opacity: f64) {
        for (x, y, cover) in mask.cover.enumerate_pixels().filter(|(_, _, cover)| cover.0[0] > 0.0) {
            self.blend(mask.window.left + x, mask.window.top + y, tone(x, y), cover.0[0] * opacity as f32);
        }
    }
}
