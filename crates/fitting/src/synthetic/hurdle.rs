//! The hurdle under a leap: in the middle of the jump, as high as the hooves leave room for.

use muybridge_core::BONE_COUNT;

use super::leap::Leap;
use crate::layout::SHARED;

/// Height of the hurdle for the reference horse, m.
const HEIGHT_M: f64 = 0.9;
/// Least room between a hoof and the bar, m.
const ROOM_M: f64 = 0.06;
/// Instants at which the leap is looked at.
const LOOKS: usize = 400;

/// A bar across the track.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hurdle {
    /// Place along the track, m.
    pub x_m: f64,
    /// Height of the bar over the ground, m.
    pub height_m: f64,
}

/// The hurdle that a leap clears.
pub(super) fn hurdle_under(leap: &Leap) -> Hurdle {
    let x_m = leap.middle_x_m();
    let looks = (0..LOOKS).map(|k| leap.duration_s() * k as f64 / LOOKS as f64);
    let lowest_m = looks.map(|time_s| lowest_over_m(leap, x_m, time_s)).fold(f64::INFINITY, f64::min);
    Hurdle { x_m, height_m: (HEIGHT_M * leap.size()).min(lowest_m - ROOM_M) }
}

/// Height of the lowest part of the horse over a place of the track, m; infinite where none is.
fn lowest_over_m(leap: &Leap, x_m: f64, time_s: f64) -> f64 {
    let kinematics = leap.chain().kinematics(&leap.pose(time_s), &[0.0; SHARED]);
    let heights = (0..BONE_COUNT).filter_map(|i| {
        let [[x0, y0], [x1, y1]] = kinematics.bone(i);
        let share = (x_m - x0) / (x1 - x0);
        (0.0..=1.0).contains(&share).then_some(y0 + share * (y1 - y0))
    });
    heights.fold(f64::INFINITY, f64::min)
}
