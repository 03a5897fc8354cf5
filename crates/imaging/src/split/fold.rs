//! The fold of a page: a line from top to bottom that is unlike the mount where it crosses the gutters between rows.

use image::{GrayImage, Luma};

use super::mask::{Along, Mask, Rectangle, steepest_lean};
use super::spans::GUTTER;

/// Least share of the gutters' height at which a fold is unlike the mount.
const LEAST_SHARE: f64 = 0.7;
/// Widest fold, as a share of the plate's width.
const WIDEST: f64 = 0.04;
/// Least height of all gutters together, as a share of the plate's height: fewer may be crossed by chance.
const LEAST_GUTTERS: f64 = 0.015;
/// Most folds of a page; more are gutters of a mount of another tone.
const MOST_FOLDS: usize = 2;
/// Where a fold may be, as a share of the plate's width: the plate's own border is none.
const INNER: std::ops::RangeInclusive<f64> = 0.1..=0.9;
/// Most rows of gutter that are looked at.
const MOST_ROWS: usize = 60;

/// A fold, in pixels of the turned mask.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fold {
    /// Middle of its upper and of its lower end.
    pub(super) ends: [[f64; 2]; 2],
    pub(super) width: f64,
}

impl Fold {
    /// Whether a point lies in it.
    pub(super) fn covers(&self, [x, y]: [f64; 2]) -> bool {
        let [[x0, y0], [x1, y1]] = self.ends;
        let along = (y - y0) / (y1 - y0);
        (x - x0 - along * (x1 - x0)).abs() <= 0.5 * self.width
    }

    /// Makes the fold part of the mount.
    pub(super) fn fill(&self, mount: &mut GrayImage) {
        let [[x0, y0], [x1, y1]] = self.ends;
        for y in 0..mount.height() {
            let x = x0 + (x1 - x0) * (f64::from(y) + 0.5 - y0) / (y1 - y0);
            let from = (x - 0.5 * self.width).floor().max(0.0) as u32;
            let to = ((x + 0.5 * self.width).ceil().max(0.0) as u32).min(mount.width());
            for x in from..to {
                mount.put_pixel(x, y, Luma([255]));
            }
        }
    }
}

/// Folds across a region of mount.
pub(super) fn find(mask: &Mask, region: Rectangle) -> Vec<Fold> {
    let [left, top, right, bottom] = region;
    let shares = mask.line_shares(Along::Rows, region);
    let rows: Vec<usize> = (top..bottom).filter(|y| shares[y - top] >= GUTTER).collect();
    let bands = rows.windows(2).filter(|pair| pair[1] > pair[0] + 1).count() + 1;
    if bands < 2 || (rows.len() as f64) < LEAST_GUTTERS * (bottom - top) as f64 {
        return Vec::new();
    }
    let rows: Vec<usize> = rows.iter().copied().step_by(rows.len().div_ceil(MOST_ROWS)).collect();
    let best: Vec<(f64, f64)> = (left..right).map(|x| likeliest(mask, region, &rows, x as f64 + 0.5)).collect();
    let mut folds = Vec::new();
    let mut x = 0;
    while x < best.len() {
        let count = best[x..].iter().take_while(|(share, _)| *share >= LEAST_SHARE).count();
        let place = (x as f64 + 0.5 * count as f64) / best.len() as f64;
        if count > 0 && count as f64 <= WIDEST * best.len() as f64 && INNER.contains(&place) {
            let (middle, lean) = ((left + x) as f64 + 0.5 * count as f64, best[x + count / 2].1);
            let ends = [[middle - lean, top as f64], [middle + lean, bottom as f64]];
            folds.push(Fold { ends, width: count as f64 + 2.0 });
        }
        x += count + 1;
    }
    if folds.len() > MOST_FOLDS { Vec::new() } else { folds }
}

/// Largest share of rows of gutter in which a line through a place half way down is unlike the mount, and how far that line
/// leans, px at its lower end.
fn likeliest(mask: &Mask, [left, top, right, bottom]: Rectangle, rows: &[usize], x: f64) -> (f64, f64) {
    let most = steepest_lean(bottom - top);
    let middle = 0.5 * (top + bottom) as f64;
    let share = |lean: f64| {
        let is_marked = |y: &usize| {
            let at = x + lean * (*y as f64 + 0.5 - middle) / (middle - top as f64);
            at >= left as f64 && at < right as f64 && !mask.is_mount(at as usize, *y)
        };
        rows.iter().filter(|y| is_marked(y)).count() as f64 / rows.len() as f64
    };
    (-most..=most).map(|lean| (share(lean as f64), lean as f64)).fold((0.0, 0.0), |best, candidate| {
        if candidate.0 > best.0 { candidate } else { best }
    })
}
