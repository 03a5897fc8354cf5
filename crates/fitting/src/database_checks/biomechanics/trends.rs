//! How strides of one plate change with speed: a faster horse has its feet down for less time and a smaller share of it.

use muybridge_core::{Database, Gait, Limb, Pair, Stride};

use super::super::{Check, Deviation, body, family, require};

/// A stance may rise by this from one speed to the next, s: rounding, and a capture beside its own expansion.
const STANCE_TOLERANCE_S: f64 = 0.001;
/// A duty factor may rise by this.
const DUTY_TOLERANCE: f64 = 0.002;

/// Swing of a gallop may differ from that of its slowest stride by this share: published swings fall by 6 and 8 % from 9 to
/// 17 m/s (Witte et al. 2006).
const SWING_CHANGE: f64 = 0.15;

/// Strides that do not follow from the slower ones of the same plate and gait.
pub(in super::super) fn check(database: &Database) -> Vec<Deviation> {
    let mut deviations = Vec::new();
    for stride in database.strides.iter().filter(|stride| body::not_finite(stride).is_none()) {
        let slower = slower_strides(database, stride);
        if let Some(next) = slower.last() {
            deviations.extend(rises(stride, next));
        }
        if let (Gait::Gallop, Some(slowest)) = (stride.gait, slower.first()) {
            deviations.extend(swing_changes(stride, slowest));
        }
    }
    deviations
}

/// Strides of the same plate and gait at lower speeds, slowest first.
fn slower_strides<'a>(database: &'a Database, stride: &Stride) -> Vec<&'a Stride> {
    let of_gait = database.strides_of(stride.gait);
    let mut slower: Vec<&Stride> = of_gait
        .filter(|other| family(other) == family(stride) && other.speed_m_s < stride.speed_m_s)
        .collect();
    slower.sort_by(|a, b| a.speed_m_s.total_cmp(&b.speed_m_s));
    slower
}

/// Stance times and duty factors greater than at the next lower speed.
fn rises(stride: &Stride, slower: &Stride) -> Vec<Deviation> {
    let mut deviations = Vec::new();
    for (pair, name) in [(Pair::Fore, "forelimbs"), (Pair::Hind, "hind limbs")] {
        let [duty, before] = [stride, slower].map(|s| mean_duty(s, pair));
        let [stance, stance_before] =
            [(duty, stride), (before, slower)].map(|(duty, s)| duty * f64::from(s.stride_time_s));
        let text = |what: &str, from: f64, to: f64| {
            format!(
                "the {what} of the {name} rises from {from:.3} at {:.2} m/s to {to:.3} at {:.2} m/s",
                slower.speed_m_s, stride.speed_m_s
            )
        };
        let told = text("stance time", stance_before, stance);
        deviations.extend(require(
            stride,
            Check::StanceTrend,
            stance,
            [0.0, stance_before + STANCE_TOLERANCE_S],
            told,
        ));
        let told = text("duty factor", before, duty);
        deviations.extend(require(stride, Check::DutyTrend, duty, [0.0, before + DUTY_TOLERANCE], told));
    }
    deviations
}

/// Swing times of a gallop that are not nearly those of the slowest.
fn swing_changes(stride: &Stride, slowest: &Stride) -> Vec<Deviation> {
    let pairs = [(Pair::Fore, "forelimbs"), (Pair::Hind, "hind limbs")];
    pairs
        .into_iter()
        .filter_map(|(pair, name)| {
            let [swing, before] =
                [stride, slowest].map(|s| (1.0 - mean_duty(s, pair)) * f64::from(s.stride_time_s));
            let text = format!(
                "the swing of the {name} changes from {before:.3} s at {:.2} m/s to {swing:.3} s at {:.2} m/s",
                slowest.speed_m_s, stride.speed_m_s
            );
            let allowed = [before * (1.0 - SWING_CHANGE), before * (1.0 + SWING_CHANGE)];
            require(stride, Check::SwingTrend, swing, allowed, text)
        })
        .collect()
}

fn mean_duty(stride: &Stride, pair: Pair) -> f64 {
    let legs = Limb::ALL.into_iter().filter(|limb| limb.pair() == pair);
    legs.map(|limb| f64::from(stride.contacts[limb.index()].duty_factor())).sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use super::super::super::specimen::{Specimen, checks_of_all};
    use super::*;

    #[test]
    fn feet_that_stay_longer_at_speed_are_found() {
        let slow = Specimen::walk().stride();
        let fast = |duty| {
            Specimen { id: "walk@4mph", speed_m_s: 1.7, duties: [duty; 4], ..Specimen::walk() }.stride()
        };
        assert_eq!(checks_of_all(&[slow.clone(), fast(0.50)]), []);
        let found = checks_of_all(&[slow, fast(0.56)]);
        assert_eq!(found, [Check::StanceTrend, Check::DutyTrend]);
    }

    #[test]
    fn a_gallop_whose_swing_shortens_with_speed_is_found() {
        let gallop = Specimen { duties: [0.25, 0.25, 0.27, 0.27], ..Specimen::gallop() };
        let slow = Specimen { stride_time_s: 0.49, speed_m_s: 8.2, ..gallop }.stride();
        let fast =
            |stride_time_s| Specimen { id: "gallop@19mph", speed_m_s: 8.5, stride_time_s, ..gallop }.stride();
        assert_eq!(checks_of_all(&[slow.clone(), fast(0.45)]), []);
        assert_eq!(checks_of_all(&[slow, fast(0.41)]), [Check::StanceTime, Check::SwingTrend]);
    }
}
