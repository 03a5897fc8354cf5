//! What a segment looks like, and how alike a picture is at another place and angle.

use super::figure::Segment;
use super::frame::{Level, Place};

/// Grain: variance of grey values that carries no likeness, grey levels squared.
const GRAIN_VARIANCE: f32 = 36.0;
/// Weight of a sample that shows another limb.
const FOREIGN_WEIGHT: f32 = 0.1;

/// Which part of the picture around a segment is compared.
#[derive(Clone, Copy, Debug)]
pub(super) struct Extent {
    /// Before the proximal and beyond the distal end, body heights.
    pub(super) ends: [f64; 2],
    /// To either side (above and below for a segment that points forwards), body heights.
    pub(super) sides: [f64; 2],
}

/// Samples of a picture in a segment's own frame: origin at its distal end, first axis along it.
pub(super) struct Template {
    /// Where, px.
    at: Vec<[f32; 2]>,
    /// Weights; they add up to 1.
    weights: Vec<f32>,
    /// For each layer, weight times value less the mean, over the standard deviation.
    own: Vec<[f32; 2]>,
    /// Layers that were there.
    layers: usize,
}

impl Template {
    /// Samples a picture `step_px` apart. `others` are segments of other limbs in the same picture.
    pub(super) fn new(
        level: &Level,
        segment: Segment,
        extent: Extent,
        step_px: f64,
        others: &[Segment],
    ) -> Self {
        let scale = level.px_per_height;
        let (sin, cos) = segment.angle().sin_cos();
        let ([before, after], [left, right]) = (extent.ends, extent.sides);
        let count = |length: f64| (length * scale / step_px).round().max(1.0) as i32;
        let rows = count(before + segment.length() + after);
        let columns = count(left + right);
        let (mut at, mut weights) = (Vec::new(), Vec::new());
        for (i, j) in (0..=rows).flat_map(|i| (0..=columns).map(move |j| (i, j))) {
            let along = after - f64::from(i) * step_px / scale;
            let across = f64::from(j) * step_px / scale - left;
            let [x, y] = segment.to;
            let place = [x + along * cos - across * sin, y + along * sin + across * cos];
            let own = segment.distance(place);
            let foreign = others.iter().any(|other| other.distance(place) < own);
            at.push([(along * scale) as f32, (across * scale) as f32]);
            weights.push(if foreign { FOREIGN_WEIGHT } else { 1.0 });
        }
        let total: f32 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= total);
        let mut template = Self { at, weights, own: Vec::new(), layers: level.layers };
        let values: Vec<[f32; 2]> = template.values(level, segment.to, segment.angle()).collect();
        let mean = template.weighted_mean(values.iter().copied());
        let off = |value: &[f32; 2]| [value[0] - mean[0], value[1] - mean[1]];
        let variance = template.weighted_mean(values.iter().map(|value| off(value).map(|v| v * v)));
        let scale = variance.map(|variance| 1.0 / (variance + GRAIN_VARIANCE).sqrt());
        let weighted = |(value, weight): (&[f32; 2], &f32)| {
            let off = off(value);
            [weight * off[0] * scale[0], weight * off[1] * scale[1]]
        };
        template.own = values.iter().zip(&template.weights).map(weighted).collect();
        template
    }

    fn weighted_mean(&self, values: impl Iterator<Item = [f32; 2]>) -> [f32; 2] {
        let add = |sum: [f32; 2], (w, v): (&f32, [f32; 2])| [sum[0] + w * v[0], sum[1] + w * v[1]];
        self.weights.iter().zip(values).fold([0.0; 2], add)
    }

    /// The samples' offsets from the distal end at an angle, px.
    fn stamp(&self, angle: f64) -> impl Iterator<Item = [f32; 2]> {
        let (sin, cos) = (angle.sin() as f32, angle.cos() as f32);
        self.at.iter().map(move |[along, across]| [along * cos - across * sin, along * sin + across * cos])
    }

    /// The same in whole pixels.
    pub(super) fn offsets(&self, angle: f64) -> Vec<[i32; 2]> {
        self.stamp(angle).map(|offset| offset.map(|v| v.round() as i32)).collect()
    }

    fn values<const N: usize>(
        &self,
        level: &Level,
        [x, y]: Place,
        angle: f64,
    ) -> impl Iterator<Item = [f32; N]> {
        let centre = [(x * level.px_per_height) as f32 - 0.5, (y * level.px_per_height) as f32 - 0.5];
        self.stamp(angle).map(move |[dx, dy]| between(level, [centre[0] + dx, centre[1] + dy]))
    }

    /// Likeness in -1..1 at a place and angle, between pixels.
    pub(super) fn likeness(&self, level: &Level, place: Place, angle: f64) -> f64 {
        f64::from(match self.layers.min(level.layers) {
            1 => self.correlation::<1>(self.values(level, place, angle)),
            _ => self.correlation::<2>(self.values(level, place, angle)),
        })
    }

    /// Likeness in -1..1 at a whole pixel, with the samples' offsets from [`Self::offsets`].
    pub(super) fn likeness_at_pixel(&self, level: &Level, offsets: &[[i32; 2]], pixel: [i32; 2]) -> f32 {
        match self.layers.min(level.layers) {
            1 => self.correlation::<1>(values_at_pixel(level, offsets, pixel)),
            _ => self.correlation::<2>(values_at_pixel(level, offsets, pixel)),
        }
    }

    /// Mean over `N` layers of the normalised correlation with the samples' values elsewhere.
    fn correlation<const N: usize>(&self, values: impl Iterator<Item = [f32; N]>) -> f32 {
        let (mut sum, mut square, mut product) = ([0.0f32; N], [0.0f32; N], [0.0f32; N]);
        for ((weight, own), value) in self.weights.iter().zip(&self.own).zip(values) {
            for layer in 0..N {
                let weighted = weight * value[layer];
                sum[layer] += weighted;
                square[layer] += weighted * value[layer];
                product[layer] += own[layer] * value[layer];
            }
        }
        let of = |layer: usize| {
            let variance = (square[layer] - sum[layer] * sum[layer]).max(0.0);
            product[layer] / (variance + GRAIN_VARIANCE).sqrt()
        };
        (0..N).map(of).sum::<f32>() / N as f32
    }
}

fn values_at_pixel<const N: usize>(
    level: &Level,
    offsets: &[[i32; 2]],
    [x, y]: [i32; 2],
) -> impl Iterator<Item = [f32; N]> {
    let [width, height] = level.size_px;
    offsets.iter().map(move |[dx, dy]| {
        let (column, row) = ((x + dx).clamp(0, width - 1), (y + dy).clamp(0, height - 1));
        let pixel = level.pixels[(row * width + column) as usize];
        std::array::from_fn(|layer| f32::from(pixel[layer]))
    })
}

/// Values between four pixels; beyond the border the nearest pixel's.
fn between<const N: usize>(level: &Level, [x, y]: [f32; 2]) -> [f32; N] {
    let [width, height] = level.size_px.map(|length| length as usize);
    let (x, y) = (x.clamp(0.0, (width - 1) as f32), y.clamp(0.0, (height - 1) as f32));
    let (x0, y0) = (x as usize, y as usize);
    let (x1, y1) = ((x0 + 1).min(width - 1), (y0 + 1).min(height - 1));
    let (fx, fy) = (x - x0 as f32, y - y0 as f32);
    let corners = [(x0, y0), (x1, y0), (x0, y1), (x1, y1)].map(|(x, y)| level.pixels[y * width + x]);
    std::array::from_fn(|layer| {
        let [a, b, c, d] = corners.map(|pixel| f32::from(pixel[layer]));
        let (top, bottom) = (a + fx * (b - a), c + fx * (d - c));
        top + fy * (bottom - top)
    })
}

#[cfg(test)]
mod tests {
    use image::{GrayImage, Luma};

    use super::super::climb::climb;
    use super::super::frame::Frame;
    use super::*;
    use crate::PanelView;

    const SIZE: f64 = 120.0;
    const EXTENT: Extent = Extent { ends: [0.05, 0.05], sides: [0.08, 0.08] };

    /// A view of a smooth texture, turned about and moved from where it was.
    fn view(moved: [f64; 2], turned: f64) -> PanelView {
        let picture = GrayImage::from_fn(SIZE as u32, SIZE as u32, |x, y| {
            let [x, y] = [f64::from(x) + 0.5 - moved[0] - 60.0, f64::from(y) + 0.5 - moved[1] - 60.0];
            let (sin, cos) = turned.sin_cos();
            let [u, v] = [x * cos + y * sin, y * cos - x * sin];
            let value =
                128.0 + 50.0 * (0.31 * u + 0.4).sin() * (0.23 * v).cos() + 40.0 * (0.17 * v - 0.11 * u).sin();
            Luma([value as u8])
        });
        PanelView::new(&picture, [[0.0, 0.0], [SIZE, 0.0], [SIZE, SIZE], [0.0, SIZE]], 1000).unwrap()
    }

    #[test]
    fn a_patch_moved_and_turned_is_found_to_half_a_pixel() {
        let (before, after) = (view([0.0, 0.0], 0.0), view([7.3, -4.1], 0.4));
        let [before, after] = [&before, &after].map(|view| Frame::new(view, None, SIZE, false));
        let segment = Segment { from: before.place([60.0, 40.0]), to: before.place([60.0, 60.0]) };
        let template = Template::new(&before.fine, segment, EXTENT, 2.0, &[]);
        let start = before.place([62.0, 58.0]);
        let mut unknowns = [start[0], start[1], segment.angle() + 0.2];
        let likeness = climb(&mut unknowns, &[0.03, 0.03, 0.1], 0..=6, |u| {
            template.likeness(&after.fine, [u[0], u[1]], u[2])
        });
        let [x, y] = after.plate_px([unknowns[0], unknowns[1]]);
        assert!((x - 67.3).abs() < 0.5 && (y - 55.9).abs() < 0.5, "at {x:.2}, {y:.2}");
        assert!(
            (unknowns[2] - segment.angle() - 0.4).abs() < 0.03,
            "turned {}",
            unknowns[2] - segment.angle()
        );
        assert!(likeness > 0.95, "{likeness}");
    }

    #[test]
    fn a_uniform_patch_is_like_nothing_and_a_negative_is_unlike() {
        let textured = view([0.0, 0.0], 0.0);
        let mut plain = textured.clone();
        plain.image.pixels_mut().for_each(|pixel| pixel.0 = [120]);
        let mut negative = textured.clone();
        image::imageops::invert(&mut negative.image);
        let [textured, plain, negative] =
            [&textured, &plain, &negative].map(|view| Frame::new(view, None, SIZE, false));
        let segment = Segment { from: [0.5, 0.3], to: [0.5, 0.5] };
        let of = |from: &Frame, to: &Frame| {
            let template = Template::new(&from.fine, segment, EXTENT, 2.0, &[]);
            template.likeness(&to.fine, segment.to, segment.angle())
        };
        assert!(of(&plain, &textured).abs() < 0.01 && of(&textured, &plain).abs() < 0.01);
        assert!(of(&textured, &negative) < -0.9 && of(&textured, &textured) > 0.95);
    }
}
