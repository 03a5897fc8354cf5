//! A stride ready to be played on one skeleton: rows of numbers beside each other, one row a moment.

use crate::stride::{CURVE_SAMPLES, Contact};

/// Spine (4), neck (3), head, root height, pitch, surge.
pub(super) const BODY_CHANNELS: usize = 12;
/// Five bends, scapula slide, toe along the track against the uniform advance, toe height over the ground.
pub(super) const LEG_CHANNELS: usize = 8;

/// Places of the channels of a body.
pub(super) mod body {
    pub(in crate::ride) const HEIGHT: usize = 8;
    pub(in crate::ride) const PITCH: usize = 9;
    pub(in crate::ride) const SURGE: usize = 10;
}

/// Places of the channels of a leg; the five bends come first.
pub(super) mod leg {
    pub(in crate::ride) const SLIDE: usize = 5;
    pub(in crate::ride) const TOE_AHEAD: usize = 6;
    pub(in crate::ride) const TOE_HEIGHT: usize = 7;
}

pub(super) type BodyRow = [f32; BODY_CHANNELS];
pub(super) type LegRow = [f32; LEG_CHANNELS];

/// One moment of a stride.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Row {
    pub(super) body: BodyRow,
    pub(super) legs: [LegRow; 4],
}

/// A stride at one speed.
#[derive(Clone, Debug)]
pub(super) struct Clip {
    pub(super) speed_m_s: f32,
    pub(super) stride_time_s: f32,
    /// Phase of each foot strike.
    pub(super) strikes: [f32; 4],
    /// Share of the stride each hoof is down.
    pub(super) duties: [f32; 4],
    /// Where each hoof stands, ahead of the horse's place on its track at the middle of the stance, metres.
    pub(super) prints_m: [f32; 4],
    /// [`CURVE_SAMPLES`] rows, with the last one before them and the first two after them again.
    rows: Box<[Row]>,
}

impl Clip {
    /// A clip of [`CURVE_SAMPLES`] rows.
    pub(super) fn new(
        [speed_m_s, stride_time_s]: [f32; 2],
        contacts: &[Contact; 4],
        prints_m: [f32; 4],
        rows: &[Row],
    ) -> Self {
        let wrapped = rows.len() - 1..rows.len() + CURVE_SAMPLES + 2;
        Self {
            speed_m_s,
            stride_time_s,
            strikes: contacts.map(|contact| contact.strike_phase),
            duties: contacts.map(Contact::duty_factor),
            prints_m,
            rows: wrapped.map(|i| rows[i % rows.len()]).collect(),
        }
    }

    /// The rows about a phase in `[0, 1)` and their weights: Catmull-Rom, continuous in value and slope.
    fn about(&self, phase: f32) -> (&[Row; 4], [f32; 4]) {
        let at = phase * CURVE_SAMPLES as f32;
        let i = (at as usize).min(CURVE_SAMPLES - 1);
        let t = at - i as f32;
        let weights = [
            0.5 * t * ((2.0 - t) * t - 1.0),
            0.5 * (t * t * (3.0 * t - 5.0) + 2.0),
            0.5 * t * ((4.0 - 3.0 * t) * t + 1.0),
            0.5 * t * t * (t - 1.0),
        ];
        match self.rows[i..].first_chunk() {
            Some(rows) => (rows, weights),
            None => unreachable!("there are {} rows", CURVE_SAMPLES + 3),
        }
    }

    /// Adds `weight` times the body at a phase.
    pub(super) fn add_body(&self, phase: f32, weight: f32, sum: &mut BodyRow) {
        let (rows, [a, b, c, d]) = self.about(phase);
        let [r, s, t, u] = rows.each_ref().map(|row| &row.body);
        for i in 0..BODY_CHANNELS {
            sum[i] += weight * (a * r[i] + b * s[i] + c * t[i] + d * u[i]);
        }
    }

    /// Adds `weight` times a leg at a phase.
    pub(super) fn add_leg(&self, limb: usize, phase: f32, weight: f32, sum: &mut LegRow) {
        let (rows, [a, b, c, d]) = self.about(phase);
        let [r, s, t, u] = rows.each_ref().map(|row| &row.legs[limb]);
        for i in 0..LEG_CHANNELS {
            sum[i] += weight * (a * r[i] + b * s[i] + c * t[i] + d * u[i]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sampling_passes_through_the_rows_and_closes() {
        let contact = Contact { strike_phase: 0.0, lift_off_phase: 0.5 };
        let value = |k: usize| (k as f32 / CURVE_SAMPLES as f32 * std::f32::consts::TAU).sin();
        let rows: Vec<Row> =
            (0..CURVE_SAMPLES).map(|k| Row { body: [value(k); BODY_CHANNELS], ..Row::default() }).collect();
        let clip = Clip::new([1.0, 1.0], &[contact; 4], [0.0; 4], &rows);
        for k in 0..4 * CURVE_SAMPLES {
            let phase = k as f32 / (4 * CURVE_SAMPLES) as f32;
            let mut sum = [0.0; BODY_CHANNELS];
            clip.add_body(phase, 1.0, &mut sum);
            assert!((sum[3] - (phase * std::f32::consts::TAU).sin()).abs() < 1e-4, "{phase}");
        }
    }
}
