//! From pixels to the ground: how large the animal appears where, and how far along its track a point is.
//!
//! Prints in the picture show where the ground under the animal is, the withers how high it stands over them. With a
//! pinhole camera that stands upright the withers height h(x) in the picture gives both the place to the side,
//! (x - c)/h, and the depth, f/h, in withers heights; so the way along the track is known however obliquely the animal
//! walks past, and on a gentle curve. Only for the part of the way that leads into the picture is the focal length f
//! needed.

use muybridge_core::Side;
use nalgebra::{Matrix4, RowVector4, Vector4};

use super::Film;
use super::robust::{line, median};

/// Least withers height in the picture that can be measured, px; the tracker's scatter is 2 px.
const LEAST_HEIGHT_PX: f64 = 60.0;
/// Fewest prints that make a track.
const FEWEST_PRINTS: usize = 4;
/// Fewest prints that show a curve.
const FEWEST_FOR_CURVE: usize = 7;
/// Scale of x in the fit of the track, px: half a picture.
const SCALE_PX: f64 = 1000.0;
/// Rounds of reweighting; it converges linearly, and after this many nothing moves.
const ROUNDS: usize = 30;
/// Constant of the Cauchy loss for 95 % efficiency at normal errors, in standard deviations.
const CAUCHY_EFFICIENT: f64 = 2.385;
/// Factor from a median absolute deviation to a standard deviation of normal errors.
const MAD_TO_SD: f64 = 1.4826;
/// Least scatter of prints, px: the tracker's own.
const LEAST_SCATTER_PX: f64 = 2.0;
/// Steps in which the way along the track is added up, and how far they reach beyond what was seen, as a share.
const STEPS: usize = 800;
const MARGIN: f64 = 0.1;

/// The track of a clip.
#[derive(Clone, Debug)]
pub struct Ground {
    /// 1 when x grows in the direction of travel, -1 otherwise.
    direction: f64,
    /// Ground under the middle of the animal: coefficients of y, px, by powers of the scaled x.
    ground_px: [f64; 3],
    /// Scaled x of the outermost prints, beyond which the ground goes on straight.
    prints: [f64; 2],
    /// Line of the withers: y at x = 0 and slope, px.
    withers_px: [f64; 2],
    /// How it was filmed.
    film: Film,
    /// First x of the sums, and the step between them, px.
    start_and_step_px: [f64; 2],
    /// Way to the right along the track up to each step, withers heights.
    ways: Vec<f64>,
    /// Median distance of prints from the track, withers heights.
    pub scatter: f64,
}

impl Ground {
    /// The track from the withers in each frame and the places where hooves rested, px; none when there are too few
    /// prints, or the animal is too small in part of the clip.
    pub fn new(
        direction: f64,
        withers_px: &[[f64; 2]],
        prints_px: &[(Side, [f64; 2])],
        film: &Film,
    ) -> Option<Self> {
        if prints_px.len() < FEWEST_PRINTS {
            return None;
        }
        let (ground_px, scatter_px) = fit_ground(prints_px, film)?;
        let xs = || withers_px.iter().chain(prints_px.iter().map(|(_, at)| at)).map(|at| at[0]);
        let ends = |xs: &mut dyn Iterator<Item = f64>| {
            xs.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
        };
        let [low, high] = ends(&mut xs());
        let margin = MARGIN * (high - low);
        let mut ground = Self {
            direction,
            ground_px,
            prints: ends(&mut prints_px.iter().map(|(_, at)| (at[0] - film.centre_x_px) / SCALE_PX)),
            withers_px: line(withers_px)?,
            film: *film,
            start_and_step_px: [low - margin, (high - low + 2.0 * margin) / STEPS as f64],
            ways: Vec::new(),
            scatter: 0.0,
        };
        if xs().any(|x| ground.height_px(x)[0] < LEAST_HEIGHT_PX) {
            return None;
        }
        ground.scatter = scatter_px / ground.height_px(median(xs().collect())?)[0];
        ground.add_up();
        Some(ground)
    }

    /// Adds up the way along the track; it is zero in the middle of the picture.
    fn add_up(&mut self) {
        let [start, step] = self.start_and_step_px;
        let mut way = 0.0;
        for index in 0..=STEPS {
            self.ways.push(way);
            // The middle of a step stands for the step.
            way += step * self.way_per_px(start + step * (index as f64 + 0.5));
        }
        let middle = self.way(self.film.centre_x_px);
        for way in &mut self.ways {
            *way -= middle;
        }
    }

    /// Way along the track for one pixel at x, withers heights.
    fn way_per_px(&self, x_px: f64) -> f64 {
        let [height, slope] = self.height_px(x_px);
        let height = height.max(LEAST_HEIGHT_PX);
        let aside = height - (x_px - self.film.centre_x_px) * slope;
        aside.hypot(self.film.focal_length_px * slope) / (height * height)
    }

    /// Way to the right along the track at x, withers heights.
    fn way(&self, x_px: f64) -> f64 {
        let [start, step] = self.start_and_step_px;
        let at = (x_px - start) / step;
        let index = (at.max(0.0) as usize).min(STEPS - 1);
        self.ways[index] + (at - index as f64) * (self.ways[index + 1] - self.ways[index])
    }

    /// Ground under the middle of the animal at x: y, px, and its slope.
    fn ground_px(&self, x_px: f64) -> [f64; 2] {
        let x = (x_px - self.film.centre_x_px) / SCALE_PX;
        let inside = x.clamp(self.prints[0], self.prints[1]);
        let [level, slope, bend] = self.ground_px;
        let slope_inside = slope + 2.0 * bend * inside;
        let y = level + inside * (slope + bend * inside) + slope_inside * (x - inside);
        [y, slope_inside / SCALE_PX]
    }

    /// Withers height of the animal in the picture where its middle is at x, px, and its change from pixel to pixel.
    pub fn height_px(&self, x_px: f64) -> [f64; 2] {
        let [y, slope] = self.ground_px(x_px);
        [y - self.withers_px[0] - self.withers_px[1] * x_px, slope - self.withers_px[1]]
    }

    /// Angle between the track at x and the plane of the picture, rad; positive where x grows towards the camera.
    pub fn obliqueness_rad(&self, x_px: f64) -> f64 {
        let [height, slope] = self.height_px(x_px);
        (self.film.focal_length_px * slope).atan2(height - (x_px - self.film.centre_x_px) * slope)
    }

    /// Place of a point of the animal's middle plane: how far along the track, forward from the middle of the picture,
    /// and how high above the ground, in withers heights.
    pub fn place(&self, at_px: [f64; 2]) -> [f64; 2] {
        let height_px = self.height_px(at_px[0])[0].max(LEAST_HEIGHT_PX);
        [self.direction * self.way(at_px[0]), (self.ground_px(at_px[0])[0] - at_px[1]) / height_px]
    }
}

/// The ground's line or curve through prints, and their median distance from it, px. Near prints lie lower in the
/// picture than off ones by an offset that is fitted, too, so the curve is that of the animal's middle.
fn fit_ground(prints_px: &[(Side, [f64; 2])], film: &Film) -> Option<([f64; 3], f64)> {
    let sides = |of: Side| prints_px.iter().any(|(side, _)| *side == of);
    let both = sides(Side::Left) && sides(Side::Right);
    let curve = prints_px.len() >= FEWEST_FOR_CURVE;
    let rows: Vec<(RowVector4<f64>, f64)> = prints_px
        .iter()
        .map(|(side, at)| {
            let x = (at[0] - film.centre_x_px) / SCALE_PX;
            let near = if *side == Side::Left { 1.0 } else { -1.0 };
            let row = [1.0, x, if curve { x * x } else { 0.0 }, if both { near } else { 0.0 }];
            (RowVector4::from(row), at[1])
        })
        .collect();
    let mut weights = vec![1.0; rows.len()];
    let mut solution = Vector4::zeros();
    let mut scatter = 0.0;
    for _ in 0..ROUNDS {
        let mut normal = Matrix4::zeros();
        let mut right = Vector4::zeros();
        for ((row, y), weight) in rows.iter().zip(&weights) {
            normal += *weight * row.transpose() * row;
            right += *weight * *y * row.transpose();
        }
        // What is not asked for stays zero.
        for (index, asked) in [(2, curve), (3, both)] {
            normal[(index, index)] += if asked { 0.0 } else { 1.0 };
        }
        solution = normal.cholesky()?.solve(&right);
        let rests: Vec<f64> = rows.iter().map(|(row, y)| (y - (row * solution)[0]).abs()).collect();
        scatter = median(rests.clone())?;
        let scale = CAUCHY_EFFICIENT * (MAD_TO_SD * scatter).max(LEAST_SCATTER_PX);
        weights = rests.iter().map(|rest| 1.0 / (1.0 + (rest / scale).powi(2))).collect();
    }
    Some(([solution[0], solution[1], solution[2]], scatter))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A camera 0.9 withers heights above the ground looks at a track that leads away at an angle.
    #[test]
    fn distances_along_an_oblique_track_are_right() {
        let film = Film { frames_per_s: 15.0, focal_length_px: 1000.0, centre_x_px: 1100.0 };
        for tangent in [-0.5f64, 0.0, 0.3, 0.8] {
            let cos = 1.0 / tangent.hypot(1.0);
            let seen = |along: f64, above: f64| {
                let [aside, deep] = [along * cos, 4.0 - along * cos * tangent];
                [1100.0 + 1000.0 * aside / deep, 560.0 + 1000.0 * (0.9 - above) / deep]
            };
            let alongs: Vec<f64> = (-10..=10).map(|i| 0.2 * f64::from(i)).collect();
            let withers: Vec<[f64; 2]> = alongs.iter().map(|a| seen(*a, 1.0)).collect();
            let prints: Vec<(Side, [f64; 2])> = alongs
                .iter()
                .enumerate()
                .map(|(i, a)| (if i % 2 == 0 { Side::Left } else { Side::Right }, seen(*a, 0.0)))
                .collect();
            let ground = Ground::new(1.0, &withers, &prints, &film).unwrap();
            assert!((ground.obliqueness_rad(1100.0) - tangent.atan()).abs() < 1e-6);
            for along in alongs {
                let [found, above] = ground.place(seen(along, 0.3));
                assert!(
                    (found - along).abs() < 2e-3 && (above - 0.3).abs() < 1e-6,
                    "{along}: {found}, {above}"
                );
            }
        }
    }
}
