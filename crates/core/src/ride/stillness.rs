//! Coming to a stand and setting out again (Huang 2012, section 3.1: a horse sets out with a hind leg, and the fore of that side
//! follows).

use super::retarget::smooth;

/// Strides from a slow walk to a stand.
pub(super) const HALT_STRIDES: f32 = 1.25;
/// Strides from a stand to a walk.
pub(super) const START_STRIDES: f32 = 1.0;
/// A foot of a standing horse this far from its place takes another step, metres of a reference horse.
pub(super) const MISPLACED_M: f32 = 0.1;

/// What is left of the speed.
pub(super) fn going(stillness: f32) -> f32 {
    1.0 - smooth(stillness)
}

/// The integral of [`going`] from zero.
fn gone(stillness: f32) -> f32 {
    let p = stillness.clamp(0.0, 1.0);
    p - p * p * p + 0.5 * p * p * p * p
}

/// Stillness so many strides from now.
pub(super) fn after(stillness: f32, is_halting: bool, strides: f32) -> f32 {
    let change = if is_halting { strides / HALT_STRIDES } else { -strides / START_STRIDES };
    (stillness + change).clamp(0.0, 1.0)
}

/// Stride lengths gone so many strides from now.
pub(super) fn stride_lengths(stillness: f32, is_halting: bool, strides: f32) -> f32 {
    let then = after(stillness, is_halting, strides);
    if is_halting {
        // Strides before the halting began are not looked back at.
        return HALT_STRIDES * (gone(then) - gone(stillness));
    }
    let starting = (stillness - then) * START_STRIDES;
    let rest = if then > 0.0 || strides < 0.0 { 0.0 } else { strides - starting };
    let back = if strides < 0.0 && stillness == 0.0 { strides } else { 0.0 };
    START_STRIDES * (gone(stillness) - gone(then)) + rest + back
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_distance_is_the_sum_of_the_speeds() {
        for (begin, is_halting) in [(0.0, true), (0.4, true), (1.0, false), (0.3, false), (0.0, false)] {
            let (mut sum, mut p) = (0.0, begin);
            for k in 0..3000 {
                let strides = k as f32 / 1000.0;
                let far = stride_lengths(begin, is_halting, strides);
                assert!((far - sum).abs() < 2e-3, "{begin} {is_halting} {strides}: {far} {sum}");
                sum += 0.001 * going(p);
                p = after(p, is_halting, 0.001);
            }
        }
    }
}
