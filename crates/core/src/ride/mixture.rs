//! What a horse does at a moment: ways of moving, each at its speed, mixed by weights that add up to one.

use serde::{Deserialize, Serialize};

use super::clip::{BODY_CHANNELS, BodyRow, LEG_CHANNELS, LegRow};
use super::repertoire::{Paced, Repertoire, Way};
use crate::gait::Gait;

/// Weights of all ways; they add up to one.
pub(super) type Weights = [f32; Way::COUNT];

/// A way with less weight than this is left out.
const LEAST_WEIGHT: f32 = 1e-6;

/// The timing of a mixture: how its legs stand and swing, and how fast it goes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Timing {
    /// Strides per second.
    pub(super) rate_hz: f32,
    /// Speed of a body over feet that stand still, m/s.
    pub(super) speed_m_s: f32,
    /// Share of the stride each hoof is down.
    pub(super) duties: [f32; 4],
    /// How far the body goes over each standing hoof, metres.
    pub(super) steps_m: [f32; 4],
    /// How far its stride has each standing hoof go against the body, metres: the same, but in a leap at another speed.
    pub(super) own_steps_m: [f32; 4],
    /// Where each hoof stands ahead of the horse's place at the middle of the stance, metres.
    pub(super) prints_m: [f32; 4],
}

impl Timing {
    /// Length of a stride, metres.
    pub(super) fn stride_m(&self) -> f32 {
        self.speed_m_s / self.rate_hz
    }

    /// The same with steps of a share of their length: half of what is lacking is made up by their rate, the rest costs speed.
    pub(super) fn shortened(mut self, share: f32) -> Self {
        self.steps_m = self.steps_m.map(|step_m| step_m * share);
        self.own_steps_m = self.own_steps_m.map(|step_m| step_m * share);
        self.rate_hz /= share.sqrt();
        self.speed_m_s *= share.sqrt();
        self
    }
}

impl Paced<'_> {
    fn mix(&self, of: impl Fn(&super::clip::Clip) -> f32) -> f32 {
        let slower = of(self.slower);
        slower + self.share * (of(self.faster) - slower)
    }

    /// Share of the stride a leg's hoof is down.
    pub(super) fn duty(&self, limb: usize) -> f32 {
        let stored = self.way.stored(limb);
        self.mix(|clip| clip.duties[stored] * clip.speed_m_s * clip.stride_time_s) / self.length_m()
    }

    pub(super) fn print_m(&self, limb: usize) -> f32 {
        let stored = self.way.stored(limb);
        self.mix(|clip| clip.prints_m[stored])
    }

    /// Phase of a leg's foot strike; neighbouring speeds of a gait have the same.
    pub(super) fn strike(&self, limb: usize) -> f32 {
        self.slower.strikes[self.way.stored(limb)]
    }

    /// Distance covered in a stride, metres.
    pub(super) fn length_m(&self) -> f32 {
        self.mix(|clip| clip.speed_m_s * clip.stride_time_s)
    }

    /// Adds `weight` times a leg whose cycle from strike to strike is at `cycle` of a mixture with this duty factor.
    pub(super) fn add_leg(&self, limb: usize, cycle: f32, duty: f32, weight: f32, sum: &mut LegRow) {
        let stored = self.way.stored(limb);
        for (clip, share) in [(self.slower, 1.0 - self.share), (self.faster, self.share)] {
            if share > 0.0 {
                let phase = phase_of(clip.strikes[stored], clip.duties[stored], cycle, duty);
                clip.add_leg(stored, phase, weight * share, sum);
            }
        }
    }

    /// Adds `weight` times the body at the phase a leg is at.
    fn add_body(&self, limb: usize, cycle: f32, duty: f32, weight: f32, sum: &mut BodyRow) {
        let stored = self.way.stored(limb);
        for (clip, share) in [(self.slower, 1.0 - self.share), (self.faster, self.share)] {
            if share > 0.0 {
                let phase = phase_of(clip.strikes[stored], clip.duties[stored], cycle, duty);
                clip.add_body(phase, weight * share, sum);
            }
        }
    }
}

/// Phase of a stride, in `[0, 1)`, at which a leg that strikes there and stands for `own_duty` is as far in its step as one at
/// `cycle` with `duty`: Huang 2012, Eq. 3.6 and 3.7 with the keytimes strike, lift-off and next strike.
fn phase_of(strike: f32, own_duty: f32, cycle: f32, duty: f32) -> f32 {
    let since = if cycle < duty {
        cycle * own_duty / duty
    } else {
        own_duty + (cycle - duty) * (1.0 - own_duty) / (1.0 - duty)
    };
    let phase = strike + since;
    let phase = if phase >= 1.0 { phase - 1.0 } else { phase };
    phase.clamp(0.0, 1.0)
}

/// The ways that have weight.
pub(super) struct Mixture<'a> {
    ways: [Option<(Paced<'a>, f32)>; MOST_WAYS],
    /// What it amounts to.
    pub(super) timing: Timing,
}

/// So many ways are mixed at most; a horse whose mind is changed oftener forgets the least of them.
const MOST_WAYS: usize = 4;

impl<'a> Mixture<'a> {
    /// The mixture at a wished speed: each way goes at it as far as it can, and the leap at its own; with steps of a share of
    /// their length.
    pub(super) fn new(
        repertoire: &'a Repertoire,
        weights: &Weights,
        [wished_m_s, leaping_m_s]: [f32; 2],
        steps: f32,
    ) -> Self {
        let mut ways = [None; MOST_WAYS];
        let mut timing = Timing::default();
        let (mut n, mut length_m) = (0, 0.0);
        for (index, &weight) in weights.iter().enumerate() {
            if weight < LEAST_WEIGHT || n == MOST_WAYS {
                continue;
            }
            let way = Way::from_index(index);
            let [least, most] = repertoire.playable_m_s(way.gait);
            let speed_m_s = wished_m_s.clamp(least, most);
            let paced = repertoire.paced(way, speed_m_s);
            ways[n] = Some((paced, weight));
            n += 1;
            let [rate_hz, own_m] = if way.gait == Gait::Leap {
                let rate_hz = repertoire.leap.rate_hz(leaping_m_s);
                [rate_hz, leaping_m_s / rate_hz]
            } else {
                [speed_m_s / paced.length_m(), paced.length_m()]
            };
            timing.rate_hz += weight * rate_hz;
            length_m += weight * own_m;
            for limb in 0..4 {
                timing.steps_m[limb] += weight * paced.duty(limb) * own_m;
                timing.own_steps_m[limb] += weight * paced.duty(limb) * paced.length_m();
                timing.prints_m[limb] += weight * paced.print_m(limb);
            }
        }
        // Steps and strides are mixed; the duty factors follow, so that standing feet stand still.
        timing.duties = timing.steps_m.map(|step_m| step_m / length_m);
        timing.speed_m_s = timing.rate_hz * length_m;
        Self { ways, timing: timing.shortened(steps) }
    }

    /// A leg's posture at its place in its cycle.
    pub(super) fn leg(&self, limb: usize, cycle: f32) -> LegRow {
        let mut row = [0.0; LEG_CHANNELS];
        for (paced, weight) in self.ways.iter().flatten() {
            paced.add_leg(limb, cycle, self.timing.duties[limb], *weight, &mut row);
        }
        row
    }

    /// The body's posture: the mean of those the four legs have (spec 6.1); one leg speaks for all where they agree.
    pub(super) fn body(&self, cycles: &[f32; 4], legs_agree: bool) -> BodyRow {
        let mut row = [0.0; BODY_CHANNELS];
        let speaking = if legs_agree { 2..3 } else { 0..4 };
        let share = 1.0 / speaking.len() as f32;
        for (paced, weight) in self.ways.iter().flatten() {
            for limb in speaking.clone() {
                paced.add_body(limb, cycles[limb], self.timing.duties[limb], weight * share, &mut row);
            }
        }
        row
    }
}

/// Weights kept to what a [`Mixture`] can hold: the largest, adding up to one.
pub(super) fn kept(weights: &Weights) -> Weights {
    let mut order: [usize; Way::COUNT] = std::array::from_fn(|i| i);
    order.sort_unstable_by(|&a, &b| weights[b].total_cmp(&weights[a]));
    let mut kept = [0.0; Way::COUNT];
    // One place is left for the way it changes to.
    for &index in &order[..MOST_WAYS - 1] {
        kept[index] = weights[index];
    }
    let sum: f32 = kept.iter().sum();
    kept.map(|weight| weight / sum)
}
