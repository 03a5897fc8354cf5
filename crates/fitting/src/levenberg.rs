//! Bounded Levenberg-Marquardt as an argmin solver.
//!
//! Box bounds by an active set: an unknown at its bound whose gradient points outward is pinned for the step, the rest
//! is solved, clamped into the box, and judged by the ratio of actual to predicted decrease.
//!
//! ## References
//! Madsen, Nielsen & Tingleff, *Methods for Non-Linear Least Squares Problems* (2004), Algorithm 3.16 (damping);
//! Kanzow, Yamashita & Fukushima (2004) (projection onto the box).

use argmin::core::{
    Error, Executor, IterState, KV, Problem, Solver, State, TerminationReason, TerminationStatus,
};

use crate::normal_matrix::{Factor, NormalMatrix};

/// A least-squares problem whose normal matrix has the band-and-border form.
pub trait LeastSquares {
    /// Half the sum of squared residuals.
    fn cost(&self, x: &[f64]) -> f64;
    /// Cost, gradient and second derivatives, exact or without the residuals' own curvature.
    fn linearize(&self, x: &[f64], curvature: Curvature) -> Linearization;
    /// The same in the memory of an older linearization of the problem.
    fn relinearize(&self, x: &[f64], curvature: Curvature, at: &mut Linearization) {
        *at = self.linearize(x, curvature);
    }
    /// Least and greatest value of each unknown.
    fn bounds(&self) -> &[[f64; 2]];
}

/// Which second derivatives a linearization holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Curvature {
    /// `J^T W J` with the loss's weights: positive definite everywhere, slow at the end where residuals stay large.
    GaussNewton,
    /// The cost's own second derivatives: quadratic convergence near the optimum, of no use far from it.
    Full,
}

/// A problem at a point.
pub struct Linearization {
    /// Half the sum of squares.
    pub cost: f64,
    /// Gradient of the cost.
    pub gradient: Vec<f64>,
    /// Second derivatives of the cost.
    pub normal: NormalMatrix,
}

/// Start of the damping, relative to the diagonal of the normal matrix. Must be positive; 1e-3 suits starts that are
/// within tens of degrees, which the rest pose is.
const INITIAL_DAMPING: f64 = 1e-3;
/// Damping beyond which no step of any use is left.
const GREATEST_DAMPING: f64 = 1e12;
/// Relative decrease of the cost per step below which the solver stops. Two starts that converge agree to about this.
const COST_TOLERANCE: f64 = 1e-12;
/// Once a step gains less than this share of the cost, exact second derivatives take over.
const FULL_CURVATURE_BELOW: f64 = 0.02;
/// Damping from which to search upwards when the exact second derivatives are not positive definite.
const INDEFINITE_DAMPING: f64 = 1e-3;
/// A step this much worse than predicted is refused.
const LEAST_GAIN: f64 = 1e-4;
/// Cap on accepted steps: ten times what the worst start in the tests takes.
pub const MAX_STEPS: u64 = 300;

/// The solver's state between steps.
struct Damped {
    at: Linearization,
    /// The latest factor, kept for its memory.
    factor: Factor,
    /// Diagonal of the first normal matrix, which the damping is relative to.
    scale: Vec<f64>,
    damping: f64,
    growth: f64,
    converged: bool,
}

/// Levenberg-Marquardt with box bounds.
#[derive(Default)]
pub struct BoundedLevenbergMarquardt {
    state: Option<Damped>,
}

type Iterate = IterState<Vec<f64>, (), (), (), (), f64>;

impl BoundedLevenbergMarquardt {
    /// One accepted step, or convergence: refused steps are repeated inside with more damping.
    fn step<P: LeastSquares>(
        &mut self,
        problem: &mut Problem<P>,
        x: Vec<f64>,
    ) -> Result<(Vec<f64>, f64), Error> {
        let Some(damped) = self.state.as_mut() else {
            return Err(argmin::argmin_error!(NotInitialized, "init was not called"));
        };
        let bounds = problem.problem("bounds_count", |p| Ok(p.bounds().to_vec()))?;
        let pinned: Vec<bool> = (0..x.len()).map(|i| pins(x[i], damped.at.gradient[i], bounds[i])).collect();
        let right: Vec<f64> =
            damped.at.gradient.iter().zip(&pinned).map(|(g, pin)| if *pin { 0.0 } else { -g }).collect();
        while damped.damping < GREATEST_DAMPING {
            let added: Vec<f64> = damped.scale.iter().map(|d| damped.damping * d).collect();
            if damped.at.normal.factor_into(&added, &pinned, &mut damped.factor).is_none() {
                damped.damping = damped.damping.max(INDEFINITE_DAMPING);
                damped.refuse();
                continue;
            }
            let step = damped.factor.solve(&right);
            let next: Vec<f64> = x
                .iter()
                .zip(&step)
                .zip(&bounds)
                .map(|((x, d), [low, high])| (x + d).clamp(*low, *high))
                .collect();
            let moved: Vec<f64> = next.iter().zip(&x).map(|(a, b)| a - b).collect();
            let predicted = predicted_decrease(&damped.at, &moved);
            let cost = problem.problem("cost_count", |p| Ok(p.cost(&next)))?;
            let decrease = damped.at.cost - cost;
            let tiny = COST_TOLERANCE * damped.at.cost.max(f64::MIN_POSITIVE);
            if predicted <= tiny && decrease.abs() <= tiny {
                damped.converged = true;
                return Ok((x, damped.at.cost));
            }
            if !(decrease > LEAST_GAIN * predicted && decrease > 0.0) {
                damped.refuse();
                continue;
            }
            damped.accept(decrease / predicted);
            damped.converged = decrease <= tiny;
            let near = decrease < FULL_CURVATURE_BELOW * cost;
            let curvature = if near { Curvature::Full } else { Curvature::GaussNewton };
            let at = &mut damped.at;
            problem.problem("linearize_count", |p| {
                p.relinearize(&next, curvature, at);
                Ok(())
            })?;
            return Ok((next, cost));
        }
        damped.converged = true;
        Ok((x, damped.at.cost))
    }
}

impl Damped {
    fn refuse(&mut self) {
        self.damping *= self.growth;
        self.growth *= 2.0;
    }

    fn accept(&mut self, gain: f64) {
        self.damping = (self.damping * (1.0 - (2.0 * gain - 1.0).powi(3)).max(1.0 / 3.0)).max(1e-12);
        self.growth = 2.0;
    }
}

fn pins(x: f64, gradient: f64, [low, high]: [f64; 2]) -> bool {
    (x <= low && gradient > 0.0) || (x >= high && gradient < 0.0)
}

fn predicted_decrease(at: &Linearization, step: &[f64]) -> f64 {
    let bent = at.normal.multiply(step);
    -step.iter().zip(&at.gradient).zip(&bent).map(|((d, g), h)| d * (g + 0.5 * h)).sum::<f64>()
}

impl<P: LeastSquares> Solver<P, Iterate> for BoundedLevenbergMarquardt {
    fn name(&self) -> &str {
        "bounded Levenberg-Marquardt"
    }

    fn init(&mut self, problem: &mut Problem<P>, mut state: Iterate) -> Result<(Iterate, Option<KV>), Error> {
        let Some(mut x) = state.take_param() else {
            return Err(argmin::argmin_error!(NotInitialized, "no start"));
        };
        let at = problem.problem("linearize_count", |p| {
            for (value, [low, high]) in x.iter_mut().zip(p.bounds()) {
                *value = value.clamp(*low, *high);
            }
            Ok(p.linearize(&x, Curvature::GaussNewton))
        })?;
        let cost = at.cost;
        let scale = at.normal.diagonal().iter().map(|d| d.max(f64::MIN_POSITIVE)).collect();
        let factor = Factor::of_size(&at.normal);
        self.state =
            Some(Damped { at, factor, scale, damping: INITIAL_DAMPING, growth: 2.0, converged: false });
        Ok((state.param(x).cost(cost), None))
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<P>,
        mut state: Iterate,
    ) -> Result<(Iterate, Option<KV>), Error> {
        let Some(x) = state.take_param() else {
            return Err(argmin::argmin_error!(NotInitialized, "no iterate"));
        };
        let (x, cost) = self.step(problem, x)?;
        Ok((state.param(x).cost(cost), None))
    }

    fn terminate(&mut self, _state: &Iterate) -> TerminationStatus {
        if self.state.as_ref().is_some_and(|damped| damped.converged) {
            return TerminationStatus::Terminated(TerminationReason::SolverConverged);
        }
        TerminationStatus::NotTerminated
    }
}

/// What the solver found.
#[derive(Clone, Debug, PartialEq)]
pub struct Optimum {
    /// The unknowns.
    pub x: Vec<f64>,
    /// Half the sum of squares there.
    pub cost: f64,
    /// Accepted steps.
    pub steps: u64,
    /// Whether it stopped by itself rather than at [`MAX_STEPS`].
    pub converged: bool,
}

/// Solves a problem from a start, through argmin's executor.
pub fn solve<P: LeastSquares>(problem: P, start: Vec<f64>) -> Optimum {
    solve_within(problem, start, MAX_STEPS)
}

/// Solves a problem from a start in at most so many accepted steps.
pub fn solve_within<P: LeastSquares>(problem: P, start: Vec<f64>, steps: u64) -> Optimum {
    let result = Executor::new(problem, BoundedLevenbergMarquardt::default())
        .configure(|state: Iterate| state.param(start).max_iters(steps))
        .timer(false)
        .run()
        .unwrap_or_else(|error| {
            unreachable!("cost and derivatives of a validated stride are total: {error}")
        });
    let mut state = result.state;
    let converged = matches!(
        state.get_termination_status(),
        TerminationStatus::Terminated(TerminationReason::SolverConverged)
    );
    let (cost, steps) = (state.get_cost(), state.get_iter());
    let x = state.take_param().or_else(|| state.take_best_param()).unwrap_or_default();
    Optimum { x, cost, steps, converged }
}
