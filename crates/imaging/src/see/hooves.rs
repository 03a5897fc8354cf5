//! Where the outline of a horse points down: hooves, on the ground or over it.

use imageproc::contours::{BorderType, find_contours};

use super::{HoofCandidate, Line, Silhouette};

/// A hoof stands out downward from what is to both sides of it by at least this share of the panel's height.
const PROMINENCE: f64 = 0.03;
/// With this share it is certain.
const GOOD_PROMINENCE: f64 = 0.1;
/// A hoof lies no higher than this share of the horse's height over its lowest point: folded under the belly.
const HIGHEST: f64 = 0.45;
/// Points this much higher than the lowest still belong to the sole, share of the panel's height.
const SOLE: f64 = 0.006;

pub(super) fn find(silhouette: &Silhouette, ground: Option<&Line>) -> Vec<HoofCandidate> {
    let mask = &silhouette.mask;
    let rows: Vec<u32> = mask.enumerate_pixels().filter(|(_, _, p)| p.0[0] > 0).map(|(_, y, _)| y).collect();
    let (Some(top), Some(bottom)) = (rows.first(), rows.last()) else { return Vec::new() };
    let highest = f64::from(*bottom) - HIGHEST * f64::from(bottom - top);
    let height = f64::from(mask.height());
    let mut all = Vec::new();
    for contour in find_contours::<i32>(mask).into_iter().filter(|c| c.border_type == BorderType::Outer) {
        let points: Vec<[f64; 2]> =
            contour.points.iter().map(|p| [f64::from(p.x) + 0.5, f64::from(p.y) + 1.0]).collect();
        for (at_px, prominence) in tips(&points, SOLE * height) {
            if at_px[1] < highest || prominence < PROMINENCE * height {
                continue;
            }
            let height_px = ground.map(|line| line.y_at(at_px[0]) - at_px[1]);
            let clear = (prominence / (GOOD_PROMINENCE * height)).min(1.0);
            all.push(HoofCandidate { at_px, height_px, confidence: clear * silhouette.confidence });
        }
    }
    all.sort_by(|a, b| a.at_px[0].total_cmp(&b.at_px[0]));
    all
}

/// The lowest places of a closed outline, each the middle of its sole, with how far one must climb to get to a lower one.
fn tips(points: &[[f64; 2]], sole: f64) -> Vec<([f64; 2], f64)> {
    let count = points.len();
    let y = |i: usize| points[i % count][1];
    let mut found = Vec::new();
    for i in 0..count {
        // The first point of each lowest run.
        if y(i + count - 1) >= y(i) {
            continue;
        }
        let end = (0..count).find(|k| y(i + k) != y(i)).unwrap_or(count);
        if y(i + end) > y(i) {
            continue;
        }
        let climb = |points: &mut dyn Iterator<Item = usize>| {
            let mut top = y(i);
            for k in points {
                if y(k) > y(i) {
                    return top;
                }
                top = top.min(y(k));
            }
            top
        };
        let forward = climb(&mut (i..i + count));
        let back = climb(&mut (i + 1..=i + count).rev());
        let near = |k: &usize| y(i) - y(*k) <= sole;
        let run = (i..i + count).take_while(near).chain((i + 1..=i + count).rev().take_while(near));
        let (mut left, mut right) = (f64::INFINITY, f64::NEG_INFINITY);
        for k in run {
            let x = points[k % count][0];
            (left, right) = (left.min(x), right.max(x));
        }
        found.push(([0.5 * (left + right), y(i)], y(i) - forward.max(back)));
    }
    found
}
