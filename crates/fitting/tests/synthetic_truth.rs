//! Requirements on the stride fit where the truth is known: how near it comes, and that it always ends at one place.

use muybridge_capture::Keypoint;
use muybridge_core::{BONE_COUNT, Skeleton};
use muybridge_fitting::layout::{BENDS, PANEL_DOF};
use muybridge_fitting::observation::attachment;
use muybridge_fitting::stride_fit::{StrideFit, StrideTime, fit_stride, rms, solve_from_afar};
use muybridge_fitting::synthetic::{Placing, SyntheticStride};
use muybridge_fitting::weights::Weights;

const SEEDS: std::ops::Range<u64> = 0..20;
const PANELS: usize = 24;

fn fit(stride: &SyntheticStride, placing: &Placing) -> StrideFit {
    let weights = Weights::default();
    let observation = stride.observe(placing, &weights);
    let stride_time = StrideTime { seconds: stride.stride_time_s, sd_s: 0.0 };
    fit_stride(&Skeleton::reference(), &observation, stride_time, &weights)
}

/// Distances of fitted from true joints, m: every keypoint of every panel, seen or not.
fn joint_errors_m(stride: &SyntheticStride, fit: &StrideFit, keypoints: &[Keypoint]) -> Vec<f64> {
    let mut errors = Vec::new();
    for (slot, fitted) in fit.kinematics().iter().enumerate() {
        let truth = stride.kinematics(fit.problem.order[slot]);
        for keypoint in keypoints {
            let on = attachment(*keypoint, stride.facing);
            let ([x, y], [true_x, true_y]) = (fitted.place(on), truth.place(on));
            errors.push((x - true_x).hypot(y - true_y));
        }
    }
    errors
}

fn bend_errors_deg(stride: &SyntheticStride, fit: &StrideFit, bone: usize) -> Vec<f64> {
    (0..PANELS)
        .map(|slot| {
            let truth = stride.poses[fit.problem.order[slot]][BENDS + bone];
            (fit.pose(slot)[BENDS + bone] - truth).to_degrees()
        })
        .collect()
}

/// Fitted over true length, minus one, of each bone.
fn length_errors(stride: &SyntheticStride, fit: &StrideFit) -> Vec<f64> {
    let length = |bone: usize| fit.problem.bone_length_m(bone, fit.shared());
    (0..BONE_COUNT).map(|bone| length(bone) / f64::from(stride.horse.bones[bone].length_m) - 1.0).collect()
}

/// Root mean squares over all joints (m), bends (degrees) and bones (share of their length).
fn truth_errors(pairs: &[(SyntheticStride, StrideFit)]) -> [f64; 3] {
    let keypoints: Vec<Keypoint> = Keypoint::all().collect();
    let joints = pairs.iter().flat_map(|(stride, fit)| joint_errors_m(stride, fit, &keypoints));
    let bends = pairs.iter().flat_map(|(stride, fit)| {
        (0..BONE_COUNT).flat_map(|bone| bend_errors_deg(stride, fit, bone)).collect::<Vec<_>>()
    });
    let lengths = pairs.iter().flat_map(|(stride, fit)| length_errors(stride, fit));
    [rms(joints), rms(bends), rms(lengths)]
}

fn fits(placing: Placing) -> Vec<(SyntheticStride, StrideFit)> {
    let strides = SEEDS.map(|seed| SyntheticStride::new(seed, PANELS));
    strides.map(|stride| (stride.clone(), fit(&stride, &placing))).collect()
}

/// Prints what was measured: overall, the worst stride, and each keypoint and bone; returns the overall errors.
fn report(title: &str, pairs: &[(SyntheticStride, StrideFit)]) -> [f64; 3] {
    let [joint_m, bend_deg, length] = truth_errors(pairs);
    let single = pairs.iter().map(|pair| truth_errors(std::slice::from_ref(pair)));
    let worst = single.fold([0.0; 3], |worst: [f64; 3], e| std::array::from_fn(|i| worst[i].max(e[i])));
    println!(
        "{title}: joints {:.2} cm, bends {bend_deg:.2} deg, lengths {:.1} %",
        100.0 * joint_m,
        100.0 * length
    );
    println!("  worst stride: {:.2} cm, {:.2} deg, {:.1} %", 100.0 * worst[0], worst[1], 100.0 * worst[2]);
    for keypoint in Keypoint::all() {
        let errors = pairs.iter().flat_map(|(stride, fit)| joint_errors_m(stride, fit, &[keypoint]));
        println!("  {:<18} {:.2} cm", keypoint.name(), 100.0 * rms(errors));
    }
    for bone in 0..BONE_COUNT {
        let bends = pairs.iter().flat_map(|(stride, fit)| bend_errors_deg(stride, fit, bone));
        let lengths = pairs.iter().map(|(stride, fit)| length_errors(stride, fit)[bone]);
        let name = &pairs[0].0.horse.bones[bone].name;
        println!("  {bone:>2} {name:<12} {:.1} deg, {:.1} %", rms(bends), 100.0 * rms(lengths));
    }
    [joint_m, bend_deg, length]
}

#[test]
fn a_known_stride_is_found_again() {
    for (title, labelled) in [("with contact labels", true), ("without contact labels", false)] {
        let pairs = fits(Placing { labelled, ..Placing::default() });
        assert!(pairs.iter().all(|(_, fit)| fit.optimum.converged));
        let [joint_m, bend_deg, length] = report(title, &pairs);
        assert!(joint_m <= 0.026 && bend_deg <= 5.0 && length <= 0.06);
    }
}

#[test]
fn gross_outliers_hardly_pull() {
    let pairs = fits(Placing { outlier_share: 0.05, ..Placing::default() });
    assert!(pairs.iter().all(|(_, fit)| fit.optimum.converged));
    let [joint_m, _, _] = report("with 5 % of gross outliers", &pairs);
    assert!(joint_m <= 0.030);
}

/// A start with each joint 20 to 60 degrees off the rest pose, to one side or the other.
fn perturbed(start: &[f64], seed: u64) -> Vec<f64> {
    let mut state = seed;
    let mut random = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut start = start.to_vec();
    for slot in 0..PANELS {
        for bend in &mut start[slot * PANEL_DOF + BENDS..][..BONE_COUNT] {
            let sign = if random() < 0.5 { -1.0 } else { 1.0 };
            *bend += sign * (20.0 + 40.0 * random()).to_radians();
        }
    }
    start
}

/// With outliers and without contact labels the Cauchy loss has a second minimum in seeds 3 and 23, up to 1 % higher; the
/// tolerant first steps pass it by.
#[test]
fn every_start_ends_at_one_optimum() {
    let (mut worst, mut most_steps) = (0.0f64, 0);
    for (outlier_share, labelled) in [(0.0, true), (0.0, false), (0.05, true), (0.05, false)] {
        for seed in 0..24 {
            let stride = SyntheticStride::new(seed, PANELS);
            let cold = fit(&stride, &Placing { outlier_share, labelled, ..Placing::default() });
            let start = cold.problem.rest_start(&cold.observation);
            for k in 0..3 {
                let warm = solve_from_afar(&cold.problem, perturbed(&start, 97 * seed + k));
                let apart = (warm.cost / cold.optimum.cost - 1.0).abs();
                assert!(warm.converged);
                worst = worst.max(apart);
                most_steps = most_steps.max(warm.steps);
            }
        }
    }
    println!("costs from all starts agree to {worst:.1e} in at most {most_steps} steps");
    assert!(worst <= 1e-8);
}

#[test]
fn equal_input_gives_equal_bits() {
    let bits = || {
        let found = fit(&SyntheticStride::new(3, PANELS), &Placing::default());
        found.optimum.x.iter().map(|v| v.to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(bits(), bits());
}
