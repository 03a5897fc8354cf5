//! A periodic function with a slow drift, by least squares: what a point does in every stride.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::robust::robust_sd;

/// Rounds of reweighting; weights settle in fewer than ten.
const ROUNDS: usize = 12;
/// Cauchy scale of the reweighting in robust standard deviations: 2 keeps nearly all of normal errors' weight.
const CAUCHY: f64 = 2.0;
/// Fewest samples for each unknown.
const SAMPLES_PER_UNKNOWN: usize = 2;

/// A value seen at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sample {
    /// Strides since the first frame.
    pub(super) turns: f64,
    /// The value.
    pub(super) value: f64,
}

/// Harmonics of the stride, a mean, and a drift that is even in time.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Periodic {
    /// Mean, drift per stride, then cosine and sine of each harmonic.
    coefficients: DVector<f64>,
    harmonics: usize,
    /// Turns at which the drift is zero.
    middle: f64,
}

impl Periodic {
    fn row(harmonics: usize, middle: f64, turns: f64) -> Vec<f64> {
        let mut row = vec![1.0, turns - middle];
        for k in 1..=harmonics {
            let (sin, cos) = (TAU * k as f64 * turns).sin_cos();
            row.extend([cos, sin]);
        }
        row
    }

    /// Weighted least squares; none with too few samples, or samples at too few phases.
    fn weighted(harmonics: usize, middle: f64, samples: &[Sample], weights: &[f64]) -> Option<Self> {
        let n = 2 + 2 * harmonics;
        if samples.len() < SAMPLES_PER_UNKNOWN * n {
            return None;
        }
        let mut normal = DMatrix::<f64>::zeros(n, n);
        let mut right = DVector::<f64>::zeros(n);
        for (sample, weight) in samples.iter().zip(weights) {
            let row = Self::row(harmonics, middle, sample.turns);
            for i in 0..n {
                right[i] += weight * row[i] * sample.value;
                for j in 0..n {
                    normal[(i, j)] += weight * row[i] * row[j];
                }
            }
        }
        // A trace of ridge keeps phases that no frame shows from running away.
        let ridge = 1e-6 * normal.trace() / n as f64;
        for i in 1..n {
            normal[(i, i)] += ridge;
        }
        let coefficients = normal.cholesky()?.solve(&right);
        Some(Self { coefficients, harmonics, middle })
    }

    /// Least squares.
    pub(super) fn plain(harmonics: usize, middle: f64, samples: &[Sample]) -> Option<Self> {
        Self::weighted(harmonics, middle, samples, &vec![1.0; samples.len()])
    }

    /// Least squares that outliers hardly move.
    pub(super) fn robust(harmonics: usize, middle: f64, samples: &[Sample], least_sd: f64) -> Option<Self> {
        let mut periodic = Self::plain(harmonics, middle, samples)?;
        for _ in 0..ROUNDS {
            let errors: Vec<f64> = samples.iter().map(|s| s.value - periodic.at(s.turns)).collect();
            let scale = CAUCHY * robust_sd(errors.iter().copied()).max(least_sd);
            let weights: Vec<f64> = errors.iter().map(|e| 1.0 / (1.0 + (e / scale).powi(2))).collect();
            periodic = Self::weighted(harmonics, middle, samples, &weights)?;
        }
        Some(periodic)
    }

    /// The value at an instant.
    pub(super) fn at(&self, turns: f64) -> f64 {
        let row = Self::row(self.harmonics, self.middle, turns);
        row.iter().zip(self.coefficients.iter()).map(|(a, b)| a * b).sum()
    }

    /// What the drift has added at an instant.
    pub(super) fn drift_at(&self, turns: f64) -> f64 {
        self.drift_per_turn() * (turns - self.middle)
    }

    /// What the drift adds in a stride.
    pub(super) fn drift_per_turn(&self) -> f64 {
        self.coefficients[1]
    }
}
