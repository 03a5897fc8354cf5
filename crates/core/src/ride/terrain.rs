//! The ground as the body feels it: its height under croup and withers, without the steps that only hooves feel.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::ground::Ground;
use super::track::{Facing, Track};

/// The ground under a girdle is the mean over so many places of a stretch along the track.
const PLACES: usize = 5;
/// Half that stretch, metres of a reference horse.
const HALF_STRETCH_M: f32 = 0.5;
/// How fast the body follows the ground, 1/s: a step is taken up in about a quarter of a second.
const FOLLOWING_HZ: f32 = 14.0;
/// Heights beyond this count as no ground, metres: single precision has centimetres left there.
const MOST_HEIGHT_M: f32 = 1e5;
/// Greatest slope the body takes, rise over run: 35 degrees.
const MOST_SLOPE: f32 = 0.7;

/// How much shorter steps are by the slope: by a quarter at ten degrees, two fifths at twenty, so that the legs reach.
const SHORTENING: f32 = 1.9;

/// Ground heights under croup and withers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Terrain {
    /// Under croup and withers, metres.
    pub(super) lifts_m: [f32; 2],
    /// How fast each comes nearer to the ground itself, m/s.
    nearing_m_s: [f32; 2],
}

/// The ground's height at a place; none in a hole.
pub(super) fn height_m(ground: &impl Ground, at_m: DVec2) -> Option<f32> {
    let height = ground.surface(at_m.x as f32, at_m.y as f32).height_m;
    (height.abs() < MOST_HEIGHT_M).then_some(height)
}

impl Terrain {
    /// The ground under a horse that has just been placed.
    pub(super) fn under(track: &Track, trunk_m: f32, size: f32, ground: &impl Ground) -> Self {
        let at = |i: usize| mean_height_m(track, trunk_m * i as f32, size, ground).unwrap_or(0.0);
        Self { lifts_m: [at(0), at(1)], nearing_m_s: [0.0; 2] }
    }

    /// Rise over run under the horse.
    pub(super) fn slope(&self, trunk_m: f32) -> f32 {
        ((self.lifts_m[1] - self.lifts_m[0]) / trunk_m).clamp(-MOST_SLOPE, MOST_SLOPE)
    }

    /// Angle at which the ground rises under the horse, rad.
    pub(super) fn rise_rad(&self, trunk_m: f32) -> f32 {
        let slope = self.slope(trunk_m);
        if slope == 0.0 { 0.0 } else { slope.atan() }
    }

    /// Horizontal over real distance.
    pub(super) fn level(&self, trunk_m: f32) -> f32 {
        let slope = self.slope(trunk_m);
        1.0 / (1.0 + slope * slope).sqrt()
    }

    /// Share of their length that steps keep here: a leg that reaches downhill has farther to go.
    pub(super) fn step_share(&self, trunk_m: f32) -> f32 {
        1.0 / (1.0 + SHORTENING * self.slope(trunk_m).abs())
    }

    /// Follows the ground: without delay on a slope, gently over a step.
    pub(super) fn advance(
        &mut self,
        track: &Track,
        forward_m: f32,
        trunk_m: f32,
        size: f32,
        ground: &impl Ground,
        dt_s: f32,
    ) {
        let risen_m = self.slope(trunk_m) * forward_m;
        for i in 0..2 {
            let expected = self.lifts_m[i] + risen_m;
            let Some(height_m) = mean_height_m(track, trunk_m * i as f32, size, ground) else {
                self.lifts_m[i] = expected;
                continue;
            };
            // A critically damped spring on what the body is off the ground, solved exactly.
            let (off_m, nearing) = (expected - height_m, self.nearing_m_s[i]);
            let pull = nearing + FOLLOWING_HZ * off_m;
            let fading = (-FOLLOWING_HZ * dt_s).exp();
            self.nearing_m_s[i] = (nearing - FOLLOWING_HZ * pull * dt_s) * fading;
            self.lifts_m[i] = height_m + (off_m + pull * dt_s) * fading;
        }
    }
}

fn mean_height_m(track: &Track, ahead_m: f32, size: f32, ground: &impl Ground) -> Option<f32> {
    let forward = Facing::new(track.heading_rad).ahead;
    let (mut sum, mut count) = (0.0, 0u8);
    for k in 0..PLACES {
        let along = HALF_STRETCH_M * size * (2.0 * k as f32 / (PLACES - 1) as f32 - 1.0);
        if let Some(height) = height_m(ground, track.at_m + forward * f64::from(ahead_m + along)) {
            sum += height;
            count += 1;
        }
    }
    (count > 0).then(|| sum / f32::from(count))
}
