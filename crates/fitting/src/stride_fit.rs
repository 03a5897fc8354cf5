//! Fitting one stride: the stride time by a search, the poses and lengths by least squares, and how good it all is.

use muybridge_capture::{Keypoint, KeypointState};
use muybridge_core::Skeleton;

use crate::chain::{Attachment, Kinematics};
use crate::layout::{LOG_SCALE, PANEL_DOF};
use crate::levenberg::{Curvature, LeastSquares, Optimum, solve, solve_within};
use crate::observation::{StrideObservation, attachment, depth_m};
use crate::problem::StrideProblem;
use crate::weights::Weights;

/// A stride time with its standard deviation, s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrideTime {
    /// Best value, s.
    pub seconds: f64,
    /// Standard deviation from the curvature of the cost, s; zero when it was given.
    pub sd_s: f64,
}

/// Distance of a fitted point from the placed one.
#[derive(Clone, Debug, PartialEq)]
pub struct PointResidual {
    /// Panel number.
    pub panel: u32,
    /// Keypoint.
    pub keypoint: Keypoint,
    /// Seen or guessed.
    pub state: KeypointState,
    /// Placed, plate px.
    pub placed_px: [f64; 2],
    /// Fitted, plate px.
    pub fitted_px: [f64; 2],
    /// Scale at the panel, px/m.
    pub px_per_m: f64,
}

impl PointResidual {
    /// Distance, px.
    pub fn px(&self) -> f64 {
        (self.placed_px[0] - self.fitted_px[0]).hypot(self.placed_px[1] - self.fitted_px[1])
    }

    /// Distance, m.
    pub fn metres(&self) -> f64 {
        self.px() / self.px_per_m
    }
}

/// A fitted stride.
#[derive(Clone, Debug)]
pub struct StrideFit {
    /// The observation fitted.
    pub observation: StrideObservation,
    /// The problem, with phases and the order of panels in it.
    pub problem: StrideProblem,
    /// The solution.
    pub optimum: Optimum,
    /// The stride time.
    pub stride_time: StrideTime,
}

impl StrideFit {
    /// Poses worked out, in the order of phase.
    pub fn kinematics(&self) -> Vec<Kinematics> {
        self.problem.kinematics(&self.optimum.x)
    }

    /// Unknowns of one slot.
    pub fn pose(&self, slot: usize) -> &[f64] {
        &self.optimum.x[self.problem.layout.panel(slot, 0)..][..PANEL_DOF]
    }

    /// Strides since the first panel at which a slot's panel was taken; its fraction is the slot's phase.
    pub fn turns(&self, slot: usize) -> f64 {
        let panels = &self.observation.panels;
        let start_s = panels.first().map_or(0.0, |p| p.camera.time_s);
        (panels[self.problem.order[slot]].camera.time_s - start_s) / self.stride_time.seconds
    }

    /// The shared lengths.
    pub fn shared(&self) -> &[f64] {
        &self.optimum.x[self.problem.layout.shared(0)..]
    }

    /// Withers height of the animal: the reference's, scaled, m.
    pub fn withers_height_m(&self, reference: &Skeleton) -> f64 {
        f64::from(reference.withers_height_m) * self.shared()[LOG_SCALE].exp()
    }

    /// Place of a keypoint in a slot, plate px.
    pub fn place_px(&self, slot: usize, kinematics: &Kinematics, keypoint: Keypoint) -> [f64; 2] {
        self.place_attachment_px(slot, kinematics, attachment(keypoint, self.observation.facing))
    }

    /// Place of any point of the skeleton in a slot, plate px.
    pub fn place_attachment_px(&self, slot: usize, kinematics: &Kinematics, on: Attachment) -> [f64; 2] {
        let camera = &self.observation.panels[self.problem.order[slot]].camera;
        let [x, y] = kinematics.place(on);
        camera.plate_from_world([x, y, depth_m(&self.problem.chain, on, self.observation.facing)])
    }

    /// Distance of a bone towards the camera from the near hooves' plane, m.
    pub fn bone_depth_m(&self, bone: usize) -> f64 {
        depth_m(&self.problem.chain, Attachment::Tip(bone), self.observation.facing)
    }

    /// Residuals of the points of another observation of the same panels (or the same one), panel by panel.
    pub fn residuals_of(&self, observation: &StrideObservation) -> Vec<PointResidual> {
        let mut slots: Vec<(usize, Kinematics)> = self.kinematics().into_iter().enumerate().collect();
        slots.sort_by_key(|(slot, _)| self.problem.order[*slot]);
        let residuals = slots.iter().flat_map(|(slot, k)| {
            let panel = &observation.panels[self.problem.order[*slot]];
            panel.points.iter().map(|point| PointResidual {
                panel: panel.camera.panel,
                keypoint: point.keypoint,
                state: point.state,
                placed_px: point.at_px,
                fitted_px: self.place_px(*slot, k, point.keypoint),
                px_per_m: panel.camera.px_per_m,
            })
        });
        residuals.collect()
    }

    /// Standard error of each unknown from the final normal matrix, scaled by the residual variance.
    /// None when the matrix is singular.
    pub fn standard_errors(&self) -> Option<Vec<f64>> {
        let at = (&self.problem).linearize(&self.optimum.x, Curvature::GaussNewton);
        let freedom = (self.problem.residual_count() as f64 - self.optimum.x.len() as f64).max(1.0);
        // Priors count as data of their own; where they hold, the variance falls below one and is not used to shrink.
        let variance = (2.0 * at.cost / freedom).max(1.0);
        let diagonal = at.normal.factor(&[], &[])?.inverse_diagonal();
        Some(diagonal.iter().map(|v| (v * variance).sqrt()).collect())
    }
}

/// Root mean square of distances.
pub fn rms(distances: impl Iterator<Item = f64>) -> f64 {
    let (n, sum) = distances.fold((0.0, 0.0), |(n, sum), d| (n + 1.0, sum + d * d));
    if n > 0.0 { (sum / n).sqrt() } else { 0.0 }
}

/// Fits a stride of known stride time from the rest pose.
pub fn fit_stride(
    skeleton: &Skeleton,
    observation: &StrideObservation,
    stride_time: StrideTime,
    weights: &Weights,
) -> StrideFit {
    let problem = StrideProblem::new(skeleton, observation, stride_time.seconds, weights);
    let start = problem.rest_start(observation);
    let optimum = solve_from_afar(&problem, start);
    StrideFit { observation: observation.clone(), problem, optimum, stride_time }
}

/// Factor on the Cauchy scale for the first steps from a far start: points that lie far off only because the start is bad
/// then still pull, and the loss has one minimum for longer.
const TOLERANT: f64 = 4.0;
/// Steps taken so.
const TOLERANT_STEPS: u64 = 4;

/// Solves a stride from a start that may be far off.
pub fn solve_from_afar(problem: &StrideProblem, start: Vec<f64>) -> Optimum {
    let tolerant = problem.with_cauchy(TOLERANT * problem.weights.cauchy);
    let nearer = solve_within(&tolerant, start, TOLERANT_STEPS);
    solve(problem, nearer.x)
}

/// Fits a stride from a neighbouring solution: another stride time, or points left out.
pub fn refit_stride(
    skeleton: &Skeleton,
    observation: &StrideObservation,
    stride_time: StrideTime,
    weights: &Weights,
    from: &StrideFit,
) -> StrideFit {
    let problem = StrideProblem::new(skeleton, observation, stride_time.seconds, weights);
    let optimum = solve(&problem, carried_over(from, &problem));
    StrideFit { observation: observation.clone(), problem, optimum, stride_time }
}

/// The unknowns of one fit in the order of phases of another.
fn carried_over(from: &StrideFit, problem: &StrideProblem) -> Vec<f64> {
    let mut x = from.optimum.x.clone();
    for (slot, panel) in problem.order.iter().enumerate() {
        if let Some(old) = from.problem.order.iter().position(|p| p == panel) {
            x[problem.layout.panel(slot, 0)..][..PANEL_DOF].copy_from_slice(from.pose(old));
        }
    }
    x
}

/// Shortest and longest stride the search looks at, as shares of the time the panels span. Below two thirds the
/// sequence would show the stride one and a half times, above 1.2 a sixth of it would be missing.
pub(crate) const SEARCH_SPAN: [f64; 2] = [0.67, 1.2];
/// Steps of the coarse search; at 0.53 of a span of ten panels a step is a quarter of a panel.
const SEARCH_STEPS: usize = 22;
/// One step of the coarse search as a share of the span.
pub(crate) const SEARCH_STEP_SHARE: f64 = (SEARCH_SPAN[1] - SEARCH_SPAN[0]) / SEARCH_STEPS as f64;

/// Rounds of refinement; each halves the bracket, four bring it to a sixtieth of a panel.
const REFINEMENTS: usize = 4;

/// Fits a stride whose duration is unknown: where does the movement close upon itself?
///
/// The stride time with the least cost, refined by parabolas; its standard deviation from the last parabola's curvature
/// (twice the cost rises by one).
pub fn fit_stride_of_unknown_time(
    skeleton: &Skeleton,
    observation: &StrideObservation,
    weights: &Weights,
) -> StrideFit {
    let span_s = observation.duration_s();
    let step_s = span_s * SEARCH_STEP_SHARE;
    let exact = |seconds| StrideTime { seconds, sd_s: 0.0 };
    let mut latest = fit_stride(skeleton, observation, exact(span_s), weights);
    let mut best = latest.clone();
    for i in 0..=SEARCH_STEPS {
        let seconds = span_s * SEARCH_SPAN[0] + i as f64 * step_s;
        latest = refit_stride(skeleton, observation, exact(seconds), weights, &latest);
        best = better(best, latest.clone());
    }
    refine_stride_time(skeleton, weights, best, step_s)
}

/// Closes in on the stride time with the least cost from a fit within `bracket_s` of it.
fn refine_stride_time(skeleton: &Skeleton, weights: &Weights, start: StrideFit, bracket_s: f64) -> StrideFit {
    let mut best = start;
    let mut half_width_s = bracket_s;
    let mut curvature = None;
    for _ in 0..REFINEMENTS {
        half_width_s *= 0.5;
        let at = |seconds: f64| {
            let stride_time = StrideTime { seconds, sd_s: 0.0 };
            refit_stride(skeleton, &best.observation, stride_time, weights, &best)
        };
        let middle = best.stride_time.seconds;
        let (low, high) = (at(middle - half_width_s), at(middle + half_width_s));
        let second = low.optimum.cost - 2.0 * best.optimum.cost + high.optimum.cost;
        if second > 0.0 {
            curvature = Some(second / half_width_s.powi(2));
            let shift = 0.5 * half_width_s * (low.optimum.cost - high.optimum.cost) / second;
            let refined = at(middle + shift.clamp(-half_width_s, half_width_s));
            best = [low, high, refined].into_iter().fold(best, better);
        } else {
            best = [low, high].into_iter().fold(best, better);
        }
    }
    best.stride_time.sd_s = curvature.map_or(bracket_s, |c| 1.0 / c.sqrt()).max(half_width_s);
    best
}

fn better(a: StrideFit, b: StrideFit) -> StrideFit {
    if b.optimum.cost < a.optimum.cost { b } else { a }
}
