//! `muybridge annotations`: look at annotations, check them, compare two passes over the same plate, and exchange them
//! with other tools.

use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::{Args, Subcommand};
use muybridge_capture::{ANNOTATION_SCHEMA, Annotation, Plate, hash_file, read_json};
use muybridge_core::Skeleton;
use muybridge_fitting::pipeline::fit_plate;
use muybridge_fitting::repeatability::Repeatability;
use muybridge_fitting::weights::Weights;
use muybridge_imaging::{LoadLimits, load_rgb};

use super::canvas::write_picture;
use super::contact_sheet::ContactSheet;
use super::exchange::{ExportArguments, ImportArguments, run_export, run_import};

/// Folder of annotations when only a plate's identifier is given.
const FOLDER: &str = "annotations";

/// The subcommands.
#[derive(Debug, Subcommand)]
pub(super) enum AnnotationsCommand {
    /// Read annotations and say what is wrong with them. Example: `muybridge annotations check sallie-gardner-1878`
    Check(CheckArguments),
    /// Distance between two passes over the same panels. Example: `muybridge annotations compare first.json second.json`
    Compare(CompareArguments),
    /// Draw points, skeleton and fit over the photographs. Example: `muybridge annotations show sallie-gardner-1878`
    Show(ShowArguments),
    /// Write points for `DeepLabCut`, COCO, labelme or as a table. Example: `muybridge annotations export sallie-gardner-1878 --format coco --out sallie`
    Export(ExportArguments),
    /// Take points over from such files. Example: `muybridge annotations import CollectedData_me.csv --into sallie-gardner-1878 --out mine.json`
    Import(ImportArguments),
}

/// Arguments of `check`.
#[derive(Debug, Args)]
pub(super) struct CheckArguments {
    /// Plate identifiers or annotation files.
    #[arg(required = true)]
    plates: Vec<String>,
}

/// Arguments of `compare`.
#[derive(Debug, Args)]
pub(super) struct CompareArguments {
    /// Plate identifier or annotation file of the first pass.
    first: String,
    /// Annotation file of the second pass.
    second: PathBuf,
}

/// Arguments of `show`.
#[derive(Debug, Args)]
pub(super) struct ShowArguments {
    /// Plate identifier or annotation file.
    plate: String,
    /// Picture to write (PNG).
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Where the plate's image is, if not where its manifest says.
    #[arg(long, value_name = "FILE")]
    image: Option<PathBuf>,
    /// Only these panels.
    #[arg(long, value_name = "N", value_delimiter = ',')]
    panels: Vec<u32>,
    /// Enlargement, 1 to 8.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=8))]
    zoom: u32,
    /// Panels in a row.
    #[arg(long, default_value_t = 4, value_parser = clap::value_parser!(u32).range(1..=24))]
    columns: u32,
    /// Leave the fit away and draw the placed points alone.
    #[arg(long)]
    points_only: bool,
}

impl AnnotationsCommand {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        match self {
            Self::Check(arguments) => check(arguments),
            Self::Compare(arguments) => compare(arguments),
            Self::Show(arguments) => show(arguments),
            Self::Export(arguments) => run_export(&annotation_path(&arguments.plate), arguments),
            Self::Import(arguments) => run_import(&annotation_path(&arguments.into), arguments),
        }
    }
}

/// An annotation file by its path, or by the identifier of its plate.
fn annotation_path(plate: &str) -> PathBuf {
    if plate.ends_with(".json") {
        PathBuf::from(plate)
    } else {
        Path::new(FOLDER).join(format!("{plate}.json"))
    }
}

fn check(arguments: &CheckArguments) -> anyhow::Result<()> {
    let mut bad = 0;
    for plate in &arguments.plates {
        match Plate::load(&annotation_path(plate)) {
            Ok(plate) => println!(
                "{}: good ({} panels, images {})",
                plate.annotation_path.display(),
                plate.annotation.panels.len(),
                format!("{:?}", plate.images).to_lowercase(),
            ),
            Err(error) => {
                println!("{:#}", anyhow::Error::new(error));
                bad += 1;
            }
        }
    }
    if bad > 0 {
        bail!("{bad} of {} annotations cannot be used", arguments.plates.len());
    }
    Ok(())
}

fn compare(arguments: &CompareArguments) -> anyhow::Result<()> {
    let plate = Plate::load(&annotation_path(&arguments.first))?;
    let second: Annotation = read_json(&arguments.second, ANNOTATION_SCHEMA)?;
    let calibration = muybridge_capture::calibrate(&plate.manifest, &plate.annotation)
        .with_context(|| plate.annotation_path.display().to_string())?;
    match Repeatability::new(&plate.annotation, &second, &calibration) {
        Some(repeatability) => print!("{repeatability}"),
        None => bail!("the two files share no panel with points in both"),
    }
    Ok(())
}

fn show(arguments: &ShowArguments) -> anyhow::Result<()> {
    let path = annotation_path(&arguments.plate);
    let plate = Plate::load(&path)?;
    let images = images(&plate, arguments.image.as_deref())?;
    let fitted = if arguments.points_only {
        None
    } else {
        Some(fit_plate(&path, &Skeleton::reference(), &Weights::default())?)
    };
    let sheet = ContactSheet {
        plate: &plate,
        fit: fitted.as_ref(),
        images,
        zoom: arguments.zoom,
        columns: arguments.columns,
    };
    let picture = sheet
        .draw(&arguments.panels)
        .context("no panel to draw, or a picture of more than 200 megapixels; check --panels and --zoom")?;
    let out = match &arguments.out {
        Some(out) => out.clone(),
        None => PathBuf::from("target").join(format!("{}.png", plate.manifest.id)),
    };
    write_picture(&out, &picture)?;
    println!("{}", out.display());
    Ok(())
}

/// The plate's images; none for one that is not on this machine, which is said.
fn images(plate: &Plate, instead: Option<&Path>) -> anyhow::Result<Vec<Option<image::RgbImage>>> {
    let mut images = Vec::new();
    for (index, known) in plate.manifest.images.iter().enumerate() {
        let path = instead.map_or_else(|| plate.image_path(index), Path::to_path_buf);
        if !path.exists() && instead.is_none() {
            eprintln!(
                "{}: not on this machine; drawing on blank paper (--image names another place)",
                path.display()
            );
            images.push(None);
            continue;
        }
        if hash_file(&path)? != known.sha256 {
            bail!(
                "{}: not the image the points were placed on (its hash differs from the manifest's)",
                path.display()
            );
        }
        images.push(Some(load_rgb(&path, LoadLimits::default())?));
    }
    Ok(images)
}
