//! Ground line, marks and lengths over the photograph, legible on dark ones and on light ones.

use egui::{Align2, Color32, FontId, Pos2, Rect, Stroke, Vec2, vec2};
use muybridge_capture::{Mark, PanelAnnotation};

use super::numbers::{Number, Quantity};
use super::units::number;
use super::{Tool, marks};
use crate::canvas::{PanelCanvas, line_across};
use crate::colors;
use crate::session::Session;

/// Behind lines and words.
const SHADE: Color32 = Color32::from_black_alpha(170);
/// Half the length of a mark's stroke, screen points.
const STROKE: f32 = 13.0;

/// Everything that is marked on the panel looked at.
pub(super) fn draw(canvas: &PanelCanvas, session: &Session) {
    let Some(panel) = session.panel_annotation() else { return };
    draw_ground(canvas, panel);
    draw_metre(canvas, session);
    draw_marks(canvas, session, panel);
}

fn draw_ground(canvas: &PanelCanvas, panel: &PanelAnnotation) {
    let Some(line) = panel.ground_px else { return };
    let ends = line.map(|at| canvas.view.screen_from_plate(at));
    line_across(&canvas.painter, ends, Stroke::new(3.5, Color32::from_black_alpha(110)));
    line_across(&canvas.painter, ends, Stroke::new(1.6, colors::GROUND));
    tag(canvas, ends[0] + vec2(10.0, 12.0), Align2::LEFT_TOP, "ground", colors::GROUND);
}

/// Unit vector upwards in the panel, on the screen.
fn up(panel: &PanelAnnotation) -> Vec2 {
    let [a, b] = panel.ground_px.unwrap_or([[0.0, 0.0], [1.0, 0.0]]);
    vec2((b[1] - a[1]) as f32, (a[0] - b[0]) as f32).normalized()
}

fn draw_marks(canvas: &PanelCanvas, session: &Session, panel: &PanelAnnotation) {
    let up = up(panel);
    let mut sorted: Vec<&Mark> = panel.marks.iter().collect();
    sorted.sort_by(|a, b| a.mark.total_cmp(&b.mark));
    let screen = |mark: &Mark| canvas.view.screen_from_plate(mark.at_px);
    for (at, pair) in sorted.windows(2).enumerate() {
        let ends = [screen(pair[0]), screen(pair[1])];
        canvas.painter.line_segment(ends, Stroke::new(3.5, Color32::from_black_alpha(110)));
        canvas.painter.line_segment(ends, Stroke::new(1.5, colors::MARK));
        let gap = pair[1].mark - pair[0].mark;
        let Some(text) = length_text(session, gap).filter(|_| at == 0) else { continue };
        let middle = ends[0] + 0.5 * (ends[1] - ends[0]);
        tag(canvas, middle - 12.0 * up, Align2::CENTER_TOP, &text, Color32::WHITE);
    }
    for mark in sorted {
        let at = screen(mark);
        let ends = [at - STROKE * up, at + STROKE * up];
        canvas.painter.line_segment(ends, Stroke::new(4.0, Color32::from_black_alpha(140)));
        canvas.painter.line_segment(ends, Stroke::new(1.6, colors::MARK));
        tag(canvas, at + (STROKE + 5.0) * up, Align2::CENTER_BOTTOM, &number(mark.mark), colors::MARK);
    }
}

/// The distance between two marks, in the unit it is typed in.
fn length_text(session: &Session, gap: f64) -> Option<String> {
    let value = Number::Value(Quantity::MarkSpacing);
    let spacing_m = value.get(session.draft())?;
    let unit = session.calibrate.unit(value);
    Some(format!("{} {}", unit.text(gap * spacing_m), unit.sign()))
}

/// A metre on the track, as the calibration has it, at the panel's lower edge.
fn draw_metre(canvas: &PanelCanvas, session: &Session) {
    let calibrated = session.derived.calibration.as_ref().ok();
    let camera = calibrated.and_then(|plate| {
        plate.stride.iter().chain(&plate.standing).find(|camera| camera.panel == session.panel)
    });
    let (Some(camera), Some(place)) = (camera, session.panel_place()) else { return };
    let [corner, inwards] = [place.quad_px[3], place.quad_px[2]];
    let share = |s: f64| [0, 1].map(|axis| corner[axis] + s * (inwards[axis] - corner[axis]));
    let [x_m, y_m, _] = camera.world_from_plate(share(0.04), 0.0);
    // Away from the edge, whichever way the animal faces.
    let ahead = if camera.forward[0] >= 0.0 { 1.0 } else { -1.0 };
    let ends = [x_m, x_m + ahead]
        .map(|x| canvas.view.screen_from_plate(camera.plate_from_world([x, y_m, 0.0])) - vec2(0.0, 10.0));
    canvas.painter.line_segment(ends, Stroke::new(6.0, Color32::from_black_alpha(150)));
    canvas.painter.line_segment(ends, Stroke::new(2.5, Color32::WHITE));
    let at = ends[0] + 0.5 * (ends[1] - ends[0]) - vec2(0.0, 6.0);
    tag(canvas, at, Align2::CENTER_BOTTOM, "1 m on the track", Color32::WHITE);
}

/// Words on a dark ground.
fn tag(canvas: &PanelCanvas, at: Pos2, align: Align2, text: &str, color: Color32) {
    let galley = canvas.painter.layout_no_wrap(text.into(), FontId::proportional(13.0), color);
    let rect = align.anchor_size(at, galley.size());
    canvas.painter.rect_filled(rect.expand2(vec2(4.0, 1.0)), 3.0, SHADE);
    canvas.painter.galley(rect.min, galley, color);
}

/// What a click would do, in the corner.
pub(super) fn hint(canvas: &PanelCanvas, session: &Session) {
    let panel = session.panel_annotation();
    let bare = panel.is_none_or(|panel| panel.ground_px.is_none());
    let text = match (session.calibrate.tool, session.calibrate.first_end_px) {
        (Tool::Ground | Tool::Length, Some(_)) => "Click the other end; Escape gives up".to_string(),
        (Tool::Ground, None) if bare => {
            "Click two points on the ground under the near hooves, or drag".into()
        }
        (Tool::Ground, None) => {
            "Drag the ends of the ground line; drag marks; right click deletes a mark".into()
        }
        (Tool::Length, None) => {
            "Drag along a length that is known, then type it; it replaces this panel's marks".into()
        }
        (Tool::Marks, _) => {
            let next = marks::next_number(panel, session.calibrate.first_mark);
            format!("Click: mark {}. Drag moves a mark, right click deletes it", number(next))
        }
    };
    let painter = &canvas.painter;
    let width = painter.clip_rect().width() - 40.0;
    let galley = painter.layout(text, FontId::proportional(13.0), Color32::WHITE, width);
    let at = painter.clip_rect().left_top() + vec2(12.0, 10.0);
    painter.rect_filled(Rect::from_min_size(at, galley.size()).expand(6.0), 4.0, SHADE);
    painter.galley(at, galley, Color32::WHITE);
}
