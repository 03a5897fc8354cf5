//! Ride scripts: what a rider asks of a horse over time, as a file that people and programs write.
//!
//! ```json
//! {
//!   "schema": 1,
//!   "ground": "flat",
//!   "ride": [
//!     { "for_s": 3, "speed_mph": 3 },
//!     { "for_s": 4, "gait": "canter", "lead": "left", "speed_m_s": 6, "turn_deg_s": 10 },
//!     { "for_s": 2, "leap": { "height_m": 0.6, "length_m": 3.0 } }
//!   ]
//! }
//! ```
//!
//! Each step is the whole command of its time: gait, lead, turn and leap that it does not name are not asked for. Only the speed
//! stays as it was until a step names another.

mod build;
mod ground;
mod numbers;
mod step;

use std::path::{Path, PathBuf};

use muybridge_capture::{FileError, read_json};
use muybridge_core::Command;
use serde::{Deserialize, Deserializer, de};

pub use ground::RideGround;
pub use numbers::RIDE_FACTORS;
pub use step::RideStep;

/// Schema version of a ride script.
pub const RIDE_SCHEMA: u32 = 1;
/// Longest ride, s: an hour.
pub const LONGEST_RIDE_S: f64 = 3600.0;

/// A ride.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(from = "RideFile")]
pub struct RideScript {
    /// Name for people.
    pub name: Option<String>,
    /// File of the horse's skeleton, from the folder the script is in; none for the reference horse.
    pub skeleton: Option<PathBuf>,
    /// Factor of all leg bones.
    pub legs: f32,
    /// Factor of the whole horse.
    pub size: f32,
    /// Seed of all chance.
    pub seed: u64,
    /// The ground.
    pub ground: RideGround,
    /// Where the horse stands first.
    pub start: Start,
    /// The steps, one after the other; at least one.
    pub ride: Vec<RideStep>,
}

/// Where a ride starts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Start {
    /// Metres along the world's X axis.
    #[serde(deserialize_with = "numbers::place_m")]
    pub x_m: f64,
    /// Metres along the world's Z axis, to the right of a horse that faces along X.
    #[serde(deserialize_with = "numbers::place_m")]
    pub z_m: f64,
    /// Degrees to the left of X.
    #[serde(deserialize_with = "numbers::heading_deg")]
    pub heading_deg: f32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RideFile {
    #[serde(rename = "schema", deserialize_with = "this_schema")]
    _schema: u32,
    #[serde(default)]
    name: Option<String>,
    /// A remark for people.
    #[serde(default, rename = "about")]
    _about: Option<String>,
    #[serde(default)]
    skeleton: Option<PathBuf>,
    #[serde(default = "numbers::one", deserialize_with = "numbers::factor")]
    legs: f32,
    #[serde(default = "numbers::one", deserialize_with = "numbers::factor")]
    size: f32,
    #[serde(default)]
    seed: u64,
    #[serde(default)]
    ground: RideGround,
    #[serde(default)]
    start: Start,
    #[serde(deserialize_with = "steps")]
    ride: Vec<RideStep>,
}

impl From<RideFile> for RideScript {
    fn from(file: RideFile) -> Self {
        let RideFile { name, skeleton, legs, size, seed, ground, start, ride, .. } = file;
        Self { name, skeleton, legs, size, seed, ground, start, ride }
    }
}

/// The schema, which must be [`RIDE_SCHEMA`].
fn this_schema<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u32, D::Error> {
    let schema = u32::deserialize(deserializer)?;
    if schema == RIDE_SCHEMA {
        Ok(schema)
    } else {
        Err(de::Error::custom(format!("{schema}, but this program reads schema {RIDE_SCHEMA}")))
    }
}

/// The steps: some, and not for ever.
fn steps<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<RideStep>, D::Error> {
    let steps = Vec::<RideStep>::deserialize(deserializer)?;
    let duration_s: f64 = steps.iter().map(|step| step.for_s).sum();
    if steps.is_empty() {
        Err(de::Error::custom(
            "no steps; a ride has at least one, such as { \"for_s\": 3, \"speed_mph\": 3 }",
        ))
    } else if duration_s > LONGEST_RIDE_S {
        Err(de::Error::custom(format!("{duration_s} s in all; a ride takes {LONGEST_RIDE_S} s at most")))
    } else {
        Ok(steps)
    }
}

impl RideScript {
    /// One command for an hour: the reference horse on the flat.
    pub fn of(step: RideStep) -> Self {
        let ride = vec![RideStep { for_s: LONGEST_RIDE_S, ..step }];
        let (ground, start) = (RideGround::default(), Start::default());
        Self { name: None, skeleton: None, legs: 1.0, size: 1.0, seed: 0, ground, start, ride }
    }

    /// Reads a script.
    ///
    /// # Errors
    /// When the file cannot be read or is no ride script: with the field, and the line and column where it goes wrong.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        let mut script: Self = read_json(path, RIDE_SCHEMA)?;
        if let (Some(folder), Some(skeleton)) = (path.parent(), &mut script.skeleton) {
            *skeleton = folder.join(&*skeleton);
        }
        Ok(script)
    }

    /// How long it takes, s.
    pub fn duration_s(&self) -> f64 {
        self.ride.iter().map(|step| step.for_s).sum()
    }

    /// The command to give at a time, for the next `dt_s` seconds; none after the end.
    ///
    /// A horse leaps once for each step of the script that says so: the command lets go of the leap in the step's last `dt_s`, so
    /// that a leap in the next step is another one.
    pub fn command(&self, time_s: f64, dt_s: f64) -> Option<Command> {
        let (mut end_s, mut speed_m_s) = (0.0, 0.0);
        for step in &self.ride {
            end_s += step.for_s;
            speed_m_s = step.speed_m_s.unwrap_or(speed_m_s);
            if time_s < end_s - SAME_TIME_S {
                let leap = step.leap.filter(|_| time_s + dt_s < end_s - SAME_TIME_S);
                return Some(Command { speed_m_s, turn: step.turn, gait: step.gait, lead: step.lead, leap });
            }
        }
        None
    }
}

/// Times this close are the same: sums of decimal fractions differ by less.
const SAME_TIME_S: f64 = 1e-6;

#[cfg(test)]
mod tests;
