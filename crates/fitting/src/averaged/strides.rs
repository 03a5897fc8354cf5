//! Finding the strides of a clip: the period after which all hooves repeat their way under the trunk.

use super::AverageFault;
use super::harmonics::{Periodic, Sample};

/// Shortest stride looked for, frames: a gallop's 0.4 s at 24 frames a second.
const SHORTEST_FRAMES: f64 = 10.0;
/// Fewest strides a clip must show: the spread is between them.
const FEWEST_STRIDES: f64 = 2.0;
/// One step of the coarse search, as a share of the period; over four strides it is a twenty-fifth of a stride.
const COARSE_STEP: f64 = 0.01;
/// Rounds of the fine search; each divides the step by four, three bring it to a six-thousandth.
const FINE_ROUNDS: i32 = 3;
/// Harmonics of a hoof's way forward and back; more fit two strides as one.
const HARMONICS: usize = 3;
/// A shorter period that explains this much less than the best is the stride: twice the stride fits nearly as well.
const NEARLY: f64 = 0.05;
/// Least share of the movement that a stride explains; noise without one is explained by a tenth.
const LEAST_EXPLAINED: f64 = 0.6;
/// Least standard deviation of a moving hoof under the trunk, as a share of the trunk's length; a walk has 0.5.
const LEAST_SWEEP: f64 = 0.1;

/// The strides of a clip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strides {
    /// Duration of a stride, frames.
    pub period_frames: f64,
    /// How many strides the hooves are seen for.
    pub count: f64,
    /// Share of the hooves' movement under the trunk that a stride repeated explains.
    pub explained: f64,
}

/// A hoof's place under the trunk, px, by frame.
pub(super) type Sweep = Vec<(usize, f64)>;

/// Finds the strides in the hooves' sweeps under a trunk of some length, px.
pub(super) fn find(sweeps: &[Sweep], trunk_px: f64) -> Result<Strides, AverageFault> {
    let frames = |sweep: &Sweep| sweep.first().zip(sweep.last()).map_or(0.0, |(a, b)| (b.0 - a.0) as f64);
    let span = sweeps.iter().map(frames).fold(0.0, f64::max);
    let seen: usize = sweeps.iter().map(Vec::len).sum();
    let sum_sq: f64 = sweeps.iter().map(sum_of_squares).sum();
    if (sum_sq / seen.max(1) as f64).sqrt() < LEAST_SWEEP * trunk_px {
        return Err(AverageFault::NoStride);
    }
    let longest = span / FEWEST_STRIDES;
    let explained = |period: f64| 1.0 - unexplained(sweeps, period) / sum_sq;
    let mut coarse = Vec::new();
    let mut period = SHORTEST_FRAMES;
    while period <= longest * (1.0 + COARSE_STEP) {
        coarse.push((period, explained(period)));
        period *= 1.0 + COARSE_STEP;
    }
    let best = coarse.iter().map(|(_, share)| *share).fold(0.0, f64::max);
    if best < LEAST_EXPLAINED {
        return Err(AverageFault::NoStride);
    }
    let peak = |i: &usize| {
        let share = |i: usize| coarse.get(i).map_or(0.0, |(_, share)| *share);
        share(*i) >= best - NEARLY && share(*i) >= share(i + 1) && (*i == 0 || share(*i) >= share(i - 1))
    };
    let first = (0..coarse.len()).find(peak).ok_or(AverageFault::NoStride)?;
    let mut period_frames = coarse[first].0;
    for round in 1..=FINE_ROUNDS {
        let step = period_frames * COARSE_STEP / 4f64.powi(round);
        let near = (-4..=4).map(|i| period_frames + step * f64::from(i));
        let shares = near.map(|period| (period, explained(period)));
        period_frames = shares.max_by(|a, b| a.1.total_cmp(&b.1)).map_or(period_frames, |(period, _)| period);
    }
    Ok(Strides { period_frames, count: span / period_frames, explained: explained(period_frames) })
}

fn sum_of_squares(sweep: &Sweep) -> f64 {
    let mean = sweep.iter().map(|(_, x)| x).sum::<f64>() / sweep.len().max(1) as f64;
    sweep.iter().map(|(_, x)| (x - mean).powi(2)).sum()
}

/// Sum of squares that a period does not explain.
fn unexplained(sweeps: &[Sweep], period: f64) -> f64 {
    let of_sweep = |sweep: &Sweep| {
        let sample = |(frame, value): &(usize, f64)| Sample { turns: *frame as f64 / period, value: *value };
        let samples: Vec<Sample> = sweep.iter().map(sample).collect();
        let middle = samples.iter().map(|s| s.turns).sum::<f64>() / samples.len().max(1) as f64;
        match Periodic::plain(HARMONICS, middle, &samples) {
            Some(periodic) => samples.iter().map(|s| (s.value - periodic.at(s.turns)).powi(2)).sum(),
            None => sum_of_squares(sweep),
        }
    };
    sweeps.iter().map(of_sweep).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sweep(period: f64, frames: usize) -> Sweep {
        (0..frames)
            .filter(|frame| frame % 7 != 3)
            .map(|frame| (frame, 30.0 * (std::f64::consts::TAU * frame as f64 / period).sin()))
            .collect()
    }

    #[test]
    fn the_period_is_found_to_a_fraction_of_a_frame() {
        let strides = find(&[sweep(37.3, 160), sweep(37.3, 150)], 60.0).unwrap();
        assert!((strides.period_frames - 37.3).abs() < 0.05, "{strides:?}");
    }

    #[test]
    fn one_stride_or_none_is_said() {
        assert!(matches!(find(&[sweep(100.0, 120)], 60.0), Err(AverageFault::NoStride)));
        assert!(matches!(find(&[], 60.0), Err(AverageFault::NoStride)));
        // A standing horse, tracked with noise.
        let noise = (0..200).map(|frame| (frame, ((frame * 7919) % 13) as f64 - 6.0)).collect();
        assert!(matches!(find(&[noise], 60.0), Err(AverageFault::NoStride)));
    }
}
