//! The centre-of-mass curve: cubic Hermite pieces between knots (van de Panne 1997, 2.3).

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A knot of the curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Knot {
    /// Place, world space, metres.
    pub at: DVec3,
    /// Velocity, m/s.
    pub velocity: DVec3,
}

/// The centre of mass at a moment.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CentreOfMass {
    /// Place, world space, metres.
    pub at: DVec3,
    /// Velocity, m/s.
    pub velocity: DVec3,
    /// Acceleration, m/s².
    pub acceleration: DVec3,
}

/// A C1 curve through knots at rising times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// Times of the knots, s, rising.
    pub times_s: Vec<f64>,
    /// The knots.
    pub knots: Vec<Knot>,
}

/// Weights of the first knot's place and velocity and of the second one's in a linear function of a piece.
pub(crate) type KnotWeights = [f64; 4];

/// Weights that give the place on a piece of a duration (s) at a share of it.
pub(crate) fn place_weights(share: f64, duration_s: f64) -> KnotWeights {
    let (u, u2, u3) = (share, share * share, share * share * share);
    [2.0 * u3 - 3.0 * u2 + 1.0, (u3 - 2.0 * u2 + u) * duration_s, 3.0 * u2 - 2.0 * u3, (u3 - u2) * duration_s]
}

/// The same for the velocity.
pub(crate) fn velocity_weights(share: f64, duration_s: f64) -> KnotWeights {
    let (u, u2) = (share, share * share);
    let bend = (6.0 * u2 - 6.0 * u) / duration_s;
    [bend, 3.0 * u2 - 4.0 * u + 1.0, -bend, 3.0 * u2 - 2.0 * u]
}

/// The same for the acceleration.
pub(crate) fn acceleration_weights(share: f64, duration_s: f64) -> KnotWeights {
    let bend = (12.0 * share - 6.0) / (duration_s * duration_s);
    [bend, (6.0 * share - 4.0) / duration_s, -bend, (6.0 * share - 2.0) / duration_s]
}

/// The weighted sum of two knots.
pub(crate) fn weighted(weights: &KnotWeights, first: &Knot, second: &Knot) -> DVec3 {
    weights[0] * first.at
        + weights[1] * first.velocity
        + weights[2] * second.at
        + weights[3] * second.velocity
}

impl Trajectory {
    /// The knots from one time to another, s, with their times.
    pub fn between(&self, from_s: f64, to_s: f64) -> impl Iterator<Item = (f64, &Knot)> {
        let knots = self.times_s.iter().copied().zip(&self.knots);
        knots.filter(move |(time_s, _)| (from_s..=to_s).contains(time_s))
    }

    /// The curve at a time, s; held at its ends, where it also has their velocity. An empty curve is at the origin.
    pub fn at(&self, time_s: f64) -> CentreOfMass {
        let Some(last) = self.knots.len().min(self.times_s.len()).checked_sub(1) else {
            return CentreOfMass::default();
        };
        let (first_s, last_s) = (self.times_s[0], self.times_s[last]);
        let held_s = if time_s.is_nan() { first_s } else { time_s.clamp(first_s, last_s) };
        if last == 0 {
            return CentreOfMass {
                at: self.knots[0].at,
                velocity: self.knots[0].velocity,
                ..Default::default()
            };
        }
        let piece = self.times_s.partition_point(|&at_s| at_s <= held_s).clamp(1, last) - 1;
        let duration_s = self.times_s[piece + 1] - self.times_s[piece];
        let share = (held_s - self.times_s[piece]) / duration_s;
        let (first, second) = (&self.knots[piece], &self.knots[piece + 1]);
        CentreOfMass {
            at: weighted(&place_weights(share, duration_s), first, second),
            velocity: weighted(&velocity_weights(share, duration_s), first, second),
            acceleration: weighted(&acceleration_weights(share, duration_s), first, second),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve() -> Trajectory {
        let knot = |i: f64| Knot {
            at: DVec3::new(i, 1.0 + 0.1 * (3.0 * i).sin(), 0.1 * i.cos()),
            velocity: DVec3::new(1.2, 0.3 * i.sin(), -0.2 * i),
        };
        Trajectory { times_s: vec![0.0, 0.4, 0.45, 1.3], knots: (0..4).map(|i| knot(f64::from(i))).collect() }
    }

    #[test]
    fn place_and_velocity_are_continuous_through_the_knots() {
        let curve = curve();
        for (time_s, knot) in curve.times_s.iter().zip(&curve.knots) {
            for step_s in [-1e-13, 0.0, 1e-13] {
                let at = curve.at(time_s + step_s);
                assert!(at.at.distance(knot.at) < 1e-9, "{time_s}");
                assert!(at.velocity.distance(knot.velocity) < 1e-9, "{time_s}");
            }
        }
    }

    #[test]
    fn velocity_and_acceleration_are_the_derivatives() {
        let (curve, step_s) = (curve(), 1e-5);
        for i in 1..130 {
            let time_s = 0.01 * f64::from(i) + 0.005;
            let [before, at, after] = [-step_s, 0.0, step_s].map(|by_s| curve.at(time_s + by_s));
            let velocity = (after.at - before.at) / (2.0 * step_s);
            assert!(velocity.distance(at.velocity) < 1e-4, "{time_s}");
            let acceleration = (after.velocity - before.velocity) / (2.0 * step_s);
            assert!(
                acceleration.distance(at.acceleration) < 1e-4 * (1.0 + at.acceleration.length()),
                "{time_s}"
            );
        }
    }

    #[test]
    fn any_number_is_a_time_and_an_empty_curve_is_no_trouble() {
        let curve = curve();
        assert_eq!(curve.at(f64::NAN).at, curve.knots[0].at);
        assert_eq!(curve.at(f64::INFINITY).at, curve.knots[3].at);
        assert_eq!(Trajectory::default().at(1.0), CentreOfMass::default());
    }
}
