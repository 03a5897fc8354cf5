//! The body over its feet: spec 6.3. The standing feet draw the body, a leg that cannot reach lowers it, and every leg is solved so
//! that a standing hoof is exactly where it struck.

use glam::{DVec2, DVec3, Quat, Vec3};

use super::clip::{BodyRow, LegRow, body, leg};
use super::feet::{Going, LegNow, Wanted};
use super::ground::Ground;
use super::horse::Horse;
use super::mixture::Mixture;
use super::retarget::{leg_bends, smooth};
use super::rig::{Aim, Girdle, Reached};
use super::stillness;
use super::track::{ahead, lagged};
use crate::limb::{Limb, Pair};
use crate::pose::Pose;
use crate::skeleton::bone;

/// Time in which the body follows its standing feet, s.
const DRAWN_S: f32 = 0.06;
/// Weight of the track itself among the standing feet.
const TRACK_WEIGHT: f32 = 0.25;
/// The body is drawn no farther than this, metres of a reference horse.
const MOST_DRAWN_M: f32 = 0.15;
/// The body is lowered no farther than this, metres of a reference horse.
const MOST_LOWERED_M: f32 = 0.35;
/// Time in which a lowered body rises again, s.
const RISING_S: f32 = 0.1;
/// Below this a standing hoof counts as in its place, metres.
const THERE_M: f32 = 2e-5;
/// Rounds of lowering the body for a leg whose joints, not whose length, stop it.
const LOWERING_ROUNDS: usize = 6;
/// How much more than what is lacking the body is lowered then.
const LOWERING: f32 = 1.3;
/// Softness with which a leg's limit of reach is met, metres.
const SOFT_M: f32 = 0.004;
/// A foot that is still farther than this from its place has to leave the ground, metres.
const LOST_M: f32 = 5e-5;

impl Horse {
    /// Finds the pose for the moment the clock shows.
    pub(super) fn pose_now(&mut self, ground: &impl Ground, dt_s: f32) {
        let repertoire = self.repertoire.clone();
        let (state, rig) = (self.state, &repertoire.rig);
        let step_share = state.terrain.step_share(rig.trunk_m);
        let mixture = Mixture::new(&repertoire, &state.warp.weights, state.speeds_m_s(), step_share);
        let cycles = state.warp.cycles();
        let rows: [LegRow; 4] = std::array::from_fn(|limb| mixture.leg(limb, cycles[limb]));
        let body_row = mixture.body(&cycles, state.warp.is_steady());
        let standing = smooth(state.stillness);
        let timing = mixture.timing;
        let legs = self.legs_now(&rows, &timing.prints_m, standing);
        let length_m = timing.speed_m_s / timing.rate_hz;
        let flies_m = |strides: f32| {
            timing.speed_m_s * state.leaping.time_s(&repertoire, &state.warp, strides, timing.rate_hz)
        };
        let halts = state.is_halting;
        let going = Going {
            track: &state.track,
            timing: &timing,
            distance_m: &|strides| {
                if state.leaping.is_under_way() {
                    return flies_m(strides);
                }
                length_m * stillness::stride_lengths(state.stillness, halts, strides)
            },
            standing: &|strides| smooth(stillness::after(state.stillness, halts, strides)),
            turn_rad: state.track.turn_rate_rad_s / timing.rate_hz,
            level: 1.0 / state.terrain.slope(rig.trunk_m).hypot(1.0),
            size: repertoire.size,
        };
        let feet = self.advance_feet(&legs, state.feet, &going, ground);
        self.state.feet = feet;
        let wanted: [Wanted; 4] =
            std::array::from_fn(|limb| feet[limb].wanted(&legs[limb], &going, ground, standing));
        self.draw_body(&legs, &wanted, &going, standing, dt_s);
        let mut body_row = body_row;
        body_row[body::HEIGHT] += state.leaping.added_m(&repertoire, &state.warp, timing.rate_hz);
        let mut pose = self.trunk(&body_row, &rows, standing);
        let girdles = rig.girdles(&pose);
        self.stand(&mut pose, &girdles, &wanted, dt_s);
        self.state.pose = pose;
    }

    /// Where the standing feet draw the body: the mean of what they are off the stride's own places (Huang 2012, Eq. 3.21).
    fn draw_body(
        &mut self,
        legs: &[LegNow; 4],
        wanted: &[Wanted; 4],
        going: &Going<'_>,
        standing: f32,
        dt_s: f32,
    ) {
        let (mut off_m, mut weights) = (DVec2::ZERO, TRACK_WEIGHT);
        for leg in legs {
            if !self.state.feet[leg.limb].is_planted {
                continue;
            }
            let through = (leg.cycle / going.timing.duties[leg.limb]).min(1.0);
            let weight = 4.0 * through * (1.0 - through) + standing;
            let toe = wanted[leg.limb].toe;
            off_m += (DVec2::new(toe.x, toe.z) - going.own_place(leg)) * f64::from(weight);
            weights += weight;
        }
        let off_m = off_m / f64::from(weights);
        let forward = ahead(self.state.track.heading_rad);
        let seen = [off_m.dot(forward), off_m.dot(DVec2::new(-forward.y, forward.x))];
        let most = MOST_DRAWN_M * self.repertoire.size;
        for (drawn, off) in self.state.drawn_m.iter_mut().zip(seen) {
            *drawn += ((off as f32).clamp(-most, most) - *drawn) * lagged(dt_s, DRAWN_S);
        }
    }

    /// Root, spine, neck, head and the girdles' own bones; legs as the stride has them.
    fn trunk(&self, row: &BodyRow, rows: &[LegRow; 4], standing: f32) -> Pose {
        let (state, repertoire) = (&self.state, &*self.repertoire);
        let still = &repertoire.standing;
        let mix = |going: f32, still: f32| going + standing * (still - going);
        let mut pose = Pose::default();
        for i in 0..bone::LIMBS {
            pose.bends_rad[i] = mix(row[i], still.bends_rad[i]);
        }
        for limb in Limb::ALL {
            let first = limb.first_bone();
            for i in 0..5 {
                pose.bends_rad[first + i] = mix(rows[limb.index()][i], still.bends_rad[first + i]);
            }
            if limb.pair() == Pair::Fore {
                pose.scapula_slides_m[limb.index()] = mix(rows[limb.index()][leg::SLIDE], 0.0);
            }
        }
        // A curve between its samples may swing past a limit that the samples keep.
        for (bend, [low, high]) in pose.bends_rad.iter_mut().zip(repertoire.rig.limits_rad) {
            *bend = bend.clamp(low, high);
        }
        let [head, neck, spine] = state.track.bends_rad;
        pose.lateral_bends_rad[..bone::NECK].fill(spine / 4.0);
        pose.lateral_bends_rad[bone::NECK..bone::HEAD].fill(neck / 3.0);
        pose.lateral_bends_rad[bone::HEAD] = head;
        let lifts = state.terrain.lifts_m;
        let pitch = mix(row[body::PITCH], 0.0) + state.terrain.slope(repertoire.rig.trunk_m).atan();
        let heading = state.track.heading_rad;
        let height_m = mix(row[body::HEIGHT], still.root_in_world.y);
        let (sin_lean, cos_lean) = state.track.lean_rad.sin_cos();
        let ahead_m = mix(row[body::SURGE], 0.0) + state.drawn_m[0];
        let right_m = state.drawn_m[1] - height_m * sin_lean;
        let at = super::track::beside(state.at_m(), heading, glam::Vec2::new(ahead_m, right_m));
        let up = f64::from(lifts[0] + height_m * cos_lean);
        pose.root_in_world = DVec3::new(at.x, up, at.y).as_vec3();
        pose.world_from_root = Quat::from_rotation_y(heading.rem_euclid(std::f64::consts::TAU) as f32)
            * Quat::from_rotation_x(-state.track.lean_rad)
            * Quat::from_rotation_z(pitch);
        pose
    }

    /// Lowers the body as far as the legs need, and solves them. A standing foot that even so is out of reach leaves the ground.
    fn stand(&mut self, pose: &mut Pose, girdles: &[Girdle; 4], wanted: &[Wanted; 4], dt_s: f32) {
        let height_m = pose.root_in_world.y;
        let most_m = MOST_LOWERED_M * self.repertoire.size;
        let mut lowered_m = self.state.lowered_m * (1.0 - lagged(dt_s, RISING_S));
        for limb in 0..4 {
            let lacking_m = self.lacking_m(pose, &girdles[limb], limb, &wanted[limb]);
            if lacking_m < most_m {
                lowered_m = lowered_m.max(wanted[limb].load * lacking_m);
            } else {
                self.state.feet[limb].lose();
            }
        }
        let turns = self.hoof_turns(wanted);
        let mut reached = [Reached::default(); 4];
        for round in 0..=LOWERING_ROUNDS {
            pose.root_in_world.y = height_m - lowered_m;
            reached = std::array::from_fn(|limb| {
                self.solve(pose, &girdles[limb], limb, &wanted[limb], turns[limb])
            });
            let planted = |limb: &usize| self.state.feet[*limb].is_planted;
            let lacking_m = (0..4).filter(planted).map(|limb| reached[limb].miss_m).fold(0.0, f32::max);
            let lower_m = lowered_m + LOWERING * lacking_m;
            if !(lacking_m > THERE_M && lower_m < most_m) || round == LOWERING_ROUNDS {
                break;
            }
            lowered_m = lower_m;
        }
        self.state.lowered_m = lowered_m;
        for (limb, reached) in Limb::ALL.into_iter().zip(reached) {
            let first = limb.first_bone() + 1;
            pose.bends_rad[first..first + 4].copy_from_slice(&reached.bends_rad);
            pose.limb_turns_rad[limb.index()] = reached.limb_turn_rad;
            pose.abductions_rad[limb.index()] = reached.abduction_rad;
            if reached.miss_m >= LOST_M {
                self.state.feet[limb.index()].lose();
            }
        }
    }

    /// A place in the world as the root sees it.
    fn from_root(pose: &Pose, toe: DVec3) -> Vec3 {
        pose.world_from_root.inverse() * (toe - pose.root_in_world.as_dvec3()).as_vec3()
    }

    /// How much the body has to come down for a leg to reach, metres; softly, so that a leg that comes to its limit does not jerk it.
    fn lacking_m(&self, pose: &Pose, girdle: &Girdle, limb: usize, wanted: &Wanted) -> f32 {
        let lacking = self.repertoire.rig.legs[limb].lacking_m(girdle, Self::from_root(pose, wanted.toe));
        0.5 * (lacking + (lacking * lacking + SOFT_M * SOFT_M).sqrt())
    }

    fn solve(
        &self,
        pose: &Pose,
        girdle: &Girdle,
        limb: usize,
        wanted: &Wanted,
        hoof_turn_rad: f32,
    ) -> Reached {
        let aim = Aim { toe: Self::from_root(pose, wanted.toe), hoof_turn_rad, load: wanted.load };
        self.repertoire.rig.legs[limb].solve(girdle, &leg_bends(pose, Limb::ALL[limb]), &aim)
    }

    /// Headings of the hooves against the root's, rad.
    fn hoof_turns(&self, wanted: &[Wanted; 4]) -> [f32; 4] {
        wanted.map(|wanted| (wanted.heading_rad - self.state.track.heading_rad) as f32)
    }
}
