//! The fitted stride, moving.

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

/// The moving stride.
#[derive(Clone, Debug)]
pub struct PlayState {
    /// Whether it moves.
    pub is_playing: bool,
    /// Phase, strides, in `[0, 1)`.
    pub phase: f64,
    /// Speed against the real one.
    pub rate: f64,
}

impl Default for PlayState {
    fn default() -> Self {
        Self { is_playing: false, phase: 0.0, rate: 0.25 }
    }
}
