//! How many clicks the proposals spare: a scripted person annotates plates of known truth with and without them.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

#[path = "clicks/person.rs"]
mod person;
#[path = "clicks/window.rs"]
mod window;

use std::path::{Path, PathBuf};

use muybridge_capture::{Plate, calibrate};
use muybridge_core::Gait;
use person::{Count, Person};
use window::Window;

/// Seed of the person's hand.
const SEED: u64 = 1878;
/// Most clicks with the proposals, as a share of those by hand; and most error of the fitted joints.
const MOST_CLICKS: f64 = 0.40;
const MOST_ERROR: f64 = 1.05;

/// One way of working on one plate.
struct Way {
    count: Count,
    rms_of_points: f64,
    rms_of_joints: f64,
    gait_is_right: bool,
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn work(manifest: &Path, photograph: &Path, annotation: &Path, gait: Gait, with_proposals: bool) -> Way {
    let plate = Plate::load(annotation).unwrap();
    let calibration = calibrate(&plate.manifest, &plate.annotation).unwrap();
    let withers_m = calibration.withers_height_m.map_or(1.6, |height| height.value);
    let withers_px = withers_m * calibration.stride[0].px_per_m;
    let seed = std::env::var("SEED").map_or(SEED, |v| v.parse().unwrap());
    let mut person = Person::new(plate.annotation, withers_px, seed);
    let mut window = Window::open(manifest, photograph);
    person.prepares(&mut window);
    if with_proposals {
        person.corrects_proposals(&mut window);
    } else {
        person.places_all(&mut window);
    }
    let fitted = window.fitted();
    Way {
        count: person.count,
        rms_of_points: person.rms_of_points(&mut window),
        rms_of_joints: person.rms_of_joints(&fitted.fit),
        gait_is_right: fitted.analysis.implied.agrees_with(gait),
    }
}

/// Both ways of working on a plate: by hand, and with proposals.
fn both_ways(manifest: &Path, photograph: &Path, annotation: &Path, gait: Gait) -> [Way; 2] {
    [false, true].map(|with_proposals| work(manifest, photograph, annotation, gait, with_proposals))
}

fn on_specimen(gait: Gait) -> [Way; 2] {
    let folder = repository().join("plates/specimens");
    let [manifest, photograph, annotation] =
        ["specimen-NAME.json", "specimen-NAME.jpg", "annotations/specimen-NAME.json"]
            .map(|file| folder.join(file.replace("NAME", gait.name())));
    both_ways(&manifest, &photograph, &annotation, gait)
}

fn share_of_clicks([by_hand, proposed]: &[Way; 2]) -> f64 {
    proposed.count.clicks() as f64 / by_hand.count.clicks() as f64
}

fn print(name: &str, ways: &[Way; 2]) {
    let [by_hand, proposed] = ways;
    println!(
        "{name:<8} clicks {:>3} by hand, {:>3} with proposals ({:.0} %, contacts {} in each); with keys {:>3} and {:>3} ({:.0} %); \
         points off by {:.2} and {:.2} % of withers height, fitted joints {:.2} and {:.2} % ({:.2} times)",
        by_hand.count.clicks(),
        proposed.count.clicks(),
        100.0 * share_of_clicks(ways),
        by_hand.count.contacts,
        by_hand.count.clicks() + by_hand.count.keys,
        proposed.count.clicks() + proposed.count.keys,
        100.0 * (proposed.count.clicks() + proposed.count.keys) as f64
            / (by_hand.count.clicks() + by_hand.count.keys) as f64,
        100.0 * by_hand.rms_of_points,
        100.0 * proposed.rms_of_points,
        100.0 * by_hand.rms_of_joints,
        100.0 * proposed.rms_of_joints,
        proposed.rms_of_joints / by_hand.rms_of_joints,
    );
}

#[test]
fn proposals_spare_three_of_five_clicks_and_cost_no_accuracy() {
    let gaits = std::env::var("GAITS").map_or(vec![Gait::Walk, Gait::Trot, Gait::Gallop], |v| Gait::ALL.into_iter().filter(|g| v.contains(g.name())).collect());
    let results: Vec<(Gait, [Way; 2])> = std::thread::scope(|scope| {
        let running: Vec<_> = gaits.into_iter().map(|gait| scope.spawn(move || (gait, on_specimen(gait)))).collect();
        running.into_iter().map(|work| work.join().unwrap()).collect()
    });
    for (gait, ways) in &results {
        print(gait.name(), ways);
    }
    for (gait, ways) in &results {
        let share = share_of_clicks(ways);
        let [by_hand, proposed] = ways;
        assert!(by_hand.gait_is_right && proposed.gait_is_right, "{gait}");
        assert!(share <= MOST_CLICKS, "{gait}: {share:.2} of the clicks");
        let error = proposed.rms_of_joints / by_hand.rms_of_joints;
        assert!(error <= MOST_ERROR, "{gait}: fitted joints {error:.2} times as far off");
    }
}
