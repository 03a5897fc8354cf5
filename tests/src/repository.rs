//! Where the repository is, and the folder of photographs that may stand next to it.

use std::path::{Path, PathBuf};

/// The repository's root.
pub fn repository() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().unwrap()
}

/// The folder `shared` next to the repository, which holds the photographs; none on most machines.
pub fn shared_folder() -> Option<PathBuf> {
    let folder = repository().parent()?.join("shared");
    folder.is_dir().then_some(folder)
}
