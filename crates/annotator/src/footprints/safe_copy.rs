//! The copy of a changed track on disk, until it is saved: what a crash leaves behind is offered again.
//!
//! Beside each copy lies a file that is locked as long as its program runs, so that nobody takes up the work of another window.

use std::fs::{File, OpenOptions};
use std::path::{Path, PathBuf};

use muybridge_capture::{Hash, read_json, write_json};
use muybridge_footprints::Track;
use serde::{Deserialize, Serialize};

/// Schema version of a copy.
const COPY_SCHEMA: u32 = 1;
/// Windows of one person that work on tracks at the same time, at most.
const MOST_COPIES: usize = 1000;

/// A copy.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Record {
    schema: u32,
    /// File of the track, where it has one.
    pub path: Option<PathBuf>,
    /// What that file held when it was last read or written.
    pub on_disk: Option<Hash>,
    /// The track.
    pub track: Track,
}

/// Work that a program left behind.
#[derive(Debug)]
pub struct Left {
    /// What it is.
    pub record: Record,
    copy_path: PathBuf,
    /// Held, so that no other window offers it, too.
    _lock: File,
}

impl Left {
    /// Its name for people.
    pub fn name(&self) -> String {
        let file = self.record.path.as_ref().and_then(|path| path.file_stem());
        let own = || self.record.track.name.clone().unwrap_or_else(|| "A new track".into());
        file.map_or_else(own, |stem| stem.to_string_lossy().into_owned())
    }

    /// Forgets it.
    pub fn discard(&self) {
        remove(&self.copy_path);
    }
}

/// What was left behind in a folder, by programs that do not run any more.
pub fn left_behind(folder: &Path) -> Vec<Left> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.sort();
    let copies = paths.into_iter().filter(|path| path.extension().is_some_and(|ending| ending == "json"));
    copies.filter_map(left).collect()
}

fn left(copy_path: PathBuf) -> Option<Left> {
    let lock = OpenOptions::new().create(true).append(true).open(copy_path.with_extension("lock")).ok()?;
    lock.try_lock().ok()?;
    let record = read_json(&copy_path, COPY_SCHEMA).ok()?;
    Some(Left { record, copy_path, _lock: lock })
}

fn remove(copy_path: &Path) {
    // What is not there any more needs no removal, and what cannot be removed is offered again.
    std::fs::remove_file(copy_path).ok();
    std::fs::remove_file(copy_path.with_extension("lock")).ok();
}

/// The copy of an open track.
#[derive(Debug, Default)]
pub(super) struct SafeCopy {
    folder: Option<PathBuf>,
    held: Option<(PathBuf, File)>,
    fault: Option<String>,
}

impl SafeCopy {
    pub(super) fn new(folder: Option<PathBuf>) -> Self {
        Self { folder, ..Self::default() }
    }

    /// Why there is no copy.
    pub(super) fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// Writes the track as it is now.
    pub(super) fn write(&mut self, track: &Track, path: Option<&Path>, on_disk: Option<&Hash>) {
        let Some(folder) = self.folder.clone() else { return };
        if self.held.is_none() {
            self.held = begin(&folder);
        }
        let Some((copy_path, _)) = &self.held else {
            self.fault = Some(format!("{}: cannot be written to", folder.display()));
            return;
        };
        let (path, on_disk) = (path.map(Path::to_path_buf), on_disk.cloned());
        let record = Record { schema: COPY_SCHEMA, path, on_disk, track: track.clone() };
        self.fault = write_json(copy_path, &record).err().map(|error| error.to_string());
    }

    /// Removes it: everything is saved, or need not be.
    pub(super) fn remove(&mut self) {
        if let Some((copy_path, _lock)) = self.held.take() {
            remove(&copy_path);
        }
    }
}

/// A name that no other window has.
fn begin(folder: &Path) -> Option<(PathBuf, File)> {
    std::fs::create_dir_all(folder).ok()?;
    (0..MOST_COPIES).find_map(|number| {
        let copy_path = folder.join(format!("track-{number}.json"));
        if copy_path.exists() {
            return None;
        }
        let lock =
            OpenOptions::new().create_new(true).append(true).open(copy_path.with_extension("lock")).ok()?;
        lock.try_lock().ok()?;
        Some((copy_path, lock))
    })
}
