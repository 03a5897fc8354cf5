//! All postures of a chain on a grid of places and angles, by dynamic programming from root to tip.
//!
//! ## References
//! Felzenszwalb & Huttenlocher, *Pictorial structures for object recognition* (2005).

use super::chain::{Chain, Link};
use super::frame::{Level, Place, distance};

/// Step of the angles, radians: the end of a cannon moves by less than two pixels.
const ANGLE_STEP: f64 = 7.0 * std::f64::consts::PI / 180.0;
/// A posture this much less probable than the best one (natural logarithm) is not followed.
const BEAM: f32 = 18.0;
/// What a joint pays for lying a pixel beside the end of its bone: bones look longer or shorter from panel to panel.
const LOOSE_JOINT: f32 = 0.4;
/// Roots farther from the expected place are not tried, standard deviations.
const ROOT_REACH: f64 = 2.5;
/// Places beyond the picture's edge that are tried, body heights: an animal may be half out of it.
const BEYOND: f64 = 0.1;
/// Postures told apart.
const PEAKS: usize = 8;
/// Two postures whose tips are nearer than this are one, body heights.
const APART: f64 = 0.04;

/// Places and angles of one segment's distal end, each with the best score of a chain that ends so.
struct Stage {
    first: [i32; 2],
    size: [i32; 2],
    angles: Vec<f64>,
    /// Number of angles of the stage before; 1 at the root.
    earlier_angles: usize,
    /// Of each pixel, row by row, each angle.
    score: Vec<f32>,
    /// The state of the stage before.
    back: Vec<u32>,
}

/// A state that can be gone on from.
struct Way {
    /// Row of the table of expectations: angle, and angle before it.
    row: usize,
    score: f32,
    state: u32,
}

impl Stage {
    fn new(chain: &Chain, before: Option<&Self>, link: &Link, level: &Level) -> Self {
        let steps = (link.expectation.reach() / ANGLE_STEP).round() as i32;
        let angles: Vec<f64> =
            (-steps..=steps).map(|k| link.expectation.angle + f64::from(k) * ANGLE_STEP).collect();
        let [low, high] = before.map_or_else(
            || {
                let corner = |sign: f64| chain.root.map(|v| v + sign * ROOT_REACH * chain.root_sd);
                [-1.0, 1.0].map(|sign| level.pixel_of_place(corner(sign)))
            },
            |stage| [stage.first, [0, 1].map(|axis| stage.first[axis] + stage.size[axis] - 1)],
        );
        let margin = (BEYOND * level.px_per_height) as i32;
        let reach_px = link.length * level.px_per_height;
        let bounds = [0, 1].map(|axis| {
            let steps =
                angles.iter().map(|angle| reach_px * if axis == 0 { angle.cos() } else { angle.sin() });
            let most = level.size_px[axis] + margin;
            let first = low[axis].saturating_add(steps.clone().fold(f64::INFINITY, f64::min).floor() as i32);
            let last = high[axis].saturating_add(steps.fold(f64::NEG_INFINITY, f64::max).ceil() as i32);
            let first = first.clamp(-margin, most);
            [first, last.clamp(first, most) - first + 1]
        });
        let states = (bounds[0][1] * bounds[1][1]) as usize * angles.len();
        Self {
            first: bounds.map(|[first, _]| first),
            size: bounds.map(|[_, size]| size),
            angles,
            earlier_angles: before.map_or(1, |stage| stage.angles.len()),
            score: vec![f32::NEG_INFINITY; states],
            back: vec![0; states],
        }
    }

    /// Number of a pixel in row order.
    fn cell(&self, pixel: [i32; 2]) -> Option<usize> {
        let [x, y] = [pixel[0] - self.first[0], pixel[1] - self.first[1]];
        ((0..self.size[0]).contains(&x) && (0..self.size[1]).contains(&y))
            .then(|| (y * self.size[0] + x) as usize)
    }

    fn pixels(&self) -> impl Iterator<Item = [i32; 2]> + use<> {
        let ([x0, y0], [width, height]) = (self.first, self.size);
        (0..height).flat_map(move |y| (0..width).map(move |x| [x0 + x, y0 + y]))
    }

    fn pixel_of_state(&self, state: usize) -> [i32; 2] {
        let cell = (state / self.angles.len()) as i32;
        [self.first[0] + cell % self.size[0], self.first[1] + cell / self.size[0]]
    }

    fn arrive_from_root(&mut self, chain: &Chain, link: &Link, level: &Level) {
        let count = self.angles.len();
        for (cell, pixel) in self.pixels().enumerate() {
            let [x, y] = level.place_of_pixel(pixel);
            for k in 0..count {
                let (sin, cos) = self.angles[k].sin_cos();
                let off =
                    distance([x - link.length * cos, y - link.length * sin], chain.root) / chain.root_sd;
                if off < ROOT_REACH {
                    let turn = link.expectation.log_probability(self.angles[k], &[]);
                    self.score[cell * count + k] = (turn - 0.5 * off * off) as f32;
                }
            }
        }
    }

    fn arrive(&mut self, before: &Self, earlier: Option<&Self>, link: &Link, level: &Level) {
        let ways = before.ways();
        let table = expected(&self.angles, &before.angles, earlier.map(|stage| &stage.angles[..]), link);
        let (count, rows) = (self.angles.len(), before.angles.len() * before.earlier_angles);
        for k in 0..count {
            let (sin, cos) = self.angles[k].sin_cos();
            let step = [cos, sin].map(|v| (v * link.length * level.px_per_height).round() as i32);
            let expected = &table[k * rows..(k + 1) * rows];
            for (cell, [x, y]) in self.pixels().enumerate() {
                let Some(joint) = before.cell([x - step[0], y - step[1]]) else { continue };
                let state = cell * count + k;
                for way in &ways[joint] {
                    let score = way.score + expected[way.row];
                    if score > self.score[state] {
                        (self.score[state], self.back[state]) = (score, way.state);
                    }
                }
            }
        }
    }

    /// For each pixel, the states that may be gone on from there, joints being loose.
    fn ways(&self) -> Vec<Vec<Way>> {
        let count = self.angles.len();
        let beside = (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| [dx, dy]));
        let way_at = |[x, y]: [i32; 2], k: usize| {
            let states = beside.clone().filter_map(|[dx, dy]| {
                let state = self.cell([x + dx, y + dy])? * count + k;
                Some((self.score[state] - LOOSE_JOINT * (dx * dx + dy * dy) as f32, state))
            });
            let (score, state) = states.max_by(|a, b| a.0.total_cmp(&b.0))?;
            let row = k * self.earlier_angles + self.back[state] as usize % self.earlier_angles;
            score.is_finite().then_some(Way { row, score, state: state as u32 })
        };
        self.pixels().map(|pixel| (0..count).filter_map(|k| way_at(pixel, k)).collect()).collect()
    }

    /// Adds to each state that is still in the running how alike the picture is.
    fn look(&mut self, link: &Link, level: &Level) {
        let least = self.score.iter().copied().fold(f32::NEG_INFINITY, f32::max) - BEAM;
        let count = self.angles.len();
        let offsets: Vec<Vec<_>> =
            link.coarse.iter().map(|t| self.angles.iter().map(|angle| t.offsets(*angle)).collect()).collect();
        let weight = link.weight as f32 / link.coarse.len().max(1) as f32;
        for (cell, pixel) in self.pixels().enumerate() {
            for k in 0..count {
                let score = &mut self.score[cell * count + k];
                if *score < least {
                    *score = f32::NEG_INFINITY;
                } else {
                    let looks = link.coarse.iter().zip(&offsets);
                    *score += weight
                        * looks
                            .map(|(t, offsets)| t.likeness_at_pixel(level, &offsets[k], pixel))
                            .sum::<f32>();
                }
            }
        }
    }
}

/// Log probability of each angle after each angle before it and each before that; row order: angle, nearest, earlier.
fn expected(angles: &[f64], nearest: &[f64], earlier: Option<&[f64]>, link: &Link) -> Vec<f32> {
    let mut table = Vec::new();
    for angle in angles {
        for nearest in nearest {
            match earlier {
                None => table.push(link.expectation.log_probability(*angle, &[*nearest]) as f32),
                Some(earlier) => table.extend(
                    earlier.iter().map(|e| link.expectation.log_probability(*angle, &[*e, *nearest]) as f32),
                ),
            }
        }
    }
    table
}

/// The stages of a chain, gone through.
pub(super) struct Search<'a> {
    level: &'a Level,
    stages: Vec<Stage>,
}

impl<'a> Search<'a> {
    pub(super) fn run(chain: &Chain, level: &'a Level) -> Self {
        let mut stages: Vec<Stage> = Vec::new();
        for (number, link) in chain.links.iter().enumerate() {
            let mut stage = Stage::new(chain, stages.last(), link, level);
            match stages.last() {
                None => stage.arrive_from_root(chain, link, level),
                Some(before) => {
                    stage.arrive(before, number.checked_sub(2).map(|earlier| &stages[earlier]), link, level);
                }
            }
            if number + 1 == chain.links.len() && chain.standing.is_some() {
                let count = stage.angles.len();
                for (pixel, scores) in stage.pixels().zip(stage.score.chunks_mut(count)) {
                    let bonus = chain.standing_bonus(level.place_of_pixel(pixel)) as f32;
                    scores.iter_mut().for_each(|score| *score += bonus);
                }
            }
            stage.look(link, level);
            stages.push(stage);
        }
        Self { level, stages }
    }

    /// The best posture of each place of the tip.
    pub(super) fn tips(&self) -> Option<TipMap> {
        let stage = self.stages.last()?;
        let count = stage.angles.len();
        let best = |(cell, pixel): (usize, [i32; 2])| {
            let states = cell * count..(cell + 1) * count;
            let state = states.max_by(|a, b| stage.score[*a].total_cmp(&stage.score[*b]))?;
            let score = stage.score[state];
            score.is_finite().then(|| Tip { place: self.level.place_of_pixel(pixel), score, state })
        };
        Some(TipMap { tips: stage.pixels().enumerate().filter_map(best).collect() })
    }

    /// Joints of the posture that ends in a state, root to tip.
    pub(super) fn joints(&self, chain: &Chain, state: usize) -> Vec<Place> {
        let mut joints = Vec::new();
        let mut state = state;
        for stage in self.stages.iter().rev() {
            joints.push(self.level.place_of_pixel(stage.pixel_of_state(state)));
            let angle = stage.angles[state % stage.angles.len()];
            if joints.len() == self.stages.len() {
                let ([x, y], length) = (joints[joints.len() - 1], chain.links[0].length);
                joints.push([x - length * angle.cos(), y - length * angle.sin()]);
            }
            state = stage.back[state] as usize;
        }
        joints.reverse();
        joints
    }
}

struct Tip {
    place: Place,
    score: f32,
    state: usize,
}

/// Where the tip may be, and how probable that is.
pub(super) struct TipMap {
    tips: Vec<Tip>,
}

impl TipMap {
    /// States of the best tips, each away from the others.
    pub(super) fn peaks(&self) -> Vec<usize> {
        let mut sorted: Vec<&Tip> = self.tips.iter().collect();
        sorted.sort_by(|a, b| b.score.total_cmp(&a.score));
        let mut peaks: Vec<&Tip> = Vec::new();
        for tip in sorted {
            if peaks.len() < PEAKS && peaks.iter().all(|peak| distance(peak.place, tip.place) > APART) {
                peaks.push(tip);
            }
        }
        peaks.into_iter().map(|peak| peak.state).collect()
    }

    /// Share of the probability within [`APART`] of a place, 0..1.
    pub(super) fn share_near(&self, place: Place) -> f64 {
        let best = self.tips.iter().map(|tip| tip.score).fold(f32::NEG_INFINITY, f32::max);
        let (mut near, mut all) = (0.0, f64::MIN_POSITIVE);
        for tip in &self.tips {
            let probability = f64::from(tip.score - best).exp();
            all += probability;
            if distance(tip.place, place) < APART {
                near += probability;
            }
        }
        near / all
    }
}
