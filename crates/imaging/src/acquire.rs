//! A plate's manifest from what was fetched of a catalogue, or from a person's own scan or frames; and its panels.

use std::borrow::Borrow;
use std::path::{Path, PathBuf};

use image::GrayImage;
use muybridge_capture::{
    Catalogue, CataloguePlate, Facing, FileError, MANIFEST_SCHEMA, Manifest, Panel, PlateImage, hash_file,
    write_atomically,
};
use muybridge_core::Gait;

use crate::fetch::StoredPlate;
use crate::split::{Doubt, split};
use crate::{LoadLimits, PictureError, frames, load_gray};

/// Why a plate cannot be taken over.
#[derive(Debug, thiserror::Error)]
pub enum AcquireError {
    /// A picture cannot be read, or is none.
    #[error(transparent)]
    Picture(#[from] PictureError),
    /// A file cannot be read or written.
    #[error(transparent)]
    File(#[from] FileError),
    /// The identifier cannot be a file's name.
    #[error("identifier {id:?}: letters, digits, dots, dashes and underscores only")]
    Identifier {
        /// The identifier.
        id: String,
    },
    /// Another picture has the name already.
    #[error("{}: another picture of this name is there; choose another identifier", path.display())]
    Taken {
        /// The file.
        path: PathBuf,
    },
    /// A folder cannot be made.
    #[error("{}: cannot be made", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// Cause.
        source: std::io::Error,
    },
    /// A file cannot be read.
    #[error("{}: cannot be read", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Cause.
        source: std::io::Error,
    },
    /// No photograph was found in the pictures.
    #[error("no panel found; draw them by hand in the manifest (`panels[].quad_px`)")]
    NoPanel,
}

/// Panels found in a plate's pictures.
#[derive(Clone, Debug)]
pub struct FoundPanels {
    /// The panels, numbered in reading order, corners to a tenth of a pixel.
    pub panels: Vec<Panel>,
    /// How sure each is, 0 to 1.
    pub confidence: Vec<f64>,
    /// Why they may be wrong, with the picture's index.
    pub doubts: Vec<(usize, Doubt)>,
}

/// What a person says of a plate of their own.
#[derive(Clone, Debug, PartialEq)]
pub struct OwnPlate {
    /// Identifier: letters, digits, dots, dashes and underscores, not beginning with a dot.
    pub id: String,
    /// Gait of the title.
    pub gait: Gait,
    /// The animal's name.
    pub animal: String,
    /// Title as printed.
    pub title: String,
    /// Where the scan is from.
    pub source: String,
    /// Licence or rights statement.
    pub licence: String,
    /// Which way the animal faces.
    pub facing: Option<Facing>,
}

/// Identifier of a plate of *Animal Locomotion*.
pub fn catalogue_identifier(number: u32) -> String {
    format!("animal-locomotion-{number}")
}

/// Finds the panels of a plate's pictures; each picture of several is one photograph unless it surely holds one smaller.
///
/// # Errors
/// When no panel is found.
pub fn find_panels<P: Borrow<GrayImage>>(pictures: &[P]) -> Result<FoundPanels, AcquireError> {
    let (mut panels, mut confidence, mut doubts) = (Vec::new(), Vec::new(), Vec::new());
    for (image, picture) in pictures.iter().map(Borrow::borrow).enumerate() {
        let found = split(picture);
        if pictures.len() > 1 && !(found.is_certain() && found.panels.len() == 1) {
            // A frame of a folder shows one photograph, whatever is in it.
            panels.push(whole(panels.len() as u32 + 1, image, picture));
            confidence.push(1.0);
            continue;
        }
        doubts.extend(found.doubts.into_iter().map(|doubt| (image, doubt)));
        for panel in found.panels {
            panels.push(Panel { panel: panels.len() as u32 + 1, image, quad_px: rounded(panel.quad_px) });
            confidence.push(panel.confidence);
        }
    }
    if panels.is_empty() {
        Err(AcquireError::NoPanel)
    } else {
        Ok(FoundPanels { panels, confidence, doubts })
    }
}

fn whole(panel: u32, image: usize, picture: &GrayImage) -> Panel {
    let (width, height) = (f64::from(picture.width()), f64::from(picture.height()));
    Panel { panel, image, quad_px: [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]] }
}

/// To a tenth of a pixel, as manifests have them.
fn rounded(quad_px: [[f64; 2]; 4]) -> [[f64; 2]; 4] {
    quad_px.map(|corner| corner.map(|v| (10.0 * v).round() / 10.0))
}

/// The manifest of a fetched plate of a catalogue, without panels.
pub fn from_catalogue(catalogue: &Catalogue, plate: &CataloguePlate, picture: &StoredPlate) -> Manifest {
    Manifest {
        schema: MANIFEST_SCHEMA,
        id: catalogue_identifier(plate.number),
        catalogue_number: Some(plate.number.to_string()),
        title: format!("Animal Locomotion, plate {}: {}, {}", plate.number, plate.animal, plate.action),
        animal: plate.animal.clone(),
        gait: plate.gait,
        date: "1887".into(),
        source: format!("{} (object {}), IIIF service {}", catalogue.holder, plate.object_id, plate.iiif),
        holder: catalogue.holder.clone(),
        licence: catalogue.licence.clone(),
        printed: Vec::new(),
        facing: None,
        images: vec![PlateImage {
            file: file_name(&picture.path),
            sha256: picture.sha256.clone(),
            width_px: picture.width_px,
            height_px: picture.height_px,
        }],
        panels: Vec::new(),
        calibration: None,
    }
}

/// Copies a scan, or a folder's frames, into the cache and gives their manifest, without panels, and the copies.
///
/// # Errors
/// When a file is no picture (then nothing is copied), the identifier is no plain name, another picture has the name in
/// the cache already, or something cannot be read or written.
pub fn from_files(
    source: &Path,
    plate: OwnPlate,
    cache: &Path,
) -> Result<(Manifest, Vec<PathBuf>), AcquireError> {
    let id = plate.id;
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_.".contains(c);
    if id.is_empty() || id.starts_with('.') || !id.chars().all(plain) {
        return Err(AcquireError::Identifier { id });
    }
    let sources = if source.is_dir() { frames(source)? } else { vec![source.to_path_buf()] };
    let (mut images, mut files) = (Vec::new(), Vec::new());
    for file in &sources {
        // Read before anything is written: what is no picture is refused here.
        let name = if source.is_dir() {
            format!("{id}/{}", file_name(file))
        } else {
            let ending = file.extension().map(|e| format!(".{}", e.to_string_lossy())).unwrap_or_default();
            format!("{id}{ending}")
        };
        images.push(plate_image(file, &name)?);
        files.push(cache.join(name));
    }
    for ((source, target), image) in sources.iter().zip(&files).zip(&images) {
        copy(source, target, &image.sha256)?;
    }
    let manifest = Manifest {
        schema: MANIFEST_SCHEMA,
        id,
        catalogue_number: None,
        title: plate.title,
        animal: plate.animal,
        gait: plate.gait,
        date: String::new(),
        source: plate.source,
        holder: String::new(),
        licence: plate.licence,
        printed: Vec::new(),
        facing: plate.facing,
        images,
        panels: Vec::new(),
        calibration: None,
    };
    Ok((manifest, files))
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

/// A picture file's entry in a manifest.
fn plate_image(path: &Path, file: &str) -> Result<PlateImage, AcquireError> {
    let (width_px, height_px) = load_gray(path, LoadLimits::default())?.dimensions();
    Ok(PlateImage { file: file.into(), sha256: hash_file(path)?, width_px, height_px })
}

/// Copies a file unless it is there already; another file of the same name is not overwritten.
fn copy(source: &Path, target: &Path, sha256: &str) -> Result<(), AcquireError> {
    if target.exists() {
        let same = hash_file(target)? == sha256;
        return if same { Ok(()) } else { Err(AcquireError::Taken { path: target.to_path_buf() }) };
    }
    if let Some(folder) = target.parent() {
        std::fs::create_dir_all(folder)
            .map_err(|source| AcquireError::Folder { path: folder.to_path_buf(), source })?;
    }
    let bytes = std::fs::read(source)
        .map_err(|cause| AcquireError::Read { path: source.to_path_buf(), source: cause })?;
    Ok(write_atomically(target, &bytes)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn own(id: &str) -> OwnPlate {
        OwnPlate {
            id: id.into(),
            gait: Gait::Trot,
            animal: String::new(),
            title: String::new(),
            source: String::new(),
            licence: "not stated".into(),
            facing: Some(Facing::Left),
        }
    }

    #[test]
    fn a_scan_is_copied_once_and_never_over_another() {
        let folder = tempfile::tempdir().unwrap();
        let (scan, other) = (folder.path().join("scan.png"), folder.path().join("other.png"));
        GrayImage::from_fn(40, 30, |x, y| image::Luma([(x * y % 251) as u8])).save(&scan).unwrap();
        GrayImage::new(20, 20).save(&other).unwrap();
        let cache = folder.path().join("cache");
        let (manifest, files) = from_files(&scan, own("mine"), &cache).unwrap();
        assert_eq!(files, [cache.join("mine.png")]);
        assert_eq!((manifest.images[0].file.as_str(), manifest.images[0].width_px), ("mine.png", 40));
        assert_eq!(hash_file(&files[0]).unwrap(), manifest.images[0].sha256);
        assert!(from_files(&scan, own("mine"), &cache).is_ok());
        let taken = from_files(&other, own("mine"), &cache);
        assert!(matches!(taken, Err(AcquireError::Taken { .. })));
        for id in ["", ".hidden", "a/b", "a b"] {
            let refused = from_files(&scan, own(id), &cache);
            assert!(matches!(refused, Err(AcquireError::Identifier { .. })), "{id}");
        }
    }

    #[test]
    fn what_is_no_picture_leaves_nothing_behind() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("notes.png");
        write_atomically(&file, b"not a picture").unwrap();
        let cache = folder.path().join("cache");
        assert!(matches!(from_files(&file, own("mine"), &cache), Err(AcquireError::Picture(_))));
        assert!(!cache.exists());
    }
}
