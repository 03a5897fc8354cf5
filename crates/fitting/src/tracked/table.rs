//! The table of measured strides: a row a stride, in a fixed order and precision, so that it can be kept and compared.

use std::path::{Path, PathBuf};

use muybridge_capture::{FileError, read_text};
use muybridge_core::Limb;

use super::strides::{Flag, MeasuredStride};

/// The columns.
pub const COLUMNS: [&str; 12] = [
    "clip",
    "limb",
    "strike_s",
    "stance_s",
    "swing_s",
    "stride_s",
    "duty_factor",
    "speed_withers_heights_per_s",
    "stride_length_withers_heights",
    "frames_interpolated",
    "swaps_mended",
    "flags",
];
/// Index of the first column that holds a measured number.
const FIRST_NUMBER: usize = 2;
/// Number of such columns.
const NUMBERS: usize = 7;
/// Between two flags.
const JOINT: char = '+';

/// A table that cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// The file cannot be read.
    #[error(transparent)]
    File(#[from] FileError),
    /// It is not such a table.
    #[error("{}: {fault}", path.display())]
    Content {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        fault: TableFault,
    },
}

/// What is wrong with a table.
#[derive(Debug, thiserror::Error)]
pub enum TableFault {
    /// It is no table.
    #[error("{0}; write it again with `muybridge tracks measure`")]
    Table(#[from] csv::Error),
    /// Its first row does not name the columns.
    #[error("the first row must be {columns}", columns = COLUMNS.join(","))]
    Header,
    /// A cell holds something else than its column is for.
    #[error("line {line}: {column}: {cell:?} cannot stand there")]
    Cell {
        /// Line of the file.
        line: u64,
        /// Name of the column.
        column: &'static str,
        /// The cell.
        cell: String,
    },
    /// A stride without flags lacks a number.
    #[error("line {line}: {column} is missing, but the stride has no flag")]
    Missing {
        /// Line of the file.
        line: u64,
        /// Name of the column.
        column: &'static str,
    },
}

/// The table of strides, in their order.
///
/// # Errors
/// None in practice: writing to memory does not fail.
pub fn write_table(strides: &[MeasuredStride]) -> Result<Vec<u8>, TableFault> {
    let mut writer = csv::WriterBuilder::new().from_writer(Vec::new());
    writer.write_record(COLUMNS)?;
    for stride in strides {
        let flags: Vec<&str> = stride.flags.iter().map(|flag| flag.name()).collect();
        let mut row = vec![stride.clip.clone(), stride.limb.abbreviation().to_string()];
        row.extend(numbers(stride).map(|number| number.map(|n| format!("{n:.4}")).unwrap_or_default()));
        row.extend([stride.frames_interpolated.to_string(), stride.swaps_mended.to_string()]);
        row.push(flags.join(&JOINT.to_string()));
        writer.write_record(&row)?;
    }
    writer.into_inner().map_err(|error| TableFault::Table(error.into_error().into()))
}

/// The measured numbers in the order of their columns.
fn numbers(stride: &MeasuredStride) -> [Option<f64>; NUMBERS] {
    [
        stride.strike_s,
        stride.stance_s,
        stride.swing_s,
        stride.stride_s,
        stride.duty_factor,
        stride.speed_withers_heights_per_s,
        stride.stride_length_withers_heights,
    ]
}

/// Reads a table.
///
/// # Errors
/// With the path, the line and the column, when the file cannot be read or is no such table.
pub fn read_table(path: &Path) -> Result<Vec<MeasuredStride>, TableError> {
    let text = read_text(path)?;
    parse_table(&text).map_err(|fault| TableError::Content { path: path.to_path_buf(), fault })
}

/// The strides of a table's text.
///
/// # Errors
/// With the line and the column, when it is no such table.
pub fn parse_table(text: &str) -> Result<Vec<MeasuredStride>, TableFault> {
    let mut reader = csv::ReaderBuilder::new().from_reader(text.as_bytes());
    if reader.headers()?.iter().ne(COLUMNS) {
        return Err(TableFault::Header);
    }
    reader.records().map(|row| stride(&row?)).collect()
}

fn stride(row: &csv::StringRecord) -> Result<MeasuredStride, TableFault> {
    let line = row.position().map_or(0, csv::Position::line);
    let wrong = |column: usize| {
        let cell = row[column].chars().take(40).collect();
        TableFault::Cell { line, column: COLUMNS[column], cell }
    };
    let count = |column: usize| row[column].parse::<usize>().map_err(|_| wrong(column));
    let [limb, interpolated, swaps, flags] = [1, 9, 10, 11];
    let mut numbers = [None; NUMBERS];
    for (index, number) in numbers.iter_mut().enumerate() {
        let column = FIRST_NUMBER + index;
        if !row[column].is_empty() {
            let value: f64 = row[column].parse().map_err(|_| wrong(column))?;
            // Only the first strike may be at zero.
            let least = if index == 0 { 0.0 } else { f64::MIN_POSITIVE };
            *number = Some(value).filter(|value| value.is_finite() && *value >= least);
            number.ok_or_else(|| wrong(column))?;
        }
    }
    let flag =
        |name: &str| Flag::ALL.into_iter().find(|flag| flag.name() == name).ok_or_else(|| wrong(flags));
    let names = row[flags].split(JOINT).filter(|_| !row[flags].is_empty());
    let flags: Vec<Flag> = names.map(flag).collect::<Result<_, _>>()?;
    if let Some(index) = numbers.iter().position(Option::is_none).filter(|_| flags.is_empty()) {
        return Err(TableFault::Missing { line, column: COLUMNS[FIRST_NUMBER + index] });
    }
    let [strike_s, stance_s, swing_s, stride_s, duty_factor, speed, length] = numbers;
    Ok(MeasuredStride {
        clip: row[0].to_string(),
        limb: Limb::ALL
            .into_iter()
            .find(|known| known.abbreviation() == &row[limb])
            .ok_or_else(|| wrong(limb))?,
        strike_s,
        stance_s,
        swing_s,
        stride_s,
        duty_factor,
        speed_withers_heights_per_s: speed,
        stride_length_withers_heights: length,
        frames_interpolated: count(interpolated)?,
        swaps_mended: count(swaps)?,
        flags,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn strides() -> Vec<MeasuredStride> {
        let usable = MeasuredStride {
            strike_s: Some(0.0),
            stance_s: Some(0.7321),
            swing_s: Some(0.4),
            stride_s: Some(1.1321),
            duty_factor: Some(0.6467),
            speed_withers_heights_per_s: Some(0.9),
            stride_length_withers_heights: Some(1.0189),
            frames_interpolated: 2,
            swaps_mended: 1,
            flags: Vec::new(),
            ..MeasuredStride::refused("grey, \"quoted\"", Limb::RH, Flag::NoStance)
        };
        let cut = MeasuredStride {
            stance_s: None,
            flags: vec![Flag::CutByClip, Flag::HoofNotTracked],
            ..usable.clone()
        };
        vec![usable, cut, MeasuredStride::refused("other", Limb::LF, Flag::Standing)]
    }

    #[test]
    fn what_is_written_is_read_back() {
        let text = String::from_utf8(write_table(&strides()).unwrap()).unwrap();
        assert_eq!(parse_table(&text).unwrap(), strides());
        assert!(text.contains("other,LF,,,,,,,,0,0,standing\n"));
    }

    #[test]
    fn damaged_tables_are_errors_that_say_where() {
        let text = String::from_utf8(write_table(&strides()).unwrap()).unwrap();
        assert!(matches!(parse_table(""), Err(TableFault::Header)));
        assert!(matches!(parse_table(&text.replace("limb", "leg")), Err(TableFault::Header)));
        for (from, to, column) in [
            (",RH,", ",XX,", "limb"),
            ("0.7321", "-0.7", "stance_s"),
            ("0.6467", "much", "duty_factor"),
            ("standing", "sitting", "flags"),
            (",2,1,", ",2,one,", "swaps_mended"),
        ] {
            let fault = parse_table(&text.replacen(from, to, 1)).unwrap_err();
            assert!(matches!(fault, TableFault::Cell { column: found, .. } if found == column), "{fault}");
        }
        let missing = parse_table(&text.replacen("0.7321", "", 1)).unwrap_err();
        assert!(matches!(missing, TableFault::Missing { line: 2, column: "stance_s" }), "{missing}");
        assert!(matches!(parse_table(&text[..text.len() - 14]), Err(TableFault::Table(_))));
        assert!(matches!(read_table(Path::new("/nowhere.csv")), Err(TableError::File(_))));
    }
}
