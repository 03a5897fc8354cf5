//! What a rider, a script or a planner asks of the horse.

use serde::{Deserialize, Serialize};

use crate::gait::Gait;
use crate::limb::Side;

/// One press of the rein turns the horse by this, radians (Huang 2012, section 3.4.2: 15 degrees at a time).
pub const TURN_STEP_RAD: f32 = 15.0 * std::f32::consts::PI / 180.0;

/// What the horse is asked to do from now on. Any numbers may stand in it: what is no number counts as not asked for, and what
/// no horse can do is held within what this one can.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Command {
    /// Wanted speed, m/s; zero or less to halt. Held within what the horse's gaits (or the wanted gait) can do.
    pub speed_m_s: f32,
    /// Wanted turn.
    pub turn: Turn,
    /// Wanted gait; without it the speed chooses. [`Gait::Leap`] is asked for by `leap` and is no gait to choose.
    pub gait: Option<Gait>,
    /// Wanted lead at canter and gallop; without it the turn chooses.
    pub lead: Option<Side>,
    /// A leap, taken once when it was not in the command of the step before.
    pub leap: Option<Leap>,
}

/// How the horse is to turn. Angles are headings about the world's Y axis: zero faces along X, to the left is positive.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Turn {
    /// At a rate, rad/s.
    Rate(f32),
    /// To a heading, rad, by the shorter way.
    Heading(f32),
    /// To the heading so many steps of [`TURN_STEP_RAD`] to the left of world X.
    Steps(i32),
}

impl Default for Turn {
    fn default() -> Self {
        Self::Rate(0.0)
    }
}

/// A leap's size.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Leap {
    /// How far the trunk rises in flight, metres; 0.05 to 1.2 for the reference horse.
    pub height_m: f32,
    /// How far the trunk travels in flight, metres; held to what its speed in that time can be.
    pub length_m: f32,
}
