//! Where the image files of a plate lie on this machine.

use std::path::{Path, PathBuf};

/// Environment variable that names another folder for fetched plates.
pub const CACHE_VARIABLE: &str = "MUYBRIDGE_CACHE";

/// The folder of fetched plates: `$MUYBRIDGE_CACHE`, or `muybridge/plates` in the system's cache folder (`~/.cache`,
/// `~/Library/Caches`, `%LOCALAPPDATA%`). None when neither is known. It may not exist yet.
pub fn cache_folder() -> Option<PathBuf> {
    use etcetera::BaseStrategy;
    match std::env::var_os(CACHE_VARIABLE) {
        Some(folder) if !folder.is_empty() => Some(PathBuf::from(folder)),
        _ => etcetera::base_strategy::choose_native_strategy()
            .ok()
            .map(|strategy| strategy.cache_dir().join("muybridge").join("plates")),
    }
}

/// The path of an image that a manifest names: next to the manifest, or else in the [`cache_folder`]; where neither
/// is there, next to the manifest.
pub fn locate_image(manifest_path: &Path, file: &str) -> PathBuf {
    let beside = manifest_path.parent().unwrap_or(Path::new(".")).join(file);
    if beside.exists() {
        return beside;
    }
    cache_folder().map(|folder| folder.join(file)).filter(|cached| cached.exists()).unwrap_or(beside)
}
