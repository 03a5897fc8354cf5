//! Where the cameras stand.

use egui::Ui;
use muybridge_capture::{Draft, Parallax, Plane, Position};

use super::layout::{FIELD, choose, remark, row};
use super::marks::MarkRow;
use super::numbers::{Number, Quantity};
use super::sections::{calibration, change, known};
use super::{defaults, entry};
use crate::app::PageContext;
use crate::session::Session;

/// How cameras stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Cameras {
    Fixed,
    Spaced,
    FixedMark,
    Even,
}

impl Cameras {
    pub(super) const NAMES: [(Self, &'static str); 4] = [
        (Self::Fixed, "One camera that does not move"),
        (Self::Spaced, "A row of cameras, evenly spaced"),
        (Self::FixedMark, "A row: seen on one fixed mark"),
        (Self::Even, "Cut out around the animal: it moves on evenly"),
    ];

    fn of(position: &Position) -> Self {
        match position {
            Position::FixedCamera => Self::Fixed,
            Position::CameraSpacing { .. } => Self::Spaced,
            Position::FixedMark { .. } => Self::FixedMark,
            Position::EvenAdvance { .. } => Self::Even,
        }
    }

    pub(super) fn position(self, draft: &Draft) -> Position {
        let first = draft.annotation.stride.first;
        match self {
            Self::Fixed => Position::FixedCamera,
            Self::Spaced => defaults::battery(middle_mark(draft).unwrap_or(0.0)),
            Self::FixedMark => {
                let marks = draft.panel(first).and_then(|panel| panel.marks.first());
                Position::FixedMark { mark: marks.map_or(0.0, |mark| mark.mark) }
            }
            Self::Even => Position::EvenAdvance { per_panel_m: None },
        }
    }
}

/// The number, to a hundredth, of the mark in the middle of the stride's first panel, where its camera looks.
fn middle_mark(draft: &Draft) -> Option<f64> {
    let first = draft.annotation.stride.first;
    let row = MarkRow::through(draft.panel(first)?)?;
    let place = draft.manifest.panels.iter().find(|panel| panel.panel == first)?;
    Some((100.0 * row.number_at(place.centre_px())).round() / 100.0)
}

/// The form.
pub(super) fn show(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    let Some(calibration) = calibration(session) else { return };
    let now = Cameras::of(&calibration.position);
    let plane = calibration.scale.known_length.as_ref().map(|length| &length.plane);
    let needs_row = matches!(plane, Some(Plane::Wall(Parallax::FromStance)))
        .then_some("Parallax is measured from stance, which needs the spacing of the cameras");
    let choices = Cameras::NAMES
        .map(|(cameras, title)| (cameras, title, needs_row.filter(|_| cameras != Cameras::Spaced)));
    let width = ui.available_width() - 8.0;
    if let Some(cameras) = choose(ui, "Cameras", now, &choices, width) {
        let position = cameras.position(session.draft());
        change(session, page, "Position of the cameras", |c| c.position = position);
    }
    ui.add_space(2.0);
    match now {
        Cameras::Fixed => {
            remark(ui, "All panels are seen from one place; positions are read off the picture.");
        }
        Cameras::Spaced => spaced(ui, session, page),
        Cameras::FixedMark => {
            row(ui, "Fixed mark", "Number of a mark that is placed in every panel", |ui| {
                entry::number(ui, session, Number::FixedMark, FIELD);
            });
            entry::refused(ui, session, &[Number::FixedMark]);
            remark(ui, "Positions are measured from this mark, which must be placed in every panel.");
        }
        Cameras::Even => even(ui, session, page),
    }
}

/// How far the trunk moves from panel to panel: measured, or typed.
fn even(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    let set = |ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>, name, per_panel_m| {
        if ui.button(name).clicked() {
            change(session, page, name, |c| c.position = Position::EvenAdvance { per_panel_m });
        }
    };
    if calibration(session).is_some_and(|c| Quantity::Advance.of(c).is_some()) {
        known(ui, session, page, Quantity::Advance);
        set(ui, session, page, "Measure the advance from stance", None);
    } else {
        remark(ui, "The advance per panel is measured on the hooves in stance, which the trunk passes over.");
        set(ui, session, page, "Type the advance instead", Some(defaults::known(Quantity::Advance)));
    }
}

/// Spacing of the row, and where on the wall it begins.
fn spaced(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    known(ui, session, page, Quantity::CameraSpacing);
    let why = "Number of the mark opposite the first panel's camera; 3.7 lies between marks 3 and 4";
    row(ui, "First axis", why, |ui| {
        entry::number(ui, session, Number::FirstAxisMark, FIELD);
        let middle = middle_mark(session.draft());
        let button = ui.add_enabled(middle.is_some(), egui::Button::new("Panel's middle"));
        let why_not = "Place two marks in the stride's first panel";
        if let (true, Some(mark)) = (button.on_disabled_hover_text(why_not).clicked(), middle) {
            entry::attempt(session, page.messages, "First axis mark", |draft| {
                Number::FirstAxisMark.set(draft, mark);
            });
        }
    });
    entry::refused(ui, session, &[Number::FirstAxisMark]);
    remark(ui, "Number the marks so that the same upright has the same number in all panels.");
}
