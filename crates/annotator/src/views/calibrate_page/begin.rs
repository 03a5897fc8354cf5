//! A plate of which nobody has said yet how scale, position and time are known.

use egui::{Button, Frame, RichText, Ui, vec2};
use muybridge_capture::{ScaleSource, TimeSource};

use super::layout::remark;
use super::position::Cameras;
use super::{Tool, defaults, entry};
use crate::app::PageContext;
use crate::session::Session;

/// What is known, as the person has chosen so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Kinds {
    scale: ScaleSource,
    cameras: Cameras,
    /// None when nothing is known about time.
    time: Option<TimeSource>,
}

impl Default for Kinds {
    fn default() -> Self {
        Self { scale: ScaleSource::WithersHeight, cameras: Cameras::Fixed, time: None }
    }
}

/// Asks what is known; a click begins the calibration with it.
pub(super) fn show(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    ui.label(RichText::new("Nobody has said yet how scale, position and time are known").strong().size(15.0));
    remark(ui, "Choose what is known. The numbers come next; each is assumed until you type a better one.");
    let mut kinds = session.calibrate.begin;
    Frame::group(ui.style()).show(ui, |ui| {
        ui.set_width(ui.available_width());
        options(
            ui,
            "How large is it?",
            &mut kinds.scale,
            &[
                (ScaleSource::KnownLength, "A length in the picture is known"),
                (ScaleSource::WithersHeight, "The animal's height at the withers"),
            ],
        );
        options(ui, "Where do the cameras stand?", &mut kinds.cameras, &Cameras::NAMES);
        options(
            ui,
            "When was each panel taken?",
            &mut kinds.time,
            &[
                (Some(TimeSource::Interval), "The interval between panels is known"),
                (Some(TimeSource::Speed), "The animal's speed is known"),
                (Some(TimeSource::StrideTime), "The time of one stride is known"),
                (
                    Some(TimeSource::DynamicSimilarity),
                    "Nothing is known: infer the speed from the stride's length",
                ),
                (None, "Nothing is known: assume an interval"),
            ],
        );
    });
    session.calibrate.begin = kinds;
    ui.add_space(6.0);
    let button = Button::new(RichText::new("Begin calibration").strong().size(15.0));
    if ui.add_sized(vec2(ui.available_width(), 32.0), button).clicked() {
        begin(session, page, kinds);
    }
    ui.add_space(6.0);
    ui.separator();
}

fn begin(session: &mut Session, page: &mut PageContext<'_>, kinds: Kinds) {
    let position = kinds.cameras.position(session.draft());
    let time = kinds.time.unwrap_or(TimeSource::Interval);
    let begun = defaults::calibration(kinds.scale, position, time);
    entry::attempt(session, page.messages, "Begin calibration", |draft| {
        draft.manifest.calibration = Some(begun);
    });
    let unmarked = session.panel_annotation().is_none_or(|panel| panel.marks.len() < 2);
    if kinds.scale == ScaleSource::KnownLength && unmarked {
        session.calibrate.tool = Tool::Length;
    }
}

fn options<T: Copy + PartialEq>(ui: &mut Ui, question: &str, now: &mut T, choices: &[(T, &str)]) {
    ui.label(RichText::new(question).strong());
    for (choice, title) in choices {
        if ui.radio(*now == *choice, *title).clicked() {
            *now = *choice;
        }
    }
    ui.add_space(6.0);
}
