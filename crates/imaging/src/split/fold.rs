//! The fold of a page: a line from top to bottom that is unlike the mount where it crosses the gutters between rows.

use image::{GrayImage, Luma};

use super::Point;
use super::mask::{Along, Mask, Rectangle, steepest_lean};
use super::spans::{GUTTER, runs};

/// Least share of the gutters' height at which a fold is unlike the mount.
const LEAST_SHARE: f64 = 0.7;
/// Share from which on a line counts when leans are compared.
const HALF: f64 = 0.5;
/// Widest fold, as a share of the plate's width.
const WIDEST: f64 = 0.04;
/// Where a fold may be, as a share of the plate's width: the plate's own border is none.
const INNER: std::ops::RangeInclusive<f64> = 0.1..=0.9;
/// Least height of all gutters together, as a share of the plate's height: fewer may be crossed by chance.
const LEAST_GUTTERS: f64 = 0.015;
/// Margin above and below all photographs that is looked at, as a share of the plate's height: the page may end there.
const MARGIN: f64 = 0.03;
/// Most rows of gutter that are looked at.
const MOST_ROWS: usize = 60;
/// Most folds of a page; more are gutters of a mount of another tone.
const MOST_FOLDS: usize = 2;

/// A fold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Fold {
    /// Middle of its upper and of its lower end.
    pub(super) ends: [Point; 2],
    pub(super) width: f64,
}

impl Fold {
    /// Whether a point lies in it.
    pub(super) fn covers(&self, [x, y]: Point) -> bool {
        (x - self.x_at(y)).abs() <= 0.5 * self.width
    }

    fn x_at(&self, y: f64) -> f64 {
        let [[x0, y0], [x1, y1]] = self.ends;
        x0 + (x1 - x0) * (y - y0) / (y1 - y0)
    }

    /// Makes the fold part of the mount.
    pub(super) fn fill(&self, mount: &mut GrayImage) {
        for y in 0..mount.height() {
            let x = self.x_at(f64::from(y) + 0.5);
            let from = (x - 0.5 * self.width).floor().max(0.0) as u32;
            let to = (x + 0.5 * self.width).ceil().max(0.0) as u32;
            for x in from..to.min(mount.width()) {
                mount.put_pixel(x, y, Luma([u8::MAX]));
            }
        }
    }
}

/// Folds across a region of mount, in pixels of the mask.
pub(super) fn find(mask: &Mask, region: Rectangle) -> Vec<Fold> {
    let [left, top, right, bottom] = region;
    let rows = gutter_rows(mask, region);
    if rows.is_empty() {
        return Vec::new();
    }
    let clearness = |shares: &[f64]| shares.iter().map(|share| (share - HALF).max(0.0).powi(2)).sum::<f64>();
    let most = steepest_lean(bottom - top);
    let (_, lean, shares) = (-most..=most)
        .map(|lean| (lean as f64, marked_shares(mask, region, &rows, lean as f64)))
        .map(|(lean, shares)| (clearness(&shares), lean, shares))
        .fold((-1.0, 0.0, Vec::new()), |best, candidate| if candidate.0 > best.0 { candidate } else { best });
    let width = (right - left) as f64;
    let mut folds = Vec::new();
    let mut x = 0;
    while x < shares.len() {
        let count = shares[x..].iter().take_while(|share| **share >= LEAST_SHARE).count();
        let middle = x as f64 + 0.5 * count as f64;
        if count > 0 && count as f64 <= WIDEST * width && INNER.contains(&(middle / width)) {
            let middle = left as f64 + middle;
            let ends = [[middle - lean, top as f64], [middle + lean, bottom as f64]];
            folds.push(Fold { ends, width: count as f64 + 1.0 });
        }
        x += count + 1;
    }
    if folds.len() > MOST_FOLDS { Vec::new() } else { folds }
}

/// Some of the rows that are gutters; none when there are too few to tell a fold from a speck.
fn gutter_rows(mask: &Mask, region: Rectangle) -> Vec<usize> {
    let [_, top, _, bottom] = region;
    let height = (bottom - top) as f64;
    let shares = mask.path_shares(Along::Rows, region);
    let photographs = runs(&shares, GUTTER);
    let (Some(first), Some(last)) = (photographs.first(), photographs.last()) else { return Vec::new() };
    let margin = (MARGIN * height) as usize;
    let near = first.start.saturating_sub(margin)..(last.end + margin).min(shares.len());
    let rows: Vec<usize> = near.filter(|y| shares[*y] >= GUTTER).map(|y| top + y).collect();
    let is_one_band = rows.windows(2).all(|pair| pair[1] == pair[0] + 1);
    if is_one_band || (rows.len() as f64) < LEAST_GUTTERS * height {
        return Vec::new();
    }
    let every = rows.len().div_ceil(MOST_ROWS);
    rows.into_iter().step_by(every).collect()
}

/// Share of rows of gutter that are unlike the mount on each line of a lean (px at its lower end).
fn marked_shares(mask: &Mask, [left, top, right, bottom]: Rectangle, rows: &[usize], lean: f64) -> Vec<f64> {
    let middle = 0.5 * (top + bottom) as f64;
    let mut marked = vec![0.0; right - left];
    for y in rows {
        let shift = (lean * (*y as f64 + 0.5 - middle) / (middle - top as f64)).round() as isize;
        for (x, marked) in marked.iter_mut().enumerate() {
            let at = x as isize + shift;
            if at >= 0 && at < (right - left) as isize && !mask.is_mount(left + at as usize, *y) {
                *marked += 1.0 / rows.len() as f64;
            }
        }
    }
    marked
}
