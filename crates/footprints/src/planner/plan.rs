//! Directions in the plan, as prints give them.

use std::f64::consts::{PI, TAU};

use glam::DVec2;

/// Unit direction (x, z) of a heading, radians to the left of X.
pub(super) fn ahead(heading_rad: f64) -> DVec2 {
    DVec2::new(heading_rad.cos(), -heading_rad.sin())
}

/// Unit direction (x, z) to the right of a heading.
pub(super) fn right_of(heading_rad: f64) -> DVec2 {
    DVec2::new(heading_rad.sin(), heading_rad.cos())
}

/// Heading of a direction, radians to the left of X.
pub(super) fn heading_of(direction: DVec2) -> f64 {
    (-direction.y).atan2(direction.x)
}

/// The same angle between half a turn to the right and half a turn to the left.
pub(super) fn wrapped(angle_rad: f64) -> f64 {
    (angle_rad + PI).rem_euclid(TAU) - PI
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn left_turns_are_positive_and_right_is_to_the_right() {
        // World space has X forward and Z to the right, so that a left turn of 90 degrees leads to -Z.
        assert!(ahead(PI / 2.0).distance(DVec2::new(0.0, -1.0)) < 1e-15);
        assert!(right_of(0.0).distance(DVec2::new(0.0, 1.0)) < 1e-15);
        for i in -20..20 {
            let heading = 0.31 * f64::from(i);
            assert!((wrapped(heading_of(ahead(heading)) - heading)).abs() < 1e-12);
            assert!((wrapped(heading_of(right_of(heading)) - heading + PI / 2.0)).abs() < 1e-12);
        }
    }
}
