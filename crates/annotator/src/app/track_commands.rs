//! Tracks of footprints: opening, saving, and the questions about them that must be answered first.

use std::path::{Path, PathBuf};

use egui::{Context, Id, Key, Modal, Ui, ViewportCommand};
use muybridge_footprints::Track;

use super::dialogs::Dialog;
use super::{Annotator, Command};
use crate::footprints::document::{TrackDocument, TrackSaveError};
use crate::footprints::examples::Example;
use crate::footprints::safe_copy::{Left, left_behind};

/// What happens after a question about a track is answered.
pub(super) enum AfterTrack {
    /// Nothing: the track stays open.
    Stay,
    /// The program ends.
    Quit,
    /// The walk under way becomes the open track.
    KeepWalk,
    /// Another track is shown.
    Show(Box<TrackDocument>),
}

/// A question about a track.
pub(super) enum TrackQuestion {
    /// Work that was left unsaved by a crash.
    Recover(Vec<Left>),
    /// The open track has changes.
    Unsaved(AfterTrack),
    /// A file would be overwritten.
    Overwrite { trouble: String, path: PathBuf, after: AfterTrack },
    /// Where the track is to be saved.
    SaveAs { path: String, after: AfterTrack },
    /// Which file is to be opened, where the system has no dialog.
    Open(String),
}

/// An answer.
enum Answer {
    Save,
    DoNotSave,
    Path(PathBuf),
    TakeUp(usize),
    Discard(usize),
    Cancel,
}

impl Annotator {
    /// Commands about tracks; false when it is none.
    pub(super) fn run_on_tracks(&mut self, context: &Context, command: Command) -> bool {
        use Command as C;
        let is_open = self.footprints.is_open();
        match command {
            C::PageFootprints => self.open_footprints(context),
            C::Save if is_open => self.save_track(context, AfterTrack::Stay),
            C::SaveAs if is_open => self.ask_track_name(AfterTrack::Stay),
            C::FootprintsKeepWalk => self.go_to_track(context, AfterTrack::KeepWalk),
            command => match example_of(command) {
                Some(example) => self.show_track(context, TrackDocument::new(example.track())),
                None => return self.footprints.run(command),
            },
        }
        true
    }

    /// Goes to the page; the first time, what was left behind is offered.
    fn open_footprints(&mut self, context: &Context) {
        self.ride.close();
        let left = self.places.tracks().map(|folder| left_behind(&folder)).unwrap_or_default();
        self.footprints.open(context, self.places.tracks());
        if !left.is_empty() {
            self.dialog = Some(Dialog::Track(TrackQuestion::Recover(left)));
        }
    }

    /// Says at the start that a track was left behind.
    pub(super) fn mention_tracks_left(&mut self) {
        let left = self.places.tracks().map(|folder| left_behind(&folder)).unwrap_or_default();
        if let Some(first) = left.first() {
            let name = first.name();
            self.messages.note(format!("There is unsaved work on {name}: the Footprints page (F7) has it"));
        }
    }

    /// Shows a track that was read from a file.
    pub(super) fn offer_track(&mut self, context: &Context, track: Track, path: &Path) {
        self.open_footprints(context);
        self.settings.remember(path);
        self.write_settings();
        self.show_track(context, TrackDocument::of_file(track, path));
    }

    /// Shows another track, after asking about changes of the open one.
    fn show_track(&mut self, context: &Context, document: TrackDocument) {
        self.go_to_track(context, AfterTrack::Show(Box::new(document)));
    }

    fn go_to_track(&mut self, context: &Context, after: AfterTrack) {
        if self.footprints.has_unsaved_work() {
            self.ask_to_save_track(after);
        } else {
            self.after_track(context, after);
        }
    }

    pub(super) fn ask_to_save_track(&mut self, after: AfterTrack) {
        self.dialog = Some(Dialog::Track(TrackQuestion::Unsaved(after)));
    }

    pub(super) fn ask_track_path(&mut self) {
        self.dialog = Some(Dialog::Track(TrackQuestion::Open(String::new())));
    }

    fn ask_track_name(&mut self, after: AfterTrack) {
        let document = &self.footprints.editor().document;
        let path = document.path().map(|path| path.display().to_string());
        let name = document.name().to_lowercase().replace([' ', ',', '/'], "-").replace("--", "-");
        let path = path.unwrap_or_else(|| format!("{name}.json"));
        self.dialog = Some(Dialog::Track(TrackQuestion::SaveAs { path, after }));
    }

    fn save_track(&mut self, context: &Context, after: AfterTrack) {
        match self.footprints.editor().document.path().map(Path::to_path_buf) {
            Some(path) => self.save_track_as(context, &path, false, after),
            None => self.ask_track_name(after),
        }
    }

    fn save_track_as(&mut self, context: &Context, path: &Path, overwrite: bool, after: AfterTrack) {
        match self.footprints.editor_mut().document.save_as(path, overwrite) {
            Ok(()) => {
                self.messages.note(format!("Saved {}", path.display()));
                self.settings.remember(path);
                self.write_settings();
                self.after_track(context, after);
            }
            Err(error @ TrackSaveError::ChangedOnDisk(_)) => {
                let (trouble, path) = (error.to_string(), path.to_path_buf());
                self.dialog = Some(Dialog::Track(TrackQuestion::Overwrite { trouble, path, after }));
            }
            Err(error) => self.messages.trouble(error.to_string()),
        }
    }

    fn after_track(&mut self, context: &Context, after: AfterTrack) {
        match after {
            AfterTrack::Stay => {}
            AfterTrack::Quit => {
                self.close_session();
                self.may_close = true;
                context.send_viewport_cmd(ViewportCommand::Close);
            }
            AfterTrack::KeepWalk => {
                if let Some(document) = self.footprints.take_walk() {
                    self.footprints.show_document(document);
                }
            }
            AfterTrack::Show(document) => self.footprints.show_document(*document),
        }
    }

    /// Asks, and does what is answered.
    pub(super) fn ask_about_track(&mut self, context: &Context, mut question: TrackQuestion) {
        let mut answer = None;
        let modal = Modal::new(Id::unique("track dialog")).show(context, |ui| {
            ui.set_width(480.0);
            answer = match &mut question {
                TrackQuestion::Recover(left) => ask_recover(ui, left),
                TrackQuestion::Unsaved(_) => {
                    ui.heading("Save the track?");
                    ui.label("The open track of footprints has changes that are not saved.");
                    buttons(ui, &[("Save it", 0), ("Do not save", 1), ("Cancel", 2)])
                }
                TrackQuestion::Overwrite { trouble, .. } => {
                    ui.heading("Overwrite the file?");
                    ui.label(trouble.as_str());
                    buttons(ui, &[("Overwrite it", 0), ("Cancel", 2)])
                }
                TrackQuestion::SaveAs { path, .. } => ask_path(ui, path, "Save the track as", "Save here"),
                TrackQuestion::Open(path) => ask_path(ui, path, "Open a track", "Open it"),
            };
        });
        let escaped = !matches!(question, TrackQuestion::Recover(_)) && modal.should_close();
        match answer.or(escaped.then_some(Answer::Cancel)) {
            Some(answer) => self.take_track_answer(context, question, answer),
            None => self.dialog = Some(Dialog::Track(question)),
        }
    }

    fn take_track_answer(&mut self, context: &Context, question: TrackQuestion, answer: Answer) {
        match (question, answer) {
            (TrackQuestion::Unsaved(after), Answer::Save) => self.save_track(context, after),
            (TrackQuestion::Unsaved(after), Answer::DoNotSave) => {
                self.footprints.editor_mut().document.discard();
                self.after_track(context, after);
            }
            (TrackQuestion::Overwrite { path, after, .. }, Answer::Save) => {
                self.save_track_as(context, &path, true, after);
            }
            (TrackQuestion::SaveAs { after, .. }, Answer::Path(path)) => {
                self.save_track_as(context, &path, false, after);
            }
            (TrackQuestion::Open(_), Answer::Path(path)) => self.open(context, &path),
            (TrackQuestion::Recover(left), Answer::TakeUp(one)) => self.take_up(context, &left, one),
            (TrackQuestion::Recover(mut left), Answer::Discard(one)) => {
                if one < left.len() {
                    left.remove(one).discard();
                }
                if !left.is_empty() {
                    self.dialog = Some(Dialog::Track(TrackQuestion::Recover(left)));
                }
            }
            _ => {}
        }
    }

    /// Takes up what was left behind: it is kept safe again before the old copy goes.
    fn take_up(&mut self, context: &Context, left: &[Left], one: usize) {
        let Some(chosen) = left.get(one) else { return };
        if self.footprints.has_unsaved_work() {
            self.messages.trouble("Save the open track first; the other one is offered again");
            return;
        }
        self.after_track(context, AfterTrack::Show(Box::new(TrackDocument::recovered(chosen))));
        if self.footprints.editor().document.safe_copy_fault().is_none() {
            chosen.discard();
        }
    }
}

/// The example that a command begins with.
fn example_of(command: Command) -> Option<Example> {
    use Command as C;
    Some(match command {
        C::FootprintsNewBird => Example::WalkingBird,
        C::FootprintsNewStairs => Example::Stairs,
        C::FootprintsNewLeaps => Example::Leaps,
        C::FootprintsNewRunner => Example::Runner,
        C::FootprintsNewTimed => Example::AutomaticTiming,
        C::FootprintsNewPath => Example::Path,
        C::FootprintsNewTrot => Example::Trot,
        C::FootprintsNewRiver => Example::River,
        C::FootprintsNewEmpty => Example::Empty,
        _ => return None,
    })
}

fn buttons(ui: &mut Ui, choices: &[(&str, usize)]) -> Option<Answer> {
    let mut answer = None;
    ui.horizontal(|ui| {
        for (text, choice) in choices {
            if ui.button(*text).clicked() {
                answer = Some(match choice {
                    0 => Answer::Save,
                    1 => Answer::DoNotSave,
                    _ => Answer::Cancel,
                });
            }
        }
    });
    answer
}

fn ask_path(ui: &mut Ui, path: &mut String, heading: &str, button: &str) -> Option<Answer> {
    ui.heading(heading);
    let edit = ui.add(egui::TextEdit::singleline(path).desired_width(f32::INFINITY));
    edit.widget_info(|| {
        egui::WidgetInfo::labeled(egui::accesskit::Role::TextInput, true, "Path of the track")
    });
    let entered = edit.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter));
    let mut answer = None;
    ui.horizontal(|ui| {
        let can = !path.trim().is_empty();
        if ui.add_enabled(can, egui::Button::new(button)).clicked() || (entered && can) {
            answer = Some(Answer::Path(PathBuf::from(path.trim())));
        }
        if ui.button("Cancel").clicked() {
            answer = Some(Answer::Cancel);
        }
    });
    answer
}

fn ask_recover(ui: &mut Ui, left: &[Left]) -> Option<Answer> {
    ui.heading("There are unsaved footprints");
    ui.label("The program ended before this was saved.");
    let mut answer = None;
    for (i, one) in left.iter().enumerate() {
        ui.separator();
        ui.label(egui::RichText::new(one.name()).strong());
        ui.label(format!("{} prints, {}", one.record.track.prints.len(), one.record.track.model));
        ui.horizontal(|ui| {
            if ui.button(format!("Take up {}", one.name())).clicked() {
                answer = Some(Answer::TakeUp(i));
            }
            if ui.button("Discard").on_hover_text("The changes are gone for good").clicked() {
                answer = Some(Answer::Discard(i));
            }
        });
    }
    ui.separator();
    if ui.button("Decide later").clicked() {
        answer = Some(Answer::Cancel);
    }
    answer
}
