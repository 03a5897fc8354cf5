//! Periodic cubic spline through uneven knots.

use nalgebra::{DMatrix, DVector};

/// Knots closer than this share of the period are merged into one with the mean value: a spline through two noisy
/// values at nearly the same phase would swing.
const MERGE: f64 = 0.01;

/// A curve of period 1, twice continuously differentiable, through given values.
#[derive(Clone, Debug)]
pub struct PeriodicSpline {
    knots: Vec<f64>,
    values: Vec<f64>,
    /// Second derivative at each knot.
    bends: Vec<f64>,
}

impl PeriodicSpline {
    /// Through `values` at rising `phases` in `[0, 1)`; at least three distinct phases.
    pub fn new(phases: &[f64], values: &[f64]) -> Self {
        let (knots, values) = merged(phases, values);
        let n = knots.len();
        let gap = |i: usize| (knots[(i + 1) % n] - knots[i]).rem_euclid(1.0);
        let slope = |i: usize| (values[(i + 1) % n] - values[i]) / gap(i);
        let mut matrix = DMatrix::zeros(n, n);
        let mut right = DVector::zeros(n);
        for i in 0..n {
            let before = (i + n - 1) % n;
            matrix[(i, before)] += gap(before) / 6.0;
            matrix[(i, i)] += (gap(before) + gap(i)) / 3.0;
            matrix[(i, (i + 1) % n)] += gap(i) / 6.0;
            right[i] = slope(i) - slope(before);
        }
        let solved = matrix.lu().solve(&right);
        let bends = solved.map_or(vec![0.0; n], |b| b.as_slice().to_vec());
        Self { knots, values, bends }
    }

    /// Value at a phase (any real number).
    pub fn at(&self, phase: f64) -> f64 {
        let n = self.knots.len();
        let phase = phase.rem_euclid(1.0);
        let next = self.knots.partition_point(|k| *k <= phase) % n;
        let here = (next + n - 1) % n;
        let width = (self.knots[next] - self.knots[here]).rem_euclid(1.0);
        let width = if width == 0.0 { 1.0 } else { width };
        let b = (phase - self.knots[here]).rem_euclid(1.0) / width;
        let a = 1.0 - b;
        a * self.values[here]
            + b * self.values[next]
            + ((a.powi(3) - a) * self.bends[here] + (b.powi(3) - b) * self.bends[next]) * width * width / 6.0
    }
}

fn merged(phases: &[f64], values: &[f64]) -> (Vec<f64>, Vec<f64>) {
    let mut groups: Vec<(f64, f64, f64)> = Vec::new();
    for (&phase, &value) in phases.iter().zip(values) {
        match groups.last_mut() {
            Some((sum, total, n)) if phase - *sum / *n < MERGE => {
                *sum += phase;
                *total += value;
                *n += 1.0;
            }
            _ => groups.push((phase, value, 1.0)),
        }
    }
    groups.iter().map(|(sum, total, n)| (sum / n, total / n)).unzip()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    #[test]
    fn passes_through_knots_and_follows_a_sine_between_uneven_ones() {
        let phases = [0.02, 0.11, 0.19, 0.33, 0.41, 0.52, 0.66, 0.71, 0.83, 0.95];
        let values: Vec<f64> = phases.iter().map(|p| (TAU * p).sin()).collect();
        let spline = PeriodicSpline::new(&phases, &values);
        for (p, v) in phases.iter().zip(&values) {
            assert!((spline.at(*p) - v).abs() < 1e-12);
        }
        for i in 0..100 {
            let p = i as f64 / 100.0;
            assert!((spline.at(p) - (TAU * p).sin()).abs() < 0.01, "{p}");
            assert!((spline.at(p) - spline.at(p - 2.0)).abs() < 1e-12);
        }
    }

    #[test]
    fn two_readings_of_one_phase_are_averaged() {
        let spline = PeriodicSpline::new(&[0.0, 0.3, 0.302, 0.6], &[0.0, 1.0, 3.0, 0.0]);
        assert!((spline.at(0.301) - 2.0).abs() < 1e-9);
    }
}
