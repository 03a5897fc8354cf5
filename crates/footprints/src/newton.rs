//! Damped Newton on a chain of knots, as an argmin solver: each curve ties two neighbouring knots, so that the second derivatives are
//! blocks of six along the diagonal and beside it, and a step costs as much as the chain is long.
//!
//! The length of the missing force has a point at zero, where good motions are. It is rounded off, `sqrt(r² + s²)`, and s is made smaller
//! and smaller: each stage starts where the one before it ended.
//!
//! ## References
//! Madsen, Nielsen & Tingleff, *Methods for Non-Linear Least Squares Problems* (2004), Algorithm 3.16 (damping).

use std::ops::Range;

use argmin::core::{
    Error, Executor, IterState, KV, Problem as Counted, Solver, State, TerminationReason, TerminationStatus,
};

use crate::energy::Foreseen;
use crate::knots::Knot;
use crate::problem::{BentCurve, Block, CURVE_SAMPLES, KNOT_SIZE, Problem, Row};

/// Rounding of the missing force at each stage, m/s²: from gravity, where everything is smooth, to a ten-thousandth of it.
const STAGES: [f64; 9] = [10.0, 3.0, 1.0, 0.3, 0.1, 0.03, 0.01, 0.003, 0.001];
/// Damping relative to the diagonal, at the start and where a later stage begins at most.
const FIRST_DAMPING: f64 = 1.0;
const LATER_DAMPING: f64 = 1e-5;
/// An accepted step divides the damping by this at most, and never makes it less than the second number.
const MOST_RELIEF: f64 = 10.0;
const LEAST_DAMPING: f64 = 1e-10;
/// Damping of the pendulum's system: what nothing holds stays.
const PENDULUM_DAMPING: f64 = 1e-12;
/// Damping beyond which no step of any use is left.
const GREATEST_DAMPING: f64 = 1e9;
/// Relative decrease of the energy below which a stage ends, and that of the last one.
const STAGE_TOLERANCE: f64 = 1e-3;
const LAST_TOLERANCE: f64 = 2e-5;
/// That of the last stage while a print is dragged: the next frame goes on from there.
const DRAG_TOLERANCE: f64 = 5e-4;
/// A step this much worse than predicted is refused.
const LEAST_GAIN: f64 = 1e-4;
/// Cap on accepted steps: three times what the worst of the random tracks takes.
const MOST_STEPS: u64 = 300;

/// The knots of a problem that may move; the others stay.
pub(crate) struct Chain<'a> {
    pub(crate) problem: &'a Problem,
    pub(crate) knots: Vec<Knot>,
    pub(crate) free: Range<usize>,
}

impl Chain<'_> {
    /// Curves that touch a free knot.
    fn curves(&self) -> Range<usize> {
        self.free.start.saturating_sub(1)..self.free.end.min(self.problem.curves())
    }

    fn knot(&self, unknowns: &[f64], knot: usize) -> Knot {
        if self.free.contains(&knot) { read(unknowns, knot - self.free.start) } else { self.knots[knot] }
    }

    fn energy(&self, unknowns: &[f64], smoothing: f64) -> f64 {
        let of = |curve: usize| {
            let ends = [curve, curve + 1].map(|knot| self.knot(unknowns, knot));
            let [physics, comfort] = self.problem.curve_energy(curve, [&ends[0], &ends[1]], smoothing);
            physics + comfort
        };
        self.curves().map(of).sum()
    }

    /// Energy and derivatives at a place, to which a step from the linearization before has led.
    fn linearize(&self, unknowns: &[f64], smoothing: f64, at: &mut Linearization) {
        at.clear(self.free.len());
        at.foreseen.resize(self.curves().len(), Default::default());
        for (place, curve) in self.curves().enumerate() {
            let ends = [curve, curve + 1].map(|knot| self.knot(unknowns, knot));
            let foreseen = &mut at.foreseen[place];
            let bent = self.problem.bend_curve(curve, [&ends[0], &ends[1]], smoothing, foreseen);
            self.gather(curve, &bent, at);
        }
        self.hold(at);
    }

    /// Stops the resting knots.
    fn rest(&mut self) {
        for knot in self.free.clone().filter(|&knot| self.problem.rests(knot)) {
            self.knots[knot].velocity = glam::DVec3::ZERO;
        }
    }

    /// Takes the velocities of resting knots out of the system.
    fn hold(&self, at: &mut Linearization) {
        for knot in self.free.clone().filter(|&knot| self.problem.rests(knot)) {
            let slot = knot - self.free.start;
            for i in KNOT_SIZE / 2..KNOT_SIZE {
                at.gradient[slot][i] = 0.0;
                at.beside[slot][i] = Row::default();
                at.diagonal[slot].iter_mut().for_each(|row| row[i] = 0.0);
                at.diagonal[slot][i] = Row::default();
                at.diagonal[slot][i][i] = 1.0;
                if slot > 0 {
                    at.beside[slot - 1].iter_mut().for_each(|row| row[i] = 0.0);
                }
            }
        }
    }

    /// Adds a curve to the whole.
    fn gather(&self, curve: usize, bent: &BentCurve, at: &mut Linearization) {
        at.energy += bent.energy;
        let slot = |knot: usize| self.free.contains(&knot).then(|| knot - self.free.start);
        let slots = [slot(curve), slot(curve + 1)];
        for (side, slot) in slots.into_iter().enumerate() {
            let Some(slot) = slot else { continue };
            add(&mut at.diagonal[slot], &bent.blocks[2 * side]);
            let gradient = [bent.gradient[side].at.to_array(), bent.gradient[side].velocity.to_array()];
            for (sum, part) in at.gradient[slot].iter_mut().zip(gradient.as_flattened()) {
                *sum += part;
            }
        }
        if let [Some(slot), Some(_)] = slots {
            add(&mut at.beside[slot], &bent.blocks[1]);
        }
    }

    /// Moves the free knots to the pendulum's motion.
    pub(crate) fn swing(&mut self) {
        self.rest();
        let mut at = Linearization::default();
        at.clear(self.free.len());
        for curve in self.curves() {
            let bent = self.problem.bend_pendulum(curve, [&self.knots[curve], &self.knots[curve + 1]]);
            self.gather(curve, &bent, &mut at);
        }
        self.hold(&mut at);
        let ones: Vec<Row> =
            at.diagonal.iter().map(|block| std::array::from_fn(|i| block[i][i].max(1e-9))).collect();
        let mut factor = Factor::default();
        if !factor.factor(&at, &ones, PENDULUM_DAMPING) {
            return;
        }
        let mut step: Vec<Row> = at.gradient.iter().map(|row| row.map(|g| -g)).collect();
        factor.solve(&mut step);
        for (knot, [x, y, z, vx, vy, vz]) in self.knots[self.free.clone()].iter_mut().zip(step) {
            knot.at += glam::DVec3::new(x, y, z);
            knot.velocity += glam::DVec3::new(vx, vy, vz);
        }
    }
}

/// The unknowns of knots.
pub(crate) fn write(knots: &[Knot]) -> Vec<f64> {
    knots.iter().flat_map(|knot| [knot.at.to_array(), knot.velocity.to_array()]).flatten().collect()
}

/// The knot at a place in the unknowns.
pub(crate) fn read(unknowns: &[f64], knot: usize) -> Knot {
    let [x, y, z, vx, vy, vz] = std::array::from_fn(|i| unknowns[KNOT_SIZE * knot + i]);
    Knot { at: glam::DVec3::new(x, y, z), velocity: glam::DVec3::new(vx, vy, vz) }
}

fn add(sum: &mut Block, part: &Block) {
    for (sum, part) in sum.as_flattened_mut().iter_mut().zip(part.as_flattened()) {
        *sum += part;
    }
}

/// Gradient and second derivatives of a chain.
#[derive(Default)]
struct Linearization {
    energy: f64,
    /// Of each curve that touches a free knot.
    foreseen: Vec<[Foreseen; CURVE_SAMPLES]>,
    gradient: Vec<Row>,
    /// Each knot with itself, and each with the next.
    diagonal: Vec<Block>,
    beside: Vec<Block>,
}

impl Linearization {
    fn clear(&mut self, knots: usize) {
        self.energy = 0.0;
        self.gradient.clear();
        self.gradient.resize(knots, Row::default());
        for blocks in [&mut self.diagonal, &mut self.beside] {
            blocks.clear();
            blocks.resize(knots, Block::default());
        }
    }

    /// What the energy falls by along a step, as far as the derivatives tell.
    fn predicted(&self, step: &[Row]) -> f64 {
        let mut sum = 0.0;
        for (knot, row) in step.iter().enumerate() {
            let next = step.get(knot + 1);
            for i in 0..KNOT_SIZE {
                let mut bent = 0.5 * dot(&self.diagonal[knot][i], row);
                if let Some(next) = next {
                    bent += dot(&self.beside[knot][i], next);
                }
                sum -= row[i] * (self.gradient[knot][i] + bent);
            }
        }
        sum
    }
}

fn dot(a: &Row, b: &Row) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The factor L of a block tridiagonal matrix, in memory that is used again.
#[derive(Default)]
struct Factor {
    /// Lower triangles along the diagonal, and the blocks below them (transposed).
    diagonal: Vec<Block>,
    beside: Vec<Block>,
}

impl Factor {
    /// Factors the second derivatives with damping relative to a scale; false when they are not positive definite.
    fn factor(&mut self, of: &Linearization, scale: &[Row], damping: f64) -> bool {
        self.diagonal.clone_from(&of.diagonal);
        self.beside.clone_from(&of.beside);
        for knot in 0..self.diagonal.len() {
            for i in 0..KNOT_SIZE {
                self.diagonal[knot][i][i] += damping * scale[knot][i];
            }
            if knot > 0 {
                // Subtracts what the knot before it explains.
                let above = &self.beside[knot - 1];
                for row in above {
                    for i in 0..KNOT_SIZE {
                        for j in 0..=i {
                            self.diagonal[knot][i][j] -= row[i] * row[j];
                        }
                    }
                }
            }
            if !cholesky(&mut self.diagonal[knot]) {
                return false;
            }
            solve_rows(&self.diagonal[knot], &mut self.beside[knot]);
        }
        true
    }

    /// Solves for a step, in place.
    fn solve(&self, step: &mut [Row]) {
        for knot in 0..step.len() {
            if knot > 0 {
                for (row, by) in self.beside[knot - 1].iter().zip(step[knot - 1]) {
                    for i in 0..KNOT_SIZE {
                        step[knot][i] -= row[i] * by;
                    }
                }
            }
            let (lower, row) = (&self.diagonal[knot], &mut step[knot]);
            for i in 0..KNOT_SIZE {
                let sum: f64 = (0..i).map(|j| lower[i][j] * row[j]).sum();
                row[i] = (row[i] - sum) / lower[i][i];
            }
        }
        for knot in (0..step.len()).rev() {
            if let Some(&next) = step.get(knot + 1) {
                for (value, row) in step[knot].iter_mut().zip(&self.beside[knot]) {
                    *value -= dot(row, &next);
                }
            }
            let (lower, row) = (&self.diagonal[knot], &mut step[knot]);
            for i in (0..KNOT_SIZE).rev() {
                let sum: f64 = (i + 1..KNOT_SIZE).map(|j| lower[j][i] * row[j]).sum();
                row[i] = (row[i] - sum) / lower[i][i];
            }
        }
    }
}

/// The lower factor of a block in its lower triangle; false when it is not positive definite.
fn cholesky(block: &mut Block) -> bool {
    for j in 0..KNOT_SIZE {
        let sum: f64 = (0..j).map(|k| block[j][k] * block[j][k]).sum();
        let pivot = block[j][j] - sum;
        if !(pivot > 0.0 && pivot.is_finite()) {
            return false;
        }
        block[j][j] = pivot.sqrt();
        for i in j + 1..KNOT_SIZE {
            let sum: f64 = (0..j).map(|k| block[i][k] * block[j][k]).sum();
            block[i][j] = (block[i][j] - sum) / block[j][j];
        }
    }
    true
}

/// Solves `L X = B` in place of B.
fn solve_rows(lower: &Block, rows: &mut Block) {
    for i in 0..KNOT_SIZE {
        for k in 0..i {
            let (before, after) = rows.split_at_mut(i);
            for (value, by) in after[0].iter_mut().zip(&before[k]) {
                *value -= lower[i][k] * by;
            }
        }
        rows[i].iter_mut().for_each(|value| *value /= lower[i][i]);
    }
}

/// How far a start is from the solution.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum From {
    /// All stages.
    FarOff,
    /// The last stage alone, and that only as far as a frame needs.
    NearlySolved,
}

/// The solver.
pub(crate) struct StagedNewton {
    stages: &'static [f64],
    last_tolerance: f64,
    stage: usize,
    at: Linearization,
    factor: Factor,
    scale: Vec<Row>,
    damping: f64,
    growth: f64,
    converged: bool,
}

impl StagedNewton {
    fn new(from: From) -> Self {
        let (stages, damping, last_tolerance) = match from {
            From::FarOff => (&STAGES[..], FIRST_DAMPING, LAST_TOLERANCE),
            From::NearlySolved => (&STAGES[STAGES.len() - 1..], LATER_DAMPING, DRAG_TOLERANCE),
        };
        Self {
            stages,
            last_tolerance,
            stage: 0,
            at: Linearization::default(),
            factor: Factor::default(),
            scale: Vec::new(),
            damping,
            growth: 2.0,
            converged: false,
        }
    }

    /// Evaluates the chain where the next step starts from.
    fn linearize(&mut self, chain: &Chain<'_>, x: &[f64]) {
        chain.linearize(x, self.stages[self.stage], &mut self.at);
    }

    /// Begins a stage at a place.
    fn begin(&mut self, chain: &Chain<'_>, x: &[f64]) {
        self.linearize(chain, x);
        self.scale.clear();
        let diagonal = |block: &Block| std::array::from_fn(|i| block[i][i].max(1e-9));
        self.scale.extend(self.at.diagonal.iter().map(diagonal));
    }

    /// One accepted step, or none when no step gains anything; ends stages that gain no more.
    fn step(&mut self, chain: &Chain<'_>, x: &[f64]) -> Option<Vec<f64>> {
        while self.damping < GREATEST_DAMPING {
            if !self.factor.factor(&self.at, &self.scale, self.damping) {
                self.refuse();
                continue;
            }
            let mut step: Vec<Row> = self.at.gradient.iter().map(|row| row.map(|g| -g)).collect();
            self.factor.solve(&mut step);
            let predicted = self.at.predicted(&step);
            let next: Vec<f64> = x.iter().zip(step.as_flattened()).map(|(x, d)| x + d).collect();
            let decrease = self.at.energy - chain.energy(&next, self.stages[self.stage]);
            if decrease > LEAST_GAIN * predicted && decrease > 0.0 {
                self.accept(decrease / predicted);
                if decrease < self.tolerance() * self.at.energy {
                    self.next_stage(chain, &next);
                } else {
                    self.linearize(chain, &next);
                }
                return Some(next);
            }
            if predicted <= self.tolerance() * self.at.energy {
                break;
            }
            self.refuse();
        }
        self.next_stage(chain, x);
        None
    }

    fn refuse(&mut self) {
        self.damping *= self.growth;
        self.growth *= 2.0;
    }

    fn accept(&mut self, gain: f64) {
        let relief = (1.0 - (2.0 * gain - 1.0).powi(3)).max(1.0 / MOST_RELIEF);
        self.damping = (self.damping * relief).max(LEAST_DAMPING);
        self.growth = 2.0;
    }

    fn tolerance(&self) -> f64 {
        if self.stage + 1 < self.stages.len() { STAGE_TOLERANCE } else { self.last_tolerance }
    }

    fn next_stage(&mut self, chain: &Chain<'_>, x: &[f64]) {
        self.stage += 1;
        self.converged = self.stage >= self.stages.len();
        (self.damping, self.growth) = (self.damping.min(LATER_DAMPING), 2.0);
        if !self.converged {
            self.begin(chain, x);
        }
    }
}

type Iterate = IterState<Vec<f64>, (), (), (), (), f64>;

impl Solver<Chain<'_>, Iterate> for StagedNewton {
    fn name(&self) -> &str {
        "staged Newton on a chain"
    }

    fn init(
        &mut self,
        problem: &mut Counted<Chain<'_>>,
        mut state: Iterate,
    ) -> Result<(Iterate, Option<KV>), Error> {
        let Some(x) = state.take_param() else {
            return Err(argmin::argmin_error!(NotInitialized, "no start"));
        };
        problem.problem("linearize_count", |chain| {
            self.begin(chain, &x);
            Ok(())
        })?;
        Ok((state.param(x).cost(self.at.energy), None))
    }

    fn next_iter(
        &mut self,
        problem: &mut Counted<Chain<'_>>,
        mut state: Iterate,
    ) -> Result<(Iterate, Option<KV>), Error> {
        let Some(x) = state.take_param() else {
            return Err(argmin::argmin_error!(NotInitialized, "no iterate"));
        };
        let next = problem.problem("step_count", |chain| Ok(self.step(chain, &x)))?;
        Ok((state.param(next.unwrap_or(x)).cost(self.at.energy), None))
    }

    fn terminate(&mut self, _state: &Iterate) -> TerminationStatus {
        if self.converged {
            TerminationStatus::Terminated(TerminationReason::SolverConverged)
        } else {
            TerminationStatus::NotTerminated
        }
    }
}

/// Moves the free knots of a chain to where the energy is least; returns all knots, the accepted steps and whether it came to rest.
pub(crate) fn minimize(mut chain: Chain<'_>, from: From) -> (Vec<Knot>, usize, bool) {
    chain.rest();
    let (mut knots, free) = (chain.knots.clone(), chain.free.clone());
    if free.is_empty() {
        return (knots, 0, true);
    }
    let start = write(&knots[free.clone()]);
    let run = Executor::new(chain, StagedNewton::new(from))
        .configure(|state: Iterate| state.param(start).max_iters(MOST_STEPS))
        .timer(false)
        .run();
    let Ok(mut result) = run else { return (knots, 0, false) };
    let status = result.state.get_termination_status().clone();
    let converged = status == TerminationStatus::Terminated(TerminationReason::SolverConverged);
    let steps = result.state.get_iter() as usize;
    let x = result.state.take_param().or_else(|| result.state.take_best_param()).unwrap_or_default();
    if x.len() == KNOT_SIZE * free.len() && x.iter().all(|value| value.is_finite()) {
        for (slot, knot) in free.enumerate() {
            knots[knot] = read(&x, slot);
        }
    }
    (knots, steps, converged)
}
