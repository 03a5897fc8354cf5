//! What a segment looks like, and how alike a picture is at another place and angle.

use image::GrayImage;

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
    layers: Vec<Vec<f32>>,
}

impl Template {
    /// Samples a picture `step_px` apart. `others` are segments of other limbs in the same picture.
    pub(super) fn new(level: &Level, segment: Segment, extent: Extent, step_px: f64, others: &[Segment]) -> Self {
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
        let mut template = Self { at, weights, layers: Vec::new() };
        for layer in 0..level.layers.len() {
            let values: Vec<f32> = template.values(level, layer, segment.to, segment.angle()).collect();
            template.layers.push(template.standard(&values));
        }
        template
    }

    fn standard(&self, values: &[f32]) -> Vec<f32> {
        let mean: f32 = self.weights.iter().zip(values).map(|(w, v)| w * v).sum();
        let variance: f32 = self.weights.iter().zip(values).map(|(w, v)| w * (v - mean) * (v - mean)).sum();
        let scale = 1.0 / (variance + GRAIN_VARIANCE).sqrt();
        self.weights.iter().zip(values).map(|(w, v)| w * (v - mean) * scale).collect()
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

    fn values(&self, level: &Level, layer: usize, [x, y]: Place, angle: f64) -> impl Iterator<Item = f32> {
        let centre = [(x * level.px_per_height) as f32 - 0.5, (y * level.px_per_height) as f32 - 0.5];
        self.stamp(angle).map(move |[dx, dy]| between(&level.layers[layer], [centre[0] + dx, centre[1] + dy]))
    }

    /// Likeness in -1..1 at a place and angle, between pixels.
    pub(super) fn likeness(&self, level: &Level, place: Place, angle: f64) -> f64 {
        let layers = self.layers_in_common(level);
        let of = |layer| self.correlation(layer, self.values(level, layer, place, angle));
        f64::from((0..layers).map(of).sum::<f32>()) / layers as f64
    }

    /// Likeness in -1..1 at a whole pixel, with the samples' offsets from [`Self::offsets`].
    pub(super) fn likeness_at_pixel(&self, level: &Level, offsets: &[[i32; 2]], [x, y]: [i32; 2]) -> f32 {
        let [width, height] = level.size_px();
        let layers = self.layers_in_common(level);
        let of = |layer: usize| {
            let raw = level.layers[layer].as_raw();
            let values = offsets.iter().map(|[dx, dy]| {
                let (column, row) = ((x + dx).clamp(0, width - 1), (y + dy).clamp(0, height - 1));
                f32::from(raw[(row * width + column) as usize])
            });
            self.correlation(layer, values)
        };
        (0..layers).map(of).sum::<f32>() / layers as f32
    }

    /// The photograph is in both; the silhouette may not be.
    fn layers_in_common(&self, level: &Level) -> usize {
        self.layers.len().min(level.layers.len())
    }

    fn correlation(&self, layer: usize, values: impl Iterator<Item = f32>) -> f32 {
        let (mut sum, mut square, mut product) = (0.0f32, 0.0f32, 0.0f32);
        for ((weight, own), value) in self.weights.iter().zip(&self.layers[layer]).zip(values) {
            sum += weight * value;
            square += weight * value * value;
            product += own * value;
        }
        product / ((square - sum * sum).max(0.0) + GRAIN_VARIANCE).sqrt()
    }
}

/// Value between four pixels; beyond the border the nearest pixel's.
fn between(picture: &GrayImage, [x, y]: [f32; 2]) -> f32 {
    let (width, height, raw) = (picture.width() as usize, picture.height() as usize, picture.as_raw());
    let (x, y) = (x.clamp(0.0, (width - 1) as f32), y.clamp(0.0, (height - 1) as f32));
    let (x0, y0) = (x as usize, y as usize);
    let (x1, y1) = ((x0 + 1).min(width - 1), (y0 + 1).min(height - 1));
    let (fx, fy) = (x - x0 as f32, y - y0 as f32);
    let at = |x: usize, y: usize| f32::from(raw[y * width + x]);
    let top = at(x0, y0) + fx * (at(x1, y0) - at(x0, y0));
    let bottom = at(x0, y1) + fx * (at(x1, y1) - at(x0, y1));
    top + fy * (bottom - top)
}
