//! A track file being worked on: its history, the change under way, saving.

use std::path::{Path, PathBuf};

use muybridge_capture::{FileError, Hash, hash_file, write_atomically};
use muybridge_footprints::Track;

use super::safe_copy::{Left, SafeCopy};

/// Steps that can be taken back, of a track of usual length.
const MOST_STEPS: usize = 500;
/// Prints in all steps together, at most: a long track has a shorter history.
const MOST_PRINTS: usize = 500_000;
/// Steps that can be taken back however long the track is.
const LEAST_STEPS: usize = 20;

/// A state before or after the present one.
#[derive(Clone, Debug)]
struct Step {
    label: String,
    track: Track,
}

/// Why a track was not saved.
#[derive(Debug, thiserror::Error)]
pub enum TrackSaveError {
    /// Nobody has said where.
    #[error("this track has no file yet")]
    NoPath,
    /// Another program wrote the file, or it was there before.
    #[error("{}: there is another file of this name, or it was changed since it was read", .0.display())]
    ChangedOnDisk(PathBuf),
    /// The file cannot be written.
    #[error(transparent)]
    File(#[from] FileError),
}

/// An open track.
#[derive(Debug)]
pub struct TrackDocument {
    track: Track,
    saved: Option<Track>,
    path: Option<PathBuf>,
    on_disk: Option<Hash>,
    past: Vec<Step>,
    future: Vec<Step>,
    preview: Option<Step>,
    revision: u64,
    safe_copy: SafeCopy,
}

impl TrackDocument {
    /// A track that has no file: an example, or what somebody walked. It counts as saved until it is changed.
    pub fn new(track: Track) -> Self {
        Self {
            saved: Some(track.clone()),
            track,
            path: None,
            on_disk: None,
            past: Vec::new(),
            future: Vec::new(),
            preview: None,
            revision: 0,
            safe_copy: SafeCopy::default(),
        }
    }

    /// A track of a file.
    pub fn of_file(track: Track, path: &Path) -> Self {
        let on_disk = hash_file(path).ok();
        Self { path: Some(path.to_path_buf()), on_disk, ..Self::new(track) }
    }

    /// Work that a program left behind; it is not saved.
    pub fn recovered(left: &Left) -> Self {
        let (path, on_disk) = (left.record.path.clone(), left.record.on_disk.clone());
        Self { saved: None, path, on_disk, ..Self::new(left.record.track.clone()) }
    }

    /// Counts as work that is not saved: a walk that is kept, which no file has yet.
    pub fn unsaved(mut self) -> Self {
        self.saved = None;
        self
    }

    /// Keeps every change in a folder until it is saved, so that a crash loses nothing.
    pub fn keep_safe_in(&mut self, folder: Option<PathBuf>) {
        self.safe_copy = SafeCopy::new(folder);
        self.write_safe_copy();
    }

    /// The track as it is shown: with the change under way.
    pub fn track(&self) -> &Track {
        self.preview.as_ref().map_or(&self.track, |preview| &preview.track)
    }

    /// The track without the change under way.
    pub fn committed(&self) -> &Track {
        &self.track
    }

    /// A number that changes whenever [`TrackDocument::track`] does.
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// Where it is saved.
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// Its name for people: the file's, its own, or none.
    pub fn name(&self) -> String {
        let file = self.path.as_ref().and_then(|path| path.file_stem());
        let own = || self.track.name.clone().unwrap_or_else(|| "New track".into());
        file.map_or_else(own, |stem| stem.to_string_lossy().into_owned())
    }

    /// Whether there are changes that are not saved, the one under way among them.
    pub fn is_changed(&self) -> bool {
        self.saved.as_ref() != Some(self.track())
    }

    /// Why changes are not protected against a crash.
    pub fn safe_copy_fault(&self) -> Option<&str> {
        self.safe_copy.fault()
    }

    /// Whether a change is under way.
    pub fn is_changing(&self) -> bool {
        self.preview.is_some()
    }

    /// Shows what a gesture would make of the track as it was before the gesture.
    pub fn preview(&mut self, label: &str, change: impl FnOnce(&mut Track)) {
        let mut track = self.track.clone();
        change(&mut track);
        self.preview = Some(Step { label: label.into(), track });
        self.revision += 1;
    }

    /// Makes the change under way, as one step.
    pub fn commit(&mut self) {
        let Some(Step { label, track }) = self.preview.take() else { return };
        if track == self.track {
            return;
        }
        self.future.clear();
        let before = std::mem::replace(&mut self.track, track);
        self.past.push(Step { label, track: before });
        self.forget_oldest();
        self.note_change();
    }

    /// Forgets the change under way.
    pub fn cancel(&mut self) {
        if self.preview.take().is_some() {
            self.revision += 1;
        }
    }

    /// Makes a change at once, as one step.
    pub fn edit(&mut self, label: &str, change: impl FnOnce(&mut Track)) {
        self.commit();
        self.preview(label, change);
        self.commit();
    }

    /// What would be taken back.
    pub fn undo_label(&self) -> Option<&str> {
        self.past.last().map(|step| step.label.as_str())
    }

    /// What would be brought back.
    pub fn redo_label(&self) -> Option<&str> {
        self.future.last().map(|step| step.label.as_str())
    }

    /// Takes the last step back.
    pub fn undo(&mut self) {
        self.commit();
        if let Some(Step { label, track }) = self.past.pop() {
            let after = std::mem::replace(&mut self.track, track);
            self.future.push(Step { label, track: after });
            self.note_change();
        }
    }

    /// Brings the step back that was taken back last.
    pub fn redo(&mut self) {
        self.commit();
        if let Some(Step { label, track }) = self.future.pop() {
            let before = std::mem::replace(&mut self.track, track);
            self.past.push(Step { label, track: before });
            self.note_change();
        }
    }

    fn note_change(&mut self) {
        self.revision += 1;
        self.write_safe_copy();
    }

    fn write_safe_copy(&mut self) {
        if self.is_changed() {
            self.safe_copy.write(&self.track, self.path.as_deref(), self.on_disk.as_ref());
        } else {
            self.safe_copy.remove();
        }
    }

    fn forget_oldest(&mut self) {
        let mut prints: usize = self.past.iter().map(|step| step.track.prints.len()).sum();
        let mut surplus = 0;
        for step in &self.past {
            let left = self.past.len() - surplus;
            if left <= LEAST_STEPS || (left <= MOST_STEPS && prints <= MOST_PRINTS) {
                break;
            }
            prints -= step.track.prints.len();
            surplus += 1;
        }
        self.past.drain(..surplus);
    }

    /// Writes the file it was read from or saved to last.
    ///
    /// # Errors
    /// When there is none, when it is not what was read (unless `overwrite`), or when it cannot be written.
    pub fn save(&mut self, overwrite: bool) -> Result<(), TrackSaveError> {
        let path = self.path.clone().ok_or(TrackSaveError::NoPath)?;
        self.save_as(&path, overwrite)
    }

    /// Writes a file, which is this track's from now on.
    ///
    /// # Errors
    /// As [`TrackDocument::save`].
    pub fn save_as(&mut self, path: &Path, overwrite: bool) -> Result<(), TrackSaveError> {
        self.commit();
        let known = self.on_disk.as_ref().filter(|_| self.path.as_deref() == Some(path));
        if path.exists() && !overwrite && hash_file(path).ok().as_ref() != known {
            return Err(TrackSaveError::ChangedOnDisk(path.to_path_buf()));
        }
        write_atomically(path, self.track.to_json().as_bytes())?;
        self.path = Some(path.to_path_buf());
        self.on_disk = hash_file(path).ok();
        self.saved = Some(self.track.clone());
        self.safe_copy.remove();
        Ok(())
    }

    /// Forgets changes that are not saved: the person has said so.
    pub fn discard(&mut self) {
        self.safe_copy.remove();
    }
}
