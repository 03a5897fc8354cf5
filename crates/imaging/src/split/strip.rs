//! The tones along an edge of a photograph, read along lines across it.

use std::ops::Range;

use image::GrayImage;

use super::edge::RoughEdge;
use super::fold::Fold;
use super::mount::Tones;
use super::{Point, SD_PER_MEDIAN, median};

/// Lines across an edge along which tones are read.
pub(super) const SCAN_LINES: usize = 64;
/// Neighbouring lines averaged into one.
const THICKNESS: usize = 4;
/// Share of the edge at either end that is not read: corners are ragged.
const CORNER: f64 = 0.03;
/// Depth of the window inside and outside the rough edge, in panel sizes.
const DEPTH: f64 = 0.08;
/// Share of the mount outside that is read at most.
const OUTSIDE: f64 = 0.8;
/// Steps of the window per depth.
const STEPS: f64 = 40.0;
/// Fewest samples across an edge among which there can be one.
const LEAST_SAMPLES: usize = 8;
/// Share of the depth that is surely photograph.
const INNER: f64 = 0.7;
/// Departure from the mount's tone that counts in full: this share of the photograph's.
const CLEAR: f64 = 0.4;
/// At least these many standard deviations of the mount, and at least and most in grey values.
const NOISE: f64 = 4.0;
const LEAST_CONTRAST: f64 = 6.0;
const MOST_CONTRAST: f64 = 40.0;

/// Samples along lines across an edge, outermost first.
pub(super) struct Strip {
    /// Distance of neighbouring samples, px.
    pub(super) step_px: f64,
    /// Place of the first sample, px inwards of the rough edge.
    pub(super) first_px: f64,
    /// Grey values; not a number beyond the plate's border.
    pub(super) tones: Vec<Vec<f64>>,
    /// Departures from the mount's tone: 0 like mount to 1 unlike.
    pub(super) departures: Vec<Vec<f64>>,
}

/// Place of a scan line along the edge, -0.5..0.5.
pub(super) fn along(line: usize) -> f64 {
    ((line as f64 + 0.5) / SCAN_LINES as f64 - 0.5) * (1.0 - 2.0 * CORNER)
}

impl Strip {
    /// Reads the tones near a rough edge; none when it is too short or lies beyond the plate.
    pub(super) fn read(plate: &GrayImage, folds: &[Fold], rough: &RoughEdge) -> Option<Self> {
        let depth = DEPTH * rough.size_px;
        let step_px = (depth / STEPS).max(1.0);
        let [near, far] = rough.mount_px;
        let outside = depth.min(OUTSIDE * far.max(2.0));
        let first_px = -(outside / step_px).round() * step_px;
        let count = ((depth - first_px) / step_px).round() as usize + 1;
        let at = |i: usize| first_px + step_px * i as f64;
        let scan = |line: usize| (0..count).map(|i| mean_tone(plate, folds, rough, line, at(i))).collect();
        let tones: Vec<Vec<f64>> = (0..SCAN_LINES).map(scan).collect();
        if count < LEAST_SAMPLES || tones.iter().flatten().all(|tone| tone.is_nan()) {
            return None;
        }
        // Mount is surest half way to what lies beyond it.
        let quarter = 0.25 * (far - near).max(0.0);
        let outermost = outside.min(far - quarter);
        let innermost = (near + quarter).min(outermost - 2.0 * step_px);
        let index = |px: f64| (((-px - first_px) / step_px).round().max(0.0) as usize).min(count - 1);
        let outer = index(outermost)..index(innermost) + 1;
        let inner = count - ((INNER * depth / step_px) as usize).min(count)..count;
        let departures = departures(&tones, rough.mount, outer, inner);
        Some(Self { step_px, first_px, tones, departures })
    }

    /// Samples of each line.
    pub(super) fn count(&self) -> usize {
        self.departures[0].len()
    }

    /// Where a scan line meets a line at an offset that leans by so much from end to end, px; in samples.
    pub(super) fn crossing(&self, [offset, lean]: [f64; 2], line: usize) -> f64 {
        (offset + lean * along(line) - self.first_px) / self.step_px
    }
}

/// Departures from the mount, whose tone is that of the outer samples; the inner are photograph.
fn departures(
    tones: &[Vec<f64>],
    expected: Tones,
    outer: Range<usize>,
    inner: Range<usize>,
) -> Vec<Vec<f64>> {
    let samples =
        |range: Range<usize>| tones.iter().flat_map(move |line| line[range.clone()].iter().copied());
    let mount: Vec<f64> = samples(outer).filter(|tone| expected.has(*tone)).collect();
    let middle = if mount.is_empty() { expected.usual } else { median(mount.clone()) };
    let spread = SD_PER_MEDIAN * median(mount.iter().map(|tone| (tone - middle).abs()).collect());
    let contrast = samples(inner).filter(|tone| !tone.is_nan()).map(|tone| (tone - middle).abs());
    let least = (NOISE * spread).clamp(LEAST_CONTRAST, MOST_CONTRAST);
    let full = (CLEAR * median(contrast.collect())).clamp(least, MOST_CONTRAST);
    let departure = |tone: &f64| if tone.is_nan() { 0.0 } else { ((tone - middle).abs() / full).min(1.0) };
    tones.iter().map(|line| line.iter().map(departure).collect()).collect()
}

/// Mean of a few points along the edge at a place across it.
fn mean_tone(plate: &GrayImage, folds: &[Fold], rough: &RoughEdge, line: usize, inwards_px: f64) -> f64 {
    let spacing = (1.0 - 2.0 * CORNER) / (SCAN_LINES * THICKNESS) as f64;
    let sum: f64 = (0..THICKNESS)
        .map(|k| {
            let share = 0.5 + along(line) + (k as f64 - 0.5 * (THICKNESS - 1) as f64) * spacing;
            let point = rough.point(share, inwards_px);
            if folds.iter().any(|fold| fold.covers(point)) { rough.mount.usual } else { tone(plate, point) }
        })
        .sum();
    sum / THICKNESS as f64
}

/// Grey value at a point, between four pixels; not a number outside the plate.
fn tone(plate: &GrayImage, [x, y]: Point) -> f64 {
    let (width, height) = (plate.width() as usize, plate.height() as usize);
    if !(x >= 0.0 && y >= 0.0 && x < width as f64 && y < height as f64) {
        return f64::NAN;
    }
    let (x, y) = ((x - 0.5).max(0.0), (y - 0.5).max(0.0));
    let (x0, y0) = (x as usize, y as usize);
    let (x1, y1) = ((x0 + 1).min(width - 1), (y0 + 1).min(height - 1));
    let (fx, fy) = (x - x0 as f64, y - y0 as f64);
    let pixels = plate.as_raw();
    let at = |x: usize, y: usize| f64::from(pixels[y * width + x]);
    (1.0 - fy) * ((1.0 - fx) * at(x0, y0) + fx * at(x1, y0))
        + fy * ((1.0 - fx) * at(x0, y1) + fx * at(x1, y1))
}
