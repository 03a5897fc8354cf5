//! Filled shapes with smooth edges: exact coverage of polygons, distance to tapered capsules.

use image::{ImageBuffer, Luma};

/// A point or vector of the plate, px: x right, y down.
pub(super) type Point = [f64; 2];

pub(super) fn add([ax, ay]: Point, [bx, by]: Point) -> Point {
    [ax + bx, ay + by]
}

pub(super) fn sub([ax, ay]: Point, [bx, by]: Point) -> Point {
    [ax - bx, ay - by]
}

pub(super) fn scaled([x, y]: Point, factor: f64) -> Point {
    [x * factor, y * factor]
}

/// `share` of the way from `a` to `b`.
pub(super) fn between(a: Point, b: Point, share: f64) -> Point {
    add(scaled(a, 1.0 - share), scaled(b, share))
}

/// Turned anticlockwise where y points up.
pub(super) fn turned([x, y]: Point, angle_rad: f64) -> Point {
    let (sin, cos) = angle_rad.sin_cos();
    [cos * x - sin * y, sin * x + cos * y]
}

/// A closed region of the plate.
#[derive(Clone, Debug)]
pub(super) enum Shape {
    /// Inside of closed lines. Where lines of one sense overlap the region is filled once; one of the other sense is a hole.
    Outlines(Vec<Vec<Point>>),
    /// Two circles, centre and radius each, and what their common tangents enclose.
    Capsule([(Point, f64); 2]),
}

impl Shape {
    /// Inside of one closed line.
    pub(super) fn polygon(corners: Vec<Point>) -> Self {
        Self::Outlines(vec![corners])
    }

    /// A straight stroke of a width in px, square at its ends.
    pub(super) fn stroke(a: Point, b: Point, width: f64) -> Self {
        let [dx, dy] = sub(b, a);
        let half = 0.5 * width / dx.hypot(dy).max(f64::MIN_POSITIVE);
        let side = [-dy * half, dx * half];
        Self::polygon(vec![add(a, side), add(b, side), sub(b, side), sub(a, side)])
    }

    /// Least and greatest x, least and greatest y; turned inside out when a coordinate is not finite.
    fn bounds(&self) -> [f64; 4] {
        let empty = [f64::INFINITY, f64::NEG_INFINITY, f64::INFINITY, f64::NEG_INFINITY];
        let grow = |[x0, x1, y0, y1]: [f64; 4], ([x, y], r): (Point, f64)| {
            [x0.min(x - r), x1.max(x + r), y0.min(y - r), y1.max(y + r)]
        };
        match self {
            Self::Outlines(lines) => lines.iter().flatten().map(|point| (*point, 0.0)).fold(empty, grow),
            Self::Capsule(ends) => ends.iter().copied().fold(empty, grow),
        }
    }
}

/// A window of the plate, in whole px.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Window {
    pub(super) left: u32,
    pub(super) top: u32,
    pub(super) width: u32,
    pub(super) height: u32,
}

impl Window {
    /// The least window around points, within a plate of a size in px.
    pub(super) fn around(points: &[Point], [width, height]: [u32; 2]) -> Self {
        let limit = |v: f64, most: u32| v.clamp(0.0, f64::from(most)) as u32;
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for point in points {
            low = [0, 1].map(|i| low[i].min(point[i]));
            high = [0, 1].map(|i| high[i].max(point[i]));
        }
        let (left, top) = (limit(low[0].floor(), width), limit(low[1].floor(), height));
        let (right, bottom) = (limit(high[0].ceil(), width), limit(high[1].ceil(), height));
        Self { left, top, width: right.saturating_sub(left), height: bottom.saturating_sub(top) }
    }

    /// What a set of shapes needs of this window, with a margin in px.
    fn needed(&self, shapes: &[Shape], margin: f64) -> Self {
        let corners: Vec<Point> = shapes
            .iter()
            .flat_map(|shape| {
                let [x0, x1, y0, y1] = shape.bounds();
                [[x0 - margin, y0 - margin], [x1 + margin, y1 + margin]]
            })
            .collect();
        let (right, bottom) = (self.left + self.width, self.top + self.height);
        let mut inner = Self::around(&corners, [right, bottom]);
        let (x, y) = (inner.left.max(self.left), inner.top.max(self.top));
        inner.width = (inner.left + inner.width).saturating_sub(x);
        inner.height = (inner.top + inner.height).saturating_sub(y);
        (inner.left, inner.top) = (x, y);
        inner
    }
}

/// Grey values or coverage of a window, one number per pixel.
pub(super) type Field = ImageBuffer<Luma<f32>, Vec<f32>>;

/// How much of each pixel of a window a set of shapes covers, 0 to 1.
#[derive(Clone, Debug)]
pub(super) struct Mask {
    pub(super) window: Window,
    pub(super) cover: Field,
}

impl Mask {
    /// The union of shapes, cut at a window, with room for a margin in px around them.
    pub(super) fn of(shapes: &[Shape], within: Window, margin: f64) -> Self {
        let window = within.needed(shapes, margin);
        let mut mask = Self { window, cover: Field::new(window.width, window.height) };
        for shape in shapes {
            mask.unite(shape);
        }
        mask
    }

    fn unite(&mut self, shape: &Shape) {
        let window = self.window.needed(std::slice::from_ref(shape), 1.0);
        if window.width == 0 || window.height == 0 {
            return;
        }
        let (dx, dy) = (window.left - self.window.left, window.top - self.window.top);
        let origin = [f64::from(window.left), f64::from(window.top)];
        let cover = match shape {
            Shape::Outlines(lines) => outlines_cover(lines, origin, window.width, window.height),
            Shape::Capsule(ends) => {
                let ends = ends.map(|(centre, radius)| (sub(centre, origin), radius));
                Field::from_fn(window.width, window.height, |x, y| {
                    let at = [f64::from(x) + 0.5, f64::from(y) + 0.5];
                    Luma([(0.5 - capsule_distance(at, ends)).clamp(0.0, 1.0) as f32])
                })
            }
        };
        for (x, y, value) in cover.enumerate_pixels() {
            let here = &mut self.cover.get_pixel_mut(x + dx, y + dy).0[0];
            *here = here.max(value.0[0]);
        }
    }

    /// Coverage at a point of the plate; zero outside the window.
    pub(super) fn at(&self, [x, y]: Point) -> f32 {
        let (x, y) = (x - f64::from(self.window.left), y - f64::from(self.window.top));
        if x < 0.0 || y < 0.0 {
            return 0.0;
        }
        self.cover.get_pixel_checked(x as u32, y as u32).map_or(0.0, |pixel| pixel.0[0])
    }
}

/// Signed distance of a point from a capsule whose ends are two circles.
fn capsule_distance(at: Point, [(a, ra), (b, rb)]: [(Point, f64); 2]) -> f64 {
    let ([px, py], [bx, by]) = (sub(at, a), sub(b, a));
    let (length, drop) = (bx.hypot(by), ra - rb);
    if length <= drop.abs() {
        // One circle holds the other.
        return if drop > 0.0 { px.hypot(py) - ra } else { (px - bx).hypot(py - by) - rb };
    }
    let (ux, uy) = (bx / length, by / length);
    let (along, across) = (px * ux + py * uy, (px * uy - py * ux).abs());
    // The tangent leans by the angle whose sine is the taper.
    let sin = drop / length;
    let cos = (1.0 - sin * sin).sqrt();
    let foot = along * cos - across * sin;
    if foot <= 0.0 {
        px.hypot(py) - ra
    } else if foot >= length * cos {
        (px - bx).hypot(py - by) - rb
    } else {
        across * cos + along * sin - ra
    }
}

/// Share of each pixel inside closed lines, exact where they do not overlap (Levien's accumulation of signed areas, as in
/// font-rs). `origin` is the picture's top left corner.
fn outlines_cover(lines: &[Vec<Point>], origin: Point, width: u32, height: u32) -> Field {
    // Two columns more than the picture take what an edge on the right border adds behind it.
    let row = width as usize + 2;
    let mut areas = vec![0.0f64; row * height as usize];
    for line in lines {
        let points: Vec<Point> = line.iter().map(|point| sub(*point, origin)).collect();
        let points = cut_to(points, [f64::from(width), f64::from(height)]);
        for (i, a) in points.iter().enumerate() {
            add_edge(&mut areas, row, *a, points[(i + 1) % points.len()]);
        }
    }
    let mut cover = Field::new(width, height);
    for (values, areas) in cover.chunks_exact_mut(width as usize).zip(areas.chunks_exact(row)) {
        let mut sum = 0.0;
        for (value, area) in values.iter_mut().zip(areas) {
            sum += area;
            *value = sum.abs().min(1.0) as f32;
        }
    }
    cover
}

/// Adds what an edge contributes to each pixel's change of coverage along its row.
fn add_edge(areas: &mut [f64], row: usize, a: Point, b: Point) {
    if a[1] == b[1] {
        return;
    }
    let (sign, [ax, ay], [bx, by]) = if a[1] < b[1] { (1.0, a, b) } else { (-1.0, b, a) };
    let slope = (bx - ax) / (by - ay);
    for y in ay.floor() as usize..by.ceil() as usize {
        let (top, bottom) = (ay.max(y as f64), by.min(y as f64 + 1.0));
        let (x0, x1) = (ax + (top - ay) * slope, ax + (bottom - ay) * slope);
        let (left, right) = (x0.min(x1), x0.max(x1));
        let amount = sign * (bottom - top);
        let mut done = 0.0;
        for x in left.floor() as usize..=(right.floor() as usize).min(row - 2) {
            let total = amount * share_left_of(left, right, x as f64);
            if let Some(area) = areas.get_mut(y * row + x) {
                *area += total - done;
            }
            done = total;
        }
        if let Some(area) = areas.get_mut(y * row + (right.floor() as usize + 1).min(row - 1)) {
            *area += amount - done;
        }
    }
}

/// Mean share of a pixel from `x` to `x + 1` that lies to the right of an edge running evenly from `left` to `right`.
fn share_left_of(left: f64, right: f64, x: f64) -> f64 {
    // Integral of clamp(x + 1 - t, 0, 1) over t in [left, right], over its length.
    let span = right - left;
    if span < 1e-9 {
        return (x + 1.0 - left).clamp(0.0, 1.0);
    }
    let ramp = |t: f64| {
        // Integral from t to infinity of clamp(x + 1 - t, 0, 1).
        if t <= x { x - t + 0.5 } else { 0.5 * (x + 1.0 - t).max(0.0).powi(2) }
    };
    (ramp(left) - ramp(right)) / span
}

/// A polygon cut to the rectangle from zero to `size` (Sutherland and Hodgman).
fn cut_to(mut left: Vec<Point>, size: Point) -> Vec<Point> {
    left.retain(|point| point.iter().all(|v| v.is_finite()));
    for (axis, limit, sign) in [(0, 0.0, 1.0), (0, size[0], -1.0), (1, 0.0, 1.0), (1, size[1], -1.0)] {
        let mut kept = Vec::with_capacity(left.len() + 4);
        for (i, a) in left.iter().enumerate() {
            let b = left[(i + 1) % left.len()];
            let (inside_a, inside_b) = (sign * (a[axis] - limit), sign * (b[axis] - limit));
            if inside_a >= 0.0 {
                kept.push(*a);
            }
            if (inside_a > 0.0 && inside_b < 0.0) || (inside_a < 0.0 && inside_b > 0.0) {
                let mut on = between(*a, b, inside_a / (inside_a - inside_b));
                on[axis] = limit;
                kept.push(on);
            }
        }
        left = kept;
    }
    left
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: Window = Window { left: 3, top: 5, width: 40, height: 30 };

    fn area(shapes: &[Shape]) -> f64 {
        Mask::of(shapes, ALL, 2.0).cover.iter().map(|cover| f64::from(*cover)).sum()
    }

    fn triangle() -> Vec<Point> {
        vec![[10.3, 8.2], [31.7, 12.9], [17.1, 28.6]]
    }

    #[test]
    fn a_polygon_covers_its_exact_area_whichever_way_it_turns() {
        let [a, b, c] = [[10.3, 8.2], [31.7, 12.9], [17.1, 28.6]];
        let ([ux, uy], [vx, vy]) = (sub(b, a), sub(c, a));
        let exact = 0.5 * (ux * vy - uy * vx);
        let backwards = triangle().into_iter().rev().collect();
        assert!((area(&[Shape::polygon(triangle())]) - exact).abs() < 1e-3);
        assert!((area(&[Shape::polygon(backwards)]) - exact).abs() < 1e-3);
    }

    #[test]
    fn what_lies_outside_the_window_is_cut_off() {
        let around = vec![[-90.0, -70.0], [200.0, -60.0], [190.0, 300.0], [-80.0, 250.0]];
        assert!((area(&[Shape::polygon(around)]) - 1200.0).abs() < 1e-3);
        let beside = vec![[100.0, 10.0], [120.0, 10.0], [110.0, 20.0]];
        assert_eq!(area(&[Shape::polygon(beside)]), 0.0);
    }

    #[test]
    fn an_inner_line_of_the_other_sense_is_a_hole() {
        let square = |r: f64| {
            vec![[20.0 - r, 20.0 - r], [20.0 + r, 20.0 - r], [20.0 + r, 20.0 + r], [20.0 - r, 20.0 + r]]
        };
        let hole = square(3.0).into_iter().rev().collect();
        assert!((area(&[Shape::Outlines(vec![square(8.0), hole])]) - (256.0 - 36.0)).abs() < 1e-3);
    }

    #[test]
    fn a_capsule_has_the_area_of_its_circles_and_tangents() {
        let disc = Shape::Capsule([([20.2, 18.7], 6.0), ([20.2, 18.7], 6.0)]);
        assert!((area(&[disc]) - 36.0 * std::f64::consts::PI).abs() < 1.0);
        // Equal radii: a disc and a rectangle between its halves.
        let rod = Shape::Capsule([([12.0, 20.0], 4.0), ([32.0, 20.0], 4.0)]);
        assert!((area(&[rod]) - (16.0 * std::f64::consts::PI + 160.0)).abs() < 1.0);
        let inside = Shape::Capsule([([20.0, 20.0], 6.0), ([21.0, 20.0], 2.0)]);
        assert!((area(&[inside]) - 36.0 * std::f64::consts::PI).abs() < 1.0);
    }
}
