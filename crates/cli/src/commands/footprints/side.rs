//! The side view: the curve of the centre of mass with its tangents, pale figures, the ground.

use glam::DVec3;
use muybridge_footprints::Support;

use super::chart::{Axis, Chart};
use super::plan::times;
use super::sheet::{Color, INK, Sheet};
use super::silhouette;
use super::supports::{color, foot_color, legend};
use super::unrolled::Unrolled;
use super::walk::Walk;

const GROUND: Color = [206, 190, 158];
const TANGENT: Color = [44, 140, 60];
/// A tangent is drawn as far as the body would go in this time to both sides, s.
const TANGENT_S: f64 = 0.09;
/// Figures are so many of their lengths apart.
const APART: f64 = 1.15;
const MOST_FIGURES: usize = 40;
/// Highest view, px, and room over the figures and under the ground, metres.
const HIGHEST_PX: f64 = 620.0;
const OVER_M: f64 = 0.15;
const UNDER_M: f64 = 0.12;

/// The side view of a motion on a sheet of a width, px.
pub(super) fn side(walk: &Walk, title: &str, width_px: f64) -> Sheet {
    let way = Unrolled::of(walk);
    let supports = walk.motion.placed.supports();
    let moments = way.moments(APART * silhouette::length_m(walk, &way), MOST_FIGURES);
    let chart = chart(walk, &way, &moments, &supports, width_px);
    let mut sheet = chart.sheet();
    let place = |at: [f64; 2]| chart.place(at);
    chart.draw_axes(&mut sheet, true);
    draw_ground(&mut sheet, walk, &way, &chart);
    for &time_s in &moments {
        silhouette::draw(&mut sheet, walk, &way, time_s, &place);
    }
    for print in &walk.motion.placed.prints {
        let time_s = 0.5 * (print.strike_s + print.lift_off_s);
        let outline = walk.outline(print);
        let ahead = print.world_from_foot * DVec3::X;
        let along = |at: &DVec3| (*at - print.middle).dot(ahead);
        let reach = |sign: f64| outline.iter().map(|at| sign * along(at)).fold(0.02, f64::max);
        let ends = [print.middle - ahead * reach(-1.0), print.middle + ahead * reach(1.0)];
        let points = ends.map(|at| place(way.place(time_s, at)));
        sheet.line(points.to_vec(), foot_color(print.foot), 4.0);
    }
    draw_curve(&mut sheet, walk, &way, &supports, &place);
    chart.draw_title(&mut sheet, title, "from the right, turns laid out straight");
    let mut entries = legend(&supports);
    entries.push((TANGENT, "tangents of the curve".into()));
    chart.draw_legend(&mut sheet, &entries);
    sheet
}

fn chart(walk: &Walk, way: &Unrolled, moments: &[f64], supports: &[Support], width_px: f64) -> Chart {
    let (mut along, mut up) = ([f64::INFINITY, f64::NEG_INFINITY], [f64::INFINITY, f64::NEG_INFINITY]);
    let widen = |range: &mut [f64; 2], value: f64| *range = [range[0].min(value), range[1].max(value)];
    for &time_s in moments {
        let (range, top) = silhouette::extent(walk, way, time_s);
        range.into_iter().for_each(|value| widen(&mut along, value));
        widen(&mut up, top + OVER_M);
    }
    for time_s in supports.iter().flat_map(times) {
        let [at, height] = way.place(time_s, walk.motion.centre_of_mass(time_s).at);
        widen(&mut along, at);
        widen(&mut up, height + OVER_M);
    }
    let grounds = way.way().map(|(_, at)| walk.ground_m(at));
    grounds.chain(walk.motion.placed.prints.iter().map(|print| print.middle.y)).for_each(|height| {
        widen(&mut up, height - UNDER_M);
    });
    let (long, high) = (along[1] - along[0], up[1] - up[0]);
    // What is high rather than long has ground on both sides.
    let margin = (0.02 * long).max(0.5 * (high * Chart::inner_px(width_px) / HIGHEST_PX - long));
    let axes =
        [Axis::new([along[0] - margin, along[1] + margin], "along the way (m)"), Axis::new(up, "height (m)")];
    Chart::new(width_px, axes, None)
}

/// The ground under the centre of mass, and level beyond its ends.
fn draw_ground(sheet: &mut Sheet, walk: &Walk, way: &Unrolled, chart: &Chart) {
    let mut points: Vec<[f64; 2]> = Vec::new();
    for (along, at) in way.way() {
        let point = chart.place([along, walk.ground_m(at)]);
        // Where the body goes back, the ground is there already.
        if points.last().is_none_or(|last| point[0] > last[0]) {
            points.push(point);
        }
    }
    let (left, right) = (chart.at[0], chart.at[0] + chart.size[0]);
    let ends = [points.first().copied(), points.last().copied()];
    let [Some([_, first]), Some([_, last])] = ends else { return };
    points.insert(0, [left, first]);
    points.push([right, last]);
    let bottom = chart.at[1] + chart.size[1];
    points.extend([[right, bottom], [left, bottom]]);
    sheet.area(points, GROUND, 1.0);
}

fn draw_curve(
    sheet: &mut Sheet,
    walk: &Walk,
    way: &Unrolled,
    supports: &[Support],
    place: &impl Fn([f64; 2]) -> [f64; 2],
) {
    let trajectory = &walk.motion.solved.trajectory;
    let knots = || trajectory.between(0.0, walk.motion.duration_s());
    for (time_s, knot) in knots() {
        let reach = knot.velocity * TANGENT_S;
        let ends = [knot.at - reach, knot.at + reach].map(|at| place(way.place(time_s, at)));
        sheet.line(ends.to_vec(), TANGENT, 1.4);
    }
    for support in supports {
        let points =
            times(support).map(|time_s| place(way.place(time_s, walk.motion.centre_of_mass(time_s).at)));
        sheet.line(points.collect(), color(&support.down), 3.0);
    }
    for (time_s, knot) in knots() {
        sheet.dot(place(way.place(time_s, knot.at)), 2.6, INK);
    }
}
