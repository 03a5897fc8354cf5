//! Grounds to ride on, named in a few characters.

use std::f32::consts::TAU;
use std::str::FromStr;

use muybridge_core::{Ground, Surface};
use serde::{Deserialize, Deserializer, de};

/// The ground stays level this far before the start, metres, so that the horse stands and sets off on the level.
const LEVEL_M: f32 = 5.0;
/// Each side of a ridge is so long, metres of X, and its top: some strides of any gait.
const RIDGE_SIDE_M: f32 = 12.0;
const RIDGE_TOP_M: f32 = 4.0;
/// A tread of the stairs, metres: a horse's length.
const TREAD_M: f32 = 2.5;
/// Treads up before the stairs go down again.
const TREADS_UP: f32 = 4.0;
/// From one hill to the next along X and along Z, metres.
const HILLS_M: [f32; 2] = [14.0, 22.0];

const GREATEST_SLOPE_DEG: f32 = 30.0;
const GREATEST_STEP_M: f32 = 0.5;
const GREATEST_HILL_M: f32 = 5.0;

/// The ground of a ride. All but the flat one are level within five metres of the start and rise and fall along X.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum RideGround {
    /// `flat`: the plane of height zero.
    #[default]
    Flat,
    /// `slope:DEGREES`: uphill without an end, or downhill when negative.
    Slope(f32),
    /// `ridge:DEGREES`: up for 12 m, level for 4 m, down for 12 m, level.
    Ridge(f32),
    /// `steps:HEIGHT`: stairs of so many metres a step, four up, four down, and so on.
    Steps(f32),
    /// `hills:HEIGHT`: waves of so many metres from valley to top.
    Hills(f32),
}

impl RideGround {
    /// Height at a place, metres.
    pub fn height_m(self, x_m: f32, z_m: f32) -> f32 {
        let beyond_m = (x_m - LEVEL_M).max(0.0);
        match self {
            Self::Flat => 0.0,
            Self::Slope(degrees) => beyond_m * degrees.to_radians().tan(),
            Self::Ridge(degrees) => {
                let up_m = beyond_m.min(RIDGE_SIDE_M);
                let down_m = (beyond_m - RIDGE_SIDE_M - RIDGE_TOP_M).clamp(0.0, RIDGE_SIDE_M);
                (up_m - down_m) * degrees.to_radians().tan()
            }
            Self::Steps(height_m) => {
                let tread = if x_m < LEVEL_M { 0.0 } else { (beyond_m / TREAD_M).floor() + 1.0 };
                let around = tread.rem_euclid(2.0 * TREADS_UP);
                height_m * around.min(2.0 * TREADS_UP - around)
            }
            Self::Hills(height_m) => {
                let wave = |at_m: f32, from_hill_to_hill_m: f32| (TAU * at_m / from_hill_to_hill_m).cos();
                let across = 0.75 + 0.25 * wave(z_m, HILLS_M[1]);
                0.5 * height_m * across * (1.0 - wave(beyond_m, HILLS_M[0]))
            }
        }
    }
}

impl Ground for RideGround {
    fn surface(&self, x_m: f32, z_m: f32) -> Surface {
        (|x: f32, z: f32| self.height_m(x, z)).surface(x_m, z_m)
    }
}

impl FromStr for RideGround {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (kind, size) = text.split_once(':').map_or((text, None), |(kind, size)| (kind, Some(size)));
        let number = |least: f32, most: f32, unit: &str| {
            let wanted = || format!("{kind}:NUMBER with a number between {least} and {most} {unit}");
            let number: f32 = size.and_then(|size| size.parse().ok()).ok_or_else(wanted)?;
            if (least..=most).contains(&number) { Ok(number) } else { Err(wanted()) }
        };
        match kind {
            "flat" if size.is_none() => Ok(Self::Flat),
            "slope" => number(-GREATEST_SLOPE_DEG, GREATEST_SLOPE_DEG, "degrees").map(Self::Slope),
            "ridge" => number(-GREATEST_SLOPE_DEG, GREATEST_SLOPE_DEG, "degrees").map(Self::Ridge),
            "steps" => number(0.0, GREATEST_STEP_M, "m").map(Self::Steps),
            "hills" => number(0.0, GREATEST_HILL_M, "m").map(Self::Hills),
            _ => Err("there is flat, slope:DEGREES, ridge:DEGREES, steps:METRES and hills:METRES".into()),
        }
    }
}

impl<'de> Deserialize<'de> for RideGround {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = String::deserialize(deserializer)?;
        text.parse().map_err(|fault| de::Error::custom(format!("{text:?} is no ground: {fault}")))
    }
}
