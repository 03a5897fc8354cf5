//! The next panel's points, ready to be looked over by a person.

use image::GrayImage;
use muybridge_capture::{Keypoint, KeypointState, LimbJoint, NearOff, Placed, PlacedBy};
use muybridge_core::Pair;

use super::figure::{BACK, JOINTS, Segment, height_plate_px};
use super::{PanelPoints, Tracked, track};
use crate::PanelView;

/// Half the width of a limb, as a share of the height at the withers.
const LIMB_HALF_WIDTH: f64 = 0.03;

/// A proposed point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Proposal {
    /// Which.
    pub keypoint: Keypoint,
    /// Where and how seen; placed by tracking.
    pub placed: Placed,
    /// As [`Tracked::quality`]; 0 for a point that is only carried along with the trunk.
    pub quality: f64,
}

/// Proposes every point that is placed in a known panel, in the order of [`Keypoint::all`]: tracked where it can be, else carried
/// along with the trunk. Panels are given as to [`track`].
///
/// Knees, hocks, fetlocks and hooves of the off side are occluded where they come to lie behind a near limb, else visible; all
/// other points are seen or not as they were.
pub fn propose(
    known: &[PanelPoints],
    next: &PanelView,
    next_silhouette: Option<&GrayImage>,
) -> Vec<Proposal> {
    let tracked = track(known, next, next_silhouette);
    let proposed = |keypoint| {
        let latest = known.iter().rev().find(|panel| panel.points.place(keypoint).is_some())?;
        let (at_px, quality) = match tracked.iter().find(|tracked| tracked.keypoint == keypoint) {
            Some(tracked) => (tracked.at_px, tracked.quality),
            None => (carried_px(latest, keypoint, next, &tracked)?, 0.0),
        };
        let was = latest.points.get(keypoint)?.state;
        let state = state(keypoint, at_px, was, &tracked, latest);
        let placed = Placed { at_px: Some(at_px), state, by: PlacedBy::Tracked, sd_px: None };
        Some(Proposal { keypoint, placed, quality })
    };
    Keypoint::all().filter_map(proposed).collect()
}

/// Where a point is if it goes with the points of the back; if none is tracked, if it stays where it is in the panel.
fn carried_px(
    panel: &PanelPoints,
    keypoint: Keypoint,
    next: &PanelView,
    tracked: &[Tracked],
) -> Option<[f64; 2]> {
    let on_back = |k: Keypoint| matches!(k, Keypoint::Body(point) if BACK.contains(&point));
    let in_next = |at_px| next.transform.panel_from_plate(at_px).map(|v| v / next.scale);
    let in_panel = |at_px| panel.view.transform.panel_from_plate(at_px).map(|v| v / panel.view.scale);
    let moves: Vec<[f64; 2]> = tracked
        .iter()
        .filter(|tracked| on_back(tracked.keypoint))
        .filter_map(|tracked| {
            let ([x, y], [u, v]) = (in_panel(panel.points.place(tracked.keypoint)?), in_next(tracked.at_px));
            Some([u - x, v - y])
        })
        .collect();
    let count = moves.len().max(1) as f64;
    let place = in_panel(panel.points.place(keypoint)?);
    let moved: [f64; 2] =
        std::array::from_fn(|axis| place[axis] + moves.iter().map(|m| m[axis]).sum::<f64>() / count);
    let at_px = next.transform.plate_from_panel(moved.map(|v| v * next.scale));
    at_px.iter().all(|v| v.is_finite()).then_some(at_px)
}

fn state(
    keypoint: Keypoint,
    at_px: [f64; 2],
    was: KeypointState,
    tracked: &[Tracked],
    panel: &PanelPoints,
) -> KeypointState {
    let Keypoint::Limb(side, _, LimbJoint::Middle | LimbJoint::Fetlock | LimbJoint::Hoof) = keypoint else {
        return was;
    };
    let half_width_px = LIMB_HALF_WIDTH * height_plate_px(panel.points).unwrap_or(0.0);
    let place = |keypoint| tracked.iter().find(|tracked| tracked.keypoint == keypoint).map(|t| t.at_px);
    let hidden = |pair: Pair| {
        JOINTS.windows(2).any(|ends| {
            let [from, to] =
                [ends[0], ends[1]].map(|joint| place(Keypoint::Limb(NearOff::Near, pair, joint)));
            let segment = from.zip(to).map(|(from, to)| Segment { from, to });
            segment.is_some_and(|segment| segment.distance(at_px) < half_width_px)
        })
    };
    if side == NearOff::Off && (hidden(Pair::Fore) || hidden(Pair::Hind)) {
        KeypointState::Occluded
    } else {
        KeypointState::Visible
    }
}
