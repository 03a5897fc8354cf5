//! Triangles that lead from the plate to the screen, and cutting them at the edges of tiles.

use std::collections::BTreeMap;

use super::tiles::TILE;

/// Plate x and y (px), screen x and y (points) of one corner.
pub(super) type Corner = [f64; 4];
/// A convex polygon.
pub(super) type Polygon = Vec<Corner>;

/// Largest error of a triangle against the true map, in pixels of the screen: no eye sees it.
const INVISIBLE_PX: f64 = 0.25;
/// Most cells along a side; enough for 64 pixels of perspective distortion.
const MOST_CELLS: usize = 16;

/// Triangles of the unit square mapped by `corner_at(u, v)`, as many as the map's bend needs.
/// `pixels_per_point` and the map's own scale turn distances into pixels of the screen.
pub(super) fn triangles(corner_at: impl Fn(f64, f64) -> Corner, pixels_per_point: f64) -> Vec<[Corner; 3]> {
    let cells = cells(&corner_at, pixels_per_point);
    let at = |x: usize, y: usize| corner_at(x as f64 / cells as f64, y as f64 / cells as f64);
    let mut triangles = Vec::with_capacity(2 * cells * cells);
    for y in 0..cells {
        for x in 0..cells {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            triangles.extend([[a, b, c], [a, c, d]]);
        }
    }
    triangles.retain(|triangle| triangle.as_flattened().iter().all(|v| v.is_finite()));
    triangles
}

/// How many cells along a side keep the error invisible: it falls with their square.
fn cells(corner_at: &impl Fn(f64, f64) -> Corner, pixels_per_point: f64) -> usize {
    let corners = [corner_at(0.0, 0.0), corner_at(1.0, 0.0), corner_at(1.0, 1.0), corner_at(0.0, 1.0)];
    let scale = scale(&[[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]);
    let middles = [(0.5, 0.0, &corners[..2]), (1.0, 0.5, &corners[1..3]), (0.5, 1.0, &corners[2..])];
    let errors = middles.into_iter().chain([(0.5, 0.5, &corners[..])]).map(|(u, v, around)| {
        let mean = |i: usize| around.iter().map(|corner| corner[i]).sum::<f64>() / around.len() as f64;
        let middle = corner_at(u, v);
        let [px, py, sx, sy] = [0, 1, 2, 3].map(|i| middle[i] - mean(i));
        px.hypot(py) * scale + sx.hypot(sy)
    });
    let worst = errors.fold(0.0, f64::max) * pixels_per_point;
    ((worst / INVISIBLE_PX).sqrt().ceil() as usize).clamp(1, MOST_CELLS)
}

/// Screen points per plate px over all triangles; zero when they have no area on the screen, and infinite or NaN when
/// they have none on the plate.
pub(super) fn scale(triangles: &[[Corner; 3]]) -> f64 {
    let area = |[a, b, c]: &[Corner; 3], x: usize| {
        ((b[x] - a[x]) * (c[x + 1] - a[x + 1]) - (c[x] - a[x]) * (b[x + 1] - a[x + 1])).abs()
    };
    let sum = |x: usize| triangles.iter().map(|triangle| area(triangle, x)).sum::<f64>();
    (sum(2) / sum(0)).sqrt()
}

/// The parts of the triangles that are inside `least..=most` (of all four coordinates), by row and column of the tiles
/// of a level.
pub(super) fn by_tile(
    triangles: &[[Corner; 3]],
    [least, most]: [Corner; 2],
    level: usize,
) -> BTreeMap<(u32, u32), Vec<Polygon>> {
    let tile_px = f64::from(TILE) * (level as f64).exp2();
    let mut tiles: BTreeMap<(u32, u32), Vec<Polygon>> = BTreeMap::new();
    for triangle in triangles {
        let visible = cut_box(triangle.to_vec(), least, most, 0..4);
        if visible.is_empty() {
            continue;
        }
        let index = |i: usize, pick: fn(f64, f64) -> f64, start: f64| {
            visible.iter().map(|corner| corner[i]).fold(start, pick) / tile_px
        };
        // What ends at a tile's edge does not reach into the next tile.
        let range = |i| {
            let first = index(i, f64::min, f64::INFINITY).floor().max(0.0) as u32;
            first..(index(i, f64::max, 0.0).ceil() as u32).max(first + 1)
        };
        for row in range(1) {
            for column in range(0) {
                let low = [f64::from(column) * tile_px, f64::from(row) * tile_px, 0.0, 0.0];
                let part = cut_box(visible.clone(), low, low.map(|v| v + tile_px), 0..2);
                if !part.is_empty() {
                    tiles.entry((row, column)).or_default().push(part);
                }
            }
        }
    }
    tiles
}

/// The part of a polygon between two corners along some of the coordinates; empty, or at least a triangle.
fn cut_box(mut polygon: Polygon, least: Corner, most: Corner, axes: std::ops::Range<usize>) -> Polygon {
    for axis in axes {
        polygon = cut(polygon, axis, 1.0, least[axis]);
        polygon = cut(polygon, axis, -1.0, -most[axis]);
    }
    polygon
}

/// The part of a polygon where `sign` times a coordinate is at least `bound` (Sutherland and Hodgman 1974).
fn cut(polygon: Polygon, axis: usize, sign: f64, bound: f64) -> Polygon {
    let inside = |corner: &Corner| sign * corner[axis] - bound;
    if polygon.iter().all(|corner| inside(corner) >= 0.0) {
        return polygon;
    }
    let mut kept = Polygon::with_capacity(polygon.len() + 1);
    for (i, to) in polygon.iter().enumerate() {
        let from = &polygon[(i + polygon.len() - 1) % polygon.len()];
        let (before, after) = (inside(from), inside(to));
        if (before > 0.0 && after < 0.0) || (before < 0.0 && after > 0.0) {
            let share = before / (before - after);
            let mut crossing: Corner = std::array::from_fn(|k| from[k] + share * (to[k] - from[k]));
            crossing[axis] = sign * bound;
            kept.push(crossing);
        }
        if after >= 0.0 {
            kept.push(*to);
        }
    }
    if kept.len() < 3 { Polygon::new() } else { kept }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(polygon: &Polygon) -> f64 {
        (1..polygon.len() - 1).map(|i| triangle_area(polygon[0], polygon[i], polygon[i + 1])).sum()
    }

    fn triangle_area(a: Corner, b: Corner, c: Corner) -> f64 {
        ((b[0] - a[0]) * (c[1] - a[1]) - (c[0] - a[0]) * (b[1] - a[1])).abs() / 2.0
    }

    #[test]
    fn tiles_share_out_a_patch_without_gap_or_overlap() {
        let turned = |u: f64, v: f64| {
            let (x, y) = (200.0 + 1500.0 * u - 400.0 * v, 450.0 + 300.0 * u + 1200.0 * v);
            [x, y, 0.5 * x, 0.5 * y]
        };
        let triangles = triangles(turned, 1.0);
        assert_eq!(triangles.len(), 2, "an affine map needs no more");
        let all = [[f64::MIN; 4], [f64::MAX; 4]];
        let tiles = by_tile(&triangles, [[0.0, 0.0, f64::MIN, f64::MIN], all[1]], 0);
        let sum: f64 = tiles.values().flatten().map(area).sum();
        // A corner of 640 x 200 / 2 px is left of the plate.
        assert!((1500.0 * 1200.0 + 400.0 * 300.0 - 64_000.0 - sum).abs() < 1e-3, "{sum}");
        for (&(row, column), polygons) in &tiles {
            for corner in polygons.iter().flatten() {
                assert!(corner[0] >= f64::from(column * TILE) - 1e-6);
                assert!(corner[1] <= f64::from((row + 1) * TILE) + 1e-6);
                assert!((corner[2] - 0.5 * corner[0]).abs() < 1e-9, "the map is kept where it is cut");
            }
        }
    }

    #[test]
    fn a_bent_map_is_cut_finely_and_one_of_nan_not_drawn() {
        let bent = |u: f64, v: f64| [u, v, 600.0 * u / (1.0 + 0.2 * u), 400.0 * v / (1.0 + 0.2 * u)];
        let count = triangles(bent, 1.0).len();
        assert!((2 * 8 * 8..=2 * 16 * 16).contains(&count), "{count}");
        assert!(triangles(|_, _| [f64::NAN; 4], 1.0).is_empty());
    }
}
