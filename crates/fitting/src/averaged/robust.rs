//! Quantiles, and straight lines through points some of which lie.

pub(super) use crate::tracked::median;

/// Most points of which all pairs are looked at; of more an even selection is.
const MOST_POINTS: usize = 250;
/// Factor from a median absolute deviation to a standard deviation of normal errors.
const MAD_TO_SD: f64 = 1.4826;

/// The value below which a share of the values lies; none of nothing.
pub(super) fn quantile(mut values: Vec<f64>, share: f64) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let at = share * values.len().checked_sub(1)? as f64;
    let (low, high) = (values[at.floor() as usize], values[at.ceil() as usize]);
    Some(low + (high - low) * at.fract())
}

/// Standard deviation of normal errors with the same median distance from zero.
pub(super) fn robust_sd(errors: impl Iterator<Item = f64>) -> f64 {
    MAD_TO_SD * median(errors.map(f64::abs).collect()).unwrap_or(0.0)
}

/// A straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    intercept: f64,
    slope: f64,
}

impl Line {
    /// The median slope of all pairs of points, and the median intercept (Theil and Sen). None without two different x.
    pub(super) fn through(points: &[[f64; 2]]) -> Option<Self> {
        let every = points.len().div_ceil(MOST_POINTS).max(1);
        let some: Vec<[f64; 2]> = points.iter().step_by(every).copied().collect();
        let mut slopes = Vec::new();
        for (i, a) in some.iter().enumerate() {
            slopes
                .extend(some[i + 1..].iter().filter(|b| b[0] != a[0]).map(|b| (b[1] - a[1]) / (b[0] - a[0])));
        }
        let slope = median(slopes)?;
        let intercept = median(points.iter().map(|[x, y]| y - slope * x).collect())?;
        Some(Self { intercept, slope })
    }

    /// Its height at a place.
    pub(super) fn at(self, x: f64) -> f64 {
        self.intercept + self.slope * x
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_among_points_a_quarter_of_which_lie() {
        let lies = |i: i32| if i % 4 == 0 { 300.0 } else { 0.0 };
        let points: Vec<[f64; 2]> =
            (0..40).map(|i| [f64::from(i), 3.0 - 0.5 * f64::from(i) + lies(i)]).collect();
        let line = Line::through(&points).unwrap();
        assert!((line.at(10.0) + 2.0).abs() < 0.5, "{line:?}");
        assert_eq!(Line::through(&[[1.0, 2.0], [1.0, 3.0]]), None);
        assert_eq!(median(vec![4.0, 1.0]), Some(2.5));
    }
}
