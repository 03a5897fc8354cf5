//! Plates to choose from: those of a folder, and those of the catalogue, fetched or not.

mod catalogue;
mod shelf;

use std::path::{Path, PathBuf};

use egui::{Align2, Context, TextEdit, Ui, Window, vec2};

use crate::toast::Messages;
use catalogue::CatalogueList;
use shelf::Shelf;

/// The two lists.
#[derive(Clone, Copy, PartialEq, Eq)]
enum List {
    Folder,
    Catalogue,
}

/// The window while it is open.
pub struct Browser {
    list: List,
    path: String,
    filter: String,
    shelf: Shelf,
    catalogue: CatalogueList,
}

impl Browser {
    /// Plates of a folder and its folder of specimens, and of the catalogue in it.
    pub fn new(folder: &Path) -> Self {
        Self {
            list: List::Folder,
            path: String::new(),
            filter: String::new(),
            shelf: Shelf::read(folder),
            catalogue: CatalogueList::read(folder),
        }
    }

    /// Draws the window: a path to open, and whether the window stays.
    pub fn show(&mut self, context: &Context, messages: &mut Messages) -> (Option<PathBuf>, bool) {
        let (mut stays, mut chosen) = (true, self.catalogue.finish(messages));
        let window = Window::new("Plates").open(&mut stays).collapsible(false).default_size([620.0, 480.0]);
        window.pivot(Align2::CENTER_CENTER).default_pos(context.content_rect().center()).show(
            context,
            |ui| {
                chosen = chosen.take().or(self.path_line(ui));
                ui.horizontal(|ui| {
                    ui.selectable_value(&mut self.list, List::Folder, "On this machine");
                    ui.selectable_value(&mut self.list, List::Catalogue, "Animal Locomotion, 1887");
                    let filter =
                        TextEdit::singleline(&mut self.filter).hint_text("Search").desired_width(160.0);
                    named(ui.add(filter), "Search plates");
                });
                ui.separator();
                let filter = self.filter.to_lowercase();
                chosen = chosen.take().or(match self.list {
                    List::Folder => self.shelf.show(ui, &filter),
                    List::Catalogue => self.catalogue.show(ui, &filter),
                });
            },
        );
        let stays = stays && chosen.is_none();
        (chosen, stays)
    }

    /// Any path, for systems without a file dialog.
    fn path_line(&mut self, ui: &mut Ui) -> Option<PathBuf> {
        let mut chosen = None;
        ui.horizontal(|ui| {
            ui.label("Path");
            let edit = TextEdit::singleline(&mut self.path)
                .hint_text("a picture, a folder of frames, a manifest or an annotation")
                .desired_width(ui.available_width() - 70.0);
            let edit = named(ui.add(edit), "Path to open");
            let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            if (ui.add_sized(vec2(60.0, 20.0), egui::Button::new("Open it")).clicked() || entered)
                && !self.path.trim().is_empty()
            {
                chosen = Some(PathBuf::from(self.path.trim()));
            }
        });
        chosen
    }
}

/// A text field with a name for those who do not see it.
fn named(response: egui::Response, name: &str) -> egui::Response {
    response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::TextInput, true, name));
    response
}
