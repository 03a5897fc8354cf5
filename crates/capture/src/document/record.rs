//! The lines of a journal.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::OnDisk;
use super::draft::Part;

/// One line of a journal.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Record {
    /// A change.
    Edit { label: String, parts: Vec<Part> },
    /// The last step was taken back.
    Undo,
    /// The step last taken back was brought again.
    Redo,
    /// Both files were written; where the annotation is now, and how it names its plate.
    Saved { on_disk: OnDisk, annotation_path: PathBuf, plate: String },
}
