//! Grounds to ride on, and grounds that are none.

use muybridge_core::{FlatGround, Ground, Random, Surface};

/// Steepest slope, degrees.
pub const STEEPEST_DEG: f64 = 20.0;
/// Height of a step, m.
pub const STEP_M: f32 = 0.2;
/// Steps of a stair before it goes down again.
const STAIR: i64 = 8;

/// A ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Terrain {
    /// Height zero.
    Flat,
    /// A plane: rise per metre along X and Z.
    Slope([f32; 2]),
    /// Stairs of [`STEP_M`] along X, up and down, each tread so long, m.
    Steps(f32),
    /// Waves: height, m, and length, m, of the longest; a shorter one runs across.
    Hills([f32; 2]),
    /// The same height everywhere, which may be no number at all.
    Level(f32),
    /// Flat, with holes of no number 0.5 m wide every 1.5 m.
    Holes,
    /// Cliffs of 3 m every 2 m.
    Cliffs,
}

impl Terrain {
    /// A ground that a horse can run on, by chance: flat, slope, steps and hills equally often.
    pub fn draw(random: &mut Random) -> Self {
        match (random.uniform() * 4.0) as usize {
            0 => Self::Flat,
            1 => {
                let rise = random.between(0.0, STEEPEST_DEG).to_radians().tan();
                let (sin, cos) = random.between(0.0, std::f64::consts::TAU).sin_cos();
                Self::Slope([(rise * cos) as f32, (rise * sin) as f32])
            }
            2 => Self::Steps(random.between(1.5, 5.0) as f32),
            _ => {
                let length = random.between(25.0, 80.0);
                // The steepest part of both waves together stays below the steepest slope.
                let most = STEEPEST_DEG.to_radians().tan() * length / std::f64::consts::TAU / 1.6;
                Self::Hills([random.between(0.1, most.min(2.5)) as f32, length as f32])
            }
        }
    }

    /// Plain name of its kind.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Flat => "flat",
            Self::Slope(_) => "slope",
            Self::Steps(_) => "steps",
            Self::Hills(_) => "hills",
            Self::Level(_) => "level",
            Self::Holes => "holes",
            Self::Cliffs => "cliffs",
        }
    }

    /// Names of the kinds that [`Self::draw`] gives.
    pub const DRAWN: [&'static str; 4] = ["flat", "slope", "steps", "hills"];

    fn height(&self, x: f32, z: f32) -> f32 {
        match *self {
            Self::Flat => 0.0,
            Self::Slope([along, across]) => along * x + across * z,
            Self::Steps(tread_m) => {
                let step = (x / tread_m).floor() as i64;
                let up = step.rem_euclid(2 * STAIR);
                STEP_M * up.min(2 * STAIR - up) as f32
            }
            Self::Hills([height_m, length_m]) => {
                let k = std::f32::consts::TAU / length_m;
                height_m * ((k * x).sin() + 0.5 * (1.2 * k * (z + 0.4 * x)).sin())
            }
            Self::Level(height_m) => height_m,
            Self::Holes => {
                let is_hole = x.rem_euclid(1.5) < 0.5;
                if is_hole { f32::NAN } else { 0.0 }
            }
            Self::Cliffs => 3.0 * (x / 2.0).floor().rem_euclid(2.0),
        }
    }
}

impl Ground for Terrain {
    fn surface(&self, x_m: f32, z_m: f32) -> Surface {
        match self {
            Self::Flat => FlatGround.surface(x_m, z_m),
            _ => (|x: f32, z: f32| self.height(x, z)).surface(x_m, z_m),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drawn_grounds_are_no_steeper_than_they_may_be_and_steps_as_high_as_they_should() {
        let mut random = Random::new(5);
        for _ in 0..200 {
            let terrain = Terrain::draw(&mut random);
            assert!(Terrain::DRAWN.contains(&terrain.name()));
            for k in 0..400 {
                let (x, z) = (0.37 * k as f32 - 60.0, 0.21 * k as f32 - 30.0);
                let surface = terrain.surface(x, z);
                let slope_deg = surface.normal.y.clamp(-1.0, 1.0).acos().to_degrees();
                match terrain {
                    Terrain::Steps(_) => {
                        let steps = surface.height_m / STEP_M;
                        assert!((steps - steps.round()).abs() < 1e-4);
                    }
                    _ => assert!(f64::from(slope_deg) < STEEPEST_DEG + 0.5, "{terrain:?}: {slope_deg}"),
                }
            }
        }
    }
}
