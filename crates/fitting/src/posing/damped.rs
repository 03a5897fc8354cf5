//! Bounded, damped least squares over the unknowns of one panel: dense, small, and quick enough for a pointer.
//!
//! The stride fit's solver works on a ring of panels and lets lengths give way; a drag needs one panel, fixed lengths
//! and an answer before the next picture. The steps are the same: Levenberg-Marquardt with bounds as an active set,
//! Gauss-Newton far from the optimum and the cost's own second derivatives near it.

use nalgebra::{DMatrix, DVector};

use crate::chain::{Attachment, Chain, Kinematics, Unknown, Vec2};
use crate::layout::{PANEL_DOF, SHARED};
use crate::problem::LinearRow;

use super::PanelPose;

/// How the distance of a point from its target counts, by the distance in standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Loss {
    /// Half the square.
    Square,
    /// Half the square up to this many standard deviations, linear beyond: a pull that does not grow.
    Huber(f64),
    /// Cauchy's loss of this scale: a pull that fades.
    Cauchy(f64),
}

impl Loss {
    /// Value, slope over distance, and curvature.
    fn of(self, s: f64) -> [f64; 3] {
        match self {
            Self::Huber(end) if s > end => [end * (s - 0.5 * end), end / s, 0.0],
            Self::Square | Self::Huber(_) => [0.5 * s * s, 1.0, 1.0],
            Self::Cauchy(scale) => {
                let q = (s / scale).powi(2);
                [0.5 * scale * scale * q.ln_1p(), 1.0 / (1.0 + q), (1.0 - q) / (1.0 + q).powi(2)]
            }
        }
    }
}

/// A point of the skeleton that is wanted at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct PointTerm {
    pub(super) on: Attachment,
    /// Wanted place in the sagittal plane, m.
    pub(super) target_m: Vec2,
    /// Standard deviation of a coordinate, m.
    pub(super) sd_m: f64,
    pub(super) loss: Loss,
}

/// What a pose is to fulfil. An unknown whose bounds are equal is frozen.
#[derive(Clone, Debug)]
pub(super) struct PoseProblem<'a> {
    pub(super) chain: &'a Chain,
    pub(super) lengths: &'a [f64; SHARED],
    pub(super) bounds: [[f64; 2]; PANEL_DOF],
    /// Value each unknown is drawn to, and how far it may stray.
    pub(super) mean: PanelPose,
    pub(super) sd: [f64; PANEL_DOF],
    pub(super) rows: &'a [LinearRow],
    pub(super) points: Vec<PointTerm>,
}

/// Which second derivatives to use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Curvature {
    GaussNewton,
    Full,
}

/// A problem at a pose.
pub(super) struct Linearized {
    pub(super) gradient: [f64; PANEL_DOF],
    pub(super) normal: [[f64; PANEL_DOF]; PANEL_DOF],
}

impl PoseProblem<'_> {
    /// Half the sum of squares, with the losses in it.
    pub(super) fn cost(&self, x: &PanelPose) -> f64 {
        let k = self.chain.kinematics(x, self.lengths);
        let strays = (0..PANEL_DOF).map(|i| 0.5 * ((x[i] - self.mean[i]) / self.sd[i]).powi(2));
        let rows = self.rows.iter().map(|row| 0.5 * row.residual(x).powi(2));
        let points = self.points.iter().map(|term| term.loss.of(term.distance_sd(&k)[2])[0]);
        strays.chain(rows).chain(points).sum()
    }

    /// Gradient and second derivatives of the cost.
    pub(super) fn linearize(&self, x: &PanelPose, curvature: Curvature) -> Linearized {
        let mut at = Linearized { gradient: [0.0; PANEL_DOF], normal: [[0.0; PANEL_DOF]; PANEL_DOF] };
        for i in 0..PANEL_DOF {
            let weight = self.sd[i].powi(-2);
            at.gradient[i] += weight * (x[i] - self.mean[i]);
            at.normal[i][i] += weight;
        }
        for row in self.rows {
            let residual = row.residual(x);
            for (i, slope) in &row.terms {
                at.gradient[*i] += residual * slope;
                for (j, other) in &row.terms {
                    at.normal[*i][*j] += slope * other;
                }
            }
        }
        let k = self.chain.kinematics(x, self.lengths);
        for term in &self.points {
            self.add_point(&mut at, &k, term, curvature);
        }
        at
    }

    fn add_point(&self, at: &mut Linearized, k: &Kinematics, term: &PointTerm, curvature: Curvature) {
        let [rx, ry, s] = term.distance_sd(k);
        let [_, even, along] = term.loss.of(s);
        let weight = even * term.sd_m.powi(-2);
        let pull = [rx, ry].map(|r| even * r / term.sd_m);
        // Second derivative with respect to the place: `even` across the residual, `along` in its direction.
        let mut stiffness = [[weight, 0.0], [0.0, weight]];
        if curvature == Curvature::Full && s > 0.0 {
            let extra = (along - even) / (s * term.sd_m).powi(2);
            let r = [rx, ry];
            stiffness = [0, 1].map(|a| [0, 1].map(|b| stiffness[a][b] + extra * r[a] * r[b]));
        }
        let mut places: [(usize, Vec2); PANEL_DOF] = [(0, [0.0; 2]); PANEL_DOF];
        let mut count = 0;
        self.chain.derivatives(k, term.on, |unknown, d| {
            if let Unknown::Panel(i) = unknown {
                places[count] = (i, d);
                count += 1;
            }
        });
        for (i, d) in &places[..count] {
            at.gradient[*i] += pull[0] * d[0] + pull[1] * d[1];
            let stiff = stiffness.map(|row| row[0] * d[0] + row[1] * d[1]);
            for (j, other) in &places[..count] {
                at.normal[*i][*j] += stiff[0] * other[0] + stiff[1] * other[1];
            }
        }
        if curvature == Curvature::Full {
            self.chain.second_derivatives(k, term.on, pull, |a, b, value| {
                if let (Unknown::Panel(a), Unknown::Panel(b)) = (a, b) {
                    at.normal[a][b] += value;
                    if a != b {
                        at.normal[b][a] += value;
                    }
                }
            });
        }
    }
}

impl PointTerm {
    /// Residual in standard deviations, and its length.
    fn distance_sd(&self, k: &Kinematics) -> [f64; 3] {
        let [x, y] = k.place(self.on);
        let [rx, ry] = [(x - self.target_m[0]) / self.sd_m, (y - self.target_m[1]) / self.sd_m];
        [rx, ry, rx.hypot(ry)]
    }
}

/// Damping at the start, as a share of the pull towards the mean: an unknown may move by about its standard deviation.
const INITIAL_DAMPING: f64 = 0.1;
/// Damping beyond which no step of any use is left.
const GREATEST_DAMPING: f64 = 1e12;
/// A step this much worse than predicted is refused.
const LEAST_GAIN: f64 = 1e-3;
/// The solver stops at steps below this share of every standard deviation; of half a radian, seen on a limb of one
/// metre at 1000 px/m, this is a hundredth of a pixel.
const STEP_TOLERANCE: f64 = 2e-5;
/// Once a step gains less than this share of the cost, exact second derivatives take over.
const FULL_CURVATURE_BELOW: f64 = 0.1;
/// Rounds in which a step's unknowns may run into their bounds.
const BOUND_ROUNDS: usize = 6;

/// The pose of least cost near a start, in at most so many steps.
pub(super) fn solve(problem: &PoseProblem<'_>, start: &PanelPose, steps: usize) -> PanelPose {
    let clamp = |x: f64, i: usize| x.clamp(problem.bounds[i][0], problem.bounds[i][1]);
    let mut x: PanelPose = std::array::from_fn(|i| clamp(start[i], i));
    let mut cost = problem.cost(&x);
    let (mut damping, mut growth, mut curvature) = (INITIAL_DAMPING, 2.0, Curvature::GaussNewton);
    for _ in 0..steps {
        let at = problem.linearize(&x, curvature);
        let accepted = loop {
            let trial = at.bounded_step(problem, &x, damping).map(|step| {
                let next: PanelPose = std::array::from_fn(|i| clamp(x[i] + step[i], i));
                (next, cost - problem.cost(&next), at.predicted_decrease(&step))
            });
            match trial {
                Some((next, decrease, predicted)) if decrease > (LEAST_GAIN * predicted).max(0.0) => {
                    // A step cut short by bounds may promise nothing and still gain.
                    break Some((next, decrease, (decrease / predicted.max(decrease)).min(1.0)));
                }
                Some((next, ..)) if problem.largest_move(&x, &next) < STEP_TOLERANCE => break None,
                _ => (damping, growth) = (damping * growth, growth * 2.0),
            }
            if damping > GREATEST_DAMPING {
                break None;
            }
        };
        let Some((next, decrease, gain)) = accepted else { break };
        let moved = problem.largest_move(&x, &next);
        let near = decrease < FULL_CURVATURE_BELOW * cost;
        curvature = if near { Curvature::Full } else { Curvature::GaussNewton };
        (damping, growth) = (damping * (1.0 - (2.0 * gain - 1.0).powi(3)).clamp(0.1, 1.0), 2.0);
        (x, cost) = (next, cost - decrease);
        if moved < STEP_TOLERANCE {
            break;
        }
    }
    x
}

impl PoseProblem<'_> {
    /// Largest change of an unknown, in its standard deviations.
    fn largest_move(&self, from: &PanelPose, to: &PanelPose) -> f64 {
        (0..PANEL_DOF).map(|i| ((to[i] - from[i]) / self.sd[i]).abs()).fold(0.0, f64::max)
    }
}

impl Linearized {
    /// The damped step that stays within the bounds; none when the second derivatives are not positive definite.
    fn bounded_step(
        &self,
        problem: &PoseProblem<'_>,
        x: &PanelPose,
        damping: f64,
    ) -> Option<[f64; PANEL_DOF]> {
        let mut step = [0.0; PANEL_DOF];
        let pinned = |i: usize| {
            let ([low, high], slope) = (problem.bounds[i], self.gradient[i]);
            low >= high || (x[i] <= low && slope > 0.0) || (x[i] >= high && slope < 0.0)
        };
        let mut free: Vec<usize> = (0..PANEL_DOF).filter(|i| !pinned(*i)).collect();
        for _ in 0..BOUND_ROUNDS {
            let added = |i: usize| damping * problem.sd[i].powi(-2);
            let matrix = DMatrix::from_fn(free.len(), free.len(), |r, c| {
                let (i, j) = (free[r], free[c]);
                self.normal[i][j] + if i == j { added(i) } else { 0.0 }
            });
            // Unknowns that ran into a bound in an earlier round move as far as it, and pull the others along.
            let right = DVector::from_fn(free.len(), |r, _| {
                let bent = (0..PANEL_DOF).map(|j| self.normal[free[r]][j] * step[j]).sum::<f64>();
                -self.gradient[free[r]] - bent
            });
            let solved = matrix.cholesky()?.solve(&right);
            let beyond =
                |i: usize, d: f64| x[i] + d < problem.bounds[i][0] || x[i] + d > problem.bounds[i][1];
            let within = free.iter().zip(solved.iter()).all(|(i, d)| !beyond(*i, *d));
            let mut left = Vec::with_capacity(free.len());
            for (i, d) in free.iter().zip(solved.iter()) {
                if within || beyond(*i, *d) {
                    step[*i] = (x[*i] + d).clamp(problem.bounds[*i][0], problem.bounds[*i][1]) - x[*i];
                } else {
                    left.push(*i);
                }
            }
            free = left;
            if free.is_empty() || within {
                break;
            }
        }
        step.iter().all(|d| d.is_finite()).then_some(step)
    }

    fn predicted_decrease(&self, step: &[f64; PANEL_DOF]) -> f64 {
        let mut sum = 0.0;
        for i in (0..PANEL_DOF).filter(|i| step[*i] != 0.0) {
            let bent = (0..PANEL_DOF).map(|j| self.normal[i][j] * step[j]).sum::<f64>();
            sum -= step[i] * (self.gradient[i] + 0.5 * bent);
        }
        sum
    }
}
