//! The main job: read `annotations/`, fit everything, print one table, write the database and the report.

mod check;
mod compare;
mod json;
mod plates;
mod preset;
mod table;

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use anyhow::Context;
use clap::{Parser, ValueEnum};
use muybridge_capture::{write_atomically, write_json};
use muybridge_core::{Database, Skeleton};
use muybridge_fitting::fit_document::FitDocument;
use muybridge_fitting::gait_laws::{Evidence, GaitLaw, gait_laws};
use muybridge_fitting::motion_database::build_database;
use muybridge_fitting::pipeline::PlateFit;

use crate::{EXIT_FAILED, EXIT_USAGE, report_error};

/// Where the committed database is, seen from the repository's root.
const DATABASE: &str = "crates/core/data/motion.json";

/// Fits every annotated plate: strides, contacts, contact-time laws by gait, the motion database and a report.
#[derive(Debug, Parser)]
#[command(name = "fit-gaits", version, after_long_help = EXAMPLES)]
pub struct Arguments {
    /// Folder of annotation files (*.json; folders inside it are not read).
    #[arg(long, value_name = "DIR", default_value = "annotations")]
    pub annotations: PathBuf,
    /// Fit only this plate (its identifier, e.g. sallie-gardner-1878); may be given several times. The database is then
    /// written only if --out names a file.
    #[arg(long, value_name = "PLATE")]
    pub only: Vec<String>,
    /// Database file to write, or to compare with under --check [default: crates/core/data/motion.json].
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
    /// Folder for the report and the fitted poses.
    #[arg(long, value_name = "DIR", default_value = "target/fit-report")]
    pub report: PathBuf,
    /// Print one JSON document on standard output instead of the table.
    #[arg(long)]
    pub json: bool,
    /// Write no database; say whether the one that is there is what the annotations give (exit code 1 if not).
    #[arg(long)]
    pub check: bool,
    /// Fit a published table instead of the annotations; --only then takes gaits.
    #[arg(long, value_name = "NAME")]
    pub preset: Option<Preset>,
}

const EXAMPLES: &str = "\
Examples:
  fit-gaits                              fit everything in annotations/
  fit-gaits --only sallie-gardner-1878   one plate, without touching the database
  fit-gaits --check                      is the committed database up to date?
  fit-gaits --preset huang-2012 --json   the published contact-time laws, as JSON

Exit codes: 0 done; 1 something could not be fitted or written, or the database is stale; 2 wrong usage.";

/// Published tables.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Preset {
    /// Contact times of eleven clips and six gaits: Huang 2012, Fig. 3.9.
    #[value(name = "huang-2012")]
    Huang2012,
}

/// Everything one run found out.
struct Outcome {
    fits: Vec<PlateFit>,
    laws: Vec<GaitLaw>,
    database: Database,
    failures: Vec<String>,
}

/// Runs the program.
pub fn run(arguments: &Arguments) -> ExitCode {
    let skeleton = Skeleton::reference();
    let outcome = match (arguments.preset, arguments.only.as_slice()) {
        (Some(Preset::Huang2012), only) => preset::outcome(only),
        (None, only) => fit_annotations(&arguments.annotations, only, &skeleton),
    };
    let outcome = match outcome {
        Ok(outcome) => outcome,
        Err(error) => return report_error(&error, EXIT_USAGE),
    };
    match write_outcome(arguments, &outcome, &skeleton) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::from(EXIT_FAILED),
        Err(error) => report_error(&error, EXIT_FAILED),
    }
}

fn fit_annotations(folder: &Path, only: &[String], skeleton: &Skeleton) -> anyhow::Result<Outcome> {
    let paths = plates::annotation_paths(folder, only)?;
    let (fits, mut failures) = plates::fit_all(&paths, skeleton);
    if paths.is_empty() {
        failures.push(format!("{}: holds no annotation file (*.json)", folder.display()));
    }
    let (walks, walks_sha256) = match plates::tracked_walks(folder) {
        Ok(table) => table,
        Err(error) => {
            failures.push(error.to_string());
            Default::default()
        }
    };
    let evidence = Evidence { fits: &fits, walks: &walks, walks_sha256: &walks_sha256 };
    let laws = gait_laws(&evidence);
    let database = build_database(&evidence, skeleton);
    Ok(Outcome { fits, laws, database, failures })
}

/// Prints and writes; true when all went well.
fn write_outcome(arguments: &Arguments, outcome: &Outcome, skeleton: &Skeleton) -> anyhow::Result<bool> {
    if arguments.json {
        print!("{}", muybridge_capture::to_stable_json(&json::document(outcome)));
    } else {
        print!("{}", table::text(outcome));
    }
    for failure in &outcome.failures {
        eprintln!("not fitted: {failure}");
    }
    write_report(arguments, outcome, skeleton)?;
    let fresh = if arguments.check {
        check_database(arguments, outcome)?
    } else {
        write_database(arguments, outcome)?
    };
    Ok(fresh && outcome.failures.is_empty())
}

fn write_report(arguments: &Arguments, outcome: &Outcome, skeleton: &Skeleton) -> anyhow::Result<()> {
    let folder = &arguments.report;
    std::fs::create_dir_all(folder)
        .with_context(|| format!("{}: cannot create the report's folder", folder.display()))?;
    for fitted in &outcome.fits {
        write_json(&folder.join(format!("{}.fit.json", fitted.id())), &FitDocument::new(fitted, skeleton))?;
    }
    let Outcome { fits, laws, database, failures } = outcome;
    let page = muybridge_fitting::report::html(fits, laws, database, failures, skeleton);
    let path = folder.join("index.html");
    write_atomically(&path, page.as_bytes())?;
    eprintln!("report: {}", path.display());
    Ok(())
}

/// Whether the database file is what this run gives.
fn check_database(arguments: &Arguments, outcome: &Outcome) -> anyhow::Result<bool> {
    if arguments.preset.is_some() {
        let differences = preset::differences(&outcome.laws);
        differences.iter().for_each(|difference| eprintln!("published table: {difference}"));
        return Ok(differences.is_empty());
    }
    let path = arguments.out.as_deref().unwrap_or(Path::new(DATABASE));
    let text = muybridge_capture::read_text(path)?;
    let committed = Database::from_json(&text).with_context(|| path.display().to_string())?;
    let differences = check::differences(&committed, &outcome.database, &arguments.only);
    if differences.is_empty() {
        eprintln!("{}: up to date", path.display());
    } else {
        eprintln!("{}: stale; run `fit-gaits` and commit the result", path.display());
        differences.iter().for_each(|difference| eprintln!("  {difference}"));
    }
    Ok(differences.is_empty())
}

/// Writes the database unless a plate failed: the old one is then worth more than one with holes.
fn write_database(arguments: &Arguments, outcome: &Outcome) -> anyhow::Result<bool> {
    let partial = !arguments.only.is_empty() || arguments.preset.is_some();
    let path = match (&arguments.out, partial) {
        (Some(path), _) => path.as_path(),
        (None, false) => Path::new(DATABASE),
        (None, true) => {
            eprintln!("database: not written, since only a part was asked for; name a file with --out");
            return Ok(true);
        }
    };
    if !outcome.failures.is_empty() {
        eprintln!("database: {} left as it was, because not every plate could be fitted", path.display());
        return Ok(false);
    }
    write_json(path, &outcome.database)?;
    eprintln!("database: {}", path.display());
    Ok(true)
}
