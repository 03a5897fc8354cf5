//! A copy of one of the repository's plates in a folder of its own, to damage and to run the programs in.

use std::path::{Path, PathBuf};
use std::process::Command;

use muybridge_capture::{to_stable_json, write_atomically};
use serde_json::Value;
use tempfile::TempDir;

use crate::program::{Run, program};
use crate::repository;

/// The plate that is copied.
pub const SALLIE: &str = "sallie-gardner-1878";

/// The copy; it is removed when dropped.
pub struct Workspace {
    folder: TempDir,
}

impl Default for Workspace {
    fn default() -> Self {
        Self::new()
    }
}

impl Workspace {
    /// Copies one plate, [`SALLIE`]: annotation, second pass and manifest, but no photograph.
    pub fn new() -> Self {
        let workspace = Self { folder: tempfile::tempdir().unwrap() };
        for folder in ["annotations", "annotations/second-pass", "plates"] {
            let file = format!("{folder}/{SALLIE}.json");
            std::fs::create_dir_all(workspace.path(folder)).unwrap();
            write(&workspace.path(&file), &std::fs::read_to_string(repository().join(&file)).unwrap());
        }
        workspace
    }

    /// A path in the copy.
    pub fn path(&self, relative: &str) -> PathBuf {
        self.folder.path().join(relative)
    }

    /// A file's text.
    pub fn text(&self, relative: &str) -> String {
        std::fs::read_to_string(self.path(relative)).unwrap()
    }

    /// A file as JSON.
    pub fn json(&self, relative: &str) -> Value {
        serde_json::from_str(&self.text(relative)).unwrap()
    }

    /// Replaces a file.
    pub fn write(&self, relative: &str, text: &str) {
        write(&self.path(relative), text);
    }

    /// Changes a JSON file.
    pub fn edit(&self, relative: &str, change: impl FnOnce(&mut Value)) {
        let mut document = self.json(relative);
        change(&mut document);
        self.write(relative, &to_stable_json(&document));
    }

    /// Replaces the first occurrence of a text in a file, which must have it.
    pub fn replace(&self, relative: &str, from: &str, to: &str) {
        let text = self.text(relative);
        assert!(text.contains(from), "{relative} has no {from:?}");
        self.write(relative, &text.replacen(from, to, 1));
    }

    /// Runs a program in the copy.
    pub fn run(&self, name: &str, arguments: &[&str]) -> Run {
        Run::of(self.command(name).args(arguments))
    }

    /// Runs `fit-gaits` in the copy; it writes `db.json` and the folder `report` there.
    pub fn fit_gaits(&self, arguments: &[&str]) -> Run {
        Run::of(self.command("fit-gaits").args(["--out", "db.json", "--report", "report"]).args(arguments))
    }

    /// A program about to be run in the copy.
    pub fn command(&self, name: &str) -> Command {
        let mut command = Command::new(program(name));
        command.current_dir(self.folder.path()).env_remove("RAYON_NUM_THREADS");
        // Away from plates that the person who runs the tests has fetched.
        command.env("MUYBRIDGE_CACHE", self.folder.path().join("cache"));
        command
    }

    /// Adds a second, good plate: the repository's own under another name, with few panels and a stride time that is
    /// told, so that it is fitted quickly.
    pub fn add_good_plate(&self, id: &str) {
        let (annotation, manifest) = (format!("annotations/{id}.json"), format!("plates/{id}.json"));
        self.write(&annotation, &self.text(&format!("annotations/{SALLIE}.json")));
        self.write(&manifest, &self.text(&format!("plates/{SALLIE}.json")));
        self.edit(&annotation, |document| {
            document["plate"] = format!("../plates/{id}.json").into();
            for (index, panel) in document["panels"].as_array_mut().unwrap().iter_mut().enumerate() {
                // Panels 1, 4, 5, 6, 8 and 10 are enough, with the standing panel 12.
                if [2, 3, 7, 9, 11].contains(&(index + 1)) {
                    panel["use"] = "unused".into();
                    panel["keypoints"] = serde_json::json!({});
                }
            }
            document["stride"]["closes_after_panels"] = 9.into();
        });
        self.edit(&manifest, |document| {
            document["id"] = id.into();
            document["images"][0]["file"] = format!("{id}.jpg").into();
            // So few panels need not show a hoof in stance twice.
            document["calibration"]["scale"]["known_length"]["plane"] = serde_json::json!({
                "wall": { "ratio": { "value": 1.19, "sd": 0.02, "assumed": true, "from": "the whole plate" } }
            });
        });
    }
}

/// Replaces a file with a text.
pub fn write(path: &Path, text: &str) {
    write_atomically(path, text.as_bytes()).unwrap();
}
