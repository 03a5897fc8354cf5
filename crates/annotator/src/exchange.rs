//! Import and export of points in the window.

use egui::Context;

use crate::session::Session;
use crate::toast::Messages;

/// The window while it is open.
pub struct ExchangeWindow {}

impl ExchangeWindow {
    /// Points from a file.
    pub fn import(_session: &Session) -> Self {
        Self {}
    }

    /// Points into files.
    pub fn export(_session: &Session) -> Self {
        Self {}
    }

    /// Draws the window; false when it is closed.
    pub fn show(&mut self, _context: &Context, _session: &mut Session, _messages: &mut Messages) -> bool {
        false
    }
}
