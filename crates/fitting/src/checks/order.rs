//! Contacts against themselves and against the title's gait.

use muybridge_capture::{Annotation, Event, Manifest, StanceLabel};
use muybridge_core::{Gait, Limb, Pair};

use super::{Concern, ConcernKind, Severity};
use crate::footfalls::{Footfalls, Lane, NoSpan, contacts, leg_name};
use crate::gait_analysis::GaitAnalysis;

/// Strikes closer than this share of the stride count as one beat: either order is the same.
const ONE_BEAT: f64 = 0.07;

pub(super) fn concerns(annotation: &Annotation, manifest: &Manifest, footfalls: &Footfalls) -> Vec<Concern> {
    let mut concerns = Vec::new();
    for lane in &footfalls.lanes {
        concerns.extend(contradictions(lane));
        concerns.extend(no_stance(annotation, lane));
        // A leap has a take-off and a landing.
        if annotation.gait(manifest) != Gait::Leap {
            concerns.extend(second_stance(footfalls, lane));
        }
    }
    if let Ok(contacts) = contacts(footfalls, manifest.facing) {
        concerns.extend(of_gait(&GaitAnalysis::new(contacts, [1.0, 0.0]), annotation.gait(manifest)));
    }
    concerns
}

fn contradictions(lane: &Lane) -> Vec<Concern> {
    let limb = (lane.side, lane.pair);
    let name = leg_name(lane.side, lane.pair);
    lane.contradicting
        .iter()
        .map(|instant| {
            let event = match instant.event {
                Event::Strike => "strike",
                Event::LiftOff => "lift-off",
            };
            let at = instant.at_panel;
            let text = format!(
                "the {event} of {name} placed at {at:.2} contradicts the labels around it; remove one"
            );
            // A place in a file may be anything; the cast saturates.
            let panel = at.floor() as u32;
            Concern::of_limb(ConcernKind::ContradictingInstant, (panel, limb), Vec::new(), 1.5, text)
        })
        .collect()
}

/// Only when every panel is labelled: until then it is work not done yet.
fn no_stance(annotation: &Annotation, lane: &Lane) -> Option<Concern> {
    let span = annotation.stride;
    let mut panels = annotation.panels.iter().filter(|p| (span.first..=span.last).contains(&p.panel));
    let complete = panels.all(|p| p.contacts.of(lane.side, lane.pair) != StanceLabel::Unknown);
    let what = match lane.no_span.filter(|_| complete)? {
        NoSpan::NeverDown => "swing in every panel; label where it is down",
        NoSpan::NeverUp => "stance in every panel; label where it is up",
    };
    let text = format!("{} is labelled {what}", leg_name(lane.side, lane.pair));
    let mut concern = Concern::of_stride(ConcernKind::LegContacts, Severity::Warning, 2.0, text);
    concern.limb = Some((lane.side, lane.pair));
    Some(concern)
}

/// In a stride each hoof comes down once; the shorter stances are the doubtful ones.
fn second_stance(footfalls: &Footfalls, lane: &Lane) -> Vec<Concern> {
    let longest = lane.longest();
    let others = lane.spans.iter().filter(|span| Some(*span) != longest);
    others
        .map(|span| {
            let at = footfalls.clock.panel_near(0.5 * (span.strike.at_panel + span.lift_off.at_panel));
            let name = leg_name(lane.side, lane.pair);
            let text = format!("{name} comes down a second time in the stride; check its labels here");
            let limb = (lane.side, lane.pair);
            Concern::of_limb(ConcernKind::LegContacts, (at, limb), Vec::new(), 2.0, text)
        })
        .collect()
}

fn of_gait(analysis: &GaitAnalysis, gait: Gait) -> Vec<Concern> {
    if gait == Gait::Leap {
        return Vec::new();
    }
    let mut concerns = Vec::new();
    if !analysis.implied.agrees_with(gait) {
        let implied = analysis.implied.name();
        let text = format!(
            "the footfalls are those of a {implied}, the title says {gait}; check the contacts, or the title"
        );
        concerns.push(Concern::of_stride(ConcernKind::GaitAgainstTitle, Severity::Warning, 1.0, text));
    }
    let order = analysis.footfall_order();
    if !allowed(analysis, order, gait) {
        let names: Vec<&str> = order.iter().map(|limb| limb.abbreviation()).collect();
        let text = format!(
            "the hooves strike in the order {}, which is none of a {gait}; check the contacts and near against off",
            names.join(", ")
        );
        concerns.push(Concern::of_stride(ConcernKind::FootfallOrder, Severity::Warning, 1.2, text));
    }
    let extended = analysis.suspensions.iter().find(|s| {
        matches!(gait, Gait::Canter | Gait::Gallop)
            && s.left_by.pair() == Pair::Hind
            && s.ended_by.pair() == Pair::Fore
    });
    if extended.is_some() {
        let text = format!(
            "the {gait} is off the ground between hind and fore strikes, as a dog is; a horse is off the ground between \
             fore and hind: check the contacts and the order of the panels"
        );
        concerns.push(Concern::of_stride(ConcernKind::FootfallOrder, Severity::Warning, 1.3, text));
    }
    concerns
}

/// Whether the strikes follow each other as in the gait, from any leg on and but for those of one beat.
fn allowed(analysis: &GaitAnalysis, order: [Limb; 4], gait: Gait) -> bool {
    use Limb::{LF, LH, RF, RH};
    let orders: &[[Limb; 4]] = match gait {
        Gait::Walk | Gait::Amble => &[[LH, LF, RH, RF]],
        // Two beats: whether they are the right ones is for the lags to say.
        Gait::Trot | Gait::Rack | Gait::Leap => return true,
        Gait::Canter => &[[LH, RH, LF, RF], [RH, LH, RF, LF]],
        Gait::Gallop => &[[LH, RH, LF, RF], [RH, LH, RF, LF], [LH, RH, RF, LF], [RH, LH, LF, RF]],
    };
    let lag = |limb: Limb| analysis.lags[limb.index()];
    let mut variants = vec![order];
    for k in 0..4 {
        let apart = (lag(order[(k + 1) % 4]) - lag(order[k])).rem_euclid(1.0);
        if apart < ONE_BEAT {
            let mut exchanged = order;
            exchanged.swap(k, (k + 1) % 4);
            variants.push(exchanged);
        }
    }
    let same = |a: &[Limb; 4], b: &[Limb; 4]| (0..4).any(|turn| (0..4).all(|k| a[(k + turn) % 4] == b[k]));
    variants.iter().any(|variant| orders.iter().any(|order| same(variant, order)))
}
