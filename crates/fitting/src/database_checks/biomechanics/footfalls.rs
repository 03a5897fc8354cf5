//! Footfalls: their order and spacing, the lead, the number of feet down, and the suspensions, gait by gait.

use muybridge_core::{Gait, Lead, Limb, Pair};

use super::super::{Check, Deviation, Subject};
use crate::contacts::LegContact;
use crate::gait_analysis::Suspension;

/// Successive beats of a walk or amble, share of the stride: a quarter, give or take a tenth (Hildebrand's own scatter, and
/// about one panel of a plate).
const QUARTER_BEAT: [f64; 2] = [0.15, 0.35];
/// Left and right of a symmetrical gait: half a stride, give or take 0.12 (as in the analysis of plates).
const HALF_STRIDE: [f64; 2] = [0.38, 0.62];
/// The two feet of a trot's, rack's or canter's pair strike within this share of the stride: one panel of twelve.
const ONE_BEAT: f64 = 0.08;
/// Beats of a canter that are not one, share of the stride.
const CANTER_BEATS: [f64; 2] = [0.1, 0.5];
/// Beats of a gallop: 4 % of a stride of 0.45 s is 18 ms, less than a strike is known by.
const GALLOP_BEATS: [f64; 2] = [0.04, 0.55];
/// Rounding of instants: a gap in support shorter than this share of the stride is none.
const MEETING: f64 = 0.01;
/// A captured amble may have three feet down for this share of the stride, one panel of twelve; a derived one has none.
const AMBLE_OVERLAP: f64 = 0.1;
/// An amble has one foot and two feet down for at least this share of the stride each.
const AMBLE_ALTERNATION: f64 = 0.02;
/// A second gap in support of a canter or gallop shorter than this share of the stride is explained by the uncertainty of a
/// plate's instants, a hundredth of the stride (4 ms) each: twice their joint standard deviation.
const UNCERTAIN_GAP: f64 = 0.028;
/// A trot or rack has its two suspensions where the mean duty factor is below a half by this much: two feet of a pair are
/// never on the ground for exactly the same time.
const PAIR_SCATTER: f64 = 0.05;

pub(super) fn check(subject: &Subject<'_>) -> Vec<Deviation> {
    let mut deviations = lead(subject);
    deviations.extend(beats(subject));
    deviations.extend(support(subject));
    deviations.extend(suspensions(subject));
    deviations
}

/// Share of the stride from one leg's strike to another's.
fn apart(subject: &Subject<'_>, from: Limb, to: Limb) -> f64 {
    let lags = subject.footfalls.lags;
    (lags[to.index()] - lags[from.index()]).rem_euclid(1.0)
}

/// Canter and gallop have the lead that their footfalls have, on one side; symmetrical gaits have none.
fn lead(subject: &Subject<'_>) -> Vec<Deviation> {
    let (stated, found) = (subject.stride.lead, subject.footfalls.lead);
    let fault = match subject.stride.gait {
        Gait::Walk | Gait::Amble | Gait::Trot | Gait::Rack => {
            stated.map(|_| "a symmetrical gait has no lead".to_string())
        }
        Gait::Canter | Gait::Gallop if stated.is_none() => Some("no lead is stated".into()),
        Gait::Canter | Gait::Gallop if stated != found => {
            Some(format!("lead stated {}, footfalls show {}", lead_name(stated), lead_name(found)))
        }
        Gait::Canter | Gait::Gallop if !stated.is_some_and(Lead::is_transverse) => {
            Some("fore and hind lead on opposite sides, as the horse rarely does".into())
        }
        Gait::Canter | Gait::Gallop | Gait::Leap => None,
    };
    fault.and_then(|text| subject.require(Check::Lead, 1.0, [0.0, 0.0], text)).into_iter().collect()
}

fn lead_name(lead: Option<Lead>) -> String {
    lead.map_or("none".into(), |lead| format!("fore {:?}, hind {:?}", lead.fore, lead.hind).to_lowercase())
}

/// A beat: from one strike to another, and how long that may be.
type Beat = (Limb, Limb, [f64; 2]);

/// Beats outside their limits. An order other than the gait's shows as beats that are far too long.
fn beats(subject: &Subject<'_>) -> Vec<Deviation> {
    use Limb::{LF, LH, RF, RH};
    let sides = [(LH, RH, HALF_STRIDE), (LF, RF, HALF_STRIDE)];
    let expected: Vec<Beat> = match subject.stride.gait {
        Gait::Walk | Gait::Amble => {
            let sequence = [(LH, LF), (LF, RH), (RH, RF), (RF, LH)];
            sequence.map(|(from, to)| (from, to, QUARTER_BEAT)).into_iter().chain(sides).collect()
        }
        Gait::Trot => sides.into_iter().chain([together(LH, RF), together(RH, LF)]).collect(),
        Gait::Rack => sides.into_iter().chain([together(LH, LF), together(RH, RF)]).collect(),
        Gait::Canter | Gait::Gallop => {
            leading(subject).map_or(Vec::new(), |legs| asymmetrical(subject, legs))
        }
        Gait::Leap => Vec::new(),
    };
    expected.into_iter().filter_map(|beat| beat_deviation(subject, beat)).collect()
}

fn together(hind: Limb, fore: Limb) -> Beat {
    (hind, fore, [-ONE_BEAT, ONE_BEAT])
}

/// Trailing hind, leading hind, trailing fore, leading fore.
fn leading(subject: &Subject<'_>) -> Option<[Limb; 4]> {
    let lead = subject.stride.lead?;
    let (hind, fore) = (|side| Limb::new(Pair::Hind, side), |side| Limb::new(Pair::Fore, side));
    Some([hind(lead.hind.opposite()), hind(lead.hind), fore(lead.fore.opposite()), fore(lead.fore)])
}

fn asymmetrical(subject: &Subject<'_>, legs: [Limb; 4]) -> Vec<Beat> {
    let [trailing_hind, leading_hind, trailing_fore, leading_fore] = legs;
    if subject.stride.gait == Gait::Canter {
        vec![
            (trailing_hind, leading_hind, CANTER_BEATS),
            together(leading_hind, trailing_fore),
            (trailing_fore, leading_fore, CANTER_BEATS),
            (leading_fore, trailing_hind, CANTER_BEATS),
        ]
    } else {
        vec![
            (trailing_hind, leading_hind, GALLOP_BEATS),
            (leading_hind, trailing_fore, GALLOP_BEATS),
            (trailing_fore, leading_fore, GALLOP_BEATS),
            (leading_fore, trailing_hind, GALLOP_BEATS),
        ]
    }
}

fn beat_deviation(subject: &Subject<'_>, (from, to, allowed): Beat) -> Option<Deviation> {
    let apart = apart(subject, from, to);
    // Feet that strike together may do so in either order.
    let value = if allowed[0] < 0.0 && apart > 0.5 { apart - 1.0 } else { apart };
    let text = format!(
        "{} strikes {value:.3} of the stride after {}; in the {} {:.2} to {:.2}",
        to.abbreviation(),
        from.abbreviation(),
        subject.stride.gait,
        allowed[0],
        allowed[1]
    );
    subject.require(Check::Footfalls, value, allowed, text)
}

/// Share of the stride in which the number of feet down is one that `counts` accepts.
fn share_of(subject: &Subject<'_>, counts: impl Fn(usize) -> bool) -> f64 {
    let down = |feet: &[bool; 4]| feet.iter().filter(|down| **down).count();
    subject.footfalls.supports.iter().filter(|s| counts(down(&s.down))).map(|s| s.share).sum()
}

/// The walk always has a foot down; the amble has one and two in turn.
fn support(subject: &Subject<'_>) -> Vec<Deviation> {
    let gait = subject.stride.gait;
    if !matches!(gait, Gait::Walk | Gait::Amble) {
        return Vec::new();
    }
    let mut rows = vec![("no foot", share_of(subject, |n| n == 0), [0.0, MEETING])];
    if gait == Gait::Amble {
        rows.push(("three feet or more", share_of(subject, |n| n > 2), [0.0, AMBLE_OVERLAP]));
        rows.push(("one foot", share_of(subject, |n| n == 1), [AMBLE_ALTERNATION, 1.0]));
        rows.push(("two feet", share_of(subject, |n| n == 2), [AMBLE_ALTERNATION, 1.0]));
    }
    rows.into_iter()
        .filter_map(|(feet, share, allowed)| {
            let text = format!(
                "{feet} on the ground for {:.1} % of the stride; in the {gait} {:.0} to {:.0} % (Muybridge)",
                100.0 * share,
                100.0 * allowed[0],
                100.0 * allowed[1]
            );
            subject.require(Check::Support, share, allowed, text)
        })
        .collect()
}

/// Suspensions in the number and of the kind that the gait has.
fn suspensions(subject: &Subject<'_>) -> Vec<Deviation> {
    match subject.stride.gait {
        Gait::Walk | Gait::Amble => Vec::new(),
        Gait::Trot | Gait::Rack => two_suspensions(subject).into_iter().collect(),
        Gait::Canter | Gait::Gallop => gathered_suspension(subject),
        Gait::Leap => leap_flight(subject).into_iter().collect(),
    }
}

/// Trot and rack fly after each pair, where their feet are down for less than half the stride.
fn two_suspensions(subject: &Subject<'_>) -> Option<Deviation> {
    let number = subject.footfalls.suspensions.len() as f64;
    let duty = subject.footfalls.contacts.iter().map(LegContact::duty_factor).sum::<f64>() / 4.0;
    let least = if duty < 0.5 - PAIR_SCATTER { 2.0 } else { 0.0 };
    let gait = subject.stride.gait;
    let text =
        format!("{number:.0} suspensions; the {gait} with a duty factor of {duty:.2} has {least:.0} to 2");
    subject.require(Check::Suspension, number, [least, 2.0], text)
}

/// Canter and gallop fly once: gathered, begun by the leading fore and ended by a hind.
fn gathered_suspension(subject: &Subject<'_>) -> Vec<Deviation> {
    let Some([.., leading_fore]) = leading(subject) else { return Vec::new() };
    let is_gathered = |s: &&Suspension| s.is_gathered() && s.left_by == leading_fore;
    let found = &subject.footfalls.suspensions;
    let number = found.iter().filter(is_gathered).count() as f64;
    let gait = subject.stride.gait;
    let text = format!(
        "{number:.0} gathered suspensions, begun by the leading fore and ended by a hind; the {gait} has 1"
    );
    let gathered = subject.require(Check::Suspension, number, [1.0, 1.0], text);
    let others = found.iter().filter(|s| !is_gathered(s)).filter_map(|s| {
        let [left_by, ended_by] = [s.left_by, s.ended_by].map(Limb::abbreviation);
        let text = format!(
            "{:.1} % of the stride without a foot down from {left_by} to {ended_by}, where the {gait} has no suspension",
            100.0 * s.share
        );
        subject.require(Check::Suspension, s.share, [0.0, UNCERTAIN_GAP], text)
    });
    gathered.into_iter().chain(others).collect()
}

/// A leap flies from its hind feet to its forefeet.
fn leap_flight(subject: &Subject<'_>) -> Option<Deviation> {
    let over = |s: &&Suspension| s.left_by.pair() == Pair::Hind && s.ended_by.pair() == Pair::Fore;
    let flights = subject.footfalls.suspensions.iter().filter(over).count();
    let text = format!("{flights} flights from the hind feet to the forefeet; a leap has one");
    subject.require(Check::Suspension, flights as f64, [1.0, 1.0], text)
}

#[cfg(test)]
mod tests {
    use muybridge_core::Side;

    use super::super::super::specimen::{Specimen, checks_of};
    use super::*;

    #[test]
    fn good_strides_of_every_gait_raise_nothing() {
        let strides =
            [Specimen::walk(), Specimen::amble(), Specimen::trot(), Specimen::canter(), Specimen::gallop()];
        for specimen in strides {
            assert_eq!(checks_of(&specimen.stride()), [], "{}", specimen.gait);
        }
    }

    #[test]
    fn a_trot_with_one_suspension_is_found() {
        let stride = Specimen { duties: [0.51, 0.40, 0.40, 0.40], ..Specimen::trot() }.stride();
        assert_eq!(checks_of(&stride), [Check::Suspension]);
    }

    #[test]
    fn a_gallop_with_an_extended_suspension_is_found() {
        let stride =
            Specimen { strikes: [0.5, 0.72, 0.0, 0.18], duties: [0.28; 4], ..Specimen::gallop() }.stride();
        assert_eq!(checks_of(&stride), [Check::Suspension]);
    }

    #[test]
    fn a_leap_that_lands_on_its_hind_feet_is_found() {
        let leap = Specimen { gait: Gait::Leap, lead: None, duties: [0.28; 4], ..Specimen::gallop() };
        assert_eq!(checks_of(&Specimen { strikes: [0.5, 0.72, 0.0, 0.18], ..leap }.stride()), []);
        assert_eq!(checks_of(&leap.stride()), [Check::Suspension]);
    }

    #[test]
    fn a_walk_unsupported_for_3_percent_is_found() {
        let strikes = [0.16, 0.66, 0.0, 0.5];
        let duties = [0.31, 0.70, 0.47, 0.52];
        assert_eq!(
            checks_of(&Specimen { strikes, duties, speed_m_s: 1.3, ..Specimen::walk() }.stride()),
            [Check::Support]
        );
    }

    #[test]
    fn an_amble_in_diagonal_sequence_and_a_trot_out_of_step_are_found() {
        let amble = Specimen { strikes: [0.75, 0.25, 0.0, 0.5], ..Specimen::amble() }.stride();
        assert_eq!(checks_of(&amble), [Check::Footfalls]);
        let trot =
            Specimen { strikes: [0.61, 0.11, 0.0, 0.5], duties: [0.36; 4], ..Specimen::trot() }.stride();
        assert_eq!(checks_of(&trot), [Check::Footfalls]);
    }

    #[test]
    fn a_wrong_lead_is_found() {
        let mut stride = Specimen::trot().stride();
        stride.lead = Some(Lead { fore: Side::Left, hind: Side::Left });
        assert_eq!(checks_of(&stride), [Check::Lead]);
        let mut stride = Specimen::gallop().stride();
        stride.lead = None;
        assert_eq!(checks_of(&stride), [Check::Lead]);
    }
}
