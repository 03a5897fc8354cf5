//! The body over its feet: trunk, neck and head as the stride has them, on the track, on the ground, leaning and bent into the turn.

use glam::{DVec2, DVec3, Quat, Vec2};

use super::clip::{BodyRow, LegRow, body, leg};
use super::feet::{Going, LegNow, Wanted};
use super::ground::Ground;
use super::mixture::Mixture;
use super::repertoire::Repertoire;
use super::retarget::smooth;
use super::state::HorseState;
use super::track::{Facing, lagged};
use crate::limb::{Limb, Pair};
use crate::pose::Pose;
use crate::skeleton::bone;

/// Time in which the body follows its standing feet, s.
const DRAWN_S: f32 = 0.06;
/// Weight of the track itself among the standing feet.
const TRACK_WEIGHT: f32 = 0.25;
/// The body is drawn no farther than this, metres of a reference horse.
const MOST_DRAWN_M: f32 = 0.15;

impl HorseState {
    /// Finds the pose for the moment the clock shows.
    pub(super) fn pose_now(&mut self, repertoire: &Repertoire, ground: &impl Ground, dt_s: f32) {
        let step_share = self.terrain.step_share(repertoire.rig.trunk_m);
        let mixture = Mixture::new(repertoire, &self.warp.weights, self.speeds_m_s(), step_share);
        let before_m = if self.timing.rate_hz > 0.0 { self.timing.stride_m() } else { 0.0 };
        let timing = mixture.timing;
        self.timing = timing;
        self.lengthen(before_m, dt_s);
        let cycles = self.warp.cycles();
        let rows: [LegRow; 4] = std::array::from_fn(|limb| mixture.leg(limb, cycles[limb]));
        let mut body_row = mixture.body(&cycles, self.warp.is_steady());
        body_row[body::HEIGHT] += self.leaping.added_m(repertoire, &self.warp, timing.rate_hz);

        let legs = self.legs_now(repertoire, &rows, &timing, &cycles);
        let going = self.going(repertoire, &timing);
        let (feet, has_to_step) = self.stepped(&legs, &going, ground);
        let mut wanted: [Wanted; 4] =
            std::array::from_fn(|limb| feet[limb].wanted(&legs[limb], &going, ground));
        let off_m = off_track_m(&legs, &wanted, &going);
        let stood = self.feet.map(|foot| foot.is_planted);
        self.has_left = std::array::from_fn(|limb| stood[limb] && !feet[limb].is_planted);
        (self.feet, self.is_stepping) = (feet, has_to_step);
        let most = MOST_DRAWN_M * repertoire.size;
        for (drawn, off) in self.drawn_m.iter_mut().zip(off_m) {
            *drawn += (off.clamp(-most, most) - *drawn) * lagged(dt_s, DRAWN_S);
        }

        let mut pose = self.trunk(repertoire, &body_row, &rows);
        self.tilt_legs(repertoire, &mut pose, &wanted);
        self.settle(repertoire, &pose, &mut wanted, stood, ground);
        self.stand(repertoire, &mut pose, &wanted, dt_s);
        self.pose = pose;
    }

    /// Root, spine, neck, head and the girdles' own bones; legs as the stride has them.
    fn trunk(&self, repertoire: &Repertoire, row: &BodyRow, rows: &[LegRow; 4]) -> Pose {
        let (still, standing) = (&repertoire.standing, smooth(self.stillness));
        let mix = |going: f32, still: f32| going + standing * (still - going);
        let mut pose = Pose::default();
        for i in 0..bone::LIMBS {
            pose.bends_rad[i] = mix(row[i], still.bends_rad[i]);
        }
        for limb in Limb::ALL {
            let (first, row) = (limb.first_bone(), &rows[limb.index()]);
            for i in 0..5 {
                pose.bends_rad[first + i] = mix(row[i], still.bends_rad[first + i]);
            }
            if limb.pair() == Pair::Fore {
                pose.scapula_slides_m[limb.index()] = mix(row[leg::SLIDE], 0.0);
            }
        }
        // A curve between its samples may swing past a limit that the samples keep.
        for (bend, [low, high]) in pose.bends_rad.iter_mut().zip(repertoire.rig.limits_rad) {
            *bend = bend.clamp(low, high);
        }
        let [head, neck, spine] = self.track.bends_rad;
        pose.lateral_bends_rad[..bone::NECK].fill(spine / 4.0);
        pose.lateral_bends_rad[bone::NECK..bone::HEAD].fill(neck / 3.0);
        pose.lateral_bends_rad[bone::HEAD] = head;
        let pitch = mix(row[body::PITCH], 0.0) + self.terrain.rise_rad(repertoire.rig.trunk_m);
        let height_m = mix(row[body::HEIGHT], still.root_in_world.y);
        self.place_root(&mut pose, [height_m, pitch], mix(row[body::SURGE], 0.0));
        pose
    }

    /// Places the root on the track, over the ground, leaning.
    fn place_root(&self, pose: &mut Pose, [height_m, pitch_rad]: [f32; 2], surge_m: f32) {
        let (heading, lean) = (self.track.heading_rad, self.track.lean_rad);
        let (sin_lean, cos_lean) = lean.sin_cos();
        let ahead_right_m = Vec2::new(surge_m + self.drawn_m[0], self.drawn_m[1] - height_m * sin_lean);
        let at = Facing::new(heading).beside(self.track.at_m, ahead_right_m);
        let up_m = f64::from(self.terrain.lifts_m[0] + height_m * cos_lean);
        pose.root_in_world = DVec3::new(at.x, up_m, at.y).as_vec3();
        pose.world_from_root = Quat::from_rotation_y(heading.rem_euclid(std::f64::consts::TAU) as f32)
            * Quat::from_rotation_x(-lean)
            * Quat::from_rotation_z(pitch_rad);
    }

    /// Legs stay upright while the trunk takes the slope, and hooves on the ground take its slope under them.
    fn tilt_legs(&self, repertoire: &Repertoire, pose: &mut Pose, wanted: &[Wanted; 4]) {
        let body_rad = self.terrain.rise_rad(repertoire.rig.trunk_m);
        let mut turn = |bone: usize, by_rad: f32| {
            let [low, high] = repertoire.rig.limits_rad[bone];
            pose.bends_rad[bone] = (pose.bends_rad[bone] + by_rad).clamp(low, high);
        };
        for limb in Limb::ALL {
            turn(limb.first_bone() + 1, -body_rad);
            let rise_rad = self.feet[limb.index()].rise_rad;
            turn(limb.hoof_bone(), rise_rad * wanted[limb.index()].load);
        }
    }
}

/// Where the standing feet draw the body, ahead and to the right, metres: the mean of what they are off the stride's own places
/// (Huang 2012, Eq. 3.21).
fn off_track_m(legs: &[LegNow; 4], wanted: &[Wanted; 4], going: &Going<'_>) -> [f32; 2] {
    let (mut off_m, mut weights) = (DVec2::ZERO, TRACK_WEIGHT);
    for (leg, wanted) in legs.iter().zip(wanted) {
        if !wanted.is_planted {
            continue;
        }
        let through = (leg.cycle / going.timing.duties[leg.limb]).min(1.0);
        let weight = 4.0 * through * (1.0 - through) + going.standing;
        off_m += (DVec2::new(wanted.toe.x, wanted.toe.z) - going.own_place(leg)) * f64::from(weight);
        weights += weight;
    }
    let off_m = off_m / f64::from(weights);
    [off_m.dot(going.facing.ahead) as f32, off_m.dot(going.facing.right()) as f32]
}
