//! What reading tracks from a table has in common, whoever wrote the table.

use std::fs::File;
use std::io::{Error, Read};
use std::path::Path;

/// Longest table that is read, bytes: an hour of film at 15 frames/s has 22 MB.
pub(crate) const MOST_BYTES: u64 = 32 * 1024 * 1024;
/// Longest piece of a damaged table that a message repeats, characters.
const LONGEST_QUOTE: usize = 40;

/// The bytes of a table; none when it is longer than 32 MiB.
///
/// # Errors
/// When it is no file or cannot be read. Pipes and devices could be waited for, or read, for ever.
pub(crate) fn read_bytes(path: &Path) -> Result<Option<Vec<u8>>, Error> {
    if !std::fs::metadata(path)?.is_file() {
        return Err(Error::other("not a file"));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST_BYTES + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= MOST_BYTES).then_some(bytes))
}

/// A reader of rows whose lengths the caller checks, header included.
pub(crate) fn rows(bytes: &[u8]) -> csv::Reader<&[u8]> {
    csv::ReaderBuilder::new().has_headers(false).flexible(true).trim(csv::Trim::All).from_reader(bytes)
}

/// The beginning of a cell, for a message.
pub(crate) fn quoted(cell: &str) -> String {
    cell.chars().take(LONGEST_QUOTE).collect()
}
