//! A plate as a person names it, its pictures and its panels.

use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use image::GrayImage;
use muybridge_capture::{Manifest, Panel, hash_file, locate_image};
use muybridge_imaging::acquire::{FoundPanels, catalogue_identifier, find_panels};
use muybridge_imaging::split::Doubt;
use muybridge_imaging::{LoadLimits, frames, load_gray};

/// Folders in which an identifier is looked up.
const FOLDERS: [&str; 2] = ["plates", "plates/specimens"];

/// A plate with its picture files.
pub(super) struct PlateSource {
    /// Identifier: the manifest's, or the name of the file or folder without its ending.
    pub(super) id: String,
    /// The manifest and its path, where there is one.
    pub(super) manifest: Option<(PathBuf, Manifest)>,
    /// The picture files.
    pub(super) files: Vec<PathBuf>,
}

/// Panels of a plate.
pub(super) struct Panels {
    pub(super) panels: Vec<Panel>,
    /// How sure each is, 0 to 1; none for panels of a manifest.
    pub(super) confidence: Option<Vec<f64>>,
    /// Why they may be wrong, with the picture's index.
    pub(super) doubts: Vec<(usize, Doubt)>,
}

impl From<FoundPanels> for Panels {
    fn from(found: FoundPanels) -> Self {
        Self { panels: found.panels, confidence: Some(found.confidence), doubts: found.doubts }
    }
}

/// Name of a file or folder without its ending.
pub(super) fn stem(path: &Path) -> String {
    let canonical = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let name = if canonical.is_dir() { canonical.file_name() } else { canonical.file_stem() };
    name.map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}

impl PlateSource {
    /// Finds a plate by its manifest, picture, folder of frames, identifier or catalogue number.
    pub(super) fn find(name: &str) -> anyhow::Result<Self> {
        let path = Path::new(name);
        if path.is_dir() {
            return Ok(Self { id: stem(path), manifest: None, files: frames(path)? });
        }
        if path.is_file() && path.extension().is_none_or(|extension| extension != "json") {
            return Ok(Self { id: stem(path), manifest: None, files: vec![path.to_path_buf()] });
        }
        let id = name.parse().map_or_else(|_| name.to_string(), catalogue_identifier);
        let in_folders = FOLDERS.map(|folder| Path::new(folder).join(format!("{id}.json")));
        let manifest = [path.to_path_buf()].into_iter().chain(in_folders).find(|path| path.is_file());
        match manifest {
            Some(path) => Self::from_manifest(path),
            None => bail!(
                "{name}: no such manifest, picture or folder, and no plate of this identifier in {}; \
                 `muybridge plates fetch` gets plates of the catalogue",
                FOLDERS.join(" or ")
            ),
        }
    }

    fn from_manifest(path: PathBuf) -> anyhow::Result<Self> {
        let manifest = Manifest::read(&path)?;
        let mut files = Vec::new();
        for image in &manifest.images {
            let file = locate_image(&path, &image.file);
            if !file.exists() {
                bail!(
                    "{}: not on this machine; put it there, or get it with `muybridge plates fetch` or `add`",
                    file.display()
                );
            }
            if hash_file(&file)? != image.sha256 {
                bail!("{}: another image than the manifest's (its hash differs)", file.display());
            }
            files.push(file);
        }
        Ok(Self { id: manifest.id.clone(), manifest: Some((path, manifest)), files })
    }

    /// Reads the pictures.
    pub(super) fn pictures(&self) -> anyhow::Result<Vec<GrayImage>> {
        self.files.iter().map(|file| Ok(load_gray(file, LoadLimits::default())?)).collect()
    }

    /// The manifest's panels, or those found in the pictures where it has none.
    pub(super) fn panels(&self, pictures: &[GrayImage]) -> anyhow::Result<Panels> {
        match &self.manifest {
            Some((_, manifest)) if !manifest.panels.is_empty() => {
                Ok(Panels { panels: manifest.panels.clone(), confidence: None, doubts: Vec::new() })
            }
            _ => Ok(find_panels(pictures).with_context(|| self.id.clone())?.into()),
        }
    }
}
