//! Changes to ground lines and numbered marks, and what marks say by themselves.

use muybridge_capture::{Draft, Mark, Panel, PanelAnnotation, Position};
use muybridge_imaging::PanelTransform;

use super::defaults;

/// Least distance between the two ends of a ground line, across; the documents ask for more than 10 px.
const LEAST_GROUND_PX: f64 = 10.5;
/// Least distance between the two ends of a known length, px: a shorter one is a slip of the hand.
const LEAST_LENGTH_PX: f64 = 3.0;

/// A straight line through a panel's marks: numbers against px along the ground line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct MarkRow {
    /// Px from one mark to the next; negative when numbers rise to the left.
    pub(super) px_per_mark: f64,
    zero_along_px: f64,
    origin_px: [f64; 2],
    along: [f64; 2],
}

impl MarkRow {
    /// By least squares, as the calibration has it; none with fewer than two marks.
    pub(super) fn through(panel: &PanelAnnotation) -> Option<Self> {
        let [a, b] = panel.ground_px.unwrap_or([[0.0, 0.0], [1.0, 0.0]]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let along = [0, 1].map(|axis| (b[axis] - a[axis]) / length);
        let mut row = Self { px_per_mark: f64::NAN, zero_along_px: 0.0, origin_px: a, along };
        let points: Vec<(f64, f64)> = panel.marks.iter().map(|m| (m.mark, row.along_px(m.at_px))).collect();
        let n = points.len() as f64;
        let (mean_x, mean_y) = points.iter().fold((0.0, 0.0), |(sx, sy), (x, y)| (sx + x / n, sy + y / n));
        let sxx: f64 = points.iter().map(|(x, _)| (x - mean_x).powi(2)).sum();
        let sxy: f64 = points.iter().map(|(x, y)| (x - mean_x) * (y - mean_y)).sum();
        row.px_per_mark = sxy / sxx;
        row.zero_along_px = mean_y - row.px_per_mark * mean_x;
        (points.len() >= 2 && row.px_per_mark.is_finite() && row.px_per_mark != 0.0).then_some(row)
    }

    fn along_px(&self, at_px: [f64; 2]) -> f64 {
        (0..2).map(|axis| (at_px[axis] - self.origin_px[axis]) * self.along[axis]).sum()
    }

    /// The number that a mark at this place would have.
    pub(super) fn number_at(&self, at_px: [f64; 2]) -> f64 {
        (self.along_px(at_px) - self.zero_along_px) / self.px_per_mark
    }
}

/// Draws a panel's ground line; false when the two points are too close to each other.
pub(super) fn set_ground(draft: &mut Draft, panel: u32, [a, b]: [[f64; 2]; 2]) -> bool {
    let ends = if a[0] <= b[0] { [a, b] } else { [b, a] };
    let good = ends[1][0] - ends[0][0] >= LEAST_GROUND_PX;
    if good {
        draft.panel_mut(panel).ground_px = Some(ends);
    }
    good
}

/// Makes a known length of the line between two points: marks 0 and 1 and no others. False when they are too close.
pub(super) fn set_length(draft: &mut Draft, panel: u32, ends: [[f64; 2]; 2]) -> bool {
    let [a, b] = ends;
    let good = (b[0] - a[0]).hypot(b[1] - a[1]) >= LEAST_LENGTH_PX;
    if good {
        let mark = |(number, at_px)| Mark { mark: number, at_px };
        draft.panel_mut(panel).marks = [0.0, 1.0].into_iter().zip(ends).map(mark).collect();
        let calibration = draft.manifest.calibration.get_or_insert_with(|| {
            use muybridge_capture::{ScaleSource, TimeSource};
            defaults::calibration(ScaleSource::KnownLength, Position::FixedCamera, TimeSource::Interval)
        });
        calibration.scale.known_length.get_or_insert_with(defaults::known_length);
    }
    good
}

/// The number of the mark that is placed next: one more than the greatest of the panel, else the first.
pub(super) fn next_number(panel: Option<&PanelAnnotation>, first: f64) -> f64 {
    let numbers = panel.into_iter().flat_map(|panel| &panel.marks).map(|mark| mark.mark);
    numbers.reduce(f64::max).map_or(first, |greatest| greatest + 1.0)
}

/// Indices of a panel's marks from left to right.
fn from_the_left(panel: &PanelAnnotation) -> Vec<usize> {
    let mut order: Vec<usize> = (0..panel.marks.len()).collect();
    order.sort_by(|a, b| panel.marks[*a].at_px[0].total_cmp(&panel.marks[*b].at_px[0]));
    order
}

/// Numbers a panel's marks from the left, one by one.
pub(super) fn renumber(draft: &mut Draft, panel: u32, first: f64) {
    let panel = draft.panel_mut(panel);
    for (number, index) in from_the_left(panel).into_iter().enumerate() {
        panel.marks[index].mark = first + number as f64;
    }
    panel.marks.sort_by(|a, b| a.mark.total_cmp(&b.mark));
}

/// Panels of the same image whose middle is at the height of this one's.
pub(super) fn same_row(draft: &Draft, panel: u32) -> Vec<u32> {
    let place = |number: u32| draft.manifest.panels.iter().find(|p| p.panel == number);
    let Some(from) = place(panel) else { return Vec::new() };
    let half = 0.5 * (from.quad_px[3][1] - from.quad_px[0][1]).abs();
    let beside = |other: &&Panel| {
        other.panel != panel
            && other.image == from.image
            && (other.centre_px()[1] - from.centre_px()[1]).abs() < half
    };
    draft.manifest.panels.iter().filter(beside).map(|other| other.panel).collect()
}

/// All other panels.
pub(super) fn others(draft: &Draft, panel: u32) -> Vec<u32> {
    draft.manifest.panels.iter().map(|p| p.panel).filter(|number| *number != panel).collect()
}

/// Takes a place of one panel to the same place of another, by their corners.
fn to_panel(draft: &Draft, from: u32, to: u32) -> Option<impl Fn([f64; 2]) -> [f64; 2] + use<>> {
    let transform = |number: u32| {
        let panel = draft.manifest.panels.iter().find(|p| p.panel == number)?;
        PanelTransform::new(panel.quad_px, [1.0, 1.0])
    };
    let (from, to) = (transform(from)?, transform(to)?);
    Some(move |at_px| to.plate_from_panel(from.panel_from_plate(at_px)))
}

/// Copies a panel's ground line to others, at the same place of each; `replace` also where one is drawn.
pub(super) fn copy_ground(draft: &mut Draft, from: u32, targets: &[u32], replace: bool) {
    let Some(line) = draft.panel(from).and_then(|panel| panel.ground_px) else { return };
    for to in targets {
        let bare = draft.panel(*to).is_none_or(|panel| panel.ground_px.is_none());
        if let Some(place) = to_panel(draft, from, *to).filter(|_| bare || replace) {
            set_ground(draft, *to, line.map(place));
        }
    }
}

/// By how much the numbers of marks rise from one panel to the next at the same place of the picture: the camera moved on.
fn numbers_per_panel(draft: &Draft, row: Option<MarkRow>) -> f64 {
    let Some(calibration) = &draft.manifest.calibration else { return 0.0 };
    let facing = draft.manifest.facing.map_or(1.0, muybridge_capture::Facing::sign);
    match (&calibration.position, &calibration.scale.known_length) {
        (Position::CameraSpacing { spacing_m, .. }, Some(length)) => {
            let sign = row.map_or(1.0, |row| row.px_per_mark.signum());
            facing * sign * spacing_m.value / length.mark_spacing_m.value
        }
        _ => 0.0,
    }
}

/// Copies a panel's marks to the panels that have fewer than two, at the same place of each: the scale is taken to be the
/// same. With a row of cameras the numbers go on as the cameras do, so that positions stay right. How many panels took them.
pub(super) fn copy_marks(draft: &mut Draft, from: u32, targets: &[u32]) -> usize {
    let Some(source) = draft.panel(from).cloned() else { return 0 };
    let step = numbers_per_panel(draft, MarkRow::through(&source));
    let mut taken = 0;
    for to in targets {
        let bare = draft.panel(*to).is_none_or(|panel| panel.marks.len() < 2);
        let Some(place) = to_panel(draft, from, *to).filter(|_| bare) else { continue };
        let shift = step * (f64::from(*to) - f64::from(from));
        let copied = |mark: &Mark| Mark { mark: tidy(mark.mark + shift), at_px: place(mark.at_px) };
        draft.panel_mut(*to).marks = source.marks.iter().map(copied).collect();
        taken += 1;
    }
    taken
}

/// A number of a mark without digits that mean nothing: to a ten-thousandth of the distance between marks.
fn tidy(number: f64) -> f64 {
    (1e4 * number).round() / 1e4
}

/// Numbers the marks of all other panels so that the same upright has the same number as in this one: each where it must be
/// seen after the cameras have moved on, to the nearest whole. How many panels were numbered.
pub(super) fn number_alike(draft: &mut Draft, from: u32) -> usize {
    let Some(row) = draft.panel(from).and_then(MarkRow::through) else { return 0 };
    let base = draft.panel(from).and_then(|panel| panel.marks.first()).map_or(0.0, |mark| mark.mark);
    let step = numbers_per_panel(draft, Some(row));
    let mut numbered = 0;
    for to in others(draft, from) {
        let Some(panel) = draft.panel(to).filter(|panel| !panel.marks.is_empty()).cloned() else { continue };
        let Some(back) = to_panel(draft, to, from) else { continue };
        let shift = step * (f64::from(to) - f64::from(from));
        let due: Vec<f64> = panel.marks.iter().map(|m| row.number_at(back(m.at_px)) + shift).collect();
        let apart: Vec<f64> = due.iter().map(|number| (number - due[0]).round()).collect();
        let off = due.iter().zip(&apart).map(|(due, apart)| due - apart).sum::<f64>() / due.len() as f64;
        let start = base + (off - base).round();
        for (mark, apart) in draft.panel_mut(to).marks.iter_mut().zip(&apart) {
            mark.mark = start + apart;
        }
        numbered += 1;
    }
    numbered
}

/// Takes uprights over as marks where they cross the ground line, or at their feet where none is drawn: in the panels with
/// fewer than two marks, numbered from the left. How many panels took them.
pub(super) fn take_uprights(draft: &mut Draft, found: &[(u32, Vec<[[f64; 2]; 2]>)], first: f64) -> usize {
    let mut taken = 0;
    for (number, uprights) in found {
        let panel = draft.panel_mut(*number);
        if panel.marks.len() >= 2 || uprights.is_empty() {
            continue;
        }
        let ground = panel.ground_px;
        let foot = |line: &[[f64; 2]; 2]| ground.and_then(|g| crossing(*line, g)).unwrap_or(line[1]);
        let feet = uprights.iter().map(foot).filter(|at| at.iter().all(|v| v.is_finite()));
        panel.marks = feet.map(|at_px| Mark { mark: 0.0, at_px }).collect();
        renumber(draft, *number, first);
        taken += 1;
    }
    taken
}

/// Where two straight lines cross; none when they are parallel.
fn crossing([p, q]: [[f64; 2]; 2], [a, b]: [[f64; 2]; 2]) -> Option<[f64; 2]> {
    let (d, e) = ([q[0] - p[0], q[1] - p[1]], [b[0] - a[0], b[1] - a[1]]);
    let cross = d[0] * e[1] - d[1] * e[0];
    let share = ((a[0] - p[0]) * e[1] - (a[1] - p[1]) * e[0]) / cross;
    let at = [p[0] + share * d[0], p[1] + share * d[1]];
    at.iter().all(|v| v.is_finite()).then_some(at)
}

#[cfg(test)]
mod tests;
