//! Even spacing of a wall's uprights: tells which faint lines are uprights, too.

use super::lines::Upright;

/// Uprights that must agree before others are judged by them.
const FEWEST: usize = 3;
/// Places of evenly spaced uprights agree to this part of the spacing.
const TOLERANCE: f64 = 0.06;
/// This share of the certain uprights must be evenly spaced.
const MOST_EVEN: f64 = 0.6;
/// Uprights are no closer than this, px: finer lines are a grid.
const LEAST_PITCH: f64 = 12.0;
/// Leans of neighbouring uprights differ by less, px per px.
const LEAN: f64 = 0.03;

/// The spacing of a panel's certain uprights.
pub(super) struct Spacing {
    /// Place and lean at one height: polynomials in the upright's number.
    place: [f64; 3],
    lean: [f64; 3],
    /// Distance between neighbours, px.
    pitch: f64,
    y: f64,
}

impl Spacing {
    /// None when they are too few, or most of them not evenly spaced.
    pub(super) fn of(certain: &[&Upright], y: f64) -> Option<Self> {
        let places: Vec<f64> = certain.iter().map(|line| line.x(y)).collect();
        let (first, pitch) = lattice(&places)?;
        let number = |line: &Upright| ((line.x(y) - first) / pitch).round();
        let even: Vec<&&Upright> = certain.iter().filter(|line| is_even(line.x(y), first, pitch)).collect();
        let fit = |value: &dyn Fn(&Upright) -> f64, terms: usize| {
            let points: Vec<_> = even.iter().map(|line| (number(line), value(line))).collect();
            polynomial(&points, terms)
        };
        let terms = if even.len() > FEWEST { 3 } else { 2 };
        Some(Self { place: fit(&|line| line.x(y), terms)?, lean: fit(&|line| line.lean, 2)?, pitch, y })
    }

    /// Whether a line stands where an upright is due.
    pub(super) fn expects(&self, line: &Upright) -> bool {
        let x = line.x(self.y);
        let at =
            |coefficients: &[f64; 3], k: f64| coefficients[0] + k * (coefficients[1] + k * coefficients[2]);
        let guess = ((x - self.place[0]) / self.pitch).round();
        (-1..=1).map(|step| guess + f64::from(step)).any(|k| {
            (at(&self.place, k) - x).abs() < TOLERANCE * self.pitch
                && (at(&self.lean, k) - line.lean).abs() < LEAN
        })
    }
}

/// A place and a distance that put most places at even distances; of several, the largest.
fn lattice(places: &[f64]) -> Option<(f64, f64)> {
    let agreeing = |(first, pitch): (f64, f64)| places.iter().filter(|x| is_even(**x, first, pitch)).count();
    let mut best: Option<(usize, (f64, f64))> = None;
    for (i, first) in places.iter().enumerate() {
        for pitch in places[i + 1..].iter().flat_map(|x| [1.0, 2.0].map(|parts| (x - first) / parts)) {
            let count = if pitch >= LEAST_PITCH { agreeing((*first, pitch)) } else { 0 };
            if best.is_none_or(|(most, (_, widest))| count > most || count == most && pitch > widest) {
                best = Some((count, (*first, pitch)));
            }
        }
    }
    let (count, lattice) = best?;
    (count >= FEWEST && count as f64 >= MOST_EVEN * places.len() as f64).then_some(lattice)
}

fn is_even(x: f64, first: f64, pitch: f64) -> bool {
    let number = (x - first) / pitch;
    // Seen aslant, they come closer bit by bit.
    (number - number.round()).abs() < TOLERANCE * (1.0 + 0.5 * number.abs())
}

/// Least squares in the first terms of a parabola, about the mean for stability.
fn polynomial(points: &[(f64, f64)], terms: usize) -> Option<[f64; 3]> {
    let mut m = [[0.0; 4]; 3];
    for (k, value) in points {
        let powers = [1.0, *k, k * k];
        for i in 0..terms {
            (0..terms).for_each(|j| m[i][j] += powers[i] * powers[j]);
            m[i][3] += powers[i] * value;
        }
    }
    for i in 0..terms {
        let pivot = (i..terms).max_by(|a, b| m[*a][i].abs().total_cmp(&m[*b][i].abs()))?;
        m.swap(i, pivot);
        if m[i][i].abs() < 1e-9 {
            return None;
        }
        for k in (0..terms).filter(|k| *k != i) {
            let factor = m[k][i] / m[i][i];
            (i..4).for_each(|j| m[k][j] -= factor * m[i][j]);
        }
    }
    Some(std::array::from_fn(|i| if i < terms { m[i][3] / m[i][i] } else { 0.0 }))
}
