//! Plates to choose from: a folder's, and the catalogue's, fetched or not.

use std::path::{Path, PathBuf};

use egui::Context;

use crate::toast::Messages;

/// The window while it is open.
pub struct Browser {
    _folder: PathBuf,
}

impl Browser {
    /// Plates of a folder.
    pub fn new(folder: &Path) -> Self {
        Self { _folder: folder.to_path_buf() }
    }

    /// Draws the window: a path to open, and whether the window stays.
    pub fn show(&mut self, _context: &Context, _messages: &mut Messages) -> (Option<PathBuf>, bool) {
        (None, false)
    }
}
