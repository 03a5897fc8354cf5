//! Straight, nearly upright lines of a wall: a Hough search over their two ends, then least squares.

use image::{GrayImage, Luma};

use super::Plane;

/// Strips the picture is averaged into, top to bottom: short enough that a leaning line stays within two pixels.
const STRIPS: u32 = 48;
/// Columns that are searched at most; wider pictures are searched at every second or third pixel.
const COLUMNS: u32 = 450;
/// A line is darker (or lighter) than what lies this far to both sides of its middle, shares of the width: the thin
/// rules of a gridded wall, and the boards that part it.
const REACHES: [f64; 2] = [0.006, 0.013];
/// Response over noise that counts fully; more says nothing more about a line.
const MOST_RESPONSE: f32 = 4.0;
/// Response over noise below which a strip speaks against the line.
const LEAST_RESPONSE: f32 = 1.5;

/// In place of a response: cannot be seen.
const HIDDEN: f32 = -1.0;
/// Difference of tone that counts fully in a line's place.
const MOST_DEPTH: f64 = 40.0;

/// Darker or lighter than its surroundings.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tone {
    Dark,
    Light,
}

/// What to search for.
#[derive(Clone, Copy, Debug)]
pub(super) struct Search {
    /// Steepest lean, px across per px down.
    pub(super) lean: f64,
    /// Shortest line, share of the height.
    pub(super) length: f64,
}

/// A line found: `x = at + lean * y`, between two heights, px.
#[derive(Clone, Copy, Debug)]
pub(super) struct Upright {
    pub(super) at: f64,
    pub(super) lean: f64,
    pub(super) from: f64,
    pub(super) to: f64,
    /// Breadth, px.
    pub(super) breadth: f64,
    /// Difference of tone from both sides.
    pub(super) depth: f64,
    pub(super) confidence: f64,
}

impl Upright {
    pub(super) fn x(&self, y: f64) -> f64 {
        self.at + self.lean * y
    }
}

/// The picture averaged over strips of rows and a few columns.
struct Strips {
    mean: Plane,
    /// Pixels per column and per strip.
    pixel: [f64; 2],
}

impl Strips {
    fn new(image: &GrayImage) -> Self {
        let (width, height) = image.dimensions();
        let pixel = [width.div_ceil(COLUMNS), height.div_ceil(STRIPS)];
        let (columns, rows) =
            (width.div_ceil(pixel[0].max(1)) as usize, height.div_ceil(pixel[1].max(1)) as usize);
        let mut mean = vec![0.0; columns * rows];
        for (y, row) in image.as_raw().chunks_exact(width.max(1) as usize).enumerate() {
            let strip = y / pixel[1] as usize * columns;
            for (sums, values) in mean[strip..].iter_mut().zip(row.chunks(pixel[0] as usize)) {
                *sums += values.iter().map(|v| f32::from(*v)).sum::<f32>() / values.len() as f32;
            }
        }
        for (y, row) in mean.chunks_exact_mut(columns.max(1)).enumerate() {
            let rows = (height - y as u32 * pixel[1]).min(pixel[1]) as f32;
            row.iter_mut().for_each(|sum| *sum /= rows);
        }
        let mean = Plane::from_raw(columns as u32, rows as u32, mean).unwrap_or_default();
        Self { mean, pixel: pixel.map(f64::from) }
    }

    /// How much each place stands out between its two sides, over the noise; 0 to [`MOST_RESPONSE`].
    fn response(&self, tone: Tone, width: u32) -> Plane {
        let mut best = Plane::new(self.mean.width(), self.mean.height());
        for reach in REACHES.map(|share| ((share * f64::from(width) / self.pixel[0]).round() as u32).max(2)) {
            let ridge = self.ridge(tone, reach);
            let mut sizes: Vec<f32> = ridge.pixels().map(|p| p.0[0].abs()).collect();
            let noise = super::quantile(&mut sizes, 0.5).max(0.5) * 1.5;
            for (best, ridge) in best.pixels_mut().zip(ridge.pixels()) {
                best.0[0] = best.0[0].max((ridge.0[0] / noise).clamp(0.0, MOST_RESPONSE));
            }
        }
        best
    }

    /// Marks columns of strips that are mostly hidden.
    fn hide(&self, response: &mut Plane, hidden: &GrayImage) {
        for (x, y, value) in response.enumerate_pixels_mut() {
            let [column, row] = [x, y].map(|k| f64::from(k) + 0.5);
            if is_hidden(hidden, column * self.pixel[0], (row * self.pixel[1]) as u32) {
                value.0[0] = HIDDEN;
            }
        }
    }

    fn ridge(&self, tone: Tone, reach: u32) -> Plane {
        let last = self.mean.width() - 1;
        Plane::from_fn(self.mean.width(), self.mean.height(), |x, y| {
            let at = |x: u32| self.mean.get_pixel(x, y).0[0];
            let (left, right) = (at(x.saturating_sub(reach)), at((x + reach).min(last)));
            if x < reach || x + reach > last {
                return Luma([0.0]);
            }
            Luma([match tone {
                Tone::Dark => left.min(right) - at(x),
                Tone::Light => at(x) - left.max(right),
            }])
        })
    }
}

/// A line through the strips: columns at the first and last strip, and the part that is seen.
#[derive(Clone, Copy)]
struct Candidate {
    top: f64,
    bottom: f64,
    run: Run,
}

/// Strips in which a line is seen.
#[derive(Clone, Copy, Default)]
struct Run {
    from: usize,
    to: usize,
    /// Strips between them that are not hidden.
    seen: usize,
    /// How much speaks for the line.
    worth: f32,
}

/// All lines of a tone, left to right. What is hidden (above 0) speaks neither for a line nor against it.
pub(super) fn find(
    image: &GrayImage,
    hidden: Option<&GrayImage>,
    tone: Tone,
    search: Search,
) -> Vec<Upright> {
    let strips = Strips::new(image);
    let mut response = strips.response(tone, image.width());
    if let Some(hidden) = hidden {
        strips.hide(&mut response, hidden);
    }
    let mut candidates = candidates(&response, &strips, search);
    candidates.sort_by(|a, b| b.run.worth.total_cmp(&a.run.worth));
    let mut kept: Vec<Candidate> = Vec::new();
    let apart = REACHES[1] * f64::from(image.width()) / strips.pixel[0];
    for candidate in candidates {
        let clear = kept.iter().all(|k| {
            let (top, bottom) = (candidate.top - k.top, candidate.bottom - k.bottom);
            top * bottom > 0.0 && (0.5 * (top + bottom)).abs() >= apart.max(3.0)
        });
        if clear {
            kept.push(candidate);
        }
    }
    let mut lines: Vec<Upright> = kept.iter().map(|c| refined(image, hidden, tone, &strips, c)).collect();
    lines.retain(|line| line.lean.abs() <= search.lean);
    lines.sort_by(|a, b| a.at.total_cmp(&b.at));
    lines
}

fn candidates(response: &Plane, strips: &Strips, search: Search) -> Vec<Candidate> {
    let (columns, rows) = (response.width() as i64, response.height() as usize);
    let shortest = (search.length * rows as f64).ceil() as usize;
    let most = (search.lean * rows as f64 * strips.pixel[1] / strips.pixel[0]).round() as i64;
    let values: Vec<&[f32]> = response.as_raw().chunks_exact(response.width().max(1) as usize).collect();
    let mut all = Vec::new();
    // Neighbouring columns are averaged over: every second lean is enough.
    for shift in (-most..=most).step_by(2) {
        let top = -0.5 * shift as f64;
        let step = shift as f64 / (rows.max(2) - 1) as f64;
        let offsets: Vec<i64> = (0..rows).map(|row| (top + step * row as f64).round() as i64).collect();
        for column in 0..columns {
            let run = best_run(values.iter().zip(&offsets).map(|(row, offset)| {
                usize::try_from(column + offset).ok().and_then(|x| row.get(x)).copied().unwrap_or(0.0)
            }));
            if run.seen >= shortest {
                let top = column as f64 + top;
                all.push(Candidate { top, bottom: top + shift as f64, run });
            }
        }
    }
    all
}

/// The run of strips that speaks most for a line (Kadane's algorithm).
fn best_run(responses: impl Iterator<Item = f32>) -> Run {
    let mut best = Run::default();
    let mut run = Run::default();
    for (row, response) in responses.enumerate().filter(|(_, response)| *response != HIDDEN) {
        if run.worth <= 0.0 {
            run = Run { from: row, ..Run::default() };
        }
        run.to = row + 1;
        run.seen += 1;
        run.worth += response - LEAST_RESPONSE;
        if run.worth > best.worth {
            best = run;
        }
    }
    best
}

/// Least squares through the middles of the line in each strip, with weights that fall with the distance.
fn refined(
    image: &GrayImage,
    hidden: Option<&GrayImage>,
    tone: Tone,
    strips: &Strips,
    candidate: &Candidate,
) -> Upright {
    let [pixel_x, pixel_y] = strips.pixel;
    let rows = f64::from(strips.mean.height()).max(2.0) - 1.0;
    let lean_in_columns = (candidate.bottom - candidate.top) / rows;
    let lean = lean_in_columns * pixel_x / pixel_y;
    let at = (candidate.top + 0.5) * pixel_x - lean * 0.5 * pixel_y;
    let (from, to) = (candidate.run.from as f64 * pixel_y, candidate.run.to as f64 * pixel_y);
    let to = to.min(f64::from(image.height()));
    let confidence =
        f64::from(candidate.run.worth) / f64::from((MOST_RESPONSE - LEAST_RESPONSE) * STRIPS as f32);
    let mut line = Upright { at, lean, from, to, breadth: 1.0, depth: 0.0, confidence: confidence.min(1.0) };
    let reach = (REACHES[1] * f64::from(image.width())).max(3.0);
    for pass in 0..3 {
        let middles: Vec<_> = (from as u32..to as u32)
            .filter(|row| hidden.is_none_or(|hidden| !is_hidden(hidden, line.x(f64::from(*row) + 0.5), *row)))
            .filter_map(|row| middle(image, tone, row, line.x(f64::from(row) + 0.5), reach))
            .collect();
        let spread = [3.0, 2.0, 1.5][pass] * (1.0f64).max(line.breadth / 3.0);
        let Some((at, lean)) = fitted(&middles, &line, spread) else { break };
        (line.at, line.lean) = (at, lean);
        let mut breadths: Vec<f32> = middles.iter().map(|m| m.breadth as f32).collect();
        line.breadth = f64::from(super::quantile(&mut breadths, 0.5));
        let mut depths: Vec<f32> = middles.iter().map(|m| m.depth as f32).collect();
        line.depth = f64::from(super::quantile(&mut depths, 0.5));
    }
    line
}

fn is_hidden(hidden: &GrayImage, x: f64, y: u32) -> bool {
    x >= 0.0 && hidden.get_pixel_checked(x as u32, y).is_some_and(|pixel| pixel.0[0] > 0)
}

/// Where the line crosses one row.
struct Middle {
    x: f64,
    y: f64,
    depth: f64,
    breadth: f64,
}

fn middle(image: &GrayImage, tone: Tone, row: u32, x: f64, reach: f64) -> Option<Middle> {
    let first = (x - reach).floor();
    let last = (x + reach).ceil();
    if first < 0.0 || last >= f64::from(image.width()) {
        return None;
    }
    let at = |column: u32| f64::from(image.get_pixel(column, row).0[0]);
    let (first, last) = (first as u32, last as u32);
    let side = |a: u32| 0.5 * (at(a) + at(a + 1));
    let (left, right) = (side(first), side(last - 1));
    let (mut sum, mut moment, mut peak) = (0.0, 0.0, 0.0f64);
    for column in first..=last {
        let t = f64::from(column - first) / f64::from(last - first);
        let ground = left + (right - left) * t;
        let depth = match tone {
            Tone::Dark => ground - at(column),
            Tone::Light => at(column) - ground,
        }
        .max(0.0);
        sum += depth;
        peak = peak.max(depth);
        moment += depth * (f64::from(column) + 0.5);
    }
    (peak >= 4.0).then(|| Middle {
        x: moment / sum,
        y: f64::from(row) + 0.5,
        depth: peak,
        breadth: sum / peak,
    })
}

fn fitted(middles: &[Middle], line: &Upright, spread: f64) -> Option<(f64, f64)> {
    let (mut w, mut wy, mut wyy, mut wx, mut wxy) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for m in middles {
        let off = (m.x - line.x(m.y)) / spread;
        let weight = m.depth.min(MOST_DEPTH) / (1.0 + off * off).powi(2);
        w += weight;
        wy += weight * m.y;
        wyy += weight * m.y * m.y;
        wx += weight * m.x;
        wxy += weight * m.x * m.y;
    }
    let determinant = w * wyy - wy * wy;
    (determinant > 1e-6 * w * w).then(|| {
        let lean = (w * wxy - wy * wx) / determinant;
        ((wx - lean * wy) / w, lean)
    })
}
