//! The points farthest from the fit; a click shows one.

use egui::{Align2, FontId, Ui, pos2};
use muybridge_fitting::pipeline::PlateFit;
use muybridge_fitting::stride_fit::PointResidual;

use super::{clickable_row, jump};
use crate::colors;
use crate::session::Session;

/// Points listed.
const LISTED: usize = 10;
/// Height of a line, screen points.
const ROW: f32 = 18.0;
/// Right or left edges of the columns, as shares of the width: panel, point, px, cm.
const COLUMNS: [f32; 4] = [0.12, 0.17, 0.78, 0.99];

/// The table.
pub(super) fn show(ui: &mut Ui, session: &mut Session, plate: &PlateFit) {
    let mut worst: Vec<&PointResidual> = plate.residuals.iter().collect();
    worst.sort_by(|a, b| b.metres().total_cmp(&a.metres()));
    let weak = ui.visuals().weak_text_color();
    let (rect, _) = ui.allocate_exact_size(egui::vec2(ui.available_width(), ROW), egui::Sense::hover());
    draw_cells(ui, rect, ["panel", "point", "px", "cm"].map(String::from), weak);
    for (at, residual) in worst.into_iter().take(LISTED).enumerate() {
        let point = colors::name(residual.keypoint);
        let [px, cm] = [residual.px(), 100.0 * residual.metres()].map(|value| format!("{value:.2}"));
        let name = format!("Worst point {}: panel {}, {point}, {px} px, {cm} cm", at + 1, residual.panel);
        let (rect, response) = clickable_row(ui, ROW, &name);
        let text = ui.visuals().text_color();
        draw_cells(ui, rect, [residual.panel.to_string(), point, px, cm], text);
        if response.clicked() {
            jump(session, residual.panel, Some(residual.keypoint));
        }
        response.on_hover_text("Click to go there");
    }
}

fn draw_cells(ui: &Ui, rect: egui::Rect, cells: [String; 4], color: egui::Color32) {
    let anchors = [Align2::RIGHT_CENTER, Align2::LEFT_CENTER, Align2::RIGHT_CENTER, Align2::RIGHT_CENTER];
    for ((cell, share), anchor) in cells.into_iter().zip(COLUMNS).zip(anchors) {
        let at = pos2(rect.left() + share * rect.width(), rect.center().y);
        ui.painter().text(at, anchor, cell, FontId::proportional(13.0), color);
    }
}
