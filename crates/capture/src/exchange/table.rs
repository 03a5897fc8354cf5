//! Comma-separated tables within bounds: rows with their line numbers, cells as numbers.

use super::ExchangeError;
use super::notes::short;

/// Most columns of a table: a hundred animals with thirty points of three numbers are 9000.
const MOST_COLUMNS: usize = 10_000;

/// The rows of a text, each with its line number.
pub(super) struct Rows<'t> {
    file: &'t str,
    reader: csv::Reader<&'t [u8]>,
    record: csv::StringRecord,
}

impl<'t> Rows<'t> {
    pub(super) fn new(file: &'t str, text: &'t str) -> Self {
        let reader = csv::ReaderBuilder::new()
            .has_headers(false)
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        Self { file, reader, record: csv::StringRecord::new() }
    }

    /// The next row that is not empty.
    pub(super) fn next(&mut self) -> Result<Option<(String, &csv::StringRecord)>, ExchangeError> {
        loop {
            let there = self.reader.read_record(&mut self.record).map_err(|error| {
                ExchangeError::content(self.file, "table", format!("{error}; export it again"))
            })?;
            if !there {
                return Ok(None);
            }
            let line = self.record.position().map_or(0, csv::Position::line);
            let place = format!("line {line}");
            if self.record.len() > MOST_COLUMNS {
                let message = format!("{} columns are too many; is it damaged?", self.record.len());
                return Err(ExchangeError::content(self.file, place, message));
            }
            if self.record.iter().any(|cell| !cell.is_empty()) {
                return Ok(Some((place, &self.record)));
            }
        }
    }
}

/// A cell's number; none when it is empty or says that there is none.
pub(super) fn number(
    file: &str,
    place: &str,
    column: &str,
    cell: &str,
) -> Result<Option<f64>, ExchangeError> {
    if cell.is_empty() || cell.eq_ignore_ascii_case("nan") || cell == "NA" {
        return Ok(None);
    }
    cell.parse().map(Some).map_err(|_| {
        let place = format!("{place}, column {}", short(column));
        let message = format!(
            "{:?} is no number; correct it or empty the cell (decimal points, no commas)",
            short(cell)
        );
        ExchangeError::content(file, place, message)
    })
}
