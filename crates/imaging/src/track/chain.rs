//! A limb, or neck and head, as a chain of segments sought as one: the best of all its postures near the expected one.
//!
//! ## References
//! Felzenszwalb & Huttenlocher, *Pictorial structures for object recognition* (2005): the search over places and angles.

use super::climb::climb;
use super::frame::{Level, Place};
use super::template::Template;
use super::expectation::knob;

/// Step of the angles searched, radians: the end of a cannon moves by less than two pixels.
const ANGLE_STEP: f64 = 7.0 * std::f64::consts::PI / 180.0;
/// A posture this much less probable than the best one (natural logarithm) is not followed.
const BEAM: f32 = 18.0;
/// What a joint pays for lying a pixel beside the end of its bone: bones look longer or shorter from panel to panel.
const LOOSE_JOINT: f32 = 0.4;
/// Postures refined.
const HYPOTHESES: usize = 10;
/// Two postures whose tips are nearer than this are one, body heights.
const APART: f64 = 0.05;

/// One way a joint bends.
pub(super) struct Bend {
    pub(super) share: f64,
    pub(super) bend: f64,
    pub(super) per_turn: f64,
    pub(super) sd: f64,
}

/// A segment of a chain: what is expected of it and what it looks like.
pub(super) struct Link {
    /// Length in body heights, and its standard deviation as a share.
    pub(super) length: f64,
    pub(super) length_sd: f64,
    /// Angle expected from the panels before, and its standard deviation, radians.
    pub(super) angle: f64,
    pub(super) angle_sd: f64,
    pub(super) bend_limits: [f64; 2],
    pub(super) bends: Vec<Bend>,
    pub(super) knobs: [f64; 2],
    /// Farthest angle from the expected one, radians.
    pub(super) reach: f64,
    /// Weight of one unit of likeness, in units of log probability.
    pub(super) weight: f64,
    /// Its looks, for the search and for the refinement.
    pub(super) coarse: Vec<Template>,
    pub(super) fine: Vec<Template>,
}

/// Segments from a root.
pub(super) struct Chain {
    pub(super) root: Place,
    pub(super) root_sd: f64,
    pub(super) links: Vec<Link>,
    /// Where the tip would be if it stands.
    pub(super) standing: Option<Place>,
}

/// A posture found.
#[derive(Clone, Debug)]
pub(super) struct Posture {
    /// Root to tip.
    pub(super) joints: Vec<Place>,
    /// Of each segment, -1..1.
    pub(super) likeness: Vec<f64>,
    /// Log probability, up to a constant.
    pub(super) score: f64,
    /// Share of all probability near the tip.
    pub(super) certainty: f64,
    /// Score over that of the best posture with its tip elsewhere.
    pub(super) lead: f64,
}

fn wrapped(angle: f64) -> f64 {
    angle.sin().atan2(angle.cos())
}

impl Link {
    /// Log probability of an angle after those of the segments before it, nearest last.
    fn expects(&self, angle: f64, before: &[f64]) -> f64 {
        let sds = self.knobs[0];
        let nu = self.knobs[1];
        let off = wrapped(angle - self.angle) / self.angle_sd / sds;
        let t = -0.5 * (nu + 1.0) * (1.0 + off * off / nu).ln();
        let Some(nearest) = before.last() else { return t };
        let bend = wrapped(angle - nearest);
        let beyond = (self.bend_limits[0] - bend).max(bend - self.bend_limits[1]).max(0.0);
        let limit = -0.5 * (beyond / 0.15).powi(2);
        let mut likely = 0.0;
        if !self.bends.is_empty() {
            let turn = if before.len() > 1 { wrapped(nearest - before[before.len() - 2]) } else { 0.0 };
            likely = self.bends.iter().map(|m| {
                let off = wrapped(bend - m.bend - m.per_turn * turn) / m.sd;
                m.share / m.sd * (-0.5 * off * off).exp()
            }).sum::<f64>().max(1e-6).ln();
        }
        t + limit + likely
    }

    fn angles(&self) -> Vec<f64> {
        let steps = (self.reach / ANGLE_STEP).round() as i32;
        (-steps..=steps).map(|k| self.angle + f64::from(k) * ANGLE_STEP).collect()
    }

    fn likeness(&self, level: &Level, place: Place, angle: f64) -> f64 {
        let of = |template: &Template| {
            let layers = template.likeness(level, place, angle);
            f64::from(layers.iter().sum::<f32>()) / layers.len() as f64
        };
        let values = self.fine.iter().map(of);
        if knob("MAX", 0.0) > 0.0 {
            values.fold(-1.0, f64::max)
        } else {
            values.sum::<f64>() / self.fine.len().max(1) as f64
        }
    }
}

/// Places and angles of one segment, each with the best score of a chain that ends so.
struct Stage {
    first: [i32; 2],
    size: [i32; 2],
    angles: Vec<f64>,
    score: Vec<f32>,
    /// The state of the segment before.
    back: Vec<u32>,
    /// Angles of the stage before
    before: Vec<f64>,
}

impl Stage {
    fn index(&self, pixel: [i32; 2], angle: usize) -> Option<usize> {
        let [x, y] = [pixel[0] - self.first[0], pixel[1] - self.first[1]];
        ((0..self.size[0]).contains(&x) && (0..self.size[1]).contains(&y))
            .then(|| (y * self.size[0] + x) as usize * self.angles.len() + angle)
    }

    fn pixel(&self, state: usize) -> [i32; 2] {
        let cell = (state / self.angles.len()) as i32;
        [self.first[0] + cell % self.size[0], self.first[1] + cell / self.size[0]]
    }

    fn pixels(&self) -> impl Iterator<Item = [i32; 2]> + use<> {
        let ([x0, y0], [width, height]) = (self.first, self.size);
        (0..height).flat_map(move |y| (0..width).map(move |x| [x0 + x, y0 + y]))
    }

    /// Best scores when each end may be a pixel beside.
    fn loosened(&self) -> (Vec<f32>, Vec<u32>) {
        let mut best = self.score.clone();
        let mut from: Vec<u32> = (0..best.len() as u32).collect();
        for pixel in self.pixels() {
            for (dx, dy) in (-1..=1).flat_map(|dy| (-1..=1).map(move |dx| (dx, dy))) {
                let Some(other) = self.index([pixel[0] + dx, pixel[1] + dy], 0) else { continue };
                let Some(own) = self.index(pixel, 0) else { continue };
                let cost = LOOSE_JOINT * ((dx * dx + dy * dy) as f32);
                for k in 0..self.angles.len() {
                    let score = self.score[other + k] - cost;
                    if score > best[own + k] {
                        best[own + k] = score;
                        from[own + k] = (other + k) as u32;
                    }
                }
            }
        }
        (best, from)
    }
}

impl Chain {
    /// The best postures, each with its tip elsewhere.
    pub(super) fn find(&self, coarse: &Level, fine: &Level) -> Vec<Posture> {
        let t0 = std::time::Instant::now();
        let stages = self.search(coarse);
        if knob("PROF", 0.0) > 0.0 { eprintln!("search {:.3} states {}", t0.elapsed().as_secs_f64(), stages.iter().map(|s| s.score.len()).sum::<usize>()); }
        let t0 = std::time::Instant::now();
        let Some(tips) = stages.last() else { return Vec::new() };
        let map = TipMap::new(tips, coarse);
        let out = map.peaks()
            .into_iter()
            .map(|state| {
                let mut posture = self.refine(fine, &Self::trace(&stages, state, coarse));
                posture.certainty = posture.joints.last().map_or(0.0, |tip| map.share_near(*tip));
                posture
            })
            .collect();
        if knob("PROF", 0.0) > 0.0 { eprintln!("refine {:.3}", t0.elapsed().as_secs_f64()); }
        out
    }

    fn stage_box(&self, before: Option<&Stage>, link: &Link, level: &Level) -> ([i32; 2], [i32; 2]) {
        let scale = level.px_per_height;
        let reach: Vec<Place> =
            link.angles().iter().map(|a| [a.cos(), a.sin()].map(|v| v * link.length)).collect();
        let (low, high) = match before {
            Some(stage) => {
                (stage.first, [stage.first[0] + stage.size[0] - 1, stage.first[1] + stage.size[1] - 1])
            }
            None => {
                let r = 2.5 * self.root_sd;
                let pixel = |sign: f64| level.pixel_of_place(self.root.map(|v| v + sign * r));
                (pixel(-1.0), pixel(1.0))
            }
        };
        let bound = |axis: usize, max: bool| {
            let all = reach.iter().map(|place| place[axis] * scale);
            if max { all.fold(f64::NEG_INFINITY, f64::max).ceil() } else { all.fold(f64::INFINITY, f64::min).floor() }
        };
        let size = level.size();
        let margin = (0.1 * scale) as i32;
        let first: [i32; 2] = std::array::from_fn(|a| (low[a] + bound(a, false) as i32).clamp(-margin, size[a] + margin));
        let last: [i32; 2] = std::array::from_fn(|a| (high[a] + bound(a, true) as i32).clamp(first[a], size[a] + margin));
        (first, [last[0] - first[0] + 1, last[1] - first[1] + 1])
    }

    fn search(&self, level: &Level) -> Vec<Stage> {
        let mut stages: Vec<Stage> = Vec::new();
        for (number, link) in self.links.iter().enumerate() {
            let (first, size) = self.stage_box(stages.last(), link, level);
            let angles = link.angles();
            let states = (size[0] * size[1]) as usize * angles.len();
            let mut stage =
                Stage { first, size, angles, score: vec![f32::NEG_INFINITY; states], back: vec![0; states], before: stages.last().map_or(vec![0.0], |b: &Stage| b.angles.clone()) };
            match stages.last() {
                None => self.arrive_from_root(&mut stage, link, level),
                Some(before) => Self::arrive(&mut stage, before, link, level),
            }
            if number + 1 == self.links.len() {
                self.stand(&mut stage, level);
            }
            let t0 = std::time::Instant::now();
            look(&mut stage, link, level);
            if knob("PROF", 0.0) > 0.0 { eprintln!("  look {:.3} {} kept {}", t0.elapsed().as_secs_f64(), stage.score.len(), stage.score.iter().filter(|s| s.is_finite()).count()); }
            stages.push(stage);
        }
        stages
    }

    fn arrive_from_root(&self, stage: &mut Stage, link: &Link, level: &Level) {
        for pixel in stage.pixels() {
            let [x, y] = level.place_of_pixel(pixel);
            for k in 0..stage.angles.len() {
                let angle = stage.angles[k];
                let root = [x - link.length * angle.cos(), y - link.length * angle.sin()];
                let off = apart(root, self.root) / self.root_sd;
                if off < 3.0 && let Some(state) = stage.index(pixel, k) {
                    stage.score[state] = (link.expects(angle, &[]) - 0.5 * off * off) as f32;
                }
            }
        }
    }

    fn arrive(stage: &mut Stage, before: &Stage, link: &Link, level: &Level) {
        let (scores, from) = before.loosened();
        let (own, earlier) = (before.angles.len(), before.before.len());
        let mut table = vec![0.0f32; stage.angles.len() * own * earlier];
        for (k, angle) in stage.angles.iter().enumerate() {
            for (b, nearest) in before.angles.iter().enumerate() {
                for (a, first) in before.before.iter().enumerate() {
                    table[(k * own + b) * earlier + a] = if earlier > 1 { link.expects(*angle, &[*first, *nearest]) } else { link.expects(*angle, &[*nearest]) } as f32;
                }
            }
        }
        let alive: Vec<Vec<(usize, f32, u32)>> = (0..scores.len() / own)
            .map(|cell| {
                (0..own)
                    .filter(|b| scores[cell * own + b].is_finite())
                    .map(|b| {
                        let from = from[cell * own + b];
                        let first = before.back[from as usize] as usize % earlier;
                        (b * earlier + first, scores[cell * own + b], from)
                    })
                    .collect()
            })
            .collect();
        let count = stage.angles.len();
        for k in 0..count {
            let (sin, cos) = stage.angles[k].sin_cos();
            let step = [cos, sin].map(|v| (v * link.length * level.px_per_height).round() as i32);
            let table = &table[k * own * earlier..(k + 1) * own * earlier];
            for (cell, pixel) in stage.pixels().enumerate() {
                let Some(joint) = before.index([pixel[0] - step[0], pixel[1] - step[1]], 0) else { continue };
                let state = cell * count + k;
                for (row, score, from) in &alive[joint / own] {
                    let score = score + table[*row];
                    if score > stage.score[state] {
                        stage.score[state] = score;
                        stage.back[state] = *from;
                    }
                }
            }
        }
    }

    fn stand(&self, stage: &mut Stage, level: &Level) {
        let angles = stage.angles.len();
        for (cell, pixel) in stage.pixels().enumerate() {
            let bonus = self.standing_bonus(level.place_of_pixel(pixel)) as f32;
            stage.score[cell * angles..(cell + 1) * angles].iter_mut().for_each(|score| *score += bonus);
        }
    }

    fn standing_bonus(&self, tip: Place) -> f64 {
        const BONUS: f64 = 3.0;
        const SD: f64 = 0.05;
        self.standing.map_or(0.0, |place| BONUS * (-0.5 * (apart(tip, place) / SD).powi(2)).exp())
    }

    /// Root and angles of the chain that ends in a state.
    fn trace(stages: &[Stage], state: usize, level: &Level) -> Vec<Place> {
        let mut joints = Vec::new();
        let mut state = state;
        for (number, stage) in stages.iter().enumerate().rev() {
            joints.push(level.place_of_pixel(stage.pixel(state)));
            if number == 0 {
                joints.push([stage.angles[state % stage.angles.len()]; 2]);
            }
            state = stage.back[state] as usize;
        }
        joints.reverse();
        joints
    }

    fn joints(&self, unknowns: &[f64]) -> Vec<Place> {
        let count = self.links.len();
        let mut joints = vec![[unknowns[0], unknowns[1]]];
        for i in 0..count {
            let [x, y] = joints[i];
            let (angle, length) = (unknowns[2 + i], unknowns[2 + count + i] * self.links[i].length);
            joints.push([x + length * angle.cos(), y + length * angle.sin()]);
        }
        joints
    }

    fn score(&self, level: &Level, unknowns: &[f64]) -> f64 {
        let count = self.links.len();
        let joints = self.joints(unknowns);
        let mut score = -0.5 * (apart(joints[0], self.root) / self.root_sd).powi(2);
        for (i, link) in self.links.iter().enumerate() {
            let angle = unknowns[2 + i];
            let before = &unknowns[2..2 + i];
            let stretch = (unknowns[2 + count + i] - 1.0) / link.length_sd;
            score += link.expects(angle, before) - 0.5 * stretch * stretch;
            score += link.weight * link.likeness(level, joints[i + 1], angle);
        }
        score + joints.last().map_or(0.0, |tip| self.standing_bonus(*tip))
    }

    pub(super) fn refine(&self, level: &Level, traced: &[Place]) -> Posture {
        let count = self.links.len();
        let ([angle, _], first) = (traced[0], traced[1]);
        let length = self.links[0].length;
        let mut unknowns = vec![first[0] - length * angle.cos(), first[1] - length * angle.sin(), angle];
        let mut lengths = vec![1.0];
        for i in 1..count {
            let [dx, dy] = [traced[i + 1][0] - traced[i][0], traced[i + 1][1] - traced[i][1]];
            unknowns.push(dy.atan2(dx));
            lengths.push(dx.hypot(dy) / self.links[i].length);
        }
        unknowns.extend(lengths);
        let mut steps = vec![0.015; 2];
        steps.extend(std::iter::repeat_n(0.08, count));
        steps.extend(std::iter::repeat_n(0.06, count));
        let score = climb(&mut unknowns, &steps, 4, |u| self.score(level, u));
        let joints = self.joints(&unknowns);
        let likeness =
            self.links.iter().enumerate().map(|(i, link)| link.likeness(level, joints[i + 1], unknowns[2 + i]));
        Posture { likeness: likeness.collect(), joints, score, certainty: 0.0, lead: 0.0 }
    }
}

/// Adds to each state that is still in the running how alike the picture is.
fn look(stage: &mut Stage, link: &Link, level: &Level) {
    let best = stage.score.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    let count = stage.angles.len();
    let offsets: Vec<Vec<Vec<[i32; 2]>>> =
        link.coarse.iter().map(|t| stage.angles.iter().map(|a| t.offsets(*a)).collect()).collect();
    let knob_max = knob("MAX", 0.0) > 0.0;
    for (cell, pixel) in stage.pixels().enumerate() {
        for k in 0..count {
            let score = &mut stage.score[cell * count + k];
            if *score < best - BEAM {
                *score = f32::NEG_INFINITY;
                continue;
            }
            let max = knob_max;
            let mut likeness = if max { -1.0f32 } else { 0.0 };
            for (template, offsets) in link.coarse.iter().zip(&offsets) {
                let layers = template.layers(level);
                let sum: f32 = (0..layers)
                    .map(|layer| template.likeness_at_pixel(level, layer, &offsets[k], pixel))
                    .sum();
                let value = sum / layers as f32;
                likeness = if max { likeness.max(value) } else { likeness + value };
            }
            *score += link.weight as f32 * likeness / if max { 1.0 } else { link.coarse.len().max(1) as f32 };
        }
    }
}

/// For each place of the tip, the best posture that ends there.
struct TipMap {
    places: Vec<(Place, f32, usize)>,
}

impl TipMap {
    fn new(stage: &Stage, level: &Level) -> Self {
        let count = stage.angles.len();
        let places = stage.pixels().enumerate().filter_map(|(cell, pixel)| {
            let states = cell * count..(cell + 1) * count;
            let state = states.max_by(|a, b| stage.score[*a].total_cmp(&stage.score[*b]))?;
            let score = stage.score[state];
            score.is_finite().then(|| (level.place_of_pixel(pixel), score, state))
        });
        Self { places: places.collect() }
    }

    /// States of the best tips, each away from the others.
    fn peaks(&self) -> Vec<usize> {
        let mut sorted: Vec<&(Place, f32, usize)> = self.places.iter().collect();
        sorted.sort_by(|a, b| b.1.total_cmp(&a.1));
        let mut peaks: Vec<&(Place, f32, usize)> = Vec::new();
        for candidate in sorted {
            if peaks.iter().all(|peak| apart(peak.0, candidate.0) > APART) {
                peaks.push(candidate);
            }
            if peaks.len() == HYPOTHESES {
                break;
            }
        }
        peaks.into_iter().map(|peak| peak.2).collect()
    }

    fn share_near(&self, tip: Place) -> f64 {
        let best = self.places.iter().map(|place| place.1).fold(f32::NEG_INFINITY, f32::max);
        let (mut near, mut all) = (0.0, 0.0);
        for (place, score, _) in &self.places {
            let probability = f64::from(score - best).exp();
            all += probability;
            if apart(*place, tip) < APART {
                near += probability;
            }
        }
        near / all
    }
}

fn apart(a: Place, b: Place) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
