//! Which pixels of a small, turned copy of a plate look like its mount, with fast sums along nearly straight lines.

use image::{GrayImage, Luma};
use imageproc::geometric_transformations::{Border, Interpolation, Projection, warp_into};
use imageproc::region_labelling::{Connectivity, connected_components};

/// Most a row or column of panels leans against the plate as a whole, as a slope: 1.2 degrees.
const LEAN: f64 = 0.021;
/// Steepest tilt of a plate that is looked for, degrees.
const STEEPEST_TILT_DEG: f64 = 5.0;

/// Which way a line runs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Along {
    /// From left to right.
    Rows,
    /// From top to bottom.
    Columns,
}

/// How far the ends of a line of a length may lie off from its middle, px.
pub(super) fn steepest_lean(length: usize) -> isize {
    (0.5 * LEAN * length as f64).ceil() as isize
}

/// A rectangle of the mask, [left, top, right, bottom], pixels, right and bottom excluded.
pub(super) type Rectangle = [usize; 4];

/// Mount-like pixels, counted from the left and from the top.
pub(super) struct Mask {
    /// Width, height.
    pub(super) size: [usize; 2],
    /// Mount pixels left of each pixel; one entry more than pixels in each row.
    from_left: Vec<u16>,
    /// Mount pixels above each pixel; by column.
    from_top: Vec<u16>,
}

impl Mask {
    /// From a picture in which mount is not zero.
    pub(super) fn new(mount: &GrayImage) -> Self {
        let size = [mount.width() as usize, mount.height() as usize];
        let sums = |lines: usize, length: usize, at: &dyn Fn(usize, usize) -> bool| {
            let mut sums = Vec::with_capacity(lines * (length + 1));
            for line in 0..lines {
                let mut sum = 0u16;
                sums.push(sum);
                for i in 0..length {
                    sum += u16::from(at(line, i));
                    sums.push(sum);
                }
            }
            sums
        };
        let pixels = mount.as_raw();
        let from_left = sums(size[1], size[0], &|y, x| pixels[y * size[0] + x] > 0);
        let from_top = sums(size[0], size[1], &|x, y| pixels[y * size[0] + x] > 0);
        Self { size, from_left, from_top }
    }

    /// Mount pixels of one row (or column) between two places.
    fn count(&self, along: Along, line: usize, from: usize, to: usize) -> u32 {
        let (sums, stride) = match along {
            Along::Rows => (&self.from_left, self.size[0] + 1),
            Along::Columns => (&self.from_top, self.size[1] + 1),
        };
        u32::from(sums[line * stride + to] - sums[line * stride + from])
    }

    /// Whether a pixel is mount.
    pub(super) fn is_mount(&self, x: usize, y: usize) -> bool {
        self.count(Along::Rows, y, x, x + 1) > 0
    }

    /// Share of mount in a rectangle, 0..1; 1 when it is empty.
    pub(super) fn share(&self, [left, top, right, bottom]: Rectangle) -> f64 {
        let area = (right.saturating_sub(left) * bottom.saturating_sub(top)) as f64;
        let count: u32 = (top..bottom).map(|y| self.count(Along::Rows, y, left, right)).sum();
        if area > 0.0 { f64::from(count) / area } else { 1.0 }
    }

    /// For each row (or column) of a rectangle, the share of mount along the line through its middle that has the most,
    /// among lines that lean a little; 0..1.
    pub(super) fn line_shares(&self, along: Along, [left, top, right, bottom]: Rectangle) -> Vec<f64> {
        let (lines, from, to) = match along {
            Along::Rows => (top..bottom, left, right),
            Along::Columns => (left..right, top, bottom),
        };
        let last = lines.end.saturating_sub(1);
        let first = lines.start;
        let length = to.saturating_sub(from);
        let most = steepest_lean(length);
        lines
            .map(|line| {
                (-most..=most)
                    .map(|shift| self.leaning_count(along, (line, first, last), (from, to), shift))
                    .max()
                    .map_or(1.0, |count| f64::from(count) / length.max(1) as f64)
            })
            .collect()
    }

    /// Mount pixels along a line that begins `shift` lines before its middle and ends as many after it.
    fn leaning_count(
        &self,
        along: Along,
        (line, first, last): (usize, usize, usize),
        (from, to): (usize, usize),
        shift: isize,
    ) -> u32 {
        let pieces = 2 * shift.abs() + 1;
        let length = (to - from) as isize;
        (0..pieces)
            .map(|piece| {
                let offset = (piece - shift.abs()) * shift.signum();
                let row = (line as isize + offset).clamp(first as isize, last as isize) as usize;
                let begin = from + (piece * length / pieces) as usize;
                let end = from + ((piece + 1) * length / pieces) as usize;
                self.count(along, row, begin, end)
            })
            .sum()
    }
}

/// Least size of a piece of mount against the largest: a fold parts a mount, a horse is no mount.
const LEAST_PIECE: f64 = 0.1;

/// Pixels of the mask to one of the copy in which pieces are told apart.
const COARSE: u32 = 3;

/// Bounding rectangle of the large connected pieces of mount, to a few pixels.
pub(super) fn extent(mount: &GrayImage) -> Option<Rectangle> {
    let coarse = GrayImage::from_fn(mount.width() / COARSE, mount.height() / COARSE, |x, y| {
        *mount.get_pixel(x * COARSE, y * COARSE)
    });
    let labels = connected_components(&coarse, Connectivity::Four, Luma([0]));
    let mut pieces: Vec<(usize, Rectangle)> = Vec::new();
    for (x, y, label) in labels.enumerate_pixels() {
        let index = label.0[0] as usize;
        if index == 0 {
            continue;
        }
        if pieces.len() < index {
            pieces.resize(index, (0, [usize::MAX, usize::MAX, 0, 0]));
        }
        let (count, [left, top, right, bottom]) = &mut pieces[index - 1];
        let (x, y) = (x as usize, y as usize);
        *count += 1;
        (*left, *top) = ((*left).min(x), (*top).min(y));
        (*right, *bottom) = ((*right).max(x + 1), (*bottom).max(y + 1));
    }
    let largest = pieces.iter().map(|piece| piece.0).max()?;
    pieces
        .into_iter()
        .filter(|(count, _)| *count as f64 >= LEAST_PIECE * largest as f64)
        .map(|piece| piece.1)
        .reduce(|[l, t, r, b], [left, top, right, bottom]| {
            [l.min(left), t.min(top), r.max(right), b.max(bottom)]
        })
        .map(|edges| edges.map(|edge| edge * COARSE as usize))
}

/// Tilt of the plate, radians, clockwise as seen: the angle at which rows and columns of mount stand out most.
pub(super) fn tilt_rad(mount: &GrayImage) -> f64 {
    let best = |from: f64, step: f64, count: u32, every: usize| {
        (0..=count)
            .map(|i| from + step * f64::from(i))
            .map(|degrees| (sharpness(mount, degrees.to_radians().tan(), every), degrees))
            .fold((f64::MIN, 0.0), |best, candidate| if candidate.0 > best.0 { candidate } else { best })
            .1
    };
    let coarse = best(-STEEPEST_TILT_DEG, 0.25, (8.0 * STEEPEST_TILT_DEG) as u32, 4);
    best(coarse - 0.25, 0.05, 10, 2).to_radians()
}

/// How suddenly the sums along leaning rows and columns change from line to line, of every few pixels.
fn sharpness(mount: &GrayImage, slope: f64, every: usize) -> f64 {
    let size = [mount.width() as usize, mount.height() as usize];
    let sizes = size.map(|length| length.div_ceil(every));
    let reach = sizes.map(|length| (slope.abs() * length as f64) as usize + 2);
    let mut rows = vec![0.0f32; sizes[1] + 2 * reach[0]];
    let mut columns = vec![0.0f32; sizes[0] + 2 * reach[1]];
    let shifts: Vec<usize> =
        (0..sizes[0]).map(|x| (reach[0] as f64 - slope * x as f64) as usize).collect();
    for (y, line) in mount.as_raw().chunks_exact(size[0]).step_by(every).enumerate() {
        let shift = (slope * y as f64 + reach[1] as f64) as usize;
        for (x, value) in line.iter().step_by(every).enumerate() {
            let is_mount = f32::from(u8::from(*value > 0));
            rows[y + shifts[x]] += is_mount;
            columns[x + shift] += is_mount;
        }
    }
    let change = |sums: &[f32], scale: usize| {
        let sum: f32 = sums.windows(2).map(|pair| (pair[1] - pair[0]).powi(2)).sum();
        f64::from(sum) / (scale * scale) as f64
    };
    change(&rows, sizes[0]) + change(&columns, sizes[1])
}

/// Where a point of a turned picture lies in the picture it was made from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    cosine: f64,
    sine: f64,
    /// Middle of the picture and of the turned one.
    middles: [[f64; 2]; 2],
}

impl Turn {
    /// Point of the picture, from one of the turned picture.
    pub(super) fn back(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [[cx, cy], [tx, ty]] = self.middles;
        let (x, y) = (x - tx, y - ty);
        [cx + self.cosine * x - self.sine * y, cy + self.sine * x + self.cosine * y]
    }

    /// Point of the turned picture, from one of the picture.
    pub(super) fn forth(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [[cx, cy], [tx, ty]] = self.middles;
        let (x, y) = (x - cx, y - cy);
        [tx + self.cosine * x + self.sine * y, ty - self.sine * x + self.cosine * y]
    }
}

/// The picture turned upright by a tilt, large enough to lose nothing; beyond the border as at the border.
pub(super) fn upright(picture: &GrayImage, tilt_rad: f64) -> (GrayImage, Turn) {
    let (width, height) = (f64::from(picture.width()), f64::from(picture.height()));
    let (sine, cosine) = tilt_rad.sin_cos();
    let turned = [width * cosine + height * sine.abs(), width * sine.abs() + height * cosine].map(f64::ceil);
    let turn = Turn { cosine, sine, middles: [[0.5 * width, 0.5 * height], turned.map(|v| 0.5 * v)] };
    // The filter's pixel centres are whole numbers.
    let (from, to) = ([0.5 * (width - 1.0), 0.5 * (height - 1.0)], turned.map(|v| 0.5 * (v - 1.0)));
    let projection = Projection::translate(-from[0] as f32, -from[1] as f32)
        .and_then(Projection::rotate(-tilt_rad as f32))
        .and_then(Projection::translate(to[0] as f32, to[1] as f32));
    let mut out = GrayImage::new(turned[0] as u32, turned[1] as u32);
    warp_into(picture, projection, Interpolation::Nearest, Border::Replicate, &mut out);
    (out, turn)
}
