//! How many clicks the proposals spare: scripted people annotate plates of known truth with and without them.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

#[path = "clicks/person.rs"]
mod person;
#[path = "clicks/window.rs"]
mod window;

use std::path::{Path, PathBuf};

use muybridge_capture::{Plate, calibrate};
use muybridge_core::{Gait, Skeleton};
use person::{Count, Person};
use window::Window;

/// Seeds of the people's hands: what one of them needs changes by a tenth with the hand.
const PEOPLE: [u64; 2] = [1, 1878];
/// Most clicks with the proposals, as a share of those by hand.
const MOST_CLICKS: f64 = 0.40;
/// Most error of the fitted joints, as a multiple of that by hand.
const MOST_ERROR: f64 = 1.05;

/// The files of a plate, and what its footfalls should be named.
struct Files {
    manifest: PathBuf,
    photograph: PathBuf,
    annotation: PathBuf,
    gait: Gait,
}

/// What one way of working on a plate took and gave; distances as shares of the withers height.
struct Way {
    count: Count,
    rms_of_points: f64,
    rms_of_joints: f64,
    gait_is_right: bool,
}

/// A plate by hand and with proposals, summed up over people.
struct Comparison {
    name: String,
    clicks: [usize; 2],
    contacts: usize,
    keys: [usize; 2],
    rms_of_points: [f64; 2],
    rms_of_joints: [f64; 2],
    gaits_are_right: bool,
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn specimen(gait: Gait) -> Files {
    let folder = repository().join("plates/specimens");
    let [manifest, photograph, annotation] =
        ["specimen-NAME.json", "specimen-NAME.jpg", "annotations/specimen-NAME.json"]
            .map(|file| folder.join(file.replace("NAME", gait.name())));
    Files { manifest, photograph, annotation, gait }
}

/// Works on a plate, by hand or with proposals, and fits it.
fn work(files: &Files, seed: u64, with_proposals: bool) -> Result<Way, String> {
    let plate = Plate::load(&files.annotation).unwrap();
    let calibration = calibrate(&plate.manifest, &plate.annotation).unwrap();
    let reference_m = f64::from(Skeleton::reference().withers_height_m);
    // The height of the standing animal: a moving one's withers are lower, by gait.
    let standing = calibration.withers_height_m.filter(|_| !calibration.standing.is_empty());
    let withers_m = standing.map_or(reference_m, |height| height.value);
    let mut person = Person::new(plate.annotation, withers_m * calibration.stride[0].px_per_m, seed);
    let mut window = Window::open(&files.manifest, &files.photograph);
    person.prepares(&mut window);
    if with_proposals {
        person.corrects_proposals(&mut window);
    } else {
        person.places_all(&mut window);
    }
    let fitted = window.fitted()?;
    Ok(Way {
        count: person.count,
        rms_of_points: person.rms_of_points(&mut window),
        rms_of_joints: person.rms_of_joints(&fitted.fit),
        gait_is_right: fitted.analysis.implied.agrees_with(files.gait),
    })
}

fn compare(name: &str, files: &Files) -> Result<Comparison, String> {
    let mut sum = Comparison {
        name: name.to_string(),
        clicks: [0; 2],
        contacts: 0,
        keys: [0; 2],
        rms_of_points: [0.0; 2],
        rms_of_joints: [0.0; 2],
        gaits_are_right: true,
    };
    for seed in PEOPLE {
        for (way, with_proposals) in [false, true].into_iter().enumerate() {
            let done = work(files, seed, with_proposals)?;
            sum.clicks[way] += done.count.clicks();
            sum.keys[way] += done.count.keys;
            sum.contacts = done.count.contacts;
            sum.rms_of_points[way] += done.rms_of_points / PEOPLE.len() as f64;
            sum.rms_of_joints[way] += done.rms_of_joints / PEOPLE.len() as f64;
            sum.gaits_are_right &= done.gait_is_right;
        }
    }
    Ok(sum)
}

impl Comparison {
    fn share_of_clicks(&self) -> f64 {
        self.clicks[1] as f64 / self.clicks[0] as f64
    }

    fn times_the_error(&self) -> f64 {
        self.rms_of_joints[1] / self.rms_of_joints[0]
    }

    /// A row: means of the people.
    fn print(&self) {
        let mean = |count: usize| count as f64 / PEOPLE.len() as f64;
        let [clicks, keys] = [self.clicks, self.keys].map(|counts| counts.map(mean));
        let percent = |values: [f64; 2]| values.map(|value| 100.0 * value);
        let ([p, q], [j, k]) = (percent(self.rms_of_points), percent(self.rms_of_joints));
        println!(
            "| {:<7} | {:5.1} | {:5.1} | {:4.1} % | {} | {:4.1}, {:5.1} | {:4.1} % | {p:.2}, {q:.2} % | {j:.2}, {k:.2} % | {:.2} | {} |",
            self.name,
            clicks[0],
            clicks[1],
            100.0 * self.share_of_clicks(),
            self.contacts,
            keys[0],
            keys[1],
            100.0 * (clicks[1] + keys[1]) / (clicks[0] + keys[0]),
            self.times_the_error(),
            if self.gaits_are_right { "right" } else { "wrong" },
        );
    }
}

fn print_head() {
    println!("by hand, and with proposals; contacts are among the clicks; distances in withers heights");
    println!(
        "| plate | clicks by hand | proposed | share | contacts | keys | share with keys | points off | joints off | times | gait |"
    );
}

#[test]
fn proposals_spare_three_of_five_clicks_and_cost_no_accuracy() {
    let compared: Vec<Comparison> = std::thread::scope(|scope| {
        let start = |gait: Gait| scope.spawn(move || compare(gait.name(), &specimen(gait)).unwrap());
        let running = [Gait::Walk, Gait::Trot, Gait::Gallop].map(start);
        running.into_iter().map(|work| work.join().unwrap()).collect()
    });
    print_head();
    compared.iter().for_each(Comparison::print);
    for plate in &compared {
        assert!(plate.gaits_are_right, "{}", plate.name);
        let (share, times) = (plate.share_of_clicks(), plate.times_the_error());
        assert!(share <= MOST_CLICKS, "{}: {share:.3} of the clicks", plate.name);
        assert!(times <= MOST_ERROR, "{}: fitted joints {times:.3} times as far off", plate.name);
    }
}

#[test]
#[ignore = "no bar: prints what the proposals spare on the other specimens and on Sallie Gardner"]
fn clicks_on_other_plates() {
    print_head();
    let others =
        [Gait::Amble, Gait::Rack, Gait::Canter, Gait::Leap].map(|gait| (gait.name(), specimen(gait)));
    let sallie = Files {
        manifest: repository().join("plates/sallie-gardner-1878.json"),
        photograph: repository().join("../shared/plates/sallie-gardner-1878/plate.jpg"),
        annotation: repository().join("annotations/sallie-gardner-1878.json"),
        gait: Gait::Gallop,
    };
    for (name, files) in others.into_iter().chain([("sallie", sallie)]) {
        if !files.photograph.exists() {
            println!("{name}: skipped, its photograph is not on this machine");
            continue;
        }
        match compare(name, &files) {
            Ok(compared) => compared.print(),
            Err(fault) => println!("{name}: not fitted: {fault}"),
        }
    }
}
