//! Silhouettes, ground and walls of drawings whose truth is known, of specimens, and of a real plate.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::path::Path;

use image::{GrayImage, Luma};
use muybridge_capture::Facing;
use muybridge_core::Random;
use muybridge_imaging::PanelView;
use muybridge_imaging::see::{Line, Silhouette, Wall, hoof_candidates, silhouettes, walls};
use muybridge_imaging::specimen::{Specimen, SpecimenStyle, draw, swung_legs};

type Point = [f64; 2];

fn whole(picture: &GrayImage) -> PanelView {
    let (width, height) = (f64::from(picture.width()), f64::from(picture.height()));
    PanelView::new(picture, [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]], 900).unwrap()
}

fn iou(mask: &GrayImage, inside: impl Fn(u32, u32) -> bool) -> f64 {
    let (mut both, mut either) = (0, 0);
    for (x, y, pixel) in mask.enumerate_pixels() {
        let (found, there) = (pixel.0[0] > 0, inside(x, y));
        both += u32::from(found && there);
        either += u32::from(found || there);
    }
    f64::from(both) / f64::from(either)
}

/// A barrel on four legs before a wall with uprights every 80 px, the ground at y = 250.
struct Drawing {
    shift: f64,
}

impl Drawing {
    const GROUND: f64 = 250.0;

    fn legs(&self) -> [f64; 4] {
        [150.0, 180.0, 270.0, 300.0].map(|x| x + self.shift)
    }

    fn is_horse(&self, x: u32, y: u32) -> bool {
        let (x, y) = (f64::from(x) + 0.5, f64::from(y) + 0.5);
        let barrel = ((x - 225.0 - self.shift) / 100.0).powi(2) + ((y - 140.0) / 45.0).powi(2) < 1.0;
        barrel || y > 140.0 && y < Self::GROUND && self.legs().iter().any(|leg| (x - leg).abs() < 5.0)
    }

    fn picture(&self, [wall, horse, line]: [f64; 3], seed: u64) -> GrayImage {
        let mut random = Random::new(seed);
        GrayImage::from_fn(450, 300, |x, y| {
            let on_line = x % 80 == 30 && y < 235 || y == 235;
            let tone = if self.is_horse(x, y) {
                horse
            } else if on_line {
                line
            } else {
                wall
            };
            Luma([(tone + 3.0 * random.normal()).round() as u8])
        })
    }
}

#[test]
fn a_drawn_horse_its_ground_uprights_and_hooves_are_found_dark_or_light() {
    for tones in [[180.0, 60.0, 120.0], [70.0, 160.0, 120.0]] {
        let drawings: Vec<Drawing> = (0..4).map(|k| Drawing { shift: 12.0 * f64::from(k) }).collect();
        let views: Vec<PanelView> =
            drawings.iter().enumerate().map(|(k, d)| whole(&d.picture(tones, k as u64))).collect();
        let horses = silhouettes(&views);
        for ((drawing, horse), wall) in drawings.iter().zip(&horses).zip(walls(&views, &horses)) {
            let iou = iou(&horse.mask, |x, y| drawing.is_horse(x, y));
            assert!(iou > 0.95 && horse.confidence > 0.6, "{tones:?}: {iou:.3}, {:.2}", horse.confidence);
            let ground = wall.ground.unwrap();
            for x in [50.0, 400.0] {
                assert!((ground.y_at(x) - Drawing::GROUND).abs() < 1.5, "{tones:?}: {ground:?}");
            }
            let places: Vec<f64> = wall.uprights.iter().map(|line| line.x_at(60.0)).collect();
            assert_eq!(places.len(), 6, "{places:?}");
            assert!(
                places.iter().enumerate().all(|(k, x)| (x - 30.5 - 80.0 * k as f64).abs() < 0.5),
                "{places:?}"
            );
            let hooves = hoof_candidates(horse, Some(&ground));
            for leg in drawing.legs() {
                assert!(
                    hooves
                        .iter()
                        .any(|hoof| (hoof.at_px[0] - leg).abs() < 3.0 && hoof.height_px.unwrap().abs() < 3.0),
                    "{tones:?}: {leg} of {hooves:?}"
                );
            }
        }
    }
}

#[test]
fn nothing_to_see_is_no_horse_and_no_panic() {
    assert!(silhouettes(&[]).is_empty());
    assert!(walls(&[], &[]).is_empty());
    for (width, height) in [(1, 1), (1, 40), (40, 1), (2, 3), (64, 48)] {
        for tone in [0, 128, 255] {
            let view = whole(&GrayImage::from_pixel(width, height, Luma([tone])));
            let horses = silhouettes(std::slice::from_ref(&view));
            assert_eq!(horses[0].confidence, 0.0, "{width} x {height}, {tone}");
            assert_eq!(horses[0].mask.dimensions(), (width, height));
            let walls = walls(std::slice::from_ref(&view), &horses);
            assert!(walls[0].ground.is_none_or(|line| line.confidence == 0.0), "{width} x {height}, {tone}");
            assert!(walls[0].uprights.is_empty() && hoof_candidates(&horses[0], None).is_empty());
        }
    }
}

#[test]
fn a_silhouette_that_cannot_be_trusted_says_so() {
    // A dark wedge from the edge over half the picture, and noise.
    let mut random = Random::new(7);
    let wedge = GrayImage::from_fn(300, 200, |x, y| {
        Luma([(if x + y > 260 { 60.0 } else { 90.0 } + 30.0 * random.normal()).clamp(0.0, 255.0) as u8])
    });
    let horses = silhouettes(&[whole(&wedge)]);
    assert!(horses[0].confidence < 0.3, "{}", horses[0].confidence);
}

struct Seen {
    views: Vec<PanelView>,
    horses: Vec<Silhouette>,
    walls: Vec<Wall>,
}

impl Seen {
    fn new(picture: &GrayImage, quads_px: &[[Point; 4]]) -> Self {
        let views: Vec<PanelView> =
            quads_px.iter().map(|quad| PanelView::new(picture, *quad, 900).unwrap()).collect();
        let horses = silhouettes(&views);
        let walls = walls(&views, &horses);
        Self { views, horses, walls }
    }

    /// Differences from a true line at a fifth, half and four fifths of a panel, px.
    fn ground_off_px(&self, panel: usize, truth_px: [Point; 2]) -> [f64; 3] {
        let view = &self.views[panel];
        let truth = Line { ends_px: truth_px.map(|p| view.transform.panel_from_plate(p)), confidence: 1.0 };
        let ground = self.walls[panel].ground.unwrap();
        [0.2, 0.5, 0.8].map(|share| {
            let x = share * f64::from(view.image.width());
            ground.y_at(x) - truth.y_at(x)
        })
    }

    /// Distance of the nearest upright from a place on the plate, px.
    fn upright_off_px(&self, panel: usize, at_px: Point) -> f64 {
        let [x, y] = self.views[panel].transform.panel_from_plate(at_px);
        let off = self.walls[panel].uprights.iter().map(|line| (line.x_at(y) - x).abs());
        off.fold(f64::INFINITY, f64::min)
    }
}

fn specimen(style: &SpecimenStyle, facing: Facing) -> (Specimen, Seen) {
    let poses = (style.columns * style.rows) as usize;
    let specimen = draw(&swung_legs(poses, facing), style);
    let quads: Vec<[Point; 4]> = specimen.truth.panels.iter().map(|panel| panel.quad_px).collect();
    let seen = Seen::new(&specimen.picture, &quads);
    (specimen, seen)
}

#[test]
fn specimens_of_several_looks_are_seen() {
    let small =
        |style: SpecimenStyle| SpecimenStyle { columns: 3, rows: 2, panel_px: [400.0, 270.0], ..style };
    let looks = [
        (small(SpecimenStyle::default()), Facing::Right),
        (small(SpecimenStyle::animal_locomotion()), Facing::Left),
        (
            small(SpecimenStyle { rider: true, grain_sd: 5.0, seed: 3, ..SpecimenStyle::default() }),
            Facing::Left,
        ),
    ];
    for (style, facing) in looks {
        let (specimen, seen) = specimen(&style, facing);
        for (panel, truth) in specimen.truth.panels.iter().enumerate() {
            let (view, horse) = (&seen.views[panel], &seen.horses[panel]);
            let iou = iou(&horse.mask, |x, y| {
                let at = [f64::from(x) + 0.5, f64::from(y) + 0.5];
                specimen.silhouettes[panel].at(view.transform.plate_from_panel(at)) > 127
            });
            assert!(
                iou >= 0.90 && horse.confidence > 0.5,
                "panel {panel}: {iou:.3}, {:.2}",
                horse.confidence
            );
            let ground = seen.ground_off_px(panel, truth.ground_px);
            assert!(ground.iter().all(|off| off.abs() <= 2.0), "panel {panel}: {ground:.2?}");
            let edge = |[a, b]: [Point; 2]| [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])];
            let off: Vec<f64> = truth
                .uprights
                .iter()
                .map(|upright| seen.upright_off_px(panel, edge(upright.ends_px)))
                .collect();
            let found = off.iter().filter(|off| **off <= 2.0).count();
            assert!(found + 1 >= truth.uprights.len(), "panel {panel}: {off:.1?}");
        }
    }
}

#[test]
fn sallie_gardner_is_seen_as_it_was_annotated_by_hand() {
    let repository = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let plate = repository.join("../shared/plates/sallie-gardner-1878/plate.jpg");
    if !plate.is_file() {
        println!("skipped: no shared plates");
        return;
    }
    let read = |path: &str| -> serde_json::Value {
        serde_json::from_str(&std::fs::read_to_string(repository.join(path)).unwrap()).unwrap()
    };
    let manifest = read("plates/sallie-gardner-1878.json");
    let annotation = read("annotations/sallie-gardner-1878.json");
    let quads: Vec<[Point; 4]> = manifest["panels"]
        .as_array()
        .unwrap()
        .iter()
        .map(|panel| serde_json::from_value(panel["quad_px"].clone()).unwrap())
        .collect();
    let seen = Seen::new(&image::open(plate).unwrap().into_luma8(), &quads);
    let (mut marks, mut found) = (0, 0);
    // In the last panel the horse stands nearer to the camera than it ran.
    for (panel, by_hand) in annotation["panels"].as_array().unwrap().iter().enumerate().take(11) {
        let ground_px: [Point; 2] = serde_json::from_value(by_hand["ground_px"].clone()).unwrap();
        let off = seen.ground_off_px(panel, ground_px);
        assert!(off.iter().all(|off| off.abs() <= 3.0), "panel {}: {off:.1?}", panel + 1);
        assert!(seen.horses[panel].confidence > 0.7, "panel {}", panel + 1);
        for mark in by_hand["marks"].as_array().unwrap() {
            marks += 1;
            let at_px: Point = serde_json::from_value(mark["at_px"].clone()).unwrap();
            found += usize::from(seen.upright_off_px(panel, at_px) <= 3.0);
        }
    }
    assert!(found as f64 >= 0.9 * marks as f64, "{found} of {marks}");
}
