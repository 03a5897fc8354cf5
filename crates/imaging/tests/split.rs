//! Panels are found where they are, and what is not certain is said.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::path::{Path, PathBuf};

use image::{GrayImage, Luma};
use muybridge_capture::Facing;
use muybridge_core::Random;
use muybridge_imaging::specimen::{Specimen, SpecimenStyle, draw, swung_legs};
use muybridge_imaging::split::{Doubt, Side, Split, iou, split};
use muybridge_imaging::{LoadLimits, load_gray};

type Quad = [[f64; 2]; 4];

/// Overlap from which on a panel counts as found.
const FOUND: f64 = 0.95;

/// Photographs 180 x 130 px with a dark horse of a kind, in a grid turned about the plate's middle.
struct Plate {
    rows: usize,
    columns: usize,
    tilt_deg: f64,
    mount: f64,
    /// Number of a panel whose right half is as dark as the mount.
    shadow: Option<usize>,
}

const PANEL: [f64; 2] = [180.0, 130.0];
/// Gutters and margins are uneven: they grow to the right and downwards.
fn start(i: usize, size: f64) -> f64 {
    let i = i as f64;
    34.0 + i * (size + 14.0) + 2.0 * i * i
}

impl Plate {
    fn size(&self) -> [f64; 2] {
        [start(self.columns, PANEL[0]) + 20.0, start(self.rows, PANEL[1]) + 20.0]
    }

    /// A point of the upright plate, from one of the turned plate.
    fn upright(&self, [x, y]: [f64; 2], sign: f64) -> [f64; 2] {
        let ([width, height], (sine, cosine)) = (self.size(), self.tilt_deg.to_radians().sin_cos());
        let (x, y, sine) = (x - 0.5 * width, y - 0.5 * height, sign * sine);
        [0.5 * width + cosine * x + sine * y, 0.5 * height - sine * x + cosine * y]
    }

    fn quads(&self) -> Vec<Quad> {
        (0..self.rows * self.columns)
            .map(|i| {
                let (x, y) = (start(i % self.columns, PANEL[0]), start(i / self.columns, PANEL[1]));
                let corners = [[x, y], [x + PANEL[0], y], [x + PANEL[0], y + PANEL[1]], [x, y + PANEL[1]]];
                corners.map(|corner| self.upright(corner, -1.0))
            })
            .collect()
    }

    fn tone(&self, at: [f64; 2]) -> f64 {
        let [x, y] = self.upright(at, 1.0);
        let inside = |i: usize| {
            let at = [x - start(i % self.columns, PANEL[0]), y - start(i / self.columns, PANEL[1])];
            (at[0] >= 0.0 && at[0] < PANEL[0] && at[1] >= 0.0 && at[1] < PANEL[1]).then_some((i, at))
        };
        match (0..self.rows * self.columns).find_map(inside) {
            None => self.mount,
            Some((i, [x, _])) if self.shadow == Some(i + 1) && x > 0.5 * PANEL[0] => self.mount,
            Some((_, [x, y])) => {
                let is_horse = ((x - 90.0) / 60.0).powi(2) + ((y - 70.0) / 30.0).powi(2) < 1.0;
                let is_post = (x - 40.0).abs() < 2.0 && y < 110.0;
                if is_horse || is_post { 60.0 } else { 150.0 - 0.2 * y }
            }
        }
    }

    fn draw(&self) -> GrayImage {
        let mut random = Random::new(7);
        let [width, height] = self.size().map(|v| v as u32);
        GrayImage::from_fn(width, height, |x, y| {
            let at = |dx: f64, dy: f64| self.tone([f64::from(x) + dx, f64::from(y) + dy]);
            let mean = 0.25 * (at(0.25, 0.25) + at(0.75, 0.25) + at(0.25, 0.75) + at(0.75, 0.75));
            Luma([(mean + 4.0 * random.normal()).round().clamp(0.0, 255.0) as u8])
        })
    }
}

/// The least overlap of a panel with what was found in its place; nothing when the numbers differ.
fn least_overlap(found: &Split, truth: &[Quad]) -> f64 {
    if found.panels.len() != truth.len() {
        return 0.0;
    }
    found.panels.iter().zip(truth).map(|(panel, quad)| iou(&panel.quad_px, quad)).fold(1.0, f64::min)
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The file of a real plate or frame, where there are any.
fn shared(name: &str) -> Option<PathBuf> {
    let path = repository().join("../shared/plates").join(name);
    if !path.exists() {
        println!("skipped: no shared plates");
    }
    path.exists().then_some(path)
}

#[test]
fn overlap_is_that_of_areas() {
    let square = |x: f64, y: f64| [[x, y], [x + 2.0, y], [x + 2.0, y + 2.0], [x, y + 2.0]];
    let diamond = [[1.0, 0.0], [2.0, 1.0], [1.0, 2.0], [0.0, 1.0]];
    let [a, b, c, d] = diamond;
    assert!((iou(&square(0.0, 0.0), &square(0.0, 0.0)) - 1.0).abs() < 1e-12);
    assert!((iou(&square(0.0, 0.0), &square(1.0, 1.0)) - 1.0 / 7.0).abs() < 1e-12);
    assert!((iou(&square(0.0, 0.0), &diamond) - 0.5).abs() < 1e-12);
    assert!((iou(&[d, c, b, a], &square(0.0, 0.0)) - 0.5).abs() < 1e-12);
    assert_eq!(iou(&square(0.0, 0.0), &square(5.0, 0.0)), 0.0);
    assert_eq!(iou(&[a; 4], &[a; 4]), 0.0);
}

#[test]
fn panels_of_a_tilted_plate_are_found_to_half_a_pixel() {
    for (mount, tilt_deg, rows, columns) in
        [(30.0, 0.0, 2, 4), (30.0, -2.7, 3, 3), (235.0, 1.6, 4, 2), (235.0, 3.0, 1, 6)]
    {
        let plate = Plate { rows, columns, tilt_deg, mount, shadow: None };
        let found = split(&plate.draw());
        assert_eq!(found.doubts, [], "mount {mount}, tilt {tilt_deg}");
        assert_eq!(found.panels.len(), rows * columns);
        for (i, (panel, quad)) in found.panels.iter().zip(plate.quads()).enumerate() {
            assert_eq!([panel.row, panel.column], [i / columns, i % columns]);
            assert!(panel.confidence > 0.9);
            for (corner, expected) in panel.quad_px.iter().zip(quad) {
                let off = (corner[0] - expected[0]).hypot(corner[1] - expected[1]);
                assert!(off < 0.7, "corner {off:.2} px off; mount {mount}, tilt {tilt_deg}, panel {}", i + 1);
            }
        }
    }
}

#[test]
fn an_edge_in_shadow_is_placed_by_the_other_panels_and_doubted() {
    let plate = Plate { rows: 2, columns: 3, tilt_deg: 0.8, mount: 25.0, shadow: Some(5) };
    let found = split(&plate.draw());
    assert!(least_overlap(&found, &plate.quads()) >= FOUND);
    assert!(
        found
            .doubts
            .iter()
            .any(|doubt| matches!(doubt, Doubt::HiddenEdge { panel: 5, side: Side::Right, .. }))
    );
    assert!(found.doubts.iter().all(|doubt| match doubt {
        Doubt::HiddenEdge { panel, .. } | Doubt::FaintOutline { panel, .. } => *panel == 5,
        _ => false,
    }));
}

#[test]
fn a_row_may_end_early() {
    let plate = Plate { rows: 2, columns: 4, tilt_deg: 0.0, mount: 30.0, shadow: None };
    let last = plate.quads()[7];
    let mut picture = plate.draw();
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        if f64::from(x) >= last[0][0] - 2.0 && f64::from(y) >= last[0][1] - 2.0 {
            *pixel = Luma([30]);
        }
    }
    let found = split(&picture);
    assert!(least_overlap(&found, &plate.quads()[..7]) >= FOUND);
    assert!(found.is_certain(), "{:?}", found.doubts);
}

#[test]
fn the_real_plates_split_without_a_hint() {
    let json = |name: &str| -> serde_json::Value {
        serde_json::from_slice(&std::fs::read(repository().join(name)).unwrap()).unwrap()
    };
    let sallie = json("plates/sallie-gardner-1878.json")["panels"]
        .as_array()
        .unwrap()
        .iter()
        .map(|panel| panel["quad_px"].clone())
        .collect::<serde_json::Value>();
    let daisy = json("tests/data/daisy-panels.json")["quads_px"].clone();
    for (name, truth) in [("sallie-gardner-1878/plate.jpg", sallie), ("daisy-galloping/plate.jpg", daisy)] {
        let Some(path) = shared(name) else { return };
        let truth: Vec<Quad> = serde_json::from_value(truth).unwrap();
        let found = split(&load_gray(&path, LoadLimits::default()).unwrap());
        let least = least_overlap(&found, &truth);
        assert!(least >= FOUND, "{name}: {} panels, {least:.3}", found.panels.len());
        assert!(found.is_certain(), "{name}: {:?}", found.doubts);
    }
}

#[test]
fn a_single_photograph_is_one_panel_with_a_doubt() {
    for name in ["flode-holden-614/13.jpg", "pronto-pacing/05.png", "chopper-walking/20.jpg"] {
        let Some(path) = shared(name) else { return };
        let frame = load_gray(&path, LoadLimits::default()).unwrap();
        let [width, height] = [frame.width(), frame.height()].map(f64::from);
        let found = split(&frame);
        assert_eq!(found.doubts, [Doubt::NoMount], "{name}");
        assert_eq!(found.panels.len(), 1);
        assert_eq!(found.panels[0].quad_px, [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]]);
    }
}

#[test]
fn pictures_of_nothing_give_a_doubt_and_no_panic() {
    for (width, height) in [(0, 0), (1, 1), (3, 900), (60, 60), (900, 50), (400, 300)] {
        for tone in [0, 128, 255] {
            let found = split(&GrayImage::from_pixel(width, height, Luma([tone])));
            assert_eq!(found, Split { panels: Vec::new(), doubts: vec![Doubt::Nothing] });
        }
        let mut random = Random::new(3);
        let noise = GrayImage::from_fn(width, height, |_, _| Luma([(255.0 * random.uniform()) as u8]));
        let found = split(&noise);
        assert!(!found.is_certain(), "noise {width} x {height}: {} panels", found.panels.len());
    }
}

/// A random specimen plate, every seventh with its last cell empty.
fn specimen(seed: u64) -> Specimen {
    let style = SpecimenStyle::random(seed);
    let cells = (style.columns * style.rows) as usize;
    let poses = if seed % 7 == 3 { (cells - 1).max(2) } else { cells };
    draw(&swung_legs(poses, if seed.is_multiple_of(2) { Facing::Left } else { Facing::Right }), &style)
}

/// Splits random specimens; returns how many panels there are and how many are found. None may be wrong without a doubt.
fn split_specimens(seeds: std::ops::Range<u64>) -> (usize, usize) {
    let (mut all, mut right) = (0, 0);
    for seed in seeds {
        let specimen = specimen(seed);
        let truth: Vec<Quad> = specimen.truth.panels.iter().map(|panel| panel.quad_px).collect();
        let found = split(&specimen.picture);
        let is_found = |quad: &&Quad| found.panels.iter().any(|panel| iou(&panel.quad_px, quad) >= FOUND);
        all += truth.len();
        right += truth.iter().filter(is_found).count();
        let is_right = least_overlap(&found, &truth) >= FOUND;
        assert!(is_right || !found.is_certain(), "specimen {seed} is wrong without a doubt");
        if !found.is_certain() {
            println!("specimen {seed}: {}, {:?}", if is_right { "right" } else { "wrong" }, found.doubts);
        }
    }
    (all, right)
}

#[test]
fn random_specimens_are_found_or_doubted() {
    let (all, right) = split_specimens(0..8);
    assert_eq!(all, right);
}
