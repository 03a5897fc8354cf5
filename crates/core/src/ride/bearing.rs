//! The body gives way, not the foot: it is drawn to feet that are out of reach, and every leg is solved so that a standing hoof is
//! exactly where it struck (spec 6.3).

use glam::{DVec2, DVec3, Vec3, Vec3Swizzles};

use super::feet::Wanted;
use super::ground::Ground;
use super::repertoire::Repertoire;
use super::retarget::leg_bends;
use super::rig::{Aim, Girdle, Reached};
use super::state::HorseState;
use super::terrain::height_m;
use super::track::lagged;
use crate::limb::Limb;
use crate::pose::Pose;

/// The body is pulled no farther than this to a foot that is out of reach, metres of a reference horse.
const MOST_PULLED_M: f32 = 0.6;
/// Time in which a pulled body comes back, s.
const RETURNING_S: f32 = 0.12;
/// A pull goes down rather than along the track: a body held back in its way lurches, a lowered one flexes its legs.
const PULL_ALONG: f32 = 0.5;
/// Below this a standing hoof counts as in its place, metres.
const THERE_M: f32 = 2e-5;
/// Rounds of pulling the body to legs that are too short; each takes a leg after the other.
const PULLS: usize = 3;
/// Rounds of pulling it to legs whose joints, not whose length, stop them.
const SOLUTIONS: usize = 8;
/// Share of its greatest length a leg strikes the ground with at most, unless the body is too high for that.
const COMFORT: f32 = 0.985;
/// A pull that leaves more than this of what was lacking is not worth it.
const WORTH: f32 = 0.8;
/// How much more than what is lacking the body is pulled then.
const PULL: f32 = 1.3;
/// Softness with which a leg's limit of reach is met, metres.
const SOFT_M: f32 = 0.004;
/// On ground that rises at this angle a hoof keeps to its slope, rad.
const SLOPING_RAD: f32 = 0.1;
/// A foot that is still farther than this from its place has to leave the ground, metres.
const LOST_M: f32 = 5e-5;

/// The pull of a leg of a length whose toe has to be at a place seen from its joint, metres: as long as it takes.
fn pull_to(place: Vec3, lacking_m: f32) -> Vec3 {
    let along = place.normalize_or_zero();
    let way = (along * Vec3::new(PULL_ALONG, 1.0, PULL_ALONG)).normalize_or_zero();
    way * (lacking_m / way.dot(along).max(0.2))
}

impl HorseState {
    /// Draws prints that are just being made to where the legs can reach without pulling the body.
    pub(super) fn settle(
        &mut self,
        repertoire: &Repertoire,
        pose: &Pose,
        wanted: &mut [Wanted; 4],
        stood: [bool; 4],
        ground: &impl Ground,
    ) {
        let strikes: [bool; 4] = std::array::from_fn(|limb| self.feet[limb].is_planted && !stood[limb]);
        if !strikes.contains(&true) {
            return;
        }
        let girdles = repertoire.rig.girdles(pose);
        for limb in (0..4).filter(|&limb| strikes[limb]) {
            let joint = pose.root_in_world + self.pull_m + pose.world_from_root * girdles[limb].joint;
            let print = &mut self.feet[limb].print;
            let away = (*print - joint.as_dvec3()).as_vec3();
            let reach_m = COMFORT * repertoire.rig.legs[limb].span_m;
            let (level_m, most_m) = (away.xz().length(), (reach_m * reach_m - away.y * away.y).sqrt());
            if level_m > most_m {
                let nearer = away.xz() * (1.0 - most_m / level_m);
                let at = DVec2::new(print.x, print.z) - nearer.as_dvec2();
                let height = height_m(ground, at).map_or(print.y, f64::from);
                *print = DVec3::new(at.x, height, at.y);
                wanted[limb].toe = *print;
            }
        }
    }

    /// Draws the body to feet that are out of reach, and solves the legs. Only a foot that no place of the body would serve leaves the
    /// ground.
    pub(super) fn stand(
        &mut self,
        repertoire: &Repertoire,
        pose: &mut Pose,
        wanted: &[Wanted; 4],
        dt_s: f32,
    ) {
        let girdles = repertoire.rig.girdles(pose);
        let mut pull = self.pull(repertoire, pose, &girdles, wanted, dt_s);
        let root = pose.root_in_world;
        let most_m = MOST_PULLED_M * repertoire.size;
        let mut reached = [Reached::default(); 4];
        let (mut best_m, mut best) = (f32::INFINITY, pull);
        for round in 0..=SOLUTIONS {
            pose.root_in_world = root + pull;
            for limb in 0..4 {
                reached[limb] = self.reach(repertoire, pose, &girdles[limb], limb, &wanted[limb]);
            }
            let planted = (0..4).filter(|&limb| self.feet[limb].is_planted);
            let worst = planted.max_by(|&a, &b| reached[a].miss_m.total_cmp(&reached[b].miss_m));
            let Some(worst) = worst.filter(|&limb| reached[limb].miss_m > THERE_M) else { break };
            let miss_m = reached[worst].miss_m;
            if round == SOLUTIONS {
                break;
            }
            if miss_m > WORTH * best_m {
                // Pulling does not help: that foot has to go, and the body goes back.
                self.feet[worst].lose();
                (pull, best_m) = (best, f32::INFINITY);
                continue;
            }
            (best_m, best) = (miss_m, pull);
            let missing = reached[worst].missing_m.clamp_length_max(most_m).extend(0.0);
            pull = (pull + PULL * (pose.world_from_root * missing)).clamp_length_max(most_m);
        }
        self.pull_m = pull;
        for (limb, reached) in Limb::ALL.into_iter().zip(reached) {
            let first = limb.first_bone() + 1;
            pose.bends_rad[first..first + 4].copy_from_slice(&reached.bends_rad);
            pose.limb_turns_rad[limb.index()] = reached.limb_turn_rad;
            pose.abductions_rad[limb.index()] = reached.abduction_rad;
            if reached.miss_m >= LOST_M {
                self.feet[limb.index()].lose();
            }
        }
    }

    /// How far the body has to be from where its stride has it so that every standing leg reaches its print and every leg that will
    /// strike its next one, metres.
    fn pull(
        &self,
        repertoire: &Repertoire,
        pose: &Pose,
        girdles: &[Girdle; 4],
        wanted: &[Wanted; 4],
        dt_s: f32,
    ) -> Vec3 {
        let root = pose.root_in_world.as_dvec3();
        let mut pull = self.pull_m * (1.0 - lagged(dt_s, RETURNING_S));
        let joints = girdles.map(|girdle| pose.world_from_root * girdle.joint);
        for limb in 0..4 {
            // What is to come, softly, so that a leg that comes to its limit does not jerk the body.
            let place = (wanted[limb].bears_at - root).as_vec3() - joints[limb];
            let lacking = place.length() - repertoire.rig.legs[limb].span_m;
            let lacking = 0.5 * (lacking + (lacking * lacking + SOFT_M * SOFT_M).sqrt());
            let done = pull.dot(place.normalize_or_zero());
            pull += pull_to(place, (wanted[limb].bears * lacking - done).max(0.0));
        }
        for _ in 0..PULLS {
            let mut is_pulled = false;
            for limb in (0..4).filter(|&limb| wanted[limb].is_planted) {
                let place = (wanted[limb].toe - root).as_vec3() - joints[limb] - pull;
                let lacking = place.length() - repertoire.rig.legs[limb].span_m;
                if lacking > 0.0 {
                    pull += pull_to(place, lacking);
                    is_pulled = true;
                }
            }
            if !is_pulled {
                break;
            }
        }
        pull.clamp_length_max(MOST_PULLED_M * repertoire.size)
    }

    /// Solves a leg for where its toe is wanted.
    fn reach(
        &self,
        repertoire: &Repertoire,
        pose: &Pose,
        girdle: &Girdle,
        limb: usize,
        wanted: &Wanted,
    ) -> Reached {
        let from_root: DVec3 = wanted.toe - pose.root_in_world.as_dvec3();
        let aim = Aim {
            toe: pose.world_from_root.inverse() * from_root.as_vec3(),
            hoof_turn_rad: (wanted.heading_rad - self.track.heading_rad) as f32,
            load: wanted.load,
            keeps_hoof: wanted.load * (self.feet[limb].rise_rad.abs() / SLOPING_RAD).min(1.0),
        };
        repertoire.rig.legs[limb].solve(girdle, &leg_bends(pose, Limb::ALL[limb]), &aim)
    }
}
