//! The journal of a document: what it was when work began, and every change since, one line each, on disk before it is shown.
//!
//! A line is eight hexadecimal digits of its SHA-256, a blank, and JSON. A line that was being written when the power went
//! fails its check and is cut off; all lines before it count.

use std::fs::{File, OpenOptions};
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::draft::Draft;
use super::record::Record;
use super::{OnDisk, place};

/// Schema version of a journal.
pub(crate) const JOURNAL_SCHEMA: u32 = 1;
/// Ending of a journal's file name.
const ENDING: &str = "journal";
/// Hexadecimal digits of a line's check.
const CHECK_DIGITS: usize = 8;

/// First line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Head {
    pub(crate) journal: u32,
    pub(crate) manifest_path: PathBuf,
    pub(crate) annotation_path: PathBuf,
    pub(crate) on_disk: OnDisk,
    pub(crate) saved: Draft,
    pub(crate) draft: Draft,
}

/// What a journal says.
pub(crate) struct Recovered {
    pub(crate) head: Head,
    pub(crate) records: Vec<Record>,
}

/// Why a journal cannot be used.
#[derive(Debug, thiserror::Error)]
pub enum JournalError {
    /// The file cannot be made, read or written.
    #[error("{}: the journal of unsaved work cannot be written or read ({source}); check the folder and its room", path.display())]
    File {
        /// The journal.
        path: PathBuf,
        /// Cause.
        source: std::io::Error,
    },
    /// Another program holds it.
    #[error("{}: this plate is open already, here or in another window", path.display())]
    Held {
        /// The journal.
        path: PathBuf,
    },
    /// It holds work that was not saved.
    #[error("{}: holds unsaved work on this plate; take it up or discard it first", path.display())]
    Unsaved {
        /// The journal.
        path: PathBuf,
    },
    /// Not a journal of this version.
    #[error("{}: not a journal that this version can read; move it away", path.display())]
    Unreadable {
        /// The journal.
        path: PathBuf,
    },
}

/// An open journal, locked against other programs.
#[derive(Debug)]
pub(crate) struct Journal {
    path: PathBuf,
    file: File,
}

impl Journal {
    /// Starts the journal of a document in a folder, which is made if need be. One that is there is replaced, unless
    /// another program holds it or it has changes.
    pub(crate) fn create(folder: &Path, head: &Head) -> Result<Self, JournalError> {
        let path = folder.join(file_name(&head.annotation_path));
        std::fs::create_dir_all(folder).map_err(|source| file_error(&path, source))?;
        let mut journal = Self::lock(path)?;
        if journal.waiting().is_some() {
            return Err(JournalError::Unsaved { path: journal.path });
        }
        journal.restart(head)?;
        Ok(journal)
    }

    /// Opens a journal that was left behind, and cuts a torn last line off.
    pub(crate) fn reopen(path: &Path) -> Result<(Self, Recovered), JournalError> {
        let mut journal = Self::lock(path.to_path_buf())?;
        let mut text = Vec::new();
        journal.file.read_to_end(&mut text).map_err(|source| file_error(path, source))?;
        let (recovered, length) =
            parse(&text).ok_or_else(|| JournalError::Unreadable { path: path.to_path_buf() })?;
        let cut = |file: &mut File| {
            file.set_len(length as u64)?;
            file.seek(SeekFrom::End(0)).map(drop)
        };
        cut(&mut journal.file).map_err(|source| file_error(path, source))?;
        Ok((journal, recovered))
    }

    fn lock(path: PathBuf) -> Result<Self, JournalError> {
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
        let file = file.map_err(|source| file_error(&path, source))?;
        match file.try_lock() {
            Ok(()) => Ok(Self { path, file }),
            Err(std::fs::TryLockError::WouldBlock) => Err(JournalError::Held { path }),
            Err(std::fs::TryLockError::Error(source)) => Err(file_error(&path, source)),
        }
    }

    /// Begins anew from a state.
    pub(crate) fn restart(&mut self, head: &Head) -> Result<(), JournalError> {
        let begin = |file: &mut File| {
            file.set_len(0)?;
            file.rewind()
        };
        begin(&mut self.file).map_err(|source| file_error(&self.path, source))?;
        self.write(head)
    }

    /// Adds a line and waits until it is on disk.
    pub(crate) fn append(&mut self, record: &Record) -> Result<(), JournalError> {
        self.write(record)
    }

    fn write<T: Serialize>(&mut self, line: &T) -> Result<(), JournalError> {
        let json = serde_json::to_string(line)
            .unwrap_or_else(|error| unreachable!("documents hold only string keys: {error}"));
        let line = format!("{} {json}\n", check(json.as_bytes()));
        let write = |file: &mut File| {
            file.write_all(line.as_bytes())?;
            file.sync_data()
        };
        write(&mut self.file).map_err(|source| file_error(&self.path, source))
    }

    /// The changes in it, if any.
    fn waiting(&mut self) -> Option<Waiting> {
        let mut text = Vec::new();
        self.file.read_to_end(&mut text).ok()?;
        let Recovered { head, records } = parse(&text)?.0;
        let unsaved = records.iter().rev().take_while(|r| !matches!(r, Record::Saved { .. })).count();
        let changed = unsaved > 0 || (records.is_empty() && head.draft != head.saved);
        changed.then(|| Waiting {
            journal_path: self.path.clone(),
            annotation_path: head.annotation_path,
            plate: head.draft.manifest.id,
            changes: unsaved,
        })
    }

    /// Removes the file: its document was saved, or was not to be kept. A file that cannot be removed is left.
    pub(crate) fn remove(self) {
        std::fs::remove_file(&self.path).ok();
    }
}

fn file_error(path: &Path, source: std::io::Error) -> JournalError {
    JournalError::File { path: path.to_path_buf(), source }
}

fn check(json: &[u8]) -> String {
    Sha256::digest(json).iter().take(CHECK_DIGITS / 2).map(|byte| format!("{byte:02x}")).collect()
}

/// Name of the journal of an annotation: its stem, and enough of its path's hash to tell it from others of that name.
fn file_name(annotation_path: &Path) -> String {
    let stem = annotation_path.file_stem().unwrap_or_default().to_string_lossy();
    let path = place::absolute(annotation_path);
    format!("{stem}-{}.{ENDING}", check(path.to_string_lossy().as_bytes()))
}

/// What a journal says, and the length of its good lines in bytes. None when not even the first is good.
fn parse(text: &[u8]) -> Option<(Recovered, usize)> {
    let mut lines = text.split_inclusive(|byte| *byte == b'\n');
    let first = lines.next()?;
    let head: Head = parse_line(first)?;
    if head.journal != JOURNAL_SCHEMA {
        return None;
    }
    let (mut records, mut length) = (Vec::new(), first.len());
    for line in lines {
        let Some(record) = parse_line(line) else { break };
        records.push(record);
        length += line.len();
    }
    Some((Recovered { head, records }, length))
}

fn parse_line<T: DeserializeOwned>(line: &[u8]) -> Option<T> {
    let line = line.strip_suffix(b"\n")?;
    let (digits, json) = line.split_at_checked(CHECK_DIGITS)?;
    let json = json.strip_prefix(b" ")?;
    (digits == check(json).as_bytes()).then(|| serde_json::from_slice(json).ok())?
}

/// A journal that was left behind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Waiting {
    /// The journal.
    pub journal_path: PathBuf,
    /// The annotation it belongs to.
    pub annotation_path: PathBuf,
    /// Its plate's identifier.
    pub plate: String,
    /// Changes in it.
    pub changes: usize,
}

/// Journals with changes in a folder that no running program holds, in the order of their names.
pub fn waiting(folder: &Path) -> Vec<Waiting> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == ENDING));
    paths.sort();
    paths.into_iter().filter_map(left_behind).collect()
}

fn left_behind(journal_path: PathBuf) -> Option<Waiting> {
    Journal::lock(journal_path).ok()?.waiting()
}

/// Removes a journal: the person does not want what is in it.
///
/// # Errors
/// When it cannot be removed, or another program holds it.
pub fn discard(journal_path: &Path) -> Result<(), JournalError> {
    let journal = Journal::lock(journal_path.to_path_buf())?;
    std::fs::remove_file(&journal.path).map_err(|source| file_error(journal_path, source))
}
