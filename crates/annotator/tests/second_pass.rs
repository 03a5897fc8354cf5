//! A blind second pass, and what the program refuses to do.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::path::{Path, PathBuf};

use annotator::app::{Annotator, Places};
use annotator::command::Command;
use egui::Context;
use muybridge_capture::{Keypoint, Placed, PlacedBy, read_json, write_atomically};

fn opened(folder: &Path) -> (Annotator, Context, PathBuf) {
    let specimens = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plates/specimens");
    std::fs::create_dir_all(folder.join("annotations")).unwrap();
    for file in ["specimen-trot.json", "specimen-trot.jpg", "annotations/specimen-trot.json"] {
        std::fs::copy(specimens.join(file), folder.join(file)).unwrap();
    }
    let path = folder.join("annotations/specimen-trot.json");
    let places = Places { state: Some(folder.join("state")), plates: folder.to_path_buf() };
    let context = Context::default();
    let mut annotator = Annotator::new(&context, places, Some(&path));
    annotator.wait_until_open(&context);
    (annotator, context, path)
}

#[test]
fn a_second_pass_is_blind_and_measures_how_well_points_are_placed() {
    let folder = tempfile::tempdir().unwrap();
    let (mut annotator, context, path) = opened(folder.path());
    let first = annotator.session.as_ref().unwrap().draft().annotation.clone();
    annotator.run(&context, Command::SecondPass);
    let session = annotator.session.as_mut().unwrap();
    let again: Vec<u32> = session.draft().annotation.panels.iter().map(|panel| panel.panel).collect();
    assert_eq!(again.len(), first.panels.len().div_ceil(3));
    assert!(session.draft().annotation.panels.iter().all(|panel| panel.keypoints.iter().next().is_none()));
    // The second hand is 3 px to the right of the first.
    for panel in first.panels.iter().filter(|panel| again.contains(&panel.panel)) {
        session.edit("Place points", |draft| {
            for (keypoint, placed) in panel.keypoints.iter() {
                let at_px = placed.at_px.map(|[x, y]| [x + 3.0, y]);
                let placed = Placed { at_px, by: PlacedBy::Hand, ..*placed };
                draft.panel_mut(panel.panel).keypoints.insert(keypoint, placed);
            }
        });
    }
    annotator.run(&context, Command::ProposeFitted);
    let said = annotator.messages.all().last().unwrap().text.clone();
    assert!(said.contains("blind"), "{said}");
    annotator.run(&context, Command::SecondPass);
    let session = annotator.session.as_ref().unwrap();
    assert_eq!(session.document.annotation_path(), path);
    assert_eq!(session.draft().annotation, first, "the first pass is untouched");
    let repeatability = session.repeatability.as_ref().unwrap();
    assert_eq!(repeatability.points.len(), again.len() * Keypoint::all().count());
    assert!((repeatability.sd_px(true).unwrap() - 1.5).abs() < 0.01);
    let second = folder.path().join("annotations/second-pass/specimen-trot.json");
    let second: muybridge_capture::Annotation = read_json(&second, 1).unwrap();
    assert_eq!(second.plate, "../../specimen-trot.json");
}

#[test]
fn a_second_pass_wants_the_first_saved() {
    let folder = tempfile::tempdir().unwrap();
    let (mut annotator, context, _) = opened(folder.path());
    annotator.session.as_mut().unwrap().edit("Title", |draft| draft.manifest.title = "x".into());
    assert!(annotator.why_not(Command::SecondPass).is_some());
    annotator.run(&context, Command::Save);
    assert_eq!(annotator.why_not(Command::SecondPass), None);
}

#[test]
fn saving_over_a_changed_file_is_asked_about_and_a_dead_key_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let (mut annotator, context, path) = opened(folder.path());
    annotator.run(&context, Command::Undo);
    assert!(annotator.messages.all().last().unwrap().text.contains("nothing to undo"));
    annotator.run(&context, Command::NudgeLeft);
    assert!(annotator.messages.all().last().unwrap().text.contains("Select a placed point"));
    annotator.session.as_mut().unwrap().edit("Notes", |draft| draft.annotation.notes.push("x".into()));
    let changed = std::fs::read_to_string(&path).unwrap().replace("truth", "lie");
    write_atomically(&path, changed.as_bytes()).unwrap();
    annotator.run(&context, Command::Save);
    assert!(std::fs::read_to_string(&path).unwrap().contains("lie"), "not overwritten unasked");
    assert!(annotator.session.as_ref().unwrap().document.is_changed());
}
