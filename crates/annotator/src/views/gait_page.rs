//! Footfalls in numbers, the fit, and what to look at again.

mod concerns;
mod fit_box;
mod heat;
mod hildebrand;
mod law_plot;
mod numbers;
mod plot;
mod supports;
mod worst;

use egui::accesskit::Role;
use egui::{CollapsingHeader, Color32, Rect, Response, RichText, Sense, Ui, WidgetInfo, vec2};
use muybridge_capture::Keypoint;

use crate::app::PageContext;
use crate::session::{Page, Session};

/// The panel at the right. What the fit says is not shown in a blind second pass.
pub fn inspector(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    let blind = session.second_pass.is_some();
    let fitted = session.fit.latest().filter(|_| !blind).cloned();
    let plate = fitted.as_ref().map(|fitted| &fitted.plate);
    section(ui, "fit", "Fit", |ui| fit_box::show(ui, session, page));
    concerns::show(ui, session, fitted.as_deref());
    section(ui, "numbers", "Gait in numbers", |ui| numbers::show(ui, session, plate));
    section(ui, "supports", "Feet on the ground, in order", |ui| supports::show(ui, session, plate));
    section(ui, "law", "Contact time against speed", |ui| law_plot::show(ui, session, plate));
    section(ui, "hildebrand", "Hildebrand's plot", |ui| hildebrand::show(ui, session, plate));
    if let Some(plate) = plate {
        section(ui, "worst", "Worst points", |ui| worst::show(ui, session, plate));
        section(ui, "heat", "Distance from the fit, all points", |ui| heat::show(ui, session, plate));
    }
}

/// A part of the inspector that can be folded away.
fn section(ui: &mut Ui, id: &str, title: &str, content: impl FnOnce(&mut Ui)) {
    let title = RichText::new(title).strong().size(14.0);
    CollapsingHeader::new(title).id_salt(("gait", id)).default_open(true).show_unindented(ui, content);
    ui.add_space(6.0);
}

/// A line over the whole width that can be clicked; what is on it is painted by the caller.
fn clickable_row(ui: &mut Ui, height: f32, name: &str) -> (Rect, Response) {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Button, true, name));
    if response.hovered() || response.has_focus() {
        ui.painter().rect_filled(rect, 2.0, ui.visuals().widgets.hovered.weak_bg_fill);
    }
    (rect, response)
}

/// Shows a point on the pose page, unless its panel was taken away since the fit.
fn jump(session: &mut Session, panel: u32, keypoint: Option<Keypoint>) {
    if session.place_of(panel).is_none() {
        return;
    }
    session.page = Page::Pose;
    session.shown.sheet = false;
    session.go_to(panel);
    session.selected = keypoint.or(session.selected);
}

/// A colour of the data, darker on light backgrounds.
fn legible(ui: &Ui, color: Color32) -> Color32 {
    if ui.visuals().dark_mode { color } else { color.lerp_to_gamma(Color32::BLACK, 0.35) }
}

/// `0.452 ± 0.003`.
fn plus_minus([value, sd]: [f64; 2], decimals: usize) -> String {
    format!("{value:.decimals$} ± {sd:.decimals$}")
}
