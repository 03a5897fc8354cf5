//! When the hooves of the mean stride stand: low, and moving back with the ground.

use muybridge_capture::{Keypoint, NearOff, StanceLabel};
use muybridge_core::Pair;

use super::mean::{MeanPoint, PHASES};
use super::robust::median;

/// A hoof stands whose height over its own sole level is less than this, and flies above the second, withers heights: the
/// mean of a standing sole scatters by less than a hundredth, and in mid swing it is five to ten times as high.
const HEIGHTS: [f64; 2] = [0.015, 0.045];
/// A hoof stands whose speed over the ground is a smaller share of the trunk's than this, and flies above the second.
const SLIPS: [f64; 2] = [0.3, 0.6];
/// Panels that show the sole's own level: the lowest, fewer than any stance of a symmetrical gait has.
const LEVEL_PANELS: usize = 6;

/// A hoof of the mean stride.
#[derive(Clone, Debug, PartialEq)]
pub struct HoofStance {
    /// Near or off.
    pub side: NearOff,
    /// Fore or hind.
    pub pair: Pair,
    /// Height at which its sole stands in the picture, withers heights over the ground line.
    pub level: f64,
    /// What it does at each phase.
    pub labels: Vec<StanceLabel>,
}

impl HoofStance {
    /// Phases of strike and lift-off, half way through panels in doubt; none for a hoof that never stands or never flies.
    pub fn instants(&self) -> Option<[f64; 2]> {
        let n = self.labels.len();
        let label = |k: usize| self.labels[k % n];
        let first = (0..n).find(|k| label(*k) == StanceLabel::Stance && run_starts(&self.labels, *k))?;
        let last = (first..first + n)
            .take_while(|k| label(*k) != StanceLabel::Swing)
            .filter(|k| label(*k) == StanceLabel::Stance)
            .last()?;
        let before = (1..n).find(|back| label(first + n - back) == StanceLabel::Swing)?;
        let after = (1..n).find(|on| label(last + on) == StanceLabel::Swing)?;
        let strike = first as f64 - 0.5 * before as f64;
        let lift_off = last as f64 + 0.5 * after as f64;
        Some([strike, lift_off].map(|at| (at / n as f64).rem_euclid(1.0)))
    }

    /// Share of the stride it stands.
    pub fn duty_factor(&self) -> Option<f64> {
        self.instants().map(|[strike, lift_off]| (lift_off - strike).rem_euclid(1.0))
    }
}

/// Whether no stance comes between the last swing and this phase.
fn run_starts(labels: &[StanceLabel], k: usize) -> bool {
    let n = labels.len();
    let before = (1..n).map(|back| labels[(k + n - back) % n]).find(|label| *label != StanceLabel::Unknown);
    before == Some(StanceLabel::Swing)
}

/// The four hooves in the order near fore, off fore, near hind, off hind, while the trunk advances by so much in a stride,
/// withers heights. Hooves that the clip does not have are missing.
pub(super) fn hoof_stances(points: &[MeanPoint], advance: f64) -> Vec<HoofStance> {
    let mut stances = Vec::new();
    for pair in [Pair::Fore, Pair::Hind] {
        for side in [NearOff::Near, NearOff::Off] {
            let hoof = points.iter().find(|point| point.keypoint == Keypoint::hoof(side, pair));
            stances.extend(hoof.and_then(|hoof| hoof_stance(hoof, side, pair, advance / PHASES as f64)));
        }
    }
    stances
}

fn hoof_stance(hoof: &MeanPoint, side: NearOff, pair: Pair, step: f64) -> Option<HoofStance> {
    let at = |k: usize| hoof.places[k % PHASES].map(|place| place.at);
    let mut heights: Vec<f64> = (0..PHASES).filter_map(at).map(|[_, y]| y).collect();
    heights.sort_by(f64::total_cmp);
    heights.truncate(LEVEL_PANELS);
    let level = median(heights)?;
    let label = |k: usize| {
        let (Some([x, y]), before, after) = (at(k), at(k + PHASES - 1), at(k + 1)) else {
            return StanceLabel::Unknown;
        };
        // From the neighbours there are; standing, the hoof falls back by a step from phase to phase.
        let falls = [before.map(|b| b[0] - x), after.map(|a| x - a[0])];
        let known: Vec<f64> = falls.into_iter().flatten().collect();
        let slip = known.iter().map(|fall| (1.0 - fall / step).abs());
        // At strike and lift-off one neighbour is in the air; the slower side says whether it stands.
        let slowest = slip.clone().fold(f64::INFINITY, f64::min);
        let mean = slip.sum::<f64>() / known.len().max(1) as f64;
        let height = y - level;
        if height > HEIGHTS[1] || slowest > SLIPS[1] {
            StanceLabel::Swing
        } else if height < HEIGHTS[0] && mean < SLIPS[0] {
            StanceLabel::Stance
        } else {
            StanceLabel::Unknown
        }
    };
    let mut labels: Vec<StanceLabel> = (0..PHASES).map(label).collect();
    longest_run_only(&mut labels);
    Some(HoofStance { side, pair, level, labels })
}

/// A hoof stands once in a stride: stance outside of the longest run is in doubt, doubt inside of it is stance, and doubt
/// far from it is swing.
fn longest_run_only(labels: &mut [StanceLabel]) {
    let n = labels.len();
    let run = |first: usize| {
        let on = (0..n).take_while(|i| labels[(first + i) % n] != StanceLabel::Swing);
        on.filter(|i| labels[(first + i) % n] == StanceLabel::Stance).last().map_or(0, |last| last + 1)
    };
    let starts = (0..n).filter(|k| labels[*k] == StanceLabel::Stance && run_starts(labels, *k));
    let Some((length, first)) = starts.map(|first| (run(first), first)).max_by_key(|(length, _)| *length)
    else {
        return;
    };
    for i in 0..n {
        let label = &mut labels[(first + i) % n];
        if i < length {
            *label = StanceLabel::Stance;
        } else if *label == StanceLabel::Stance {
            *label = StanceLabel::Unknown;
        }
    }
    let edges = |i: usize| (length..length + 2).contains(&i) || i + 2 >= n;
    for i in (length..n).filter(|i| !edges(*i)) {
        let label = &mut labels[(first + i) % n];
        if *label == StanceLabel::Unknown {
            *label = StanceLabel::Swing;
        }
    }
}
