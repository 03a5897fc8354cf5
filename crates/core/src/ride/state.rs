//! All that changes from step to step.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use super::feet::Foot;
use super::gait_choice::Choice;
use super::leaping::Leaping;
use super::mixture::Timing;
use super::terrain::Terrain;
use super::track::Track;
use super::warp::Warp;
use crate::limb::Side;
use crate::pose::Pose;
use crate::random::Random;

/// All that changes from step to step: plain data, to be kept for a save game or a rollback. Its numbers
/// are of both precisions: a format that keeps every bit of them (a binary one, or `serde_json` with its feature `float_roundtrip`)
/// brings back the very same horse.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct HorseState {
    pub(super) pose: Pose,
    pub(super) warp: Warp,
    pub(super) track: Track,
    pub(super) terrain: Terrain,
    pub(super) feet: [Foot; 4],
    pub(super) choice: Choice,
    pub(super) lead: Side,
    pub(super) leaping: Leaping,
    pub(super) random: Random,
    /// The speed that the ways of moving are played at, m/s.
    pub(super) wished_m_s: f32,
    /// The timing of what it does now.
    pub(super) timing: Timing,
    /// Strides per second of the clock; none at rest.
    pub(super) rate_hz: f32,
    /// Speed along the heading, m/s.
    pub(super) speed_m_s: f32,
    /// What the stride's length gains in a stride, metres.
    pub(super) gain_m: f32,
    /// Whether a halt is asked for.
    pub(super) is_halting: bool,
    /// Whether a standing horse has yet a step to take.
    pub(super) is_stepping: bool,
    /// Feet that have just left the ground.
    pub(super) has_left: [bool; 4],
    /// From going, 0, to standing, 1, evenly; posture and speed follow it smoothly.
    pub(super) stillness: f32,
    /// The body against its place on the track: where its standing feet draw it, ahead and to the right, metres.
    pub(super) drawn_m: [f32; 2],
    /// The body against where its stride has it: pulled by feet that are out of reach, world space, metres.
    pub(super) pull_m: Vec3,
}

impl HorseState {
    /// The speeds that gaits and the leap are played at, m/s.
    pub(super) fn speeds_m_s(&self) -> [f32; 2] {
        [self.wished_m_s, self.leaping.speed_m_s.max(1.0)]
    }
}
