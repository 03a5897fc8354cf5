//! Our own table: one point a row, in plate px. Reads and writes all that a placed point has.

use super::collect::{Collector, FoundPoint, Origin, Said, Target};
use super::notes::{Skipped, short};
use super::table::{Rows, number};
use super::{ExchangeError, Format};
use crate::annotation::{Annotation, KeypointState, PlacedBy};
use crate::manifest::Manifest;

/// The columns, in the order in which they are written; the first four must be there, in any order.
const COLUMNS: [&str; 6] = ["panel", "keypoint", "x_px", "y_px", "state", "by"];
const NEEDED: usize = 4;

const STATES: [(&str, KeypointState); 3] = [
    ("visible", KeypointState::Visible),
    ("occluded", KeypointState::Occluded),
    ("absent", KeypointState::Absent),
];

const PROVENANCES: [(&str, PlacedBy); 4] = [
    ("hand", PlacedBy::Hand),
    ("interpolated", PlacedBy::Interpolated),
    ("tracked", PlacedBy::Tracked),
    ("fitted", PlacedBy::Fitted),
];

/// The file of all entries, absent ones too.
pub(super) fn write(manifest: &Manifest, annotation: &Annotation) -> Vec<(String, Vec<u8>)> {
    let mut text = format!("{}\n", COLUMNS.join(","));
    for panel in &annotation.panels {
        for (keypoint, placed) in panel.keypoints.iter() {
            let [x, y] = placed.place().map_or_else(Default::default, |at| at.map(|v| v.to_string()));
            let (number, state, by) = (panel.panel, state_name(placed.state), provenance_name(placed.by));
            text.push_str(&format!("{number},{keypoint},{x},{y},{state},{by}\n"));
        }
    }
    vec![(format!("{}.csv", manifest.id), text.into_bytes())]
}

fn state_name(state: KeypointState) -> &'static str {
    STATES.iter().find(|(_, known)| *known == state).map_or("", |(name, _)| name)
}

/// Name of a provenance, as in our files.
pub(super) fn provenance_name(by: PlacedBy) -> &'static str {
    PROVENANCES.iter().find(|(_, known)| *known == by).map_or("", |(name, _)| name)
}

/// A provenance by its name.
pub(super) fn provenance(name: &str) -> Option<PlacedBy> {
    PROVENANCES.iter().find(|(known, _)| known.eq_ignore_ascii_case(name.trim())).map(|(_, by)| *by)
}

/// Reads a table.
pub(super) fn read(file: &str, text: &str, collector: &mut Collector<'_>) -> Result<(), ExchangeError> {
    let mut rows = Rows::new(file, text);
    let Some((_, header)) = rows.next()? else { return Ok(()) };
    let width = header.len();
    let columns = columns(file, header)?;
    while let Some((place, row)) = rows.next()? {
        if row.len() != width {
            let message = format!("{} cells, but the header has {width}; correct the row", row.len());
            return Err(ExchangeError::content(file, place, message));
        }
        let cell = |column: usize| columns[column].and_then(|i| row.get(i)).unwrap_or_default();
        let panel: u32 = cell(0).parse().map_err(|_| {
            let message = format!("{:?} is no panel number; correct it", short(cell(0)));
            ExchangeError::content(file, format!("{place}, column panel"), message)
        })?;
        let place_px = [number(file, &place, "x_px", cell(2))?, number(file, &place, "y_px", cell(3))?];
        let state = match STATES.iter().find(|(name, _)| name.eq_ignore_ascii_case(cell(4))) {
            Some((_, state)) => Some(*state),
            None if cell(4).is_empty() => None,
            None => {
                collector.notes.skip(Skipped::UnknownState, short(cell(4)));
                continue;
            }
        };
        let at = match (place_px, state) {
            (_, Some(KeypointState::Absent)) => None,
            ([Some(x), Some(y)], _) if x.is_finite() && y.is_finite() => Some([x, y]),
            _ => {
                collector.notes.skip(Skipped::NoPlace, place);
                continue;
            }
        };
        let by = provenance(cell(5)).map_or(Origin::Unsaid, Origin::Stated);
        let point = FoundPoint { name: cell(1).into(), at, said: Said { state, by } };
        collector.take(file, &place, Format::Csv, &Target::Panel(panel), vec![point])?;
    }
    Ok(())
}

/// Where the header has each of our columns.
fn columns(file: &str, header: &csv::StringRecord) -> Result<[Option<usize>; COLUMNS.len()], ExchangeError> {
    let columns = COLUMNS.map(|name| header.iter().position(|cell| cell.eq_ignore_ascii_case(name)));
    if let Some(missing) = (0..NEEDED).find(|i| columns[*i].is_none()) {
        let message = format!(
            "no column `{}`; needed are {}, separated by commas",
            COLUMNS[missing],
            COLUMNS[..NEEDED].join(", ")
        );
        return Err(ExchangeError::content(file, "line 1", message));
    }
    Ok(columns)
}
