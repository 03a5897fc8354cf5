//! What can be grasped in the plan: prints, their headings, their timing daggers, points and tangents of the path.

use egui::accesskit::Role;
use egui::{Color32, CursorIcon, Pos2, Rect, Response, Sense, Stroke, Ui, Vec2, WidgetInfo, vec2};

use super::drawing::{self, FootShape, Look};
use super::gesture::{Gesture, Grasp, TANGENT_SHARE, dagger_way, tangent};
use super::plan_view::{Canvas, tame};
use crate::colors;
use crate::footprints::Editor;
use crate::footprints::edits::direction;
use crate::toast::trouble_color;

/// Half the side of the square in which a handle is grasped, points.
const GRASP: f32 = 7.0;
/// A print is grasped within this of its middle even when it is drawn smaller, points.
const LEAST_PRINT: f32 = 8.0;
/// The heading's handle is so far ahead of the toe, points.
const AHEAD: f32 = 16.0;
/// A dagger begins so far beside the foot, points.
const BESIDE: f32 = 5.0;
/// Half the length of a crossbar, points.
const CROSSBAR: f32 = 7.0;
/// A second of a dagger, points: at the scale of the plan as a metre, but never too short to grasp or too long to see.
const SECOND: [f64; 2] = [36.0, 150.0];
/// More prints than this on the screen have handles only when they are selected.
const MOST_HANDLED: usize = 60;
/// More prints than this on the screen cannot be grasped one by one: one has to look closer.
const MOST_GRASPED: usize = 400;
/// Handles of prints that are not selected are shown from this size of a foot on, points.
const HANDLED_FOOT: f64 = 7.0;

/// Everything the prints are drawn and grasped by.
pub(super) struct PlanPrints<'a> {
    pub(super) canvas: &'a Canvas,
    pub(super) shape: &'a FootShape,
    /// Prints with a remark, from 0.
    pub(super) remarked: &'a [usize],
    /// Prints that cannot be walked, with what to do.
    pub(super) faulty: &'a [(usize, String)],
    /// Prints on the ground at this moment.
    pub(super) down: Vec<usize>,
}

/// Length of a second of the daggers, points.
pub(super) fn points_per_s(canvas: &Canvas) -> f64 {
    (0.8 * canvas.view.points_per_m).clamp(SECOND[0], SECOND[1])
}

/// A handle that can be dragged.
fn grip(ui: &Ui, canvas: &Canvas, at: Pos2, half: f32, name: &str, hover: &str) -> Response {
    let rect = Rect::from_center_size(at, Vec2::splat(2.0 * half)).intersect(canvas.rect);
    let response = ui.interact(rect, ui.scope_id().with(("footprints", name)), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    let response = response.on_hover_cursor(CursorIcon::Grab);
    if hover.is_empty() { response } else { response.on_hover_text(hover) }
}

/// Follows a drag of a handle in the plan.
fn follow(
    ui: &Ui,
    canvas: &Canvas,
    editor: &mut Editor,
    gesture: &mut Option<Gesture>,
    grasp: Grasp,
    response: &Response,
) {
    let primary = egui::PointerButton::Primary;
    if response.drag_started_by(primary)
        && let Some(from) = ui.input(|input| input.pointer.press_origin())
    {
        editor.document.commit();
        *gesture = Some(Gesture::new(editor, grasp, from));
    }
    let Some(under_way) = gesture.filter(|gesture| gesture.is_in_plan(grasp)) else { return };
    if response.dragged_by(primary)
        && let Some(to) = response.interact_pointer_pos()
    {
        let snaps = ui.input(|input| input.modifiers.shift);
        under_way.follow_in_plan(editor, canvas, to, points_per_s(canvas), snaps);
    }
    if response.drag_stopped() {
        *gesture = None;
        editor.commit();
    }
}

/// All prints: drawn, and grasped.
pub(super) fn prints(ui: &Ui, plan: &PlanPrints<'_>, editor: &mut Editor, gesture: &mut Option<Gesture>) {
    let canvas = plan.canvas;
    let margin = (plan.shape.toe_m * canvas.view.points_per_m) as f32 + 60.0;
    let visible: Vec<usize> = (0..editor.prints().len())
        .filter(|i| canvas.sees(canvas.screen(editor.prints()[*i].at_m), margin))
        .collect();
    let are_large = plan.shape.toe_m * canvas.view.points_per_m >= HANDLED_FOOT;
    // Those along a path are grasped one by one: its own handles are among them.
    let all_handled = visible.len() <= MOST_HANDLED && are_large && !editor.are_laid();
    for (place, &print) in visible.iter().enumerate() {
        let is_selected = editor.selected.contains(&print);
        let hovered = (is_selected || place < MOST_GRASPED) && body(ui, plan, editor, gesture, print);
        draw(ui, plan, editor, print, hovered);
    }
    for print in visible {
        if all_handled || editor.selected.contains(&print) && editor.selected.len() <= MOST_HANDLED {
            dagger(ui, plan, editor, gesture, print);
            heading(ui, plan, editor, gesture, print);
        }
    }
}

fn draw(ui: &Ui, plan: &PlanPrints<'_>, editor: &Editor, print: usize, is_hovered: bool) {
    let Some(shown) = editor.prints().get(print) else { return };
    let look = Look {
        is_selected: editor.selected.contains(&print),
        is_hovered,
        is_down: plan.down.contains(&print),
        is_laid: editor.are_laid(),
        is_remarked: plan.remarked.binary_search(&print).is_ok(),
        is_faulty: plan.faulty.iter().any(|(faulty, _)| *faulty == print),
    };
    drawing::print(ui, plan.canvas, plan.shape, print, shown, look);
}

/// The print itself: a click selects it, a drag moves what is selected. Whether the pointer is on it.
fn body(
    ui: &Ui,
    plan: &PlanPrints<'_>,
    editor: &mut Editor,
    gesture: &mut Option<Gesture>,
    print: usize,
) -> bool {
    let shown = editor.prints()[print];
    let at = plan.canvas.screen(shown.at_m);
    let half = ((plan.shape.toe_m * plan.canvas.view.points_per_m * 0.8) as f32).max(LEAST_PRINT);
    let name = format!("Print {} {}", print + 1, shown.foot.abbreviation());
    let response = grip(ui, plan.canvas, at, half, &name, "");
    let shift = ui.input(|input| input.modifiers.shift);
    if response.clicked() {
        editor.select(print, shift);
    }
    if response.drag_started_by(egui::PointerButton::Primary) && !editor.selected.contains(&print) {
        editor.select(print, shift);
    }
    follow(ui, plan.canvas, editor, gesture, Grasp::Prints, &response);
    response.hovered()
}

/// The handle ahead of the toe.
fn heading(ui: &Ui, plan: &PlanPrints<'_>, editor: &mut Editor, gesture: &mut Option<Gesture>, print: usize) {
    let (canvas, shown) = (plan.canvas, editor.prints()[print]);
    let ahead = canvas.along(direction(shown.heading_deg));
    let toe = canvas.screen(shown.at_m) + ahead * (plan.shape.toe_m * canvas.view.points_per_m) as f32;
    let at = toe + ahead * AHEAD;
    let hover = format!("Heading {:.0}°: drag to turn; with Shift by steps of 15°", shown.heading_deg);
    let response = grip(ui, canvas, at, GRASP, &format!("Heading of print {}", print + 1), &hover);
    canvas.painter.line_segment([toe, at], Stroke::new(1.0, colors::FIT));
    handle(ui, canvas, at, colors::FIT, &response);
    follow(ui, canvas, editor, gesture, Grasp::Heading(print), &response);
}

/// The timing dagger: the end of its bar says how long the foot stands, its crossbar when the next one falls.
fn dagger(ui: &Ui, plan: &PlanPrints<'_>, editor: &mut Editor, gesture: &mut Option<Gesture>, print: usize) {
    let (canvas, shown) = (plan.canvas, editor.prints()[print]);
    let Some(timing) = editor.timing(print) else { return };
    let away = dagger_way(editor, canvas, print);
    let ahead = canvas.along(direction(shown.heading_deg));
    let beside = (plan.shape.half_width_m * canvas.view.points_per_m) as f32 + BESIDE;
    let from = canvas.screen(shown.at_m) + away * beside;
    let second = points_per_s(canvas);
    let at = |time_s: f64| tame(from + away * (time_s * second) as f32);
    let (end, cross) = (at(timing.stance_time_s), at(timing.step_time_s));
    let color = trouble_color(ui.visuals().dark_mode);
    // Times that follow from the distances are thinner.
    let width = if shown.timing.is_some() { 2.2 } else { 1.2 };
    canvas.painter.line_segment([from, end], Stroke::new(width, color));
    let ends = [cross - ahead * CROSSBAR, cross + ahead * CROSSBAR];
    canvas.painter.line_segment(ends, Stroke::new(width + 0.6, color));
    let number = print + 1;
    let source = if shown.timing.is_some() { "" } else { " (from the distance)" };
    let hover = format!("Stands {:.2} s{source}: drag", timing.stance_time_s);
    let response = grip(ui, canvas, end, GRASP, &format!("Stance time of print {number}"), &hover);
    handle(ui, canvas, end, color, &response);
    follow(ui, canvas, editor, gesture, Grasp::Stance(print), &response);
    // The crossbar is grasped at its front end: bar and crossbar may lie on one another.
    let hover = format!("Next footfall after {:.2} s{source}: drag", timing.step_time_s);
    let response = grip(ui, canvas, ends[1], GRASP, &format!("Step time of print {number}"), &hover);
    square(ui, canvas, ends[1], color, &response);
    follow(ui, canvas, editor, gesture, Grasp::Step(print), &response);
}

fn rim(ui: &Ui, response: &Response) -> Stroke {
    let is_held = response.hovered() || response.dragged();
    Stroke::new(if is_held { 2.0 } else { 1.0 }, ui.visuals().strong_text_color())
}

fn handle(ui: &Ui, canvas: &Canvas, at: Pos2, color: Color32, response: &Response) {
    canvas.painter.circle(at, 4.0, color, rim(ui, response));
}

fn square(ui: &Ui, canvas: &Canvas, at: Pos2, color: Color32, response: &Response) {
    let rect = Rect::from_center_size(at, vec2(6.5, 6.5));
    canvas.painter.rect(rect, 0.0, color, rim(ui, response), egui::StrokeKind::Outside);
}

/// Points and tangents of the path.
pub(super) fn path(ui: &Ui, canvas: &Canvas, editor: &mut Editor, gesture: &mut Option<Gesture>) {
    let Some(points) = editor.track().path.as_ref().map(|path| path.points.clone()) else { return };
    let color = colors::GROUND;
    for (i, point) in points.iter().enumerate() {
        let at = canvas.screen(point.at_m);
        if !canvas.sees(at, 200.0) {
            continue;
        }
        let number = i + 1;
        if let Some(tangent_m) = tangent(&points, i).filter(|_| points.len() > 1) {
            let strength = if point.tangent_m.is_some() { 1.0 } else { 0.55 };
            for (end, name) in [(1.0, "Tangent"), (-1.0, "Rear tangent")] {
                let end_m = [0, 1].map(|k| point.at_m[k] + end * TANGENT_SHARE * tangent_m[k]);
                let to = tame(canvas.screen(end_m));
                canvas.painter.line_segment([at, to], Stroke::new(1.0, color.gamma_multiply(strength)));
                let hover = "Direction and pull of the path: drag";
                let response = grip(ui, canvas, to, GRASP, &format!("{name} of path point {number}"), hover);
                handle(ui, canvas, to, color.gamma_multiply(strength), &response);
                follow(ui, canvas, editor, gesture, Grasp::Tangent(i, end), &response);
            }
        }
        let hover = "A point of the path: drag; Delete takes it away";
        let response = grip(ui, canvas, at, GRASP, &format!("Path point {number}"), hover);
        if response.clicked() || response.drag_started() {
            editor.deselect();
            editor.path_point = Some(i);
        }
        follow(ui, canvas, editor, gesture, Grasp::PathPoint(i), &response);
        square(ui, canvas, at, color, &response);
        if editor.path_point == Some(i) {
            let stroke = Stroke::new(2.0, ui.visuals().strong_text_color());
            canvas.painter.circle_stroke(at, 9.0, stroke);
        }
    }
}
