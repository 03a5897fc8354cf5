//! Calibration: scale, position, time, and what follows from them.

mod begin;
mod defaults;
mod drawing;
mod entry;
mod follows;
mod gestures;
mod layout;
mod marks;
mod numbers;
mod position;
mod sections;
mod stride;
mod tools;
mod trouble;
mod units;

use std::collections::BTreeMap;

use egui::{Panel, Ui};

use crate::app::PageContext;
use crate::canvas::PanelCanvas;
use crate::session::Session;
use numbers::{Number, Quantity};
use units::Unit;

/// What a click or drag on the photograph does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
enum Tool {
    /// Draws the ground line where there is none.
    #[default]
    Ground,
    /// Draws a known length.
    Length,
    /// Places numbered marks.
    Marks,
}

/// What the page remembers while a plate is open; none of it is kept in the files.
#[derive(Debug, Default)]
pub struct CalibrateState {
    tool: Tool,
    grip: Option<gestures::Grip>,
    /// Panel and first end of a line that is drawn by two clicks, plate px.
    first_end_px: Option<(u32, [f64; 2])>,
    typing: Option<entry::Typing>,
    wants_focus: Option<Number>,
    units: BTreeMap<Quantity, Unit>,
    first_mark: f64,
    begin: begin::Kinds,
}

impl CalibrateState {
    /// Forgets what is being drawn.
    pub fn let_go(&mut self) {
        (self.grip, self.first_end_px) = (None, None);
    }

    /// The first end of a line that was begun in this panel.
    fn take_first_end(&mut self, panel: u32) -> Option<[f64; 2]> {
        self.first_end_px.take().filter(|(begun, _)| *begun == panel).map(|(_, at_px)| at_px)
    }

    /// The quantity whose unit a number is typed in.
    fn unit_key(number: Number) -> Option<Quantity> {
        match number {
            Number::Value(quantity) | Number::Spread(quantity) => Some(quantity),
            Number::CameraToTrack | Number::CameraToWall => Some(Quantity::CameraDistance),
            _ => None,
        }
    }

    fn unit(&self, number: Number) -> Unit {
        let chosen = Self::unit_key(number).and_then(|quantity| self.units.get(&quantity));
        match (number, chosen.copied().unwrap_or(number.units()[0])) {
            // A spread in hands and inches would be read as a tenth of what it is.
            (Number::Spread(_), Unit::Hand) => Unit::Inch,
            (_, unit) => unit,
        }
    }

    fn set_unit(&mut self, number: Number, unit: Unit) {
        if let Some(quantity) = Self::unit_key(number) {
            self.units.insert(quantity, unit);
        }
        self.typing = None;
    }
}

/// The photograph with ground line and marks; below it what follows.
pub fn canvas(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    if !session.panel_numbers().is_empty() {
        let below =
            Panel::bottom("what follows").resizable(true).default_size(182.0).size_range(60.0..=420.0);
        below.show(ui, |ui| follows::show(ui, session));
    }
    let Some(canvas) = PanelCanvas::show(ui, session) else { return };
    if session.shown.marks {
        drawing::draw(&canvas, session);
        gestures::handles(ui, &canvas, session);
    }
    gestures::draw_new(ui, &canvas, session, page.messages);
    drawing::hint(&canvas, session);
}

/// Tools and forms.
pub fn inspector(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    tools::take_found(session, page.messages);
    tools::choose(ui, session);
    if session.draft().manifest.calibration.is_none() {
        begin::show(ui, session, page);
        tools::show(ui, session, page);
    } else {
        tools::show(ui, session, page);
        sections::show(ui, session, page);
    }
}
