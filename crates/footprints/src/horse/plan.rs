//! Everything about a horse's motion that its prints alone decide.

use glam::DVec3;
use muybridge_core::{Ground, Limb, Pose, ReachMiss, ToeAim};

use super::flexing::flex;
use super::gait::HorseGait;
use super::leg::{Doing, LegCourse, LegNow, RUN_STRIDES, Stand, courses};
use super::model::HorseModel;
use super::series::smooth;
use super::swing::SwingPath;
use super::trunk::{Trunk, body_phase};
use crate::knots::Knot;
use crate::orientation::Orientation;
use crate::placed::Placed;
use crate::problem::{Problem, Weights};
use crate::stance::Stance;
use crate::track::TrackGait;

/// A leg's load at footfall and lift-off, and the shares of its stance and of its swing over which it comes and goes: a foreleg that
/// has to be shorter than the gait has it unlocks its carpus little by little.
const LOAD_AT_EDGE: f64 = 0.4;
const STANCE_EASING: f64 = 0.3;
const SWING_EASING: f64 = 0.12;
/// On ground that rises at this angle a hoof keeps to its slope, rad (as the core's ride has it).
const SLOPING_RAD: f64 = 0.1;
/// Time over which the velocity of the first guess is measured, before and after, s: a few steps of the tables.
const START_S: f64 = 0.05;
/// A horse's trunk takes the moments of its legs' forces: they go through shoulders and hips. A point mass that stands on one foot
/// 0.6 m before it would fall.
const FORCE_THROUGH_HIP: f64 = 1.0;

/// A horse over its prints, as far as they alone decide it: where each leg is in its step, how the trunk is turned, what the energy
/// has to know.
#[derive(Clone, Debug)]
pub(crate) struct HorsePlan {
    gait: HorseGait,
    print_count: usize,
    end_s: f64,
    /// From when to when the centre of mass is found: a running horse comes from somewhere and goes on.
    solved_s: [f64; 2],
    courses: [LegCourse; 4],
    paths: [SwingPath; 4],
    trunk: Trunk,
}

/// Where a toe is wanted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub(super) aim: ToeAim,
    rise_rad: f64,
}

impl HorsePlan {
    /// Plans the motion of a horse over prints.
    ///
    /// # Errors
    /// A sentence on what is wrong with the gait: unknown, at a speed it is not known at, or with a lead it does not have.
    pub(crate) fn new(
        model: &HorseModel,
        gait: &TrackGait,
        placed: &Placed,
        ground: &impl Ground,
    ) -> Result<Self, String> {
        let gait = HorseGait::new(model, gait)?;
        let own = gait.own();
        let paths = Limb::ALL.map(|limb| SwingPath::new(&gait, &own, limb));
        let (mut courses, running) = courses(&gait, placed, ground);
        for (path, course) in paths.iter().zip(&mut courses) {
            path.plan(&own, course, ground);
        }
        let run_s = RUN_STRIDES as f64 * gait.stride_time_s;
        let from_s = if running.comes { -run_s } else { 0.0 };
        let to_s = placed.end_s + if running.goes { run_s } else { 0.0 };
        let trunk = Trunk::new(&gait, &courses, [from_s, to_s], ground);
        let (print_count, end_s) = (placed.prints.len(), placed.end_s);
        Ok(Self { gait, print_count, end_s, solved_s: [from_s, to_s], courses, paths, trunk })
    }

    /// Heading, lean and pitch of the trunk: of the root's frame, in which the hips of [`HorsePlan::stances`] are told.
    pub(super) fn orientation(&self) -> &Orientation {
        &self.trunk.orientation
    }

    /// What the centre of mass has to minimise. Where the horse is in its gait at the beginning or the end, it is two strides longer
    /// there, so that the curve comes from somewhere and goes on: what nothing holds would fall.
    pub(crate) fn problem(&self, weights: Weights) -> Problem {
        Problem::new(&self.stances(), self.solved_s[1], self.orientation(), weights)
    }

    /// Where to begin the search for the centre of mass: as the gait has it over the feet, going with them.
    pub(crate) fn start(&self, problem: &Problem) -> Vec<Knot> {
        let knot = |&time_s: &f64| {
            let [before, at, after] = [-START_S, 0.0, START_S].map(|by_s| self.gait_place(time_s + by_s));
            Knot { at, velocity: (after - before) / (2.0 * START_S) }
        };
        problem.times_s().iter().map(knot).collect()
    }

    /// The centre of mass as the gait has it, world space, metres.
    fn gait_place(&self, time_s: f64) -> DVec3 {
        let phase = body_phase(&self.legs(time_s)) as f32;
        let height_m = f64::from(self.gait.own().pose(phase, [phase; 4]).root_in_world.y);
        let (pose, _) = self.carried(time_s, DVec3::ZERO);
        // What `carried` puts under the centre of mass, put on it.
        self.trunk.under_root(time_s) + DVec3::Y * height_m - pose.root_in_world.as_dvec3()
    }

    /// What the energy knows of the feet, in the order of their footfalls.
    fn stances(&self) -> Vec<Stance> {
        let [from_s, to_s] = self.solved_s;
        let mut stances = Vec::new();
        for course in &self.courses {
            let leg = &self.gait.legs[course.limb.index()];
            let is_solved = |stand: &&Stand| stand.to_s > from_s && stand.from_s < to_s;
            stances.extend(course.stands.iter().filter(is_solved).map(|stand| Stance {
                foot: course.limb.index(),
                from_s: stand.from_s.max(from_s),
                to_s: stand.to_s.min(to_s),
                ankle: stand.toe,
                middle: stand.toe,
                toe: stand.toe,
                hip_from_com: leg.hip_from_com_m,
                nominal_m: leg.nominal_m,
                longest_m: f64::from(self.gait.model.reach().span_m(course.limb)),
                force_through_hip: FORCE_THROUGH_HIP,
            }));
        }
        stances.sort_by(|a, b| a.from_s.total_cmp(&b.from_s).then(a.foot.cmp(&b.foot)));
        stances
    }

    /// End of the motion, s.
    pub(super) fn end_s(&self) -> f64 {
        self.end_s
    }

    pub(super) fn print_count(&self) -> usize {
        self.print_count
    }

    pub(super) fn gait(&self) -> &HorseGait {
        &self.gait
    }

    pub(super) fn courses(&self) -> &[LegCourse; 4] {
        &self.courses
    }

    pub(super) fn trunk(&self) -> &Trunk {
        &self.trunk
    }

    pub(super) fn legs(&self, time_s: f64) -> [Option<LegNow<'_>>; 4] {
        self.courses.each_ref().map(|course| course.at(time_s))
    }

    /// The pose at a time with the gait's legs, not yet on their prints, carried by a centre of mass; and where the toes are wanted.
    pub(super) fn carried(&self, time_s: f64, centre_of_mass: DVec3) -> (Pose, [Option<Wanted>; 4]) {
        let legs = self.legs(time_s);
        let own = self.gait.own();
        let body_phase = body_phase(&legs) as f32;
        let phases = legs.map(|leg| leg.map_or(body_phase, |leg| leg.posture_phase as f32));
        let mut pose = own.pose(body_phase, phases);
        pose.lateral_bends_rad = self.trunk.lateral_bends_rad(time_s);
        let wanted: [Option<Wanted>; 4] = std::array::from_fn(|limb| {
            let leg = legs[limb].as_ref()?;
            Some(self.wanted(limb, leg))
        });
        self.tilt_legs(&mut pose, time_s, &wanted);
        let world_from_root = self.trunk.orientation.at(time_s).normalize();
        pose.world_from_root = glam::Quat::IDENTITY;
        pose.root_in_world = glam::Vec3::ZERO;
        let from_root = pose.centre_of_mass(self.gait.model.skeleton());
        pose.world_from_root = world_from_root.as_quat();
        pose.root_in_world = (centre_of_mass - world_from_root * from_root.as_dvec3()).as_vec3();
        (pose, wanted)
    }

    /// Legs stay upright while the trunk takes the slope, and hooves on the ground take its slope under them.
    fn tilt_legs(&self, pose: &mut Pose, time_s: f64, wanted: &[Option<Wanted>; 4]) {
        let rise_rad = self.trunk.rise_rad(time_s) as f32;
        let bones = &self.gait.model.skeleton().bones;
        let mut turn = |bone: usize, by_rad: f32| {
            let [low, high] = bones[bone].limits_rad;
            pose.bends_rad[bone] = (pose.bends_rad[bone] + by_rad).clamp(low, high);
        };
        for (limb, wanted) in Limb::ALL.into_iter().zip(wanted) {
            turn(limb.first_bone() + 1, -rise_rad);
            if let Some(wanted) = wanted {
                turn(limb.hoof_bone(), wanted.rise_rad as f32 * wanted.aim.load);
            }
        }
    }

    fn wanted(&self, limb: usize, leg: &LegNow<'_>) -> Wanted {
        let (toe_in_world, heading_rad, load, rise_rad) = match leg.doing {
            Doing::Stands(stand) => {
                let through = leg.through;
                let load =
                    LOAD_AT_EDGE + (1.0 - LOAD_AT_EDGE) * smooth(through.min(1.0 - through) / STANCE_EASING);
                (stand.toe, stand.heading_rad, load, stand.rise_rad)
            }
            Doing::Swings([from, to], swing, share) => {
                let toe = self.paths[limb].toe(&self.gait.own(), [from, to], swing, share);
                let heading_rad = from.heading_rad + smooth(share) * (to.heading_rad - from.heading_rad);
                let load = LOAD_AT_EDGE * (1.0 - smooth(share.min(1.0 - share) / SWING_EASING));
                (toe, heading_rad, load, if share < 0.5 { from.rise_rad } else { to.rise_rad })
            }
        };
        let aim = ToeAim {
            toe_in_world,
            hoof_heading_rad: heading_rad as f32,
            load: load as f32,
            keeps_hoof: (load * (rise_rad.abs() / SLOPING_RAD).min(1.0)) as f32,
        };
        Wanted { aim, rise_rad }
    }

    /// Brings every toe to where it is wanted; what each leg misses.
    pub(super) fn reach(&self, pose: &mut Pose, wanted: &[Option<Wanted>; 4]) -> [ReachMiss; 4] {
        std::array::from_fn(|limb| {
            let (Some(wanted), limb) = (&wanted[limb], Limb::ALL[limb]) else { return ReachMiss::default() };
            let model = &self.gait.model;
            flex(model, pose, limb, &wanted.aim);
            model.reach().reach(pose, limb, &wanted.aim)
        })
    }
}
