//! Where a plate and its parts lie on disk.

use std::io;
use std::path::{Path, PathBuf};

use muybridge_capture::FileError;

use super::FetchError;

/// The files of one plate: `target` with endings.
pub(super) struct Place {
    target: PathBuf,
}

impl Place {
    pub(super) fn new(target: &Path) -> Self {
        Self { target: target.to_path_buf() }
    }

    fn with(&self, ending: &str) -> PathBuf {
        let mut path = self.target.clone().into_os_string();
        path.push(ending);
        path.into()
    }

    /// A picture kept byte for byte as it came.
    pub(super) fn jpeg(&self) -> PathBuf {
        self.with(".jpg")
    }

    /// A picture put together from tiles.
    pub(super) fn png(&self) -> PathBuf {
        self.with(".png")
    }

    /// A whole picture while it arrives.
    pub(super) fn part(&self) -> PathBuf {
        self.with(".part")
    }

    /// What the part is a part of.
    pub(super) fn part_origin(&self) -> PathBuf {
        self.with(".part.json")
    }

    /// Folder of tiles while they arrive.
    pub(super) fn tiles(&self) -> PathBuf {
        self.with(".tiles")
    }

    /// Makes the folder that all of it lies in.
    pub(super) fn make_folder(&self) -> Result<(), FetchError> {
        match self.target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => {
                std::fs::create_dir_all(folder).map_err(|error| write_error(folder, error))
            }
            _ => Ok(()),
        }
    }

    /// Removes the part, where there is one.
    pub(super) fn remove_part(&self) -> Result<(), FetchError> {
        remove_file(&self.part())?;
        self.remove_part_origin()
    }

    /// Removes the word on what the part is a part of, so that nothing goes on from it.
    pub(super) fn remove_part_origin(&self) -> Result<(), FetchError> {
        remove_file(&self.part_origin())
    }

    /// Removes the tiles, where there are some.
    pub(super) fn remove_tiles(&self) -> Result<(), FetchError> {
        let tiles = self.tiles();
        accept_missing(std::fs::remove_dir_all(&tiles)).map_err(|error| write_error(&tiles, error))
    }

    /// After success: nothing but the picture stays, in one form.
    pub(super) fn keep_only(&self, picture: &Path) -> Result<(), FetchError> {
        for other in [self.jpeg(), self.png()].iter().filter(|other| *other != picture) {
            remove_file(other)?;
        }
        self.remove_part()?;
        self.remove_tiles()
    }

    /// After failure: what a later fetch can go on from stays, nothing else.
    pub(super) fn tidy_after(&self, error: &FetchError) -> Result<(), FetchError> {
        if matches!(error, FetchError::Busy { .. }) {
            return Ok(());
        }
        if error.discredits_parts() || !self.part_origin().exists() {
            self.remove_part()?;
        }
        let tiles = std::fs::read_dir(self.tiles()).map_or(0, Iterator::count);
        // The description that they belong to lies with them.
        if error.discredits_parts() || tiles <= 1 {
            self.remove_tiles()?;
        }
        Ok(())
    }
}

/// A file that cannot be written or removed.
pub(super) fn write_error(path: &Path, source: io::Error) -> FetchError {
    FileError::Write { path: path.to_path_buf(), source }.into()
}

fn accept_missing(result: io::Result<()>) -> io::Result<()> {
    match result {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        result => result,
    }
}

fn remove_file(path: &Path) -> Result<(), FetchError> {
    accept_missing(std::fs::remove_file(path)).map_err(|error| write_error(path, error))
}
