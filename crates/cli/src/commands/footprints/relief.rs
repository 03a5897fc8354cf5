//! Heights of the ground in the plan: tints and contours. An edge of a step is found where it is.

use muybridge_footprints::Terrain;

use super::chart::{Chart, round_step};
use super::sheet::{Color, PAPER, Sheet};

/// The highest ground's tint, and a contour.
const HIGH: Color = [222, 200, 160];
const CONTOUR: Color = [168, 146, 108];
/// Side of a square of one tint, and of a square in which contours are looked for, px.
const TINT_PX: f64 = 5.0;
const SQUARE_PX: f64 = 7.0;
/// Tints, and about so many contours.
const TINTS: f64 = 16.0;
const CONTOURS: f64 = 16.0;
/// Less than this is flat, metres.
const FLAT_M: f64 = 0.02;
/// Halvings of a square's side: a hundredth of a px.
const HALVINGS: usize = 10;

/// Draws the relief of a ground; the distance of its contours, metres, unless it is flat.
pub(super) fn draw(sheet: &mut Sheet, chart: &Chart, terrain: &Terrain) -> Option<f64> {
    if *terrain == Terrain::Flat {
        return None;
    }
    let relief = Relief { chart, terrain };
    let (columns, rows) = relief.squares(TINT_PX);
    let heights: Vec<f64> = (0..columns * rows)
        .map(|i| {
            let [x, y] = [i % columns, i / columns].map(|at| (at as f64 + 0.5) * TINT_PX);
            relief.height(chart.at[0] + x, chart.at[1] + y)
        })
        .collect();
    let low = heights.iter().copied().fold(f64::INFINITY, f64::min);
    let high = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    if high - low <= FLAT_M {
        return None;
    }
    for row in 0..rows {
        relief.tint(sheet, row, &heights[row * columns..(row + 1) * columns], [low, high]);
    }
    let every_m = round_step((high - low) / CONTOURS);
    let first = (low / every_m - 0.5).ceil() as i64;
    let last = (high / every_m - 0.5).floor() as i64;
    // Half-way between round heights, so that level treads have none.
    for i in first..=last {
        relief.contour(sheet, (i as f64 + 0.5) * every_m);
    }
    Some(every_m)
}

struct Relief<'a> {
    chart: &'a Chart,
    terrain: &'a Terrain,
}

impl Relief<'_> {
    fn squares(&self, side_px: f64) -> (usize, usize) {
        let [width, height] = self.chart.size;
        ((width / side_px).ceil() as usize, (height / side_px).ceil() as usize)
    }

    /// Height of the ground at a place of the sheet, metres.
    fn height(&self, x_px: f64, y_px: f64) -> f64 {
        let [x, z] = self.chart.value([x_px, y_px]);
        self.terrain.on_ground([x, z]).y
    }

    /// One row of squares; neighbours of one tint are one.
    fn tint(&self, sheet: &mut Sheet, row: usize, heights: &[f64], [low, high]: [f64; 2]) {
        let level = |height: f64| ((height - low) / (high - low) * (TINTS - 1.0)).round() as u32;
        let [left, top] = self.chart.at;
        let (right, bottom) = (left + self.chart.size[0], top + self.chart.size[1]);
        let mut from = 0;
        for to in 1..=heights.len() {
            let tint = level(heights[from]);
            if to < heights.len() && level(heights[to]) == tint {
                continue;
            }
            let share = f64::from(tint) / (TINTS - 1.0);
            let mix = |i: usize| f64::from(PAPER[i]) + share * (f64::from(HIGH[i]) - f64::from(PAPER[i]));
            let at = [left + from as f64 * TINT_PX, top + row as f64 * TINT_PX];
            let size =
                [(left + to as f64 * TINT_PX).min(right) - at[0], (at[1] + TINT_PX).min(bottom) - at[1]];
            if tint > 0 {
                sheet.rectangle(at, size, [0, 1, 2].map(|i| mix(i) as u8));
            }
            from = to;
        }
    }

    /// The line of one height.
    fn contour(&self, sheet: &mut Sheet, height_m: f64) {
        let (columns, rows) = self.squares(SQUARE_PX);
        let [left, top] = self.chart.at;
        let [width, height] = self.chart.size;
        let x = |column: usize| left + (column as f64 * SQUARE_PX).min(width);
        let y = |row: usize| top + (row as f64 * SQUARE_PX).min(height);
        let is_high = |row: usize| -> Vec<bool> {
            (0..=columns).map(|column| self.height(x(column), y(row)) > height_m).collect()
        };
        let mut above = is_high(0);
        for row in 0..rows {
            let below = is_high(row + 1);
            for column in 0..columns {
                let corners = [
                    ([x(column), y(row)], above[column]),
                    ([x(column + 1), y(row)], above[column + 1]),
                    ([x(column + 1), y(row + 1)], below[column + 1]),
                    ([x(column), y(row + 1)], below[column]),
                ];
                let crossings: Vec<[f64; 2]> = (0..4)
                    .filter(|&i| corners[i].1 != corners[(i + 1) % 4].1)
                    .map(|i| self.crossing(corners[i], corners[(i + 1) % 4].0, height_m))
                    .collect();
                for ends in crossings.chunks_exact(2) {
                    sheet.line(ends.to_vec(), CONTOUR, 1.0);
                }
            }
            above = below;
        }
    }

    /// Where a height is reached between two places.
    fn crossing(&self, (mut from, is_high): ([f64; 2], bool), mut to: [f64; 2], height_m: f64) -> [f64; 2] {
        for _ in 0..HALVINGS {
            let middle = [0, 1].map(|i| 0.5 * (from[i] + to[i]));
            if (self.height(middle[0], middle[1]) > height_m) == is_high {
                from = middle;
            } else {
                to = middle;
            }
        }
        to
    }
}
