//! How trunk and neck are carried over the legs.

use muybridge_core::bone;

use super::legs::PoseVector;
use crate::chain::Chain;
use crate::layout::{BENDS, PANEL_DOF, PITCH, SLIDES};

/// Rounding the loins tucks the croup under by this share of it; the back before it drops by the rest.
const TUCK: f64 = 0.6;
/// Shares of the two joints behind the saddle in the rounding, and of the three of the neck in its raising.
const LOINS: [f64; 2] = [0.6, 0.4];
const NECK: [f64; 3] = [0.6, 0.25, 0.15];

/// The pose in which every joint is at rest, at the origin.
pub(super) fn resting(chain: &Chain) -> PoseVector {
    let mut pose = [0.0; PANEL_DOF];
    pose[BENDS..SLIDES].copy_from_slice(&chain.rest_rad);
    pose
}

/// Rounds the loins by an angle, rad.
pub(super) fn round_loins(pose: &mut PoseVector, rounding_rad: f64) {
    pose[PITCH] += TUCK * rounding_rad;
    for (i, share) in LOINS.into_iter().enumerate() {
        pose[BENDS + bone::SPINE + i] -= share * rounding_rad;
    }
    // The neck keeps its direction.
    pose[BENDS + bone::NECK] += (1.0 - TUCK) * rounding_rad;
}

/// Raises the neck by an angle, rad.
pub(super) fn raise_neck(pose: &mut PoseVector, raise_rad: f64) {
    for (i, share) in NECK.into_iter().enumerate() {
        pose[BENDS + bone::NECK + i] += share * raise_rad;
    }
}
