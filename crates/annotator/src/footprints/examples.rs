//! Tracks to begin with: what the paper shows, and a horse.

use muybridge_core::Gait;
use muybridge_footprints::{
    Foot, Laying, Model, PathPoint, Print, River, StepTiming, Terrain, Track, TrackGait,
};

use super::edits::{direction, is_left, wrapped_deg};

/// Step length and width of a model that tells none, metres.
const STEP_M: [f64; 2] = [0.4, 0.2];

/// One who begins stands so long on the left foot and on the right one, and steps out after so long, s.
const STANDS_S: [f64; 3] = [0.5, 1.0, 0.8];
/// Rivers that are looked at for one that can be crossed.
const RIVERS: u64 = 20;

/// A track to begin with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Example {
    /// The paper's first figure.
    WalkingBird,
    /// A dinosaur goes up.
    Stairs,
    /// A turn, then leaps.
    Leaps,
    /// A person runs.
    Runner,
    /// The distances alone say when to leap.
    AutomaticTiming,
    /// A person along a path.
    Path,
    /// A horse along a path.
    Trot,
    /// From stone to stone.
    River,
    /// Nothing yet.
    Empty,
}

impl Example {
    /// All, with their names.
    pub const ALL: [(Self, &'static str); 9] = [
        (Self::WalkingBird, "Walking bird"),
        (Self::Stairs, "Dinosaur on stairs"),
        (Self::Leaps, "A turn and leaps"),
        (Self::Runner, "Running human"),
        (Self::AutomaticTiming, "Bird, timed by its distances"),
        (Self::Path, "Human along a path"),
        (Self::Trot, "Horse in trot along a path"),
        (Self::River, "Stepping stones across a river"),
        (Self::Empty, "No prints"),
    ];

    /// The track.
    pub fn track(self) -> Track {
        let mut track = match self {
            Self::WalkingBird => walking_bird(),
            Self::Stairs => stairs(),
            Self::Leaps => leaps(),
            Self::Runner => runner(),
            Self::AutomaticTiming => automatic_timing(),
            Self::Path => path(),
            Self::Trot => trot(),
            Self::River => river(),
            Self::Empty => return Track::new("bird"),
        };
        let name = Self::ALL.iter().find(|(example, _)| *example == self).map(|(_, name)| (*name).into());
        track.name = name;
        track
    }
}

/// One who lays prints.
struct Walker {
    at_m: [f64; 2],
    heading_deg: f64,
    half_width_m: f64,
    prints: Vec<Print>,
}

impl Walker {
    fn new(width_m: f64) -> Self {
        Self { at_m: [0.0; 2], heading_deg: 0.0, half_width_m: width_m / 2.0, prints: Vec::new() }
    }

    /// Stands on both feet, and lifts the left one first.
    fn stand(&mut self) {
        self.step(0.0, 0.0, timing(STANDS_S[0], 0.0));
        self.step(0.0, 0.0, timing(STANDS_S[1], STANDS_S[2]));
    }

    /// Turns, goes on, and sets a foot down.
    fn step(&mut self, length_m: f64, turn_deg: f64, timing: Option<StepTiming>) {
        self.heading_deg += turn_deg;
        let [x, z] = direction(self.heading_deg);
        self.at_m = [self.at_m[0] + length_m * x, self.at_m[1] + length_m * z];
        let foot = if self.prints.last().is_some_and(|last| last.foot == Foot::Left) {
            Foot::Right
        } else {
            Foot::Left
        };
        // To the right of the way is (-z, x).
        let aside_m = if is_left(foot) { -self.half_width_m } else { self.half_width_m };
        let at_m = [self.at_m[0] - aside_m * z, self.at_m[1] + aside_m * x];
        self.prints.push(Print { foot, at_m, heading_deg: wrapped_deg(self.heading_deg), timing });
    }
}

fn timing(stance_time_s: f64, step_time_s: f64) -> Option<StepTiming> {
    Some(StepTiming { stance_time_s, step_time_s })
}

fn step_m(model: &str) -> [f64; 2] {
    Model::named(model).map_or(STEP_M, |model| model.step_m)
}

fn track_of(model: &str, walker: Walker) -> Track {
    Track { prints: walker.prints, ..Track::new(model) }
}

fn walking_bird() -> Track {
    let [length_m, width_m] = step_m("bird");
    let mut walker = Walker::new(width_m);
    walker.stand();
    for i in 0..10 {
        walker.step(length_m, if (3..8).contains(&i) { 14.0 } else { 0.0 }, None);
    }
    walker.step(0.0, 0.0, None);
    track_of("bird", walker)
}

fn stairs() -> Track {
    let [length_m, width_m] = step_m("dinosaur");
    let mut walker = Walker::new(width_m);
    // One foot on each stair, each print in the middle of its tread.
    let (tread_m, steps) = (0.8 * length_m, 8);
    walker.stand();
    walker.step(length_m, 0.0, None);
    for _ in 0..steps + 2 {
        walker.step(tread_m, 0.0, None);
    }
    walker.step(0.0, 0.0, None);
    let from_m = [length_m + tread_m / 2.0, 0.0];
    let terrain = Terrain::Stairs { tread_m, rise_m: 0.16 * length_m, steps, towards_deg: 0.0, from_m };
    Track { terrain, ..track_of("dinosaur", walker) }
}

fn leaps() -> Track {
    let [length_m, width_m] = step_m("human");
    let mut walker = Walker::new(width_m);
    walker.stand();
    for _ in 0..3 {
        walker.step(0.8 * length_m, 20.0, timing(0.6, 0.5));
    }
    // The times of a print are those of the step from it: this one leaps.
    walker.step(0.8 * length_m, 20.0, timing(0.36, 0.6));
    walker.step(1.3 * length_m, 0.0, timing(0.32, 0.56));
    walker.step(1.3 * length_m, 0.0, timing(0.32, 0.56));
    walker.step(1.3 * length_m, 0.0, timing(0.36, 0.34));
    walker.step(0.8 * length_m, 0.0, timing(0.5, 0.4));
    walker.step(0.6 * length_m, 0.0, timing(0.9, 0.6));
    walker.step(0.0, 0.0, timing(0.6, 0.6));
    track_of("human", walker)
}

fn runner() -> Track {
    let [length_m, width_m] = step_m("human");
    let mut walker = Walker::new(0.6 * width_m);
    for _ in 0..11 {
        walker.step(1.75 * length_m, 0.0, timing(0.22, 0.34));
    }
    walker.step(1.75 * length_m, 0.0, timing(0.18, 0.18));
    track_of("human", walker)
}

fn automatic_timing() -> Track {
    let [length_m, width_m] = step_m("bird");
    let mut walker = Walker::new(width_m);
    walker.stand();
    for share in [1.0, 1.0, 1.0, 2.2, 1.0, 1.0, 0.7, 2.2, 1.0, 1.0] {
        walker.step(share * length_m, 0.0, None);
    }
    walker.step(0.0, 0.0, None);
    track_of("bird", walker)
}

fn laying(points_m: &[[f64; 2]]) -> Option<Laying> {
    let points = points_m.iter().map(|at_m| PathPoint { at_m: *at_m, tangent_m: None }).collect();
    Some(Laying { points, step_length_m: None, step_width_m: None, timing: None })
}

fn path() -> Track {
    let path = laying(&[[0.0, 0.0], [3.0, 0.0], [5.5, -1.5], [5.5, -4.5], [2.5, -5.5]]);
    Track { path, ..Track::new("human") }
}

fn trot() -> Track {
    let gait = Some(TrackGait { gait: Gait::Trot, speed_m_s: 4.6, lead: None });
    let path = laying(&[[0.0, 0.0], [7.0, 0.0], [13.0, -3.0], [16.0, -9.0]]);
    Track { gait, path, ..Track::new("horse") }
}

/// From stone to stone; of the first river that can be crossed.
fn river() -> Track {
    let Some(model) = Model::named("human") else { return Track::new("human") };
    let step_m = model.step_m[0];
    let crossing = (0..RIVERS).find_map(|seed| {
        let river = River::scattered(8.0 * step_m, 8.0 * step_m, 0.8 * step_m, seed).ok()?;
        river.cross(&model).ok()
    });
    Track { prints: crossing.unwrap_or_default(), ..Track::new("human") }
}
