//! True annotations raise no warning; each fault raises its own, in the right place, first.

use std::path::Path;

use muybridge_capture::{
    BodyPoint, Event, Instant, KeypointState, LimbJoint, Placed, PlacedBy, Plate, StanceLabel, calibrate,
};
use muybridge_core::{Gait, Skeleton};

use super::*;
use crate::footfalls::LANES;
use crate::pipeline::{PlateFit, fit_loaded};
use crate::weights::Weights;

mod swaps;

fn plate(path: &str) -> Plate {
    Plate::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)).unwrap()
}

fn specimen(gait: Gait) -> Plate {
    plate(&format!("plates/specimens/annotations/specimen-{gait}.json"))
}

fn concerns(plate: &Plate) -> Vec<Concern> {
    let calibration = calibrate(&plate.manifest, &plate.annotation).ok();
    before_fit(&plate.annotation, &plate.manifest, calibration.as_ref())
}

fn fitted(plate: &Plate) -> PlateFit {
    fit_loaded(plate.clone(), &Skeleton::reference(), &Weights::default()).unwrap()
}

/// Moves a point by withers heights, forward and up.
fn move_point(plate: &mut Plate, index: usize, keypoint: Keypoint, [forward, up]: [f64; 2]) {
    let calibration = calibrate(&plate.manifest, &plate.annotation).unwrap();
    let camera = calibration.stride[index];
    let height_px = 1.6 * camera.px_per_m;
    let placed = plate.annotation.panels[index].keypoints.get(keypoint).copied().unwrap();
    let at = placed.at_px.unwrap();
    let moved = [0, 1].map(|i| at[i] + height_px * (forward * camera.forward[i] + up * camera.up[i]));
    let placed = Placed { at_px: Some(moved), ..placed };
    plate.annotation.panels[index].keypoints.insert(keypoint, placed);
}

fn place(plate: &Plate, index: usize, keypoint: Keypoint) -> [f64; 2] {
    plate.annotation.panels[index].keypoints.place(keypoint).unwrap()
}

fn set(plate: &mut Plate, index: usize, keypoint: Keypoint, at_px: [f64; 2]) {
    let placed =
        Placed { at_px: Some(at_px), state: KeypointState::Visible, by: PlacedBy::Hand, sd_px: None };
    plate.annotation.panels[index].keypoints.insert(keypoint, placed);
}

const JOINTS: [LimbJoint; 5] =
    [LimbJoint::Root, LimbJoint::Upper, LimbJoint::Middle, LimbJoint::Fetlock, LimbJoint::Hoof];

/// The first concern is of this kind, at this panel (by index) and limb.
fn assert_first(plate: &Plate, kind: ConcernKind, index: usize, limb: Option<(NearOff, Pair)>, story: &str) {
    let found = concerns(plate);
    let panel = plate.annotation.panels[index].panel;
    let first = found.first().unwrap_or_else(|| panic!("{story}: nothing found"));
    assert_eq!((first.kind, first.panel), (kind, Some(panel)), "{story}: {found:#?}");
    if limb.is_some() {
        assert_eq!(first.limb, limb, "{story}: {found:#?}");
    }
    assert!(!first.text.is_empty() && first.text.matches(". ").count() == 0, "{}", first.text);
}

#[test]
fn true_annotations_raise_nothing_before_a_fit_and_no_warning_after_it() {
    for gait in Gait::ALL {
        let plate = specimen(gait);
        assert_eq!(concerns(&plate), [], "{gait}");
        assert_eq!(before_fit(&plate.annotation, &plate.manifest, None), [], "{gait} without calibration");
        let after = after_fit(&fitted(&plate));
        assert!(after.iter().all(|c| c.severity < Severity::Warning), "{gait}: {after:#?}");
    }
}

#[test]
fn plate_of_1878_raises_no_warning() {
    let plate = plate("annotations/sallie-gardner-1878.json");
    for found in [concerns(&plate), after_fit(&fitted(&plate))] {
        assert!(found.iter().all(|c| c.severity < Severity::Warning), "{found:#?}");
    }
}

#[test]
fn the_scatter_of_a_careful_hand_raises_next_to_nothing() {
    let mut raised = Vec::new();
    for gait in Gait::ALL {
        let original = specimen(gait);
        for seed in 0..20 {
            let mut random = muybridge_core::Random::new(seed);
            let mut plate = original.clone();
            // As on the plate of 1878: 1 % of withers height for what is seen, 1.5 % for what is guessed.
            (plate.annotation.visible_sd_px, plate.annotation.occluded_sd_px) = (1.0, 1.5);
            for panel in &mut plate.annotation.panels {
                let placed: Vec<(Keypoint, Placed)> = panel.keypoints.iter().map(|(k, p)| (k, *p)).collect();
                for (keypoint, mut placed) in placed {
                    let sd_px = if placed.state == KeypointState::Visible { 1.0 } else { 1.5 };
                    placed.at_px = placed.at_px.map(|at| at.map(|v| v + sd_px * random.normal()));
                    panel.keypoints.insert(keypoint, placed);
                }
            }
            raised.extend(concerns(&plate).into_iter().filter(|c| c.severity == Severity::Warning));
        }
    }
    let mut kinds: Vec<ConcernKind> = raised.iter().map(|c| c.kind).collect();
    kinds.sort();
    assert!(raised.len() <= 10, "{} in 140 plates: {kinds:?}", raised.len());
}

#[test]
fn nothing_in_a_draft_makes_a_check_or_the_footfalls_fail() {
    let mut random = muybridge_core::Random::new(9);
    let wild = [f64::NAN, f64::INFINITY, -1e300, 0.0, 7.5];
    for round in 0..60 {
        let mut plate = specimen(Gait::ALL[round % 7]);
        let calibration = calibrate(&plate.manifest, &plate.annotation).unwrap();
        let mut number = |count: usize| (random.uniform() * count as f64) as usize;
        let annotation = &mut plate.annotation;
        annotation.stride.first = [0, 1, 5, 12, u32::MAX][number(5)];
        annotation.stride.last = [0, 1, 5, 12, u32::MAX][number(5)];
        annotation.stride.closes_after_panels = Some(wild[number(5)]);
        annotation.panels.truncate([0, 1, 2, 5, 12][number(5)]);
        for panel in &mut annotation.panels {
            let keypoint = Keypoint::all().nth(number(26)).unwrap();
            let at_px = Some([wild[number(5)], wild[number(5)]]);
            panel.keypoints.insert(
                keypoint,
                Placed { at_px, state: KeypointState::Visible, by: PlacedBy::Hand, sd_px: None },
            );
            panel.ground_px = [panel.ground_px, None, Some([[wild[number(5)]; 2]; 2])][number(3)];
        }
        for (side, pair) in LANES {
            let event = [Event::Strike, Event::LiftOff][number(2)];
            annotation.instants.push(Instant { side, pair, event, at_panel: wild[number(5)] });
        }
        for calibration in [None, Some(&calibration)] {
            before_fit(annotation, &plate.manifest, calibration);
            let clock = StrideClock::new(annotation, calibration, None);
            for leg in LANES {
                let places = [wild[number(5)], wild[number(5)]];
                crate::footfalls::with_edge(annotation, &clock, leg, Event::Strike, places);
                crate::footfalls::with_span(annotation, &clock, leg, places);
                crate::footfalls::without_span(annotation, &clock, leg, places[0]);
                Footfalls::new(annotation, clock.clone()).shown(leg.0, leg.1, places);
            }
        }
    }
}

#[test]
fn a_stretched_bone_is_found() {
    for gait in [Gait::Walk, Gait::Trot, Gait::Gallop] {
        let original = specimen(gait);
        for (side, pair) in LANES {
            let swings = (0..12)
                .filter(|k| original.annotation.panels[*k].contacts.of(side, pair) == StanceLabel::Swing);
            for (index, bone) in swings.zip([0, 1, 2, 3].into_iter().cycle()) {
                let mut plate = original.clone();
                let ends = [0, 1].map(|k| place(&plate, index, Keypoint::Limb(side, pair, JOINTS[bone + k])));
                let stretch = [0, 1].map(|i| 0.25 * (ends[1][i] - ends[0][i]));
                for joint in &JOINTS[bone + 1..] {
                    let [x, y] = place(&plate, index, Keypoint::Limb(side, pair, *joint));
                    set(
                        &mut plate,
                        index,
                        Keypoint::Limb(side, pair, *joint),
                        [x + stretch[0], y + stretch[1]],
                    );
                }
                let story = format!("{gait} {side:?} {pair:?} {bone}");
                assert_first(&plate, ConcernKind::BoneLength, index, Some((side, pair)), &story);
            }
        }
    }
}

#[test]
fn a_joint_moved_along_its_limb_is_named_itself() {
    let mut plate = specimen(Gait::Trot);
    let joint = |joint| Keypoint::Limb(NearOff::Near, Pair::Fore, joint);
    let [knee, fetlock] = [LimbJoint::Middle, LimbJoint::Fetlock].map(|j| place(&plate, 3, joint(j)));
    set(&mut plate, 3, joint(LimbJoint::Middle), [0, 1].map(|i| knee[i] + 0.45 * (fetlock[i] - knee[i])));
    let found = concerns(&plate);
    assert_eq!(found[0].keypoints, [joint(LimbJoint::Middle)], "{found:#?}");
}

#[test]
fn a_stance_hoof_off_the_ground_is_found() {
    for gait in Gait::ALL {
        let original = specimen(gait);
        for (side, pair) in LANES {
            for index in 0..12 {
                if original.annotation.panels[index].contacts.of(side, pair) != StanceLabel::Stance {
                    continue;
                }
                let mut plate = original.clone();
                move_point(&mut plate, index, Keypoint::hoof(side, pair), [0.0, 0.04]);
                let story = format!("{gait} {side:?} {pair:?}");
                assert_first(&plate, ConcernKind::StanceOffGround, index, Some((side, pair)), &story);
            }
        }
    }
}

#[test]
fn a_standing_hoof_called_swing_is_found() {
    let mut plate = specimen(Gait::Walk);
    let leg = (NearOff::Off, Pair::Hind);
    let stance =
        |plate: &Plate, k: usize| plate.annotation.panels[k].contacts.of(leg.0, leg.1) == StanceLabel::Stance;
    let index = (1..11).find(|k| (k - 1..=k + 1).all(|k| stance(&plate, k))).unwrap();
    plate.annotation.panels[index].contacts.set(leg.0, leg.1, StanceLabel::Swing);
    assert_first(&plate, ConcernKind::SwingOnGround, index, Some(leg), "walk");
}

#[test]
fn a_knee_and_a_hock_bent_the_wrong_way_are_found() {
    for (side, pair) in LANES {
        let mut plate = specimen(Gait::Trot);
        let joint = |joint| Keypoint::Limb(side, pair, joint);
        // Where the limb is folded most, its lower part is turned over to the other side of the upper.
        let bend = |plate: &Plate, index: usize| {
            let [a, b, c] = [LimbJoint::Upper, LimbJoint::Middle, LimbJoint::Fetlock]
                .map(|j| place(plate, index, joint(j)));
            let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
            (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1])
        };
        let index = (0..12).max_by(|a, b| bend(&plate, *a).abs().total_cmp(&bend(&plate, *b).abs())).unwrap();
        let (sin, cos) = (-2.0 * bend(&plate, index)).sin_cos();
        let pivot = place(&plate, index, joint(LimbJoint::Middle));
        for lower in [LimbJoint::Fetlock, LimbJoint::Hoof] {
            let at = place(&plate, index, joint(lower));
            let [x, y] = [at[0] - pivot[0], at[1] - pivot[1]];
            set(
                &mut plate,
                index,
                joint(lower),
                [pivot[0] + cos * x - sin * y, pivot[1] + sin * x + cos * y],
            );
        }
        assert_first(&plate, ConcernKind::BentWrongWay, index, Some((side, pair)), "trot");
    }
}

#[test]
fn points_outside_on_top_and_missing_are_found() {
    let mut plate = specimen(Gait::Rack);
    let hock = Keypoint::Limb(NearOff::Near, Pair::Hind, LimbJoint::Middle);
    let quad = plate.manifest.panels[2].quad_px;
    set(&mut plate, 2, hock, [quad[0][0] - 40.0, quad[0][1]]);
    assert_first(&plate, ConcernKind::OutsidePanel, 2, Some((NearOff::Near, Pair::Hind)), "outside");

    let mut plate = specimen(Gait::Rack);
    let at = place(&plate, 5, hock);
    set(&mut plate, 5, Keypoint::Limb(NearOff::Near, Pair::Hind, LimbJoint::Fetlock), [at[0] + 0.5, at[1]]);
    assert_first(&plate, ConcernKind::OnTop, 5, Some((NearOff::Near, Pair::Hind)), "on top");

    let mut plate = specimen(Gait::Rack);
    plate.annotation.panels[7].keypoints.remove(hock);
    plate.annotation.panels[7].keypoints.remove(Keypoint::Body(BodyPoint::Poll));
    assert_first(&plate, ConcernKind::MissingPoints, 7, None, "missing");
    let found = concerns(&plate);
    assert_eq!(found.len(), 1);
    assert_eq!(found[0].severity, Severity::Note);
    assert_eq!(found[0].text, "poll, near hock are not placed yet; place or call absent");
}

#[test]
fn a_contradicting_instant_and_a_second_stance_are_found() {
    let mut plate = specimen(Gait::Canter);
    let leg = (NearOff::Near, Pair::Fore);
    let label = |plate: &Plate, k: usize| plate.annotation.panels[k].contacts.of(leg.0, leg.1);
    let swing = (1..11).find(|k| (k - 1..=k + 1).all(|k| label(&plate, k) == StanceLabel::Swing)).unwrap();
    let mut again = plate.clone();
    let at_panel = swing as f64 + 1.5;
    plate.annotation.instants.push(Instant { side: leg.0, pair: leg.1, event: Event::Strike, at_panel });
    assert_first(&plate, ConcernKind::ContradictingInstant, swing, Some(leg), "canter");
    again.annotation.panels[swing].contacts.set(leg.0, leg.1, StanceLabel::Stance);
    let found = concerns(&again);
    let second = found.iter().find(|c| c.kind == ConcernKind::LegContacts).unwrap();
    assert_eq!((second.panel, second.limb), (Some(swing as u32 + 1), Some(leg)));
}

/// The labels alone, in any order of panels.
fn labels_only(gait: Gait, panel_of: impl Fn(usize) -> usize) -> Plate {
    let mut plate = specimen(gait);
    let labels: Vec<_> = plate.annotation.panels.iter().map(|panel| panel.contacts).collect();
    for (k, panel) in plate.annotation.panels.iter_mut().enumerate() {
        panel.contacts = labels[panel_of(k)];
        for keypoint in Keypoint::all() {
            let absent =
                Placed { at_px: None, state: KeypointState::Absent, by: PlacedBy::Hand, sd_px: None };
            panel.keypoints.insert(keypoint, absent);
        }
    }
    plate
}

#[test]
fn footfalls_in_reverse_are_no_gait_of_the_horse() {
    for gait in [Gait::Walk, Gait::Amble, Gait::Canter, Gait::Gallop] {
        assert_eq!(concerns(&labels_only(gait, |k| k)), [], "{gait}");
        let found = concerns(&labels_only(gait, |k| 11 - k));
        assert_eq!(found.first().map(|c| c.kind), Some(ConcernKind::FootfallOrder), "{gait}: {found:#?}");
    }
}

#[test]
fn a_title_of_another_gait_is_doubted() {
    for (gait, title) in [(Gait::Trot, Gait::Rack), (Gait::Rack, Gait::Trot), (Gait::Gallop, Gait::Walk)] {
        let mut plate = specimen(gait);
        plate.manifest.gait = title;
        let found = concerns(&plate);
        assert!(found.iter().any(|c| c.kind == ConcernKind::GaitAgainstTitle), "{gait} {title}: {found:#?}");
    }
}

#[test]
fn a_leg_that_never_stands_is_named_once_all_its_panels_are_labelled() {
    let mut plate = specimen(Gait::Trot);
    for panel in &mut plate.annotation.panels {
        panel.contacts.set(NearOff::Off, Pair::Fore, StanceLabel::Swing);
    }
    let found = concerns(&plate);
    let leg = found.iter().find(|c| c.kind == ConcernKind::LegContacts).unwrap();
    assert_eq!(leg.limb, Some((NearOff::Off, Pair::Fore)));
    plate.annotation.panels[0].contacts.set(NearOff::Off, Pair::Fore, StanceLabel::Unknown);
    assert!(concerns(&plate).iter().all(|c| c.kind != ConcernKind::LegContacts));
}

#[test]
fn after_a_fit_the_worst_point_a_slide_and_a_jump_come_first() {
    let mut plate = specimen(Gait::Trot);
    let stifle = Keypoint::Limb(NearOff::Near, Pair::Hind, LimbJoint::Upper);
    move_point(&mut plate, 4, stifle, [0.1, 0.05]);
    let found = after_fit(&fitted(&plate));
    assert_eq!((found[0].kind, found[0].panel), (ConcernKind::Residual, Some(5)), "{found:#?}");
    assert_eq!(found[0].keypoints, [stifle]);
    let sizes: Vec<f64> = found.iter().filter(|c| c.severity == Severity::Warning).map(|c| c.size).collect();
    assert!(sizes.is_sorted_by(|a, b| a >= b));

    let mut plate = specimen(Gait::Walk);
    let leg = (NearOff::Near, Pair::Fore);
    let stance =
        |plate: &Plate, k: usize| plate.annotation.panels[k].contacts.of(leg.0, leg.1) == StanceLabel::Stance;
    let index = (1..11).find(|k| stance(&plate, *k) && stance(&plate, k - 1)).unwrap();
    move_point(&mut plate, index, Keypoint::hoof(leg.0, leg.1), [0.12, 0.0]);
    let found = after_fit(&fitted(&plate));
    let slip = found.iter().find(|c| c.kind == ConcernKind::StanceSlip).unwrap();
    assert_eq!((slip.panel, slip.limb), (Some(index as u32 + 1), Some(leg)), "{found:#?}");
}

#[test]
fn a_stride_that_does_not_close_is_doubted() {
    let mut plate = specimen(Gait::Walk);
    // Two thirds of a stride, and nobody says after how many panels it closes.
    plate.annotation.stride.last = 8;
    plate.annotation.panels.truncate(8);
    plate.annotation.stride.closes_after_panels = None;
    let found = after_fit(&fitted(&plate));
    assert!(found.iter().any(|c| c.kind == ConcernKind::LoopOpen), "{found:#?}");
}
