//! A folder of frames is a plate, too: its pictures in the order of their numbers.

use std::cmp::Ordering;
use std::path::{Path, PathBuf};

use crate::picture::PictureError;

/// Endings of picture files, lower case.
const ENDINGS: [&str; 6] = ["jpg", "jpeg", "png", "tif", "tiff", "gif"];

/// The picture files of a folder, ordered by name with numbers by their value: `frame-9.png` before `frame-10.png`.
/// Hidden files are left out.
///
/// # Errors
/// When the folder cannot be read, or holds no picture file.
pub fn frames(folder: &Path) -> Result<Vec<PathBuf>, PictureError> {
    let read_error = |source| PictureError::Read { path: folder.to_path_buf(), source };
    let mut found: Vec<(String, PathBuf)> = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(read_error)? {
        let path = entry.map_err(read_error)?.path();
        let Some(name) = path.file_name().map(|name| name.to_string_lossy().into_owned()) else { continue };
        let ending = path.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        if !name.starts_with('.') && ending.is_some_and(|e| ENDINGS.contains(&e.as_str())) && path.is_file() {
            found.push((name, path));
        }
    }
    if found.is_empty() {
        return Err(PictureError::NoFrames { path: folder.to_path_buf() });
    }
    found.sort_by(|(a, _), (b, _)| natural_order(a, b));
    Ok(found.into_iter().map(|(_, path)| path).collect())
}

/// Texts in the order a person expects: runs of digits by their value, everything else by character; equal so, by text.
fn natural_order(a: &str, b: &str) -> Ordering {
    let (mut left, mut right) = (a, b);
    loop {
        let (digits_left, digits_right) = (leading_digits(left), leading_digits(right));
        let order = if !digits_left.is_empty() && !digits_right.is_empty() {
            (left, right) = (&left[digits_left.len()..], &right[digits_right.len()..]);
            let value = |digits: &str| digits.trim_start_matches('0').to_owned();
            let (x, y) = (value(digits_left), value(digits_right));
            x.len().cmp(&y.len()).then(x.cmp(&y))
        } else {
            let (mut rest_left, mut rest_right) = (left.chars(), right.chars());
            let (x, y) = (rest_left.next(), rest_right.next());
            if x.is_none() && y.is_none() {
                return a.cmp(b);
            }
            (left, right) = (rest_left.as_str(), rest_right.as_str());
            x.cmp(&y)
        };
        if order != Ordering::Equal {
            return order;
        }
    }
}

fn leading_digits(text: &str) -> &str {
    &text[..text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit()).len()]
}

#[cfg(test)]
mod tests {
    use super::*;
    use muybridge_capture::write_atomically;

    #[test]
    fn frames_come_in_the_order_of_their_numbers() {
        let folder = tempfile::tempdir().unwrap();
        for name in ["frame-10.png", "frame-9.PNG", "frame-009b.jpg", "notes.txt", ".hidden.png", "a.tiff"] {
            write_atomically(&folder.path().join(name), b"x").unwrap();
        }
        let names: Vec<String> = frames(folder.path())
            .unwrap()
            .iter()
            .map(|path| path.file_name().unwrap().to_string_lossy().into_owned())
            .collect();
        assert_eq!(names, ["a.tiff", "frame-9.PNG", "frame-009b.jpg", "frame-10.png"]);
    }

    #[test]
    fn a_folder_without_pictures_says_so() {
        let folder = tempfile::tempdir().unwrap();
        assert!(frames(folder.path()).unwrap_err().to_string().contains("no picture"));
        assert!(frames(&folder.path().join("missing")).unwrap_err().to_string().contains("cannot be read"));
    }
}
