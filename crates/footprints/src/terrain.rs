//! Terrain for footprints: they take its height and slope.

use std::ops::RangeInclusive;

use glam::{DVec2, DVec3};
use muybridge_core::{Ground, Surface};
use serde::{Deserialize, Deserializer, Serialize};

use crate::bounds::{HEADING_DEG, PLACE_M, out_of_range};

/// Slopes, degrees; steeper ones are walls.
const SLOPE_DEG: RangeInclusive<f64> = -60.0..=60.0;
/// Treads of stairs and the distance of heights, metres.
const LENGTH_M: RangeInclusive<f64> = 0.01..=1000.0;
/// Rise of one stair, metres.
const RISE_M: RangeInclusive<f64> = -10.0..=10.0;
const MOST_STEPS: u32 = 1000;
/// Radii of a spiral staircase, metres.
const RADIUS_M: RangeInclusive<f64> = 0.0..=1000.0;
const STEPS_PER_TURN: RangeInclusive<f64> = 3.0..=360.0;
const MOST_HEIGHTS: usize = 1_000_000;

/// A ground as data. Directions are degrees to the left of X, as headings are.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case", tag = "kind", deny_unknown_fields)]
pub enum Terrain {
    /// The plane of height zero.
    #[default]
    #[serde(deserialize_with = "nothing_else")]
    Flat,
    /// A plane through the origin.
    Slope {
        /// How steeply it rises, -60 to 60 degrees.
        rise_deg: f64,
        /// Where it rises to, degrees.
        towards_deg: f64,
    },
    /// A straight flight of stairs without sides: level at height zero before it, level at its top behind it.
    Stairs {
        /// Depth of a tread, metres, at least 0.01.
        tread_m: f64,
        /// Rise of a stair, metres; negative goes down.
        rise_m: f64,
        /// Number of stairs, at most 1000. The last one is the landing.
        steps: u32,
        /// Where they lead, degrees.
        towards_deg: f64,
        /// A place on the edge of the first stair: x and z, metres.
        from_m: [f64; 2],
    },
    /// Stairs around a pillar, at most one turn, because a terrain has one height at a place. What they leave of the turn is
    /// halved: a landing at their top, and level ground before their foot; inside and outside the ring the height is zero.
    SpiralStairs {
        /// The middle of the pillar: x and z, metres.
        centre_m: [f64; 2],
        /// Radius at which the treads begin, metres.
        inner_m: f64,
        /// Radius at which they end, metres.
        outer_m: f64,
        /// Treads of a whole turn, 3 to 360.
        steps_per_turn: u32,
        /// Rise of a stair, metres; negative goes down.
        rise_m: f64,
        /// How far they go round, above 0 and at most 1 turn; rounded to whole treads.
        turns: f64,
        /// Direction from the middle to the edge of the first stair, degrees.
        from_deg: f64,
        /// Whether they lead clockwise, seen from above; else to the left, as headings turn.
        #[serde(default)]
        clockwise: bool,
    },
    /// Heights on a square grid, between them bilinear; beyond its edges the edge goes on level.
    HeightField {
        /// Place of the first height: x and z, metres.
        from_m: [f64; 2],
        /// Distance between neighbours, metres.
        spacing_m: f64,
        /// Heights in a row along X; the rows follow along Z.
        columns: u32,
        /// The heights, row by row, metres; at most a million.
        heights_m: Vec<f64>,
    },
}

/// Refuses fields of a ground that has none; serde itself lets them pass.
fn nothing_else<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
    #[derive(Deserialize)]
    #[serde(deny_unknown_fields)]
    struct Nothing {}
    Nothing::deserialize(deserializer).map(|Nothing {}| ())
}

/// The unit vector of a direction (degrees to the left of X) in the plan.
pub(crate) fn direction(towards_deg: f64) -> DVec2 {
    let (sin, cos) = towards_deg.to_radians().sin_cos();
    DVec2::new(cos, -sin)
}

impl Terrain {
    /// Height (m) and unit normal at a place in the plan, metres. A tread is level up to its very edge.
    pub fn at(&self, x_m: f64, z_m: f64) -> (f64, DVec3) {
        let place = DVec2::new(x_m, z_m);
        match self {
            Self::Flat => (0.0, DVec3::Y),
            Self::Slope { rise_deg, towards_deg } => {
                let gradient = direction(*towards_deg) * rise_deg.to_radians().tan();
                (gradient.dot(place), normal(gradient))
            }
            Self::Stairs { tread_m, rise_m, steps, towards_deg, from_m } => {
                let along_m = (place - DVec2::from(*from_m)).dot(direction(*towards_deg));
                let climbed = ((along_m / tread_m).floor() + 1.0).clamp(0.0, f64::from(*steps));
                (climbed * rise_m, DVec3::Y)
            }
            Self::SpiralStairs { centre_m, inner_m, outer_m, rise_m, .. } => {
                let from_centre = place - DVec2::from(*centre_m);
                let in_ring = (*inner_m..=*outer_m).contains(&from_centre.length());
                let climbed = if in_ring { self.climbed(from_centre) } else { 0.0 };
                (climbed * rise_m, DVec3::Y)
            }
            Self::HeightField { from_m, spacing_m, columns, heights_m } => {
                Grid { spacing_m: *spacing_m, columns: *columns as usize, heights_m }
                    .at((place - DVec2::from(*from_m)) / *spacing_m)
            }
        }
    }

    /// The place on the ground, metres, above or below a place in the plan (x and z, metres).
    pub fn on_ground(&self, at_m: [f64; 2]) -> DVec3 {
        DVec3::new(at_m[0], self.at(at_m[0], at_m[1]).0, at_m[1])
    }

    /// Stairs climbed where one is, seen from the middle of a spiral staircase.
    fn climbed(&self, from_centre: DVec2) -> f64 {
        let Self::SpiralStairs { steps_per_turn, turns, from_deg, clockwise, .. } = self else {
            return 0.0;
        };
        let left_deg = (-from_centre.y).atan2(from_centre.x).to_degrees() - from_deg;
        let around_deg = if *clockwise { -left_deg } else { left_deg }.rem_euclid(360.0);
        let per_turn = f64::from(*steps_per_turn);
        let steps = (turns * per_turn).round();
        let (around, rest) = (around_deg * per_turn / 360.0, per_turn - steps);
        if around < steps + 0.5 * rest { (around.floor() + 1.0).min(steps) } else { 0.0 }
    }

    /// What is wrong with its numbers, as a sentence that says what they must be.
    pub fn fault(&self) -> Option<String> {
        match self {
            Self::Flat => None,
            Self::Slope { rise_deg, towards_deg } => {
                out_of_range("rise_deg", *rise_deg, &SLOPE_DEG, "degrees")
                    .or_else(|| out_of_range("towards_deg", *towards_deg, &HEADING_DEG, "degrees"))
            }
            Self::Stairs { tread_m, rise_m, steps, towards_deg, from_m } => {
                out_of_range("tread_m", *tread_m, &LENGTH_M, "m")
                    .or_else(|| out_of_range("rise_m", *rise_m, &RISE_M, "m"))
                    .or_else(|| too_many("steps", *steps as usize, MOST_STEPS as usize))
                    .or_else(|| out_of_range("towards_deg", *towards_deg, &HEADING_DEG, "degrees"))
                    .or_else(|| place_fault("from_m", *from_m))
            }
            Self::SpiralStairs { .. } => self.spiral_fault(),
            Self::HeightField { from_m, spacing_m, columns, heights_m } => place_fault("from_m", *from_m)
                .or_else(|| out_of_range("spacing_m", *spacing_m, &LENGTH_M, "m"))
                .or_else(|| heights_fault(*columns as usize, heights_m)),
        }
        .map(|fault| format!("terrain: {fault}"))
    }

    fn spiral_fault(&self) -> Option<String> {
        let Self::SpiralStairs {
            centre_m, inner_m, outer_m, steps_per_turn, rise_m, turns, from_deg, ..
        } = self
        else {
            return None;
        };
        let per_turn = f64::from(*steps_per_turn);
        place_fault("centre_m", *centre_m)
            .or_else(|| out_of_range("inner_m", *inner_m, &RADIUS_M, "m"))
            .or_else(|| {
                out_of_range("outer_m", *outer_m, &(*inner_m + LENGTH_M.start()..=*RADIUS_M.end()), "m")
            })
            .or_else(|| out_of_range("steps_per_turn", per_turn, &STEPS_PER_TURN, "treads"))
            .or_else(|| out_of_range("rise_m", *rise_m, &RISE_M, "m"))
            .or_else(|| {
                out_of_range("turns", *turns, &(0.5 / per_turn..=1.0), "turns, for a place has one height")
            })
            .or_else(|| out_of_range("from_deg", *from_deg, &HEADING_DEG, "degrees"))
    }
}

impl Ground for Terrain {
    fn surface(&self, x_m: f32, z_m: f32) -> Surface {
        let (height_m, normal) = self.at(f64::from(x_m), f64::from(z_m));
        Surface { height_m: height_m as f32, normal: normal.as_vec3() }
    }
}

/// The unit normal of a surface whose height rises by so much a metre along x and z.
fn normal(gradient: DVec2) -> DVec3 {
    DVec3::new(-gradient.x, 1.0, -gradient.y).normalize_or(DVec3::Y)
}

struct Grid<'a> {
    spacing_m: f64,
    columns: usize,
    heights_m: &'a [f64],
}

impl Grid<'_> {
    /// Height and normal at a place measured in columns and rows.
    fn at(&self, place: DVec2) -> (f64, DVec3) {
        let rows = self.heights_m.len() / self.columns.max(1);
        let (column, x, inside_x) = cell(place.x, self.columns);
        let (row, z, inside_z) = cell(place.y, rows);
        let height = |down: usize, right: usize| {
            let at = (row + down).min(rows.saturating_sub(1)) * self.columns
                + (column + right).min(self.columns.saturating_sub(1));
            self.heights_m.get(at).copied().unwrap_or(0.0)
        };
        let [near, far] = [0, 1].map(|down| [height(down, 0), height(down, 1)]);
        let across = |row: [f64; 2]| row[0] + (row[1] - row[0]) * x;
        let rise_x = (near[1] - near[0]) * (1.0 - z) + (far[1] - far[0]) * z;
        let rise_z = across(far) - across(near);
        let gradient = DVec2::new(rise_x * inside_x, rise_z * inside_z) / self.spacing_m;
        (across(near) + (across(far) - across(near)) * z, normal(gradient))
    }
}

/// The cell of a place among so many heights, the share of it that is behind the place, and 1 inside the grid, 0 beyond it.
fn cell(place: f64, heights: usize) -> (usize, f64, f64) {
    let last = heights.saturating_sub(1) as f64;
    let held = place.clamp(0.0, last);
    let first = held.floor().min((last - 1.0).max(0.0));
    (first as usize, held - first, f64::from(u8::from(held == place)))
}

fn place_fault(name: &str, at_m: [f64; 2]) -> Option<String> {
    at_m.into_iter().find_map(|value_m| out_of_range(name, value_m, &PLACE_M, "m"))
}

fn too_many(name: &str, count: usize, most: usize) -> Option<String> {
    (count > most).then(|| format!("{name} is {count}; {most} are the most"))
}

fn heights_fault(columns: usize, heights_m: &[f64]) -> Option<String> {
    if columns == 0 || heights_m.is_empty() || !heights_m.len().is_multiple_of(columns) {
        return Some(format!(
            "heights_m has {} heights in rows of {columns}; it must have one whole row or more",
            heights_m.len()
        ));
    }
    too_many("the number of heights_m", heights_m.len(), MOST_HEIGHTS).or_else(|| {
        let out = heights_m.iter().position(|height_m| !PLACE_M.contains(height_m))?;
        out_of_range(&format!("height {} of heights_m", out + 1), heights_m[out], &PLACE_M, "m")
    })
}

#[cfg(test)]
mod tests;
