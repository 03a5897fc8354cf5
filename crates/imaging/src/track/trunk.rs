//! The trunk: the part that changes least from panel to panel, and so the frame for all others.

use super::climb::climb;
use super::figure::{Figure, Segment};
use super::frame::{Frame, Level, Place, step};
use super::template::{Extent, Template};

/// What of the trunk is compared, around the line of the back: a little above it, and down to the belly.
const EXTENT: Extent = Extent { ends: [0.0, 0.04], sides: [0.1, 0.33] };
/// Distance of samples in the search and in the refinement, px: the trunk is large.
const SAMPLE_STEPS_PX: [f64; 2] = [4.0, 3.0];
/// Weight of one unit of likeness, in units of log probability.
const LIKENESS_WEIGHT: f64 = 30.0;
/// How far the trunk strays from where it is expected in a panel, body heights: cameras of a battery fire a little early or
/// late.
const PLACE_SD: f64 = 0.3;
/// How much the trunk pitches between panels, radians: a tenth in a leap, less in the gaits.
const PITCH_SD: f64 = 0.09;
/// Pitches tried, radians.
const PITCHES: [f64; 9] = [-0.32, -0.24, -0.16, -0.08, 0.0, 0.08, 0.16, 0.24, 0.32];
/// Distance of places tried, px: the trunk's likeness is smooth over a fifth of its height.
const STRIDE: usize = 2;
/// First steps of the refinement: place, body heights, and pitch, radians. Halved this many times.
const STEPS: [f64; 3] = [0.016, 0.016, 0.03];
const HALVINGS: u32 = 4;

/// How the trunk moves from one panel to another.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrunkMotion {
    from: Place,
    to: Place,
    /// Turn, radians, clockwise.
    pub(super) pitch: f64,
    /// Likeness of the trunk in the two panels, -1..1; 0 where it was not compared.
    pub(super) likeness: f64,
}

impl TrunkMotion {
    /// Where the trunk carries a place.
    pub(super) fn apply(&self, place: Place) -> Place {
        let (sin, cos) = self.pitch.sin_cos();
        let [x, y] = step(self.from, place);
        [self.to[0] + x * cos - y * sin, self.to[1] + x * sin + y * cos]
    }

    /// From the last of the figures, whose panel is `last`, to the next panel. Where no trunk is placed, it is taken to stay
    /// where it is in the panel.
    pub(super) fn find(figures: &[Figure], last: &Frame, next: &Frame) -> Self {
        let trunks: Vec<Option<Segment>> = figures.iter().rev().take(2).map(Figure::trunk).collect();
        let Some(trunk) = trunks.first().copied().flatten() else {
            return Self { from: [0.0; 2], to: [0.0; 2], pitch: 0.0, likeness: 0.0 };
        };
        // A battery follows the animal; before a single camera it goes on as it went.
        let mut expected = vec![trunk.to];
        if let Some(before) = trunks.get(1).copied().flatten() {
            let [dx, dy] = step(before.to, trunk.to);
            expected.push([trunk.to[0] + dx, trunk.to[1] + dy]);
        }
        let prior = |[x, y, pitch]: [f64; 3]| {
            let off = |e: &Place| (x - e[0]).hypot(y - e[1]) / PLACE_SD;
            let nearest = expected.iter().map(off).fold(f64::INFINITY, f64::min);
            -0.5 * (nearest * nearest + (pitch / PITCH_SD).powi(2))
        };
        let template = |level: &Level, step_px| Template::new(level, trunk, EXTENT, step_px, &[]);
        let start = search(&template(&last.coarse, SAMPLE_STEPS_PX[0]), &next.coarse, trunk.angle(), &prior);
        let fine = template(&last.fine, SAMPLE_STEPS_PX[1]);
        let likeness = |u: &[f64]| fine.likeness(&next.fine, [u[0], u[1]], trunk.angle() + u[2]);
        let mut unknowns = start.unwrap_or([trunk.to[0], trunk.to[1], 0.0]);
        climb(&mut unknowns, &STEPS, 0..=HALVINGS, |u| {
            LIKENESS_WEIGHT * likeness(u) + prior([u[0], u[1], u[2]])
        });
        let [x, y, pitch] = unknowns;
        Self { from: trunk.to, to: [x, y], pitch, likeness: likeness(&unknowns) }
    }
}

/// The best place and pitch of all.
fn search(
    template: &Template,
    level: &Level,
    angle: f64,
    prior: &impl Fn([f64; 3]) -> f64,
) -> Option<[f64; 3]> {
    let [width, height] = level.size_px;
    let mut best = None;
    let mut top = f64::NEG_INFINITY;
    for pitch in PITCHES {
        let offsets = template.offsets(angle + pitch);
        for (x, y) in
            (0..height).step_by(STRIDE).flat_map(|y| (0..width).step_by(STRIDE).map(move |x| (x, y)))
        {
            let place = level.place_of_pixel([x, y]);
            let unknowns = [place[0], place[1], pitch];
            let expected = prior(unknowns);
            if expected + LIKENESS_WEIGHT < top {
                continue;
            }
            let score =
                expected + LIKENESS_WEIGHT * f64::from(template.likeness_at_pixel(level, &offsets, [x, y]));
            if score > top {
                (top, best) = (score, Some(unknowns));
            }
        }
    }
    best
}
