//! Tracking on drawn plates, on "Sallie Gardner", and on pictures that show nothing.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use std::path::{Path, PathBuf};

use image::{GrayImage, Luma};
use muybridge_capture::{
    ANNOTATION_SCHEMA, Annotation, BodyPoint, Facing, Keypoint, KeypointState, Keypoints, LimbJoint,
    MANIFEST_SCHEMA, Manifest, NearOff, Placed, PlacedBy, read_json,
};
use muybridge_core::Pair;
use muybridge_imaging::specimen::{Specimen, SpecimenStyle, draw, swung_legs};
use muybridge_imaging::track::{PanelPoints, Tracked, propose, track};
use muybridge_imaging::{LoadLimits, PanelView, load_gray};

const LONGEST_PX: u32 = 700;

struct Shot {
    view: PanelView,
    points: Keypoints,
}

impl Shot {
    fn known(&self) -> PanelPoints<'_> {
        PanelPoints { view: &self.view, silhouette: None, points: &self.points }
    }
}

/// Errors of visible points of one joint, in shares of the height.
fn errors(found: &[Tracked], truth: &Keypoints, height_px: f64, joint: LimbJoint) -> Vec<f64> {
    let error = |tracked: &Tracked| {
        let placed = truth.get(tracked.keypoint)?;
        let wanted = matches!(tracked.keypoint, Keypoint::Limb(_, _, j) if j == joint);
        let at_px = placed.at_px.filter(|_| wanted && placed.state == KeypointState::Visible)?;
        Some((at_px[0] - tracked.at_px[0]).hypot(at_px[1] - tracked.at_px[1]) / height_px)
    };
    found.iter().filter_map(error).collect()
}

fn share_within(errors: &[f64], limit: f64) -> f64 {
    errors.iter().filter(|error| **error < limit).count() as f64 / errors.len() as f64
}

fn shots(specimen: &Specimen) -> Vec<Shot> {
    let shot = |panel: &muybridge_imaging::specimen::PanelTruth| Shot {
        view: PanelView::new(&specimen.picture, panel.quad_px, LONGEST_PX).unwrap(),
        points: panel.keypoints.clone(),
    };
    specimen.truth.panels.iter().map(shot).collect()
}

fn drawn(facing: Facing, style: &SpecimenStyle) -> (Vec<Shot>, f64) {
    let specimen = draw(&swung_legs(12, facing), style);
    let height_px = specimen.truth.withers_height_m * specimen.truth.panels[0].camera.px_per_m;
    (shots(&specimen), height_px)
}

#[test]
fn hooves_of_a_drawn_trot_are_found_a_panel_ahead() {
    let looks = [SpecimenStyle::default(), SpecimenStyle::animal_locomotion()];
    for (facing, style) in [Facing::Right, Facing::Left].into_iter().zip(looks) {
        let (shots, height_px) = drawn(facing, &style);
        let mut all = Vec::new();
        for next in [3, 6, 8] {
            let known = [shots[next - 2].known(), shots[next - 1].known()];
            let found = track(&known, &shots[next].view, None);
            all.extend(errors(&found, &shots[next].points, height_px, LimbJoint::Hoof));
        }
        assert!(all.len() >= 8 && share_within(&all, 0.02) >= 0.8, "{facing:?}: {all:.3?}");
    }
}

#[test]
fn tracking_backwards_is_tracking_with_the_order_turned_round() {
    let (shots, height_px) = drawn(Facing::Right, &SpecimenStyle::default());
    let found = track(&[shots[6].known(), shots[5].known()], &shots[4].view, None);
    let errors = errors(&found, &shots[4].points, height_px, LimbJoint::Fetlock);
    assert!(share_within(&errors, 0.03) >= 0.75, "{errors:.3?}");
}

fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

#[test]
fn sallie_gardners_limbs_are_followed_a_panel_ahead() {
    let root = repository();
    let picture = root.join("../shared/plates/sallie-gardner-1878/plate.jpg");
    if !picture.exists() {
        println!("skipped: no shared plates");
        return;
    }
    let manifest: Manifest =
        read_json(&root.join("plates/sallie-gardner-1878.json"), MANIFEST_SCHEMA).unwrap();
    let annotation: Annotation =
        read_json(&root.join("annotations/sallie-gardner-1878.json"), ANNOTATION_SCHEMA).unwrap();
    let plate = load_gray(&picture, LoadLimits::default()).unwrap();
    let shots: Vec<Shot> = (0..11)
        .map(|i| Shot {
            view: PanelView::new(&plate, manifest.panels[i].quad_px, LONGEST_PX).unwrap(),
            points: annotation.panels[i].keypoints.clone(),
        })
        .collect();
    // Withers over the ground line in the gallop, px.
    let height_px = 166.0;
    let mut all = [LimbJoint::Hoof, LimbJoint::Fetlock, LimbJoint::Middle].map(|joint| (joint, Vec::new()));
    for next in 2..11 {
        let found = track(&[shots[next - 2].known(), shots[next - 1].known()], &shots[next].view, None);
        for (joint, all) in &mut all {
            all.extend(errors(&found, &shots[next].points, height_px, *joint));
        }
    }
    // Hand-placed points repeat to 1.5 px a coordinate, so that 2 % of the height is hardly more than the truth's own error.
    for ((joint, errors), least) in all.iter().zip([0.55, 0.70, 0.70]) {
        let (two, four) = (share_within(errors, 0.02), share_within(errors, 0.04));
        println!("{joint:?}: {} seen, {two:.2} within 2 %, {four:.2} within 4 %", errors.len());
        assert!(four >= least, "{joint:?}: {errors:.3?}");
    }
}

#[test]
fn a_plain_panel_gets_proposals_that_say_they_are_worthless() {
    let (shots, _) = drawn(Facing::Right, &SpecimenStyle::default());
    let mut plain = shots[4].view.clone();
    plain.image.pixels_mut().for_each(|pixel| pixel.0 = [150]);
    let proposals = propose(&[shots[2].known(), shots[3].known()], &plain, None);
    assert_eq!(proposals.len(), Keypoint::all().count());
    for proposal in &proposals {
        assert!(proposal.quality < 0.3, "{}: {}", proposal.keypoint, proposal.quality);
        assert_eq!(proposal.placed.by, PlacedBy::Tracked);
    }
    assert!(proposals.iter().map(|p| p.keypoint).eq(Keypoint::all()));
}

#[test]
fn covered_limbs_have_less_quality_than_seen_ones() {
    let (shots, _) = drawn(Facing::Right, &SpecimenStyle::default());
    let mut covered = shots[6].view.clone();
    let panel_px = |keypoint| covered.transform.panel_from_plate(shots[6].points.place(keypoint).unwrap());
    let [middle_x, _] = panel_px(Keypoint::Body(BodyPoint::Back));
    let [_, stifle_y] = panel_px(Keypoint::Limb(NearOff::Near, Pair::Hind, LimbJoint::Upper));
    for (x, y, pixel) in covered.image.enumerate_pixels_mut() {
        if f64::from(x) < middle_x && f64::from(y) > stifle_y {
            *pixel = Luma([160]);
        }
    }
    let found = track(&[shots[4].known(), shots[5].known()], &covered, None);
    let quality = |pair| {
        let hoof = Keypoint::hoof(NearOff::Near, pair);
        found.iter().find(|tracked| tracked.keypoint == hoof).map_or(0.0, |tracked| tracked.quality)
    };
    assert!(
        quality(Pair::Fore) > 0.8 && quality(Pair::Hind) < 0.3,
        "{} {}",
        quality(Pair::Fore),
        quality(Pair::Hind)
    );
}

#[test]
fn points_that_cannot_be_tracked_are_carried_along() {
    let (mut shots, _) = drawn(Facing::Right, &SpecimenStyle::default());
    let hoof = Keypoint::hoof(NearOff::Near, Pair::Fore);
    let lone = shots[5].points.get(hoof).copied();
    for joint in [LimbJoint::Root, LimbJoint::Upper, LimbJoint::Middle, LimbJoint::Fetlock] {
        shots[5].points.remove(Keypoint::Limb(NearOff::Near, Pair::Fore, joint));
    }
    let proposals = propose(&[shots[5].known()], &shots[6].view, None);
    let proposal = proposals.iter().find(|p| p.keypoint == hoof).unwrap();
    assert_eq!(proposal.quality, 0.0);
    assert!(lone.is_some() && proposal.placed.at_px.is_some());
    let withers = Keypoint::Body(BodyPoint::Withers);
    assert!(proposals.iter().any(|p| p.keypoint == withers && p.quality > 0.5));
}

#[test]
fn nothing_at_all_is_no_reason_to_fail() {
    let (shots, _) = drawn(Facing::Left, &SpecimenStyle::default());
    assert!(track(&[], &shots[0].view, None).is_empty());
    let nothing = Keypoints::default();
    let empty = PanelPoints { view: &shots[0].view, silhouette: None, points: &nothing };
    assert!(propose(&[empty], &shots[1].view, None).is_empty());

    let place =
        |at_px| Placed { at_px: Some(at_px), state: KeypointState::Visible, by: PlacedBy::Hand, sd_px: None };
    let everywhere = |at: fn(usize) -> [f64; 2]| {
        let mut points = Keypoints::default();
        Keypoint::all().enumerate().for_each(|(i, keypoint)| points.insert(keypoint, place(at(i))));
        points
    };
    let odd: [fn(usize) -> [f64; 2]; 5] = [
        |_| [50.0, 50.0],
        |_| [f64::NAN, 0.0],
        |i| [1e9 * i as f64, -1e12],
        |i| [0.01 * i as f64, 20.0],
        |i| [40.0 * (i % 7) as f64 - 100.0, 90.0 * (i % 3) as f64],
    ];
    let tiny = GrayImage::from_pixel(1, 1, Luma([7]));
    let tiny = PanelView::new(&tiny, [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], 9).unwrap();
    for at in odd {
        let points = everywhere(at);
        for (view, next) in
            [(&shots[0].view, &tiny), (&tiny, &shots[0].view), (&shots[0].view, &shots[1].view)]
        {
            let known = PanelPoints { view, silhouette: Some(&tiny.image), points: &points };
            let black = GrayImage::new(next.image.width(), next.image.height());
            for tracked in track(&[known, known], next, Some(&black)) {
                assert!((0.0..=1.0).contains(&tracked.quality), "{tracked:?}");
            }
        }
    }
}
