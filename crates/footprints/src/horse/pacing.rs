//! The gait's clock along a path: where the root is and when, at every phase, with shorter and quicker steps on slopes.

use super::gait::HorseGait;
use super::series::between;
use crate::path::Path;
use crate::terrain::Terrain;

/// Steps of the table in a stride.
const STEPS: usize = 16;
/// The ground under a girdle is the mean over so many places of a stretch along the path, half of it so long, metres.
const PLACES: usize = 5;
const HALF_STRETCH_M: f64 = 0.5;
/// Greatest slope that counts, rise over run: 35 degrees.
const MOST_SLOPE: f64 = 0.7;
/// How much shorter steps are by the slope, as in the core's ride: by a quarter at ten degrees, so that the legs reach.
const SHORTENING: f64 = 1.9;

/// Places and times at even steps of phase, from phase 0 to beyond the end of the path.
pub(super) struct Pacing {
    along_m: Vec<f64>,
    times_s: Vec<f64>,
    /// Horizontal over real distance on the slope.
    levels: Vec<f64>,
}

/// Rise over run under a horse whose root is at a distance along a path.
fn slope(path: &Path, terrain: &Terrain, along_m: f64, wheelbase_m: f64) -> f64 {
    let height_m = |along_m: f64| {
        let place = |k: usize| {
            let offset_m = HALF_STRETCH_M * (2.0 * k as f64 / (PLACES - 1) as f64 - 1.0);
            let (at, _) = path.at(along_m + offset_m);
            terrain.at(at.x, at.y).0
        };
        (0..PLACES).map(place).sum::<f64>() / PLACES as f64
    };
    let slope = (height_m(along_m + wheelbase_m) - height_m(along_m)) / wheelbase_m;
    slope.clamp(-MOST_SLOPE, MOST_SLOPE)
}

impl Pacing {
    /// The clock of a gait that is at a distance along the path at phase 0, up to a stride beyond the path's end, or to so many strides
    /// and two more.
    pub(super) fn new(
        gait: &HorseGait,
        path: &Path,
        terrain: &Terrain,
        first_m: f64,
        most_strides: usize,
    ) -> Self {
        let until_m = path.length_m() + gait.stride_length_m;
        let mut pacing = Self { along_m: Vec::new(), times_s: Vec::new(), levels: Vec::new() };
        let (mut along_m, mut time_s) = (first_m, 0.0);
        // Behind the beginning of the path it is as at its beginning.
        for _ in 0..=(most_strides + 2) * STEPS {
            let slope = slope(path, terrain, along_m.max(0.0), gait.wheelbase_m());
            let share = 1.0 / (1.0 + SHORTENING * slope.abs());
            let level = 1.0 / slope.hypot(1.0);
            pacing.along_m.push(along_m);
            pacing.times_s.push(time_s);
            pacing.levels.push(level);
            if along_m > until_m {
                break;
            }
            // Half of what a step is shorter is made up by its rate, the rest costs speed.
            along_m += gait.stride_length_m * share * level / STEPS as f64;
            time_s += gait.stride_time_s * share.sqrt() / STEPS as f64;
        }
        pacing
    }

    /// Time at a phase that is not negative, s.
    pub(super) fn time_s(&self, phase: f64) -> f64 {
        between(&self.times_s, 1.0, phase * STEPS as f64)
    }

    /// Distance along the path of what is so far ahead of the root at a phase, metres.
    pub(super) fn along_m(&self, phase: f64, ahead_m: f64) -> f64 {
        let at = phase * STEPS as f64;
        let before_m = match self.along_m[..] {
            // Before the first moment the root came as it went on.
            [first, second, ..] => at.min(0.0) * (second - first),
            _ => 0.0,
        };
        let level = between(&self.levels, 1.0, at);
        between(&self.along_m, 1.0, at) + before_m + ahead_m * level
    }
}
