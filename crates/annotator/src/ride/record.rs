//! The last seconds of a ride, step by step, so that going back shows exactly what was.

use std::collections::VecDeque;
use std::sync::Arc;

use glam::Vec3;
use muybridge_core::{Horse, HorseState, Joints, Readout, Repertoire};

use super::terrain::Terrain;
use super::wants::Wants;

/// Steps of the simulation in a second.
pub const STEPS_PER_S: usize = 60;
/// Duration of a step, s.
pub const STEP_S: f64 = 1.0 / STEPS_PER_S as f64;
/// Seconds that are kept.
pub const KEPT_S: usize = 20;

/// A horse after a step.
#[derive(Clone)]
pub struct RiderFrame {
    /// Everything of it that changes.
    pub state: HorseState,
    /// What it was doing.
    pub readout: Readout,
    /// Where its joints were seen.
    pub joints: Joints,
    /// Where it was seen from where it moved, metres.
    pub offset_m: Vec3,
    /// The motion it drew from: that of its build.
    pub repertoire: Arc<Repertoire>,
}

impl RiderFrame {
    /// The horse as it is, seen at an offset.
    pub(super) fn of(horse: &Horse, offset_m: Vec3) -> Self {
        Self {
            state: *horse.state(),
            readout: horse.readout(),
            joints: super::shifted(&horse.pose().joints(horse.skeleton()), offset_m),
            offset_m,
            repertoire: Arc::clone(horse.repertoire()),
        }
    }
}

/// The ride after a step.
#[derive(Clone)]
pub struct Frame {
    /// Number of the step since the ride began.
    pub step: u64,
    /// What was asked for in that step.
    pub wants: Wants,
    /// The ground.
    pub terrain: Terrain,
    /// Horse A, and B where there is one.
    pub riders: [Option<RiderFrame>; 2],
}

/// The frames that are kept, oldest first; never empty.
pub struct Record {
    frames: VecDeque<Frame>,
}

impl Record {
    /// A record that begins with a frame.
    pub fn new(first: Frame) -> Self {
        let mut frames = VecDeque::with_capacity(KEPT_S * STEPS_PER_S + 1);
        frames.push_back(first);
        Self { frames }
    }

    /// Steps that can be gone back from the newest frame.
    pub fn depth(&self) -> usize {
        self.frames.len() - 1
    }

    /// The frame so many steps before the newest; the oldest when there are fewer.
    pub fn back(&self, steps: usize) -> &Frame {
        &self.frames[self.depth() - steps.min(self.depth())]
    }

    /// Frames from one so many steps back to one fewer back, oldest first.
    pub fn between(&self, from_back: usize, to_back: usize) -> impl DoubleEndedIterator<Item = &Frame> {
        let [from, to] = [from_back, to_back].map(|back| self.depth() - back.min(self.depth()));
        self.frames.range(from..=to.max(from))
    }

    /// Adds the frame after the newest; the oldest is forgotten when there are too many.
    pub fn push(&mut self, frame: Frame) {
        if self.frames.len() > KEPT_S * STEPS_PER_S {
            self.frames.pop_front();
        }
        self.frames.push_back(frame);
    }

    /// Forgets the newest frames, but not the last that is left.
    pub fn forget_newest(&mut self, steps: usize) {
        let left = self.depth() - steps.min(self.depth());
        self.frames.truncate(left + 1);
    }

    /// Puts another frame into the place of the newest.
    pub fn replace_newest(&mut self, frame: Frame) {
        self.frames.pop_back();
        self.frames.push_back(frame);
    }
}
