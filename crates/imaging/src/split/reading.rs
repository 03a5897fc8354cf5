//! One way to read a plate: a range of tone taken for the mount, and the panels that follow from it.

use image::GrayImage;

use super::agree::{agree, complete};
use super::edge::{self, RoughEdge};
use super::fold::{self, Fold};
use super::layout::{self, Cell, Layout};
use super::mask::{Mask, extent};
use super::mount::{self, Tones};
use super::small::{Small, within};
use super::turn::{Turn, tilt_rad, upright};
use super::{Point, median};

/// Most layouts whose edges are looked for on the plate.
const MOST_READINGS: usize = 5;
/// Share of the best score below which a reading is of no interest.
pub(super) const LEAST_SCORE: f64 = 0.5;
/// Power of what is seen of the outlines in a reading's score.
const SEEN_POWER: i32 = 4;
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
    let mut readings: Vec<Reading> =
        mount::candidates(&small.picture).into_iter().filter_map(|tones| Reading::new(small, tones)).collect();
    readings.sort_by(|a, b| b.layout.worth.total_cmp(&a.layout.worth));
    if std::env::var("SPLIT_DEBUG").is_ok() { for r in &readings { eprintln!("{:?} {} worth {:.3} {:?} region {:?} tilt {:?}", r.mount, r.layout.cells.len(), r.layout.worth, r.folds, r.layout.region, r.turn); } }
    readings.truncate(MOST_READINGS);
    let mut best = 0.0f64;
    for reading in &mut readings {
        // No score is above the worth.
        if reading.layout.worth >= LEAST_SCORE * best {
            reading.find_edges(plate);
            best = best.max(reading.score);
            if std::env::var("SPLIT_DEBUG").is_ok() { eprintln!("  {} seen {:.2} score {:.2}", reading.outlines.len(), reading.mean_seen(), reading.score); }
        }
    }
    readings.retain(|reading| !reading.outlines.is_empty());
    readings.sort_by(|a, b| b.score.total_cmp(&a.score));
    readings
}

impl Reading {
    /// Rough cells; none when there are none.
    fn new(small: &Small, tones: Tones) -> Option<Self> {
        let mask = within(&small.picture, tones.darkest, tones.lightest);
        let (mut turned, turn) = upright(&mask, tilt_rad(&mask));
        let region = extent(&turned)?;
        let mut mask = Mask::new(&turned);
        let folds = fold::find(&mask, region);
        if !folds.is_empty() {
            for fold in &folds {
                fold.fill(&mut turned);
            }
            mask = Mask::new(&turned);
        }
        let layout = layout::find(&mask, region)?;
        let factor = f64::from(small.factor);
        let on_plate = |fold: &Fold| Fold {
            ends: fold.ends.map(|end| turn.picture_from_turned(end).map(|v| v * factor)),
            width: fold.width * factor,
        };
        let folds = folds.iter().map(on_plate).collect();
        Some(Self { layout, outlines: Vec::new(), score: 0.0, turn, mount: tones, folds, factor })
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
        [0, 1].map(|axis| median(self.layout.cells.iter().map(|cell| cell.size(axis) * self.factor).collect()))
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
