//! Uprights and level lines of the wall.

use image::GrayImage;
use imageproc::distance_transform::Norm;
use imageproc::morphology::dilate;

use super::erase::{LEVEL, transposed};
use super::lines::{Search, Tone, Upright, find};
use super::spacing::Spacing;
use super::{Line, Silhouette};
use crate::PanelView;

/// Uprights lean less than this. Faint ones are seen over this share of the height between horse, rider and edge.
const UPRIGHT: Search = Search { lean: 0.16, length: 0.1 };
/// A line of this confidence is an upright by itself, ...
const CERTAIN: f64 = 0.18;
/// ... one of this confidence where an upright is due.
const FAINT: f64 = 0.05;
/// Lines nearer to a better one are its own edges, share of the width.
const APART: f64 = 0.013;
/// The horse is kept clear of by this share of the width.
const CLEAR: f64 = 0.008;

/// Lines of a panel's wall: uprights from left to right, levels from the top down.
pub(super) fn lines(view: &PanelView, horse: &Silhouette) -> [Vec<Line>; 2] {
    let clear = (CLEAR * f64::from(view.image.width())).ceil().min(255.0) as u8;
    let hidden = dilate(&horse.mask, Norm::LInf, clear);
    let uprights = uprights(&view.image, &hidden).into_iter().map(|line| Line {
        ends_px: [[line.x(line.from), line.from], [line.x(line.to), line.to]],
        confidence: line.confidence,
    });
    let levels =
        both_tones(&transposed(&view.image), &transposed(&hidden), LEVEL).into_iter().map(|line| Line {
            ends_px: [[line.from, line.x(line.from)], [line.to, line.x(line.to)]],
            confidence: line.confidence,
        });
    [uprights.collect(), levels.collect()]
}

fn uprights(image: &GrayImage, hidden: &GrayImage) -> Vec<Upright> {
    let mut all = both_tones(image, hidden, UPRIGHT);
    let middle = 0.5 * f64::from(image.height());
    let certain: Vec<&Upright> = all.iter().filter(|line| line.confidence >= CERTAIN).collect();
    let spacing = Spacing::of(&certain, middle);
    all.retain(|line| match &spacing {
        Some(spacing) => line.confidence >= FAINT && spacing.expects(line),
        None => line.confidence >= CERTAIN,
    });
    all
}

/// Lines darker and lighter than the wall, each once.
fn both_tones(image: &GrayImage, hidden: &GrayImage, search: Search) -> Vec<Upright> {
    let mut found = find(image, Some(hidden), Tone::Dark, search);
    found.extend(find(image, Some(hidden), Tone::Light, search));
    found.sort_by(|a, b| b.confidence.total_cmp(&a.confidence));
    let apart = (APART * f64::from(image.width())).max(4.0);
    let mut lines: Vec<Upright> = Vec::new();
    for line in found {
        let middle = 0.5 * (line.from + line.to);
        if lines.iter().all(|other| (other.x(middle) - line.x(middle)).abs() > apart) {
            lines.push(line);
        }
    }
    lines.sort_by(|a, b| a.at.total_cmp(&b.at));
    lines
}
