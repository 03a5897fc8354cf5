//! How long a large plate takes to open and split, in how much memory, and how long 24 silhouettes take.
//!
//! The large plate is drawn by a process of its own, so that its memory is not counted.

#![allow(clippy::unwrap_used, reason = "a benchmark stops at the first thing it cannot do")]

use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

use image::imageops::{FilterType, resize};
use image::{GrayImage, ImageFormat};
use muybridge_cli::specimens::kept;
use muybridge_core::{Gait, Random};
use muybridge_imaging::see::silhouettes;
use muybridge_imaging::split::split;
use muybridge_imaging::{LoadLimits, PanelView, frames, load_gray};
use muybridge_tests::shared_folder;

/// Sides of the large plate, px: 50 megapixels.
const LARGE_PX: [u32; 2] = [8640, 5800];
/// Standard deviation of its grain, grey values.
const GRAIN_SD: f64 = 4.0;
const MOST_SPLIT_S: f64 = 1.5;
const MOST_SPLIT_MB: f64 = 600.0;
const MOST_SILHOUETTES_S: f64 = 1.0;
const SILHOUETTES: usize = 24;
/// Longer side of a view, as `muybridge plates show` uses it.
const VIEW_PX: u32 = 700;
/// Timed runs; the median counts.
const RUNS: usize = 5;

fn main() {
    let arguments: Vec<String> = std::env::args().collect();
    if let Some(at) = arguments.iter().position(|argument| argument == "--draw") {
        return draw_large(Path::new(&arguments[at + 1]));
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.jpg");
    let status = Command::new(std::env::current_exe().unwrap()).arg("--draw").arg(&path).status().unwrap();
    assert!(status.success());
    large_plate(&path);
    silhouettes_of_a_plate();
}

/// A specimen, enlarged, with grain of its own size.
fn draw_large(path: &Path) {
    let small = kept(Gait::Gallop).picture;
    let mut large = resize(&small, LARGE_PX[0], LARGE_PX[1], FilterType::Triangle);
    let mut random = Random::new(1);
    for pixel in large.pixels_mut() {
        pixel.0[0] = (f64::from(pixel.0[0]) + GRAIN_SD * random.normal()).round().clamp(0.0, 255.0) as u8;
    }
    large.save_with_format(path, ImageFormat::Jpeg).unwrap();
}

fn large_plate(path: &Path) {
    println!("large plate: {} x {} px, {:.1} MB", LARGE_PX[0], LARGE_PX[1], megabytes(path));
    let mut times: Vec<[f64; 2]> = Vec::new();
    let mut panels = 0;
    for _ in 0..RUNS {
        let start = Instant::now();
        let picture = load_gray(path, LoadLimits::default()).unwrap();
        let opened = start.elapsed().as_secs_f64();
        panels = split(&picture).panels.len();
        times.push([opened, start.elapsed().as_secs_f64()]);
    }
    times.sort_by(|a, b| a[1].total_cmp(&b[1]));
    let [opened, all] = times[RUNS / 2];
    println!("panels found: {panels} (of 12)");
    report("open and split", all, "s", MOST_SPLIT_S);
    println!("  opening alone: {opened:.3} s; open and split takes {:.2} times that", all / opened);
    if let Some(peak) = peak_memory_mb() {
        report("peak memory", peak, "MB", MOST_SPLIT_MB);
    }
}

fn silhouettes_of_a_plate() {
    let (name, views) = views();
    let start = Instant::now();
    let found = silhouettes(&views).len();
    let seconds = start.elapsed().as_secs_f64();
    println!("silhouettes of {name}: {found}");
    report("24 silhouettes", seconds, "s", MOST_SILHOUETTES_S);
}

/// 24 panels: of plate 614 where it is at hand, else of drawn specimens.
fn views() -> (String, Vec<PanelView>) {
    let whole = |picture: &GrayImage| {
        let (width, height) = (f64::from(picture.width()), f64::from(picture.height()));
        PanelView::new(picture, [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]], VIEW_PX).unwrap()
    };
    if let Some(folder) = shared_folder().map(|folder| folder.join("plates/flode-holden-614")) {
        let paths: Vec<PathBuf> = frames(&folder).unwrap();
        let pictures =
            paths.iter().take(SILHOUETTES).map(|path| load_gray(path, LoadLimits::default()).unwrap());
        return ("plate 614, Flode Holden".into(), pictures.map(|picture| whole(&picture)).collect());
    }
    println!("no shared plates: specimens instead of a real plate");
    let views = [Gait::Trot, Gait::Gallop].into_iter().flat_map(|gait| {
        let specimen = kept(gait);
        let quads: Vec<_> = specimen.truth.panels.iter().map(|panel| panel.quad_px).collect();
        quads.into_iter().map(move |quad| PanelView::new(&specimen.picture, quad, VIEW_PX).unwrap())
    });
    ("specimens".into(), views.collect())
}

fn report(what: &str, value: f64, unit: &str, most: f64) {
    let verdict = if value <= most { "met" } else { "MISSED" };
    println!("{what}: {value:.3} {unit} (at most {most} {unit}: {verdict})");
}

fn megabytes(path: &Path) -> f64 {
    std::fs::metadata(path).unwrap().len() as f64 / 1e6
}

/// Largest memory this process has used so far; none where the system does not tell.
fn peak_memory_mb() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<f64>().ok()? / 1000.0)
}
