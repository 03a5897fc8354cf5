//! The pose of a two-legged figure.

use glam::{DQuat, DVec3};

/// What a foot does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FootState {
    /// Flat on its print.
    Flat,
    /// On its toes, the heel raised by so much, radians.
    OnToes {
        /// Heel rise, radians.
        rise_rad: f64,
    },
    /// In the air, so far from lift-off (0) to strike (1).
    Swing {
        /// 0 to 1.
        share: f64,
    },
}

/// One leg.
#[derive(Clone, Debug, PartialEq)]
pub struct LegPose {
    /// Hip, knee, (hock,) ankle, world space, metres.
    pub joints: Vec<DVec3>,
    /// Turns the foot's frame (X to the toes, Y up from the sole, Z right) into world space.
    pub world_from_foot: DQuat,
    /// Heel and toe on the sole, world space, metres.
    pub heel: DVec3,
    /// Toe.
    pub toe: DVec3,
    /// What the foot does.
    pub state: FootState,
    /// How far the foot in stance is from its print because the leg cannot reach it, metres.
    pub miss_m: f64,
}

/// A two-legged figure at a moment.
#[derive(Clone, Debug, PartialEq)]
pub struct BipedPose {
    /// Centre of mass, world space, metres.
    pub centre_of_mass: DVec3,
    /// Turns the body's frame (X ahead, Y up, Z right, origin at the centre of mass) into world space.
    pub world_from_body: DQuat,
    /// Left and right.
    pub legs: [LegPose; 2],
}
