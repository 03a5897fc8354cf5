//! A person calibrates a plate of which nothing is known yet, with pointer and keys.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::path::{Path, PathBuf};

use annotator::app::{Annotator, Places};
use annotator::command::Command;
use annotator::session::{Page, Session};
use egui::accesskit::Role;
use egui::{Context, Key, Modifiers, PointerButton, Pos2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use muybridge_capture::{
    ANNOTATION_SCHEMA, Annotation, BodyPoint, Keypoint, MANIFEST_SCHEMA, Manifest, PanelAnnotation,
    calibrate, read_json, write_json,
};

/// Precision of a line drawn by hand over the specimen, whose metre is 64 px long: half a pixel at each end.
const DRAWN: f64 = 0.012;

fn specimens() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plates/specimens")
}

/// The window with the drawn trot: panels and points of the trunk, but no calibration, no ground, no marks.
struct Person {
    harness: Harness<'static, Annotator>,
    _folder: tempfile::TempDir,
}

impl Person {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let mut manifest: Manifest =
            read_json(&specimens().join("specimen-trot.json"), MANIFEST_SCHEMA).unwrap();
        manifest.calibration = None;
        let path = folder.path().join("specimen-trot.json");
        write_json(&path, &manifest).unwrap();
        std::fs::copy(specimens().join("specimen-trot.jpg"), folder.path().join("specimen-trot.jpg"))
            .unwrap();
        let places = Places { state: Some(folder.path().join("state")), plates: folder.path().to_path_buf() };
        let context = Context::default();
        let mut annotator = Annotator::new(&context, places, Some(&path));
        annotator.wait_until_open(&context);
        annotator.settings.fit_always = false;
        let session = annotator.session.as_mut().unwrap();
        place_trunk(session);
        session.page = Page::Calibrate;
        let harness = Harness::builder()
            .with_size([1500.0, 2600.0])
            .build_ui_state(|ui, annotator: &mut Annotator| annotator.ui(ui), annotator);
        let mut person = Self { harness, _folder: folder };
        person.harness.run_steps(4);
        person
    }

    fn session(&self) -> &Session {
        self.harness.state().session.as_ref().unwrap()
    }

    fn undo_label(&self) -> Option<&str> {
        self.session().document.undo_label()
    }

    fn command(&mut self, command: Command) {
        let context = self.harness.ctx.clone();
        self.harness.state_mut().run(&context, command);
        self.harness.run_steps(2);
    }

    /// Lets frames pass until work in the background has come to this.
    fn wait_for(&mut self, done: impl Fn(&Session) -> bool) {
        for _ in 0..1500 {
            if done(self.session()) {
                return;
            }
            std::thread::sleep(std::time::Duration::from_millis(20));
            self.harness.run_steps(1);
        }
        panic!("it does not come to an end: {:?}", self.harness.state().messages.all());
    }

    fn screen(&self, at_px: [f64; 2]) -> Pos2 {
        let canvas = self.harness.get_by_label("Photograph").rect();
        let panel = self.session().panel_place().unwrap();
        self.session().zoom.view(panel, canvas).screen_from_plate(at_px)
    }

    fn button(&mut self, at: Pos2, button: PointerButton, pressed: bool) {
        self.harness.event(egui::Event::PointerButton {
            pos: at,
            button,
            pressed,
            modifiers: Modifiers::NONE,
        });
        self.harness.run_steps(1);
    }

    fn click_on(&mut self, at_px: [f64; 2], button: PointerButton) {
        let at = self.screen(at_px);
        self.harness.hover_at(at);
        self.harness.run_steps(1);
        self.button(at, button, true);
        self.button(at, button, false);
        self.harness.run_steps(1);
    }

    fn drag(&mut self, from_px: [f64; 2], to_px: [f64; 2]) {
        let [from, to] = [from_px, to_px].map(|at| self.screen(at));
        self.harness.hover_at(from);
        self.harness.run_steps(1);
        self.button(from, PointerButton::Primary, true);
        for share in [0.3, 0.7, 1.0] {
            self.harness.hover_at(from + share * (to - from));
            self.harness.run_steps(1);
        }
        self.button(to, PointerButton::Primary, false);
        self.harness.run_steps(2);
    }

    fn press(&mut self, label: &str) {
        self.harness.get_by_role_and_label(Role::Button, label).click();
        self.harness.run_steps(3);
    }

    fn choose(&mut self, list: &str, choice: &str) {
        self.harness.get_by_role_and_label(Role::ComboBox, list).click();
        self.harness.run_steps(3);
        self.press(choice);
    }

    /// Types into the field that has the keyboard, all of which is selected first.
    fn type_here(&mut self, text: &str) {
        self.harness.key_press_modifiers(Modifiers::COMMAND, Key::A);
        self.harness.run_steps(1);
        self.harness.event(egui::Event::Text(text.into()));
        self.harness.run_steps(2);
    }

    fn type_into(&mut self, field: &str, text: &str) {
        self.harness.get_by_role_and_label(Role::TextInput, field).focus();
        self.harness.run_steps(2);
        self.type_here(text);
    }

    fn enter(&mut self) {
        self.harness.key_press(Key::Enter);
        self.harness.run_steps(2);
    }
}

/// The true points of the trunk, so that speeds can be told.
fn place_trunk(session: &mut Session) {
    let truth: Annotation =
        read_json(&specimens().join("annotations/specimen-trot.json"), ANNOTATION_SCHEMA).unwrap();
    session.edit("Points", |draft| {
        for panel in &truth.panels {
            for point in [BodyPoint::Withers, BodyPoint::Back, BodyPoint::Croup, BodyPoint::Dock] {
                let keypoint = Keypoint::Body(point);
                let placed = *panel.keypoints.get(keypoint).unwrap();
                draft.panel_mut(panel.panel).keypoints.insert(keypoint, placed);
            }
        }
    });
}

/// What a person draws on the first panel, and types.
fn draw_and_type(person: &mut Person, first: &PanelAnnotation) {
    assert!(person.harness.query_all_by_label_contains("Nobody has said yet").next().is_some());
    for end in first.ground_px.unwrap() {
        person.click_on(end, PointerButton::Primary);
    }
    assert_eq!(person.undo_label(), Some("Draw the ground line"));
    let canvas = person.harness.get_by_label("Photograph").rect();
    person.press("Draw a known length");
    person.drag(first.marks[0].at_px, first.marks[1].at_px);
    assert_eq!(person.undo_label(), Some("Draw a known length"));
    assert_eq!(
        person.harness.get_by_label("Photograph").rect(),
        canvas,
        "the forms leave the photograph where it is"
    );
    person.choose("Unit of Known length: m", "ft");
    person.type_into("Known length", "3.28084");
    assert!(
        (person
            .session()
            .draft()
            .manifest
            .calibration
            .as_ref()
            .unwrap()
            .scale
            .known_length
            .as_ref()
            .unwrap()
            .mark_spacing_m
            .value
            - 1.0)
            .abs()
            < 1e-5,
        "shown while it is typed"
    );
    assert_eq!(person.undo_label(), Some("Draw a known length"), "not a step yet");
    person.enter();
    assert_eq!(person.undo_label(), Some("Known length"));
    person.choose("Marks stand: on the animal's track", "on a wall: distances");
    person.type_into("Camera to wall", "14.4");
    person.enter();
    person.choose("Cameras: One camera that does not move", "A row of cameras, evenly spaced");
    person.type_into("Camera spacing", "0.20685752");
    person.enter();
    // The first camera is proposed to look where it does: at the middle of its panel.
    let axis = person.harness.get_by_role_and_label(Role::TextInput, "First axis mark").value().unwrap();
    assert!((axis.parse::<f64>().unwrap() - 1.0).abs() < 0.02, "{axis}");
    person.type_into("Interval", "0.058728");
    person.enter();
    copy_to_all(person);
}

/// Ground line and marks to all other panels.
fn copy_to_all(person: &mut Person) {
    let copies: Vec<_> = person
        .harness
        .get_all_by_role_and_label(Role::Button, "Copy to panels without")
        .map(|n| n.rect())
        .collect();
    for rect in copies {
        let at = rect.center();
        person.harness.hover_at(at);
        person.harness.run_steps(1);
        person.button(at, PointerButton::Primary, true);
        person.button(at, PointerButton::Primary, false);
        person.harness.run_steps(2);
    }
}

#[test]
fn a_drawn_length_an_interval_and_a_ground_line_calibrate_the_plate() {
    let manifest: Manifest = read_json(&specimens().join("specimen-trot.json"), MANIFEST_SCHEMA).unwrap();
    let truth: Annotation =
        read_json(&specimens().join("annotations/specimen-trot.json"), ANNOTATION_SCHEMA).unwrap();
    let known = calibrate(&manifest, &truth).unwrap();
    let mut person = Person::new();
    draw_and_type(&mut person, &truth.panels[0]);
    let derived = person.session().derived.calibration.as_ref().unwrap();
    let close = |a: f64, b: f64, limit: f64| (a / b - 1.0).abs() < limit;
    assert!(close(derived.stride[0].px_per_m, known.stride[0].px_per_m, DRAWN));
    assert!(close(derived.speed_m_s.value, known.speed_m_s.value, 2.0 * DRAWN), "{:?}", derived.speed_m_s);
    assert!(close(derived.interval_s.value, known.interval_s.value, 1e-4));
    assert!((derived.stride[0].axis_foot_px[0] - known.stride[0].axis_foot_px[0]).abs() < 1.5);
    let steps = [
        "Copy the marks",
        "Copy the ground line",
        "Interval",
        "Camera spacing",
        "Position of the cameras",
        "Camera to wall",
        "Where the marks stand",
        "Known length",
        "Draw a known length",
        "Draw the ground line",
        "Points",
    ];
    for step in steps {
        assert_eq!(person.undo_label(), Some(step));
        person.command(Command::Undo);
    }
    assert!(person.session().draft().manifest.calibration.is_none() && person.undo_label().is_none());
}

#[test]
fn the_length_that_was_drawn_is_typed_at_once() {
    let mut person = Person::new();
    person.press("Draw a known length");
    person.drag([60.0, 150.0], [120.0, 150.0]);
    person.harness.event(egui::Event::Text("1.25".into()));
    person.harness.run_steps(2);
    person.enter();
    let calibration = person.session().draft().manifest.calibration.clone().unwrap();
    assert!((calibration.scale.known_length.unwrap().mark_spacing_m.value - 1.25).abs() < 1e-9);
}

#[test]
fn bad_numbers_are_refused_with_the_reason_and_change_nothing() {
    let mut person = Person::new();
    person.press("Begin calibration");
    let before = person.session().draft().clone();
    let value = "Withers height";
    for text in ["abc", "", "-1", "0", "99", "1e999", "nan", "1/0", "15.3.2", "½", "12 m"] {
        person.type_into(value, text);
        assert!(person.harness.query_by_label_contains("Not taken over").is_some(), "{text:?}");
        person.enter();
        assert_eq!(*person.session().draft(), before, "{text:?}");
    }
    assert_eq!(person.undo_label(), Some("Begin calibration"));
    person.choose("Unit of Withers height: m", "hands");
    person.type_into(value, "15.4");
    assert!(person.harness.query_by_label_contains("are inches").is_some());
    person.type_into(value, "15.3");
    assert!(person.harness.query_by_label_contains("Not taken over").is_none());
    person.enter();
    let height =
        person.session().draft().manifest.calibration.as_ref().unwrap().scale.withers_height_m.clone();
    assert!((height.unwrap().value - 1.6002).abs() < 1e-9);
    // A click elsewhere ends a field as Enter does, and Escape gives it up.
    person.type_into("Interval", "0.05");
    person.click_on([100.0, 60.0], PointerButton::Primary);
    assert_eq!(person.undo_label(), Some("Interval"));
    person.type_into("Interval", "0.07");
    person.harness.key_press(Key::Escape);
    person.harness.run_steps(2);
    let interval = person.session().draft().manifest.calibration.as_ref().unwrap().time.interval_s.clone();
    assert!((interval.unwrap().value - 0.05).abs() < 1e-12);
    // What drives needs its source; a stride time needs to know when the stride closes.
    person.type_into("Interval, standard deviation", "-0.1");
    assert!(person.harness.query_by_label_contains("must not be negative").is_some());
}

#[test]
fn marks_are_placed_numbered_dragged_and_deleted() {
    let mut person = Person::new();
    person.press("Marks");
    for x in [60.0, 120.0, 180.0] {
        person.click_on([x, 150.0], PointerButton::Primary);
    }
    let numbers = |person: &Person| -> Vec<f64> {
        person.session().panel_annotation().unwrap().marks.iter().map(|mark| mark.mark).collect()
    };
    assert_eq!(numbers(&person), [0.0, 1.0, 2.0]);
    person.drag([120.0, 150.0], [130.0, 140.0]);
    let moved = person.session().panel_annotation().unwrap().marks[1];
    assert!((moved.at_px[0] - 130.0).abs() < 0.6 && (moved.at_px[1] - 140.0).abs() < 0.6, "{moved:?}");
    assert_eq!(person.undo_label(), Some("Move mark 1"));
    person.type_into("Number of mark 3", "1");
    assert!(person.harness.query_by_label_contains("placed twice").is_some());
    person.type_into("Number of mark 3", "2.5");
    person.enter();
    person.click_on([60.0, 150.0], PointerButton::Secondary);
    assert_eq!(numbers(&person), [1.0, 2.5]);
    assert!(person.harness.query_by_label("Mark 2.5").is_some());
    person.press("Number from the left");
    assert_eq!(numbers(&person), [0.0, 1.0]);
}

#[test]
fn a_ground_line_is_dragged_by_its_ends_and_given_up_by_escape() {
    let mut person = Person::new();
    person.drag([40.0, 200.0], [220.0, 205.0]);
    let line = person.session().panel_annotation().unwrap().ground_px.unwrap();
    person.drag(line[1], [230.0, 195.0]);
    let moved = person.session().panel_annotation().unwrap().ground_px.unwrap();
    assert_eq!(moved[0], line[0]);
    assert!((moved[1][0] - 230.0).abs() < 0.6 && (moved[1][1] - 195.0).abs() < 0.6, "{moved:?}");
    let from = person.screen(moved[0]);
    person.harness.hover_at(from);
    person.harness.run_steps(1);
    person.button(from, PointerButton::Primary, true);
    person.harness.hover_at(from + egui::vec2(40.0, -60.0));
    person.harness.run_steps(2);
    person.harness.key_press(Key::Escape);
    person.harness.run_steps(2);
    person.button(from + egui::vec2(60.0, -60.0), PointerButton::Primary, false);
    person.harness.run_steps(2);
    assert_eq!(person.session().panel_annotation().unwrap().ground_px.unwrap(), moved);
    // An end does not go past the other.
    person.drag(moved[0], [240.0, 200.0]);
    let line = person.session().panel_annotation().unwrap().ground_px.unwrap();
    assert!(line[1][0] - line[0][0] > 10.0);
}

#[test]
fn uprights_that_are_found_become_numbered_marks() {
    let truth: Annotation =
        read_json(&specimens().join("annotations/specimen-trot.json"), ANNOTATION_SCHEMA).unwrap();
    let mut person = Person::new();
    person.wait_for(|session| !session.picture_is_missing());
    person.press("Find the ground lines");
    person.wait_for(|session| session.panel_annotation().is_some_and(|panel| panel.ground_px.is_some()));
    person.press("Find uprights");
    person.wait_for(|session| session.panel_annotation().is_some_and(|panel| !panel.marks.is_empty()));
    assert_eq!(person.undo_label(), Some("Find uprights"));
    for panel in &truth.panels[..3] {
        let found = &person.session().draft().panel(panel.panel).unwrap().marks;
        assert_eq!(found.len(), panel.marks.len(), "panel {}", panel.panel);
        for (number, (found, known)) in found.iter().zip(&panel.marks).enumerate() {
            assert!((found.mark - number as f64).abs() < 1e-9);
            assert!((found.at_px[0] - known.at_px[0]).abs() < 1.0, "{found:?} {known:?}");
        }
    }
}
