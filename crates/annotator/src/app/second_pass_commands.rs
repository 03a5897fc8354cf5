//! Starting and ending a blind second pass.

use egui::Context;
use muybridge_capture::Document;

use super::Annotator;
use crate::second_pass::SecondPass;
use crate::session::{Page, Session};

impl Annotator {
    /// Starts a second pass over the open plate, or ends the one under way and shows what it says.
    pub(super) fn second_pass(&mut self, context: &Context) {
        let Some(session) = &mut self.session else { return };
        session.commit();
        match session.second_pass.clone() {
            None => self.begin_second_pass(context),
            Some(pass) => self.end_second_pass(context, &pass),
        }
    }

    fn begin_second_pass(&mut self, context: &Context) {
        let journals = self.places.journals();
        let Some(session) = &self.session else { return };
        match SecondPass::begin(session, journals.as_deref()) {
            Ok((document, pass)) => {
                self.show_document(context, document);
                if let Some(session) = &mut self.session {
                    session.page = Page::Pose;
                    session.panel = pass.next_panel().unwrap_or(session.panel);
                    session.second_pass = Some(pass);
                }
            }
            Err(trouble) => self.messages.trouble(trouble),
        }
    }

    fn end_second_pass(&mut self, context: &Context, pass: &SecondPass) {
        let Some(session) = &mut self.session else { return };
        let compared = pass.compare(session);
        if let Err(error) = session.document.save(false) {
            self.messages.trouble(error.to_string());
            return;
        }
        self.messages
            .note(format!("The second pass is kept in {}", session.document.annotation_path().display()));
        match Document::open(&pass.first_path, self.places.journals().as_deref()) {
            Ok(document) => self.show_document(context, document),
            Err(error) => self.messages.trouble(error.to_string()),
        }
        match (compared, &mut self.session) {
            (Ok(repeatability), Some(session)) => session.repeatability = Some(repeatability),
            (Err(trouble), _) => self.messages.trouble(trouble),
            (Ok(_), None) => {}
        }
    }
}

/// Why a second pass cannot be started or ended now.
pub(super) fn why_not(session: &Session) -> Option<&'static str> {
    let starts = session.second_pass.is_none();
    (starts && session.document.is_changed()).then_some("Save the first pass before")
}
