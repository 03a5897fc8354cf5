//! Times of the stride fit against its requirements and against scipy's least squares on the same problem.
//!
//! `cargo bench -p muybridge-fitting --bench stride_fit`

use std::cell::Cell;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use muybridge_capture::write_json;
use muybridge_core::Skeleton;
use muybridge_fitting::export_problem::ExportedProblem;
use muybridge_fitting::gait_laws::Evidence;
use muybridge_fitting::levenberg::{Curvature, LeastSquares, Linearization, Optimum, solve};
use muybridge_fitting::motion_database::build_database;
use muybridge_fitting::observation::StrideObservation;
use muybridge_fitting::pipeline::fit_plate;
use muybridge_fitting::problem::StrideProblem;
use muybridge_fitting::stride_fit::solve_from_afar;
use muybridge_fitting::synthetic::{Placing, SyntheticStride};
use muybridge_fitting::weights::Weights;

const PANELS: usize = 24;
/// Runs of which the median is taken.
const RUNS: usize = 15;
const PLATE_RUNS: usize = 5;
/// A run counts as arrived within this share of the optimum's cost, the same for both sides of the comparison.
const NEAR: f64 = 1e-6;
/// Requirements: one stride, a whole plate, peak memory, and how many times faster than scipy.
const STRIDE_LIMIT_S: f64 = 0.060;
const PLATE_LIMIT_S: f64 = 2.0;
const MEMORY_LIMIT_MB: f64 = 300.0;
const LEAST_RATIO: f64 = 10.0;

fn main() -> Result<(), Box<dyn Error>> {
    let stride = SyntheticStride::new(0, PANELS);
    let observation = stride.observe(&Placing::default(), &Weights::default());
    let (cold_s, problem, optimum) = time_cold_start(&stride, &observation);
    let (unknowns, residuals) = (optimum.x.len(), problem.residual_count());
    println!("{PANELS}-panel stride: {unknowns} unknowns, {residuals} residuals, {} steps", optimum.steps);
    requirement("one stride from the rest pose", 1e3 * cold_s, 1e3 * STRIDE_LIMIT_S, "ms");
    requirement("annotated plate with motion database", time_plate()?, PLATE_LIMIT_S, "s");
    match peak_memory_mb() {
        Some(peak_mb) => requirement("peak memory", peak_mb, MEMORY_LIMIT_MB, "MB"),
        None => println!("peak memory: not told by this system"),
    }
    compare_with_scipy(&problem, &observation)
}

fn requirement(what: &str, value: f64, limit: f64, unit: &str) {
    let verdict = if value <= limit { "met" } else { "MISSED" };
    println!("{what}: {value:.3} {unit} (at most {limit} {unit}: {verdict})");
}

fn median(mut seconds: Vec<f64>) -> f64 {
    seconds.sort_by(f64::total_cmp);
    seconds[seconds.len() / 2]
}

/// Median time of setting up and solving a stride from the rest pose, s, with the problem and its optimum.
fn time_cold_start(
    stride: &SyntheticStride,
    observation: &StrideObservation,
) -> (f64, StrideProblem, Optimum) {
    let (skeleton, weights) = (Skeleton::reference(), Weights::default());
    let run = || {
        let start = Instant::now();
        let problem = StrideProblem::new(&skeleton, observation, stride.stride_time_s, &weights);
        let optimum = solve_from_afar(&problem, problem.rest_start(observation));
        (start.elapsed().as_secs_f64(), problem, optimum)
    };
    let (_, problem, optimum) = run();
    (median((0..RUNS).map(|_| run().0).collect()), problem, optimum)
}

/// Median time from an annotated plate to the motion database, s.
fn time_plate() -> Result<f64, Box<dyn Error>> {
    let annotation = root().join("annotations/sallie-gardner-1878.json");
    let (skeleton, weights) = (Skeleton::reference(), Weights::default());
    let mut seconds = Vec::new();
    for _ in 0..PLATE_RUNS {
        let start = Instant::now();
        let fitted = fit_plate(&annotation, &skeleton, &weights)?;
        std::hint::black_box(build_database(
            &Evidence { fits: std::slice::from_ref(&fitted), ..Evidence::default() },
            &skeleton,
        ));
        seconds.push(start.elapsed().as_secs_f64());
    }
    Ok(median(seconds))
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Peak resident memory of this process so far, MB, where the system tells it.
fn peak_memory_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.split_whitespace().next()?.parse().ok()?;
    Some(kilobytes / 1024.0)
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

fn compare_with_scipy(
    problem: &StrideProblem,
    observation: &StrideObservation,
) -> Result<(), Box<dyn Error>> {
    match scipy_version() {
        Ok(versions) => println!("python, numpy, scipy {versions}"),
        Err(cause) => {
            println!("comparison with scipy skipped: {cause}");
            return Ok(());
        }
    }
    let start = problem.rest_start(observation);
    let unbounded = vec![[f64::NEG_INFINITY, f64::INFINITY]; start.len()];
    println!("{:<34} {:>9} {:>12} {:>9} {:>7}  note", "case", "seconds", "cost", "distance", "ratio");
    for (name, bounds) in [("free", unbounded), ("bounded", problem.bounds().to_vec())] {
        let cost = watched_solve(problem, &bounds, &start, 0.0).cost;
        let runs: Vec<Timed> = (0..RUNS).map(|_| watched_solve(problem, &bounds, &start, cost)).collect();
        let near_s = median(runs.iter().map(|run| run.near_s).collect());
        let whole_s = median(runs.iter().map(|run| run.whole_s).collect());
        let note = format!("{whole_s:.4} s until it stops by itself");
        println!(
            "{:<34} {near_s:>9.4} {:>12.6} {:>9} {:>7}  {note}",
            format!("{name}, this solver"),
            cost,
            "",
            1
        );
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("stride-{name}.json"));
        write_json(&file, &ExportedProblem::new(problem, name == "bounded", &start, cost))?;
        run_scipy(&file, name, near_s)?;
    }
    Ok(())
}

/// A solution's cost, and the times until the cost is within [`NEAR`] of the optimum and until the solver stops, s.
struct Timed {
    cost: f64,
    near_s: f64,
    whole_s: f64,
}

fn watched_solve(problem: &StrideProblem, bounds: &[[f64; 2]], start: &[f64], optimum_cost: f64) -> Timed {
    let near_s = Cell::new(f64::NAN);
    let clock = Instant::now();
    let near_cost = optimum_cost * (1.0 + NEAR);
    let optimum = solve(Watched { problem, bounds, near_cost, clock, near_s: &near_s }, start.to_vec());
    Timed { cost: optimum.cost, near_s: near_s.get(), whole_s: clock.elapsed().as_secs_f64() }
}

fn run_scipy(file: &Path, name: &str, own_s: f64) -> Result<(), Box<dyn Error>> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/scipy_reference.py");
    let output = Command::new("python3").arg(script).arg(file).env("OMP_NUM_THREADS", "1").output()?;
    if !output.status.success() {
        return Err(String::from_utf8_lossy(&output.stderr).into());
    }
    for line in String::from_utf8_lossy(&output.stdout).lines() {
        let case: serde_json::Value = serde_json::from_str(line)?;
        let number = |key: &str| case[key].as_f64().unwrap_or(f64::NAN);
        let ratio = number("seconds") / own_s;
        let verdict = if ratio >= LEAST_RATIO { "" } else { "  under 10" };
        let case_name = format!("{name}, scipy {}", case["case"].as_str().unwrap_or("?"));
        let (seconds, cost, distance) = (number("seconds"), number("cost"), number("relative_distance"));
        let note = case["note"].as_str().unwrap_or("");
        println!(
            "{case_name:<34} {seconds:>9.4} {cost:>12.6} {distance:>9.1e} {ratio:>7.1}  {note}{verdict}"
        );
    }
    Ok(())
}

/// A problem with other bounds that notes when its cost first comes near the optimum.
struct Watched<'a> {
    problem: &'a StrideProblem,
    bounds: &'a [[f64; 2]],
    near_cost: f64,
    clock: Instant,
    near_s: &'a Cell<f64>,
}

impl LeastSquares for Watched<'_> {
    fn cost(&self, x: &[f64]) -> f64 {
        let cost = self.problem.cost(x);
        if self.near_s.get().is_nan() && cost <= self.near_cost {
            self.near_s.set(self.clock.elapsed().as_secs_f64());
        }
        cost
    }

    fn linearize(&self, x: &[f64], curvature: Curvature) -> Linearization {
        self.problem.linearize(x, curvature)
    }

    fn relinearize(&self, x: &[f64], curvature: Curvature, at: &mut Linearization) {
        self.problem.relinearize(x, curvature, at);
    }

    fn bounds(&self) -> &[[f64; 2]] {
        self.bounds
    }
}
