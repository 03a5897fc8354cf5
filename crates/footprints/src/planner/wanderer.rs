//! Wandering at random in a square with trees (van de Panne 1997, 4.2 and Fig. 20).
//!
//! The paper's rule: one walks straight on until the present direction would come too near to an obstacle within the look-ahead; then
//! another direction is drawn. To that comes a promise that turning slowly can be kept: after every step one of the two circles of
//! sharpest turning, to the left or to the right, is free all around. A step that leaves neither is not made, and the one along the
//! circle that is free always can be.

use glam::DVec2;
use muybridge_core::Random;

use super::meadow::{Meadow, WanderError};
use super::plan::{ahead, right_of, wrapped};
use crate::lay::setting_out;
use crate::model::Model;
use crate::timing::StepTiming;
use crate::track::{Foot, Print};

/// Sharpest turn from one step to the next, radians.
const MOST_TURN_RAD: f64 = 30.0 * std::f64::consts::PI / 180.0;
/// How far the wanderer looks ahead, steps: the way that half a turn takes at the sharpest.
const LOOK_AHEAD_STEPS: f64 = 6.0;
/// What is kept free between a print and a tree or the border, step lengths.
const TOLERANCE_STEPS: f64 = 0.25;
/// Turns that are tried for a step, evenly from the sharpest right to the sharpest left.
const TURNS: i32 = 13;
/// Directions that are drawn before the freest of them is taken.
const DRAWS: u32 = 24;
/// Spread of the drawn directions about the present one: at first, and how much it grows with every draw, radians.
const SPREAD_RAD: [f64; 2] = [0.5, 0.1];
/// Places that are tried for the start.
const STARTS: usize = 5_000;

/// One who wanders: an endless sequence of prints, the same for the same seed.
#[derive(Clone, Debug)]
pub struct Wanderer {
    meadow: Meadow,
    random: Random,
    gauge: Gauge,
    /// Between the two lines of prints.
    place: DVec2,
    heading_rad: f64,
    wanted_rad: f64,
    /// The side on which the circle of sharpest turning is free: 1 left, -1 right.
    free_side: f64,
    /// Of the first two prints, on which it stands before it sets out.
    first_times: [StepTiming; 2],
    laid: usize,
}

/// Lengths of a walk, metres.
#[derive(Clone, Copy, Debug)]
struct Gauge {
    step_m: f64,
    half_width_m: f64,
    /// Between a print's outline and an obstacle.
    tolerance_m: f64,
    /// Between the middle line and an obstacle.
    clear_m: f64,
    /// Radius of the circle on which the sharpest turns lie.
    turn_radius_m: f64,
}

impl Gauge {
    fn of(model: &Model) -> Result<Self, WanderError> {
        let [step_m, width_m] = model.step_m;
        let outline_m = model.leg.foot.outline_m.iter().map(|point| point[0].hypot(point[1]));
        let foot_m = outline_m.fold(model.leg.foot.toe_ahead_m, f64::max);
        let is_length = |length_m: f64| length_m > 0.0 && length_m < f64::INFINITY;
        if !(is_length(step_m) && is_length(width_m) && is_length(foot_m)) {
            return Err(WanderError::Model);
        }
        let tolerance_m = TOLERANCE_STEPS * step_m;
        Ok(Self {
            step_m,
            half_width_m: width_m / 2.0,
            tolerance_m,
            clear_m: tolerance_m + width_m / 2.0 + foot_m,
            turn_radius_m: step_m / (2.0 * (MOST_TURN_RAD / 2.0).sin()),
        })
    }

    /// Whether the circle of sharpest turning to a side is free.
    fn has_circle(&self, meadow: &Meadow, place: DVec2, heading_rad: f64, side: f64) -> bool {
        // Steps are chords of the circle: the way is its tangent half a turn of a step later.
        let tangent_rad = heading_rad + side * MOST_TURN_RAD / 2.0;
        let middle = place - side * self.turn_radius_m * right_of(tangent_rad);
        // Between two steps the way is nearer to the middle by this.
        let sagitta_m = self.turn_radius_m * (1.0 - (MOST_TURN_RAD / 2.0).cos());
        let inner_m = self.turn_radius_m - sagitta_m - self.clear_m;
        meadow.has_ring(middle, inner_m, self.turn_radius_m + self.clear_m)
    }

    /// A side on which the circle of sharpest turning is free.
    fn free_side(&self, meadow: &Meadow, place: DVec2, heading_rad: f64) -> Option<f64> {
        [1.0, -1.0].into_iter().find(|side| self.has_circle(meadow, place, heading_rad, *side))
    }
}

impl Wanderer {
    /// Someone with a model's steps, somewhere in a meadow.
    ///
    /// # Errors
    /// When the model's steps are none, or the meadow has no room to turn about in.
    pub fn new(meadow: Meadow, model: &Model, seed: u64) -> Result<Self, WanderError> {
        let gauge = Gauge::of(model)?;
        let mut random = Random::new(seed);
        let half_m = meadow.side_m() / 2.0;
        let start = (0..STARTS).find_map(|_| {
            let place = DVec2::new(random.between(-half_m, half_m), random.between(-half_m, half_m));
            let heading_rad = random.between(-std::f64::consts::PI, std::f64::consts::PI);
            Some((place, heading_rad, gauge.free_side(&meadow, place, heading_rad)?))
        });
        let radius_m = gauge.turn_radius_m + gauge.clear_m;
        let first_times = setting_out(model.timing.timing(gauge.step_m));
        let no_room = WanderError::NoRoom { step_m: gauge.step_m, radius_m };
        let (place, heading_rad, free_side) = start.ok_or(no_room)?;
        Ok(Self {
            meadow,
            random,
            gauge,
            place,
            heading_rad,
            wanted_rad: heading_rad,
            free_side,
            first_times,
            laid: 0,
        })
    }

    /// Where it wanders.
    pub fn meadow(&self) -> &Meadow {
        &self.meadow
    }

    /// What is always free between a print's outline and a tree or the border, metres.
    pub fn tolerance_m(&self) -> f64 {
        self.gauge.tolerance_m
    }

    fn free_way_m(&self, heading_rad: f64) -> f64 {
        let most_m = LOOK_AHEAD_STEPS * self.gauge.step_m;
        self.meadow.free_way_m(self.place, ahead(heading_rad), most_m, self.gauge.clear_m)
    }

    fn is_blocked(&self, heading_rad: f64) -> bool {
        self.free_way_m(heading_rad) < LOOK_AHEAD_STEPS * self.gauge.step_m
    }

    /// A direction drawn by chance, ever farther from the present one until nothing is in its way.
    fn draw_direction(&mut self) -> f64 {
        let mut freest = (f64::NEG_INFINITY, self.heading_rad);
        for draw in 0..DRAWS {
            let spread_rad = SPREAD_RAD[0] + SPREAD_RAD[1] * f64::from(draw);
            let heading_rad = wrapped(self.heading_rad + spread_rad * self.random.normal());
            let way_m = self.free_way_m(heading_rad);
            if way_m > freest.0 {
                freest = (way_m, heading_rad);
            }
            if !self.is_blocked(heading_rad) {
                break;
            }
        }
        freest.1
    }

    /// Turns that could be made, the nearest to what is wanted first.
    fn turns(&self) -> Vec<f64> {
        let wish_rad = wrapped(self.wanted_rad - self.heading_rad).clamp(-MOST_TURN_RAD, MOST_TURN_RAD);
        let turn = |i: i32| MOST_TURN_RAD * (2.0 * f64::from(i) / f64::from(TURNS - 1) - 1.0);
        let mut turns: Vec<f64> = std::iter::once(wish_rad).chain((0..TURNS).map(turn)).collect();
        turns.sort_by(|a, b| (a - wish_rad).abs().total_cmp(&(b - wish_rad).abs()));
        turns
    }

    /// The free side after a step with a turn, if there is one and nothing is in the way of the step.
    fn side_after(&self, turn_rad: f64) -> Option<f64> {
        let heading_rad = self.heading_rad + turn_rad;
        let step_m = self.gauge.step_m;
        let is_free =
            self.meadow.free_way_m(self.place, ahead(heading_rad), step_m, self.gauge.clear_m) >= step_m;
        let place = self.place + step_m * ahead(heading_rad);
        self.gauge.free_side(&self.meadow, place, heading_rad).filter(|_| is_free)
    }

    fn step(&mut self) {
        if self.is_blocked(self.wanted_rad) {
            self.wanted_rad = self.draw_direction();
        }
        let turns = self.turns();
        let possible = turns.iter().position(|turn| self.side_after(*turn).is_some());
        let turn_rad = possible.map_or(self.free_side * MOST_TURN_RAD, |i| turns[i]);
        self.free_side = self.side_after(turn_rad).unwrap_or(self.free_side);
        self.heading_rad = wrapped(self.heading_rad + turn_rad);
        self.place += self.gauge.step_m * ahead(self.heading_rad);
        // What is wanted cannot be had from here: another direction, or it would be tried for ever.
        if possible != Some(0) {
            self.wanted_rad = self.draw_direction();
        }
    }
}

impl Iterator for Wanderer {
    type Item = Print;

    /// The next print; there always is one. The first two stand side by side, and have times; the others have the model's.
    fn next(&mut self) -> Option<Print> {
        if self.laid >= 2 {
            self.step();
        }
        let foot = Foot::BIPED[self.laid % 2];
        let side = if foot == Foot::Left { -1.0 } else { 1.0 };
        let at = self.place + side * self.gauge.half_width_m * right_of(self.heading_rad);
        let timing = self.first_times.get(self.laid).copied();
        self.laid += 1;
        Some(Print { foot, at_m: at.to_array(), heading_deg: self.heading_rad.to_degrees(), timing })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planner::Tree;
    use crate::planner::tests::walker;

    fn wanderer(seed: u64) -> Wanderer {
        let model = walker();
        let meadow = Meadow::planted(30.0 * model.step_m[0], 12, 4.0 * model.step_m[0], seed).unwrap();
        Wanderer::new(meadow, &model, seed).unwrap()
    }

    /// Corners of a print's outline in the plan.
    fn outline(print: &Print) -> Vec<DVec2> {
        let heading_rad = print.heading_deg.to_radians();
        let corner = |point: &[f64; 2]| {
            DVec2::from_array(print.at_m) + point[0] * ahead(heading_rad) + point[1] * right_of(heading_rad)
        };
        walker().leg.foot.outline_m.iter().map(corner).collect()
    }

    #[test]
    fn no_print_comes_near_a_tree_or_the_border() {
        for seed in 0..20 {
            let mut wanderer = wanderer(seed);
            let tolerance_m = wanderer.tolerance_m() - 1e-9;
            assert!(wanderer.meadow().trees().len() >= 8, "seed {seed}");
            for i in 0..10_000 {
                let print = wanderer.next().unwrap();
                for corner in outline(&print) {
                    let to_border_m = wanderer.meadow().side_m() / 2.0 - corner.abs().max_element();
                    assert!(to_border_m >= tolerance_m, "seed {seed}, print {i}");
                    for tree in wanderer.meadow().trees() {
                        let to_trunk_m = tree.at().distance(corner) - tree.radius_m;
                        assert!(to_trunk_m >= tolerance_m, "seed {seed}, print {i}: {to_trunk_m}");
                    }
                }
            }
        }
    }

    #[test]
    fn steps_turn_little_and_are_as_long_as_the_models() {
        let [step_m, width_m] = walker().step_m;
        let prints: Vec<Print> = wanderer(3).take(10_000).collect();
        for (i, pair) in prints.windows(2).enumerate() {
            let [before, after] = [pair[0], pair[1]];
            assert_ne!(before.foot, after.foot);
            let turn_rad = wrapped((after.heading_deg - before.heading_deg).to_radians());
            assert!(turn_rad.abs() <= MOST_TURN_RAD + 1e-9, "print {i}");
            let length_m = DVec2::from_array(before.at_m).distance(DVec2::from_array(after.at_m));
            // The outer foot of a turn goes a little farther.
            let outside_m = step_m + width_m / 2.0 * MOST_TURN_RAD.sin();
            let most_m = 1e-9 + if i == 0 { width_m } else { outside_m.hypot(width_m) };
            assert!(length_m <= most_m, "print {i}: {length_m}");
        }
    }

    /// Whoever is stuck goes round in a circle; others come all over the meadow and turn both ways.
    #[test]
    fn nobody_gets_stuck() {
        const CELLS: f64 = 6.0;
        for seed in 0..20 {
            let wanderer = wanderer(seed);
            let side_m = wanderer.meadow().side_m();
            let prints: Vec<Print> = wanderer.take(10_000).collect();
            for (part, prints) in prints.chunks(2_500).enumerate() {
                let mut seen = vec![false; (CELLS * CELLS) as usize];
                let cell = |at_m: f64| ((at_m / side_m + 0.5) * CELLS).floor();
                for print in prints {
                    seen[(cell(print.at_m[0]) * CELLS + cell(print.at_m[1])) as usize] = true;
                }
                let share = seen.iter().filter(|seen| **seen).count() as f64 / seen.len() as f64;
                assert!(share > 0.7, "seed {seed}, part {part}: {share}");
            }
            let turn = |pair: &[Print]| wrapped((pair[1].heading_deg - pair[0].heading_deg).to_radians());
            let turned: Vec<f64> = prints.windows(2).map(turn).collect();
            for hundred in turned.chunks(100) {
                let sum: f64 = hundred.iter().sum();
                assert!(sum.abs() < 0.8 * 100.0 * MOST_TURN_RAD, "seed {seed} turns and turns");
            }
        }
    }

    #[test]
    fn the_same_seed_wanders_the_same_way() {
        let prints = |seed: u64| wanderer(seed).take(500).collect::<Vec<Print>>();
        assert_eq!(prints(5), prints(5));
        assert_ne!(prints(5), prints(6));
    }

    #[test]
    fn a_free_way_is_as_long_as_it_is() {
        let tree = Tree { at_m: [3.0, 0.0], radius_m: 0.5 };
        let meadow = Meadow::new(20.0, vec![tree]).unwrap();
        let way_m = |from: [f64; 2], towards: [f64; 2]| {
            meadow.free_way_m(DVec2::from_array(from), DVec2::from_array(towards), 50.0, 0.25)
        };
        assert!((way_m([0.0, 0.0], [1.0, 0.0]) - 2.25).abs() < 1e-12, "up to the tree");
        assert!((way_m([0.0, 0.0], [0.0, 1.0]) - 9.75).abs() < 1e-12, "up to the border");
        assert!((way_m([0.0, 0.8], [1.0, 0.0]) - 9.75).abs() < 1e-12, "past the tree");
        assert!((way_m([5.0, 0.0], [1.0, 0.0]) - 4.75).abs() < 1e-12, "the tree behind");
    }

    #[test]
    fn meadows_and_models_that_cannot_be_are_refused() {
        let tree = |x: f64, radius_m: f64| Tree { at_m: [x, 0.0], radius_m };
        for side_m in [f64::NAN, 0.0, -1.0, f64::INFINITY, 1e5] {
            assert!(matches!(Meadow::new(side_m, vec![]), Err(WanderError::Side { .. })));
            assert!(matches!(Meadow::planted(side_m, 5, 1.0, 0), Err(WanderError::Side { .. })));
        }
        for bad in
            [tree(f64::NAN, 1.0), tree(11.0, 1.0), tree(0.0, f64::NAN), tree(0.0, 0.0), tree(0.0, 10.0)]
        {
            let refused = Meadow::new(20.0, vec![tree(1.0, 0.1), bad]);
            assert_eq!(refused, Err(WanderError::Tree { number: 2 }));
        }
        assert!(matches!(
            Meadow::new(20.0, vec![tree(0.0, 0.1); 100_000]),
            Err(WanderError::TooManyTrees { .. })
        ));
        assert!(Meadow::planted(20.0, usize::MAX, f64::NAN, 0).unwrap().trees().is_empty());
        let cramped = Wanderer::new(Meadow::new(walker().step_m[0], vec![]).unwrap(), &walker(), 0);
        assert!(matches!(cramped, Err(WanderError::NoRoom { .. })));
        let mut model = walker();
        model.step_m[0] = f64::NAN;
        let refused = Wanderer::new(Meadow::new(20.0, vec![]).unwrap(), &model, 0);
        assert!(matches!(refused, Err(WanderError::Model)));
    }
}
