//! The finite square world of the wandering bird (van de Panne 1997, Fig. 20): a border and trees.

use glam::DVec2;
use muybridge_core::Random;
use serde::{Deserialize, Serialize};

/// Longest side of a meadow, metres: prints lie within 10 km of the origin.
const MOST_SIDE_M: f64 = 20_000.0;
/// Most trees: each of them is looked at some dozen times a step.
const MOST_TREES: usize = 2_000;
/// Places tried for each tree of [`Meadow::planted`] before there is no more room.
const TRIES: usize = 200;
/// Radii of planted trees, shares of the gap between them.
const TRUNKS: [f64; 2] = [0.05, 0.15];

/// A tree's trunk.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tree {
    /// Its middle: x and z, metres.
    pub at_m: [f64; 2],
    /// Its radius, metres.
    pub radius_m: f64,
}

impl Tree {
    pub(super) fn at(&self) -> DVec2 {
        DVec2::from_array(self.at_m)
    }
}

/// A square around the origin with trees.
#[derive(Clone, Debug, PartialEq)]
pub struct Meadow {
    side_m: f64,
    trees: Vec<Tree>,
}

/// Why nobody can wander.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WanderError {
    /// A square that is none.
    #[error("the side of the square is {side_m} m; it must be more than 0 and at most {MOST_SIDE_M} m")]
    Side {
        /// Its side, metres.
        side_m: f64,
    },
    /// A tree that is none.
    #[error(
        "tree {number}: its place must be two numbers within the square, its radius above 0 and below half its side"
    )]
    Tree {
        /// Which, from 1.
        number: usize,
    },
    /// Too many trees.
    #[error("{count} trees; {MOST_TREES} are the most")]
    TooManyTrees {
        /// How many.
        count: usize,
    },
    /// A model whose steps are no lengths.
    #[error("the model's step length, step width and foot must be numbers above 0")]
    Model,
    /// The trees leave no place from which one can turn about.
    #[error(
        "no place in the square has room to turn about in: steps of {step_m} m need a free circle of {radius_m:.2} m radius; \
             make the square larger or fell trees"
    )]
    NoRoom {
        /// Step length, metres.
        step_m: f64,
        /// Radius of the circle with what is kept free on both sides of it, metres.
        radius_m: f64,
    },
}

impl Meadow {
    /// A square with a side (m) around the origin, and its trees.
    ///
    /// # Errors
    /// When the side or a tree cannot be, or there are too many trees.
    pub fn new(side_m: f64, trees: Vec<Tree>) -> Result<Self, WanderError> {
        if !(side_m > 0.0 && side_m <= MOST_SIDE_M) {
            return Err(WanderError::Side { side_m });
        }
        if trees.len() > MOST_TREES {
            return Err(WanderError::TooManyTrees { count: trees.len() });
        }
        let half_m = side_m / 2.0;
        let stands = |tree: &Tree| {
            tree.at_m.iter().all(|at_m| at_m.abs() <= half_m) && tree.radius_m > 0.0 && tree.radius_m < half_m
        };
        match trees.iter().position(|tree| !stands(tree)) {
            Some(tree) => Err(WanderError::Tree { number: tree + 1 }),
            None => Ok(Self { side_m, trees }),
        }
    }

    /// A square with so many trees (fewer when there is no room), each `gap_m` or more from its neighbours and the border.
    ///
    /// # Errors
    /// As [`Meadow::new`].
    pub fn planted(side_m: f64, count: usize, gap_m: f64, seed: u64) -> Result<Self, WanderError> {
        let mut meadow = Self::new(side_m, Vec::new())?;
        let mut random = Random::new(seed);
        for _ in 0..count.min(MOST_TREES) {
            let tree = (0..TRIES).find_map(|_| {
                let radius_m = gap_m * random.between(TRUNKS[0], TRUNKS[1]);
                let most_m = side_m / 2.0 - gap_m - radius_m;
                let at_m = [random.between(-most_m, most_m), random.between(-most_m, most_m)];
                let tree = Tree { at_m, radius_m };
                let is_apart =
                    |other: &Tree| other.at().distance(tree.at()) >= gap_m + other.radius_m + tree.radius_m;
                (most_m > 0.0 && meadow.trees.iter().all(is_apart)).then_some(tree)
            });
            meadow.trees.extend(tree);
        }
        Self::new(side_m, meadow.trees)
    }

    /// Side of the square, metres.
    pub fn side_m(&self) -> f64 {
        self.side_m
    }

    /// Its trees.
    pub fn trees(&self) -> &[Tree] {
        &self.trees
    }

    /// Whether a ring about a middle is clear of trees and border by so much on both sides, all in metres. Trees may stand within it.
    pub(super) fn has_ring(&self, middle: DVec2, inner_m: f64, outer_m: f64) -> bool {
        let is_beside = |tree: &Tree| {
            let distance_m = tree.at().distance(middle);
            distance_m - tree.radius_m >= outer_m || distance_m + tree.radius_m <= inner_m
        };
        middle.abs().max_element() + outer_m <= self.side_m / 2.0 && self.trees.iter().all(is_beside)
    }

    /// How far one comes straight ahead, up to `most_m`, until a tree or the border is nearer than `clear_m`, metres.
    pub(super) fn free_way_m(&self, from: DVec2, direction: DVec2, most_m: f64, clear_m: f64) -> f64 {
        let half_m = self.side_m / 2.0 - clear_m;
        let to_border = |at_m: f64, rate: f64| {
            if rate.abs() < 1e-12 { f64::INFINITY } else { (half_m * rate.signum() - at_m) / rate }
        };
        let mut way_m = most_m.min(to_border(from.x, direction.x)).min(to_border(from.y, direction.y));
        for tree in &self.trees {
            let to_tree = tree.at() - from;
            let along_m = to_tree.dot(direction);
            let kept_m = tree.radius_m + clear_m;
            let inside = kept_m * kept_m - (to_tree.length_squared() - along_m * along_m);
            // A tree behind, or one that the way passes by.
            if along_m > 0.0 && inside > 0.0 {
                way_m = way_m.min(along_m - inside.sqrt());
            }
        }
        way_m.max(0.0)
    }
}
