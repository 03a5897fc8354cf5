//! How well panels, horses, walls and hooves are found on plates whose truth is known.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use muybridge_capture::{Keypoint, KeypointState, LimbJoint, read_json};
use muybridge_cli::specimens::{kept, random};
use muybridge_core::{Gait, Skeleton};
use muybridge_fitting::pipeline::fit_plate;
use muybridge_fitting::weights::Weights;
use muybridge_imaging::PanelView;
use muybridge_imaging::see::{Line, Silhouette, Wall, silhouettes, walls};
use muybridge_imaging::specimen::{PanelTruth, Specimen, SpecimenTruth};
use muybridge_imaging::split::{iou, split};
use muybridge_imaging::track::{PanelPoints, track};
use muybridge_tests::{repository, shared_folder};

type Point = [f64; 2];

/// Longer side of the pictures that are looked at, px.
const VIEW_PX: u32 = 700;
/// A panel counts as found from this overlap on.
const FOUND_IOU: f64 = 0.95;

/// Every panel found, in reading order, and none besides.
fn all_found(found: &[[Point; 4]], truth: &[[Point; 4]]) -> bool {
    found.len() == truth.len() && found.iter().zip(truth).all(|(a, b)| iou(a, b) >= FOUND_IOU)
}

fn found_quads(picture: &image::GrayImage) -> (Vec<[Point; 4]>, bool) {
    let found = split(picture);
    (found.panels.iter().map(|panel| panel.quad_px).collect(), found.is_certain())
}

fn true_quads(specimen: &Specimen) -> Vec<[Point; 4]> {
    specimen.truth.panels.iter().map(|panel| panel.quad_px).collect()
}

/// Results of a function of each seed, in the order of the seeds.
fn on_all_cores<T: Send>(seeds: std::ops::Range<u64>, work: impl Fn(u64) -> T + Sync) -> Vec<T> {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get() as u64);
    let work = &work;
    let mut results: Vec<(u64, T)> = std::thread::scope(|scope| {
        let share = |thread: u64| seeds.clone().filter(move |seed| seed % threads == thread);
        let run =
            |thread| scope.spawn(move || share(thread).map(|seed| (seed, work(seed))).collect::<Vec<_>>());
        let running: Vec<_> = (0..threads).map(run).collect();
        running.into_iter().flat_map(|thread| thread.join().unwrap()).collect()
    });
    results.sort_by_key(|(seed, _)| *seed);
    results.into_iter().map(|(_, result)| result).collect()
}

#[test]
fn panels_of_200_random_specimens_are_found_or_called_uncertain() {
    let judge = |seed: u64| {
        let specimen = random(seed);
        let (quads, certain) = found_quads(&specimen.picture);
        (seed, all_found(&quads, &true_quads(&specimen)), certain)
    };
    let judged = on_all_cores(0..200, judge);
    let found = judged.iter().filter(|(_, found, _)| *found).count();
    let sure_and_wrong: Vec<u64> =
        judged.iter().filter(|(_, found, certain)| !found && *certain).map(|(seed, ..)| *seed).collect();
    println!("all panels found on {found} of 200 plates; sure and wrong: {sure_and_wrong:?}");
    assert!(found >= 198, "{found} of 200");
    assert!(sure_and_wrong.is_empty(), "{sure_and_wrong:?}");
}

#[test]
fn panels_of_real_plates_are_found_without_a_hint() {
    let Some(shared) = shared_folder() else {
        println!("skipped: no shared plates");
        return;
    };
    let sallie: serde_json::Value = serde_json::from_str(
        &std::fs::read_to_string(repository().join("plates/sallie-gardner-1878.json")).unwrap(),
    )
    .unwrap();
    let by_hand = |value: &serde_json::Value| serde_json::from_value::<[Point; 4]>(value.clone()).unwrap();
    let sallie: Vec<[Point; 4]> =
        sallie["panels"].as_array().unwrap().iter().map(|panel| by_hand(&panel["quad_px"])).collect();
    let daisy: serde_json::Value = serde_json::from_str(
        &std::fs::read_to_string(repository().join("tests/data/daisy-panels.json")).unwrap(),
    )
    .unwrap();
    let daisy: Vec<[Point; 4]> = daisy["quads_px"].as_array().unwrap().iter().map(by_hand).collect();
    for (name, truth) in [("sallie-gardner-1878", sallie), ("daisy-galloping", daisy)] {
        let path = shared.join("plates").join(name).join("plate.jpg");
        let picture = muybridge_imaging::load_gray(&path, muybridge_imaging::LoadLimits::default()).unwrap();
        let (quads, _) = found_quads(&picture);
        let overlaps: Vec<f64> = quads.iter().zip(&truth).map(|(a, b)| iou(a, b)).collect();
        println!("{name}: {overlaps:.3?}");
        assert!(all_found(&quads, &truth), "{name}: {overlaps:.3?}");
    }
}

/// A specimen and what is seen in it.
struct Seen {
    specimen: Specimen,
    views: Vec<PanelView>,
    silhouettes: Vec<Silhouette>,
    walls: Vec<Wall>,
}

impl Seen {
    fn new(specimen: Specimen) -> Self {
        let view = |quad: [Point; 4]| PanelView::new(&specimen.picture, quad, VIEW_PX).unwrap();
        let views: Vec<PanelView> = true_quads(&specimen).into_iter().map(view).collect();
        let silhouettes = silhouettes(&views);
        Self { walls: walls(&views, &silhouettes), silhouettes, views, specimen }
    }

    fn truth(&self, panel: usize) -> &PanelTruth {
        &self.specimen.truth.panels[panel]
    }

    fn silhouette_iou(&self, panel: usize) -> f64 {
        let (view, truth) = (&self.views[panel], &self.specimen.silhouettes[panel]);
        let (mut both, mut either) = (0, 0);
        for (x, y, pixel) in self.silhouettes[panel].mask.enumerate_pixels() {
            let at = view.transform.plate_from_panel([f64::from(x) + 0.5, f64::from(y) + 0.5]);
            let (found, there) = (pixel.0[0] > 127, truth.at(at) > 127);
            both += usize::from(found && there);
            either += usize::from(found || there);
        }
        both as f64 / either as f64
    }

    /// Farthest distance of a found line's ends from a true line, plate px.
    fn off_px(&self, panel: usize, found: &Line, [a, b]: [Point; 2]) -> f64 {
        let distance = |at: Point| {
            let [x, y] = self.views[panel].transform.plate_from_panel(at);
            let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
            (dx * (y - a[1]) - dy * (x - a[0])).abs() / dx.hypot(dy)
        };
        found.ends_px.map(distance).into_iter().fold(0.0, f64::max)
    }

    /// Ground line: its farthest distance from the truth, px; infinite where none was found.
    fn ground_off_px(&self, panel: usize) -> f64 {
        let ground = self.walls[panel].ground.as_ref();
        ground.map_or(f64::INFINITY, |line| self.off_px(panel, line, self.truth(panel).ground_px))
    }

    /// Uprights that are there, those of them found, and lines found where none is.
    fn uprights(&self, panel: usize) -> [usize; 3] {
        let truth = &self.truth(panel).uprights;
        let found = &self.walls[panel].uprights;
        let near = |line: &Line, ends: [Point; 2]| self.off_px(panel, line, ends) <= 2.0;
        let hit = truth.iter().filter(|upright| found.iter().any(|line| near(line, upright.ends_px))).count();
        let stray =
            found.iter().filter(|line| !truth.iter().any(|upright| near(line, upright.ends_px))).count();
        [truth.len(), hit, stray]
    }
}

/// What is measured over plates.
#[derive(Default)]
struct Tally {
    panels: usize,
    ious: Vec<f64>,
    grounds_px: Vec<f64>,
    uprights: [usize; 3],
}

impl Tally {
    fn add(&mut self, seen: &Seen) {
        for panel in 0..seen.views.len() {
            self.panels += 1;
            self.ious.push(seen.silhouette_iou(panel));
            self.grounds_px.push(seen.ground_off_px(panel));
            let counts = seen.uprights(panel);
            (0..3).for_each(|i| self.uprights[i] += counts[i]);
        }
        self.ious.sort_by(f64::total_cmp);
        self.grounds_px.sort_by(f64::total_cmp);
    }

    fn share_of_good_silhouettes(&self) -> f64 {
        self.ious.iter().filter(|iou| **iou >= 0.9).count() as f64 / self.panels as f64
    }

    fn print(&self, name: &str) {
        let share = |count: usize| 100.0 * count as f64 / self.panels as f64;
        let level = self.grounds_px.iter().filter(|off| **off <= 2.0).count();
        println!(
            "{name}: {} panels; silhouette IoU median {:.3}, least {:.3}, {:.1} % >= 0.90; ground median {:.2} px, worst {:.2} px, \
             {:.1} % <= 2 px; uprights found within 2 px {} of {}, stray {}",
            self.panels,
            self.ious[self.panels / 2],
            self.ious[0],
            100.0 * self.share_of_good_silhouettes(),
            self.grounds_px[self.panels / 2],
            self.grounds_px[self.panels - 1],
            share(level),
            self.uprights[1],
            self.uprights[0],
            self.uprights[2],
        );
    }
}

#[test]
fn horse_ground_and_wall_of_kept_specimens_are_seen() {
    let mut all = Tally::default();
    for gait in Gait::ALL {
        let mut tally = Tally::default();
        let seen = Seen::new(kept(gait));
        tally.add(&seen);
        all.add(&seen);
        tally.print(gait.name());
    }
    all.print("kept");
    // A hurdle that touches the horse counts as horse, and a light horse's hooves are lost on a light track.
    assert!(all.share_of_good_silhouettes() >= 0.95 && all.ious[0] >= 0.85, "{:?}", &all.ious[..5]);
    assert!(all.grounds_px[all.panels - 1] <= 2.0, "{:?}", &all.grounds_px[all.panels - 5..]);
    let [there, found, stray] = all.uprights.map(|count| count as f64);
    assert!(found >= 0.95 * there && stray <= 0.02 * there, "{:?}", all.uprights);
}

#[test]
fn horse_ground_and_wall_of_random_specimens_are_seen() {
    let mut all = Tally::default();
    for seen in on_all_cores(1000..1024, |seed| Seen::new(random(seed))) {
        all.add(&seen);
    }
    all.print("random");
    // Worst are dark walls in small panels, and halves in shadow.
    assert!(all.share_of_good_silhouettes() >= 0.75);
    assert!(all.grounds_px[all.panels * 3 / 4] <= 2.0);
}

/// A hoof tracked into a panel: its error as a share of the withers height, and the quality it was given.
struct TrackedHoof {
    error: f64,
    quality: f64,
}

/// Visible hooves of a specimen tracked one panel ahead from the true points of the two panels before.
fn tracked_hooves(seen: &Seen) -> Vec<TrackedHoof> {
    let truth = &seen.specimen.truth;
    let mut hooves = Vec::new();
    for panel in 2..seen.views.len() {
        let known = [panel - 2, panel - 1].map(|k| PanelPoints {
            view: &seen.views[k],
            silhouette: Some(&seen.silhouettes[k].mask),
            points: &truth.panels[k].keypoints,
        });
        for tracked in track(&known, &seen.views[panel], Some(&seen.silhouettes[panel].mask)) {
            let is_hoof = matches!(tracked.keypoint, Keypoint::Limb(_, _, LimbJoint::Hoof));
            let there = truth.panels[panel].keypoints.get(tracked.keypoint).unwrap();
            if let (true, KeypointState::Visible, Some(at)) = (is_hoof, there.state, there.at_px) {
                let off_px = (tracked.at_px[0] - at[0]).hypot(tracked.at_px[1] - at[1]);
                let withers_px = truth.withers_height_m * truth.panels[panel].camera.px_per_m;
                hooves.push(TrackedHoof { error: off_px / withers_px, quality: tracked.quality });
            }
        }
    }
    hooves
}

/// Probability that a good hoof has a higher quality than a bad one.
fn separation(hooves: &[TrackedHoof], most_error: f64) -> f64 {
    let (good, bad): (Vec<&TrackedHoof>, Vec<&TrackedHoof>) =
        hooves.iter().partition(|h| h.error <= most_error);
    let pairs = good.iter().flat_map(|g| bad.iter().map(move |b| (g.quality, b.quality)));
    let wins: f64 = pairs
        .map(|(g, b)| {
            if g > b {
                1.0
            } else if g == b {
                0.5
            } else {
                0.0
            }
        })
        .sum();
    wins / (good.len() * bad.len()) as f64
}

#[test]
fn hooves_are_tracked_and_bad_tracks_known() {
    let mut all = Vec::new();
    for gait in Gait::ALL {
        let hooves = tracked_hooves(&Seen::new(kept(gait)));
        let good = hooves.iter().filter(|hoof| hoof.error <= 0.02).count();
        println!("{gait}: {good} of {} visible hooves within 2 % of withers height", hooves.len());
        all.extend(hooves);
    }
    let good = all.iter().filter(|hoof| hoof.error <= 0.02).count() as f64 / all.len() as f64;
    let separation = separation(&all, 0.02);
    println!(
        "{:.1} % of {} hooves; quality tells good from bad in {:.1} % of pairs",
        100.0 * good,
        all.len(),
        100.0 * separation
    );
    assert!(good >= 0.80, "{good:.3}");
    assert!(separation >= 0.80, "{separation:.3}");
}

#[test]
fn kept_specimens_are_what_the_program_draws() {
    let folder = repository().join("plates/specimens");
    for gait in Gait::ALL {
        let id = format!("specimen-{gait}");
        let specimen = kept(gait);
        let truth: SpecimenTruth = read_json(&folder.join(format!("{id}.truth.json")), 1).unwrap();
        for (kept, drawn) in truth.panels.iter().zip(&specimen.truth.panels) {
            for keypoint in Keypoint::all() {
                let (a, b) =
                    (kept.keypoints.place(keypoint).unwrap(), drawn.keypoints.place(keypoint).unwrap());
                // Rounded to a hundredth; another processor may round otherwise.
                assert!(
                    (a[0] - b[0]).hypot(a[1] - b[1]) < 0.03,
                    "{id}, {keypoint}: run `muybridge plates specimen`"
                );
            }
        }
        let picture = image::open(folder.join(format!("{id}.jpg"))).unwrap().to_luma8();
        assert_eq!(picture.dimensions(), specimen.picture.dimensions(), "{id}");
        let difference: f64 = picture
            .pixels()
            .zip(specimen.picture.pixels())
            .map(|(a, b)| f64::from(a.0[0].abs_diff(b.0[0])))
            .sum();
        let mean = difference / f64::from(picture.width() * picture.height());
        assert!(mean < 4.0, "{id}: {mean:.2} grey values apart; run `muybridge plates specimen`");
    }
}

#[test]
fn kept_specimens_go_through_the_whole_pipeline() {
    let folder = repository().join("plates/specimens/annotations");
    for gait in Gait::ALL.into_iter().filter(|gait| *gait != Gait::Leap) {
        let path = folder.join(format!("specimen-{gait}.json"));
        let fitted = fit_plate(&path, &Skeleton::reference(), &Weights::default()).unwrap();
        let implied = fitted.analysis.implied;
        println!("{gait}: fitted as {}", implied.name());
        assert!(implied.agrees_with(gait), "{gait}: fitted as {}", implied.name());
    }
}
