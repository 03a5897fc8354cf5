//! The plan: the ground from above, with everything on it that can be grasped.

use egui::accesskit::Role;
use egui::{
    Align2, FontId, Key, PointerButton, Pos2, Rect, Response, Sense, Stroke, StrokeKind, Ui, WidgetInfo, vec2,
};
use muybridge_footprints::{Laying, PathPoint};

use super::backdrop;
use super::curve::Curve;
use super::drawing::{self, FootShape};
use super::gesture::Gesture;
use super::grips::{self, PlanPrints};
use super::plan_view::{Canvas, PlanView};
use crate::footprints::Editor;
use crate::footprints::edits::moved_place;
use crate::toast::trouble_color;

/// Scrolled so far, the plan is e times as large, points.
const SCROLL_PER_ZOOM: f32 = 300.0;
/// Faults that are written beside their prints; the inspector has all.
const MOST_NOTES: usize = 4;

/// What a click on the ground does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Tool {
    /// Selects; a double click adds a print.
    #[default]
    Prints,
    /// Adds a point to the path.
    Path,
}

/// The plan, as it is looked at.
#[derive(Default)]
pub(super) struct Plan {
    view: Option<PlanView>,
    pub(super) tool: Tool,
    /// Where a rubber band began.
    band: Option<Pos2>,
    is_panning: bool,
    rect: Option<Rect>,
}

impl Plan {
    /// Shows the whole track again.
    pub(super) fn show_all(&mut self) {
        self.view = None;
    }

    /// Zooms about the middle.
    pub(super) fn zoom_by(&mut self, factor: f64) {
        if let (Some(view), Some(rect)) = (self.view, self.rect) {
            self.view = Some(view.zoomed(rect, factor, rect.center()));
        }
    }

    /// The canvas of a square that is shown as a whole until somebody looks elsewhere.
    pub(super) fn wander_canvas(
        &mut self,
        ui: &Ui,
        rect: Rect,
        corners_m: [[f64; 2]; 2],
        response: &Response,
    ) -> Canvas {
        self.rect = Some(rect);
        let view = self.view.unwrap_or_else(|| PlanView::fit(corners_m.into_iter(), rect));
        let mut canvas = Canvas { view, rect, painter: ui.painter_at(rect) };
        self.look(ui, &mut canvas, response);
        if response.dragged_by(PointerButton::Primary) {
            canvas.view = canvas.view.panned(response.drag_delta());
            self.view = Some(canvas.view);
        }
        canvas
    }

    fn canvas(&mut self, rect: Rect, editor: &Editor, ui: &Ui) -> Canvas {
        self.rect = Some(rect);
        let painter = ui.painter_at(rect);
        if let Some(view) = self.view {
            return Canvas { view, rect, painter };
        }
        let points = editor.track().path.iter().flat_map(|path| &path.points).map(|point| point.at_m);
        let view = PlanView::fit(editor.prints().iter().map(|print| print.at_m).chain(points), rect);
        // The prints of a path may not be known yet.
        if !editor.solving.is_busy() {
            self.view = Some(view);
        }
        Canvas { view, rect, painter }
    }

    /// Zoom and pan.
    fn look(&mut self, ui: &Ui, canvas: &mut Canvas, response: &Response) {
        let space = ui.input(|input| input.key_down(Key::Space)) && !ui.ctx().egui_wants_keyboard_input();
        if response.drag_started() {
            self.is_panning = space || !response.drag_started_by(PointerButton::Primary);
        }
        if response.dragged() && self.is_panning {
            canvas.view = canvas.view.panned(response.drag_delta());
            self.view = Some(canvas.view);
        }
        let pointer = ui.input(|input| input.pointer.latest_pos());
        if let Some(pointer) = pointer.filter(|at| canvas.rect.contains(*at) && response.contains_pointer()) {
            let (scrolled, pinched) =
                ui.input_mut(|input| (std::mem::take(&mut input.smooth_scroll_delta).y, input.zoom_delta()));
            let factor = f64::from((scrolled / SCROLL_PER_ZOOM).exp() * pinched);
            if (factor - 1.0).abs() > 1e-6 {
                canvas.view = canvas.view.zoomed(canvas.rect, factor, pointer);
                self.view = Some(canvas.view);
            }
        }
    }

    /// Clicks and drags on the bare ground.
    fn on_ground(&mut self, ui: &Ui, canvas: &Canvas, editor: &mut Editor, response: &Response) {
        let shift = ui.input(|input| input.modifiers.shift);
        let at_m = response.interact_pointer_pos().map(|at| canvas.plan(at));
        match (self.tool, at_m) {
            (Tool::Path, Some(at_m)) if response.clicked() => add_path_point(editor, at_m),
            (Tool::Prints, Some(at_m)) if response.double_clicked() => editor.add_print(Some(at_m)),
            (Tool::Prints, _) if response.clicked() && !shift => editor.deselect(),
            _ => {}
        }
        if response.drag_started_by(PointerButton::Primary) && !self.is_panning {
            self.band = ui.input(|input| input.pointer.press_origin());
        }
        let Some(from) = self.band else { return };
        if let Some(to) = response.interact_pointer_pos().filter(|_| response.dragged()) {
            let band = Rect::from_two_pos(from, to);
            let stroke = Stroke::new(1.0, ui.visuals().selection.stroke.color);
            let fill = ui.visuals().selection.bg_fill.gamma_multiply(0.25);
            canvas.painter.rect(band, 0.0, fill, stroke, StrokeKind::Inside);
            if !shift {
                editor.deselect();
            }
            let within = |i: &usize| band.contains(canvas.screen(editor.prints()[*i].at_m));
            let inside: Vec<usize> = (0..editor.prints().len()).filter(within).collect();
            editor.selected.extend(inside);
        } else if response.drag_stopped() {
            self.band = None;
        }
    }
}

/// Adds a point to the path; the first one begins it.
fn add_path_point(editor: &mut Editor, at_m: [f64; 2]) {
    let point = PathPoint { at_m: moved_place(at_m, [0.0; 2]), tangent_m: None };
    editor.document.edit("Add a point of the path", |track| {
        let none = || Laying { points: Vec::new(), step_length_m: None, step_width_m: None, timing: None };
        track.path.get_or_insert_with(none).points.push(point);
    });
    editor.deselect();
    editor.path_point = editor.track().path.as_ref().and_then(|path| path.points.len().checked_sub(1));
}

/// The print that a fault names, from 0.
pub(super) fn print_of(fault: &str) -> Option<usize> {
    let after = fault.split("print ").nth(1)?;
    let digits: String = after.chars().take_while(char::is_ascii_digit).collect();
    digits.parse::<usize>().ok()?.checked_sub(1)
}

/// The plan over all the space there is.
pub(super) fn show(
    ui: &mut Ui,
    plan: &mut Plan,
    editor: &mut Editor,
    gesture: &mut Option<Gesture>,
    curve: &Curve,
    shape: &FootShape,
) {
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
    let name = "Plan: double-click adds a print, drag selects, scroll zooms, middle drag or Space moves";
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, name));
    if rect.width() < 10.0 || rect.height() < 10.0 {
        return;
    }
    let mut canvas = plan.canvas(rect, editor, ui);
    plan.look(ui, &mut canvas, &response);
    backdrop::show(ui, &canvas, &editor.track().terrain);
    drawing::path(ui, &canvas, editor.track());
    plan.on_ground(ui, &canvas, editor, &response);
    let faulty: Vec<(usize, String)> =
        editor.solving.faults().iter().filter_map(|fault| Some((print_of(fault)?, fault.clone()))).collect();
    let mut remarked: Vec<usize> = curve.remarks.iter().map(|remark| remark.print).collect();
    remarked.sort_unstable();
    let now_s = editor.playback.time_s();
    let stands = |i: &usize| {
        let placed = editor.motion().and_then(|motion| motion.placed.prints.get(*i));
        placed.is_some_and(|print| (print.strike_s..print.lift_off_s).contains(&now_s))
    };
    let down: Vec<usize> = (0..editor.prints().len()).filter(stands).collect();
    let prints = PlanPrints { canvas: &canvas, shape, remarked: &remarked, faulty: &faulty, down };
    grips::prints(ui, &prints, editor, gesture);
    drawing::curve(ui, &canvas, curve);
    grips::path(ui, &canvas, editor, gesture);
    present(ui, &canvas, editor, curve);
    notes(ui, &canvas, editor, &faulty, curve, &response);
    pointer(ui, &canvas, editor, &response);
}

fn present(ui: &Ui, canvas: &Canvas, editor: &Editor, curve: &Curve) {
    let (Some(motion), time_s) = (editor.motion(), editor.playback.time_s()) else { return };
    let now = motion.centre_of_mass(time_s);
    let heading = vec2(now.velocity.x as f32, now.velocity.z as f32);
    drawing::present(ui, canvas, [now.at.x, now.at.z], heading, curve.down(time_s));
}

/// Faults beside their prints; a remark beside the print under the pointer.
fn notes(
    ui: &Ui,
    canvas: &Canvas,
    editor: &Editor,
    faulty: &[(usize, String)],
    curve: &Curve,
    response: &Response,
) {
    let color = trouble_color(ui.visuals().dark_mode);
    for (print, fault) in faulty.iter().take(MOST_NOTES) {
        if let Some(print) = editor.prints().get(*print) {
            drawing::note(ui, canvas, canvas.screen(print.at_m), fault, color);
        }
    }
    let Some(pointer) = ui.input(|input| input.pointer.hover_pos()) else { return };
    let is_near = |print: usize| {
        let at = editor.prints().get(print).map(|print| canvas.screen(print.at_m));
        at.is_some_and(|at| at.distance(pointer) < 12.0)
    };
    if let Some(remark) = curve.remarks.iter().find(|remark| is_near(remark.print)) {
        drawing::note(ui, canvas, pointer, &remark.text, color);
    }
    if editor.prints().is_empty() && editor.track().path.is_none() && !response.dragged() {
        let text = "Double-click the ground to add prints, or draw a path (D) along which they are laid";
        let font = FontId::proportional(15.0);
        let color = ui.visuals().text_color();
        canvas.painter.text(canvas.rect.center(), Align2::CENTER_CENTER, text, font, color);
    }
}

/// Where the pointer is.
fn pointer(ui: &Ui, canvas: &Canvas, editor: &Editor, response: &Response) {
    let Some(at) = response.hover_pos().filter(|at| canvas.rect.contains(*at)) else { return };
    let [x, z] = canvas.plan(at);
    let height_m = editor.track().terrain.at(x, z).0;
    let text = format!("x {x:.2} m   z {z:.2} m   height {height_m:.2} m");
    let corner = canvas.rect.left_bottom() + vec2(10.0, -8.0);
    let color = ui.visuals().weak_text_color();
    canvas.painter.text(corner, Align2::LEFT_BOTTOM, text, FontId::proportional(12.0), color);
}
