//! A simple motion: the reference horse with its legs swung to and fro.

use std::f64::consts::TAU;

use muybridge_capture::{Facing, NearOff};
use muybridge_core::{BONE_COUNT, Gait, Joints, Limb, Pair, Pose, Skeleton, bone};

use super::{PosedHorse, SpecimenMotion};

/// Speed and duration of a stride: an easy trot.
const SPEED_M_S: f64 = 3.6;
const STRIDE_TIME_S: f64 = 0.7;
/// A toe is down when it is less than this over the lowest one, m.
const DOWN_M: f64 = 0.03;

/// A stride's phase of each leg, in the order of [`Limb::ALL`]: diagonal pairs together.
const PHASES: [f64; 4] = [0.0, 0.5, 0.5, 0.0];

/// A trot-like motion of the reference horse over one stride, without the exactness of a real gait: hooves slide a little.
/// For pictures whose gait does not matter.
pub fn swung_legs(panels: usize, facing: Facing) -> SpecimenMotion {
    let horse = Skeleton::reference();
    let poses = (0..panels).map(|k| posed(&horse, k as f64 / panels as f64, facing)).collect();
    SpecimenMotion {
        gait: Gait::Trot,
        facing,
        withers_height_m: f64::from(horse.withers_height_m),
        speed_m_s: SPEED_M_S,
        closes_after_panels: Some(panels as f64),
        poses,
        hurdle: None,
    }
}

/// The horse at a phase of its stride, 0 to 1.
fn posed(horse: &Skeleton, phase: f64, facing: Facing) -> PosedHorse {
    let mut pose = Pose::standing(horse);
    let time_s = phase * STRIDE_TIME_S;
    pose.root_in_world.x = (SPEED_M_S * time_s) as f32;
    for limb in Limb::ALL {
        swing(&mut pose, limb, phase + PHASES[limb.index()]);
    }
    pose.bends_rad[bone::NECK] += 0.04 * (2.0 * TAU * phase).sin() as f32;
    let lowest =
        Limb::ALL.map(|limb| pose.joints(horse).toe(limb).y).into_iter().fold(f32::INFINITY, f32::min);
    pose.root_in_world.y -= lowest;
    seen(&pose.joints(horse), time_s, facing, horse)
}

/// Turns a leg's bones as a harmonic of its phase: forward in swing with knee and hock bent.
fn swing(pose: &mut Pose, limb: Limb, phase: f64) {
    let forward = (TAU * phase).cos() as f32;
    // Bent while the leg comes forward.
    let bent = (-(TAU * phase).sin()).max(0.0) as f32;
    let turns: [f32; 5] = match limb.pair() {
        Pair::Fore => {
            [0.1 * forward, 0.35 * forward + 0.25 * bent, 0.1 * bent, -1.3 * bent, 0.3 - 0.9 * bent]
        }
        Pair::Hind => [0.0, 0.35 * forward + 0.35 * bent, -0.75 * bent, 0.75 * bent, 0.2 - 0.9 * bent],
    };
    for (i, turn) in turns.into_iter().enumerate() {
        pose.bends_rad[limb.first_bone() + i] += turn;
    }
}

/// The joints as the cameras see them: z towards the camera, the near hooves' plane at zero.
fn seen(joints: &Joints, time_s: f64, facing: Facing, horse: &Skeleton) -> PosedHorse {
    let near = facing.limb(NearOff::Near, Pair::Fore);
    let towards_camera = if near == Limb::RF { 1.0 } else { -1.0 };
    let hoof_plane = f64::from(horse.bones[near.hoof_bone()].lateral_m).abs();
    let point =
        |[x, y, z]: [f32; 3]| [f64::from(x), f64::from(y), towards_camera * f64::from(z) - hoof_plane];
    let lowest = Limb::ALL.map(|limb| joints.toe(limb).y).into_iter().fold(f32::INFINITY, f32::min);
    PosedHorse {
        time_s,
        bones: std::array::from_fn::<_, BONE_COUNT, _>(|i| {
            [point(joints.bases[i].to_array()), point(joints.tips[i].to_array())]
        }),
        croup: point(joints.root.to_array()),
        dock: point(joints.dock.to_array()),
        down: Limb::ALL.map(|limb| f64::from(joints.toe(limb).y - lowest) < DOWN_M),
    }
}
