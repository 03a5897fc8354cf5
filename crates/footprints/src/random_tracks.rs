//! Tracks by chance, for tests, benchmarks and hostile trials: equal seeds give equal tracks, and all of them can be placed.

use glam::DVec2;
use muybridge_core::Random;

use crate::lay::{beside, setting_out};
use crate::model::{MODEL_NAMES, Model};
use crate::terrain::{Terrain, direction};
use crate::timing::{StepTiming, strikes, timings};
use crate::track::{Foot, Print, Track};

/// m/s².
const GRAVITY_M_S2: f64 = 9.81;
/// Steps of a track: 2 to 24.
const STEPS: [f64; 2] = [2.0, 25.0];
/// Stances that were drawn longer are cut to this share of the time to the same foot's next fall.
const MOST_DUTY_FACTOR: f64 = 0.85;
/// A figure that has hopped on two feet stands on them for so many step times.
const REST: f64 = 1.2;
/// Prints on level ground before stairs.
const BEFORE_STAIRS: usize = 2;

/// Kinds of tracks, and models on two legs, which come first.
const KINDS: u64 = Kind::ALL.len() as u64;
const BIPEDS: u64 = MODEL_NAMES.len() as u64 - 1;

/// What a track shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Walk,
    Run,
    HopsOnOneFoot,
    HopsOnTwoFeet,
    Turns,
    Stairs,
    SpiralStairs,
    Slope,
}

impl Kind {
    const ALL: [Self; 8] = [
        Self::Walk,
        Self::Run,
        Self::HopsOnOneFoot,
        Self::HopsOnTwoFeet,
        Self::Turns,
        Self::Stairs,
        Self::SpiralStairs,
        Self::Slope,
    ];

    fn name(self) -> &'static str {
        match self {
            Self::Walk => "walk",
            Self::Run => "run",
            Self::HopsOnOneFoot => "hops on one foot",
            Self::HopsOnTwoFeet => "hops on two feet",
            Self::Turns => "turns",
            Self::Stairs => "stairs",
            Self::SpiralStairs => "spiral stairs",
            Self::Slope => "slope",
        }
    }

    fn is_walked(self) -> bool {
        !matches!(self, Self::Run | Self::HopsOnOneFoot | Self::HopsOnTwoFeet)
    }

    /// Least and greatest step, in steps of the model.
    fn steps(self) -> [f64; 2] {
        match self {
            Self::Run => [1.4, 2.2],
            Self::HopsOnOneFoot | Self::HopsOnTwoFeet => [0.3, 1.2],
            _ => [0.7, 1.1],
        }
    }

    /// Least and greatest step time, in times in which a body falls over half its leg's length and a little more: sqrt(l / g).
    fn step_times(self) -> [f64; 2] {
        match self {
            Self::Run => [1.0, 1.3],
            Self::HopsOnOneFoot | Self::HopsOnTwoFeet => [1.3, 1.9],
            _ => [1.4, 2.0],
        }
    }

    /// Least and greatest stance time, in step times.
    fn stance_shares(self) -> [f64; 2] {
        match self {
            Self::Run => [0.5, 0.75],
            Self::HopsOnOneFoot | Self::HopsOnTwoFeet => [0.5, 0.65],
            _ => [1.1, 1.35],
        }
    }

    /// Most degrees a step turns by.
    fn most_turn_deg(self) -> f64 {
        match self {
            Self::Turns => 35.0,
            Self::Stairs | Self::SpiralStairs => 0.0,
            _ => 4.0,
        }
    }
}

/// A track of 2 to 24 steps that a seed chooses: a bird, a dinosaur or a human walks, runs, hops, turns, goes up or down stairs or a
/// slope, with times of its own, automatic ones, or both. Of 24 seeds in a row each kind is once each model's.
///
/// Its name says what it shows. Lengths and times are those of the model. Should the model be missing, the track is without prints.
pub fn random_track(seed: u64) -> Track {
    let mut random = Random::new(seed);
    let kind = Kind::ALL[(seed % KINDS) as usize];
    let name = MODEL_NAMES[(seed / KINDS % BIPEDS) as usize];
    let mut track = Track::new(name);
    let Some(model) = Model::named(name) else { return track };
    track.name = Some(format!("{} {seed}", kind.name()));
    let steps = random.between(STEPS[0], STEPS[1]) as usize;
    let mut draw = Draw::new(random, kind, &model);
    let (line, terrain) = draw.line(steps);
    track.terrain = terrain;
    track.prints = draw.prints(&line);
    draw.time(&mut track.prints);
    settle(&mut track, &model);
    track
}

/// Where the figure is at each step, and its direction.
type Line = Vec<(DVec2, DVec2)>;

struct Draw {
    random: Random,
    kind: Kind,
    /// Step length, metres.
    step_m: f64,
    /// Distance of the feet's lines, metres.
    width_m: f64,
    /// Comfortable leg, metres.
    leg_m: f64,
    /// A step's times, before chance varies them.
    timing: StepTiming,
    /// Whether the figure stands on both feet first.
    stands_first: bool,
}

impl Draw {
    fn new(mut random: Random, kind: Kind, model: &Model) -> Self {
        let [step_m, width_m] = model.step_m;
        let leg_m = model.leg.nominal_m;
        let mut within = |[least, most]: [f64; 2]| random.between(least, most);
        let step_time_s = within(kind.step_times()) * (leg_m / GRAVITY_M_S2).sqrt();
        let stance_time_s = within(kind.stance_shares()) * step_time_s;
        let step_m = within(kind.steps()) * step_m;
        let stands_first = kind.is_walked() && random.uniform() < 0.5;
        let timing = StepTiming { stance_time_s, step_time_s };
        Self { random, kind, step_m, width_m, leg_m, timing, stands_first }
    }

    /// The line on which the figure goes, and the ground.
    fn line(&mut self, steps: usize) -> (Line, Terrain) {
        let places = match self.kind {
            Kind::HopsOnTwoFeet => steps.div_ceil(2).max(2),
            _ if self.stands_first => steps,
            _ => steps + 1,
        };
        let towards_deg = rounded(self.random.between(-180.0, 180.0), 10.0);
        let from = [self.random.between(-5.0, 5.0), self.random.between(-5.0, 5.0)];
        let from = DVec2::from(from.map(|place_m| rounded(place_m, 100.0)));
        match self.kind {
            Kind::SpiralStairs => self.around(places, from, towards_deg),
            Kind::Stairs => (self.onward(places, from, towards_deg), self.stairs(places, from, towards_deg)),
            Kind::Slope => {
                let rise_deg = rounded(self.random.between(3.0, 12.0), 10.0);
                let towards = rounded(self.random.between(-180.0, 180.0), 10.0);
                let slope = Terrain::Slope { rise_deg, towards_deg: towards };
                (self.onward(places, from, towards_deg), slope)
            }
            _ => (self.onward(places, from, towards_deg), Terrain::Flat),
        }
    }

    /// Step after step, turning a little more or less each time.
    fn onward(&mut self, places: usize, from: DVec2, towards_deg: f64) -> Line {
        let most_deg = self.kind.most_turn_deg();
        let (mut at, mut heading_deg, mut turn_deg) = (from, towards_deg, 0.0);
        (0..places)
            .map(|_| {
                let here = (at, direction(heading_deg));
                turn_deg = 0.5 * (turn_deg + self.random.between(-most_deg, most_deg));
                heading_deg += turn_deg;
                at += direction(heading_deg) * self.step_m * self.random.between(0.97, 1.03);
                here
            })
            .collect()
    }

    /// Stairs with a step on each tread.
    fn stairs(&mut self, places: usize, from: DVec2, towards_deg: f64) -> Terrain {
        let before_m = (BEFORE_STAIRS as f64 - 0.5) * self.step_m;
        let from_m = from + direction(towards_deg) * before_m;
        let steps = places.saturating_sub(BEFORE_STAIRS + 1).max(1) as u32;
        let (tread_m, rise_m) = (rounded(self.step_m, 1000.0), self.rise_m());
        Terrain::Stairs { tread_m, rise_m, steps, towards_deg, from_m: from_m.to_array().map(at_m) }
    }

    /// A walk up or down a spiral staircase, a step on each tread.
    fn around(&mut self, places: usize, from: DVec2, towards_deg: f64) -> (Line, Terrain) {
        let per_turn = (self.random.between(12.0, 20.0) as usize).max(places + 3);
        let each_deg = 360.0 / per_turn as f64;
        let radius_m = self.step_m / each_deg.to_radians();
        let clockwise = self.random.uniform() < 0.5;
        let side = if clockwise { -1.0 } else { 1.0 };
        let angle_deg = |step: f64| towards_deg + side * each_deg * step;
        let line = (0..places)
            .map(|i| {
                let angle_deg = angle_deg(i as f64);
                (from + direction(angle_deg) * radius_m, direction(angle_deg + side * 90.0))
            })
            .collect();
        let treads = places.saturating_sub(BEFORE_STAIRS).max(1);
        let terrain = Terrain::SpiralStairs {
            centre_m: from.to_array(),
            inner_m: rounded(0.4 * radius_m, 1000.0),
            outer_m: rounded(1.6 * radius_m, 1000.0),
            steps_per_turn: per_turn as u32,
            rise_m: self.rise_m(),
            turns: rounded(treads as f64 / per_turn as f64, 10_000.0),
            from_deg: rounded(angle_deg(BEFORE_STAIRS as f64 - 0.5), 10.0),
            clockwise,
        };
        (line, terrain)
    }

    /// Rise of a stair, up or down, metres: up to a fifth of the leg.
    fn rise_m(&mut self) -> f64 {
        let up = if self.random.uniform() < 0.65 { 1.0 } else { -1.0 };
        rounded(up * self.random.between(0.08, 0.2) * self.leg_m, 1000.0)
    }

    /// The prints on a line, without times.
    fn prints(&mut self, line: &Line) -> Vec<Print> {
        let first = usize::from(self.random.uniform() < 0.5);
        let foot = |step: usize| Foot::BIPED[(first + step) % 2];
        let mut prints = Vec::with_capacity(2 * line.len());
        for (i, (middle, ahead)) in line.iter().enumerate() {
            let feet = match self.kind {
                Kind::HopsOnTwoFeet => vec![foot(0), foot(1)],
                Kind::HopsOnOneFoot => vec![foot(0)],
                _ if self.stands_first && i == 0 => vec![foot(1), foot(0)],
                _ => vec![foot(i)],
            };
            for foot in feet {
                let (place_m, heading_deg) = beside(*middle, *ahead, foot, self.width_m);
                let heading_deg = rounded(heading_deg + self.random.between(-4.0, 4.0), 10.0);
                prints.push(Print { foot, at_m: place_m.map(at_m), heading_deg, timing: None });
            }
        }
        prints
    }

    /// Gives all prints times, or none, or some. The last two stand to the end; where the figure hops on two feet they have times
    /// that say so, for of two feet that fall together the first one always has some.
    fn time(&mut self, prints: &mut [Print]) {
        let share = pick(&mut self.random, &[0.0, 0.5, 1.0]);
        let pairs = self.kind == Kind::HopsOnTwoFeet;
        let rest_s = REST * self.timing.step_time_s;
        let count = prints.len();
        for (i, print) in prints.iter_mut().enumerate() {
            let vary = self.random.between(0.95, 1.05);
            let (own, first, last) = (self.random.uniform() < share, i % 2 == 0, i + 2 >= count);
            let timed = if pairs { own || first || last } else { own && !last };
            let stance_time_s = if last { rest_s } else { self.timing.stance_time_s * vary };
            let until_next_s = if last { rest_s } else { self.timing.step_time_s * vary };
            let step_time_s = if pairs && first { 0.0 } else { until_next_s };
            print.timing = timed.then_some(StepTiming { stance_time_s, step_time_s });
        }
        if self.stands_first {
            for (print, timing) in prints.iter_mut().zip(setting_out(self.timing)) {
                print.timing = Some(timing);
            }
        }
    }
}

/// Shortens stances that would not end before the same foot's next fall, and writes times in whole milliseconds.
fn settle(track: &mut Track, model: &Model) {
    for print in &mut track.prints {
        print.timing = print.timing.map(|timing| StepTiming {
            stance_time_s: rounded(timing.stance_time_s, 1000.0),
            step_time_s: rounded(timing.step_time_s, 1000.0),
        });
    }
    let strikes_s = strikes(&timings(&track.prints, &model.timing, &track.terrain));
    let mut next_of_foot: [Option<f64>; 4] = [None; 4];
    for (print, strike_s) in track.prints.iter_mut().zip(strikes_s).rev() {
        let next_s = next_of_foot[print.foot.index()].replace(strike_s);
        if let (Some(timing), Some(next_s)) = (&mut print.timing, next_s) {
            let most_s = (MOST_DUTY_FACTOR * (next_s - strike_s) * 1000.0).floor() / 1000.0;
            timing.stance_time_s = timing.stance_time_s.min(most_s);
        }
    }
}

fn pick<T: Copy>(random: &mut Random, from: &[T]) -> T {
    from[(random.uniform() * from.len() as f64) as usize]
}

/// A number in so many parts of one, so that files are short.
fn rounded(number: f64, parts: f64) -> f64 {
    (number * parts).round() / parts
}

/// A place in tenths of a millimetre, metres.
fn at_m(place_m: f64) -> f64 {
    rounded(place_m, 10_000.0)
}

#[cfg(test)]
mod tests;
