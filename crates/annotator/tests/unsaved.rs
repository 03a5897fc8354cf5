//! Work that is not saved, when something else comes in between.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::path::{Path, PathBuf};

use annotator::app::{Annotator, Places};
use annotator::command::Command;
use egui::{Context, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use muybridge_capture::waiting;

fn copied(folder: &Path, name: &str) -> PathBuf {
    let specimens = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plates/specimens");
    std::fs::create_dir_all(folder.join("annotations")).unwrap();
    for file in [format!("{name}.json"), format!("{name}.jpg"), format!("annotations/{name}.json")] {
        std::fs::copy(specimens.join(&file), folder.join(&file)).unwrap();
    }
    folder.join(format!("annotations/{name}.json"))
}

fn opened(folder: &Path, path: &Path) -> (Annotator, Context) {
    let places = Places { state: Some(folder.join("state")), plates: folder.to_path_buf() };
    let context = Context::default();
    let mut annotator = Annotator::new(&context, places, Some(path));
    annotator.wait_until_open(&context);
    annotator.settings.fit_always = false;
    (annotator, context)
}

fn titled(annotator: &mut Annotator, title: &str) {
    annotator.session.as_mut().unwrap().edit("Title", |draft| draft.manifest.title = title.into());
}

fn shown(annotator: Annotator) -> Harness<'static, Annotator> {
    Harness::builder()
        .with_size(vec2(1360.0, 900.0))
        .with_max_steps(40)
        .build_ui_state(|ui, annotator: &mut Annotator| annotator.ui(ui), annotator)
}

fn plates_waiting(folder: &Path) -> Vec<String> {
    waiting(&folder.join("state/journals")).into_iter().map(|left| left.plate).collect()
}

#[test]
fn taking_up_the_work_on_another_plate_keeps_ours() {
    let folder = tempfile::tempdir().unwrap();
    let (trot, walk) = (copied(folder.path(), "specimen-trot"), copied(folder.path(), "specimen-walk"));
    let (mut crashed, _) = opened(folder.path(), &trot);
    titled(&mut crashed, "left behind");
    drop(crashed);
    let (mut annotator, context) = opened(folder.path(), &walk);
    titled(&mut annotator, "not saved yet");
    annotator.open(&context, &trot);
    annotator.wait_until_open(&context);
    let mut harness = shown(annotator);
    harness.run();
    harness.get_by_label("Take up specimen-trot").click();
    harness.run();
    let session = harness.state().session.as_ref().unwrap();
    assert_eq!(session.draft().manifest.title, "left behind");
    assert_eq!(plates_waiting(folder.path()), ["specimen-walk"], "our own work is offered again");
}

#[test]
fn what_is_not_to_be_saved_is_gone_and_what_is_being_typed_is_not_forgotten() {
    let folder = tempfile::tempdir().unwrap();
    let path = copied(folder.path(), "specimen-trot");
    let (mut annotator, context) = opened(folder.path(), &path);
    // A field that still has the focus.
    annotator.session.as_mut().unwrap().preview("Title", |draft| draft.manifest.title = "typing".into());
    annotator.run(&context, Command::Close);
    assert!(annotator.session.is_some(), "it is asked about");
    let mut harness = shown(annotator);
    harness.run();
    harness.get_by_label("Do not save").click();
    harness.run();
    assert!(harness.state().session.is_none());
    assert!(plates_waiting(folder.path()).is_empty());
}
