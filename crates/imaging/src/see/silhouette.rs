//! Horse and rider, apart from wall and track.

use image::{GrayImage, Luma};

use super::evidence::{self, Evidence};
use super::trust::{self, Look};
use super::{Plane, Silhouette, outline, relax};
use crate::PanelView;

/// A horse in a panel with a shorter side is a few specks.
const LEAST_PX: u32 = 16;
/// Neighbours whose tones differ by less than this share of the contrast pull together.
const LIKE: f32 = 0.15;

/// The horse of every panel.
pub(super) fn find(views: &[PanelView]) -> Vec<Silhouette> {
    let (masks, looks): (Vec<GrayImage>, Vec<Look>) = evidence::of_panels(views)
        .iter()
        .zip(views)
        .map(|(evidence, view)| {
            let [width, height] = [evidence.tone.width(), evidence.tone.height()];
            if width.min(height) < LEAST_PX {
                let mask = GrayImage::new(view.image.width(), view.image.height());
                return (mask, Look { area: 0.0, confidence: 0.0 });
            }
            let horse = outline::pieces(evidence, &probability(evidence));
            (outline::refined(&view.image, evidence, &horse), Look::new(evidence, &horse))
        })
        .unzip();
    let confidences = trust::confidences(&looks);
    masks.into_iter().zip(confidences).map(|(mask, confidence)| Silhouette { mask, confidence }).collect()
}

fn probability(evidence: &Evidence) -> Plane {
    let tone = &evidence.tone;
    let odds = Plane::from_fn(tone.width(), tone.height(), |x, y| {
        Luma([evidence.odds(x, y, tone.get_pixel(x, y).0[0])])
    });
    relax::relaxed(&odds, tone, (2.0 * evidence.background.noise).max(LIKE * evidence.full_contrast()))
}
