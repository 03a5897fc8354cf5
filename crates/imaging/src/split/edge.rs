//! The straight edge of one photograph, found on the plate itself to a fraction of a pixel.

use image::GrayImage;

use super::fold::Fold;
use super::layout::median;

/// Lines across an edge along which tones are read.
const SCAN_LINES: usize = 64;
/// Share of the edge at either end that is not read: corners are ragged.
const CORNER: f64 = 0.03;
/// Neighbouring lines averaged into one.
const THICKNESS: usize = 4;
/// Depth of the window inside and outside the rough edge, in panel sizes.
const DEPTH: f64 = 0.08;
/// Steps of the window per depth.
const STEPS: f64 = 40.0;
/// Depth of the photograph just inside its edge that must differ from the mount, in panel sizes.
const RIM: f64 = 0.02;
/// How far from its edge a ragged photograph may begin and still be seen there, in panel sizes.
const SLACK: f64 = 0.012;
/// Neighbouring samples unlike the mount that are a photograph rather than a speck.
const PHOTOGRAPH: usize = 3;
/// Rounds of fitting a line and leaving out what is far from it.
const ROUNDS: usize = 3;
/// Most an edge leans against its rough place, in edge lengths.
const LEAN: f64 = 0.025;
/// Departure from the mount's tone that counts in full: this share of the photograph's.
const CLEAR: f64 = 0.4;
/// At least these many standard deviations of the mount, and at least and most in grey values.
const NOISE: f64 = 4.0;
const LEAST_CONTRAST: f64 = 6.0;
const MOST_CONTRAST: f64 = 40.0;
/// Standard deviation of a normal variable per median of its distance from the middle.
const NORMAL_PER_MEDIAN: f64 = 1.4826;
/// Worth lost by an edge at the window's rim against one at its middle.
const FAR: f64 = 0.1;

type Point = [f64; 2];

/// A rough edge: its ends in plate px, clockwise round the panel, and the panel's size across it.
#[derive(Clone, Copy, Debug)]
pub(super) struct RoughEdge {
    pub(super) ends: [Point; 2],
    pub(super) size_px: f64,
    /// Where outside there is only mount: nearest and farthest, px from the rough edge.
    pub(super) mount_px: [f64; 2],
}

/// An edge as seen on the plate.
#[derive(Clone, Copy, Debug)]
pub(super) struct SeenEdge {
    /// Its ends, plate px, where the rough edge's were.
    pub(super) ends: [Point; 2],
    /// Share of its length along which the tone steps from mount to photograph there, 0..1.
    pub(super) seen: f64,
}

/// Departures from the mount's tone, 0 like mount to 1 unlike, along lines across the edge, outermost first.
struct Strip {
    step_px: f64,
    /// Position of the first sample, px inwards of the rough edge.
    first_px: f64,
    departures: Vec<Vec<f64>>,
    /// Grey values of the same samples.
    tones: Vec<Vec<f64>>,
}

/// Finds the edge near its rough place; the rough place with nothing seen when nothing is there.
pub(super) fn find(plate: &GrayImage, folds: &[Fold], rough: RoughEdge) -> SeenEdge {
    let unseen = SeenEdge { ends: rough.ends, seen: 0.0 };
    let Some(strip) = Strip::read(plate, folds, rough) else { return unseen };
    let rim = ((RIM * rough.size_px / strip.step_px).round() as usize).max(2);
    let (offset, lean) = strip.refined(strip.best_line(rim), rim);
    let seen = strip.seen((offset, lean), 1.0 + SLACK * rough.size_px / strip.step_px);
    let inwards = inwards(rough.ends);
    let moved = |end: Point, by: f64| [end[0] + inwards[0] * by, end[1] + inwards[1] * by];
    let ends = [moved(rough.ends[0], offset - 0.5 * lean), moved(rough.ends[1], offset + 0.5 * lean)];
    SeenEdge { ends, seen }
}

/// Unit vector into the panel, whose outline runs clockwise.
fn inwards([[ax, ay], [bx, by]]: [Point; 2]) -> Point {
    let length = (bx - ax).hypot(by - ay).max(f64::MIN_POSITIVE);
    [-(by - ay) / length, (bx - ax) / length]
}

/// Place of a scan line along the edge, -0.5..0.5.
fn along(line: usize) -> f64 {
    let share = (line as f64 + 0.5) / SCAN_LINES as f64;
    (share - 0.5) * (1.0 - 2.0 * CORNER)
}

impl Strip {
    fn read(plate: &GrayImage, folds: &[Fold], rough: RoughEdge) -> Option<Self> {
        let depth = DEPTH * rough.size_px;
        let step_px = (depth / STEPS).max(1.0);
        let [near, far] = rough.mount_px;
        let outside = depth.min(0.8 * far.max(2.0));
        let first_px = -(outside / step_px).round() * step_px;
        let count = ((depth - first_px) / step_px).round() as usize + 1;
        let inwards = inwards(rough.ends);
        let [a, b] = rough.ends;
        let tones: Vec<Vec<f64>> = (0..SCAN_LINES)
            .map(|line| {
                let width = (1.0 - 2.0 * CORNER) / (SCAN_LINES * THICKNESS) as f64;
                (0..count)
                    .map(|i| {
                        let o = first_px + step_px * i as f64;
                        let sum: f64 = (0..THICKNESS)
                            .map(|k| {
                                let share = 0.5 + along(line) + (k as f64 - 0.5 * (THICKNESS - 1) as f64) * width;
                                let at = |axis: usize| a[axis] + share * (b[axis] - a[axis]) + o * inwards[axis];
                                if folds.iter().any(|f| f.covers([at(0), at(1)])) { f64::NAN } else { tone(plate, [at(0), at(1)]) }
                            })
                            .sum();
                        sum / THICKNESS as f64
                    })
                    .collect()
            })
            .collect();
        if tones.iter().flatten().all(|v| v.is_nan()) {
            return None;
        }
        let safe = 0.5 * (near + far).min(outside + near);
        let outer = ((-safe - first_px) / step_px).max(2.0) as usize;
        Some(Self { step_px, first_px, departures: departures(&tones, outer, (0.7 * depth / step_px) as usize), tones })
    }

    fn count(&self) -> usize {
        self.departures[0].len()
    }

    /// Index of a line's crossing with a scan line.
    fn index(&self, offset: f64, lean: f64, line: usize) -> f64 {
        (offset + lean * along(line) - self.first_px) / self.step_px
    }

    /// Offset and lean, px, of the line with most photograph just inside and least outside.
    fn best_line(&self, rim: usize) -> (f64, f64) {
        let sums: Vec<Vec<f64>> = self
            .departures
            .iter()
            .map(|line| {
                let mut sum = 0.0;
                std::iter::once(0.0)
                    .chain(line.iter().map(|v| {
                        sum += v;
                        sum
                    }))
                    .collect()
            })
            .collect();
        let length = self.step_px * self.count() as f64;
        let most_lean = LEAN * length / DEPTH;
        let leans = (most_lean / self.step_px).ceil() as isize;
        let mut best = (f64::MIN, 0.0, 0.0);
        for position in 1..self.count() - rim {
            let offset = self.first_px + self.step_px * position as f64;
            for step in -leans..=leans {
                let lean = self.step_px * step as f64;
                let worth: f64 =
                    sums.iter().enumerate().map(|(l, sums)| step_worth(sums, self.index(offset, lean, l), rim)).sum();
                let worth = worth / SCAN_LINES as f64 - FAR * (offset / length).abs();
                if worth > best.0 {
                    best = (worth, offset, lean);
                }
            }
        }
        (best.1, best.2)
    }

    /// The line through the crossings of half tone near a line, those far from it left out.
    fn refined(&self, (mut offset, mut lean): (f64, f64), rim: usize) -> (f64, f64) {
        for _ in 0..ROUNDS {
            let crossings: Vec<Point> = (0..SCAN_LINES)
                .filter_map(|line| {
                    let near = self.index(offset, lean, line);
                    let foot = crossing(&self.departures[line], near, 2.0 + 0.25 * rim as f64, rim)?;
                    let at = half_way(&self.tones[line], foot, rim);
                    Some([along(line), self.first_px + self.step_px * at])
                })
                .collect();
            if let Some(line) = straight(&crossings) {
                (offset, lean) = line;
            }
        }
        (offset, lean)
    }

    /// Share of scan lines on which the photograph begins near a line, coming from the mount.
    fn seen(&self, (offset, lean): (f64, f64), slack: f64) -> f64 {
        let is_seen = |line: usize| {
            let at = self.index(offset, lean, line);
            // Beyond the plate's border the tone is not a number.
            let first = self.tones[line].iter().position(|tone| !tone.is_nan());
            let begins = self.departures[line].windows(PHOTOGRAPH).position(|run| run.iter().all(|d| *d >= 0.5));
            first.is_some_and(|first| (first as f64) < at)
                && begins.is_some_and(|begins| begins > 0 && (begins as f64 - at).abs() <= slack)
        };
        (0..SCAN_LINES).filter(|line| is_seen(*line)).count() as f64 / SCAN_LINES as f64
    }
}

/// Departure from the mount just inside a place less that outside it.
fn step_worth(sums: &[f64], at: f64, rim: usize) -> f64 {
    let last = sums.len() - 1;
    let at = at.round().clamp(0.0, last as f64) as usize;
    let inside = (at + rim).min(last);
    let mean = |from: usize, to: usize| if to > from { (sums[to] - sums[from]) / (to - from) as f64 } else { 0.0 };
    mean(at, inside) - mean(0, at)
}

/// Where a scan line steps up nearest to a place, in samples; none when it does not.
fn crossing(line: &[f64], near: f64, reach: f64, rim: usize) -> Option<f64> {
    let last = line.len() - 1;
    let from = (near - reach).floor().max(0.0) as usize;
    let to = ((near + reach).ceil().max(0.0) as usize).min(last);
    let mut best: Option<(f64, f64)> = None;
    for i in from..to {
        let (low, high) = (line[i], line[i + 1]);
        if !(low < 0.5 && high >= 0.5) {
            continue;
        }
        let at = i as f64 + (0.5 - low) / (high - low);
        let inside = &line[i + 1..(i + 1 + rim).min(line.len())];
        if inside.iter().sum::<f64>() < 0.5 * inside.len() as f64 {
            continue;
        }
        if best.is_none_or(|(distance, _)| (at - near).abs() < distance) {
            best = Some(((at - near).abs(), at));
        }
    }
    best.map(|(_, at)| at)
}

/// Where the tone is half way between the mount before a place and the photograph behind it, in samples.
fn half_way(tones: &[f64], foot: f64, rim: usize) -> f64 {
    let foot_index = foot as usize;
    let before = median(tones[foot_index.saturating_sub(rim)..=foot_index].to_vec());
    let behind = median(tones[(foot_index + 2).min(tones.len() - 1)..(foot_index + 2 + rim).min(tones.len())].to_vec());
    let half = 0.5 * (before + behind);
    let side = |i: usize| (tones[i] - half) * (behind - before);
    (foot_index..(foot_index + rim).min(tones.len() - 1))
        .find(|i| side(*i) < 0.0 && side(i + 1) >= 0.0)
        .map_or(foot, |i| i as f64 + side(i) / (side(i) - side(i + 1)))
}

/// Offset and lean of the line through points, by the median of slopes and of offsets; none of fewer than a few.
fn straight(points: &[Point]) -> Option<(f64, f64)> {
    if points.len() < 6 {
        return None;
    }
    let half = points.len() / 2;
    let slopes = (0..points.len() - half).map(|i| {
        let ([x0, y0], [x1, y1]) = (points[i], points[i + half]);
        (y1 - y0) / (x1 - x0)
    });
    let lean = median(slopes.collect());
    Some((median(points.iter().map(|[x, y]| y - lean * x).collect()), lean))
}

/// Departures from the mount, whose tone is that of the outermost samples; the innermost are photograph.
fn departures(tones: &[Vec<f64>], outer: usize, inner: usize) -> Vec<Vec<f64>> {
    let known = |samples: &mut dyn Iterator<Item = f64>| samples.filter(|tone| !tone.is_nan()).collect::<Vec<f64>>();
    let mount = known(&mut tones.iter().flat_map(|line| line.iter().take(outer).copied()));
    let photograph = known(&mut tones.iter().flat_map(|line| line.iter().rev().take(inner).copied()));
    let middle = median(mount.clone());
    let spread = NORMAL_PER_MEDIAN * median(mount.iter().map(|tone| (tone - middle).abs()).collect());
    let contrast = median(photograph.iter().map(|tone| (tone - middle).abs()).collect());
    let full = (CLEAR * contrast).clamp((NOISE * spread).clamp(LEAST_CONTRAST, MOST_CONTRAST), MOST_CONTRAST);
    let departure = |tone: &f64| if tone.is_nan() { 0.0 } else { ((tone - middle).abs() / full).min(1.0) };
    tones.iter().map(|line| line.iter().map(departure).collect()).collect()
}

/// Grey value at a point between four pixels; not a number outside the plate.
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
    (1.0 - fy) * ((1.0 - fx) * at(x0, y0) + fx * at(x1, y0)) + fy * ((1.0 - fx) * at(x0, y1) + fx * at(x1, y1))
}
