//! A plate being worked on: its two documents, their history and the journal that survives a crash.
//!
//! Every change goes through [`Document::edit`]: it is compared with what was there, written to the journal, and only then
//! becomes the state that is shown. So undo needs no inverse of any command, and a killed program loses nothing.

mod draft;
mod history;
mod journal;
mod place;
mod record;
mod save;

use std::path::{Path, PathBuf};

use crate::annotation::{ANNOTATION_SCHEMA, Annotation};
use crate::files::{FileError, Hash, hash_bytes, hash_file, read_json, to_stable_json};
use crate::manifest::Manifest;
use crate::validation::{Plate, PlateError, check_draft};

pub use draft::Draft;
use history::History;
use journal::{Journal, Recovered};
pub use journal::{JournalError, Waiting, discard, waiting};
pub use place::{STATE_VARIABLE, annotation_beside, relative_path, state_folder};
use record::Record;
pub use save::SaveError;

/// What the two files held when they were last read or written; none where there is no file.
#[derive(Clone, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(crate) struct OnDisk {
    pub(crate) manifest: Option<Hash>,
    pub(crate) annotation: Option<Hash>,
}

impl OnDisk {
    fn of(manifest_path: &Path, annotation_path: &Path) -> Self {
        Self { manifest: hash_file(manifest_path).ok(), annotation: hash_file(annotation_path).ok() }
    }
}

/// An open plate.
#[derive(Debug)]
pub struct Document {
    manifest_path: PathBuf,
    annotation_path: PathBuf,
    draft: Draft,
    saved: Draft,
    on_disk: OnDisk,
    history: History,
    journal: Option<Journal>,
    revision: u64,
}

impl Document {
    /// Opens an annotation and the manifest it names. Unfinished ones open; wrong ones do not.
    ///
    /// # Errors
    /// When a file cannot be read, or with the faults that make it unusable.
    pub fn open(annotation_path: &Path, journals: Option<&Path>) -> Result<Self, DocumentError> {
        let annotation: Annotation = read_json(annotation_path, ANNOTATION_SCHEMA)?;
        let folder = annotation_path.parent().unwrap_or(Path::new("."));
        let manifest_path = folder.join(&annotation.plate);
        let manifest = Manifest::read(&manifest_path)?;
        check_draft(annotation_path, &annotation, &manifest)?;
        let on_disk = OnDisk::of(&manifest_path, annotation_path);
        let draft = Draft { manifest, annotation }.rounded().ok_or_else(|| not_finite(annotation_path))?;
        Self::begin(manifest_path, annotation_path.to_path_buf(), draft.clone(), draft, on_disk, journals)
    }

    /// Starts an annotation of a plate that has none, or a plate that has no manifest yet; nothing is written until it is
    /// saved.
    ///
    /// # Errors
    /// When another program has the same plate open.
    pub fn start(
        manifest_path: &Path,
        annotation_path: &Path,
        manifest: Manifest,
        journals: Option<&Path>,
    ) -> Result<Self, DocumentError> {
        let annotation = draft::empty_annotation(&manifest, relative_path(annotation_path, manifest_path));
        let draft = Draft { manifest, annotation }.rounded().ok_or_else(|| not_finite(manifest_path))?;
        let on_disk = OnDisk::of(manifest_path, annotation_path);
        let paths = (manifest_path.to_path_buf(), annotation_path.to_path_buf());
        Self::begin(paths.0, paths.1, draft.clone(), draft, on_disk, journals)
    }

    /// Takes up work from a journal that was left behind: state and history as they were last shown.
    ///
    /// # Errors
    /// When the journal cannot be read or another program holds it.
    pub fn recover(journal_path: &Path) -> Result<Self, DocumentError> {
        let (journal, Recovered { head, records }) = Journal::reopen(journal_path)?;
        let mut document = Self {
            manifest_path: head.manifest_path,
            annotation_path: head.annotation_path,
            draft: head.draft,
            saved: head.saved,
            on_disk: head.on_disk,
            history: History::default(),
            journal: Some(journal),
            revision: 0,
        };
        for record in records {
            document.replay(record);
        }
        document.know_what_was_written();
        Ok(document)
    }

    fn begin(
        manifest_path: PathBuf,
        annotation_path: PathBuf,
        draft: Draft,
        saved: Draft,
        on_disk: OnDisk,
        journals: Option<&Path>,
    ) -> Result<Self, DocumentError> {
        let mut document = Self {
            manifest_path,
            annotation_path,
            draft,
            saved,
            on_disk,
            history: History::default(),
            journal: None,
            revision: 0,
        };
        if let Some(folder) = journals {
            document.journal = Some(Journal::create(folder, &document.head())?);
        }
        Ok(document)
    }

    /// A save that was cut short may have written a file already: what is there then is saved, and no one else's change.
    fn know_what_was_written(&mut self) {
        let ours = |path: &Path, text: String| {
            hash_file(path).ok().filter(|on_disk| *on_disk == hash_bytes(text.as_bytes()))
        };
        if let Some(hash) = ours(&self.manifest_path, to_stable_json(&self.draft.manifest)) {
            self.on_disk.manifest = Some(hash);
            self.saved.manifest = self.draft.manifest.clone();
        }
        if let Some(hash) = ours(&self.annotation_path, to_stable_json(&self.draft.annotation)) {
            self.on_disk.annotation = Some(hash);
            self.saved.annotation = self.draft.annotation.clone();
        }
    }

    fn head(&self) -> journal::Head {
        journal::Head {
            journal: journal::JOURNAL_SCHEMA,
            manifest_path: self.manifest_path.clone(),
            annotation_path: self.annotation_path.clone(),
            on_disk: self.on_disk.clone(),
            saved: self.saved.clone(),
            draft: self.draft.clone(),
        }
    }

    /// The manifest's file.
    pub fn manifest_path(&self) -> &Path {
        &self.manifest_path
    }

    /// The annotation's file.
    pub fn annotation_path(&self) -> &Path {
        &self.annotation_path
    }

    /// The documents as they are now.
    pub fn draft(&self) -> &Draft {
        &self.draft
    }

    /// Rises with every change of the state, undo and redo included.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Whether the annotation has never been saved.
    pub fn is_new(&self) -> bool {
        self.on_disk.annotation.is_none()
    }

    /// Whether there is something to save.
    pub fn is_changed(&self) -> bool {
        self.draft != self.saved
    }

    /// Why changes are not protected against a crash, if they are not.
    pub fn journal_fault(&self) -> Option<&str> {
        self.journal.as_ref()?.fault()
    }

    /// Makes a change, as one step that can be undone. Places are rounded to a hundredth of a pixel. Whether anything
    /// changed: a change with a number that is not finite is not made, and the plate that the annotation names is changed
    /// by [`Document::save_as`] alone.
    pub fn edit(&mut self, label: &str, change: impl FnOnce(&mut Draft)) -> bool {
        let mut after = self.draft.clone();
        change(&mut after);
        after.annotation.plate.clone_from(&self.draft.annotation.plate);
        let Some(after) = after.rounded() else { return false };
        let Some(step) = history::Step::between(label, &self.draft, &after) else { return false };
        self.record(&Record::Edit { label: label.into(), parts: step.redo.clone() });
        self.history.push(step);
        self.draft = after;
        self.revision += 1;
        true
    }

    /// What undo would take back.
    pub fn undo_label(&self) -> Option<&str> {
        self.history.undo_label()
    }

    /// What redo would bring back.
    pub fn redo_label(&self) -> Option<&str> {
        self.history.redo_label()
    }

    /// Takes the last step back; its name, or none when there is none.
    pub fn undo(&mut self) -> Option<String> {
        self.undo_label()?;
        self.record(&Record::Undo);
        self.revision += 1;
        self.history.undo(&mut self.draft)
    }

    /// Brings back the step last taken back; its name, or none when there is none.
    pub fn redo(&mut self) -> Option<String> {
        self.redo_label()?;
        self.record(&Record::Redo);
        self.revision += 1;
        self.history.redo(&mut self.draft)
    }

    fn replay(&mut self, record: Record) {
        match record {
            Record::Edit { label, parts } => {
                let mut after = self.draft.clone();
                after.apply(&parts);
                if let Some(step) = history::Step::between(&label, &self.draft, &after) {
                    self.history.push(step);
                }
                self.draft = after;
            }
            Record::Undo => drop(self.history.undo(&mut self.draft)),
            Record::Redo => drop(self.history.redo(&mut self.draft)),
            Record::Saved { on_disk, annotation_path, plate } => {
                self.annotation_path = annotation_path;
                self.draft.annotation.plate = plate;
                self.on_disk = on_disk;
                self.saved = self.draft.clone();
            }
        }
        self.revision += 1;
    }

    /// Writes to the journal; where that fails, work goes on, the fault is shown, and the next change tries again.
    fn record(&mut self, record: &Record) {
        if let Some(journal) = &mut self.journal {
            journal.append(record);
        }
    }

    /// The two documents as a validated plate, ready to be calibrated and fitted.
    ///
    /// # Errors
    /// With everything that is missing or wrong.
    pub fn plate(&self) -> Result<Plate, PlateError> {
        Plate::from_documents(
            (&self.manifest_path, self.draft.manifest.clone()),
            (&self.annotation_path, self.draft.annotation.clone()),
        )
    }

    /// Closes the document and removes its journal: only when everything is saved, or the person has said that it may go.
    pub fn close(mut self) {
        if let Some(journal) = self.journal.take() {
            journal.remove();
        }
    }
}

fn not_finite(path: &Path) -> DocumentError {
    let (path, field) = (path.to_path_buf(), "document".into());
    DocumentError::File(FileError::Parse { path, field, message: "holds a number that is not finite".into() })
}

/// Why a document cannot be opened.
#[derive(Debug, thiserror::Error)]
pub enum DocumentError {
    /// A file cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// Its content is wrong.
    #[error(transparent)]
    Plate(#[from] PlateError),
    /// Its journal cannot be used.
    #[error(transparent)]
    Journal(#[from] JournalError),
}

#[cfg(test)]
mod tests;
