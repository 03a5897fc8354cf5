//! The menu bar: every command with its key, and what is under way.

use std::path::PathBuf;

use egui::{Button, RichText, Ui};

use super::{Annotator, Command, Session};
use crate::command::Menu;
use crate::toast::trouble_color;

impl Annotator {
    /// The bar; a recent plate that was chosen.
    pub(super) fn menu_bar(&self, ui: &mut Ui, commands: &mut Vec<Command>) -> Option<PathBuf> {
        let mut chosen = None;
        egui::MenuBar::new().ui(ui, |ui| {
            for (menu, title) in Menu::ALL {
                ui.menu_button(title, |ui| {
                    self.menu(ui, menu, commands);
                    if menu == Menu::File && !self.settings.recent.is_empty() {
                        ui.separator();
                        chosen = self.recent(ui);
                    }
                });
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| self.status(ui));
        });
        chosen
    }

    fn recent(&self, ui: &mut Ui) -> Option<PathBuf> {
        let mut chosen = None;
        for path in &self.settings.recent {
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            let button = Button::new(format!("Recent: {name}"));
            if ui.add(button).on_hover_text(path.display().to_string()).clicked() {
                chosen = Some(path.clone());
                ui.close();
            }
        }
        chosen
    }

    fn menu(&self, ui: &mut Ui, menu: Menu, commands: &mut Vec<Command>) {
        ui.set_min_width(260.0);
        for command in Command::ALL.iter().copied().filter(|command| command.description().menu == menu) {
            let why_not = self.why_not(command);
            let button =
                Button::new(self.menu_title(command)).shortcut_text(self.settings.keys.shown(command));
            let response = ui.add_enabled(why_not.is_none(), button);
            if let Some(why_not) = why_not {
                response.on_disabled_hover_text(why_not);
            } else if response.clicked() {
                commands.push(command);
                ui.close();
            }
        }
    }

    /// A command's title, with what it would act on or a tick.
    fn menu_title(&self, command: Command) -> String {
        let title = command.title();
        let Some(session) = &self.session else { return title.into() };
        let step = match command {
            Command::Undo => session.document.undo_label(),
            Command::Redo => session.document.redo_label(),
            _ => None,
        };
        match (step, self.is_on(command)) {
            (Some(step), _) => format!("{title}: {step}"),
            (None, Some(true)) => format!("[x] {title}"),
            (None, Some(false)) => format!("[  ] {title}"),
            (None, None) => title.into(),
        }
    }

    /// Name of the plate, whether it is saved, and what is under way.
    fn status(&self, ui: &mut Ui) {
        if let Some(session) = &self.session {
            let mark = match (session.document.is_changed(), session.document.is_new()) {
                (true, _) => "not saved",
                (false, true) => "new",
                (false, false) => "saved",
            };
            ui.label(RichText::new(mark).weak());
            let path = session.document.annotation_path();
            let name = path.file_stem().unwrap_or_default().to_string_lossy();
            ui.label(RichText::new(name).strong()).on_hover_text(path.display().to_string());
            if let Some(fault) = session.document.journal_fault() {
                let text = RichText::new("changes are not protected against a crash");
                ui.label(text.color(trouble_color(ui.visuals().dark_mode))).on_hover_text(fault);
            }
        }
        let session_work = self.session.as_ref().and_then(Session::work_under_way);
        let opening = self.opening.as_ref().map(|job| job.what.clone());
        if let Some(work) = opening.or(session_work) {
            ui.spinner();
            ui.label(work);
        }
    }
}
