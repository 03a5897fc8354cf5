//! The run-time half of the toolchain: skeleton, pose, stride, gait and the embedded motion database.
//!
//! # Conventions
//!
//! SI units throughout: metres, seconds, radians, kilograms; speeds in m/s.
//! World space is right-handed: X forward, Y up, Z to the horse's right.
//! A bone's *bend* is its direction minus its parent's, counter-clockwise positive as seen from the horse's
//! right side (looking along -Z): zero is straight, and the sign is kept, so that a knee never inverts.
//! Legs are always in the order left fore, right fore, left hind, right hind ([`Limb::ALL`]).
//! Phase is cyclic in `[0, 1)`; intervals of phase may run through the wrap.
//! Names carry spaces and units (`point_in_world`, `stride_time_s`); transforms are named `a_from_b`.
//!
//! This crate opens no file, reads no clock, starts no thread and draws chance only from a seed it is given ([`Random`]): equal inputs give equal bytes.
//! It depends on glam and serde, and on `serde_json` only to parse the two data files compiled into it.

mod database;
mod foot_phase;
mod gait;
mod law;
mod limb;
mod packed;
mod pose;
mod provenance;
mod random;
mod ride;
mod skeleton;
mod speed_blend;
mod stride;

pub use database::{DATABASE_SCHEMA, DataError, Database};
pub use foot_phase::{
    FootPhase, FootPhaseTest, LANDED_FETLOCK_DEG, LEAST_HEIGHT_SHARE, LIFTED_FETLOCK_DEG, toe_ahead_m,
};
pub use gait::{Gait, Lead};
pub use law::{ContactLaw, Interval, LawKind, MPS_PER_MPH, PowerLaw};
pub use limb::{Limb, Pair, Side};
pub use packed::CURVE_STEP;
pub use pose::{Joints, Pose};
pub use provenance::{Provenance, SpeedSource};
pub use random::Random;
pub use ride::{
    ChangeReadout, Command, FlatGround, Ground, Horse, HorseState, Leap, LegReach, OwnGait, ReachMiss,
    Readout, Repertoire, Surface, TURN_STEP_RAD, ToeAim, Turn,
};
pub use skeleton::{
    BODY_BONE_COUNT, BONE_COUNT, Bone, FetlockCoupling, ReciprocalCoupling, SKELETON_SCHEMA, Skeleton,
    SwingFetlock, bone,
};
pub use speed_blend::SpeedBlend;
pub use stride::{CHANNEL_COUNT, CURVE_SAMPLES, Contact, Curves, Stride};

/// Runs the README's example as a test.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
