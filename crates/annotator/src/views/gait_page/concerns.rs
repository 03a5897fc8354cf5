//! Warnings and notes, worst first; a click shows the point.

use egui::{Color32, FontId, Rect, Ui, pos2};
use muybridge_fitting::checks::{Concern, Severity};

use super::{clickable_row, jump, section};
use crate::fit_state::Fitted;
use crate::session::Session;

/// Concerns shown at most: beyond these a person repairs the first ones first.
const MOST: usize = 24;
/// Bar that tells warnings from notes, screen points.
const BAR: f32 = 3.0;

/// The list, of the documents and of the fit.
pub(super) fn show(ui: &mut Ui, session: &mut Session, fitted: Option<&Fitted>) {
    let of_fit = fitted.map_or(&[][..], |fitted| &fitted.concerns);
    let mut concerns: Vec<Concern> = session.derived.concerns.iter().chain(of_fit).cloned().collect();
    concerns.sort_by(|a, b| b.severity.cmp(&a.severity).then(b.size.total_cmp(&a.size)));
    section(ui, "concerns", &heading(&concerns), |ui| {
        if concerns.is_empty() {
            ui.label("Nothing here contradicts itself.");
        }
        for concern in concerns.iter().take(MOST) {
            row(ui, session, concern);
        }
        if concerns.len() > MOST {
            ui.weak(format!("and {} more", concerns.len() - MOST));
        }
    });
}

fn heading(concerns: &[Concern]) -> String {
    let warnings = concerns.iter().filter(|concern| concern.severity == Severity::Warning).count();
    let count = |number: usize, one: &str| match number {
        1 => format!("1 {one}"),
        _ => format!("{number} {one}s"),
    };
    format!("{}, {}", count(warnings, "warning"), count(concerns.len() - warnings, "note"))
}

fn row(ui: &mut Ui, session: &mut Session, concern: &Concern) {
    let text = match concern.panel {
        Some(panel) => format!("Panel {panel}: {}", concern.text),
        None => concern.text.clone(),
    };
    let visuals = ui.visuals();
    let (color, bar) = match concern.severity {
        Severity::Warning => (visuals.strong_text_color(), visuals.warn_fg_color),
        Severity::Note => (visuals.text_color(), visuals.weak_text_color()),
    };
    let left = 2.0 * BAR + 4.0;
    let galley =
        ui.painter().layout(text.clone(), FontId::proportional(13.0), color, ui.available_width() - left);
    let (rect, response) = clickable_row(ui, galley.size().y + 5.0, &text);
    let bar_rect = Rect::from_min_max(
        rect.min + egui::vec2(1.0, 2.0),
        pos2(rect.left() + 1.0 + BAR, rect.bottom() - 2.0),
    );
    ui.painter().rect_filled(bar_rect, 1.0, bar);
    ui.painter().galley(rect.min + egui::vec2(left, 2.0), galley, Color32::PLACEHOLDER);
    match concern.panel {
        Some(panel) if response.clicked() => jump(session, panel, concern.keypoints.first().copied()),
        Some(_) => drop(response.on_hover_text("Click to go there")),
        None => drop(response.on_hover_text("This concerns the whole stride")),
    }
}
