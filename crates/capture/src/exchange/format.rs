//! The formats, which is which, and where pixels begin in them.

use serde::Deserialize;
use serde::de::{DeserializeOwned, IgnoredAny};

use super::notes::short;
use super::{ExchangeError, ImportFile, LARGEST_FILE_BYTES};

/// A format of another tool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// A `DeepLabCut` project: `CollectedData_<scorer>.csv`.
    DeepLabCut,
    /// COCO keypoints, one JSON file.
    Coco,
    /// labelme, one JSON file a picture.
    Labelme,
    /// A table with one point a row: panel, keypoint, plate px, state, provenance.
    Csv,
}

/// Of which pictures coordinates are pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// Of each panel, cut out and squared up: panel px.
    Panel,
    /// Of the plate's image files: plate px.
    Plate,
}

impl Space {
    /// Name for people: `panel` or `plate`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Panel => "panel",
            Self::Plate => "plate",
        }
    }
}

impl Format {
    /// All formats.
    pub const ALL: [Self; 4] = [Self::DeepLabCut, Self::Coco, Self::Labelme, Self::Csv];

    /// Name for people and command lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::DeepLabCut => "deeplabcut",
            Self::Coco => "coco",
            Self::Labelme => "labelme",
            Self::Csv => "csv",
        }
    }

    /// The spaces that a format can hold, the usual one first. `DeepLabCut` knows one animal a picture, so a plate of many
    /// panels is none of its pictures; our table is of the plate.
    pub fn spaces(self) -> &'static [Space] {
        match self {
            Self::DeepLabCut => &[Space::Panel],
            Self::Coco | Self::Labelme => &[Space::Panel, Space::Plate],
            Self::Csv => &[Space::Plate],
        }
    }

    pub(super) fn space(self, wanted: Option<Space>) -> Result<Space, ExchangeError> {
        let space = wanted.unwrap_or(self.spaces()[0]);
        if self.spaces().contains(&space) {
            Ok(space)
        } else {
            Err(ExchangeError::Space { format: self, space })
        }
    }

    /// Coordinate of the centre of a picture's first pixel, px; 0.5 in our own files.
    pub fn first_pixel_centre_px(self) -> f64 {
        match self {
            Self::DeepLabCut | Self::Coco => 0.0,
            Self::Labelme | Self::Csv => 0.5,
        }
    }

    /// Tells a file's format from what is in it.
    ///
    /// # Errors
    /// When it is none of ours.
    pub fn detect(name: &str, text: &str) -> Result<Self, ExchangeError> {
        let unknown = |message: &str| ExchangeError::Format { file: name.into(), message: message.into() };
        if text.starts_with(['{', '[']) {
            #[derive(Deserialize)]
            struct Head {
                shapes: Option<IgnoredAny>,
                annotations: Option<IgnoredAny>,
            }
            let head: Head = serde_json::from_str(text).map_err(|error| unknown(&no_json(&error)))?;
            return match (head.shapes, head.annotations) {
                (Some(_), _) => Ok(Self::Labelme),
                (None, Some(_)) => Ok(Self::Coco),
                (None, None) => {
                    Err(unknown("has neither `annotations` (COCO) nor `shapes` (labelme); name its format"))
                }
            };
        }
        let header = text.lines().next().unwrap_or_default().to_ascii_lowercase();
        let first = header.split(',').next().unwrap_or_default();
        if first.trim_matches(['"', ' ']) == "scorer" {
            return Ok(Self::DeepLabCut);
        }
        if header.contains("panel") && header.contains("keypoint") {
            return Ok(Self::Csv);
        }
        Err(unknown("neither DeepLabCut, COCO, labelme nor a table with the columns panel and keypoint"))
    }
}

/// A JSON document, with the field named where it is wrong.
pub(super) fn parse_json<T: DeserializeOwned>(file: &str, text: &str) -> Result<T, ExchangeError> {
    let mut deserializer = serde_json::Deserializer::from_str(text);
    let document = serde_path_to_error::deserialize(&mut deserializer).map_err(|error| {
        let place = short(&error.path().to_string());
        let inner = error.into_inner();
        let message = if inner.is_data() { inner.to_string() } else { no_json(&inner) };
        ExchangeError::content(file, place, message)
    })?;
    deserializer.end().map_err(|error| ExchangeError::content(file, "end", no_json(&error)))?;
    Ok(document)
}

/// What to say of text that is no JSON, or not all of it.
fn no_json(error: &serde_json::Error) -> String {
    format!("no valid JSON ({error}); correct the text there (NaN is none), or export it again")
}

/// A file's text without byte order mark and leading space.
pub(super) fn text_of(file: &ImportFile) -> Result<&str, ExchangeError> {
    if file.content.len() > LARGEST_FILE_BYTES {
        return Err(ExchangeError::TooLarge { file: file.name.clone(), bytes: file.content.len() });
    }
    let unreadable =
        |message: &str| ExchangeError::Format { file: file.name.clone(), message: message.into() };
    if file.content.starts_with(b"\x89HDF") {
        return Err(unreadable("is HDF5, which is not read; take the CSV file of the same name next to it"));
    }
    let text = std::str::from_utf8(&file.content)
        .map_err(|_| unreadable("is no UTF-8 text; save it as UTF-8, or take another file"))?;
    let text = text.trim_start_matches('\u{feff}').trim_start();
    if text.is_empty() { Err(unreadable("the file is empty; export it again")) } else { Ok(text) }
}
