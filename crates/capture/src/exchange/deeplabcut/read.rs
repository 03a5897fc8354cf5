//! Reading `DeepLabCut` tables: labels with one or three columns of path, and predictions with likelihoods.

use std::collections::BTreeSet;

use super::{OCCLUDED_FROM, VISIBLE_FROM};
use crate::annotation::{KeypointState, PlacedBy};
use crate::exchange::collect::{Collector, FoundPoint, Origin, Said, Target};
use crate::exchange::notes::{Skipped, short};
use crate::exchange::table::{Rows, number};
use crate::exchange::{ExchangeError, Format};

/// Individual of the points that belong to no animal, in projects of several.
const UNIQUE: &str = "single";

/// The header: which columns hold which point.
struct Header {
    /// Columns that name the picture: 3, or 1 in old files and predictions.
    keys: usize,
    width: usize,
    points: Vec<PointColumns>,
}

/// Columns of a point; `coords` are x, y and likelihood.
struct PointColumns {
    name: String,
    coords: [Option<usize>; 3],
}

/// Reads a table of one animal.
pub(in crate::exchange) fn read(
    file: &str,
    text: &str,
    collector: &mut Collector<'_>,
) -> Result<(), ExchangeError> {
    let folder = folder_of_plate(file, text, collector)?;
    let mut rows = Rows::new(file, text);
    let header = read_header(file, &mut rows)?;
    while let Some((place, cells)) = rows.next()? {
        if cells.len() != header.width {
            let message =
                format!("{} cells, but the header has {}; correct the row", cells.len(), header.width);
            return Err(ExchangeError::content(file, place, message));
        }
        let mut points = Vec::new();
        for columns in &header.points {
            let mut values = [None; 3];
            for (value, column) in values.iter_mut().zip(columns.coords) {
                let Some(column) = column else { continue };
                *value = number(file, &place, &columns.name, cells.get(column).unwrap_or_default())?;
            }
            points.extend(point(&columns.name, values, columns.coords[2].is_some(), collector));
        }
        let key = key(cells, header.keys);
        let target = match key.parse() {
            Ok(frame) => {
                collector.notes.remark("rows are numbered frames: frame 0 was taken for the first panel");
                Target::Frame(frame)
            }
            Err(_) if folder.as_ref().is_some_and(|folder| folder_of(&key) != folder) => {
                collector.notes.skip_many(Skipped::NoPanel, points.len(), short(folder_of(&key)));
                continue;
            }
            Err(_) => Target::Picture { name: key, size_px: None, panel: None },
        };
        collector.take(file, &place, Format::DeepLabCut, &target, points)?;
    }
    Ok(())
}

/// What names a row's picture: a path, or the number of a frame.
fn key(cells: &csv::StringRecord, keys: usize) -> String {
    cells.iter().take(keys).collect::<Vec<_>>().join("/")
}

/// The folder in a picture's path: that of the film or plate; empty for a bare name.
fn folder_of(key: &str) -> &str {
    key.rsplit(['/', '\\']).nth(1).unwrap_or_default()
}

/// The folder whose rows are this plate's, where the rows are of several.
fn folder_of_plate(
    file: &str,
    text: &str,
    collector: &mut Collector<'_>,
) -> Result<Option<String>, ExchangeError> {
    let mut rows = Rows::new(file, text);
    let keys = read_header(file, &mut rows)?.keys;
    let mut folders = BTreeSet::new();
    while let Some((_, cells)) = rows.next()? {
        folders.insert(folder_of(&key(cells, keys)).to_string());
    }
    let id = &collector.manifest.id;
    if folders.contains(id) {
        return Ok(Some(id.clone()));
    }
    if folders.len() > 1 {
        let shown: Vec<String> = folders.iter().take(5).map(|folder| short(folder)).collect();
        let message = format!(
            "the rows are of several films ({}), and none is called {id}; keep those of this plate",
            shown.join(", ")
        );
        return Err(ExchangeError::content(file, "rows", message));
    }
    if let Some(folder) = folders.first().filter(|folder| !folder.is_empty()) {
        collector
            .notes
            .remark(format!("the rows are of `{}`, and were taken for this plate's", short(folder)));
    }
    Ok(None)
}

/// A point of a row; none where there is nothing, or nothing to be believed.
fn point(
    name: &str,
    [x, y, likelihood]: [Option<f64>; 3],
    predicted: bool,
    collector: &mut Collector<'_>,
) -> Option<FoundPoint> {
    let at = match (x, y) {
        (None, None) => return None,
        (Some(x), Some(y)) if x.is_finite() && y.is_finite() => [x, y],
        _ => {
            collector.notes.skip(Skipped::NoPlace, short(name));
            return None;
        }
    };
    let said = if predicted {
        let likelihood = likelihood.unwrap_or(0.0);
        if likelihood.is_nan() || likelihood < OCCLUDED_FROM {
            collector.notes.skip(Skipped::Unlikely, short(name));
            return None;
        }
        collector.notes.remark(format!(
            "predictions were taken for tracked points: visible from a likelihood of {VISIBLE_FROM}, below it occluded"
        ));
        let visible = likelihood >= VISIBLE_FROM;
        let state = if visible { KeypointState::Visible } else { KeypointState::Occluded };
        Said { state: Some(state), by: Origin::Stated(PlacedBy::Tracked) }
    } else {
        Said { state: None, by: Origin::Unsaid }
    };
    Some(FoundPoint { name: name.to_string(), at: Some(at), said })
}

/// Reads `scorer`, `individuals` (in projects of several animals), `bodyparts` and `coords`.
fn read_header(file: &str, rows: &mut Rows<'_>) -> Result<Header, ExchangeError> {
    let wrong = |message: &str| ExchangeError::content(file, "header", message);
    rows.next()?;
    let mut levels: Vec<csv::StringRecord> = Vec::new();
    let name = |level: &csv::StringRecord| level.get(0).unwrap_or_default().to_string();
    while levels.last().is_none_or(|level| name(level) != "coords") {
        let next = rows.next()?.filter(|_| levels.len() < 3);
        let (_, cells) = next.ok_or_else(|| wrong("no row `coords`; export the table again"))?;
        levels.push(cells.clone());
    }
    let (individuals, bodyparts, coords) = match levels.as_slice() {
        [bodyparts, coords] => (None, bodyparts, coords),
        [individuals, bodyparts, coords] if name(individuals) == "individuals" => {
            (Some(individuals), bodyparts, coords)
        }
        _ => return Err(wrong("no rows `bodyparts` and `coords` after `scorer`; export the table again")),
    };
    let width = coords.len();
    if name(bodyparts) != "bodyparts" || levels.iter().any(|level| level.len() != width) {
        return Err(wrong("its rows differ in width, or `bodyparts` is missing; export the table again"));
    }
    if let Some(individuals) = individuals {
        let animals: BTreeSet<&str> =
            individuals.iter().skip(1).filter(|name| !name.is_empty() && *name != UNIQUE).collect();
        if animals.len() > 1 {
            let shown: Vec<String> = animals.iter().take(5).map(|name| short(name)).collect();
            let message = format!("{} animals ({}); keep one", animals.len(), shown.join(", "));
            return Err(ExchangeError::content(file, "individuals", message));
        }
    }
    let keys = coords.iter().skip(1).take_while(|cell| cell.is_empty()).count() + 1;
    if ![1, 3].contains(&keys) || keys >= width {
        return Err(wrong("the picture's path must be in one or in three columns, and points after it"));
    }
    Ok(Header { keys, width, points: point_columns(file, keys, bodyparts, coords)? })
}

/// The columns of each point; a point's columns stand together.
fn point_columns(
    file: &str,
    keys: usize,
    bodyparts: &csv::StringRecord,
    coords: &csv::StringRecord,
) -> Result<Vec<PointColumns>, ExchangeError> {
    let mut points: Vec<PointColumns> = Vec::new();
    for (column, (name, coord)) in bodyparts.iter().zip(coords).enumerate().skip(keys) {
        let slot = ["x", "y", "likelihood"].iter().position(|known| *known == coord).ok_or_else(|| {
            let message =
                format!("coordinate {:?} of {:?}, expected x, y or likelihood", short(coord), short(name));
            ExchangeError::content(file, format!("header, column {}", column + 1), message)
        })?;
        match points.last_mut() {
            Some(last) if last.name == name && last.coords[slot].is_none() => {
                last.coords[slot] = Some(column);
            }
            _ => {
                let mut coords = [None; 3];
                coords[slot] = Some(column);
                points.push(PointColumns { name: name.to_string(), coords });
            }
        }
    }
    Ok(points)
}
