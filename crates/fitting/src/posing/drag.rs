//! A drag: the pose that follows a handle from the press of the button to its release.
//!
//! Every answer is the best pose for the pose at the start and the present target; the pose before only says where to
//! begin to look, and a clearly better answer from the start replaces it. So the way the pointer took leaves no trace,
//! and coming back brings the first pose back.

use muybridge_capture::Keypoint;

use crate::chain::Attachment;
use crate::observation::attachment;

use super::damped::{Loss, PointTerm, PoseProblem, solve};
use super::plan::Plan;
use super::{PanelPose, PanelPoser};

/// How much of the animal gives way to a handle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reach {
    /// The limb, or the neck, that the handle is on. Hip and shoulder, withers, back, croup and dock move the trunk all
    /// the same.
    #[default]
    Limb,
    /// The trunk too, where the limb or the neck cannot reach.
    Whole,
}

/// Options of a drag.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DragOptions {
    /// How much of the animal gives way.
    pub reach: Reach,
    /// Keypoints that must stay. Hooves labelled stance stay without being named, but for the hoof of a limb that is
    /// dragged by its knee or hock or below.
    pub pins: Vec<Keypoint>,
}

/// Standard deviation of the handle about the pointer, m: the pull of the other joints moves it by less.
const HANDLE_SD_M: f64 = 1.2e-3;
/// Distance beyond which the pull does not grow, in those: a target out of reach bends every joint as far as it goes, and
/// yet cannot tear at what is pinned.
const FULL_PULL_SD: f64 = 4.0;
/// A handle is followed as far as this from its first place, m: more than the length of the animal.
const FARTHEST_M: f64 = 4.0;
/// The pointer's way is followed in pieces of at most this, m, so that a jump ends where a slow drag would.
const PIECE_M: f64 = 0.15;
/// Steps for each piece on the way, at its end, and from the start.
const STEPS_ON_THE_WAY: usize = 3;
const STEPS: usize = 40;
const STEPS_AFRESH: usize = 25;
/// Where two poses answer a target, the one that continues the motion is left for the other at this share of its cost:
/// the equal ones of a joint that may bend either way are not to flicker.
const CLEARLY_BETTER: f64 = 0.25;

/// One gesture.
#[derive(Clone, Debug)]
pub struct Drag {
    poser: PanelPoser,
    plan: Plan,
    on: Attachment,
    start: PanelPose,
    start_m: [f64; 2],
    /// The latest target, m, and the pose that answers it.
    target_m: [f64; 2],
    pose: PanelPose,
}

impl Drag {
    /// Takes hold of a keypoint. A pose that is not finite is replaced by the rest pose.
    pub fn begin(poser: &PanelPoser, pose: &PanelPose, handle: Keypoint, options: &DragOptions) -> Self {
        let start = poser.within_limits(pose).unwrap_or_else(|| poser.rest_pose());
        let on = attachment(handle, poser.facing);
        let start_m = poser.chain.kinematics(&start, &poser.lengths).place(on);
        Self {
            plan: Plan::new(poser, &start, handle, options),
            poser: poser.clone(),
            on,
            start,
            start_m,
            target_m: start_m,
            pose: start,
        }
    }

    /// The pose whose handle is at a place of the plate, or as near to it as lengths, limits and pins allow.
    /// A target that is not finite leaves the pose as it is.
    pub fn to(&mut self, target_px: [f64; 2]) -> &PanelPose {
        let wanted_m = self.poser.world_m(target_px, self.on);
        if target_px.iter().chain(&wanted_m).all(|value| value.is_finite()) {
            self.follow(within(self.start_m, wanted_m, FARTHEST_M));
        }
        &self.pose
    }

    /// The pose that answers the latest target.
    pub fn pose(&self) -> &PanelPose {
        &self.pose
    }

    fn follow(&mut self, target_m: [f64; 2]) {
        let from = self.target_m;
        let way = [target_m[0] - from[0], target_m[1] - from[1]];
        let pieces = (way[0].hypot(way[1]) / PIECE_M).ceil().max(1.0);
        for piece in 1..pieces as usize {
            let share = piece as f64 / pieces;
            let at = [from[0] + share * way[0], from[1] + share * way[1]];
            self.pose = solve(&self.problem(at), &self.pose, STEPS_ON_THE_WAY);
        }
        let problem = self.problem(target_m);
        let [continued, afresh] = [(&self.pose, STEPS), (&self.start, STEPS_AFRESH)]
            .map(|(from, steps)| solve(&problem, from, steps));
        let better = problem.cost(&afresh) < CLEARLY_BETTER * problem.cost(&continued);
        self.pose = if better { afresh } else { continued };
        self.target_m = target_m;
    }

    fn problem(&self, target_m: [f64; 2]) -> PoseProblem<'_> {
        let mut points = self.plan.held.clone();
        points.push(PointTerm { on: self.on, target_m, sd_m: HANDLE_SD_M, loss: Loss::Huber(FULL_PULL_SD) });
        PoseProblem {
            chain: &self.poser.chain,
            lengths: &self.poser.lengths,
            bounds: self.plan.bounds,
            mean: self.start,
            sd: self.plan.sd,
            rows: &self.plan.rows,
            points,
        }
    }
}

/// The point of a disc that is nearest to another point on its ray from the centre.
fn within(centre: [f64; 2], point: [f64; 2], radius: f64) -> [f64; 2] {
    let offset = [point[0] - centre[0], point[1] - centre[1]];
    let share = (radius / offset[0].hypot(offset[1])).min(1.0);
    if share.is_nan() { centre } else { [centre[0] + share * offset[0], centre[1] + share * offset[1]] }
}
