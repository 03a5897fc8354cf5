//! Changes to the panels of a plate, their order and their ground lines.

use muybridge_capture::{Draft, Keypoint, Panel};

/// The same point of the other side; points of the trunk have none and stay.
pub fn other_side(keypoint: Keypoint) -> Keypoint {
    use muybridge_capture::NearOff::{Near, Off};
    match keypoint {
        Keypoint::Body(_) => keypoint,
        Keypoint::Limb(Near, pair, joint) => Keypoint::Limb(Off, pair, joint),
        Keypoint::Limb(Off, pair, joint) => Keypoint::Limb(Near, pair, joint),
    }
}

/// Takes found panels over, numbered in reading order. Panels that were there are replaced; points stay where they are.
pub fn take_found(draft: &mut Draft, found: Vec<Panel>) {
    draft.manifest.panels = found;
    span_all(draft);
}

/// Takes found ground lines over where none is drawn.
pub fn take_ground(draft: &mut Draft, lines: &[(u32, [[f64; 2]; 2])]) {
    for (panel, line) in lines {
        let ground_px = &mut draft.panel_mut(*panel).ground_px;
        if ground_px.is_none() && line.iter().flatten().all(|v| v.is_finite()) {
            *ground_px = Some(*line);
        }
    }
}

/// The stride goes from the first to the last panel.
fn span_all(draft: &mut Draft) {
    let numbers = || draft.manifest.panels.iter().map(|panel| panel.panel);
    let (first, last) = (numbers().min().unwrap_or(1), numbers().max().unwrap_or(1));
    (draft.annotation.stride.first, draft.annotation.stride.last) = (first, last);
}

/// Adds a panel after the last: of its size, beside it, or below when there is no room; else in the middle.
pub fn add(draft: &mut Draft) {
    let manifest = &mut draft.manifest;
    let Some(image) = manifest.images.first() else { return };
    let size = [f64::from(image.width_px), f64::from(image.height_px)];
    let number = manifest.panels.iter().map(|panel| panel.panel).max().unwrap_or(0) + 1;
    let middle = [0.3, 0.7].map(|share| [share * size[0], share * size[1]]);
    let in_the_middle = [middle[0], [middle[1][0], middle[0][1]], middle[1], [middle[0][0], middle[1][1]]];
    let fits = |quad: &[[f64; 2]; 4]| quad.iter().all(|[x, y]| *x <= size[0] && *y <= size[1]);
    let quad_px = match manifest.panels.last() {
        None => in_the_middle,
        Some(last) => {
            let width = last.quad_px[1][0] - last.quad_px[0][0];
            let height = last.quad_px[3][1] - last.quad_px[0][1];
            let shifted = |dx: f64, dy: f64| last.quad_px.map(|[x, y]| [x + dx, y + dy]);
            let places = [shifted(1.05 * width, 0.0), shifted(0.0, 1.05 * height)];
            places.into_iter().find(fits).unwrap_or(in_the_middle)
        }
    };
    let image = manifest.panels.last().map_or(0, |panel| panel.image);
    manifest.panels.push(Panel { panel: number, image, quad_px });
    span_all(draft);
}

/// Deletes a panel and what is marked on it; the panels after it keep their numbers.
pub fn delete(draft: &mut Draft, panel: u32) {
    draft.manifest.panels.retain(|p| p.panel != panel);
    draft.annotation.panels.retain(|p| p.panel != panel);
    span_all(draft);
}

/// Gives the panels another order; `order` lists indices into the present one. What is marked goes with its photograph.
fn reorder(draft: &mut Draft, order: &[usize]) {
    let before = draft.manifest.panels.clone();
    let numbers: Vec<u32> = before.iter().map(|panel| panel.panel).collect();
    draft.manifest.panels = order
        .iter()
        .zip(&numbers)
        .map(|(from, number)| Panel { panel: *number, ..before[*from].clone() })
        .collect();
    for panel in &mut draft.annotation.panels {
        let from = numbers.iter().position(|number| *number == panel.panel);
        if let Some(to) = from.and_then(|from| order.iter().position(|at| *at == from)) {
            panel.panel = numbers[to];
        }
    }
    draft.annotation.panels.sort_by_key(|panel| panel.panel);
}

/// Moves a panel earlier or later; its new number.
pub fn moved(draft: &mut Draft, panel: u32, steps: i64) -> u32 {
    let mut order: Vec<usize> = (0..draft.manifest.panels.len()).collect();
    let Some(at) = draft.manifest.panels.iter().position(|p| p.panel == panel) else { return panel };
    let to = (at as i64 + steps).clamp(0, order.len() as i64 - 1) as usize;
    order.swap(at, to);
    reorder(draft, &order);
    draft.manifest.panels[to].panel
}

/// The last panel becomes the first.
pub fn reverse(draft: &mut Draft) {
    let order: Vec<usize> = (0..draft.manifest.panels.len()).rev().collect();
    reorder(draft, &order);
}

/// Rows that were read from left to right are read from right to left, and the other way round.
pub fn mirror_rows(draft: &mut Draft) {
    let panels = &draft.manifest.panels;
    let in_row = |a: &Panel, b: &Panel| {
        let height = a.quad_px[3][1] - a.quad_px[0][1];
        a.image == b.image && (a.centre_px()[1] - b.centre_px()[1]).abs() < 0.5 * height.abs()
    };
    let mut order: Vec<usize> = Vec::new();
    let mut start = 0;
    while start < panels.len() {
        let length = panels[start..].iter().take_while(|panel| in_row(&panels[start], panel)).count().max(1);
        order.extend((start..start + length).rev());
        start += length;
    }
    reorder(draft, &order);
}

#[cfg(test)]
mod tests {
    use muybridge_capture::{Document, KeypointState, Placed, PlacedBy};

    use super::*;

    fn specimen() -> Draft {
        let path =
            concat!(env!("CARGO_MANIFEST_DIR"), "/../../plates/specimens/annotations/specimen-gallop.json");
        Document::open(std::path::Path::new(path), None).unwrap().draft().clone()
    }

    #[test]
    fn points_go_with_their_photographs_whatever_the_order() {
        let draft = specimen();
        let stay_inside = |draft: &Draft| {
            draft.annotation.panels.iter().all(|panel| {
                let place = draft.manifest.panels.iter().find(|p| p.panel == panel.panel).unwrap();
                panel.keypoints.iter().all(|(_, point)| place.contains(point.at_px.unwrap(), 12.0))
            })
        };
        let mut changed = draft.clone();
        reverse(&mut changed);
        assert!(stay_inside(&changed) && changed != draft);
        mirror_rows(&mut changed);
        assert!(stay_inside(&changed));
        let number = moved(&mut changed, 3, -1);
        assert!(number == 2 && stay_inside(&changed));
        moved(&mut changed, 2, 1);
        mirror_rows(&mut changed);
        reverse(&mut changed);
        assert_eq!(changed, draft);
    }

    #[test]
    fn mirroring_reads_every_row_from_the_other_end() {
        let mut draft = specimen();
        let x = |draft: &Draft, number: u32| {
            draft.manifest.panels.iter().find(|p| p.panel == number).unwrap().centre_px()[0]
        };
        let (first, fourth) = (x(&draft, 1), x(&draft, 4));
        mirror_rows(&mut draft);
        assert!((x(&draft, 1) - fourth).abs() < 1.0 && (x(&draft, 4) - first).abs() < 1.0);
    }

    #[test]
    fn panels_are_added_beside_the_last_and_deleted_with_their_points() {
        let mut draft = specimen();
        let count = draft.manifest.panels.len();
        add(&mut draft);
        let new = draft.manifest.panels.last().unwrap().clone();
        assert_eq!((draft.manifest.panels.len(), draft.annotation.stride.last), (count + 1, new.panel));
        let at_px = Some(new.centre_px());
        let placed = Placed { at_px, state: KeypointState::Visible, by: PlacedBy::Hand, sd_px: None };
        draft.panel_mut(new.panel).keypoints.insert(Keypoint::all().next().unwrap(), placed);
        delete(&mut draft, new.panel);
        assert!(draft.panel(new.panel).is_none() && draft.manifest.panels.len() == count);
        draft.manifest.panels.clear();
        add(&mut draft);
        assert_eq!(draft.manifest.panels[0].panel, 1);
    }
}
