//! How far a silhouette can be trusted.

use image::GrayImage;

use super::evidence::Evidence;

/// Tones are compared this far inside and outside the outline, px of the reduced panel.
const REACH: i64 = 2;
/// A step of this share of the horse's contrast is an outline, ...
const STEP: f32 = 0.3;
/// ... if it is more than this many standard deviations of the wall.
const STEP_NOISE: f32 = 2.5;
/// Steps are found along this much of a good outline; along half as much of one that tells nothing.
const GOOD_OUTLINE: f64 = 0.9;
/// Contrast in standard deviations of the wall that makes a silhouette certain.
const GOOD_CONTRAST: f32 = 10.0;
/// Shares of a panel that a horse may cover: a small one in the distance; one that fills the panel, with a sulky.
const AREA: [f64; 2] = [0.015, 0.6];
/// Along so much of its outline a silhouette may be cut off by the panel's edge.
const CUT_OFF: f64 = 0.15;
/// Horses of one plate differ less in area than this, as a factor.
const LIKE_AREA: f64 = 1.5;

/// What is measured of one silhouette.
pub(super) struct Look {
    /// Share of the panel.
    pub(super) area: f64,
    /// 0 to 1, by the panel alone.
    pub(super) confidence: f64,
}

impl Look {
    pub(super) fn new(evidence: &Evidence, horse: &GrayImage) -> Self {
        let (mut outline, mut steps, mut cut) = (0u32, 0u32, 0u32);
        let mut inside = 0u32;
        for (x, y, _) in horse.enumerate_pixels().filter(|(_, _, pixel)| pixel.0[0] > 0) {
            inside += 1;
            for (dx, dy) in [(1, 0), (-1, 0), (0, 1), (0, -1)] {
                let (x, y) = (i64::from(x), i64::from(y));
                match value(horse, x + dx, y + dy) {
                    None => cut += 1,
                    Some(0) => {
                        outline += 1;
                        steps += u32::from(is_step(evidence, [x, y], [dx, dy]));
                    }
                    Some(_) => {}
                }
            }
        }
        let area = f64::from(inside) / (f64::from(horse.width()) * f64::from(horse.height())).max(1.0);
        if outline == 0 || !(AREA[0]..AREA[1]).contains(&area) {
            return Self { area, confidence: 0.0 };
        }
        let found = f64::from(steps) / f64::from(outline);
        let cut = f64::from(cut) / f64::from(outline + cut);
        let contrast = (evidence.full_contrast() / evidence.background.noise / GOOD_CONTRAST).clamp(0.0, 1.0);
        let outline = ((2.0 * found - GOOD_OUTLINE) / GOOD_OUTLINE).clamp(0.0, 1.0);
        let whole = (1.0 - cut / CUT_OFF).clamp(0.0, 1.0).sqrt();
        Self { area, confidence: outline * whole * f64::from(contrast).sqrt() }
    }
}

fn value(mask: &GrayImage, x: i64, y: i64) -> Option<u8> {
    let (x, y) = (u32::try_from(x).ok()?, u32::try_from(y).ok()?);
    mask.get_pixel_checked(x, y).map(|pixel| pixel.0[0])
}

/// Whether the tone changes across the outline.
fn is_step(evidence: &Evidence, [x, y]: [i64; 2], [dx, dy]: [i64; 2]) -> bool {
    let tone = |x: i64, y: i64| {
        let column = x.clamp(0, i64::from(evidence.tone.width()) - 1) as u32;
        let row = y.clamp(0, i64::from(evidence.tone.height()) - 1) as u32;
        evidence.tone.get_pixel(column, row).0[0]
    };
    let step = (tone(x + REACH * dx, y + REACH * dy) - tone(x - REACH * dx, y - REACH * dy)).abs();
    step > (STEP * evidence.full_contrast()).max(STEP_NOISE * evidence.background.noise)
}

/// Confidences of a plate's silhouettes: each by itself, and whether its area is like the others'.
pub(super) fn confidences(looks: &[Look]) -> Vec<f64> {
    let mut areas: Vec<f32> = looks.iter().filter(|l| l.confidence > 0.0).map(|l| l.area as f32).collect();
    let middle = f64::from(super::quantile(&mut areas, 0.5));
    let like = |area: f64| (2.0 - (area / middle).max(middle / area) / LIKE_AREA).clamp(0.0, 1.0);
    looks
        .iter()
        .map(|look| if look.confidence > 0.0 { look.confidence * like(look.area) } else { 0.0 })
        .collect()
}
