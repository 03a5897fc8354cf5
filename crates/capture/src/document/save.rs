//! Saving: both files atomically, and never over somebody else's change without asking.

use std::path::{Path, PathBuf};

use super::{Document, OnDisk, Record, relative_path};
use crate::files::{FileError, hash_file, write_json};

/// Why a document was not saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The file on disk is not the one that was read.
    #[error("{}: was changed on disk since it was opened; overwrite it, or save under another name", path.display())]
    ChangedOnDisk {
        /// The file.
        path: PathBuf,
    },
    /// A file cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
}

impl Document {
    /// Writes the manifest, where it changed, and then the annotation.
    ///
    /// # Errors
    /// When a file on disk is not the one last read or written and `overwrite` is not set, or cannot be written. What
    /// could not be saved stays open, and in the journal.
    pub fn save(&mut self, overwrite: bool) -> Result<(), SaveError> {
        let manifest_changed = self.draft.manifest != self.saved.manifest || self.on_disk.manifest.is_none();
        if !overwrite {
            self.check_unchanged(manifest_changed)?;
        }
        if manifest_changed {
            write_in_folder(&self.manifest_path, &self.draft.manifest)?;
        }
        write_in_folder(&self.annotation_path, &self.draft.annotation)?;
        self.saved = self.draft.clone();
        self.on_disk = OnDisk::of(&self.manifest_path, &self.annotation_path);
        let (on_disk, annotation_path) = (self.on_disk.clone(), self.annotation_path.clone());
        self.record(&Record::Saved { on_disk, annotation_path });
        Ok(())
    }

    /// Saves the annotation as another file of the same plate, and goes on with that one. The journal stays this
    /// document's.
    ///
    /// # Errors
    /// As [`Document::save`]; a file that is there already counts as changed.
    pub fn save_as(&mut self, annotation_path: &Path, overwrite: bool) -> Result<(), SaveError> {
        if !overwrite && annotation_path.exists() {
            return Err(SaveError::ChangedOnDisk { path: annotation_path.to_path_buf() });
        }
        self.annotation_path = annotation_path.to_path_buf();
        self.on_disk.annotation = hash_file(annotation_path).ok();
        let plate = relative_path(annotation_path, &self.manifest_path);
        self.edit("Save under another name", |draft| draft.annotation.plate = plate);
        self.save(overwrite)
    }

    fn check_unchanged(&self, manifest_changed: bool) -> Result<(), SaveError> {
        let files = [
            (&self.manifest_path, &self.on_disk.manifest, manifest_changed),
            (&self.annotation_path, &self.on_disk.annotation, true),
        ];
        for (path, known, written) in files {
            if written && path.exists() && hash_file(path).ok() != *known {
                return Err(SaveError::ChangedOnDisk { path: path.clone() });
            }
        }
        Ok(())
    }
}

fn write_in_folder<T: serde::Serialize>(path: &Path, document: &T) -> Result<(), FileError> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)
            .map_err(|source| FileError::Write { path: path.to_path_buf(), source })?;
    }
    write_json(path, document)
}
