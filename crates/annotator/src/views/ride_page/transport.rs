//! Time: stop, single steps, slow motion, and the moment that is shown.

use egui::{Slider, Ui};

use super::command_button;
use crate::app::PageContext;
use crate::command::Command;
use crate::ride::RideSession;
use crate::ride::record::STEP_S;

/// Speeds of time.
const RATES: [(f64, &str); 5] =
    [(1.0 / 16.0, "1/16"), (1.0 / 8.0, "1/8"), (1.0 / 4.0, "1/4"), (1.0 / 2.0, "1/2"), (1.0, "1×")];

/// The row over the diagram.
pub(super) fn show(ui: &mut Ui, ride: &mut RideSession, page: &mut PageContext<'_>) {
    ui.add_space(3.0);
    ui.horizontal(|ui| {
        let title = if ride.is_paused() { "Go on" } else { "Pause" };
        command_button(ui, page, Command::RidePause, title, ride.is_paused());
        command_button(ui, page, Command::RideStepBack, "Step back", false);
        command_button(ui, page, Command::RideStepForward, "Step forward", false);
        ui.separator();
        ui.label("Time");
        for (rate, text) in RATES {
            let is_on = (ride.rate - rate).abs() < 1e-9;
            let button = egui::Button::selectable(is_on, text).frame_when_inactive(true);
            if ui.add(button).on_hover_text(format!("Time at {text} of the real one")).clicked() {
                ride.rate = rate;
            }
        }
        ui.separator();
        moment(ui, ride);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            command_button(ui, page, Command::RideReset, "Begin again", false);
        });
    });
    ui.add_space(2.0);
}

/// The slider over the record, and what is shown.
fn moment(ui: &mut Ui, ride: &mut RideSession) {
    let depth_s = ride.record().depth() as f64 * STEP_S;
    let mut at_s = -(ride.back() as f64) * STEP_S;
    ui.spacing_mut().slider_width = 170.0;
    let slider = Slider::new(&mut at_s, -depth_s.max(STEP_S)..=0.0)
        .text("Moment")
        .suffix(" s")
        .fixed_decimals(2)
        .step_by(STEP_S);
    let changed = ui.add(slider).on_hover_text("The last twenty seconds, as they were").changed();
    if changed {
        ride.go_back((-at_s / STEP_S).round().max(0.0) as usize);
    }
    if ride.back() > 0 {
        let text = "Forgets what came after this moment, and rides on";
        if ui.button("Ride on from here").on_hover_text(text).clicked() {
            ride.ride_on_from_here();
            ride.pause(false);
        }
    } else {
        let strides = ride.shown().riders[0].as_ref().map_or(0.0, |rider| rider.readout.strides);
        ui.weak(format!("phase {:.2}", strides.rem_euclid(1.0)));
    }
}
