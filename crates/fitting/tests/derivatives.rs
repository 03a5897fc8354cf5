//! First and second derivatives of the whole stride problem against finite differences.

use muybridge_core::Skeleton;
use muybridge_fitting::levenberg::{Curvature, LeastSquares};
use muybridge_fitting::problem::StrideProblem;
use muybridge_fitting::synthetic::{Placing, SyntheticStride};
use muybridge_fitting::weights::Weights;

/// Step of the central differences.
const STEP: f64 = 1e-6;

/// A stride with stances through the wrap and outliers far out on the loss, the number of its placed coordinates, and
/// a point away from the rest pose and the optimum.
fn example() -> (StrideProblem, usize, Vec<f64>) {
    let (stride, weights) = (SyntheticStride::new(5, 9), Weights::default());
    let observation = stride.observe(&Placing { outlier_share: 0.1, ..Placing::default() }, &weights);
    let problem = StrideProblem::new(&Skeleton::reference(), &observation, stride.stride_time_s, &weights);
    let mut x = problem.rest_start(&observation);
    for (i, value) in x.iter_mut().enumerate() {
        *value += 0.1 * (1.3 * i as f64).sin();
    }
    (problem, 2 * observation.panels.iter().map(|panel| panel.points.len()).sum::<usize>(), x)
}

/// A function's values one step ahead and one step back along an unknown.
fn both_sides<T>(x: &[f64], unknown: usize, f: impl Fn(&[f64]) -> T) -> [T; 2] {
    [STEP, -STEP].map(|step| {
        let mut moved = x.to_vec();
        moved[unknown] += step;
        f(&moved)
    })
}

fn greatest(values: impl Iterator<Item = f64>) -> f64 {
    values.map(f64::abs).fold(0.0, f64::max)
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[test]
fn rows_agree_with_central_differences() {
    let (problem, _, x) = example();
    let mut dense: Vec<Vec<f64>> = Vec::new();
    for (_, terms) in problem.rows(&x) {
        let mut row = vec![0.0; x.len()];
        terms.iter().for_each(|(i, slope)| row[*i] += slope);
        dense.push(row);
    }
    let scales: Vec<f64> = dense.iter().map(|row| greatest(row.iter().copied())).collect();
    let mut worst = 0.0f64;
    for unknown in 0..x.len() {
        let [ahead, back] = both_sides(&x, unknown, |x| problem.rows(x));
        for (i, row) in dense.iter().enumerate() {
            let numeric = (ahead[i].0 - back[i].0) / (2.0 * STEP);
            worst = worst.max((numeric - row[unknown]).abs() / scales[i]);
        }
    }
    println!("rows differ from central differences by {worst:.1e} of their largest derivative");
    assert!(worst <= 1e-6);
}

#[test]
fn rows_cost_and_gradient_tell_the_same() {
    let (problem, _, x) = example();
    let rows = problem.rows(&x);
    assert_eq!(rows.len(), problem.residual_count());
    let half_squares = rows.iter().map(|(r, _)| 0.5 * r * r).sum::<f64>();
    let cost = (&problem).cost(&x);
    let at = (&problem).linearize(&x, Curvature::GaussNewton);
    assert!((half_squares / cost - 1.0).abs() < 1e-12 && (at.cost / cost - 1.0).abs() < 1e-12);
    let scale = greatest(at.gradient.iter().copied());
    let numeric = (0..x.len()).map(|i| {
        let [ahead, back] = both_sides(&x, i, |x| (&problem).cost(x));
        (ahead - back) / (2.0 * STEP) - at.gradient[i]
    });
    let worst = greatest(numeric) / scale;
    println!("gradient differs from central differences by {worst:.1e} of its largest component");
    assert!(worst <= 1e-6);
}

/// `J^T W J` from the folded rows: folding took the slope `loss' / sqrt(2 loss)`, the weight is `loss' / r`.
#[test]
fn gauss_newton_is_the_weighted_product_of_the_rows() {
    let (problem, coordinates, x) = example();
    let c = Weights::default().cauchy;
    let normal = (&problem).linearize(&x, Curvature::GaussNewton).normal;
    let probe: Vec<f64> = (0..x.len()).map(|i| (0.7 * i as f64).cos()).collect();
    let mut expected = vec![0.0; x.len()];
    for (i, (folded, terms)) in problem.rows(&x).iter().enumerate() {
        let weight = if i < coordinates {
            let r = folded.signum() * c * ((folded / c).powi(2).exp() - 1.0).sqrt();
            let slope = r / (1.0 + (r / c).powi(2));
            slope / r * (folded / slope).powi(2)
        } else {
            1.0
        };
        let along: f64 = terms.iter().map(|(j, slope)| slope * probe[*j]).sum();
        terms.iter().for_each(|(j, slope)| expected[*j] += weight * slope * along);
    }
    let found = normal.multiply(&probe);
    let scale = greatest(expected.iter().copied());
    let worst = greatest(found.iter().zip(&expected).map(|(a, b)| a - b)) / scale;
    println!("Gauss-Newton matrix differs from its definition by {worst:.1e}");
    assert!(worst <= 1e-10);
    assert!(dot(&probe, &found) > 0.0);
}

#[test]
fn full_curvature_agrees_with_differences_of_the_gradient() {
    let (problem, _, x) = example();
    let normal = (&problem).linearize(&x, Curvature::Full).normal;
    let mut worst = 0.0f64;
    for unknown in 0..x.len() {
        let gradient = |x: &[f64]| (&problem).linearize(x, Curvature::GaussNewton).gradient;
        let [ahead, back] = both_sides(&x, unknown, gradient);
        let mut unit = vec![0.0; x.len()];
        unit[unknown] = 1.0;
        let column = normal.multiply(&unit);
        let difference = (0..x.len()).map(|i| (ahead[i] - back[i]) / (2.0 * STEP) - column[i]);
        worst = worst.max(greatest(difference) / greatest(column.iter().copied()));
    }
    println!(
        "second derivatives differ from differences of the gradient by {worst:.1e} of their column's largest"
    );
    assert!(worst <= 1e-5);
}
