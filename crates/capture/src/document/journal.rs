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
use crate::files::sync_folder;

/// Schema version of a journal.
pub(crate) const JOURNAL_SCHEMA: u32 = 1;
/// Ending of a journal's file name.
const ENDING: &str = "journal";
/// Ending of a journal that this version cannot read.
const SET_ASIDE: &str = "journal-unreadable";
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

impl Recovered {
    /// Changes since the last save.
    fn unsaved(&self) -> usize {
        self.records.iter().rev().take_while(|record| !matches!(record, Record::Saved { .. })).count()
    }

    fn is_unsaved(&self) -> bool {
        self.unsaved() > 0 || (self.records.is_empty() && self.head.draft != self.head.saved)
    }
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
    /// None until it can be made.
    file: Option<File>,
    /// Bytes of the lines that are on disk.
    length: u64,
    /// Lines that are not on disk yet: they are written before the next one.
    backlog: Vec<u8>,
    fault: Option<String>,
}

impl Journal {
    /// Starts the journal of a document in a folder, which is made if need be. One that is there is replaced, unless
    /// another program holds it or it has changes. Without room or leave to write it, the journal is begun with the next
    /// line for which there is.
    pub(crate) fn create(folder: &Path, head: &Head) -> Result<Self, JournalError> {
        let path = folder.join(file_name(&head.annotation_path));
        let backlog = line(head).map_err(|source| file_error(&path, source))?;
        let mut journal = Self { path, file: None, length: 0, backlog, fault: None };
        match journal.write() {
            Err(error @ (JournalError::Held { .. } | JournalError::Unsaved { .. })) => Err(error),
            written => {
                journal.fault = written.err().map(|error| error.to_string());
                Ok(journal)
            }
        }
    }

    /// Opens a journal that was left behind; a torn last line is cut off with the next that is written.
    pub(crate) fn reopen(path: &Path) -> Result<(Self, Recovered), JournalError> {
        let mut file = lock(path, false)?;
        let text = read(&mut file, path)?;
        let (recovered, length) =
            parse(&text).ok_or_else(|| JournalError::Unreadable { path: path.to_path_buf() })?;
        let (path, length) = (path.to_path_buf(), length as u64);
        Ok((Self { path, file: Some(file), length, backlog: Vec::new(), fault: None }, recovered))
    }

    /// Adds a line and waits until it is on disk.
    pub(crate) fn append(&mut self, record: &Record) {
        let appended = line(record).map_err(|source| file_error(&self.path, source)).and_then(|line| {
            self.backlog.extend(line);
            self.write()
        });
        self.fault = appended.err().map(|error| error.to_string());
    }

    /// Why lines are missing on disk, if any are.
    pub(crate) fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    fn write(&mut self) -> Result<(), JournalError> {
        let mut file = match self.file.take() {
            Some(file) => file,
            None => make(&self.path)?,
        };
        let written = write_from(&mut file, self.length, &self.backlog);
        self.file = Some(file);
        written.map_err(|source| file_error(&self.path, source))?;
        self.length += self.backlog.len() as u64;
        self.backlog.clear();
        Ok(())
    }

    /// Removes the file: its document was saved, or was not to be kept. A file that cannot be removed is left.
    pub(crate) fn remove(self) {
        if self.file.is_some() {
            std::fs::remove_file(&self.path).ok();
        }
    }
}

/// Makes the file of a new journal, or takes over one that is not needed. One that this version cannot read is kept
/// beside it.
fn make(path: &Path) -> Result<File, JournalError> {
    if let Some(folder) = path.parent() {
        std::fs::create_dir_all(folder).map_err(|source| file_error(path, source))?;
    }
    let mut file = lock(path, true)?;
    let text = read(&mut file, path)?;
    match parse(&text) {
        Some((recovered, _)) if recovered.is_unsaved() => {
            Err(JournalError::Unsaved { path: path.to_path_buf() })
        }
        // Without a whole first line it was never begun.
        None if text.contains(&b'\n') => {
            let aside = path.with_extension(SET_ASIDE);
            std::fs::rename(path, aside).map_err(|source| file_error(path, source))?;
            lock(path, true)
        }
        _ => Ok(file),
    }
    .inspect(|_| path.parent().into_iter().for_each(sync_folder))
}

/// Writes at the end of the good lines, over what an earlier attempt may have left there, and waits for the disk.
fn write_from(file: &mut File, length: u64, lines: &[u8]) -> std::io::Result<()> {
    file.set_len(length)?;
    file.seek(SeekFrom::Start(length))?;
    file.write_all(lines)?;
    file.sync_data()
}

fn lock(path: &Path, create: bool) -> Result<File, JournalError> {
    // Anything but a file could keep its reader waiting for ever.
    if std::fs::metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
        return Err(file_error(path, std::io::Error::other("not a file")));
    }
    let file = OpenOptions::new().read(true).write(true).create(create).truncate(false).open(path);
    let file = file.map_err(|source| file_error(path, source))?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(std::fs::TryLockError::WouldBlock) => Err(JournalError::Held { path: path.to_path_buf() }),
        Err(std::fs::TryLockError::Error(source)) => Err(file_error(path, source)),
    }
}

fn read(file: &mut File, path: &Path) -> Result<Vec<u8>, JournalError> {
    let mut text = Vec::new();
    file.read_to_end(&mut text).map_err(|source| file_error(path, source))?;
    Ok(text)
}

/// A line's text; an error for a path that is no Unicode.
fn line<T: Serialize>(content: &T) -> std::io::Result<Vec<u8>> {
    let json = serde_json::to_string(content)?;
    Ok(format!("{} {json}\n", check(json.as_bytes())).into_bytes())
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
    let mut file = lock(&journal_path, false).ok()?;
    let (recovered, _) = parse(&read(&mut file, &journal_path).ok()?)?;
    recovered.is_unsaved().then(|| Waiting {
        changes: recovered.unsaved(),
        annotation_path: recovered.head.annotation_path,
        plate: recovered.head.draft.manifest.id,
        journal_path,
    })
}

/// Removes a journal: the person does not want what is in it.
///
/// # Errors
/// When it cannot be removed, or another program holds it.
pub fn discard(journal_path: &Path) -> Result<(), JournalError> {
    let _lock = lock(journal_path, false)?;
    std::fs::remove_file(journal_path).map_err(|source| file_error(journal_path, source))
}
