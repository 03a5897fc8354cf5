//! A picture in one answer, kept in a part file while it arrives so that a broken download can go on.

use std::fs::{File, OpenOptions, TryLockError};
use std::io::{Read, Seek, SeekFrom, Write};

use image::DynamicImage;
use muybridge_capture::{FileError, to_stable_json, write_atomically};
use serde::{Deserialize, Serialize};

use super::client::{Answer, Client, Rest};
use super::jpeg;
use super::place::{Place, write_error};
use super::{FetchError, Progress};

/// A picture that has arrived and reads to its end.
pub(super) struct Whole {
    pub(super) jpeg: Vec<u8>,
    pub(super) picture: DynamicImage,
}

impl Whole {
    /// Width and height, px.
    pub(super) fn size_px(&self) -> [u32; 2] {
        [self.picture.width(), self.picture.height()]
    }
}

/// What a part file is a part of.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
struct Origin {
    url: String,
    /// `ETag` or `Last-Modified` of the answer.
    validator: String,
}

/// Downloads a picture, going on from the part that is there, and reads it. The part stays until the caller has done
/// with the picture.
///
/// # Errors
/// When it cannot be downloaded within the limits, is no picture, or ends before its end.
pub(super) fn fetch_whole(client: &mut Client, url: &str, place: &Place) -> Result<Whole, FetchError> {
    let mut part = Part::open(place)?;
    client.persist(|client| {
        let from = part.receive(client, url)?;
        let jpeg = part.read()?;
        match jpeg::decode(url, &jpeg, client.limits.pixels) {
            Ok(picture) => Ok(Whole { jpeg, picture }),
            Err(error) => {
                part.restart()?;
                // What was there before may be at fault, not the server.
                Err(if from > 0 { does_not_fit(url) } else { error })
            }
        }
    })
}

fn does_not_fit(url: &str) -> FetchError {
    let cause = "the rest does not fit what was there".into();
    FetchError::Interrupted { url: url.into(), received: 0, cause }
}

/// An open part file, locked: another run would write into it.
struct Part<'a> {
    place: &'a Place,
    file: File,
}

impl<'a> Part<'a> {
    fn open(place: &'a Place) -> Result<Self, FetchError> {
        let path = place.part();
        let file = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(&path);
        let file = file.map_err(|error| write_error(&path, error))?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => Err(FetchError::Busy { path }),
            // A file system without locks must do.
            Ok(()) | Err(TryLockError::Error(_)) => Ok(Self { place, file }),
        }
    }

    /// What is there of `url` that a download can go on from.
    fn there(&self, url: &str) -> Option<Rest> {
        let from = self.file.metadata().ok()?.len();
        let text = std::fs::read(self.place.part_origin()).ok()?;
        let origin: Origin = serde_json::from_slice(&text).ok()?;
        (from > 0 && origin.url == url).then_some(Rest { from, validator: origin.validator })
    }

    /// Forgets what has arrived.
    fn restart(&self) -> Result<(), FetchError> {
        self.place.remove_part_origin()?;
        self.file.set_len(0).map_err(|error| write_error(&self.place.part(), error))
    }

    /// One attempt to bring the file to its end. Returns how many of its bytes were there before.
    fn receive(&mut self, client: &mut Client, url: &str) -> Result<u64, FetchError> {
        let there = self.there(url);
        let answer = match client.get(url, there.as_ref()) {
            // What is there is no beginning of what the server has now.
            Err(FetchError::Status { status: 416, .. }) if there.is_some() => client.get(url, None)?,
            answer => answer?,
        };
        let from = match there {
            Some(rest) if answer.is_rest(&rest) => rest.from,
            _ => 0,
        };
        if from == 0 {
            self.restart()?;
            if answer.is_partial() {
                return Err(does_not_fit(url));
            }
            self.keep_origin(url, &answer)?;
        }
        self.write(client, answer, from)?;
        Ok(from)
    }

    fn keep_origin(&self, url: &str, answer: &Answer) -> Result<(), FetchError> {
        let Some(validator) = answer.validator() else { return Ok(()) };
        let origin = Origin { url: url.into(), validator: validator.into() };
        Ok(write_atomically(&self.place.part_origin(), to_stable_json(&origin).as_bytes())?)
    }

    fn write(&mut self, client: &mut Client, answer: Answer, from: u64) -> Result<(), FetchError> {
        let path = self.place.part();
        let total = answer.length().map(|rest| from.saturating_add(rest));
        let progress = &mut client.progress;
        progress(Progress::Bytes { received: from, total });
        self.file.seek(SeekFrom::Start(from)).map_err(|error| write_error(&path, error))?;
        answer.receive([from, client.limits.bytes], |chunk, received| {
            self.file.write_all(chunk).map_err(|error| write_error(&path, error))?;
            progress(Progress::Bytes { received, total });
            Ok(())
        })
    }

    /// All that has arrived. By the open file: the name may be another run's by now.
    fn read(&mut self) -> Result<Vec<u8>, FetchError> {
        let mut bytes = Vec::new();
        let result = self.file.rewind().and_then(|()| self.file.read_to_end(&mut bytes));
        match result {
            Ok(_) => Ok(bytes),
            Err(source) => Err(FileError::Read { path: self.place.part(), source }.into()),
        }
    }
}
