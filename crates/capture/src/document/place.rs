//! Where things are kept: the folder of journals and settings, the annotation of a plate, and paths relative to files.

use std::path::{Component, Path, PathBuf};

/// Environment variable that names another folder for journals and settings.
pub const STATE_VARIABLE: &str = "MUYBRIDGE_STATE";

/// The folder of journals and settings: `$MUYBRIDGE_STATE`, or `muybridge` in the system's folder for program state
/// (`~/.local/state`, `~/Library/Application Support`, `%APPDATA%`). None when neither is known. It may not exist yet.
pub fn state_folder() -> Option<PathBuf> {
    use etcetera::BaseStrategy;
    match std::env::var_os(STATE_VARIABLE) {
        Some(folder) if !folder.is_empty() => Some(PathBuf::from(folder)),
        _ => etcetera::base_strategy::choose_native_strategy()
            .ok()
            .map(|strategy| strategy.state_dir().unwrap_or_else(|| strategy.data_dir()).join("muybridge")),
    }
}

/// The annotation that belongs to a manifest: of the same name in the folder `annotations` beside the manifest or one above,
/// whichever is there; else in the one beside it.
pub fn annotation_beside(manifest_path: &Path) -> PathBuf {
    let name = PathBuf::from(manifest_path.file_name().unwrap_or_default());
    let folder = manifest_path.parent().unwrap_or(Path::new("."));
    let beside = folder.join("annotations");
    let above = absolute(folder).parent().map(|parent| parent.join("annotations"));
    match above.filter(|above| above.is_dir() && !beside.is_dir()) {
        Some(above) => above.join(name),
        None => beside.join(name),
    }
}

/// A path without `.` and `..`, from the root; links are followed as far as the path exists.
pub(super) fn absolute(path: &Path) -> PathBuf {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => drop(plain.pop()),
            Component::CurDir => {}
            other => plain.push(other),
        }
        if let Ok(real) = plain.canonicalize() {
            plain = real;
        }
    }
    plain
}

/// The path of `to` as seen from the folder of the file `from`, with forward slashes.
pub fn relative_path(from: &Path, to: &Path) -> String {
    let (from, to) = (absolute(from), absolute(to));
    let from: Vec<Component> = from.parent().unwrap_or(Path::new("")).components().collect();
    let to: Vec<Component> = to.components().collect();
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..".to_string(), from.len() - shared);
    let down = to[shared..].iter().map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}
