//! The speed: wanted and real, with the gaits' ranges along it.

use egui::accesskit::Role;
use egui::{Align2, Color32, FontId, Rect, Response, Sense, Stroke, Ui, WidgetInfo, pos2, vec2};
use muybridge_core::{Gait, MPS_PER_MPH};

use crate::ride::RideSession;
use crate::ride::wants::{Order, Wants};

/// Height of the band of a gait.
const BAND: f32 = 15.0;
/// Height of the axis with its numbers.
const AXIS: f32 = 16.0;
/// Free at both ends, so that the first and the last number are not cut.
const MARGIN: f32 = 9.0;
/// The gaits in rows, so that no two bands overlap.
const ROWS: [&[Gait]; 3] =
    [&[Gait::Walk, Gait::Amble, Gait::Trot, Gait::Gallop], &[Gait::Rack], &[Gait::Canter]];

/// Colour of a gait, the same in bands, diagram and headline: told apart on light and dark.
pub(super) fn color(gait: Gait) -> Color32 {
    match gait {
        Gait::Walk => Color32::from_rgb(76, 144, 107),
        Gait::Amble => Color32::from_rgb(62, 128, 150),
        Gait::Trot => Color32::from_rgb(88, 110, 180),
        Gait::Rack => Color32::from_rgb(136, 100, 170),
        Gait::Canter => Color32::from_rgb(176, 112, 60),
        Gait::Gallop => Color32::from_rgb(178, 74, 66),
        Gait::Leap => Color32::from_rgb(150, 140, 50),
    }
}

/// The slider: a drag or a click sets the wanted speed.
pub(super) fn show(ui: &mut Ui, ride: &mut RideSession) {
    let height = ROWS.len() as f32 * BAND + AXIS;
    let (rect, response) =
        ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click_and_drag());
    let wanted_mph = ride.shown().wants.speed_mph;
    name(&response, wanted_mph);
    let axis = rect.x_range().shrink(MARGIN);
    let x = |mph: f32| axis.min + axis.span() * mph / *Wants::SPEED_MPH.end();
    bands(ui, rect, ride, x);
    numbers(ui, rect, x);
    let real_m_s = ride.shown().riders[0].as_ref().map_or(0.0, |rider| rider.readout.speed_m_s);
    hands(ui, rect, x(real_m_s / MPS_PER_MPH as f32), x(wanted_mph));
    if response.has_focus() {
        ui.painter().rect_stroke(rect, 3.0, ui.visuals().selection.stroke, egui::StrokeKind::Inside);
    }
    if let Some(pointer) = response.interact_pointer_pos() {
        let mph = (pointer.x - axis.min) / axis.span() * Wants::SPEED_MPH.end();
        let mph = mph.round().clamp(*Wants::SPEED_MPH.start(), *Wants::SPEED_MPH.end());
        if (mph - wanted_mph).abs() > 0.0 {
            ride.give(Order::Speed(mph));
        }
    }
    if response.has_focus() {
        by_keys(ui, &response, ride);
    }
    response.on_hover_text("Wanted speed: drag, or press the keys for a mile per hour more or less");
}

/// The arrow keys of a slider that has the keyboard.
fn by_keys(ui: &Ui, response: &Response, ride: &mut RideSession) {
    let arrows = egui::EventFilter { horizontal_arrows: true, ..Default::default() };
    ui.memory_mut(|memory| memory.set_focus_lock_filter(response.id, arrows));
    let presses = |key| ui.input(|input| input.num_presses(key));
    (0..presses(egui::Key::ArrowRight)).for_each(|_| ride.give(Order::Faster));
    (0..presses(egui::Key::ArrowLeft)).for_each(|_| ride.give(Order::Slower));
}

fn name(response: &Response, mph: f32) {
    response.widget_info(|| {
        let mut info = WidgetInfo::labeled(Role::Slider, true, "Wanted speed, mph");
        info.value = Some(f64::from(mph));
        info
    });
}

fn bands(ui: &Ui, rect: Rect, ride: &RideSession, x: impl Fn(f32) -> f32) {
    let frame = ride.shown();
    let present = frame.riders[0].as_ref().map(|rider| rider.readout.gait);
    for (row, gaits) in ROWS.iter().enumerate() {
        for gait in *gaits {
            let Some([low, high]) = gait.speed_range_mph() else { continue };
            let top = rect.top() + BAND * row as f32 + 1.0;
            let band = Rect::from_min_max(
                // Half a mile to either side, so that neighbours meet and the walk is wide enough for its name.
                pos2(x(low as f32 - 0.5), top),
                pos2(x(high as f32 + 0.5), top + BAND - 2.0),
            );
            let (fill, text) = if present == Some(*gait) && !ride_stands(ride) {
                (color(*gait), Color32::WHITE)
            } else {
                (color(*gait).gamma_multiply(0.35), ui.visuals().text_color())
            };
            ui.painter().rect_filled(band, 3.0, fill);
            if frame.wants.gait == Some(*gait) {
                let stroke = Stroke::new(1.5, ui.visuals().strong_text_color());
                ui.painter().rect_stroke(band, 3.0, stroke, egui::StrokeKind::Inside);
            }
            let font = FontId::proportional(10.5);
            let clipped = ui.painter().with_clip_rect(band.intersect(ui.clip_rect()));
            clipped.text(band.center(), Align2::CENTER_CENTER, gait.name(), font, text);
        }
    }
}

fn ride_stands(ride: &RideSession) -> bool {
    ride.shown().riders[0].as_ref().is_some_and(|rider| rider.readout.is_standing)
}

fn numbers(ui: &Ui, rect: Rect, x: impl Fn(f32) -> f32) {
    let top = rect.bottom() - AXIS;
    let weak = ui.visuals().weak_text_color();
    for mph in (0..=40).step_by(5) {
        let x = x(mph as f32);
        let long = if mph % 10 == 0 { 4.0 } else { 2.0 };
        ui.painter().vline(x, top..=top + long, Stroke::new(1.0, weak));
        if mph % 10 == 0 {
            let text = if mph == 0 { "0 mph".to_string() } else { mph.to_string() };
            let align = if mph == 0 { Align2::LEFT_TOP } else { Align2::CENTER_TOP };
            let at = pos2(if mph == 0 { x - 4.0 } else { x }, top + 3.0);
            ui.painter().text(at, align, text, FontId::proportional(10.5), weak);
        }
    }
}

/// The real speed as a line, the wanted one as a handle.
fn hands(ui: &Ui, rect: Rect, real_x: f32, wanted_x: f32) {
    let visuals = ui.visuals();
    let y = rect.top()..=rect.bottom() - AXIS + 2.0;
    ui.painter().vline(real_x, y.clone(), Stroke::new(2.0, visuals.strong_text_color()));
    let bottom = *y.end();
    let handle = [vec2(0.0, -7.0), vec2(5.5, 5.0), vec2(-5.5, 5.0)].map(|by| pos2(wanted_x, bottom) + by);
    let edge = Stroke::new(1.0, visuals.strong_text_color());
    ui.painter().add(egui::Shape::convex_polygon(handle.into(), visuals.selection.bg_fill, edge));
}
