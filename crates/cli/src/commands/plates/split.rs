//! `muybridge plates split`: the panels of a plate, printed and drawn.

use std::path::{Path, PathBuf};

use anyhow::bail;
use clap::Args;
use comfy_table::{CellAlignment, Table, presets::NOTHING};
use image::{DynamicImage, GrayImage, Rgb, imageops};
use muybridge_capture::{Panel, write_json};
use muybridge_imaging::acquire::find_panels;

use super::source::{Panels, PlateSource};
use crate::commands::canvas::{Canvas, write_picture};

/// Longer side of a drawn plate, px.
const LONGEST_PX: u32 = 2400;
/// Below this confidence a panel is drawn as doubtful.
const SURE: f64 = 0.5;
const GOOD: Rgb<u8> = Rgb([40, 220, 90]);
const DOUBTFUL: Rgb<u8> = Rgb([255, 60, 40]);
const PAPER: Rgb<u8> = Rgb([236, 232, 222]);

/// Arguments of `split`.
#[derive(Debug, Args)]
pub(in crate::commands) struct SplitArguments {
    /// A catalogue number, identifier, manifest, picture or folder of frames.
    plate: String,
    /// Picture to draw (PNG; default: `target/<identifier>-panels.png`).
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Draw the panels on blank paper instead of over the photograph.
    #[arg(long)]
    drawing: bool,
    /// Write the panels found into the plate's manifest, which must have none.
    #[arg(long)]
    write: bool,
    /// With --write: replace panels that the manifest has.
    #[arg(long, requires = "write")]
    replace: bool,
}

pub(super) fn run_split(arguments: &SplitArguments) -> anyhow::Result<()> {
    let source = PlateSource::find(&arguments.plate)?;
    let pictures = source.pictures()?;
    let found = Panels::from(find_panels(&pictures)?);
    print_panels(&found);
    let out = arguments
        .out
        .clone()
        .unwrap_or_else(|| Path::new("target").join(format!("{}-panels.png", source.id)));
    write_picture(&out, &draw_panels(&pictures, &found, arguments.drawing))?;
    println!("{}", out.display());
    if arguments.write {
        write_panels(source, found, arguments.replace)?;
    }
    Ok(())
}

fn write_panels(source: PlateSource, found: Panels, replace: bool) -> anyhow::Result<()> {
    let Some((path, mut manifest)) = source.manifest else {
        bail!("--write: the plate has no manifest; make one with `muybridge plates add`");
    };
    if !manifest.panels.is_empty() && !replace {
        bail!(
            "{}: has {} panels already, perhaps corrected by hand; --replace to lose them",
            path.display(),
            manifest.panels.len()
        );
    }
    manifest.panels = found.panels;
    write_json(&path, &manifest)?;
    println!("{}", path.display());
    Ok(())
}

/// Prints panels as a table, and every reason to doubt them.
pub(super) fn print_panels(found: &Panels) {
    let mut table = Table::new();
    table.load_style(NOTHING).set_header([
        "panel",
        "sure",
        "top left",
        "top right",
        "bottom right",
        "bottom left",
    ]);
    for (i, panel) in found.panels.iter().enumerate() {
        let sure = found.confidence.as_ref().map_or_else(String::new, |c| format!("{:.2}", c[i]));
        let corners = panel.quad_px.map(|[x, y]| format!("{x:.1} {y:.1}"));
        table.add_row([panel.panel.to_string(), sure].into_iter().chain(corners));
    }
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Right);
    }
    println!("{}", table.trim_fmt());
    for (image, doubt) in &found.doubts {
        let which = if found.panels.last().is_some_and(|panel| panel.image > 0) {
            format!("picture {}: ", image + 1)
        } else {
            String::new()
        };
        println!("uncertain: {which}{doubt}");
    }
    if !found.doubts.is_empty() {
        println!("look at the drawing, and correct corners by hand in the manifest (`panels[].quad_px`)");
    }
}

/// The first picture with its panels; frames of a folder have one each, all alike.
fn draw_panels(pictures: &[GrayImage], found: &Panels, drawing: bool) -> image::RgbImage {
    let picture = &pictures[0];
    let scale = (f64::from(LONGEST_PX) / f64::from(picture.width().max(picture.height()))).min(1.0);
    let [width, height] =
        [picture.width(), picture.height()].map(|side| ((f64::from(side) * scale).round() as u32).max(1));
    let mut canvas = Canvas::new(width, height, PAPER);
    if !drawing {
        let small = imageops::thumbnail(picture, width, height);
        canvas.picture = DynamicImage::from(small).into_rgb8();
    }
    for (i, panel) in found.panels.iter().enumerate().filter(|(_, panel)| panel.image == 0) {
        let sure = found.confidence.as_ref().is_none_or(|confidence| confidence[i] >= SURE);
        draw_panel(&mut canvas, panel, scale, if sure { GOOD } else { DOUBTFUL });
    }
    canvas.picture
}

fn draw_panel(canvas: &mut Canvas, panel: &Panel, scale: f64, colour: Rgb<u8>) {
    let corners = panel.quad_px.map(|corner| corner.map(|v| v * scale));
    for i in 0..4 {
        canvas.line(corners[i], corners[(i + 1) % 4], 2.0, colour);
    }
    let [x, y] = panel.centre_px().map(|v| v * scale);
    canvas.text([x, y], &panel.panel.to_string(), colour);
}
