//! A track as motion: solved, and posed at any time.

use std::ops::Range;
use std::sync::Arc;

use muybridge_core::Pose;

use crate::biped::{Biped, stances};
use crate::horse::{HOOF_OUTLINE_M, HorseModel, HorseMotion, HorsePlan, lay_horse};
use crate::knots::{CentreOfMass, Knot, Trajectory};
use crate::lay::lay_biped;
use crate::model::Model;
use crate::orientation::Orientation;
use crate::placed::Placed;
use crate::pose::BipedPose;
use crate::problem::Problem;
use crate::shape::{self, Tube};
use crate::solve::{Method, Solved, descend, resolve, solve};
use crate::timing::TimingRule;
use crate::track::{Foot, Track, TrackError};

/// Knots on either side of a change that move with it: what is farther off hardly feels it.
const FELT_KNOTS: usize = 4;
/// A foot that is farther than this from its print misses it, metres.
const MISSED_M: f64 = 5e-3;
/// Looked for at so many moments of a stance.
const MISS_SAMPLES: usize = 8;
/// A mean force that nobody exerts is worth a remark from a quarter of the weight on, m/s².
const STRETCHED_M_S2: f64 = 2.5;

/// Who walks; cheap to clone.
#[derive(Clone, Debug)]
pub enum Character {
    /// On two legs.
    Biped(Arc<Model>),
    /// On four.
    Horse(HorseModel),
}

impl Character {
    /// A built-in character: `bird`, `dinosaur`, `human` or `horse`. Making the horse takes some tens of milliseconds: keep it.
    pub fn named(name: &str) -> Option<Self> {
        if name == "horse" {
            return Some(Self::Horse(HorseModel::reference()));
        }
        Model::named(name).map(|model| Self::Biped(Arc::new(model)))
    }

    /// Outline of a right foot's print, x ahead and z to the right of its middle, metres; a left one's is its mirror image.
    pub fn outline_m(&self) -> &[[f64; 2]] {
        match self {
            Self::Biped(model) => &model.leg.foot.outline_m,
            Self::Horse(_) => &HOOF_OUTLINE_M,
        }
    }

    /// Its feet.
    pub fn feet(&self) -> &'static [Foot] {
        match self {
            Self::Biped(_) => &Foot::BIPED,
            Self::Horse(_) => &Foot::QUADRUPED,
        }
    }

    /// The track with prints laid along its path if it has none.
    ///
    /// # Errors
    /// When the path or the gait does not serve.
    pub fn laid(&self, track: &Track) -> Result<Track, TrackError> {
        let mut track = track.clone();
        if let (true, Some(laying)) = (track.prints.is_empty(), &track.path) {
            let laid = match self {
                Self::Biped(model) => lay_biped(laying, model),
                Self::Horse(model) => lay_horse(laying, &gait(&track)?, &track.terrain, model),
            };
            track.prints = laid.map_err(|error| fault(error.to_string()))?;
        }
        Ok(track)
    }

    /// The prints on the ground at their times.
    fn place(&self, track: &Track) -> Result<Placed, TrackError> {
        let strange = track.prints.iter().position(|print| !self.feet().contains(&print.foot));
        if let Some(i) = strange {
            let feet: Vec<&str> = self.feet().iter().map(|foot| foot.abbreviation()).collect();
            let foot = track.prints[i].foot.abbreviation();
            let text = format!(
                "print {}: a {} has no foot {foot}; its feet are {}",
                i + 1,
                track.model,
                feet.join(", ")
            );
            return Err(fault(text));
        }
        match self {
            Self::Biped(model) => track.place(&model.timing),
            Self::Horse(_) => track.place(&TimingRule { step_times: Vec::new(), stance_times: Vec::new() }),
        }
    }
}

fn gait(track: &Track) -> Result<crate::track::TrackGait, TrackError> {
    track
        .gait
        .ok_or_else(|| fault("a horse needs to know its gait: give the track a gait and a speed".into()))
}

fn fault(text: String) -> TrackError {
    TrackError::Faults(vec![text])
}

/// A figure at a moment.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "made one at a time and never kept in numbers")]
pub enum Figure {
    /// On two legs.
    Biped(BipedPose),
    /// A horse.
    Horse(Pose),
}

/// What a person should know of a motion: it is shown as it is, but the prints asked for more than a body can do.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    /// The print it is about, from 0.
    pub print: usize,
    /// What, in a sentence.
    pub text: String,
}

/// What carries the legs over a solved track.
#[derive(Clone, Debug)]
enum Carried {
    Biped { model: Arc<Model>, orientation: Orientation },
    Horse { model: HorseModel, motion: Box<HorseMotion> },
}

/// What is known before the centre of mass is.
enum Planned {
    Biped { model: Arc<Model>, orientation: Orientation },
    Horse { model: HorseModel, plan: Box<HorsePlan> },
}

/// A solved track.
#[derive(Clone, Debug)]
pub struct Motion {
    /// The track, its prints laid.
    pub track: Track,
    /// The prints on the ground.
    pub placed: Placed,
    /// The solution. A horse that is in its gait at the beginning or the end has two more strides there that are not shown, whose
    /// knots and energy are among these.
    pub solved: Solved,
    problem: Problem,
    carried: Carried,
}

impl Motion {
    /// Lays prints where there are none, times them, finds the centre-of-mass curve from the paper's start.
    ///
    /// # Errors
    /// When the track cannot be walked.
    pub fn solve(track: &Track, character: &Character, method: Method) -> Result<Self, TrackError> {
        let track = character.laid(track)?;
        let placed = character.place(&track)?;
        let planned = Planned::new(&track, &placed, character)?;
        let problem = planned.problem(&track, &placed);
        let solved = planned.solve(&problem, method);
        Ok(Self { carried: planned.carry(&solved.trajectory), track, placed, solved, problem })
    }

    /// The motion of a track that differs a little from this one's, found from this one: only what feels the change moves.
    ///
    /// Quick, and as good as [`Motion::solve`] to about a percent of the energy; when a gesture has ended, solve anew.
    ///
    /// # Errors
    /// When the track cannot be walked.
    pub fn changed(&self, track: &Track) -> Result<Self, TrackError> {
        let character = self.character();
        let track = character.laid(track)?;
        let placed = character.place(&track)?;
        let planned = Planned::new(&track, &placed, &character)?;
        let problem = planned.problem(&track, &placed);
        let solved = if problem.times_s().len() == self.problem.times_s().len() {
            let (start, free) = self.moved(&problem);
            resolve(&problem, start, free)
        } else {
            planned.solve(&problem, Method::Gradient)
        };
        Ok(Self { carried: planned.carry(&solved.trajectory), track, placed, solved, problem })
    }

    /// This motion's knots, moved as their prints have; and those that feel the change.
    fn moved(&self, problem: &Problem) -> (Vec<Knot>, Range<usize>) {
        let (before, after) = (self.problem.start(), problem.start());
        let ends = before.iter().zip(&after).zip(&self.solved.trajectory.knots);
        let knots = ends
            .map(|((before, after), knot)| Knot { at: knot.at + after.at - before.at, ..*knot })
            .collect();
        let is_other = |curve: &usize| !self.problem.has_same_curve(problem, *curve);
        let first = (0..problem.curves()).find(is_other);
        let last = (0..problem.curves()).rev().find(is_other);
        let free = match (first, last) {
            (Some(first), Some(last)) => first.saturating_sub(FELT_KNOTS)..last + 2 + FELT_KNOTS,
            _ => 0..0,
        };
        (knots, free)
    }

    /// Who walks.
    pub fn character(&self) -> Character {
        match &self.carried {
            Carried::Biped { model, .. } => Character::Biped(Arc::clone(model)),
            Carried::Horse { model, .. } => Character::Horse(model.clone()),
        }
    }

    /// What the curve was found to minimise.
    pub fn problem(&self) -> &Problem {
        &self.problem
    }

    /// Duration, s.
    pub fn duration_s(&self) -> f64 {
        self.placed.end_s
    }

    /// The centre of mass at a time.
    pub fn centre_of_mass(&self, time_s: f64) -> CentreOfMass {
        self.solved.trajectory.at(time_s)
    }

    /// The figure at a time, s; held at the ends.
    pub fn figure(&self, time_s: f64) -> Figure {
        match &self.carried {
            Carried::Biped { model, orientation } => {
                let trajectory = &self.solved.trajectory;
                Figure::Biped(Biped { model, placed: &self.placed, orientation, trajectory }.pose(time_s))
            }
            Carried::Horse { motion, .. } => Figure::Horse(motion.pose(time_s)),
        }
    }

    /// What a two-legged figure looks like; a horse is drawn from its joints.
    pub fn tubes(&self, figure: &Figure) -> Vec<Tube> {
        match (&self.carried, figure) {
            (Carried::Biped { model, .. }, Figure::Biped(pose)) => shape::tubes(model, pose),
            _ => Vec::new(),
        }
    }

    /// What a person should know: prints out of reach, and steps whose forces nobody could exert; in the order of the prints.
    pub fn remarks(&self) -> Vec<Remark> {
        let mut remarks: Vec<Remark> =
            self.misses().map(|(print, miss_m)| self.missed(print, miss_m)).collect();
        remarks.extend(self.stretched());
        remarks.sort_by_key(|remark| remark.print);
        remarks
    }

    fn missed(&self, print: usize, miss_m: f64) -> Remark {
        let foot = self.placed.prints[print].foot.abbreviation();
        let text = format!(
            "print {} ({foot}) is out of reach by {miss_m:.3} m; move it nearer to its neighbours or give it more time",
            print + 1
        );
        Remark { print, text }
    }

    /// Prints that their feet miss, with the most they miss them by, metres.
    fn misses(&self) -> Box<dyn Iterator<Item = (usize, f64)> + '_> {
        if let Carried::Horse { motion, .. } = &self.carried {
            return Box::new(motion.misses());
        }
        let most_m = |print: &crate::placed::PlacedPrint| {
            let moment = |i: usize| {
                let share = (i as f64 + 0.5) / MISS_SAMPLES as f64;
                print.strike_s + share * (print.lift_off_s - print.strike_s)
            };
            let miss_m = |time_s: f64| match self.figure(time_s) {
                Figure::Biped(pose) => pose.legs[print.foot.index()].miss_m,
                Figure::Horse(_) => 0.0,
            };
            (0..MISS_SAMPLES).map(moment).map(miss_m).fold(0.0, f64::max)
        };
        let misses = self.placed.prints.iter().map(most_m).enumerate();
        Box::new(misses.filter(|(_, miss_m)| *miss_m > MISSED_M))
    }

    /// Steps during which the mean of the missing force is large.
    fn stretched(&self) -> impl Iterator<Item = Remark> + '_ {
        let (times_s, knots) = (&self.solved.trajectory.times_s, &self.solved.trajectory.knots);
        let physics = self.track.weights.physics.max(f64::MIN_POSITIVE);
        // A horse's curve begins before its prints and ends after them: nobody sees that.
        let is_shown = |curve: &usize| times_s[*curve] >= 0.0 && times_s[curve + 1] <= self.placed.end_s;
        (0..self.problem.curves()).filter(is_shown).filter_map(move |curve| {
            let [missing, _] = self.problem.curve_energy(curve, [&knots[curve], &knots[curve + 1]], 0.0);
            let mean_m_s2 = missing / physics / (times_s[curve + 1] - times_s[curve]);
            let print =
                self.placed.prints.partition_point(|print| print.strike_s <= times_s[curve]).max(1) - 1;
            let text = format!(
                "after print {} the motion asks for a force of {:.2} of the weight that no foot exerts",
                print + 1,
                mean_m_s2 / 9.81
            );
            (mean_m_s2 > STRETCHED_M_S2).then_some(Remark { print, text })
        })
    }
}

/// Whether a two-legged figure stands on both feet at the beginning and at the end: then it is at rest there.
fn stands(placed: &Placed) -> [bool; 2] {
    let both = |is_down: &dyn Fn(&crate::placed::PlacedPrint) -> bool| {
        Foot::BIPED.iter().all(|foot| placed.prints.iter().any(|print| print.foot == *foot && is_down(print)))
    };
    [both(&|print| print.strike_s <= 0.0), both(&|print| print.lift_off_s >= placed.end_s)]
}

impl Planned {
    fn new(track: &Track, placed: &Placed, character: &Character) -> Result<Self, TrackError> {
        Ok(match character {
            Character::Biped(model) => {
                let orientation = Orientation::plan(
                    &placed.prints,
                    placed.end_s,
                    model.body_window_s,
                    model.pitch,
                    model.roll,
                );
                Self::Biped { model: Arc::clone(model), orientation }
            }
            Character::Horse(model) => {
                let plan = HorsePlan::new(model, &gait(track)?, placed, &track.terrain).map_err(fault)?;
                Self::Horse { model: model.clone(), plan: Box::new(plan) }
            }
        })
    }

    fn problem(&self, track: &Track, placed: &Placed) -> Problem {
        match self {
            Self::Biped { model, orientation } => {
                Problem::new(&stances(model, placed), placed.end_s, orientation, track.weights)
                    .at_rest(stands(placed))
            }
            Self::Horse { plan, .. } => plan.problem(track.weights),
        }
    }

    /// Solves: a horse from its gait over the prints, which is near and known; others from the paper's start.
    fn solve(&self, problem: &Problem, method: Method) -> Solved {
        match (self, method) {
            (Self::Horse { plan, .. }, Method::Gradient) => descend(problem, plan.start(problem)),
            _ => solve(problem, method),
        }
    }

    fn carry(self, trajectory: &Trajectory) -> Carried {
        match self {
            Self::Biped { model, orientation } => Carried::Biped { model, orientation },
            Self::Horse { model, plan } => {
                Carried::Horse { model, motion: Box::new(HorseMotion::new(*plan, trajectory.clone())) }
            }
        }
    }
}
