//! Files: reading with the field named, stable JSON text, atomic writing, hashes.

use std::fs::File;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;
use sha2::{Digest, Sha256};

/// A file that could not be read or written.
#[derive(Debug, thiserror::Error)]
pub enum FileError {
    /// The file cannot be opened or read.
    #[error("{}: cannot be read; check the path and its permissions", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Cause.
        source: std::io::Error,
    },
    /// The file cannot be written.
    #[error("{}: cannot be written; check that the folder exists, is writable and has room", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// Cause.
        source: std::io::Error,
    },
    /// The file has nothing in it.
    #[error("{}: the file is empty; restore it from version control or a backup", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
    /// The text is not what the document needs.
    #[error("{}: {field}: {message}", path.display())]
    Parse {
        /// The file.
        path: PathBuf,
        /// The field, as a path such as `panels[3].keypoints.near_hock`.
        field: String,
        /// What is wrong there.
        message: String,
    },
    /// Written by another version.
    #[error("{}: schema: version {found}, but this program reads version {expected}; update the program", path.display())]
    Schema {
        /// The file.
        path: PathBuf,
        /// Version in the file.
        found: u64,
        /// Version this program reads.
        expected: u32,
    },
}

/// Longest text that is read, bytes: five hundred times the longest document known to us.
const LONGEST_TEXT: u64 = 100_000_000;

/// SHA-256 of a file, lower-case hexadecimal.
pub type Hash = String;

/// Reads a text file.
///
/// # Errors
/// When the file cannot be read, is no UTF-8, is empty, or longer than a hundred megabytes.
pub fn read_text(path: &Path) -> Result<String, FileError> {
    let read = |mut file: File| {
        let mut text = String::new();
        if (&mut file).take(LONGEST_TEXT).read_to_string(&mut text)? as u64 == LONGEST_TEXT {
            return Err(std::io::ErrorKind::FileTooLarge.into());
        }
        Ok(text)
    };
    let text = open_file(path)
        .and_then(read)
        .map_err(|source| FileError::Read { path: path.to_path_buf(), source })?;
    if text.trim().is_empty() {
        return Err(FileError::Empty { path: path.to_path_buf() });
    }
    Ok(text)
}

/// Opens a file for reading. Pipes and devices are refused: they could be waited for, or read, for ever.
fn open_file(path: &Path) -> std::io::Result<File> {
    if !std::fs::metadata(path)?.is_file() {
        return Err(std::io::Error::other("not a file"));
    }
    File::open(path)
}

/// Reads a document whose first level has a `schema` number.
///
/// # Errors
/// As [`read_text`]; and when the schema differs from `expected_schema`, or the text is no such document, with the
/// field named.
pub fn read_json<T: DeserializeOwned>(path: &Path, expected_schema: u32) -> Result<T, FileError> {
    let text = read_text(path)?;
    #[derive(serde::Deserialize)]
    struct Head {
        schema: Option<u64>,
    }
    // Text that has no readable head is no document either, and reading it whole tells where it goes wrong.
    if let Ok(head) = serde_json::from_str::<Head>(&text) {
        let missing = || FileError::Parse {
            path: path.to_path_buf(),
            field: "schema".into(),
            message: "missing; is this the right file?".into(),
        };
        let found = head.schema.ok_or_else(missing)?;
        if found != u64::from(expected_schema) {
            return Err(FileError::Schema { path: path.to_path_buf(), found, expected: expected_schema });
        }
    }
    let deserializer = &mut serde_json::Deserializer::from_str(&text);
    let document = serde_path_to_error::deserialize(&mut *deserializer)
        .map_err(|error| parse_error(path, error.path().to_string(), error.inner()))?;
    deserializer.end().map_err(|error| parse_error(path, ".".into(), &error))?;
    Ok(document)
}

fn parse_error(path: &Path, field: String, error: &serde_json::Error) -> FileError {
    let message = if error.is_data() {
        error.to_string()
    } else {
        format!("no valid JSON ({error}); correct the text there, or restore the file from version control")
    };
    // serde_path_to_error calls the whole document a dot.
    let field = if field == "." { "document".into() } else { field };
    FileError::Parse { path: path.to_path_buf(), field, message }
}

/// Widest line that a list or object may take before it is broken, characters.
const LINE_WIDTH: usize = 110;

/// Text of a document: two-space indentation, short lists and objects on one line, fields in declaration order,
/// numbers as they are (round them before), a line feed at the end.
pub fn to_stable_json<T: Serialize>(document: &T) -> String {
    // By way of text, which keeps the short form of 32-bit numbers.
    let value: Value = serde_json::to_string(document)
        .and_then(|text| serde_json::from_str(&text))
        .unwrap_or_else(|error| unreachable!("documents hold only string keys and finite numbers: {error}"));
    let mut text = String::new();
    write_value(&value, 0, &mut text);
    text.push('\n');
    text
}

fn write_value(value: &Value, indent: usize, out: &mut String) {
    let inline = inline(value);
    let (open, close, items): (_, _, Vec<(Option<&String>, &Value)>) = match value {
        Value::Array(items) => ('[', ']', items.iter().map(|item| (None, item)).collect()),
        Value::Object(fields) => ('{', '}', fields.iter().map(|(key, item)| (Some(key), item)).collect()),
        _ => return out.push_str(&inline),
    };
    if indent + inline.len() <= LINE_WIDTH {
        return out.push_str(&inline);
    }
    out.push(open);
    let numbers = items.iter().all(|(key, item)| key.is_none() && item.is_number());
    let mut column = LINE_WIDTH;
    for (i, (key, item)) in items.iter().enumerate() {
        let comma = if i + 1 < items.len() { "," } else { "" };
        let next = if numbers { item.to_string().len() + 2 } else { LINE_WIDTH };
        if column + next > LINE_WIDTH {
            out.push('\n');
            out.extend(std::iter::repeat_n(' ', indent + 2));
            column = indent + 2;
        } else {
            out.push(' ');
        }
        column += next;
        if let Some(key) = key {
            out.push_str(&format!("{}: ", Value::from(key.as_str())));
        }
        write_value(item, indent + 2, out);
        out.push_str(comma);
    }
    out.push('\n');
    out.extend(std::iter::repeat_n(' ', indent));
    out.push(close);
}

fn inline(value: &Value) -> String {
    match value {
        Value::Array(items) => format!("[{}]", items.iter().map(inline).collect::<Vec<_>>().join(", ")),
        Value::Object(fields) if fields.is_empty() => "{}".into(),
        Value::Object(fields) => {
            let fields: Vec<_> = fields
                .iter()
                .map(|(key, item)| format!("{}: {}", Value::from(key.as_str()), inline(item)))
                .collect();
            format!("{{ {} }}", fields.join(", "))
        }
        other => other.to_string(),
    }
}

/// Writes a file so that at every moment either the old or the new content is there, whole.
///
/// # Errors
/// When the folder cannot be written to.
pub fn write_atomically(path: &Path, content: &[u8]) -> Result<(), FileError> {
    let write_error = |source| FileError::Write { path: path.to_path_buf(), source };
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let mut file = tempfile::NamedTempFile::new_in(folder).map_err(write_error)?;
    file.write_all(content).map_err(write_error)?;
    file.as_file().sync_all().map_err(write_error)?;
    set_default_permissions(file.as_file()).map_err(write_error)?;
    file.persist(path).map_err(|error| write_error(error.error))?;
    sync_folder(folder);
    Ok(())
}

/// Waits until a folder's names are on disk, where the system can say so: a new name must outlive a power cut, too.
pub(crate) fn sync_folder(folder: &Path) {
    if cfg!(unix) {
        File::open(folder).and_then(|folder| folder.sync_all()).ok();
    }
}

/// Temporary files are private to their owner; a document is readable to all, as an ordinary new file is.
#[cfg(unix)]
fn set_default_permissions(file: &std::fs::File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn set_default_permissions(_file: &std::fs::File) -> std::io::Result<()> {
    Ok(())
}

/// Writes a document as stable JSON, atomically.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_json<T: Serialize>(path: &Path, document: &T) -> Result<(), FileError> {
    write_atomically(path, to_stable_json(document).as_bytes())
}

/// SHA-256 of bytes.
pub(crate) fn hash_bytes(bytes: &[u8]) -> Hash {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// SHA-256 of a file.
///
/// # Errors
/// When the file cannot be read.
pub fn hash_file(path: &Path) -> Result<Hash, FileError> {
    let read_error = |source| FileError::Read { path: path.to_path_buf(), source };
    let mut file = open_file(path).map_err(read_error)?;
    let mut hasher = Sha256::new();
    let mut buffer = vec![0; 1 << 16];
    loop {
        let n = file.read(&mut buffer).map_err(read_error)?;
        if n == 0 {
            break;
        }
        hasher.update(&buffer[..n]);
    }
    Ok(hasher.finalize().iter().map(|byte| format!("{byte:02x}")).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn short_lists_stay_on_one_line_and_long_ones_break() {
        let short = serde_json::json!({"a": [1, 2], "b": "x"});
        assert_eq!(to_stable_json(&short), "{ \"a\": [1, 2], \"b\": \"x\" }\n");
        let long = serde_json::json!({"curve": vec![0.25; 100], "text": "y"});
        let text = to_stable_json(&long);
        assert!(text.lines().all(|line| line.len() <= LINE_WIDTH), "{text}");
        assert_eq!(serde_json::from_str::<Value>(&text).unwrap(), long);
    }

    #[test]
    fn a_failed_write_leaves_the_old_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("document.json");
        write_atomically(&path, b"old").unwrap();
        write_atomically(&path, b"new").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        let missing = folder.path().join("no-such-folder/document.json");
        assert!(write_atomically(&missing, b"x").unwrap_err().to_string().contains("no-such-folder"));
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "no temporary file stays behind");
    }
}
