//! A path in the plan: a C1 curve of cubic Hermite pieces, measured along its length.

use glam::DVec2;
use serde::{Deserialize, Serialize};

use crate::bounds::PLACE_M;

/// Points closer than this are one, metres.
const SAME_PLACE_M: f64 = 1e-6;
/// Parts of a piece whose lengths are tabulated; with five nodes in each the length of an ordinary bend is exact to a nanometre.
const PARTS: usize = 32;
/// Most steps of the search for a length, and how near it comes, metres.
const SEARCH_STEPS: usize = 40;
const SEARCH_M: f64 = 1e-12;
/// Where a piece stands still (a tangent of zero), its direction is that so far along.
const NEARBY: f64 = 1e-4;
/// Nodes and weights of Gauss and Legendre on -1 to 1, five nodes.
const NODES: [[f64; 2]; 5] = [
    [0.0, 0.568_888_888_888_888_9],
    [-0.538_469_310_105_683_1, 0.478_628_670_499_366_5],
    [0.538_469_310_105_683_1, 0.478_628_670_499_366_5],
    [-0.906_179_845_938_664, 0.236_926_885_056_189_1],
    [0.906_179_845_938_664, 0.236_926_885_056_189_1],
];

/// A point the path goes through.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathPoint {
    /// x and z, metres.
    pub at_m: [f64; 2],
    /// Direction and pull of the path there: x and z, metres; absent: half the way between its neighbours (Catmull-Rom), at the
    /// ends what bends least.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tangent_m: Option<[f64; 2]>,
}

/// A path measured along its length.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    pieces: Vec<Piece>,
    /// Length up to each part of each piece, metres, and in the end the whole one.
    lengths_m: Vec<f64>,
}

impl Path {
    /// The path through points; none with fewer than two points that differ, or numbers that are none or farther than 10 km.
    ///
    /// Points at one place in a row count once. A path that ends where it began closes without a kink.
    pub fn through(points: &[PathPoint]) -> Option<Self> {
        let numbers = |point: &PathPoint| point.at_m.into_iter().chain(point.tangent_m.into_iter().flatten());
        if points.iter().flat_map(numbers).any(|number| !PLACE_M.contains(&number)) {
            return None;
        }
        let mut points = points.to_vec();
        points.dedup_by(|next, point| {
            let same = place(next).distance(place(point)) < SAME_PLACE_M;
            point.tangent_m = point.tangent_m.or(next.tangent_m.filter(|_| same));
            same
        });
        if points.len() < 2 {
            return None;
        }
        let tangents = tangents(&points);
        let pieces: Vec<Piece> = (1..points.len())
            .map(|i| Piece {
                from: place(&points[i - 1]),
                to: place(&points[i]),
                tangents: [tangents[i - 1], tangents[i]],
            })
            .collect();
        let mut lengths_m = vec![0.0];
        let mut length_m = 0.0;
        for piece in &pieces {
            for part in 0..PARTS {
                length_m += piece.length_m(share(part), share(part + 1));
                lengths_m.push(length_m);
            }
        }
        Some(Self { pieces, lengths_m })
    }

    /// Length, metres.
    pub fn length_m(&self) -> f64 {
        self.lengths_m.last().copied().unwrap_or(0.0)
    }

    /// Place (x, z) and unit direction at a distance along it, metres; beyond its ends it goes on straight.
    pub fn at(&self, along_m: f64) -> (DVec2, DVec2) {
        let on_path_m = along_m.clamp(0.0, self.length_m());
        let parts = self.lengths_m.len().saturating_sub(1);
        let after = self.lengths_m.partition_point(|length_m| *length_m <= on_path_m);
        let part = after.saturating_sub(1).min(parts.saturating_sub(1));
        let Some(piece) = self.pieces.get(part / PARTS) else { return (DVec2::ZERO, DVec2::X) };
        let at = piece.after(part % PARTS, on_path_m - self.lengths_m[part]);
        let direction = piece.direction(at);
        let beyond_m = if along_m.is_finite() { along_m - on_path_m } else { 0.0 };
        (piece.at(at) + direction * beyond_m, direction)
    }
}

fn place(point: &PathPoint) -> DVec2 {
    DVec2::from(point.at_m)
}

/// Where a part of a piece begins, 0 to 1.
fn share(part: usize) -> f64 {
    part as f64 / PARTS as f64
}

/// The tangents: the points' own, or Catmull's and Rom's. At an end that does not close, the curve is not bent.
fn tangents(points: &[PathPoint]) -> Vec<DVec2> {
    let last = points.len() - 1;
    let closes = last > 2 && place(&points[0]).distance(place(&points[last])) < SAME_PLACE_M;
    let given = |i: usize| points[i].tangent_m.map(DVec2::from);
    let between = |from: usize, to: usize| 0.5 * (place(&points[to]) - place(&points[from]));
    let mut tangents: Vec<DVec2> = (0..=last)
        .map(|i| match given(i) {
            Some(tangent) => tangent,
            None if closes && (i == 0 || i == last) => {
                given(last - i).unwrap_or_else(|| between(last - 1, 1))
            }
            None if i == 0 || i == last => DVec2::ZERO,
            None => between(i - 1, i + 1),
        })
        .collect();
    if !closes {
        let open = [0, last].map(|i| given(i).is_none());
        let [first_chord, last_chord] = [2.0 * between(0, 1), 2.0 * between(last - 1, last)];
        if open == [true, true] && last == 1 {
            return vec![first_chord; 2];
        }
        if open[0] {
            tangents[0] = 1.5 * first_chord - 0.5 * tangents[1];
        }
        if open[1] {
            tangents[last] = 1.5 * last_chord - 0.5 * tangents[last - 1];
        }
    }
    tangents
}

/// A cubic Hermite curve; its parameter goes from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    from: DVec2,
    to: DVec2,
    tangents: [DVec2; 2],
}

impl Piece {
    fn at(&self, u: f64) -> DVec2 {
        let v = 1.0 - u;
        self.from * (v * v * (1.0 + 2.0 * u))
            + self.to * (u * u * (3.0 - 2.0 * u))
            + self.tangents[0] * (u * v * v)
            - self.tangents[1] * (u * u * v)
    }

    fn derivative(&self, u: f64) -> DVec2 {
        let v = 1.0 - u;
        (self.to - self.from) * (6.0 * u * v)
            + self.tangents[0] * (v * (v - 2.0 * u))
            + self.tangents[1] * (u * (u - 2.0 * v))
    }

    fn direction(&self, u: f64) -> DVec2 {
        let derivative = self.derivative(u);
        if derivative.length() > NEARBY * SAME_PLACE_M {
            return derivative.normalize_or(DVec2::X);
        }
        let nearby = if u < 0.5 { u + NEARBY } else { u - NEARBY };
        self.derivative(nearby).normalize_or(DVec2::X)
    }

    fn length_m(&self, from: f64, to: f64) -> f64 {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        NODES
            .iter()
            .map(|[node, weight]| weight * self.derivative(middle + half * node).length())
            .sum::<f64>()
            * half
    }

    /// The parameter at a length after the beginning of a part: Newton's method, halving where it leaves the part.
    fn after(&self, part: usize, length_m: f64) -> f64 {
        let begin = share(part);
        let (mut low, mut high) = (begin, share(part + 1));
        let whole_m = self.length_m(low, high);
        let share_m = if whole_m > 0.0 { (length_m / whole_m).clamp(0.0, 1.0) } else { 0.0 };
        let mut at = low + (high - low) * share_m;
        for _ in 0..SEARCH_STEPS {
            let over_m = self.length_m(begin, at) - length_m;
            if over_m.abs() < SEARCH_M {
                break;
            }
            if over_m > 0.0 {
                high = at;
            } else {
                low = at;
            }
            let newton = at - over_m / self.derivative(at).length();
            at = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
        }
        at
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(places: &[[f64; 2]]) -> Vec<PathPoint> {
        places.iter().map(|at_m| PathPoint { at_m: *at_m, tangent_m: None }).collect()
    }

    fn path(places: &[[f64; 2]]) -> Path {
        Path::through(&points(places)).unwrap()
    }

    /// A circle of eight points with the tangents of a circle.
    fn circle(radius_m: f64) -> Path {
        let eighth = std::f64::consts::FRAC_PI_4;
        let pull = 4.0 * (eighth / 4.0).tan() * radius_m;
        let points: Vec<PathPoint> = (0..=8)
            .map(|i| {
                let (sin, cos) = (f64::from(i) * eighth).sin_cos();
                PathPoint {
                    at_m: [radius_m * cos, radius_m * sin],
                    tangent_m: Some([-pull * sin, pull * cos]),
                }
            })
            .collect();
        Path::through(&points).unwrap()
    }

    #[test]
    fn a_straight_line_is_as_long_as_it_is_and_goes_on_straight() {
        for line in [path(&[[1.0, 2.0], [4.0, 6.0]]), path(&[[1.0, 2.0], [1.6, 2.8], [4.0, 6.0]])] {
            assert!((line.length_m() - 5.0).abs() < 1e-9);
            for along_m in [-2.0, 0.0, 0.7, 2.5, 5.0, 9.0] {
                let (at, direction) = line.at(along_m);
                assert!((direction - DVec2::new(0.6, 0.8)).length() < 1e-9);
                assert!((at - DVec2::new(1.0 + 0.6 * along_m, 2.0 + 0.8 * along_m)).length() < 1e-9);
            }
        }
    }

    #[test]
    fn length_and_place_on_a_circle_are_those_of_the_circle() {
        let circle = circle(3.0);
        assert!((circle.length_m() / (std::f64::consts::TAU * 3.0) - 1.0).abs() < 1e-5);
        for i in 0..50 {
            let along_m = circle.length_m() * f64::from(i) / 49.0;
            let (at, direction) = circle.at(along_m);
            assert!((at.length() - 3.0).abs() < 2e-5 * 3.0);
            let (sin, cos) = (along_m / 3.0).sin_cos();
            assert!((direction - DVec2::new(-sin, cos)).length() < 1e-3);
        }
    }

    #[test]
    fn the_curve_is_continuous_and_so_is_its_direction() {
        let places = [[0.0, 0.0], [3.0, 1.0], [4.0, -2.0], [9.0, 0.5], [9.5, 4.0]];
        let path = path(&places);
        for pair in path.pieces.windows(2) {
            assert!((pair[0].at(1.0) - pair[1].at(0.0)).length() < 1e-9);
            assert!((pair[0].derivative(1.0) - pair[1].derivative(0.0)).length() < 1e-9);
        }
        let step_m = 1e-9;
        for (i, joint_m) in path.lengths_m.iter().enumerate() {
            let ((before, to), (after, from)) = (path.at(joint_m - step_m), path.at(joint_m + step_m));
            assert!((after - before).length() < 3.0 * step_m, "part {i}");
            assert!((to - from).length() < 1e-7, "part {i}");
        }
        for (i, at_m) in places.iter().enumerate() {
            let along_m = path.lengths_m[i * PARTS];
            assert!((path.at(along_m).0 - DVec2::from(*at_m)).length() < 1e-9);
        }
    }

    #[test]
    fn the_distance_along_it_is_the_way_walked() {
        let path = path(&[[0.0, 0.0], [3.0, 1.0], [4.0, -2.0], [9.0, 0.5]]);
        let step_m = path.length_m() / 20_000.0;
        let way_m: f64 = (0..20_000)
            .map(|i| path.at(f64::from(i) * step_m).0.distance(path.at(f64::from(i + 1) * step_m).0))
            .sum();
        assert!((way_m - path.length_m()).abs() < 1e-6);
    }

    #[test]
    fn a_path_that_comes_back_closes_without_a_kink() {
        let path = path(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [0.0, 0.0]]);
        let ((start, sets_out), (end, arrives)) = (path.at(0.0), path.at(path.length_m()));
        assert!((start - end).length() < 1e-9);
        assert!((sets_out - arrives).length() < 1e-9);
    }

    #[test]
    fn points_that_coincide_count_once() {
        let once = path(&[[0.0, 0.0], [2.0, 1.0], [4.0, 0.0]]);
        let twice = path(&[[0.0, 0.0], [0.0, 0.0], [2.0, 1.0], [2.0, 1.0], [4.0, 0.0]]);
        assert_eq!(once, twice);
        assert_eq!(Path::through(&points(&[[1.0, 1.0]; 5])), None);
        assert_eq!(Path::through(&points(&[[1.0, 1.0]])), None);
        assert_eq!(Path::through(&[]), None);
    }

    #[test]
    fn what_is_no_number_is_no_path() {
        for bad in [f64::NAN, f64::INFINITY, 1e9] {
            assert_eq!(Path::through(&points(&[[0.0, 0.0], [bad, 1.0]])), None);
            let pulled =
                [PathPoint { at_m: [0.0; 2], tangent_m: Some([bad, 0.0]) }, points(&[[1.0, 0.0]])[0]];
            assert_eq!(Path::through(&pulled), None);
        }
    }

    #[test]
    fn standing_still_and_turning_back_have_a_direction() {
        let still = PathPoint { at_m: [0.0; 2], tangent_m: Some([0.0; 2]) };
        let path =
            Path::through(&[still, PathPoint { at_m: [3.0, 4.0], tangent_m: Some([0.0; 2]) }]).unwrap();
        for along_m in [0.0, 2.0, 5.0] {
            assert!((path.at(along_m).1 - DVec2::new(0.6, 0.8)).length() < 1e-6);
        }
        let back = self::path(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.0]]);
        assert!(back.length_m() > 1.9);
        for i in 0..=40 {
            assert!((back.at(back.length_m() * f64::from(i) / 40.0).1.length() - 1.0).abs() < 1e-9);
        }
        assert!(back.at(f64::NAN).0.length().is_nan() || back.at(f64::NAN).0.is_finite());
        assert!(back.at(f64::INFINITY).0.is_finite());
    }
}
