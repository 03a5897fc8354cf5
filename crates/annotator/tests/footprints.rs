//! The Footprints page, used as a person uses it: handles, bars, keys, files.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::path::Path;
use std::time::Duration;

use annotator::app::{Annotator, Places};
use annotator::command::{Command, Menu};
use annotator::footprints::Editor;
use annotator::footprints::document::TrackDocument;
use egui::accesskit::Role;
use egui::{Event, Key, Modifiers, PointerButton, Pos2, Vec2, ViewportId, pos2, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::{NodeT, Queryable};
use muybridge_footprints::{Foot, Print, Track};
use tempfile::TempDir;

type Window = Harness<'static, Annotator>;

/// The program without a plate, on the Footprints page, with the walking bird.
fn walking() -> (Window, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let window = window_in(folder.path());
    (window, folder)
}

fn window_in(folder: &Path) -> Window {
    let places = Places { state: Some(folder.join("state")), plates: folder.to_path_buf() };
    let mut annotator = Annotator::new(&egui::Context::default(), places, Some(&folder.join("none")));
    annotator.session = None;
    let mut window = Harness::builder()
        .with_size(vec2(1300.0, 820.0))
        .with_step_dt(1.0 / 60.0)
        .build_ui_state(|ui, annotator: &mut Annotator| annotator.ui(ui), annotator);
    run(&mut window, Command::PageFootprints);
    settle(&mut window);
    window
}

fn run(window: &mut Window, command: Command) {
    let context = window.ctx.clone();
    window.state_mut().run(&context, command);
    window.step();
}

/// Until the motion is that of the track.
fn settle(window: &mut Window) {
    window.step();
    window.state_mut().footprints.wait();
    window.run_steps(3);
}

fn editor(window: &Window) -> &Editor {
    window.state().footprints.editor()
}

fn show(window: &mut Window, track: Track) {
    window.state_mut().footprints.show_document(TrackDocument::new(track));
    settle(window);
}

fn middle(window: &Window, name: &str) -> Pos2 {
    window.get_by_label(name).rect().center()
}

fn pointer(window: &mut Window, at: Pos2, pressed: Option<bool>, modifiers: Modifiers) {
    window.input_mut().events.push(Event::PointerMoved(at));
    if let Some(pressed) = pressed {
        let event = Event::PointerButton { pos: at, button: PointerButton::Primary, pressed, modifiers };
        window.input_mut().events.push(event);
    }
    window.step();
}

/// Drags from a place; what is shown in the middle of it is looked at by `between`.
fn drag_at(window: &mut Window, from: Pos2, by: Vec2, between: impl FnOnce(&mut Window)) {
    pointer(window, from, None, Modifiers::NONE);
    pointer(window, from, Some(true), Modifiers::NONE);
    for share in [0.3, 0.6, 1.0] {
        pointer(window, from + by * share, None, Modifiers::NONE);
    }
    window.step();
    between(window);
    pointer(window, from + by, Some(false), Modifiers::NONE);
    window.run_steps(3);
}

fn drag(window: &mut Window, name: &str, by: Vec2) {
    let from = middle(window, name);
    drag_at(window, from, by, |_| {});
}

fn press(window: &mut Window, key: Key) {
    window.key_press(key);
    window.run_steps(2);
}

fn press_with(window: &mut Window, modifiers: Modifiers, key: Key) {
    window.key_press_modifiers(modifiers, key);
    window.run_steps(2);
}

/// Prints but for one.
fn others(track: &Track, print: usize) -> Vec<Print> {
    let rest = track.prints.iter().enumerate().filter(|(i, _)| *i != print);
    rest.map(|(_, print)| *print).collect()
}

#[test]
fn each_of_the_five_handles_changes_its_number_and_the_motion_follows() {
    let (mut window, _folder) = walking();
    let name = format!("Print 5 {}", editor(&window).prints()[4].foot.abbreviation());
    for (handle, by) in [
        (name.as_str(), vec2(30.0, 0.0)),
        (name.as_str(), vec2(0.0, 25.0)),
        ("Heading of print 5", vec2(-8.0, 25.0)),
        ("Stance time of print 5", vec2(0.0, 25.0)),
        ("Step time of print 5", vec2(0.0, 12.0)),
    ] {
        let before = editor(&window).track().clone();
        let (was, timing) = (before.prints[4], editor(&window).timing(4).unwrap());
        let curve = editor(&window).motion().unwrap().solved.trajectory.clone();
        let from = middle(&window, handle);
        // A dagger points away from the other foot, whichever way the bird has turned.
        let by = if handle.contains("time") { dagger(&window) * by.y } else { by };
        drag_at(&mut window, from, by, |window| {
            let motion = editor(window).motion().unwrap();
            assert_ne!(motion.solved.trajectory, curve, "{handle}: the motion follows while it is dragged");
        });
        let track = editor(&window).track();
        let now = track.prints[4];
        assert_eq!(others(track, 4), others(&before, 4), "{handle}");
        let times = editor(&window).timing(4).unwrap();
        let changed = [
            now.at_m != was.at_m,
            now.heading_deg != was.heading_deg,
            (times.stance_time_s - timing.stance_time_s).abs() > 1e-9,
            (times.step_time_s - timing.step_time_s).abs() > 1e-9,
        ];
        let wanted = match handle {
            "Heading of print 5" => [false, true, false, false],
            "Stance time of print 5" => [false, false, true, false],
            "Step time of print 5" => [false, false, false, true],
            // Times of a print without times of its own follow from the distances.
            _ => [true, false, changed[2], changed[3]],
        };
        assert_eq!(changed, wanted, "{handle}");
        press_with(&mut window, Modifiers::COMMAND, Key::Z);
        settle(&mut window);
        assert_eq!(*editor(&window).track(), before, "{handle}: undone in one step");
        assert_eq!(editor(&window).motion().unwrap().solved.trajectory, curve, "{handle}");
    }
}

/// Which way the dagger of print 5 points on the screen.
fn dagger(window: &Window) -> Vec2 {
    let print = editor(window).prints()[4];
    let heading = print.heading_deg.to_radians();
    let ahead = vec2(heading.cos() as f32, -heading.sin() as f32);
    if print.foot == Foot::Left { vec2(ahead.y, -ahead.x) } else { vec2(-ahead.y, ahead.x) }
}

#[test]
fn the_timing_diagram_and_the_plan_agree() {
    let (mut window, _folder) = walking();
    let before = editor(&window).stances();
    drag(&mut window, "Lift-off of print 4", vec2(12.0, 0.0));
    settle(&mut window);
    let after = editor(&window).stances();
    assert!(after[3].lift_off_s > before[3].lift_off_s + 0.01);
    assert!(editor(&window).selected.is_empty() || editor(&window).selected.contains(&3));
    let placed = &editor(&window).motion().unwrap().placed.prints;
    for (times, print) in after.iter().zip(placed) {
        assert!((times.strike_s - print.strike_s).abs() < 1e-9);
        assert!((times.lift_off_s.min(editor(&window).end_s()) - print.lift_off_s).abs() < 2e-3);
    }
    drag(&mut window, "Stance of print 4", vec2(10.0, 0.0));
    settle(&mut window);
    let moved = editor(&window).stances();
    let by_s = moved[3].strike_s - after[3].strike_s;
    assert!(by_s > 0.005, "{by_s}");
    assert!((moved[3].lift_off_s - after[3].lift_off_s - by_s).abs() < 1e-9);
    assert!((moved[4].strike_s - after[4].strike_s).abs() < 1e-9, "all others stay");
    assert_eq!(editor(&window).selected.iter().copied().collect::<Vec<_>>(), [3], "selected in both");
    drag(&mut window, "Footfall of print 4", vec2(-10.0, 0.0));
    let early = editor(&window).stances();
    assert!(early[3].strike_s < moved[3].strike_s - 0.005);
    assert!((early[3].lift_off_s - moved[3].lift_off_s).abs() < 1e-9);
    drag(&mut window, "Step time of print 6 in the diagram", vec2(15.0, 0.0));
    let later = editor(&window).stances();
    assert!(later[6].strike_s > early[6].strike_s + 0.01);
    assert!((later[7].next_s - early[7].next_s - (later[6].strike_s - early[6].strike_s)).abs() < 1e-9);
}

#[test]
fn prints_are_selected_moved_together_and_deleted() {
    let (mut window, _folder) = walking();
    let before = editor(&window).track().clone();
    let names: Vec<String> =
        [2, 4].map(|i: usize| format!("Print {} {}", i + 1, before.prints[i].foot.abbreviation())).to_vec();
    window.get_by_label(&names[0]).click();
    window.run_steps(2);
    let at = middle(&window, &names[1]);
    window.input_mut().events.push(Event::ModifiersChanged(Modifiers::SHIFT));
    pointer(&mut window, at, Some(true), Modifiers::SHIFT);
    pointer(&mut window, at, Some(false), Modifiers::SHIFT);
    window.input_mut().events.push(Event::ModifiersChanged(Modifiers::NONE));
    window.run_steps(2);
    assert_eq!(editor(&window).selected.iter().copied().collect::<Vec<_>>(), [2, 4]);
    drag(&mut window, &names[0], vec2(0.0, 40.0));
    let moved = editor(&window).track();
    let by = |i: usize| moved.prints[i].at_m[1] - before.prints[i].at_m[1];
    assert!(by(2) > 0.01 && (by(2) - by(4)).abs() < 1e-12 && by(3) == 0.0);
    press(&mut window, Key::ArrowLeft);
    assert!((editor(&window).track().prints[4].at_m[0] - before.prints[4].at_m[0] + 0.01).abs() < 1e-9);
    press(&mut window, Key::Delete);
    assert_eq!(editor(&window).prints().len(), before.prints.len() - 2);
    for _ in 0..3 {
        press_with(&mut window, Modifiers::COMMAND, Key::Z);
    }
    assert_eq!(*editor(&window).track(), before);
    // A rubber band around everything.
    let plan = plan_rect(&window);
    drag_at(&mut window, plan.min + vec2(4.0, 4.0), plan.size() - vec2(8.0, 8.0), |_| {});
    assert_eq!(editor(&window).selected.len(), before.prints.len());
    press(&mut window, Key::Escape);
    assert!(editor(&window).selected.is_empty() && window.state().footprints.is_open());
    press(&mut window, Key::Insert);
    assert_eq!(editor(&window).prints().len(), before.prints.len() + 1);
    let feet: Vec<Foot> = editor(&window).prints().iter().rev().take(2).map(|print| print.foot).collect();
    assert_ne!(feet[0], feet[1]);
}

fn plan_rect(window: &Window) -> egui::Rect {
    let is_plan = |node: &egui_kittest::Node<'_>| {
        node.accesskit_node().label().is_some_and(|label| label.starts_with("Plan: "))
    };
    window.get_all_by_role(Role::Canvas).find(is_plan).unwrap().rect()
}

#[test]
fn a_double_click_adds_a_print_there() {
    let (mut window, _folder) = walking();
    let (count, at) = (editor(&window).prints().len(), plan_rect(&window).right_bottom() - vec2(60.0, 60.0));
    for _ in 0..2 {
        pointer(&mut window, at, Some(true), Modifiers::NONE);
        pointer(&mut window, at, Some(false), Modifiers::NONE);
    }
    window.run_steps(3);
    assert_eq!(editor(&window).prints().len(), count + 1);
    assert!(editor(&window).selected.contains(&count));
}

#[test]
fn a_path_is_drawn_by_clicks_and_its_prints_are_laid() {
    let (mut window, _folder) = walking();
    run(&mut window, Command::FootprintsNewEmpty);
    settle(&mut window);
    press(&mut window, Key::D);
    let plan = plan_rect(&window);
    for share in [[0.15, 0.3], [0.5, 0.6], [0.85, 0.4]] {
        let at = plan.min + plan.size() * Vec2::from(share);
        pointer(&mut window, at, Some(true), Modifiers::NONE);
        pointer(&mut window, at, Some(false), Modifiers::NONE);
        // A second click soon after would be a double click.
        window.run_steps(30);
    }
    settle(&mut window);
    assert!(
        editor(&window).are_laid() && editor(&window).prints().len() > 3,
        "{}",
        editor(&window).prints().len()
    );
    let laid = editor(&window).prints().to_vec();
    press(&mut window, Key::Escape);
    drag(&mut window, "Path point 2", vec2(0.0, -60.0));
    settle(&mut window);
    assert_ne!(editor(&window).prints(), laid);
    drag(&mut window, "Tangent of path point 2", vec2(0.0, 40.0));
    settle(&mut window);
    assert!(editor(&window).track().path.as_ref().unwrap().points[1].tangent_m.is_some());
    press(&mut window, Key::L);
    settle(&mut window);
    assert!(!editor(&window).are_laid() && !editor(&window).track().prints.is_empty());
    window.get_by_label("Forget the path").click_accesskit();
    window.run_steps(3);
    assert!(editor(&window).track().path.is_none() && !editor(&window).prints().is_empty());
}

#[test]
fn time_passes_while_it_plays_and_nothing_is_painted_while_it_stands() {
    let (mut window, _folder) = walking();
    press(&mut window, Key::P);
    window.run_steps(30);
    let time_s = editor(&window).playback.time_s();
    assert!((0.3..0.7).contains(&time_s), "{time_s}");
    press(&mut window, Key::P);
    window.run_steps(40);
    let delay = window.output().viewport_output[&ViewportId::ROOT].repaint_delay;
    assert!(delay > Duration::from_secs(1), "{delay:?}");
    let stood_s = editor(&window).playback.time_s();
    press(&mut window, Key::Period);
    assert!((editor(&window).playback.time_s() - stood_s - 1.0 / 60.0).abs() < 1e-9);
    let diagram = window.get_by_label_contains("Present moment").rect();
    let at = pos2(diagram.center().x, diagram.bottom() - 20.0);
    drag_at(&mut window, at, vec2(60.0, 0.0), |_| {});
    assert!(editor(&window).playback.time_s() > stood_s);
}

#[test]
fn numbers_that_are_typed_change_the_print_and_nonsense_changes_nothing() {
    let (mut window, _folder) = walking();
    press(&mut window, Key::N);
    let before = editor(&window).track().clone();
    for (field, text) in [("Print x", "NaN"), ("Print heading", "inf"), ("Print stance time", "-NaN")] {
        let node = window.get_by_label(field);
        node.click();
        window.run_steps(3);
        window.input_mut().events.push(Event::Text(text.into()));
        window.run_steps(2);
        press(&mut window, Key::Enter);
        let track = editor(&window).track();
        let finite =
            track.prints.iter().all(|print| print.heading_deg.is_finite() && print.at_m[0].is_finite());
        assert!(finite, "{field} {text}");
        assert_eq!(track.prints[1..], before.prints[1..], "{field} {text}");
    }
    while editor(&window).document.undo_label().is_some() {
        run(&mut window, Command::FootprintsUndo);
    }
    window.get_by_label("Print x").click();
    window.run_steps(3);
    window.input_mut().events.push(Event::Text("0.05".into()));
    window.run_steps(2);
    press(&mut window, Key::Enter);
    assert_eq!(editor(&window).track().prints[0].at_m[0], 0.05);
    run(&mut window, Command::FootprintsUndo);
    assert_eq!(*editor(&window).track(), before);
}

#[test]
fn unsaved_work_is_asked_about_and_survives_a_crash() {
    let (mut window, folder) = walking();
    press(&mut window, Key::Insert);
    let track = editor(&window).track().clone();
    run(&mut window, Command::FootprintsNewRunner);
    window.run_steps(2);
    window.get_by_label("Cancel").click();
    window.run_steps(2);
    assert_eq!(*editor(&window).track(), track);
    drop(window);
    let mut again = window_in(folder.path());
    again.run_steps(3);
    again.get_by_label_contains("Take up").click();
    again.run_steps(3);
    assert_eq!(*editor(&again).track(), track);
    run(&mut again, Command::SaveAs);
    again.run_steps(2);
    let path = folder.path().join("kept.json");
    let field = again.get_by_label("Path of the track");
    field.focus();
    again.run_steps(2);
    press_with(&mut again, Modifiers::COMMAND, Key::A);
    again.input_mut().events.push(Event::Text(path.display().to_string()));
    again.run_steps(2);
    again.get_by_label("Save here").click();
    again.run_steps(3);
    assert!(!editor(&again).document.is_changed());
    run(&mut again, Command::FootprintsNewRunner);
    settle(&mut again);
    assert_ne!(*editor(&again).track(), track);
    let context = again.ctx.clone();
    again.state_mut().open(&context, &path);
    again.state_mut().wait_until_open(&context);
    settle(&mut again);
    assert_eq!(*editor(&again).track(), track);
    drop(again);
    let last = window_in(folder.path());
    assert!(last.query_by_label_contains("Take up").is_none(), "all was saved");
}

#[test]
fn files_that_are_no_tracks_do_no_harm() {
    let (mut window, folder) = walking();
    let before = editor(&window).track().clone();
    let good = before.to_json();
    let texts = [
        "{\"model\": 3, \"prints\": []}".to_string(),
        "{\"schema\": 1, \"model\": \"bird\", \"prints\": [{}]}".to_string(),
        good.replace("\"schema\": 1", "\"schema\": 99"),
        good[..good.len() / 2].to_string(),
        "\"model\" \"prints\"".to_string(),
        "[".repeat(100_000) + "\"model\" \"prints\"",
    ];
    for (i, text) in texts.iter().enumerate() {
        let path = folder.path().join(format!("bad-{i}.json"));
        muybridge_capture::write_atomically(&path, text.as_bytes()).unwrap();
        let context = window.ctx.clone();
        let messages = window.state().messages.all().len();
        window.state_mut().open(&context, &path);
        window.state_mut().wait_until_open(&context);
        window.run_steps(2);
        assert!(window.state().messages.all().len() > messages, "{i}");
        assert_eq!(*editor(&window).track(), before, "{i}");
    }
    // What reads as a track but cannot be walked is shown, with what is wrong.
    for (i, odd) in ["1e300", "-5.0"].iter().enumerate() {
        let path = folder.path().join(format!("odd-{i}.json"));
        let mut track = before.clone();
        track.prints[2].heading_deg = 12_345.0;
        let text = track.to_json().replace("12345.0", odd);
        muybridge_capture::write_atomically(&path, text.as_bytes()).unwrap();
        let context = window.ctx.clone();
        window.state_mut().open(&context, &path);
        window.state_mut().wait_until_open(&context);
        settle(&mut window);
        press(&mut window, Key::P);
        window.run_steps(5);
        press(&mut window, Key::P);
    }
    let mut unknown = before.clone();
    unknown.model = "unicorn".into();
    show(&mut window, unknown);
    assert!(!editor(&window).solving.faults().is_empty());
}

#[test]
fn ten_thousand_prints_can_be_looked_at_and_edited() {
    let (mut window, _folder) = walking();
    let mut track = Track::new("bird");
    track.prints = (0..10_000)
        .map(|i| Print {
            foot: Foot::BIPED[i % 2],
            at_m: [0.2 * i as f64, if i % 2 == 0 { -0.06 } else { 0.06 }],
            heading_deg: 0.0,
            timing: None,
        })
        .collect();
    show(&mut window, track);
    let begun = std::time::Instant::now();
    window.run_steps(5);
    press_with(&mut window, Modifiers::COMMAND, Key::A);
    press(&mut window, Key::ArrowUp);
    press(&mut window, Key::Delete);
    assert!(editor(&window).prints().is_empty());
    run(&mut window, Command::FootprintsUndo);
    assert_eq!(editor(&window).prints().len(), 10_000);
    window.run_steps(3);
    let frames_s = begun.elapsed().as_secs_f64();
    println!("14 frames of 10,000 prints: {frames_s:.2} s");
    assert!(frames_s < 20.0, "{frames_s}");
}

#[test]
fn models_change_and_a_horse_is_laid_along_the_way() {
    let (mut window, _folder) = walking();
    for model in ["dinosaur", "human", "horse", "bird"] {
        let button = window.get_all_by_label(model).find(|node| node.accesskit_node().role() == Role::Button);
        button.unwrap().click_accesskit();
        window.run_steps(2);
        settle(&mut window);
        settle(&mut window);
        assert_eq!(editor(&window).track().model, model);
        assert!(editor(&window).prints().len() > 3, "{model}: {:?}", editor(&window).solving.faults());
        assert_eq!(editor(&window).prints()[0].foot.is_biped(), model != "horse", "{model}");
    }
}

#[test]
fn a_bird_wanders_and_its_walk_is_kept() {
    let (mut window, _folder) = walking();
    press(&mut window, Key::W);
    window.run_steps(240);
    let walk = window.state().footprints.walk().unwrap();
    assert!(walk.fault().is_none() && walk.time_s() > 3.0, "{:?} {}", walk.fault(), walk.time_s());
    assert!(window.state().why_not(Command::FootprintsAdd).is_some());
    window.get_by_label("Stop").click_accesskit();
    window.run_steps(3);
    let time_s = window.state().footprints.walk().unwrap().time_s();
    window.run_steps(20);
    assert_eq!(window.state().footprints.walk().unwrap().time_s(), time_s);
    window.get_by_label("Keep as a track").click_accesskit();
    window.run_steps(2);
    settle(&mut window);
    assert!(window.state().footprints.walk().is_none());
    assert!(editor(&window).prints().len() > 5 && editor(&window).document.is_changed());
    assert!(editor(&window).motion().is_some(), "{:?}", editor(&window).solving.faults());
}

#[test]
fn no_key_at_any_time_does_harm() {
    let (mut window, _folder) = walking();
    let keys: Vec<Key> = Key::ALL.to_vec();
    let mut number = 11_usize;
    for round in 0..500 {
        number = (number * 1_103_515_245 + 12345) % (1 << 31);
        let key = keys[(number >> 8) % keys.len()];
        // These go to other pages.
        if matches!(key, Key::F1 | Key::F2 | Key::F3 | Key::F4 | Key::F5 | Key::F6) {
            continue;
        }
        let modifiers = if round % 5 == 0 { Modifiers::SHIFT } else { Modifiers::NONE };
        for pressed in [true, false] {
            let event = Event::Key { key, physical_key: None, pressed, repeat: false, modifiers };
            window.input_mut().events.push(event);
        }
        window.step();
        if !window.state().footprints.is_open() {
            run(&mut window, Command::PageFootprints);
        }
    }
}

#[test]
fn every_footprints_command_acts_on_its_page_only() {
    let (mut window, _folder) = walking();
    let all: Vec<Command> =
        Command::ALL.iter().copied().filter(|c| c.description().menu == Menu::Footprints).collect();
    assert_eq!(window.state().why_not(Command::RideLeap), Some("Go to the Ride page first"));
    assert_eq!(window.state().why_not(Command::NextPanel), Some("Leave the Footprints page first"));
    assert!(window.state().why_not(Command::Save).is_none());
    press(&mut window, Key::Escape);
    assert!(!window.state().footprints.is_open());
    assert!(all.iter().all(|command| window.state().why_not(*command).is_some()));
    window.get_by_label_contains("Walk from footprints").click();
    window.run_steps(2);
    assert!(window.state().footprints.is_open());
    run(&mut window, Command::PageRide);
    assert!(window.state().ride.is_open() && !window.state().footprints.is_open());
}
