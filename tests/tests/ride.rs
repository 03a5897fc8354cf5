//! The horse in real time: hooves that never slide, any change at any moment, and what real horses do, on a sample of the big run
//! (`cargo run --release -p muybridge-tests --bin ride-trials`).

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};

use muybridge_core::{Database, Gait, MPS_PER_MPH, Repertoire, Skeleton, TURN_STEP_RAD, Turn};
use muybridge_fitting::ride_checks::changes::{
    ChangeTable, GAITS, Interrupted, SteadyGait, measure_interrupted, usual_mph,
};
use muybridge_fitting::ride_checks::situations::SituationTable;
use muybridge_fitting::ride_checks::speeds::{heading_row, speed_row};
use muybridge_fitting::ride_checks::steady_strides::{SteadyStrides, gaits_and_speeds};
use muybridge_fitting::ride_checks::trials::Summary;
use muybridge_fitting::ride_checks::{builds, hostile};

/// Mean speed over whole strides is the commanded one to this share.
const SPEED_SHARE: f64 = 0.005;
/// The heading is the commanded one to this, degrees.
const HEADING_DEG: f64 = 1.0;
/// Start phases of each pair of gaits here; the big run takes 40.
const PHASES: usize = 10;
/// Rides here; the big run takes 10,000.
const RIDES: u64 = 48;
/// Longest list of faults that is printed.
const MOST_LINES: usize = 40;

fn database() -> &'static Database {
    static DATABASE: OnceLock<Database> = OnceLock::new();
    DATABASE.get_or_init(Database::embedded)
}

fn reference() -> &'static Arc<Repertoire> {
    static REFERENCE: OnceLock<Arc<Repertoire>> = OnceLock::new();
    REFERENCE.get_or_init(|| Arc::new(Repertoire::new(database(), &Skeleton::reference()).unwrap()))
}

fn assert_none(faults: &[String]) {
    let shown = faults.iter().take(MOST_LINES).cloned().collect::<Vec<_>>().join("\n");
    assert!(faults.is_empty(), "{} faults:\n{shown}", faults.len());
}

#[test]
fn synthesised_strides_do_what_horses_do() {
    let strides = SteadyStrides::ride(reference(), database(), 0.5);
    println!(
        "{} steady strides, at most {:.1e} rad out of their planes",
        strides.database.strides.len(),
        strides.sideways_rad
    );
    let deviations = strides.deviations().iter().map(ToString::to_string).collect::<Vec<_>>();
    let stale = strides.stale();
    assert!(stale.is_empty(), "these occur no more, take them off the list: {stale:#?}");
    assert_none(&[strides.faults, deviations].concat());
}

#[test]
fn the_horse_goes_as_fast_as_it_is_told() {
    let automatic = (1..=40).map(|mph| (None, f64::from(mph)));
    let explicit = gaits_and_speeds(1.0).map(|(gait, mph)| (Some(gait), mph));
    let mut faults = Vec::new();
    println!("asked    mph  gait     error %");
    for (asked, mph) in automatic.chain(explicit) {
        match speed_row(reference(), asked, mph) {
            Ok(row) => {
                let name = asked.map_or("-", Gait::name);
                println!("{name:<7} {mph:4.0}  {:<7} {:8.3}", row.gait, 100.0 * row.error);
                if row.error.abs() > SPEED_SHARE {
                    faults.push(format!(
                        "{name} at {mph} mph ({}): {:.2} % off",
                        row.gait,
                        100.0 * row.error
                    ));
                }
            }
            Err(fault) => faults.push(fault),
        }
    }
    assert_none(&faults);
}

#[test]
fn the_horse_goes_where_it_is_told() {
    let mut faults = Vec::new();
    println!("gait     wanted  stated off  moved off, degrees");
    for gait in GAITS {
        for (turn, wanted_rad) in [
            (Turn::Steps(1), f64::from(TURN_STEP_RAD)),
            (Turn::Heading(-PI as f32 / 12.0), -PI / 12.0),
            (Turn::Heading(PI as f32 / 2.0), PI / 2.0),
            (Turn::Steps(-6), -PI / 2.0),
            (Turn::Heading(PI as f32), PI),
        ] {
            match heading_row(reference(), gait, usual_mph(gait) * MPS_PER_MPH, turn, wanted_rad) {
                Ok(row) => {
                    let errors = [row.stated_error_rad, row.moved_error_rad].map(f64::to_degrees);
                    let line = format!(
                        "{gait:<7} {:7.0} {:11.3} {:10.3}",
                        wanted_rad.to_degrees(),
                        errors[0],
                        errors[1]
                    );
                    println!("{line}");
                    if errors.iter().any(|error| error.abs() > HEADING_DEG) {
                        faults.push(line);
                    }
                }
                Err(fault) => faults.push(fault),
            }
        }
    }
    assert_none(&faults);
}

#[test]
fn every_change_of_gait_arrives_without_a_slide() {
    let table = ChangeTable::measure(reference(), PHASES);
    println!("{table}");
    assert_none(&table.all_faults());
}

#[test]
fn a_change_may_begin_during_a_change() {
    let gaits: Vec<SteadyGait> =
        GAITS.iter().map(|gait| SteadyGait::ride(reference(), *gait).unwrap()).collect();
    let mut faults = Vec::new();
    let mut cases = 0;
    for (i, from) in gaits.iter().enumerate() {
        for (j, by) in gaits.iter().enumerate().filter(|(j, _)| *j != i) {
            // One third gait for each pair, so that all 30 last changes occur.
            let (k, share) = ((j + 1 + (i + j) % 5) % 6, 0.15 + 0.1 * (cases % 8) as f32);
            let case = Interrupted { from, by, to: &gaits[k], share };
            match measure_interrupted(case, 0.1 * f64::from(cases % 10)) {
                Ok(measured) => faults.extend(measured.faults().into_iter().map(|fault| {
                    format!("{} by {} ({share:.2}) to {}: {}", from.gait, by.gait, gaits[k].gait, fault.text)
                })),
                Err(fault) => faults.push(fault),
            }
            cases += 1;
        }
    }
    assert_none(&faults);
}

#[test]
fn rides_of_a_minute_break_no_limit() {
    let builds = builds::repertoires(database()).unwrap();
    let summary = Summary::ride(0..RIDES, &builds);
    println!("{summary}");
    let faults: Vec<String> =
        summary.broken.iter().map(|(seed, broken)| format!("seed {seed}: {broken}")).collect();
    assert_none(&faults);
}

#[test]
fn single_things_break_no_limit_on_any_build() {
    let table = SituationTable::ride(&builds::repertoires(database()).unwrap());
    println!("{table}");
    assert_none(&table.faults());
}

#[test]
fn hostile_inputs_leave_a_horse_that_is_itself_again() {
    let faults: Vec<String> =
        hostile::all().into_iter().filter_map(|input| input.ride(reference()).err()).collect();
    assert_none(&faults);
}
