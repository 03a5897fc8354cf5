//! What the pointer does on the photograph: drags of ends and marks, new lines, new marks.

use egui::{
    Color32, CursorIcon, Key, PointerButton, Pos2, Rect, Response, Sense, Stroke, Ui, Vec2, WidgetInfo,
    accesskit::Role,
};
use muybridge_capture::Mark;

use super::numbers::{Number, Quantity};
use super::units::number;
use super::{Tool, marks, tools};
use crate::canvas::PanelCanvas;
use crate::colors;
use crate::session::Session;
use crate::toast::Messages;

/// Half the side of the square in which something is grasped, screen points.
const GRASP: f32 = 8.0;

/// What can be dragged.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Grip {
    /// An end of the ground line: 0 left, 1 right. With the distance from the pointer, px.
    Ground(usize, [f64; 2]),
    /// A mark, by its index. With the distance from the pointer, px.
    Mark(usize, [f64; 2]),
    /// A new line from here.
    Line([f64; 2]),
}

/// Handles of ground line and marks.
pub(super) fn handles(ui: &mut Ui, canvas: &PanelCanvas, session: &mut Session) {
    let Some(panel) = session.panel_annotation().cloned() else { return };
    for (end, at_px) in panel.ground_px.iter().flatten().enumerate() {
        let name = ["Ground left", "Ground right"][end];
        let response = handle(ui, canvas, *at_px, name, colors::GROUND, session.calibrate.grip.is_none());
        follow(ui, canvas, session, &response, *at_px, |grasp_px| Grip::Ground(end, grasp_px));
    }
    for (index, mark) in panel.marks.iter().enumerate() {
        let name = format!("Mark {}", number(mark.mark));
        let response = handle(ui, canvas, mark.at_px, &name, colors::MARK, session.calibrate.grip.is_none());
        follow(ui, canvas, session, &response, mark.at_px, |grasp_px| Grip::Mark(index, grasp_px));
        if response.clicked_by(PointerButton::Secondary) {
            tools::delete(session, index);
            return;
        }
    }
}

fn handle(
    ui: &Ui,
    canvas: &PanelCanvas,
    at_px: [f64; 2],
    name: &str,
    color: Color32,
    hint: bool,
) -> Response {
    let at = canvas.view.screen_from_plate(at_px);
    let rect = Rect::from_center_size(at, Vec2::splat(2.0 * GRASP)).intersect(canvas.painter.clip_rect());
    let response = ui.interact(rect, ui.scope_id().with(("calibrate", name)), Sense::click_and_drag());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    let lit = response.hovered() || response.dragged();
    let fill = if lit { Color32::WHITE } else { color };
    canvas.painter.circle(at, if lit { 6.0 } else { 5.0 }, fill, Stroke::new(1.8, Color32::BLACK));
    let deletes = if name.starts_with("Mark") { "; right click deletes it" } else { "" };
    let response = response.on_hover_cursor(CursorIcon::Grab);
    if hint { response.on_hover_text(format!("{name}: drag it{deletes}")) } else { response }
}

/// The pointer on the plate, px, wherever it is.
fn pointer_px(ui: &Ui, canvas: &PanelCanvas) -> Option<[f64; 2]> {
    let at = ui.input(|input| input.pointer.latest_pos()).map(|at| canvas.view.plate_from_screen(at));
    at.filter(|at| at.iter().all(|v| v.is_finite()))
}

/// Where the button went down, on the plate, px.
fn pressed_px(ui: &Ui, canvas: &PanelCanvas) -> Option<[f64; 2]> {
    ui.input(|input| input.pointer.press_origin()).map(|at| canvas.view.plate_from_screen(at))
}

/// Follows the drag of a handle while it lasts; makes the change when it ends.
fn follow(
    ui: &Ui,
    canvas: &PanelCanvas,
    session: &mut Session,
    response: &Response,
    at_px: [f64; 2],
    grip: impl Fn([f64; 2]) -> Grip,
) {
    if response.drag_started_by(PointerButton::Primary)
        && let Some([x, y]) = pressed_px(ui, canvas)
    {
        session.commit();
        session.calibrate.let_go();
        session.calibrate.grip = Some(grip([at_px[0] - x, at_px[1] - y]));
    }
    if response.dragged_by(PointerButton::Primary)
        && let Some([x, y]) = pointer_px(ui, canvas)
        && let Some(grip) = session.calibrate.grip
    {
        move_to(session, grip, [x, y]);
    }
    if response.drag_stopped() && session.calibrate.grip.take().is_some() {
        session.commit();
    }
}

fn move_to(session: &mut Session, grip: Grip, [x, y]: [f64; 2]) {
    let panel = session.panel;
    match grip {
        Grip::Ground(end, [dx, dy]) => session.preview("Move the ground line", |draft| {
            let Some(mut ends) = draft.panel(panel).and_then(|panel| panel.ground_px) else { return };
            ends[end] = [x + dx, y + dy];
            // An end that is drawn past the other stays where it was.
            if ends[0][0] < ends[1][0] {
                marks::set_ground(draft, panel, ends);
            }
        }),
        Grip::Mark(index, [dx, dy]) => {
            let moved = session.document.draft().panel(panel).and_then(|panel| panel.marks.get(index));
            let Some(mark) = moved.map(|mark| mark.mark) else { return };
            session.preview(&format!("Move mark {}", number(mark)), |draft| {
                if let Some(mark) = draft.panel_mut(panel).marks.get_mut(index) {
                    mark.at_px = [x + dx, y + dy];
                }
            });
        }
        Grip::Line(_) => {}
    }
}

/// New lines and marks, by the tool.
pub(super) fn draw_new(ui: &Ui, canvas: &PanelCanvas, session: &mut Session, messages: &mut Messages) {
    if ui.input(|input| input.modifiers.alt) {
        return;
    }
    let bare = session.panel_annotation().is_none_or(|panel| panel.ground_px.is_none());
    match session.calibrate.tool {
        Tool::Ground if bare || matches!(session.calibrate.grip, Some(Grip::Line(_))) => {
            draw_line(ui, canvas, session, messages);
        }
        Tool::Length => draw_line(ui, canvas, session, messages),
        Tool::Marks => place_mark(canvas, session),
        Tool::Ground => {}
    }
}

/// A line between two clicks, or along a drag.
fn draw_line(ui: &Ui, canvas: &PanelCanvas, session: &mut Session, messages: &mut Messages) {
    let response = &canvas.response;
    if response.drag_started_by(PointerButton::Primary)
        && let Some(from) = pressed_px(ui, canvas)
    {
        session.commit();
        session.calibrate.let_go();
        session.calibrate.grip = Some(Grip::Line(from));
    }
    if ui.input(|input| input.key_pressed(Key::Escape)) {
        session.calibrate.let_go();
    }
    let Some(to) = pointer_px(ui, canvas) else { return };
    if response.clicked_by(PointerButton::Primary) {
        match session.calibrate.take_first_end(session.panel) {
            None => session.calibrate.first_end_px = Some((session.panel, to)),
            Some(from) => {
                preview_line(session, [from, to]);
                finish_line(session, messages);
            }
        }
    } else if let (Some(Grip::Line(from)), true) =
        (session.calibrate.grip, response.dragged_by(PointerButton::Primary))
    {
        preview_line(session, [from, to]);
    }
    if response.drag_stopped() && matches!(session.calibrate.grip.take(), Some(Grip::Line(_))) {
        finish_line(session, messages);
    }
    if let Some((panel, from)) = session.calibrate.first_end_px
        && panel == session.panel
    {
        draw_band(canvas, [from, to]);
    }
}

fn preview_line(session: &mut Session, ends: [[f64; 2]; 2]) {
    let (panel, grip) = (session.panel, session.calibrate.grip);
    let is_length = session.calibrate.tool == Tool::Length;
    let mut drawn = session.document.draft().clone();
    let draw = if is_length { marks::set_length } else { marks::set_ground };
    if draw(&mut drawn, panel, ends) {
        let label = if is_length { "Draw a known length" } else { "Draw the ground line" };
        session.preview(label, |draft| *draft = drawn);
    } else {
        session.cancel();
        session.calibrate.grip = grip;
    }
}

/// Takes a line that was long enough; the length of a known one is typed next.
fn finish_line(session: &mut Session, messages: &mut Messages) {
    if !session.is_dragging() {
        messages.note("The line is too short: nothing was drawn");
        return;
    }
    session.commit();
    if session.calibrate.tool == Tool::Length {
        session.calibrate.tool = Tool::Ground;
        session.calibrate.wants_focus = Some(Number::Value(Quantity::MarkSpacing));
    }
}

/// The line from the first click to the pointer.
fn draw_band(canvas: &PanelCanvas, ends: [[f64; 2]; 2]) {
    let ends: [Pos2; 2] = ends.map(|at| canvas.view.screen_from_plate(at));
    canvas.painter.line_segment(ends, Stroke::new(4.0, Color32::from_black_alpha(150)));
    canvas.painter.line_segment(ends, Stroke::new(1.5, Color32::WHITE));
    canvas.painter.circle_filled(ends[0], 4.0, Color32::WHITE);
}

fn place_mark(canvas: &PanelCanvas, session: &mut Session) {
    let clicked = canvas.response.clicked_by(PointerButton::Primary);
    let Some(at) = canvas.response.interact_pointer_pos().filter(|_| clicked) else { return };
    let (panel, at_px) = (session.panel, canvas.view.plate_from_screen(at));
    let next = marks::next_number(session.panel_annotation(), session.calibrate.first_mark);
    session.commit();
    session.edit(&format!("Place mark {}", number(next)), |draft| {
        draft.panel_mut(panel).marks.push(Mark { mark: next, at_px });
    });
}
