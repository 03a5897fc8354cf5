//! The big run: thousands of rides of a minute, every change of gait from every phase, every speed, hostile inputs; exits with 1 when a
//! limit is broken.

use std::ops::Range;
use std::process::ExitCode;
use std::sync::Arc;
use std::thread;

use muybridge_core::{Database, Repertoire, Skeleton};
use muybridge_fitting::ride_checks::builds;
use muybridge_fitting::ride_checks::changes::{
    ACCELERATION_RATIO, CONVERGENCE, ChangeTable, DURATION_STRIDES, START_PHASES,
};
use muybridge_fitting::ride_checks::hostile;
use muybridge_fitting::ride_checks::situations::SituationTable;
use muybridge_fitting::ride_checks::steady_strides::SteadyStrides;
use muybridge_fitting::ride_checks::trials::{RIDE_S, Summary, Trial};

const USAGE: &str = "usage: ride-trials [--sequences N] [--first SEED] [--only rides|changes|steady|hostile|situations] [--lines N] [--show SEED [--from S] [--to S]]";
/// Rides unless it is said otherwise.
const SEQUENCES: u64 = 10_000;
/// Threads.
const THREADS: u64 = 2;
/// Rides of one thread at a time.
const PORTION: u64 = 25;
/// Lines of broken limits that are printed unless it is said otherwise.
const MOST_LINES: usize = 60;

struct Arguments {
    seeds: Range<u64>,
    only: Option<String>,
    /// A ride to show step by step.
    show: Option<u64>,
    span_s: [f64; 2],
    /// Lines of each list of faults.
    lines: usize,
}

fn arguments() -> Option<Arguments> {
    let (mut sequences, mut first, mut only, mut show) = (SEQUENCES, 0, None, None);
    let (mut span_s, mut lines) = ([0.0, RIDE_S], MOST_LINES);
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let value = words.next()?;
        match word.as_str() {
            "--sequences" => sequences = value.parse().ok()?,
            "--first" => first = value.parse().ok()?,
            "--show" => show = Some(value.parse().ok()?),
            "--lines" => lines = value.parse().ok()?,
            "--from" => span_s[0] = value.parse().ok()?,
            "--to" => span_s[1] = value.parse().ok()?,
            "--only" if ["rides", "changes", "steady", "hostile", "situations"].contains(&value.as_str()) => {
                only = Some(value);
            }
            _ => return None,
        }
    }
    Some(Arguments { seeds: first..first + sequences, only, show, span_s, lines })
}

fn main() -> ExitCode {
    let Some(arguments) = arguments() else {
        eprintln!("{USAGE}");
        return ExitCode::from(2);
    };
    let database = Database::embedded();
    match run(&database, &arguments) {
        Ok(0) => ExitCode::SUCCESS,
        Ok(faults) => {
            println!("{faults} limits broken");
            ExitCode::from(1)
        }
        Err(fault) => {
            eprintln!("{fault}");
            ExitCode::from(1)
        }
    }
}

/// Runs what is wanted; returns the number of faults.
fn run(database: &Database, arguments: &Arguments) -> Result<usize, String> {
    if let Some(seed) = arguments.show {
        return show(database, seed, arguments.span_s).map(|()| 0);
    }
    let wanted = |name: &str| arguments.only.as_deref().is_none_or(|only| only == name);
    let reference =
        Arc::new(Repertoire::new(database, &Skeleton::reference()).map_err(|error| error.to_string())?);
    let (mut faults, lines) = (0, arguments.lines);
    if wanted("steady") {
        faults += steady(&reference, database, lines);
    }
    if wanted("changes") {
        faults += changes(&reference, lines);
    }
    if wanted("hostile") {
        faults += hostile_inputs(&reference, lines);
    }
    let builds = builds::repertoires(database).map_err(|error| error.to_string())?;
    if wanted("situations") {
        let table = SituationTable::ride(&builds);
        println!("{table}");
        faults += told("situations", &table.faults(), lines);
    }
    if wanted("rides") {
        faults += rides(&builds, &arguments.seeds, lines);
    }
    Ok(faults)
}

/// Prints a list of faults, shortened; returns how many there are.
fn told(what: &str, faults: &[String], lines: usize) -> usize {
    println!("{what}: {} faults", faults.len());
    faults.iter().take(lines).for_each(|fault| println!("  {fault}"));
    faults.len()
}

fn steady(repertoire: &Arc<Repertoire>, database: &Database, lines: usize) -> usize {
    let strides = SteadyStrides::ride(repertoire, database, 0.5);
    let deviations: Vec<String> = strides.deviations().iter().map(ToString::to_string).collect();
    let faults = [strides.faults.clone(), deviations].concat();
    println!(
        "{} steady strides, at most {:.1e} rad out of their planes",
        strides.database.strides.len(),
        strides.sideways_rad
    );
    told("steady gaits at every half mile per hour", &faults, lines)
}

fn changes(repertoire: &Arc<Repertoire>, lines: usize) -> usize {
    let table = ChangeTable::measure(repertoire, START_PHASES);
    println!("{table}");
    println!(
        "limits: {} to {} strides, legs within {CONVERGENCE:.0e} of a stride, acceleration {ACCELERATION_RATIO} x steady, slide 0.1 mm",
        DURATION_STRIDES[0], DURATION_STRIDES[1]
    );
    told("changes of gait", &table.all_faults(), lines)
}

fn hostile_inputs(repertoire: &Arc<Repertoire>, lines: usize) -> usize {
    let faults: Vec<String> =
        hostile::all().into_iter().filter_map(|input| input.ride(repertoire).err()).collect();
    told("hostile inputs", &faults, lines)
}

/// Rides on all threads, in portions, so that the summary does not depend on which thread rode which.
fn rides(builds: &[Arc<Repertoire>], seeds: &Range<u64>, lines: usize) -> usize {
    let mut summary = Summary::default();
    let next = std::sync::atomic::AtomicU64::new(seeds.start);
    let parts: Vec<Summary> = thread::scope(|scope| {
        let workers: Vec<_> =
            (0..THREADS).map(|_| scope.spawn(|| worker(builds, seeds.end, &next))).collect();
        workers.into_iter().filter_map(|worker| worker.join().ok()).collect()
    });
    if parts.len() < THREADS as usize {
        println!("a ride panicked");
        return 1;
    }
    parts.into_iter().for_each(|part| summary.merge(part));
    println!("{summary}");
    let rows: Vec<String> =
        summary.broken.iter().map(|(seed, broken)| format!("seed {seed}: {broken}")).collect();
    told("rides that broke a limit", &rows, lines)
}

fn worker(builds: &[Arc<Repertoire>], end: u64, next: &std::sync::atomic::AtomicU64) -> Summary {
    let mut summary = Summary::default();
    loop {
        let start = next.fetch_add(PORTION, std::sync::atomic::Ordering::Relaxed);
        if start >= end {
            return summary;
        }
        summary.merge(Summary::ride(start..end.min(start + PORTION), builds));
    }
}

/// Prints every step of one ride in a span of time.
fn show(database: &Database, seed: u64, span_s: [f64; 2]) -> Result<(), String> {
    let builds = builds::repertoires(database).map_err(|error| error.to_string())?;
    let trial = Trial::of(seed, builds.len());
    println!("{trial:?}, {}", builds[trial.build].skeleton().name);
    println!(
        "     s  step  asked                      gait     change          m/s   rate   turn  down  cycles                 lowered root            new worst"
    );
    trial.ride_seeing(&builds[trial.build], |seen| {
        if (span_s[0]..=span_s[1]).contains(&seen.time_s) {
            println!("{seen}");
        }
    });
    Ok(())
}
