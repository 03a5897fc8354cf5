//! A way that turns, laid out straight: how far the body has come where it faces, and how far before or behind that a point is.

use glam::{DVec2, DVec3};

use super::walk::Walk;

/// Time between two rows, s, and most rows.
const STEP_S: f64 = 1.0 / 60.0;
const MOST_ROWS: f64 = 6000.0;

/// The way of a motion.
pub(super) struct Unrolled {
    step_s: f64,
    rows: Vec<Row>,
}

#[derive(Clone, Copy)]
struct Row {
    /// How far the centre of mass has come, metres.
    along_m: f64,
    centre: DVec2,
    facing: DVec2,
}

impl Unrolled {
    pub(super) fn of(walk: &Walk) -> Self {
        let duration_s = walk.motion.duration_s();
        let step_s = STEP_S.max(duration_s / MOST_ROWS);
        let mut rows: Vec<Row> = Vec::new();
        for i in 0..=(duration_s / step_s).ceil() as u32 {
            let time_s = (f64::from(i) * step_s).min(duration_s);
            let centre = level(walk.motion.centre_of_mass(time_s).at);
            let facing = walk.facing(time_s);
            let along_m = rows.last().map_or(0.0, |last| {
                last.along_m + (centre - last.centre).dot((facing + last.facing).normalize_or(facing))
            });
            rows.push(Row { along_m, centre, facing });
        }
        Self { step_s, rows }
    }

    fn row(&self, time_s: f64) -> Row {
        let at = (time_s / self.step_s).clamp(0.0, self.rows.len().saturating_sub(1) as f64);
        let none = Row { along_m: 0.0, centre: DVec2::ZERO, facing: DVec2::X };
        let first = self.rows.get(at as usize).copied().unwrap_or(none);
        let next = self.rows.get(at as usize + 1).copied().unwrap_or(first);
        Row {
            along_m: first.along_m + (next.along_m - first.along_m) * at.fract(),
            centre: first.centre.lerp(next.centre, at.fract()),
            facing: first.facing.lerp(next.facing, at.fract()).normalize_or(first.facing),
        }
    }

    /// A point as it is seen from the right at a time: how far along the way, and its height, metres.
    pub(super) fn place(&self, time_s: f64, point: DVec3) -> [f64; 2] {
        let row = self.row(time_s);
        [row.along_m + (level(point) - row.centre).dot(row.facing), point.y]
    }

    /// How far a point is to the right of the body at a time, metres.
    pub(super) fn aside_m(&self, time_s: f64, point: DVec3) -> f64 {
        let row = self.row(time_s);
        (level(point) - row.centre).dot(row.facing.perp())
    }

    /// The way over the ground: how far along, and where (x and z), metres.
    pub(super) fn way(&self) -> impl Iterator<Item = (f64, DVec2)> {
        self.rows.iter().map(|row| (row.along_m, row.centre))
    }

    /// Moments at which the body has come equally far from one to the next, about `every_m`, from the first to the last; `most` at most.
    pub(super) fn moments(&self, every_m: f64, most: usize) -> Vec<f64> {
        let end_s = self.step_s * self.rows.len().saturating_sub(1) as f64;
        let way_m: f64 = self.rows.windows(2).map(|pair| pair[0].centre.distance(pair[1].centre)).sum();
        let parts = ((way_m / every_m).floor() as usize).clamp(1, most.max(2) - 1);
        let (mut moments, mut gone_m) = (vec![0.0], 0.0);
        for (i, pair) in self.rows.windows(2).enumerate() {
            gone_m += pair[0].centre.distance(pair[1].centre);
            if gone_m >= way_m * moments.len() as f64 / parts as f64 && moments.len() < parts {
                moments.push((i + 1) as f64 * self.step_s);
            }
        }
        moments.push(end_s);
        moments
    }
}

fn level(at: DVec3) -> DVec2 {
    DVec2::new(at.x, at.z)
}
