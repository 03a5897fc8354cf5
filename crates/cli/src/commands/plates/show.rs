//! `muybridge plates show`: what is seen in the panels, drawn over them.

use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::{Args, ValueEnum};
use image::{DynamicImage, GrayImage, Rgb, imageops};
use imageproc::morphology::{Mask, grayscale_dilate};
use muybridge_capture::{ANNOTATION_SCHEMA, Annotation, Panel, read_json};
use muybridge_imaging::PanelView;
use muybridge_imaging::see::{Line, Silhouette, Wall, hoof_candidates, silhouettes, walls};
use muybridge_imaging::track::{PanelPoints, Tracked, track};

use super::source::PlateSource;
use crate::commands::canvas::{Canvas, write_picture};

/// Longer side of the pictures that are looked at, px.
const VIEW_PX: u32 = 700;
const GAP: u32 = 8;
/// Height of the caption under a panel, px.
const CAPTION: u32 = 26;
/// Largest picture drawn, px: 0.6 GB of memory.
const LARGEST_PX: u64 = 200_000_000;
const PAPER: Rgb<u8> = Rgb([236, 232, 222]);
const INK: Rgb<u8> = Rgb([40, 36, 30]);
const SILHOUETTE: Rgb<u8> = Rgb([255, 214, 10]);
/// Inside of a silhouette on blank paper.
const SHADE: Rgb<u8> = Rgb([120, 112, 102]);
const GROUND: Rgb<u8> = Rgb([60, 140, 255]);
const UPRIGHT: Rgb<u8> = Rgb([40, 220, 90]);
const HORIZONTAL: Rgb<u8> = Rgb([90, 190, 160]);
const HOOF: Rgb<u8> = Rgb([255, 120, 30]);
const TRUSTED: Rgb<u8> = Rgb([40, 220, 90]);
const DOUBTED: Rgb<u8> = Rgb([255, 60, 40]);

/// What can be drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Layer {
    /// Outline of horse and rider.
    Silhouette,
    /// Ground line.
    Ground,
    /// Uprights of the wall.
    Uprights,
    /// Horizontal lines of the wall.
    Horizontals,
    /// Hooves near the ground.
    Hooves,
    /// Points of the annotation tracked from the two panels before, with a line to where they were placed.
    Tracks,
}

/// Arguments of `show`.
#[derive(Debug, Args)]
pub(in crate::commands) struct ShowArguments {
    /// A catalogue number, identifier, manifest, picture or folder of frames.
    plate: String,
    /// What to draw (default: all but tracks).
    #[arg(long, value_name = "LAYERS", value_delimiter = ',')]
    layers: Vec<Layer>,
    /// Annotation to track from (default: the plate's in `annotations/`).
    #[arg(long, value_name = "FILE")]
    annotation: Option<PathBuf>,
    /// Only these panels.
    #[arg(long, value_name = "N", value_delimiter = ',')]
    panels: Vec<u32>,
    /// Panels in a row.
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=24))]
    columns: u32,
    /// Draw on blank paper instead of over the photographs.
    #[arg(long)]
    drawing: bool,
    /// Picture to write (PNG; default: `target/<identifier>-seen.png`).
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

/// Everything that is seen, panel by panel.
struct Seen {
    panels: Vec<Panel>,
    views: Vec<PanelView>,
    silhouettes: Vec<Silhouette>,
    walls: Vec<Wall>,
    /// Tracked points and where a person placed them, panel px.
    tracks: Vec<Vec<(Tracked, Option<[f64; 2]>)>>,
}

pub(super) fn run_show(arguments: &ShowArguments) -> anyhow::Result<()> {
    let source = PlateSource::find(&arguments.plate)?;
    let pictures = source.pictures()?;
    let panels = source.panels(&pictures)?;
    for (_, doubt) in &panels.doubts {
        eprintln!("panels uncertain: {doubt}");
    }
    let mut seen = see(panels.panels, &pictures)?;
    let layers = if arguments.layers.is_empty() {
        vec![Layer::Silhouette, Layer::Ground, Layer::Uprights, Layer::Horizontals, Layer::Hooves]
    } else {
        arguments.layers.clone()
    };
    if layers.contains(&Layer::Tracks) {
        let path = arguments.annotation.clone().unwrap_or_else(|| annotation_of(&source));
        seen.tracks = tracks(&seen, &read_json(&path, ANNOTATION_SCHEMA)?);
    }
    let wanted: Vec<usize> = (0..seen.panels.len())
        .filter(|i| arguments.panels.is_empty() || arguments.panels.contains(&seen.panels[*i].panel))
        .collect();
    let picture = sheet(&seen, &wanted, &layers, arguments)
        .context("no panel to draw, or a picture of more than 200 megapixels; check --panels")?;
    let out =
        arguments.out.clone().unwrap_or_else(|| Path::new("target").join(format!("{}-seen.png", source.id)));
    write_picture(&out, &picture)?;
    println!("{}", out.display());
    Ok(())
}

/// An annotation lies in `annotations/`, next to the folder of the manifest or in it.
fn annotation_of(source: &PlateSource) -> PathBuf {
    let name = format!("{}.json", source.id);
    let manifest = source.manifest.as_ref().map(|(path, _)| path.as_path());
    let folder = manifest.and_then(Path::parent).unwrap_or(Path::new("."));
    let within = folder.join("annotations").join(&name);
    if within.exists() { within } else { folder.join("..").join("annotations").join(name) }
}

fn see(panels: Vec<Panel>, pictures: &[GrayImage]) -> anyhow::Result<Seen> {
    let mut views = Vec::new();
    for panel in &panels {
        let picture = pictures.get(panel.image).context("a panel names a picture that is not there")?;
        let view = PanelView::new(picture, panel.quad_px, VIEW_PX);
        views.push(view.with_context(|| format!("panel {}: its corners enclose no area", panel.panel))?);
    }
    let tracks = vec![Vec::new(); panels.len()];
    let found = silhouettes(&views);
    Ok(Seen { walls: walls(&views, &found), silhouettes: found, tracks, panels, views })
}

/// Points of each panel tracked from the annotated panels before it.
fn tracks(seen: &Seen, annotation: &Annotation) -> Vec<Vec<(Tracked, Option<[f64; 2]>)>> {
    let points =
        |i: usize| annotation.panels.iter().find(|p| p.panel == seen.panels[i].panel).map(|p| &p.keypoints);
    (0..seen.views.len())
        .map(|i| {
            let known: Vec<PanelPoints> = (i.saturating_sub(2)..i)
                .filter_map(|k| {
                    let silhouette = Some(&seen.silhouettes[k].mask);
                    Some(PanelPoints { view: &seen.views[k], silhouette, points: points(k)? })
                })
                .collect();
            let view = &seen.views[i];
            let panel_px = |at| view.transform.panel_from_plate(at);
            track(&known, view, Some(&seen.silhouettes[i].mask))
                .into_iter()
                .map(|tracked| {
                    let placed = points(i).and_then(|points| points.place(tracked.keypoint)).map(panel_px);
                    (Tracked { at_px: panel_px(tracked.at_px), ..tracked }, placed)
                })
                .collect()
        })
        .collect()
}

fn sheet(
    seen: &Seen,
    wanted: &[usize],
    layers: &[Layer],
    arguments: &ShowArguments,
) -> Option<image::RgbImage> {
    let size = |pick: fn(&GrayImage) -> u32| wanted.iter().map(|i| pick(&seen.views[*i].image)).max();
    let (cell_width, cell_height) = (size(GrayImage::width)? + GAP, size(GrayImage::height)? + CAPTION + GAP);
    let columns = arguments.columns.min(wanted.len() as u32);
    let rows = (wanted.len() as u32).div_ceil(columns);
    let area = u64::from(columns) * u64::from(cell_width) * u64::from(rows) * u64::from(cell_height);
    if area > LARGEST_PX {
        return None;
    }
    let mut canvas = Canvas::new(columns * cell_width + GAP, rows * cell_height + GAP, PAPER);
    for (cell, i) in (0..).zip(wanted) {
        let at = [GAP + cell % columns * cell_width, GAP + cell / columns * cell_height];
        draw_panel(&mut canvas, at, seen, *i, layers, arguments.drawing);
    }
    Some(canvas.picture)
}

fn draw_panel(canvas: &mut Canvas, at: [u32; 2], seen: &Seen, i: usize, layers: &[Layer], drawing: bool) {
    let (view, silhouette, wall) = (&seen.views[i], &seen.silhouettes[i], &seen.walls[i]);
    let place = |p: [f64; 2]| [f64::from(at[0]) + p[0], f64::from(at[1]) + p[1]];
    if !drawing {
        let photograph = DynamicImage::from(view.image.clone()).into_rgb8();
        imageops::replace(&mut canvas.picture, &photograph, i64::from(at[0]), i64::from(at[1]));
    }
    let has = |layer| layers.contains(&layer);
    if has(Layer::Silhouette) {
        draw_silhouette(canvas, at, &silhouette.mask, drawing);
    }
    let mut lines: Vec<(&Line, Rgb<u8>)> = Vec::new();
    if has(Layer::Horizontals) {
        lines.extend(wall.horizontals.iter().map(|line| (line, HORIZONTAL)));
    }
    if has(Layer::Uprights) {
        lines.extend(wall.uprights.iter().map(|line| (line, UPRIGHT)));
    }
    if has(Layer::Ground) {
        lines.extend(wall.ground.iter().map(|line| (line, GROUND)));
    }
    for (line, colour) in lines {
        canvas.line(place(line.ends_px[0]), place(line.ends_px[1]), 1.5, colour);
    }
    if has(Layer::Hooves) {
        for hoof in hoof_candidates(silhouette, wall.ground.as_ref()) {
            canvas.ring(place(hoof.at_px), 5, HOOF);
        }
    }
    for (tracked, placed) in &seen.tracks[i] {
        let colour = if tracked.quality >= 0.5 { TRUSTED } else { DOUBTED };
        if let Some(placed) = placed {
            canvas.line(place(tracked.at_px), place(*placed), 1.5, colour);
        }
        canvas.dot(place(tracked.at_px), 3, colour);
    }
    let caption = format!("{}  silhouette sure to {:.2}", seen.panels[i].panel, silhouette.confidence);
    canvas.text([f64::from(at[0]), f64::from(at[1] + view.image.height()) + 4.0], &caption, INK);
}

/// The pixels just outside a mask; on blank paper its inside, too.
fn draw_silhouette(canvas: &mut Canvas, [left, top]: [u32; 2], mask: &GrayImage, drawing: bool) {
    let grown = grayscale_dilate(mask, &Mask::diamond(1));
    for (x, y, _) in grown.enumerate_pixels().filter(|(_, _, pixel)| pixel.0[0] > 127) {
        let inside = mask.get_pixel(x, y).0[0] > 127;
        match (inside, drawing) {
            (false, _) => canvas.picture.put_pixel(left + x, top + y, SILHOUETTE),
            (true, true) => canvas.picture.put_pixel(left + x, top + y, SHADE),
            (true, false) => {}
        }
    }
}
