//! Curves through knots, and places sampled evenly in time.

use crate::chain::Vec2;

/// A curve through knots of time, value and slope, cubic between them and level outside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Curve(pub(super) &'static [[f64; 3]]);

impl Curve {
    pub(super) fn at(&self, time_s: f64) -> f64 {
        let next = self.0.partition_point(|knot| knot[0] <= time_s);
        let (Some(&[t1, v1, s1]), Some(&[t0, v0, s0])) =
            (self.0.get(next), next.checked_sub(1).and_then(|i| self.0.get(i)))
        else {
            let outer = if next == 0 { self.0.first() } else { self.0.last() };
            return outer.map_or(0.0, |knot| knot[1]);
        };
        let (span, u) = (t1 - t0, (time_s - t0) / (t1 - t0));
        let (w, passed) = (1.0 - u, u * u * (3.0 - 2.0 * u));
        v0 + (v1 - v0) * passed + span * u * w * (s0 * w - s1 * u)
    }
}

/// Places at even times, with a smooth curve through them.
#[derive(Clone, Debug)]
pub(super) struct Samples {
    from_s: f64,
    step_s: f64,
    places: Vec<Vec2>,
}

impl Samples {
    /// Zeros from one time to another; times and spacing are stretched by `pace`.
    pub(super) fn new(from_s: f64, to_s: f64, step_s: f64, pace: f64) -> Self {
        let count = ((to_s - from_s) / step_s) as usize + 1;
        Self { from_s: from_s * pace, step_s: step_s * pace, places: vec![[0.0; 2]; count] }
    }

    pub(super) fn times_s(&self) -> impl Iterator<Item = f64> {
        (0..self.places.len()).map(|k| self.from_s + k as f64 * self.step_s)
    }

    /// Sets the places, one for each of the times.
    pub(super) fn replace(&mut self, places: Vec<Vec2>) {
        self.places = places;
    }

    /// Catmull-Rom between the samples; outside, the first and the last.
    pub(super) fn at(&self, time_s: f64) -> Vec2 {
        let last = self.places.len() - 1;
        let along = ((time_s - self.from_s) / self.step_s).clamp(0.0, last as f64);
        let i = (along as usize).min(last.saturating_sub(1));
        let t = along - i as f64;
        let [p0, p1, p2, p3] =
            [i.saturating_sub(1), i, (i + 1).min(last), (i + 2).min(last)].map(|k| self.places[k]);
        [0, 1].map(|axis| {
            let [p0, p1, p2, p3] = [p0, p1, p2, p3].map(|p| p[axis]);
            let (a, b, c) = (-p0 + 3.0 * p1 - 3.0 * p2 + p3, 2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3, p2 - p0);
            p1 + 0.5 * t * (c + t * (b + t * a))
        })
    }
}
