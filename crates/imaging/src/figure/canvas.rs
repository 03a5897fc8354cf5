//! A z-buffer: triangles into pixels, the nearest wins.

use std::ops::Range;

use glam::Vec3;

/// A weight so little below zero is zero: the third is what the others leave of one.
const ROUNDING: f32 = 1e-5;

/// Pixels and their depths, a window of a picture.
#[derive(Clone, Debug)]
pub(super) struct Canvas<P> {
    /// Where the window's first pixel is in the picture.
    pub(super) from: [usize; 2],
    /// Width and height.
    pub(super) size: [usize; 2],
    pub(super) pixels: Vec<P>,
    /// One over the distance, 0 where nothing is.
    pub(super) depths: Vec<f32>,
    /// The columns of each row outside which nothing has been drawn.
    drawn: Vec<Range<usize>>,
}

/// A corner in the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Picture x and y (px), one over the distance.
    pub(super) at: Vec3,
    /// What is painted from, such as a colour.
    pub(super) value: Vec3,
}

impl<P: Copy + Default> Canvas<P> {
    pub(super) fn new(from: [usize; 2], size: [usize; 2]) -> Self {
        let count = size[0] * size[1];
        let drawn = vec![size[0]..0; size[1]];
        Self { from, size, pixels: vec![P::default(); count], depths: vec![0.0; count], drawn }
    }

    /// The columns outside which nothing has been drawn in some rows.
    pub(super) fn drawn(&self, rows: Range<usize>) -> Range<usize> {
        let rows = &self.drawn[rows];
        let start = rows.iter().map(|columns| columns.start).min().unwrap_or(0);
        start..rows.iter().map(|columns| columns.end).max().unwrap_or(0).max(start)
    }

    /// Closes slits of a pixel or two between surfaces that should touch: they are painted like the pixel to their left.
    pub(super) fn close_slits(&mut self) {
        const WIDEST: usize = 2;
        let width = self.size[0].max(1);
        for (depths, pixels) in self.depths.chunks_exact_mut(width).zip(self.pixels.chunks_exact_mut(width)) {
            let mut x = 1;
            while x < width {
                let slit = depths[x..].iter().take_while(|depth| **depth <= 0.0).count();
                if depths[x - 1] > 0.0 && (1..=WIDEST).contains(&slit) && x + slit < width {
                    depths.copy_within(x - 1..x, x);
                    pixels.copy_within(x - 1..x, x);
                    x += 1;
                } else {
                    x += slit.max(1);
                }
            }
        }
    }

    /// Draws a triangle that is counter-clockwise as seen (y pointing down the screen); others are seen from behind. `paint` makes
    /// a pixel of the value between the corners'.
    pub(super) fn triangle(&mut self, corners: [Corner; 3], paint: impl Fn(Vec3) -> P) {
        // In the picture's own pixels, so that any window of it rounds alike.
        let [a, b, c] = corners;
        let [top, bottom] = [self.from[1] as f32, (self.from[1] + self.size[1]) as f32];
        if a.at.y.max(b.at.y).max(c.at.y) < top || a.at.y.min(b.at.y).min(c.at.y) > bottom {
            return;
        }
        let edge = |p: Vec3, q: Vec3, x: f32, y: f32| (q.y - p.y) * (x - p.x) - (q.x - p.x) * (y - p.y);
        let area = edge(a.at, b.at, c.at.x, c.at.y);
        if !(area > 0.0 && area.is_finite()) {
            return;
        }
        let bounds = |i: usize| {
            let (low, high) = (a.at[i].min(b.at[i]).min(c.at[i]), a.at[i].max(b.at[i]).max(c.at[i]));
            let [first, end] = [(low - 0.5).ceil(), (high + 0.5).floor()].map(|v| v.max(0.0) as usize);
            let inside = |at: usize| at.saturating_sub(self.from[i]).min(self.size[i]);
            inside(first)..inside(end)
        };
        let (columns, rows) = (bounds(0), bounds(1));
        if columns.is_empty() {
            return;
        }
        // How the weights of the corners change from one column to the next.
        let (step_u, step_v) = ((c.at.y - b.at.y) / area, (a.at.y - c.at.y) / area);
        for y in rows {
            let [x, centre] =
                [self.from[0] + columns.start, self.from[1] + y].map(|pixel| pixel as f32 + 0.5);
            let mut u = edge(b.at, c.at, x, centre) / area;
            let mut v = edge(c.at, a.at, x, centre) / area;
            let row = y * self.size[0];
            let drawn = &mut self.drawn[y];
            (drawn.start, drawn.end) = (drawn.start.min(columns.start), drawn.end.max(columns.end));
            let depths = &mut self.depths[row + columns.start..row + columns.end];
            let pixels = &mut self.pixels[row + columns.start..row + columns.end];
            for (to_depth, to_pixel) in depths.iter_mut().zip(pixels) {
                let w = 1.0 - u - v;
                if u >= 0.0 && v >= 0.0 && w >= -ROUNDING {
                    let depth = u * a.at.z + v * b.at.z + w * c.at.z;
                    if depth > *to_depth {
                        *to_depth = depth;
                        *to_pixel = paint(a.value * u + b.value * v + c.value * w);
                    }
                }
                u += step_u;
                v += step_v;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(x: f32, y: f32, inverse_distance: f32) -> Corner {
        Corner { at: Vec3::new(x, y, inverse_distance), value: Vec3::ONE }
    }

    fn covering(inverse_distance: f32) -> [Corner; 3] {
        [(-50.0, -50.0), (0.0, 200.0), (200.0, -50.0)].map(|(x, y)| corner(x, y, inverse_distance))
    }

    #[test]
    fn the_nearer_wins_in_either_order() {
        for near_first in [true, false] {
            let mut canvas = Canvas::<u8>::new([0, 0], [8, 8]);
            let (near, far) = ((covering(0.5), 1), (covering(0.2), 2));
            for (triangle, color) in if near_first { [near, far] } else { [far, near] } {
                canvas.triangle(triangle, |_| color);
            }
            assert!(canvas.pixels.iter().all(|&color| color == 1));
        }
    }

    #[test]
    fn triangles_that_share_an_edge_leave_no_hole_in_any_window() {
        for from in [[0, 0], [3, 1]] {
            let mut canvas = Canvas::<u8>::new(from, [40 - from[0], 40 - from[1]]);
            let fan = [(3.3, 4.1), (2.2, 37.7), (36.9, 35.2), (33.3, 2.2)].map(|(x, y)| corner(x, y, 1.0));
            let middle = corner(17.3, 19.1, 1.0);
            for i in 0..4 {
                canvas.triangle([middle, fan[i], fan[(i + 1) % 4]], |_| 1);
            }
            for y in 6..33 {
                for x in 5..32 {
                    assert_eq!(canvas.pixels[(y - from[1]) * canvas.size[0] + x - from[0]], 1, "{x} {y}");
                }
            }
        }
    }

    #[test]
    fn slits_are_closed_and_the_sky_is_not() {
        let mut canvas = Canvas::<u8>::new([0, 0], [8, 2]);
        canvas.depths =
            [[1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0]].concat();
        canvas.close_slits();
        let seen: Vec<u8> = canvas.depths.iter().map(|depth| u8::from(*depth > 0.0)).collect();
        assert_eq!(seen, [1, 1, 1, 1, 1, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1]);
    }

    #[test]
    fn the_back_and_what_is_no_number_are_not_drawn() {
        let mut canvas = Canvas::<u8>::new([0, 0], [8, 8]);
        let [a, b, c] = covering(0.5);
        canvas.triangle([b, a, c], |_| 1);
        canvas.triangle([a, b, corner(f32::NAN, 3.0, 1.0)], |_| 1);
        canvas.triangle([a, b, corner(f32::INFINITY, 3.0, 1.0)], |_| 1);
        assert!(canvas.pixels.iter().all(|&color| color == 0));
    }
}
