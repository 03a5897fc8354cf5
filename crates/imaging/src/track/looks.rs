//! Chains made ready to be sought: what is expected of each, and what it looked like.

use muybridge_capture::{Keypoint, LimbJoint};

use super::chain::{Chain, Link};
use super::expectation::expectations;
use super::figure::{CHAINS, Figure, chain_keypoints, contralateral};
use super::frame::{Frame, Place, step};
use super::template::{Extent, Template};
use super::trunk::TrunkMotion;

/// Distance of a template's samples, px: finer ones take time and find no more.
const COARSE_STEP_PX: f64 = 2.0;
const FINE_STEP_PX: f64 = 2.4;
/// Standard deviation of a root about where the trunk carries it, body heights: a scapula slides, a withers hardly.
const LIMB_ROOT_SD: f64 = 0.03;
const NECK_ROOT_SD: f64 = 0.016;
/// A hoof this little over the lowest one may stand, body heights.
const MAY_STAND: f64 = 0.065;

/// What is particular to a kind of segment.
struct Kind {
    extent: Extent,
    /// Standard deviation of its length between panels, as a share: Sallie Gardner's hand-placed bones have 0.04 to 0.1,
    /// drawn ones none; a neck stretches.
    length_sd: f64,
    /// Weight of one unit of likeness, in units of log probability: what lies within the trunk looks like nothing much.
    weight: f64,
}

/// By the distal end. Half a limb's width is 0.02 to 0.04 body heights; as much beside it tells it from the ground.
fn kind(distal: Keypoint) -> Kind {
    let kind = |half: f64, beyond: f64, length_sd, weight| Kind {
        extent: Extent { ends: [0.0, beyond], sides: [half, half] },
        length_sd,
        weight,
    };
    match distal {
        Keypoint::Body(_) => kind(0.12, 0.04, 0.08, 17.6),
        Keypoint::Limb(_, _, LimbJoint::Root | LimbJoint::Upper) => kind(0.075, 0.0, 0.04, 8.8),
        Keypoint::Limb(_, _, LimbJoint::Middle) => kind(0.066, 0.0, 0.04, 15.4),
        Keypoint::Limb(_, _, LimbJoint::Fetlock) => kind(0.04, 0.0, 0.04, 17.6),
        Keypoint::Limb(_, _, LimbJoint::Hoof) => kind(0.04, 0.05, 0.07, 21.6),
    }
}

/// What was seen: panels made ready and their figures, latest last, and how the trunk went on from there.
pub(super) struct Seen<'a> {
    pub(super) frames: Vec<Frame<'a>>,
    pub(super) figures: Vec<Figure>,
    pub(super) trunk: TrunkMotion,
}

/// A chain of the last figure, and the keypoints at its joints.
pub(super) struct Sought {
    pub(super) keypoints: Vec<Keypoint>,
    pub(super) chain: Chain,
}

impl Seen<'_> {
    /// The chains that have at least one segment in the last panel.
    pub(super) fn sought(&self) -> Vec<Sought> {
        (0..CHAINS).filter_map(|number| self.sought_chain(number)).collect()
    }

    fn sought_chain(&self, number: usize) -> Option<Sought> {
        let last = self.figures.last()?;
        let mut keypoints = chain_keypoints(number);
        keypoints.retain(|keypoint| last.place(*keypoint).is_some());
        let whole = keypoints.windows(2).take_while(|ends| last.segment(ends[0], ends[1]).is_some()).count();
        if whole == 0 {
            return None;
        }
        keypoints.truncate(whole + 1);
        let expected = expectations(&self.figures, &keypoints, self.trunk.pitch);
        let links = keypoints.windows(2).zip(expected).map(|(ends, expectation)| {
            let Kind { extent, length_sd, weight } = kind(ends[1]);
            let [coarse, fine] = self.templates(number, [ends[0], ends[1]], extent);
            let length = self.mean_length([ends[0], ends[1]]);
            Link { length, length_sd, expectation, weight, coarse, fine }
        });
        let links = links.collect();
        let root_sd = if number == 0 { NECK_ROOT_SD } else { LIMB_ROOT_SD };
        let root = self.trunk.apply(last.place(keypoints[0])?);
        let standing = keypoints.last().and_then(|tip| self.standing(*tip));
        Some(Sought { chain: Chain { root, root_sd, links, standing }, keypoints })
    }

    fn mean_length(&self, [from, to]: [Keypoint; 2]) -> f64 {
        let lengths: Vec<f64> =
            self.figures.iter().filter_map(|figure| Some(figure.segment(from, to)?.length())).collect();
        lengths.iter().sum::<f64>() / lengths.len().max(1) as f64
    }

    /// Looks of a segment at both resolutions: in the last panel, in the one before, and the other limb's in the last. Their
    /// mean is worth more than any of them, because a limb rarely passes behind another in all three.
    fn templates(&self, number: usize, ends: [Keypoint; 2], extent: Extent) -> [Vec<Template>; 2] {
        let mut templates = [Vec::new(), Vec::new()];
        let last = self.figures.len() - 1;
        let mut sources = vec![(last, number, Some(ends))];
        if let Some(before) = last.checked_sub(1) {
            sources.push((before, number, Some(ends)));
        }
        let other = contralateral(ends[0]).zip(contralateral(ends[1])).map(|(from, to)| [from, to]);
        // Near and off limb of a pair: 1 and 2, 3 and 4.
        sources.push((last, if number % 2 == 1 { number + 1 } else { number.saturating_sub(1) }, other));
        for (panel, chain, ends) in sources {
            let (figure, frame) = (&self.figures[panel], &self.frames[panel]);
            let Some(segment) = ends.and_then(|[from, to]| figure.segment(from, to)) else { continue };
            let others = figure.other_limbs(chain);
            templates[0].push(Template::new(&frame.coarse, segment, extent, COARSE_STEP_PX, &others));
            templates[1].push(Template::new(&frame.fine, segment, extent, FINE_STEP_PX, &others));
        }
        templates
    }

    /// Where a hoof is if it stands: it moves against the trunk as it did, and along the ground only.
    fn standing(&self, tip: Keypoint) -> Option<Place> {
        let [.., before, last] = self.figures.as_slice() else { return None };
        if !matches!(tip, Keypoint::Limb(_, _, LimbJoint::Hoof)) {
            return None;
        }
        let (was, now) = (before.place(tip)?, last.place(tip)?);
        let lowest =
            Keypoint::all().filter_map(|k| last.place(k)).map(|place| place[1]).fold(now[1], f64::max);
        if now[1] < lowest - MAY_STAND {
            return None;
        }
        let trunk_step = step(before.trunk()?.to, last.trunk()?.to);
        let carried = self.trunk.apply(now);
        Some([carried[0] + now[0] - was[0] - trunk_step[0], carried[1]])
    }
}
