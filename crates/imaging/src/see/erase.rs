//! Painting over the wall's lines with what lies to both sides of them.

use image::{GrayImage, Luma};

use super::lines::{Search, Tone, Upright, find};

/// Lines less certain than this stay: a leg is better kept than a line removed.
const LEAST_CONFIDENCE: f64 = 0.15;
/// Broader lines may be legs, share of the width.
const MOST_BREADTH: f64 = 0.013;
/// What is so many times broader or deeper than the line is something before it: a leg.
const BEFORE: f64 = 1.7;
/// Where so little of the line's depth is left it is behind something, or not there.
const ABSENT: f64 = 0.5;
/// Difference of tone that grain alone makes.
const LITTLE: f64 = 12.0;
/// Uprights lean less than this, px per px: those of 1878 lean inward by up to 0.1.
const UPRIGHT: Search = Search { lean: 0.16, length: 0.22 };
/// Panels are squared up; rails and rules stay nearly level.
pub(super) const LEVEL: Search = Search { lean: 0.05, length: 0.4 };

/// The panel without the uprights and rails that are of the horse's tone, next to the wall's. Before a light horse, dark ones
/// matter, too: its hooves and mane are.
pub(super) fn erased(image: &GrayImage, horse: Tone) -> GrayImage {
    let tones: &[Tone] = if horse == Tone::Dark { &[Tone::Dark] } else { &[Tone::Light, Tone::Dark] };
    let mut clean = image.clone();
    for line in tones.iter().flat_map(|tone| find(image, None, *tone, UPRIGHT)) {
        erase(&mut clean, &line);
    }
    let (turned, mut clean) = (transposed(image), transposed(&clean));
    for line in tones.iter().flat_map(|tone| find(&turned, None, *tone, LEVEL)) {
        erase(&mut clean, &line);
    }
    transposed(&clean)
}

/// Columns become rows.
pub(super) fn transposed(image: &GrayImage) -> GrayImage {
    GrayImage::from_fn(image.height(), image.width(), |x, y| *image.get_pixel(y, x))
}

fn erase(image: &mut GrayImage, line: &Upright) {
    let (width, height) = image.dimensions();
    let most = (MOST_BREADTH * f64::from(width)).max(3.5);
    if line.confidence < LEAST_CONFIDENCE || line.breadth > most {
        return;
    }
    let half = 0.5 * line.breadth + 1.0;
    for y in 0..height {
        let x = line.x(f64::from(y) + 0.5);
        let (left, right) = ((x - half - 1.5).floor(), (x + half + 0.5).ceil());
        if left < 0.0 || right >= f64::from(width) || is_hidden(image, line, y, x) {
            continue;
        }
        let (left, right) = (left as u32, right as u32);
        let [from, to] = [left, right].map(|x| f64::from(image.get_pixel(x, y).0[0]));
        for x in left + 1..right {
            let share = f64::from(x - left) / f64::from(right - left);
            image.put_pixel(x, y, Luma([(from + (to - from) * share).round() as u8]));
        }
    }
}

/// Whether something broader or deeper than the line covers it in a row.
fn is_hidden(image: &GrayImage, line: &Upright, y: u32, x: f64) -> bool {
    let reach = (line.breadth + 3.0) as u32;
    let middle = (x.max(0.0) as u32).min(image.width() - 1);
    let (first, last) = (middle.saturating_sub(reach), (middle + reach).min(image.width() - 1));
    let at = |x: u32| f64::from(image.get_pixel(x, y).0[0]);
    let (left, right) = (at(middle) - at(first), at(middle) - at(last));
    let depth = 0.5 * (left + right).abs();
    let like = |x: &u32| (at(*x) - at(middle)).abs() < 0.5 * line.depth;
    let to_left = (first..middle).rev().take_while(like).count();
    let to_right = (middle + 1..=last).take_while(like).count();
    depth < ABSENT * line.depth
        || depth > BEFORE * line.depth + LITTLE
        || (1 + to_left + to_right) as f64 > BEFORE * line.breadth + 2.0
}
