//! Near and off exchanged: in a panel, where a limb's points lie on the other limb's way; in the whole plate, where the
//! near limb is the hidden one.

use muybridge_capture::{Annotation, Keypoint, KeypointState, LimbJoint, NearOff};
use muybridge_core::Pair;

use super::view::PlateView;
use super::{Concern, ConcernKind, Severity};
use crate::footfalls::leg_name;

/// Joints that tell one limb from the other; the roots of both lie together.
const JOINTS: [LimbJoint; 4] = [LimbJoint::Upper, LimbJoint::Middle, LimbJoint::Fetlock, LimbJoint::Hoof];
/// Exchanging must leave less than this share of the jerk that is there.
const LEFT_OVER: f64 = 0.62;
/// Exchanging must smooth the way of a joint by this much on the mean, withers heights: three times the scatter of a
/// hand. Where limbs cross it does not, and there an exchange does no harm either.
const LEAST_GAIN: f64 = 0.03;
/// More hidden than seen points by this factor, on the near limb against the off one.
const HIDDEN_FACTOR: f64 = 4.0;
/// Fewest points that must be hidden on the near limb only, for that to say anything.
const LEAST_HIDDEN: usize = 8;

pub(super) fn concerns(annotation: &Annotation, view: &PlateView<'_>) -> Vec<Concern> {
    let [fore, hind] = [Pair::Fore, Pair::Hind].map(|pair| exchanged(view, pair));
    let mut concerns = Vec::new();
    for (k, panel) in view.panels.iter().enumerate() {
        match (fore[k], hind[k]) {
            (Some(a), Some(b)) => concerns.push(whole_panel(panel.panel, a.max(b))),
            (Some(size), None) => concerns.push(one_pair(panel.panel, Pair::Fore, size)),
            (None, Some(size)) => concerns.push(one_pair(panel.panel, Pair::Hind, size)),
            (None, None) => {}
        }
    }
    concerns.extend([Pair::Fore, Pair::Hind].into_iter().filter_map(|pair| hidden_near(annotation, pair)));
    concerns
}

fn whole_panel(panel: u32, size: f64) -> Concern {
    let text = "all four limbs continue the way of the other side's; exchange near and off in this panel";
    let mut concern =
        Concern::of_stride(ConcernKind::SwappedPanel, Severity::Warning, size, text.to_string());
    concern.panel = Some(panel);
    concern.keypoints = [Pair::Fore, Pair::Hind].into_iter().flat_map(limb_points).collect();
    concern
}

fn one_pair(panel: u32, pair: Pair, size: f64) -> Concern {
    let [near, off] = [NearOff::Near, NearOff::Off].map(|side| leg_name(side, pair));
    let text =
        format!("{near} and {off} each continue the way of the other; exchange the two limbs in this panel");
    let limb = (NearOff::Near, pair);
    Concern::of_limb(ConcernKind::SwappedLimbs, (panel, limb), limb_points(pair).collect(), size, text)
}

fn limb_points(pair: Pair) -> impl Iterator<Item = Keypoint> {
    [NearOff::Near, NearOff::Off]
        .into_iter()
        .flat_map(move |side| JOINTS.map(|joint| Keypoint::Limb(side, pair, joint)))
}

/// For each panel, how far over the threshold its limbs are exchanged.
///
/// Runs of panels are exchanged one after another, the one that smooths the most first, as long as one does.
fn exchanged(view: &PlateView<'_>, pair: Pair) -> Vec<Option<f64>> {
    let n = view.panels.len();
    let mut flipped = vec![false; n];
    let mut sizes = vec![None; n];
    for _ in 0..n {
        let Some((run, size)) = best_run(view, pair, &flipped) else { break };
        for k in run {
            flipped[k] = !flipped[k];
            sizes[k] = flipped[k].then_some(size);
        }
    }
    if flipped.iter().filter(|f| **f).count() * 2 > n {
        // More than half exchanged: the others are.
        let size = sizes.iter().flatten().copied().fold(1.0, f64::max);
        sizes = flipped.iter().map(|f| (!f).then_some(size)).collect();
    }
    sizes
}

/// The run of panels, at most half of all, that is best exchanged, and how far over the threshold.
fn best_run(view: &PlateView<'_>, pair: Pair, flipped: &[bool]) -> Option<(Vec<usize>, f64)> {
    let n = view.panels.len();
    let ring = view.closes_after_panels.is_some();
    let mut best: Option<(f64, Vec<usize>, f64)> = None;
    for start in 0..n {
        for length in 1..=n / 2 {
            // Where the stride does not close, an end has neighbours on one side only, which proves nothing.
            if !ring && (start == 0 || start + length >= n) {
                break;
            }
            let run: Vec<usize> = (start..start + length).map(|k| k % n).collect();
            let mut after = flipped.to_vec();
            for k in &run {
                after[*k] = !after[*k];
            }
            let (mut terms, mut jerk) = (0.0, [0.0; 2]);
            for middle in touched(&run, n) {
                let Some([count, as_is, exchanged]) = at_triple(view, pair, middle, [flipped, &after]) else {
                    continue;
                };
                terms += count;
                jerk = [jerk[0] + as_is, jerk[1] + exchanged];
            }
            let gain = (jerk[0] - jerk[1]) / f64::max(terms, 1.0);
            let good = gain > LEAST_GAIN && jerk[1] < LEFT_OVER * jerk[0];
            // The most is gained where all that is wrong is put right, not where a part is put right best.
            let whole_gain = jerk[0] - jerk[1];
            if good && best.as_ref().is_none_or(|(most, ..)| whole_gain > *most) {
                best = Some((whole_gain, run, gain / LEAST_GAIN));
            }
        }
    }
    best.map(|(_, run, size)| (run, size))
}

/// Middles of the triples that hold panels inside and outside a run.
fn touched(run: &[usize], n: usize) -> Vec<usize> {
    let (Some(&first), Some(&last)) = (run.first(), run.last()) else { return Vec::new() };
    let mut middles = vec![(first + n - 1) % n, first, last, (last + 1) % n];
    middles.sort_unstable();
    middles.dedup();
    middles
}

/// How far the joints of both limbs lie from the straight way between the panels before and after, before and after an
/// exchange, and how many were counted; only joints that both limbs have in all three panels.
fn at_triple(view: &PlateView<'_>, pair: Pair, middle: usize, flips: [&[bool]; 2]) -> Option<[f64; 3]> {
    let n = view.panels.len();
    let inside = middle > 0 && middle + 1 < n;
    if n < 3 || !(inside || view.closes_after_panels.is_some()) {
        return None;
    }
    let slots = [(middle + n - 1) % n, middle, (middle + 1) % n];
    let gap = |a: usize, b: usize| {
        let gap = view.panels[b].at_panel - view.panels[a].at_panel;
        view.closes_after_panels.map_or(gap, |closes| gap.rem_euclid(closes))
    };
    let (h1, h2) = (gap(slots[0], middle), gap(middle, slots[2]));
    let share = if h1 + h2 > 0.0 { h1 / (h1 + h2) } else { 0.5 };
    let mut sums = [0.0; 3];
    for joint in JOINTS {
        let places = slots.map(|k| {
            let at = |side| view.panels[k].point(Keypoint::Limb(side, pair, joint));
            Some([at(NearOff::Near)?, at(NearOff::Off)?])
        });
        let [Some(before), Some(here), Some(next)] = places else { continue };
        sums[0] += 2.0;
        for (sum, flipped) in sums[1..].iter_mut().zip(flips) {
            for side in 0..2 {
                let of = |k: usize, two: [[f64; 2]; 2]| two[side ^ usize::from(flipped[k])];
                let (a, b, c) = (of(slots[0], before), of(middle, here), of(slots[2], next));
                let away = [0, 1].map(|i| b[i] - a[i] - share * (c[i] - a[i]));
                *sum += away[0].hypot(away[1]);
            }
        }
    }
    (sums[0] > 0.0).then_some(sums)
}

/// Where only one of the two limbs' joints is hidden, it should be the off one.
fn hidden_near(annotation: &Annotation, pair: Pair) -> Option<Concern> {
    let mut hidden = [0usize; 2];
    for panel in &annotation.panels {
        for joint in JOINTS {
            let is_hidden = |side| {
                let placed = panel.keypoints.get(Keypoint::Limb(side, pair, joint))?;
                Some(placed.state != KeypointState::Visible)
            };
            if let (Some(near), Some(off)) = (is_hidden(NearOff::Near), is_hidden(NearOff::Off)) {
                hidden[0] += usize::from(near && !off);
                hidden[1] += usize::from(off && !near);
            }
        }
    }
    let doubtful = hidden[0] >= LEAST_HIDDEN && hidden[0] as f64 > HIDDEN_FACTOR * hidden[1] as f64;
    doubtful.then(|| {
        let size = hidden[0] as f64 / (HIDDEN_FACTOR * (hidden[1] as f64).max(1.0));
        let [near, off] = [NearOff::Near, NearOff::Off].map(|side| leg_name(side, pair));
        let text = format!(
            "{near} is hidden in {} places where {off} is seen; check which of the two is nearer the camera",
            hidden[0]
        );
        Concern::of_stride(ConcernKind::HiddenNear, Severity::Note, size, text)
    })
}
