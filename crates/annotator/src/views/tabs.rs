//! The row of pages.

use egui::{Key, RichText, Ui};

use crate::app::PageContext;
use crate::command::Command;
use crate::session::{Page, Session};

/// The pages with their commands; the Ride page is none of the plate's.
const PAGES: [(Option<Page>, Command, &str); 6] = [
    (Some(Page::Plate), Command::PagePlate, "1  Plate"),
    (Some(Page::Calibrate), Command::PageCalibrate, "2  Calibrate"),
    (Some(Page::Pose), Command::PagePose, "3  Pose"),
    (Some(Page::Gait), Command::PageGait, "4  Gait"),
    (Some(Page::Play), Command::PagePlay, "5  Play"),
    (None, Command::PageRide, "6  Ride"),
];

fn pages(ui: &mut Ui, shown: Option<Page>, has_plate: bool, page: &mut PageContext<'_>) {
    for (this, command, title) in PAGES {
        let button = egui::Button::selectable(shown == this, RichText::new(title).size(15.0));
        let keys = page.settings.keys.shown(command);
        let response = ui.add_enabled(has_plate || this.is_none(), button);
        if response.on_hover_text(keys).on_disabled_hover_text("Open a plate first").clicked() {
            page.commands.push(command);
        }
    }
    ui.separator();
}

/// The row while the Ride page is looked at.
pub fn show_riding(ui: &mut Ui, has_plate: bool, page: &mut PageContext<'_>) {
    ui.horizontal(|ui| {
        pages(ui, None, has_plate, page);
        let (text, key) = (
            if has_plate { "Back to the plate" } else { "Back" },
            page.settings.keys.shown(Command::RideLeave),
        );
        if ui.button(text).on_hover_text(key).clicked() {
            page.commands.push(Command::RideLeave);
        }
    });
}

/// The row: pages, and whatever is asked of the person before the rest makes sense.
pub fn show(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    if session.is_dragging() && ui.input(|input| input.key_pressed(Key::Escape)) {
        session.cancel();
    }
    ui.horizontal(|ui| {
        pages(ui, Some(session.page), true, page);
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
