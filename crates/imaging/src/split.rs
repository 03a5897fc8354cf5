//! Finding the panels of a plate.

mod edge;
mod fold;
mod layout;
mod mask;
mod mount;
mod overlap;
mod spans;

use image::{GrayImage, Luma};

use edge::RoughEdge;
use layout::{Cell, Layout};
use mask::{Mask, Turn};
pub use overlap::iou;

type Point = [f64; 2];

/// Longest side of the small copy on which panels are first found, px.
const SMALL_PX: u32 = 2000;

/// A photograph found on a plate.
#[derive(Clone, Debug, PartialEq)]
pub struct FoundPanel {
    pub quad_px: [Point; 4],
    pub confidence: f64,
    pub row: usize,
    pub column: usize,
    pub seen: [f64; 4],
    pub inferred: [bool; 4],
}

#[derive(Clone, Debug)]
pub struct Split {
    pub panels: Vec<FoundPanel>,
    pub doubts: Vec<String>,
}

impl Split {
    pub fn is_certain(&self) -> bool { self.doubts.is_empty() }
}

pub fn split(plate: &GrayImage) -> Split {
    let factor = plate.width().max(plate.height()).div_ceil(SMALL_PX).max(1);
    let small = reduced(plate, factor);
    let smooth = if factor < 3 { imageproc::filter::median_filter(&small, 1, 1) } else { small };
    let debug = std::env::var("SPLIT_DEBUG").unwrap_or_default();
    let mut layouts: Vec<(Layout, Turn)> = Vec::new();
    for tones in mount::candidates(&smooth) {
        let mut mount = smooth.clone();
        for p in mount.pixels_mut() {
            p.0[0] = if (tones.darkest..=tones.lightest).contains(&p.0[0]) { 255 } else { 0 };
        }
        let tilt = mask::tilt_rad(&mount);
        let (mut turned, turn) = mask::upright(&mount, tilt);
        let Some(region) = mask::extent(&turned) else { continue };
        let mut mask = Mask::new(&turned);
        let folds = fold::find(&mask, region);
        for fold in &folds {
            fold.fill(&mut turned);
        }
        if !folds.is_empty() {
            mask = Mask::new(&turned);
        }
        let Some(mut found) = layout::find(&mask, region) else { continue };
        found.folds = folds;
        if !debug.is_empty() {
            eprintln!("{tones:?} tilt {:.2} region {region:?} of {:?} -> {:?}", tilt.to_degrees(), turned.dimensions(), (found.cells.len(), found.worth, &found.folds));
            if debug == "2" { for c in &found.cells { eprintln!("    {c:?}"); } }
        }
        layouts.push((found, turn));
    }
    layouts.sort_by(|a, b| b.0.worth.total_cmp(&a.0.worth));
    let mut best: Option<(f64, Vec<FoundPanel>)> = None;
    for (layout, turn) in layouts.iter_mut().take(4) {
        let panels = refined(plate, layout, turn, f64::from(factor));
        let seen = panels.iter().map(|p| p.confidence).sum::<f64>() / panels.len() as f64;
        let score = layout.worth * seen * seen;
        if !debug.is_empty() { eprintln!("{} panels, worth {:.2} seen {seen:.2} score {score:.3}", panels.len(), layout.worth); }
        if best.as_ref().is_none_or(|b| score > b.0) { best = Some((score, panels)); }
    }
    let panels = best.map(|b| b.1).unwrap_or_default();
    Split { panels, doubts: vec![] }
}

fn refined(plate: &GrayImage, layout: &mut Layout, turn: &Turn, factor: f64) -> Vec<FoundPanel> {
        let mut panels: Vec<FoundPanel> = layout.cells.iter().map(|cell| refine(plate, layout, cell, turn, factor)).collect();
        for (cell, panel) in layout.cells.iter_mut().zip(&panels) {
            let q = panel.quad_px.map(|p| turn.forth(p.map(|v| v / factor)));
            cell.edges = [0.5 * (q[0][0] + q[3][0]), 0.5 * (q[0][1] + q[1][1]), 0.5 * (q[1][0] + q[2][0]), 0.5 * (q[2][1] + q[3][1])];
            cell.inferred = [false; 4];
        }
        layout::agree(&mut layout.cells, layout.region, 0, 0.03);
        layout::agree(&mut layout.cells, layout.region, 1, 0.03);
        for (i, cell) in layout.cells.iter().enumerate() {
            if cell.inferred.contains(&true) {
                panels[i] = refine(plate, layout, cell, turn, factor);
            }
        }
    panels
}

fn refine(plate: &GrayImage, layout: &Layout, cell: &Cell, turn: &Turn, factor: f64) -> FoundPanel {
    let [l, t, r, b] = cell.edges;
    let corners = [[l, t], [r, t], [r, b], [l, b]].map(|p| turn.back(p).map(|v| v * factor));
    let outside = cell.mount_outside(layout);
    let size = [b - t, r - l, b - t, r - l];
    let folds: Vec<fold::Fold> = layout.folds.iter().map(|f| fold::Fold { ends: f.ends.map(|p| turn.back(p).map(|v| v * factor)), width: f.width * factor }).collect();
    let found: [edge::SeenEdge; 4] = std::array::from_fn(|i| {
        let mount_px = outside[[1, 2, 3, 0][i]].map(|v| v * factor);
        edge::find(plate, &folds, RoughEdge { ends: [corners[i], corners[(i + 1) % 4]], size_px: size[i] * factor, mount_px })
    });
    // corner i is where edge i-1 meets edge i.
    let quad = std::array::from_fn(|i| meeting(found[(i + 3) % 4].ends, found[i].ends).unwrap_or(corners[i]));
    let seen = found.map(|f| f.seen);
    FoundPanel { quad_px: quad, confidence: seen.iter().sum::<f64>() / 4.0, row: cell.row, column: cell.column, seen, inferred: cell.inferred }
}

fn meeting([a, b]: [Point; 2], [c, d]: [Point; 2]) -> Option<Point> {
    let (ux, uy) = (b[0] - a[0], b[1] - a[1]);
    let (vx, vy) = (d[0] - c[0], d[1] - c[1]);
    let det = ux * vy - uy * vx;
    let s = ((c[0] - a[0]) * vy - (c[1] - a[1]) * vx) / det;
    s.is_finite().then(|| [a[0] + s * ux, a[1] + s * uy])
}

fn reduced(plate: &GrayImage, factor: u32) -> GrayImage {
    let (w, h) = (plate.width() / factor, plate.height() / factor);
    let stride = plate.width() as usize;
    let px = plate.as_raw();
    let f = factor as usize;
    let mut sums = vec![0u32; w as usize];
    let mut out = GrayImage::new(w, h);
    for y in 0..h as usize {
        sums.fill(0);
        for j in 0..f {
            let line = &px[(y * f + j) * stride..][..w as usize * f];
            for (s, c) in sums.iter_mut().zip(line.chunks_exact(f)) {
                *s += c.iter().map(|v| u32::from(*v)).sum::<u32>();
            }
        }
        for (x, s) in sums.iter().enumerate() {
            out.put_pixel(x as u32, y as u32, Luma([(s / (factor * factor)) as u8]));
        }
    }
    out
}
