//! Times of motion from footprints against their requirements, the paper's greedy search and scipy's L-BFGS-B on the same energy.
//!
//! `cargo bench -p muybridge-footprints --bench footprints`

use std::error::Error;
use std::hint::black_box;
use std::path::Path;
use std::process::Command;
use std::time::Instant;

use glam::DVec3;
use muybridge_core::Random;
use muybridge_footprints::{
    Character, Foot, Knot, Meadow, Method, Model, Motion, Planner, Print, Problem, Terrain, Track, Wanderer,
    Weights, solve,
};

/// Steps of the track.
const STEPS: usize = 12;
/// Runs of which the median is taken.
const RUNS: usize = 101;
/// Runs of the greedy search, which takes longer.
const GREEDY_RUNS: usize = 11;
/// Prints that a planner is given, and those before which it is not timed.
const PLANNED: usize = 2_000;
const PLANNED_BEFORE: usize = 100;
/// Way by which a print is dragged in each frame, metres.
const DRAG_M: f64 = 0.01;
/// Requirements, ms.
const COLD_LIMIT_MS: f64 = 2.0;
const DRAG_LIMIT_MS: f64 = 0.5;
const PLANNER_LIMIT_MS: f64 = 0.5;
/// scipy counts as arrived within this share of this solver's energy.
const NEAR: f64 = 0.01;
/// Rounding of the missing force's length that scipy is helped with in one of its cases, m/s².
const STAGES: [f64; 5] = [10.0, 1.0, 0.1, 0.01, 0.001];
/// Random points at which both sides' energies and gradients are compared, and how far from the start they are.
const CHECKS: u64 = 5;
const CHECK_SPREAD: f64 = 0.2;

fn main() -> Result<(), Box<dyn Error>> {
    for name in ["bird", "dinosaur", "human"] {
        let (track, character) = (walk(name)?, Character::named(name).ok_or("no such model")?);
        let motion = Motion::solve(&track, &character, Method::Gradient)?;
        println!(
            "\n{name}, {STEPS} steps with a turn and a leap: {} unknowns",
            6 * motion.problem().times_s().len()
        );
        let cold_ms = time_ms(RUNS, || Motion::solve(&track, &character, Method::Gradient));
        requirement("from a cold start", cold_ms, COLD_LIMIT_MS);
        requirement("a dragged print, solved again", drag_ms(&motion)?, DRAG_LIMIT_MS);
        let (median_ms, late_ms) = planner_ms(name)?;
        requirement("a step of the planner", median_ms, PLANNER_LIMIT_MS);
        println!("  (99 of 100 of them within {late_ms:.3} ms)");
        compare_with_greedy(&motion);
        compare_with_scipy(name, motion.problem())?;
    }
    Ok(())
}

fn requirement(what: &str, value_ms: f64, limit_ms: f64) {
    let verdict = if value_ms <= limit_ms { "met" } else { "MISSED" };
    println!("{what}: {value_ms:.3} ms (at most {limit_ms} ms: {verdict})");
}

fn sorted(mut values: Vec<f64>) -> Vec<f64> {
    values.sort_by(f64::total_cmp);
    values
}

/// Median time of a run, ms.
fn time_ms<T>(runs: usize, mut run: impl FnMut() -> T) -> f64 {
    let time = |_| {
        let start = Instant::now();
        black_box(run());
        1e3 * start.elapsed().as_secs_f64()
    };
    sorted((0..runs).map(time).collect())[runs / 2]
}

/// Twelve steps with automatic times: a walk that turns to the left, with a leap in the middle.
fn walk(name: &str) -> Result<Track, Box<dyn Error>> {
    let model = Model::named(name).ok_or("no such model")?;
    let [step_m, width_m] = model.step_m;
    let (mut track, mut at, mut heading_deg) = (Track::new(name), [0.0, 0.0], 0.0_f64);
    for i in 0..=STEPS {
        let foot = Foot::BIPED[i % 2];
        let (sin, cos) = heading_deg.to_radians().sin_cos();
        let aside_m = width_m * (foot.index() as f64 - 0.5);
        let at_m = [at[0] + aside_m * sin, at[1] + aside_m * cos];
        track.prints.push(Print { foot, at_m, heading_deg, timing: None });
        let length_m = if i == STEPS / 2 { 2.5 * step_m } else { step_m };
        heading_deg += if (2..5).contains(&i) { 15.0 } else { 0.0 };
        let (sin, cos) = heading_deg.to_radians().sin_cos();
        at = [at[0] + length_m * cos, at[1] - length_m * sin];
    }
    Ok(track)
}

/// Median time of a frame in which one print is dragged on, ms.
fn drag_ms(motion: &Motion) -> Result<f64, Box<dyn Error>> {
    let (mut motion, mut times_ms) = (motion.clone(), Vec::new());
    for frame in 0..RUNS {
        let mut track = motion.track.clone();
        // To and fro, so that the print stays where it can be stepped on.
        let by_m = if frame / 10 % 2 == 0 { DRAG_M } else { -DRAG_M };
        track.prints[4].at_m[0] += by_m;
        let start = Instant::now();
        motion = black_box(motion.changed(&track)?);
        times_ms.push(1e3 * start.elapsed().as_secs_f64());
    }
    Ok(sorted(times_ms)[RUNS / 2])
}

/// Median time of a planner's step, and that within which 99 of 100 are, ms.
fn planner_ms(name: &str) -> Result<(f64, f64), Box<dyn Error>> {
    let model = Model::named(name).ok_or("no such model")?;
    let step_m = model.step_m[0];
    let wanderer = Wanderer::new(Meadow::planted(30.0 * step_m, 12, 4.0 * step_m, 1)?, &model, 1)?;
    let mut planner = Planner::new(model, Terrain::Flat, Weights::default())?;
    let mut times_ms = Vec::new();
    for print in wanderer.take(PLANNED) {
        let start = Instant::now();
        planner.push(print)?;
        times_ms.push(1e3 * start.elapsed().as_secs_f64());
    }
    let times_ms = sorted(times_ms.split_off(PLANNED_BEFORE));
    Ok((times_ms[times_ms.len() / 2], times_ms[times_ms.len() * 99 / 100]))
}

fn compare_with_greedy(motion: &Motion) {
    let problem = motion.problem();
    let (own, greedy) = (solve(problem, Method::Gradient), solve(problem, Method::Greedy));
    let own_ms = time_ms(RUNS, || solve(problem, Method::Gradient));
    let greedy_ms = time_ms(GREEDY_RUNS, || solve(problem, Method::Greedy));
    println!("{:<42} {:>9} {:>10} {:>8}", "solver alone", "ms", "energy", "ratio");
    println!("{:<42} {own_ms:>9.3} {:>10.4} {:>8}  {} steps", "gradient", own.energy.total(), 1, own.steps);
    let (energy, ratio) = (greedy.energy.total(), greedy_ms / own_ms);
    println!(
        "{:<42} {greedy_ms:>9.3} {energy:>10.4} {ratio:>8.1}  {} sweeps",
        "greedy (6 cm, 2 cm)", greedy.steps
    );
}

/// Whether python3 can import scipy; the error's last line if not.
fn scipy_version() -> Result<String, String> {
    let import =
        "import sys, numpy, scipy; print(sys.version.split()[0], numpy.__version__, scipy.__version__)";
    let output = Command::new("python3").args(["-c", import]).output().map_err(|error| error.to_string())?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).trim().to_string());
    }
    let errors = String::from_utf8_lossy(&output.stderr);
    Err(errors.lines().last().unwrap_or("python3 failed").to_string())
}

/// Knots as a list of numbers.
fn numbers(knots: &[Knot]) -> Vec<f64> {
    knots.iter().flat_map(|knot| [knot.at.to_array(), knot.velocity.to_array()].concat()).collect()
}

/// Energy and gradient at a random point near the start.
fn check(problem: &Problem, seed: u64) -> serde_json::Value {
    let mut random = Random::new(seed);
    let mut by = || DVec3::from_array([(); 3].map(|()| CHECK_SPREAD * random.normal()));
    let shake = |knot: Knot| Knot { at: knot.at + by(), velocity: knot.velocity + by() };
    let knots: Vec<Knot> = problem.start().into_iter().map(shake).collect();
    let (energy, gradient) = (problem.energy(&knots).total(), problem.gradient(&knots));
    serde_json::json!({ "knots": numbers(&knots), "energy": energy, "gradient": numbers(&gradient) })
}

fn compare_with_scipy(name: &str, problem: &Problem) -> Result<(), Box<dyn Error>> {
    match scipy_version() {
        Ok(versions) => println!("scipy's L-BFGS-B (python, numpy, scipy {versions})"),
        Err(cause) => {
            println!("comparison with scipy skipped: {cause}");
            return Ok(());
        }
    }
    let own_ms = time_ms(RUNS, || solve(problem, Method::Gradient));
    let mut file = serde_json::to_value(problem.exported(Foot::BIPED.len()))?;
    file["start"] = numbers(&problem.start()).into();
    file["optimum"] = solve(problem, Method::Gradient).energy.total().into();
    file["near"] = NEAR.into();
    file["stages"] = STAGES.to_vec().into();
    file["checks"] = (0..CHECKS).map(|seed| check(problem, seed)).collect();
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("footprints-{name}.json"));
    std::io::Write::write_all(&mut std::fs::File::create(&path)?, file.to_string().as_bytes())?;
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/scipy_footprints.py");
    let output = Command::new("python3").arg(script).arg(&path).env("OMP_NUM_THREADS", "1").output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    for line in String::from_utf8_lossy(&output.stdout).lines() {
        let case: serde_json::Value = serde_json::from_str(line)?;
        let number = |key: &str| case[key].as_f64().unwrap_or(f64::NAN);
        let ms = 1e3 * number("seconds");
        let how = case["case"].as_str().unwrap_or("?");
        let note = if case["near"] == true { "arrived" } else { "did not arrive" };
        let (energy, ratio, evaluations) = (number("energy"), ms / own_ms, number("evaluations"));
        println!("{how:<42} {ms:>9.3} {energy:>10.4} {ratio:>8.1}  {evaluations} evaluations, {note}");
    }
    Ok(())
}
