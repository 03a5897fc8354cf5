//! A small random generator whose sequence never changes, for everything that is drawn or chosen by chance.
//!
//! ## References
//! Steele, Lea & Flood, *Fast splittable pseudorandom number generators* (2014): `SplitMix64`.

use std::f64::consts::TAU;

use serde::{Deserialize, Serialize};

/// `SplitMix64` with uniform and normal numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Random {
    state: u64,
}

impl Random {
    /// Starts the sequence of a seed.
    pub fn new(seed: u64) -> Self {
        Self { state: seed }
    }

    fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Uniform in `[0, 1)`.
    pub fn uniform(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Uniform between two values.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Normal with mean 0 and variance 1 (Box and Muller).
    pub fn normal(&mut self) -> f64 {
        let radius = (-2.0 * (1.0 - self.uniform()).ln()).sqrt();
        radius * (TAU * self.uniform()).cos()
    }

    /// Marks `count` of `total` things, each set equally likely (selection sampling).
    pub fn choose(&mut self, count: usize, total: usize) -> Vec<bool> {
        let mut wanted = count.min(total);
        (0..total)
            .map(|i| {
                let taken = self.uniform() * ((total - i) as f64) < wanted as f64;
                wanted -= usize::from(taken);
                taken
            })
            .collect()
    }
}
