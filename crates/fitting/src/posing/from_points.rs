//! The pose through the placed points of one panel.

use muybridge_capture::{Keypoint, KeypointState, Keypoints};
use muybridge_core::bone;

use crate::chain::Vec2;
use crate::layout::{BENDS, PANEL_DOF, PITCH, ROOT_X, ROOT_Y, SLIDES};
use crate::observation::attachment;
use crate::problem::LinearRow;
use crate::weights::Weights;

use super::damped::{Loss, PointTerm, PoseProblem, solve};
use super::{PanelPose, PanelPoser};

/// Repeatability of placed points, standard deviation of a coordinate, px: an annotation's own numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HandScatter {
    /// Of visible points.
    pub visible_px: f64,
    /// Of occluded points.
    pub occluded_px: f64,
}

/// Root against the start, m: the placed points alone say where the animal is.
const ROOT_SD_M: f64 = 2.0;
/// Factor on the Cauchy scale from a far start, as in the stride fit.
const TOLERANT: f64 = 4.0;
/// Steps with the tolerant loss, and with the final one.
const TOLERANT_STEPS: usize = 12;
const STEPS: usize = 40;

impl PanelPoser {
    /// The pose that runs through the placed points as nearly as bone lengths and joint limits allow; joints without
    /// points follow `start`, or stand at rest in the natural carriage. Without any point it is the start itself.
    pub fn pose_from_points(
        &self,
        keypoints: &Keypoints,
        scatter: HandScatter,
        start: Option<&PanelPose>,
    ) -> PanelPose {
        let weights = Weights::default();
        let given = start.and_then(|pose| self.within_limits(pose));
        let mean = given.unwrap_or_else(|| self.rest_pose());
        let points = self.terms(keypoints, scatter, &weights);
        if points.is_empty() {
            return mean;
        }
        let mut rows: Vec<LinearRow> = self.reciprocal.iter().chain(&self.fetlock).cloned().collect();
        if given.is_none() {
            rows.push(head_row(&weights));
        }
        let mean = if given.is_none() { self.carried_to(&mean, &points) } else { mean };
        let mut problem = PoseProblem {
            chain: &self.chain,
            lengths: &self.lengths,
            bounds: self.bounds(),
            mean,
            sd: sds(&weights),
            rows: &rows,
            points,
        };
        problem.set_cauchy(TOLERANT * weights.cauchy);
        let nearer = solve(&problem, &self.carried_to(&mean, &problem.points), TOLERANT_STEPS);
        problem.set_cauchy(weights.cauchy);
        solve(&problem, &nearer, STEPS)
    }

    fn terms(&self, keypoints: &Keypoints, scatter: HandScatter, weights: &Weights) -> Vec<PointTerm> {
        let terms = Keypoint::all().filter_map(|keypoint| {
            let placed = keypoints.get(keypoint)?;
            let hand_px = match placed.state {
                KeypointState::Visible => scatter.visible_px,
                KeypointState::Occluded | KeypointState::Absent => scatter.occluded_px,
            };
            let on = attachment(keypoint, self.facing);
            let target_m = self.world_m(placed.place()?, on);
            let sd_m = weights.landmark_sd_m.hypot(hand_px / self.px_per_m(on));
            let usable = target_m.iter().chain([&sd_m]).all(|value| value.is_finite());
            usable.then_some(PointTerm { on, target_m, sd_m, loss: Loss::Cauchy(weights.cauchy) })
        });
        terms.collect()
    }

    /// A pose moved so that its points and the wanted ones have the same mean.
    fn carried_to(&self, pose: &PanelPose, points: &[PointTerm]) -> PanelPose {
        let k = self.chain.kinematics(pose, &self.lengths);
        let offset = |axis: usize| {
            let sum: f64 = points.iter().map(|p| p.target_m[axis] - k.place(p.on)[axis]).sum();
            sum / points.len().max(1) as f64
        };
        let by: Vec2 = [offset(0), offset(1)];
        let mut carried = *pose;
        carried[ROOT_X] += by[0];
        carried[ROOT_Y] += by[1];
        carried
    }
}

impl PoseProblem<'_> {
    fn set_cauchy(&mut self, scale: f64) {
        for term in &mut self.points {
            term.loss = Loss::Cauchy(scale);
        }
    }
}

/// How far each unknown may stray from the start: the stride fit's own numbers.
fn sds(weights: &Weights) -> [f64; PANEL_DOF] {
    let mut sd = [ROOT_SD_M; PANEL_DOF];
    sd[PITCH] = weights.pitch_prior_sd;
    sd[BENDS..SLIDES].copy_from_slice(&weights.bend_prior_sd);
    sd[SLIDES..].fill(weights.slide_prior_sd);
    sd
}

/// The head's direction in the world, as in the stride fit: the sum of the bends from the root up to it.
fn head_row(weights: &Weights) -> LinearRow {
    let sd = weights.head_direction_sd;
    let bends = (bone::SPINE..=bone::HEAD).map(|i| BENDS + i).chain([PITCH]);
    LinearRow { terms: bends.map(|i| (i, 1.0 / sd)).collect(), constant: -weights.head_direction / sd }
}
