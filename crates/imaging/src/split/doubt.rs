//! What speaks against the panels that were found.

use std::cmp::Ordering;

use super::layout::SHAPES;
use super::overlap::iou;
use super::reading::{Outline, Reading};

/// Least share of a side that must have been seen; less is a guess from the other panels.
const LEAST_SIDE: f64 = 0.3;
/// Least share of an outline that must have been seen.
const LEAST_OUTLINE: f64 = 0.6;
/// Departure from the usual width or height that is unusual: real panels differ by 5 %.
const UNLIKE: f64 = 0.055;
/// Overlap of two panels (intersection over union) that is more than a shared edge.
const OVERLAP: f64 = 0.01;
/// Overlap of the same panel in two readings below which it is not in the same place.
const SAME_PLACE: f64 = 0.9;
/// Least score of another reading, against the best, at which it may be the right one: of one with fewer panels, which every
/// plate with thin gutters has; of one with as many in other places; and of one with more.
const COARSER_RIVAL: f64 = 0.9;
const EQUAL_RIVAL: f64 = 0.8;
const FINER_RIVAL: f64 = 0.7;

/// A side of a panel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// Left.
    Left,
    /// Top.
    Top,
    /// Right.
    Right,
    /// Bottom.
    Bottom,
}

impl Side {
    /// In the order of `Outline::seen`.
    const ALL: [Self; 4] = [Self::Left, Self::Top, Self::Right, Self::Bottom];
}

impl std::fmt::Display for Side {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Left => "left",
            Self::Top => "top",
            Self::Right => "right",
            Self::Bottom => "bottom",
        })
    }
}

/// A reason to look at the panels that were found. Panels are counted from 1 in reading order.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Doubt {
    /// The picture is too small or of one tone.
    #[error("nothing is to be seen on the picture")]
    Nothing,
    /// There is no mount around photographs.
    #[error("no photographs on a mount were found; the whole picture is taken as one photograph")]
    NoMount,
    /// Only one photograph was found.
    #[error("only one photograph was found; are there gutters too thin to be seen?")]
    OnlyOne,
    /// Another number of panels is possible.
    #[error("{found} panels were found, but {other} are possible")]
    OtherCount {
        /// Panels found.
        found: usize,
        /// Panels of the other reading.
        other: usize,
    },
    /// As many panels are possible in other places.
    #[error("as many panels are possible in other places")]
    OtherPlaces,
    /// Rows have different numbers of panels.
    #[error("the rows do not have equally many panels")]
    UnevenRows,
    /// A side was hardly seen.
    #[error("panel {panel}: its {side} edge is hidden (seen along {:.0} %) and is a guess from the other panels", 100.0 * seen)]
    HiddenEdge {
        /// Panel.
        panel: usize,
        /// Side.
        side: Side,
        /// Share of the side that was seen, 0..1.
        seen: f64,
    },
    /// Little of an outline was seen.
    #[error("panel {panel}: only {:.0} % of its outline was seen", 100.0 * seen)]
    FaintOutline {
        /// Panel.
        panel: usize,
        /// Share of the outline that was seen, 0..1.
        seen: f64,
    },
    /// A panel's size is not that of the others.
    #[error("panel {panel}: {:.0} % {} than the others", 100.0 * (ratio - 1.0).abs(), if *ratio > 1.0 { "larger" } else { "smaller" })]
    UnlikeSize {
        /// Panel.
        panel: usize,
        /// Its width or height, whichever is more unlike, over the usual.
        ratio: f64,
    },
    /// The panels' shape is unusual.
    #[error(
        "the panels are {width_by_height:.2} times as wide as high; are they two photographs each, or a part of one?"
    )]
    OddShape {
        /// Usual width over usual height.
        width_by_height: f64,
    },
    /// Two panels overlap.
    #[error("panels {panel} and {other} overlap")]
    Overlap {
        /// Panel.
        panel: usize,
        /// The other, later in reading order.
        other: usize,
    },
}

/// All doubts about a reading, given the others.
pub(super) fn doubts(reading: &Reading, others: &[Reading]) -> Vec<Doubt> {
    let mut doubts = rivals(reading, others);
    if reading.outlines.len() == 1 {
        doubts.push(Doubt::OnlyOne);
    }
    if !reading.layout.is_full {
        doubts.push(Doubt::UnevenRows);
    }
    let usual_px = reading.usual_size_px();
    if !has_usual_shape(reading) {
        doubts.push(Doubt::OddShape { width_by_height: usual_px[0] / usual_px[1] });
    }
    for (i, outline) in reading.outlines.iter().enumerate() {
        doubts.extend(outline_doubts(i + 1, outline, usual_px));
        let later = reading.outlines.iter().enumerate().skip(i + 1);
        let overlapping = later.filter(|(_, other)| iou(&outline.quad_px, &other.quad_px) > OVERLAP);
        doubts.extend(overlapping.map(|(j, _)| Doubt::Overlap { panel: i + 1, other: j + 1 }));
    }
    doubts
}

/// Other readings that may be the right one.
fn rivals(reading: &Reading, others: &[Reading]) -> Vec<Doubt> {
    let found = reading.outlines.len();
    let rivals = others.iter().filter(|other| {
        let least = match other.outlines.len().cmp(&found) {
            Ordering::Less => COARSER_RIVAL,
            Ordering::Equal => EQUAL_RIVAL,
            Ordering::Greater => FINER_RIVAL,
        };
        other.is_credible() && has_usual_shape(other) && other.score >= least * reading.score
    });
    let mut doubts = Vec::new();
    for other in rivals {
        let doubt = if other.outlines.len() != found {
            Doubt::OtherCount { found, other: other.outlines.len() }
        } else if is_elsewhere(reading, other) {
            Doubt::OtherPlaces
        } else {
            continue;
        };
        if !doubts.contains(&doubt) {
            doubts.push(doubt);
        }
    }
    doubts
}

/// Whether some panel of as many is in another place.
fn is_elsewhere(reading: &Reading, other: &Reading) -> bool {
    let mut pairs = reading.outlines.iter().zip(&other.outlines);
    pairs.any(|(a, b)| iou(&a.quad_px, &b.quad_px) < SAME_PLACE)
}

fn has_usual_shape(reading: &Reading) -> bool {
    let [width, height] = reading.usual_size_px();
    SHAPES.contains(&(width / height))
}

fn outline_doubts(panel: usize, outline: &Outline, usual_px: [f64; 2]) -> Vec<Doubt> {
    let mut doubts: Vec<Doubt> = Side::ALL
        .into_iter()
        .zip(outline.seen)
        .filter(|(_, seen)| *seen < LEAST_SIDE)
        .map(|(side, seen)| Doubt::HiddenEdge { panel, side, seen })
        .collect();
    let seen = outline.mean_seen();
    if doubts.is_empty() && seen < LEAST_OUTLINE {
        doubts.push(Doubt::FaintOutline { panel, seen });
    }
    let [a, b, c, d] = outline.quad_px;
    let length = |p: [f64; 2], q: [f64; 2]| (q[0] - p[0]).hypot(q[1] - p[1]);
    let ratios = [
        0.5 * (length(a, b) + length(d, c)) / usual_px[0],
        0.5 * (length(a, d) + length(b, c)) / usual_px[1],
    ];
    let ratio = ratios
        .into_iter()
        .fold(1.0, |most: f64, r| if (r - 1.0).abs() > (most - 1.0).abs() { r } else { most });
    if (ratio - 1.0).abs() > UNLIKE {
        doubts.push(Doubt::UnlikeSize { panel, ratio });
    }
    doubts
}
