//! Times of steps from their distances (van de Panne 1997, 4.1 and Fig. 12).
//!
//! The distance to the next print says when it is struck and how long this one stands. Where the stance is the longer of the two, both
//! feet are down in between, and that is a walk; where it is the shorter one, there is a flight. Three things that the paper leaves
//! open keep this sensible where distances differ and feet do not take turns:
//!
//! - A foot is in the air for a quarter of the time to its own next footfall or more, for it has a way to go. So hops on one foot are
//!   flights however small they are.
//! - A foot is lifted no later than the other foot, which fell after it: before a leap nobody stays behind.
//! - The last print of a foot stands to the end, where the figure comes to rest; unless the other foot leaps away from it.

use std::ops::RangeInclusive;

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::bounds::{LEAST_TIME_S, MOST_TIME_S, PLACE_M, SAME_TIME_S, out_of_range};
use crate::terrain::Terrain;
use crate::track::Print;

/// Greatest share of the time between two footfalls of a foot for which it stands: in slow walks of two-legged animals the stance
/// takes about 0.7 of the stride.
const MOST_DUTY_FACTOR: f64 = 0.75;
const MOST_PIECES: usize = 1000;
const STANCE_TIME_S: RangeInclusive<f64> = LEAST_TIME_S..=MOST_TIME_S;

/// The two times of a footprint: its timing dagger.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StepTiming {
    /// How long the foot stands, s; 0.01 to 600.
    pub stance_time_s: f64,
    /// Time from this footfall to the next one of any foot, s; of the last print: to the end of the motion. 0 to 600; less
    /// than a millisecond is together.
    pub step_time_s: f64,
}

impl StepTiming {
    /// What is wrong with its numbers, as a sentence that says what they must be.
    pub fn fault(&self) -> Option<String> {
        out_of_range("stance_time_s", self.stance_time_s, &STANCE_TIME_S, "s")
            .or_else(|| out_of_range("step_time_s", self.step_time_s, &(0.0..=MOST_TIME_S), "s"))
    }
}

/// Stance and step time as functions of the distance between successive prints, in pieces of straight lines.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TimingRule {
    /// Distances (m, rising) with the step time (s) at each.
    pub step_times: Vec<[f64; 2]>,
    /// Distances (m, rising) with the stance time (s) at each. Where it is shorter than the step time there is a flight.
    pub stance_times: Vec<[f64; 2]>,
}

impl TimingRule {
    /// Both times for a distance, metres; held at both ends.
    pub fn timing(&self, distance_m: f64) -> StepTiming {
        StepTiming {
            stance_time_s: held(&self.stance_times, distance_m),
            step_time_s: held(&self.step_times, distance_m),
        }
    }

    /// Whether a step of a distance (m) is a leap: a flight without a foot on the ground.
    pub fn leaps(&self, distance_m: f64) -> bool {
        let timing = self.timing(distance_m);
        timing.stance_time_s < timing.step_time_s
    }

    /// What is wrong with its numbers, as a sentence that says what they must be.
    pub fn fault(&self) -> Option<String> {
        pieces_fault("step_times", &self.step_times)
            .or_else(|| pieces_fault("stance_times", &self.stance_times))
    }
}

/// The value at a place of pieces of straight lines, held at both ends; the shortest time where there are none.
fn held(pieces: &[[f64; 2]], at: f64) -> f64 {
    let after = pieces.partition_point(|[place, _]| *place <= at);
    match (after.checked_sub(1).and_then(|before| pieces.get(before)), pieces.get(after)) {
        (Some([from, value]), Some([to, next])) => value + (next - value) * (at - from) / (to - from),
        (Some([_, value]), None) | (None, Some([_, value])) => *value,
        (None, None) => LEAST_TIME_S,
    }
}

fn pieces_fault(name: &str, pieces: &[[f64; 2]]) -> Option<String> {
    if pieces.is_empty() || pieces.len() > MOST_PIECES {
        let count = pieces.len();
        return Some(format!(
            "{name} has {count} distances; it must have at least one and at most {MOST_PIECES}"
        ));
    }
    let number = |[distance_m, time_s]: &[f64; 2]| {
        out_of_range(&format!("a distance in {name}"), *distance_m, &(0.0..=*PLACE_M.end()), "m")
            .or_else(|| out_of_range(&format!("a time in {name}"), *time_s, &STANCE_TIME_S, "s"))
    };
    pieces.iter().find_map(number).or_else(|| {
        let falls = pieces.windows(2).find(|pair| pair[1][0] <= pair[0][0])?;
        let (first, next) = (falls[0][0], falls[1][0]);
        Some(format!("the distances in {name} must rise, but {next} m comes after {first} m"))
    })
}

/// The times of all prints: their own, or the rule's where they have none.
pub(crate) fn timings(prints: &[Print], rule: &TimingRule, terrain: &Terrain) -> Vec<StepTiming> {
    let places: Vec<DVec3> = prints.iter().map(|print| terrain.on_ground(print.at_m)).collect();
    let mut timings = by_distance(prints, &places, rule);
    let strikes_s = strikes(&timings);
    let end_s = strikes_s.last().zip(timings.last()).map_or(0.0, |(strike, last)| strike + last.step_time_s);
    let mut next_of_foot: [Option<f64>; 4] = [None; 4];
    for i in (0..prints.len()).rev() {
        let foot = prints[i].foot;
        let next_own_s = next_of_foot[foot.index()].replace(strikes_s[i]);
        if prints[i].timing.is_some() {
            continue;
        }
        let left_behind = || places[i + 1..].iter().any(|place| rule.leaps(places[i].distance(*place)));
        let stance_time_s = &mut timings[i].stance_time_s;
        if next_own_s.is_none() && !left_behind() {
            *stance_time_s = end_s - strikes_s[i];
            continue;
        }
        let until_own_s = next_own_s.map_or(f64::INFINITY, |next_s| next_s - strikes_s[i]);
        *stance_time_s = stance_time_s.min(MOST_DUTY_FACTOR * until_own_s);
        if let Some(next) = timings.get(i + 1).filter(|_| prints[i + 1].foot != foot) {
            let next_lifts_s = timings[i].step_time_s + next.stance_time_s;
            timings[i].stance_time_s = timings[i].stance_time_s.min(next_lifts_s);
        }
    }
    timings
}

/// Footfalls, s after the first one. Those within a millisecond are one.
pub(crate) fn strikes(timings: &[StepTiming]) -> Vec<f64> {
    let (mut time_s, mut strike_s) = (0.0, 0.0);
    timings
        .iter()
        .map(|timing| {
            if time_s - strike_s >= SAME_TIME_S {
                strike_s = time_s;
            }
            time_s += timing.step_time_s;
            strike_s
        })
        .collect()
}

/// The prints' own times, or those of the distance to the next print: of the last print, of the distance from the one before it, with
/// time to come to rest in.
fn by_distance(prints: &[Print], places: &[DVec3], rule: &TimingRule) -> Vec<StepTiming> {
    let distance_m = |from: usize| places.get(from + 1).map(|next| places[from].distance(*next));
    let of = |i: usize| match distance_m(i) {
        Some(distance_m) => rule.timing(distance_m),
        None => {
            let timing = rule.timing(i.checked_sub(1).and_then(distance_m).unwrap_or(0.0));
            StepTiming { step_time_s: timing.step_time_s.max(timing.stance_time_s), ..timing }
        }
    };
    prints.iter().enumerate().map(|(i, print)| print.timing.unwrap_or_else(|| of(i))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::track::Foot;

    /// Walks up to 1 m, leaps beyond.
    fn rule() -> TimingRule {
        TimingRule {
            step_times: vec![[0.2, 0.4], [1.0, 0.5], [3.0, 0.9]],
            stance_times: vec![[0.2, 0.6], [1.0, 0.5], [3.0, 0.3]],
        }
    }

    fn prints(feet: &str, places_m: &[f64]) -> Vec<Print> {
        let foot = |letter: char| if letter == 'L' { Foot::Left } else { Foot::Right };
        let print = |(letter, x_m): (char, &f64)| Print {
            foot: foot(letter),
            at_m: [*x_m, 0.0],
            heading_deg: 0.0,
            timing: None,
        };
        feet.chars().zip(places_m).map(print).collect()
    }

    fn lift_offs(timings: &[StepTiming]) -> Vec<f64> {
        strikes(timings)
            .iter()
            .zip(timings)
            .map(|(strike_s, timing)| strike_s + timing.stance_time_s)
            .collect()
    }

    #[test]
    fn times_lie_on_the_lines_and_are_held_at_the_ends() {
        let at = |distance_m: f64| {
            let timing = rule().timing(distance_m);
            [timing.step_time_s, timing.stance_time_s]
        };
        assert_eq!([at(0.0), at(0.2), at(50.0)], [[0.4, 0.6], [0.4, 0.6], [0.9, 0.3]]);
        let [step_s, stance_s] = at(2.0);
        assert!((step_s - 0.7).abs() < 1e-12 && (stance_s - 0.4).abs() < 1e-12);
        assert_eq!([0.9, 1.0, 1.1].map(|distance_m| rule().leaps(distance_m)), [false, false, true]);
    }

    #[test]
    fn a_walk_has_double_stances_and_ends_on_both_feet() {
        let prints = prints("LRLRL", &[0.0, 0.6, 1.1, 1.7, 2.3]);
        let timings = timings(&prints, &rule(), &Terrain::Flat);
        let (strikes_s, lifts_s) = (strikes(&timings), lift_offs(&timings));
        let end_s = strikes_s[4] + timings[4].step_time_s;
        for i in 0..3 {
            assert!(lifts_s[i] > strikes_s[i + 1], "the next foot falls before this one lifts");
            assert!(lifts_s[i] < strikes_s[i + 2], "and this one swings before it falls again");
        }
        assert!((lifts_s[3] - end_s).abs() < 1e-12 && (lifts_s[4] - end_s).abs() < 1e-12);
    }

    #[test]
    fn a_long_step_is_a_leap_with_nobody_left_behind() {
        let prints = prints("LRLRL", &[0.0, 0.25, 3.25, 3.75, 4.25]);
        let timings = timings(&prints, &rule(), &Terrain::Flat);
        let (strikes_s, lifts_s) = (strikes(&timings), lift_offs(&timings));
        assert!((timings[1].stance_time_s - 0.3).abs() < 1e-12);
        assert!(lifts_s[1] < strikes_s[2]);
        assert!(lifts_s[0] <= lifts_s[1]);
    }

    #[test]
    fn the_last_print_of_a_foot_that_the_other_one_leaps_from_does_not_stay_down() {
        let prints = prints("LRRR", &[0.0, 0.6, 1.6, 2.6]);
        let timings = timings(&prints, &rule(), &Terrain::Flat);
        let (strikes_s, lifts_s) = (strikes(&timings), lift_offs(&timings));
        assert!(lifts_s[0] < strikes_s[2], "the left foot leaves with the first hop");
        assert!(lifts_s[1] < strikes_s[2] && lifts_s[2] < strikes_s[3], "hops on one foot are flights");
        assert!((lifts_s[3] - strikes_s[3] - timings[3].step_time_s).abs() < 1e-12);
    }

    #[test]
    fn height_counts_as_distance() {
        let prints = prints("LRL", &[0.0, 0.5, 1.0]);
        let stairs =
            Terrain::Stairs { tread_m: 0.5, rise_m: 1.2, steps: 9, towards_deg: 0.0, from_m: [0.25, 0.0] };
        let climbing = timings(&prints, &rule(), &stairs);
        assert_eq!(climbing[0].step_time_s, rule().timing(1.3).step_time_s);
    }

    #[test]
    fn own_times_stay_as_they_are() {
        let mut prints = prints("LRLR", &[0.0, 0.5, 1.0, 1.5]);
        let own = StepTiming { stance_time_s: 0.7, step_time_s: 0.65 };
        prints[1].timing = Some(own);
        let timings = timings(&prints, &rule(), &Terrain::Flat);
        assert_eq!(timings[1], own);
        assert_eq!(timings[2].step_time_s, rule().timing(0.5).step_time_s);
    }

    #[test]
    fn feet_that_fall_within_a_millisecond_fall_together() {
        let steps = [0.5, 1e-12, 0.0006, 0.0006, 0.5]
            .map(|step_time_s| StepTiming { stance_time_s: 0.4, step_time_s });
        assert_eq!(strikes(&steps), [0.0, 0.5, 0.5, 0.5, 0.5 + 1e-12 + 0.0006 + 0.0006]);
    }

    #[test]
    fn one_print_and_none_have_times() {
        let one = timings(&prints("L", &[0.0]), &rule(), &Terrain::Flat);
        assert_eq!(one, [StepTiming { stance_time_s: 0.6, step_time_s: 0.6 }]);
        assert!(timings(&[], &rule(), &Terrain::Flat).is_empty());
    }

    #[test]
    fn rules_and_times_that_cannot_be_are_named() {
        assert_eq!(rule().fault(), None);
        let with = |step_times: Vec<[f64; 2]>| TimingRule { step_times, ..rule() };
        for (pieces, named) in [
            (vec![], "at least one"),
            (vec![[0.5, 0.4], [0.5, 0.5]], "must rise"),
            (vec![[0.5, -0.4]], "a time in step_times"),
            (vec![[f64::NAN, 0.4]], "a distance in step_times"),
            (vec![[0.5, f64::INFINITY]], "a time in step_times"),
        ] {
            let rule = with(pieces);
            assert!(rule.fault().unwrap().contains(named), "{:?}", rule.fault());
            let _ = rule.timing(0.7);
        }
        let timing = |stance_time_s: f64, step_time_s: f64| StepTiming { stance_time_s, step_time_s };
        assert_eq!(timing(0.5, 0.0).fault(), None);
        for (times, named) in [
            (timing(-0.5, 0.5), "stance_time_s is -0.5 s"),
            (timing(0.0, 0.5), "stance_time_s"),
            (timing(0.5, f64::NAN), "step_time_s"),
            (timing(0.5, -1e-9), "step_time_s"),
            (timing(601.0, 0.5), "600"),
        ] {
            assert!(times.fault().unwrap().contains(named), "{:?}", times.fault());
        }
    }
}
