//! Asynchronous time warping (Huang 2012, section 3.3.2; spec 6.1): every leg finds its own way from its place in the old gait's
//! stride to its place in the new one's.
//!
//! Each leg's cycle is the horse's clock plus the leg's own offset. In a gait the offsets are where its hooves strike; a change
//! moves each offset to the new gait's by the shorter way, so that the legs go through 2.5 strides of the clock (sigma*) and a little
//! more or less each (sigma^j), and are all exactly in the new gait at the end. The paper spreads the difference evenly over the
//! frames (Eq. 3.17); here it comes and goes smoothly, so that no leg's speed has a step. The paper's reference leg keeps the clock's
//! pace; here it is the point between the legs that leaves the farthest the least to catch up.

use serde::{Deserialize, Serialize};

use super::mixture::{Weights, kept};
use super::repertoire::{Repertoire, Way};
use super::retarget::smooth;

/// Strides of a change (Huang 2012: a horse changes its gait within two to three).
pub(super) const CHANGE_STRIDES: f32 = 2.5;

/// The legs' places against the clock, and the change under way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Warp {
    /// Strides gone.
    pub(super) clock: f64,
    /// How far the phase of the stride is ahead of the clock.
    ahead: f32,
    offsets: [f32; 4],
    /// How fast the offsets move, per stride of the clock.
    drifts: [f32; 4],
    pub(super) weights: Weights,
    pub(super) to: Way,
    change: Option<Change>,
}

/// A change under way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Change {
    began: f64,
    strides: f32,
    /// Shares of the change between which the postures change; the legs' places do all the while.
    mixing: [f32; 2],
    from: Way,
    from_weights: Weights,
    from_offsets: [f32; 4],
    from_drifts: [f32; 4],
    /// What each leg's offset gains: sigma^j - sigma*.
    gains: [f32; 4],
}

/// To the nearest equal angle: into -0.5 to 0.5 strides.
fn nearest(strides: f32) -> f32 {
    strides - strides.round()
}

/// The shift of all four that leaves the greatest of them the smallest: the middle of the smallest arc that holds them.
fn shift(gains: [f32; 4]) -> f32 {
    let mut sorted = gains.map(|gain| gain.rem_euclid(1.0));
    sorted.sort_by(f32::total_cmp);
    let gap = |i: usize| (sorted[(i + 1) % 4] - sorted[i]).rem_euclid(1.0);
    // Equal gains leave one gap of a whole stride.
    let wide = |i: usize| if sorted[0] == sorted[3] { f32::from(u8::from(i == 3)) } else { gap(i) };
    let widest = (0..4).max_by(|&a, &b| wide(a).total_cmp(&wide(b))).unwrap_or(3);
    let first = sorted[(widest + 1) % 4];
    first + 0.5 * (1.0 - wide(widest))
}

impl Warp {
    /// All legs in one way's stride.
    pub(super) fn steady(repertoire: &Repertoire, way: Way) -> Self {
        let mut weights = [0.0; Way::COUNT];
        weights[way.index()] = 1.0;
        let offsets = strikes(repertoire, way).map(|strike| -strike);
        Self { clock: 0.0, ahead: 0.0, offsets, drifts: [0.0; 4], weights, to: way, change: None }
    }

    /// Where each leg is in its cycle from strike to strike, `[0, 1)`.
    pub(super) fn cycles(&self) -> [f32; 4] {
        let phase = self.clock.rem_euclid(1.0) as f32;
        self.offsets.map(|offset| {
            let cycle = (phase + offset).rem_euclid(1.0);
            if cycle < 1.0 { cycle } else { 0.0 }
        })
    }

    /// Phase of the stride, `[0, 1)`: that of the way it is in or changes to, exact when no change is under way.
    pub(super) fn phase(&self) -> f32 {
        let phase = (self.clock + f64::from(self.ahead)).rem_euclid(1.0) as f32;
        if phase < 1.0 { phase } else { 0.0 }
    }

    /// How fast each leg's cycle goes, cycles per stride of the clock.
    pub(super) fn paces(&self) -> [f32; 4] {
        self.drifts.map(|drift| 1.0 + drift)
    }

    /// How much of the change is done, and from which way; none when none is under way.
    pub(super) fn change(&self) -> Option<(Way, f32)> {
        self.change.map(|change| (change.from, change.share(self.clock)))
    }

    /// Begins to change to a way, from whatever is going on.
    pub(super) fn begin(&mut self, repertoire: &Repertoire, to: Way, strides: f32) {
        let gains = self.gains(repertoire, to);
        let by = shift(gains);
        self.set_out(to, [strides, 0.0, strides], gains.map(|gain| nearest(gain - by)));
    }

    /// Begins to change to a way whose posture is taken on within the first so many strides.
    pub(super) fn begin_at_once(&mut self, repertoire: &Repertoire, to: Way, strides: f32, within: f32) {
        self.begin(repertoire, to, strides);
        if let Some(change) = &mut self.change {
            change.mixing = [0.0, within / strides];
        }
    }

    /// Begins to change to a way so that it ends at a phase of its stride, after at least so many strides of the clock, and its
    /// posture is taken on within the last so many.
    pub(super) fn begin_to_phase(
        &mut self,
        repertoire: &Repertoire,
        to: Way,
        [least_strides, within]: [f32; 2],
        phase: f32,
    ) {
        let gains = self.gains(repertoire, to);
        let by = shift(gains);
        let now = (self.clock.rem_euclid(1.0) as f32 - by).rem_euclid(1.0);
        let strides = least_strides + (phase - now - least_strides).rem_euclid(1.0);
        self.set_out(to, [strides, strides - within, strides], gains.map(|gain| nearest(gain - by)));
    }

    fn gains(&self, repertoire: &Repertoire, to: Way) -> [f32; 4] {
        let strikes = strikes(repertoire, to);
        std::array::from_fn(|limb| -strikes[limb] - self.offsets[limb])
    }

    fn set_out(&mut self, to: Way, [strides, mix_from, mix_to]: [f32; 3], gains: [f32; 4]) {
        let from = self.to;
        let from_weights = kept(&self.weights);
        self.change = Some(Change {
            began: self.clock,
            strides,
            mixing: [mix_from / strides, mix_to / strides],
            from,
            from_weights,
            from_offsets: self.offsets,
            from_drifts: self.drifts,
            gains,
        });
        self.to = to;
    }

    /// Moves the clock on; a change that is done leaves every leg exactly in the new gait.
    pub(super) fn advance(&mut self, repertoire: &Repertoire, strides: f32) {
        self.clock += f64::from(strides);
        let Some(change) = self.change else { return };
        let share = change.share(self.clock);
        if share >= 1.0 {
            self.arrive(repertoire);
            return;
        }
        let [from, to] = change.mixing;
        let mixed = smooth((share - from) / (to - from));
        for (now, from) in self.weights.iter_mut().zip(change.from_weights) {
            *now = (1.0 - mixed) * from;
        }
        self.weights[self.to.index()] += mixed;
        let weight = smooth(share);
        let left = 1.0 - share;
        for limb in 0..4 {
            // Cubic from the drift there was to none.
            let drift = change.from_drifts[limb];
            self.offsets[limb] = change.from_offsets[limb]
                + weight * change.gains[limb]
                + drift * change.strides * share * left * left;
            self.drifts[limb] =
                6.0 * share * left * change.gains[limb] / change.strides + drift * left * (1.0 - 3.0 * share);
        }
    }

    fn arrive(&mut self, repertoire: &Repertoire) {
        let Some(change) = self.change.take() else { return };
        let strikes = strikes(repertoire, self.to);
        // The legs agree on where in the stride they are.
        self.ahead = nearest(change.from_offsets[0] + change.gains[0] + strikes[0]);
        self.offsets = strikes.map(|strike| self.ahead - strike);
        self.drifts = [0.0; 4];
        self.weights = [0.0; Way::COUNT];
        self.weights[self.to.index()] = 1.0;
    }

    /// Sets the clock so that a leg is at a place of its cycle. For a horse whose feet are all at rest.
    pub(super) fn set_cycle(&mut self, limb: usize, cycle: f32) {
        let now = self.cycles()[limb];
        self.clock += f64::from((cycle - now).rem_euclid(1.0));
    }

    /// Whether all legs go through one stride.
    pub(super) fn is_steady(&self) -> bool {
        self.change.is_none()
    }
}

impl Change {
    fn share(&self, clock: f64) -> f32 {
        ((clock - self.began) as f32 / self.strides).clamp(0.0, 1.0)
    }
}

/// Phases of a way's foot strikes; those of neighbouring speeds are the same.
fn strikes(repertoire: &Repertoire, way: Way) -> [f32; 4] {
    let paced = repertoire.paced(way, 0.0);
    std::array::from_fn(|limb| paced.strike(limb))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shift_leaves_the_farthest_the_least() {
        for gains in [[0.1, 0.2, 0.9, 0.0], [0.5; 4], [0.0, 0.5, 0.5, 0.0], [-0.3, 1.4, 0.25, 0.6]] {
            let worst = |by: f32| gains.iter().map(|gain| nearest(gain - by).abs()).fold(0.0, f32::max);
            let best = (0..1000).map(|k| worst(k as f32 / 1000.0)).fold(1.0, f32::min);
            assert!(worst(shift(gains)) < best + 2e-3, "{gains:?}: {} {best}", worst(shift(gains)));
        }
    }
}
