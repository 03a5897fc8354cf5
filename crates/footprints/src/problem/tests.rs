//! Derivatives, locality and continuity on random tracks.

use glam::DVec3;
use muybridge_core::Random;

use super::*;
use crate::greedy;
use crate::motion::{Character, Motion};
use crate::random_tracks::random_track;
use crate::solve::{Method, solve};
use crate::supports::Support;
use crate::track::Track;

fn problem(seed: u64) -> Problem {
    let track = random_track(seed);
    let character = Character::named(&track.model).unwrap();
    Motion::solve(&track, &character, Method::Gradient).unwrap().problem().clone()
}

fn shaken(problem: &Problem, random: &mut Random) -> Vec<Knot> {
    let mut any = |most: f64| DVec3::from_array(std::array::from_fn(|_| random.between(-most, most)));
    let shake = |knot: Knot| Knot { at: knot.at + any(0.2), velocity: knot.velocity + any(1.0) };
    problem.start().into_iter().map(shake).collect()
}

fn element(knot: &mut Knot, element: usize) -> &mut f64 {
    let part = if element < 3 { &mut knot.at } else { &mut knot.velocity };
    &mut part[element % 3]
}

#[test]
fn the_gradient_is_that_of_finite_differences() {
    let mut random = Random::new(4);
    let mut worst = 0.0_f64;
    for seed in 0..24 {
        let problem = problem(seed);
        let mut knots = shaken(&problem, &mut random);
        let gradient = problem.gradient(&knots);
        let scale =
            gradient.iter().map(|knot| knot.at.length().max(knot.velocity.length())).fold(0.0, f64::max);
        for knot in 0..knots.len() {
            for i in 0..KNOT_SIZE {
                let mut at = |by: f64| {
                    *element(&mut knots[knot], i) += by;
                    greedy::around(&problem, &knots, knot)
                };
                let step = 1e-5;
                let (up, _, down) = (at(step), at(-step), at(-step));
                at(step);
                let mut exact = gradient[knot];
                worst = worst.max(((up - down) / (2.0 * step) - *element(&mut exact, i)).abs() / scale);
            }
        }
    }
    assert!(worst < 1e-6, "{worst:.1e} of the greatest derivative");
}

#[test]
fn evaluating_the_curves_that_changed_is_evaluating_all() {
    let mut random = Random::new(5);
    for seed in 0..24 {
        let problem = problem(seed);
        let mut knots = shaken(&problem, &mut random);
        let curves = |knots: &[Knot]| -> Vec<[f64; 2]> {
            let of = |curve| problem.curve_energy(curve, [&knots[curve], &knots[curve + 1]], 0.0);
            (0..problem.curves()).map(of).collect()
        };
        let before = curves(&knots);
        let knot = (random.uniform() * knots.len() as f64) as usize;
        knots[knot].at += DVec3::new(0.06, 0.0, 0.02);
        let after = curves(&knots);
        for curve in (0..problem.curves()).filter(|&curve| curve + 1 != knot && curve != knot) {
            assert_eq!(before[curve], after[curve], "curve {curve} does not touch knot {knot}");
        }
        let touched: f64 = (knot.saturating_sub(1)..(knot + 1).min(after.len()))
            .map(|curve| after[curve][0] + after[curve][1])
            .sum();
        assert_eq!(greedy::around(&problem, &knots, knot), touched);
        let total = problem.energy(&knots);
        let sums = after.iter().fold([0.0; 2], |sum, part| [sum[0] + part[0], sum[1] + part[1]]);
        assert_eq!([total.physics, total.comfort], sums);
    }
}

#[test]
fn a_walk_of_n_steps_has_six_unknowns_a_step_and_six_more() {
    let stance = |i: usize| Stance {
        foot: i % 2,
        from_s: 0.5 * i as f64,
        to_s: 0.5 * i as f64 + 0.6,
        ankle: DVec3::X * (0.7 * i as f64),
        middle: DVec3::X * (0.7 * i as f64),
        toe: DVec3::X * (0.7 * i as f64 + 0.1),
        hip_from_com: DVec3::ZERO,
        nominal_m: 0.9,
        longest_m: 0.95,
        force_through_hip: 0.0,
    };
    let stances: Vec<Stance> = (0..12).map(stance).collect();
    let upright = Orientation::fixed(glam::DQuat::IDENTITY);
    let problem = Problem::new(&stances, 6.0, &upright, Weights::default());
    assert_eq!(KNOT_SIZE * problem.start().len(), 6 * 12 + 6);
    let start = problem.start();
    assert!(start.iter().all(|knot| knot.velocity == DVec3::ZERO && (knot.at.y - 0.9).abs() < 1e-12));
    assert!((start[3].at.x - 3.0 * 0.7).abs() < 1e-12, "above its print");
}

#[test]
fn flights_are_ballistic() {
    let mut worst = 0.0_f64;
    for seed in 0..48 {
        let track = random_track(seed);
        let motion =
            Motion::solve(&track, &Character::named(&track.model).unwrap(), Method::Gradient).unwrap();
        for flight in motion.placed.supports().into_iter().filter(Support::is_flight) {
            let [from_s, to_s] = [flight.from_s, flight.to_s];
            if to_s - from_s <= 0.05 {
                continue;
            }
            let (from, to) = (motion.centre_of_mass(from_s), motion.centre_of_mass(to_s));
            let duration_s = to_s - from_s;
            // Height over the chord in the middle of the flight: g T² / 8.
            let middle = motion.centre_of_mass((from_s + to_s) / 2.0).at.y;
            let rise_m = middle - (from.at.y + to.at.y) / 2.0;
            worst = worst.max((rise_m / (9.81 * duration_s * duration_s / 8.0) - 1.0).abs());
        }
    }
    assert!(worst < 0.02, "{worst}");
}

#[test]
fn a_figure_crouches_before_it_leaps() {
    let track = Track::from_json(
        r#"{"schema": 1, "model": "human", "prints": [
        {"foot": "L", "at_m": [0, -0.08], "heading_deg": 0, "timing": {"stance_time_s": 0.9, "step_time_s": 0}},
        {"foot": "R", "at_m": [0, 0.08], "heading_deg": 0, "timing": {"stance_time_s": 0.9, "step_time_s": 1.3}},
        {"foot": "L", "at_m": [1.2, -0.08], "heading_deg": 0, "timing": {"stance_time_s": 1.0, "step_time_s": 0}},
        {"foot": "R", "at_m": [1.2, 0.08], "heading_deg": 0, "timing": {"stance_time_s": 1.0, "step_time_s": 1.0}}]}"#,
    )
    .unwrap();
    let motion = Motion::solve(&track, &Character::named("human").unwrap(), Method::Gradient).unwrap();
    let height = |time_s: f64| motion.centre_of_mass(time_s).at.y;
    let lowest = (0..90).map(|i| height(0.01 * f64::from(i))).fold(f64::INFINITY, f64::min);
    let landing = (0..60).map(|i| height(1.3 + 0.01 * f64::from(i))).fold(f64::INFINITY, f64::min);
    let (start, end) = (height(0.0), height(motion.duration_s()));
    assert!(start - lowest > 0.03, "crouches by {:.3} m", start - lowest);
    assert!(end - landing > 0.02, "gives by {:.3} m where it lands", end - landing);
}

#[test]
fn the_gradient_solver_beats_the_greedy_search_and_both_repeat_themselves() {
    for seed in 0..24 {
        let problem = problem(seed);
        let [gradient, greedy] = [Method::Gradient, Method::Greedy].map(|method| solve(&problem, method));
        assert!(gradient.energy.total() <= greedy.energy.total(), "track {seed}");
        assert_eq!(gradient, solve(&problem, Method::Gradient));
        assert_eq!(greedy, solve(&problem, Method::Greedy));
    }
}

#[test]
fn the_pendulum_is_quadratic() {
    let mut random = Random::new(6);
    for seed in 0..8 {
        let problem = problem(seed);
        let knots = shaken(&problem, &mut random);
        for curve in 0..problem.curves() {
            let at = |ends: [Knot; 2]| problem.bend_pendulum(curve, [&ends[0], &ends[1]]);
            let ends = [knots[curve], knots[curve + 1]];
            let here = at(ends);
            for side in 0..2 {
                for i in 0..KNOT_SIZE {
                    let mut moved = ends;
                    *element(&mut moved[side], i) += 1.0;
                    let there = at(moved);
                    for other in side..2 {
                        for j in 0..KNOT_SIZE {
                            let mut change = there.gradient[other];
                            let mut before = here.gradient[other];
                            let found = *element(&mut change, j) - *element(&mut before, j);
                            let bent = here.blocks[side + other][i][j];
                            assert!(
                                (found - bent).abs() <= 1e-6 * (1.0 + bent.abs()),
                                "track {seed}, curve {curve}"
                            );
                        }
                    }
                }
            }
        }
    }
}
