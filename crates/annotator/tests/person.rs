//! A person's whole way through the program, without a display: from a bare picture to exported points, with a kill on
//! the way. The same in a real window, with screenshots: `tests/window/person.py`.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::path::{Path, PathBuf};
use std::time::Duration;

use annotator::app::{Annotator, Places};
use annotator::command::Command;
use annotator::picture::ImageState;
use annotator::session::Session;
use egui::{Key, Modifiers, Pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use muybridge_capture::{
    Annotation, Draft, Facing, KEYPOINT_COUNT, Keypoint, KeypointState, NearOff, StanceLabel, read_json,
};
use muybridge_core::Pair;
use tempfile::TempDir;

/// A click on the screen hits the point that is meant to a third of a plate px.
const HIT_PX: f64 = 0.35;

struct Person {
    harness: Harness<'static, Annotator>,
    folder: TempDir,
    truth: Annotation,
}

fn specimen(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plates/specimens").join(file)
}

/// The program; without a path it starts as it does after a crash.
fn started(folder: &Path, path: Option<&Path>) -> Harness<'static, Annotator> {
    let context = egui::Context::default();
    let places = Places { state: Some(folder.join("state")), plates: folder.to_path_buf() };
    let mut annotator = Annotator::new(&context, places, path);
    annotator.settings.fit_always = false;
    annotator.wait_until_open(&context);
    Harness::builder()
        .with_size(vec2(1360.0, 1400.0))
        .with_step_dt(1.0 / 60.0)
        .with_max_steps(40)
        .build_ui_state(|ui, annotator: &mut Annotator| annotator.ui(ui), annotator)
}

impl Person {
    /// A bare picture in a folder of its own.
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let picture = folder.path().join("specimen-gallop.jpg");
        std::fs::copy(specimen("specimen-gallop.jpg"), &picture).unwrap();
        let truth = read_json(&specimen("annotations/specimen-gallop.json"), 1).unwrap();
        let harness = started(folder.path(), Some(&picture));
        let mut person = Self { harness, folder, truth };
        person.wait();
        person
    }

    fn session(&self) -> &Session {
        self.harness.state().session.as_ref().unwrap()
    }

    fn draft(&self) -> Draft {
        self.session().document.draft().clone()
    }

    /// Frames pass until pictures are read and nothing is under way.
    fn wait(&mut self) {
        loop {
            self.harness.step();
            let reading =
                self.session().images.states().iter().any(|state| matches!(state, ImageState::Waiting));
            if !reading && self.session().work_under_way().is_none() {
                break;
            }
            std::thread::sleep(Duration::from_millis(2));
        }
        self.harness.run_ok();
    }

    fn press(&mut self, label: &str) {
        self.harness.query_all_by_label_contains(label).next().unwrap().click();
        self.harness.run_ok();
        self.wait();
    }

    fn key(&mut self, modifiers: Modifiers, key: Key) {
        self.harness.key_press_modifiers(modifiers, key);
        self.harness.run_ok();
    }

    fn drag(&mut self, from: Pos2, to: Pos2) {
        self.harness.hover_at(from);
        self.harness.run_ok();
        self.harness.drag_at(from);
        self.harness.run_ok();
        for share in [0.3, 0.7, 1.0] {
            self.harness.hover_at(from + share * (to - from));
            self.harness.run_ok();
        }
        self.harness.drop_at(to);
        self.harness.run_ok();
    }

    fn click_at(&mut self, at: Pos2) {
        self.drag(at, at);
    }

    fn middle_of(&self, label: &str) -> Pos2 {
        self.harness.query_all_by_label(label).next().unwrap().rect().center()
    }

    /// A handle on the photograph; the list at the right has the same names.
    fn handle(&self, name: &str) -> Pos2 {
        let canvas = self.harness.get_by_label("Photograph").rect();
        let mut places = self.harness.query_all_by_label(name).map(|node| node.rect().center());
        places.find(|at| canvas.contains(*at)).unwrap()
    }

    fn undo(&mut self) {
        self.key(Modifiers::COMMAND, Key::Z);
    }
}

fn splits_and_says_what_it_is(person: &mut Person) {
    person.press("Find panels");
    assert_eq!(person.draft().manifest.panels.len(), 12);
    let (before, corner) = (person.draft(), person.middle_of("Panel 1 top left"));
    person.drag(corner, corner + vec2(25.0, 18.0));
    assert_ne!(person.draft(), before);
    person.undo();
    assert_eq!(person.draft(), before, "one drag is one step");
    // A field that is still being typed in, and a click elsewhere: both count.
    let title = person.middle_of("Title");
    person.click_at(title + vec2(120.0, 0.0));
    person.harness.event(egui::Event::Text("Gallop".into()));
    person.harness.run_ok();
    person.press("Right");
    let manifest = person.draft().manifest;
    assert_eq!((manifest.title.as_str(), manifest.facing), ("Gallop", Some(Facing::Right)));
}

fn calibrates(person: &mut Person) {
    person.key(Modifiers::NONE, Key::F2);
    for step in [
        "Find the ground lines",
        "A length in the picture is known",
        "A row of cameras, evenly spaced",
        "The interval between panels is known",
        "Begin calibration",
        "Find uprights",
        "Number all panels alike",
    ] {
        person.press(step);
    }
    let draft = person.draft();
    let ready =
        |panel: &muybridge_capture::PanelAnnotation| panel.ground_px.is_some() && panel.marks.len() >= 5;
    assert_eq!(draft.annotation.panels.iter().filter(|panel| ready(panel)).count(), 12);
}

/// Every point of a panel by a click, guessed ones after O.
fn poses(person: &mut Person, panel: u32) {
    person.key(Modifiers::NONE, Key::F3);
    person.press(&format!("Panel {panel}"));
    let truth = person.truth.panels.iter().find(|p| p.panel == panel).unwrap().keypoints.clone();
    for keypoint in Keypoint::all() {
        let point = truth.get(keypoint).unwrap();
        if point.state == KeypointState::Occluded {
            person.key(Modifiers::NONE, Key::O);
        }
        let canvas = person.harness.get_by_label("Photograph").rect();
        let place = person.session().panel_place().unwrap().clone();
        let at = person.session().zoom.view(&place, canvas).screen_from_plate(point.at_px.unwrap());
        person.click_at(at);
    }
    let placed = person.draft().panel(panel).unwrap().keypoints.clone();
    assert_eq!(placed.iter().count(), KEYPOINT_COUNT);
    for (keypoint, point) in placed.iter() {
        let (is, meant) = (point.at_px.unwrap(), truth.get(keypoint).unwrap());
        let [x, y] = meant.at_px.unwrap();
        assert!((is[0] - x).hypot(is[1] - y) < HIT_PX && point.state == meant.state, "{keypoint}: {point:?}");
    }
}

fn drags_the_skeleton_and_marks_a_footfall(person: &mut Person) {
    person.key(Modifiers::NONE, Key::K);
    let before = person.draft();
    let hock = person.handle("near hock");
    person.drag(hock, hock - vec2(30.0, 20.0));
    let reached = person.handle("near hock");
    assert!(reached.distance(hock - vec2(30.0, 20.0)) < 1.0, "the joint is under the pointer: {reached:?}");
    let hoof = Keypoint::hoof(NearOff::Near, Pair::Hind);
    let place = |draft: &Draft| draft.panel(2).unwrap().keypoints.place(hoof).unwrap();
    let (was, is) = (place(&before), place(&person.draft()));
    assert!((was[0] - is[0]).hypot(was[1] - is[1]) > 2.0, "the hoof follows");
    person.undo();
    assert_eq!(person.draft(), before);
    let lane = person.harness.get_by_label("Footfalls near hind").rect();
    person.click_at(Pos2::new(lane.left() + 1.5 * lane.width() / 12.0, lane.center().y));
    assert_eq!(person.draft().panel(2).unwrap().contacts.of(NearOff::Near, Pair::Hind), StanceLabel::Stance);
}

/// Three nudges after saving, then the program is gone; the next one offers exactly that.
fn is_killed_and_takes_up(mut person: Person) -> Person {
    person.key(Modifiers::COMMAND, Key::S);
    assert!(!person.session().document.is_changed());
    person.key(Modifiers::NONE, Key::P);
    let hock = person.handle("near hock");
    person.click_at(hock);
    let mut states = vec![person.draft()];
    for _ in 0..3 {
        person.key(Modifiers::NONE, Key::ArrowUp);
        states.push(person.draft());
    }
    let Person { harness, folder, truth } = person;
    drop(harness);
    let mut person = Person { harness: started(folder.path(), None), folder, truth };
    person.harness.run_ok();
    assert!(person.harness.query_by_label_contains("3 changes").is_some());
    person.harness.get_by_label("Take up specimen-gallop").click();
    person.harness.run_ok();
    person.wait();
    assert_eq!(person.draft(), states[3]);
    person.undo();
    assert_eq!(person.draft(), states[2]);
    person
}

fn fits_a_whole_stride(person: &mut Person) {
    let folder = person.folder.path().join("whole");
    std::fs::create_dir_all(folder.join("annotations")).unwrap();
    for file in ["specimen-gallop.jpg", "specimen-gallop.json", "annotations/specimen-gallop.json"] {
        std::fs::copy(specimen(file), folder.join(file)).unwrap();
    }
    let context = person.harness.ctx.clone();
    let annotator = person.harness.state_mut();
    annotator.open(&context, &folder.join("annotations/specimen-gallop.json"));
    annotator.wait_until_open(&context);
    person.wait();
    person.key(Modifiers::COMMAND, Key::F);
    person.wait();
    person.key(Modifiers::NONE, Key::F4);
    assert!(person.harness.query_by_label("Fit of the present points.").is_some());
    let fitted = person.session().fit.latest().unwrap();
    assert!(fitted.plate.residuals.iter().all(|residual| residual.metres() < 0.06));
}

fn exports(person: &mut Person) {
    person.harness.key_press_modifiers(Modifiers::COMMAND, Key::E);
    person.harness.run_ok();
    person.harness.get_by_label("Export").click();
    person.harness.run_ok();
    let export = person.folder.path().join("annotations/specimen-gallop-export");
    assert!(std::fs::read_dir(export).unwrap().count() > 0);
}

#[test]
fn a_person_goes_from_a_bare_picture_to_exported_points() {
    let mut person = Person::new();
    splits_and_says_what_it_is(&mut person);
    calibrates(&mut person);
    poses(&mut person, 1);
    poses(&mut person, 2);
    assert!(person.session().derived.calibration.is_ok());
    drags_the_skeleton_and_marks_a_footfall(&mut person);
    let mut person = is_killed_and_takes_up(person);
    let context = person.harness.ctx.clone();
    person.harness.state_mut().run(&context, Command::Save);
    let path = person.folder.path().join("annotations/specimen-gallop.json");
    let saved: Annotation = read_json(&path, 1).unwrap();
    assert_eq!(saved, person.draft().annotation);
    exports(&mut person);
    fits_a_whole_stride(&mut person);
}
