//! Finding the panels of a plate: where each photograph lies on its mount, in reading order, and what is uncertain about it.
//!
//! 1. A small copy is searched for the mount: several ranges of tone are tried (`mount`). For each, the copy is turned
//!    upright (`turn`), a fold of the page is counted as mount (`fold`), and rows and columns of panels are what lies
//!    between paths along mount (`mask`, `spans`, `layout`). Panels of a plate are of one size: that tells a gutter from a
//!    dark line in a photograph, and a photograph from a caption.
//! 2. Each edge is then found on the plate itself, to a fraction of a pixel (`edge`). One that lies in shadow is placed by
//!    the other panels' size (`agree`).
//! 3. The range of tone is taken that explains most of the plate and shows most of the outlines (`reading`); what speaks
//!    against the result is said (`doubt`).

mod agree;
mod doubt;
mod edge;
mod fold;
mod layout;
mod mask;
mod mount;
mod overlap;
mod reading;
mod small;
mod spans;
mod strip;
mod turn;

use image::GrayImage;

pub use doubt::{Doubt, Side};
pub use overlap::iou;

use layout::Cell;
use reading::Outline;
use small::Small;

/// A point: x right, y down.
type Point = [f64; 2];

/// Least side of a picture that is searched, px: the panels of a smaller one would show nothing.
const LEAST_PLATE_PX: u32 = 48;
/// Standard deviation of a normal variable per median of its distance from the middle.
const SD_PER_MEDIAN: f64 = 1.4826;
/// Least difference of grey values that is a picture.
const LEAST_RANGE: u8 = 8;

/// A photograph found on a plate.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundPanel {
    /// Corners in plate px: top left, top right, bottom right, bottom left.
    pub quad_px: [[f64; 2]; 4],
    /// Share of its outline along which the photograph was seen to begin, coming from the mount: 0 (a guess) to 1.
    pub confidence: f64,
    /// Row, from 0 at the top.
    pub row: usize,
    /// Place in the row, from 0 at the left.
    pub column: usize,
}

/// What was found on a plate.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    /// The photographs in reading order: rows from the top, each from the left.
    pub panels: Vec<FoundPanel>,
    /// What may be wrong with them; empty when nothing speaks against them.
    pub doubts: Vec<Doubt>,
}

impl Split {
    /// Whether nothing speaks against the panels. Otherwise a person should look at them.
    pub fn is_certain(&self) -> bool {
        self.doubts.is_empty()
    }
}

/// Finds the photographs of a plate. A picture without mount around photographs is one panel, and a doubt says so. Equal
/// plates give equal results.
pub fn split(plate: &GrayImage) -> Split {
    let (width, height) = plate.dimensions();
    let small = (width.min(height) >= LEAST_PLATE_PX).then(|| Small::new(plate));
    let Some(small) = small.filter(|small| small.range() >= LEAST_RANGE) else {
        return Split { panels: Vec::new(), doubts: vec![Doubt::Nothing] };
    };
    let readings = reading::all(plate, &small);
    let Some(best) = readings.first().filter(|best| best.is_credible()) else {
        return Split { panels: vec![whole(plate)], doubts: vec![Doubt::NoMount] };
    };
    let panels =
        best.layout.cells.iter().zip(&best.outlines).map(|(cell, outline)| panel(cell, outline)).collect();
    Split { panels, doubts: doubt::doubts(best, &readings[1..]) }
}

fn panel(cell: &Cell, outline: &Outline) -> FoundPanel {
    FoundPanel {
        quad_px: outline.quad_px,
        confidence: outline.mean_seen(),
        row: cell.row,
        column: cell.column,
    }
}

/// The whole picture as one photograph.
fn whole(plate: &GrayImage) -> FoundPanel {
    let [right, bottom] = [plate.width(), plate.height()].map(f64::from);
    let quad_px = [[0.0, 0.0], [right, 0.0], [right, bottom], [0.0, bottom]];
    FoundPanel { quad_px, confidence: 0.0, row: 0, column: 0 }
}

/// Middle value, the upper one of two; zero of none.
fn median(mut values: Vec<f64>) -> f64 {
    let middle = values.len() / 2;
    if values.is_empty() {
        return 0.0;
    }
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
