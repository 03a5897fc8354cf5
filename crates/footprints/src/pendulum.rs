//! Where the gradient solver begins: the motion of a linear inverted pendulum over the prints, which is one linear system.
//!
//! Legs are taken as upright and as long as is comfortable, so that a foot's force is the weight and its direction is linear in the
//! place of the centre of mass (Kajita et al. 2001, *The 3D linear inverted pendulum mode*). The energy is then quadratic: from
//! whatever curve one starts, one step of Newton leads to its only minimum.

use glam::{DMat3, DVec3};

use crate::energy::{Derivatives, GRAVITY, Support, outer};

/// A squared missing force counts by this, s²/m: as the rounded length of the first stage does, r²/(2 · 10 m/s²).
const FORCE: f64 = 0.05;
/// Between two feet the weight may be on either: this share of the force's weight draws it to the middle.
const BETWEEN: f64 = 0.1;
/// Share of the comfort's weight that draws a hip over its foot: long steps lead it far from there. Of 0.003 to 0.1 this leads to the
/// lowest energies over the random tracks.
const OVER_FOOT: f64 = 0.1;

/// The derivatives of the pendulum's energy at a moment; they are the same second derivatives everywhere.
pub(crate) fn derivatives(
    supports: &[Support],
    centre: DVec3,
    acceleration: DVec3,
    [physics, comfort_per_s2]: [f64; 2],
) -> Derivatives {
    let mut all = Derivatives::default();
    let weight = 2.0 * FORCE * physics;
    if supports.is_empty() {
        all.by_acceleration = weight * (acceleration - GRAVITY);
        all.bend_acceleration = DMat3::IDENTITY * weight;
        return all;
    }
    let count = supports.len() as f64;
    let mean = |of: fn(&Support) -> DVec3| supports.iter().map(of).sum::<DVec3>() / count;
    let (support, through) = (mean(|support| support.middle), mean(|support| support.through));
    let height_m = supports.iter().map(|support| support.nominal_m).sum::<f64>() / count;
    let rate = -GRAVITY.y / height_m.max(1e-3);
    let level = (DMat3::IDENTITY - outer(DVec3::Y, DVec3::Y)) * spread(supports, support);
    let missing = level * (acceleration - rate * (centre + through - support));
    all.by_acceleration = weight * missing;
    all.by_place = -weight * rate * missing;
    all.bend_acceleration = level * weight;
    all.bend_mixed = level * (-weight * rate);
    all.bend_place = level * (weight * rate * rate);
    for support in supports {
        let weights = DMat3::from_diagonal(DVec3::new(OVER_FOOT, 1.0, OVER_FOOT)) * (2.0 * comfort_per_s2);
        let off = centre + support.hip - support.ankle - DVec3::Y * support.nominal_m;
        all.by_place += weights * off;
        all.bend_place += weights;
    }
    all
}

/// How much of a level force counts: all of it across the line between two feet, little along it; little of any between more feet.
fn spread(supports: &[Support], middle: DVec3) -> DMat3 {
    match supports {
        [_] => DMat3::IDENTITY,
        [first, _] => {
            let along = (first.middle - middle).with_y(0.0).normalize_or_zero();
            DMat3::IDENTITY - outer(along, along) * (1.0 - BETWEEN)
        }
        _ => DMat3::IDENTITY * BETWEEN,
    }
}
