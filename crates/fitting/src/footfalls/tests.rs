//! Lanes and gait from labels against known motions, and edges dragged at random.

use std::path::{Path, PathBuf};

use muybridge_capture::{
    Annotation, Event, Instant, NearOff, PanelUse, Plate, PlateCalibration, StanceLabel, calibrate,
};
use muybridge_core::{Gait, Lead, Limb, Pair, Random, Side};

use super::*;
use crate::contacts::LegContact;
use crate::published;
use crate::synthetic::SyntheticStride;

fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

fn specimen(gait: Gait) -> Plate {
    Plate::load(&repository(&format!("plates/specimens/annotations/specimen-{gait}.json"))).unwrap()
}

fn sallie() -> Plate {
    Plate::load(&repository("annotations/sallie-gardner-1878.json")).unwrap()
}

fn clock(plate: &Plate) -> StrideClock {
    StrideClock::new(&plate.annotation, None, None)
}

fn live(plate: &Plate, calibration: Option<&PlateCalibration>) -> LiveGait {
    let clock = StrideClock::new(&plate.annotation, calibration, None);
    let footfalls = Footfalls::new(&plate.annotation, clock);
    LiveGait::new(&footfalls, (&plate.manifest, plate.manifest.gait), calibration, None, &published::laws())
        .unwrap()
}

#[test]
fn labels_alone_give_duty_factors_and_name_the_six_gaits() {
    for gait in Gait::ALL.into_iter().filter(|gait| *gait != Gait::Leap) {
        let plate = specimen(gait);
        let truth = SyntheticStride::of_gait(gait, 1, 12);
        let live = live(&plate, None);
        assert!(live.analysis.implied.agrees_with(gait), "{gait}: {:?}", live.analysis.implied);
        assert_eq!(live.analysis.lead, truth.lead, "{gait}");
        for print in truth.hoof_prints() {
            let found: &LegContact = &live.analysis.contacts[print.limb.index()];
            for (found, time_s) in [(found.strike, print.strike_s), (found.lift_off, print.lift_off_s)] {
                let off = (found.phase - time_s / truth.stride_time_s + 0.5).rem_euclid(1.0) - 0.5;
                // Midway between two panels, an edge is good to half a panel.
                assert!(off.abs() * 12.0 <= 0.5 + 1e-6, "{gait} {print:?}: {off}");
            }
        }
    }
}

#[test]
fn instants_at_the_true_places_give_the_true_phases() {
    for gait in Gait::ALL.into_iter().filter(|gait| *gait != Gait::Leap) {
        let mut plate = specimen(gait);
        let truth = SyntheticStride::of_gait(gait, 1, 12);
        let calibration = calibrate(&plate.manifest, &plate.annotation).unwrap();
        let clock = StrideClock::new(&plate.annotation, Some(&calibration), None);
        let panel = |time_s: f64| 1.0 + (12.0 * time_s / truth.stride_time_s).rem_euclid(12.0);
        for print in truth.hoof_prints() {
            let leg = (plate.facing.near_off(print.limb.side()), print.limb.pair());
            for (event, time_s) in [(Event::Strike, print.strike_s), (Event::LiftOff, print.lift_off_s)] {
                let at = panel(time_s);
                plate.annotation = with_edge(&plate.annotation, &clock, leg, event, [at, at]);
            }
        }
        let live = live(&plate, Some(&calibration));
        for print in truth.hoof_prints() {
            let found = &live.analysis.contacts[print.limb.index()];
            for (found, time_s) in [(found.strike, print.strike_s), (found.lift_off, print.lift_off_s)] {
                let at = panel(time_s);
                let phase = (time_s / truth.stride_time_s).rem_euclid(1.0);
                let off = (found.phase - phase + 0.5).rem_euclid(1.0) - 0.5;
                // No instant can stand between the last panel and the first: there the middle is taken.
                let allowed = if at > 12.0 { 0.5 / 12.0 } else { 1e-6 };
                assert!(off.abs() <= allowed + 1e-9, "{gait} {print:?}: {off}");
            }
        }
    }
}

#[test]
fn numbers_in_seconds_and_metres_come_with_the_calibration() {
    let plate = specimen(Gait::Trot);
    let truth = SyntheticStride::of_gait(Gait::Trot, 1, 12);
    let calibration = calibrate(&plate.manifest, &plate.annotation).unwrap();
    let live = live(&plate, Some(&calibration));
    assert!((live.stride_time_s.unwrap()[0] - truth.stride_time_s).abs() < 1e-6);
    assert!((live.stride_length_m.unwrap()[0] / (truth.speed_m_s * truth.stride_time_s) - 1.0).abs() < 0.02);
    assert!(live.support_s.unwrap()[0] <= truth.stride_time_s + 1e-9);
    assert!(live.law_distances.iter().all(|d| d.kind == muybridge_core::LawKind::Support));
    assert_eq!(live.missing, [], "the withers' height follows from the scale");
    let without = super::tests::live(&plate, None);
    assert_eq!(without.missing, [Missing::Calibration]);
    assert!((without.analysis.lateral_lag() - live.analysis.lateral_lag()).abs() < 1e-6);
}

#[test]
fn plate_of_1878_reads_as_a_rotary_or_transverse_gallop_with_its_hand_instants() {
    let plate = sallie();
    let clock = clock(&plate);
    let footfalls = Footfalls::new(&plate.annotation, clock.clone());
    let off_hind = footfalls.lane(NearOff::Off, Pair::Hind).spans[0];
    assert_eq!((off_hind.strike.at_panel, off_hind.strike.source), (4.1, EdgeSource::Hand));
    assert_eq!(off_hind.lift_off.source, EdgeSource::Midway { bracket: [6.0, 7.0] });
    // The near fore is down in 10, 11 and 1: one stance over the end of the stride, shown at both ends.
    let near_fore = footfalls.lane(NearOff::Near, Pair::Fore);
    assert_eq!(near_fore.spans.len(), 1);
    let shown = footfalls.shown(NearOff::Near, Pair::Fore, [1.0, 11.0]);
    let shown: Vec<[f64; 2]> = shown.iter().map(|s| [s.from_panel, s.to_panel]).collect();
    assert_eq!(shown, [[-1.5, 1.5], [9.5, 12.5]]);
    let live = live(&plate, None);
    assert!(live.analysis.implied.agrees_with(Gait::Gallop), "{:?}", live.analysis.implied);
    assert_eq!(live.analysis.lead, Some(Lead { fore: Side::Right, hind: Side::Right }));
    assert_eq!(live.analysis.footfall_order(), [Limb::LH, Limb::RH, Limb::LF, Limb::RF]);
}

#[test]
fn what_is_missing_is_named() {
    let mut plate = specimen(Gait::Walk);
    for panel in &mut plate.annotation.panels {
        panel.contacts.set(NearOff::Off, Pair::Fore, StanceLabel::Swing);
        panel.contacts.set(NearOff::Near, Pair::Hind, StanceLabel::Stance);
    }
    let footfalls = Footfalls::new(&plate.annotation, clock(&plate));
    let missing =
        LiveGait::new(&footfalls, (&plate.manifest, plate.manifest.gait), None, None, &[]).unwrap_err();
    let words: Vec<String> = missing.iter().map(ToString::to_string).collect();
    assert_eq!(words, ["off fore has no stance span yet", "near hind has no swing yet"]);
    plate.manifest.facing = None;
    let missing =
        LiveGait::new(&footfalls, (&plate.manifest, plate.manifest.gait), None, None, &[]).unwrap_err();
    assert!(missing.contains(&Missing::Facing));
}

#[test]
fn an_edge_dragged_past_a_panel_takes_its_label_along_and_stops_at_its_neighbours() {
    let plate = sallie();
    let clock = clock(&plate);
    let leg = (NearOff::Off, Pair::Hind);
    let later = with_edge(&plate.annotation, &clock, leg, Event::Strike, [4.1, 5.3]);
    assert_eq!(later.panels[4].contacts.off_hind, StanceLabel::Swing);
    assert_eq!(later.panels[3].contacts.off_hind, StanceLabel::Unknown, "not passed, so not known better");
    let earlier = with_edge(&later, &clock, leg, Event::Strike, [5.3, 2.75]);
    let labels: Vec<StanceLabel> = earlier.panels[1..5].iter().map(|p| p.contacts.off_hind).collect();
    assert_eq!(labels, [StanceLabel::Swing, StanceLabel::Stance, StanceLabel::Stance, StanceLabel::Stance]);
    let at = |annotation: &Annotation| {
        let of_leg = |i: &&Instant| (i.side, i.pair) == leg;
        annotation.instants.iter().filter(of_leg).map(|i| i.at_panel).collect::<Vec<f64>>()
    };
    assert_eq!(at(&earlier), [2.75]);
    // Dragged beyond the lift-off it stops before it, and the lift-off stays where it was.
    let far = with_edge(&plate.annotation, &clock, leg, Event::Strike, [4.1, 9.0]);
    let span = Footfalls::new(&far, clock).lane(leg.0, leg.1).spans[0];
    assert!((span.lift_off.at_panel - 6.5).abs() < 1e-9 && span.panels() > 0.0 && span.panels() < 0.1);
}

#[test]
fn a_label_that_contradicts_an_instant_removes_it() {
    let plate = sallie();
    let clock = clock(&plate);
    let leg = (NearOff::Off, Pair::Hind);
    let changed = with_label(&plate.annotation, &clock, leg, 4, StanceLabel::Stance);
    assert_eq!(changed.instants.len(), 1, "a hoof that is down in 4 has not struck at 4.1");
    let agreed = with_label(&plate.annotation, &clock, leg, 4, StanceLabel::Swing);
    assert_eq!(agreed.instants.len(), 2);
}

#[test]
fn a_span_is_drawn_on_a_lane_of_unknowns_and_taken_away_again() {
    let mut plate = specimen(Gait::Gallop);
    let leg = (NearOff::Near, Pair::Hind);
    for panel in &mut plate.annotation.panels {
        panel.contacts.set(leg.0, leg.1, StanceLabel::Unknown);
    }
    let clock = clock(&plate);
    let drawn = with_span(&plate.annotation, &clock, leg, [6.6, 3.4]);
    let labels = |annotation: &Annotation| {
        annotation.panels.iter().map(|p| p.contacts.of(leg.0, leg.1)).collect::<Vec<_>>()
    };
    use StanceLabel::{Stance, Swing, Unknown};
    let [u, s, w] = [Unknown, Stance, Swing];
    assert_eq!(labels(&drawn), [u, u, w, s, s, s, w, u, u, u, u, u]);
    let span = Footfalls::new(&drawn, clock.clone()).lane(leg.0, leg.1).spans[0];
    assert_eq!([span.strike.at_panel, span.lift_off.at_panel], [3.4, 6.6]);
    let again = with_span(&drawn, &clock, leg, [5.0, 9.0]);
    assert_eq!(again, drawn, "a stance cannot begin within another");
    let gone = without_span(&drawn, &clock, leg, 4.0);
    assert_eq!(labels(&gone), [u, u, w, w, w, w, w, u, u, u, u, u]);
    assert!(gone.instants.is_empty());
}

/// Whether labels, instants and spans of every leg agree.
fn assert_consistent(annotation: &Annotation, clock: &StrideClock, story: &str) {
    for lane in &Footfalls::new(annotation, clock.clone()).lanes {
        assert!(lane.contradicting.is_empty(), "{story}: {:?}", lane.contradicting);
        let n = lane.spans.len();
        let around: f64 = (0..n)
            .map(|k| {
                let (span, next) = (&lane.spans[k], &lane.spans[(k + 1) % n]);
                assert!(span.panels() > 0.0, "{story}: {span:?}");
                span.panels() + clock.after(span.lift_off.at_panel, next.strike.at_panel)
            })
            .sum();
        // Stances and swings in between add up to one turn: nothing overlaps.
        assert!(n == 0 || (around - clock.closes_after_panels()).abs() < 1e-6, "{story}: {around}");
        for panel in annotation.panels.iter().filter(|p| p.usage == PanelUse::Stride) {
            let at = f64::from(panel.panel);
            let on_edge = lane
                .spans
                .iter()
                .flat_map(|s| [s.strike.at_panel, s.lift_off.at_panel])
                .any(|edge| clock.after(edge - 1e-6, at) < 2e-6);
            let inside = lane.span_at(clock, at).is_some();
            let label = panel.contacts.of(lane.side, lane.pair);
            let expected = match label {
                StanceLabel::Stance => inside || lane.no_span == Some(NoSpan::NeverUp),
                StanceLabel::Swing => !inside,
                StanceLabel::Unknown => true,
            };
            assert!(expected || on_edge, "{story}: panel {at} is {label:?}; {lane:?}");
        }
    }
}

#[test]
fn any_sequence_of_edits_leaves_labels_and_instants_in_agreement() {
    let mut random = Random::new(4);
    let mut plates: Vec<Plate> = Gait::ALL.into_iter().map(specimen).collect();
    plates.push(sallie());
    for round in 0..48 {
        let mut plate = plates[round % plates.len()].clone();
        // Strides that close before, at and after the last panel.
        let closes = [None, Some(10.3), Some(11.0), Some(12.0), Some(13.4)][round % 5];
        plate.annotation.stride.closes_after_panels = closes;
        let clock = clock(&plate);
        let overlapping = clock.closes_after_panels() < f64::from(clock.last() - clock.first()) + 1.0;
        for step in 0..60 {
            let leg = LANES[(4.0 * random.uniform()) as usize];
            let event = if random.uniform() < 0.5 { Event::Strike } else { Event::LiftOff };
            let [a, b] = [random.between(0.0, 14.0), random.between(0.0, 14.0)];
            let b = if random.uniform() < 0.2 { b.round() } else { b };
            let before = plate.annotation.clone();
            let (kind, after) = match (5.0 * random.uniform()) as u32 {
                0 => ("span", with_span(&before, &clock, leg, [a, b])),
                1 => ("away", without_span(&before, &clock, leg, a)),
                2 => {
                    let label = [StanceLabel::Stance, StanceLabel::Swing, StanceLabel::Unknown]
                        [(3.0 * random.uniform()) as usize];
                    ("label", with_label(&before, &clock, leg, 1 + (11.0 * random.uniform()) as u32, label))
                }
                _ => ("edge", with_edge(&before, &clock, leg, event, [a, b])),
            };
            let story = format!("{} {round}.{step} {kind} {leg:?} {event:?} {a} {b}", plate.manifest.id);
            plate.annotation = after;
            if !overlapping || kind != "label" {
                assert_consistent(&plate.annotation, &clock, &story);
            }
            for (side, pair) in LANES.into_iter().filter(|other| *other != leg) {
                let lane = |of: &Annotation| Footfalls::new(of, clock.clone()).lane(side, pair).clone();
                assert_eq!(lane(&before), lane(&plate.annotation), "{story}: another leg changed");
            }
            if step % 10 > 0 {
                continue;
            }
            let (manifest, annotation) = (plate.manifest.clone(), plate.annotation.clone());
            Plate::from_documents((&plate.manifest_path, manifest), (&plate.annotation_path, annotation))
                .unwrap();
        }
    }
}

#[test]
fn a_frame_of_dragging_takes_no_time() {
    let plate = sallie();
    let calibration = calibrate(&plate.manifest, &plate.annotation).unwrap();
    let laws = published::laws();
    let clock = StrideClock::new(&plate.annotation, Some(&calibration), None);
    let start = std::time::Instant::now();
    for k in 0..200 {
        let to = 4.0 + f64::from(k) * 0.01;
        let leg = (NearOff::Off, Pair::Hind);
        let dragged = with_edge(&plate.annotation, &clock, leg, Event::Strike, [4.1, to]);
        let footfalls = Footfalls::new(&dragged, clock.clone());
        LiveGait::new(&footfalls, (&plate.manifest, plate.manifest.gait), Some(&calibration), None, &laws)
            .unwrap();
    }
    let each_s = start.elapsed().as_secs_f64() / 200.0;
    // The budget is 0.2 ms; ten times that leaves room for a busy machine.
    assert!(each_s < 2e-3, "{each_s} s");
}
