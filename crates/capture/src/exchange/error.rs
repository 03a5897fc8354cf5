//! Why points cannot be exchanged.

use super::{Format, LARGEST_FILE_BYTES, Space};
use crate::keypoint::Keypoint;

/// Why an import or export is impossible.
#[derive(Debug, thiserror::Error, PartialEq)]
pub enum ExchangeError {
    /// The file is none that can be read.
    #[error("{file}: {message}")]
    Format {
        /// The file.
        file: String,
        /// What it is instead, and what to do.
        message: String,
    },
    /// The file is larger than any annotation of a plate.
    #[error(
        "{file}: {bytes} bytes are too many (at most {LARGEST_FILE_BYTES}); cut it down to the images of this plate"
    )]
    TooLarge {
        /// The file.
        file: String,
        /// Its size.
        bytes: usize,
    },
    /// Something in the file is wrong.
    #[error("{file}: {place}: {message}")]
    Content {
        /// The file.
        file: String,
        /// The line, row or field.
        place: String,
        /// What is wrong there, and what to do.
        message: String,
    },
    /// Two places of the files speak of one point.
    #[error(
        "{file}: {place}: {keypoint} of panel {panel} comes twice, here as `{name}` and before as `{first_name}` ({first_place}); keep one of the two"
    )]
    Twice {
        /// The file.
        file: String,
        /// The second place.
        place: String,
        /// The second name.
        name: String,
        /// The panel.
        panel: u32,
        /// The point.
        keypoint: Keypoint,
        /// The first place.
        first_place: String,
        /// The first name.
        first_name: String,
    },
    /// The format has no way to say it.
    #[error(
        "{} files cannot hold {} coordinates; leave the space away or choose {}",
        format.name(),
        space.name(),
        format.spaces()[0].name()
    )]
    Space {
        /// The format.
        format: Format,
        /// What was wanted.
        space: Space,
    },
    /// The annotation and the manifest disagree.
    #[error("panel {panel}: {message}")]
    Panel {
        /// The panel.
        panel: u32,
        /// What is wrong with it, and what to do.
        message: String,
    },
    /// Two pictures of an export would have one name.
    #[error("two pictures would be called {0}; give the plate's image files other names")]
    SameName(String),
    /// A name that cannot be part of a file name.
    #[error("the scorer {0:?} cannot be part of a file name; use letters, digits, `-` and `_`")]
    Scorer(String),
    /// The table of names is wrong.
    #[error("{theirs:?} cannot be {ours:?}, which is no keypoint of ours; one of them is `near_hock`")]
    Name {
        /// The other tool's name.
        theirs: String,
        /// What it should be.
        ours: String,
    },
}

impl ExchangeError {
    pub(super) fn content(file: &str, place: impl Into<String>, message: impl Into<String>) -> Self {
        Self::Content { file: file.into(), place: place.into(), message: message.into() }
    }
}
