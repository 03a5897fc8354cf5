//! Commands that change the open plate's documents.

use egui::Context;
use muybridge_capture::{Facing, Keypoint, KeypointState, Placed, PlacedBy, StanceLabel};
use muybridge_core::Pair;
use muybridge_fitting::footfalls::{LANES, with_label};
use muybridge_imaging::track::Proposal;

use super::Command;
use crate::panels;
use crate::picture::ImageState;
use crate::proposal::Found;
use crate::session::{Page, Session, Tool};
use crate::toast::Messages;

/// A nudge, px; and a fine one.
const NUDGE_PX: f64 = 1.0;
const FINE_NUDGE_PX: f64 = 0.1;

impl Session {
    /// Does a command of the open plate.
    pub(super) fn run(&mut self, context: &Context, command: Command, messages: &mut Messages) {
        use Command as C;
        match command {
            C::Undo | C::Redo => self.step_history(command, messages),
            C::Visible => self.set_state(KeypointState::Visible),
            C::Occluded => self.set_state(KeypointState::Occluded),
            C::Absent => self.set_state(KeypointState::Absent),
            C::DeletePoint => self.delete_point(),
            C::NudgeLeft => self.nudge([-NUDGE_PX, 0.0]),
            C::NudgeRight => self.nudge([NUDGE_PX, 0.0]),
            C::NudgeUp => self.nudge([0.0, -NUDGE_PX]),
            C::NudgeDown => self.nudge([0.0, NUDGE_PX]),
            C::NudgeLeftFine => self.nudge([-FINE_NUDGE_PX, 0.0]),
            C::NudgeRightFine => self.nudge([FINE_NUDGE_PX, 0.0]),
            C::NudgeUpFine => self.nudge([0.0, -FINE_NUDGE_PX]),
            C::NudgeDownFine => self.nudge([0.0, FINE_NUDGE_PX]),
            C::ToolGuided => self.take_tool(Tool::Guided),
            C::ToolFree => self.take_tool(Tool::Free),
            C::ToolSkeleton => self.take_tool(Tool::Skeleton),
            C::NextPoint => self.select_next(1),
            C::PreviousPoint => self.select_next(-1),
            C::OtherSide => self.selected = self.selected.map(panels::other_side),
            C::FitNow => self.fit.start(&self.document, context),
            C::WorstPoint => self.go_to_worst(),
            C::PlayStride => {
                self.page = Page::Play;
                self.play.is_playing = !self.play.is_playing;
            }
            C::ToggleNearFore => self.toggle_contact(0),
            C::ToggleOffFore => self.toggle_contact(1),
            C::ToggleNearHind => self.toggle_contact(2),
            C::ToggleOffHind => self.toggle_contact(3),
            _ => self.run_on_panels(context, command),
        }
    }

    fn run_on_panels(&mut self, context: &Context, command: Command) {
        use Command as C;
        let panel = self.panel;
        match command {
            C::SplitAutomatically => self.proposals.split(&self.images, context),
            C::FindGround => {
                let draft = self.document.draft().clone();
                self.proposals.find_ground(&draft, &self.images, context);
            }
            C::AddPanel => self.edit("Add a panel", panels::add),
            C::DeletePanel => self.edit("Delete a panel", |draft| panels::delete(draft, panel)),
            C::PanelEarlier => self.move_panel(-1),
            C::PanelLater => self.move_panel(1),
            C::MirrorOrder => self.edit("Mirror the reading order", panels::mirror_rows),
            C::ReverseOrder => self.edit("Reverse the order of time", panels::reverse),
            C::FlipFacing => self.edit("Turn the facing round", |draft| {
                draft.manifest.facing = Some(match draft.manifest.facing {
                    Some(Facing::Right) => Facing::Left,
                    _ => Facing::Right,
                });
            }),
            C::CopyPrevious => self.copy_previous(),
            C::ProposeTracked => self.propose_tracked(context),
            C::ProposeInterpolated => self.propose_interpolated(),
            C::ProposeFitted => self.propose_fitted(),
            C::SwapFore => self.swap("Swap the forelegs", Some(Pair::Fore)),
            C::SwapHind => self.swap("Swap the hindlegs", Some(Pair::Hind)),
            C::SwapPanel => self.swap("Swap near and off", None),
            C::ClearPanel => self.edit("Delete all points of a panel", |draft| {
                draft.panel_mut(panel).keypoints = muybridge_capture::Keypoints::default();
            }),
            _ => {}
        }
    }

    fn step_history(&mut self, command: Command, messages: &mut Messages) {
        let (step, done) = match command {
            Command::Undo => (self.document.undo(), "Undone"),
            _ => (self.document.redo(), "Done again"),
        };
        if let Some(step) = step {
            messages.note(format!("{done}: {step}"));
        }
        self.note_change();
    }

    fn set_state(&mut self, state: KeypointState) {
        let (Some(keypoint), panel) = (self.selected, self.panel) else { return };
        let known = self.panel_annotation().and_then(|p| p.keypoints.get(keypoint)).copied();
        let at_px = known.and_then(|placed| placed.at_px);
        if at_px.is_none() && state != KeypointState::Absent {
            // What the next click places is meant.
            self.next_state = state;
            return;
        }
        let at_px = at_px.filter(|_| state != KeypointState::Absent);
        let by = known.map_or(PlacedBy::Hand, |placed| placed.by);
        let label = format!("{} is {}", crate::colors::name(keypoint), format!("{state:?}").to_lowercase());
        self.edit(&label, |draft| {
            draft.panel_mut(panel).keypoints.insert(keypoint, Placed { at_px, state, by, sd_px: None });
        });
        if state == KeypointState::Absent && self.tool == Tool::Guided {
            self.select_unplaced();
        }
    }

    fn delete_point(&mut self) {
        let (Some(keypoint), panel) = (self.selected, self.panel) else { return };
        let label = format!("Delete {}", crate::colors::name(keypoint));
        self.edit(&label, |draft| draft.panel_mut(panel).keypoints.remove(keypoint));
    }

    fn nudge(&mut self, [dx, dy]: [f64; 2]) {
        let Some((keypoint, placed)) = self.selected_point() else { return };
        let Some([x, y]) = placed.place() else { return };
        let placed = Placed { at_px: Some([x + dx, y + dy]), by: PlacedBy::Hand, sd_px: None, ..placed };
        let (label, panel) = (format!("Nudge {}", crate::colors::name(keypoint)), self.panel);
        self.edit(&label, |draft| draft.panel_mut(panel).keypoints.insert(keypoint, placed));
    }

    /// The selected point, where it has an entry.
    pub fn selected_point(&self) -> Option<(Keypoint, Placed)> {
        let keypoint = self.selected?;
        Some((keypoint, *self.panel_annotation()?.keypoints.get(keypoint)?))
    }

    fn take_tool(&mut self, tool: Tool) {
        self.tool = tool;
        self.page = Page::Pose;
        if tool == Tool::Guided {
            self.select_unplaced();
        }
    }

    fn select_next(&mut self, steps: i64) {
        let count = muybridge_capture::KEYPOINT_COUNT as i64;
        let at = self.selected.map_or(if steps > 0 { -1 } else { 0 }, |keypoint| keypoint.index() as i64);
        self.selected = Keypoint::all().nth((at + steps).rem_euclid(count) as usize);
    }

    /// Selects the first point in the drawn order that has no entry, from the selected one on.
    pub fn select_unplaced(&mut self) {
        let keypoints = self.panel_annotation().map(|panel| panel.keypoints.clone()).unwrap_or_default();
        let start = self.selected.map_or(0, Keypoint::index);
        let all: Vec<Keypoint> = Keypoint::all().collect();
        let in_order = all[start..].iter().chain(&all[..start]);
        self.selected = in_order.copied().find(|keypoint| keypoints.get(*keypoint).is_none());
    }

    fn go_to_worst(&mut self) {
        let Some(fitted) = self.fit.latest() else { return };
        let worst = fitted.plate.residuals.iter().max_by(|a, b| a.metres().total_cmp(&b.metres()));
        if let Some((panel, keypoint)) = worst.map(|worst| (worst.panel, worst.keypoint)) {
            self.page = Page::Pose;
            self.go_to(panel);
            self.selected = Some(keypoint);
        }
    }

    fn toggle_contact(&mut self, lane: usize) {
        let (leg, panel) = (LANES[lane], self.panel);
        let Some(clock) = self.derived.footfalls.as_ref().map(|footfalls| footfalls.clock.clone()) else {
            return;
        };
        self.edit("Contact label", |draft| {
            let now = draft.panel_mut(panel).contacts.of(leg.0, leg.1);
            let next = match now {
                StanceLabel::Unknown | StanceLabel::Swing => StanceLabel::Stance,
                StanceLabel::Stance => StanceLabel::Swing,
            };
            draft.annotation = with_label(&draft.annotation, &clock, leg, panel, next);
        });
    }

    fn move_panel(&mut self, steps: i64) {
        let panel = self.panel;
        let mut now = panel;
        self.edit("Move a panel", |draft| now = panels::moved(draft, panel, steps));
        self.panel = now;
    }

    fn swap(&mut self, label: &str, pair: Option<Pair>) {
        let panel = self.panel;
        self.edit(label, |draft| draft.panel_mut(panel).swap_near_off(pair));
    }

    /// Whether a photograph of the plate is not there (yet).
    pub fn picture_is_missing(&self) -> bool {
        self.images.states().iter().any(|state| !matches!(state, ImageState::Ready(_)))
    }

    /// Takes over what was found in the background.
    pub fn finish_background_work(&mut self, messages: &mut Messages) {
        self.images.poll();
        // A drag goes on from the documents as they were when it began.
        if self.is_dragging() {
            return;
        }
        self.fit.finish();
        match self.proposals.finish(messages) {
            Some(Found::Points(panel, proposals)) if proposals.is_empty() => {
                messages
                    .trouble(format!("Panel {panel}: nothing could be tracked; place the points by hand"));
            }
            Some(Found::Points(panel, proposals)) => {
                let point = |Proposal { keypoint, placed, .. }: &Proposal| (*keypoint, *placed);
                let points: Vec<(Keypoint, Placed)> = proposals.iter().map(point).collect();
                self.take_proposed("Propose by tracking", panel, &points);
            }
            Some(Found::Ground(lines)) => {
                messages
                    .note(format!("Ground found in {} panels; drag its ends where it is off", lines.len()));
                self.edit("Find the ground lines", |draft| panels::take_ground(draft, &lines));
            }
            Some(Found::Panels(found)) => {
                messages.note(format!("{} panels found", found.panels.len()));
                found.doubts.iter().for_each(|(_, doubt)| messages.trouble(doubt.to_string()));
                self.edit("Find panels", |draft| panels::take_found(draft, found.panels));
            }
            None => {}
        }
    }

    /// What is under way in the background, for people.
    pub fn work_under_way(&self) -> Option<String> {
        let fitting = self.fit.is_running().then(|| "Fitting the stride".to_string());
        self.proposals.work().map(str::to_string).or(fitting)
    }

    /// To be called before a frame is drawn: what follows from the documents, and the fit.
    pub fn before_frame(&mut self, context: &Context, fit_always: bool) {
        if fit_always && self.second_pass.is_none() && !self.is_dragging() {
            self.fit.start_when_quiet(&self.document, context);
        }
        let (state, dragging) = (self.state(), self.is_dragging());
        let draft = self.draft().clone();
        self.derived.update(&draft, state, self.fit.latest(), dragging);
    }
}
