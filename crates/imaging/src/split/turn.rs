//! Turning a mask of the mount upright.

use image::{GrayImage, Luma};
use imageproc::geometric_transformations::{Border, Interpolation, Projection, warp_into};

use super::Point;

/// Steepest tilt of a plate that is looked for, degrees.
const STEEPEST_DEG: f64 = 5.0;
/// Steps of the first and of the second search, degrees; pixels of which one is looked at, each way.
const COARSE_STEP_DEG: f64 = 0.25;
const COARSE_EVERY: usize = 5;
const FINE_STEP_DEG: f64 = 0.1;
const FINE_EVERY: usize = 3;
/// What a turned mask has beyond the picture's border: mount, but not counted where its extent is asked for.
pub(super) const BEYOND: u8 = 1;

/// Where a point of a turned picture lies in the picture it was made from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    cosine: f64,
    sine: f64,
    /// Middle of the picture and of the turned one.
    middles: [Point; 2],
}

impl Turn {
    /// Point of the picture, from one of the turned picture.
    pub(super) fn picture_from_turned(&self, [x, y]: Point) -> Point {
        let [[cx, cy], [tx, ty]] = self.middles;
        let (x, y) = (x - tx, y - ty);
        [cx + self.cosine * x - self.sine * y, cy + self.sine * x + self.cosine * y]
    }

    /// Point of the turned picture, from one of the picture.
    pub(super) fn turned_from_picture(&self, [x, y]: Point) -> Point {
        let [[cx, cy], [tx, ty]] = self.middles;
        let (x, y) = (x - cx, y - cy);
        [tx + self.cosine * x + self.sine * y, ty - self.sine * x + self.cosine * y]
    }
}

/// A mask turned upright by a tilt, large enough to lose nothing.
pub(super) fn upright(mask: &GrayImage, tilt_rad: f64) -> (GrayImage, Turn) {
    let (width, height) = (f64::from(mask.width()), f64::from(mask.height()));
    let (sine, cosine) = tilt_rad.sin_cos();
    let size = [width * cosine + height * sine.abs(), width * sine.abs() + height * cosine].map(f64::ceil);
    let turn = Turn { cosine, sine, middles: [[0.5 * width, 0.5 * height], size.map(|v| 0.5 * v)] };
    // The filter's pixel centres are whole numbers.
    let from = [width, height].map(|v| -0.5 * (v - 1.0) as f32);
    let to = size.map(|v| 0.5 * (v - 1.0) as f32);
    let projection = Projection::translate(from[0], from[1])
        .and_then(Projection::rotate(-tilt_rad as f32))
        .and_then(Projection::translate(to[0], to[1]));
    let mut turned = GrayImage::new(size[0] as u32, size[1] as u32);
    warp_into(mask, projection, Interpolation::Nearest, Border::Constant(Luma([BEYOND])), &mut turned);
    (turned, turn)
}

/// Tilt of the plate, radians, clockwise as seen: the angle at which rows and columns of mount stand out most.
pub(super) fn tilt_rad(mask: &GrayImage) -> f64 {
    let is_mount_summed = is_rare_at_border(mask);
    let best = |from: f64, step: f64, to: f64, every: usize| {
        let count = ((to - from) / step).round() as u32;
        (0..=count)
            .map(|i| from + step * f64::from(i))
            .map(|degrees| (sharpness(mask, degrees.to_radians().tan(), is_mount_summed, every), degrees))
            .fold((f64::MIN, 0.0), |best, candidate| if candidate.0 > best.0 { candidate } else { best })
            .1
    };
    let coarse = best(-STEEPEST_DEG, COARSE_STEP_DEG, STEEPEST_DEG, COARSE_EVERY);
    best(coarse - COARSE_STEP_DEG, FINE_STEP_DEG, coarse + COARSE_STEP_DEG, FINE_EVERY).to_radians()
}

/// How suddenly the sums along leaning rows and columns change from line to line, of every few pixels. What is summed is
/// mount or its opposite, whichever is rarer at the picture's border, so that the border itself is no change.
fn sharpness(mask: &GrayImage, slope: f64, is_mount_summed: bool, every: usize) -> f64 {
    let size = [mask.width() as usize, mask.height() as usize];
    let sizes = size.map(|length| length.div_ceil(every));
    let reach = sizes.map(|length| (slope.abs() * length as f64) as usize + 2);
    let mut rows = vec![0.0f32; sizes[1] + 2 * reach[0]];
    let mut columns = vec![0.0f32; sizes[0] + 2 * reach[1]];
    let shifts: Vec<usize> = (0..sizes[0]).map(|x| (reach[0] as f64 - slope * x as f64) as usize).collect();
    for (y, line) in mask.as_raw().chunks_exact(size[0]).step_by(every).enumerate() {
        let shift = (slope * y as f64 + reach[1] as f64) as usize;
        for (x, value) in line.iter().step_by(every).enumerate() {
            let summed = f32::from(u8::from((*value > 0) == is_mount_summed));
            rows[y + shifts[x]] += summed;
            columns[x + shift] += summed;
        }
    }
    let change = |sums: &[f32], scale: usize| {
        let sum: f32 = sums.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum();
        f64::from(sum) / (scale * scale) as f64
    };
    change(&rows, sizes[0]) + change(&columns, sizes[1])
}

/// Whether less than half of the picture's border is mount.
fn is_rare_at_border(mask: &GrayImage) -> bool {
    let (right, bottom) = (mask.width() - 1, mask.height() - 1);
    let across = (0..=right).flat_map(|x| [(x, 0), (x, bottom)]);
    let border = across.chain((0..=bottom).flat_map(|y| [(0, y), (right, y)]));
    let (mount, all) = border.fold((0u32, 0u32), |(mount, all), (x, y)| {
        (mount + u32::from(mask.get_pixel(x, y).0[0] > 0), all + 1)
    });
    2 * mount < all
}
