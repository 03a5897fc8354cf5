//! Forces: what the duty factor asks of a leg, and how a body moves while no foot is down.

use muybridge_core::{Gait, Pair};

use super::super::{Check, Deviation, Subject};
use super::published::{GALLOP_FORE_DUTY, pair_duty_factor, power_through};
use crate::gait_analysis::Suspension;

/// Standard gravity, m/s^2.
const GRAVITY: f64 = 9.80665;
/// The forelimbs' share of the weight in symmetrical gaits, as in standing horses.
const FORE_SHARE_STANDING: f64 = 0.57;
/// The forelimbs' share at canter and gallop.
const FORE_SHARE_GALLOP: f64 = 0.52;
/// Greatest peak force measured at the gallop, non-leading fore at 11.4 m/s, N/kg (J Exp Biol 222 jeb204107).
const MEASURED_PEAK: f64 = 14.0;
const MEASURED_AT_M_S: f64 = 11.4;
/// The duty factor's rule overestimates by up to 19 % (Witte et al. 2004), and a duty factor is known to 20 %: 20 N/kg.
const PEAK_MARGIN: f64 = 1.19 * 1.2;
/// Poses looked at over a suspension.
const SAMPLES: usize = 40;
/// Distance of the centre of mass from its parabola in the air, m: twice what the captures show (12 mm), for masses are rounded
/// estimates and a fitted root scatters; a trunk carried level through a flight of 0.14 s is as far off.
const BALLISTIC_MARGIN_M: f64 = 0.025;

pub(super) fn check(subject: &Subject<'_>) -> Vec<Deviation> {
    let mut deviations = Vec::new();
    if subject.stride.gait != Gait::Leap {
        // Take-off and landing are no steady stride: their forces follow from the height of the jump.
        deviations.extend([Pair::Fore, Pair::Hind].into_iter().filter_map(|pair| peak_force(subject, pair)));
    }
    deviations.extend(subject.footfalls.suspensions.iter().filter_map(|s| ballistics(subject, s)));
    deviations
}

/// Force of a half sine over the stance that carries the pair's share of the weight, per leg, N/kg.
fn peak_force(subject: &Subject<'_>, pair: Pair) -> Option<Deviation> {
    let gait = subject.stride.gait;
    let fore =
        if matches!(gait, Gait::Canter | Gait::Gallop) { FORE_SHARE_GALLOP } else { FORE_SHARE_STANDING };
    let share = if pair == Pair::Fore { fore } else { 1.0 - fore };
    let duty = pair_duty_factor(subject, pair);
    let force = std::f64::consts::FRAC_PI_4 * share / duty * GRAVITY;
    let limit = MEASURED_PEAK * PEAK_MARGIN * faster_gallop(gait, f64::from(subject.stride.speed_m_s));
    let legs = if pair == Pair::Fore { "forelimb" } else { "hind limb" };
    let text = format!(
        "a {legs} with a duty factor of {duty:.3} must bear {force:.1} N/kg at its peak; at most {limit:.1}, by the {MEASURED_PEAK:.1} measured at {MEASURED_AT_M_S:.1} m/s"
    );
    subject.require(Check::PeakForce, force, [0.0, limit], text)
}

/// Forces of faster gallops grow as published duty factors fall.
fn faster_gallop(gait: Gait, speed_m_s: f64) -> f64 {
    if gait != Gait::Gallop || speed_m_s <= MEASURED_AT_M_S {
        return 1.0;
    }
    power_through(&GALLOP_FORE_DUTY, MEASURED_AT_M_S) / power_through(&GALLOP_FORE_DUTY, speed_m_s)
}

/// Farthest the centre of mass is from the parabola through its places at lift-off and strike.
fn ballistics(subject: &Subject<'_>, suspension: &Suspension) -> Option<Deviation> {
    let height = |share: f64| {
        let phase = (suspension.start + suspension.share * share) as f32;
        f64::from(subject.stride.pose(phase).centre_of_mass(&subject.skeleton).y)
    };
    let duration_s = suspension.share * f64::from(subject.stride.stride_time_s);
    let (start, end) = (height(0.0), height(1.0));
    let from_parabola = |k: usize| {
        let t = k as f64 / SAMPLES as f64;
        let rise = 0.5 * GRAVITY * duration_s * duration_s * t * (1.0 - t);
        height(t) - (start + (end - start) * t + rise)
    };
    let farthest = (0..=SAMPLES).map(from_parabola).max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
    // Falling from rest is the most that a trunk which the legs have just pushed up can do.
    let drop = (start - end) - 0.5 * GRAVITY * duration_s * duration_s;
    let worst = if drop > farthest.abs() { drop } else { farthest };
    let text = format!(
        "in {:.0} ms without a foot down the centre of mass moves {:.0} mm otherwise than a thrown body; at most {:.0}",
        1e3 * duration_s,
        1e3 * worst,
        1e3 * BALLISTIC_MARGIN_M
    );
    subject.require(Check::Ballistics, worst, [-BALLISTIC_MARGIN_M, BALLISTIC_MARGIN_M], text)
}

#[cfg(test)]
mod tests {
    use super::super::super::specimen::{Specimen, checks_of};
    use super::*;

    #[test]
    fn a_canter_on_too_short_stances_is_found() {
        let stride = Specimen { duties: [0.17, 0.17, 0.3, 0.3], ..Specimen::canter() }.stride();
        assert_eq!(checks_of(&stride), [Check::PeakForce]);
    }

    #[test]
    fn a_trunk_that_falls_faster_than_a_stone_is_found() {
        let mut stride = Specimen::trot().stride();
        let subject = Subject::new(&stride, &muybridge_core::Skeleton::reference());
        let flight = subject.footfalls.suspensions[0];
        let n = stride.curves.height_m.len();
        let middle = (flight.start + 0.5 * flight.share) as f32;
        for k in 0..n {
            let away = (k as f32 / n as f32 - middle + 0.5).rem_euclid(1.0) - 0.5;
            stride.curves.height_m[k] -= 0.2 * (-(away / 0.02).powi(2)).exp();
        }
        assert!(checks_of(&stride).contains(&Check::Ballistics));
    }
}
