//! Calibration: scale, position, time, and what follows from them.

use egui::Ui;

use crate::app::PageContext;
use crate::canvas::PanelCanvas;
use crate::session::Session;

/// The photograph.
pub fn canvas(ui: &mut Ui, session: &mut Session, _page: &mut PageContext<'_>) {
    PanelCanvas::show(ui, session);
}

/// The panel at the right.
pub fn inspector(_ui: &mut Ui, _session: &mut Session, _page: &mut PageContext<'_>) {}
