//! The solution as a file: the curve's knots, and the motion with all joints.

use glam::{DVec3, Vec3};
use muybridge_core::{BONE_COUNT, Skeleton};
use muybridge_footprints::{Character, Figure, Support};
use serde::Serialize;

use super::summary::rounded;
use super::walk::Walk;

/// Schema version of a solution file.
const SOLUTION_SCHEMA: u32 = 1;
/// Most moments in one file.
pub(super) const MOST_FRAMES: f64 = 50_000.0;
/// Joints of a leg by how many there are from hip to ankle.
const LEG_JOINTS: [&str; 4] = ["hip", "knee", "hock", "ankle"];

type Place = [f64; 3];

/// A solution file. Places are metres, X forward, Y up, Z to the right; times seconds.
#[derive(Debug, Serialize)]
pub(super) struct Solution {
    schema: u32,
    name: String,
    model: String,
    method: &'static str,
    energy_m_s: EnergyParts,
    duration_s: f64,
    prints: Vec<PrintRecord>,
    knots: Vec<KnotRecord>,
    frames_per_s: f64,
    /// What the places of a frame's `joints_m` are.
    joints: Vec<String>,
    frames: Vec<Frame>,
}

#[derive(Debug, Serialize)]
struct EnergyParts {
    physics: f64,
    comfort: f64,
}

#[derive(Debug, Serialize)]
struct PrintRecord {
    foot: &'static str,
    at_m: Place,
    strike_s: f64,
    lift_off_s: f64,
}

#[derive(Debug, Serialize)]
struct KnotRecord {
    time_s: f64,
    at_m: Place,
    velocity_m_s: Place,
}

#[derive(Debug, Serialize)]
struct Frame {
    time_s: f64,
    centre_of_mass_m: Place,
    down: Vec<&'static str>,
    joints_m: Vec<Place>,
}

fn place(at: DVec3) -> Place {
    at.to_array().map(rounded)
}

/// The solution of a walk with so many frames a second, the last one at its end.
pub(super) fn solution(walk: &Walk, method: &'static str, frames_per_s: f64) -> Solution {
    let motion = &walk.motion;
    let trajectory = &motion.solved.trajectory;
    let knots = trajectory.times_s.iter().zip(&trajectory.knots);
    let supports = motion.placed.supports();
    let last = (motion.duration_s() * frames_per_s - 1e-6).ceil().max(0.0) as u32;
    let frame = |i: u32| {
        let time_s = (f64::from(i) / frames_per_s).min(motion.duration_s());
        let down = Support::at(&supports, time_s).map_or(&[][..], |support| &support.down);
        Frame {
            time_s: rounded(time_s),
            centre_of_mass_m: place(motion.centre_of_mass(time_s).at),
            down: down.iter().map(|foot| foot.abbreviation()).collect(),
            joints_m: joints(walk, time_s).into_iter().map(place).collect(),
        }
    };
    Solution {
        schema: SOLUTION_SCHEMA,
        name: walk.title(),
        model: motion.track.model.clone(),
        method,
        energy_m_s: EnergyParts {
            physics: rounded(motion.solved.energy.physics),
            comfort: rounded(motion.solved.energy.comfort),
        },
        duration_s: rounded(motion.duration_s()),
        prints: motion
            .placed
            .prints
            .iter()
            .map(|print| PrintRecord {
                foot: print.foot.abbreviation(),
                at_m: place(print.middle),
                strike_s: rounded(print.strike_s),
                lift_off_s: rounded(print.lift_off_s),
            })
            .collect(),
        knots: knots
            .map(|(&time_s, knot)| KnotRecord {
                time_s: rounded(time_s),
                at_m: place(knot.at),
                velocity_m_s: place(knot.velocity),
            })
            .collect(),
        frames_per_s,
        joints: joint_names(walk),
        frames: (0..=last).map(frame).collect(),
    }
}

fn joint_names(walk: &Walk) -> Vec<String> {
    match (&walk.character, walk.skeleton()) {
        (Character::Biped(model), _) => {
            let segments = model.leg.segments_m.len();
            // With two segments there is no hock.
            let leg = LEG_JOINTS.iter().filter(|name| segments > 2 || **name != "hock");
            let leg: Vec<&str> = leg.copied().chain(["heel", "toe"]).collect();
            ["left", "right"]
                .iter()
                .flat_map(|side| leg.iter().map(move |name| format!("{side}_{name}")))
                .collect()
        }
        (Character::Horse(_), Some(skeleton)) => {
            let bones = (0..BONE_COUNT).map(|i| {
                let name = &skeleton.bones[i].name;
                let of_limb = Skeleton::limb_of(i).map(|limb| format!("{}_{name}", limb.abbreviation()));
                format!("{}_tip", of_limb.unwrap_or_else(|| name.clone()))
            });
            std::iter::once("root".to_string()).chain(bones).collect()
        }
        (Character::Horse(_), None) => Vec::new(),
    }
}

fn joints(walk: &Walk, time_s: f64) -> Vec<DVec3> {
    match (walk.motion.figure(time_s), walk.skeleton()) {
        (Figure::Biped(pose), _) => {
            let legs = pose.legs.into_iter();
            legs.flat_map(|leg| leg.joints.into_iter().chain([leg.heel, leg.toe])).collect()
        }
        (Figure::Horse(pose), Some(skeleton)) => {
            let joints = pose.joints(skeleton);
            std::iter::once(joints.root).chain(joints.tips).map(Vec3::as_dvec3).collect()
        }
        (Figure::Horse(_), None) => Vec::new(),
    }
}
