//! A track of footprints that is being worked on, with its motion, what is selected, and the moment looked at. Needs no window.

pub mod document;
pub mod edits;
pub mod examples;
pub mod playback;
pub mod safe_copy;
pub mod solving;
pub mod wandering;

use std::collections::BTreeSet;
use std::path::PathBuf;

use muybridge_footprints::{Energy, Motion, Print, StepTiming, Track};

use document::TrackDocument;
use examples::Example;
use playback::Playback;
use solving::{Solving, Waker};

/// Times of a print that no motion and no file tells, s.
const UNKNOWN_TIMING: StepTiming = StepTiming { stance_time_s: 0.6, step_time_s: 0.5 };

/// When a foot is on the ground, s after the first footfall.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StanceTimes {
    /// Footfall.
    pub strike_s: f64,
    /// When the foot leaves the ground.
    pub lift_off_s: f64,
    /// Next footfall of any foot.
    pub next_s: f64,
}

/// An open track.
pub struct Editor {
    /// The track with its history.
    pub document: TrackDocument,
    /// Its motion.
    pub solving: Solving,
    /// The moment looked at.
    pub playback: Playback,
    /// Selected prints, from 0.
    pub selected: BTreeSet<usize>,
    /// Selected point of the path, from 0.
    pub path_point: Option<usize>,
    safe_folder: Option<PathBuf>,
}

impl Default for Editor {
    fn default() -> Self {
        Self::new(TrackDocument::new(Example::WalkingBird.track()))
    }
}

impl Editor {
    /// Shows a document.
    pub fn new(document: TrackDocument) -> Self {
        Self {
            document,
            solving: Solving::default(),
            playback: Playback::default(),
            selected: BTreeSet::new(),
            path_point: None,
            safe_folder: None,
        }
    }

    /// Keeps changes in a folder until they are saved.
    pub fn keep_safe_in(&mut self, folder: Option<PathBuf>) {
        self.safe_folder.clone_from(&folder);
        self.document.keep_safe_in(folder);
    }

    /// Shows another document; what was there is forgotten as it is.
    pub fn show(&mut self, mut document: TrackDocument) {
        document.keep_safe_in(self.safe_folder.clone());
        self.document = document;
        self.solving.begin_again();
        self.playback.begin_again();
        self.deselect();
    }

    /// The track as it is shown.
    pub fn track(&self) -> &Track {
        self.document.track()
    }

    /// The last motion that could be found.
    pub fn motion(&self) -> Option<&Motion> {
        self.solving.latest()
    }

    /// Duration of the motion, s.
    pub fn end_s(&self) -> f64 {
        self.motion().map_or(0.0, Motion::duration_s)
    }

    /// Whether the prints are laid along the path, and not yet the track's own.
    pub fn are_laid(&self) -> bool {
        self.track().prints.is_empty() && self.track().path.is_some()
    }

    /// The prints that are shown: the track's own, or those laid along its path.
    pub fn prints(&self) -> &[Print] {
        match self.motion() {
            Some(motion) if self.are_laid() && motion.track.model == self.track().model => {
                &motion.track.prints
            }
            _ => &self.track().prints,
        }
    }

    /// The times of a print: its own, or the automatic ones.
    pub fn timing(&self, print: usize) -> Option<StepTiming> {
        let own = self.prints().get(print)?.timing;
        let placed = self.motion().map(|motion| &motion.placed);
        let automatic = placed.filter(|placed| placed.prints.len() == self.prints().len()).map(|placed| {
            let at = &placed.prints[print];
            let next_s = placed.prints.get(print + 1).map_or(placed.end_s, |next| next.strike_s);
            StepTiming { stance_time_s: at.lift_off_s - at.strike_s, step_time_s: next_s - at.strike_s }
        });
        Some(own.or(automatic).unwrap_or(UNKNOWN_TIMING))
    }

    /// When each foot is on the ground.
    pub fn stances(&self) -> Vec<StanceTimes> {
        let mut strike_s = 0.0;
        let stance = |print: usize| {
            let timing = self.timing(print).unwrap_or(UNKNOWN_TIMING);
            let next_s = strike_s + timing.step_time_s;
            let times = StanceTimes { strike_s, lift_off_s: strike_s + timing.stance_time_s, next_s };
            strike_s = next_s;
            times
        };
        (0..self.prints().len()).map(stance).collect()
    }

    /// The energy now and before the last change.
    pub fn energies(&self) -> Option<(Energy, Option<Energy>)> {
        Some((self.motion()?.solved.energy, self.solving.energy_before()))
    }

    /// Makes a change of the prints at once, as one step; laid prints become the track's own first.
    pub fn edit(&mut self, label: &str, change: impl FnOnce(&mut Track)) {
        self.document.commit();
        let own = self.own_prints();
        self.document.edit(label, |track| {
            own.give(track);
            change(track);
        });
        self.tidy_selection();
    }

    /// Shows what a gesture would make of the prints; laid prints become the track's own first.
    pub fn preview(&mut self, label: &str, change: impl FnOnce(&mut Track)) {
        let own = self.own_prints();
        self.document.preview(label, |track| {
            own.give(track);
            change(track);
        });
    }

    fn own_prints(&self) -> OwnPrints {
        OwnPrints(if self.are_laid() { self.prints().to_vec() } else { Vec::new() })
    }

    /// Makes the change under way, as one step.
    pub fn commit(&mut self) {
        self.document.commit();
        self.tidy_selection();
    }

    /// Takes the last step back.
    pub fn undo(&mut self) {
        self.document.undo();
        self.tidy_selection();
    }

    /// Brings back the step taken back last.
    pub fn redo(&mut self) {
        self.document.redo();
        self.tidy_selection();
    }

    /// What is selected is there.
    fn tidy_selection(&mut self) {
        let count = self.prints().len();
        self.selected.retain(|print| *print < count);
        let points = self.track().path.as_ref().map_or(0, |path| path.points.len());
        self.path_point = self.path_point.filter(|point| *point < points);
    }

    /// Selects nothing.
    pub fn deselect(&mut self) {
        self.selected.clear();
        self.path_point = None;
    }

    /// Selects a print, alone or with what is selected already, from which it is taken away when it is selected.
    pub fn select(&mut self, print: usize, with_others: bool) {
        self.path_point = None;
        if !with_others {
            self.selected = BTreeSet::from([print]);
        } else if !self.selected.remove(&print) {
            self.selected.insert(print);
        }
    }

    /// Selects the print so many places on from the last selected one, around the track.
    pub fn select_next(&mut self, places: isize) {
        let count = self.prints().len() as isize;
        if count == 0 {
            return;
        }
        let next = match (self.selected.last(), places > 0) {
            (Some(at), _) => (*at as isize + places).rem_euclid(count),
            (None, true) => 0,
            (None, false) => count - 1,
        };
        self.select(next as usize, false);
    }

    /// Puts the next print where it goes on, or at a place; it is selected.
    pub fn add_print(&mut self, at_m: Option<[f64; 2]>) {
        self.edit("Add a print", |track| {
            let print =
                at_m.map_or_else(|| edits::next_print(track), |at_m| edits::next_print_at(track, at_m));
            track.prints.push(print);
        });
        if let Some(last) = self.prints().len().checked_sub(1) {
            self.select(last, false);
        }
    }

    /// Takes away what is selected.
    pub fn delete_selected(&mut self) {
        if let Some(point) = self.path_point.take() {
            self.document.edit("Delete a point of the path", |track| {
                if let Some(path) = &mut track.path {
                    path.points.remove(point);
                }
            });
        } else if !self.selected.is_empty() {
            let prints = std::mem::take(&mut self.selected);
            // A track whose prints are all gone has none: its path must not lay them again at once.
            self.edit("Delete prints", |track| {
                edits::delete(track, &prints);
                if track.prints.is_empty() {
                    track.path = None;
                }
            });
        }
    }

    /// Makes the prints laid along the path the track's own, or lays them along it anew.
    pub fn lay_prints(&mut self) {
        if self.are_laid() {
            self.edit("Lay prints", |_| {});
        } else {
            self.deselect();
            self.document.edit("Lay prints along the path", |track| track.prints.clear());
        }
    }

    /// Finds the motion of the track as it is.
    pub fn solve(&mut self, waker: &Waker) {
        let (revision, is_draft) = (self.document.revision(), self.document.is_changing());
        self.solving.follow(self.document.track(), revision, is_draft, waker);
        self.tidy_selection();
    }
}

/// Prints that become the track's own before they are changed; none when they are already.
struct OwnPrints(Vec<Print>);

impl OwnPrints {
    fn give(self, track: &mut Track) {
        if track.prints.is_empty() && !self.0.is_empty() {
            track.prints = self.0;
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]
mod tests;
