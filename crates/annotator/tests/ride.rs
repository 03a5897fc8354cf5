//! The Ride page, used as a person uses it: keys, buttons, sliders, time.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::collections::BTreeSet;
use std::path::Path;
use std::time::Duration;

use annotator::app::{Annotator, Places};
use annotator::command::{Command, Menu};
use annotator::ride::{RideSession, Which};
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, ViewportId, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use muybridge_core::{Gait, Side, Turn};
use tempfile::TempDir;

type Window = Harness<'static, Annotator>;

/// The program without a plate, on the Ride page: with little room for the horse, which is drawn in every frame.
fn riding() -> (Window, TempDir) {
    riding_in(vec2(470.0, 420.0))
}

/// The same in a window of a size.
fn riding_in(size: egui::Vec2) -> (Window, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let places = Places { state: Some(folder.path().join("state")), plates: folder.path().to_path_buf() };
    let mut annotator = Annotator::new(&egui::Context::default(), places, Some(&folder.path().join("none")));
    annotator.session = None;
    let mut window = Harness::builder()
        .with_size(size)
        .with_step_dt(1.0 / 60.0)
        .build_ui_state(|ui, annotator: &mut Annotator| annotator.ui(ui), annotator);
    let context = window.ctx.clone();
    window.state_mut().run(&context, Command::PageRide);
    window.state_mut().ride.wait();
    window.run_steps(3);
    (window, folder)
}

fn ride(window: &Window) -> &RideSession {
    window.state().ride.session().unwrap()
}

fn press(window: &mut Window, key: Key) {
    window.key_press(key);
    window.step();
}

fn ride_s(window: &mut Window, seconds: f64) {
    window.run_steps((seconds * 60.0) as usize);
}

fn gait(window: &Window) -> Gait {
    ride(window).shown().riders[0].as_ref().unwrap().readout.gait
}

fn repaint_delay(window: &Window) -> Duration {
    window.output().viewport_output[&ViewportId::ROOT].repaint_delay
}

#[test]
fn keys_drive_the_horse() {
    let (mut window, _folder) = riding();
    for _ in 0..8 {
        press(&mut window, Key::W);
    }
    press(&mut window, Key::ArrowDown);
    assert_eq!(ride(&window).wants().speed_mph, 11.0);
    press(&mut window, Key::Num5);
    assert_eq!(ride(&window).wants().gait, Some(Gait::Canter));
    press(&mut window, Key::L);
    assert_eq!(ride(&window).wants().lead, Some(Side::Left));
    press(&mut window, Key::A);
    press(&mut window, Key::ArrowLeft);
    let Turn::Heading(heading) = ride(&window).wants().turn else { panic!("a heading") };
    assert!((heading.to_degrees() - 30.0).abs() < 0.1, "{heading}");
    ride_s(&mut window, 5.0);
    assert_eq!(gait(&window), Gait::Canter);
    press(&mut window, Key::Num0);
    press(&mut window, Key::H);
    assert_eq!((ride(&window).wants().gait, ride(&window).wants().speed_mph), (None, 0.0));
    press(&mut window, Key::Space);
    let leaped = ride(&window).shown().wants.leaps || ride(&window).wants().leaps;
    assert!(leaped);
    press(&mut window, Key::R);
    assert!(ride(&window).shown().step < 3);
}

#[test]
fn a_held_rein_turns_until_it_is_let_go() {
    let (mut window, _folder) = riding();
    window.key_down(Key::D);
    ride_s(&mut window, 0.8);
    assert!(matches!(ride(&window).wants().turn, Turn::Rate(rate) if rate < 0.0));
    window.key_up(Key::D);
    window.run_steps(2);
    assert!(matches!(ride(&window).wants().turn, Turn::Heading(_)));
}

#[test]
fn a_pause_ends_all_repaints_and_time_stands() {
    let (mut window, _folder) = riding();
    ride_s(&mut window, 0.5);
    assert_eq!(repaint_delay(&window), Duration::ZERO);
    press(&mut window, Key::P);
    window.run_steps(40);
    let step = ride(&window).shown().step;
    assert!(repaint_delay(&window) > Duration::from_secs(1), "{:?}", repaint_delay(&window));
    window.run_steps(10);
    assert_eq!(ride(&window).shown().step, step);
    press(&mut window, Key::P);
    ride_s(&mut window, 0.5);
    assert!(ride(&window).shown().step > step + 20);
}

#[test]
fn a_single_step_back_shows_the_earlier_pose_exactly() {
    let (mut window, _folder) = riding();
    press(&mut window, Key::Num3);
    ride_s(&mut window, 1.0);
    press(&mut window, Key::P);
    let mut seen = Vec::new();
    for _ in 0..5 {
        seen.push(ride(&window).joints(Which::A).unwrap());
        press(&mut window, Key::Period);
    }
    for joints in seen.iter().rev() {
        press(&mut window, Key::Comma);
        assert_eq!(ride(&window).joints(Which::A).unwrap(), *joints);
    }
    window.get_by_label("Ride on from here").click_accesskit();
    window.run_steps(3);
    assert!(!ride(&window).is_paused() && ride(&window).back() == 0);
}

#[test]
fn sliders_rebuild_the_horse_while_it_goes_on() {
    let (mut window, _folder) = riding();
    ride_s(&mut window, 0.5);
    let before = ride(&window).repertoire(Which::A).unwrap().clone();
    let slider = window.get_all_by_label("Legs").find(|node| node.accesskit_node().role() == Role::Slider);
    slider.unwrap().set_value_accesskit(1.3);
    window.step();
    for _ in 0..600 {
        window.step();
        std::thread::sleep(Duration::from_millis(5));
        if !std::sync::Arc::ptr_eq(&before, ride(&window).repertoire(Which::A).unwrap()) {
            break;
        }
    }
    let tall = ride(&window).repertoire(Which::A).unwrap().skeleton().clone();
    assert!(tall.withers_height_m > before.skeleton().withers_height_m + 0.2, "{}", tall.withers_height_m);
    let step = ride(&window).shown().step;
    ride_s(&mut window, 0.5);
    assert!(ride(&window).shown().step > step);
}

#[test]
fn a_second_horse_comes_and_goes() {
    let (mut window, _folder) = riding();
    window.get_by_label("Horse B").click_accesskit();
    window.run_steps(5);
    assert!(ride(&window).has_second());
    assert!(window.query_all_by_label("Bring B beside A").next().is_some());
    ride_s(&mut window, 0.5);
    window.get_by_label("B as a ghost within A").click_accesskit();
    window.run_steps(3);
    let checkbox = window.get_all_by_label("Horse B").find(|n| n.accesskit_node().role() == Role::CheckBox);
    checkbox.unwrap().click_accesskit();
    window.run_steps(3);
    assert!(!ride(&window).has_second());
}

#[test]
fn no_key_at_any_time_does_harm() {
    let (mut window, _folder) = riding();
    let keys: Vec<Key> = Key::ALL.to_vec();
    let mut number = 7_usize;
    for round in 0..700 {
        number = (number * 1_103_515_245 + 12345) % (1 << 31);
        let key = keys[(number >> 8) % keys.len()];
        // These open other windows, of the program or of the system.
        if matches!(key, Key::F1 | Key::F2 | Key::F3 | Key::F4 | Key::F5) {
            continue;
        }
        let modifiers = if round % 5 == 0 { Modifiers::SHIFT } else { Modifiers::NONE };
        for pressed in [true, false] {
            let event = Event::Key { key, physical_key: None, pressed, repeat: false, modifiers };
            window.input_mut().events.push(event);
        }
        window.step();
        if !window.state().ride.is_open() {
            let context = window.ctx.clone();
            window.state_mut().run(&context, Command::PageRide);
        }
        let joints = ride(&window).joints(Which::A).unwrap();
        assert!(joints.tips.iter().all(|at| at.is_finite()), "{key:?}");
    }
}

#[test]
fn every_ride_command_acts_on_the_ride_page_only() {
    let (mut window, _folder) = riding();
    let rides = Command::ALL.iter().copied().filter(|c| c.description().menu == Menu::Ride);
    let rides: Vec<Command> = rides.collect();
    assert!(rides.iter().all(|command| window.state().why_not(*command).is_none()));
    assert_eq!(window.state().why_not(Command::Undo), Some("Leave the Ride page first"));
    press(&mut window, Key::Escape);
    assert!(!window.state().ride.is_open());
    assert!(rides.iter().all(|command| window.state().why_not(*command).is_some()));
    let speed = ride(&window).wants().speed_mph;
    press(&mut window, Key::W);
    assert_eq!(ride(&window).wants().speed_mph, speed);
    window.get_by_label_contains("Ride a horse").click();
    window.run_steps(2);
    assert!(window.state().ride.is_open());
}

#[test]
fn every_control_has_a_name() {
    let (mut window, _folder) = riding_in(vec2(1100.0, 1500.0));
    window.get_by_label("Hills").click_accesskit();
    window.get_by_label("Horse B").click_accesskit();
    window.run_steps(3);
    let root = window.root();
    let mut waiting: Vec<_> = root.children().collect();
    let mut seen = 0;
    while let Some(node) = waiting.pop() {
        let inner = node.accesskit_node();
        let acts = matches!(
            inner.role(),
            Role::Button | Role::CheckBox | Role::Slider | Role::SpinButton | Role::ComboBox | Role::Canvas
        );
        if acts {
            seen += 1;
            let name = inner.label().or(inner.value());
            assert!(name.is_some_and(|name| !name.trim().is_empty()), "{inner:?}");
        }
        waiting.extend(node.children());
    }
    assert!(seen > 50, "{seen}");
}

#[test]
fn the_photograph_nearest_in_phase_stands_beside_a_horse_of_the_plates_gait() {
    let specimens = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plates/specimens");
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir_all(folder.path().join("annotations")).unwrap();
    for file in ["specimen-gallop.json", "specimen-gallop.jpg", "annotations/specimen-gallop.json"] {
        std::fs::copy(specimens.join(file), folder.path().join(file)).unwrap();
    }
    let path = folder.path().join("annotations/specimen-gallop.json");
    let (mut window, _folder) = riding_in(vec2(1000.0, 500.0));
    let context = window.ctx.clone();
    window.state_mut().open(&context, &path);
    window.state_mut().wait_until_open(&context);
    assert!(!window.state().ride.is_open(), "a plate that is opened is shown");
    let session = window.state_mut().session.as_mut().unwrap();
    session.fit.start(&session.document, &context);
    session.fit.wait();
    press(&mut window, Key::F6);
    press(&mut window, Key::Num6);
    ride_s(&mut window, 5.0);
    let mut panels = BTreeSet::new();
    for _ in 0..40 {
        window.step();
        let shown = window.query_all_by_label_contains("of the plate").next();
        panels.extend(shown.and_then(|node| node.accesskit_node().value().or(node.accesskit_node().label())));
    }
    assert!(panels.iter().filter(|text| text.starts_with("Panel")).count() > 6, "{panels:?}");
    press(&mut window, Key::Num1);
    ride_s(&mut window, 4.0);
    assert!(window.query_all_by_label_contains("of the plate").next().is_none());
    press(&mut window, Key::F3);
    window.run_steps(2);
    assert!(!window.state().ride.is_open());
}
