//! The curve of the centre of mass, ready to be drawn: made anew only when the motion changes.

use egui::Color32;
use glam::DVec3;
use muybridge_footprints::{Foot, Motion, Remark, Support};

use crate::colors;

/// Time between two points of the curve, s.
const STEP_S: f64 = 1.0 / 60.0;
/// Points of the whole curve at most: that of a long track is coarser.
const MOST_POINTS: f64 = 30_000.0;

/// A part of the curve with the same feet on the ground.
pub(super) struct Run {
    pub(super) color: Color32,
    pub(super) points: Vec<DVec3>,
    pub(super) times_s: Vec<f64>,
}

/// The curve and what belongs to it.
#[derive(Default)]
pub(super) struct Curve {
    version: Option<u64>,
    pub(super) supports: Vec<Support>,
    pub(super) runs: Vec<Run>,
    /// Place and velocity at each knot.
    pub(super) knots: Vec<(DVec3, DVec3)>,
    /// Lowest and highest centre of mass, metres.
    pub(super) heights_m: [f64; 2],
    pub(super) remarks: Vec<Remark>,
}

impl Curve {
    /// Follows the motion.
    pub(super) fn follow(&mut self, motion: Option<&Motion>, version: u64) {
        if self.version == Some(version) {
            return;
        }
        *self = motion.map_or_else(Self::default, Self::of);
        self.version = Some(version);
    }

    fn of(motion: &Motion) -> Self {
        let supports = motion.placed.supports();
        let step_s = STEP_S.max(motion.duration_s() / MOST_POINTS);
        let run = |support: &Support| {
            let steps = ((support.to_s - support.from_s) / step_s).ceil().clamp(1.0, MOST_POINTS) as usize;
            let time_s =
                |i: usize| support.from_s + (support.to_s - support.from_s) * i as f64 / steps as f64;
            let times_s: Vec<f64> = (0..=steps).map(time_s).collect();
            let points = times_s.iter().map(|time_s| motion.centre_of_mass(*time_s).at).collect();
            Run { color: colors::support(&support.down), points, times_s }
        };
        let runs: Vec<Run> = supports.iter().map(run).collect();
        let heights = || runs.iter().flat_map(|run| &run.points).map(|at| at.y).filter(|y| y.is_finite());
        let heights_m =
            [heights().fold(f64::INFINITY, f64::min), heights().fold(f64::NEG_INFINITY, f64::max)];
        // A horse's curve begins before its prints and ends after them.
        let knots = motion.solved.trajectory.between(0.0, motion.duration_s());
        let knots = knots.map(|(_, knot)| (knot.at, knot.velocity)).collect();
        Self { version: None, heights_m, knots, remarks: motion.remarks(), supports, runs }
    }

    /// The feet on the ground at a time.
    pub(super) fn down(&self, time_s: f64) -> &[Foot] {
        Support::at(&self.supports, time_s).map_or(&[], |support| &support.down)
    }
}
