//! What is there when no plate is open.

use std::path::PathBuf;

use egui::{RichText, Ui};

use crate::command::Command;
use crate::settings::Settings;

/// Draws it; a recent plate that was chosen.
pub fn show(ui: &mut Ui, settings: &Settings, commands: &mut Vec<Command>) -> Option<PathBuf> {
    let mut chosen = None;
    ui.vertical_centered(|ui| {
        ui.add_space(60.0);
        ui.heading(RichText::new("Open a plate").size(26.0));
        ui.label(
            "Drop a picture, a folder of frames, a manifest, an annotation or a track of footprints here.",
        );
        ui.add_space(16.0);
        for command in [
            Command::Open,
            Command::Browse,
            Command::OpenSpecimen,
            Command::PageRide,
            Command::PageFootprints,
            Command::Tour,
        ] {
            let title = match command {
                Command::PageRide => "Ride a horse",
                Command::PageFootprints => "Walk from footprints",
                command => command.title(),
            };
            let text = format!("{title}   {}", settings.keys.shown(command));
            if ui.add_sized([280.0, 32.0], egui::Button::new(text)).clicked() {
                commands.push(command);
            }
        }
        if !settings.recent.is_empty() {
            ui.add_space(24.0);
            ui.label(RichText::new("Recent").strong());
        }
        for path in &settings.recent {
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            if ui.link(name).on_hover_text(path.display().to_string()).clicked() {
                chosen = Some(path.clone());
            }
        }
    });
    chosen
}
