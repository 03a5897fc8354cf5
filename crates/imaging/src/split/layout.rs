//! Rows, columns and rough edges of the panels, from a mask of the mount.

use super::agree::agree;
use super::mask::{Along, Mask, Rectangle};
use super::median;
use super::spans::{Span, common_size, panels, runs};

/// Least share of a panel's cell that is not mount; a line of a caption is mostly mount.
const LEAST_CONTENT: f64 = 0.3;
/// Least share of mount where a panel is missing at the end of the last row.
const BLANK: f64 = 0.9;
/// Share of mount along an edge at which the mount outside it ends.
const MOUNT_ENDS: f64 = 0.5;
/// Most of the way from an edge to its neighbour that other panels of the same row or column may take up.
const MOST_NEAR: f64 = 0.7;
/// Width over height of a photograph of a horse, from upright to two horses long, and the worth of panels of another shape.
pub(super) const SHAPES: std::ops::RangeInclusive<f64> = 0.75..=1.7;
const ODD: f64 = 0.5;
/// Points along each gutter whose tone is looked at.
const GUTTER_POINTS: usize = 40;
/// Power of the number of panels with which a layout is worth more: thin gutters are more easily missed than imagined.
const MORE_PANELS: f64 = 0.5;

/// One panel, roughly: pixels of the turned mask. Sides are in the order left, top, right, bottom.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    pub(super) row: usize,
    pub(super) column: usize,
    pub(super) edges: [f64; 4],
    /// Where the mount outside each edge ends.
    mount_ends: [f64; 4],
}

impl Cell {
    /// Width (axis 0) or height (axis 1).
    pub(super) fn size(&self, axis: usize) -> f64 {
        self.edges[axis + 2] - self.edges[axis]
    }

    /// Length that two cells have in common along an axis; negative when they are apart.
    pub(super) fn overlap(&self, other: &Self, axis: usize) -> f64 {
        self.edges[axis + 2].min(other.edges[axis + 2]) - self.edges[axis].max(other.edges[axis])
    }

    /// Whether left and right edges (axis 0) or top and bottom edges (axis 1) of both should be in line.
    pub(super) fn is_mate(&self, other: &Self, axis: usize) -> bool {
        let is_in_line = axis == 0 || self.row == other.row;
        is_in_line && self.overlap(other, axis) > 0.5 * self.size(axis).min(other.size(axis))
    }

    /// Where there is only mount outside each edge: nearest and farthest, px from the edge outwards.
    pub(super) fn mount_outside(&self, cells: &[Self]) -> [[f64; 2]; 4] {
        std::array::from_fn(|side| {
            let (axis, outwards) = (side % 2, if side < 2 { -1.0 } else { 1.0 });
            let beyond = |value: f64| outwards * (value - self.edges[side]);
            let (mut near, mut far) = (0.0f64, beyond(self.mount_ends[side]));
            for other in cells {
                let middle = 0.5 * (other.edges[axis] + other.edges[axis + 2]);
                if self.is_mate(other, axis) {
                    near = near.max(beyond(other.edges[side]));
                } else if self.overlap(other, 1 - axis) > 0.0 && beyond(middle) > 0.0 {
                    far = far.min(beyond(other.edges[(side + 2) % 4]));
                }
            }
            [if near < MOST_NEAR * far { near } else { 0.0 }, far.max(0.0)]
        })
    }
}

/// All panels, in reading order.
#[derive(Clone, Debug)]
pub(super) struct Layout {
    pub(super) cells: Vec<Cell>,
    /// Where the mount is.
    pub(super) region: Rectangle,
    /// How well the mount explains what is not panel: larger is better, 0 for less than two panels.
    pub(super) worth: f64,
    /// Whether the rows have equally many panels, but for blank mount at the end of the last.
    pub(super) is_full: bool,
}

impl Layout {
    /// Points half way between neighbouring panels, in pixels of the mask.
    pub(super) fn gutter_points(&self) -> Vec<[f64; 2]> {
        let mut points = Vec::new();
        for (i, cell) in self.cells.iter().enumerate() {
            for (axis, other) in self.cells[i + 1..].iter().flat_map(|other| [(0, other), (1, other)]) {
                let is_next = if axis == 0 {
                    other.row == cell.row && other.column == cell.column + 1
                } else {
                    other.row == cell.row + 1 && cell.overlap(other, 0) > 0.5 * cell.size(0)
                };
                if is_next {
                    let across = 0.5 * (cell.edges[axis + 2] + other.edges[axis]);
                    points.extend((0..GUTTER_POINTS).map(|k| {
                        let share = (k as f64 + 0.5) / GUTTER_POINTS as f64;
                        let along = cell.edges[1 - axis] + share * cell.size(1 - axis);
                        if axis == 0 { [across, along] } else { [along, across] }
                    }));
                }
            }
        }
        points
    }
}

/// Finds the panels in a region of mount, between paths that are mount for a share of their length; none when there is nothing
/// like one.
pub(super) fn find(mask: &Mask, region: Rectangle, gutter: f64) -> Option<Layout> {
    let [left, top, right, _] = region;
    let row_runs = runs(&mask.path_shares(Along::Rows, region), gutter);
    let height = common_size(std::slice::from_ref(&row_runs), &(0.0..=f64::MAX))?;
    let bands: Vec<Rectangle> = panels(&row_runs, height)
        .iter()
        .map(|span| [left, top + span.start, right, top + span.end])
        .filter(|band| 1.0 - mask.share(*band) >= LEAST_CONTENT)
        .collect();
    let column_runs: Vec<Vec<Span>> =
        bands.iter().map(|band| runs(&mask.path_shares(Along::Columns, *band), gutter)).collect();
    let width = common_size(&column_runs, &(SHAPES.start() * height..=SHAPES.end() * height))?;
    let mut rows: Vec<Vec<Cell>> = Vec::new();
    for (band, runs) in bands.iter().zip(&column_runs) {
        let mut cells: Vec<Cell> = Vec::new();
        for span in panels(runs, width) {
            let box_px =
                trimmed(mask, [left + span.start, band[1], left + span.end, band[3]], height, gutter);
            let mount_ends = |edges| std::array::from_fn(|side| mount_end(mask, region, edges, side) as f64);
            cells.extend(box_px.map(|edges| Cell {
                row: rows.len(),
                column: cells.len(),
                edges: edges.map(|edge| edge as f64),
                mount_ends: mount_ends(edges),
            }));
        }
        if !cells.is_empty() {
            rows.push(cells);
        }
    }
    let (mut cells, is_full) = (rows.concat(), is_full(mask, region, &rows));
    for axis in 0..2 {
        agree(&mut cells, region, axis, None);
    }
    let worth = worth(mask, region, &cells);
    (!cells.is_empty()).then_some(Layout { cells, region, worth, is_full })
}

/// A cell without the mount above and below its photograph; none when it is mostly mount.
fn trimmed(
    mask: &Mask,
    [left, top, right, bottom]: Rectangle,
    height: f64,
    gutter: f64,
) -> Option<Rectangle> {
    let rows = runs(&mask.path_shares(Along::Rows, [left, top, right, bottom]), gutter);
    let tallest = panels(&rows, height).into_iter().max_by(|a, b| a.length().total_cmp(&b.length()));
    let (start, end) = match tallest {
        Some(span) => (span.start, span.end),
        None => (rows.first()?.start, rows.last()?.end),
    };
    let edges = [left, top + start, right, top + end];
    (1.0 - mask.share(edges) >= LEAST_CONTENT).then_some(edges)
}

/// How far the mount reaches outwards from an edge of a cell: to the region's border, or to where most of a line along the
/// edge is something else.
fn mount_end(mask: &Mask, region: Rectangle, cell: Rectangle, side: usize) -> usize {
    let axis = side % 2;
    let is_mount = |at: usize| {
        let mut line = cell;
        (line[axis], line[axis + 2]) = (at, at + 1);
        mask.share(line) >= MOUNT_ENDS
    };
    // Outwards, the line before the edge first.
    let mut lines: Box<dyn Iterator<Item = usize>> = if side < 2 {
        Box::new((region[side]..cell[side]).rev())
    } else {
        Box::new(cell[side]..region[side])
    };
    let Some(first) = lines.by_ref().find(|at| is_mount(*at)) else { return region[side] };
    let last = lines.take_while(|at| is_mount(*at)).last().unwrap_or(first);
    if side < 2 { last } else { last + 1 }
}

/// Whether the rows have equally many panels, but for blank mount at the end of the last.
fn is_full(mask: &Mask, region: Rectangle, rows: &[Vec<Cell>]) -> bool {
    let Some(fullest) = rows.iter().max_by_key(|row| row.len()) else { return false };
    rows.iter().enumerate().all(|(i, row)| {
        let (Some(first), Some(last), Some(outer)) = (row.first(), row.last(), fullest.last()) else {
            return false;
        };
        let missing = [last.edges[2], last.edges[1], outer.edges[2], last.edges[3]];
        let missing = missing.map(|edge| edge.max(0.0) as usize);
        let is_blank = missing[2] <= region[2] && mask.share(missing) >= BLANK;
        row.len() == fullest.len() || (i + 1 == rows.len() && first.is_mate(&fullest[0], 0) && is_blank)
    })
}

/// Share of the region in panels, times share of mount in the rest, less where panels are of unlike sizes.
fn worth(mask: &Mask, region: Rectangle, cells: &[Cell]) -> f64 {
    let area = |[left, top, right, bottom]: Rectangle| {
        (right.saturating_sub(left) * bottom.saturating_sub(top)) as f64
    };
    let (mut covered, mut mount_inside) = (0.0, 0.0);
    for cell in cells {
        let [left, top, right, bottom] = cell.edges.map(|edge| edge.max(0.0) as usize);
        let rectangle =
            [left.max(region[0]), top.max(region[1]), right.min(region[2]), bottom.min(region[3])];
        covered += area(rectangle);
        mount_inside += mask.share(rectangle) * area(rectangle);
    }
    let whole = area(region);
    let rest = whole - covered;
    if rest <= 0.0 || cells.len() < 2 {
        return 0.0;
    }
    let purity = ((mask.share(region) * whole - mount_inside) / rest).clamp(0.0, 1.0);
    let unlike = |axis: usize| {
        let usual = median(cells.iter().map(|cell| cell.size(axis)).collect());
        cells.iter().map(|cell| (cell.size(axis) / usual - 1.0).abs().min(1.0)).sum::<f64>()
            / cells.len() as f64
    };
    let alike = (1.0 - unlike(0) - unlike(1)).max(0.0);
    let sizes = [0, 1].map(|axis| median(cells.iter().map(|cell| cell.size(axis)).collect()));
    let shape = if SHAPES.contains(&(sizes[0] / sizes[1])) { 1.0 } else { ODD };
    let more = (cells.len() as f64).powf(MORE_PANELS);
    covered / whole * purity * alike * (whole / mask.area()).sqrt() * more * shape
}
