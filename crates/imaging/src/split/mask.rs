//! Which pixels of a turned copy of a plate look like its mount, with fast sums along nearly straight lines.

use image::{GrayImage, Luma};
use imageproc::region_labelling::{Connectivity, connected_components};

use super::turn::BEYOND;

/// Most a row or column of panels leans against the plate as a whole, as a slope: 1.2 degrees.
const LEAN: f64 = 0.021;
/// Pieces of a path, and how far it may bend from one to the next besides leaning, px.
const PIECES: usize = 8;
const BEND_PX: usize = 1;
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

    /// For each row (or column) of a rectangle, the share of mount along the path through its middle that has the most, among
    /// paths that lean and bend a little: panels are not quite in line. 0..1.
    pub(super) fn path_shares(&self, along: Along, [left, top, right, bottom]: Rectangle) -> Vec<f64> {
        let (lines, from, to) = match along {
            Along::Rows => (top..bottom, left, right),
            Along::Columns => (left..right, top, bottom),
        };
        let length = to.saturating_sub(from);
        let ends: Vec<usize> = (0..=PIECES).map(|piece| from + piece * length / PIECES).collect();
        let counts = |piece: usize| -> Vec<u32> {
            lines.clone().map(|line| self.count(along, line, ends[piece], ends[piece + 1])).collect()
        };
        let bend = (LEAN * length as f64 / PIECES as f64).ceil() as usize + BEND_PX;
        // Best paths from either end to the middle.
        let best = |pieces: &mut dyn Iterator<Item = usize>| {
            pieces.fold(vec![0; lines.len()], |best: Vec<u32>, piece| {
                let near =
                    |i: usize| best[i.saturating_sub(bend)..(i + bend + 1).min(best.len())].iter().max();
                counts(piece).iter().enumerate().map(|(i, count)| count + near(i).unwrap_or(&0)).collect()
            })
        };
        let (before, behind) = (best(&mut (0..PIECES / 2)), best(&mut (PIECES / 2..PIECES).rev()));
        before.iter().zip(behind).map(|(a, b)| f64::from(a + b) / length.max(1) as f64).collect()
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
        .reduce(|[l, t, r, b], [left, top, right, bottom]| {
            [l.min(left), t.min(top), r.max(right), b.max(bottom)]
        })
        .map(|edges| edges.map(|edge| edge * COARSE as usize))
}
