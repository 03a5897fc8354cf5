//! A short tour of the window, step by step, on the plate that is open.

use egui::Context;

use crate::session::Session;

/// The tour while it is shown.
#[derive(Debug, Default)]
pub struct Tour {
    _step: usize,
}

impl Tour {
    /// Draws the present step; false when the tour is over.
    pub fn show(&mut self, _context: &Context, _session: Option<&mut Session>) -> bool {
        false
    }
}
