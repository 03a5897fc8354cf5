//! The state of the Footprints page without its window.

use std::path::Path;
use std::sync::Arc;

use muybridge_footprints::{Foot, Print, StepTiming};

use super::document::TrackSaveError;
use super::safe_copy::left_behind;
use super::*;

fn waker() -> Waker {
    Arc::new(|| {})
}

fn solved(editor: &mut Editor) {
    for _ in 0..2 {
        editor.solve(&waker());
        editor.solving.wait();
    }
}

fn bird() -> Editor {
    let mut editor = Editor::default();
    solved(&mut editor);
    assert!(editor.solving.faults().is_empty(), "{:?}", editor.solving.faults());
    editor
}

#[test]
fn every_example_becomes_a_motion() {
    for (example, name) in Example::ALL.into_iter().filter(|(example, _)| *example != Example::Empty) {
        let mut editor = Editor::new(TrackDocument::new(example.track()));
        solved(&mut editor);
        assert!(editor.solving.faults().is_empty(), "{name}: {:?}", editor.solving.faults());
        assert!(editor.prints().len() > 6 && editor.end_s() > 1.0, "{name}: {}", editor.end_s());
        // A run, leaps and a river ask for a little more than a body can do, which the page is to show.
        let remarks = editor.motion().unwrap().remarks();
        assert!(3 * remarks.len() <= editor.prints().len(), "{name}: {remarks:#?}");
    }
}

#[test]
fn a_gesture_is_one_step_and_undo_restores_track_and_motion() {
    let mut editor = bird();
    let before = (editor.track().clone(), editor.motion().unwrap().solved.clone());
    for i in 1..=20 {
        editor.preview("Move", |track| edits::put(track, 4, [0.01 * f64::from(i), 0.3]));
        editor.solve(&waker());
        editor.solving.wait();
    }
    assert_ne!(editor.motion().unwrap().solved, before.1);
    editor.commit();
    solved(&mut editor);
    assert_eq!(editor.motion().unwrap().track.prints[4].at_m, [0.2, 0.3]);
    editor.undo();
    solved(&mut editor);
    assert_eq!((editor.track(), &editor.motion().unwrap().solved), (&before.0, &before.1));
    assert_eq!(editor.document.undo_label(), None);
    assert!(!editor.document.is_changed());
    editor.redo();
    assert_eq!(editor.track().prints[4].at_m, [0.2, 0.3]);
}

#[test]
fn what_cannot_be_walked_leaves_the_last_motion() {
    let mut editor = bird();
    let end_s = editor.end_s();
    editor.edit("Together", |track| {
        let timing = Some(StepTiming { stance_time_s: 5.0, step_time_s: 0.0 });
        track.prints.iter_mut().for_each(|print| print.timing = timing);
    });
    solved(&mut editor);
    assert!(!editor.solving.faults().is_empty());
    assert_eq!(editor.end_s(), end_s);
    editor.undo();
    solved(&mut editor);
    assert!(editor.solving.faults().is_empty());
}

#[test]
fn prints_along_a_path_become_the_tracks_own_when_one_is_moved() {
    let mut editor = Editor::new(TrackDocument::new(Example::Path.track()));
    solved(&mut editor);
    assert!(editor.are_laid() && editor.prints().len() > 8);
    let laid = editor.prints().to_vec();
    editor.edit("Move", |track| edits::put(track, 3, [1.0, 1.0]));
    assert!(!editor.are_laid());
    let own = &editor.track().prints;
    assert!(own.len() == laid.len() && own[2] == laid[2] && own[3].at_m == [1.0, 1.0]);
    editor.lay_prints();
    solved(&mut editor);
    assert!(editor.are_laid() && editor.prints() == laid);
}

#[test]
fn all_prints_can_be_deleted_and_come_back() {
    let mut editor = bird();
    let before = editor.track().clone();
    editor.selected = (0..editor.prints().len()).collect();
    editor.delete_selected();
    solved(&mut editor);
    assert!(editor.prints().is_empty() && editor.stances().is_empty());
    editor.delete_selected();
    editor.select_next(1);
    for _ in 0..3 {
        editor.add_print(None);
    }
    solved(&mut editor);
    assert!(editor.solving.faults().is_empty(), "{:?}", editor.solving.faults());
    assert_eq!(
        editor.prints().iter().map(|print| print.foot).collect::<Vec<_>>(),
        [Foot::Left, Foot::Right, Foot::Left]
    );
    for _ in 0..4 {
        editor.undo();
    }
    assert_eq!(*editor.track(), before);
}

#[test]
fn ten_thousand_prints_are_solved_in_the_background() {
    let mut track = muybridge_footprints::Track::new("bird");
    track.prints = (0..10_000)
        .map(|i| Print {
            foot: if i % 2 == 0 { Foot::Left } else { Foot::Right },
            at_m: [0.2 * f64::from(i), if i % 2 == 0 { -0.05 } else { 0.05 }],
            heading_deg: 0.0,
            timing: None,
        })
        .collect();
    let mut editor = Editor::new(TrackDocument::new(track));
    let begun = std::time::Instant::now();
    editor.solve(&waker());
    assert!(begun.elapsed().as_millis() < 200, "{:?}", begun.elapsed());
    editor.solving.wait();
    assert!(editor.solving.faults().is_empty() || editor.motion().is_none());
    assert!(begun.elapsed().as_secs() < 60, "{:?}", begun.elapsed());
    for i in 0..60 {
        editor.edit("Move", |track| edits::put(track, 5, [f64::from(i), 0.0]));
    }
    editor.undo();
    assert_eq!(editor.track().prints[5].at_m[0], 58.0);
}

#[test]
fn a_file_is_written_whole_and_never_over_another_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("walk.json");
    let mut editor = bird();
    assert!(matches!(editor.document.save(false), Err(TrackSaveError::NoPath)));
    editor.add_print(None);
    assert!(editor.document.is_changed());
    editor.document.save_as(&path, false).unwrap();
    assert!(!editor.document.is_changed());
    let read = Track::from_json(&std::fs::read_to_string(&path).unwrap()).unwrap();
    assert_eq!(read, *editor.track());
    editor.add_print(None);
    muybridge_capture::write_atomically(&path, b"somebody else's").unwrap();
    assert!(matches!(editor.document.save(false), Err(TrackSaveError::ChangedOnDisk(_))));
    assert!(matches!(
        Editor::default().document.save_as(&path, false),
        Err(TrackSaveError::ChangedOnDisk(_))
    ));
    assert_eq!(std::fs::read_to_string(&path).unwrap(), "somebody else's");
    editor.document.save(true).unwrap();
    let missing = Path::new("/no/such/folder/walk.json");
    assert!(matches!(editor.document.save_as(missing, false), Err(TrackSaveError::File(_))));
    assert_eq!(editor.document.path(), Some(path.as_path()));
}

#[test]
fn what_a_crash_leaves_behind_is_offered_once() {
    let folder = tempfile::tempdir().unwrap();
    let mut editor = bird();
    editor.keep_safe_in(Some(folder.path().to_path_buf()));
    assert!(left_behind(folder.path()).is_empty());
    editor.add_print(None);
    assert!(left_behind(folder.path()).is_empty(), "it is open");
    let track = editor.track().clone();
    drop(editor);
    let left = left_behind(folder.path());
    assert_eq!(left.len(), 1);
    assert_eq!(left[0].record.track, track);
    assert!(left_behind(folder.path()).is_empty(), "it is being offered");
    let document = TrackDocument::recovered(&left[0]);
    assert!(document.is_changed());
    left[0].discard();
    drop(left);
    assert!(left_behind(folder.path()).is_empty());
}
