//! The plates of a folder.

use std::path::{Path, PathBuf};

use egui::{Grid, ScrollArea, Ui};
use muybridge_capture::{Manifest, annotation_beside, locate_image};

/// One plate.
struct Plate {
    path: PathBuf,
    name: String,
    gait: String,
    has_annotation: bool,
    has_pictures: bool,
}

/// The plates of a folder and of its folder of specimens, by name.
pub(super) struct Shelf {
    folder: PathBuf,
    plates: Vec<Plate>,
}

impl Shelf {
    /// Reads the manifests; files that are none are left out.
    pub(super) fn read(folder: &Path) -> Self {
        let folders = [folder.to_path_buf(), folder.join("specimens")];
        let mut paths: Vec<PathBuf> = folders
            .iter()
            .filter_map(|folder| std::fs::read_dir(folder).ok())
            .flat_map(|entries| entries.filter_map(|entry| Some(entry.ok()?.path())))
            .filter(|path| path.extension().is_some_and(|ending| ending == "json"))
            .collect();
        paths.sort();
        Self { folder: folder.to_path_buf(), plates: paths.iter().filter_map(|path| plate(path)).collect() }
    }

    /// Draws the list; the plate that was chosen.
    pub(super) fn show(&self, ui: &mut Ui, filter: &str) -> Option<PathBuf> {
        let mut chosen = None;
        if self.plates.is_empty() {
            ui.label(format!("There is no plate in {}.", self.folder.display()));
        }
        ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
            Grid::new("shelf").num_columns(4).striped(true).spacing([14.0, 4.0]).show(ui, |ui| {
                for plate in self.plates.iter().filter(|plate| plate.name.to_lowercase().contains(filter)) {
                    if ui.button(&plate.name).on_hover_text(plate.path.display().to_string()).clicked() {
                        chosen = Some(plate.path.clone());
                    }
                    ui.label(&plate.gait);
                    ui.label(if plate.has_annotation { "annotated" } else { "" });
                    ui.label(if plate.has_pictures { "" } else { "picture not here" });
                    ui.end_row();
                }
            });
        });
        chosen
    }
}

fn plate(path: &Path) -> Option<Plate> {
    let manifest = Manifest::read(path).ok()?;
    Some(Plate {
        has_annotation: annotation_beside(path).exists(),
        has_pictures: manifest.images.iter().all(|image| locate_image(path, &image.file).exists()),
        gait: manifest.gait.to_string(),
        name: manifest.id,
        path: path.to_path_buf(),
    })
}
