//! The problem as numbers, for solvers that are not written in Rust.

use serde::Serialize;

use super::{CURVE_SAMPLES, Problem, Sample, Weights};
use crate::energy::Support;

/// Where the ankle of a foot that is not down is put, so that its leg has a length, metres under the ground.
const ABSENT_M: f64 = 1000.0;

/// For every foot that may be down at a time, every curve and every sample of it: a number or a vector.
type OfFeet<T> = Vec<Vec<Vec<T>>>;

/// A problem's samples. The energy of knots `p0 v0 p1 v1 ...` is the sum over curves and samples of `lasts_s` times (`physics` times the
/// missing force + `comfort_per_s2` times the squared differences of the legs that are down from `nominal_m`), with the centre of mass
/// and its acceleration at a sample the sums of its curve's `p0 v0 p1 v1` with the weights `place` and `acceleration`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExportedProblem {
    /// Weights of the energy.
    pub weights: Weights,
    /// Weights of the knots' numbers in the place at each sample of each curve.
    pub place: Vec<Vec<[f64; 4]>>,
    /// The same in the acceleration, 1/s², 1/s.
    pub acceleration: Vec<Vec<[f64; 4]>>,
    /// What a sample stands for, s.
    pub lasts_s: Vec<Vec<f64>>,
    /// Whether a foot is down (1) or not (0).
    pub down: OfFeet<f64>,
    /// Ankle of the foot while flat, metres.
    pub ankle: OfFeet<[f64; 3]>,
    /// Point of support of the flat foot, metres.
    pub middle: OfFeet<[f64; 3]>,
    /// From there to the toe, metres.
    pub toe_from_middle: OfFeet<[f64; 3]>,
    /// Hip from the centre of mass, metres.
    pub hip: OfFeet<[f64; 3]>,
    /// Where the force goes through, from the centre of mass, metres.
    pub through: OfFeet<[f64; 3]>,
    /// Comfortable leg, metres.
    pub nominal_m: OfFeet<f64>,
    /// Longest leg with the foot flat, metres.
    pub longest_m: OfFeet<f64>,
}

impl Problem {
    /// The samples as numbers, with room for so many feet at a time.
    pub fn exported(&self, feet: usize) -> ExportedProblem {
        let place =
            |get: fn(&Support) -> [f64; 3]| self.of_feet(feet, move |support| support.map_or([0.0; 3], get));
        let leg = |get: fn(&Support) -> f64| self.of_feet(feet, move |support| support.map_or(1.0, get));
        let far = |get: fn(&Support) -> [f64; 3]| {
            self.of_feet(feet, move |support| support.map_or([0.0, -ABSENT_M, 0.0], get))
        };
        ExportedProblem {
            weights: self.weights,
            place: self.of_samples(|sample| sample.place),
            acceleration: self.of_samples(|sample| sample.acceleration),
            lasts_s: self.of_samples(|sample| sample.lasts_s),
            down: self.of_feet(feet, |support| f64::from(u8::from(support.is_some()))),
            ankle: far(|support| support.ankle.to_array()),
            middle: far(|support| support.middle.to_array()),
            toe_from_middle: place(|support| support.toe_from_middle.to_array()),
            hip: place(|support| support.hip.to_array()),
            through: place(|support| support.through.to_array()),
            nominal_m: leg(|support| support.nominal_m),
            longest_m: leg(|support| support.longest_m),
        }
    }

    fn of_samples<T>(&self, get: impl Fn(&Sample) -> T) -> Vec<Vec<T>> {
        self.samples.chunks(CURVE_SAMPLES).map(|curve| curve.iter().map(&get).collect()).collect()
    }

    fn of_feet<T>(&self, feet: usize, get: impl Fn(Option<&Support>) -> T) -> OfFeet<T> {
        let of = |foot: usize| {
            self.of_samples(|sample| {
                let down = &self.supports[sample.supports.clone()];
                get(down.get(foot))
            })
        };
        (0..feet).map(of).collect()
    }
}
