//! The numbers of the leap, for a horse of the reference's size on the right lead.
//!
//! Times are seconds from the first panel. A jump of a metre takes some 0.45 s in the air, at 5 to 6 m/s.

use muybridge_core::Limb;

use super::curve::Curve;
use super::legs::{Fold, LegStyle};

/// Speed along the track, m/s, and the length of the whole sequence, s.
pub(super) const SPEED_M_S: f64 = 5.6;
pub(super) const DURATION_S: f64 = 1.48;

/// When a hoof is down, and how far ahead of scapula or croup its toe stands in the middle of that, m.
pub(super) struct Planted {
    pub(super) span_s: [f64; 2],
    pub(super) toe_ahead_m: f64,
}

const fn planted(strike_s: f64, lift_off_s: f64, toe_ahead_m: f64) -> Planted {
    Planted { span_s: [strike_s, lift_off_s], toe_ahead_m }
}

/// The stances of each leg in the order of `Limb::ALL`: approach, take-off of the hinds, landing of trailing and
/// leading fore, landing of the hinds, and the next canter stride.
pub(super) const PLANTED: [&[Planted]; 4] = [
    &[planted(-0.07, 0.11, 0.12), planted(TOUCH_DOWN_S, 1.11, 0.10), planted(1.50, 1.67, 0.09)],
    &[
        planted(-0.48, -0.31, 0.09),
        planted(0.05, 0.22, 0.14),
        planted(1.04, 1.205, 0.13),
        planted(1.61, 1.78, 0.09),
    ],
    &[
        planted(-0.25, -0.07, -0.09),
        planted(0.26, 0.475, -0.02),
        planted(1.23, 1.41, -0.05),
        planted(1.77, 1.95, -0.09),
    ],
    &[
        planted(-0.15, 0.03, -0.09),
        planted(0.28, TAKE_OFF_S, -0.02),
        planted(1.29, 1.475, -0.06),
        planted(1.84, 2.02, -0.09),
    ],
];

/// The last hind leaves the ground, the first fore comes down.
pub(super) const TAKE_OFF_S: f64 = 0.49;
pub(super) const TOUCH_DOWN_S: f64 = 0.95;
/// In flight the centre of mass follows a parabola: rising speed at take-off, m/s, and its height over that of the
/// standing horse then and at touch-down, m.
const GRAVITY_M_S2: f64 = 9.81;
const RISE_M_S: f64 = 2.3;
const FLIGHT_S: f64 = TOUCH_DOWN_S - TAKE_OFF_S;
const TAKE_OFF_M: f64 = 0.12;
const TOUCH_DOWN_M: f64 = TAKE_OFF_M + RISE_M_S * FLIGHT_S - 0.5 * GRAVITY_M_S2 * FLIGHT_S * FLIGHT_S;

/// Height of the centre of mass over that of the standing horse, m. A cubic with the parabola's ends is the parabola.
pub(super) const COM_HEIGHT: Curve = Curve(&[
    [-0.2, -0.10, 0.0],
    [0.0, -0.06, -0.1],
    [0.12, -0.06, 0.1],
    [0.26, -0.03, 0.45],
    [TAKE_OFF_S, TAKE_OFF_M, RISE_M_S],
    [TOUCH_DOWN_S, TOUCH_DOWN_M, RISE_M_S - GRAVITY_M_S2 * FLIGHT_S],
    [1.12, 0.03, -0.2],
    [1.22, -0.03, -0.5],
    [1.34, -0.06, 0.0],
    [1.60, -0.10, 0.0],
]);

/// Nose up, degrees: the forehand lifts off, the horse rocks over the hurdle and lands on its fores.
pub(super) const PITCH_DEG: Curve = Curve(&[
    [-0.2, 3.0, 0.0],
    [0.05, -1.0, 0.0],
    [0.24, 8.0, 75.0],
    [0.44, 22.0, 20.0],
    [0.70, 3.0, -95.0],
    [TOUCH_DOWN_S, -13.0, -50.0],
    [0.99, -14.0, 0.0],
    [1.18, 1.0, 60.0],
    [1.30, 6.0, 0.0],
    [1.60, -2.0, 0.0],
]);

/// Rounding of the loins, degrees.
pub(super) const ROUNDING_DEG: Curve = Curve(&[
    [0.0, -2.0, 0.0],
    [0.28, 7.0, 0.0],
    [0.49, -3.0, 0.0],
    [0.70, 4.0, 0.0],
    [0.95, 0.0, 0.0],
    [1.22, 6.0, 0.0],
    [1.45, -2.0, 0.0],
]);

/// Raising of the neck, degrees.
pub(super) const NECK_DEG: Curve =
    Curve(&[[0.0, -2.0, 0.0], [0.30, 8.0, 0.0], [0.68, -14.0, 0.0], [1.00, 6.0, 0.0], [1.30, 0.0, 0.0]]);

const fn fold(degrees: f64, at: f64) -> Fold {
    Fold { degrees, at }
}

/// Swings of the canter around the leap.
const FORE_CANTER: [Fold; 3] = [fold(-4.0, 0.4), fold(60.0, 0.5), fold(-92.0, 0.41)];
const HIND_CANTER: [Fold; 3] = [fold(14.0, 0.5), fold(-50.0, 0.46), fold(72.0, 0.46)];
/// The hinds come up quickly for the take-off.
const HIND_GATHERED: [Fold; 3] = [fold(8.0, 0.5), fold(-38.0, 0.46), fold(48.0, 0.46)];
/// Folded over the hurdle.
const FORE_OVER: [Fold; 3] = [fold(10.0, 0.5), fold(62.0, 0.5), fold(-118.0, 0.5)];
const HIND_OVER: [Fold; 3] = [fold(42.0, 0.5), fold(-90.0, 0.47), fold(104.0, 0.48)];

/// Folds of a swing: the `next`th stance of the leg follows it.
pub(super) fn folds(limb: Limb, next: usize) -> [Fold; 3] {
    match (limb, next) {
        (Limb::LF, 1) | (Limb::RF, 2) => FORE_OVER,
        (Limb::LF | Limb::RF, _) => FORE_CANTER,
        (Limb::LH | Limb::RH, 1) => HIND_GATHERED,
        (Limb::LH | Limb::RH, 2) => HIND_OVER,
        (Limb::LH | Limb::RH, _) => HIND_CANTER,
    }
}

/// Forelegs and hind legs.
pub(super) const FORE: LegStyle = LegStyle {
    girdle_deg: 3.0,
    girdle_swing_deg: 11.0,
    pastern_deg: [-54.0, -38.0, -100.0],
    folds: FORE_CANTER,
};
pub(super) const HIND: LegStyle = LegStyle {
    girdle_deg: -10.0,
    girdle_swing_deg: 8.0,
    pastern_deg: [-54.0, -40.0, -104.0],
    folds: HIND_CANTER,
};
