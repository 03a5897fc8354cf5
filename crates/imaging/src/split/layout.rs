//! Rows, columns and rough edges of the panels, from a mask of the mount.

use super::fold::Fold;
use super::mask::{Along, Mask, Rectangle};
use super::spans::{Span, common_size, panels, runs};

/// Least share of a panel's cell that is not mount; a line of a caption is mostly mount.
const LEAST_CONTENT: f64 = 0.3;
/// Relative departure from the usual size (or of an edge from its neighbours', in sizes) up to which a panel is left as it is.
const USUAL: f64 = 0.07;

/// One panel, roughly: pixels of the turned mask.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) row: usize,
    pub(super) column: usize,
    /// Left, top, right, bottom.
    pub(super) edges: [f64; 4],
    /// Which of them were not seen in the mask but taken from other panels.
    pub(super) inferred: [bool; 4],
}

impl Cell {
    fn size(&self, axis: usize) -> f64 {
        self.edges[axis + 2] - self.edges[axis]
    }

    /// Length that two cells have in common along an axis; negative when they are apart.
    fn overlap(&self, other: &Self, axis: usize) -> f64 {
        self.edges[axis + 2].min(other.edges[axis + 2]) - self.edges[axis].max(other.edges[axis])
    }

    /// Whether left and right edges (axis 0) or top and bottom edges (axis 1) of both should be in line.
    fn is_mate(&self, other: &Self, axis: usize) -> bool {
        let is_in_line = axis == 0 || self.row == other.row;
        is_in_line && self.overlap(other, axis) > 0.5 * self.size(axis).min(other.size(axis))
    }

    /// Where there is only mount outside each edge: nearest and farthest, px from the edge outwards.
    pub(super) fn mount_outside(&self, layout: &Layout) -> [[f64; 2]; 4] {
        std::array::from_fn(|side| {
            let (axis, outwards) = (side % 2, if side < 2 { -1.0 } else { 1.0 });
            let edge = self.edges[side];
            let beyond = |value: f64| outwards * (value - edge);
            let mut near = 0.0f64;
            let mut far = beyond(layout.region[side] as f64);
            for other in &layout.cells {
                let middle = 0.5 * (other.edges[axis] + other.edges[axis + 2]);
                if self.is_mate(other, axis) {
                    near = near.max(beyond(other.edges[side]));
                } else if self.overlap(other, 1 - axis) > 0.0 && beyond(middle) > 0.0 {
                    far = far.min(beyond(other.edges[(side + 2) % 4]));
                }
            }
            let far = far.max(0.0);
            [if near < 0.7 * far { near } else { 0.0 }, far]
        })
    }
}

/// All panels, in reading order.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub(super) cells: Vec<Cell>,
    /// Folds of the page.
    pub(super) folds: Vec<Fold>,
    /// Where the mount is.
    pub(super) region: Rectangle,
    /// How well the mount explains what is not panel, 0..1: for choosing among masks.
    pub(super) worth: f64,
}

/// Finds the panels in a region of mount; none when there is nothing like one.
pub(super) fn find(mask: &Mask, region: Rectangle) -> Option<Layout> {
    let [left, top, right, bottom] = region;
    let row_runs = runs(&mask.line_shares(Along::Rows, region));
    let height = common_size(std::slice::from_ref(&row_runs))?;
    let bands: Vec<Rectangle> = panels(&row_runs, height)
        .iter()
        .map(|span| [left, top + span.start, right, top + span.end])
        .filter(|band| 1.0 - mask.share(*band) >= LEAST_CONTENT)
        .collect();
    let column_runs: Vec<Vec<Span>> =
        bands.iter().map(|band| runs(&mask.line_shares(Along::Columns, *band))).collect();
    let width = common_size(&column_runs)?;
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    for (band, runs) in bands.iter().zip(&column_runs) {
        let cells: Vec<Cell> = panels(runs, width)
            .iter()
            .filter_map(|span| trimmed(mask, [left + span.start, band[1], left + span.end, band[3]], height))
            .collect();
        if !cells.is_empty() {
            rows.push(cells);
        }
    }
    let worth = worth(mask, region, &rows);
    for (row, cells) in rows.iter_mut().enumerate() {
        for (column, cell) in cells.iter_mut().enumerate() {
            (cell.row, cell.column) = (row, column);
        }
    }
    let mut cells = rows.concat();
    agree(&mut cells, region, 0, USUAL);
    agree(&mut cells, region, 1, USUAL);
    (!cells.is_empty()).then_some(Layout { cells, folds: Vec::new(), region, worth })
}

/// A cell without the mount above and below its photograph; none when it is mostly mount.
fn trimmed(mask: &Mask, [left, top, right, bottom]: Rectangle, height: f64) -> Option<Cell> {
    let rows = runs(&mask.line_shares(Along::Rows, [left, top, right, bottom]));
    let tallest =
        panels(&rows, height).into_iter().max_by(|a, b| a.length().total_cmp(&b.length()));
    let (start, end) = match (tallest, rows.first(), rows.last()) {
        (Some(span), ..) => (top + span.start, top + span.end),
        (None, Some(first), Some(last)) => (top + first.start, top + last.end),
        _ => return None,
    };
    let edges = [left, start, right, end].map(|v| v as f64);
    (1.0 - mask.share([left, start, right, end]) >= LEAST_CONTENT).then_some(Cell {
        row: 0,
        column: 0,
        edges,
        inferred: [false; 4],
    })
}

/// Share of the region in panels, times share of mount in the rest, less where panels are of unlike sizes.
fn worth(mask: &Mask, region: Rectangle, rows: &[Vec<Cell>]) -> f64 {
    let cells: Vec<&Cell> = rows.iter().flatten().collect();
    let area = |[left, top, right, bottom]: Rectangle| ((right - left) * (bottom - top)) as f64;
    let whole = area(region);
    let (mut covered, mut mount_inside) = (0.0, 0.0);
    for cell in &cells {
        let rectangle = cell.edges.map(|v| v as usize);
        covered += area(rectangle);
        mount_inside += mask.share(rectangle) * area(rectangle);
    }
    let rest = whole - covered;
    if rest <= 0.0 || cells.len() < 2 {
        return 0.0;
    }
    let purity = (mask.share(region) * whole - mount_inside) / rest;
    let unlike: f64 = (0..2)
        .map(|axis| {
            let usual = median(cells.iter().map(|cell| cell.size(axis)).collect());
            cells.iter().map(|cell| (cell.size(axis) / usual - 1.0).abs().min(1.0)).sum::<f64>()
                / cells.len() as f64
        })
        .sum();
    let share = whole / (mask.size[0] * mask.size[1]) as f64;
    covered / whole * purity * (1.0 - unlike).max(0.0) * share.sqrt() * (cells.len() as f64).powf(0.25)
}

/// Middle value; the upper one of two; zero of none.
pub(super) fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Edges of panels of unusual width (axis 0) or height (axis 1) are put where those of their column or row are.
pub(super) fn agree(cells: &mut [Cell], region: Rectangle, axis: usize, tolerance: f64) {
    let usual = median(cells.iter().map(|cell| cell.size(axis)).collect());
    let is_usual = |cell: &Cell| (cell.size(axis) / usual - 1.0).abs() <= tolerance;
    let before = cells.to_vec();
    for cell in cells.iter_mut().filter(|cell| !is_usual(cell)) {
        let mates: Vec<&Cell> =
            before.iter().filter(|mate| is_usual(mate) && cell.is_mate(mate, axis)).collect();
        let expected = if mates.is_empty() {
            grown(cell, &before, region, axis, usual)
        } else {
            [axis, axis + 2].map(|side| median(mates.iter().map(|mate| mate.edges[side]).collect()))
        };
        for (side, value) in [axis, axis + 2].into_iter().zip(expected) {
            if (cell.edges[side] - value).abs() > 0.75 * tolerance * usual {
                cell.edges[side] = value;
                cell.inferred[side] = true;
            }
        }
    }
}

/// A panel of the usual size that keeps the edge on whose other side there is less room.
fn grown(cell: &Cell, cells: &[Cell], region: Rectangle, axis: usize, usual: f64) -> [f64; 2] {
    let [low, high] = [cell.edges[axis], cell.edges[axis + 2]];
    let across = 1 - axis;
    let abreast = cells.iter().filter(|other| cell.overlap(other, across) > 0.0);
    let (mut before, mut behind) = (region[axis] as f64, region[axis + 2] as f64);
    for other in abreast {
        let [start, end] = [other.edges[axis], other.edges[axis + 2]];
        if 0.5 * (start + end) < low {
            before = before.max(end);
        } else if 0.5 * (start + end) > high {
            behind = behind.min(start);
        }
    }
    if low - before > behind - high { [high - usual, high] } else { [low, low + usual] }
}
