//! Cutting a row of panels, seen as a profile of mount, into panels of nearly one size.

use std::ops::RangeInclusive;

/// Least share of mount along a path that is a gutter: captions, numbers and a fold may cross it.
pub(super) const GUTTER: f64 = 0.92;
/// The same where gutters are so thin that panels and grain close them here and there.
pub(super) const THIN_GUTTER: f64 = 0.8;
/// What a panel loses of its worth by having gutters inside, in lengths of the gutters: a dark line across a photograph is
/// swallowed where that makes panels alike, a gutter is not.
const SWALLOWED: f64 = 1.5;
/// Width of gutter, in panel sizes, for which it loses twice as much: wider than a line in a photograph.
const WIDE: f64 = 0.015;
/// Worth of panels of an unlikely size.
const UNLIKELY: f64 = 0.5;
/// Relative departure from the common size at which a panel is worth nothing.
const UNLIKE: f64 = 0.5;
/// Most runs of one profile that are weighed; a profile of more is not one of a row of panels.
const MOST_RUNS: usize = 80;

/// A stretch of a profile, px; the end is excluded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) start: usize,
    pub(super) end: usize,
    /// How much of it is gutter.
    gutter: usize,
}

impl Span {
    pub(super) fn length(&self) -> f64 {
        (self.end - self.start) as f64
    }

    /// Worth as a panel of about a size.
    fn worth(&self, size: f64) -> f64 {
        let unlike = (self.length() / size - 1.0) / UNLIKE;
        let gutter = self.gutter as f64;
        self.length() * (1.0 - unlike * unlike) - SWALLOWED * gutter * (1.0 + gutter / (WIDE * size))
    }
}

/// Stretches between gutters.
pub(super) fn runs(shares_of_mount: &[f64], gutter: f64) -> Vec<Span> {
    let mut runs: Vec<Span> = Vec::new();
    for (i, _) in shares_of_mount.iter().enumerate().filter(|(_, share)| **share < gutter) {
        match runs.last_mut() {
            Some(run) if run.end == i => run.end = i + 1,
            _ => runs.push(Span { start: i, end: i + 1, gutter: 0 }),
        }
    }
    runs.truncate(MOST_RUNS);
    runs
}

/// The size that panels made of several rows of runs have in common, rather one of the likely sizes; none without runs.
pub(super) fn common_size(rows: &[Vec<Span>], likely: &RangeInclusive<f64>) -> Option<f64> {
    let sizes = rows.iter().flat_map(|runs| joined(runs).into_iter().map(|span| span.length()));
    let worth = |size: f64| -> f64 {
        rows.iter().map(|runs| panels(runs, size).iter().map(|span| span.worth(size)).sum::<f64>()).sum()
    };
    let mut best: Option<(f64, f64)> = None;
    let mut seen: Vec<f64> = sizes.collect();
    seen.sort_by(f64::total_cmp);
    seen.dedup();
    for size in seen {
        let candidate = worth(size) * if likely.contains(&size) { 1.0 } else { UNLIKELY };
        if best.is_none_or(|(most, _)| candidate > most) {
            best = Some((candidate, size));
        }
    }
    best.map(|(_, size)| size)
}

/// All neighbouring runs taken together, in every way.
fn joined(runs: &[Span]) -> Vec<Span> {
    (0..runs.len()).flat_map(|first| (first..runs.len()).map(move |last| join(&runs[first..=last]))).collect()
}

fn join(runs: &[Span]) -> Span {
    let (start, end) = (runs[0].start, runs[runs.len() - 1].end);
    let content: usize = runs.iter().map(|run| run.end - run.start).sum();
    Span { start, end, gutter: end - start - content }
}

/// The panels of a row: neighbouring runs joined so that they are worth most as panels of about a size.
pub(super) fn panels(runs: &[Span], size: f64) -> Vec<Span> {
    // best[i]: worth of the first i runs and the panel that ends there.
    let mut best: Vec<(f64, Option<Span>, usize)> = vec![(0.0, None, 0)];
    for end in 1..=runs.len() {
        let mut most = (best[end - 1].0, None, end - 1);
        for first in (0..end).rev() {
            let span = join(&runs[first..end]);
            if span.length() > (1.0 + UNLIKE) * size {
                break;
            }
            let worth = best[first].0 + span.worth(size);
            if worth > most.0 {
                most = (worth, Some(span), first);
            }
        }
        best.push(most);
    }
    let mut panels = Vec::new();
    let mut end = runs.len();
    while end > 0 {
        let (_, span, before) = best[end];
        panels.extend(span);
        end = before;
    }
    panels.reverse();
    panels
}
