//! The motion that is compiled in: no stride does what a horse does not, but for what the photographs themselves show.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use muybridge_core::{Database, Gait, Provenance, Skeleton};
use muybridge_fitting::database_checks::{
    FootErrors, KNOWN_DEVIATIONS, check_database, stale, unexplained, worst_foot_errors,
};

/// Worst errors of standing feet, gait by gait, captures and made strides apart.
fn foot_table(database: &Database, reference: &Skeleton) -> String {
    let mut table = String::from("gait    kind      strides  slide mm  sink mm  float mm  print mm\n");
    for gait in Gait::ALL {
        for captured in [true, false] {
            let is_captured = |provenance: &Provenance| matches!(provenance, Provenance::Captured { .. });
            let of_kind = database.strides_of(gait).filter(|s| is_captured(&s.provenance) == captured);
            let errors: Vec<FootErrors> =
                of_kind.map(|stride| worst_foot_errors(stride, reference)).collect();
            let worst = errors.iter().copied().fold(FootErrors::default(), FootErrors::worst);
            if !errors.is_empty() {
                let [slide, sink, float, print] =
                    [worst.slide_m, worst.sink_m, worst.float_m, worst.print_m].map(|m| 1e3 * m);
                let (kind, n) = (if captured { "captured" } else { "made" }, errors.len());
                table += &format!(
                    "{:<7} {kind:<9} {n:7} {slide:9.1} {sink:8.1} {float:9.1} {print:9.1}\n",
                    gait.name()
                );
            }
        }
    }
    table
}

#[test]
fn every_stride_does_what_a_horse_does() {
    let (database, reference) = (Database::embedded(), Skeleton::reference());
    println!("{}", foot_table(&database, &reference));
    let found = unexplained(&check_database(&database, &reference), KNOWN_DEVIATIONS);
    let lines: Vec<String> = found.iter().map(ToString::to_string).collect();
    assert!(lines.is_empty(), "{} deviations:\n{}", lines.len(), lines.join("\n"));
}

#[test]
fn every_known_deviation_still_occurs() {
    let found = check_database(&Database::embedded(), &Skeleton::reference());
    let gone = stale(&found, KNOWN_DEVIATIONS);
    assert!(gone.is_empty(), "these occur no more, take them off the list: {gone:#?}");
}

#[test]
fn the_derived_amble_stands_on_one_and_two_feet_in_turn_at_every_speed() {
    let database = Database::embedded();
    let ambles: Vec<_> = database.strides_of(Gait::Amble).collect();
    assert!(!ambles.is_empty());
    for amble in ambles {
        let feet = |k: u16| amble.support(f32::from(k) / 1000.0).iter().filter(|down| **down).count();
        let ones = (0..1000).filter(|k| feet(*k) == 1).count();
        let twos = (0..1000).filter(|k| feet(*k) == 2).count();
        assert!(ones > 50 && twos > 50 && ones + twos == 1000, "{}: {ones} and {twos} of 1000", amble.id);
    }
}
