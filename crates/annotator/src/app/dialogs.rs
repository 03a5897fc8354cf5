//! Questions that must be answered before anything else happens.

use std::path::PathBuf;

use egui::{Context, Id, Key, Modal, Ui};
use muybridge_capture::{Document, Waiting, discard};

use super::Annotator;
use super::track_commands::TrackQuestion;

/// What happens after a question is answered.
pub(super) enum After {
    /// Nothing: the plate stays open.
    Stay,
    /// The plate is closed.
    Close,
    /// The program ends.
    Quit,
    /// Another path is opened.
    Open(PathBuf),
    /// A specimen is opened.
    OpenSpecimen,
    /// A document that is open already is shown.
    Show(Box<Document>),
}

/// A question.
pub(super) enum Dialog {
    /// Work that was left unsaved by a crash.
    Recover(Vec<Waiting>),
    /// The open plate has changes.
    Unsaved(After),
    /// A file on disk would be overwritten; where the annotation is saved, if elsewhere.
    Overwrite { trouble: String, save_as: Option<PathBuf>, after: After },
    /// Another name for the annotation.
    SaveAs(String),
    /// About a track of footprints.
    Track(TrackQuestion),
}

/// An answer.
enum Answer {
    Recover(Waiting),
    OpenSaved(Waiting),
    Discard(Waiting),
    Save,
    DoNotSave,
    Overwrite,
    SaveAs(PathBuf),
    Cancel,
}

impl Annotator {
    pub(super) fn show_dialog(&mut self, context: &Context) {
        let Some(mut dialog) = self.dialog.take() else { return };
        if let Dialog::Track(question) = dialog {
            self.ask_about_track(context, question);
            return;
        }
        let mut answer = None;
        let modal = Modal::new(Id::unique("dialog")).show(context, |ui| {
            ui.set_width(480.0);
            answer = match &mut dialog {
                Dialog::Recover(waiting) => ask_recover(ui, waiting),
                Dialog::Unsaved(_) => ask_unsaved(ui),
                Dialog::Overwrite { trouble, .. } => ask_overwrite(ui, trouble),
                Dialog::SaveAs(path) => ask_save_as(ui, path),
                Dialog::Track(_) => None,
            };
        });
        // Work that was left behind is not decided upon by a stray key.
        let escaped = !matches!(dialog, Dialog::Recover(_)) && modal.should_close();
        match answer.or(escaped.then_some(Answer::Cancel)) {
            Some(answer) => self.take_answer(context, dialog, answer),
            None => self.dialog = Some(dialog),
        }
    }

    fn take_answer(&mut self, context: &Context, dialog: Dialog, answer: Answer) {
        match (dialog, answer) {
            (Dialog::Recover(waiting), answer) => self.take_recovery(context, waiting, answer),
            (Dialog::Unsaved(after), Answer::Save) => self.save(context, false, after),
            (Dialog::Unsaved(after), Answer::DoNotSave) => {
                self.discard_session();
                self.go_on(context, after);
            }
            (Dialog::Unsaved(After::Show(document)), _) => document.close(),
            (Dialog::Overwrite { save_as: None, after, .. }, Answer::Overwrite) => {
                self.save(context, true, after);
            }
            (Dialog::Overwrite { save_as: Some(path), after, .. }, Answer::Overwrite) => {
                self.save_as(context, path, true, after);
            }
            (Dialog::SaveAs(_), Answer::SaveAs(path)) => self.save_as(context, path, false, After::Stay),
            _ => {}
        }
    }

    fn take_recovery(&mut self, context: &Context, mut waiting: Vec<Waiting>, answer: Answer) {
        match answer {
            Answer::Recover(chosen) => match Document::recover(&chosen.journal_path) {
                Ok(document) => self.show_document(context, document),
                Err(error) => self.messages.trouble(error.to_string()),
            },
            Answer::OpenSaved(chosen) => match discard(&chosen.journal_path) {
                Ok(()) => self.open(context, &chosen.annotation_path),
                Err(error) => self.messages.trouble(error.to_string()),
            },
            Answer::Discard(chosen) => {
                if let Err(error) = discard(&chosen.journal_path) {
                    self.messages.trouble(error.to_string());
                }
                waiting.retain(|other| *other != chosen);
                if !waiting.is_empty() {
                    self.dialog = Some(Dialog::Recover(waiting));
                }
            }
            _ => {}
        }
    }
}

fn ask_recover(ui: &mut Ui, waiting: &[Waiting]) -> Option<Answer> {
    ui.heading("There is unsaved work");
    ui.label("The program ended before this was saved. Every change up to that moment is still there, and can still be undone.");
    let mut answer = None;
    for one in waiting {
        ui.separator();
        ui.label(egui::RichText::new(&one.plate).strong());
        ui.label(format!("{} changes, {}", one.changes, one.annotation_path.display()));
        ui.horizontal(|ui| {
            if ui.button(format!("Take up {}", one.plate)).clicked() {
                answer = Some(Answer::Recover(one.clone()));
            }
            if one.annotation_path.exists() && ui.button("Open the saved file instead").clicked() {
                answer = Some(Answer::OpenSaved(one.clone()));
            }
            if ui.button("Discard").on_hover_text("The changes are gone for good").clicked() {
                answer = Some(Answer::Discard(one.clone()));
            }
        });
    }
    ui.separator();
    if ui.button("Decide later").clicked() {
        answer = Some(Answer::Cancel);
    }
    answer
}

fn ask_unsaved(ui: &mut Ui) -> Option<Answer> {
    ui.heading("Save the changes?");
    ui.label("The open plate has changes that are not saved.");
    let mut answer = None;
    ui.horizontal(|ui| {
        for (text, choice) in
            [("Save them", Answer::Save), ("Do not save", Answer::DoNotSave), ("Cancel", Answer::Cancel)]
        {
            if ui.button(text).clicked() {
                answer = Some(choice);
            }
        }
    });
    answer
}

fn ask_overwrite(ui: &mut Ui, trouble: &str) -> Option<Answer> {
    ui.heading("Overwrite the file?");
    ui.label(trouble);
    let mut answer = None;
    ui.horizontal(|ui| {
        if ui.button("Overwrite it").clicked() {
            answer = Some(Answer::Overwrite);
        }
        if ui.button("Cancel").clicked() {
            answer = Some(Answer::Cancel);
        }
    });
    answer
}

fn ask_save_as(ui: &mut Ui, path: &mut String) -> Option<Answer> {
    ui.heading("Save the annotation as");
    let edit = ui.add(egui::TextEdit::singleline(path).desired_width(f32::INFINITY));
    edit.widget_info(|| {
        egui::WidgetInfo::labeled(egui::accesskit::Role::TextInput, true, "Path of the annotation")
    });
    let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    let mut answer = None;
    ui.horizontal(|ui| {
        if ui.button("Save here").clicked() || entered {
            answer = Some(Answer::SaveAs(PathBuf::from(path.trim())));
        }
        if ui.button("Cancel").clicked() {
            answer = Some(Answer::Cancel);
        }
    });
    answer
}
