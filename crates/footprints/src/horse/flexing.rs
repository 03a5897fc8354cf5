//! A leg that has to be shorter than the gait has it, flexed before its joints are solved.

use glam::Vec2;
use muybridge_core::{Limb, Pair, Pose, ToeAim};

use super::model::HorseModel;

/// How a foreleg draws itself up, rad of humerus, radius, metacarpal and hoof for each rad: mostly at the elbow; the carpus as far as it
/// bears no load.
const FORE: [f32; 4] = [-0.35, 0.8, -0.6, 0.2];
/// Place of the carpus among them.
const CARPUS: usize = 2;
/// The same of a hind leg: femur, tibia, metatarsal and hoof; stifle and hock flex together.
const HIND: [f32; 4] = [0.45, -0.8, 0.7, -0.1];
/// It does so by no more than this, rad.
const MOST_RAD: f32 = 1.5;
/// Halvings of the search for how much.
const HALVINGS: usize = 16;

/// The four bones of a leg below its scapula.
struct Leg {
    first: usize,
    lengths_m: [f32; 4],
    limits_rad: [[f32; 2]; 4],
    bends_rad: [f32; 4],
    flexing: [f32; 4],
}

impl Leg {
    fn flexed_rad(&self, by_rad: f32) -> [f32; 4] {
        std::array::from_fn(|i| {
            let [low, high] = self.limits_rad[i];
            (self.bends_rad[i] + by_rad * self.flexing[i]).clamp(low, high)
        })
    }

    /// From shoulder to toe in the leg's plane, metres.
    fn length_m(&self, by_rad: f32) -> f32 {
        let (mut angle_rad, mut toe) = (0.0, Vec2::ZERO);
        for (bend_rad, length_m) in self.flexed_rad(by_rad).into_iter().zip(self.lengths_m) {
            angle_rad += bend_rad;
            toe += length_m * Vec2::from_angle(angle_rad);
        }
        toe.length()
    }
}

/// Flexes a leg until it is as long as it has to be, if it is longer. A leg that is nearly straight does not say by itself which of its
/// joints is to give, and what the solver finds may change from one moment to the next.
pub(super) fn flex(model: &HorseModel, pose: &mut Pose, limb: Limb, aim: &ToeAim) {
    let bones = &model.skeleton().bones;
    let first = limb.first_bone() + 1;
    let mut flexing = if limb.pair() == Pair::Fore { FORE } else { HIND };
    if limb.pair() == Pair::Fore {
        flexing[CARPUS] *= 1.0 - aim.load;
    }
    let leg = Leg {
        first,
        lengths_m: std::array::from_fn(|i| bones[first + i].length_m),
        limits_rad: std::array::from_fn(|i| bones[first + i].limits_rad),
        bends_rad: std::array::from_fn(|i| pose.bends_rad[first + i]),
        flexing,
    };
    let joint = model.reach().joints_in_root(pose)[limb.index()];
    let joint = pose.root_in_world.as_dvec3() + (pose.world_from_root * joint).as_dvec3();
    let lateral_m = bones[limb.hoof_bone()].lateral_m - bones[limb.first_bone()].lateral_m;
    let away_m = aim.toe_in_world.distance(joint) as f32;
    let wanted_m = (away_m * away_m - lateral_m * lateral_m).max(0.0).sqrt();
    if !wanted_m.is_finite() || leg.length_m(0.0) <= wanted_m {
        return;
    }
    let (mut longer_rad, mut shorter_rad) = (0.0, MOST_RAD);
    for _ in 0..HALVINGS {
        let middle_rad = 0.5 * (longer_rad + shorter_rad);
        if leg.length_m(middle_rad) > wanted_m {
            longer_rad = middle_rad;
        } else {
            shorter_rad = middle_rad;
        }
    }
    pose.bends_rad[leg.first..leg.first + 4].copy_from_slice(&leg.flexed_rad(longer_rad));
}
