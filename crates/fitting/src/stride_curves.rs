//! A fitted stride between its panels: every unknown as a periodic curve of phase.

use crate::chain::Kinematics;
use crate::layout::{PANEL_DOF, ROOT_X};
use crate::periodic::PeriodicSpline;
use crate::stride_fit::StrideFit;

/// One curve per unknown of a panel; the root's place along the track as surge against uniform advance.
pub struct StrideCurves<'a> {
    fit: &'a StrideFit,
    channels: Vec<PeriodicSpline>,
}

impl<'a> StrideCurves<'a> {
    /// Curves through the fitted poses.
    pub fn new(fit: &'a StrideFit) -> Self {
        let problem = &fit.problem;
        let channels = (0..PANEL_DOF)
            .map(|dof| {
                let values: Vec<f64> = (0..problem.layout.panels)
                    .map(|slot| {
                        let advance =
                            if dof == ROOT_X { fit.turns(slot) * problem.stride_length_m } else { 0.0 };
                        fit.pose(slot)[dof] - advance
                    })
                    .collect();
                PeriodicSpline::new(&problem.phases, &values)
            })
            .collect();
        Self { fit, channels }
    }

    /// Value of one unknown at a phase; the root's place as surge.
    pub fn channel(&self, dof: usize, phase: f64) -> f64 {
        self.channels[dof].at(phase)
    }

    /// The pose at a phase (any real number; whole strides add their length).
    pub fn pose(&self, phase: f64) -> Vec<f64> {
        let mut pose: Vec<f64> = (0..PANEL_DOF).map(|dof| self.channel(dof, phase)).collect();
        pose[ROOT_X] += phase * self.fit.problem.stride_length_m;
        pose
    }

    /// Joints at a phase.
    pub fn kinematics(&self, phase: f64) -> Kinematics {
        self.fit.problem.chain.kinematics(&self.pose(phase), self.fit.shared())
    }
}
