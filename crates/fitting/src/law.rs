//! Fitting `T_c = a v^b` (Huang 2012, Eq. 3.1), with honest intervals (spec 4.3).
//!
//! Two points are interpolated exactly and carry **no** interval. From three on the nonlinear least-squares solution
//! counts (errors in seconds), with Student-t intervals; from five on it is made robust. One point takes its shape from
//! another law by the paper's amble rule.

use muybridge_core::{Interval, PowerLaw};
use nalgebra::{Matrix2, Vector2};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// One measured contact time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Contact time, s.
    pub contact_time_s: f64,
}

/// A fitted law.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LawFit {
    /// Parameters.
    pub curve: PowerLaw,
    /// Number of points.
    pub n: usize,
    /// 95 % interval; none with two points.
    pub interval: Option<Interval>,
    /// Standard errors of `a` and `b`; none with two points.
    pub standard_errors: Option<[f64; 2]>,
    /// Share of the variance explained; none with two points, where it is one by construction.
    pub r_squared: Option<f64>,
    /// Covariance of the parameters, for the band around the curve.
    covariance: Option<Matrix2<f64>>,
}

/// Least number of points for which outliers can be told from the rest.
const ROBUST_FROM: usize = 5;
/// Tukey-style constant of the Cauchy loss for 95 % efficiency at normal errors, in robust standard deviations.
const CAUCHY_EFFICIENT: f64 = 2.385;
/// Factor from a median absolute deviation to a standard deviation of normal errors.
const MAD_TO_SD: f64 = 1.4826;

impl LawFit {
    /// Half width of the 95 % confidence band of the curve at a speed, s; none with two points.
    pub fn band_half_width_s(&self, speed_m_s: f64) -> Option<f64> {
        let gradient = gradient(self.curve, speed_m_s);
        let variance = (gradient.transpose() * self.covariance? * gradient)[0];
        Some(t_quantile(self.n) * variance.max(0.0).sqrt())
    }
}

/// Fits a law through points of at least two different speeds, all positive; none otherwise.
pub fn fit_law(points: &[ContactPoint]) -> Option<LawFit> {
    let start = fit_log_law(points)?;
    if points.len() == 2 {
        return Some(start);
    }
    let mut weights = vec![1.0; points.len()];
    let mut curve = gauss_newton(points, &weights, start.curve)?;
    if points.len() >= ROBUST_FROM {
        // Reweighting converges linearly; forty rounds leave nothing of the first weights.
        for _ in 0..40 {
            let mut spread: Vec<f64> = points.iter().map(|p| residual(curve, p).abs()).collect();
            spread.sort_by(f64::total_cmp);
            let scale = CAUCHY_EFFICIENT * MAD_TO_SD * spread[spread.len() / 2];
            if scale <= 0.0 {
                break;
            }
            for (weight, point) in weights.iter_mut().zip(points) {
                *weight = 1.0 / (1.0 + (residual(curve, point) / scale).powi(2));
            }
            curve = gauss_newton(points, &weights, curve)?;
        }
    }
    Some(with_statistics(points, &weights, curve))
}

/// Closed-form straight line through the logarithms: errors in percent. Intervals for `a` are those of `ln a`, turned
/// back.
pub fn fit_log_law(points: &[ContactPoint]) -> Option<LawFit> {
    let good = points.iter().all(|p| p.speed_m_s > 0.0 && p.contact_time_s > 0.0);
    let n = points.len() as f64;
    if !good || points.len() < 2 {
        return None;
    }
    let logs: Vec<(f64, f64)> = points.iter().map(|p| (p.speed_m_s.ln(), p.contact_time_s.ln())).collect();
    let (mx, my) = logs.iter().fold((0.0, 0.0), |(sx, sy), (x, y)| (sx + x / n, sy + y / n));
    let sxx: f64 = logs.iter().map(|(x, _)| (x - mx).powi(2)).sum();
    if sxx <= 1e-12 {
        return None;
    }
    let b = logs.iter().map(|(x, y)| (x - mx) * (y - my)).sum::<f64>() / sxx;
    let ln_a = my - b * mx;
    let curve = PowerLaw { a: ln_a.exp(), b };
    let mut fit = LawFit {
        curve,
        n: points.len(),
        interval: None,
        standard_errors: None,
        r_squared: None,
        covariance: None,
    };
    if points.len() > 2 {
        let rest: f64 = logs.iter().map(|(x, y)| (y - ln_a - b * x).powi(2)).sum();
        let total: f64 = logs.iter().map(|(_, y)| (y - my).powi(2)).sum();
        let variance = rest / (n - 2.0);
        let (sb, sa) = ((variance / sxx).sqrt(), (variance * (1.0 / n + mx * mx / sxx)).sqrt());
        let t = t_quantile(points.len());
        fit.standard_errors = Some([curve.a * sa, sb]);
        fit.r_squared = Some(1.0 - rest / total);
        fit.interval =
            Some(Interval { a: [(ln_a - t * sa).exp(), (ln_a + t * sa).exp()], b: [b - t * sb, b + t * sb] });
    }
    Some(fit)
}

/// One point: the parent's curve at the point's speed and at `second_speed_m_s`, both shifted by the same time so that the
/// first meets the point; the law through the two (Huang 2012, Fig. 3.10, where the speeds are 7 and 9 mph and the
/// parent is the walk). None when the shift leaves no positive time.
pub fn shift_law(parent: PowerLaw, point: ContactPoint, second_speed_m_s: f64) -> Option<PowerLaw> {
    let shift = point.contact_time_s - parent.contact_time_s(point.speed_m_s);
    let second = ContactPoint {
        speed_m_s: second_speed_m_s,
        contact_time_s: parent.contact_time_s(second_speed_m_s) + shift,
    };
    fit_log_law(&[point, second]).map(|fit| fit.curve)
}

fn residual(curve: PowerLaw, point: &ContactPoint) -> f64 {
    point.contact_time_s - curve.contact_time_s(point.speed_m_s)
}

/// Derivatives of the contact time with respect to `a` and `b`.
fn gradient(curve: PowerLaw, speed_m_s: f64) -> Vector2<f64> {
    let power = speed_m_s.powf(curve.b);
    Vector2::new(power, curve.a * power * speed_m_s.ln())
}

/// 97.5 % quantile of Student's t at `n - 2` degrees of freedom.
fn t_quantile(n: usize) -> f64 {
    StudentsT::new(0.0, 1.0, n as f64 - 2.0).map_or(f64::NAN, |t| t.inverse_cdf(0.975))
}

fn gauss_newton(points: &[ContactPoint], weights: &[f64], start: PowerLaw) -> Option<PowerLaw> {
    let cost = |curve: PowerLaw| -> f64 {
        points.iter().zip(weights).map(|(p, w)| w * residual(curve, p).powi(2)).sum()
    };
    let mut curve = start;
    for _ in 0..100 {
        let (normal, right) = normal_equations(points, weights, curve);
        let step = normal.lu().solve(&right)?;
        let mut length = 1.0;
        let next = loop {
            let next = PowerLaw { a: curve.a + length * step[0], b: curve.b + length * step[1] };
            if next.a > 0.0 && cost(next) <= cost(curve) {
                break next;
            }
            length *= 0.5;
            if length < 1e-10 {
                break curve;
            }
        };
        let moved = (next.a - curve.a).abs() / curve.a + (next.b - curve.b).abs();
        curve = next;
        if moved < 1e-13 {
            break;
        }
    }
    Some(curve)
}

fn normal_equations(
    points: &[ContactPoint],
    weights: &[f64],
    curve: PowerLaw,
) -> (Matrix2<f64>, Vector2<f64>) {
    let mut normal = Matrix2::zeros();
    let mut right = Vector2::zeros();
    for (point, weight) in points.iter().zip(weights) {
        let g = gradient(curve, point.speed_m_s);
        normal += *weight * g * g.transpose();
        right += *weight * residual(curve, point) * g;
    }
    (normal, right)
}

fn with_statistics(points: &[ContactPoint], weights: &[f64], curve: PowerLaw) -> LawFit {
    let n = points.len();
    let weighted =
        |f: &dyn Fn(&ContactPoint) -> f64| -> f64 { points.iter().zip(weights).map(|(p, w)| w * f(p)).sum() };
    let mass: f64 = weights.iter().sum();
    let mean = weighted(&|p| p.contact_time_s) / mass;
    let rest = weighted(&|p| residual(curve, p).powi(2));
    let total = weighted(&|p| (p.contact_time_s - mean).powi(2));
    let variance = rest / (n as f64 - 2.0);
    let covariance =
        normal_equations(points, weights, curve).0.try_inverse().map(|inverse| inverse * variance);
    let errors = covariance.map(|c| [c[(0, 0)].sqrt(), c[(1, 1)].sqrt()]);
    let t = t_quantile(n);
    LawFit {
        curve,
        n,
        interval: errors.map(|[sa, sb]| Interval {
            a: [curve.a - t * sa, curve.a + t * sa],
            b: [curve.b - t * sb, curve.b + t * sb],
        }),
        standard_errors: errors,
        r_squared: Some(1.0 - rest / total),
        covariance,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(pairs: &[(f64, f64)]) -> Vec<ContactPoint> {
        pairs.iter().map(|(v, t)| ContactPoint { speed_m_s: *v, contact_time_s: *t }).collect()
    }

    /// The published walk and trot pooled, which means nothing but checks the arithmetic: the
    /// numbers are those of scipy 1.x `curve_fit` (a, b and their standard errors), which does what R's `nls` does.
    #[test]
    fn four_points_agree_with_other_statistics_programs() {
        let mps = muybridge_core::MPS_PER_MPH;
        let data = points(&[
            (3.0 * mps, 1.36865),
            (5.0 * mps, 0.95),
            (15.0 * mps, 0.339225),
            (11.0 * mps, 0.427778),
        ]);
        let fit = fit_law(&data).unwrap();
        let [sa, sb] = fit.standard_errors.unwrap();
        for (found, expected) in [
            (fit.curve.a, FOUR_POINT[0]),
            (fit.curve.b, FOUR_POINT[1]),
            (sa, FOUR_POINT[2]),
            (sb, FOUR_POINT[3]),
        ] {
            assert!((found / expected - 1.0).abs() < 1e-5, "{found} {expected}");
        }
    }
    const FOUR_POINT: [f64; 4] = [1.78659705, -0.85562641, 0.075839161, 0.057662449];

    #[test]
    fn two_points_are_met_exactly_and_carry_no_interval() {
        let data = points(&[(2.0, 0.8), (5.0, 0.4)]);
        let fit = fit_law(&data).unwrap();
        assert!(data.iter().all(|p| residual(fit.curve, p).abs() < 1e-12));
        assert!(fit.interval.is_none() && fit.band_half_width_s(3.0).is_none());
    }

    #[test]
    fn intervals_cover_the_truth_as_often_as_they_say() {
        let truth = PowerLaw { a: 0.9, b: -0.7 };
        let mut seed = 7u64;
        let mut normal = || {
            let mut sum = -6.0;
            for _ in 0..12 {
                seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                sum += (seed >> 11) as f64 / (1u64 << 53) as f64;
            }
            sum
        };
        for n in [3, 4] {
            let mut covered = 0;
            for _ in 0..1000 {
                let data: Vec<ContactPoint> = (0..n)
                    .map(|i| {
                        let speed_m_s = 2.0 + 1.7 * i as f64;
                        let noise = 0.01 * normal();
                        ContactPoint { speed_m_s, contact_time_s: truth.contact_time_s(speed_m_s) + noise }
                    })
                    .collect();
                let [low, high] = fit_law(&data).unwrap().interval.unwrap().b;
                covered += usize::from((low..=high).contains(&truth.b));
            }
            assert!((925..=975).contains(&covered), "{covered} of 1000 at n = {n}");
        }
    }

    #[test]
    fn an_outlier_among_many_does_not_pull() {
        let truth = PowerLaw { a: 0.8, b: -0.6 };
        let mut data: Vec<ContactPoint> = (1..12)
            .map(|i| {
                let speed_m_s = f64::from(i);
                let ripple = 0.002 * f64::from(i).sin();
                ContactPoint { speed_m_s, contact_time_s: truth.contact_time_s(speed_m_s) + ripple }
            })
            .collect();
        data[4].contact_time_s *= 2.0;
        let fit = fit_law(&data).unwrap();
        assert!((fit.curve.b - truth.b).abs() < 0.02, "{:?}", fit.curve);
    }

    #[test]
    fn what_cannot_be_fitted_is_none() {
        assert!(fit_law(&[]).is_none());
        assert!(fit_law(&points(&[(2.0, 0.5)])).is_none());
        assert!(fit_law(&points(&[(2.0, 0.5), (2.0, 0.6)])).is_none());
        assert!(fit_law(&points(&[(2.0, 0.5), (3.0, -0.6)])).is_none());
        assert!(fit_law(&points(&[(f64::NAN, 0.5), (3.0, 0.6)])).is_none());
        let parent = PowerLaw { a: 1.0, b: -0.5 };
        assert!(shift_law(parent, ContactPoint { speed_m_s: 1.0, contact_time_s: 0.1 }, 30.0).is_none());
    }
}
