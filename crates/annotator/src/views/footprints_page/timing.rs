//! The timing diagram: a row per foot, a bar per stance, the height of the centre of mass; always in step with the plan.

use egui::accesskit::Role;
use egui::{
    Align2, CursorIcon, FontId, PointerButton, Pos2, Rect, Response, Sense, Shape, Stroke, Ui, Vec2,
    WidgetInfo, pos2, vec2,
};
use muybridge_footprints::Foot;

use super::curve::Curve;
use super::gesture::{Gesture, Grasp};
use crate::colors;
use crate::footprints::{Editor, StanceTimes};

/// Height of a row, points.
const ROW: f32 = 20.0;
/// Height of the row of the centre of mass.
const HEIGHTS: f32 = 40.0;
/// Height of the row of seconds.
const SECONDS: f32 = 15.0;
/// Width of the names at the left, and of the rest at the right.
const NAMES: f32 = 54.0;
const REST: f32 = 16.0;
/// Half the width in which an edge is grasped.
const GRASP: f32 = 4.0;
/// Bars narrower than this have no edges to grasp: one has to look closer.
const LEAST_BAR: f32 = 16.0;
/// More bars than this on the screen cannot be grasped.
const MOST_GRASPED: usize = 200;
/// A longer motion is shown in part at first, s.
const SHOWN_AT_FIRST_S: f64 = 20.0;
/// Shortest and longest time that is shown, s.
const SPAN_S: [f64; 2] = [0.2, 30_000.0];
/// Scrolled so far, a second is e times as long, points.
const SCROLL_PER_ZOOM: f32 = 300.0;
/// Lines are at least so far apart, points.
const LINES: f64 = 60.0;

/// The part of the time that is shown.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Window {
    from_s: f64,
    span_s: f64,
}

/// The diagram, as it is looked at.
#[derive(Default)]
pub(super) struct TimingView {
    /// None: the whole motion.
    window: Option<Window>,
    /// What was shown when a drag began: the scale must not change under the pointer.
    held: Option<Window>,
}

impl TimingView {
    /// Shows the whole motion again.
    pub(super) fn show_all(&mut self) {
        *self = Self::default();
    }

    fn shown(&self, end_s: f64) -> Window {
        let all = Window { from_s: 0.0, span_s: end_s.clamp(1.0, SHOWN_AT_FIRST_S) };
        self.held.or(self.window).unwrap_or(all)
    }
}

/// Where moments are on the screen.
struct Lanes {
    rect: Rect,
    window: Window,
    feet: Vec<Foot>,
}

impl Lanes {
    fn points_per_s(&self) -> f64 {
        f64::from(self.rect.width()) / self.window.span_s
    }

    fn x(&self, time_s: f64) -> f32 {
        let x = f64::from(self.rect.left()) + (time_s - self.window.from_s) * self.points_per_s();
        x.clamp(-30_000.0, 30_000.0) as f32
    }

    fn time_s(&self, x: f32) -> f64 {
        self.window.from_s + f64::from(x - self.rect.left()) / self.points_per_s()
    }

    fn row(&self, foot: Foot) -> Rect {
        let row = self.feet.iter().position(|other| *other == foot).unwrap_or(0);
        let top = self.rect.top() + ROW * row as f32;
        Rect::from_min_size(pos2(self.rect.left(), top), vec2(self.rect.width(), ROW))
    }

    fn heights(&self) -> Rect {
        let top = self.rect.top() + ROW * self.feet.len() as f32;
        Rect::from_min_size(pos2(self.rect.left(), top + 3.0), vec2(self.rect.width(), HEIGHTS - 3.0))
    }
}

/// The diagram over the whole width.
pub(super) fn show(
    ui: &mut Ui,
    view: &mut TimingView,
    editor: &mut Editor,
    gesture: &mut Option<Gesture>,
    curve: &Curve,
) {
    let is_biped =
        editor.prints().first().map_or(editor.track().model != "horse", |print| print.foot.is_biped());
    let feet: Vec<Foot> = if is_biped { Foot::BIPED.to_vec() } else { Foot::QUADRUPED.to_vec() };
    let height = ROW * feet.len() as f32 + HEIGHTS + SECONDS;
    let (outer, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click_and_drag());
    let name = "Present moment: drag to go through time, scroll to zoom, middle drag to move";
    response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, name));
    let rect = Rect::from_min_max(
        pos2(outer.left() + NAMES, outer.top()),
        pos2((outer.right() - REST).max(outer.left() + NAMES + 20.0), outer.bottom() - SECONDS),
    );
    let stances = editor.stances();
    let end_s = stances.iter().fold(editor.end_s(), |end_s, times| end_s.max(times.lift_off_s));
    let lanes = Lanes { rect, window: view.shown(end_s), feet };
    look(ui, view, &lanes, &response);
    scrub(editor, &lanes, &response);
    backgrounds(ui, &lanes);
    heights(ui, &lanes, curve);
    bars(ui, view, &lanes, editor, gesture, &stances);
    present(ui, &lanes, editor);
}

/// Zoom and pan.
fn look(ui: &Ui, view: &mut TimingView, lanes: &Lanes, response: &Response) {
    let Window { from_s, span_s } = lanes.window;
    if response.dragged_by(PointerButton::Middle) || response.dragged_by(PointerButton::Secondary) {
        let by_s = f64::from(response.drag_delta().x) / lanes.points_per_s();
        view.window = Some(Window { from_s: (from_s - by_s).max(0.0), span_s });
    }
    let Some(pointer) = response.hover_pos().filter(|_| response.contains_pointer()) else { return };
    let scrolled = ui.input_mut(|input| {
        let delta = std::mem::take(&mut input.smooth_scroll_delta);
        delta.x + delta.y
    });
    let factor = f64::from((-scrolled / SCROLL_PER_ZOOM).exp());
    if (factor - 1.0).abs() > 1e-6 {
        let about_s = lanes.time_s(pointer.x);
        let zoomed_s = (span_s * factor).clamp(SPAN_S[0], SPAN_S[1]);
        let from_s = (about_s - (about_s - from_s) * zoomed_s / span_s).max(0.0);
        view.window = Some(Window { from_s, span_s: zoomed_s });
    }
}

/// A click or drag beside the bars goes to a moment.
fn scrub(editor: &mut Editor, lanes: &Lanes, response: &Response) {
    if (response.clicked() || response.dragged_by(PointerButton::Primary))
        && let Some(at) = response.interact_pointer_pos()
    {
        let end_s = editor.end_s();
        editor.playback.is_playing = false;
        editor.playback.go_to(lanes.time_s(at.x), end_s);
    }
}

fn backgrounds(ui: &Ui, lanes: &Lanes) {
    let text = ui.visuals().text_color();
    for foot in &lanes.feet {
        let row = lanes.row(*foot);
        ui.painter().rect_filled(row.shrink2(vec2(0.0, 1.0)), 2.0, ui.visuals().extreme_bg_color);
        let at = pos2(row.left() - 8.0, row.center().y);
        ui.painter().text(at, Align2::RIGHT_CENTER, foot.abbreviation(), FontId::monospace(12.0), text);
    }
    let heights = lanes.heights();
    ui.painter().rect_filled(heights, 2.0, ui.visuals().extreme_bg_color);
    let at = pos2(heights.left() - 8.0, heights.center().y);
    ui.painter().text(at, Align2::RIGHT_CENTER, "height", FontId::proportional(11.0), text);
    let distance_s = super::plan_view::line_distance_m(lanes.points_per_s(), LINES);
    let first = (lanes.window.from_s / distance_s).ceil() as i64;
    let last = ((lanes.window.from_s + lanes.window.span_s) / distance_s).floor() as i64;
    for number in first..=last {
        let time_s = number as f64 * distance_s;
        let x = lanes.x(time_s);
        let stroke = Stroke::new(1.0, text.gamma_multiply(0.15));
        ui.painter().vline(x, lanes.rect.y_range(), stroke);
        let label = if distance_s < 1.0 { format!("{time_s:.1} s") } else { format!("{time_s:.0} s") };
        let at = pos2(x, lanes.rect.bottom() + 1.0);
        ui.painter().text(at, Align2::CENTER_TOP, label, FontId::proportional(11.0), text);
    }
}

/// Height of the centre of mass, coloured by the feet on the ground.
fn heights(ui: &Ui, lanes: &Lanes, curve: &Curve) {
    let row = lanes.heights();
    let [least, most] = curve.heights_m;
    if !(most - least).is_finite() || curve.runs.is_empty() {
        return;
    }
    let range_m = (most - least).max(0.02);
    let painter = ui.painter_at(row);
    for run in &curve.runs {
        let at = |(at, time_s): (&glam::DVec3, &f64)| {
            let share = ((at.y - least) / range_m) as f32;
            pos2(lanes.x(*time_s), row.bottom() - 4.0 - share * (row.height() - 8.0))
        };
        let points: Vec<Pos2> = run.points.iter().zip(&run.times_s).map(at).collect();
        if Rect::from_points(&points).expand(1.0).intersects(row) {
            painter.add(Shape::line(points, Stroke::new(2.0, run.color)));
        }
    }
    let text = format!("{least:.2} to {most:.2} m");
    let color = ui.visuals().weak_text_color();
    painter.text(
        row.right_bottom() + vec2(-4.0, -1.0),
        Align2::RIGHT_BOTTOM,
        text,
        FontId::proportional(10.5),
        color,
    );
}

/// All stances, drawn and grasped.
fn bars(
    ui: &Ui,
    view: &mut TimingView,
    lanes: &Lanes,
    editor: &mut Editor,
    gesture: &mut Option<Gesture>,
    stances: &[StanceTimes],
) {
    let is_seen = |times: &StanceTimes| {
        lanes.x(times.lift_off_s.max(times.next_s)) > lanes.rect.left() - 9.0
            && lanes.x(times.strike_s) < lanes.rect.right() + 9.0
    };
    let seen: Vec<usize> = (0..stances.len()).filter(|i| is_seen(&stances[*i])).collect();
    let are_grasped = seen.len() <= MOST_GRASPED;
    for print in seen {
        let Some(foot) = editor.prints().get(print).map(|print| print.foot) else { continue };
        let bar = Bar { lanes, print, row: lanes.row(foot), times: stances[print] };
        bar.draw(ui, editor, colors::foot(foot));
        if are_grasped {
            bar.grasp(ui, view, editor, gesture);
        }
    }
}

/// A stance in the diagram.
struct Bar<'a> {
    lanes: &'a Lanes,
    print: usize,
    row: Rect,
    times: StanceTimes,
}

impl Bar<'_> {
    fn rect(&self) -> Rect {
        let [from, to] = [self.times.strike_s, self.times.lift_off_s].map(|time_s| self.lanes.x(time_s));
        Rect::from_min_max(
            pos2(from, self.row.top() + 3.0),
            pos2(to.max(from + 1.0), self.row.bottom() - 3.0),
        )
    }

    /// Where the crossbar is grasped.
    fn crossbar(&self) -> Pos2 {
        pos2(self.lanes.x(self.times.next_s), self.row.center().y)
    }

    fn draw(&self, ui: &Ui, editor: &Editor, color: egui::Color32) {
        let painter = ui.painter_at(self.lanes.rect.expand(6.0));
        let (rect, is_selected) = (self.rect(), editor.selected.contains(&self.print));
        let opacity = if editor.are_laid() { 0.35 } else { 0.85 };
        painter.rect_filled(rect, 2.0, color.gamma_multiply(opacity));
        if is_selected {
            let stroke = Stroke::new(2.0, ui.visuals().strong_text_color());
            painter.rect_stroke(rect, 2.0, stroke, egui::StrokeKind::Outside);
        }
        if rect.width() > LEAST_BAR {
            let text = (self.print + 1).to_string();
            let font = FontId::proportional(11.5);
            painter.text(rect.center(), Align2::CENTER_CENTER, text, font, egui::Color32::BLACK);
        }
        let at = self.crossbar();
        let stroke = Stroke::new(1.6, crate::toast::trouble_color(ui.visuals().dark_mode));
        painter.vline(at.x, (at.y - 7.0)..=(at.y + 7.0), stroke);
        if at.x > rect.right() {
            let thin = Stroke::new(1.0, stroke.color.gamma_multiply(0.6));
            painter.hline(rect.right()..=at.x, at.y, thin);
        }
    }

    fn grasp(&self, ui: &Ui, view: &mut TimingView, editor: &mut Editor, gesture: &mut Option<Gesture>) {
        let (rect, number) = (self.rect(), self.print + 1);
        let grip = |rect: Rect, name: String, hover: String, cursor: CursorIcon| {
            let rect = rect.intersect(self.lanes.rect.expand2(vec2(GRASP, 0.0)));
            let id = ui.scope_id().with(("timing", &name));
            let response = ui.interact(rect, id, Sense::click_and_drag());
            response.widget_info(|| WidgetInfo::labeled(Role::Button, true, &name));
            response.on_hover_cursor(cursor).on_hover_text(hover)
        };
        let stands_s = self.times.lift_off_s - self.times.strike_s;
        let (name, hover) =
            (format!("Stance of print {number}"), format!("Print {number} stands {stands_s:.2} s"));
        let body = grip(rect, name, hover, CursorIcon::Grab);
        let shift = ui.input(|input| input.modifiers.shift);
        if body.clicked() || (body.drag_started() && !editor.selected.contains(&self.print)) {
            editor.select(self.print, shift);
        }
        let edge =
            |x: f32| Rect::from_center_size(pos2(x, rect.center().y), vec2(2.0 * GRASP, rect.height()));
        let mut grips = vec![(Grasp::Bar(self.print), body)];
        let cross = Rect::from_center_size(self.crossbar(), Vec2::new(2.0 * GRASP, ROW - 2.0));
        let hover = format!("Next footfall {:.2} s after this one", self.times.next_s - self.times.strike_s);
        let name = format!("Step time of print {number} in the diagram");
        grips.push((Grasp::Step(self.print), grip(cross, name, hover, CursorIcon::ResizeHorizontal)));
        if rect.width() >= LEAST_BAR {
            let name = format!("Lift-off of print {number}");
            let hover = format!("Print {number} leaves the ground at {:.2} s", self.times.lift_off_s);
            let lift_off = grip(edge(rect.right()), name, hover, CursorIcon::ResizeHorizontal);
            grips.push((Grasp::Stance(self.print), lift_off));
            let name = format!("Footfall of print {number}");
            let hover = format!("Print {number} falls at {:.2} s", self.times.strike_s);
            let footfall = grip(edge(rect.left()), name, hover, CursorIcon::ResizeHorizontal);
            grips.push((Grasp::Footfall(self.print), footfall));
        }
        for (grasp, response) in grips {
            self.follow(ui, view, editor, gesture, grasp, &response);
        }
    }

    fn follow(
        &self,
        ui: &Ui,
        view: &mut TimingView,
        editor: &mut Editor,
        gesture: &mut Option<Gesture>,
        grasp: Grasp,
        response: &Response,
    ) {
        if response.drag_started_by(PointerButton::Primary)
            && let Some(from) = ui.input(|input| input.pointer.press_origin())
        {
            editor.document.commit();
            view.held = Some(self.lanes.window);
            *gesture = Some(Gesture::in_time(editor, grasp, from));
        }
        let Some(under_way) = gesture.filter(|gesture| gesture.is_in_time(grasp)) else { return };
        if response.dragged_by(PointerButton::Primary)
            && let Some(to) = response.interact_pointer_pos()
        {
            under_way.follow_in_time(editor, to, self.lanes.points_per_s());
        }
        if response.drag_stopped() {
            (*gesture, view.held) = (None, None);
            editor.commit();
        }
    }
}

/// The present moment.
fn present(ui: &Ui, lanes: &Lanes, editor: &Editor) {
    let x = lanes.x(editor.playback.time_s());
    if !(lanes.rect.left() - 1.0..=lanes.rect.right() + 1.0).contains(&x) {
        return;
    }
    let color = ui.visuals().strong_text_color();
    ui.painter().vline(x, lanes.rect.y_range(), Stroke::new(1.5, color));
    let top = pos2(x, lanes.rect.top());
    let flag = vec![top + vec2(-5.0, -2.0), top + vec2(5.0, -2.0), top + vec2(0.0, 6.0)];
    ui.painter().add(Shape::convex_polygon(flag, color, Stroke::NONE));
}
