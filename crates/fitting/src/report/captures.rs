//! Two captures of one gait side by side: what they agree on, and how far apart they are.

use muybridge_capture::LEG_SHARE;
use muybridge_core::{Database, Gait, Lead, Limb, Pair, Provenance, Side, SpeedSource, Stride};

use super::page::{escape, table};
use crate::pipeline::PlateFit;

/// Standard gravity, m/s^2.
const GRAVITY: f64 = 9.80665;

/// One quantity of all captures of a gait.
#[derive(Clone, Debug, PartialEq)]
pub struct ComparedQuantity {
    /// Name with its unit.
    pub name: String,
    /// Values as text, in the order of the captures.
    pub values: Vec<String>,
    /// How far apart the farthest two are: percent of their mean, or share of the stride; empty for words.
    pub apart: String,
}

/// The captures of one gait, at least two.
#[derive(Clone, Debug, PartialEq)]
pub struct CaptureComparison {
    /// The gait.
    pub gait: Gait,
    /// Identifiers of the captured strides, slowest first.
    pub captures: Vec<String>,
    /// Speed and how it is known, Froude number, stride time, relative stride length, duty factors, lags.
    pub quantities: Vec<ComparedQuantity>,
}

/// A comparison for every gait that the database holds two or more captured strides of; `fits` are the plates they come
/// from, which know the animals' measured heights.
pub fn compare_captures(fits: &[PlateFit], database: &Database) -> Vec<CaptureComparison> {
    Gait::ALL.into_iter().filter_map(|gait| compare(gait, fits, &captured(database, gait))).collect()
}

/// Captured strides of a gait, slowest first.
pub(super) fn captured(database: &Database, gait: Gait) -> Vec<&Stride> {
    let is_capture = |stride: &&Stride| matches!(stride.provenance, Provenance::Captured { .. });
    database.strides_of(gait).filter(is_capture).collect()
}

fn compare(gait: Gait, fits: &[PlateFit], strides: &[&Stride]) -> Option<CaptureComparison> {
    if strides.len() < 2 {
        return None;
    }
    let leg_m = |stride: &Stride| {
        let fit = fits.iter().find(|fit| fit.id() == stride.id);
        LEG_SHARE * fit.map_or(f64::from(stride.withers_height_m), |fit| fit.withers_height_m)
    };
    let in_percent = |name: &str, decimals: usize, of: &dyn Fn(&Stride) -> f64| {
        let values: Vec<f64> = strides.iter().map(|stride| of(stride)).collect();
        ComparedQuantity {
            name: name.to_string(),
            values: values.iter().map(|value| format!("{value:.decimals$}")).collect(),
            apart: format!("{:.0} %", percent_apart(&values)),
        }
    };
    let mut quantities = vec![
        in_percent("speed, m/s", 2, &|s| f64::from(s.speed_m_s)),
        ComparedQuantity {
            name: "speed is".into(),
            values: strides.iter().map(|stride| speed_is(&stride.provenance).to_string()).collect(),
            apart: String::new(),
        },
        in_percent("Froude number", 2, &|s| f64::from(s.speed_m_s).powi(2) / (GRAVITY * leg_m(s))),
        in_percent("stride time, s", 3, &|s| f64::from(s.stride_time_s)),
        in_percent("stride over leg length", 2, &|s| f64::from(s.stride_length_m()) / leg_m(s)),
        in_percent("duty factor fore", 3, &|s| duty_factor(s, Pair::Fore)),
        in_percent("duty factor hind", 3, &|s| duty_factor(s, Pair::Hind)),
    ];
    quantities.extend(lags(strides));
    let captures = strides.iter().map(|stride| stride.id.clone()).collect();
    Some(CaptureComparison { gait, captures, quantities })
}

/// How the speed of a stride is known, in a word; an inferred one is shouted, because all else rests on it.
pub(super) fn speed_is(provenance: &Provenance) -> &'static str {
    match provenance {
        Provenance::Captured { speed: SpeedSource::Stated, .. } => "stated",
        Provenance::Captured { speed: SpeedSource::Measured, .. } => "measured",
        Provenance::Captured { speed: SpeedSource::Inferred, .. } => "INFERRED",
        Provenance::Derived { .. } => "set",
        Provenance::Published { .. } => "published",
    }
}

/// Mean of a pair's two feet.
fn duty_factor(stride: &Stride, pair: Pair) -> f64 {
    let of = |side| f64::from(stride.contacts[Limb::new(pair, side).index()].duty_factor());
    0.5 * (of(Side::Left) + of(Side::Right))
}

/// When the four feet strike. Strides with a lead are compared by the feet's part in it, so that a left lead
/// lies beside a right one; all others by the feet themselves.
fn lags(strides: &[&Stride]) -> Vec<ComparedQuantity> {
    let leads: Option<Vec<Lead>> = strides.iter().map(|stride| stride.lead).collect();
    let feet: Vec<[Limb; 4]> = match &leads {
        Some(leads) => leads.iter().map(|lead| feet_of(*lead)).collect(),
        None => vec![[Limb::LH, Limb::RH, Limb::LF, Limb::RF]; strides.len()],
    };
    let names = match leads {
        Some(_) => ["trailing hind", "leading hind", "trailing fore", "leading fore"],
        None => ["left hind", "right hind", "left fore", "right fore"],
    };
    let lag = |foot: usize| {
        let strikes = strides.iter().zip(&feet).map(|(stride, feet)| {
            let phase = |i: usize| f64::from(stride.contacts[feet[i].index()].strike_phase);
            (phase(foot) - phase(0)).rem_euclid(1.0)
        });
        let values: Vec<f64> = strikes.collect();
        ComparedQuantity {
            name: format!("lag of the {}", names[foot]),
            values: values.iter().map(|value| format!("{value:.3}")).collect(),
            apart: if foot == 0 {
                String::new()
            } else {
                format!("{:.3} of the stride", phase_apart(&values))
            },
        }
    };
    (0..names.len()).map(lag).collect()
}

/// Trailing hind, leading hind, trailing fore, leading fore.
fn feet_of(lead: Lead) -> [Limb; 4] {
    [
        Limb::new(Pair::Hind, lead.hind.opposite()),
        Limb::new(Pair::Hind, lead.hind),
        Limb::new(Pair::Fore, lead.fore.opposite()),
        Limb::new(Pair::Fore, lead.fore),
    ]
}

/// Greatest less least, in percent of the mean.
fn percent_apart(values: &[f64]) -> f64 {
    let greatest = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let least = values.iter().copied().fold(f64::INFINITY, f64::min);
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    100.0 * (greatest - least) / mean
}

/// The shortest stretch of the stride that holds all phases.
fn phase_apart(phases: &[f64]) -> f64 {
    let mut sorted = phases.to_vec();
    sorted.sort_by(f64::total_cmp);
    let next = sorted.iter().skip(1).copied().chain(sorted.first().map(|first| first + 1.0));
    let widest_gap = sorted.iter().zip(next).map(|(phase, next)| next - phase).fold(0.0, f64::max);
    1.0 - widest_gap
}

/// The comparison of a gait's captures as a table, or nothing where there is but one.
pub(super) fn section(fits: &[PlateFit], database: &Database, gait: Gait) -> String {
    let Some(comparison) = compare(gait, fits, &captured(database, gait)) else { return String::new() };
    let mut head = vec!["Quantity".to_string()];
    head.extend(comparison.captures.iter().map(|id| escape(id)));
    head.push("Apart".into());
    let head: Vec<&str> = head.iter().map(String::as_str).collect();
    let row = |quantity: &ComparedQuantity| {
        let mut row = vec![escape(&quantity.name)];
        row.extend(quantity.values.iter().map(|value| escape(value)));
        row.push(escape(&quantity.apart));
        row
    };
    let rows: Vec<Vec<String>> = comparison.quantities.iter().map(row).collect();
    format!(
        "<h4>Captures of one gait compared: {gait}</h4>\n{}<p class=\"note\">Apart: greatest less least in \
         percent of the mean, or as a share of the stride. Two captures at two speeds differ by their speeds, \
         too: a duty factor falls as the speed grows. Leg length is {LEG_SHARE} of the withers height. A speed \
         that is inferred was worked out from the stride&#8217;s length, so that its Froude number, its stride \
         time and its relative length are not independent of one another.</p>\n",
        table("numbers", &head, &rows)
    )
}

#[cfg(test)]
mod tests {
    use super::super::tests;
    use super::*;

    /// Two gallops of one horse: the first slower, on the other lead.
    fn two_gallops() -> Database {
        let mut database = tests::database();
        database.strides.retain(|stride| stride.id == "sallie-gardner-1878");
        let mut other = database.strides[0].clone();
        other.id = "other".into();
        other.speed_m_s *= 0.5;
        other.contacts.swap(0, 1);
        other.contacts.swap(2, 3);
        other.lead = other.lead.map(|lead| Lead { fore: lead.fore.opposite(), hind: lead.hind.opposite() });
        database.strides.insert(0, other);
        database
    }

    fn apart(comparison: &CaptureComparison, name: &str) -> String {
        comparison.quantities.iter().find(|quantity| quantity.name == name).unwrap().apart.clone()
    }

    #[test]
    fn one_gait_on_two_leads_differs_in_speed_and_not_in_lags() {
        let comparisons = compare_captures(&[], &two_gallops());
        assert_eq!(comparisons.len(), 1);
        assert_eq!(comparisons[0].captures, ["other", "sallie-gardner-1878"]);
        assert_eq!(apart(&comparisons[0], "speed, m/s"), "67 %");
        assert_eq!(apart(&comparisons[0], "duty factor hind"), "0 %");
        assert_eq!(apart(&comparisons[0], "lag of the leading fore"), "0.000 of the stride");
    }

    #[test]
    fn a_single_capture_is_not_compared_and_derived_strides_are_no_captures() {
        let mut database = two_gallops();
        database.strides[0].provenance = Provenance::Derived { from: vec![], how: "by half".into() };
        assert!(compare_captures(&[], &database).is_empty());
        assert!(section(&[], &database, Gait::Gallop).is_empty());
    }

    #[test]
    fn phases_on_both_sides_of_the_wrap_are_near() {
        assert!((phase_apart(&[0.98, 0.03]) - 0.05).abs() < 1e-12);
        assert!((phase_apart(&[0.9, 0.1, 0.95]) - 0.2).abs() < 1e-12);
    }
}
