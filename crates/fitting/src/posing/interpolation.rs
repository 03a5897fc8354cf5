//! Keypoints of a panel from the panels before and after it, by way of poses.
//!
//! Between two panels a joint runs on an arc, and its pixels on a chord. So bends are interpolated, not pixels: cubic
//! curves through the poses of two panels on either side, over the end of the stride where it closes.

use muybridge_capture::{
    Facing, Keypoint, KeypointState, Keypoints, LegContacts, NearOff, PanelCamera, Placed, PlacedBy,
};
use muybridge_core::Skeleton;

use crate::layout::{PANEL_DOF, ROOT_X, SHARED};
use crate::observation::attachment;

use super::{HandScatter, PanelPose, PanelPoser};

/// A panel of the sequence, in the order of time.
#[derive(Clone, Debug)]
pub struct SequencePanel {
    /// Panel number; neighbours are one apart in time.
    pub panel: u32,
    /// Its camera.
    pub camera: PanelCamera,
    /// What is placed in it. Leave out what was itself interpolated.
    pub keypoints: Keypoints,
    /// Contact labels.
    pub contacts: LegContacts,
}

/// Fewest placed points from which a pose is taken.
const LEAST_POINTS: usize = 3;
/// Neighbours looked for on each side.
const NEIGHBOURS: usize = 2;

/// A panel that has points: when it is, its pose, and what the pose leaves unexplained.
struct Posed<'a> {
    at: f64,
    panel: &'a SequencePanel,
    /// Root relative to the camera.
    pose: PanelPose,
    /// Placed less posed, m, of each keypoint.
    left_over_m: Vec<Option<[f64; 2]>>,
}

/// Places for a panel from the placed points of the others, marked as interpolated.
///
/// `period_panels` is the number of panels after which the movement repeats, where it is known; without it nothing is
/// carried over the end of the sequence. Only keypoints placed in one of the two nearest panels come back; what a pose
/// does not explain of a placed point is carried along. Nothing comes back without placed panels on both sides.
pub fn interpolate(
    skeleton: &Skeleton,
    facing: Facing,
    lengths: &[f64; SHARED],
    sequence: &[SequencePanel],
    target: u32,
    period_panels: Option<f64>,
) -> Keypoints {
    let mut interpolated = Keypoints::default();
    let Some(wanted) = sequence.iter().find(|p| p.panel == target) else { return interpolated };
    let poser_of = |p: &SequencePanel| PanelPoser::new(skeleton, facing, lengths, p.camera, &p.contacts);
    let at = f64::from(target);
    let near = neighbours(sequence, at, period_panels);
    let mut posed: Vec<Posed<'_>> =
        near.into_iter().map(|(at, panel)| Posed::new(&poser_of(panel), at, panel)).collect();
    let Some(after) = posed.iter().position(|p| p.at > at).filter(|after| *after > 0) else {
        return interpolated;
    };
    let drift_m = drift_m_per_panel(&posed, period_panels);
    for p in &mut posed {
        p.pose[ROOT_X] -= drift_m * p.panel_time();
    }
    let times: Vec<f64> = posed.iter().map(|p| p.at).collect();
    let weights = cubic_weights(&times, after, at);
    let blend = |value: &dyn Fn(&Posed<'_>) -> f64| -> f64 {
        posed.iter().zip(&weights).map(|(p, weight)| weight * value(p)).sum()
    };
    let mut pose: PanelPose = std::array::from_fn(|i: usize| blend(&|p| p.pose[i]));
    pose[ROOT_X] += drift_m * at + wanted.camera.camera_x_m;
    let poser = poser_of(wanted);
    let Some(pose) = poser.within_limits(&pose) else { return interpolated };
    let share = (at - times[after - 1]) / (times[after] - times[after - 1]);
    for keypoint in Keypoint::all() {
        if let Some(placed) = between(&poser, &pose, keypoint, [&posed[after - 1], &posed[after]], share) {
            interpolated.insert(keypoint, placed);
        }
    }
    interpolated
}

impl<'a> Posed<'a> {
    fn new(poser: &PanelPoser, at: f64, panel: &'a SequencePanel) -> Self {
        // A careful hand: the pose is to run through the points, and what is left over is carried along.
        let scatter = HandScatter { visible_px: 0.0, occluded_px: 0.0 };
        let mut pose = poser.pose_from_points(&panel.keypoints, scatter, None);
        let k = poser.chain.kinematics(&pose, &poser.lengths);
        let left_over_m = Keypoint::all().map(|keypoint| {
            let on = attachment(keypoint, poser.facing);
            let [x, y] = poser.world_m(panel.keypoints.place(keypoint)?, on);
            let [px, py] = k.place(on);
            Some([x - px, y - py])
        });
        let left_over_m = left_over_m.collect();
        pose[ROOT_X] -= panel.camera.camera_x_m;
        Self { at, panel, pose, left_over_m }
    }

    /// When its panel was taken, without the strides that were added: the drift of the root goes with that.
    fn panel_time(&self) -> f64 {
        f64::from(self.panel.panel)
    }
}

/// The nearest placed panels, two on each side where there are, with their times; rising.
fn neighbours(sequence: &[SequencePanel], at: f64, period: Option<f64>) -> Vec<(f64, &SequencePanel)> {
    let shifts = match period.filter(|p| p.is_finite() && *p >= 1.0) {
        Some(period) => vec![-period, 0.0, period],
        None => vec![0.0],
    };
    let placed = |p: &&SequencePanel| {
        let points = Keypoint::all().filter(|keypoint| p.keypoints.place(*keypoint).is_some()).count();
        points >= LEAST_POINTS && f64::from(p.panel) != at
    };
    let mut all: Vec<(f64, &SequencePanel)> = sequence
        .iter()
        .filter(placed)
        .flat_map(|p| shifts.iter().map(move |shift| (f64::from(p.panel) + shift, p)))
        .collect();
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    // A panel of the next stride may stand at the very time of one of this.
    all.dedup_by(|b, a| b.0 - a.0 < 1e-6);
    let after = all.iter().position(|(time, _)| *time > at).unwrap_or(all.len());
    let (first, end) = (after.saturating_sub(NEIGHBOURS), (after + NEIGHBOURS).min(all.len()));
    all[first..end].to_vec()
}

/// How fast the root moves against the cameras, m per panel: a line through the placed panels.
fn drift_m_per_panel(posed: &[Posed<'_>], period: Option<f64>) -> f64 {
    let n = posed.len() as f64;
    let mean = |value: &dyn Fn(&Posed<'_>) -> f64| posed.iter().map(value).sum::<f64>() / n;
    let (mean_t, mean_x) = (mean(&|p| p.panel_time()), mean(&|p| p.pose[ROOT_X]));
    let spread = mean(&|p| (p.panel_time() - mean_t).powi(2));
    let slope = mean(&|p| (p.panel_time() - mean_t) * (p.pose[ROOT_X] - mean_x)) / spread;
    // Without a period the curve itself follows the drift.
    if period.is_some() && slope.is_finite() { slope } else { 0.0 }
}

/// Weights of the values at rising times for a time between the ones before and at `after`: a cubic whose slopes are those
/// of parabolas through neighbours (Catmull-Rom for uneven times), a line's where there is no neighbour.
fn cubic_weights(times: &[f64], after: usize, at: f64) -> Vec<f64> {
    let (t1, t2) = (times[after - 1], times[after]);
    let h = t2 - t1;
    let u = (at - t1) / h;
    let mut weights = vec![0.0; times.len()];
    weights[after - 1] += (1.0 + 2.0 * u) * (1.0 - u).powi(2);
    weights[after] += u * u * (3.0 - 2.0 * u);
    let slopes = [(after - 1, h * u * (1.0 - u).powi(2)), (after, -h * u * u * (1.0 - u))];
    for (knot, factor) in slopes {
        match (knot.checked_sub(1), times.get(knot + 1)) {
            (Some(before), Some(next)) => {
                let (h1, h2) = (times[knot] - times[before], next - times[knot]);
                weights[before] -= factor * h2 / (h1 * (h1 + h2));
                weights[knot] += factor * (h2 - h1) / (h1 * h2);
                weights[knot + 1] += factor * h1 / (h2 * (h1 + h2));
            }
            _ => {
                weights[after - 1] -= factor / h;
                weights[after] += factor / h;
            }
        }
    }
    weights
}

/// A keypoint of the interpolated pose with what its neighbours have left over.
fn between(
    poser: &PanelPoser,
    pose: &[f64; PANEL_DOF],
    keypoint: Keypoint,
    nearest: [&Posed<'_>; 2],
    share: f64,
) -> Option<Placed> {
    let [before, after] = nearest.map(|p| p.left_over_m[keypoint.index()]);
    let left_over = match (before, after) {
        (Some(a), Some(b)) => [0, 1].map(|axis| a[axis] + share * (b[axis] - a[axis])),
        (one, other) => one.or(other)?,
    };
    let on = attachment(keypoint, poser.facing);
    let [x, y] = poser.chain.kinematics(pose, &poser.lengths).place(on);
    let at_px = poser.plate_px([x + left_over[0], y + left_over[1]], poser.depth_m(on));
    let closer = if share < 0.5 { nearest } else { [nearest[1], nearest[0]] };
    let states = closer.map(|p| p.panel.keypoints.get(keypoint).filter(|placed| placed.place().is_some()));
    let guessed = if matches!(keypoint, Keypoint::Limb(NearOff::Off, ..)) {
        KeypointState::Occluded
    } else {
        KeypointState::Visible
    };
    let state = states[0].or(states[1]).map_or(guessed, |placed| placed.state);
    let finite = at_px.iter().all(|value| value.is_finite());
    finite.then_some(Placed { at_px: Some(at_px), state, by: PlacedBy::Interpolated, sd_px: None })
}
