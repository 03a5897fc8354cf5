//! Opening whatever a person names or drops: an annotation, a manifest, a picture, a folder of frames, a track of footprints.

use std::path::{Path, PathBuf};

use muybridge_capture::{
    Document, DocumentError, JournalError, MANIFEST_SCHEMA, Manifest, PlateImage, Waiting, annotation_beside,
    hash_file, locate_image, read_text, waiting,
};
use muybridge_core::Gait;
use muybridge_footprints::Track;
use muybridge_imaging::{LoadLimits, frames, load_gray};

/// Longest text file that is looked at, bytes: the largest annotation known has a tenth of a megabyte.
const LONGEST_TEXT: u64 = 50_000_000;

/// What became of a path.
#[derive(Debug)]
pub enum Opened {
    /// A plate, and what is wrong with its pictures on this machine.
    Document(Box<Document>, Vec<String>),
    /// A track of footprints, and its file.
    Track(Box<Track>, PathBuf),
    /// Its plate has unsaved work from before.
    Waiting(Waiting),
    /// A folder that holds plates and no frames.
    Folder(PathBuf),
}

/// Opens a path.
///
/// # Errors
/// In words: which file, what is wrong, what to do.
pub fn open(path: &Path, journals: Option<&Path>) -> Result<Opened, String> {
    if path.to_str().is_none() {
        return Err(format!(
            "{}: its name is no Unicode text; rename the file or its folder",
            path.display()
        ));
    }
    let metadata = std::fs::metadata(path)
        .map_err(|error| format!("{}: cannot be opened ({error}); check the path", path.display()))?;
    if metadata.is_dir() {
        return match frames(path) {
            Ok(files) => begin_from_pictures(path, &files, journals),
            Err(_) if holds_documents(path) => Ok(Opened::Folder(path.to_path_buf())),
            Err(error) => Err(error.to_string()),
        };
    }
    if !metadata.is_file() {
        return Err(format!("{}: neither a file nor a folder; check the path", path.display()));
    }
    if path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("json")) {
        if metadata.len() > LONGEST_TEXT {
            return Err(format!(
                "{}: far too long for an annotation; is this the right file?",
                path.display()
            ));
        }
        return open_document(path, journals);
    }
    // A picture that has a manifest of its name beside it is that plate's.
    let manifest_path = path.with_extension("json");
    if manifest_path.exists() {
        return open_document(&manifest_path, journals);
    }
    begin_from_pictures(path, &[path.to_path_buf()], journals)
}

fn holds_documents(folder: &Path) -> bool {
    let ending = |entry: std::io::Result<std::fs::DirEntry>| {
        entry.is_ok_and(|entry| entry.path().extension().is_some_and(|ending| ending == "json"))
    };
    std::fs::read_dir(folder).is_ok_and(|mut entries| entries.any(ending))
}

/// An annotation names its plate; a manifest has images.
fn open_document(path: &Path, journals: Option<&Path>) -> Result<Opened, String> {
    let text = read_text(path).map_err(|error| error.to_string())?;
    let has = |field: &str| text.contains(&format!("\"{field}\""));
    if has("plate") && has("annotator") {
        return opened(Document::open(path, journals), path, journals);
    }
    // Nothing else has footprints, and a track names who walks.
    if has("model") && (has("prints") || has("path")) && !has("images") {
        let track = Track::from_json(&text).map_err(|error| format!("{}: {error}", path.display()))?;
        return Ok(Opened::Track(Box::new(track), path.to_path_buf()));
    }
    if !(has("images") && has("panels") && has("gait")) {
        return Err(format!(
            "{}: neither an annotation, nor a plate's manifest, nor a track of footprints; points of other tools come in by File, Import points",
            path.display()
        ));
    }
    let annotation_path = annotation_beside(path);
    if annotation_path.exists() {
        return opened(Document::open(&annotation_path, journals), &annotation_path, journals);
    }
    let manifest = Manifest::read(path).map_err(|error| error.to_string())?;
    begin(path, manifest, journals)
}

fn begin(manifest_path: &Path, manifest: Manifest, journals: Option<&Path>) -> Result<Opened, String> {
    let annotation_path = annotation_beside(manifest_path);
    let document = Document::start(manifest_path, &annotation_path, manifest, journals);
    opened(document, &annotation_path, journals)
}

/// Unsaved work from before is offered, not overwritten.
fn opened(
    document: Result<Document, DocumentError>,
    annotation_path: &Path,
    journals: Option<&Path>,
) -> Result<Opened, String> {
    match document {
        Ok(document) => {
            let troubles = picture_troubles(&document);
            Ok(Opened::Document(Box::new(document), troubles))
        }
        Err(DocumentError::Journal(JournalError::Unsaved { path })) => {
            let left = journals.map(waiting).unwrap_or_default();
            let own = left.into_iter().find(|left| left.journal_path == path);
            own.map(Opened::Waiting)
                .ok_or_else(|| format!("{}: its journal cannot be read", annotation_path.display()))
        }
        Err(error) => Err(error.to_string()),
    }
}

/// Pictures that are missing, or are not those the points were placed on.
pub fn picture_troubles(document: &Document) -> Vec<String> {
    let images = &document.draft().manifest.images;
    let trouble = |image: &PlateImage| {
        let path = locate_image(document.manifest_path(), &image.file);
        match hash_file(&path) {
            Err(_) => Some(format!(
                "{}: not on this machine; points are shown without the photograph. Put it there, or fetch it (File, Browse plates)",
                path.display()
            )),
            Ok(hash) if hash != image.sha256 => Some(format!(
                "{}: another picture than the one the points were placed on (its hash differs); get the right file",
                path.display()
            )),
            Ok(_) => None,
        }
    };
    images.iter().filter_map(trouble).collect()
}

/// A plate nobody has described yet: its manifest will lie beside the picture, or beside the folder of frames.
fn begin_from_pictures(path: &Path, files: &[PathBuf], journals: Option<&Path>) -> Result<Opened, String> {
    let path = std::path::absolute(path).map_err(|error| format!("{}: {error}", path.display()))?;
    let folder = path.parent().unwrap_or(Path::new("."));
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let mut images = Vec::new();
    for file in files {
        let file = std::path::absolute(file).map_err(|error| format!("{}: {error}", file.display()))?;
        let (width_px, height_px) =
            load_gray(&file, LoadLimits::default()).map_err(|error| error.to_string())?.dimensions();
        let sha256 = hash_file(&file).map_err(|error| error.to_string())?;
        let name = file.strip_prefix(folder).unwrap_or(&file).to_string_lossy().replace('\\', "/");
        images.push(PlateImage { file: name, sha256, width_px, height_px });
    }
    let manifest = Manifest {
        schema: MANIFEST_SCHEMA,
        id: stem.clone(),
        catalogue_number: None,
        title: String::new(),
        animal: String::new(),
        gait: Gait::Gallop,
        date: String::new(),
        source: String::new(),
        holder: String::new(),
        licence: "not stated".into(),
        printed: Vec::new(),
        facing: None,
        images,
        panels: Vec::new(),
        calibration: None,
    };
    begin(&folder.join(format!("{stem}.json")), manifest, journals)
}
