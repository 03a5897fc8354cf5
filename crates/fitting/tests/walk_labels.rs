//! Contacts found in tracked walks against labels that a person made by eye, from plots of the hoof tracks of six clips and from
//! Chopper's photographs, without sight of what the program finds.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::collections::BTreeMap;
use std::path::Path;

use muybridge_core::Limb;
use muybridge_fitting::tracked::clip::Clip;
use muybridge_fitting::tracked::{FRAMES_PER_S, Film, measure};

const LABELS: &str = include_str!("data/walk-contacts-by-eye.csv");
/// Video frames by which a found contact may miss its label.
const TOLERANCE: f64 = 1.0;

/// Strikes and lift-offs of a leg, video frames.
type Events = [Vec<f64>; 2];

fn labels() -> BTreeMap<String, [Events; 4]> {
    let mut clips: BTreeMap<String, [Events; 4]> = BTreeMap::new();
    let mut reader = csv::ReaderBuilder::new().from_reader(LABELS.as_bytes());
    for row in reader.records() {
        let row = row.unwrap();
        let limb = Limb::ALL.into_iter().find(|limb| limb.abbreviation() == &row[1]).unwrap();
        let events = &mut clips.entry(row[0].to_string()).or_default()[limb.index()];
        for (which, cell) in [&row[2], &row[3]].into_iter().enumerate() {
            events[which].extend(cell.parse::<f64>());
        }
    }
    clips
}

#[test]
fn nine_contacts_in_ten_are_within_a_frame_of_what_a_person_sees() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/reference/tracked-walks");
    if !folder.exists() {
        println!("skipped: no shared tracks");
        return;
    }
    let (mut near, mut all, mut missed) = (0, 0, Vec::new());
    for (name, legs) in labels() {
        let clip = Clip::read(&folder.join(format!("{name}.csv"))).unwrap();
        let stances = measure(&clip, &Film::at_rate(FRAMES_PER_S)).stances;
        for limb in Limb::ALL {
            let of_leg = &stances[limb.index()];
            let found: Events = [
                of_leg.iter().filter_map(|stance| stance.strike.frame()).collect(),
                of_leg.iter().filter_map(|stance| stance.lift_off.frame()).collect(),
            ];
            for (which, label) in
                legs[limb.index()].iter().enumerate().flat_map(|(i, of)| of.iter().map(move |l| (i, *l)))
            {
                let off = found[which].iter().map(|at| (at - label).abs()).fold(f64::INFINITY, f64::min);
                all += 1;
                near += usize::from(off <= TOLERANCE);
                if off > TOLERANCE {
                    let event = ["strike", "lift-off"][which];
                    missed.push(format!("{name} {} {event} {label}: {off:.1}", limb.abbreviation()));
                }
            }
        }
    }
    println!("{near} of {all} contacts within a frame of their labels; not: {missed:#?}");
    assert!(all > 100, "the labels are there");
    assert!(near * 10 >= all * 9, "{near} of {all}");
}
