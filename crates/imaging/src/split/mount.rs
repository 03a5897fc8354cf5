//! Tones that may be the mount's.

use image::GrayImage;
use imageproc::stats::histogram;

use super::{SD_PER_MEDIAN, median};

/// Grey values of a mount, from the darkest to the lightest, both included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Tones {
    pub(super) darkest: u8,
    pub(super) lightest: u8,
    /// Median of the pixels within.
    pub(super) usual: f64,
}

/// Standard deviations of a mount's tone that its range spans to either side.
const SPREADS: f64 = 4.0;
/// How far a mount's tone may lie outside its range where grain was not averaged away, grey values.
const GRAIN: f64 = 12.0;

impl Tones {
    /// Whether a grey value may be the mount's.
    pub(super) fn has(&self, tone: f64) -> bool {
        (f64::from(self.darkest) - GRAIN..=f64::from(self.lightest) + GRAIN).contains(&tone)
    }

    /// The range around grey values seen in gutters; none of no values.
    pub(super) fn around(values: &[f64]) -> Option<Self> {
        if values.is_empty() {
            return None;
        }
        let usual = median(values.to_vec());
        let spread = SD_PER_MEDIAN * median(values.iter().map(|v| (v - usual).abs()).collect());
        let reach = (SPREADS * spread).max(GRAIN);
        // Nothing is darker than black or lighter than white.
        Some(Self {
            darkest: (usual - reach).max(0.0) as u8,
            lightest: (usual + reach).min(255.0) as u8,
            usual,
        })
    }

    fn new(counts: &[f64], darkest: usize, lightest: usize) -> Self {
        let (darkest, lightest) = (darkest.min(255), lightest.min(255));
        let half = 0.5 * counts[darkest..=lightest.max(darkest)].iter().sum::<f64>();
        let mut below = 0.0;
        let usual = (darkest..lightest).find(|v| {
            below += counts[*v];
            below >= half
        });
        Self { darkest: darkest as u8, lightest: lightest as u8, usual: usual.unwrap_or(lightest) as f64 }
    }
}

/// Least and most of a picture that can be mount.
const SHARES: std::ops::RangeInclusive<f64> = 0.03..=0.9;
/// Grey values by which two ranges differ at least at one end: a smaller difference is not worth another trial.
const DISTINCT: u8 = 6;

/// Ranges of tone worth trying as mount: either end of the histogram, down to the level that parts it best, the level that
/// parts that end again, and half way; and each peak.
pub(super) fn candidates(picture: &GrayImage) -> Vec<Tones> {
    let counts: Vec<f64> = histogram(picture).channels[0].iter().map(|count| f64::from(*count)).collect();
    let total: f64 = counts.iter().sum();
    let middle = parting_level(&counts, 0, 255);
    let (low, high) = (parting_level(&counts, 0, middle), parting_level(&counts, middle + 1, 255));
    let ends = [
        (0, middle),
        (0, (low + middle) / 2),
        (0, low),
        (middle + 1, 255),
        ((middle + high) / 2 + 1, 255),
        (high + 1, 255),
    ];
    let ends = ends.map(|(from, to)| Tones::new(&counts, from, to));
    let mut found: Vec<Tones> = Vec::new();
    for tones in ends.into_iter().chain(peaks(&counts)) {
        let share = counts[tones.darkest as usize..=tones.lightest as usize].iter().sum::<f64>() / total;
        let is_new = |other: &Tones| {
            other.darkest.abs_diff(tones.darkest) >= DISTINCT
                || other.lightest.abs_diff(tones.lightest) >= DISTINCT
        };
        if SHARES.contains(&share) && found.iter().all(is_new) {
            found.push(tones);
        }
    }
    found
}

/// Otsu's level within a range of grey values: the last of the darker class.
fn parting_level(counts: &[f64], from: usize, to: usize) -> usize {
    let (from, to) = (from.min(254), to.min(255));
    let total: f64 = counts[from..=to].iter().sum();
    let moment: f64 = (from..=to).map(|v| v as f64 * counts[v]).sum();
    let (mut below, mut moment_below) = (0.0, 0.0);
    let mut best = (-1.0, from);
    for v in from..to {
        below += counts[v];
        moment_below += v as f64 * counts[v];
        let above = total - below;
        if below > 0.0 && above > 0.0 {
            let apart = moment_below / below - (moment - moment_below) / above;
            let between = below * above * apart * apart;
            if between > best.0 {
                best = (between, v);
            }
        }
    }
    best.1
}

/// Half-width of the window in which a peak must be the highest, grey values.
const PEAK_REACH: usize = 8;
/// Least share of the picture within a peak.
const PEAK_SHARE: f64 = 0.03;

/// Peaks of the histogram, down to a fifth of their height on either side.
fn peaks(counts: &[f64]) -> Vec<Tones> {
    let at = |v: isize| counts.get(v as usize).copied().unwrap_or(0.0);
    let smooth: Vec<f64> = (0..256).map(|v| (v - 2..=v + 2).map(at).sum::<f64>() / 5.0).collect();
    let total: f64 = counts.iter().sum();
    let mut found = Vec::new();
    for v in 0..256usize {
        let (from, to) = (v.saturating_sub(PEAK_REACH), (v + PEAK_REACH).min(255));
        if smooth[v] <= 0.0 || (from..=to).any(|u| smooth[u] > smooth[v] || (smooth[u] == smooth[v] && u < v))
        {
            continue;
        }
        let foot = 0.2 * smooth[v];
        let darkest = (0..v).rev().find(|u| smooth[*u] < foot).map_or(0, |u| u + 1);
        let lightest = (v..256).find(|u| smooth[*u] < foot).map_or(255, |u| u - 1);
        if counts[darkest..=lightest].iter().sum::<f64>() >= PEAK_SHARE * total {
            found.push(Tones::new(counts, darkest, lightest));
        }
    }
    found
}
