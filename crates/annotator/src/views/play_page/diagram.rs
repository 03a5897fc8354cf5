//! The footfall diagram of the fitted stride with the phase as a line; a drag moves the phase.

use egui::accesskit::Role;
use egui::{Align2, FontId, Rect, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};
use muybridge_fitting::footfalls::LANES;
use muybridge_fitting::pipeline::PlateFit;

use crate::colors;

/// Width of the lanes' names, screen points.
const NAMES: f32 = 64.0;
/// Height of a lane.
const LANE: f32 = 15.0;
/// Names of the lanes.
const LANE_NAMES: [&str; 4] = ["near fore", "off fore", "near hind", "off hind"];

/// The diagram; the phase it was dragged to.
pub(super) fn show(ui: &mut Ui, plate: &PlateFit, phase: f64) -> Option<f64> {
    let height = 4.0 * LANE + 18.0;
    let (outer, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click_and_drag());
    let name = "Footfalls of the fitted stride: drag to move the phase";
    response.widget_info(|| WidgetInfo::labeled(Role::Slider, true, name));
    let lanes =
        Rect::from_min_size(outer.min + vec2(NAMES, 0.0), vec2(outer.width() - NAMES - 8.0, 4.0 * LANE));
    draw_lanes(ui, plate, lanes);
    draw_panels(ui, plate, lanes);
    let x = lanes.left() + lanes.width() * phase as f32;
    ui.painter().vline(x, lanes.y_range(), Stroke::new(2.0, ui.visuals().strong_text_color()));
    let pointer = response.interact_pointer_pos()?;
    Some(f64::from((pointer.x - lanes.left()) / lanes.width()).clamp(0.0, 0.999))
}

fn draw_lanes(ui: &Ui, plate: &PlateFit, lanes: Rect) {
    let (painter, visuals) = (ui.painter(), ui.visuals());
    for (at, (side, pair)) in LANES.into_iter().enumerate() {
        let top = lanes.top() + LANE * at as f32;
        let lane = Rect::from_min_size(pos2(lanes.left(), top), vec2(lanes.width(), LANE));
        painter.rect_filled(lane.shrink2(vec2(0.0, 1.0)), 2.0, visuals.extreme_bg_color);
        let name_at = pos2(lane.left() - 6.0, lane.center().y);
        let font = FontId::proportional(12.0);
        painter.text(name_at, Align2::RIGHT_CENTER, LANE_NAMES[at], font, visuals.text_color());
        let contact = &plate.analysis.contacts[plate.plate.facing.limb(side, pair).index()];
        let (strike, duty) = (contact.strike.phase, contact.duty_factor());
        // A stance over the end of the stride is drawn in two pieces.
        for from in [strike - 1.0, strike] {
            let [low, high] = [from.max(0.0), (from + duty).min(1.0)];
            if high > low {
                let x = |phase: f64| lane.left() + lane.width() * phase as f32;
                let bar =
                    Rect::from_min_max(pos2(x(low), lane.top() + 2.0), pos2(x(high), lane.bottom() - 2.0));
                painter.rect_filled(bar, 2.0, colors::side(side));
            }
        }
    }
}

/// The panels' numbers below their phases.
fn draw_panels(ui: &Ui, plate: &PlateFit, lanes: Rect) {
    let fit = &plate.fit;
    let weak = ui.visuals().weak_text_color();
    let mut free_from = f32::NEG_INFINITY;
    for (slot, phase) in fit.problem.phases.iter().enumerate() {
        let panel = fit.observation.panels[fit.problem.order[slot]].camera.panel;
        let x = lanes.left() + lanes.width() * *phase as f32;
        ui.painter().vline(x, lanes.bottom()..=lanes.bottom() + 3.0, Stroke::new(1.0, weak));
        // Numbers that would touch the one before are left out.
        if x - 8.0 > free_from {
            let at = pos2(x, lanes.bottom() + 4.0);
            ui.painter().text(at, Align2::CENTER_TOP, panel.to_string(), FontId::proportional(11.0), weak);
            free_from = x + 8.0;
        }
    }
}
