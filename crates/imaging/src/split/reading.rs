//! One way to read a plate: a range of tone taken for the mount, and the panels that follow from it.

use image::GrayImage;

use super::agree::{agree, complete};
use super::edge::{self, RoughEdge};
use super::fold::{self, Fold};
use super::layout::{self, Cell, Layout};
use super::mask::{Mask, extent};
use super::mount::{self, Tones};
use super::small::{Small, within};
use super::spans::{GUTTER, THIN_GUTTER};
use super::turn::{Turn, tilt_rad, upright};
use super::{Point, median};

/// Most layouts whose edges are looked for on the plate.
const MOST_READINGS: usize = 10;
/// Share of the best score below which a reading is of no interest.
const LEAST_SCORE: f64 = 0.5;
/// Power of what is seen of the outlines in a reading's score.
const SEEN_POWER: i32 = 2;
/// Share of the outlines that may be seen less with a purer mount: some of what was seen may have been the page's border.
const LESS_SEEN: f64 = 0.02;
/// Least width of a mount around panels, in panel sizes; and least share of their outlines that must be seen.
const MOUNT_MARGIN: f64 = 0.02;
const MOUNTED_SEEN: f64 = 0.9;
/// Least share of all outlines that is seen of panels on a mount: shapes in a single photograph have less.
const CREDIBLE: f64 = 0.6;
/// Sides of a cell in the order of a quadrilateral's edges: top, right, bottom, left.
const SIDES: [usize; 4] = [1, 2, 3, 0];

/// The outline of one panel.
#[derive(Clone, Copy, Debug)]
pub(super) struct Outline {
    /// Corners in plate px: top left, top right, bottom right, bottom left.
    pub(super) quad_px: [Point; 4],
    /// Share of each side along which the photograph was seen to begin: left, top, right, bottom.
    pub(super) seen: [f64; 4],
}

impl Outline {
    pub(super) fn mean_seen(&self) -> f64 {
        0.25 * self.seen.iter().sum::<f64>()
    }
}

/// One way to read a plate.
pub(super) struct Reading {
    pub(super) layout: Layout,
    /// Of the layout's cells.
    pub(super) outlines: Vec<Outline>,
    /// Larger is better.
    pub(super) score: f64,
    turn: Turn,
    mount: Tones,
    /// Folds in plate px.
    folds: Vec<Fold>,
    /// Plate px to one of the mask.
    factor: f64,
}

/// The readings of a plate, best first.
pub(super) fn all(plate: &GrayImage, small: &Small) -> Vec<Reading> {
    let mut readings: Vec<Reading> = mount::candidates(&small.picture)
        .into_iter()
        .flat_map(|tones| Reading::of_tones(small, tones))
        .collect();
    readings.sort_by(|a, b| b.layout.worth.total_cmp(&a.layout.worth));
    readings.truncate(MOST_READINGS);
    let mut best = 0.0f64;
    for reading in &mut readings {
        // No score is above the worth.
        if reading.layout.worth >= LEAST_SCORE * best {
            reading.find_edges(plate);
            best = best.max(reading.score);
        }
    }
    readings.retain(|reading| !reading.outlines.is_empty());
    readings.sort_by(|a, b| b.score.total_cmp(&a.score));
    if let Some(inner) = (1..readings.len()).find(|i| readings[*i].is_mounted_within(&readings[0])) {
        readings.swap(0, inner);
    }
    if let Some(best) = readings.first_mut()
        && let Some(purer) = best.with_purer_mount(plate, small)
    {
        *best = purer;
    }
    readings
}

impl Reading {
    /// The readings with a range of tone as mount, without edges.
    fn of_tones(small: &Small, mount: Tones) -> Vec<Self> {
        let mask = within(&small.picture, mount.darkest, mount.lightest);
        let (mut turned, turn) = upright(&mask, tilt_rad(&mask));
        let Some(region) = extent(&turned) else { return Vec::new() };
        let mut mask = Mask::new(&turned);
        let folds = fold::find(&mask, region);
        if !folds.is_empty() {
            for fold in &folds {
                fold.fill(&mut turned);
            }
            mask = Mask::new(&turned);
        }
        let factor = f64::from(small.factor);
        let on_plate = |fold: &Fold| Fold {
            ends: fold.ends.map(|end| turn.picture_from_turned(end).map(|v| v * factor)),
            width: fold.width * factor,
        };
        let folds: Vec<Fold> = folds.iter().map(on_plate).collect();
        let mut layouts: Vec<Layout> = [GUTTER, THIN_GUTTER]
            .into_iter()
            .filter_map(|gutter| layout::find(&mask, region, gutter))
            .collect();
        layouts.dedup_by_key(|layout| layout.cells.len());
        let reading = |layout| Self {
            layout,
            outlines: Vec::new(),
            score: 0.0,
            turn,
            mount,
            folds: folds.clone(),
            factor,
        };
        layouts.into_iter().map(reading).collect()
    }

    /// Whether its panels lie within those of another reading, clear of their corners: then those are mounts on a page.
    fn is_mounted_within(&self, other: &Self) -> bool {
        let is_clear = |inner: &Outline, outer: &Outline| {
            let [width, height] = self.usual_size_px();
            (0..4).all(|i| {
                let ([x, y], [ox, oy]) = (inner.quad_px[i], outer.quad_px[i]);
                // Outwards is left for the first and last corner, and up for the first two.
                let outwards =
                    [if i == 0 || i == 3 { x - ox } else { ox - x }, if i < 2 { y - oy } else { oy - y }];
                let shares = [outwards[0] / width, outwards[1] / height];
                shares.iter().all(|v| *v > -MOUNT_MARGIN) && shares.iter().any(|v| *v > MOUNT_MARGIN)
            })
        };
        let mut pairs = self.outlines.iter().zip(&other.outlines);
        self.outlines.len() == other.outlines.len()
            && self.mean_seen() >= MOUNTED_SEEN
            && pairs.all(|(inner, outer)| is_clear(inner, outer))
    }

    /// The same panels with the tones of the gutters between them for mount: what lies beyond the page may be of nearly the same
    /// tone. None when that shows other panels, or less of them.
    fn with_purer_mount(&self, plate: &GrayImage, small: &Small) -> Option<Self> {
        let tone = |point: Point| {
            let [x, y] = self.turn.picture_from_turned(point).map(|v| v.max(0.0) as u32);
            small.picture.get_pixel_checked(x, y).map(|pixel| f64::from(pixel.0[0]))
        };
        let tones =
            Tones::around(&self.layout.gutter_points().into_iter().filter_map(tone).collect::<Vec<f64>>())?;
        let mut readings = Self::of_tones(small, tones);
        readings.retain(|reading| reading.layout.cells.len() == self.layout.cells.len());
        let mut purer = readings.into_iter().next()?;
        purer.find_edges(plate);
        (purer.mean_seen() >= self.mean_seen() - LESS_SEEN).then_some(purer)
    }

    /// Whether enough of the outlines is seen for them to be photographs on a mount.
    pub(super) fn is_credible(&self) -> bool {
        self.mean_seen() >= CREDIBLE && self.outlines.iter().all(|outline| is_convex(&outline.quad_px))
    }

    pub(super) fn mean_seen(&self) -> f64 {
        self.outlines.iter().map(Outline::mean_seen).sum::<f64>() / self.outlines.len().max(1) as f64
    }

    /// Finds all edges on the plate, and once more those that the other panels say are elsewhere.
    fn find_edges(&mut self, plate: &GrayImage) {
        self.outlines = self.layout.cells.iter().map(|cell| self.outline(plate, cell)).collect();
        for (cell, outline) in self.layout.cells.iter_mut().zip(&self.outlines) {
            let [a, b, c, d] =
                outline.quad_px.map(|corner| self.turn.turned_from_picture(corner.map(|v| v / self.factor)));
            cell.edges = [a[0] + d[0], a[1] + b[1], b[0] + c[0], c[1] + d[1]].map(|sum| 0.5 * sum);
        }
        let seen: Vec<[f64; 4]> = self.outlines.iter().map(|outline| outline.seen).collect();
        let mut changed = vec![false; seen.len()];
        for axis in 0..2 {
            let completed = complete(&mut self.layout.cells, &seen, axis);
            let agreed = agree(&mut self.layout.cells, self.layout.region, axis, Some(&seen));
            for (changed, (completed, agreed)) in changed.iter_mut().zip(completed.into_iter().zip(agreed)) {
                *changed |= completed | agreed;
            }
        }
        for i in (0..changed.len()).filter(|i| changed[*i]) {
            self.outlines[i] = self.outline(plate, &self.layout.cells[i]);
        }
        self.score = self.layout.worth * self.mean_seen().powi(SEEN_POWER);
    }

    fn outline(&self, plate: &GrayImage, cell: &Cell) -> Outline {
        let [left, top, right, bottom] = cell.edges;
        let corners = [[left, top], [right, top], [right, bottom], [left, bottom]]
            .map(|corner| self.turn.picture_from_turned(corner).map(|v| v * self.factor));
        let outside = cell.mount_outside(&self.layout.cells);
        let edges: [edge::SeenEdge; 4] = std::array::from_fn(|i| {
            let side = SIDES[i];
            let rough = RoughEdge {
                ends: [corners[i], corners[(i + 1) % 4]],
                size_px: cell.size(side % 2) * self.factor,
                mount_px: outside[side].map(|v| v * self.factor),
                mount: self.mount,
            };
            edge::find(plate, &self.folds, rough)
        });
        let quad_px =
            std::array::from_fn(|i| meeting(edges[(i + 3) % 4].ends, edges[i].ends).unwrap_or(corners[i]));
        let mut seen = [0.0; 4];
        for (edge, side) in edges.iter().zip(SIDES) {
            seen[side] = edge.seen;
        }
        Outline { quad_px, seen }
    }

    /// Usual width and height of a panel, px.
    pub(super) fn usual_size_px(&self) -> [f64; 2] {
        [0, 1]
            .map(|axis| median(self.layout.cells.iter().map(|cell| cell.size(axis) * self.factor).collect()))
    }
}

/// Where two straight lines meet; none when they are parallel.
fn meeting([a, b]: [Point; 2], [c, d]: [Point; 2]) -> Option<Point> {
    let ([ux, uy], [vx, vy]) = ([b[0] - a[0], b[1] - a[1]], [d[0] - c[0], d[1] - c[1]]);
    let share = ((c[0] - a[0]) * vy - (c[1] - a[1]) * vx) / (ux * vy - uy * vx);
    share.is_finite().then(|| [a[0] + share * ux, a[1] + share * uy])
}

/// Corners turn clockwise all round (y pointing down).
fn is_convex(quad: &[Point; 4]) -> bool {
    (0..4).all(|i| {
        let ([ax, ay], [bx, by], [cx, cy]) = (quad[i], quad[(i + 1) % 4], quad[(i + 2) % 4]);
        (bx - ax) * (cy - by) - (by - ay) * (cx - bx) > 0.0
    })
}
