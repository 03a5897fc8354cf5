//! How far two quadrilaterals agree.

type Point = [f64; 2];

/// Area shared by two convex quadrilaterals, over the area of both together: 1 when they are the same, 0 when they do not
/// meet or either has no area. Corners run one way round in each, either way.
pub fn iou(a: &[Point; 4], b: &[Point; 4]) -> f64 {
    let (a, b) = (clockwise(a), clockwise(b));
    // Sutherland & Hodgman, *Reentrant polygon clipping* (1974).
    let mut shared = a.to_vec();
    for i in 0..4 {
        shared = clipped(&shared, b[i], b[(i + 1) % 4]);
    }
    let both = area(&shared).max(0.0);
    let either = area(&a) + area(&b) - both;
    if either > 0.0 { (both / either).clamp(0.0, 1.0) } else { 0.0 }
}

fn clockwise(quad: &[Point; 4]) -> [Point; 4] {
    let [a, b, c, d] = *quad;
    if area(quad) < 0.0 { [d, c, b, a] } else { *quad }
}

/// Positive when the corners run clockwise as seen, y pointing down.
pub(super) fn area(polygon: &[Point]) -> f64 {
    let next = polygon.iter().cycle().skip(1);
    0.5 * polygon.iter().zip(next).map(|([ax, ay], [bx, by])| ax * by - bx * ay).sum::<f64>()
}

/// The part of a polygon to the right of a line.
fn clipped(polygon: &[Point], from: Point, to: Point) -> Vec<Point> {
    let side = |[x, y]: Point| (to[0] - from[0]) * (y - from[1]) - (to[1] - from[1]) * (x - from[0]);
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, a) in polygon.iter().enumerate() {
        let b = polygon[(i + 1) % polygon.len()];
        let (here, there) = (side(*a), side(b));
        if here >= 0.0 {
            kept.push(*a);
        }
        if (here > 0.0 && there < 0.0) || (here < 0.0 && there > 0.0) {
            let share = here / (here - there);
            kept.push([a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])]);
        }
    }
    kept
}
