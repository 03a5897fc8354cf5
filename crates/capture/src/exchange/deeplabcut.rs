//! `DeepLabCut` projects: the labels of one animal, the same with likelihoods, and `config.yaml`.
//!
//! Labels have no state: a point is there or not. The second file has the layout of `DeepLabCut`'s analysis output, in
//! which each point has a likelihood, and there 1 is visible and 0.5 occluded; `movement` and other readers of results
//! take it, while they refuse labels.

mod read;

use super::layout::{Layout, Shown};
use super::{ExchangeError, ExportPicture, skeleton_edges};
use crate::annotation::{Annotation, KeypointState};
use crate::keypoint::Keypoint;
use crate::manifest::Manifest;
pub(super) use read::read;

/// Likelihood from which `DeepLabCut` itself draws a prediction (`pcutoff` of its configuration): visible.
const VISIBLE_FROM: f64 = 0.6;
/// Likelihood below which a prediction is no place at all, only the least bad one of the picture.
const OCCLUDED_FROM: f64 = 0.1;
/// Likelihoods that are written for a visible and an occluded point.
const WRITTEN_LIKELIHOODS: [f64; 2] = [1.0, 0.5];

type Files = Vec<(String, Vec<u8>)>;

/// The files of a project, and where its pictures belong.
pub(super) fn write(
    manifest: &Manifest,
    annotation: &Annotation,
    layout: &Layout,
    scorer: Option<&str>,
) -> Result<(Files, Vec<ExportPicture>), ExchangeError> {
    let scorer = match scorer {
        Some(scorer) => scorer.to_string(),
        None => plain_name(&annotation.annotator),
    };
    if scorer != plain_name(&scorer) {
        return Err(ExchangeError::Scorer(scorer));
    }
    let folder = format!("labeled-data/{}/", manifest.id);
    let files = vec![
        ("config.yaml".into(), config(manifest, layout, &scorer).into_bytes()),
        (format!("{folder}CollectedData_{scorer}.csv"), labels(manifest, layout, &scorer).into_bytes()),
        (format!("{}DLC_{scorer}.csv", manifest.id), likelihoods(layout, &scorer).into_bytes()),
    ];
    Ok((files, layout.pictures_in(&folder)))
}

/// A name with nothing in it that means something in a path or table; `scorer` when nothing is left.
fn plain_name(name: &str) -> String {
    let kept =
        |c: char| if c.is_alphanumeric() || "-_".contains(c) { Some(c) } else { (c == ' ').then_some('_') };
    let name: String = name.chars().filter_map(kept).collect();
    if name.is_empty() { "scorer".into() } else { name }
}

/// The three rows of a header, after the columns that name the picture.
fn header(scorer: &str, keys: &str, coordinates: &[&str]) -> String {
    let mut rows = [format!("scorer{keys}"), format!("bodyparts{keys}"), format!("coords{keys}")];
    for keypoint in Keypoint::all() {
        for coordinate in coordinates {
            for (row, cell) in rows.iter_mut().zip([scorer, keypoint.name(), coordinate]) {
                row.push(',');
                row.push_str(cell);
            }
        }
    }
    format!("{}\n", rows.join("\n"))
}

/// Labels with the picture's path in three columns, rows in the order of names.
fn labels(manifest: &Manifest, layout: &Layout, scorer: &str) -> String {
    let row = |shown: &Shown| {
        let mut row = format!("labeled-data,{},{}", manifest.id, layout.pictures[shown.picture].name);
        for keypoint in Keypoint::all() {
            let point = shown.points.iter().find(|point| point.keypoint == keypoint);
            row.push_str(&point.map_or(",,".into(), |point| format!(",{},{}", point.at[0], point.at[1])));
        }
        row
    };
    let mut rows: Vec<String> = layout.shown.iter().map(row).collect();
    rows.sort();
    format!("{}{}\n", header(scorer, ",,", &["x", "y"]), rows.join("\n"))
}

/// Every picture by its number from 0, with or without points: a film of the panels.
fn likelihoods(layout: &Layout, scorer: &str) -> String {
    let mut text = header(scorer, "", &["x", "y", "likelihood"]);
    for index in 0..layout.pictures.len() {
        let shown = layout.shown.iter().find(|shown| shown.picture == index);
        text.push_str(&index.to_string());
        for keypoint in Keypoint::all() {
            let points = shown.map(|shown| shown.points.as_slice()).unwrap_or_default();
            match points.iter().find(|point| point.keypoint == keypoint) {
                Some(point) => {
                    let visible = point.state == KeypointState::Visible;
                    let likelihood = WRITTEN_LIKELIHOODS[usize::from(!visible)];
                    text.push_str(&format!(",{},{},{likelihood:.1}", point.at[0], point.at[1]));
                }
                None => text.push_str(",,,"),
            }
        }
        text.push('\n');
    }
    text
}

/// A project's settings. `DeepLabCut` itself corrects `project_path` when it opens the file.
fn config(manifest: &Manifest, layout: &Layout, scorer: &str) -> String {
    // A JSON string is a string of YAML.
    let quoted = |text: &str| serde_json::Value::from(text).to_string();
    let date: String = manifest.date.chars().filter(|c| c.is_alphanumeric()).collect();
    let [width, height] = layout.pictures.first().map_or([0, 0], |picture| picture.size_px);
    let mut text = format!(
        "# Settings of a DeepLabCut project: the labelled panels of one plate, in labeled-data.\n\
         Task: {}\nscorer: {}\ndate: {}\nmultianimalproject: false\nidentity:\nproject_path: .\nengine: pytorch\n\n\
         video_sets:\n  {}:\n    crop: 0, {width}, 0, {height}\nbodyparts:\n",
        quoted(&manifest.id),
        quoted(scorer),
        quoted(&date),
        quoted(&format!("videos/{}.mp4", manifest.id)),
    );
    for keypoint in Keypoint::all() {
        text.push_str(&format!("- {keypoint}\n"));
    }
    text.push_str("\nstart: 0\nstop: 1\n");
    text.push_str(&format!("numframes2pick: {}\n\nskeleton:\n", layout.pictures.len()));
    for [from, to] in skeleton_edges() {
        text.push_str(&format!("- - {from}\n  - {to}\n"));
    }
    text.push_str(&format!(
        "skeleton_color: black\npcutoff: {VISIBLE_FROM}\ndotsize: 6\nalphavalue: 0.7\ncolormap: rainbow\n\n\
         TrainingFraction:\n- 0.95\niteration: 0\ndefault_net_type: resnet_50\ndefault_augmenter: default\n\
         snapshotindex: -1\ndetector_snapshotindex: -1\nbatch_size: 8\ndetector_batch_size: 1\n\n\
         cropping: false\nx1: 0\nx2: {width}\ny1: 0\ny2: {height}\n\ncorner2move2:\n- 50\n- 50\nmove2corner: true\n"
    ));
    text
}
