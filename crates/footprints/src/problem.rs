//! The unknowns and the energy of a whole motion (van de Panne 1997, 2.3 and 2.4).

mod export;

use std::ops::Range;

use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

use crate::energy::{Derivatives, Foreseen, MOST_FEET, Support, Terms, derivatives, energy};
use crate::knots::{Knot, KnotWeights, acceleration_weights, place_weights, weighted};
use crate::orientation::Orientation;
use crate::pendulum;
use crate::stance::Stance;

pub use export::ExportedProblem;

/// Samples of the energy on each curve (van de Panne 1997, 2.4.3), in the middles of ten equal parts.
pub const CURVE_SAMPLES: usize = 10;
/// Numbers of a knot: place and velocity.
pub(crate) const KNOT_SIZE: usize = 6;
/// Footfalls and flights nearer to each other than this share a knot, s: a curve of a thousandth of a second would be bent like a needle.
const LEAST_CURVE_S: f64 = 0.02;

/// Parts of curves that differ by less are as long, s.
const SAME_S: f64 = 1e-9;

/// Weights of the energy.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Weights {
    /// Of the force that nobody exerts.
    pub physics: f64,
    /// The paper's k: of the squared difference of a leg from its comfortable length, 1/s². At 200 a leg that is 7 cm off weighs as much as
    /// a tenth of the body's weight that nobody carries; the paper gives no number.
    pub comfort_per_s2: f64,
    /// Way of the leg beyond its longest over which the support goes from the middle of the foot to its toe, metres; 0 switches
    /// at once, as the paper does.
    pub toe_band_m: f64,
}

impl Default for Weights {
    fn default() -> Self {
        Self { physics: 1.0, comfort_per_s2: 200.0, toe_band_m: 0.06 }
    }
}

impl Weights {
    /// What is wrong with the numbers, if anything.
    pub fn fault(&self) -> Option<String> {
        let fits = |what: &str, value: f64, most: f64| {
            let wrong = !(0.0..=most).contains(&value);
            wrong.then(|| format!("weights: {what} is {value}; it must be between 0 and {most}"))
        };
        fits("physics", self.physics, 1e6)
            .or_else(|| fits("comfort_per_s2", self.comfort_per_s2, 1e6))
            .or_else(|| fits("toe_band_m", self.toe_band_m, 10.0))
    }
}

/// The energy of a motion, m/s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Energy {
    /// Of forces that nobody exerts.
    pub physics: f64,
    /// Of uncomfortable legs.
    pub comfort: f64,
}

impl Energy {
    /// Both, m/s.
    pub fn total(self) -> f64 {
        self.physics + self.comfort
    }
}

/// A moment at which the energy is sampled.
#[derive(Clone, Debug)]
struct Sample {
    place: KnotWeights,
    acceleration: KnotWeights,
    /// What the sample stands for, s.
    lasts_s: f64,
    /// The feet on the ground, in the problem's list.
    supports: Range<usize>,
}

/// Stances, knots' times and samples: everything but the curve.
#[derive(Clone, Debug)]
pub struct Problem {
    times_s: Vec<f64>,
    start: Vec<Knot>,
    weights: Weights,
    /// Whether the first and the last knot are at rest.
    rests: [bool; 2],
    /// [`CURVE_SAMPLES`] for each curve.
    samples: Vec<Sample>,
    supports: Vec<Support>,
}

/// A row of second derivatives, and all of one knot with another.
pub(crate) type Row = [f64; KNOT_SIZE];
pub(crate) type Block = [Row; KNOT_SIZE];

/// The energy of a curve with its derivatives by its two knots.
#[derive(Clone, Debug, Default)]
pub(crate) struct BentCurve {
    pub(crate) energy: f64,
    pub(crate) gradient: [Knot; 2],
    /// Second derivatives of the first knot with itself, the first with the second, the second with itself.
    pub(crate) blocks: [Block; 3],
}

impl Problem {
    /// The problem of stances up to the end of the motion, with a planned orientation of the body. At most four feet on the ground at a
    /// time count.
    pub fn new(stances: &[Stance], end_s: f64, orientation: &Orientation, weights: Weights) -> Self {
        let mut stances = stances.to_vec();
        stances.sort_by(|a, b| a.from_s.total_cmp(&b.from_s).then(a.foot.cmp(&b.foot)));
        let times_s = knot_times_s(&stances, end_s);
        let start = starts(&stances, &times_s, orientation);
        let rests = [false; 2];
        let mut problem = Self { times_s, start, weights, rests, samples: Vec::new(), supports: Vec::new() };
        problem.sample(&stances, orientation);
        problem
    }

    fn sample(&mut self, stances: &[Stance], orientation: &Orientation) {
        let (mut past, mut running): (usize, Vec<&Stance>) = (0, Vec::new());
        for curve in 0..self.curves() {
            let (from_s, to_s) = (self.times_s[curve], self.times_s[curve + 1]);
            let duration_s = to_s - from_s;
            running.retain(|stance| stance.to_s > from_s);
            while let Some(stance) = stances.get(past).filter(|stance| stance.from_s < to_s) {
                running.push(stance);
                past += 1;
            }
            for i in 0..CURVE_SAMPLES {
                let share = (i as f64 + 0.5) / CURVE_SAMPLES as f64;
                let time_s = from_s + share * duration_s;
                let first = self.supports.len();
                let down = running.iter().filter(|stance| stance.from_s <= time_s && time_s < stance.to_s);
                let supports = down.take(MOST_FEET).map(|stance| stance.support(orientation, time_s));
                self.supports.extend(supports);
                self.samples.push(Sample {
                    place: place_weights(share, duration_s),
                    acceleration: acceleration_weights(share, duration_s),
                    lasts_s: duration_s / CURVE_SAMPLES as f64,
                    supports: first..self.supports.len(),
                });
            }
        }
    }

    /// The same with the centre of mass at rest at the beginning, at the end, or both: a figure that stands there. Free ends, as the
    /// paper has them, suit a figure that comes from somewhere and goes on.
    #[must_use]
    pub fn at_rest(mut self, rests: [bool; 2]) -> Self {
        self.rests = rests;
        self
    }

    /// Whether a knot has no velocity.
    pub(crate) fn rests(&self, knot: usize) -> bool {
        (self.rests[0] && knot == 0) || (self.rests[1] && knot + 1 == self.times_s.len())
    }

    /// Number of curves.
    pub fn curves(&self) -> usize {
        self.times_s.len().saturating_sub(1)
    }

    /// Times of the knots, s: footfalls, beginnings of flights, and the end.
    pub fn times_s(&self) -> &[f64] {
        &self.times_s
    }

    /// The paper's start: every leg at its comfortable length above its print, at rest.
    pub fn start(&self) -> Vec<Knot> {
        self.start.clone()
    }

    /// The energy of a curve through knots, as many as there are times.
    pub fn energy(&self, knots: &[Knot]) -> Energy {
        let mut sum = Energy::default();
        for curve in 0..self.curves() {
            let [physics, comfort] = self.curve_energy(curve, [&knots[curve], &knots[curve + 1]], 0.0);
            sum.physics += physics;
            sum.comfort += comfort;
        }
        sum
    }

    /// Gradient of [`Problem::energy`] by each knot's place and velocity.
    pub fn gradient(&self, knots: &[Knot]) -> Vec<Knot> {
        let mut gradient = vec![Knot::default(); knots.len()];
        for curve in 0..self.curves() {
            let ends = [&knots[curve], &knots[curve + 1]];
            let by = self.bend_curve(curve, ends, 0.0, &mut Default::default()).gradient;
            for (sum, by) in gradient[curve..].iter_mut().zip(by) {
                sum.at += by.at;
                sum.velocity += by.velocity;
            }
        }
        gradient
    }

    /// Whether a curve of another problem with as many knots lasts as long over the same feet, but for what nobody sees.
    pub(crate) fn has_same_curve(&self, other: &Self, curve: usize) -> bool {
        let mut samples = self.samples(curve).zip(other.samples(curve));
        samples.all(|((sample, supports), (others, other_supports))| {
            (sample.lasts_s - others.lasts_s).abs() < SAME_S
                && supports.len() == other_supports.len()
                && supports.iter().zip(other_supports).all(|(support, other)| support.is_near(other))
        })
    }

    fn terms(&self, smoothing: f64) -> Terms {
        let Weights { physics, comfort_per_s2, toe_band_m } = self.weights;
        Terms { physics, comfort_per_s2, toe_band_m, smoothing }
    }

    fn samples(&self, curve: usize) -> impl Iterator<Item = (&Sample, &[Support])> {
        let samples = &self.samples[curve * CURVE_SAMPLES..(curve + 1) * CURVE_SAMPLES];
        samples.iter().map(|sample| (sample, &self.supports[sample.supports.clone()]))
    }

    /// Physics and comfort of one curve between its knots; `smoothing` rounds the point of the missing force's length at zero, m/s².
    pub(crate) fn curve_energy(&self, curve: usize, [first, second]: [&Knot; 2], smoothing: f64) -> [f64; 2] {
        let terms = self.terms(smoothing);
        let mut sums = [0.0; 2];
        for (sample, supports) in self.samples(curve) {
            let centre = weighted(&sample.place, first, second);
            let acceleration = weighted(&sample.acceleration, first, second);
            let parts = energy(supports, centre, acceleration, &terms);
            sums[0] += parts[0] * sample.lasts_s;
            sums[1] += parts[1] * sample.lasts_s;
        }
        sums
    }

    /// A curve between its knots with its derivatives; `foreseen` is what was foreseen a step ago and then what is foreseen now.
    pub(crate) fn bend_curve(
        &self,
        curve: usize,
        [first, second]: [&Knot; 2],
        smoothing: f64,
        foreseen: &mut [Foreseen; CURVE_SAMPLES],
    ) -> BentCurve {
        let terms = self.terms(smoothing);
        let mut bent = BentCurve::default();
        for ((sample, supports), foreseen) in self.samples(curve).zip(foreseen) {
            let centre = weighted(&sample.place, first, second);
            let acceleration = weighted(&sample.acceleration, first, second);
            let at = derivatives(supports, centre, acceleration, &terms, foreseen);
            *foreseen = at.foreseen;
            bent.add(sample, at);
        }
        bent
    }

    /// The same of the pendulum's energy, from which the solver begins.
    pub(crate) fn bend_pendulum(&self, curve: usize, [first, second]: [&Knot; 2]) -> BentCurve {
        let weights = [self.weights.physics, self.weights.comfort_per_s2];
        let mut bent = BentCurve::default();
        for (sample, supports) in self.samples(curve) {
            let centre = weighted(&sample.place, first, second);
            let acceleration = weighted(&sample.acceleration, first, second);
            bent.add(sample, pendulum::derivatives(supports, centre, acceleration, weights));
        }
        bent
    }
}

impl BentCurve {
    fn add(&mut self, sample: &Sample, mut at: Derivatives) {
        at.scale(sample.lasts_s);
        self.energy += at.energy;
        let by = |i: usize| sample.place[i] * at.by_place + sample.acceleration[i] * at.by_acceleration;
        for (knot, first) in self.gradient.iter_mut().zip([0, 2]) {
            knot.at += by(first);
            knot.velocity += by(first + 1);
        }
        sample.add_blocks(&at, &mut self.blocks);
    }
}

impl Derivatives {
    fn scale(&mut self, by: f64) {
        self.energy *= by;
        self.by_place *= by;
        self.by_acceleration *= by;
        self.bend_place *= by;
        self.bend_mixed *= by;
        self.bend_acceleration *= by;
    }
}

impl Sample {
    /// Adds second derivatives by place and acceleration as those by the knots' numbers.
    fn add_blocks(&self, at: &Derivatives, blocks: &mut [Block; 3]) {
        let mixed_back = at.bend_mixed.transpose();
        for i in 0..4 {
            // Rows of number i: how place and acceleration of the moment answer to it.
            let place = at.bend_place * self.place[i] + mixed_back * self.acceleration[i];
            let acceleration = at.bend_mixed * self.place[i] + at.bend_acceleration * self.acceleration[i];
            for j in i..4 {
                let part = place * self.place[j] + acceleration * self.acceleration[j];
                let block = &mut blocks[i / 2 + j / 2];
                add_part(block, [i % 2, j % 2], &part);
                if i / 2 == j / 2 && i != j {
                    add_part(block, [j % 2, i % 2], &part.transpose());
                }
            }
        }
    }
}

fn add_part(block: &mut Block, [row, column]: [usize; 2], part: &DMat3) {
    for (j, column_of_part) in [part.x_axis, part.y_axis, part.z_axis].into_iter().enumerate() {
        for i in 0..3 {
            block[3 * row + i][3 * column + j] += column_of_part[i];
        }
    }
}

impl Stance {
    fn support(&self, orientation: &Orientation, time_s: f64) -> Support {
        let hip = orientation.at(time_s) * self.hip_from_com;
        Support {
            ankle: self.ankle,
            middle: self.middle,
            toe_from_middle: self.toe - self.middle,
            hip,
            through: hip * self.force_through_hip,
            nominal_m: self.nominal_m,
            longest_m: self.longest_m,
        }
    }
}

/// Footfalls, beginnings of flights, and the end; at least one time.
fn knot_times_s(stances: &[Stance], end_s: f64) -> Vec<f64> {
    let mut times_s = vec![stances.first().map_or(0.0, |stance| stance.from_s)];
    let mut until_s = f64::NEG_INFINITY;
    let mut add = |time_s: f64| {
        if time_s >= times_s[times_s.len() - 1] + LEAST_CURVE_S && time_s <= end_s - LEAST_CURVE_S {
            times_s.push(time_s);
        }
    };
    for stance in stances {
        if until_s < stance.from_s {
            add(until_s);
        }
        add(stance.from_s);
        until_s = until_s.max(stance.to_s);
    }
    add(until_s);
    if end_s > times_s[times_s.len() - 1] {
        times_s.push(end_s);
    }
    times_s
}

/// For each knot the place at which the latest foot to strike stands under its hip, with a comfortable leg; at rest. The hip's distance
/// from the median plane does not count: the centre of mass is above the print.
fn starts(stances: &[Stance], times_s: &[f64], orientation: &Orientation) -> Vec<Knot> {
    let over = |stance: &Stance| {
        let hip = orientation.at(stance.from_s) * stance.hip_from_com.with_z(0.0);
        stance.ankle + DVec3::Y * stance.nominal_m - hip
    };
    let place = |&time_s: &f64| {
        let struck = stances.partition_point(|stance| stance.from_s <= time_s + LEAST_CURVE_S / 2.0);
        let Some(latest) = struck.checked_sub(1).map(|i| &stances[i]) else { return DVec3::ZERO };
        let together = stances[..struck].iter().rev();
        let together = together.take_while(|stance| latest.from_s - stance.from_s < LEAST_CURVE_S);
        let (sum, count) =
            together.fold((DVec3::ZERO, 0.0), |(sum, count), stance| (sum + over(stance), count + 1.0));
        sum / count
    };
    times_s.iter().map(|time_s| Knot { at: place(time_s), velocity: DVec3::ZERO }).collect()
}

#[cfg(test)]
mod tests;
