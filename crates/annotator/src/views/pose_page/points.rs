//! Placing and moving points as changes of a draft.

use muybridge_capture::{Draft, Keypoint, KeypointState, NearOff, Placed, PlacedBy};
use muybridge_fitting::posing::{PanelPose, PanelPoser};

/// A point that moves less than this with the skeleton stays as it was placed, px: it is not touched by the drag.
const UNMOVED_PX: f64 = 0.2;

/// Puts a point where a person says.
pub(super) fn place(
    draft: &mut Draft,
    panel: u32,
    keypoint: Keypoint,
    at_px: [f64; 2],
    state: KeypointState,
) {
    let placed = Placed { at_px: Some(at_px), state, by: PlacedBy::Hand, sd_px: None };
    draft.panel_mut(panel).keypoints.insert(keypoint, placed);
}

/// Moves points with the skeleton: what the drag carries goes along, what it leaves is not touched, and points without a
/// place get the skeleton's. The handle counts as placed by hand, all others that moved as inferred.
pub(super) fn follow_skeleton(
    draft: &mut Draft,
    panel: u32,
    poser: &PanelPoser,
    [before, after]: [&PanelPose; 2],
    handle: Option<Keypoint>,
) {
    let (from, to) = (poser.keypoints_px(before), poser.keypoints_px(after));
    let keypoints = &mut draft.panel_mut(panel).keypoints;
    for keypoint in Keypoint::all() {
        let (a, b) = (from[keypoint.index()], to[keypoint.index()]);
        let moved = [b[0] - a[0], b[1] - a[1]];
        let known = keypoints.get(keypoint).copied();
        let placed = match known {
            Some(placed) if placed.state == KeypointState::Absent => continue,
            Some(placed) if handle != Some(keypoint) && moved[0].hypot(moved[1]) < UNMOVED_PX => placed,
            Some(placed) => {
                // The handle is where the skeleton's joint is; others keep their distance from theirs.
                let at = placed.at_px.filter(|_| handle != Some(keypoint)).unwrap_or(a);
                let by = if handle == Some(keypoint) { PlacedBy::Hand } else { PlacedBy::Fitted };
                Placed { at_px: Some([at[0] + moved[0], at[1] + moved[1]]), by, sd_px: None, ..placed }
            }
            None => {
                let by = if handle == Some(keypoint) { PlacedBy::Hand } else { PlacedBy::Fitted };
                Placed { at_px: Some(b), state: expected_state(keypoint), by, sd_px: None }
            }
        };
        if placed.at_px.iter().flatten().all(|v| v.is_finite()) {
            keypoints.insert(keypoint, placed);
        }
    }
}

/// Off limbs are mostly guessed until somebody says they are seen.
fn expected_state(keypoint: Keypoint) -> KeypointState {
    match keypoint {
        Keypoint::Limb(NearOff::Off, ..) => KeypointState::Occluded,
        _ => KeypointState::Visible,
    }
}
