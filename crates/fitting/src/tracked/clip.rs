//! Reading a clip: the table of a machine-tracked film, as `DeepLabCut` writes it.
//!
//! Three header rows (scorer, bodyparts, coords), then one row a frame: its number and x, y and likelihood of every
//! point; x to the right and y down from the top left of the picture, px.

#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};

use muybridge_core::Limb;

use crate::track_table::{quoted, read_bytes, rows};

/// Columns of a point.
const COORDINATES: [&str; 3] = ["x", "y", "likelihood"];

/// The points that the tracker knows, each at its own index.
pub const POINTS: [&str; 16] = [
    "Nostril",
    "Poll",
    "Withers",
    "Hip",
    "LeftKnee",
    "LeftFrontFetlock",
    "LeftFrontHoof",
    "RightKnee",
    "RightFrontFetlock",
    "RightFrontHoof",
    "LeftHock",
    "LeftHindFetlock",
    "LeftHindHoof",
    "RightHock",
    "RightHindFetlock",
    "RightHindHoof",
];
const NOSTRIL: usize = 0;
const WITHERS: usize = 2;
const HIP: usize = 3;
/// Hooves in the order of [`Limb::ALL`].
const HOOVES: [usize; 4] = [6, 9, 12, 15];

/// A clip that cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct ClipError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub fault: ClipFault,
}

/// What is wrong with a clip's file.
#[derive(Debug, thiserror::Error)]
pub enum ClipFault {
    /// It cannot be opened or read.
    #[error("cannot be read ({0}); check the path and its permissions")]
    Read(#[from] std::io::Error),
    /// It is longer than any clip.
    #[error("longer than 32 MiB; cut the film into clips")]
    TooBig,
    /// It is no table.
    #[error("no table of text ({0}); export it from DeepLabCut as CSV")]
    Table(#[from] csv::Error),
    /// There is nothing in it.
    #[error("the file is empty")]
    Empty,
    /// The header rows are missing.
    #[error(
        "the three header rows scorer, bodyparts and coords are missing; export it from DeepLabCut as CSV"
    )]
    Header,
    /// The header names a point that is not one of [`POINTS`].
    #[error("unknown point {0:?}; known are those of the walk model: {known}", known = POINTS.join(", "))]
    UnknownPoint(String),
    /// A point's x, y or likelihood is missing, or there twice.
    #[error("column {1} of point {0:?} must be there once")]
    Column(String, String),
    /// A row has more or fewer cells than the header.
    #[error("line {line}: {found} cells, but the header has {expected}; is the file cut off?")]
    Cells {
        /// Line of the file.
        line: u64,
        /// Cells of the row.
        found: usize,
        /// Cells of the header.
        expected: usize,
    },
    /// A cell holds no usable number.
    #[error("line {line}, column {column}: {cell:?} is no number that can stand there")]
    Number {
        /// Line of the file.
        line: u64,
        /// Column from 1.
        column: usize,
        /// The cell.
        cell: String,
    },
    /// Frames are missing or out of order.
    #[error("line {line}: frame {cell:?} where {expected} should follow; every frame of the film is needed")]
    Frame {
        /// Line of the file.
        line: u64,
        /// The cell.
        cell: String,
        /// The number that should be there.
        expected: usize,
    },
    /// There is a header and no frame.
    #[error("there are no frames")]
    NoFrames,
}

/// A point in one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrackedPoint {
    /// Place in the picture, px from the top left, y down.
    pub at_px: [f64; 2],
    /// The tracker's own trust, 0 to 1; 0 where the table has no number.
    pub likelihood: f64,
}

/// A machine-tracked film; frames are counted from 0 at the first row.
#[derive(Clone, Debug, PartialEq)]
pub struct Clip {
    /// Name of the file without its ending.
    pub name: String,
    /// A list of frames for each of [`POINTS`].
    tracks: Vec<Vec<TrackedPoint>>,
}

impl Clip {
    /// Reads a clip.
    ///
    /// # Errors
    /// The path and what is wrong with the file there.
    pub fn read(path: &Path) -> Result<Self, ClipError> {
        let name = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let read = || Self::parse(name, &read_bytes(path)?.ok_or(ClipFault::TooBig)?);
        read().map_err(|fault| ClipError { path: path.to_path_buf(), fault })
    }

    /// A clip from the bytes of its file.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn parse(name: String, bytes: &[u8]) -> Result<Self, ClipFault> {
        let mut reader = rows(bytes);
        let mut rows = reader.records();
        let columns = header(&mut rows)?;
        let mut tracks = vec![Vec::new(); POINTS.len()];
        for (frame, row) in rows.enumerate() {
            let row = row?;
            let line = row.position().map_or(0, csv::Position::line);
            let expected = 1 + COORDINATES.len() * POINTS.len();
            if row.len() != expected {
                return Err(ClipFault::Cells { line, found: row.len(), expected });
            }
            if row[0].parse::<f64>().ok() != Some(frame as f64) {
                return Err(ClipFault::Frame { line, cell: quoted(&row[0]), expected: frame });
            }
            for (track, columns) in tracks.iter_mut().zip(&columns) {
                track.push(point(&row, line, *columns)?);
            }
        }
        if tracks[0].is_empty() {
            return Err(ClipFault::NoFrames);
        }
        Ok(Self { name, tracks })
    }

    /// Number of frames, at least one.
    pub fn frames(&self) -> usize {
        self.tracks[0].len()
    }

    /// The nostril's track.
    pub fn nostril(&self) -> &[TrackedPoint] {
        &self.tracks[NOSTRIL]
    }

    /// The track of the withers.
    pub fn withers(&self) -> &[TrackedPoint] {
        &self.tracks[WITHERS]
    }

    /// The track of the croup, which the tracker calls hip.
    pub fn croup(&self) -> &[TrackedPoint] {
        &self.tracks[HIP]
    }

    /// The track that bears the name of a leg's hoof; it may at times follow the other leg's.
    pub fn hoof(&self, limb: Limb) -> &[TrackedPoint] {
        &self.tracks[HOOVES[limb.index()]]
    }
}

/// The columns of x, y and likelihood of every point.
fn header(
    rows: &mut impl Iterator<Item = Result<csv::StringRecord, csv::Error>>,
) -> Result<Vec<[usize; 3]>, ClipFault> {
    let mut next = |name: &str, missing: ClipFault| -> Result<csv::StringRecord, ClipFault> {
        let row = rows.next().ok_or(missing)??;
        if row.get(0) == Some(name) { Ok(row) } else { Err(ClipFault::Header) }
    };
    let scorer = next("scorer", ClipFault::Empty)?;
    let points = next("bodyparts", ClipFault::Header)?;
    let coordinates = next("coords", ClipFault::Header)?;
    if scorer.len() != points.len() || coordinates.len() != points.len() {
        return Err(ClipFault::Header);
    }
    if let Some(unknown) = points.iter().skip(1).find(|name| !POINTS.contains(name)) {
        return Err(ClipFault::UnknownPoint(quoted(unknown)));
    }
    let column = |point: &str, coordinate: &str| {
        let mut found = (1..points.len()).filter(|&i| &points[i] == point && &coordinates[i] == coordinate);
        match (found.next(), found.next()) {
            (Some(column), None) => Ok(column),
            _ => Err(ClipFault::Column(point.to_string(), coordinate.to_string())),
        }
    };
    POINTS
        .iter()
        .map(|point| {
            let [x, y, likelihood] = COORDINATES;
            Ok([column(point, x)?, column(point, y)?, column(point, likelihood)?])
        })
        .collect()
}

/// A point of a row; one whose cells are empty has likelihood 0.
fn point(row: &csv::StringRecord, line: u64, columns: [usize; 3]) -> Result<TrackedPoint, ClipFault> {
    let mut numbers = [None; 3];
    for (number, column) in numbers.iter_mut().zip(columns) {
        let cell = &row[column];
        if cell.is_empty() || cell.eq_ignore_ascii_case("nan") {
            continue;
        }
        match cell.parse::<f64>() {
            Ok(value) if value.is_finite() => *number = Some(value),
            _ => return Err(ClipFault::Number { line, column: column + 1, cell: quoted(cell) }),
        }
    }
    let likelihood = match numbers {
        [Some(_), Some(_), Some(likelihood)] => likelihood,
        _ => 0.0,
    };
    if !(0.0..=1.0).contains(&likelihood) {
        let cell = quoted(&row[columns[2]]);
        return Err(ClipFault::Number { line, column: columns[2] + 1, cell });
    }
    Ok(TrackedPoint { at_px: [numbers[0].unwrap_or(0.0), numbers[1].unwrap_or(0.0)], likelihood })
}
