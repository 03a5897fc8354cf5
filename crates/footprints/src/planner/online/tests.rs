//! Tests of the planner: what was executed stays, whatever comes.

use std::time::Instant;

use super::*;
use crate::knots::Knot;
use crate::planner::{Meadow, Wanderer};
use crate::solve::{Method, solve};
use crate::timing::StepTiming;
use crate::track::Track;

fn planner(name: &str) -> Planner {
    Planner::new(Model::named(name).unwrap(), Terrain::Flat, Weights::default()).unwrap()
}

/// Prints of someone wandering among trees.
fn wandering(name: &str, seed: u64, count: usize) -> Vec<Print> {
    let model = Model::named(name).unwrap();
    let meadow = Meadow::planted(30.0 * model.step_m[0], 12, 4.0 * model.step_m[0], seed).unwrap();
    Wanderer::new(meadow, &model, seed).unwrap().take(count).collect()
}

/// Prints straight ahead, so far from one another.
fn ahead_by(lengths_m: &[f64], width_m: f64) -> Vec<Print> {
    let mut x_m = 0.0;
    let print = |(i, length_m): (usize, &f64)| {
        x_m += length_m;
        let (foot, side) = if i % 2 == 0 { (Foot::Left, -0.5) } else { (Foot::Right, 0.5) };
        Print { foot, at_m: [x_m, side * width_m], heading_deg: 0.0, timing: None }
    };
    lengths_m.iter().enumerate().map(print).collect()
}

#[test]
fn what_was_executed_never_changes() {
    for name in ["bird", "human", "dinosaur"] {
        let mut planner = planner(name);
        let mut curve: Vec<(f64, Knot)> = Vec::new();
        let mut poses: Vec<(f64, BipedPose)> = Vec::new();
        let mut posed_s = 0.0;
        for (i, print) in wandering(name, 4, 60).into_iter().enumerate() {
            planner.push(print).unwrap();
            let knots =
                planner.trajectory().times_s.iter().copied().zip(planner.trajectory().knots.iter().copied());
            let knots: Vec<(f64, Knot)> = knots.collect();
            assert_eq!(knots[..curve.len()], curve, "{name}, print {i}");
            curve = knots;
            let Some(final_s) = planner.final_s() else { continue };
            while posed_s <= final_s {
                poses.push((posed_s, planner.pose(posed_s).unwrap()));
                posed_s += 0.017;
            }
        }
        for (time_s, pose) in &poses {
            assert_eq!(planner.pose(*time_s).as_ref(), Some(pose), "{name} at {time_s} s");
        }
        assert!(poses.len() > 500, "{name}: {}", poses.len());
    }
}

#[test]
fn each_print_from_the_third_on_executes_the_step_before() {
    let mut planner = planner("bird");
    for (n, print) in wandering("bird", 1, 30).into_iter().enumerate() {
        planner.push(print).unwrap();
        if n < 2 {
            assert!(planner.final_s().is_none() && planner.pose(0.0).is_none());
            continue;
        }
        let executed_s = planner.trajectory().times_s.last().copied().unwrap();
        assert_eq!(executed_s, planner.placed().prints[n - 1].strike_s);
        assert_eq!(planner.final_s(), Some(executed_s), "walking, poses are final as far as the curve");
    }
}

#[test]
fn the_curve_and_the_body_go_on_without_a_jump() {
    for name in ["bird", "human", "dinosaur"] {
        let mut planner = planner(name);
        for print in wandering(name, 2, 200) {
            planner.push(print).unwrap();
        }
        let curve = planner.trajectory();
        for time_s in &curve.times_s[1..curve.times_s.len() - 1] {
            let [before, after] = [-1e-12, 1e-12].map(|by_s| curve.at(time_s + by_s));
            assert!(before.at.distance(after.at) < 1e-9 && before.velocity.distance(after.velocity) < 1e-9);
        }
        let final_s = planner.final_s().unwrap();
        let mut last = planner.pose(0.0).unwrap().world_from_body;
        for frame in 1..=(final_s * 60.0) as usize {
            let turned = planner.pose(frame as f64 / 60.0).unwrap().world_from_body;
            let turn_deg = turned.angle_between(last).to_degrees();
            assert!(turn_deg < 4.0, "{name} turns by {turn_deg} degrees in a frame at {frame}");
            last = turned;
        }
    }
}

/// The same prints as a track, with all of them known.
fn track(name: &str, prints: &[Print]) -> Track {
    Track { prints: prints.to_vec(), ..Track::new(name) }
}

#[test]
fn times_and_orientation_are_nearly_those_of_the_whole_track() {
    for name in ["bird", "human", "dinosaur"] {
        let prints = wandering(name, 3, 80);
        let mut planner = planner(name);
        for print in &prints {
            planner.push(*print).unwrap();
        }
        let model = Model::named(name).unwrap();
        let whole = track(name, &prints).place(&model.timing).unwrap();
        let known = prints.len() - 2;
        for (print, of_whole) in planner.placed().prints[..known].iter().zip(&whole.prints) {
            assert!((print.strike_s - of_whole.strike_s).abs() < 1e-9);
            assert!((print.lift_off_s - of_whole.lift_off_s).abs() < 1e-9);
            assert_eq!(print.world_from_foot, of_whole.world_from_foot);
        }
        let Model { body_window_s, pitch, roll, .. } = model;
        let orientation = Orientation::plan(&whole.prints, whole.end_s, body_window_s, pitch, roll);
        let final_s = planner.final_s().unwrap();
        let mut worst_deg: f64 = 0.0;
        for frame in 0..(final_s * 60.0) as usize {
            let time_s = frame as f64 / 60.0;
            let turned = planner.pose(time_s).unwrap().world_from_body;
            worst_deg = worst_deg.max(turned.angle_between(orientation.at(time_s)).to_degrees());
        }
        assert!(worst_deg < 0.01, "{name}: {worst_deg}");
    }
}

/// Energy of the executed curve over what the whole track's solution needs for the same steps.
#[test]
fn planning_a_step_at_a_time_costs_little() {
    for name in ["bird", "human", "dinosaur"] {
        let prints = wandering(name, 5, 60);
        let mut planner = planner(name);
        for print in &prints {
            planner.push(*print).unwrap();
        }
        let model = Model::named(name).unwrap();
        let whole = track(name, &prints).place(&model.timing).unwrap();
        let Model { body_window_s, pitch, roll, .. } = model;
        let orientation = Orientation::plan(&whole.prints, whole.end_s, body_window_s, pitch, roll);
        let problem = Problem::new(&stances(&model, &whole), whole.end_s, &orientation, Weights::default());
        let solved = solve(&problem, Method::Gradient);
        let executed_s = planner.trajectory().times_s.last().copied().unwrap();
        // The planner's curve as far as it goes, and then the whole track's.
        let knots: Vec<Knot> = problem
            .times_s()
            .iter()
            .zip(&solved.trajectory.knots)
            .map(|(time_s, knot)| {
                let at = planner.trajectory().at(*time_s);
                if *time_s <= executed_s + 1e-9 { Knot { at: at.at, velocity: at.velocity } } else { *knot }
            })
            .collect();
        let (planned, best) = (problem.energy(&knots), solved.energy);
        assert!(planned.total() < 1.4 * best.total(), "{name}: {planned:?}, whole track {best:?}");
    }
}

#[test]
fn a_leap_is_crouched_for_before_it_comes() {
    let model = Model::named("bird").unwrap();
    let [step_m, width_m] = model.step_m;
    let leap_m = model.timing.step_times.last().unwrap()[0];
    let lowest_before = |length_m: f64| {
        let mut planner = planner("bird");
        let mut lengths_m = vec![step_m; 12];
        (lengths_m[0], lengths_m[1]) = (0.0, 0.0);
        lengths_m[8] = length_m;
        for print in ahead_by(&lengths_m, width_m) {
            planner.push(print).unwrap();
        }
        let prints = &planner.placed().prints;
        let [from_s, to_s] = [prints[6].strike_s, prints[7].lift_off_s];
        let at = |i: i32| planner.trajectory().at(from_s + (to_s - from_s) * f64::from(i) / 50.0).at.y;
        (0..=50).map(at).fold(f64::INFINITY, f64::min)
    };
    let crouch_m = lowest_before(step_m) - lowest_before(leap_m);
    assert!(crouch_m > 0.02 * model.leg.nominal_m, "{crouch_m}");
}

#[test]
fn a_step_costs_the_same_however_far_it_has_come() {
    let mut planner = planner("bird");
    let mut times_s = Vec::new();
    for print in wandering("bird", 6, 10_000) {
        let start = Instant::now();
        planner.push(print).unwrap();
        times_s.push(start.elapsed().as_secs_f64());
    }
    let median = |times_s: &[f64]| {
        let mut times_s = times_s.to_vec();
        times_s.sort_by(f64::total_cmp);
        times_s[times_s.len() / 2]
    };
    let [first_s, last_s] = [median(&times_s[..1000]), median(&times_s[9000..])];
    assert!(last_s < 3.0 * first_s + 1e-4, "{first_s} s at first, {last_s} s after 9000");
}

#[test]
fn runs_are_final_up_to_where_the_next_flight_begins() {
    let model = Model::named("human").unwrap();
    let leap_m = 0.9 * model.timing.step_times.last().unwrap()[0];
    let mut lengths_m = vec![leap_m; 20];
    (lengths_m[0], lengths_m[1]) = (0.0, 0.0);
    let mut planner = planner("human");
    let (mut last_s, mut executed_s) = (0.0, 0.0);
    for (n, print) in ahead_by(&lengths_m, model.step_m[1]).into_iter().enumerate() {
        planner.push(print).unwrap();
        let Some(final_s) = planner.final_s() else { continue };
        executed_s = *planner.trajectory().times_s.last().unwrap();
        assert!(final_s > last_s && final_s <= executed_s, "print {n}");
        last_s = final_s;
    }
    assert!(last_s < executed_s, "a foot in flight swings to a print whose hip is not known yet");
}

/// In a run a foot is lifted before the body's window ends, and swings to a print that has not come: the body turns as if it came where
/// it is imagined, and makes the difference good without a jump.
#[test]
fn a_run_that_turns_suddenly_turns_smoothly() {
    let model = Model::named("human").unwrap();
    let (mut planner, mut at, mut heading_rad) = (planner("human"), DVec2::ZERO, 0.0);
    for i in 0..60_usize {
        heading_rad += if i % 10 == 5 { 0.6 } else { 0.0 };
        at += 2.0 * model.step_m[0] * ahead(heading_rad);
        let print = Print {
            foot: Foot::BIPED[i % 2],
            at_m: at.to_array(),
            heading_deg: heading_rad.to_degrees(),
            timing: None,
        };
        planner.push(print).unwrap();
    }
    let frames = (planner.final_s().unwrap() * 60.0) as usize;
    let turned = |frame: usize| planner.pose(frame as f64 / 60.0).unwrap().world_from_body;
    for frame in 1..frames {
        let turn_deg = turned(frame).angle_between(turned(frame - 1)).to_degrees();
        assert!(turn_deg < 3.0, "{turn_deg} degrees in frame {frame}");
    }
}

#[test]
fn prints_that_cannot_be_are_refused_and_change_nothing() {
    let good = wandering("bird", 7, 10);
    let mut planner = planner("bird");
    for print in &good[..6] {
        planner.push(*print).unwrap();
    }
    let (knots, placed) = (planner.trajectory().clone(), planner.placed().clone());
    let timing = |stance_time_s: f64, step_time_s: f64| Some(StepTiming { stance_time_s, step_time_s });
    for bad in [
        Print { at_m: [f64::NAN, 0.0], ..good[6] },
        Print { at_m: [0.0, 1e9], ..good[6] },
        Print { heading_deg: f64::INFINITY, ..good[6] },
        Print { foot: good[5].foot, ..good[6] },
        Print { foot: Foot::LeftHind, ..good[6] },
        Print { timing: timing(-1.0, 0.5), ..good[6] },
        Print { timing: timing(0.5, f64::NAN), ..good[6] },
    ] {
        let error = planner.push(bad).unwrap_err();
        assert!(matches!(error, PlannerError::Print { number: 7, .. }), "{error}");
        assert_eq!((planner.trajectory(), planner.placed()), (&knots, &placed));
    }
    planner.push(Print { timing: timing(30.0, 0.3), ..good[6] }).unwrap();
    planner.push(good[7]).unwrap();
    let error = planner.push(good[8]).unwrap_err();
    assert!(error.to_string().contains("print 7"), "{error}");
    let weights = Weights { physics: f64::NAN, ..Weights::default() };
    assert!(Planner::new(Model::named("bird").unwrap(), Terrain::Flat, weights).is_err());
}

#[test]
fn prints_far_apart_in_place_or_near_in_time_are_walked_somehow() {
    let timing = |step_time_s: f64| Some(StepTiming { stance_time_s: 0.01, step_time_s });
    let mut planner = planner("bird");
    for (i, print) in ahead_by(&[50.0; 200], 0.2).into_iter().enumerate() {
        let timing = if i % 3 == 0 { timing([0.01, 0.015, 0.0, 600.0][i / 3 % 4]) } else { None };
        // Where the times are too short for a foot to fall again, the print is refused; and that is all.
        let _ = planner.push(Print { timing, ..print });
    }
    let final_s = planner.final_s().unwrap();
    for i in 0..100 {
        let pose = planner.pose(final_s * f64::from(i) / 99.0).unwrap();
        assert!(pose.centre_of_mass.is_finite());
    }
}
