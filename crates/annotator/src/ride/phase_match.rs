//! At which phase of a plate's stride a horse is, from its footfalls.

use std::f64::consts::TAU;

use muybridge_core::Limb;

/// A match.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhaseMatch {
    /// Phase of the plate's stride, `[0, 1)`.
    pub phase: f64,
    /// How far the four legs disagree, 0 (not at all) to 1.
    pub spread: f64,
    /// Whether the plate's animal goes as the horse would in a mirror: on the other lead.
    pub is_mirrored: bool,
}

/// The phase of a plate at which its legs are as far in their cycles as the horse's. `cycles` are shares of each leg's cycle since
/// its strike, `strikes` the plate's phases of strike, both in the order of [`Limb::ALL`].
pub fn matched(cycles: [f32; 4], strikes: [f64; 4]) -> PhaseMatch {
    let straight = mean(Limb::ALL.map(|limb| strikes[limb.index()] + f64::from(cycles[limb.index()])));
    let twin = [1, 0, 3, 2];
    let mirrored = mean([0, 1, 2, 3].map(|i: usize| strikes[i] + f64::from(cycles[twin[i]])));
    let (is_mirrored, [phase, spread]) =
        if mirrored[1] + 1e-9 < straight[1] { (true, mirrored) } else { (false, straight) };
    PhaseMatch { phase, spread, is_mirrored }
}

/// Mean of phases around the circle, and how far they disagree.
fn mean(phases: [f64; 4]) -> [f64; 2] {
    let (sin, cos) = phases.iter().fold((0.0, 0.0), |(sin, cos), phase| {
        (sin + (TAU * phase).sin() / 4.0, cos + (TAU * phase).cos() / 4.0)
    });
    [(sin.atan2(cos) / TAU).rem_euclid(1.0), 1.0 - f64::hypot(sin, cos)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_phase_is_found_again_on_either_lead() {
        // A gallop: hinds, then fores.
        let strikes = [0.55, 0.75, 0.1, 0.25];
        for phase in [0.0, 0.3, 0.97] {
            let cycles = strikes.map(|strike: f64| (phase - strike).rem_euclid(1.0) as f32);
            let found = matched(cycles, strikes);
            assert!((found.phase - phase).abs() < 1e-3 || (found.phase - phase).abs() > 0.999, "{found:?}");
            assert!(found.spread < 1e-6 && !found.is_mirrored);
            let other = matched([cycles[1], cycles[0], cycles[3], cycles[2]], strikes);
            assert!(other.is_mirrored && other.spread < 1e-6);
        }
    }
}
