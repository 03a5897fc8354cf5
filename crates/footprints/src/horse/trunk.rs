//! The trunk before the centre of mass is known: where it faces, how it is pitched by gait and ground, leaned and bent into a turn.

use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};
use muybridge_core::{BODY_BONE_COUNT, Ground, OwnGait, bone};

use super::gait::HorseGait;
use super::leg::{Doing, LegCourse, LegNow};
use super::series::{between, moving_mean, slope, smooth};
use crate::orientation::Orientation;

/// Step of the tables, s, unless that makes more than so many.
const STEP_S: f64 = 1.0 / 60.0;
const MOST_STEPS: f64 = 120_000.0;
/// Greatest slope the trunk takes, rise over run: 35 degrees.
const MOST_SLOPE: f64 = 0.7;
/// Least distance of fore and hind feet that a slope is measured over, as a share of the gait's.
const LEAST_WHEELBASE: f64 = 0.5;
/// The ground under the root is the mean over so many places of a stretch along the trunk, half of it so long, metres.
const PLACES: usize = 5;
const HALF_STRETCH_M: f64 = 0.5;
/// Heights beyond this are no ground, metres.
const MOST_HEIGHT_M: f64 = 1e5;
/// Acceleration of free fall, m/s².
const GRAVITY_M_S2: f64 = 9.81;
/// Share of the lean that would balance a turn: the feet beside the track do the rest (as the core's ride has it).
const LEAN_SHARE: f64 = 0.8;
/// Greatest lean, rad.
const MOST_LEAN_RAD: f64 = 0.35;
/// Bend of head and neck for a turn rate, rad per rad/s, and greatest bends of head, neck and spine, rad (as the core's ride has them).
const BEND_PER_RATE: [f64; 2] = [0.12, 0.4];
const MOST_BENT_RAD: [f64; 3] = [0.2, 0.55, 0.22];
/// Slower than this, m/s, the spine does not bend more for the same turn.
const SLOW_M_S: f64 = 1.0;
/// Bones of the neck.
const NECK_BONES: f64 = (bone::HEAD - bone::NECK) as f64;
/// Bones of the spine.
const SPINE_BONES: f64 = bone::NECK as f64;

/// The trunk through the whole motion.
#[derive(Clone, Debug)]
pub(super) struct Trunk {
    /// Heading, lean and pitch of the root's frame.
    pub(super) orientation: Orientation,
    /// The place on the ground that the gait has under the root, world space, metres; without the steps that only hooves feel.
    under_root: Vec<DVec3>,
    /// Angle at which the ground rises under the horse, rad.
    rises_rad: Vec<f64>,
    /// Turn rate, rad/s, to the left positive.
    turning_rad_s: Vec<f64>,
    /// Bend of the whole spine, rad, to the left positive.
    spine_rad: Vec<f64>,
}

/// The feet at a moment: middles of the fore and of the hind ones, and their mean heading.
#[derive(Clone, Copy, Debug, Default)]
struct Feet {
    fore: DVec3,
    hind: DVec3,
    heading_rad: f64,
}

/// Phase of the body: the circular mean of the legs' phases.
pub(super) fn body_phase(legs: &[Option<LegNow<'_>>; 4]) -> f64 {
    let sum: DVec2 = legs.iter().flatten().map(|leg| DVec2::from_angle(TAU * leg.phase)).sum();
    sum.y.atan2(sum.x) / TAU
}

/// Where a foot is over the ground, and where it faces.
fn foot(leg: &LegNow<'_>) -> (DVec3, f64) {
    match leg.doing {
        Doing::Stands(stand) => (stand.toe, stand.heading_rad),
        Doing::Swings([from, to], _, share) => {
            let late = smooth(share);
            let heading_rad = from.heading_rad + late * (to.heading_rad - from.heading_rad);
            (from.toe.lerp(to.toe, late), heading_rad)
        }
    }
}

impl Feet {
    fn new(legs: &[Option<LegNow<'_>>; 4]) -> Self {
        let (mut middles, mut heading_rad) = ([(DVec3::ZERO, 0.0); 2], 0.0);
        for (limb, leg) in legs.iter().enumerate() {
            let Some((at, heading)) = leg.as_ref().map(foot) else { continue };
            middles[limb / 2].0 += at;
            middles[limb / 2].1 += 1.0;
            heading_rad += heading;
        }
        let [fore, hind] = middles.map(|(sum, count)| sum / f64::max(count, 1.0));
        let [fores, hinds] = middles.map(|(_, count)| count);
        // A horse without fore or hind prints has its feet in one place.
        let (fore, hind) = (if fores > 0.0 { fore } else { hind }, if hinds > 0.0 { hind } else { fore });
        Self { fore, hind, heading_rad: heading_rad / f64::max(fores + hinds, 1.0) }
    }
}

impl Trunk {
    /// The trunk between two times, s.
    pub(super) fn new(
        gait: &HorseGait,
        courses: &[LegCourse; 4],
        [from_s, to_s]: [f64; 2],
        ground: &impl Ground,
    ) -> Self {
        let step_s = STEP_S.max((to_s - from_s) / MOST_STEPS);
        let times = || (0..=((to_s - from_s) / step_s).ceil() as usize).map(|i| from_s + i as f64 * step_s);
        let legs = |time_s: f64| courses.each_ref().map(|course| course.at(time_s));
        let feet: Vec<Feet> = times().map(|time_s| Feet::new(&legs(time_s))).collect();
        let half = (0.5 * gait.stride_time_s / step_s).round() as usize;
        let mean = |of: fn(&Feet) -> DVec3| moving_mean(&feet.iter().map(of).collect::<Vec<_>>(), half);
        let [fore, hind] = [mean(|feet| feet.fore), mean(|feet| feet.hind)];
        let headings: Vec<f64> = feet.iter().map(|feet| feet.heading_rad).collect();
        let headings = moving_mean(&headings, half);
        let turning_rad_s = moving_mean(&slope(&headings, step_s), half);
        let middles: Vec<DVec3> = fore.iter().zip(&hind).map(|(fore, hind)| (*fore + *hind) * 0.5).collect();
        let speeds: Vec<f64> =
            slope(&middles, step_s).iter().map(|velocity| velocity.x.hypot(velocity.z)).collect();
        let speeds_m_s = moving_mean(&speeds, half);
        let own = gait.own();
        let (mut rises_rad, mut world_from_body, mut spine_rad) = (Vec::new(), Vec::new(), Vec::new());
        let mut under_root = Vec::new();
        for (i, time_s) in times().enumerate() {
            let heading_rad = headings[i];
            let rise_rad = rise_rad(gait, hind[i], fore[i], heading_rad);
            let lean_rad = lean_rad(turning_rad_s[i] * speeds_m_s[i]);
            let pitch_rad = rise_rad + pitch_rad(&own, body_phase(&legs(time_s)));
            rises_rad.push(rise_rad);
            under_root.push(self::under_root(gait, middles[i], heading_rad, ground));
            spine_rad.push(turning_rad_s[i] * gait.wheelbase_m() / speeds_m_s[i].max(SLOW_M_S));
            world_from_body.push(
                DQuat::from_rotation_y(heading_rad)
                    * DQuat::from_rotation_x(-lean_rad)
                    * DQuat::from_rotation_z(pitch_rad),
            );
        }
        Self {
            orientation: Orientation { from_s, step_s, world_from_body },
            under_root,
            rises_rad,
            turning_rad_s,
            spine_rad,
        }
    }

    fn between(&self, values: &[f64], time_s: f64) -> f64 {
        between(values, self.orientation.step_s, time_s - self.orientation.from_s)
    }

    /// The place on the ground that the gait has under the root, world space, metres.
    pub(super) fn under_root(&self, time_s: f64) -> DVec3 {
        between(&self.under_root, self.orientation.step_s, time_s - self.orientation.from_s)
    }

    /// Angle at which the ground rises under the horse, rad.
    pub(super) fn rise_rad(&self, time_s: f64) -> f64 {
        self.between(&self.rises_rad, time_s)
    }

    /// Turns of spine, neck and head into the turn, rad.
    pub(super) fn lateral_bends_rad(&self, time_s: f64) -> [f32; BODY_BONE_COUNT] {
        let turning_rad_s = self.between(&self.turning_rad_s, time_s);
        let spine_rad = self.between(&self.spine_rad, time_s);
        let bends = [BEND_PER_RATE[0] * turning_rad_s, BEND_PER_RATE[1] * turning_rad_s, spine_rad];
        let bend = |i: usize| bends[i].clamp(-MOST_BENT_RAD[i], MOST_BENT_RAD[i]);
        let mut lateral = [0.0; BODY_BONE_COUNT];
        lateral[bone::SPINE..bone::NECK].fill((bend(2) / SPINE_BONES) as f32);
        lateral[bone::NECK..bone::HEAD].fill((bend(1) / NECK_BONES) as f32);
        lateral[bone::HEAD] = bend(0) as f32;
        lateral
    }
}

/// Angle at which the ground rises from the hind feet to the fore feet along a heading, rad.
fn rise_rad(gait: &HorseGait, hind: DVec3, fore: DVec3, heading_rad: f64) -> f64 {
    let (sin, cos) = heading_rad.sin_cos();
    let way = fore - hind;
    let ahead_m = (way.x * cos - way.z * sin).max(LEAST_WHEELBASE * gait.wheelbase_m());
    let slope = way.y / ahead_m;
    if slope.is_finite() { slope.clamp(-MOST_SLOPE, MOST_SLOPE).atan() } else { 0.0 }
}

/// The place under the root, behind the middle of the feet as in the gait, at the mean height of the ground about it; at the height of
/// the feet where there is none.
fn under_root(gait: &HorseGait, feet: DVec3, heading_rad: f64, ground: &impl Ground) -> DVec3 {
    let (sin, cos) = heading_rad.sin_cos();
    let ahead_m = gait.legs.iter().map(|leg| leg.print_m).sum::<f64>() / gait.legs.len() as f64;
    let at = |along_m: f64| (feet.x + along_m * cos, feet.z - along_m * sin);
    let height_m = |k: usize| {
        let (x_m, z_m) = at(HALF_STRETCH_M * (2.0 * k as f64 / (PLACES - 1) as f64 - 1.0) - ahead_m);
        let height_m = f64::from(ground.surface(x_m as f32, z_m as f32).height_m);
        if height_m.abs() < MOST_HEIGHT_M { height_m } else { feet.y }
    };
    let (x_m, z_m) = at(-ahead_m);
    DVec3::new(x_m, (0..PLACES).map(height_m).sum::<f64>() / PLACES as f64, z_m)
}

/// Lean into a turn with a lateral acceleration, m/s², to the left positive, rad.
fn lean_rad(lateral_m_s2: f64) -> f64 {
    (LEAN_SHARE * (lateral_m_s2 / GRAVITY_M_S2).atan()).clamp(-MOST_LEAN_RAD, MOST_LEAN_RAD)
}

/// Pitch of the root in the gait, rad.
fn pitch_rad(own: &OwnGait<'_>, phase: f64) -> f64 {
    let turn = own.pose(phase as f32, [phase as f32; 4]).world_from_root;
    2.0 * f64::from(turn.z).atan2(f64::from(turn.w))
}
