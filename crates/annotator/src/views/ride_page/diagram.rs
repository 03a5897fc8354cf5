//! The footfalls of the last seconds, drawn as they fall.

use egui::accesskit::Role;
use egui::{Align2, Color32, FontId, Mesh, Rect, Sense, Shape, Stroke, Ui, WidgetInfo, pos2, vec2};
use muybridge_core::{Gait, Limb, Side};

use super::speed;
use crate::colors;
use crate::ride::record::{Frame, STEP_S};
use crate::ride::{RideSession, Which};

/// What is shown, s.
const SHOWN_S: f64 = 4.0;
/// Height of a lane, points.
const LANE: f32 = 15.0;
/// Height of the row of gaits above the lanes, and of the row of feet below them.
const ROW: f32 = 15.0;
/// Width of the names at the left, and of the present at the right.
const NAMES: f32 = 44.0;
const PRESENT: f32 = 24.0;
/// How much of a lane's height horse B takes when there is one.
const SECOND: f32 = 0.36;

/// One horse at one moment, for the diagram.
type Fall = Option<([bool; 4], Option<Gait>)>;

/// The diagram; a drag pulls time back and forth.
pub(super) fn show(ui: &mut Ui, ride: &mut RideSession) {
    let height = 2.0 * ROW + 4.0 * LANE;
    let (outer, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click_and_drag());
    let name = "Footfalls of the last seconds: drag to go back and forth in time";
    response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, name));
    let lanes = Rect::from_min_max(
        outer.min + vec2(NAMES, ROW),
        pos2(outer.right() - PRESENT, outer.top() + ROW + 4.0 * LANE),
    );
    let steps = (SHOWN_S / STEP_S) as usize;
    let frames: Vec<&Frame> = ride.record().between(ride.back() + steps, ride.back()).collect();
    let first = steps + 1 - frames.len().min(steps + 1);
    let columns = Columns { lanes, first, count: steps + 1 };
    backgrounds(ui, lanes);
    let present = columns.horse(ui, &frames, Which::A);
    if ride.shown().riders[1].is_some() {
        columns.horse(ui, &frames, Which::B);
    }
    columns.gaits(ui, &frames);
    columns.feet(ui, &frames);
    columns.present(ui, present);
    if response.dragged() {
        let by = f64::from(response.drag_delta().x / lanes.width()) * SHOWN_S / STEP_S;
        // What is less than a step is kept by the pointer, not by us: a slow drag must move, too.
        let id = response.id.with("carried");
        let carried = ui.data(|data| data.get_temp::<f64>(id)).unwrap_or(0.0) + by;
        ui.data_mut(|data| data.insert_temp(id, carried - carried.trunc()));
        let back = ride.back() as f64 + carried.trunc();
        ride.go_back(back.max(0.0) as usize);
    }
    response.on_hover_text(
        "The last four seconds; the thin bars are horse B. Drag to go back and forth in time.",
    );
}

fn backgrounds(ui: &Ui, lanes: Rect) {
    for limb in Limb::ALL {
        let top = lanes.top() + LANE * limb.index() as f32;
        let lane = Rect::from_min_size(pos2(lanes.left(), top), vec2(lanes.width(), LANE));
        ui.painter().rect_filled(lane.shrink2(vec2(0.0, 1.0)), 2.0, ui.visuals().extreme_bg_color);
        let at = pos2(lanes.left() - 8.0, lane.center().y);
        let color = ui.visuals().text_color();
        ui.painter().text(at, Align2::RIGHT_CENTER, limb.abbreviation(), FontId::monospace(12.0), color);
    }
}

/// Where the moments are.
struct Columns {
    lanes: Rect,
    /// Columns before the oldest frame there is.
    first: usize,
    count: usize,
}

impl Columns {
    /// Left edge of the column of a frame, points.
    fn x(&self, at: usize) -> f32 {
        let share = (self.first + at) as f32 / self.count as f32;
        self.lanes.left() + self.lanes.width() * share
    }

    /// Runs of equal values: from, to (exclusive), value.
    fn runs<T: PartialEq + Copy>(frames: &[&Frame], value: impl Fn(&Frame) -> T) -> Vec<(usize, usize, T)> {
        let mut runs: Vec<(usize, usize, T)> = Vec::new();
        for (at, frame) in frames.iter().enumerate() {
            let value = value(frame);
            match runs.last_mut() {
                Some((_, to, last)) if *last == value => *to = at + 1,
                _ => runs.push((at, at + 1, value)),
            }
        }
        runs
    }

    /// The bars of a horse; what it does at the last moment.
    fn horse(&self, ui: &Ui, frames: &[&Frame], which: Which) -> Fall {
        let mut mesh = Mesh::default();
        for limb in Limb::ALL {
            let down = |frame: &Frame| {
                let rider = frame.riders[which.index()].as_ref();
                rider.is_some_and(|rider| rider.readout.on_ground[limb.index()])
            };
            let top = self.lanes.top() + LANE * limb.index() as f32 + 2.0;
            let (top, bottom, color) = match which {
                Which::A => (top, top + LANE - 4.0, side_color(limb.side())),
                Which::B => (top + (LANE - 4.0) * (1.0 - SECOND), top + LANE - 4.0, second_color(ui)),
            };
            for (from, to, _) in Self::runs(frames, down).into_iter().filter(|(_, _, down)| *down) {
                let bar = Rect::from_min_max(pos2(self.x(from), top), pos2(self.x(to), bottom));
                mesh.add_colored_rect(bar, color);
            }
        }
        ui.painter().add(Shape::mesh(mesh));
        let rider = frames.last()?.riders[which.index()].as_ref()?;
        Some((rider.readout.on_ground, (!rider.readout.is_standing).then_some(rider.readout.gait)))
    }

    /// The gaits above the lanes, a line where one changes into another.
    fn gaits(&self, ui: &Ui, frames: &[&Frame]) {
        let gait = |frame: &Frame| {
            let rider = frame.riders[0].as_ref();
            rider.and_then(|rider| (!rider.readout.is_standing).then_some(rider.readout.gait))
        };
        let runs = Self::runs(frames, gait);
        for (at, (from, to, gait)) in runs.iter().enumerate() {
            let (left, right) = (self.x(*from), self.x(*to));
            let row = Rect::from_min_max(pos2(left, self.lanes.top() - ROW), pos2(right, self.lanes.top()));
            let color = gait.map_or(ui.visuals().weak_text_color(), speed::color);
            let band = Rect::from_min_max(pos2(left, row.bottom() - 3.0), pos2(right, row.bottom() - 1.0));
            ui.painter().rect_filled(band, 0.0, color);
            let name = gait.map_or("stands", Gait::name);
            let font = FontId::proportional(11.0);
            let clipped = ui.painter().with_clip_rect(row.intersect(ui.clip_rect()));
            let color = super::legible(ui, color);
            clipped.text(row.left_center() + vec2(4.0, -2.0), Align2::LEFT_CENTER, name, font, color);
            if at > 0 {
                let stroke = Stroke::new(1.0, ui.visuals().text_color().gamma_multiply(0.6));
                ui.painter().vline(left, row.top()..=self.lanes.bottom(), stroke);
            }
        }
    }

    /// How many feet are down, below the lanes: the more, the darker.
    fn feet(&self, ui: &Ui, frames: &[&Frame]) {
        let count = |frame: &Frame| {
            let rider = frame.riders[0].as_ref();
            rider.map_or(0, |rider| rider.readout.on_ground.iter().filter(|down| **down).count())
        };
        let text = ui.visuals().text_color();
        let at = pos2(self.lanes.left() - 8.0, self.lanes.bottom() + ROW / 2.0);
        ui.painter().text(at, Align2::RIGHT_CENTER, "feet", FontId::proportional(11.0), text);
        for (from, to, feet) in Self::runs(frames, count) {
            let (left, right) = (self.x(from), self.x(to));
            let top = self.lanes.bottom() + 2.0;
            let row = Rect::from_min_max(pos2(left, top), pos2(right, top + ROW - 3.0));
            ui.painter().rect_filled(row, 0.0, text.gamma_multiply(0.11 * feet as f32));
            if row.width() > 9.0 {
                let font = FontId::proportional(10.5);
                ui.painter().text(row.center(), Align2::CENTER_CENTER, feet.to_string(), font, text);
            }
        }
    }

    /// The edge of the present, and which feet are down.
    fn present(&self, ui: &Ui, fall: Fall) {
        let x = self.x(self.count - self.first);
        let stroke = Stroke::new(1.5, ui.visuals().strong_text_color());
        ui.painter().vline(x, self.lanes.y_range(), stroke);
        let Some((on_ground, _)) = fall else { return };
        for limb in Limb::ALL {
            let at = pos2(x + PRESENT / 2.0, self.lanes.top() + LANE * (limb.index() as f32 + 0.5));
            let color = side_color(limb.side());
            if on_ground[limb.index()] {
                ui.painter().circle_filled(at, 4.5, color);
            } else {
                ui.painter().circle_stroke(at, 4.0, Stroke::new(1.0, color));
            }
        }
    }
}

/// Left and right as in the figure, whose right side is towards the camera of the side view.
fn side_color(side: Side) -> Color32 {
    match side {
        Side::Right => colors::NEAR,
        Side::Left => colors::OFF,
    }
}

/// Horse B over the bars of A.
fn second_color(ui: &Ui) -> Color32 {
    ui.visuals().strong_text_color().gamma_multiply(0.75)
}
