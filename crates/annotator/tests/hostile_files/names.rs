//! Things that are no files, and files that cannot be named or read.

use std::path::Path;

use super::{Dropped, Specimen, write};

pub(super) fn names(folder: &Path) -> Vec<Dropped> {
    std::fs::create_dir_all(folder).unwrap();
    let mut paths =
        vec![folder.join("missing.json"), folder.join("missing.jpg"), folder.join("x/../y/z.json")];
    for name in ["empty-folder", "folder.json", "folder.jpg"] {
        std::fs::create_dir(folder.join(name)).unwrap();
        paths.push(folder.join(name));
    }
    for (name, file, content) in [
        ("folder-of-text", "a.txt", b"text".as_slice()),
        ("folder-of-damage", "frame-1.png", b"\x89PNG\r\n\x1a\n"),
        ("folder-of-nothings", "frame-1.jpg", b""),
    ] {
        std::fs::create_dir(folder.join(name)).unwrap();
        write(&folder.join(name).join(file), content);
        paths.push(folder.join(name));
    }
    let long = folder.join(format!("{}.json", "n".repeat(240)));
    write(&long, b"{}");
    paths.extend([long, folder.join("n".repeat(5000))]);
    #[cfg(unix)]
    paths.extend(unix_names(folder));
    paths.into_iter().map(|path| Dropped { path, may_open: false }).collect()
}

#[cfg(unix)]
fn unix_names(folder: &Path) -> Vec<std::path::PathBuf> {
    use std::os::unix::ffi::OsStrExt;
    use std::os::unix::fs::{PermissionsExt, symlink};
    let mut paths = vec![Path::new("/dev/zero").to_path_buf(), Path::new("/dev/null").to_path_buf()];
    for name in ["pipe.json", "pipe.jpg", "pipe"] {
        let path = folder.join(name);
        if std::process::Command::new("mkfifo").arg(&path).status().is_ok_and(|status| status.success()) {
            paths.push(path);
        }
    }
    symlink(folder.join("ring-b.json"), folder.join("ring-a.json")).unwrap();
    symlink(folder.join("ring-a.json"), folder.join("ring-b.json")).unwrap();
    symlink(folder.join("nowhere"), folder.join("nowhere.json")).unwrap();
    paths.extend(["ring-a.json", "nowhere.json"].map(|name| folder.join(name)));
    // A good plate in a folder that cannot be written down.
    let unnamed = folder.join(std::ffi::OsStr::from_bytes(b"n\xff"));
    paths.push(Specimen::read().unpack(&unnamed, "good"));
    let named = folder.join(std::ffi::OsStr::from_bytes(b"\xc3\x28.jpg"));
    write(&named, &std::fs::read(unnamed.join("specimen-trot.jpg")).unwrap());
    paths.push(named);
    let closed = folder.join("closed.json");
    write(&closed, b"{}");
    std::fs::set_permissions(&closed, std::fs::Permissions::from_mode(0o000)).unwrap();
    paths.push(closed);
    paths
}
