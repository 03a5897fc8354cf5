//! The plan: prints with their timing daggers, the way of the centre of mass, the ground's heights.

use glam::{DVec2, DVec3};
use muybridge_footprints::{Character, Placed, PlacedPrint, Support, Terrain, Trajectory};

use super::chart::{Axis, Chart, FOOT_PX, round_step};
use super::relief;
use super::sheet::{Anchor, Color, INK, MUTED, SMALL_PX, Sheet};
use super::supports::{color, foot_color, legend};
use super::walk::{Walk, outline};

/// Room around prints and daggers, in distances of the prints.
const MARGIN: f64 = 0.5;
/// Highest plan, px, and the least for each px of its width.
const HIGHEST_PX: f64 = 760.0;
const FLATTEST: f64 = 0.17;
/// Handles of the prints' headings.
const HANDLE: Color = [44, 140, 60];
const DAGGER: Color = [196, 44, 40];
/// Length of a dagger of the middle stance time, of the middle distance of prints.
const DAGGER_SHARE: f64 = 0.45;
/// Where prints are nearer than this, only each tenth has its number, px.
const NUMBER_PX: f64 = 36.0;
/// Samples of a curve for each time of equal support, at least, and for each second.
const SAMPLES: f64 = 12.0;
const SAMPLES_PER_S: f64 = 60.0;
/// Most samples of one curve.
const MOST_SAMPLES: f64 = 600.0;

/// Times in a support, both ends among them.
pub(super) fn times(support: &Support) -> impl Iterator<Item = f64> + use<> {
    let (from_s, length_s) = (support.from_s, support.to_s - support.from_s);
    let parts = (length_s * SAMPLES_PER_S).clamp(SAMPLES, MOST_SAMPLES).ceil() as u32;
    (0..=parts).map(move |i| from_s + length_s * f64::from(i) / f64::from(parts))
}

/// What a plan shows.
pub(super) struct View<'a> {
    pub(super) title: String,
    pub(super) about: String,
    pub(super) character: &'a Character,
    pub(super) terrain: &'a Terrain,
    pub(super) placed: &'a Placed,
    pub(super) trajectory: &'a Trajectory,
    /// Areas beside the prints, such as trees: their corners (x and z, metres), colour, and what they are.
    pub(super) things: Vec<(Vec<[f64; 2]>, Color, &'static str)>,
}

impl<'a> View<'a> {
    pub(super) fn of(walk: &'a Walk, title: &str) -> Self {
        Self {
            title: title.into(),
            about: "plan".into(),
            character: &walk.character,
            terrain: &walk.motion.track.terrain,
            placed: &walk.motion.placed,
            trajectory: &walk.motion.solved.trajectory,
            things: Vec::new(),
        }
    }

    /// The plan on a sheet of a width, px.
    pub(super) fn draw(&self, width_px: f64) -> Sheet {
        let supports = self.placed.supports();
        let dagger = Dagger::new(self.placed);
        let chart = self.chart(&supports, &dagger, width_px);
        let mut sheet = chart.sheet();
        let contours_m = relief::draw(&mut sheet, &chart, self.terrain);
        chart.draw_axes(&mut sheet, true);
        for (corners, color, _) in &self.things {
            sheet.area(corners.iter().map(|at| chart.place(*at)).collect(), *color, 1.0);
        }
        let place = |at: DVec3| chart.place([at.x, at.z]);
        for (number, print) in self.placed.prints.iter().enumerate() {
            let outline = outline(self.character, print);
            dagger.draw(&mut sheet, &chart, self.placed, number, &outline);
            let mut around: Vec<[f64; 2]> = outline.iter().copied().map(place).collect();
            let foot = foot_color(print.foot);
            sheet.area(around.clone(), foot, 0.28);
            around.extend(around.first().copied());
            sheet.line(around, foot, 1.4);
            draw_handle(&mut sheet, print, &outline, &place);
        }
        for support in &supports {
            let points = times(support).map(|time_s| place(self.trajectory.at(time_s).at)).collect();
            sheet.line(points, color(&support.down), 3.0);
        }
        self.trajectory
            .between(0.0, self.placed.end_s)
            .for_each(|(_, knot)| sheet.dot(place(knot.at), 2.6, INK));
        self.number_prints(&mut sheet, chart.scale(0), &place);
        chart.draw_title(&mut sheet, &self.title, &self.about);
        let mut entries = legend(&supports);
        for (_, color, name) in &self.things {
            if !name.is_empty() && !entries.iter().any(|(_, words)| words == name) {
                entries.push((*color, (*name).to_string()));
            }
        }
        chart.draw_legend(&mut sheet, &entries);
        dagger.explain(&mut sheet, &chart, contours_m);
        sheet
    }

    /// A chart with one scale for both axes, all of the motion in it.
    fn chart(&self, supports: &[Support], dagger: &Dagger, width_px: f64) -> Chart {
        let margin_m = MARGIN * dagger.way_m;
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        let mut take = |at: DVec3| {
            let at = DVec2::new(at.x, at.z);
            (low, high) = (low.min(at), high.max(at));
        };
        for (number, print) in self.placed.prints.iter().enumerate() {
            take(print.middle);
            take(dagger.end(self.placed, number, &outline(self.character, print)));
        }
        for support in supports {
            [support.from_s, support.to_s].into_iter().for_each(|time_s| take(self.trajectory.at(time_s).at));
        }
        self.things.iter().flat_map(|thing| &thing.0).for_each(|[x, z]| take(DVec3::new(*x, 0.0, *z)));
        (low, high) = (low - margin_m, high + margin_m);
        let middle = 0.5 * (low + high);
        let inner_px = Chart::inner_px(width_px);
        let px_per_m = (inner_px / (high.x - low.x)).min(HIGHEST_PX / (high.y - low.y));
        let half =
            DVec2::new(inner_px / px_per_m, (high.y - low.y).max(FLATTEST * inner_px / px_per_m)) / 2.0;
        // Seen from above, Z points down where X points to the right.
        let axes = [
            Axis::new([middle.x - half.x, middle.x + half.x], "x (m)"),
            Axis::new([middle.y + half.y, middle.y - half.y], "z (m)"),
        ];
        Chart::new(width_px, axes, None)
    }

    /// Writes the numbers of the prints beside their heels, as far as they have room.
    fn number_prints(&self, sheet: &mut Sheet, scale: f64, place: &impl Fn(DVec3) -> [f64; 2]) {
        let mut last: Vec<[f64; 2]> = Vec::new();
        let dense = scale * Dagger::new(self.placed).way_m < NUMBER_PX;
        let last_one = self.placed.prints.len();
        let is_named = |number: &usize| {
            !dense || *number == 0 || (number + 1).is_multiple_of(10) || number + 1 == last_one
        };
        for (number, print) in self.placed.prints.iter().enumerate().filter(|(number, _)| is_named(number)) {
            let side = if print.foot.index().is_multiple_of(2) { 1.0 } else { -1.0 };
            let reach = reach_m(print, &outline(self.character, print)).max(0.05);
            let beside = DVec3::new(-1.35 * reach, 0.0, -0.45 * side * reach);
            let [x, y] = place(print.middle + print.world_from_foot * beside);
            let at = [x, y + 4.0];
            if last.iter().rev().take(8).all(|other| (other[0] - at[0]).hypot(other[1] - at[1]) > 15.0) {
                sheet.text(at, &(number + 1).to_string(), INK, SMALL_PX, Anchor::Middle);
                last.push(at);
            }
        }
    }
}

/// How far an outline reaches from the middle of its print, metres.
fn reach_m(print: &PlacedPrint, outline: &[DVec3]) -> f64 {
    outline.iter().map(|at| at.distance(print.middle)).fold(0.0, f64::max)
}

/// The handle by which a print is turned.
fn draw_handle(
    sheet: &mut Sheet,
    print: &PlacedPrint,
    outline: &[DVec3],
    place: &impl Fn(DVec3) -> [f64; 2],
) {
    let length_m = reach_m(print, outline);
    let ahead = |share: f64| print.middle + print.world_from_foot * DVec3::X * (length_m * share);
    let [from, to] = [0.2, 1.5].map(|share| place(ahead(share)));
    sheet.line(vec![from, to], HANDLE, 1.4);
    sheet.dot(to, 2.8, HANDLE);
}

/// Timing daggers: a bar beside the foot as long as its stance time, a crossbar at its step time.
struct Dagger {
    m_per_s: f64,
    /// Middle distance of successive prints, metres.
    way_m: f64,
}

impl Dagger {
    fn new(placed: &Placed) -> Self {
        let prints = &placed.prints;
        let mut stances: Vec<f64> = prints.iter().map(|print| print.lift_off_s - print.strike_s).collect();
        let mut ways: Vec<f64> =
            prints.windows(2).map(|pair| pair[0].middle.distance(pair[1].middle)).collect();
        let middle = |values: &mut Vec<f64>| {
            values.sort_by(f64::total_cmp);
            values.get(values.len() / 2).copied().unwrap_or(1.0)
        };
        let way_m = middle(&mut ways).max(0.1);
        let m_per_s = round_step(DAGGER_SHARE * way_m / middle(&mut stances).max(0.01) / 2.0);
        Self { m_per_s, way_m }
    }

    /// Stance time and step time of a print, s.
    fn times_s(placed: &Placed, number: usize) -> [f64; 2] {
        let print = &placed.prints[number];
        let next_s = placed.prints.get(number + 1).map_or(placed.end_s, |next| next.strike_s);
        [print.lift_off_s.min(placed.end_s), next_s].map(|to_s| to_s - print.strike_s)
    }

    /// A place beside a print: so far out from its edge, and ahead, metres.
    fn beside(print: &PlacedPrint, outline: &[DVec3], out_m: f64, ahead_m: f64) -> DVec3 {
        let side = if print.foot.index().is_multiple_of(2) { -1.0 } else { 1.0 };
        let foot_from_world = print.world_from_foot.inverse();
        let aside = |at: &DVec3| (foot_from_world * (*at - print.middle)).z * side;
        let edge_m = outline.iter().map(aside).fold(0.0, f64::max);
        print.middle + print.world_from_foot * DVec3::new(ahead_m, 0.0, side * (edge_m + out_m))
    }

    /// Where the dagger of a print ends.
    fn end(&self, placed: &Placed, number: usize, outline: &[DVec3]) -> DVec3 {
        let [stance_s, step_s] = Self::times_s(placed, number);
        Self::beside(&placed.prints[number], outline, self.m_per_s * stance_s.max(step_s), 0.0)
    }

    fn draw(&self, sheet: &mut Sheet, chart: &Chart, placed: &Placed, number: usize, outline: &[DVec3]) {
        let print = &placed.prints[number];
        let at = |out_m: f64, ahead_m: f64| {
            let at = Self::beside(print, outline, out_m, ahead_m);
            chart.place([at.x, at.z])
        };
        let [stance_m, step_m] = Self::times_s(placed, number).map(|time_s| self.m_per_s * time_s);
        sheet.line(vec![at(0.0, 0.0), at(stance_m, 0.0)], DAGGER, 2.0);
        let half_m = 4.5 / chart.scale(0);
        sheet.line(vec![at(step_m, -half_m), at(step_m, half_m)], DAGGER, 2.0);
        // Between lift-off and the next footfall nothing holds the bar.
        let dashes = ((step_m - stance_m) * chart.scale(0) / 6.0).ceil().max(0.0);
        for i in 0..dashes as u32 {
            let along = |share: f64| stance_m + (step_m - stance_m) * (f64::from(i) + share) / dashes;
            sheet.line(vec![at(along(0.35), 0.0), at(along(0.75), 0.0)], DAGGER, 1.0);
        }
    }

    /// A dagger of a tenth of seconds that is easily measured, and the distance of the contours.
    fn explain(&self, sheet: &mut Sheet, chart: &Chart, contours_m: Option<f64>) {
        let shown_s = round_step(34.0 / (self.m_per_s * chart.scale(0)));
        let right = chart.at[0] + chart.size[0];
        let length_px = shown_s * self.m_per_s * chart.scale(0);
        let base = chart.at[1] + chart.size[1] + FOOT_PX;
        let middle = base - 4.0;
        let from = [right - length_px, middle];
        sheet.line(vec![from, [right, middle]], DAGGER, 2.0);
        sheet.line(vec![[right, middle - 4.5], [right, middle + 4.5]], DAGGER, 2.0);
        let heights = contours_m.map_or(String::new(), |every_m| format!("contours every {every_m} m;  "));
        let words = format!("{heights}daggers: bar = stance, crossbar = step, this long = {shown_s} s");
        sheet.text([from[0] - 8.0, base], &words, MUTED, SMALL_PX, Anchor::End);
    }
}
