//! The mean stride: every point at evenly spaced phases, how much strides differ there, and how well the mean is known.

use muybridge_capture::Keypoint;
use nalgebra::{Matrix3, Vector3};

use super::legs::{Course, Habit, Seen};
use super::robust::robust_sd;

/// Phases of the mean stride, as many as the fit's smoothness was tuned at.
pub const PHASES: usize = 24;
/// Half width of the window of the local regression, strides. Its weights fall to half at 0.59 of it, so that half of the
/// weight lies within a twenty-fourth of a stride; a parabola in it leaves peaks as high as they are.
const HALF_WIDTH: f64 = 1.5 / PHASES as f64;
/// Rounds of reweighting; weights settle in fewer than five.
const ROUNDS: usize = 6;
/// Tukey's constant: 95 % as good as the mean where errors are normal.
const TUKEY: f64 = 4.685;
/// Least standard deviation about the mean, withers heights; where labels repeat exactly, weights would fall to nothing.
const LEAST_SD: f64 = 0.003;
/// Fewest places in a window: three fix the parabola, as many again make it a mean.
const FEWEST_PLACES: usize = 6;
/// How many strides the spread of a point over all phases counts against its spread at one: a standard deviation from two
/// to four strides is good to its own half only.
const PRIOR_STRIDES: f64 = 2.0;

/// A point of the mean stride.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeanPlace {
    /// Forward of the trunk's middle and above the ground, withers heights.
    pub at: [f64; 2],
    /// Standard deviation between strides of one coordinate, withers heights.
    pub spread: f64,
    /// Standard error of one coordinate of the mean, withers heights.
    pub standard_error: f64,
    /// Strides that show it at this phase.
    pub strides: usize,
}

/// A keypoint of the mean stride; a phase that too few strides show is missing.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanPoint {
    /// The keypoint.
    pub keypoint: Keypoint,
    /// How far forward of the trunk it drifts in a stride, withers heights; taken out of its places. Points nearer to the
    /// camera than the trunk drift forward as the animal passes, points behind it drift back.
    pub drift: f64,
    /// Its place at phases `k / PHASES`.
    pub places: Vec<Option<MeanPlace>>,
}

/// The means of all courses that have one.
pub(super) fn mean_points(courses: &[Course], middle: f64) -> Vec<MeanPoint> {
    courses.iter().filter_map(|course| mean_point(course, middle)).collect()
}

fn mean_point(course: &Course, middle: f64) -> Option<MeanPoint> {
    let seen: Vec<Seen> = course.seen.iter().flatten().copied().collect();
    let habit = Habit::new(&seen, middle)?;
    // The slow change of the picture is taken out, so that all strides are seen as in the middle of the clip.
    let still: Vec<Seen> = seen
        .iter()
        .map(|s| {
            let drift = habit.drift_at(s.turns);
            Seen { turns: s.turns, at: [s.at[0] - drift[0], s.at[1] - drift[1]] }
        })
        .collect();
    let expected = |turns: f64| {
        let (at, drift) = (habit.at(turns), habit.drift_at(turns));
        [at[0] - drift[0], at[1] - drift[1]]
    };
    let mut places: Vec<Option<MeanPlace>> =
        (0..PHASES).map(|k| mean_place(&still, k as f64 / PHASES as f64, &expected)).collect();
    steady_spreads(&mut places);
    places.iter().any(Option::is_some).then_some(MeanPoint {
        keypoint: course.keypoint,
        drift: habit.drift_forward(),
        places,
    })
}

/// Strides from a phase to the nearest instant of that phase, and which stride it is in.
fn from_phase(turns: f64, phase: f64) -> (f64, i64) {
    let stride = (turns - phase).round();
    (turns - phase - stride, stride as i64)
}

fn mean_place(seen: &[Seen], phase: f64, expected: &dyn Fn(f64) -> [f64; 2]) -> Option<MeanPlace> {
    let near: Vec<(f64, i64, [f64; 2])> = seen
        .iter()
        .map(|s| (from_phase(s.turns, phase), s.at))
        .filter(|((off, _), _)| off.abs() < HALF_WIDTH)
        .map(|((off, stride), at)| (off, stride, at))
        .collect();
    let mut strides: Vec<i64> = near.iter().map(|(_, stride, _)| *stride).collect();
    strides.dedup();
    if near.len() < FEWEST_PLACES || strides.len() < 2 {
        return None;
    }
    let mut at = [0.0; 2];
    let mut variance = 0.0;
    for axis in 0..2 {
        let values: Vec<[f64; 2]> = near.iter().map(|(off, _, at)| [*off, at[axis]]).collect();
        let start: Vec<f64> = values.iter().map(|[off, v]| v - expected(phase + off)[axis]).collect();
        let (curve, weights) = local_parabola(&values, start)?;
        at[axis] = curve[0];
        let of_stride = |stride: &i64| {
            let own = near.iter().zip(&weights).filter(|((_, s, _), _)| s == stride);
            let sums = own.fold([0.0; 2], |[sum, all], ((off, _, at), weight)| {
                [sum + weight * (at[axis] - value(curve, *off)), all + weight]
            });
            (sums[1] > 0.0).then(|| sums[0] / sums[1])
        };
        let offsets: Vec<f64> = strides.iter().filter_map(of_stride).collect();
        let mean = offsets.iter().sum::<f64>() / offsets.len() as f64;
        variance +=
            offsets.iter().map(|o| (o - mean).powi(2)).sum::<f64>() / (offsets.len() as f64 - 1.0).max(1.0);
    }
    let spread = (0.5 * variance).sqrt();
    Some(MeanPlace { at, spread, standard_error: 0.0, strides: strides.len() })
}

fn value(curve: Vector3<f64>, off: f64) -> f64 {
    curve[0] + off * (curve[1] + off * curve[2])
}

/// Parabola through values near zero, with Tukey's weights; the first errors are against what is expected there. None where
/// the places do not fix it.
fn local_parabola(values: &[[f64; 2]], mut errors: Vec<f64>) -> Option<(Vector3<f64>, Vec<f64>)> {
    let mut fitted = None;
    for _ in 0..ROUNDS {
        let reach = TUKEY * robust_sd(errors.iter().copied()).max(LEAST_SD);
        let weight = |([off, _], error): (&[f64; 2], &f64)| {
            let tricube = (1.0 - (off.abs() / HALF_WIDTH).powi(3)).powi(3);
            tricube * (1.0 - (error / reach).powi(2)).max(0.0).powi(2)
        };
        let weights: Vec<f64> = values.iter().zip(&errors).map(weight).collect();
        let (mut normal, mut right) = (Matrix3::zeros(), Vector3::zeros());
        for ([off, value], weight) in values.iter().zip(&weights) {
            let row = Vector3::new(1.0, *off, off * off);
            normal += row * row.transpose() * *weight;
            right += row * (*value * *weight);
        }
        let curve = normal.cholesky()?.solve(&right);
        errors = values.iter().map(|[off, v]| v - value(curve, *off)).collect();
        fitted = Some((curve, weights));
    }
    fitted
}

/// A spread from a few strides is drawn towards the point's own over all phases; the standard errors follow from it.
fn steady_spreads(places: &mut [Option<MeanPlace>]) {
    let variances: Vec<f64> = places.iter().flatten().map(|place| place.spread.powi(2)).collect();
    let usual = variances.iter().sum::<f64>() / variances.len().max(1) as f64;
    for place in places.iter_mut().flatten() {
        let own = place.strides as f64 - 1.0;
        let variance = (own * place.spread.powi(2) + PRIOR_STRIDES * usual) / (own + PRIOR_STRIDES);
        place.spread = variance.sqrt();
        place.standard_error = (variance / place.strides as f64).sqrt();
    }
}
