//! A bird that wanders among trees, seen from above; and where tracks come from and go to.

use egui::accesskit::Role;
use egui::{Color32, Rect, RichText, Sense, Shape, Stroke, Ui, WidgetInfo, vec2};
use muybridge_footprints::{Foot, FootState, Terrain};

use super::drawing::{self, FootShape, Look};
use super::plan::Plan;
use super::plan_view::{Canvas, tame};
use super::{backdrop, command_button};
use crate::app::PageContext;
use crate::colors;
use crate::command::Command;
use crate::footprints::Editor;
use crate::footprints::examples::Example;
use crate::footprints::wandering::Wandering;
use crate::toast::trouble_color;

/// Time between two points of the way that is drawn, s.
const WAY_STEP_S: f64 = 1.0 / 30.0;
/// Points of the way at most.
const MOST_POINTS: f64 = 4000.0;
const TRUNK: Color32 = Color32::from_rgb(128, 98, 70);
const CROWN: Color32 = Color32::from_rgb(70, 130, 70);

/// New, open, save.
pub(super) fn files(ui: &mut Ui, editor: &Editor, page: &mut PageContext<'_>) {
    let mark = if editor.document.is_changed() { "not saved" } else { "saved" };
    ui.horizontal(|ui| {
        ui.label(RichText::new(editor.document.name()).strong());
        let has_file = editor.document.path().is_some() || editor.document.is_changed();
        ui.weak(if has_file { mark } else { "example" });
    });
    if let Some(fault) = editor.document.safe_copy_fault() {
        let text = RichText::new("changes are not protected against a crash");
        ui.label(text.color(trouble_color(ui.visuals().dark_mode))).on_hover_text(fault);
    }
    ui.horizontal_wrapped(|ui| {
        ui.menu_button("New…", |ui| {
            for (example, name) in Example::ALL {
                if ui.button(name).clicked() {
                    page.commands.push(new_command(example));
                    ui.close();
                }
            }
        });
        for (command, title) in
            [(Command::Open, "Open…"), (Command::Save, "Save"), (Command::SaveAs, "Save as…")]
        {
            command_button(ui, page, command, title, false);
        }
    });
    ui.horizontal_wrapped(|ui| {
        command_button(ui, page, Command::FootprintsUndo, "Undo", false);
        command_button(ui, page, Command::FootprintsRedo, "Redo", false);
        command_button(ui, page, Command::FootprintsAdd, "Add a print", false);
        command_button(ui, page, Command::FootprintsWander, "Let a bird wander", false);
    });
}

/// The command that begins with an example.
fn new_command(example: Example) -> Command {
    match example {
        Example::WalkingBird => Command::FootprintsNewBird,
        Example::Stairs => Command::FootprintsNewStairs,
        Example::Leaps => Command::FootprintsNewLeaps,
        Example::Runner => Command::FootprintsNewRunner,
        Example::AutomaticTiming => Command::FootprintsNewTimed,
        Example::Path => Command::FootprintsNewPath,
        Example::Trot => Command::FootprintsNewTrot,
        Example::River => Command::FootprintsNewRiver,
        Example::Empty => Command::FootprintsNewEmpty,
    }
}

/// What the wanderer does; whether the walk is to be kept.
pub(super) fn inspector(ui: &mut Ui, walk: &Wandering, page: &mut PageContext<'_>) -> bool {
    ui.heading("A bird among trees");
    ui.label("Each print comes while it walks, and only the step before the newest is planned.");
    ui.add_space(8.0);
    ui.label(format!("{:.1} s, {} prints", walk.time_s(), walk.prints().len()));
    ui.add_space(8.0);
    let title = if walk.is_paused() { "Go on" } else { "Stop" };
    let mut keeps = false;
    ui.horizontal_wrapped(|ui| {
        command_button(ui, page, Command::FootprintsPlay, title, walk.is_paused());
        keeps = ui.button("Keep as a track").on_hover_text("The prints so far, to be edited").clicked();
        command_button(ui, page, Command::FootprintsWander, "End the walk", false);
    });
    if let Some(fault) = walk.fault() {
        ui.label(RichText::new(fault).color(trouble_color(ui.visuals().dark_mode)));
    }
    keeps
}

/// The meadow from above.
pub(super) fn show(ui: &mut Ui, plan: &mut Plan, walk: &Wandering, shape: &FootShape) {
    let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
    let name = "Meadow: scroll to zoom, drag to move";
    response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, name));
    if rect.width() < 10.0 || rect.height() < 10.0 {
        return;
    }
    let half_m = walk.side_m() / 2.0;
    let corners = [[-half_m, -half_m], [half_m, half_m]];
    let canvas = plan.wander_canvas(ui, rect, corners, &response);
    backdrop::show(ui, &canvas, &Terrain::Flat);
    let border = Rect::from_two_pos(tame(canvas.screen(corners[0])), tame(canvas.screen(corners[1])));
    let stroke = Stroke::new(2.0, ui.visuals().text_color());
    canvas.painter.rect_stroke(border, 0.0, stroke, egui::StrokeKind::Inside);
    for tree in walk.trees() {
        let radius = ((tree.radius_m * canvas.view.points_per_m) as f32).max(3.0);
        let at = tame(canvas.screen(tree.at_m));
        canvas.painter.circle_filled(at, 1.7 * radius, CROWN.gamma_multiply(0.35));
        canvas.painter.circle(at, radius, TRUNK, Stroke::new(1.0, CROWN));
    }
    let now_s = walk.time_s();
    let placed = &walk.planner().placed().prints;
    for (i, print) in walk.prints().iter().enumerate() {
        let at = canvas.screen(print.at_m);
        if canvas.sees(at, 60.0) {
            let down = placed.get(i).map(|placed| (placed.strike_s..placed.lift_off_s).contains(&now_s));
            let is_laid = placed.get(i).is_none_or(|placed| placed.strike_s > now_s);
            let look = Look { is_down: down.unwrap_or(false), is_laid, ..Look::default() };
            drawing::print(ui, &canvas, shape, i, print, look);
        }
    }
    way(&canvas, walk);
    if let Some(pose) = walk.pose() {
        let ahead = pose.world_from_body * glam::DVec3::X;
        let (at, heading) = (pose.centre_of_mass, vec2(ahead.x as f32, ahead.z as f32));
        let is_down = |foot: &Foot| !matches!(pose.legs[foot.index()].state, FootState::Swing { .. });
        let down: Vec<Foot> = Foot::BIPED.into_iter().filter(is_down).collect();
        drawing::present(ui, &canvas, [at.x, at.z], heading, &down);
    }
}

/// The way so far.
fn way(canvas: &Canvas, walk: &Wandering) {
    let step_s = WAY_STEP_S.max(walk.time_s() / MOST_POINTS);
    let steps = (walk.time_s() / step_s) as usize;
    let at = |i: usize| {
        let at = walk.planner().trajectory().at(i as f64 * step_s).at;
        tame(canvas.screen([at.x, at.z]))
    };
    let points = (0..=steps).map(at).collect();
    canvas.painter.add(Shape::line(points, Stroke::new(2.0, colors::FIT)));
}
