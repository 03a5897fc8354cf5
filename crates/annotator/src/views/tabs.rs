//! The row of pages.

use egui::{Key, RichText, Ui};

use crate::app::PageContext;
use crate::command::Command;
use crate::session::{Page, Session};

const PAGES: [(Page, Command, &str); 5] = [
    (Page::Plate, Command::PagePlate, "1  Plate"),
    (Page::Calibrate, Command::PageCalibrate, "2  Calibrate"),
    (Page::Pose, Command::PagePose, "3  Pose"),
    (Page::Gait, Command::PageGait, "4  Gait"),
    (Page::Play, Command::PagePlay, "5  Play"),
];

/// The row: pages, and whatever is asked of the person before the rest makes sense.
pub fn show(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    if session.is_dragging() && ui.input(|input| input.key_pressed(Key::Escape)) {
        session.cancel();
    }
    ui.horizontal(|ui| {
        for (this, command, title) in PAGES {
            let button = egui::Button::selectable(session.page == this, RichText::new(title).size(15.0));
            let keys = page.settings.keys.shown(command);
            if ui.add(button).on_hover_text(keys).clicked() {
                page.commands.push(command);
            }
        }
        ui.separator();
        if session.draft().manifest.facing.is_none() && !session.panel_numbers().is_empty() {
            ui.label("Which way does the animal face?");
            for (title, facing) in
                [("Left", muybridge_capture::Facing::Left), ("Right", muybridge_capture::Facing::Right)]
            {
                if ui.button(title).clicked() {
                    session.edit("Facing", |draft| draft.manifest.facing = Some(facing));
                }
            }
        } else if let Some(pass) = &session.second_pass {
            ui.label(RichText::new(pass.headline(session)).strong());
        } else if session.panel_numbers().is_empty() {
            ui.label("No panels yet");
        } else {
            ui.label(format!("Panel {} of {}", session.panel, session.panel_numbers().len()));
        }
    });
}
