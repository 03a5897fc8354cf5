//! Where horses are made ready, in the background, while the ride goes on.

use std::sync::Arc;

use egui::Context;
use muybridge_core::{Database, Repertoire, Skeleton};

use super::SharedRepertoire;
use crate::job::{Job, take_answer};
use crate::ride::Which;
use crate::ride::build::Build;

/// A horse is made when its sliders have rested for this long, s.
const QUIET_S: f64 = 0.12;

type Made = Result<SharedRepertoire, String>;

/// A horse under way.
struct Work {
    which: Which,
    job: Job<(Arc<Database>, Made)>,
}

/// The workshop.
#[derive(Default)]
pub(super) struct Workshop {
    database: Option<Arc<Database>>,
    under_way: Option<Work>,
    done: Option<(Which, Made)>,
    /// What the sliders say of each horse.
    wanted: [Build; 2],
    /// What was made, or tried, last.
    tried: [Build; 2],
    changed_s: Option<f64>,
}

impl Workshop {
    /// Begins with the reference horse.
    pub(super) fn begin(&mut self, context: &Context) {
        if self.under_way.is_none() {
            self.start(Which::A, context);
        }
    }

    /// The build of a horse as the sliders say.
    pub(super) fn wanted(&self, which: Which) -> Build {
        self.wanted[which.index()]
    }

    /// Says how a horse is to be built; at `now_s` of egui's time.
    pub(super) fn want(&mut self, which: Which, build: Build, now_s: f64) {
        self.wanted[which.index()] = build;
        self.changed_s = Some(now_s);
    }

    /// Says that a new horse B has the build of A.
    pub(super) fn copy_first(&mut self) {
        (self.wanted[1], self.tried[1]) = (self.tried[0], self.tried[0]);
    }

    /// Whether a horse is being made, or is about to be.
    pub(super) fn is_busy(&self) -> bool {
        self.under_way.is_some() || self.next().is_some()
    }

    fn next(&self) -> Option<Which> {
        Which::ALL.into_iter().find(|which| self.wanted[which.index()] != self.tried[which.index()])
    }

    /// Starts what is to be made, once the sliders rest.
    pub(super) fn work(&mut self, context: &Context) {
        let (Some(which), None) = (self.next(), &self.under_way) else { return };
        let now_s = context.input(|input| input.time);
        let rested_s = self.changed_s.map_or(QUIET_S, |changed_s| now_s - changed_s);
        if rested_s >= QUIET_S {
            self.start(which, context);
        } else {
            context.request_repaint_after(std::time::Duration::from_secs_f64(QUIET_S - rested_s));
        }
    }

    fn start(&mut self, which: Which, context: &Context) {
        let build = self.wanted[which.index()];
        self.tried[which.index()] = build;
        let database = self.database.clone();
        let job = Job::start("Making the horse ready", context, move || {
            let database = database.unwrap_or_else(|| Arc::new(Database::embedded()));
            let skeleton = build.skeleton(&Skeleton::reference());
            let made = Repertoire::new(&database, &skeleton).map(Arc::new);
            (database, made.map_err(|error| format!("A horse of these proportions cannot be made: {error}")))
        });
        self.under_way = Some(Work { which, job });
    }

    /// What is finished.
    pub(super) fn finished(&mut self) -> Option<(Which, Made)> {
        if let Some(done) = self.done.take() {
            return Some(done);
        }
        let Work { which, job } = self.under_way.take()?;
        let mut job = Some(job);
        match take_answer(&mut job) {
            Some(answer) => Some((which, self.keep(answer))),
            None => {
                self.under_way = job.map(|job| Work { which, job });
                None
            }
        }
    }

    fn keep(&mut self, answer: Result<(Arc<Database>, Made), String>) -> Made {
        let (database, made) = answer?;
        self.database = Some(database);
        made
    }

    /// Waits for what is under way.
    pub(super) fn wait(&mut self) {
        if let Some(Work { which, job }) = self.under_way.take() {
            let made = self.keep(job.wait());
            self.done = Some((which, made));
        }
    }
}
