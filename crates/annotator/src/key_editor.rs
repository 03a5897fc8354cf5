//! Choosing keys: click a command's key, press another.

use egui::{Align2, Context, Key, ScrollArea, Window};

use crate::command::{Command, Menu};
use crate::keys::{KeyMap, pressed, to_words};

/// The window while it is open.
#[derive(Debug, Default)]
pub struct KeyEditor {
    waiting: Option<Command>,
    note: String,
}

impl KeyEditor {
    /// Draws the window; false when it is closed.
    pub fn show(&mut self, context: &Context, keys: &mut KeyMap) -> bool {
        if let Some(command) = self.waiting {
            self.take_key(context, command, keys);
        }
        let mut open = true;
        let window = Window::new("Keys").open(&mut open).collapsible(false).default_width(480.0);
        window.anchor(Align2::CENTER_CENTER, [0.0, 0.0]).show(context, |ui| {
            ui.label(
                "Click a key, then press the one you want. A key does one thing: another command loses it.",
            );
            ui.horizontal(|ui| {
                if ui.button("All defaults").clicked() {
                    keys.reset_all();
                    self.note.clear();
                }
                ui.label(&self.note);
            });
            ui.separator();
            ScrollArea::vertical().max_height(420.0).show(ui, |ui| {
                for (menu, title) in Menu::ALL {
                    ui.heading(title);
                    self.menu(ui, menu, keys);
                }
            });
        });
        open
    }

    fn menu(&mut self, ui: &mut egui::Ui, menu: Menu, keys: &mut KeyMap) {
        egui::Grid::new(("keys", menu as usize)).num_columns(3).striped(true).show(ui, |ui| {
            for command in Command::ALL.iter().copied().filter(|c| c.description().menu == menu) {
                ui.label(command.title());
                let words: Vec<_> = keys.keys(command).iter().map(to_words).collect();
                let shown = match (self.waiting == Some(command), words.is_empty()) {
                    (true, _) => "press a key…".into(),
                    (false, true) => "none".into(),
                    (false, false) => words.join("  or  "),
                };
                let button = ui.button(shown);
                let name = format!("Key of {}", command.title());
                button.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Button, true, &name));
                if button.clicked() {
                    self.waiting = Some(command);
                }
                if ui.small_button("default").clicked() {
                    keys.reset(command);
                }
                ui.end_row();
            }
        });
    }

    fn take_key(&mut self, context: &Context, command: Command, keys: &mut KeyMap) {
        let Some(key) = context.input(|input| input.events.iter().find_map(pressed)) else { return };
        context.input_mut(|input| input.consume_key(key.modifiers, key.logical_key));
        self.waiting = None;
        if key.logical_key == Key::Escape {
            return;
        }
        let loser = keys.choose(command, key);
        self.note = match loser {
            Some(loser) => format!("{} was “{}”, which has no key now", to_words(&key), loser.title()),
            None => String::new(),
        };
    }
}
