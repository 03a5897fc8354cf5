//! A foot on its print: flat, or on its toes.

use std::f64::consts::{PI, TAU};

use glam::{DQuat, DVec2, DVec3};

use super::{Biped, FootNow, FootPlace, ankle_from_toe};
use crate::orientation::smooth;
use crate::placed::PlacedPrint;
use crate::pose::FootState;

/// Longest time in which a heel rises by itself at the end of a stance, s: some two fifths of a slow walk's stance. One who stands for
/// long and then walks off does not rise for half of that time.
const LONGEST_RISE_S: f64 = 0.4;
/// The heel rises by itself as far as the model says when the hip is ahead of the ankle by this share of the comfortable leg or more:
/// half of a walking step. On the spot and backwards it does not.
const FULL_STEP: f64 = 0.3;
/// The heel rises no closer than this to where the ankle is nearest to the hip, radians: the last of the rise brings the ankle hardly
/// any nearer (6 mm in a human), and the foot would turn in a moment as the hip comes up to one that lands far ahead.
const LEFT_RAD: f64 = 0.25;

impl Biped<'_> {
    /// The foot on its print under a hip at a time of its stance, s.
    ///
    /// The heel rises as far as the leg needs to be no longer than its longest, or as far as toe-off asks for, whichever is more. What
    /// is missing even so the whole foot is raised from its print.
    pub(super) fn planted(&self, print: &PlacedPrint, hip: DVec3, time_s: f64) -> FootNow {
        let (leg, lever) = (&self.model.leg, ankle_from_toe(self.model));
        let toe = print.middle + print.world_from_foot * DVec3::X * leg.foot.toe_ahead_m;
        let hip_from_toe = print.world_from_foot.inverse() * (hip - toe);
        let most_rad = leg.foot.most_heel_rise_deg.to_radians();
        let (needed_rad, useful_rad) = rise(hip_from_toe, lever, leg.longest_m);
        let wanted_rad = self.toe_off_rad(print, hip_from_toe.x - lever.x, time_s);
        let rise_rad = needed_rad.max(wanted_rad).min(useful_rad).min(most_rad);
        let world_from_foot = print.world_from_foot * DQuat::from_rotation_z(-rise_rad);
        let place = FootPlace { toe, world_from_foot };
        let to_hip = hip - place.ankle(self.model);
        let miss_m = (to_hip.length() - leg.longest_m).max(0.0);
        let place = FootPlace { toe: toe + to_hip.normalize_or_zero() * miss_m, ..place };
        let state = if rise_rad > 0.0 { FootState::OnToes { rise_rad } } else { FootState::Flat };
        FootNow { place, state, miss_m }
    }

    /// How far the heel rises by itself at a time, with the hip so far ahead of the ankle, radians.
    fn toe_off_rad(&self, print: &PlacedPrint, hip_ahead_m: f64, time_s: f64) -> f64 {
        let leg = &self.model.leg;
        if print.lift_off_s >= self.placed.end_s {
            return 0.0;
        }
        let rise_s = ((1.0 - leg.foot.heel_off_at) * (print.lift_off_s - print.strike_s)).min(LONGEST_RISE_S);
        let share = 1.0 - (print.lift_off_s - time_s) / rise_s;
        let step = smooth(hip_ahead_m / (FULL_STEP * leg.nominal_m));
        // Where the stance has no time to rise in, the share is no number, and nothing rises.
        let risen = smooth(share);
        if risen.is_nan() { 0.0 } else { leg.foot.toe_off_rise_deg.to_radians() * risen * step }
    }
}

/// Heel rise at which the leg is at its longest or shorter, and the most that is of use to reach further, radians; from the hip and the
/// ankle as seen from the toe in the frame of the flat foot, metres. Neither is below 0.
fn rise(hip_from_toe: DVec3, lever: DVec3, longest_m: f64) -> (f64, f64) {
    let (hip, ankle) = (DVec2::new(hip_from_toe.x, hip_from_toe.y), DVec2::new(lever.x, lever.y));
    let apart_rad = ankle.to_angle() - hip.to_angle();
    let nearest_rad = (apart_rad + PI).rem_euclid(TAU) - PI;
    if nearest_rad.is_nan() || nearest_rad <= 0.0 {
        return (0.0, 0.0);
    }
    // The distance squared is hip^2 + ankle^2 - 2 |hip| |ankle| cos(angle between them), the hip's part across the foot included.
    let within = (hip_from_toe.length_squared() + lever.length_squared() - longest_m * longest_m) / 2.0;
    let cosine = within / (hip.length() * ankle.length());
    let between_rad = if cosine.is_nan() { 0.0 } else { cosine.clamp(-1.0, 1.0).acos() };
    ((nearest_rad - between_rad).max(0.0), (nearest_rad - LEFT_RAD).max(0.0))
}
