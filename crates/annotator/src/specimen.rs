//! The specimen plate that comes with the program: a drawing, with every joint known, to try things on.

use std::path::{Path, PathBuf};

use muybridge_capture::{FileError, write_atomically};

const PICTURE: &[u8] = include_bytes!("../../../plates/specimens/specimen-walk.jpg");
const MANIFEST: &[u8] = include_bytes!("../../../plates/specimens/specimen-walk.json");
const ANNOTATION: &[u8] = include_bytes!("../../../plates/specimens/annotations/specimen-walk.json");

/// Lays the specimen into a folder, as far as it is not there, and gives the path of its annotation. What a person has
/// changed in it stays.
///
/// # Errors
/// When the folder cannot be written to.
pub fn unpack(folder: &Path) -> Result<PathBuf, FileError> {
    let annotations = folder.join("annotations");
    std::fs::create_dir_all(&annotations)
        .map_err(|source| FileError::Write { path: annotations.clone(), source })?;
    for (name, content) in [
        ("specimen-walk.jpg", PICTURE),
        ("specimen-walk.json", MANIFEST),
        ("annotations/specimen-walk.json", ANNOTATION),
    ] {
        let path = folder.join(name);
        if !path.exists() {
            write_atomically(&path, content)?;
        }
    }
    Ok(annotations.join("specimen-walk.json"))
}
