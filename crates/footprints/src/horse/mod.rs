//! The horse that steps where it is told: prints laid by a gait, what the energy knows of them, and the pose over them.
//!
//! ```text
//! lay_horse -> (placed prints) -> HorsePlan: stances, orientation -> (centre of mass) -> HorseMotion: pose
//! ```
//!
//! Legs, spine, neck and head move as in the motion database's gait at the track's speed, solved for the skeleton
//! ([`muybridge_core::OwnGait`]); each leg's clock runs from its own print to its own print, so that prints may be moved and retimed.
//! Where the root is follows from the centre of mass. A hoof on the ground stays on its print: where a leg cannot reach, the body
//! gives way.

mod flexing;
mod gait;
mod giving;
mod lay;
mod leg;
mod model;
mod motion;
mod pacing;
mod plan;
mod series;
mod swing;
mod trunk;

#[cfg(test)]
mod tests;

pub(crate) use lay::lay_horse;
pub use model::HorseModel;
pub(crate) use motion::HorseMotion;
pub(crate) use plan::HorsePlan;

/// The outline of a right hoof's print, x ahead and z to the right of its middle, metres: a shoe of 13 cm, by eye.
pub const HOOF_OUTLINE_M: [[f64; 2]; 14] = [
    [-0.062, -0.046],
    [-0.02, -0.062],
    [0.03, -0.056],
    [0.06, -0.028],
    [0.067, 0.0],
    [0.06, 0.028],
    [0.03, 0.056],
    [-0.02, 0.062],
    [-0.062, 0.046],
    [-0.055, 0.026],
    [-0.012, 0.033],
    [0.026, 0.0],
    [-0.012, -0.033],
    [-0.055, -0.026],
];
