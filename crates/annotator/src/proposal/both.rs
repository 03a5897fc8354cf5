//! What tracking finds from the panels before and from those after, made one.

use muybridge_capture::{Keypoint, Placed};
use muybridge_imaging::track::Proposal;

/// Where the two are farther apart than this share of the larger distance between neighbouring points, one of them is
/// wrong: the surer one counts, not the middle.
const APART: f64 = 0.25;
/// Added to every quality: points that were only carried along have none.
const LEAST_QUALITY: f64 = 0.05;

/// Both sides' points: the mean by quality where they agree, else the surer one.
pub(super) fn agreed(before: &[Proposal], after: &[Proposal]) -> Vec<Proposal> {
    let far_px = APART * typical_px(before);
    let of = |side: &[Proposal], keypoint| side.iter().find(|p| p.keypoint == keypoint).copied();
    let one = |keypoint| match (of(before, keypoint), of(after, keypoint)) {
        (Some(a), Some(b)) => Some(mean(&a, &b, far_px)),
        (a, b) => a.or(b),
    };
    Keypoint::all().filter_map(one).collect()
}

fn mean(a: &Proposal, b: &Proposal, far_px: f64) -> Proposal {
    let (surer, other) = if a.quality >= b.quality { (a, b) } else { (b, a) };
    let (Some(at), Some(also)) = (surer.placed.at_px, other.placed.at_px) else { return *surer };
    let off = [also[0] - at[0], also[1] - at[1]];
    if off[0].hypot(off[1]) > far_px {
        return *surer;
    }
    let share = (other.quality + LEAST_QUALITY) / (surer.quality + other.quality + 2.0 * LEAST_QUALITY);
    let at_px = Some([0, 1].map(|axis| at[axis] + share * off[axis]));
    Proposal { placed: Placed { at_px, ..surer.placed }, ..*surer }
}

/// Median distance of points that follow one another in the drawn order: about the length of a limb's segment.
fn typical_px(points: &[Proposal]) -> f64 {
    let places: Vec<[f64; 2]> = points.iter().filter_map(|point| point.placed.at_px).collect();
    let mut steps: Vec<f64> =
        places.windows(2).map(|ends| (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1])).collect();
    steps.sort_by(f64::total_cmp);
    steps.get(steps.len() / 2).copied().unwrap_or(0.0)
}
