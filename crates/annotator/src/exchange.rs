//! Import and export of points in the window: format, place, and what the format cannot hold.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use egui::{Align2, ComboBox, Context, TextEdit, Ui, Window};
use muybridge_capture::exchange::{
    Existing, ExportOptions, Format, ImportFile, LARGEST_FILE_BYTES, Merged, export, import,
};
use muybridge_capture::write_atomically;
use muybridge_imaging::Cutouts;

use crate::session::Session;
use crate::toast::Messages;

/// Which way points go.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Way {
    In,
    Out,
}

/// The window while it is open.
pub struct ExchangeWindow {
    way: Way,
    /// None: what the file looks like.
    format: Option<Format>,
    path: String,
    replace: bool,
    notes: Vec<String>,
}

impl ExchangeWindow {
    /// Points from a file.
    pub fn import(_session: &Session) -> Self {
        Self { way: Way::In, format: None, path: String::new(), replace: false, notes: Vec::new() }
    }

    /// Points into files: of a folder beside the annotation, unless another is named.
    pub fn export(session: &Session) -> Self {
        let annotation = session.document.annotation_path();
        let stem = annotation.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let folder = annotation.parent().unwrap_or(Path::new(".")).join(format!("{stem}-export"));
        let path = folder.display().to_string();
        Self { way: Way::Out, format: Some(Format::DeepLabCut), path, replace: false, notes: Vec::new() }
    }

    /// Draws the window; false when it is closed.
    pub fn show(&mut self, context: &Context, session: &mut Session, messages: &mut Messages) -> bool {
        let mut open = true;
        let title = if self.way == Way::In { "Import points" } else { "Export points" };
        let window = Window::new(title).open(&mut open).collapsible(false).default_width(520.0);
        window.pivot(Align2::CENTER_CENTER).default_pos(context.content_rect().center()).show(
            context,
            |ui| {
                self.form(ui);
                let go = if self.way == Way::In { "Import" } else { "Export" };
                if ui.button(go).clicked() {
                    let done = match self.way {
                        Way::In => self.take_in(session),
                        Way::Out => self.put_out(session),
                    };
                    match done {
                        Ok(text) => messages.note(text),
                        Err(trouble) => messages.trouble(trouble),
                    }
                }
                for note in &self.notes {
                    ui.label(note);
                }
            },
        );
        open
    }

    fn form(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.label("Format");
            let shown = self.format.map_or("what the file looks like", Format::name);
            let list = ComboBox::from_id_salt("format").selected_text(shown).show_ui(ui, |ui| {
                if self.way == Way::In {
                    ui.selectable_value(&mut self.format, None, "what the file looks like");
                }
                for format in Format::ALL {
                    ui.selectable_value(&mut self.format, Some(format), format.name());
                }
            });
            let name = format!("Format: {shown}");
            list.response
                .widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::ComboBox, true, &name));
        });
        let what = if self.way == Way::In { "File, or folder of labelme files" } else { "Folder" };
        ui.label(what);
        let edit = ui.add(TextEdit::singleline(&mut self.path).desired_width(f32::INFINITY));
        edit.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::TextInput, true, what));
        let replace = match self.way {
            Way::In => "Replace points that were placed by hand, too",
            Way::Out => "Write over files that are there",
        };
        ui.checkbox(&mut self.replace, replace);
    }

    fn put_out(&mut self, session: &Session) -> Result<String, String> {
        let draft = session.document.draft();
        let (format, options) = (self.format.unwrap_or(Format::Csv), ExportOptions::default());
        let cutouts = Cutouts::new(&draft.manifest);
        let exported = export(&draft.manifest, &draft.annotation, &cutouts, format, &options)
            .map_err(|error| error.to_string())?;
        let folder = PathBuf::from(self.path.trim());
        let files: Vec<(PathBuf, Vec<u8>)> =
            exported.files.into_iter().map(|(name, content)| (folder.join(name), content)).collect();
        let differs = |(path, content): &&(PathBuf, Vec<u8>)| {
            path.exists() && !std::fs::read(path).is_ok_and(|old| old == *content)
        };
        if let Some((path, _)) = files.iter().find(differs).filter(|_| !self.replace) {
            return Err(format!("{}: is there already and differs; choose another folder", path.display()));
        }
        for (path, content) in &files {
            let parent = path.parent().unwrap_or(Path::new("."));
            std::fs::create_dir_all(parent).map_err(|error| format!("{}: {error}", parent.display()))?;
            write_atomically(path, content).map_err(|error| error.to_string())?;
        }
        self.notes = exported.notes;
        let count = files.len();
        let word = if count == 1 { "file" } else { "files" };
        Ok(format!("{count} {word} written to {}", folder.display()))
    }

    fn take_in(&mut self, session: &mut Session) -> Result<String, String> {
        let files = read_files(Path::new(self.path.trim()))?;
        let manifest = &session.document.draft().manifest;
        let imported = import(&files, self.format, manifest, &Cutouts::new(manifest), &BTreeMap::new())
            .map_err(|error| error.to_string())?;
        self.notes = imported.notes.clone();
        if imported.point_count() == 0 {
            return Err("No point could be taken over; the window says why".into());
        }
        let existing = if self.replace { Existing::Replace } else { Existing::KeepHand };
        let mut merged = Merged::default();
        session.edit("Import points", |draft| merged = imported.merge_into(&mut draft.annotation, existing));
        let Merged { added, replaced, same, kept } = merged;
        Ok(format!(
            "{added} points added, {replaced} replaced, {same} as before, {kept} left away where one was placed by hand"
        ))
    }
}

/// A file, or the JSON files of a folder by name; of each no more is read than can be used.
fn read_files(path: &Path) -> Result<Vec<ImportFile>, String> {
    let unreadable = |error: std::io::Error| format!("{}: cannot be read ({error})", path.display());
    let mut paths = vec![path.to_path_buf()];
    if path.is_dir() {
        let entries = std::fs::read_dir(path).map_err(unreadable)?;
        paths = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
        paths.retain(|file| file.extension().is_some_and(|ending| ending == "json"));
        paths.sort();
    }
    let read = |path: &PathBuf| {
        let mut content = Vec::new();
        let file = std::fs::File::open(path).map_err(unreadable)?;
        file.take(LARGEST_FILE_BYTES as u64 + 1).read_to_end(&mut content).map_err(unreadable)?;
        Ok(ImportFile { name: path.display().to_string(), content })
    };
    paths.iter().map(read).collect()
}
