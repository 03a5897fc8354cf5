//! Which postures of the four limbs go together: two limbs in one place explain one limb of the picture.

use super::chain::{Chain, Posture};
use super::frame::distance;

/// A segment that another limb covers is as alike as this without being there: its score beyond that is not its own.
const HIDDEN_LIKENESS: f64 = 0.2;
/// Half the width of a limb, body heights.
const HALF_WIDTH: f64 = 0.04;
/// Points of a segment that are tried for cover.
const TRIED: u32 = 4;
/// Tips nearer than this are one answer, body heights.
const SAME: f64 = 0.025;

/// A limb's chain and the postures found for it.
pub(super) struct Candidates<'a> {
    pub(super) chain: &'a Chain,
    pub(super) postures: &'a [Posture],
}

/// The posture chosen for a limb, and the probability of all choices whose tip is where this one's is, 0..1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Choice {
    pub(super) posture: usize,
    pub(super) share: f64,
}

/// The best choice of one posture for each chain. Every chain has at least one posture.
pub(super) fn choose(limbs: &[Candidates]) -> Vec<Choice> {
    let clashes = clashes(limbs);
    let mut choices: Vec<(Vec<usize>, f64)> = vec![(Vec::new(), 0.0)];
    for (b, limb) in limbs.iter().enumerate() {
        let extended = choices.iter().flat_map(|(chosen, score)| {
            let clashes = &clashes;
            limb.postures.iter().enumerate().map(move |(q, posture)| {
                let clash: f64 = chosen.iter().enumerate().map(|(a, p)| clashes[a][b][*p][q]).sum();
                let chosen = chosen.iter().copied().chain([q]).collect();
                (chosen, score + posture.score - clash)
            })
        });
        choices = extended.collect();
    }
    let Some((best, top)) = choices.iter().max_by(|a, b| a.1.total_cmp(&b.1)) else { return Vec::new() };
    let choice = |(limb, candidates): (usize, &Candidates)| {
        let tip = |posture: usize| candidates.postures[posture].tip();
        let same =
            |posture: usize| tip(posture).zip(tip(best[limb])).is_some_and(|(a, b)| distance(a, b) < SAME);
        let (mut alike, mut all) = (0.0, 0.0);
        for (chosen, score) in &choices {
            let probability = (score - top).exp();
            all += probability;
            alike += if same(chosen[limb]) { probability } else { 0.0 };
        }
        Choice { posture: best[limb], share: alike / all }
    };
    limbs.iter().enumerate().map(choice).collect()
}

/// For limbs a < b and a posture of each: what the two together lose. Indexed by a, b, posture of a, posture of b.
fn clashes(limbs: &[Candidates]) -> Vec<Vec<Vec<Vec<f64>>>> {
    let between = |a: usize, b: usize| -> Vec<Vec<f64>> {
        if a >= b {
            return Vec::new();
        }
        let (a, b) = (&limbs[a], &limbs[b]);
        let clash = |p: &Posture, q: &Posture| covered(p, q, b.chain).min(covered(q, p, a.chain));
        a.postures.iter().map(|p| b.postures.iter().map(|q| clash(p, q)).collect()).collect()
    };
    (0..limbs.len()).map(|a| (0..limbs.len()).map(|b| between(a, b)).collect()).collect()
}

/// What a posture's score owes to segments that lie on another limb. First segments lie on the trunk and do not count.
fn covered(cover: &Posture, posture: &Posture, chain: &Chain) -> f64 {
    let cost = |i: usize| {
        let segment = posture.segment(i);
        let is_covered = |k: &u32| {
            let t = f64::from(*k) / f64::from(TRIED);
            let place = [0, 1].map(|axis| segment.from[axis] + t * (segment.to[axis] - segment.from[axis]));
            cover.segments().skip(1).any(|other| other.distance(place) < HALF_WIDTH)
        };
        let share = (1..=TRIED).filter(is_covered).count() as f64 / f64::from(TRIED);
        share * chain.links[i].weight * (posture.likeness[i] - HIDDEN_LIKENESS).max(0.0)
    };
    (1..posture.likeness.len()).map(cost).sum()
}
