//! What numbers of a track may be, and the sentence for those that may not.

use std::ops::RangeInclusive;

/// Most prints of a track: an hour and more of walking.
pub(crate) const MOST_PRINTS: usize = 10_000;
/// Places and heights, metres.
pub(crate) const PLACE_M: RangeInclusive<f64> = -10_000.0..=10_000.0;
/// Headings and directions, degrees: ten turns either way, as many as anybody winds up by dragging.
pub(crate) const HEADING_DEG: RangeInclusive<f64> = -3600.0..=3600.0;
/// Shortest stance, swing and end of a motion, s: less than any animal takes.
pub(crate) const LEAST_TIME_S: f64 = 0.01;
/// Longest stance and step time, s.
pub(crate) const MOST_TIME_S: f64 = 600.0;
/// Times closer than this are one, s: feet that fall within it fall together, and one that lifts as another falls does so then.
/// What is left between two times is long enough for a curve.
pub(crate) const SAME_TIME_S: f64 = 1e-3;
/// Longest motion, s: four hours. What is tabulated over time stays small.
pub(crate) const LONGEST_MOTION_S: f64 = 14_400.0;

/// The sentence for a number out of its range, or for none at all; nothing when it is within.
pub(crate) fn out_of_range(
    name: &str,
    value: f64,
    range: &RangeInclusive<f64>,
    unit: &str,
) -> Option<String> {
    let (least, most) = (range.start(), range.end());
    let within = range.contains(&value);
    (!within).then(|| format!("{name} is {value} {unit}; it must be between {least} and {most} {unit}"))
}
