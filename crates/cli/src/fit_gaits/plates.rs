//! Which annotation files there are, and fitting them in parallel.

use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use muybridge_capture::hash_file;
use muybridge_core::Skeleton;
use muybridge_fitting::pipeline::{PlateFit, fit_plate};
use muybridge_fitting::tracked::strides::MeasuredStride;
use muybridge_fitting::tracked::table::read_table;
use muybridge_fitting::weights::Weights;
use rayon::prelude::*;

/// Table of strides measured on tracked walks, beside the annotations.
const WALKS: &str = "tracked-walks.csv";

/// The annotation files of a folder in the order of their names, or only those asked for.
pub(super) fn annotation_paths(folder: &Path, only: &[String]) -> anyhow::Result<Vec<PathBuf>> {
    let entries = std::fs::read_dir(folder).with_context(|| {
        format!("{}: cannot read the annotations folder; name another with --annotations", folder.display())
    })?;
    let mut paths = Vec::new();
    for entry in entries {
        let path = entry.with_context(|| folder.display().to_string())?.path();
        if path.is_file() && path.extension().is_some_and(|extension| extension == "json") {
            paths.push(path);
        }
    }
    paths.sort();
    if only.is_empty() {
        return Ok(paths);
    }
    let stem =
        |path: &Path| path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    for wanted in only {
        if !paths.iter().any(|path| stem(path) == *wanted) {
            let known: Vec<String> = paths.iter().map(|path| stem(path)).collect();
            bail!("--only {wanted}: no such plate in {}; there are: {}", folder.display(), known.join(", "));
        }
    }
    paths.retain(|path| only.contains(&stem(path)));
    Ok(paths)
}

/// The measured strides of the tracked walks beside the annotations, with the table's hash; nothing where there is no table.
pub(super) fn tracked_walks(folder: &Path) -> anyhow::Result<(Vec<MeasuredStride>, String)> {
    let path = folder.join(WALKS);
    if !path.exists() {
        return Ok(Default::default());
    }
    Ok((read_table(&path)?, hash_file(&path)?))
}

/// Fits all plates, each on one thread; results and failures in the order of the paths whatever the number of threads.
pub(super) fn fit_all(paths: &[PathBuf], skeleton: &Skeleton) -> (Vec<PlateFit>, Vec<String>) {
    // Hidden by indicatif itself when standard error is no terminal.
    let bar = ProgressBar::with_draw_target(Some(paths.len() as u64), ProgressDrawTarget::stderr());
    if let Ok(style) = ProgressStyle::with_template("fitting {bar:30} {pos}/{len} plates {msg}") {
        bar.set_style(style);
    }
    let weights = Weights::default();
    let results: Vec<_> = paths
        .par_iter()
        .map(|path| {
            let result = fit_plate(path, skeleton, &weights);
            bar.inc(1);
            result
        })
        .collect();
    bar.finish_and_clear();
    let (mut fits, mut failures): (Vec<PlateFit>, Vec<String>) = (Vec::new(), Vec::new());
    for result in results {
        match result {
            Ok(fit) => match fits.iter().find(|other| other.id() == fit.id()) {
                None => fits.push(fit),
                Some(other) => failures.push(annotated_twice(&fit, other)),
            },
            // With the causes, such as the system's own reason why a file cannot be read.
            Err(failure) => failures.push(format!("{:#}", anyhow::Error::new(failure))),
        }
    }
    (fits, failures)
}

/// Strides are told apart by their plate's identifier, so that a plate can have only one annotation.
fn annotated_twice(fit: &PlateFit, other: &PlateFit) -> String {
    let [path, first] = [fit, other].map(|fit| fit.plate.annotation_path.display());
    format!("{path}: plate: {} is annotated in {first}, too; keep one of the two", fit.id())
}
