//! Exchange of placed points with the tools in which people already have work: `DeepLabCut`, COCO keypoints, labelme, and
//! a plain table for R and pandas.
//!
//! Nothing here touches a disk or a pixel: [`export`] gives the content of files, [`import`] takes it.
//! A point of a file belongs to a panel by the name of its picture or a number that the file states, never by the order
//! of rows alone; what cannot be placed or named is skipped, counted and said in the notes.
//!
//! # Where pixels begin
//!
//! Our plate px and panel px have the centre of the first pixel at (0.5, 0.5). [`Format::first_pixel_centre_px`] is the
//! one place that says where it lies in another format, and all conversion follows from it.
//!
//! | format | first pixel's centre | why |
//! | --- | --- | --- |
//! | `DeepLabCut` | 0 | labels are clicks in napari and matplotlib, which draw the first pixel around (0, 0) |
//! | COCO | 0 | keypoints count pixels from 0; SLEAP and sleap-io read them as pixel centres |
//! | labelme | 0.5 | the canvas draws the picture's corner at (0, 0) |
//! | csv | 0.5 | plate px as in our own files |

mod coco;
mod collect;
mod deeplabcut;
mod error;
mod format;
mod labelme;
mod layout;
mod merge;
mod names;
mod notes;
mod plain_csv;
mod table;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

pub use collect::Import;
pub use error::ExchangeError;
pub use format::{Format, Space};
pub use layout::{PanelPictures, PictureSource};
pub use merge::{Existing, Merged};
pub use names::{NameTable, skeleton_edges};

use crate::annotation::Annotation;
use crate::manifest::Manifest;

/// What an export may choose.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct ExportOptions {
    /// Pixels of which pictures; none for what is usual in the format ([`Format::spaces`]).
    pub space: Option<Space>,
    /// Who labelled, for `DeepLabCut`, which has the name in files and folders; none for the annotation's `annotator`.
    pub scorer: Option<String>,
}

/// A picture that an exported file speaks of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ExportPicture {
    /// Where the file expects it, relative to the export's folder, with forward slashes.
    pub path: String,
    /// What it shows.
    pub source: PictureSource,
}

/// The files of an export; none is written yet.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Export {
    /// Relative paths with forward slashes, and contents.
    pub files: Vec<(String, Vec<u8>)>,
    /// The pictures they speak of.
    pub pictures: Vec<ExportPicture>,
    /// What the format cannot hold, counted, one sentence each.
    pub notes: Vec<String>,
}

/// Turns an annotation into files of another tool.
///
/// # Errors
/// When the format cannot hold the wanted pixel space, the annotation names a panel that the manifest has not, a panel
/// has no picture, or the scorer's name cannot be part of a file name.
pub fn export(
    manifest: &Manifest,
    annotation: &Annotation,
    panels: &dyn PanelPictures,
    format: Format,
    options: &ExportOptions,
) -> Result<Export, ExchangeError> {
    let space = format.space(options.space)?;
    let layout = layout::Layout::new(manifest, annotation, panels, format, space)?;
    let (files, pictures) = match format {
        Format::DeepLabCut => deeplabcut::write(manifest, annotation, &layout, options.scorer.as_deref())?,
        Format::Coco => (coco::write(manifest, &layout), layout.pictures_in("")),
        Format::Labelme => (labelme::write(&layout), layout.pictures_in("")),
        Format::Csv => (plain_csv::write(manifest, annotation), Vec::new()),
    };
    Ok(Export { files, pictures, notes: layout.losses(annotation) })
}

/// A file to import.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImportFile {
    /// Its name, for messages.
    pub name: String,
    /// Its bytes, at most [`LARGEST_FILE_BYTES`].
    pub content: Vec<u8>,
}

/// Largest file that is read, bytes: a hundred times what twenty-four panels need. The worst files of this size that we
/// could think of took 0.3 GB and 6 s.
pub const LARGEST_FILE_BYTES: usize = 32 << 20;

/// Reads points of another tool's files (of one format) and puts them onto the plate.
///
/// `own_names` are names beyond those known, from the files to ours; none as a value skips that name.
///
/// # Errors
/// When a file is of no known format, too large or damaged, or says two things about one point, with the file and the
/// place in it.
pub fn import(
    files: &[ImportFile],
    format: Option<Format>,
    manifest: &Manifest,
    panels: &dyn PanelPictures,
    own_names: &BTreeMap<String, Option<String>>,
) -> Result<Import, ExchangeError> {
    let mut collector =
        collect::Collector::new(manifest, panels, NameTable::new(manifest.facing, own_names)?);
    for file in files {
        let text = format::text_of(file)?;
        let format = match format {
            Some(format) => format,
            None => Format::detect(&file.name, text)?,
        };
        match format {
            Format::DeepLabCut => deeplabcut::read(&file.name, text, &mut collector)?,
            Format::Coco => coco::read(&file.name, text, &mut collector)?,
            Format::Labelme => labelme::read(&file.name, text, &mut collector)?,
            Format::Csv => plain_csv::read(&file.name, text, &mut collector)?,
        }
    }
    Ok(collector.finish())
}
