//! The horse's way over the ground: place, heading, turning, bending and banking (spec 6.4).

use glam::{DVec2, Vec2};
use serde::{Deserialize, Serialize};

use super::command::{TURN_STEP_RAD, Turn};

/// Lateral acceleration a horse leans into willingly, m/s^2: about a third of its weight, near what polo and cutting horses show.
const LATERAL_M_S2: f32 = 3.5;
/// Smallest circle, metres of a reference horse: a volte of five metres across.
const LEAST_RADIUS_M: f32 = 2.5;
/// Turn rate about a place, rad/s.
const ON_THE_SPOT_RAD_S: f32 = 0.26;
/// Turn rate sought per angle to go, 1/s: with [`TURNING_S`] it comes to a heading without swinging past it.
const TURN_PER_ANGLE_HZ: f32 = 1.0;
/// Time in which the turn rate follows the wish, s.
const TURNING_S: f32 = 0.25;
/// Times in which head, neck and spine follow the wish, one after the other, s: the turn runs from the head through the neck to
/// the spine (Huang 2012, section 3.4.2).
const BENDING_S: [f32; 3] = [0.1, 0.2, 0.35];
/// Bend of head and neck for a turn rate sought, rad per rad/s.
const BEND_PER_RATE: [f32; 2] = [0.12, 0.4];
/// Greatest bend of head, neck and spine, rad.
const MOST_BENT_RAD: [f32; 3] = [0.2, 0.55, 0.22];
/// Time in which the lean follows the turn, s.
const LEANING_S: f32 = 0.3;
/// Share of the lean that would balance the turn: the feet beside the track do the rest.
const LEAN_SHARE: f32 = 0.8;

/// Place and heading on the ground.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Track {
    /// World x and z, metres.
    pub(super) at_m: DVec2,
    /// About the world's Y axis, left positive, rad; counts whole turns.
    pub(super) heading_rad: f64,
    pub(super) turn_rate_rad_s: f32,
    /// Bends of head, neck and spine, to the left positive, rad.
    pub(super) bends_rad: [f32; 3],
    /// To the left positive, rad.
    pub(super) lean_rad: f32,
}

/// How much of the way to a wish is gone after a time, for a first-order lag: `1 - exp(-t)` to half a percent, without an
/// exponential.
pub(super) fn lagged(dt_s: f32, lag_s: f32) -> f32 {
    let t = dt_s / lag_s;
    1.0 - 1.0 / (1.0 + t + 0.48 * t * t + 0.235 * t * t * t)
}

/// Unit vector ahead of a heading: world x and z.
fn ahead(heading_rad: f64) -> DVec2 {
    let (sin, cos) = heading_rad.sin_cos();
    DVec2::new(cos, -sin)
}

impl Track {
    pub(super) fn new(at_m: DVec2, heading_rad: f64) -> Self {
        Self { at_m, heading_rad, turn_rate_rad_s: 0.0, bends_rad: [0.0; 3], lean_rad: 0.0 }
    }

    /// Greatest turn rate at a speed, rad/s, for a horse of this size: it rises with speed as far as the smallest circle says, and falls
    /// where the lateral acceleration would be too great.
    pub(super) fn most_rad_s(speed_m_s: f32, size: f32) -> f32 {
        let by_circle = speed_m_s / (LEAST_RADIUS_M * size);
        let by_force = LATERAL_M_S2 / speed_m_s.max(0.1);
        by_circle.min(by_force).max(ON_THE_SPOT_RAD_S.min(by_force))
    }

    /// The turn rate sought, rad/s.
    pub(super) fn sought_rad_s(&self, turn: Turn, most_rad_s: f32) -> f32 {
        let to = |heading_rad: f64| {
            let angle = (heading_rad - self.heading_rad).rem_euclid(std::f64::consts::TAU);
            let shorter = if angle > std::f64::consts::PI { angle - std::f64::consts::TAU } else { angle };
            TURN_PER_ANGLE_HZ * shorter as f32
        };
        let sought = match turn {
            Turn::Rate(rate) => rate,
            Turn::Heading(heading) if heading.is_finite() => to(f64::from(heading)),
            Turn::Heading(_) => 0.0,
            Turn::Steps(steps) => to(f64::from(steps) * f64::from(TURN_STEP_RAD)),
        };
        if sought.is_nan() { 0.0 } else { sought.clamp(-most_rad_s, most_rad_s) }
    }

    /// Moves on by a time.
    pub(super) fn advance(
        &mut self,
        forward_m_s: f32,
        speed_m_s: f32,
        sought_rad_s: f32,
        trunk_m: f32,
        dt_s: f32,
    ) {
        self.turn_rate_rad_s += (sought_rad_s - self.turn_rate_rad_s) * lagged(dt_s, TURNING_S);
        if self.turn_rate_rad_s.abs() < 1e-6 && sought_rad_s == 0.0 {
            self.turn_rate_rad_s = 0.0;
        }
        let turned = f64::from(self.turn_rate_rad_s * dt_s);
        self.at_m += ahead(self.heading_rad + 0.5 * turned) * f64::from(forward_m_s * dt_s);
        self.heading_rad += turned;
        // The spine takes the track's own curve.
        let curve = self.turn_rate_rad_s * trunk_m / speed_m_s.max(1.0);
        let sought = [BEND_PER_RATE[0] * sought_rad_s, BEND_PER_RATE[1] * sought_rad_s, curve];
        for i in 0..3 {
            let sought = sought[i].clamp(-MOST_BENT_RAD[i], MOST_BENT_RAD[i]);
            self.bends_rad[i] += (sought - self.bends_rad[i]) * lagged(dt_s, BENDING_S[i]);
        }
        let pull = self.turn_rate_rad_s * speed_m_s / super::retarget::GRAVITY_M_S2;
        let balance = if pull == 0.0 { 0.0 } else { pull.atan() };
        self.lean_rad += (LEAN_SHARE * balance - self.lean_rad) * lagged(dt_s, LEANING_S);
    }
}

/// A direction on the ground: the unit vectors ahead and to the right, world x and z.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facing {
    pub(super) ahead: DVec2,
}

impl Facing {
    pub(super) fn new(heading_rad: f64) -> Self {
        Self { ahead: ahead(heading_rad) }
    }

    pub(super) fn right(&self) -> DVec2 {
        DVec2::new(-self.ahead.y, self.ahead.x)
    }

    /// The same turned to the left.
    pub(super) fn turned(&self, by_rad: f32) -> Self {
        if by_rad == 0.0 {
            return *self;
        }
        let (sin, cos) = by_rad.sin_cos();
        Self { ahead: self.ahead * f64::from(cos) - self.right() * f64::from(sin) }
    }

    /// World x and z of a place given ahead and to the right, metres.
    pub(super) fn beside(&self, at_m: DVec2, ahead_right_m: Vec2) -> DVec2 {
        at_m + self.ahead * f64::from(ahead_right_m.x) + self.right() * f64::from(ahead_right_m.y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn left_is_towards_minus_z() {
        let mut track = Track::new(DVec2::ZERO, 0.0);
        for _ in 0..60 {
            track.advance(2.0, 2.0, 0.5, 0.8, 1.0 / 60.0);
        }
        assert!(track.heading_rad > 0.2 && track.at_m.y < -0.1, "{track:?}");
        assert!(track.lean_rad > 0.0 && track.bends_rad.iter().all(|bend| *bend > 0.0));
        let facing = Facing::new(0.0);
        assert!(facing.beside(DVec2::ZERO, Vec2::new(1.0, 0.5)).distance(DVec2::new(1.0, 0.5)) < 1e-12);
        assert!(facing.turned(0.3).ahead.distance(ahead(0.3)) < 1e-6);
    }

    #[test]
    fn a_heading_is_reached_and_kept() {
        for steps in [1, -1, 6, 12, -5] {
            let mut track = Track::new(DVec2::ZERO, 0.0);
            let mut farthest = 0.0f64;
            for _ in 0..60 * 20 {
                let sought = track.sought_rad_s(Turn::Steps(steps), 0.6);
                track.advance(3.0, 3.0, sought, 0.8, 1.0 / 60.0);
                farthest = farthest.max(track.heading_rad.abs());
            }
            let wanted = f64::from(steps.abs()) * f64::from(TURN_STEP_RAD);
            let off = (track.heading_rad.abs() - wanted).abs().to_degrees();
            assert!(off < 0.1, "{steps}: {off} degrees");
            assert!((farthest - wanted).to_degrees() < 1.0, "{steps}: swings past by {}", farthest - wanted);
        }
    }
}
