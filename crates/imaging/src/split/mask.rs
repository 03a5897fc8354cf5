//! Which pixels of a turned copy of a plate look like its mount, with fast sums along nearly straight lines.

use image::{GrayImage, Luma};
use imageproc::region_labelling::{Connectivity, connected_components};

use super::turn::BEYOND;

/// Most a row or column of panels leans against the plate as a whole, as a slope: 1.2 degrees.
const LEAN: f64 = 0.021;
/// Least size of a piece of mount against the largest: a fold parts a mount, a horse is no mount.
const LEAST_PIECE: f64 = 0.1;
/// Pixels of the mask to one of the copy in which pieces are told apart.
const COARSE: u32 = 3;

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

/// A rectangle of the mask: left, top, right, bottom, pixels, right and bottom excluded.
pub(super) type Rectangle = [usize; 4];

/// Mount-like pixels, counted from the left and from the top.
pub(super) struct Mask {
    /// Width, height.
    size: [usize; 2],
    /// Mount pixels left of each pixel; one entry more than pixels in each row.
    from_left: Vec<u16>,
    /// Mount pixels above each pixel; by column.
    from_top: Vec<u16>,
}

impl Mask {
    /// From a picture in which mount is not zero.
    pub(super) fn new(mount: &GrayImage) -> Self {
        let size = [mount.width() as usize, mount.height() as usize];
        let pixels = mount.as_raw();
        let mut from_left = Vec::with_capacity((size[0] + 1) * size[1]);
        let mut from_top = vec![0; size[0] * (size[1] + 1)];
        for (y, line) in pixels.chunks_exact(size[0]).enumerate() {
            let mut sum = 0;
            from_left.push(sum);
            for (x, value) in line.iter().enumerate() {
                let is_mount = u16::from(*value > 0);
                sum += is_mount;
                from_left.push(sum);
                let above = x * (size[1] + 1) + y;
                from_top[above + 1] = from_top[above] + is_mount;
            }
        }
        Self { size, from_left, from_top }
    }

    /// Number of pixels.
    pub(super) fn area(&self) -> f64 {
        (self.size[0] * self.size[1]) as f64
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
        if area == 0.0 {
            return 1.0;
        }
        let count: u32 = if bottom - top <= right - left {
            (top..bottom).map(|y| self.count(Along::Rows, y, left, right)).sum()
        } else {
            (left..right).map(|x| self.count(Along::Columns, x, top, bottom)).sum()
        };
        f64::from(count) / area
    }

    /// For each row (or column) of a rectangle, the share of mount along the line through its middle that has the most,
    /// among lines that lean a little; 0..1.
    pub(super) fn line_shares(&self, along: Along, [left, top, right, bottom]: Rectangle) -> Vec<f64> {
        let (lines, span) = match along {
            Along::Rows => (top..bottom, [left, right]),
            Along::Columns => (left..right, [top, bottom]),
        };
        let ends = [lines.start, lines.end.saturating_sub(1)];
        let length = span[1].saturating_sub(span[0]);
        let most = steepest_lean(length);
        lines
            .map(|line| {
                let count = (-most..=most).map(|lean| self.leaning_count(along, line, ends, span, lean)).max();
                f64::from(count.unwrap_or(0)) / length.max(1) as f64
            })
            .collect()
    }

    /// Mount pixels along a line that begins `lean` lines before its middle and ends as many after it, within the first and
    /// the last line.
    fn leaning_count(&self, along: Along, line: usize, ends: [usize; 2], [from, to]: [usize; 2], lean: isize) -> u32 {
        let pieces = 2 * lean.abs() + 1;
        let length = (to - from) as isize;
        (0..pieces)
            .map(|piece| {
                let shifted = line as isize + (piece - lean.abs()) * lean.signum();
                let shifted = shifted.clamp(ends[0] as isize, ends[1] as isize) as usize;
                let begin = from + (piece * length / pieces) as usize;
                let end = from + ((piece + 1) * length / pieces) as usize;
                self.count(along, shifted, begin, end)
            })
            .sum()
    }
}

/// Bounding rectangle of the large connected pieces of mount within the picture, to a few pixels; none without mount.
pub(super) fn extent(mount: &GrayImage) -> Option<Rectangle> {
    let coarse = GrayImage::from_fn(mount.width() / COARSE, mount.height() / COARSE, |x, y| {
        Luma([u8::from(mount.get_pixel(x * COARSE, y * COARSE).0[0] > BEYOND)])
    });
    let labels = connected_components(&coarse, Connectivity::Four, Luma([0]));
    let mut pieces: Vec<(usize, Rectangle)> = Vec::new();
    for (x, y, Luma([label])) in labels.enumerate_pixels().filter(|(.., Luma([label]))| *label > 0) {
        let index = *label as usize - 1;
        if pieces.len() <= index {
            pieces.resize(index + 1, (0, [usize::MAX, usize::MAX, 0, 0]));
        }
        let (count, [left, top, right, bottom]) = &mut pieces[index];
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
        .reduce(|[l, t, r, b], [left, top, right, bottom]| [l.min(left), t.min(top), r.max(right), b.max(bottom)])
        .map(|edges| edges.map(|edge| edge * COARSE as usize))
}
