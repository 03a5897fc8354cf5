//! The trunk: the one part that hardly changes from panel to panel, and so the frame for all others.

use super::climb::climb;
use super::frame::{Frame, Level, Place};
use super::template::{Extent, Segment, Template};

/// What of the trunk is compared: from a little over the back to the belly; less than half of the height beneath the
/// back is trunk, and legs change.
const EXTENT: Extent = Extent { ends: [0.0, 0.05], sides: [0.12, 0.4] };
/// Distance of samples, px: the trunk is large.
const STEP_PX: f64 = 3.0;
/// Weight of one unit of likeness, in units of log probability.
const LIKENESS_WEIGHT: f64 = 30.0;
/// How far the trunk strays from where it is expected in a panel: cameras of a battery fire a little early or late.
const PLACE_SD: f64 = 0.35;
/// How much the trunk pitches between panels, radians.
const PITCH_SD: f64 = 0.09;

/// How the trunk moves from one panel to another.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrunkMotion {
    pub(super) from: Place,
    pub(super) to: Place,
    pub(super) pitch: f64,
    /// Likeness of the trunk in the two panels, -1..1; 0 where it was not compared.
    pub(super) likeness: f64,
}

impl TrunkMotion {
    pub(super) fn apply(&self, [x, y]: Place) -> Place {
        let (sin, cos) = self.pitch.sin_cos();
        let (x, y) = (x - self.from[0], y - self.from[1]);
        [self.to[0] + x * cos - y * sin, self.to[1] + x * sin + y * cos]
    }

    /// The trunk of one panel, sought in another near any of the expected moves of its front end.
    pub(super) fn find(last: &Frame, next: &Frame, trunk: Segment, expected: &[Place]) -> Self {
        let prior = |to: Place, pitch: f64| {
            let off = |e: &Place| (to[0] - trunk.to[0] - e[0]).hypot(to[1] - trunk.to[1] - e[1]) / PLACE_SD;
            let nearest = expected.iter().map(off).fold(f64::INFINITY, f64::min);
            -0.5 * (nearest * nearest + (pitch / PITCH_SD).powi(2))
        };
        let template = |level: &Level| Template::new(level, trunk, EXTENT, STEP_PX, &[]);
        let coarse = template(&last.coarse);
        let start = Self::search(&coarse, &next.coarse, trunk.angle(), &prior);
        let fine = template(&last.fine);
        let likeness = |[x, y, pitch]: [f64; 3]| {
            let layers = fine.likeness(&next.fine, [x, y], trunk.angle() + pitch);
            f64::from(layers.iter().sum::<f32>()) / layers.len() as f64
        };
        let mut unknowns = start;
        climb(&mut unknowns, &[0.02, 0.02, 0.03], 4, |u| {
            LIKENESS_WEIGHT * likeness([u[0], u[1], u[2]]) + prior([u[0], u[1]], u[2])
        });
        let [x, y, pitch] = unknowns;
        Self { from: trunk.to, to: [x, y], pitch, likeness: likeness(unknowns) }
    }

    /// Place and pitch of the best of all places.
    fn search(template: &Template, level: &Level, angle: f64, prior: &impl Fn(Place, f64) -> f64) -> [f64; 3] {
        /// Distance of places tried, px: the trunk's likeness is smooth over a fifth of its height.
        const STRIDE: usize = 2;
        let [width, height] = level.size();
        let layers = template.layers(level);
        let mut best = (f64::NEG_INFINITY, [0.0; 3]);
        for pitch in [-0.32, -0.24, -0.16, -0.08, 0.0, 0.08, 0.16, 0.24, 0.32] {
            let offsets = template.offsets(angle + pitch);
            for (x, y) in (0..height).step_by(STRIDE).flat_map(|y| (0..width).step_by(STRIDE).map(move |x| (x, y))) {
                let place = level.place_of_pixel([x, y]);
                let expected = prior(place, pitch);
                if expected + LIKENESS_WEIGHT < best.0 {
                    continue;
                }
                let sum: f32 =
                    (0..layers).map(|layer| template.likeness_at_pixel(level, layer, &offsets, [x, y])).sum();
                let score = expected + LIKENESS_WEIGHT * f64::from(sum) / layers as f64;
                if score > best.0 {
                    best = (score, [place[0], place[1], pitch]);
                }
            }
        }
        best.1
    }
}
