//! The program with a plate open that nobody has annotated, driven by its own commands and changes.

use std::path::Path;
use std::time::Duration;

use annotator::app::{Annotator, Places};
use annotator::command::Command;
use annotator::session::Session;
use annotator::toast::Messages;
use egui::Context;
use muybridge_fitting::pipeline::PlateFit;
use tempfile::TempDir;

/// Waits between two looks at what runs in the background.
const LOOK: Duration = Duration::from_millis(1);

/// The program without a display.
pub(crate) struct Window {
    annotator: Annotator,
    context: Context,
    messages: Messages,
    _folder: TempDir,
}

impl Window {
    /// Opens a copy of a manifest and its photograph; there is no annotation beside them.
    pub(crate) fn open(manifest: &Path, photograph: &Path) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let copy = |from: &Path| {
            let to = folder.path().join(from.file_name().unwrap());
            std::fs::copy(from, &to).unwrap();
            to
        };
        let path = copy(manifest);
        let image = muybridge_capture::Manifest::read(&path).unwrap().images[0].file.clone();
        std::fs::copy(photograph, folder.path().join(image)).unwrap();
        let context = Context::default();
        let places = Places { state: None, plates: folder.path().to_path_buf() };
        let mut annotator = Annotator::new(&context, places, Some(&path));
        annotator.wait_until_open(&context);
        let mut window = Self { annotator, context, messages: Messages::default(), _folder: folder };
        while window.session().picture_is_missing() {
            std::thread::sleep(LOOK);
            window.settle();
        }
        window
    }

    pub(crate) fn session(&mut self) -> &mut Session {
        self.annotator.session.as_mut().unwrap()
    }

    /// Frames pass until nothing is under way.
    pub(crate) fn settle(&mut self) {
        loop {
            let session = self.annotator.session.as_mut().unwrap();
            session.finish_background_work(&mut self.messages);
            session.before_frame(&self.context, false);
            if session.work_under_way().is_none() {
                return;
            }
            std::thread::sleep(LOOK);
        }
    }

    /// Does a command as its key does, and waits for what it starts.
    pub(crate) fn run(&mut self, command: Command) {
        assert_eq!(self.annotator.why_not(command), None, "{command:?}");
        let context = self.context.clone();
        self.annotator.run(&context, command);
        self.settle();
    }

    /// The stride fitted to the points as they are, or why it cannot be.
    pub(crate) fn fitted(&mut self) -> Result<PlateFit, String> {
        self.run(Command::FitNow);
        let fit = &self.session().fit;
        match (fit.fault(), fit.latest()) {
            (None, Some(fitted)) => Ok(fitted.plate.clone()),
            (fault, _) => Err(fault.unwrap_or("no fit").to_string()),
        }
    }
}
