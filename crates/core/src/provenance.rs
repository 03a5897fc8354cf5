//! Where a number comes from, as a type: nothing derived may pass for a capture.

use serde::{Deserialize, Serialize};

/// How the speed of a captured stride is known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum SpeedSource {
    /// The speed itself is stated with the plate.
    Stated,
    /// Distance and time are both known.
    Measured,
    /// Inferred from the stride length by dynamic similarity.
    Inferred,
}

/// Origin of a stride or a law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum Provenance {
    /// Fitted from photographs.
    Captured {
        /// Identifiers of the plates.
        plates: Vec<String>,
        /// SHA-256 of the annotation files, hexadecimal, in the order of `plates`.
        annotations_sha256: Vec<String>,
        /// How the speed is known.
        speed: SpeedSource,
    },
    /// Computed from something else.
    Derived {
        /// What from.
        from: Vec<String>,
        /// By which rule.
        how: String,
    },
    /// Taken from a publication.
    Published {
        /// Author, year and place in the work.
        source: String,
    },
}

impl Provenance {
    /// One short phrase for tables: `captured`, `derived` or `published`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Captured { .. } => "captured",
            Self::Derived { .. } => "derived",
            Self::Published { .. } => "published",
        }
    }
}
