//! Medians, and straight lines through points some of which lie.

/// Most points of which all pairs are looked at; of more an even selection is.
const MOST_POINTS: usize = 400;

/// The median; of an even number the mean of the middle two. None of nothing.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => None,
        n if n % 2 == 1 => Some(values[middle]),
        _ => Some(0.5 * (values[middle - 1] + values[middle])),
    }
}

/// Slope of the line through points: the median slope of all pairs, each weighted by its distance in x (Theil and Sen,
/// weighted after Jaeckel). Half of the points may be anywhere. None without two different x.
pub(super) fn slope(points: &[[f64; 2]]) -> Option<f64> {
    let every = points.len().div_ceil(MOST_POINTS).max(1);
    let points: Vec<[f64; 2]> = points.iter().step_by(every).copied().collect();
    let mut slopes: Vec<(f64, f64)> = Vec::new();
    for (index, a) in points.iter().enumerate() {
        for b in &points[index + 1..] {
            let distance = b[0] - a[0];
            if distance.abs() > f64::EPSILON {
                slopes.push(((b[1] - a[1]) / distance, distance.abs()));
            }
        }
    }
    slopes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * slopes.iter().map(|(_, weight)| weight).sum::<f64>();
    let mut sum = 0.0;
    slopes
        .iter()
        .find(|(_, weight)| {
            sum += weight;
            sum >= half
        })
        .map(|(slope, _)| *slope)
}

/// The line `y = intercept + slope x` through points; as [`slope`].
pub(super) fn line(points: &[[f64; 2]]) -> Option<[f64; 2]> {
    let slope = slope(points)?;
    let intercept = median(points.iter().map(|[x, y]| y - slope * x).collect())?;
    Some([intercept, slope])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_found_among_points_that_lie() {
        let mut points: Vec<[f64; 2]> = (0..21).map(|i| [f64::from(i), 3.0 - 0.5 * f64::from(i)]).collect();
        for index in [0, 5, 6, 18, 20] {
            points[index][1] += 400.0;
        }
        let [intercept, slope] = line(&points).unwrap();
        assert!((intercept - 3.0).abs() < 1e-9 && (slope + 0.5).abs() < 1e-9);
        assert_eq!(line(&[[1.0, 2.0], [1.0, 3.0]]), None);
        assert_eq!(median(vec![4.0, 1.0]), Some(2.5));
        assert_eq!(median(Vec::new()), None);
    }
}
