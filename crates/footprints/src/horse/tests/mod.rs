//! Horses over laid, moved and retimed prints: feet, trunk and joints measured.

mod laying;
mod measured;
mod scene;

use muybridge_core::{Gait, Limb};

use crate::path::PathPoint;
use crate::terrain::Terrain;
use measured::{Measured, gait_range};
use scene::{GAITS, Scene, database_curve, model, random_track, solved_curve};

/// Paths of each gait.
const PATHS: u64 = 10;

#[test]
fn every_gait_keeps_its_prints_its_order_and_its_trunk_on_ten_random_paths() {
    let model = model();
    for gait in GAITS {
        let range = gait_range(&model, gait);
        let mut worst = Measured::default();
        for seed in 0..PATHS {
            let scene = Scene::new(&model, random_track(&model, gait, seed));
            assert_eq!(scene.order(), scene.gait_order(), "{gait} on path {seed}");
            let motion = scene.motion(solved_curve(&scene));
            assert_eq!(motion.misses().count(), 0, "{gait} on path {seed}");
            worst = worst.and(&Measured::new(&scene, &motion));
        }
        println!("{gait}: {worst:?}\n  database: {range:?}");
        worst.assert_good(gait, &range);
    }
}

#[test]
fn a_horse_on_straight_level_ground_moves_as_the_database_has_it() {
    let model = model();
    for gait in GAITS {
        let scene = Scene::new(&model, scene::straight_track(&model, gait));
        let motion = scene.motion(database_curve(&scene.plan));
        let own = scene.plan.gait().own();
        let stride_s = f64::from(own.stride_time_s());
        for k in 0..60 {
            let phase = f64::from(k) / 60.0;
            let pose = motion.pose((1.0 + phase) * stride_s);
            let expected = own.pose(phase as f32, [phase as f32; 4]);
            let off_m = (pose.root_in_world.y - expected.root_in_world.y).abs();
            assert!(off_m < 0.012, "{gait} at {phase}: the croup is {off_m} m off");
            for limb in Limb::ALL {
                let bones = limb.first_bone()..=limb.hoof_bone();
                let off_rad = bones
                    .map(|bone| (pose.bends_rad[bone] - expected.bends_rad[bone]).abs())
                    .fold(0.0, f32::max);
                assert!(off_rad < 0.12, "{gait} {limb:?} at {phase}: {off_rad} rad off");
            }
        }
    }
}

#[test]
fn moved_and_retimed_prints_are_still_hit() {
    let model = model();
    for (seed, gait) in GAITS.into_iter().enumerate() {
        let mut track = random_track(&model, gait, seed as u64);
        let count = track.prints.len();
        for (i, [x_m, z_m]) in
            [(count / 3, [0.15, 0.1]), (count / 2, [-0.12, -0.15]), (count / 2 + 1, [0.1, 0.0])]
        {
            track.prints[i].at_m[0] += x_m;
            track.prints[i].at_m[1] += z_m;
            track.prints[i].heading_deg += 10.0;
            if let Some(timing) = &mut track.prints[i].timing {
                timing.stance_time_s *= 0.9;
                timing.step_time_s *= 1.25;
            }
        }
        let scene = Scene::new(&model, track);
        let motion = scene.motion(solved_curve(&scene));
        let measured = Measured::new(&scene, &motion);
        println!("{gait} moved: {measured:?}");
        assert!(measured.miss_m < 1e-3, "{gait}: {measured:?}");
        assert_eq!(motion.misses().count(), 0, "{gait}");
    }
}

#[test]
fn prints_out_of_reach_are_told_with_their_miss_and_harm_nothing() {
    let model = model();
    let mut track = random_track(&model, Gait::Trot, 3);
    track.prints[9].at_m[0] += 40.0;
    let scene = Scene::new(&model, track);
    let motion = scene.motion(database_curve(&scene.plan));
    let missed: Vec<(usize, f64)> = motion.misses().collect();
    assert!(missed.iter().any(|(print, miss_m)| *print == 9 && *miss_m > 1.0), "{missed:?}");
    for i in 0..=100 {
        let pose = motion.pose(scene.placed.end_s * f64::from(i) / 100.0);
        let joints = pose.joints(model.skeleton());
        assert!(joints.tips.iter().all(|tip| tip.is_finite()));
    }
}

#[test]
fn any_prints_that_have_times_give_finite_poses() {
    let model = model();
    let laid = random_track(&model, Gait::Canter, 2);
    let with = |keep: fn(usize) -> bool| {
        let mut track = laid.clone();
        let prints = track.prints.iter().enumerate().filter(|(i, _)| keep(*i));
        track.prints = prints.map(|(_, print)| *print).collect();
        track
    };
    let mut far = with(|_| true);
    far.prints.iter_mut().enumerate().for_each(|(i, print)| print.at_m[1] += 50.0 * (i % 3) as f64);
    let mut standing = with(|i| i < 4);
    for (i, print) in standing.prints.iter_mut().enumerate() {
        print.foot = crate::track::Foot::QUADRUPED[i];
        let step_time_s = if i < 3 { 0.0 } else { 4.0 };
        print.timing = Some(crate::timing::StepTiming { stance_time_s: 4.0, step_time_s });
    }
    for track in [with(|i| i == 0), with(|i| i < 2), with(|i| i % 4 != 1), far, standing] {
        let scene = Scene::new(&model, track);
        let motion = scene.motion(solved_curve(&scene));
        for i in -5..=105 {
            let pose = motion.pose(scene.placed.end_s * f64::from(i) / 100.0);
            let joints = pose.joints(model.skeleton());
            assert!(joints.tips.iter().all(|tip| tip.is_finite()));
        }
        assert!(motion.pose(f64::NAN).root_in_world.is_finite());
    }
}

#[test]
fn a_horse_climbs_stairs() {
    let model = model();
    let gait = scene::track_gait(&model, Gait::Walk, 0.3, muybridge_core::Side::Left);
    let terrain =
        Terrain::Stairs { tread_m: 0.8, rise_m: 0.12, steps: 8, towards_deg: 0.0, from_m: [3.0, 0.0] };
    let point = |x_m: f64| PathPoint { at_m: [x_m, 0.0], tangent_m: None };
    let scene = Scene::new(&model, scene::laid(&model, gait, vec![point(0.0), point(12.0)], terrain));
    let motion = scene.motion(solved_curve(&scene));
    let measured = Measured::new(&scene, &motion);
    println!("stairs: {measured:?}");
    assert!(measured.miss_m < 1e-3 && measured.slide_m < 1e-3, "{measured:?}");
    for i in 0..=(120.0 * scene.placed.end_s) as usize {
        let joints = motion.pose(i as f64 / 120.0).joints(model.skeleton());
        for limb in Limb::ALL {
            let toe = joints.toe(limb).as_dvec3();
            let (ground_m, _) = scene.track.terrain.at(toe.x, toe.z);
            assert!(toe.y > ground_m - 0.05, "{limb:?} is {} m in the stairs", ground_m - toe.y);
        }
    }
}
