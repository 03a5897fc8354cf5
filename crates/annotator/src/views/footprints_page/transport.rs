//! Play, pause, single steps, speed, the moment.

use egui::{Slider, Ui};

use super::command_button;
use crate::app::PageContext;
use crate::command::Command;
use crate::footprints::Editor;
use crate::footprints::playback::{RATES, STEP_S};

/// The row over the timing diagram.
pub(super) fn show(ui: &mut Ui, editor: &mut Editor, page: &mut PageContext<'_>) {
    ui.add_space(3.0);
    ui.horizontal(|ui| {
        let title = if editor.playback.is_playing { "Pause" } else { "Play" };
        command_button(ui, page, Command::FootprintsPlay, title, editor.playback.is_playing);
        command_button(ui, page, Command::FootprintsStepBack, "Step back", false);
        command_button(ui, page, Command::FootprintsStepForward, "Step forward", false);
        ui.checkbox(&mut editor.playback.is_looped, "Loop").on_hover_text("Begin again at the end");
        ui.separator();
        ui.label("Time");
        for (rate, text) in RATES {
            let is_on = (editor.playback.rate - rate).abs() < 1e-9;
            let button = egui::Button::selectable(is_on, text).frame_when_inactive(true);
            if ui.add(button).on_hover_text(format!("Time at {text} of the real one")).clicked() {
                editor.playback.rate = rate;
            }
        }
        ui.separator();
        moment(ui, editor);
        if editor.solving.is_busy() {
            ui.spinner();
            ui.weak("finding the motion…");
        }
    });
    ui.add_space(2.0);
}

fn moment(ui: &mut Ui, editor: &mut Editor) {
    let end_s = editor.end_s();
    let mut time_s = editor.playback.time_s();
    ui.spacing_mut().slider_width = 170.0;
    let slider = Slider::new(&mut time_s, 0.0..=end_s.max(STEP_S))
        .text("Moment")
        .suffix(" s")
        // Not rounded: a moment between two hundredths is one, too.
        .custom_formatter(|time_s, _| format!("{time_s:.2}"));
    if ui.add(slider).changed() && time_s != editor.playback.time_s() {
        editor.playback.is_playing = false;
        editor.playback.go_to(time_s, end_s);
    }
}
