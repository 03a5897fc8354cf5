//! Hill climbing along the axes, for a handful of unknowns and a cheap, rough score.

use std::ops::RangeInclusive;

/// Moves `unknowns` uphill by `steps` halved as often as `halvings` says, from its first to its last number, and returns the
/// score reached.
pub(super) fn climb(
    unknowns: &mut [f64],
    steps: &[f64],
    halvings: RangeInclusive<u32>,
    score: impl Fn(&[f64]) -> f64,
) -> f64 {
    /// Rounds at one step length; the score is bounded, so that a longer climb gains little.
    const ROUNDS: usize = 3;
    let mut best = score(unknowns);
    for halving in halvings {
        let factor = 0.5f64.powi(halving as i32);
        for _ in 0..ROUNDS {
            let before = best;
            for (axis, step) in steps.iter().enumerate() {
                for step in [step * factor, -step * factor] {
                    let old = unknowns[axis];
                    unknowns[axis] = old + step;
                    let here = score(unknowns);
                    if here > best {
                        best = here;
                    } else {
                        unknowns[axis] = old;
                    }
                }
            }
            if best <= before {
                break;
            }
        }
    }
    best
}
