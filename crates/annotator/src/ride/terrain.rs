//! The ground under a ride: one function of place, shared by the simulation and the picture.

use std::ops::RangeInclusive;

use muybridge_core::{Ground, Surface};

/// A new ground begins gently so far from the horse and is wholly there so far from it, metres.
const BEGINS_M: [f32; 2] = [2.5, 12.0];
/// The face of a step is this deep, metres: a cliff without depth would have no slope.
const STEP_FACE_M: f32 = 0.06;
/// Form of the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Shape {
    /// A plane.
    #[default]
    Flat,
    /// A plane that rises (or, negative, falls) ahead, degrees.
    Slope(f32),
    /// Stairs that rise (or fall) ahead: height of a step and its length, metres.
    Steps([f32; 2]),
    /// Rolling hills: height from valley to top and distance of the tops, metres.
    Hills([f32; 2]),
}

impl Shape {
    /// Steepest slope, degrees.
    pub const SLOPE_DEG: RangeInclusive<f32> = -15.0..=15.0;
    /// Height of a step, metres; negative goes down.
    pub const STEP_HEIGHT_M: RangeInclusive<f32> = -0.3..=0.3;
    /// Length of a step, metres.
    pub const STEP_LENGTH_M: RangeInclusive<f32> = 0.8..=5.0;
    /// Height of the hills, metres.
    pub const HILL_HEIGHT_M: RangeInclusive<f32> = 0.1..=2.0;
    /// Distance of the hilltops, metres.
    pub const HILL_LENGTH_M: RangeInclusive<f32> = 8.0..=40.0;
    /// One of each, as first chosen, with its name.
    pub const ALL: [(Self, &'static str); 4] = [
        (Self::Flat, "Flat"),
        (Self::Slope(6.0), "Slope"),
        (Self::Steps([0.15, 2.0]), "Steps"),
        (Self::Hills([0.8, 16.0]), "Hills"),
    ];

    /// Whether it is of the same kind, with whatever numbers.
    pub fn is_kind_of(&self, other: &Self) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }

    /// Height at a place, metres along and across the way ahead.
    fn height_m(&self, along: f32, across: f32) -> f32 {
        match *self {
            Self::Flat => 0.0,
            Self::Slope(degrees) => along * degrees.to_radians().tan(),
            Self::Steps([height, length]) => {
                let steps = along / length;
                let into = (steps - steps.floor()) * length;
                height * (steps.floor() + (into / STEP_FACE_M).min(1.0))
            }
            Self::Hills([height, length]) => {
                let turn = std::f32::consts::TAU / length;
                // Two waves that cross, so that no way leads along a level line.
                let wave = (turn * along).cos() * 0.7 + (turn * (0.6 * along + 0.8 * across)).cos() * 0.3;
                -0.5 * height * wave
            }
        }
    }
}

/// A ground that begins around a place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Terrain {
    /// Its form.
    pub shape: Shape,
    /// The place, world x and z, metres.
    at: [f32; 2],
    /// Height there, metres, and the slopes along x and z that the ground had there before.
    height_m: f32,
    slopes: [f32; 2],
    /// The way ahead, radians about Y.
    heading_rad: f32,
}

impl Terrain {
    /// The same place with a ground of another form, which begins around a horse without a jump under its hooves.
    pub fn changed(&self, shape: Shape, at: [f32; 2], heading_rad: f32) -> Self {
        let surface = self.surface(at[0], at[1]);
        let up = surface.normal.y.max(0.1);
        let slopes = [-surface.normal.x / up, -surface.normal.z / up];
        Self { shape, at, height_m: surface.height_m, slopes, heading_rad }
    }

    /// Whether it is the plane of height zero everywhere.
    pub fn is_plain(&self) -> bool {
        self.shape == Shape::Flat && self.height_m == 0.0 && self.slopes == [0.0; 2]
    }

    /// Height at a place in world space, metres.
    pub fn height_m(&self, x_m: f32, z_m: f32) -> f32 {
        let [dx, dz] = [x_m - self.at[0], z_m - self.at[1]];
        let (sin, cos) = self.heading_rad.sin_cos();
        let (along, across) = (dx * cos - dz * sin, dx * sin + dz * cos);
        let before = self.slopes[0] * dx + self.slopes[1] * dz;
        let [begins, there] = BEGINS_M;
        let share = ((dx.hypot(dz) - begins) / (there - begins)).clamp(0.0, 1.0);
        let smooth = share * share * (3.0 - 2.0 * share);
        let ahead = self.shape.height_m(along, across) - self.shape.height_m(0.0, 0.0);
        self.height_m + before + smooth * (ahead - before)
    }
}

impl Ground for Terrain {
    fn surface(&self, x_m: f32, z_m: f32) -> Surface {
        (|x: f32, z: f32| self.height_m(x, z)).surface(x_m, z_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Slopes are measured over this, metres.
    const SLOPE_STEP_M: f32 = 0.05;

    fn slope_along_x(terrain: &Terrain, x: f32) -> f32 {
        (terrain.height_m(x + SLOPE_STEP_M, 0.0) - terrain.height_m(x - SLOPE_STEP_M, 0.0))
            / (2.0 * SLOPE_STEP_M)
    }

    #[test]
    fn a_slope_rises_ahead_at_its_angle_and_begins_without_a_jump() {
        let terrain = Terrain::default().changed(Shape::Slope(10.0), [5.0, 0.0], 0.0);
        assert!((slope_along_x(&terrain, 40.0) - 10_f32.to_radians().tan()).abs() < 1e-3);
        assert!(terrain.height_m(6.5, 1.0).abs() < 1e-6 && terrain.height_m(3.5, -1.0).abs() < 1e-6);
        // To the left, heading along -Z: the slope rises that way.
        let left = Terrain::default().changed(Shape::Slope(10.0), [0.0; 2], std::f32::consts::FRAC_PI_2);
        assert!(left.height_m(0.0, -30.0) > 4.0 && left.height_m(0.0, 30.0) < -4.0);
    }

    #[test]
    fn the_next_ground_begins_where_the_last_one_was() {
        let mut terrain = Terrain::default();
        let mut x = 0.0;
        for (shape, _) in Shape::ALL.into_iter().chain(Shape::ALL) {
            let before = [-1.0, 0.0, 1.0].map(|by| terrain.height_m(x + by, 0.0));
            terrain = terrain.changed(shape, [x, 0.0], 0.0);
            let after = [-1.0, 0.0, 1.0].map(|by| terrain.height_m(x + by, 0.0));
            for (a, b) in before.iter().zip(after) {
                assert!((a - b).abs() < 0.16, "{shape:?}: {a} {b}");
            }
            x += 33.3;
        }
    }

    #[test]
    fn stairs_are_level_between_their_faces() {
        let terrain = Terrain::default().changed(Shape::Steps([0.2, 2.0]), [0.0; 2], 0.0);
        assert!((terrain.height_m(21.0, 0.0) - terrain.height_m(20.5, 0.5)).abs() < 1e-4);
        assert!((terrain.height_m(23.0, 0.0) - terrain.height_m(21.0, 0.0) - 0.2).abs() < 1e-4);
    }

    #[test]
    fn every_ground_has_a_height_and_an_upward_normal_everywhere() {
        for (shape, _) in Shape::ALL {
            let terrain = Terrain::default().changed(shape, [3.0, -2.0], 1.0);
            for i in -50..50 {
                let surface = terrain.surface(i as f32 * 1.7, i as f32 * -0.9);
                assert!(surface.height_m.is_finite() && surface.normal.y > 0.1);
            }
        }
    }
}
