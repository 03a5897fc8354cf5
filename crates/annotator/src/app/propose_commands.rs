//! Commands that propose points for a panel: tracked, interpolated, fitted, copied. None of them moves a point that a person
//! has placed.

use egui::Context;
use muybridge_capture::{Draft, Keypoint, KeypointState, PanelAnnotation, Placed, PlacedBy};
use muybridge_fitting::posing::{SequencePanel, interpolate};

use crate::session::{Page, Session, Tool};

/// Fewest points of a panel from which another is tracked.
const LEAST_KNOWN: usize = 6;

impl Session {
    /// Panels from which this one can be tracked, the one beside it last: two before it, else two after it.
    fn known_beside(&self) -> Option<Vec<u32>> {
        let numbers = self.panel_numbers();
        let at = numbers.iter().position(|number| *number == self.panel)?;
        let is_known = |panel: &u32| {
            let placed = self.draft().panel(*panel);
            placed.is_some_and(|p| {
                p.keypoints.iter().filter(|(_, p)| p.place().is_some()).count() >= LEAST_KNOWN
            })
        };
        let beside = |mut way: Vec<u32>| {
            way.truncate(2);
            let known: Vec<u32> = way.into_iter().take_while(is_known).collect();
            (!known.is_empty()).then(|| known.into_iter().rev().collect::<Vec<u32>>())
        };
        let before = beside(numbers[..at].iter().rev().copied().collect());
        let after = beside(numbers[at + 1..].to_vec());
        match (before, after) {
            (Some(before), Some(after)) if after.len() > before.len() => Some(after),
            (Some(before), _) => Some(before),
            (None, after) => after,
        }
    }

    /// Why nothing can be tracked into this panel.
    pub fn why_not_track(&self) -> Option<&'static str> {
        if self.picture_is_missing() {
            Some("The photograph is not read yet")
        } else if self.proposals.work().is_some() {
            Some("Something else is being worked out")
        } else {
            self.known_beside().is_none().then_some("Neither the panel before nor the one after has points")
        }
    }

    /// Why nothing can be interpolated into this panel.
    pub fn why_not_interpolate(&self) -> Option<&'static str> {
        let placed = |p: &&PanelAnnotation| {
            p.panel != self.panel
                && p.keypoints.iter().filter(|(_, p)| p.place().is_some()).count() >= LEAST_KNOWN
        };
        let others = self.draft().annotation.panels.iter().filter(placed).count();
        (others < 2).then_some("Two other panels must have points")
    }

    /// Why no pose can be copied into this panel.
    pub fn why_not_copy(&self) -> Option<&'static str> {
        let before = self.neighbour(-1).and_then(|panel| self.draft().panel(panel));
        before.is_none_or(|p| p.keypoints.iter().next().is_none()).then_some("The panel before has no points")
    }

    pub(super) fn propose_tracked(&mut self, context: &Context) {
        let Some(known) = self.known_beside() else { return };
        let documents = (self.document.draft(), &self.derived);
        self.proposals.track(documents, &known, self.panel, &self.images, context);
    }

    /// The panels of the stride in order of time, as interpolation wants them.
    fn sequence(&self) -> Vec<SequencePanel> {
        let draft = self.document.draft();
        let panel = |panel: u32| {
            let annotation = draft.panel(panel).cloned();
            let annotation = annotation.unwrap_or_else(|| PanelAnnotation::empty(panel));
            let camera = *self.derived.cameras.get(&panel)?;
            let (keypoints, contacts) = (annotation.keypoints, annotation.contacts);
            Some(SequencePanel { panel, camera, keypoints, contacts })
        };
        self.panel_numbers().into_iter().filter_map(panel).collect()
    }

    pub(super) fn propose_interpolated(&mut self) {
        let period = self.derived.footfalls.as_ref().map(|footfalls| footfalls.clock.closes_after_panels());
        let (skeleton, lengths) = (self.derived.skeleton().clone(), self.derived.lengths);
        let found = interpolate(&skeleton, self.facing(), &lengths, &self.sequence(), self.panel, period);
        let points: Vec<(Keypoint, Placed)> =
            found.iter().map(|(keypoint, placed)| (keypoint, *placed)).collect();
        self.take_proposed("Propose by interpolation", self.panel, &points);
    }

    pub(super) fn propose_fitted(&mut self) {
        let Some(fitted) = self.fit.latest().cloned() else { return };
        let (fit, panel) = (&fitted.plate.fit, self.panel);
        let slot = fit.problem.order.iter().position(|i| fit.observation.panels[*i].camera.panel == panel);
        let Some(slot) = slot else { return };
        let kinematics = &fit.kinematics()[slot];
        let points: Vec<(Keypoint, Placed)> = Keypoint::all()
            .map(|keypoint| {
                let known = self.panel_annotation().and_then(|p| p.keypoints.get(keypoint));
                let state = known.map_or(KeypointState::Visible, |placed| placed.state);
                let state = if state == KeypointState::Absent { KeypointState::Occluded } else { state };
                let at_px = Some(fit.place_px(slot, kinematics, keypoint));
                (keypoint, Placed { at_px, state, by: PlacedBy::Fitted, sd_px: None })
            })
            .collect();
        self.take_proposed("Propose from the fit", panel, &points);
    }

    pub(super) fn copy_previous(&mut self) {
        let (Some(from), to) = (self.neighbour(-1), self.panel) else { return };
        let Some(place) = self.derived.registration(self.document.draft(), from, to) else { return };
        let Some(source) = self.document.draft().panel(from) else { return };
        let points: Vec<(Keypoint, Placed)> = source
            .keypoints
            .iter()
            .map(|(keypoint, placed)| {
                (keypoint, Placed { at_px: placed.at_px.map(&place), by: PlacedBy::Interpolated, ..*placed })
            })
            .collect();
        self.take_proposed("Copy the previous pose", to, &points);
    }

    /// Takes points over, but never in the place of one that a person has put there; places that are none are left out.
    pub(super) fn take_proposed(&mut self, label: &str, panel: u32, points: &[(Keypoint, Placed)]) {
        self.edit(label, |draft| take_over(draft, panel, points));
        self.page = Page::Pose;
        // What was asked for may have its place now.
        if self.tool == Tool::Guided && self.panel == panel {
            self.selected = None;
            self.select_unplaced();
        }
    }
}

fn take_over(draft: &mut Draft, panel: u32, points: &[(Keypoint, Placed)]) {
    let keypoints = &mut draft.panel_mut(panel).keypoints;
    for (keypoint, placed) in points {
        let by_hand = keypoints.get(*keypoint).is_some_and(|placed| placed.by == PlacedBy::Hand);
        let finite = placed.at_px.iter().flatten().all(|v| v.is_finite());
        if !by_hand && finite {
            keypoints.insert(*keypoint, *placed);
        }
    }
}
