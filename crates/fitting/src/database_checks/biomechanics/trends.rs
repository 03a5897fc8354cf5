//! How strides of one plate change with speed: a faster horse has its feet down for less time and a smaller share of it.

use muybridge_core::{Database, Limb, Pair, Stride};

use super::super::{Check, Deviation, body, family, require};

/// A stance may rise by this from one speed to the next, s: rounding, and a capture beside its own expansion.
const STANCE_TOLERANCE_S: f64 = 0.001;
/// A duty factor may rise by this.
const DUTY_TOLERANCE: f64 = 0.002;

/// Strides whose stance or duty factor is greater than that of the next slower stride of the same plate and gait.
pub(in super::super) fn check(database: &Database) -> Vec<Deviation> {
    let strides = database.strides.iter().filter(|stride| body::not_finite(stride).is_none());
    let slower = |stride: &Stride| {
        let same = database
            .strides
            .iter()
            .filter(|other| other.gait == stride.gait && family(other) == family(stride));
        same.filter(|other| other.speed_m_s < stride.speed_m_s)
            .max_by(|a, b| a.speed_m_s.total_cmp(&b.speed_m_s))
            .cloned()
    };
    strides
        .filter_map(|stride| Some((stride, slower(stride)?)))
        .flat_map(|(stride, slower)| rises(stride, &slower))
        .collect()
}

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
}
