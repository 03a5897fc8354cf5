//! The glass: what is under the pointer, several times larger, in a corner.

use egui::{Color32, Rect, Stroke, StrokeKind, Ui, Vec2, vec2};

use crate::canvas::PanelCanvas;
use crate::colors;
use crate::picture::Look;
use crate::session::Session;

/// Side of the glass, screen points.
const SIDE: f32 = 190.0;
/// How much larger than the canvas.
const POWER: f64 = 4.0;

/// Shows the glass while the pointer is over the photograph.
pub(super) fn show(ui: &Ui, canvas: &PanelCanvas, session: &mut Session) {
    let Some(pointer) = ui.input(|input| input.pointer.latest_pos()) else { return };
    let all = canvas.painter.clip_rect();
    if !all.contains(pointer) {
        return;
    }
    // In the corner that is away from the pointer.
    let right = all.right_top() + vec2(-SIDE - 12.0, 12.0);
    let left = all.left_top() + vec2(12.0, 60.0);
    let corner = if pointer.x > all.center().x { left } else { right };
    let glass = Rect::from_min_size(corner, Vec2::splat(SIDE));
    let Some(panel) = session.panel_place().cloned() else { return };
    let under = canvas.view.plate_from_screen(pointer);
    let view = canvas.view.zoomed(POWER, pointer).with_at(under, glass.center());
    let painter = canvas.painter.with_clip_rect(glass);
    painter.rect_filled(glass, 0.0, Color32::BLACK);
    if let Some((textures, source)) = session.picture(panel.image) {
        textures.draw(&painter, source, &view, Look::default());
    }
    if let Some(annotation) = session.panel_annotation() {
        for (keypoint, placed) in annotation.keypoints.iter() {
            if let Some(at_px) = placed.place() {
                let at = view.screen_from_plate(at_px);
                painter.circle_stroke(at, 6.0, Stroke::new(1.5, colors::keypoint(keypoint)));
            }
        }
    }
    let cross = Stroke::new(1.0, Color32::from_white_alpha(170));
    let centre = glass.center();
    painter.hline(glass.x_range(), centre.y, cross);
    painter.vline(centre.x, glass.y_range(), cross);
    canvas.painter.rect_stroke(glass, 0.0, Stroke::new(2.0, Color32::WHITE), StrokeKind::Outside);
}
