//! The row of pages.

use egui::{Key, RichText, Ui};

use crate::app::PageContext;
use crate::command::Command;
use crate::session::{Page, Session};

/// The pages with their commands, and whether they are the plate's.
const PAGES: [(Command, &str, bool); 7] = [
    (Command::PagePlate, "1  Plate", true),
    (Command::PageCalibrate, "2  Calibrate", true),
    (Command::PagePose, "3  Pose", true),
    (Command::PageGait, "4  Gait", true),
    (Command::PagePlay, "5  Play", true),
    (Command::PageRide, "6  Ride", false),
    (Command::PageFootprints, "7  Footprints", false),
];

/// The command that goes to a page of the plate.
fn command_of(page: Page) -> Command {
    match page {
        Page::Plate => Command::PagePlate,
        Page::Calibrate => Command::PageCalibrate,
        Page::Pose => Command::PagePose,
        Page::Gait => Command::PageGait,
        Page::Play => Command::PagePlay,
    }
}

fn pages(ui: &mut Ui, shown: Command, has_plate: bool, page: &mut PageContext<'_>) {
    for (command, title, is_plates) in PAGES {
        let button = egui::Button::selectable(shown == command, RichText::new(title).size(15.0));
        let keys = page.settings.keys.shown(command);
        let response = ui.add_enabled(has_plate || !is_plates, button);
        if response.on_hover_text(keys).on_disabled_hover_text("Open a plate first").clicked() {
            page.commands.push(command);
        }
    }
    ui.separator();
}

/// The row while a page is looked at that is none of the plate's: its command, and the one that leaves it.
pub fn show_other(
    ui: &mut Ui,
    (shown, leave): (Command, Command),
    has_plate: bool,
    page: &mut PageContext<'_>,
) {
    ui.horizontal(|ui| {
        pages(ui, shown, has_plate, page);
        let text = if has_plate { "Back to the plate" } else { "Back" };
        if ui.button(text).on_hover_text(page.settings.keys.shown(leave)).clicked() {
            page.commands.push(leave);
        }
    });
}

/// The row: pages, and whatever is asked of the person before the rest makes sense.
pub fn show(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    if session.is_dragging() && ui.input(|input| input.key_pressed(Key::Escape)) {
        session.cancel();
    }
    ui.horizontal(|ui| {
        pages(ui, command_of(session.page), true, page);
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
