//! Panels of one plate are of one size and in line: what that says about edges that were not seen.

use super::layout::Cell;
use super::mask::Rectangle;
use super::median;

/// Relative departure from the usual size up to which a panel is left as it is.
const USUAL: f64 = 0.07;
/// Departure of an edge from its expected place, in usual sizes, up to which it is left where it is.
const IN_PLACE: f64 = 0.05;
/// Least share of an edge that must have been seen for it to be known.
pub(super) const KNOWN: f64 = 0.3;
/// Least share of an edge that must have been seen for it to stay although the panel's size is unusual.
const CLEAR: f64 = 0.7;

/// Where one of two opposite edges was hardly seen, it is put where the panel has its usual width (axis 0) or height (axis 1).
/// Returns which panels changed.
pub(super) fn complete(cells: &mut [Cell], seen: &[[f64; 4]], axis: usize) -> Vec<bool> {
    let is_known = |seen: &[f64; 4]| [seen[axis] >= KNOWN, seen[axis + 2] >= KNOWN];
    let sizes = cells.iter().zip(seen).filter(|(_, seen)| is_known(seen) == [true; 2]);
    let usual = median(sizes.map(|(cell, _)| cell.size(axis)).collect());
    let place = |(cell, seen): (&mut Cell, &[f64; 4])| {
        match is_known(seen) {
            [true, false] if usual > 0.0 => cell.edges[axis + 2] = cell.edges[axis] + usual,
            [false, true] if usual > 0.0 => cell.edges[axis] = cell.edges[axis + 2] - usual,
            _ => return false,
        }
        true
    };
    cells.iter_mut().zip(seen).map(place).collect()
}

/// Edges of panels of unusual width (axis 0) or height (axis 1) are put where those of their column or row are, unless they were
/// clearly seen. Returns which panels changed.
pub(super) fn agree(
    cells: &mut [Cell],
    region: Rectangle,
    axis: usize,
    seen: Option<&[[f64; 4]]>,
) -> Vec<bool> {
    let usual = median(cells.iter().map(|cell| cell.size(axis)).collect());
    let is_usual = |cell: &Cell| (cell.size(axis) / usual - 1.0).abs() <= USUAL;
    let before = cells.to_vec();
    let mut changed = vec![false; cells.len()];
    for (i, cell) in cells.iter_mut().enumerate().filter(|(_, cell)| !is_usual(cell)) {
        let mates: Vec<&Cell> =
            before.iter().filter(|mate| is_usual(mate) && cell.is_mate(mate, axis)).collect();
        let expected = if mates.is_empty() {
            grown(cell, &before, region, axis, usual)
        } else {
            [axis, axis + 2].map(|side| median(mates.iter().map(|mate| mate.edges[side]).collect()))
        };
        for (side, expected) in [axis, axis + 2].into_iter().zip(expected) {
            let is_clear = seen.is_some_and(|seen| seen[i][side] >= CLEAR);
            if !is_clear && (cell.edges[side] - expected).abs() > IN_PLACE * usual {
                cell.edges[side] = expected;
                changed[i] = true;
            }
        }
    }
    changed
}

/// Edges of a panel of the usual size that keeps the edge on whose other side there is less room.
fn grown(cell: &Cell, cells: &[Cell], region: Rectangle, axis: usize, usual: f64) -> [f64; 2] {
    let [low, high] = [cell.edges[axis], cell.edges[axis + 2]];
    let (mut before, mut behind) = (region[axis] as f64, region[axis + 2] as f64);
    for other in cells.iter().filter(|other| cell.overlap(other, 1 - axis) > 0.0) {
        let [start, end] = [other.edges[axis], other.edges[axis + 2]];
        if 0.5 * (start + end) < low {
            before = before.max(end);
        } else if 0.5 * (start + end) > high {
            behind = behind.min(start);
        }
    }
    if low - before > behind - high { [high - usual, high] } else { [low, low + usual] }
}
