//! Provisional cameras, lengths of a plate, and keypoints between panels.

use muybridge_capture::{Annotation, Keypoint, Keypoints, Placed, PlacedBy};
use muybridge_core::{BONE_COUNT, Skeleton};

use super::{SPECIMENS, Specimen, distance, quantile, sorted};
use crate::chain::Chain;
use crate::layout::SHARED;
use crate::posing::{
    PlacedPanel, ScaleOrigin, SequencePanel, interpolate, plate_lengths, plate_scale, provisional_camera,
};
use crate::synthetic::SyntheticStride;

#[test]
fn provisional_cameras_come_near_the_calibrated_ones() {
    let skeleton = Skeleton::reference();
    for gait in SPECIMENS {
        let mut specimen = Specimen::load(gait);
        let truth = specimen.calibration.stride[0].px_per_m;
        let facing = specimen.facing();
        specimen.plate.manifest.calibration = None;
        let manifest = specimen.plate.manifest.clone();
        let mut annotation = specimen.plate.annotation.clone();
        let scale = |annotation: &Annotation, given: Option<f64>| {
            plate_scale(&skeleton, &manifest, annotation, facing, given)
        };
        let given = scale(&annotation, Some(123.0));
        assert_eq!((given.px_per_m, given.from), (123.0, ScaleOrigin::Given));
        let from_withers = scale(&annotation, Some(f64::NAN));
        assert_eq!(from_withers.from, ScaleOrigin::Withers);
        for panel in &mut annotation.panels {
            panel.ground_px = None;
        }
        let from_limbs = scale(&annotation, None);
        assert_eq!(from_limbs.from, ScaleOrigin::LimbLengths);
        for panel in &mut annotation.panels {
            panel.keypoints = Keypoints::default();
        }
        let from_panels = scale(&annotation, None);
        assert_eq!(from_panels.from, ScaleOrigin::PanelHeight);
        let errors = [from_withers, from_limbs, from_panels].map(|s| 100.0 * (s.px_per_m / truth - 1.0));
        println!(
            "{gait}: scale from withers {:+.1} %, limbs {:+.1} %, panels {:+.1} %",
            errors[0], errors[1], errors[2]
        );
        assert!(errors[0].abs() < 12.0 && errors[1].abs() < 12.0 && errors[2].abs() < 60.0);
        for calibrated in &specimen.calibration.stride {
            let drawn = &specimen.plate.annotation;
            let camera =
                provisional_camera(&manifest, drawn, facing, calibrated.panel, from_withers).unwrap();
            let foot = calibrated.world_from_plate(camera.axis_foot_px, 0.0);
            assert!(foot[1].abs() < 0.01 && distance(camera.up, calibrated.up) < 1e-6);
            let guessed = provisional_camera(&manifest, &annotation, facing, calibrated.panel, from_panels);
            let foot = calibrated.world_from_plate(guessed.unwrap().axis_foot_px, 0.0);
            assert!(foot[1].abs() < 0.3, "guessed ground is {} m off", foot[1]);
        }
        assert!(provisional_camera(&manifest, &annotation, facing, 999, from_panels).is_none());
    }
}

#[test]
fn lengths_of_a_plate_come_from_its_points_and_rest_on_the_reference_without_any() {
    let reference = Skeleton::reference();
    let chain = Chain::new(&reference);
    let mut errors = [Vec::new(), Vec::new()];
    for seed in 0..10 {
        let stride = SyntheticStride::new(seed, 12);
        let observation =
            stride.observe(&crate::synthetic::Placing::default(), &crate::weights::Weights::default());
        let points: Vec<Keypoints> = observation
            .panels
            .iter()
            .map(|panel| {
                let mut keypoints = Keypoints::default();
                for point in &panel.points {
                    let placed = Placed {
                        at_px: Some(point.at_px),
                        state: point.state,
                        by: PlacedBy::Hand,
                        sd_px: None,
                    };
                    keypoints.insert(point.keypoint, placed);
                }
                keypoints
            })
            .collect();
        let panels: Vec<PlacedPanel<'_>> = observation
            .panels
            .iter()
            .zip(&points)
            .map(|(panel, keypoints)| PlacedPanel { camera: &panel.camera, keypoints })
            .collect();
        let lengths = plate_lengths(&reference, stride.facing, &panels);
        for bone in 8..BONE_COUNT {
            let truth = f64::from(stride.horse.bones[bone].length_m);
            errors[0].push((chain.length_m(bone, &lengths) / truth - 1.0).abs());
            errors[1].push((chain.length_m(bone, &[0.0; SHARED]) / truth - 1.0).abs());
        }
        assert_eq!(plate_lengths(&reference, stride.facing, &[]), [0.0; SHARED]);
    }
    let [measured, assumed] = errors.map(|e| 100.0 * quantile(&sorted(e), 0.5));
    println!("bone lengths: median error {measured:.1} %, of the reference {assumed:.1} %");
    assert!(measured < 0.75 * assumed);
}

/// Median errors, px, of panels interpolated through poses and in a straight line, when every `step`th is placed.
fn interpolation_errors(specimen: &Specimen, step: usize, period: f64) -> Option<[f64; 2]> {
    let all: Vec<SequencePanel> = specimen
        .panels()
        .map(|(camera, panel)| SequencePanel {
            panel: panel.panel,
            camera: *camera,
            keypoints: panel.keypoints.clone(),
            contacts: panel.contacts,
        })
        .collect();
    let placed = |i: usize| i.is_multiple_of(step);
    let sequence: Vec<SequencePanel> = all
        .iter()
        .enumerate()
        .map(|(i, p)| {
            let keypoints = if placed(i) { p.keypoints.clone() } else { Keypoints::default() };
            SequencePanel { keypoints, ..p.clone() }
        })
        .collect();
    let (mut posed, mut straight) = (Vec::new(), Vec::new());
    for i in (0..all.len()).filter(|i| !placed(*i)) {
        let found = interpolate(
            &Skeleton::reference(),
            specimen.facing(),
            &specimen.lengths,
            &sequence,
            all[i].panel,
            Some(period),
        );
        let (before, after) = (i - i % step, i - i % step + step);
        for keypoint in Keypoint::all() {
            let Some(truth) = all[i].keypoints.place(keypoint) else { continue };
            let Some(at) = found.place(keypoint) else { continue };
            assert_eq!(found.get(keypoint).unwrap().by, PlacedBy::Interpolated);
            // A straight line in the panel's own frame, as its foot of the axis is the origin.
            let from = |i: usize| {
                let (p, foot) = (&all[i % all.len()], all[i % all.len()].camera.axis_foot_px);
                p.keypoints.place(keypoint).map(|[x, y]| [x - foot[0], y - foot[1]])
            };
            let (Some(a), Some(b)) = (from(before), from(after)) else { continue };
            let share = (i - before) as f64 / step as f64;
            let foot = all[i].camera.axis_foot_px;
            let line = [0, 1].map(|axis| foot[axis] + a[axis] + share * (b[axis] - a[axis]));
            posed.push(distance(at, truth));
            straight.push(distance(line, truth));
        }
    }
    let mean = |values: &[f64]| values.iter().sum::<f64>() / values.len() as f64;
    (!posed.is_empty()).then(|| [mean(&posed), mean(&straight)])
}

#[test]
fn interpolated_poses_beat_straight_lines() {
    for gait in ["walk", "amble", "trot", "rack", "canter", "gallop"] {
        let specimen = Specimen::load(gait);
        let period = specimen.plate.annotation.stride.closes_after_panels.unwrap();
        for step in [2, 3] {
            let Some([posed, straight]) = interpolation_errors(&specimen, step, period) else { continue };
            println!(
                "{gait}, 1 of {step} panels placed: mean error {posed:.2} px through poses, {straight:.2} px in straight lines"
            );
            assert!(posed < straight, "{gait} {step}: {posed} {straight}");
        }
    }
}

#[test]
fn nothing_is_interpolated_beyond_the_placed_panels() {
    let specimen = Specimen::load("walk");
    let mut sequence: Vec<SequencePanel> = specimen
        .panels()
        .map(|(camera, panel)| SequencePanel {
            panel: panel.panel,
            camera: *camera,
            keypoints: panel.keypoints.clone(),
            contacts: panel.contacts,
        })
        .collect();
    for panel in &mut sequence[8..] {
        panel.keypoints = Keypoints::default();
    }
    let found = |target: u32, period: Option<f64>| {
        interpolate(&Skeleton::reference(), specimen.facing(), &specimen.lengths, &sequence, target, period)
    };
    assert_eq!(found(10, None).iter().count(), 0);
    assert_eq!(found(77, Some(12.0)).iter().count(), 0);
    assert!(found(10, Some(12.0)).iter().count() > 20, "the stride closes");
}
