//! A z-buffer: triangles into pixels, the nearest wins.

use egui::{Color32, ColorImage};
use glam::Vec3;

/// A weight so little below zero is zero: the third is what the others leave of one.
const ROUNDING: f32 = 1e-5;

/// Pixels and their depths.
#[derive(Clone, Debug)]
pub(super) struct Canvas {
    pub(super) width: usize,
    pub(super) height: usize,
    /// Transparent where nothing has been drawn.
    pub(super) colors: Vec<Color32>,
    /// One over the distance, 0 where nothing is.
    depths: Vec<f32>,
}

/// A corner in the picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Picture x and y (px), one over the distance.
    pub(super) at: Vec3,
    /// 0 to 1.
    pub(super) brightness: f32,
}

impl Canvas {
    pub(super) fn new(width: usize, height: usize) -> Self {
        let pixels = width * height;
        Self { width, height, colors: vec![Color32::TRANSPARENT; pixels], depths: vec![0.0; pixels] }
    }

    /// Draws a triangle that is counter-clockwise as seen (y pointing down the screen); others are seen from behind.
    pub(super) fn triangle(&mut self, [a, b, c]: [Corner; 3], color: [f32; 3]) {
        let edge = |p: Vec3, q: Vec3, x: f32, y: f32| (q.y - p.y) * (x - p.x) - (q.x - p.x) * (y - p.y);
        let area = edge(a.at, b.at, c.at.x, c.at.y);
        if !(area > 0.0 && area.is_finite()) {
            return;
        }
        let bounds = |i: usize, size: usize| {
            let (low, high) = (a.at[i].min(b.at[i]).min(c.at[i]), a.at[i].max(b.at[i]).max(c.at[i]));
            let first = (low - 0.5).ceil().max(0.0) as usize;
            first..((high + 0.5).floor().max(0.0) as usize).min(size)
        };
        let (columns, rows) = (bounds(0, self.width), bounds(1, self.height));
        if columns.is_empty() {
            return;
        }
        // How the weights of the corners change from one column to the next.
        let (step_u, step_v) = ((c.at.y - b.at.y) / area, (a.at.y - c.at.y) / area);
        for y in rows {
            let (x, centre) = (columns.start as f32 + 0.5, y as f32 + 0.5);
            let mut u = edge(b.at, c.at, x, centre) / area;
            let mut v = edge(c.at, a.at, x, centre) / area;
            let row = y * self.width;
            let depths = &mut self.depths[row + columns.start..row + columns.end];
            let colors = &mut self.colors[row + columns.start..row + columns.end];
            for (to_depth, to_color) in depths.iter_mut().zip(colors) {
                let w = 1.0 - u - v;
                if u >= 0.0 && v >= 0.0 && w >= -ROUNDING {
                    let depth = u * a.at.z + v * b.at.z + w * c.at.z;
                    if depth > *to_depth {
                        *to_depth = depth;
                        let bright = u * a.brightness + v * b.brightness + w * c.brightness;
                        *to_color = Color32::from_rgb(
                            (color[0] * bright + 0.5) as u8,
                            (color[1] * bright + 0.5) as u8,
                            (color[2] * bright + 0.5) as u8,
                        );
                    }
                }
                u += step_u;
                v += step_v;
            }
        }
    }

    /// Lays another canvas of the same size over this one, with one opacity where it is nearer and one where it is hidden.
    pub(super) fn blend(&mut self, ghost: &Self, [nearer, hidden]: [f32; 2]) {
        for (i, color) in self.colors.iter_mut().enumerate() {
            if ghost.depths[i] > 0.0 {
                let opacity = if ghost.depths[i] > self.depths[i] { nearer } else { hidden };
                *color = color.blend(ghost.colors[i].gamma_multiply(opacity));
            }
        }
    }

    /// The pixels as they are.
    pub(super) fn whole(self) -> ColorImage {
        ColorImage::new([self.width, self.height], self.colors)
    }

    /// The picture at half the size: the mean of every two by two pixels.
    pub(super) fn halved(&self) -> ColorImage {
        let mut pixels = Vec::with_capacity(self.colors.len() / 4);
        for rows in self.colors.chunks_exact(2 * self.width.max(1)) {
            let (upper, lower) = rows.split_at(self.width);
            let pairs = upper.as_chunks::<2>().0.iter().zip(lower.as_chunks::<2>().0);
            for (&[a, b], &[c, d]) in pairs {
                pixels.push(mean([a, b, c, d]));
            }
        }
        ColorImage::new([self.width / 2, self.height / 2], pixels)
    }
}

/// The mean of four colours, two channels at a time: each has sixteen bits, and a sum needs ten.
fn mean(colors: [Color32; 4]) -> Color32 {
    const CHANNELS: u32 = 0x00ff_00ff;
    let (mut even, mut odd) = (0, 0);
    for color in colors {
        let bytes = u32::from_le_bytes(color.to_array());
        even += bytes & CHANNELS;
        odd += (bytes >> 8) & CHANNELS;
    }
    let [r, g, b, a] = (((even >> 2) & CHANNELS) | (((odd >> 2) & CHANNELS) << 8)).to_le_bytes();
    Color32::from_rgba_premultiplied(r, g, b, a)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(x: f32, y: f32, inverse_distance: f32) -> Corner {
        Corner { at: Vec3::new(x, y, inverse_distance), brightness: 1.0 }
    }

    fn covering(inverse_distance: f32) -> [Corner; 3] {
        [(-50.0, -50.0), (0.0, 200.0), (200.0, -50.0)].map(|(x, y)| corner(x, y, inverse_distance))
    }

    #[test]
    fn the_nearer_wins_in_either_order() {
        for near_first in [true, false] {
            let mut canvas = Canvas::new(8, 8);
            let near = (covering(0.5), [255.0, 0.0, 0.0]);
            let far = (covering(0.2), [0.0, 255.0, 0.0]);
            for (triangle, color) in if near_first { [near, far] } else { [far, near] } {
                canvas.triangle(triangle, color);
            }
            assert!(canvas.colors.iter().all(|&color| color == Color32::from_rgb(255, 0, 0)));
        }
    }

    #[test]
    fn triangles_that_share_an_edge_leave_no_hole() {
        let mut canvas = Canvas::new(40, 40);
        let fan = [(3.3, 4.1), (2.2, 37.7), (36.9, 35.2), (33.3, 2.2)].map(|(x, y)| corner(x, y, 1.0));
        let middle = corner(17.3, 19.1, 1.0);
        for i in 0..4 {
            canvas.triangle([middle, fan[i], fan[(i + 1) % 4]], [200.0; 3]);
        }
        for y in 6..33 {
            for x in 5..32 {
                assert_eq!(canvas.colors[y * 40 + x].a(), 255, "{x} {y}");
            }
        }
    }

    #[test]
    fn half_the_size_has_the_mean_of_the_colours() {
        let mut canvas = Canvas::new(4, 2);
        canvas.colors[0] = Color32::from_rgb(200, 100, 40);
        canvas.colors[4] = Color32::from_rgb(100, 100, 0);
        canvas.colors[2..4].fill(Color32::WHITE);
        canvas.colors[6..].fill(Color32::WHITE);
        let halved = canvas.halved();
        assert_eq!(halved.size, [2, 1]);
        assert_eq!(halved.pixels, [Color32::from_rgba_premultiplied(75, 50, 10, 127), Color32::WHITE]);
        assert_eq!(Canvas::new(0, 0).halved().size, [0, 0]);
    }

    #[test]
    fn the_back_and_what_is_no_number_are_not_drawn() {
        let mut canvas = Canvas::new(8, 8);
        let [a, b, c] = covering(0.5);
        canvas.triangle([b, a, c], [255.0; 3]);
        canvas.triangle([a, b, corner(f32::NAN, 3.0, 1.0)], [255.0; 3]);
        canvas.triangle([a, b, corner(f32::INFINITY, 3.0, 1.0)], [255.0; 3]);
        assert!(canvas.colors.iter().all(|color| color.a() == 0));
    }
}
