//! Poses through placed points, and the derivatives behind every pose.

use std::time::Instant;

use muybridge_capture::{BodyPoint, Keypoint, KeypointState, Keypoints, Placed, PlacedBy};
use muybridge_core::{Limb, Random};

use super::{CAREFUL, SPECIMENS, Specimen, assert_within_limits, distance, quantile, sorted};
use crate::chain::Attachment;
use crate::layout::PANEL_DOF;
use crate::posing::PanelPose;
use crate::posing::damped::{Curvature, Loss, PointTerm, PoseProblem};

#[test]
fn pose_runs_through_the_points_of_every_specimen() {
    for gait in SPECIMENS {
        let specimen = Specimen::load(gait);
        let (mut distances, mut times_ms) = (Vec::new(), Vec::new());
        for (camera, panel) in specimen.panels() {
            let poser = specimen.poser(camera, panel);
            let before = Instant::now();
            let pose = poser.pose_from_points(&panel.keypoints, CAREFUL, None);
            times_ms.push(before.elapsed().as_secs_f64() * 1e3);
            assert_within_limits(&poser, &pose);
            for keypoint in Keypoint::all() {
                let Some(placed) = panel.keypoints.place(keypoint) else { continue };
                distances.push(distance(placed, poser.keypoint_px(&pose, keypoint)) / camera.px_per_m / 1.6);
            }
        }
        let (distances, times_ms) = (sorted(distances), sorted(times_ms));
        let [median, p95] = [0.5, 0.95].map(|share| 100.0 * quantile(&distances, share));
        let slowest = quantile(&times_ms, 1.0);
        println!(
            "{gait}: median {median:.2} % of withers height, 95 % {p95:.2} %, worst {:.2} %; {:.2} ms, slowest {slowest:.2} ms",
            100.0 * quantile(&distances, 1.0),
            quantile(&times_ms, 0.5),
        );
        assert!(median < 1.0 && p95 < 3.0, "{gait}: {median} {p95}");
    }
}

#[test]
fn few_points_move_what_they_are_on_and_odd_ones_do_no_harm() {
    let specimen = Specimen::load("walk");
    let (camera, panel) = specimen.panels().next().unwrap();
    let poser = specimen.poser(camera, panel);
    let none = poser.pose_from_points(&Keypoints::default(), CAREFUL, None);
    assert_eq!(none, poser.rest_pose());
    let toes = Keypoint::all().filter(|k| k.name().ends_with("hoof")).map(|k| poser.keypoint_px(&none, k));
    assert!(toes.into_iter().all(|toe| (camera.world_from_plate(toe, -0.12)[1]).abs() < 0.05));

    let mut points = Keypoints::default();
    let mut place = |at_px: [f64; 2]| {
        let placed =
            Placed { at_px: Some(at_px), state: KeypointState::Visible, by: PlacedBy::Hand, sd_px: None };
        points.insert(Keypoint::Body(BodyPoint::Withers), placed);
        points.clone()
    };
    let one = poser.pose_from_points(&place([140.0, 100.0]), CAREFUL, None);
    let reached = poser.keypoint_px(&one, Keypoint::Body(BodyPoint::Withers));
    assert!(distance(reached, [140.0, 100.0]) < 0.5, "{reached:?}");
    for odd in [[f64::NAN, 3.0], [1e300, -1e300], [f64::INFINITY, 0.0]] {
        let pose = poser.pose_from_points(&place(odd), CAREFUL, None);
        assert_within_limits(&poser, &pose);
    }
}

#[test]
fn derivatives_agree_with_central_differences() {
    let specimen = Specimen::load("trot");
    let (poser, pose) = specimen.posed().swap_remove(2);
    let mut random = Random::new(7);
    let x: PanelPose = std::array::from_fn(|i| pose[i] + random.between(-0.1, 0.1));
    let k = poser.chain.kinematics(&pose, &poser.lengths);
    let point = |on: Attachment, sd_m: f64, loss: Loss| {
        let [px, py] = k.place(on);
        PointTerm { on, target_m: [px + 0.05, py - 0.03], sd_m, loss }
    };
    let rows: Vec<_> = poser.reciprocal.iter().chain(&poser.fetlock).cloned().collect();
    let problem = PoseProblem {
        chain: &poser.chain,
        lengths: &poser.lengths,
        bounds: poser.bounds(),
        mean: pose,
        sd: [0.3; PANEL_DOF],
        rows: &rows,
        points: vec![
            point(Attachment::Tip(Limb::LF.hoof_bone()), 0.02, Loss::Cauchy(2.5)),
            point(Attachment::Tip(Limb::RH.hoof_bone()), 0.05, Loss::Square),
            point(Attachment::Tip(7), 0.01, Loss::Huber(2.0)),
            point(Attachment::Dock, 0.04, Loss::Huber(50.0)),
        ],
    };
    let at = problem.linearize(&x, Curvature::Full);
    let step = 1e-6;
    let moved = |i: usize, by: f64| {
        let mut moved = x;
        moved[i] += by;
        moved
    };
    for i in 0..PANEL_DOF {
        let slope = (problem.cost(&moved(i, step)) - problem.cost(&moved(i, -step))) / (2.0 * step);
        assert!(
            (slope - at.gradient[i]).abs() < 1e-5 * (1.0 + slope.abs()),
            "{i}: {slope} {}",
            at.gradient[i]
        );
        let [up, down] =
            [step, -step].map(|by| problem.linearize(&moved(i, by), Curvature::GaussNewton).gradient);
        for j in 0..PANEL_DOF {
            let bend = (up[j] - down[j]) / (2.0 * step);
            let error = (bend - at.normal[i][j]).abs();
            assert!(error < 1e-4 * (1.0 + bend.abs()), "{i} {j}: {bend} {}", at.normal[i][j]);
        }
    }
}
