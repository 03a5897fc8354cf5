//! Finding the centre-of-mass curve.

use std::ops::Range;

use serde::{Deserialize, Serialize};

use crate::greedy;
use crate::knots::{Knot, Trajectory};
use crate::newton::{Chain, From, minimize};
use crate::problem::{Energy, Problem};

/// How the curve is found.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// Exact gradient, banded Newton through argmin.
    #[default]
    Gradient,
    /// The paper's greedy search at two scales.
    Greedy,
}

/// A solved motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Solved {
    /// The curve.
    pub trajectory: Trajectory,
    /// Its energy.
    pub energy: Energy,
    /// Accepted steps (gradient) or sweeps (greedy).
    pub steps: usize,
    /// Whether it stopped by itself.
    pub converged: bool,
}

/// Solves from the paper's start.
pub fn solve(problem: &Problem, method: Method) -> Solved {
    solve_from(problem, problem.start(), method)
}

/// Solves from any start, a knot for each of the problem's times.
///
/// The gradient solver's first step leads from every start to the motion of a linear inverted pendulum, so that its result does not depend
/// on the start; the greedy search's does. [`descend`] shows what the start would do.
pub fn solve_from(problem: &Problem, start: Vec<Knot>, method: Method) -> Solved {
    let all = 0..start.len();
    let found = match method {
        Method::Gradient => {
            let mut chain = Chain { problem, knots: start, free: all };
            chain.swing();
            minimize(chain, From::FarOff)
        }
        Method::Greedy => greedy::search(problem, start),
    };
    solved(problem, found)
}

/// Solves by the gradient straight from a start, without the step that makes all starts equal.
pub fn descend(problem: &Problem, start: Vec<Knot>) -> Solved {
    let free = 0..start.len();
    solved(problem, minimize(Chain { problem, knots: start, free }, From::FarOff))
}

/// Solves by the gradient from a start that is nearly a solution, moving only the knots of a range; the others stay.
pub fn resolve(problem: &Problem, start: Vec<Knot>, free: Range<usize>) -> Solved {
    let free = free.start.min(start.len())..free.end.min(start.len());
    solved(problem, minimize(Chain { problem, knots: start, free }, From::NearlySolved))
}

fn solved(problem: &Problem, (knots, steps, converged): (Vec<Knot>, usize, bool)) -> Solved {
    let energy = problem.energy(&knots);
    Solved { trajectory: Trajectory { times_s: problem.times_s().to_vec(), knots }, energy, steps, converged }
}
