//! The horse at any time.

use muybridge_core::Pose;

use super::giving::Giving;
use super::plan::HorsePlan;
use crate::knots::Trajectory;

/// A print missed by no more than this is hit, metres.
const HIT_M: f64 = 1e-3;

/// A horse over its prints, carried by its centre of mass.
#[derive(Clone, Debug)]
pub(crate) struct HorseMotion {
    pub(super) plan: HorsePlan,
    pub(super) trajectory: Trajectory,
    pub(super) giving: Giving,
}

impl HorseMotion {
    /// A planned motion with the curve of its centre of mass.
    pub(crate) fn new(plan: HorsePlan, trajectory: Trajectory) -> Self {
        let giving = Giving::new(&plan, &trajectory);
        Self { plan, trajectory, giving }
    }

    /// The pose at a time, s; held at the ends of the motion.
    pub(crate) fn pose(&self, time_s: f64) -> Pose {
        let time_s = if time_s.is_nan() { 0.0 } else { time_s.clamp(0.0, self.plan.end_s()) };
        let (mut pose, wanted) = self.plan.carried(time_s, self.trajectory.at(time_s).at);
        pose.root_in_world += self.giving.at(time_s).as_vec3();
        self.plan.reach(&mut pose, &wanted);
        pose
    }

    /// Prints (their place among all) that a leg cannot stay on, with the most it misses them by, metres.
    pub(crate) fn misses(&self) -> impl Iterator<Item = (usize, f64)> {
        self.giving.misses_m.iter().copied().enumerate().filter(|(_, miss_m)| *miss_m > HIT_M)
    }
}
