//! Values at fixed steps of time, smoothed.

use std::ops::{Add, Mul, Sub};

/// What can be averaged.
pub(super) trait Value:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
}

impl<T> Value for T where T: Copy + Default + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T> {}

/// From 0 to 1 without a slope at either end.
pub(super) fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The mean over as many values before as after each one, fewer towards the ends.
pub(super) fn moving_mean<T: Value>(values: &[T], half: usize) -> Vec<T> {
    let Some(&first) = values.first() else { return Vec::new() };
    // Sums of differences from the first value: a walk far from the origin loses nothing.
    let mut sums = Vec::with_capacity(values.len() + 1);
    let mut sum = T::default();
    sums.push(sum);
    for &value in values {
        sum = sum + (value - first);
        sums.push(sum);
    }
    let last = values.len() - 1;
    let mean = |i: usize| {
        let half = half.min(i).min(last - i);
        first + (sums[i + half + 1] - sums[i - half]) * (1.0 / (2 * half + 1) as f64)
    };
    (0..values.len()).map(mean).collect()
}

/// Slope of values at a step of time, per second.
pub(super) fn slope<T: Value>(values: &[T], step_s: f64) -> Vec<T> {
    let last = values.len().saturating_sub(1);
    let slope = |i: usize| {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(last));
        let over_s = step_s * after.saturating_sub(before).max(1) as f64;
        (values[after] - values[before]) * (1.0 / over_s)
    };
    (0..values.len()).map(slope).collect()
}

/// The value between two steps; held at the ends.
pub(super) fn between<T: Value>(values: &[T], step_s: f64, time_s: f64) -> T {
    let Some(last) = values.len().checked_sub(1) else { return T::default() };
    let at = (time_s / step_s).clamp(0.0, last as f64);
    let i = (at as usize).min(last);
    let next = values[(i + 1).min(last)];
    values[i] + (next - values[i]) * (at - i as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_straight_line_keeps_its_values_and_its_slope() {
        let line: Vec<f64> = (0..40).map(|i| 3.0 + 0.5 * f64::from(i)).collect();
        for (value, mean) in line.iter().zip(moving_mean(&line, 7)) {
            assert!((value - mean).abs() < 1e-12);
        }
        assert!(slope(&line, 0.1).iter().all(|slope| (slope - 5.0).abs() < 1e-9));
        assert!((between(&line, 0.1, 1.25) - 9.25).abs() < 1e-12);
        assert_eq!((between(&line, 0.1, -1.0), between(&line, 0.1, 99.0)), (3.0, 22.5));
        assert!(moving_mean::<f64>(&[], 3).is_empty() && slope::<f64>(&[], 1.0).is_empty());
    }
}
