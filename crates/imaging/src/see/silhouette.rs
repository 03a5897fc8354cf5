//! Horse and rider, apart from wall and track.

use image::Luma;

use super::evidence::{self, Evidence};
use super::{Plane, Silhouette, outline, relax};
use crate::PanelView;

/// Neighbours whose tones differ by less than this share of the contrast pull together.
const LIKE: f32 = 0.15;

/// The horse of every panel.
pub(super) fn find(views: &[PanelView]) -> Vec<Silhouette> {
    evidence::of_panels(views)
        .iter()
        .zip(views)
        .map(|(evidence, view)| {
            let horse = outline::pieces(evidence, &probability(evidence));
            Silhouette { mask: outline::refined(&view.image, evidence, &horse), confidence: 1.0 }
        })
        .collect()
}

fn probability(evidence: &Evidence) -> Plane {
    let tone = &evidence.tone;
    let odds = Plane::from_fn(tone.width(), tone.height(), |x, y| {
        Luma([evidence.odds(x, y, tone.get_pixel(x, y).0[0])])
    });
    let noise = evidence.background.noise;
    let wall = evidence.background.tone.get_pixel(tone.width() / 2, tone.height() / 2).0[0];
    relax::relaxed(&odds, tone, (2.0 * noise).max(LIKE * (evidence.contrast * wall).abs()))
}
