//! Tests of marks and ground lines against a drawn plate.

use std::path::Path;

use muybridge_capture::Document;

use super::*;

/// The drawn trot with its true marks: one-metre uprights seen by cameras 0.207 m apart.
fn specimen() -> Draft {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../plates/specimens/annotations/specimen-trot.json");
    Document::open(Path::new(path), None).unwrap().draft().clone()
}

#[test]
fn marks_that_were_numbered_from_the_left_everywhere_are_numbered_alike_again() {
    let truth = specimen();
    let mut draft = truth.clone();
    for panel in truth.manifest.panels.iter().map(|panel| panel.panel) {
        let first = if panel == 1 { 3.0 } else { 0.0 };
        renumber(&mut draft, panel, first);
    }
    assert_ne!(draft, truth, "uprights come into the picture along the stride");
    assert_eq!(number_alike(&mut draft, 1), truth.manifest.panels.len() - 1);
    assert_eq!(draft, truth);
}

#[test]
fn copied_marks_keep_scale_and_positions_where_cameras_stand_in_a_row() {
    let truth = specimen();
    let mut draft = truth.clone();
    let targets = others(&draft, 1);
    targets.iter().for_each(|panel| draft.panel_mut(*panel).marks.clear());
    assert_eq!(copy_marks(&mut draft, 1, &targets), targets.len());
    let calibrated =
        |draft: &Draft| muybridge_capture::calibrate(&draft.manifest, &draft.annotation).unwrap();
    let (copied, known) = (calibrated(&draft), calibrated(&truth));
    // The panels were printed a pixel or so off their places, 2 cm of a stride of 2.5 m.
    assert!((copied.speed_m_s.value / known.speed_m_s.value - 1.0).abs() < 0.02);
    for (a, b) in copied.stride.iter().zip(&known.stride) {
        assert!((a.px_per_m / b.px_per_m - 1.0).abs() < 0.01, "panel {}", a.panel);
    }
}

#[test]
fn the_ground_goes_to_the_same_place_of_other_panels_and_replaces_only_when_asked() {
    let truth = specimen();
    let mut draft = truth.clone();
    draft.panel_mut(2).ground_px = None;
    let row = same_row(&draft, 1);
    assert_eq!(row, [2, 3, 4, 5, 6]);
    copy_ground(&mut draft, 1, &row, false);
    assert_eq!(draft.panel(3), truth.panel(3));
    let (copied, known) =
        (draft.panel(2).unwrap().ground_px.unwrap(), truth.panel(2).unwrap().ground_px.unwrap());
    for (a, b) in copied.iter().zip(known) {
        assert!((a[0] - b[0]).hypot(a[1] - b[1]) < 2.0, "{a:?} {b:?}");
    }
    copy_ground(&mut draft, 1, &row, true);
    assert_ne!(draft.panel(3), truth.panel(3));
}

#[test]
fn uprights_become_marks_on_the_ground_line_and_leave_marked_panels_alone() {
    let mut draft = specimen();
    let before = draft.panel(2).cloned();
    draft.panel_mut(1).marks.clear();
    draft.panel_mut(1).ground_px = Some([[0.0, 200.0], [100.0, 200.0]]);
    let lines = vec![[[50.0, 0.0], [50.0, 100.0]], [[20.0, 0.0], [22.0, 100.0]]];
    assert_eq!(take_uprights(&mut draft, &[(1, lines.clone()), (2, lines)], 4.0), 1);
    let marks = [(4.0, [24.0, 200.0]), (5.0, [50.0, 200.0])].map(|(mark, at_px)| Mark { mark, at_px });
    assert_eq!(draft.panel(1).unwrap().marks, marks);
    assert_eq!(draft.panel(2).cloned(), before);
    assert_eq!(next_number(draft.panel(1), 0.0), 6.0);
}

#[test]
fn lines_without_length_are_refused() {
    let mut draft = specimen();
    let before = draft.clone();
    assert!(!set_ground(&mut draft, 1, [[50.0, 10.0], [55.0, 80.0]]));
    assert!(!set_length(&mut draft, 1, [[50.0, 10.0], [51.0, 10.0]]));
    assert_eq!(draft, before);
    assert!(set_ground(&mut draft, 1, [[90.0, 10.0], [50.0, 12.0]]));
    assert_eq!(draft.panel(1).unwrap().ground_px, Some([[50.0, 12.0], [90.0, 10.0]]));
}
