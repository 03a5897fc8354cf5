//! Commands that open, save and close.

use std::path::PathBuf;
use std::time::{Duration, Instant};

use egui::{Context, ViewportCommand};
use muybridge_capture::SaveError;

use super::dialogs::{After, Dialog};
use super::track_commands::AfterTrack;
use super::{Annotator, Browser};
use crate::job::Job;
use crate::specimen;

/// A dialog that is gone after this was never there.
const NO_DIALOG: Duration = Duration::from_millis(300);

impl Annotator {
    pub(super) fn pick_file(&mut self, context: &Context) {
        self.picking = Some(Job::start("Choosing a file", context, || {
            let asked = Instant::now();
            let endings = ["json", "jpg", "jpeg", "png", "tif", "tiff", "gif"];
            let dialog = rfd::FileDialog::new().add_filter("Annotations, plates, pictures, tracks", &endings);
            (dialog.pick_file(), asked.elapsed())
        }));
    }

    /// What was chosen in the file dialog; the list of plates where the system has no dialog, which then gives nothing,
    /// faster than anybody could.
    pub(super) fn take_picked(&mut self, context: &Context, (path, took): (Option<PathBuf>, Duration)) {
        match path {
            Some(path) => self.leave(context, After::Open(path)),
            None if took < NO_DIALOG && self.footprints.is_open() => self.ask_track_path(),
            None if took < NO_DIALOG => self.browse(),
            None => {}
        }
    }

    pub(super) fn browse(&mut self) {
        self.browser = Some(Browser::new(&self.places.plates));
    }

    pub(super) fn open_specimen(&mut self, context: &Context) {
        let Some(folder) = self.places.specimen() else { return };
        match specimen::unpack(&folder) {
            Ok(path) => self.open(context, &path),
            Err(error) => self.messages.trouble(error.to_string()),
        }
    }

    pub(super) fn save(&mut self, context: &Context, overwrite: bool, after: After) {
        let Some(session) = &mut self.session else { return };
        session.commit();
        match session.document.save(overwrite) {
            Ok(()) => self.after_saving(context, after),
            Err(error) => self.ask_about(error, None, after),
        }
    }

    pub(super) fn save_as(&mut self, context: &Context, path: PathBuf, overwrite: bool, after: After) {
        let Some(session) = &mut self.session else { return };
        match session.document.save_as(&path, overwrite) {
            Ok(()) => {
                session.note_change();
                self.after_saving(context, after);
            }
            Err(error) => self.ask_about(error, Some(path), after),
        }
    }

    fn after_saving(&mut self, context: &Context, after: After) {
        if let Some(session) = &self.session {
            let path = session.document.annotation_path().to_path_buf();
            self.messages.note(format!("Saved {}", path.display()));
            self.settings.remember(&path);
            self.write_settings();
        }
        self.go_on(context, after);
    }

    fn ask_about(&mut self, error: SaveError, save_as: Option<PathBuf>, after: After) {
        match error {
            SaveError::ChangedOnDisk { .. } => {
                self.dialog = Some(Dialog::Overwrite { trouble: error.to_string(), save_as, after });
            }
            error => self.messages.trouble(error.to_string()),
        }
    }

    pub(super) fn ask_save_as(&mut self) {
        if let Some(session) = &self.session {
            self.dialog = Some(Dialog::SaveAs(session.document.annotation_path().display().to_string()));
        }
    }

    pub(super) fn go_on(&mut self, context: &Context, after: After) {
        match after {
            After::Stay => {}
            After::Close => self.close_session(),
            After::Quit if self.footprints.has_unsaved_work() => self.ask_to_save_track(AfterTrack::Quit),
            After::Quit => {
                self.close_session();
                self.may_close = true;
                context.send_viewport_cmd(ViewportCommand::Close);
            }
            After::Open(path) => self.open(context, &path),
            After::OpenSpecimen => self.open_specimen(context),
            After::Show(document) => self.show_document(context, *document),
        }
    }

    /// Holds the window while there is something to save.
    pub(super) fn watch_closing(&mut self, context: &Context) {
        let asked = context.input(|input| input.viewport().close_requested());
        if !asked || self.may_close {
            return;
        }
        if self.has_unsaved_work() {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            self.dialog = Some(Dialog::Unsaved(After::Quit));
        } else if self.footprints.has_unsaved_work() {
            context.send_viewport_cmd(ViewportCommand::CancelClose);
            self.ask_to_save_track(AfterTrack::Quit);
        } else {
            self.close_session();
        }
    }
}
