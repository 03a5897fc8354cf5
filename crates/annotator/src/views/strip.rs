//! The film strip: every panel in small, and under each what the four legs do.

use egui::{Align2, Color32, FontId, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, pos2, vec2};
use muybridge_capture::{KEYPOINT_COUNT, PanelUse};

use crate::app::PageContext;
use crate::colors;
use crate::picture::Look;
use crate::session::Session;
use crate::views::footfall_bar;

/// Height of a photograph in the strip, screen points, at most.
const PHOTOGRAPH: f32 = 62.0;
/// Width of the names of the lanes.
pub const NAMES: f32 = 74.0;

/// Where a strip's columns are.
#[derive(Clone, Copy, Debug)]
pub struct Columns {
    /// Left edge of the first column, screen points.
    pub left: f32,
    /// Width of a column.
    pub width: f32,
}

impl Columns {
    /// Screen x of a place in panels, when the first column is panel `first`: a panel's own moment is its middle.
    pub fn x(&self, first: u32, at_panel: f64) -> f32 {
        self.left + self.width * (at_panel - f64::from(first) + 0.5) as f32
    }

    /// The place in panels of a screen x.
    pub fn panel(&self, first: u32, x: f32) -> f64 {
        f64::from((x - self.left) / self.width) - 0.5 + f64::from(first)
    }
}

/// Photographs and lanes.
pub fn show(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    let numbers = session.panel_numbers();
    if numbers.is_empty() {
        ui.add_space(2.0);
        return;
    }
    let left = ui.available_rect_before_wrap().left() + NAMES;
    let columns = Columns { left, width: (ui.available_width() - NAMES - 8.0) / numbers.len() as f32 };
    let height = PHOTOGRAPH.min(columns.width * 0.72).max(16.0);
    ui.add_space(4.0);
    let (row, _) = ui.allocate_exact_size(vec2(ui.available_width(), height + 16.0), Sense::hover());
    for (at, number) in numbers.iter().enumerate() {
        let corner = pos2(columns.left + columns.width * at as f32, row.top());
        let rect = Rect::from_min_size(corner, vec2(columns.width, height + 16.0)).shrink2(vec2(1.5, 0.0));
        thumbnail(ui, session, *number, rect);
    }
    footfall_bar::show(ui, session, &columns, page);
}

/// One panel in small; a click looks at it.
pub fn thumbnail(ui: &Ui, session: &mut Session, number: u32, rect: Rect) {
    let response = ui.interact(rect, ui.scope_id().with(("panel", number)), Sense::click());
    let name = format!("Panel {number}");
    let selected = session.panel == number;
    response.widget_info(|| egui::WidgetInfo::selected(egui::accesskit::Role::Button, true, selected, &name));
    let photograph = Rect::from_min_max(rect.min, rect.max - vec2(0.0, 16.0));
    let painter = ui.painter_at(rect);
    painter.rect_filled(photograph, 0.0, ui.visuals().extreme_bg_color);
    draw_photograph(&painter, session, number, photograph);
    if session.shown.marks {
        draw_figure(&painter, session, number, photograph);
    }
    let stroke = match (selected, response.hovered()) {
        (true, _) => Stroke::new(2.5, ui.visuals().selection.stroke.color),
        (false, true) => Stroke::new(1.5, ui.visuals().strong_text_color()),
        (false, false) => Stroke::new(1.0, ui.visuals().weak_text_color()),
    };
    painter.rect_stroke(photograph, 0.0, stroke, StrokeKind::Inside);
    let (text, color) = caption(ui, session, number);
    painter.text(rect.center_bottom(), Align2::CENTER_BOTTOM, text, FontId::proportional(12.0), color);
    if response.clicked() {
        session.go_to(number);
        session.shown.sheet = false;
    }
}

/// Number of the panel, and how many of its points have a place.
fn caption(ui: &Ui, session: &Session, number: u32) -> (String, Color32) {
    let panel = session.draft().panel(number);
    let placed = panel.map_or(0, |panel| panel.keypoints.iter().count());
    let weak = ui.visuals().weak_text_color();
    match panel.map(|panel| panel.usage) {
        Some(PanelUse::Unused) => (format!("{number} unused"), weak),
        Some(PanelUse::Standing) => (format!("{number} stands"), ui.visuals().text_color()),
        _ if placed == KEYPOINT_COUNT => (format!("{number} all"), ui.visuals().strong_text_color()),
        _ if placed > 0 => (format!("{number}: {placed}"), ui.visuals().text_color()),
        _ => (number.to_string(), weak),
    }
}

fn draw_photograph(painter: &egui::Painter, session: &mut Session, number: u32, into: Rect) {
    let Some(panel) = session.place_of(number).cloned() else { return };
    if let Some((textures, source)) = session.picture(panel.image) {
        textures.draw_quad(&painter.with_clip_rect(into), source, panel.quad_px, into, Look::default());
    }
}

/// The points of a panel as thin lines over its small photograph.
fn draw_figure(painter: &egui::Painter, session: &Session, number: u32, into: Rect) {
    let (Some(panel), Some(place)) = (session.draft().panel(number), session.place_of(number)) else {
        return;
    };
    let Some(transform) = muybridge_imaging::PanelTransform::new(place.quad_px, [1.0, 1.0]) else { return };
    let screen = |at_px: [f64; 2]| -> Pos2 {
        let [u, v] = transform.panel_from_plate(at_px);
        into.lerp_inside(vec2(u as f32, v as f32))
    };
    for [from, to] in colors::edges() {
        if let Some((a, b)) = panel.keypoints.place(from).zip(panel.keypoints.place(to)) {
            let stroke = Stroke::new((into.width() / 90.0).clamp(0.8, 2.0), colors::keypoint(to));
            painter.line_segment([screen(a), screen(b)], stroke);
        }
    }
}
