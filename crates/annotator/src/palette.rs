//! The list of all commands: type a few letters, press Enter.

use egui::{Align2, Context, Id, Key, Modal, RichText, ScrollArea, TextEdit};

use crate::command::Command;
use crate::keys::KeyMap;

/// The list while it is open.
#[derive(Debug, Default)]
pub struct Palette {
    text: String,
    at: usize,
}

/// What came of a frame of the list.
pub enum Chosen {
    /// Still open.
    Nothing,
    /// Closed without a choice.
    Closed,
    /// This one.
    Command(Command),
}

/// Commands whose title holds the letters in their order, best first: whole words, then beginnings of words, then any.
fn matching(text: &str) -> Vec<Command> {
    let wanted = text.to_lowercase();
    let rank = |command: &Command| {
        let title = command.title().to_lowercase();
        let mut letters = title.chars();
        let in_order = wanted.chars().filter(|c| *c != ' ').all(|c| letters.any(|l| l == c));
        let at = title.find(wanted.trim());
        match (at, in_order) {
            (Some(0), _) => Some(0),
            (Some(_), _) => Some(1),
            (None, true) => Some(2),
            (None, false) => None,
        }
    };
    let mut found: Vec<(i32, Command)> =
        Command::ALL.iter().filter_map(|command| Some((rank(command)?, *command))).collect();
    found.sort_by_key(|(rank, _)| *rank);
    found.into_iter().map(|(_, command)| command).collect()
}

impl Palette {
    /// Draws the list. `why_not` says why a command cannot act now.
    pub fn show(
        &mut self,
        context: &Context,
        keys: &KeyMap,
        why_not: impl Fn(Command) -> Option<&'static str>,
    ) -> Chosen {
        let found = matching(&self.text);
        let mut chosen = Chosen::Nothing;
        let modal = Modal::new(Id::unique("palette"))
            .area(Modal::default_area(Id::unique("palette")).anchor(Align2::CENTER_TOP, [0.0, 80.0]));
        let response = modal.show(context, |ui| {
            ui.set_width(460.0);
            let edit = TextEdit::singleline(&mut self.text).hint_text("Command").desired_width(f32::INFINITY);
            let edit = ui.add(edit);
            edit.widget_info(|| {
                egui::WidgetInfo::labeled(egui::accesskit::Role::SearchInput, true, "Search commands")
            });
            edit.request_focus();
            if edit.changed() {
                self.at = 0;
            }
            let (down, up, enter) = ui.input(|i| {
                (i.num_presses(Key::ArrowDown), i.num_presses(Key::ArrowUp), i.key_pressed(Key::Enter))
            });
            self.at = (self.at + down).saturating_sub(up).min(found.len().saturating_sub(1));
            ScrollArea::vertical().max_height(360.0).show(ui, |ui| {
                for (at, command) in found.iter().enumerate() {
                    let response = row(ui, *command, keys, why_not(*command), at == self.at);
                    if at == self.at && down + up > 0 {
                        response.scroll_to_me(None);
                    }
                    if response.clicked() || (enter && at == self.at) {
                        chosen = Chosen::Command(*command);
                    }
                }
            });
        });
        match chosen {
            Chosen::Nothing if response.should_close() => Chosen::Closed,
            chosen => chosen,
        }
    }
}

fn row(
    ui: &mut egui::Ui,
    command: Command,
    keys: &KeyMap,
    why_not: Option<&'static str>,
    selected: bool,
) -> egui::Response {
    let title = RichText::new(command.title());
    let title = if why_not.is_some() { title.weak() } else { title };
    let button = egui::Button::selectable(selected, title).shortcut_text(keys.shown(command));
    let response = ui.add_sized([ui.available_width(), 22.0], button);
    match why_not {
        Some(why_not) => response.on_hover_text(why_not),
        None => response,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn letters_find_commands_best_first() {
        assert_eq!(matching("undo")[0], Command::Undo);
        assert!(matching("swap").contains(&Command::SwapHind));
        assert!(matching("prtr").contains(&Command::ProposeTracked));
        assert!(matching("zzzz").is_empty());
        assert_eq!(matching("").len(), Command::ALL.len());
    }
}
