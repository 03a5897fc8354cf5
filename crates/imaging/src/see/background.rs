//! The picture without the horse: the wall as far as its light changes gently, and below it the track, row by row.

use std::ops::Range;

use image::Luma;

use super::{Plane, quantile};

/// Cells along the longer side: a few to a horse's leg, so that a cell of wall beside one still shows mostly wall.
const CELLS: u32 = 28;
/// Neighbouring cells of wall differ by so many times what they usually differ by, ...
const GENTLE: f32 = 4.0;
/// ... and by a part of their tone between these.
const GENTLE_PART: [f32; 2] = [0.03, 0.12];
/// In the topmost rows, this share of the height, where no horse is, the light may fall this fast from cell to cell: a shadow over half the panel.
const RIM_STEP: f32 = 0.3;
/// See [`RIM_STEP`].
const TOP: f64 = 0.1;
/// The rim's cells that are wall differ by less than this part of their tone.
const RIM: f32 = 0.12;
/// Share of the height at the top, and of the width at the sides, where the wall's tone is looked for.
const RIM_WIDTH: f64 = 0.18;
/// The track is looked for below this share of the height.
const TRACK: f64 = 0.6;
/// So many rows like the wall end the track, share of the height.
const GAP: f64 = 0.03;
/// Legs and shadows cover less than this share of a row of the track.
const ROW_SHARE: f64 = 0.7;
/// Rounds that carry the wall's tone across the horse.
const ROUNDS: usize = 60;
/// The track's edge is blurred over so many rows.
const BLURRED: u32 = 3;
/// A row of the track is looked at in so many blocks: panels may be turned a little.
const BLOCKS: u32 = 5;
/// Least standard deviation, grey values: stains are no less, however fine the grain.
const LEAST_NOISE: f32 = 1.5;

/// What a panel would be without the horse.
#[derive(Clone)]
pub(super) struct Background {
    /// Tone, 0 to 255.
    pub(super) tone: Plane,
    /// Standard deviation of the wall around it.
    pub(super) noise: f32,
    /// First row of the track; the height when there is none.
    pub(super) track: u32,
}

/// One panel's background.
pub(super) fn estimate(picture: &Plane) -> Background {
    let cells = Cells::new(picture);
    let wall = cells.wall();
    let mut spreads: Vec<f32> =
        cells.spread.iter().zip(&wall).filter(|(_, wall)| **wall).map(|(s, _)| *s).collect();
    let noise = (quantile(&mut spreads, 0.5) * 1.48).max(LEAST_NOISE);
    let tones = cells.carried(&wall);
    let (width, height) = picture.dimensions();
    let mut tone = Plane::from_fn(width, height, |x, y| Luma([cells.between(&tones, x, y)]));
    let track = add_track(picture, &mut tone, noise);
    Background { tone, noise, track }
}

/// Median tones of square cells, and the median distances from them.
struct Cells {
    side: u32,
    columns: usize,
    rows: usize,
    median: Vec<f32>,
    spread: Vec<f32>,
}

impl Cells {
    fn new(picture: &Plane) -> Self {
        let (width, height) = picture.dimensions();
        let side = width.max(height).div_ceil(CELLS).max(1);
        let (columns, rows) = (width.div_ceil(side), height.div_ceil(side));
        let (mut median, mut spread) = (Vec::new(), Vec::new());
        for (column, row) in (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row))) {
            let xs = column * side..((column + 1) * side).min(width);
            let ys = row * side..((row + 1) * side).min(height);
            let mut values: Vec<f32> =
                ys.flat_map(|y| xs.clone().map(move |x| picture.get_pixel(x, y).0[0])).collect();
            let middle = quantile(&mut values, 0.5);
            values.iter_mut().for_each(|value| *value = (*value - middle).abs());
            median.push(middle);
            spread.push(quantile(&mut values, 0.5));
        }
        Self { side, columns: columns as usize, rows: rows as usize, median, spread }
    }

    fn neighbours(&self, i: usize) -> impl Iterator<Item = usize> {
        let (column, row) = (i % self.columns, i / self.columns);
        let (columns, rows) = (self.columns, self.rows);
        [(1, 0), (-1, 0), (0, 1), (0, -1)].into_iter().filter_map(move |(dx, dy)| {
            let (x, y) = (column.checked_add_signed(dx)?, row.checked_add_signed(dy)?);
            (x < columns && y < rows).then_some(y * columns + x)
        })
    }

    /// Which cells are wall: those of the rim of its commonest tone, and all that are reached from them in gentle steps.
    fn wall(&self) -> Vec<bool> {
        let in_rim = |i: &usize| {
            let (x, y) = ((i % self.columns) as f64 + 0.5, (i / self.columns) as f64 + 0.5);
            let (x, y) = (x / self.columns as f64, y / self.rows as f64);
            y < RIM_WIDTH || y < TRACK && !(RIM_WIDTH..1.0 - RIM_WIDTH).contains(&x)
        };
        let rim: Vec<usize> = (0..self.median.len()).filter(in_rim).collect();
        let like = |a: usize, b: usize, part: f32| {
            let (a, b) = (self.median[a].max(1.0), self.median[b].max(1.0));
            (a - b).abs() < part * a.max(b)
        };
        let commonest = rim.iter().copied().max_by_key(|i| rim.iter().filter(|j| like(*i, **j, RIM)).count());
        let step = GENTLE * self.usual_step(&rim);
        let step = step.clamp(GENTLE_PART[0], GENTLE_PART[1]);
        let top = TOP * self.rows as f64;
        let in_top = |i: usize| ((i / self.columns) as f64) + 0.5 < top;
        let mut wall = vec![false; self.median.len()];
        let mut reached: Vec<usize> =
            rim.iter().copied().filter(|i| commonest.is_some_and(|c| like(*i, c, RIM))).collect();
        reached.iter().for_each(|i| wall[*i] = true);
        while let Some(i) = reached.pop() {
            for j in self.neighbours(i) {
                let most = if in_top(i) && in_top(j) { RIM_STEP } else { step };
                if !wall[j] && like(i, j, most) {
                    wall[j] = true;
                    reached.push(j);
                }
            }
        }
        wall
    }

    /// The middle difference between neighbouring cells of the rim, as a part of their tone.
    fn usual_step(&self, rim: &[usize]) -> f32 {
        let mut steps: Vec<f32> = rim
            .iter()
            .flat_map(|i| self.neighbours(*i).map(move |j| (self.median[*i], self.median[j])))
            .map(|(a, b)| (a - b).abs() / a.max(b).max(1.0))
            .collect();
        quantile(&mut steps, 0.5)
    }

    /// The cells' tones, those of the wall smoothed a little, and carried across all others.
    fn carried(&self, wall: &[bool]) -> Vec<f32> {
        let mut known: Vec<f32> =
            self.median.iter().zip(wall).filter(|(_, wall)| **wall).map(|(m, _)| *m).collect();
        let middle = quantile(&mut known, 0.5);
        let mut tones: Vec<f32> =
            self.median.iter().zip(wall).map(|(m, wall)| if *wall { *m } else { middle }).collect();
        for _ in 0..ROUNDS {
            for i in 0..tones.len() {
                let (mut sum, mut count) = (0.0, 0.0);
                for j in self.neighbours(i) {
                    sum += tones[j];
                    count += 1.0;
                }
                if count > 0.0 {
                    let mean = sum / count;
                    tones[i] = if wall[i] { 0.6 * self.median[i] + 0.4 * mean } else { mean };
                }
            }
        }
        tones
    }

    /// A value per cell at a pixel.
    fn between(&self, values: &[f32], x: u32, y: u32) -> f32 {
        let place = |k: u32, n: usize| ((k as f32 + 0.5) / self.side as f32 - 0.5).clamp(0.0, (n - 1) as f32);
        let (x, y) = (place(x, self.columns), place(y, self.rows));
        let (left, top) = (x as usize, y as usize);
        let (right, bottom) = ((left + 1).min(self.columns - 1), (top + 1).min(self.rows - 1));
        let at = |column: usize, row: usize| values[row * self.columns + column];
        let (fx, fy) = (x - left as f32, y - top as f32);
        (1.0 - fy) * ((1.0 - fx) * at(left, top) + fx * at(right, top))
            + fy * ((1.0 - fx) * at(left, bottom) + fx * at(right, bottom))
    }
}

/// Below the wall each row has its own tone: from the bottom up to the first rows that look like the wall. Gives the
/// first row of the track.
fn add_track(picture: &Plane, tone: &mut Plane, noise: f32) -> u32 {
    let (width, height) = picture.dimensions();
    let gap = (f64::from(height) * GAP).ceil() as u32;
    let mut top = height;
    for y in ((TRACK * f64::from(height)) as u32..height).rev() {
        if off_in_row(picture, tone, y, 0..width).abs() > 2.0 * noise {
            top = y;
        } else if top > y + gap {
            break;
        }
    }
    let first = if top < height { top.saturating_sub(BLURRED) } else { height };
    for y in first..height {
        let block = |block: u32| block * width / BLOCKS..(block + 1) * width / BLOCKS;
        let offs: Vec<f32> = (0..BLOCKS).map(|i| off_in_row(picture, tone, y, block(i))).collect();
        for x in 0..width {
            let place = (x as f32 + 0.5) / width as f32 * BLOCKS as f32 - 0.5;
            let place = place.clamp(0.0, BLOCKS as f32 - 1.0);
            let (left, share) = (place as usize, place.fract());
            let right = (left + 1).min(offs.len() - 1);
            tone.get_pixel_mut(x, y).0[0] += (1.0 - share) * offs[left] + share * offs[right];
        }
    }
    top
}

/// How far part of a row is from a tone, but for the legs in it, which may be darker or lighter.
fn off_in_row(picture: &Plane, tone: &Plane, y: u32, columns: Range<u32>) -> f32 {
    let mut off: Vec<f32> =
        columns.map(|x| picture.get_pixel(x, y).0[0] - tone.get_pixel(x, y).0[0]).collect();
    let (low, high) = (quantile(&mut off, 1.0 - ROW_SHARE), quantile(&mut off, ROW_SHARE));
    if low.abs() < high.abs() { low } else { high }
}
