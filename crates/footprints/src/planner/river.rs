//! Stepping stones across a river (van de Panne 1997, Fig. 13).
//!
//! The river flows along Z; one crosses it along X. A stone offers holds, places for the middle of a foot; the way across is a path
//! from hold to hold with alternate feet, and costs least that is short, has steps of the model's length, turns little and does not cross
//! its feet.

use glam::DVec2;
use muybridge_core::Random;
use serde::{Deserialize, Serialize};

use super::crossing::{Gauge, cross};
use crate::model::Model;
use crate::track::Print;

/// Most stones.
pub(super) const MOST_STONES: usize = 10_000;
/// Most holds on all stones together, so that the way across is found in bounded time.
const MOST_HOLDS: usize = 20_000;
/// A stone larger than so many of the longest leaps is an island: two rivers.
const MOST_RADIUS_LEAPS: f64 = 4.0;
/// A stone bears a foot when its radius is at least this share of half a foot's length; the middle of the foot comes that near to its rim.
const FOOT_SHARE: f64 = 0.5;
/// Farthest that anything is from the origin, metres.
const MOST_M: f64 = 10_000.0;
/// Share of the cells of [`River::scattered`] that have a stone, and how far it is from the middle of its cell, in cells.
const SCATTER: [f64; 2] = [0.85, 0.3];
/// Radii of scattered stones, in cells.
const RADII: [f64; 2] = [0.15, 0.35];

/// A stone to step on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stone {
    /// Its middle: x and z, metres.
    pub at_m: [f64; 2],
    /// Its radius, metres.
    pub radius_m: f64,
}

/// A river with stones.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct River {
    /// Where the near bank ends and the far bank begins: x, metres.
    pub banks_m: [f64; 2],
    /// The stones.
    pub stones: Vec<Stone>,
}

/// Why nobody comes across.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RiverError {
    /// Banks that are none.
    #[error(
        "the banks are at {near_m} m and {far_m} m; the far one must be beyond the near one, both within {MOST_M} m of the origin"
    )]
    Banks {
        /// Near bank, metres.
        near_m: f64,
        /// Far bank, metres.
        far_m: f64,
    },
    /// Lengths of scattered stones that are none.
    #[error(
        "the length of the river with stones and the side of a stone's square are {length_m} m and {cell_m} m; both must be above 0"
    )]
    Scatter {
        /// Length of the river, metres.
        length_m: f64,
        /// Side of the square, metres.
        cell_m: f64,
    },
    /// A stone that is none.
    #[error(
        "stone {number}: its place must be two numbers within {MOST_M} m, its radius above 0 and at most {most_m:.2} m; \
             cross to a larger one as to a bank"
    )]
    Stone {
        /// Which, from 1.
        number: usize,
        /// Largest radius, metres.
        most_m: f64,
    },
    /// Too many stones.
    #[error(
        "{stones} stones with {holds} places for a foot; {MOST_STONES} stones and {MOST_HOLDS} places are the most"
    )]
    TooMany {
        /// How many stones.
        stones: usize,
        /// How many places for a foot, as far as they were counted.
        holds: usize,
    },
    /// A model whose steps are no lengths.
    #[error("the model's step length, step width, foot and times of steps must be numbers above 0")]
    Model,
    /// There is no way.
    #[error(
        "no way over: stones can be reached up to x = {reached_m:.2} m, from there the next place for a foot is {gap_m:.2} m off, \
             and the longest leap is {leap_m:.2} m"
    )]
    NoWay {
        /// Farthest place that can be reached: x, metres.
        reached_m: f64,
        /// Least distance from a place that can be reached to one that cannot, the far bank among them, metres.
        gap_m: f64,
        /// Longest leap of the model, metres.
        leap_m: f64,
    },
}

impl River {
    /// A river of a width (m), the near bank at x = 0, with stones strewn over `length_m` of it about one in each square of `cell_m`.
    ///
    /// # Errors
    /// When the lengths cannot be, or there would be too many stones.
    pub fn scattered(width_m: f64, length_m: f64, cell_m: f64, seed: u64) -> Result<Self, RiverError> {
        let river = Self { banks_m: [0.0, width_m], stones: Vec::new() };
        river.checked_banks()?;
        if !(length_m > 0.0 && cell_m > 0.0) {
            return Err(RiverError::Scatter { length_m, cell_m });
        }
        let [across, along] = [width_m / cell_m, length_m / cell_m].map(f64::floor);
        let stones = across * along;
        if stones > MOST_STONES as f64 {
            return Err(RiverError::TooMany { stones: stones as usize, holds: stones as usize });
        }
        let mut random = Random::new(seed);
        let mut stones = Vec::new();
        for i in 0..across as usize {
            for j in 0..along as usize {
                // Drawn also where there is no stone: each stone is then the same whatever its neighbours are.
                let is_there = random.uniform() < SCATTER[0];
                let x = i as f64 + 0.5 + random.between(-SCATTER[1], SCATTER[1]);
                let z = j as f64 + 0.5 + random.between(-SCATTER[1], SCATTER[1]) - along / 2.0;
                let radius_m = cell_m * random.between(RADII[0], RADII[1]);
                stones.extend(is_there.then_some(Stone { at_m: [x * cell_m, z * cell_m], radius_m }));
            }
        }
        Ok(Self { stones, ..river })
    }

    /// Prints from standing on the near bank to standing on the far bank, feet alternating: steps where the stones allow them, leaps
    /// where they do not. Only the first two have times, those of setting out. Deterministic; stones too small for a foot are left alone.
    ///
    /// # Errors
    /// When the river or the model cannot be, or there is no way over.
    pub fn cross(&self, model: &Model) -> Result<Vec<Print>, RiverError> {
        let gauge = Gauge::of(model).ok_or(RiverError::Model)?;
        self.checked_banks()?;
        cross(self.banks_m, &self.holds(&gauge)?, &gauge, &model.timing)
    }

    fn checked_banks(&self) -> Result<(), RiverError> {
        let [near_m, far_m] = self.banks_m;
        let is_river = near_m.abs() <= MOST_M && far_m.abs() <= MOST_M && near_m < far_m;
        if is_river { Ok(()) } else { Err(RiverError::Banks { near_m, far_m }) }
    }

    /// Places for the middle of a foot, by rising x.
    fn holds(&self, gauge: &Gauge) -> Result<Vec<DVec2>, RiverError> {
        let most_m = MOST_RADIUS_LEAPS * gauge.leap_m;
        let is_stone = |stone: &Stone| {
            let is_near = stone.at_m.iter().all(|at_m| at_m.abs() <= MOST_M);
            is_near && stone.radius_m > 0.0 && stone.radius_m <= most_m
        };
        let too_many = |holds: usize| RiverError::TooMany { stones: self.stones.len(), holds };
        if self.stones.len() > MOST_STONES {
            return Err(too_many(self.stones.len()));
        }
        if let Some(stone) = self.stones.iter().position(|stone| !is_stone(stone)) {
            return Err(RiverError::Stone { number: stone + 1, most_m });
        }
        let mut holds = Vec::new();
        for stone in &self.stones {
            stone.add_holds(gauge, &mut holds);
            if holds.len() > MOST_HOLDS {
                return Err(too_many(holds.len()));
            }
        }
        holds.retain(|hold| hold.x > self.banks_m[0] && hold.x < self.banks_m[1]);
        holds.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
        Ok(holds)
    }
}

impl Stone {
    /// Its middle and, on a stone with room for more than one foot, a lattice of triangles about it, a step's width apart.
    fn add_holds(&self, gauge: &Gauge, holds: &mut Vec<DVec2>) {
        let room_m = self.radius_m - FOOT_SHARE * gauge.foot_m;
        if room_m < 0.0 {
            return;
        }
        // On a large stone wider: a quarter of its radius, which the longest leap always bridges.
        let apart_m = gauge.width_m.max(self.radius_m / MOST_RADIUS_LEAPS);
        let rows = (room_m / apart_m * 2.0 / 3f64.sqrt()).floor() as i64;
        for row in -rows..=rows {
            let up_m = row as f64 * apart_m * 3f64.sqrt() / 2.0;
            let shift_m = if row % 2 == 0 { 0.0 } else { apart_m / 2.0 };
            let columns = (room_m / apart_m).ceil() as i64;
            let along = (-columns..=columns).map(|column| column as f64 * apart_m + shift_m);
            let lattice = along.map(|along_m| DVec2::new(along_m, up_m));
            let on_stone = lattice.filter(|from_middle| from_middle.length() <= room_m);
            holds.extend(on_stone.map(|from_middle| DVec2::from_array(self.at_m) + from_middle));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planner::Planner;
    use crate::planner::tests::walker;
    use crate::problem::Weights;
    use crate::terrain::Terrain;
    use crate::track::{Foot, Track};

    fn stone(x: f64, z: f64) -> Stone {
        Stone { at_m: [x, z], radius_m: 0.1 }
    }

    fn leap_m() -> f64 {
        Gauge::of(&walker()).unwrap().leap_m
    }

    /// Prints alternate, start and end on the banks, stand on stones between, and none is farther than the longest leap.
    fn assert_is_way(river: &River, prints: &[Print]) {
        let [near_m, far_m] = river.banks_m;
        let at = |print: &Print| DVec2::from_array(print.at_m);
        for pair in prints.windows(2) {
            assert_ne!(pair[0].foot, pair[1].foot);
            assert!(at(&pair[0]).distance(at(&pair[1])) <= leap_m() + 1e-9);
        }
        let track = Track { prints: prints.to_vec(), ..Track::new("bird") };
        track.place(&walker().timing).unwrap();
        let mut planner = Planner::new(walker(), Terrain::Flat, Weights::default()).unwrap();
        prints.iter().for_each(|print| planner.push(*print).unwrap());
        let count = prints.len();
        assert!(prints[..2].iter().all(|print| print.at_m[0] < near_m));
        assert!(prints[count - 2..].iter().all(|print| print.at_m[0] > far_m));
        for print in &prints[2..count - 2] {
            let bears = |stone: &Stone| DVec2::from_array(stone.at_m).distance(at(print)) <= stone.radius_m;
            assert!(river.stones.iter().any(bears), "{print:?}");
        }
    }

    #[test]
    fn stones_as_far_apart_as_steps_are_walked_over() {
        let [step_m, width_m] = walker().step_m;
        let stones =
            (1..10).map(|i| stone(f64::from(i) * step_m, if i % 2 == 0 { -0.5 } else { 0.5 } * width_m));
        let river = River { banks_m: [0.0, 10.0 * step_m], stones: stones.collect() };
        let prints = river.cross(&walker()).unwrap();
        assert_is_way(&river, &prints);
        assert_eq!(prints.len(), 13, "every stone once, and two prints on each bank");
        for print in &prints[2..11] {
            let foot = if print.at_m[1] < 0.0 { Foot::Left } else { Foot::Right };
            assert_eq!(print.foot, foot, "feet do not cross");
            assert!(print.heading_deg.abs() < 10.0);
        }
    }

    #[test]
    fn a_gap_is_leapt_up_to_the_longest_leap_and_no_farther() {
        let step_m = walker().step_m[0];
        let with_gap = |gap_m: f64| {
            let before = (1..5).map(|i| stone(f64::from(i) * step_m, 0.0));
            let after = (0..4).map(|i| stone(4.0 * step_m + gap_m + f64::from(i) * step_m, 0.0));
            River { banks_m: [0.0, 8.0 * step_m + gap_m], stones: before.chain(after).collect() }
        };
        let river = with_gap(0.99 * leap_m());
        assert_is_way(&river, &river.cross(&walker()).unwrap());
        let gap_m = 1.01 * leap_m();
        let refused = with_gap(gap_m).cross(&walker());
        let Err(RiverError::NoWay { reached_m, gap_m: told_m, .. }) = refused else { panic!("{refused:?}") };
        assert!((reached_m - 4.0 * step_m).abs() < 1e-9);
        assert!((told_m - gap_m).abs() < 1e-9);
    }

    #[test]
    fn a_detour_is_found_where_the_straight_way_ends() {
        let step_m = walker().step_m[0];
        // A row that ends in the middle, and a bent one beside it that reaches the other bank.
        let dead_end = (1..6).map(|i| stone(f64::from(i) * step_m, 0.0));
        let bent = (1..16).map(|i| {
            let along = f64::from(i);
            stone(along * step_m, 3.0 * leap_m() + 0.8 * leap_m() * (0.4 * along).sin())
        });
        let river = River { banks_m: [0.0, 16.0 * step_m], stones: dead_end.chain(bent).collect() };
        let prints = river.cross(&walker()).unwrap();
        assert_is_way(&river, &prints);
        assert!(prints.iter().all(|print| print.at_m[1] > leap_m()));
    }

    #[test]
    fn scattered_stones_lead_over_and_the_way_is_the_same_each_time() {
        let step_m = walker().step_m[0];
        let mut crossed = 0;
        for seed in 0..20 {
            let river = River::scattered(20.0 * step_m, 30.0 * step_m, step_m, seed).unwrap();
            let Ok(prints) = river.cross(&walker()) else { continue };
            assert_is_way(&river, &prints);
            assert!(prints.len() < 40, "seed {seed}: {} prints", prints.len());
            assert_eq!(Ok(prints), river.cross(&walker()));
            crossed += 1;
        }
        assert!(crossed >= 18, "{crossed} of 20");
    }

    #[test]
    fn a_brook_is_leapt_and_a_large_stone_walked_over() {
        let leap_m = leap_m();
        let brook = River { banks_m: [0.0, 0.3 * leap_m], stones: vec![] };
        let prints = brook.cross(&walker()).unwrap();
        assert_eq!(prints.len(), 4);
        assert_is_way(&brook, &prints);
        let radius_m = 2.0 * leap_m;
        let rock = Stone { at_m: [radius_m + 0.1, 0.0], radius_m };
        let river = River { banks_m: [0.0, 2.0 * radius_m + 0.2], stones: vec![rock] };
        assert_is_way(&river, &river.cross(&walker()).unwrap());
    }

    #[test]
    fn rivers_that_cannot_be_are_refused_and_large_ones_take_bounded_time() {
        let model = walker();
        for banks_m in [[0.0, f64::NAN], [1.0, 0.0], [0.0, 0.0], [0.0, 1e9]] {
            let river = River { banks_m, stones: vec![] };
            assert!(matches!(river.cross(&model), Err(RiverError::Banks { .. })));
        }
        let with = |stones: Vec<Stone>| River { banks_m: [0.0, 50.0], stones }.cross(&model);
        assert!(matches!(with(vec![]), Err(RiverError::NoWay { .. })), "no stones");
        for bad in [stone(f64::NAN, 0.0), Stone { radius_m: -1.0, ..stone(1.0, 0.0) }, stone(1e6, 0.0)] {
            assert!(matches!(with(vec![stone(1.0, 0.0), bad]), Err(RiverError::Stone { number: 2, .. })));
        }
        assert!(matches!(with(vec![stone(1.0, 0.0); 100_000]), Err(RiverError::TooMany { .. })));
        // All in one heap, each within reach of each, and the other bank out of reach.
        let heap = (0..10_000).map(|i| stone(0.5 + 1e-5 * f64::from(i), 1e-4 * f64::from(i % 100)));
        assert!(matches!(with(heap.collect()), Err(RiverError::NoWay { .. })));
        let step_m = model.step_m[0];
        let dense = River::scattered(60.0 * step_m, 60.0 * step_m, step_m, 1).unwrap();
        assert_is_way(&dense, &dense.cross(&model).unwrap());
        assert!(River::scattered(10.0, f64::NAN, 1.0, 0).is_err());
        assert!(River::scattered(10.0, 10.0, 1e-9, 0).is_err());
        let mut no_times = walker();
        no_times.timing.step_times.clear();
        let river = River { banks_m: [0.0, 1.0], stones: vec![] };
        assert!(matches!(river.cross(&no_times), Err(RiverError::Model)));
    }
}
