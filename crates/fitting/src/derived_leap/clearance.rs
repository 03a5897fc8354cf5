//! A fence in the middle of the leap, and how much room the toes leave over it.

use muybridge_core::{Limb, Pair, Skeleton, Stride};

/// Instants at which a toe is looked at.
const LOOKS: usize = 480;

/// A bar across the track.
#[derive(Clone, Copy, Debug)]
pub(super) struct Fence {
    /// Place along the track from the root's place at phase 0, m.
    pub(super) x_m: f64,
    /// Height over the ground, m.
    pub(super) height_m: f64,
}

impl Fence {
    /// Midway between the last hind print and the first fore print, as high as a share of the horse.
    pub(super) fn under(stride: &Stride, skeleton: &Skeleton, height: f64) -> Self {
        let prints = |pair: Pair| {
            let legs = Limb::ALL.into_iter().filter(move |limb| limb.pair() == pair);
            legs.map(|limb| {
                let contact = stride.contacts[limb.index()];
                // The stance that runs into phase 0 began with the print a stride behind the stored one.
                let turns = if contact.strike_phase > contact.lift_off_phase { 1.0 } else { 0.0 };
                f64::from(stride.prints_m[limb.index()] - turns * stride.stride_length_m())
            })
        };
        let last_m = prints(Pair::Hind).fold(f64::NEG_INFINITY, f64::max);
        let first_m = prints(Pair::Fore).fold(f64::INFINITY, f64::min);
        Self { x_m: 0.5 * (last_m + first_m), height_m: height * f64::from(skeleton.withers_height_m) }
    }

    /// Least height of a toe over the bar as it passes over it, m; negative where it knocks the bar down.
    pub(super) fn cleared_by_m(&self, stride: &Stride, skeleton: &Skeleton, limb: Limb) -> f64 {
        let toe = |k: usize| {
            let toe = stride.pose(k as f32 / LOOKS as f32).joints(skeleton).toe(limb);
            [f64::from(toe.x), f64::from(toe.y)]
        };
        let passes = (0..LOOKS).filter_map(|k| {
            let ([x0, y0], [x1, y1]) = (toe(k), toe(k + 1));
            let share = (self.x_m - x0) / (x1 - x0);
            (0.0..=1.0).contains(&share).then_some(y0 + share * (y1 - y0) - self.height_m)
        });
        passes.fold(f64::INFINITY, f64::min)
    }
}
