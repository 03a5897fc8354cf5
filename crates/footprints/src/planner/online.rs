//! Motion for prints that come one after another (van de Panne 1997, 4.2 and Fig. 14).
//!
//! When print n arrives, the step to it has its times, and the curve of the step before, from print n - 2 to print n - 1, is found and
//! executed: with the step to print n in sight, so that a leap is anticipated, and with another one like the last two, as nobody
//! should slow down because the next print is not known yet. Only knots that were not executed move. What was executed is never
//! changed again:
//!
//! - the curve up to the footfall of print n - 1;
//! - when print n - 2 is lifted, as it depends on prints up to n;
//! - the orientation of the body up to the same time. It is a moving mean and would like to know prints that are still to come; it
//!   takes the imagined ones for them, and when they come otherwise, the difference is made good by and by;
//! - poses up to there, but none of a foot in the air before the footfall that it swings to is executed too.

use glam::{DQuat, DVec2};

use super::plan::{ahead, heading_of, wrapped};
use crate::biped::{Biped, stances};
use crate::bounds::LEAST_TIME_S;
use crate::knots::Trajectory;
use crate::model::Model;
use crate::newton::{Chain, From, minimize};
use crate::orientation::{Orientation, smooth};
use crate::placed::{Placed, PlacedPrint, lift_off_s, print_faults, world_from_foot};
use crate::pose::BipedPose;
use crate::problem::{Problem, Weights};
use crate::stance::Stance;
use crate::terrain::Terrain;
use crate::timing::{TimingRule, timings};
use crate::track::{Foot, Print};

/// Prints whose times the newest one may change: its own, and of the one before and the one before that the lift-off.
const OPEN: usize = 3;
/// Time in which the body turns to where it should have been turned to, had all prints been known, s.
const SETTLING_S: f64 = 0.3;
/// Time between two entries of the orientation, s.
const ENTRY_S: f64 = 1.0 / 60.0;
/// Prints before the window of the body's orientation that still matter to it: two for the feet, two for the sways.
const BEFORE_WINDOW: usize = 4;
/// Most prints that the orientation looks back on, however fast they come.
const MOST_BEFORE: usize = 64;

/// Why a print cannot be stepped on.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlannerError {
    /// Model, terrain or weights that cannot be.
    #[error("{0}")]
    Setting(String),
    /// A print that cannot be.
    #[error("print {number}: {fault}")]
    Print {
        /// Which, from 1.
        number: usize,
        /// What is wrong and what to do.
        fault: String,
    },
}

/// A figure on two legs that is told one print at a time. A step costs the same however far it has come; what is kept grows by about a
/// kilobyte a step.
#[derive(Clone, Debug)]
pub struct Planner {
    model: Model,
    terrain: Terrain,
    weights: Weights,
    /// The last prints, [`OPEN`] at most.
    open: Vec<Print>,
    placed: Placed,
    executed: Trajectory,
    /// The curve found last, from the last executed knot to the imagined end.
    found: Trajectory,
    orientation: Orientation,
    /// Entries of the orientation that are executed.
    turned: usize,
    final_s: Option<f64>,
}

impl Planner {
    /// A figure that has not been told a print yet.
    ///
    /// # Errors
    /// When the terrain, the weights or the model's times cannot be.
    pub fn new(model: Model, terrain: Terrain, weights: Weights) -> Result<Self, PlannerError> {
        let fault = terrain.fault().or_else(|| model.timing.fault()).or_else(|| weights.fault());
        if let Some(fault) = fault {
            return Err(PlannerError::Setting(fault));
        }
        Ok(Self {
            model,
            terrain,
            weights,
            open: Vec::new(),
            placed: Placed { prints: Vec::new(), end_s: 0.0 },
            executed: Trajectory::default(),
            found: Trajectory::default(),
            orientation: Orientation { from_s: 0.0, step_s: ENTRY_S, world_from_body: Vec::new() },
            turned: 0,
            final_s: None,
        })
    }

    /// All prints so far. Lift-offs of the last two are a guess, and so is the end.
    pub fn placed(&self) -> &Placed {
        &self.placed
    }

    /// The executed curve: it only ever grows.
    pub fn trajectory(&self) -> &Trajectory {
        &self.executed
    }

    /// The time up to which poses are final, s; none before the third print.
    pub fn final_s(&self) -> Option<f64> {
        self.final_s
    }

    /// The figure at a time, s; held between 0 and [`Planner::final_s`]. None before the third print.
    pub fn pose(&self, time_s: f64) -> Option<BipedPose> {
        let time_s = if time_s.is_nan() { 0.0 } else { time_s.clamp(0.0, self.final_s?) };
        let Self { model, placed, orientation, executed: trajectory, .. } = self;
        Some(Biped { model, placed, orientation, trajectory }.pose(time_s))
    }

    /// Takes the next print; from the third one on this executes a step.
    ///
    /// # Errors
    /// When the print cannot be stepped on: its numbers cannot be, its foot is that of the print before (nobody knows then where the
    /// other one swings to), or its foot has no time to get there. The planner is then as it was.
    pub fn push(&mut self, print: Print) -> Result<(), PlannerError> {
        let number = self.placed.prints.len() + 1;
        let fault = print_faults(&print, true).next().or_else(|| {
            let same = self.open.last().is_some_and(|last| last.foot == print.foot);
            same.then(|| "its foot is the one of the print before; feet must take turns".into())
        });
        if let Some(fault) = fault {
            return Err(PlannerError::Print { number, fault });
        }
        let mut open = self.open.clone();
        open.push(print);
        open.drain(..open.len().saturating_sub(OPEN));
        let (placed, imagined) = self.timed(&open)?;
        let known = self.placed.prints.len() + 1 - open.len();
        self.placed.prints.splice(known.., placed.iter().copied());
        self.open = open;
        self.placed.end_s = imagined.end_s;
        if self.open.len() == OPEN {
            self.turn(&imagined);
            self.solve(&imagined);
            self.execute();
        }
        Ok(())
    }

    /// The open prints on the ground at their times, and the same with one more that is imagined.
    fn timed(&self, open: &[Print]) -> Result<(Vec<PlacedPrint>, Placed), PlannerError> {
        let first = self.placed.prints.len() + 1 - open.len();
        let mut prints = open.to_vec();
        prints.extend(imagined(open, &self.model.timing));
        let timings = timings(&prints, &self.model.timing, &self.terrain);
        let mut time_s = self.placed.prints.get(first).map_or(0.0, |print| print.strike_s);
        let mut strikes_s = Vec::new();
        for (i, timing) in timings.iter().enumerate() {
            // Footfalls that are known already stay what they are to the last bit.
            strikes_s.push(self.placed.prints.get(first + i).map_or(time_s, |print| print.strike_s));
            time_s = strikes_s[i] + timing.step_time_s;
        }
        for (i, pair) in strikes_s[..open.len()].windows(OPEN).enumerate() {
            let until_s = pair[OPEN - 1] - pair[0];
            let stance_s = timings[i].stance_time_s;
            if until_s < LEAST_TIME_S || stance_s > until_s - LEAST_TIME_S {
                let number = first + i + 1;
                let fault = format!(
                    "its foot still stands on print {number}, for {stance_s:.3} s, when it falls here {until_s:.3} s later; \
                     give that print less stance_time_s, or the prints from there on more step_time_s"
                );
                return Err(PlannerError::Print { number: first + open.len(), fault });
            }
        }
        let place = |(i, print): (usize, &Print)| PlacedPrint {
            foot: print.foot,
            middle: self.terrain.on_ground(print.at_m),
            world_from_foot: world_from_foot(print, &self.terrain),
            strike_s: strikes_s[i],
            lift_off_s: lift_off_s(strikes_s[i] + timings[i].stance_time_s, &strikes_s, time_s),
        };
        let prints: Vec<PlacedPrint> = prints.iter().enumerate().map(place).collect();
        Ok((prints[..open.len()].to_vec(), Placed { prints, end_s: time_s }))
    }

    /// Plans the orientation from where it is executed on.
    fn turn(&mut self, imagined: &Placed) {
        let prints = &self.placed.prints;
        let open_from = prints.len() - OPEN;
        let mut first = open_from;
        let window_from_s = self.turned as f64 * ENTRY_S - self.model.body_window_s / 2.0;
        let fewest = prints.len().saturating_sub(MOST_BEFORE);
        while first > fewest && prints[first].strike_s > window_from_s {
            first -= 1;
        }
        first = first.saturating_sub(BEFORE_WINDOW);
        // The plan of a window starts at 0: on an entry of the whole table, so that entry falls on entry.
        let skipped = (prints[first].strike_s / ENTRY_S).floor();
        let from_s = skipped * ENTRY_S;
        let earlier = |print: &PlacedPrint| PlacedPrint {
            strike_s: print.strike_s - from_s,
            lift_off_s: print.lift_off_s - from_s,
            ..*print
        };
        let window: Vec<PlacedPrint> =
            prints[first..open_from].iter().chain(&imagined.prints).map(earlier).collect();
        let Model { body_window_s, pitch, roll, .. } = self.model;
        let planned = Orientation::plan(&window, imagined.end_s - from_s, body_window_s, pitch, roll);
        self.go_on_turning(&Orientation { from_s, ..planned }, imagined.end_s);
    }

    /// Replaces what is not executed of the orientation by what is planned; from where it was executed on it goes over to it.
    fn go_on_turning(&mut self, planned: &Orientation, end_s: f64) {
        let table = &mut self.orientation.world_from_body;
        table.truncate(self.turned);
        let planned_at = |entry: usize| planned.at(entry as f64 * ENTRY_S);
        let last = table.last().copied().zip(table.len().checked_sub(1));
        let differs = last.map_or(DQuat::IDENTITY, |(turned, entry)| turned * planned_at(entry).inverse());
        for entry in table.len()..=(end_s / ENTRY_S).ceil() as usize {
            let since_s = last.map_or(0.0, |(_, last)| (entry - last) as f64 * ENTRY_S);
            let left = differs.slerp(DQuat::IDENTITY, smooth(since_s / SETTLING_S));
            table.push(left * planned_at(entry));
        }
    }

    /// Finds the curve from the last executed knot to the imagined end.
    fn solve(&mut self, imagined: &Placed) {
        let open_from = self.placed.prints.len() - OPEN;
        let before = self.placed.prints[open_from.saturating_sub(2)..open_from].to_vec();
        let placed = Placed {
            prints: before.into_iter().chain(imagined.prints.iter().copied()).collect(),
            ..*imagined
        };
        let from_s = self.executed.times_s.last().copied().unwrap_or(f64::NEG_INFINITY);
        let clipped = |stance: Stance| Stance { from_s: stance.from_s.max(from_s), ..stance };
        let stances: Vec<Stance> = stances(&self.model, &placed)
            .into_iter()
            .map(clipped)
            .filter(|stance| stance.to_s > from_s)
            .collect();
        let begins = self.executed.knots.is_empty();
        let stands = begins && self.placed.prints[1].strike_s <= 0.0;
        let problem =
            Problem::new(&stances, placed.end_s, &self.orientation, self.weights).at_rest([stands, false]);
        let mut knots = problem.start();
        if let (Some(first), Some(executed)) = (knots.first_mut(), self.executed.knots.last()) {
            *first = *executed;
        }
        let free = usize::from(!begins)..knots.len();
        let mut chain = Chain { problem: &problem, knots, free };
        chain.swing();
        let (knots, _, _) = minimize(chain, From::FarOff);
        self.found = Trajectory { times_s: problem.times_s().to_vec(), knots };
    }

    /// Executes what was found up to the footfall of the last print but one.
    fn execute(&mut self) {
        let prints = &self.placed.prints;
        let until_s = prints[prints.len() - 2].strike_s;
        let from_s = self.executed.times_s.last().copied().unwrap_or(f64::NEG_INFINITY);
        for (time_s, knot) in self.found.times_s.iter().zip(&self.found.knots) {
            if *time_s > from_s && *time_s <= until_s {
                self.executed.times_s.push(*time_s);
                self.executed.knots.push(*knot);
            }
        }
        let Some(&executed_s) = self.executed.times_s.last() else { return };
        let entries = (executed_s / ENTRY_S).ceil() as usize + 1;
        self.turned = entries.min(self.orientation.world_from_body.len()).max(self.turned);
        let is_executed = |print: &&PlacedPrint| print.strike_s <= executed_s;
        let lift_off_s = |foot: Foot| {
            let last = prints.iter().rev().filter(|print| print.foot == foot).find(is_executed);
            last.map_or(f64::NEG_INFINITY, |print| print.lift_off_s)
        };
        let [left_s, right_s] = Foot::BIPED.map(lift_off_s);
        let final_s = executed_s.min(left_s).min(right_s);
        if final_s >= self.final_s.unwrap_or(0.0) {
            self.final_s = Some(final_s);
        }
    }
}

/// A print after the last three: the step to it mirrors the last step, but for a leap, which nobody repeats who has not done so before.
fn imagined(open: &[Print], rule: &TimingRule) -> Option<Print> {
    let [before, other, last] = *open else { return None };
    let [from, over, to] = [before, other, last].map(|print| DVec2::from_array(print.at_m));
    let [before_m, last_m] = [from.distance(over), over.distance(to)];
    let length_m = if rule.leaps(last_m) { last_m.min(before_m) } else { last_m };
    let turn_rad = wrapped((last.heading_deg - other.heading_deg).to_radians());
    let middle_rad = other.heading_deg.to_radians() + turn_rad / 2.0;
    let aside_rad = heading_of(to - over) - middle_rad;
    let at = to + length_m * ahead(middle_rad + turn_rad - aside_rad);
    let heading_deg = (last.heading_deg.to_radians() + turn_rad).to_degrees();
    Some(Print { foot: other.foot, at_m: at.to_array(), heading_deg, timing: None })
}

#[cfg(test)]
mod tests;
