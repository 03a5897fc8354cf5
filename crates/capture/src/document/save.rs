//! Saving: both files atomically, and never over somebody else's change without asking.

use std::path::{Path, PathBuf};

use super::place::absolute;
use super::{Document, Record, relative_path};
use crate::files::{FileError, Hash, hash_bytes, hash_file, to_stable_json, write_atomically};
use crate::images::locate_image;
use crate::validation::{PlateError, check_draft, check_manifest};

/// Why a document was not saved.
#[derive(Debug, thiserror::Error)]
pub enum SaveError {
    /// The file on disk is not the one that was read.
    #[error("{}: was changed on disk since it was opened; overwrite it, or save under another name", path.display())]
    ChangedOnDisk {
        /// The file.
        path: PathBuf,
    },
    /// The annotation would replace its own plate.
    #[error("{}: is the plate itself; save the annotation under another name", path.display())]
    OwnPlate {
        /// The file.
        path: PathBuf,
    },
    /// What was written could not be opened again.
    #[error(transparent)]
    Wrong(#[from] PlateError),
    /// A file cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
}

impl Document {
    /// Writes the manifest, where it changed, and then the annotation.
    ///
    /// # Errors
    /// When a file on disk is not the one last read or written and `overwrite` is not set, when it could not be opened
    /// again, or cannot be written. What could not be saved stays open, and in the journal.
    pub fn save(&mut self, overwrite: bool) -> Result<(), SaveError> {
        let manifest_changed = self.draft.manifest != self.saved.manifest || self.on_disk.manifest.is_none();
        check_manifest(&self.manifest_path, &self.draft.manifest)?;
        check_draft(&self.annotation_path, &self.draft.annotation, &self.draft.manifest)?;
        if !overwrite {
            self.check_unchanged(manifest_changed)?;
        }
        if manifest_changed {
            self.on_disk.manifest = Some(write_in_folder(&self.manifest_path, &self.draft.manifest)?);
            self.saved.manifest = self.draft.manifest.clone();
        }
        self.on_disk.annotation = Some(write_in_folder(&self.annotation_path, &self.draft.annotation)?);
        self.saved.annotation = self.draft.annotation.clone();
        self.record(&Record::Saved {
            on_disk: self.on_disk.clone(),
            annotation_path: self.annotation_path.clone(),
            plate: self.draft.annotation.plate.clone(),
        });
        Ok(())
    }

    /// Saves the annotation as another file of the same plate, and goes on with that one. The journal stays this
    /// document's.
    ///
    /// # Errors
    /// As [`Document::save`], and then the document stays where it was; a file that is there already counts as changed.
    pub fn save_as(&mut self, annotation_path: &Path, overwrite: bool) -> Result<(), SaveError> {
        if self.is_of_plate(annotation_path) {
            return Err(SaveError::OwnPlate { path: annotation_path.to_path_buf() });
        }
        if !overwrite && annotation_path.exists() {
            return Err(SaveError::ChangedOnDisk { path: annotation_path.to_path_buf() });
        }
        let mut place = Place {
            plate: relative_path(annotation_path, &self.manifest_path),
            on_disk: hash_file(annotation_path).ok(),
            path: annotation_path.to_path_buf(),
        };
        self.exchange_place(&mut place);
        let saved = self.save(overwrite);
        if saved.is_err() {
            self.exchange_place(&mut place);
        }
        saved
    }

    fn is_of_plate(&self, path: &Path) -> bool {
        let images = self.draft.manifest.images.iter();
        let images = images.map(|image| locate_image(&self.manifest_path, &image.file));
        images.chain([self.manifest_path.clone()]).any(|own| absolute(&own) == absolute(path))
    }

    fn exchange_place(&mut self, place: &mut Place) {
        std::mem::swap(&mut self.annotation_path, &mut place.path);
        std::mem::swap(&mut self.on_disk.annotation, &mut place.on_disk);
        std::mem::swap(&mut self.draft.annotation.plate, &mut place.plate);
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

/// Where an annotation is saved.
struct Place {
    path: PathBuf,
    on_disk: Option<Hash>,
    plate: String,
}

/// Writes a document, in a folder that is made if need be; its hash.
fn write_in_folder<T: serde::Serialize>(path: &Path, document: &T) -> Result<Hash, FileError> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder)
            .map_err(|source| FileError::Write { path: path.to_path_buf(), source })?;
    }
    let text = to_stable_json(document);
    write_atomically(path, text.as_bytes())?;
    Ok(hash_bytes(text.as_bytes()))
}
