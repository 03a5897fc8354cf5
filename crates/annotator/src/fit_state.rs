//! The fit, worked out in the background while a person goes on working.

use std::sync::Arc;
use std::time::{Duration, Instant};

use egui::Context;
use muybridge_capture::Document;
use muybridge_core::Skeleton;
use muybridge_fitting::checks::{Concern, after_fit};
use muybridge_fitting::pipeline::{PlateFit, fit_loaded};
use muybridge_fitting::weights::Weights;

use crate::job::{Job, take_answer};

/// A fit waits until nothing was changed for this long: a row of quick changes is fitted once.
const QUIET: Duration = Duration::from_millis(400);

/// A finished fit.
pub struct Fitted {
    /// Counts the fits of a session from 1.
    pub number: u64,
    /// Revision of the document it was made from.
    pub revision: u64,
    /// The fit.
    pub plate: PlateFit,
    /// What to look at again, worst first.
    pub concerns: Vec<Concern>,
}

/// The fit of an open plate.
#[derive(Default)]
pub struct FitState {
    running: Option<Job<Result<Box<Fitted>, String>>>,
    latest: Option<Arc<Fitted>>,
    fault: Option<String>,
    tried_revision: Option<u64>,
    changed: Option<(u64, Instant)>,
    count: u64,
}

impl FitState {
    /// The latest fit, of this revision or an earlier one.
    pub fn latest(&self) -> Option<&Arc<Fitted>> {
        self.latest.as_ref()
    }

    /// Why the documents as they are cannot be fitted.
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// Whether a fit is under way.
    pub fn is_running(&self) -> bool {
        self.running.is_some()
    }

    /// Starts a fit of the document, unless one is under way.
    pub fn start(&mut self, document: &Document, context: &Context) {
        if self.running.is_some() {
            return;
        }
        let revision = document.revision();
        self.tried_revision = Some(revision);
        let plate = match document.plate() {
            Ok(plate) => plate,
            Err(error) => {
                self.fault = Some(error.to_string());
                return;
            }
        };
        self.count += 1;
        let number = self.count;
        self.running = Some(Job::start("Fitting the stride", context, move || {
            let fitted = fit_loaded(plate, &Skeleton::reference(), &Weights::default());
            fitted.map_err(|error| error.to_string()).map(|plate| {
                let concerns = after_fit(&plate);
                Box::new(Fitted { number, revision, plate, concerns })
            })
        }));
    }

    /// Starts a fit when the document has changed and been left alone for a moment.
    pub fn start_when_quiet(&mut self, document: &Document, context: &Context) {
        let revision = document.revision();
        if self.tried_revision == Some(revision) {
            return;
        }
        let since = match self.changed {
            Some((changed, since)) if changed == revision => since,
            _ => {
                let now = Instant::now();
                self.changed = Some((revision, now));
                now
            }
        };
        if since.elapsed() >= QUIET {
            self.start(document, context);
        } else {
            context.request_repaint_after(QUIET);
        }
    }

    /// Takes a finished fit; what was found when it could not be fitted.
    pub fn finish(&mut self) {
        match take_answer(&mut self.running) {
            Some(Ok(Ok(fitted))) => {
                self.fault = None;
                self.latest = Some(Arc::from(fitted));
            }
            Some(Ok(Err(fault)) | Err(fault)) => self.fault = Some(fault),
            None => {}
        }
    }

    /// Waits for the fit under way: for programs without a window.
    pub fn wait(&mut self) {
        while self.running.is_some() {
            std::thread::sleep(Duration::from_millis(2));
            self.finish();
        }
    }
}
