//! The Gait and Play pages, used as a person uses them.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::path::{Path, PathBuf};
use std::time::Duration;

use annotator::app::{Annotator, Places};
use annotator::command::Command;
use annotator::picture::ImageState;
use annotator::session::{Page, Session};
use egui::{Pos2, ViewportId, vec2};
use egui_kittest::Harness;
use egui_kittest::kittest::Queryable;
use muybridge_capture::NearOff;
use muybridge_core::{Limb, Pair};
use muybridge_fitting::footfalls::LiveGait;
use tempfile::TempDir;

/// The program with the specimen of a gallop, fitted.
fn opened(page: Page) -> (Harness<'static, Annotator>, TempDir) {
    let folder = tempfile::tempdir().unwrap();
    let path = copy_specimen(folder.path());
    let places = Places { state: Some(folder.path().join("state")), plates: folder.path().to_path_buf() };
    let context = egui::Context::default();
    let mut annotator = Annotator::new(&context, places, Some(&path));
    annotator.wait_until_open(&context);
    let session = annotator.session.as_mut().unwrap();
    session.fit.start(&session.document, &context);
    session.fit.wait();
    session.page = page;
    let mut harness = Harness::builder()
        .with_size(vec2(1360.0, 2400.0))
        .with_step_dt(1.0 / 60.0)
        .with_max_steps(40)
        .build_ui_state(|ui, annotator: &mut Annotator| annotator.ui(ui), annotator);
    while matches!(session_of(&harness).images.states().first(), Some(ImageState::Waiting)) {
        std::thread::sleep(Duration::from_millis(5));
        harness.step();
    }
    harness.run();
    (harness, folder)
}

fn copy_specimen(folder: &Path) -> PathBuf {
    let specimens = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../plates/specimens");
    std::fs::create_dir_all(folder.join("annotations")).unwrap();
    for file in ["specimen-gallop.json", "specimen-gallop.jpg", "annotations/specimen-gallop.json"] {
        std::fs::copy(specimens.join(file), folder.join(file)).unwrap();
    }
    folder.join("annotations/specimen-gallop.json")
}

fn session_of<'a>(harness: &'a Harness<'static, Annotator>) -> &'a Session {
    harness.state().session.as_ref().unwrap()
}

fn live(harness: &Harness<'static, Annotator>) -> LiveGait {
    session_of(harness).derived.gait.clone().unwrap()
}

fn duty_shown(live: &LiveGait, limb: Limb) -> String {
    let contact = &live.analysis.contacts[limb.index()];
    format!("{:.3} ± {:.3}", contact.duty_factor(), contact.duty_factor_sd())
}

fn shows(harness: &Harness<'static, Annotator>, text: &str) -> bool {
    harness.query_all_by_label(text).next().is_some()
}

fn repaint_delay(harness: &Harness<'static, Annotator>) -> Duration {
    harness.output().viewport_output[&ViewportId::ROOT].repaint_delay
}

#[test]
fn numbers_shown_are_those_of_the_fit_and_of_the_footfall_bar() {
    let (harness, _folder) = opened(Page::Gait);
    let plate = &session_of(&harness).fit.latest().unwrap().plate;
    let analysis = &plate.analysis;
    for [value, sd] in [analysis.stance_s(Pair::Fore), analysis.stance_s(Pair::Hind), analysis.support_s()] {
        assert!(shows(&harness, &format!("{value:.3} ± {sd:.3}")), "{value:.3}");
    }
    assert!(shows(&harness, "Fit of the present points."));
    assert!(shows(&harness, "The title says gallop: they agree."));
    let live = live(&harness);
    Limb::ALL.iter().for_each(|limb| assert!(shows(&harness, &duty_shown(&live, *limb)), "{limb:?}"));
    // The specimen's labels and its fit speak of the same stride.
    let apart = live.analysis.hind_duty_factor() - analysis.hind_duty_factor();
    assert!(apart.abs() < 0.06, "{apart}");
}

#[test]
fn dragging_an_edge_changes_the_duty_factor_at_once_and_is_one_step() {
    let (mut harness, _folder) = opened(Page::Gait);
    let before = session_of(&harness).document.draft().annotation.clone();
    let limb = session_of(&harness).facing().limb(NearOff::Near, Pair::Hind);
    let old = duty_shown(&live(&harness), limb);
    let edge = harness.query_all_by_label_contains("near hind lift-off").next().unwrap().rect().center();
    let at = |by: f32| Pos2::new(edge.x + by, edge.y);
    harness.drag_at(at(0.0));
    harness.run();
    for by in [6.0, 14.0, 25.0] {
        harness.hover_at(at(by));
        harness.run();
    }
    let during = duty_shown(&live(&harness), limb);
    assert_ne!(during, old);
    assert!(shows(&harness, &during), "the table follows while the button is down");
    assert_eq!(session_of(&harness).document.draft().annotation, before, "nothing is changed yet");
    harness.drop_at(at(25.0));
    harness.run();
    assert_ne!(session_of(&harness).document.draft().annotation, before);
    assert!(shows(&harness, "Fit of earlier points: something was changed since."));
    let context = harness.ctx.clone();
    harness.state_mut().run(&context, Command::Undo);
    harness.run();
    assert_eq!(session_of(&harness).document.draft().annotation, before);
    assert!(shows(&harness, &old));
}

#[test]
fn a_click_on_a_worst_point_shows_it() {
    let (mut harness, _folder) = opened(Page::Gait);
    let residuals = &session_of(&harness).fit.latest().unwrap().plate.residuals;
    let worst = residuals.iter().max_by(|a, b| a.metres().total_cmp(&b.metres())).unwrap();
    let (panel, keypoint) = (worst.panel, worst.keypoint);
    harness.query_all_by_label_contains("Worst point 1:").next().unwrap().click();
    harness.run();
    let session = session_of(&harness);
    assert_eq!((session.page, session.panel, session.selected), (Page::Pose, panel, Some(keypoint)));
}

#[test]
fn playing_moves_the_phase_through_all_panels_and_a_pause_ends_all_repaints() {
    let (mut harness, _folder) = opened(Page::Play);
    let context = harness.ctx.clone();
    harness.state_mut().run(&context, Command::PlayStride);
    let stride_s = session_of(&harness).fit.latest().unwrap().plate.fit.stride_time.seconds;
    let mut panels = Vec::new();
    let mut phases = vec![session_of(&harness).play.phase];
    let frames = (stride_s / 0.25 * 60.0) as usize;
    for _ in 0..frames {
        harness.step();
        assert_eq!(repaint_delay(&harness), Duration::ZERO);
        phases.push(session_of(&harness).play.phase);
        panels.push(session_of(&harness).panel);
    }
    let moved: f64 = phases.windows(2).map(|two| (two[1] - two[0]).rem_euclid(1.0)).sum();
    let expected = frames as f64 / 60.0 * 0.25 / stride_s;
    assert!((moved - expected).abs() < 0.05, "{moved} {expected}");
    panels.sort_unstable();
    panels.dedup();
    assert_eq!(panels, (1..=12).collect::<Vec<u32>>());
    harness.state_mut().run(&context, Command::PlayStride);
    harness.run();
    let phase = session_of(&harness).play.phase;
    harness.run();
    assert!(repaint_delay(&harness) > Duration::from_secs(1));
    assert!((session_of(&harness).play.phase - phase).abs() < 1e-12);
    harness.get_by_label("Panel after").click();
    harness.run();
    assert!((session_of(&harness).play.phase - phase).abs() > 0.01);
}

#[test]
fn a_blind_second_pass_shows_nothing_of_the_fit() {
    let (mut harness, folder) = opened(Page::Gait);
    let begun = annotator::second_pass::SecondPass::begin(session_of(&harness), Some(folder.path())).unwrap();
    harness.state_mut().session.as_mut().unwrap().second_pass = Some(begun.1);
    harness.run();
    assert!(harness.query_all_by_label_contains("Hidden during the blind second pass").next().is_some());
    assert!(harness.query_all_by_label_contains("Worst point").next().is_none());
    harness.state_mut().session.as_mut().unwrap().page = Page::Play;
    harness.run();
    assert!(harness.query_all_by_label_contains("Pause").next().is_none());
    assert!(harness.query_all_by_label_contains("Hidden during the blind second pass").next().is_some());
}
