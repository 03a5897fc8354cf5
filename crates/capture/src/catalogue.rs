//! The catalogue of plates: which there are, what they show, and where each can be had.

use std::path::Path;

use muybridge_core::Gait;
use serde::Deserialize;

use crate::files::{FileError, read_text};

/// Schema version of a catalogue file.
pub const CATALOGUE_SCHEMA: u32 = 1;

/// How an address may begin: encrypted, or never leaving this computer.
const ADDRESSES: [&str; 4] = ["https://", "http://localhost:", "http://127.0.0.1:", "http://[::1]:"];

/// A catalogue of plates, in the order of their numbers.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Catalogue {
    /// [`CATALOGUE_SCHEMA`].
    pub schema: u32,
    /// Who holds the originals.
    pub holder: String,
    /// Licence or rights statement.
    pub licence: String,
    /// The plates.
    #[serde(rename = "plate")]
    pub plates: Vec<CataloguePlate>,
}

/// One plate of the catalogue.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CataloguePlate {
    /// Plate number in *Animal Locomotion*.
    pub number: u32,
    /// The animal's name.
    pub animal: String,
    /// What it does, as titled.
    pub action: String,
    /// The gait of the title.
    pub gait: Gait,
    /// Base address of the plate's IIIF Image API service.
    pub iiif: String,
    /// The holder's own number of the object.
    pub object_id: u64,
}

impl Catalogue {
    /// Reads a catalogue file (TOML).
    ///
    /// # Errors
    /// When the file cannot be read, is no such catalogue, has another schema, or lists plates out of order, twice, or
    /// with an address that is not `https`.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let text = read_text(path)?;
        let parse_error =
            |field: String, message: String| FileError::Parse { path: path.to_path_buf(), field, message };
        let catalogue: Self = toml::from_str(&text)
            .map_err(|error| parse_error("catalogue".into(), error.to_string().trim().replace('\n', " ")))?;
        if catalogue.schema != CATALOGUE_SCHEMA {
            let (found, path) = (u64::from(catalogue.schema), path.to_path_buf());
            return Err(FileError::Schema { path, found, expected: CATALOGUE_SCHEMA });
        }
        let mut last = 0;
        for plate in &catalogue.plates {
            let fault = if plate.number <= last {
                "numbers must rise without repeats"
            } else if !ADDRESSES.iter().any(|start| plate.iiif.starts_with(start)) {
                "iiif must be an https address, or an http one on this computer"
            } else {
                last = plate.number;
                continue;
            };
            return Err(parse_error(format!("plate {}", plate.number), fault.into()));
        }
        Ok(catalogue)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str) -> Result<Catalogue, FileError> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("catalogue.toml");
        crate::files::write_atomically(&path, text.as_bytes()).unwrap();
        Catalogue::read(&path)
    }

    const HEAD: &str = "schema = 1\nholder = \"h\"\nlicence = \"l\"\n";

    fn plate(number: u32, address: &str) -> String {
        format!(
            "[[plate]]\nnumber = {number}\nanimal = \"a\"\naction = \"trotting\"\ngait = \"trot\"\niiif = \"{address}\"\nobject_id = 1\n"
        )
    }

    #[test]
    fn plates_are_read_in_order() {
        let text = format!("{HEAD}{}{}", plate(5, "https://a"), plate(7, "https://b"));
        let numbers: Vec<u32> = read(&text).unwrap().plates.iter().map(|p| p.number).collect();
        assert_eq!(numbers, [5, 7]);
    }

    #[test]
    fn faults_name_file_and_plate() {
        let cases = [
            (format!("{HEAD}{}{}", plate(7, "https://a"), plate(7, "https://b")), "plate 7"),
            (format!("{HEAD}{}", plate(7, "ftp://a")), "https"),
            (format!("{HEAD}{}", plate(7, "https://a").replace("trot\"", "prance\"")), "prance"),
            (HEAD.replace('1', "9") + &plate(7, "https://a"), "version 9"),
            (String::new(), "empty"),
        ];
        for (text, expected) in cases {
            let error = read(&text).unwrap_err().to_string();
            assert!(error.contains("catalogue.toml") && error.contains(expected), "{error}");
        }
    }
}
