//! The paper's greedy search at two scales (van de Panne 1997, Fig. 10): the baseline.

use glam::DVec3;

use crate::knots::Knot;
use crate::problem::{KNOT_SIZE, Problem};

/// Alterations of the curve, metres: coarse until nothing is gained, then fine.
const ALTERATIONS_M: [f64; 2] = [0.06, 0.02];
/// Cap on sweeps over all unknowns at each scale: ten times what the worst of the random tracks takes.
const MOST_SWEEPS: usize = 1000;
/// Most times one alteration is repeated before the next unknown has its turn.
const MOST_REPEATS: usize = 1000;

/// Searches from a start; returns the knots, the sweeps and whether it came to rest.
pub(crate) fn search(problem: &Problem, mut knots: Vec<Knot>) -> (Vec<Knot>, usize, bool) {
    let durations_s = tangent_times_s(problem);
    let (mut sweeps, mut at_rest) = (0, problem.curves() == 0);
    for alteration_m in ALTERATIONS_M {
        at_rest = problem.curves() == 0;
        for _ in 0..if at_rest { 0 } else { MOST_SWEEPS } {
            sweeps += 1;
            let mut is_better = false;
            for knot in 0..knots.len() {
                let mut energy = around(problem, &knots, knot);
                for element in 0..if problem.rests(knot) { KNOT_SIZE / 2 } else { KNOT_SIZE } {
                    let size = if element < 3 { alteration_m } else { alteration_m / durations_s[knot] };
                    let found = improve(problem, &mut knots, knot, altered(element, size), &mut energy)
                        || improve(problem, &mut knots, knot, altered(element, -size), &mut energy);
                    is_better |= found;
                }
            }
            if !is_better {
                at_rest = true;
                break;
            }
        }
    }
    (knots, sweeps, at_rest)
}

/// The mean duration of the curves at each knot, s: the paper's tangents are ways, ours are velocities.
fn tangent_times_s(problem: &Problem) -> Vec<f64> {
    let times_s = problem.times_s();
    let last = times_s.len() - 1;
    let mean = |knot: usize| {
        let (before, after) = (knot.saturating_sub(1), (knot + 1).min(last));
        (times_s[after] - times_s[before]) / (after - before).max(1) as f64
    };
    (0..times_s.len()).map(mean).collect()
}

fn altered(element: usize, by: f64) -> Knot {
    let mut alteration = [0.0; KNOT_SIZE];
    alteration[element] = by;
    let [x, y, z, vx, vy, vz] = alteration;
    Knot { at: DVec3::new(x, y, z), velocity: DVec3::new(vx, vy, vz) }
}

/// Energy of the curves that a knot shares.
pub(crate) fn around(problem: &Problem, knots: &[Knot], knot: usize) -> f64 {
    let curves = knot.saturating_sub(1)..(knot + 1).min(problem.curves());
    let of = |curve: usize| {
        let [physics, comfort] = problem.curve_energy(curve, [&knots[curve], &knots[curve + 1]], 0.0);
        physics + comfort
    };
    curves.map(of).sum()
}

/// Alters a knot as long as that makes the energy smaller.
fn improve(problem: &Problem, knots: &mut [Knot], knot: usize, by: Knot, energy: &mut f64) -> bool {
    for repeat in 0..MOST_REPEATS {
        let before = knots[knot];
        knots[knot] = Knot { at: before.at + by.at, velocity: before.velocity + by.velocity };
        let altered = around(problem, knots, knot);
        if altered < *energy {
            *energy = altered;
        } else {
            knots[knot] = before;
            return repeat > 0;
        }
    }
    true
}
