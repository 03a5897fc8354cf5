//! A sheet as pixels: every edge smooth.

use ab_glyph::{Font, FontRef, PxScale, ScaleFont};
use ab_glyph_rasterizer::{Rasterizer, point};
use image::{Rgb, RgbImage, imageops};
use imageproc::drawing::draw_text_mut;

use super::sheet::{Anchor, Color, Mark, PAPER, Sheet};

/// Corners of a circle, and of the round end of a line.
const CIRCLE: usize = 28;
const ROUND: usize = 9;
/// A line that turns by more than this is drawn in two, rad.
const SHARP: f64 = 1.0;
/// Points of a line that are nearer than this are one, px.
const SAME_PX: f64 = 0.05;

/// The pixels of a sheet.
pub(super) fn picture(sheet: &Sheet) -> RgbImage {
    let [width, height] = sheet.size.map(|side| side as u32);
    let mut painter = Painter {
        picture: RgbImage::from_pixel(width, height, Rgb(PAPER)),
        font: FontRef::try_from_slice(epaint_default_fonts::UBUNTU_LIGHT).ok(),
    };
    sheet.marks.iter().for_each(|mark| painter.draw(mark));
    painter.picture
}

struct Painter {
    picture: RgbImage,
    font: Option<FontRef<'static>>,
}

impl Painter {
    fn draw(&mut self, mark: &Mark) {
        match mark {
            Mark::Area { points, color, opacity } => self.fill(points, *color, *opacity),
            Mark::Line { points, color, width } => {
                for part in parts(points) {
                    self.fill(&outline(&part, width / 2.0), *color, 1.0);
                }
            }
            Mark::Dot { at: [x, y], radius, color } => {
                let corner = |i| {
                    let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / CIRCLE as f64).sin_cos();
                    [x + radius * cos, y + radius * sin]
                };
                self.fill(&(0..CIRCLE as u32).map(corner).collect::<Vec<_>>(), *color, 1.0);
            }
            Mark::Text { at, text, color, size, anchor } => self.write(*at, text, *color, *size, *anchor),
            Mark::Picture { at: [x, y], picture } => {
                imageops::replace(&mut self.picture, picture, *x as i64, *y as i64);
            }
        }
    }

    /// Fills a polygon, as far as it is on the paper.
    fn fill(&mut self, points: &[[f64; 2]], color: Color, opacity: f64) {
        let paper = [self.picture.width(), self.picture.height()].map(f64::from);
        let points = clipped(points, paper);
        let Some((from, size)) = window(&points) else { return };
        let mut rasterizer = Rasterizer::new(size[0], size[1]);
        let place = |[x, y]: [f64; 2]| point((x - from[0]) as f32, (y - from[1]) as f32);
        for i in 0..points.len() {
            rasterizer.draw_line(place(points[i]), place(points[(i + 1) % points.len()]));
        }
        let picture = &mut self.picture;
        rasterizer.for_each_pixel_2d(|x, y, cover| {
            let share = f64::from(cover.min(1.0)) * opacity;
            let at = [x + from[0] as u32, y + from[1] as u32];
            if share > 0.0 && at[0] < picture.width() && at[1] < picture.height() {
                let pixel = picture.get_pixel_mut(at[0], at[1]);
                let mix =
                    |i: usize| f64::from(pixel[i]) + share * (f64::from(color[i]) - f64::from(pixel[i]));
                *pixel = Rgb([0, 1, 2].map(|i| mix(i).round() as u8));
            }
        });
    }

    fn write(&mut self, [x, y]: [f64; 2], text: &str, color: Color, size: f64, anchor: Anchor) {
        let Some(font) = &self.font else { return };
        // The light face looks smaller than a browser's.
        let scale = PxScale::from(1.18 * size as f32);
        let scaled = font.as_scaled(scale);
        let width: f32 = text.chars().map(|c| scaled.h_advance(scaled.glyph_id(c))).sum();
        let left = x - f64::from(width)
            * match anchor {
                Anchor::Start => 0.0,
                Anchor::Middle => 0.5,
                Anchor::End => 1.0,
            };
        let top = y - f64::from(scaled.ascent());
        let at = [left, top].map(|v| v.round() as i32);
        // Twice, for the strokes are thin.
        for _ in 0..2 {
            draw_text_mut(&mut self.picture, Rgb(color), at[0], at[1], scale, font, text);
        }
    }
}

/// The whole pixels around points, left and top and size; none when they are too few or no numbers.
fn window(points: &[[f64; 2]]) -> Option<([f64; 2], [usize; 2])> {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for point in points {
        for i in 0..2 {
            (low[i], high[i]) = (low[i].min(point[i].floor()), high[i].max(point[i].ceil()));
        }
    }
    let size = [high[0] - low[0], high[1] - low[1]];
    let can_be = points.len() > 2 && size.iter().all(|side| side.is_finite() && *side >= 1.0);
    can_be.then(|| (low, size.map(|side| side as usize + 1)))
}

/// The part of a polygon that is on the paper; nothing when a corner is no number.
fn clipped(points: &[[f64; 2]], paper: [f64; 2]) -> Vec<[f64; 2]> {
    if points.iter().flatten().any(|v| !v.is_finite()) {
        return Vec::new();
    }
    let mut kept = points.to_vec();
    for (axis, sign, limit) in [(0, 1.0, 0.0), (0, -1.0, -paper[0]), (1, 1.0, 0.0), (1, -1.0, -paper[1])] {
        let inside = |point: &[f64; 2]| sign * point[axis] - limit;
        let all = std::mem::take(&mut kept);
        for i in 0..all.len() {
            let (from, to) = (all[i], all[(i + 1) % all.len()]);
            let (here, there) = (inside(&from), inside(&to));
            if here >= 0.0 {
                kept.push(from);
            }
            if (here >= 0.0) != (there >= 0.0) {
                let share = here / (here - there);
                kept.push([0, 1].map(|k| from[k] + (to[k] - from[k]) * share));
            }
        }
    }
    kept
}

/// A line in parts that turn nowhere sharply.
fn parts(points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
    let mut parts: Vec<Vec<[f64; 2]>> = Vec::new();
    let mut part: Vec<[f64; 2]> = Vec::new();
    for &at in points.iter().filter(|point| point.iter().all(|v| v.is_finite())) {
        if part.last().is_some_and(|last| (at[0] - last[0]).hypot(at[1] - last[1]) < SAME_PX) {
            continue;
        }
        if let [.., a, b] = part[..] {
            let angle = |from: [f64; 2], to: [f64; 2]| (to[1] - from[1]).atan2(to[0] - from[0]);
            let turn = (angle(b, at) - angle(a, b)).abs();
            if turn.min(std::f64::consts::TAU - turn) > SHARP {
                parts.push(std::mem::replace(&mut part, vec![b]));
            }
        }
        part.push(at);
    }
    parts.push(part);
    parts.retain(|part| part.len() > 1);
    parts
}

/// The polygon around a line that is so much to both sides of it, with round ends.
fn outline(points: &[[f64; 2]], half: f64) -> Vec<[f64; 2]> {
    let direction = |i: usize| {
        let (from, to) = (points[i], points[i + 1]);
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        let length = dx.hypot(dy);
        [dx / length, dy / length]
    };
    let last = points.len() - 1;
    let normal = |i: usize| {
        let [before, after] = [direction(i.saturating_sub(1)), direction(i.min(last - 1))];
        let sum = [before[0] + after[0], before[1] + after[1]];
        // At a corner the edges of both sides meet.
        let scale = 2.0 / (sum[0] * sum[0] + sum[1] * sum[1]);
        [-sum[1] * scale, sum[0] * scale]
    };
    let beside = |i: usize, side: f64| {
        let n = normal(i);
        [points[i][0] + n[0] * half * side, points[i][1] + n[1] * half * side]
    };
    let end = |at: [f64; 2], [dx, dy]: [f64; 2]| {
        let from = dy.atan2(dx) + std::f64::consts::FRAC_PI_2;
        (1..ROUND).map(move |i| {
            let (sin, cos) = (from - std::f64::consts::PI * i as f64 / ROUND as f64).sin_cos();
            [at[0] + half * cos, at[1] + half * sin]
        })
    };
    let [first, final_direction] = [direction(0), direction(last - 1)];
    let mut around: Vec<[f64; 2]> = (0..=last).map(|i| beside(i, 1.0)).collect();
    around.extend(end(points[last], final_direction));
    around.extend((0..=last).rev().map(|i| beside(i, -1.0)));
    around.extend(end(points[0], [-first[0], -first[1]]));
    around
}
