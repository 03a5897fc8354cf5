//! When each hoof of the leap is down, on the samples of the stride's curves.

use muybridge_core::{CURVE_SAMPLES, Contact, Limb, Pair, Side};

use crate::synthetic::{LeapBody, LeapStance};

/// A sample of the curves, share of the stride.
pub(super) const SAMPLE: f64 = 1.0 / CURVE_SAMPLES as f64;

/// Times and footfalls of one period of the leap.
pub(super) struct Plan {
    pub(super) lead: Side,
    pub(super) speed_m_s: f64,
    pub(super) stride_time_s: f64,
    pub(super) contacts: [Contact; 4],
    /// When each toe is held on its print: a sample longer at either end, for a curve bends over the samples beside it.
    pub(super) held: [Contact; 4],
    /// How far ahead of scapula or croup each toe stands in the middle of its stance, m.
    pub(super) toe_ahead_m: [f64; 4],
    /// When the period that is cut out of the drawn leap begins and ends, in that leap's time, s.
    pub(super) span_s: [f64; 2],
    /// Sample of the drawn leap's period that is phase 0: on the left lead the left hind strikes second.
    first_sample: usize,
}

impl Plan {
    pub(super) fn new(leap: &LeapBody, lead: Side) -> Self {
        let span_s = leap.span_s(Limb::new(Pair::Hind, lead.opposite()));
        let stride_time_s = span_s[1] - span_s[0];
        // Instants lie on samples, so that no curve has to turn between two of them.
        let sample =
            |time_s: f64| ((time_s - span_s[0]) / stride_time_s * CURVE_SAMPLES as f64).round() as usize;
        let mut stances: [LeapStance; 4] = Limb::ALL.map(|limb| leap.stance(limb));
        // Both hinds push off at once: the leading one, a hundredth of a second later, would be at the end of its reach.
        let [left_hind, right_hind] = [Limb::LH, Limb::RH].map(|limb| stances[limb.index()].lift_off_s);
        for limb in [Limb::LH, Limb::RH] {
            stances[limb.index()].lift_off_s = left_hind.min(right_hind);
        }
        let first_sample = sample(stances[Limb::LH.index()].strike_s);
        let phase = |time_s: f64| {
            let after = (sample(time_s) + CURVE_SAMPLES - first_sample) % CURVE_SAMPLES;
            after as f32 / CURVE_SAMPLES as f32
        };
        let contacts = stances.map(|stance| Contact {
            strike_phase: phase(stance.strike_s),
            lift_off_phase: phase(stance.lift_off_s),
        });
        Self {
            lead,
            speed_m_s: leap.speed_m_s(),
            stride_time_s,
            contacts,
            held: contacts.map(|contact| Contact {
                strike_phase: (contact.strike_phase - SAMPLE as f32).rem_euclid(1.0),
                lift_off_phase: (contact.lift_off_phase + SAMPLE as f32).rem_euclid(1.0),
            }),
            toe_ahead_m: stances.map(|stance| stance.toe_ahead_m),
            span_s,
            first_sample,
        }
    }

    /// Time of the drawn leap at a sample of the stride, s.
    pub(super) fn time_s(&self, sample: usize) -> f64 {
        let along = (sample + self.first_sample) % CURVE_SAMPLES;
        self.span_s[0] + along as f64 / CURVE_SAMPLES as f64 * self.stride_time_s
    }
}
