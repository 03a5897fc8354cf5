//! Reading a clip: a table with `NAME_x`, `NAME_y` and perhaps `NAME_likelihood`, one row a frame.

use std::path::{Path, PathBuf};

use muybridge_capture::{BodyPoint, FileError, Hash, hash_file};

use crate::track_table::{quoted, read_bytes, rows};

use super::naming::{Landmark, NAMINGS, Naming};

/// Likelihood from which `DeepLabCut` itself draws a prediction (`pcutoff` of its configuration).
const TRUSTED_LIKELIHOOD: f64 = 0.6;
/// Largest coordinate that is believed, px.
const FARTHEST_PX: f64 = 1e6;

/// A clip that cannot be read.
#[derive(Debug, thiserror::Error)]
#[error("{}: {fault}", path.display())]
pub struct TableError {
    /// The file.
    pub path: PathBuf,
    /// What is wrong with it.
    pub fault: TableFault,
}

/// What is wrong with a table.
#[derive(Debug, thiserror::Error)]
pub enum TableFault {
    /// It cannot be opened or read.
    #[error("cannot be read ({0}); check the path and its permissions")]
    Read(#[from] std::io::Error),
    /// It changed or vanished while it was read.
    #[error(transparent)]
    Hash(#[from] FileError),
    /// It is longer than any clip.
    #[error("longer than 32 MiB; cut the film into clips")]
    TooBig,
    /// It is no table.
    #[error("no table of text ({0}); export it as CSV")]
    Table(#[from] csv::Error),
    /// There is nothing in it.
    #[error("the file is empty")]
    Empty,
    /// The points are not those of a known naming.
    #[error("its columns are not those of a known table; {naming} needs, for one, {column}")]
    UnknownNames {
        /// The naming that fits best.
        naming: &'static str,
        /// A column it needs.
        column: String,
    },
    /// A column is there twice.
    #[error("column {0} must be there once")]
    Twice(String),
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
    #[error("line {line}: frame {cell:?} does not follow the one before; every frame of the clip is needed")]
    Frame {
        /// Line of the file.
        line: u64,
        /// The cell.
        cell: String,
    },
    /// There is a header and no frame.
    #[error("there are no frames")]
    NoFrames,
}

/// Place of a point in each frame, px, y down; none where it is not seen.
pub(super) type Track = Vec<Option<[f64; 2]>>;

/// A clip's points.
#[derive(Clone, Debug)]
pub struct Clip {
    /// Name of the file.
    pub file: String,
    /// SHA-256 of the file.
    pub sha256: Hash,
    /// Whose names its points have.
    pub naming: &'static Naming,
    /// Number of frames, at least one.
    pub frames: usize,
    /// What the first column says of the first and the last frame.
    pub named_frames: [String; 2],
    /// Places that are there, but that the tracker does not trust.
    pub drop_outs: usize,
    pub(super) tracks: Vec<(Landmark, Track)>,
}

impl Clip {
    /// Reads a clip.
    ///
    /// # Errors
    /// The path and what is wrong with the file there.
    pub fn read(path: &Path) -> Result<Self, TableError> {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        // What is no file is refused before it is hashed.
        let read = || {
            let bytes = read_bytes(path)?.ok_or(TableFault::TooBig)?;
            Self::parse(name, hash_file(path)?, &bytes)
        };
        read().map_err(|fault| TableError { path: path.to_path_buf(), fault })
    }

    /// A clip from the bytes of its file.
    ///
    /// # Errors
    /// What is wrong with them.
    pub fn parse(file: String, sha256: Hash, bytes: &[u8]) -> Result<Self, TableFault> {
        let mut reader = rows(bytes);
        let mut rows = reader.records();
        let header = rows.next().ok_or(TableFault::Empty)??;
        let (naming, columns) = columns(&header)?;
        let mut tracks: Vec<(Landmark, Track)> =
            naming.points.iter().map(|(_, landmark)| (*landmark, Vec::new())).collect();
        let (mut frames, mut drop_outs, mut last) = (0, 0, None);
        let mut named_frames = [String::new(), String::new()];
        for row in rows {
            let row = row?;
            let line = row.position().map_or(0, csv::Position::line);
            if row.len() != header.len() {
                return Err(TableFault::Cells { line, found: row.len(), expected: header.len() });
            }
            let number = frame_number(&row[0]);
            if number.is_none() || last.is_some_and(|last: u64| number != last.checked_add(1)) {
                return Err(TableFault::Frame { line, cell: quoted(&row[0]) });
            }
            last = number;
            for ((_, track), columns) in tracks.iter_mut().zip(&columns) {
                let (place, trusted) = place(&row, line, *columns)?;
                drop_outs += usize::from(place.is_some() && !trusted);
                track.push(place.filter(|_| trusted));
            }
            named_frames[usize::from(frames > 0)] = quoted(&row[0]);
            frames += 1;
        }
        if frames == 0 {
            return Err(TableFault::NoFrames);
        }
        if let Some(times) = naming.poll_beyond_eye {
            poll_from_eye(&mut tracks, times);
        }
        Ok(Self { file, sha256, naming, frames, named_frames, drop_outs, tracks })
    }

    /// Track of a landmark; none that the table does not have.
    pub(super) fn track(&self, landmark: Landmark) -> Option<&Track> {
        self.tracks.iter().find(|(other, _)| *other == landmark).map(|(_, track)| track)
    }
}

/// Replaces the eye by a point that many times as far from the nose.
fn poll_from_eye(tracks: &mut [(Landmark, Track)], times: f64) {
    let find = |point| tracks.iter().position(|(landmark, _)| *landmark == Landmark::Body(point));
    let (Some(nose), Some(eye)) = (find(BodyPoint::Muzzle), find(BodyPoint::Poll)) else { return };
    for frame in 0..tracks[eye].1.len() {
        let both = tracks[nose].1[frame].zip(tracks[eye].1[frame]);
        let beyond = |(nose, eye): ([f64; 2], [f64; 2])| [0, 1].map(|i| nose[i] + times * (eye[i] - nose[i]));
        tracks[eye].1[frame] = both.map(beyond);
    }
}

/// Columns of a point: x, y, and likelihood where there is one.
type Columns = ([usize; 2], Option<usize>);

/// The naming that the header has, and the columns of its points.
fn columns(header: &csv::StringRecord) -> Result<(&'static Naming, Vec<Columns>), TableFault> {
    let missing = |naming: &Naming| {
        let names = naming.points.iter().flat_map(|(name, _)| [format!("{name}_x"), format!("{name}_y")]);
        names.filter(|name| !header.iter().any(|cell| cell == name)).collect::<Vec<_>>()
    };
    let best =
        NAMINGS.iter().map(|naming| (naming, missing(naming))).min_by_key(|(_, missing)| missing.len());
    let (naming, missing) = best.ok_or(TableFault::Empty)?;
    if let Some(column) = missing.into_iter().next() {
        return Err(TableFault::UnknownNames { naming: naming.name, column });
    }
    let column = |name: String| {
        let mut found = header.iter().enumerate().filter(|(_, cell)| *cell == name).map(|(i, _)| i);
        match (found.next(), found.next()) {
            (_, Some(_)) => Err(TableFault::Twice(name)),
            (first, None) => Ok(first),
        }
    };
    let required = |name: String| {
        let unknown = TableFault::UnknownNames { naming: naming.name, column: name.clone() };
        column(name)?.ok_or(unknown)
    };
    let of_point = |(name, _): &(&str, Landmark)| {
        let place = [required(format!("{name}_x"))?, required(format!("{name}_y"))?];
        Ok((place, column(format!("{name}_likelihood"))?))
    };
    let columns: Result<Vec<Columns>, TableFault> = naming.points.iter().map(of_point).collect();
    Ok((naming, columns?))
}

/// The number of a frame, which may stand in the name of its picture.
fn frame_number(cell: &str) -> Option<u64> {
    let stem = cell.split('.').next().unwrap_or("");
    let digits = stem.trim_start_matches(|c: char| !c.is_ascii_digit());
    digits.parse().ok()
}

/// Place of a point, and whether it is trusted; empty cells are no place.
fn place(
    row: &csv::StringRecord,
    line: u64,
    (at, likelihood): Columns,
) -> Result<(Option<[f64; 2]>, bool), TableFault> {
    let number = |column: usize, largest: f64| {
        let cell = &row[column];
        if cell.is_empty() || cell.eq_ignore_ascii_case("nan") {
            return Ok(None);
        }
        match cell.parse::<f64>() {
            Ok(value) if value.abs() <= largest => Ok(Some(value)),
            _ => Err(TableFault::Number { line, column: column + 1, cell: quoted(cell) }),
        }
    };
    let [x, y] = [number(at[0], FARTHEST_PX)?, number(at[1], FARTHEST_PX)?];
    let trusted = match likelihood {
        Some(column) => number(column, 1.0)?.is_some_and(|likelihood| likelihood >= TRUSTED_LIKELIHOOD),
        None => true,
    };
    Ok((x.zip(y).map(|(x, y)| [x, y]), trusted))
}
