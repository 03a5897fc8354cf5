//! `muybridge plates specimen`: draws plates whose truth is known.

use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::Args;
use muybridge_capture::{hash_file, write_atomically, write_json};
use muybridge_core::Gait;
use muybridge_imaging::specimen::{Specimen, SpecimenStyle, draw, encode};

use super::gait;
use crate::specimens::{KEPT_SEED, PANELS, motion, style};

/// Arguments of `specimen`.
#[derive(Debug, Args)]
pub(in crate::commands) struct SpecimenArguments {
    /// Gaits: walk, amble, trot, rack, canter, gallop, leap (default: all).
    #[arg(value_parser = gait)]
    gaits: Vec<Gait>,
    /// Seed of the horse, its motion and all chance in the picture.
    #[arg(long, default_value_t = KEPT_SEED)]
    seed: u64,
    /// Panels of the sequence.
    #[arg(long, default_value_t = PANELS, value_parser = panels)]
    panels: usize,
    /// A random look: columns, rows, tilt, mount, gutters, light, grain, scratches from the seed.
    #[arg(long)]
    random: bool,
    /// Folder to write to.
    #[arg(long, value_name = "FOLDER", default_value = "plates/specimens")]
    out: PathBuf,
}

fn panels(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|n| (4..=48).contains(n)).ok_or_else(|| "between 4 and 48".into())
}

pub(super) fn run_specimen(arguments: &SpecimenArguments) -> anyhow::Result<()> {
    let annotations = arguments.out.join("annotations");
    std::fs::create_dir_all(&annotations).with_context(|| {
        format!("{}: cannot be made; name another folder with --out", annotations.display())
    })?;
    let gaits = if arguments.gaits.is_empty() { Gait::ALL.to_vec() } else { arguments.gaits.clone() };
    for gait in gaits {
        let look = if arguments.random {
            SpecimenStyle::random(arguments.seed)
        } else {
            style(gait, arguments.seed, arguments.panels)
        };
        let specimen = draw(&motion(gait, arguments.seed, arguments.panels), &look);
        let path = write(&arguments.out, &name(gait, arguments), &specimen)?;
        println!("{}", path.display());
    }
    Ok(())
}

/// The kept specimens have the plain names.
fn name(gait: Gait, arguments: &SpecimenArguments) -> String {
    let mut name = format!("specimen-{gait}");
    if arguments.random {
        name.push_str("-random");
    }
    if arguments.seed != KEPT_SEED {
        name.push_str(&format!("-{}", arguments.seed));
    }
    if arguments.panels != PANELS {
        name.push_str(&format!("-{}-panels", arguments.panels));
    }
    name
}

/// Writes picture, manifest, truth and annotation; the path of the picture.
fn write(folder: &Path, id: &str, specimen: &Specimen) -> anyhow::Result<PathBuf> {
    let bytes = encode(specimen);
    if bytes.is_empty() {
        bail!("{id}: the picture cannot be encoded");
    }
    let file = format!("{id}.jpg");
    let picture = folder.join(&file);
    write_atomically(&picture, &bytes)?;
    let sha256 = hash_file(&picture)?;
    let manifest = specimen.truth.manifest(id, &file, &sha256);
    write_json(&folder.join(format!("{id}.json")), &manifest)?;
    write_json(&folder.join(format!("{id}.truth.json")), &specimen.truth)?;
    let annotation = specimen.truth.annotation(&format!("../{id}.json"), &sha256);
    write_json(&folder.join("annotations").join(format!("{id}.json")), &annotation)?;
    Ok(picture)
}
