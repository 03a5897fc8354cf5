//! The numbers of what is selected: a print, prints, a point of the path.

use egui::accesskit::Role;
use egui::{ComboBox, Grid, Ui, WidgetInfo};
use muybridge_footprints::{Foot, StepTiming};

use super::fields::{Number, drag_value};
use crate::footprints::Editor;
use crate::footprints::edits::{
    self, FARTHEST_M, LONGEST_S, SHORTEST_STANCE_S, set_stance, set_step, turn_to,
};

fn metres(name: &str) -> Number<'_> {
    Number { name, suffix: " m", range: -FARTHEST_M..=FARTHEST_M, speed: 0.01, decimals: 3 }
}

fn seconds(name: &str, least_s: f64) -> Number<'_> {
    Number { name, suffix: " s", range: least_s..=LONGEST_S, speed: 0.005, decimals: 3 }
}

/// The box.
pub(super) fn show(ui: &mut Ui, editor: &mut Editor) {
    if let Some(point) = editor.path_point {
        path_point(ui, editor, point);
        return;
    }
    let (count, first) = (editor.selected.len(), editor.selected.first().copied());
    match (count, first) {
        (0, _) | (_, None) => {
            ui.weak("Nothing. Click a print; drag over several; Shift adds.");
        }
        (1, Some(print)) => one(ui, editor, print),
        (count, _) => several(ui, editor, count),
    }
}

fn one(ui: &mut Ui, editor: &mut Editor, print: usize) {
    let (Some(shown), Some(timing)) = (editor.prints().get(print).copied(), editor.timing(print)) else {
        return;
    };
    Grid::new("print numbers").num_columns(2).show(ui, |ui| {
        ui.label("Foot");
        foot(ui, editor, print, shown.foot);
        ui.end_row();
        for (axis, name) in ["x", "z"].into_iter().enumerate() {
            ui.label(name);
            drag_value(ui, editor, shown.at_m[axis], &metres(&format!("Print {name}")), |track, value| {
                let mut at_m = shown.at_m;
                at_m[axis] = value;
                edits::put(track, print, at_m);
            });
            ui.end_row();
        }
        ui.label("Heading");
        let number =
            Number { name: "Print heading", suffix: "°", range: -180.0..=180.0, speed: 0.5, decimals: 1 };
        drag_value(ui, editor, shown.heading_deg, &number, |track, value| {
            turn_to(track, print, &std::collections::BTreeSet::new(), value);
        })
        .on_hover_text("Where the toes point: to the left of X positive");
        ui.end_row();
        times(ui, editor, print, timing);
        ui.label("Times");
        automatic(ui, editor, &[print], shown.timing.is_none());
        ui.end_row();
    });
}

fn times(ui: &mut Ui, editor: &mut Editor, print: usize, timing: StepTiming) {
    ui.label("Stands");
    let stance = seconds("Print stance time", SHORTEST_STANCE_S);
    drag_value(ui, editor, timing.stance_time_s, &stance, |track, value| {
        set_stance(track, print, timing, value);
    })
    .on_hover_text("How long the foot is on the ground");
    ui.end_row();
    ui.label("Next after");
    let step = seconds("Print step time", 0.0);
    drag_value(ui, editor, timing.step_time_s, &step, |track, value| set_step(track, print, timing, value))
        .on_hover_text("From this footfall to the next one; shorter than the stance: both feet are down");
    ui.end_row();
}

fn foot(ui: &mut Ui, editor: &mut Editor, print: usize, now: Foot) {
    let feet: &[Foot] = if now.is_biped() { &Foot::BIPED } else { &Foot::QUADRUPED };
    let mut chosen = now;
    let list = ComboBox::from_id_salt("foot").selected_text(now.abbreviation()).width(60.0);
    let shown = list.show_ui(ui, |ui| {
        for foot in feet {
            ui.selectable_value(&mut chosen, *foot, foot.abbreviation());
        }
    });
    shown.response.widget_info(|| WidgetInfo::labeled(Role::ComboBox, true, "Foot of the print"));
    if chosen != now {
        editor.edit("Another foot", |track| {
            if let Some(print) = track.prints.get_mut(print) {
                print.foot = chosen;
            }
        });
    }
}

/// Whether times follow from the distances. Distances do not time four feet.
fn automatic(ui: &mut Ui, editor: &mut Editor, prints: &[usize], are_automatic: bool) {
    let is_biped = editor.prints().first().is_none_or(|print| print.foot.is_biped());
    let mut automatic = are_automatic;
    let checkbox = ui.add_enabled(is_biped, egui::Checkbox::new(&mut automatic, "From the distances"));
    let hover = "Long steps get less stance and a flight";
    if checkbox.on_hover_text(hover).on_disabled_hover_text("A gait times four feet").changed() {
        let timings: Vec<_> = prints.iter().map(|print| editor.timing(*print)).collect();
        editor.edit("Times from the distances", |track| {
            for (print, timing) in prints.iter().zip(timings) {
                if let Some(print) = track.prints.get_mut(*print) {
                    print.timing = if automatic { None } else { timing };
                }
            }
        });
    }
}

fn several(ui: &mut Ui, editor: &mut Editor, count: usize) {
    ui.label(format!("{count} prints"));
    let prints: Vec<usize> = editor.selected.iter().copied().collect();
    let shown = editor.prints();
    let are_automatic = prints.iter().all(|print| shown.get(*print).is_some_and(|p| p.timing.is_none()));
    automatic(ui, editor, &prints, are_automatic);
    if ui.button("Select all").clicked() {
        editor.selected = (0..editor.prints().len()).collect();
    }
}

fn path_point(ui: &mut Ui, editor: &mut Editor, point: usize) {
    let Some(shown) = editor.track().path.as_ref().and_then(|path| path.points.get(point)).copied() else {
        return;
    };
    ui.label(format!("Point {} of the path", point + 1));
    ui.horizontal(|ui| {
        for (axis, name) in ["x", "z"].into_iter().enumerate() {
            ui.label(name);
            let name = format!("Path point {name}");
            drag_value(ui, editor, shown.at_m[axis], &metres(&name), |track, value| {
                if let Some(point) = track.path.as_mut().and_then(|path| path.points.get_mut(point)) {
                    point.at_m[axis] = value;
                }
            });
        }
    });
    if ui.add_enabled(shown.tangent_m.is_some(), egui::Button::new("Tangent as its neighbours ask")).clicked()
    {
        editor.document.edit("Tangent of the path", |track| {
            if let Some(point) = track.path.as_mut().and_then(|path| path.points.get_mut(point)) {
                point.tangent_m = None;
            }
        });
    }
}
