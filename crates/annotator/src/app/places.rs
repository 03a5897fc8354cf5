//! Where the program finds and keeps things on this machine.

use std::path::PathBuf;

use muybridge_capture::state_folder;

/// Folders.
#[derive(Clone, Debug)]
pub struct Places {
    /// Settings and journals; none when the system has no such folder.
    pub state: Option<PathBuf>,
    /// Manifests and the catalogue.
    pub plates: PathBuf,
}

impl Default for Places {
    fn default() -> Self {
        Self { state: state_folder(), plates: PathBuf::from("plates") }
    }
}

impl Places {
    /// Folder of the journals.
    pub fn journals(&self) -> Option<PathBuf> {
        self.state.as_ref().map(|state| state.join("journals"))
    }

    /// Folder of copies of tracks that are not saved.
    pub fn tracks(&self) -> Option<PathBuf> {
        self.state.as_ref().map(|state| state.join("tracks"))
    }

    /// Folder of the specimen that comes with the program.
    pub fn specimen(&self) -> Option<PathBuf> {
        self.state.as_ref().map(|state| state.join("specimen"))
    }
}
