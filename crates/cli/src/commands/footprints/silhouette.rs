//! The figure from its right side, as areas.

use glam::DVec3;
use muybridge_core::{BONE_COUNT, Joints, Limb, Skeleton, bone};
use muybridge_footprints::Figure;

use super::sheet::{Color, PAPER, Sheet};
use super::unrolled::Unrolled;
use super::walk::Walk;

/// Half thicknesses of a horse's trunk, neck, head and legs (at their roots and at the hoof), metres, by eye.
const TRUNK_M: f64 = 0.25;
const NECK_M: [f64; 2] = [0.2, 0.08];
const HEAD_M: [f64; 2] = [0.1, 0.055];
const LEG_M: [f64; 6] = [0.12, 0.1, 0.075, 0.045, 0.04, 0.045];
/// The trunk hangs so far below its bones, metres.
const BELLY_M: f64 = 0.22;
const COAT: Color = [164, 92, 50];
/// The figure is measured at so many moments.
const MOMENTS: u32 = 24;
/// How much of the figure's own colour is left.
const PALE: f64 = 0.42;

/// A ball at a joint: its middle and its half thickness, metres.
type Ball = (DVec3, f64);

/// Draws the figure of a moment, pale. `place` makes px of metres along the way and metres of height.
pub(super) fn draw(
    sheet: &mut Sheet,
    walk: &Walk,
    way: &Unrolled,
    time_s: f64,
    place: &impl Fn([f64; 2]) -> [f64; 2],
) {
    let px_per_m = place([1.0, 0.0])[0] - place([0.0, 0.0])[0];
    let mut chains = chains(walk, time_s);
    let depth = |chain: &[Ball]| {
        chain.iter().map(|(at, _)| way.aside_m(time_s, *at)).sum::<f64>() / chain.len().max(1) as f64
    };
    chains.sort_by(|a, b| depth(&a.0).total_cmp(&depth(&b.0)));
    for (chain, color) in chains {
        let color = [0, 1, 2].map(|i| {
            (f64::from(PAPER[i]) + PALE * (f64::from(color[i]) - f64::from(PAPER[i]))).round() as u8
        });
        let balls: Vec<([f64; 2], f64)> =
            chain.iter().map(|(at, half_m)| (place(way.place(time_s, *at)), half_m * px_per_m)).collect();
        balls.iter().for_each(|(at, radius)| sheet.dot(*at, *radius, color));
        balls.windows(2).for_each(|pair| sheet.area(between(pair[0], pair[1]), color, 1.0));
    }
}

/// The figure's extent at a time: along the way, least and most, and its top, metres.
pub(super) fn extent(walk: &Walk, way: &Unrolled, time_s: f64) -> ([f64; 2], f64) {
    let (mut range, mut top) = ([f64::INFINITY, f64::NEG_INFINITY], f64::NEG_INFINITY);
    for (at, half_m) in chains(walk, time_s).into_iter().flat_map(|(chain, _)| chain) {
        let [along, up] = way.place(time_s, at);
        range = [range[0].min(along - half_m), range[1].max(along + half_m)];
        top = f64::max(top, up + half_m);
    }
    (range, top)
}

/// The figure's greatest length along its way, metres.
pub(super) fn length_m(walk: &Walk, way: &Unrolled) -> f64 {
    let moment = |i: u32| walk.motion.duration_s() * f64::from(i) / f64::from(MOMENTS);
    let lengths = (0..=MOMENTS).map(|i| extent(walk, way, moment(i)).0).map(|[from, to]| to - from);
    lengths.filter(|length| length.is_finite()).fold(0.1, f64::max)
}

/// Rows of balls with a skin around each, and their colours.
fn chains(walk: &Walk, time_s: f64) -> Vec<(Vec<Ball>, Color)> {
    let figure = walk.motion.figure(time_s);
    match (&figure, walk.skeleton()) {
        (Figure::Horse(pose), Some(skeleton)) => horse(&pose.joints(skeleton)),
        _ => {
            let tubes = walk.motion.tubes(&figure).into_iter();
            let balls = |tube: &muybridge_footprints::Tube| {
                let both = tube.points.iter().zip(&tube.radii_m);
                both.map(|(at, radii)| (at.as_dvec3(), f64::from(radii.y))).collect()
            };
            tubes.map(|tube| (balls(&tube), tube.color)).collect()
        }
    }
}

fn horse(joints: &Joints) -> Vec<(Vec<Ball>, Color)> {
    let tip = |i: usize| joints.tips[i].as_dvec3();
    let belly = |at: DVec3| at - DVec3::Y * BELLY_M;
    let mut trunk = vec![(belly(joints.root.as_dvec3()), TRUNK_M)];
    trunk.extend((bone::SPINE..=bone::SPINE_LAST).map(|i| (belly(tip(i)), TRUNK_M)));
    let necks = (bone::SPINE_LAST..=bone::NECK_LAST).collect::<Vec<_>>();
    let share = |i: usize| i as f64 / (necks.len() - 1) as f64;
    let neck = necks.iter().enumerate().map(|(k, &i)| {
        let half_m = NECK_M[0] + (NECK_M[1] - NECK_M[0]) * share(k);
        (tip(i) - DVec3::Y * (0.85 * half_m), half_m)
    });
    let head = vec![(tip(bone::NECK_LAST) - DVec3::Y * 0.08, HEAD_M[0]), (tip(bone::HEAD), HEAD_M[1])];
    let mut chains = vec![(trunk, COAT), (neck.collect(), COAT), (head, COAT)];
    for limb in Limb::ALL {
        let bones: Vec<usize> = (0..BONE_COUNT).filter(|i| Skeleton::limb_of(*i) == Some(limb)).collect();
        let balls = bones.iter().enumerate().map(|(k, &i)| (tip(i), LEG_M[(k + 1).min(LEG_M.len() - 1)]));
        let first = bones.first().map(|&i| (joints.bases[i].as_dvec3(), LEG_M[0]));
        chains.push((first.into_iter().chain(balls).collect(), COAT.map(|v| v - v / 5)));
    }
    chains
}

/// The four corners where a skin touches two balls.
fn between((a, from): ([f64; 2], f64), (b, to): ([f64; 2], f64)) -> Vec<[f64; 2]> {
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let length = dx.hypot(dy).max(1e-9);
    let (nx, ny) = (-dy / length, dx / length);
    vec![
        [a[0] + nx * from, a[1] + ny * from],
        [b[0] + nx * to, b[1] + ny * to],
        [b[0] - nx * to, b[1] - ny * to],
        [a[0] - nx * from, a[1] - ny * from],
    ]
}
