//! The horse: one struct, one step.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::command::Command;
use super::feet::Foot;
use super::gait_choice::Choice;
use super::ground::Ground;
use super::leaping::Leaping;
use super::mixture::Timing;
use super::readout::{ChangeReadout, Readout};
use super::repertoire::{Repertoire, Way};
use super::state::HorseState;
use super::terrain::{Terrain, height_m};
use super::track::{Facing, Track};
use super::warp::Warp;
use crate::database::{DataError, Database};
use crate::gait::Gait;
use crate::limb::Side;
use crate::pose::Pose;
use crate::random::Random;
use crate::skeleton::Skeleton;

/// Longest time one step can take, s.
const LONGEST_S: f32 = 0.25;
/// Longer times are taken in equal parts no longer than this, s: a stance at full gallop lasts 0.07 s.
const LONGEST_PART_S: f32 = 1.0 / 30.0;

/// A horse that is driven step by step.
#[derive(Clone, Debug)]
pub struct Horse {
    repertoire: Arc<Repertoire>,
    state: HorseState,
}

impl Horse {
    /// A horse standing at the world's origin, facing along X. The seed decides what it chooses where it has a choice.
    ///
    /// # Errors
    /// Those of [`Repertoire::new`].
    pub fn new(database: &Database, skeleton: &Skeleton, seed: u64) -> Result<Self, DataError> {
        Ok(Self::of(Arc::new(Repertoire::new(database, skeleton)?), seed))
    }

    /// Another horse of a build that is ready.
    pub fn of(repertoire: Arc<Repertoire>, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let lead = if random.uniform() < 0.5 { Side::Left } else { Side::Right };
        let state = HorseState {
            pose: repertoire.standing,
            warp: Warp::steady(&repertoire, Way::of(Gait::Walk)),
            track: Track::new(DVec2::ZERO, 0.0),
            terrain: Terrain::default(),
            feet: [Foot::default(); 4],
            choice: Choice::of(Gait::Walk),
            lead,
            leaping: Leaping::default(),
            random,
            wished_m_s: repertoire.playable_m_s(Gait::Walk)[0],
            rate_hz: 0.0,
            speed_m_s: 0.0,
            timing: Timing::default(),
            gain_m: 0.0,
            is_halting: true,
            is_stepping: false,
            has_left: [false; 4],
            stillness: 1.0,
            drawn_m: [0.0; 2],
            pull_m: glam::Vec3::ZERO,
        };
        let mut horse = Self { repertoire, state };
        horse.place(DVec3::ZERO, 0.0, &super::FlatGround);
        horse
    }

    /// Stands the horse at a place (its height is the ground's, where there is ground), facing a heading in radians, and forgets
    /// what it was doing. Numbers that are none count as zero.
    pub fn place(&mut self, at: DVec3, heading_rad: f32, ground: &impl Ground) {
        let at = if at.is_finite() { at } else { DVec3::ZERO };
        let heading_rad = f64::from(if heading_rad.is_finite() { heading_rad } else { 0.0 });
        let (repertoire, state) = (&*self.repertoire, &mut self.state);
        state.track = Track::new(DVec2::new(at.x, at.z), heading_rad);
        state.terrain = Terrain::under(&state.track, repertoire.rig.trunk_m, repertoire.size, ground);
        state.warp = Warp::steady(repertoire, Way::of(Gait::Walk));
        (state.choice, state.leaping) = (Choice::of(Gait::Walk), Leaping::default());
        (state.stillness, state.rate_hz, state.speed_m_s) = (1.0, 0.0, 0.0);
        (state.drawn_m, state.pull_m, state.gain_m) = ([0.0; 2], glam::Vec3::ZERO, 0.0);
        state.wished_m_s = repertoire.playable_m_s(Gait::Walk)[0];
        for limb in 0..4 {
            let lateral = repertoire.rig.legs[limb].toe_lateral_m;
            let ahead_right = glam::Vec2::new(repertoire.standing_toes_m[limb], lateral);
            let foot = Facing::new(heading_rad).beside(state.track.at_m, ahead_right);
            let height = height_m(ground, foot).unwrap_or(at.y as f32);
            let print = DVec3::new(foot.x, f64::from(height), foot.y);
            state.feet[limb] = Foot::standing(print, heading_rad, ground);
        }
        state.pose_now(repertoire, ground, 0.0);
    }

    /// Moves the horse on by a time in seconds and returns its pose. A time that is negative or no number counts as zero, and nothing
    /// happens; more than a quarter of a second counts as a quarter; steps longer than 1/30 s are taken in equal parts.
    /// Allocates nothing, never panics; equal horses that are asked the same on the same ground give equal bytes.
    pub fn step(&mut self, command: &Command, dt_s: f32, ground: &impl Ground) -> &Pose {
        let dt_s = if dt_s > 0.0 { dt_s.min(LONGEST_S) } else { 0.0 };
        let parts = (dt_s / LONGEST_PART_S).ceil();
        for _ in 0..parts as u32 {
            self.state.advance(&self.repertoire, command, dt_s / parts, ground);
        }
        &self.state.pose
    }

    /// The pose after the last step.
    pub fn pose(&self) -> &Pose {
        &self.state.pose
    }

    /// The horse's skeleton.
    pub fn skeleton(&self) -> &Skeleton {
        self.repertoire.skeleton()
    }

    /// The motion it draws from, to make more horses of.
    pub fn repertoire(&self) -> &Arc<Repertoire> {
        &self.repertoire
    }

    /// Its state, to be kept.
    pub fn state(&self) -> &HorseState {
        &self.state
    }

    /// Goes back to a state that was kept. That of another build is taken over, too: from the next step on this horse's own legs stand
    /// where the other's stood.
    pub fn restore(&mut self, state: &HorseState) {
        self.state = *state;
    }

    /// What it is doing.
    pub fn readout(&self) -> Readout {
        let (state, repertoire) = (&self.state, &*self.repertoire);
        let change = state.warp.change().map(|(from, share)| ChangeReadout { from: from.gait, share });
        Readout {
            gait: state.warp.to.gait,
            lead: repertoire.lead(state.warp.to),
            is_standing: state.stillness > 0.0 && state.is_halting,
            change,
            speed_m_s: state.speed_m_s,
            heading_rad: state.track.heading_rad,
            turn_rate_rad_s: state.track.turn_rate_rad_s,
            stride_time_s: 1.0 / state.rate_hz,
            strides: state.warp.clock,
            phase: state.warp.phase(),
            leg_cycles: state.warp.cycles(),
            duty_factors: state.timing.duties,
            on_ground: state.feet.map(|foot| foot.is_planted),
            prints: state.feet.map(|foot| foot.print),
            lowered_m: -state.pull_m.y,
        }
    }
}
