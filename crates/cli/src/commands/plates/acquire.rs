//! `muybridge plates fetch` and `muybridge plates add`: a plate onto this machine, and its manifest into the folder of plates.

use std::path::{Path, PathBuf};

use anyhow::{Context, anyhow, bail};
use clap::Args;
use image::GrayImage;
use indicatif::{HumanBytes, ProgressBar, ProgressDrawTarget, ProgressStyle};
use muybridge_capture::{Catalogue, CataloguePlate, Facing, Manifest, cache_folder, write_json};
use muybridge_core::Gait;
use muybridge_imaging::acquire::{
    AcquireError, OwnPlate, catalogue_identifier, find_panels, from_catalogue, from_files,
};
use muybridge_imaging::fetch::{FetchLimits, Progress, StoredPlate, fetch, stored};
use muybridge_imaging::{LoadLimits, load_gray};

use super::source::stem;
use super::split::print_panels;
use super::{CATALOGUE, gait};

/// Arguments of `fetch`.
#[derive(Debug, Args)]
pub(in crate::commands) struct FetchArguments {
    /// Numbers of the catalogue, such as 616.
    #[arg(required = true)]
    numbers: Vec<u32>,
    /// The catalogue file.
    #[arg(long, value_name = "FILE", default_value = CATALOGUE)]
    catalogue: PathBuf,
    #[command(flatten)]
    places: Places,
    /// Download again what is there already.
    #[arg(long)]
    again: bool,
    /// Most megapixels of a plate.
    #[arg(long, value_name = "N", default_value_t = 200, value_parser = clap::value_parser!(u64).range(1..=4000))]
    max_megapixels: u64,
    /// Most megabytes of a download.
    #[arg(long, value_name = "N", default_value_t = 400, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    max_megabytes: u64,
}

/// Arguments of `add`.
#[derive(Debug, Args)]
pub(in crate::commands) struct AddArguments {
    /// A scan of a plate, or a folder of frames.
    file: PathBuf,
    /// Gait of the title.
    #[arg(long, value_parser = gait)]
    gait: Gait,
    /// Identifier (default: the file's name).
    #[arg(long)]
    id: Option<String>,
    /// The animal's name.
    #[arg(long, default_value = "")]
    animal: String,
    /// Title as printed.
    #[arg(long, default_value = "")]
    title: String,
    /// Where the scan is from.
    #[arg(long, default_value = "")]
    source: String,
    /// Licence or rights statement.
    #[arg(long, default_value = "not stated")]
    licence: String,
    /// Which way the animal faces: left or right.
    #[arg(long, value_parser = facing)]
    facing: Option<Facing>,
    #[command(flatten)]
    places: Places,
}

/// Where plates go.
#[derive(Debug, Args)]
struct Places {
    /// Folder of the manifests.
    #[arg(long, value_name = "FOLDER", default_value = "plates")]
    plates: PathBuf,
    /// Folder of the pictures (default: `$MUYBRIDGE_CACHE`, or the system's cache folder).
    #[arg(long, value_name = "FOLDER")]
    cache: Option<PathBuf>,
}

fn facing(name: &str) -> Result<Facing, String> {
    match name {
        "left" => Ok(Facing::Left),
        "right" => Ok(Facing::Right),
        _ => Err("there is left and right".into()),
    }
}

impl Places {
    /// The folder of the pictures, made if need be.
    fn cache(&self) -> anyhow::Result<PathBuf> {
        let folder = self
            .cache
            .clone()
            .or_else(cache_folder)
            .context("this system has no cache folder; name one with --cache")?;
        std::fs::create_dir_all(&folder).with_context(|| {
            format!("{}: cannot be made; name another folder with --cache", folder.display())
        })?;
        Ok(folder)
    }

    fn manifest(&self, id: &str) -> PathBuf {
        self.plates.join(format!("{id}.json"))
    }
}

/// Gets plates of the catalogue; one that fails does not keep the others from coming.
pub(super) fn run_fetch(arguments: &FetchArguments) -> anyhow::Result<()> {
    let catalogue = Catalogue::read(&arguments.catalogue)?;
    let cache = arguments.places.cache()?;
    let mut failed = 0;
    for number in &arguments.numbers {
        if let Err(error) = fetch_one(arguments, &catalogue, *number, &cache) {
            eprintln!("plate {number}: {error:#}");
            failed += 1;
        }
    }
    if failed > 0 {
        bail!("{failed} of {} plates could not be had", arguments.numbers.len());
    }
    Ok(())
}

fn fetch_one(
    arguments: &FetchArguments,
    catalogue: &Catalogue,
    number: u32,
    cache: &Path,
) -> anyhow::Result<()> {
    let plate = catalogue
        .plates
        .iter()
        .find(|plate| plate.number == number)
        .context("not in the catalogue; `muybridge plates list` shows what is")?;
    let id = catalogue_identifier(number);
    let limits = FetchLimits {
        pixels: arguments.max_megapixels * 1_000_000,
        bytes: arguments.max_megabytes * 1_000_000,
        ..FetchLimits::default()
    };
    let target = cache.join(&id);
    let there = if arguments.again { None } else { stored(&target, limits.pixels)? };
    let picture = match there {
        Some(picture) => picture,
        None => download(number, plate, &target, &limits)?,
    };
    let StoredPlate { path, sha256, width_px, height_px, .. } = &picture;
    println!("{} ({width_px} x {height_px} px, sha256 {sha256})", path.display());
    let manifest = from_catalogue(catalogue, plate, &picture);
    record(&arguments.places.manifest(&id), manifest, &[picture.path])
}

fn download(
    number: u32,
    plate: &CataloguePlate,
    target: &Path,
    limits: &FetchLimits,
) -> anyhow::Result<StoredPlate> {
    let bar = bar(number);
    let fetched = fetch(&plate.iiif, target, limits, &mut |progress| show(&bar, &progress));
    bar.finish_and_clear();
    let fetched = fetched?;
    let [width, height] = fetched.full_px;
    if [width, height] != [fetched.plate.width_px, fetched.plate.height_px] {
        eprintln!("plate {number}: its service gives no more than this of its {width} x {height} px");
    }
    Ok(fetched.plate)
}

fn bar(number: u32) -> ProgressBar {
    // Hidden by indicatif itself when standard error is no terminal.
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("plate {prefix} {bar:30} {msg}") {
        bar.set_style(style);
    }
    bar.set_prefix(number.to_string());
    bar
}

fn show(bar: &ProgressBar, progress: &Progress) {
    match progress {
        Progress::Described { width_px, height_px } => {
            bar.set_message(format!("{width_px} x {height_px} px"));
        }
        Progress::Bytes { received, total } => {
            if let Some(total) = total {
                bar.set_length(*total);
            }
            bar.set_position(*received);
            bar.set_message(HumanBytes(*received).to_string());
        }
        Progress::Tiles { done, total, bytes } => {
            bar.set_length(u64::from(*total));
            bar.set_position(u64::from(*done));
            bar.set_message(format!("tile {done} of {total}, {}", HumanBytes(*bytes)));
        }
        Progress::Waiting { wait, cause } => {
            bar.set_message(format!("again in {:.0} s: {cause}", wait.as_secs_f64()));
        }
    }
}

/// Finds the panels and writes the manifest; one that is there is kept if it speaks of the same pictures.
fn record(path: &Path, mut manifest: Manifest, files: &[PathBuf]) -> anyhow::Result<()> {
    if path.exists() {
        let known = Manifest::read(path)?;
        let hashes =
            |manifest: &Manifest| manifest.images.iter().map(|i| i.sha256.clone()).collect::<Vec<_>>();
        if hashes(&known) != hashes(&manifest) {
            bail!(
                "{}: speaks of another picture (its hash differs); move the manifest away to start anew",
                path.display()
            );
        }
        println!("{}: kept as it is, of the same picture", path.display());
        return Ok(());
    }
    let pictures: Vec<GrayImage> = files
        .iter()
        .map(|file| Ok(load_gray(file, LoadLimits::default())?))
        .collect::<anyhow::Result<_>>()?;
    let found = find_panels(&pictures)?;
    manifest.panels.clone_from(&found.panels);
    print_panels(&found.into());
    write_json(path, &manifest)?;
    println!("{}", path.display());
    Ok(())
}

/// Takes a person's own scan or frames over into the cache and writes a manifest.
pub(super) fn run_add(arguments: &AddArguments) -> anyhow::Result<()> {
    let id = arguments.id.clone().unwrap_or_else(|| stem(&arguments.file));
    let plate = OwnPlate {
        id: id.clone(),
        gait: arguments.gait,
        animal: arguments.animal.clone(),
        title: arguments.title.clone(),
        source: arguments.source.clone(),
        licence: arguments.licence.clone(),
        facing: arguments.facing,
    };
    let cache = arguments.places.cache()?;
    let (manifest, files) = from_files(&arguments.file, plate, &cache).map_err(|error| match error {
        AcquireError::Identifier { id } => {
            anyhow!("--id {id:?}: letters, digits, dots, dashes and underscores only")
        }
        AcquireError::Taken { path } => {
            anyhow!("{}: another picture of this name is there; choose another --id", path.display())
        }
        error => error.into(),
    })?;
    record(&arguments.places.manifest(&id), manifest, &files)
}
