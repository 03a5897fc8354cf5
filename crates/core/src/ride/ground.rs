//! The ground a horse runs on: a height and a normal at any place, and nothing else.

use glam::Vec3;

/// Distance over which the slope of a height function is measured, metres: half a hoof.
const SLOPE_STEP_M: f32 = 0.05;

/// Steepest ground a hoof lies flat on, rad: 35 degrees.
const STEEPEST_RAD: f32 = 0.6;

/// The ground at a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// Height, metres. What is not finite is a hole: the horse steps over it as if the ground it last stood on went on.
    pub height_m: f32,
    /// Unit normal, pointing up.
    pub normal: Vec3,
}

impl Surface {
    /// Angle at which the surface rises along a heading (rad about Y, left positive), rad; zero where it is no surface.
    pub(super) fn rise_rad(&self, heading_rad: f64) -> f32 {
        let (sin, cos) = heading_rad.sin_cos();
        let along = -(self.normal.x * cos as f32 - self.normal.z * sin as f32);
        let rise = along.atan2(self.normal.y);
        if rise.is_finite() { rise.clamp(-STEEPEST_RAD, STEEPEST_RAD) } else { 0.0 }
    }
}

/// Any ground. A function of x and z (metres) that returns a height is one, its slope measured over a hoof's width.
pub trait Ground {
    /// The surface at a place in world space, metres.
    fn surface(&self, x_m: f32, z_m: f32) -> Surface;
}

/// The plane of height zero.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FlatGround;

impl Ground for FlatGround {
    fn surface(&self, _x_m: f32, _z_m: f32) -> Surface {
        Surface { height_m: 0.0, normal: Vec3::Y }
    }
}

impl<F: Fn(f32, f32) -> f32> Ground for F {
    fn surface(&self, x_m: f32, z_m: f32) -> Surface {
        let slope = |dx: f32, dz: f32| {
            let rise = self(x_m + dx, z_m + dz) - self(x_m - dx, z_m - dz);
            rise / (2.0 * SLOPE_STEP_M)
        };
        let normal = Vec3::new(-slope(SLOPE_STEP_M, 0.0), 1.0, -slope(0.0, SLOPE_STEP_M));
        Surface { height_m: self(x_m, z_m), normal: normal.try_normalize().unwrap_or(Vec3::Y) }
    }
}
