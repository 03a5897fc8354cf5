//! A limb, or neck and head, as a chain of segments sought as one: the postures that what is expected and what is seen
//! make most probable.

use std::ops::RangeInclusive;

use super::climb::climb;
use super::expectation::Expectation;
use super::figure::Segment;
use super::frame::{Frame, Level, Place, distance, step};
use super::search::{Search, TipMap};
use super::template::Template;

/// A tip expected to stand stays within this of its place, body heights.
const STANDING_SD: f64 = 0.04;
/// What a tip that stands as expected is worth, in units of log probability.
const STANDING_BONUS: f64 = 3.0;
/// First steps of the refinement: root, body heights; angles, radians; lengths, shares.
const STEPS: [f64; 3] = [0.012, 0.08, 0.06];
/// How often they are halved for postures still to be chosen from, and then again for the chosen one.
const HALVINGS: [u32; 2] = [1, 3];

/// A segment of a chain: what is expected of it and what it looks like.
pub(super) struct Link {
    /// Length in body heights.
    pub(super) length: f64,
    /// Its standard deviation as a share.
    pub(super) length_sd: f64,
    /// Where it points.
    pub(super) expectation: Expectation,
    /// Weight of one unit of likeness, in units of log probability.
    pub(super) weight: f64,
    /// Its looks, for the search.
    pub(super) coarse: Vec<Template>,
    /// Its looks, for the refinement.
    pub(super) fine: Vec<Template>,
}

/// Segments from a root.
pub(super) struct Chain {
    /// Expected place of the root.
    pub(super) root: Place,
    /// Its standard deviation, body heights.
    pub(super) root_sd: f64,
    /// Root to tip.
    pub(super) links: Vec<Link>,
    /// Where the tip is if it stands on the ground as it did.
    pub(super) standing: Option<Place>,
}

/// A posture of a chain.
#[derive(Clone, Debug)]
pub(super) struct Posture {
    /// Root to tip.
    pub(super) joints: Vec<Place>,
    /// Of each segment, -1..1.
    pub(super) likeness: Vec<f64>,
    /// Log probability, up to a constant.
    pub(super) score: f64,
    /// Share of the coarse search's probability near the tip, 0..1.
    pub(super) concentration: f64,
}

impl Posture {
    pub(super) fn segment(&self, number: usize) -> Segment {
        Segment { from: self.joints[number], to: self.joints[number + 1] }
    }

    pub(super) fn segments(&self) -> impl Iterator<Item = Segment> {
        self.joints.windows(2).map(|ends| Segment { from: ends[0], to: ends[1] })
    }

    pub(super) fn tip(&self) -> Option<Place> {
        self.joints.last().copied()
    }
}

impl Link {
    /// Mean likeness to its looks, -1..1.
    fn likeness(&self, level: &Level, place: Place, angle: f64) -> f64 {
        let sum: f64 = self.fine.iter().map(|template| template.likeness(level, place, angle)).sum();
        sum / self.fine.len().max(1) as f64
    }
}

impl Chain {
    /// The best postures, each with its tip elsewhere; none when the chain has no links.
    pub(super) fn find(&self, next: &Frame) -> Vec<Posture> {
        let search = Search::run(self, &next.coarse);
        let Some(tips) = search.tips() else { return Vec::new() };
        let refined = |state| {
            let mut posture = self.refine(&next.fine, &search.joints(self, state), 0..=HALVINGS[0]);
            posture.concentration = posture.tip().map_or(0.0, |tip| tips.share_near(tip));
            posture
        };
        TipMap::peaks(&tips).into_iter().map(refined).collect()
    }

    /// A posture that was found, refined to the end.
    pub(super) fn settle(&self, next: &Frame, posture: &Posture) -> Posture {
        let halvings = HALVINGS[0] + 1..=HALVINGS[1];
        Posture { concentration: posture.concentration, ..self.refine(&next.fine, &posture.joints, halvings) }
    }

    /// What a place of the tip adds to the log probability.
    pub(super) fn standing_bonus(&self, tip: Place) -> f64 {
        let bonus = |place| STANDING_BONUS * (-0.5 * (distance(tip, place) / STANDING_SD).powi(2)).exp();
        self.standing.map_or(0.0, bonus)
    }

    /// Climbs from joints near a summit to it.
    fn refine(&self, level: &Level, joints: &[Place], halvings: RangeInclusive<u32>) -> Posture {
        let count = self.links.len();
        let mut unknowns = joints[0].to_vec();
        let steps: Vec<Place> = joints.windows(2).map(|ends| step(ends[0], ends[1])).collect();
        unknowns.extend(steps.iter().map(|[x, y]| y.atan2(*x)));
        unknowns.extend(steps.iter().zip(&self.links).map(|([x, y], link)| x.hypot(*y) / link.length));
        let mut first_steps = vec![STEPS[0]; 2];
        first_steps.extend(std::iter::repeat_n(STEPS[1], count));
        first_steps.extend(std::iter::repeat_n(STEPS[2], count));
        let score = climb(&mut unknowns, &first_steps, halvings, |u| self.score(level, u));
        let joints = self.joints(&unknowns);
        let seen = |(i, link): (usize, &Link)| link.likeness(level, joints[i + 1], unknowns[2 + i]);
        let likeness = self.links.iter().enumerate().map(seen).collect();
        Posture { joints, likeness, score, concentration: 0.0 }
    }

    /// Log probability of root, angles and lengths, up to a constant.
    fn score(&self, level: &Level, unknowns: &[f64]) -> f64 {
        let (angles, lengths) = unknowns[2..].split_at(self.links.len());
        let joints = self.joints(unknowns);
        let mut score = -0.5 * (distance(joints[0], self.root) / self.root_sd).powi(2);
        for (i, link) in self.links.iter().enumerate() {
            let stretch = (lengths[i] - 1.0) / link.length_sd;
            score += link.expectation.log_probability(angles[i], &angles[..i]) - 0.5 * stretch * stretch;
            score += link.weight * link.likeness(level, joints[i + 1], angles[i]);
        }
        score + joints.last().map_or(0.0, |tip| self.standing_bonus(*tip))
    }

    fn joints(&self, unknowns: &[f64]) -> Vec<Place> {
        let (angles, lengths) = unknowns[2..].split_at(self.links.len());
        let mut place = [unknowns[0], unknowns[1]];
        let mut joints = vec![place];
        for ((angle, share), link) in angles.iter().zip(lengths).zip(&self.links) {
            let length = share * link.length;
            place = [place[0] + length * angle.cos(), place[1] + length * angle.sin()];
            joints.push(place);
        }
        joints
    }
}
