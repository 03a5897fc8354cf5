//! Prints on the ground, at their times.

use glam::{DMat3, DQuat, DVec3};

use crate::bounds::{
    HEADING_DEG, LEAST_TIME_S, LONGEST_MOTION_S, MOST_PRINTS, PLACE_M, SAME_TIME_S, out_of_range,
};
use crate::terrain::{Terrain, direction};
use crate::timing::{StepTiming, TimingRule, strikes, timings};
use crate::track::{Foot, Print, Track, TrackError};

/// Most faults that are listed.
const MOST_FAULTS: usize = 20;

/// A print on the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlacedPrint {
    /// Which foot.
    pub foot: Foot,
    /// Middle of the print on the ground, world space, metres.
    pub middle: DVec3,
    /// Turns the foot's frame (X to the toes, Y up from the ground, Z right) into world space.
    pub world_from_foot: DQuat,
    /// Footfall, s after the first one.
    pub strike_s: f64,
    /// When the foot leaves the ground, s; at the latest the end of the motion.
    pub lift_off_s: f64,
}

/// A whole track on the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Placed {
    /// In the order of their footfalls.
    pub prints: Vec<PlacedPrint>,
    /// End of the motion, s.
    pub end_s: f64,
}

impl Track {
    /// The prints on the ground at their times; those without times get the rule's.
    ///
    /// Two footfalls, a footfall and a lift-off, and each of them and the end are at the same time or a millisecond and more apart:
    /// what is between them is long enough for a curve. No reach is checked: what the legs cannot do is the motion's to show.
    ///
    /// # Errors
    /// Everything that keeps the track from being walked, each in a sentence that names the print (from 1).
    pub fn place(&self, rule: &TimingRule) -> Result<Placed, TrackError> {
        ended(self.number_faults(rule))?;
        let timings = timings(&self.prints, rule, &self.terrain);
        let strikes_s = strikes(&timings);
        ended(self.time_faults(&timings, &strikes_s))?;
        let end_s = end_s(&timings, &strikes_s);
        let place = |(i, print): (usize, &Print)| PlacedPrint {
            foot: print.foot,
            middle: self.terrain.on_ground(print.at_m),
            world_from_foot: world_from_foot(print, &self.terrain),
            strike_s: strikes_s[i],
            lift_off_s: lift_off_s(strikes_s[i] + timings[i].stance_time_s, &strikes_s, end_s),
        };
        Ok(Placed { prints: self.prints.iter().enumerate().map(place).collect(), end_s })
    }

    /// What is wrong with the numbers, each by itself.
    fn number_faults(&self, rule: &TimingRule) -> Vec<String> {
        let count = self.prints.len();
        if count == 0 {
            return vec!["the track has no prints; add one, or a path along which they are laid".into()];
        }
        if count > MOST_PRINTS {
            return vec![format!("the track has {count} prints; {MOST_PRINTS} are the most: take some away")];
        }
        let automatic = self.prints.iter().any(|print| print.timing.is_none());
        let mut faults: Vec<String> = [
            self.terrain.fault(),
            rule.fault().filter(|_| automatic).map(|fault| format!("timing: {fault}")),
            self.weights.fault(),
        ]
        .into_iter()
        .flatten()
        .collect();
        let biped = self.prints[0].foot.is_biped();
        for (i, print) in self.prints.iter().enumerate() {
            faults.extend(print_faults(print, biped).map(|fault| named(i, print.foot, &fault)));
        }
        faults
    }

    /// What is wrong with the times together.
    fn time_faults(&self, timings: &[StepTiming], strikes_s: &[f64]) -> Vec<String> {
        let mut faults = Vec::new();
        let mut next_of_foot: [Option<usize>; 4] = [None; 4];
        for (i, print) in self.prints.iter().enumerate().rev() {
            let Some(next) = next_of_foot[print.foot.index()].replace(i) else { continue };
            let until_s = strikes_s[next] - strikes_s[i];
            let own_stance_s = print.timing.map(|timing| timing.stance_time_s);
            let fault = again_too_soon(own_stance_s, until_s, next);
            faults.extend(fault.map(|fault| named(i, print.foot, &fault)));
        }
        faults.reverse();
        if let (Some(last), Some(print)) = (timings.last(), self.prints.last())
            && last.step_time_s < LEAST_TIME_S
        {
            let fault = "the motion ends with its footfall; give the last print a step_time_s above 0";
            faults.push(named(self.prints.len() - 1, print.foot, fault));
        }
        let end_s = end_s(timings, strikes_s);
        if end_s > LONGEST_MOTION_S {
            let said = format!("the motion takes {end_s:.0} s; {LONGEST_MOTION_S} s are the most");
            faults.push(format!("{said}: give the prints less step_time_s"));
        }
        faults
    }
}

/// A print's own faults.
pub(crate) fn print_faults(print: &Print, biped: bool) -> impl Iterator<Item = String> {
    let [x_m, z_m] = print.at_m;
    let of_another_kind = "is of another kind than print 1's foot; \
                           use L and R, or LF, RF, LH and RH, throughout";
    let untimed_hoof = "has no times, and distances do not say them for four feet; \
                        give it timing, or lay the prints along a path";
    [
        (print.foot.is_biped() != biped).then(|| of_another_kind.into()),
        out_of_range("at_m: x", x_m, &PLACE_M, "m"),
        out_of_range("at_m: z", z_m, &PLACE_M, "m"),
        out_of_range("heading_deg", print.heading_deg, &HEADING_DEG, "degrees"),
        print.timing.and_then(|timing| timing.fault()),
        (print.timing.is_none() && !print.foot.is_biped()).then(|| untimed_hoof.into()),
    ]
    .into_iter()
    .flatten()
}

/// The fault of a foot that falls again, at print `next`, before or as it lifts; its stance when that is not automatic.
fn again_too_soon(own_stance_s: Option<f64>, until_s: f64, next: usize) -> Option<String> {
    let number = next + 1;
    if until_s < LEAST_TIME_S {
        return Some(format!(
            "the same foot falls at the same time as print {number}; \
             give one of the prints up to there more step_time_s"
        ));
    }
    let most_s = until_s - LEAST_TIME_S;
    let stance_time_s = own_stance_s.filter(|stance_s| *stance_s > most_s)?;
    Some(format!(
        "it stands for {stance_time_s} s, but its foot falls again {until_s:.3} s later, at print {number}; \
         give it at most {most_s:.3} s of stance_time_s, or the prints up to there more step_time_s"
    ))
}

/// A fault of a print, with its number and its foot.
fn named(print: usize, foot: Foot, fault: &str) -> String {
    format!("print {} ({}): {fault}", print + 1, foot.abbreviation())
}

/// Ends with faults, if there are some; the first twenty of them.
fn ended(mut faults: Vec<String>) -> Result<(), TrackError> {
    if faults.is_empty() {
        return Ok(());
    }
    let more = faults.len().saturating_sub(MOST_FAULTS);
    if more > 0 {
        faults.truncate(MOST_FAULTS);
        faults.push(format!("... and {more} more"));
    }
    Err(TrackError::Faults(faults))
}

fn end_s(timings: &[StepTiming], strikes_s: &[f64]) -> f64 {
    strikes_s.last().zip(timings.last()).map_or(0.0, |(strike_s, last)| strike_s + last.step_time_s)
}

/// A lift-off, put on the footfall or the end that is at the same time.
pub(crate) fn lift_off_s(lift_off_s: f64, strikes_s: &[f64], end_s: f64) -> f64 {
    if lift_off_s > end_s - SAME_TIME_S {
        return end_s;
    }
    let after = strikes_s.partition_point(|strike_s| *strike_s < lift_off_s - SAME_TIME_S);
    strikes_s
        .get(after)
        .copied()
        .filter(|strike_s| *strike_s < lift_off_s + SAME_TIME_S)
        .unwrap_or(lift_off_s)
}

/// A foot on the ground: its toes point where the print does in the plan, its sole lies on the ground.
pub(crate) fn world_from_foot(print: &Print, terrain: &Terrain) -> DQuat {
    let (_, up) = terrain.at(print.at_m[0], print.at_m[1]);
    let ahead = direction(print.heading_deg);
    let rise = -(up.x * ahead.x + up.z * ahead.y) / up.y;
    let toes = DVec3::new(ahead.x, rise, ahead.y).normalize_or(DVec3::X);
    DQuat::from_mat3(&DMat3::from_cols(toes, up, toes.cross(up)))
}

#[cfg(test)]
mod tests;
