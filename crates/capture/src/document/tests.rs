//! A document as its user knows it: steps, saving, and what is left after a crash.

use super::*;
use crate::annotation::{KeypointState, Placed, PlacedBy, StanceLabel};
use crate::keypoint::Keypoint;

fn specimen(folder: &Path) -> PathBuf {
    let plates = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plates/specimens");
    std::fs::create_dir_all(folder.join("annotations")).unwrap();
    for file in ["specimen-walk.json", "annotations/specimen-walk.json"] {
        std::fs::copy(plates.join(file), folder.join(file)).unwrap();
    }
    folder.join("annotations/specimen-walk.json")
}

fn place(x: f64) -> Placed {
    Placed { at_px: Some([x, 150.0]), state: KeypointState::Visible, by: PlacedBy::Hand, sd_px: None }
}

fn poll() -> Keypoint {
    Keypoint::from_name("poll").unwrap()
}

fn set_poll(document: &mut Document, panel: u32, x: f64) -> bool {
    document.edit("Place poll", |draft| draft.panel_mut(panel).keypoints.insert(poll(), place(x)))
}

#[test]
fn every_step_is_taken_back_and_brought_again() {
    let folder = tempfile::tempdir().unwrap();
    let mut document = Document::open(&specimen(folder.path()), None).unwrap();
    let mut states = vec![document.draft().clone()];
    assert!(set_poll(&mut document, 1, 100.0));
    states.push(document.draft().clone());
    assert!(!set_poll(&mut document, 1, 100.004), "less than a hundredth of a pixel is no change");
    document.edit("Contacts", |draft| draft.panel_mut(2).contacts.near_fore = StanceLabel::Stance);
    document.edit("Forget panel", |draft| draft.annotation.panels.retain(|panel| panel.panel != 3));
    states.push(document.draft().clone());
    document.edit("Title", |draft| draft.manifest.title = "x".into());
    assert_eq!(document.undo().as_deref(), Some("Title"));
    assert_eq!(document.draft(), &states[2]);
    assert_eq!(document.redo_label(), Some("Title"));
    while document.undo().is_some() {}
    assert_eq!(document.draft(), &states[0]);
    document.redo();
    assert_eq!(document.draft(), &states[1]);
    set_poll(&mut document, 1, 90.0);
    assert_eq!(document.redo_label(), None, "a new step ends what could be redone");
}

#[test]
fn a_crash_loses_nothing_not_even_the_steps() {
    let folder = tempfile::tempdir().unwrap();
    let (annotation, journals) = (specimen(folder.path()), folder.path().join("journals"));
    let mut document = Document::open(&annotation, Some(&journals)).unwrap();
    set_poll(&mut document, 1, 100.0);
    set_poll(&mut document, 1, 101.0);
    set_poll(&mut document, 2, 102.0);
    document.undo();
    let shown = document.draft().clone();
    assert!(waiting(&journals).is_empty(), "a running program's journal is not offered");
    assert!(matches!(Document::open(&annotation, Some(&journals)), Err(DocumentError::Journal(_))));
    drop(document);
    let left = waiting(&journals);
    assert_eq!((left.len(), left[0].plate.as_str(), left[0].changes), (1, "specimen-walk", 4));
    let mut recovered = Document::recover(&left[0].journal_path).unwrap();
    assert_eq!(recovered.draft(), &shown);
    assert_eq!(recovered.redo().as_deref(), Some("Place poll"));
    while recovered.undo().is_some() {}
    assert_eq!(recovered.draft(), Document::open(&annotation, None).unwrap().draft());
    assert!(!recovered.is_changed());
    recovered.close();
    assert!(waiting(&journals).is_empty());
}

#[test]
fn a_torn_last_line_costs_that_line_alone() {
    let folder = tempfile::tempdir().unwrap();
    let (annotation, journals) = (specimen(folder.path()), folder.path().join("journals"));
    let mut document = Document::open(&annotation, Some(&journals)).unwrap();
    set_poll(&mut document, 1, 100.0);
    let before = document.draft().clone();
    set_poll(&mut document, 1, 120.0);
    drop(document);
    let path = waiting(&journals)[0].journal_path.clone();
    let whole = std::fs::read(&path).unwrap();
    let last_line = whole[..whole.len() - 1].iter().rposition(|byte| *byte == b'\n').unwrap() + 1;
    for length in (last_line..whole.len()).step_by(41) {
        crate::write_atomically(&path, &whole[..length]).unwrap();
        let mut recovered = Document::recover(&path).unwrap();
        assert_eq!(recovered.draft(), &before);
        set_poll(&mut recovered, 1, 130.0);
        let now = recovered.draft().clone();
        drop(recovered);
        assert_eq!(Document::recover(&path).unwrap().draft(), &now, "cut after {length} bytes");
    }
    crate::write_atomically(&path, b"nonsense").unwrap();
    assert!(Document::recover(&path).is_err());
}

#[test]
fn saving_asks_before_it_overwrites_another_change() {
    let folder = tempfile::tempdir().unwrap();
    let annotation = specimen(folder.path());
    let mut document = Document::open(&annotation, Some(&folder.path().join("journals"))).unwrap();
    set_poll(&mut document, 1, 100.0);
    document.save(false).unwrap();
    assert!(!document.is_changed());
    assert_eq!(Document::open(&annotation, None).unwrap().draft(), document.draft());
    let text = std::fs::read_to_string(&annotation).unwrap();
    crate::write_atomically(&annotation, text.replace("truth", "lie").as_bytes()).unwrap();
    set_poll(&mut document, 1, 110.0);
    assert!(matches!(document.save(false), Err(SaveError::ChangedOnDisk { .. })));
    assert!(std::fs::read_to_string(&annotation).unwrap().contains("lie"));
    document.save(true).unwrap();
    let elsewhere = folder.path().join("other/place/specimen-walk.json");
    document.save_as(&elsewhere, false).unwrap();
    assert_eq!(document.draft().annotation.plate, "../../specimen-walk.json");
    assert_eq!(Document::open(&elsewhere, None).unwrap().draft(), document.draft());
    assert!(document.save_as(&annotation, false).is_err(), "a file that is there is not overwritten unasked");
}

#[test]
fn a_plate_without_annotation_begins_one() {
    let folder = tempfile::tempdir().unwrap();
    let manifest_path =
        specimen(folder.path()).parent().unwrap().parent().unwrap().join("specimen-walk.json");
    let manifest = Manifest::read(&manifest_path).unwrap();
    let path = annotation_beside(&manifest_path);
    assert_eq!(path, folder.path().join("annotations/specimen-walk.json"));
    let new = folder.path().join("annotations/new.json");
    let mut document = Document::start(&manifest_path, &new, manifest, None).unwrap();
    assert!(!document.is_changed());
    assert!(document.plate().is_err(), "nothing is placed yet");
    set_poll(&mut document, 4, 100.0);
    document.save(false).unwrap();
    assert_eq!(Document::open(&new, None).unwrap().draft(), document.draft());
}

#[test]
fn an_annotation_elsewhere_finds_its_plate_whatever_is_undone() {
    let folder = tempfile::tempdir().unwrap();
    let annotation = specimen(folder.path());
    let journals = folder.path().join("journals");
    let mut document = Document::open(&annotation, Some(&journals)).unwrap();
    set_poll(&mut document, 1, 100.0);
    let elsewhere = folder.path().join("annotations/deep/second.json");
    document.save_as(&elsewhere, false).unwrap();
    while document.undo().is_some() {}
    document.save(false).unwrap();
    assert_eq!(Document::open(&elsewhere, None).unwrap().draft(), document.draft());
    set_poll(&mut document, 1, 90.0);
    drop(document);
    let mut left = Document::recover(&waiting(&journals)[0].journal_path).unwrap();
    assert_eq!(left.annotation_path(), elsewhere);
    left.undo();
    left.save(false).unwrap();
    assert_eq!(Document::open(&elsewhere, None).unwrap().draft(), left.draft());
}

#[test]
fn a_failed_save_under_another_name_leaves_everything_where_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let annotation = specimen(folder.path());
    let mut document = Document::open(&annotation, None).unwrap();
    set_poll(&mut document, 1, 100.0);
    crate::write_atomically(&folder.path().join("a-file"), b"no folder").unwrap();
    let before = document.draft().clone();
    assert!(matches!(document.save_as(&folder.path().join("a-file/x.json"), false), Err(SaveError::File(_))));
    let manifest_path = folder.path().join("annotations/../specimen-walk.json");
    assert!(matches!(document.save_as(&manifest_path, true), Err(SaveError::OwnPlate { .. })));
    assert_eq!((document.draft(), document.annotation_path()), (&before, annotation.as_path()));
    document.save(false).unwrap();
    assert_eq!(Document::open(&annotation, None).unwrap().draft(), &before);
}

#[test]
fn nothing_is_written_that_could_not_be_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let (annotation, journals) = (specimen(folder.path()), folder.path().join("journals"));
    let mut document = Document::open(&annotation, Some(&journals)).unwrap();
    assert!(!set_poll(&mut document, 1, f64::NAN));
    assert!(!document.edit("Camera", |draft| {
        draft.manifest.calibration.as_mut().unwrap().camera.distance_m.value = f64::INFINITY;
    }));
    assert!(!document.is_changed());
    // A digit more than a reader of numbers keeps.
    document.edit("Camera", |draft| {
        draft.manifest.calibration.as_mut().unwrap().camera.distance_m.value = 10.0 + 0.1 + 0.2;
    });
    document.edit("Corners crossed", |draft| draft.manifest.panels[0].quad_px.swap(0, 1));
    assert!(matches!(document.save(false), Err(SaveError::Wrong(_))));
    let now = document.draft().clone();
    drop(document);
    let mut left = Document::recover(&waiting(&journals)[0].journal_path).unwrap();
    assert_eq!(left.draft(), &now);
    left.undo();
    left.save(false).unwrap();
}

#[test]
fn somebody_elses_change_of_the_manifest_is_not_taken_for_our_own() {
    let folder = tempfile::tempdir().unwrap();
    let annotation = specimen(folder.path());
    let mut document = Document::open(&annotation, None).unwrap();
    set_poll(&mut document, 1, 100.0);
    let manifest_path = document.manifest_path().to_path_buf();
    let text = std::fs::read_to_string(&manifest_path).unwrap();
    crate::write_atomically(&manifest_path, text.replace("none: a drawing", "changed").as_bytes()).unwrap();
    document.save(false).unwrap();
    document.edit("Title", |draft| draft.manifest.title = "x".into());
    assert!(matches!(document.save(false), Err(SaveError::ChangedOnDisk { .. })));
}

#[test]
fn a_save_cut_short_is_not_somebody_elses_change() {
    let folder = tempfile::tempdir().unwrap();
    let (annotation, journals) = (specimen(folder.path()), folder.path().join("journals"));
    let mut document = Document::open(&annotation, Some(&journals)).unwrap();
    document.edit("Title", |draft| draft.manifest.title = "x".into());
    // Killed after the manifest was written.
    crate::write_json(document.manifest_path(), &document.draft().manifest).unwrap();
    drop(document);
    let mut left = Document::recover(&waiting(&journals)[0].journal_path).unwrap();
    left.undo();
    left.save(false).unwrap();
    assert_eq!(Document::open(&annotation, None).unwrap().draft(), left.draft());
}

#[test]
fn a_journal_of_another_version_is_kept_aside() {
    let folder = tempfile::tempdir().unwrap();
    let (annotation, journals) = (specimen(folder.path()), folder.path().join("journals"));
    let mut document = Document::open(&annotation, Some(&journals)).unwrap();
    set_poll(&mut document, 1, 100.0);
    drop(document);
    let path = waiting(&journals)[0].journal_path.clone();
    let text = std::fs::read_to_string(&path).unwrap().replacen("\"journal\":1", "\"journal\":2", 1);
    crate::write_atomically(&path, text.as_bytes()).unwrap();
    Document::open(&annotation, Some(&journals)).unwrap().close();
    assert_eq!(std::fs::read_to_string(path.with_extension("journal-unreadable")).unwrap(), text);
    let missing = journals.join("missing.journal");
    assert!(Document::recover(&missing).is_err() && discard(&missing).is_err() && !missing.exists());
}
