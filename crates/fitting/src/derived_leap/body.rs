//! The body of the leap: one period cut out of the drawn leap and closed, flight left as it is.

use muybridge_core::{CURVE_SAMPLES, Limb, Side, Skeleton, Stride, bone};

use super::plan::Plan;
use crate::layout::{BENDS, PITCH};
use crate::synthetic::LeapBody;

/// Half the width of the differences that give slopes at the ends of the period, s.
const SLOPE_S: f64 = 0.002;
/// The neck is carried this far from the drawn leap's carriage towards the gallop's.
const GALLOPING_NECK: f64 = 0.5;

/// Trunk and centre of mass of the leap, at the samples of the stride.
pub(super) struct Body {
    pub(super) plan: Plan,
    pub(super) drawn: LeapBody,
    pitch_rad: Vec<f64>,
    /// Bends of spine, neck and head.
    bends_rad: Vec<Vec<f64>>,
    mass_height_m: Vec<f64>,
}

impl Body {
    pub(super) fn new(gallop: &Stride, skeleton: &Skeleton) -> Self {
        let lead = gallop.lead.map_or(Side::Right, |lead| lead.fore);
        let drawn = LeapBody::new(skeleton, lead);
        let plan = Plan::new(&drawn, lead);
        let closed = |channel: &dyn Fn(f64) -> f64| closed(&drawn, &plan, channel);
        let bends_rad = (0..bone::LIMBS)
            .map(|bone| {
                let bends = closed(&|time_s| drawn.pose(time_s)[BENDS + bone]);
                let carriage = if bone < bone::NECK { 0.0 } else { GALLOPING_NECK };
                let offset = carriage
                    * (mean(gallop.curves.bends_rad[bone].iter().map(|b| f64::from(*b)))
                        - mean(bends.iter().copied()));
                let [low, high] = skeleton.bones[bone].limits_rad.map(f64::from);
                bends.into_iter().map(|bend| (bend + offset).clamp(low, high)).collect()
            })
            .collect();
        Self {
            pitch_rad: closed(&|time_s| drawn.pose(time_s)[PITCH]),
            bends_rad,
            mass_height_m: thrown(&drawn, &plan),
            plan,
            drawn,
        }
    }

    /// Sets pitch, spine, neck and head.
    pub(super) fn shape_trunk(&self, stride: &mut Stride) {
        let single = |values: &[f64]| values.iter().map(|v| *v as f32).collect();
        stride.curves.pitch_rad = single(&self.pitch_rad);
        for (curve, bends) in stride.curves.bends_rad.iter_mut().zip(&self.bends_rad) {
            *curve = single(bends);
        }
    }

    /// Moves the root to where the centre of mass keeps its path, lowered by a length; at phase 0 it is not ahead.
    pub(super) fn place_root(&self, stride: &mut Stride, skeleton: &Skeleton, lowered_m: f64) {
        for k in 0..CURVE_SAMPLES {
            let phase = k as f32 / CURVE_SAMPLES as f32;
            let mass = stride.pose(phase).centre_of_mass(skeleton);
            stride.curves.surge_m[k] += stride.stride_length_m() * phase - mass.x;
            stride.curves.height_m[k] += (self.mass_height_m[k] - lowered_m) as f32 - mass.y;
        }
        let ahead_m = stride.curves.surge_m[0];
        stride.curves.surge_m.iter_mut().for_each(|surge| *surge -= ahead_m);
    }

    /// Bends of a leg as the drawn leap folds it at a time of that leap, rad.
    pub(super) fn drawn_bends(&self, limb: Limb, time_s: f64) -> [f64; 5] {
        let pose = self.drawn.pose(time_s);
        std::array::from_fn(|joint| pose[BENDS + limb.first_bone() + joint])
    }
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

/// A channel of the drawn leap at the samples of the stride. What its end differs from its beginning, in value and slope, is
/// taken away half before the take-off and half after the touch-down, so that the flight stays as it is.
fn closed(drawn: &LeapBody, plan: &Plan, channel: &dyn Fn(f64) -> f64) -> Vec<f64> {
    let slope = |time_s: f64| slope(channel, time_s);
    let ([begin_s, end_s], [take_off_s, touch_down_s]) = (plan.span_s, drawn.flight_s());
    let gap = 0.5 * (channel(end_s) - channel(begin_s));
    let slope_gap = 0.5 * (slope(end_s) - slope(begin_s));
    let correction = |time_s: f64| {
        if time_s < take_off_s {
            let width_s = take_off_s - begin_s;
            fading(gap, slope_gap * width_s, (time_s - begin_s) / width_s)
        } else if time_s > touch_down_s {
            let width_s = end_s - touch_down_s;
            fading(-gap, slope_gap * width_s, (end_s - time_s) / width_s)
        } else {
            0.0
        }
    };
    (0..CURVE_SAMPLES)
        .map(|k| {
            let time_s = plan.time_s(k);
            channel(time_s) + correction(time_s)
        })
        .collect()
}

/// Slope of a channel, per second.
fn slope(channel: impl Fn(f64) -> f64, time_s: f64) -> f64 {
    (channel(time_s + SLOPE_S) - channel(time_s - SLOPE_S)) / (2.0 * SLOPE_S)
}

/// Height of the centre of mass at the samples of the stride, m: the drawn leap's parabola in flight, and before and after it
/// one cubic each to its state at the strike of the gathered hinds. So the force of the fores fades until they leave the
/// ground, and that of the hinds grows until they do; the drawn leap's own landing serves its next canter stride.
fn thrown(drawn: &LeapBody, plan: &Plan) -> Vec<f64> {
    let height = |time_s: f64| drawn.mass_height_m(time_s);
    let ([begin_s, end_s], [take_off_s, touch_down_s]) = (plan.span_s, drawn.flight_s());
    let state = |time_s: f64, slope_at_s: f64| [height(time_s), slope(height, slope_at_s)];
    // Slopes at the ends of the flight are those inside it.
    let take_off = state(take_off_s, take_off_s + SLOPE_S);
    let touch_down = state(touch_down_s, touch_down_s - SLOPE_S);
    let gathered = state(end_s, end_s);
    (0..CURVE_SAMPLES)
        .map(|k| {
            let time_s = plan.time_s(k);
            if time_s < take_off_s {
                cubic(gathered, take_off, take_off_s - begin_s, time_s - begin_s)
            } else if time_s > touch_down_s {
                cubic(touch_down, gathered, end_s - touch_down_s, time_s - touch_down_s)
            } else {
                height(time_s)
            }
        })
        .collect()
}

/// A cubic from one value and slope to another over a duration, at a time in it.
fn cubic([v0, s0]: [f64; 2], [v1, s1]: [f64; 2], duration_s: f64, time_s: f64) -> f64 {
    let at = time_s / duration_s;
    fading(v0, s0 * duration_s, at) + fading(v1, -s1 * duration_s, 1.0 - at)
}

/// A cubic with this value and slope at 0 and neither at 1.
fn fading(value: f64, slope: f64, at: f64) -> f64 {
    let rest = (1.0 - at) * (1.0 - at);
    rest * (value * (1.0 + 2.0 * at) + slope * at)
}
