//! What the program remembers from one start to the next, apart from the window: a file in the state folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use muybridge_capture::{read_json, write_json};
use serde::{Deserialize, Serialize};

use crate::keys::KeyMap;

/// Schema version of the settings file.
const SETTINGS_SCHEMA: u32 = 1;
/// Plates in the list of recent ones.
const MOST_RECENT: usize = 12;

/// Light, dark, or as the system is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Theme {
    /// As the system is.
    #[default]
    System,
    /// Light.
    Light,
    /// Dark.
    Dark,
}

/// The file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
struct File {
    schema: u32,
    theme: Theme,
    tour_seen: bool,
    fit_always: bool,
    annotator: String,
    recent: Vec<PathBuf>,
    keys: BTreeMap<String, Vec<String>>,
}

impl Default for File {
    fn default() -> Self {
        Self {
            schema: SETTINGS_SCHEMA,
            theme: Theme::default(),
            tour_seen: false,
            fit_always: true,
            annotator: String::new(),
            recent: Vec::new(),
            keys: BTreeMap::new(),
        }
    }
}

/// The settings.
#[derive(Clone, Debug)]
pub struct Settings {
    path: Option<PathBuf>,
    /// Light or dark.
    pub theme: Theme,
    /// Whether the tour was shown.
    pub tour_seen: bool,
    /// Whether the stride is fitted whenever something changed.
    pub fit_always: bool,
    /// Name that goes into new annotations.
    pub annotator: String,
    /// Annotations and manifests opened last, latest first.
    pub recent: Vec<PathBuf>,
    /// Keys.
    pub keys: KeyMap,
}

impl Settings {
    /// Reads the settings of a state folder. A file that is missing or cannot be read gives the defaults: settings are
    /// not work, and a damaged file must not keep anybody from working.
    pub fn read(folder: Option<&Path>) -> Self {
        let path = folder.map(|folder| folder.join("settings.json"));
        let file: File =
            path.as_ref().and_then(|path| read_json(path, SETTINGS_SCHEMA).ok()).unwrap_or_default();
        Self {
            path,
            theme: file.theme,
            tour_seen: file.tour_seen,
            fit_always: file.fit_always,
            annotator: file.annotator,
            recent: file.recent,
            keys: KeyMap::from_words(&file.keys),
        }
    }

    /// Writes them; why not, if that cannot be done.
    ///
    /// # Errors
    /// In words, when the folder cannot be written to.
    pub fn write(&self) -> Result<(), String> {
        let Some(path) = &self.path else { return Ok(()) };
        let file = File {
            schema: SETTINGS_SCHEMA,
            theme: self.theme,
            tour_seen: self.tour_seen,
            fit_always: self.fit_always,
            annotator: self.annotator.clone(),
            recent: self.recent.clone(),
            keys: self.keys.to_words(),
        };
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        }
        write_json(path, &file).map_err(|error| error.to_string())
    }

    /// Puts a plate at the head of the recent ones.
    pub fn remember(&mut self, path: &Path) {
        let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
        self.recent.retain(|other| *other != path);
        self.recent.insert(0, path);
        self.recent.truncate(MOST_RECENT);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::command::Command;

    #[test]
    fn settings_survive_a_restart_and_a_damaged_file_does_no_harm() {
        let folder = tempfile::tempdir().unwrap();
        let mut settings = Settings::read(Some(folder.path()));
        settings.theme = Theme::Dark;
        for i in 0..20 {
            settings.remember(Path::new(&format!("plate-{i}.json")));
        }
        settings.keys.choose(Command::Undo, egui::KeyboardShortcut::new(egui::Modifiers::NONE, egui::Key::U));
        settings.write().unwrap();
        let again = Settings::read(Some(folder.path()));
        assert_eq!(
            (again.theme, &again.keys, &again.recent),
            (Theme::Dark, &settings.keys, &settings.recent)
        );
        assert!(again.recent.len() == MOST_RECENT && again.recent[0].ends_with("plate-19.json"));
        muybridge_capture::write_atomically(&folder.path().join("settings.json"), b"{\"schema\": 1, \"rec")
            .unwrap();
        assert_eq!(Settings::read(Some(folder.path())).theme, Theme::System);
    }
}
