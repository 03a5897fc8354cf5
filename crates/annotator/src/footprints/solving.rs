//! The motion of the track that is shown: found at once while that is quick, else in the background. The last good one stays.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::Instant;

use muybridge_footprints::{Character, Energy, Method, Motion, Track};

/// Solving that took longer than this is done in the background, s: a tenth of a frame.
const QUICK_S: f64 = 0.002;
/// More prints than this are solved in the background the first time, before it is known how long it takes.
const FEW_PRINTS: usize = 64;
/// A path longer than this may have more prints than these, metres.
const SHORT_PATH_M: f64 = 25.0;

/// Wakes the window when something is done.
pub type Waker = Arc<dyn Fn() + Send + Sync>;

/// What came of solving, and how long it took, s; not how long it took to make the character.
struct Answer {
    motion: Result<Motion, String>,
    took_s: f64,
    character: Option<(String, Arc<Character>)>,
}

/// Something to be solved.
struct Task {
    track: Track,
    start: Option<Arc<Motion>>,
    character: Option<(String, Arc<Character>)>,
}

/// The work for one state of the track.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Wanted {
    revision: u64,
    /// Found from the motion before, not from the beginning.
    is_draft: bool,
}

/// The motion and how it is found.
#[derive(Default)]
pub struct Solving {
    latest: Option<Arc<Motion>>,
    /// What cannot be walked in the track as it is, a sentence a line.
    faults: Vec<String>,
    done: Option<Wanted>,
    under_way: Option<(Wanted, Receiver<Answer>)>,
    took_s: f64,
    /// How long the last draft took, and the last solution from the beginning, s.
    each_took_s: [f64; 2],
    /// The character of the model that was solved last: a horse takes a while to be made.
    character: Option<(String, Arc<Character>)>,
    /// Changes whenever the motion does.
    version: u64,
    /// Energies of the last two states that were not drafts, the earlier one first.
    energies: [Option<Energy>; 2],
}

impl Solving {
    /// The last motion that could be found.
    pub fn latest(&self) -> Option<&Motion> {
        self.latest.as_deref()
    }

    /// A number that changes whenever [`Solving::latest`] does.
    pub fn version(&self) -> u64 {
        self.version
    }

    /// Why the track as it is cannot be walked; empty when it can.
    pub fn faults(&self) -> &[String] {
        &self.faults
    }

    /// Whether work is under way.
    pub fn is_busy(&self) -> bool {
        self.under_way.is_some()
    }

    /// How long the last solution took, s.
    pub fn took_s(&self) -> f64 {
        self.took_s
    }

    /// The energy before the last change, or before the one under way.
    pub fn energy_before(&self) -> Option<Energy> {
        if self.done.is_some_and(|done| done.is_draft) { self.energies[1] } else { self.energies[0] }
    }

    /// Says that something else could not be done.
    pub fn note_fault(&mut self, fault: String) {
        self.faults = vec![fault];
    }

    /// Forgets everything: another track is opened.
    pub fn begin_again(&mut self) {
        let (character, version) = (self.character.take(), self.version + 1);
        *self = Self { character, version, ..Self::default() };
    }

    /// Follows the track. `is_draft` while a gesture is under way: then the motion is found from the one before.
    pub fn follow(&mut self, track: &Track, revision: u64, is_draft: bool, waker: &Waker) {
        self.take_answer();
        let wanted = Wanted { revision, is_draft };
        if self.under_way.is_some() || self.is_done(wanted) {
            return;
        }
        if self.is_quick(track, is_draft) {
            let answer = self.task(track, is_draft).run();
            self.take(wanted, answer);
        } else {
            self.start_work(track, wanted, waker);
        }
    }

    /// Waits for what is under way: for programs without a window.
    pub fn wait(&mut self) {
        if let Some((wanted, answer)) = self.under_way.take()
            && let Ok(answer) = answer.recv()
        {
            self.take(wanted, answer);
        }
    }

    /// A motion that was found from the beginning is no worse than a draft.
    fn is_done(&self, wanted: Wanted) -> bool {
        self.done.is_some_and(|done| done.revision == wanted.revision && (!done.is_draft || wanted.is_draft))
    }

    fn task(&self, track: &Track, is_draft: bool) -> Task {
        let start = self.latest.clone().filter(|motion| is_draft && motion.track.model == track.model);
        let character = self.character.clone().filter(|(model, _)| *model == track.model);
        Task { track: track.clone(), start, character }
    }

    fn is_quick(&self, track: &Track, is_draft: bool) -> bool {
        let points = track.path.as_ref().map_or(&[][..], |path| &path.points);
        let length_m: f64 = points
            .windows(2)
            .map(|ends| (ends[1].at_m[0] - ends[0].at_m[0]).hypot(ends[1].at_m[1] - ends[0].at_m[1]))
            .sum();
        let is_short = !track.prints.is_empty() || length_m <= SHORT_PATH_M;
        let is_made =
            track.model != "horse" || self.character.as_ref().is_some_and(|(model, _)| model == "horse");
        track.prints.len() <= FEW_PRINTS
            && is_short
            && is_made
            && self.each_took_s[usize::from(!is_draft)] <= QUICK_S
    }

    fn start_work(&mut self, track: &Track, wanted: Wanted, waker: &Waker) {
        let (sender, answer) = channel();
        let task = self.task(track, wanted.is_draft);
        let waker = Arc::clone(waker);
        let thread = std::thread::Builder::new().name("footprints".into());
        // Without a thread the sender is dropped, and `take_answer` says so.
        let _ = thread.spawn(move || {
            // The window may be gone by now; then nobody wants the answer.
            sender.send(task.run()).ok();
            waker();
        });
        self.under_way = Some((wanted, answer));
    }

    fn take_answer(&mut self) {
        let Some((wanted, answer)) = self.under_way.take() else { return };
        match answer.try_recv() {
            Ok(answer) => self.take(wanted, answer),
            Err(TryRecvError::Empty) => self.under_way = Some((wanted, answer)),
            Err(TryRecvError::Disconnected) => {
                let motion = Err("The motion could not be found: the work stopped unexpectedly".into());
                self.take(wanted, Answer { motion, took_s: self.took_s, character: None });
            }
        }
    }

    fn take(&mut self, wanted: Wanted, Answer { motion, took_s, character }: Answer) {
        (self.done, self.took_s) = (Some(wanted), took_s);
        self.each_took_s[usize::from(!wanted.is_draft)] = took_s;
        self.character = character.or(self.character.take());
        match motion {
            Ok(motion) => {
                if !wanted.is_draft {
                    self.energies = [self.energies[1], Some(motion.solved.energy)];
                }
                self.latest = Some(Arc::new(motion));
                self.version += 1;
                self.faults.clear();
            }
            Err(fault) => self.faults = fault.lines().map(String::from).collect(),
        }
    }
}

impl Task {
    fn run(mut self) -> Answer {
        let no_model = format!("There is no model \"{}\"; choose another one", self.track.model);
        let name = self.track.model.clone();
        let made = || Character::named(&name).map(|character| (name.clone(), Arc::new(character)));
        self.character = self.character.take().or_else(made);
        let begun = Instant::now();
        let motion = match (&self.start, &self.character) {
            (Some(motion), _) => motion.changed(&self.track).map_err(|error| error.to_string()),
            (None, Some((_, character))) => {
                Motion::solve(&self.track, character, Method::Gradient).map_err(|error| error.to_string())
            }
            (None, None) => Err(no_model),
        };
        Answer { motion, took_s: begun.elapsed().as_secs_f64(), character: self.character }
    }
}
