//! A person who annotates a plate whose truth is known: scatters as people do, and counts what the hand does.

use annotator::command::Command;
use muybridge_capture::{
    Annotation, Keypoint, KeypointState, PanelAnnotation, PanelUse, Placed, PlacedBy, StanceLabel,
};
use muybridge_core::Random;
use muybridge_fitting::footfalls::{LANES, with_span};

use super::window::Window;

/// Standard deviation of a coordinate of a placed point as a share of the withers height, visible and guessed: 1.5 and 2.4 px
/// at 187 px, which is what `muybridge annotations compare` finds between the two passes over Sallie Gardner.
const HAND: [f64; 2] = [1.5 / 187.0, 2.4 / 187.0];
/// A proposed point is left alone within so many of those: seven of ten of a person's own clicks lie as near. With two, the
/// points would still be as good as clicks, but what is proposed errs alike from panel to panel, and the fit cannot average
/// that away.
const LEFT_ALONE: f64 = 1.55;
/// With this many wrong points or more, the worst few are corrected first and the rest proposed again.
const MANY: usize = 3;
const WORST: usize = 2;

/// What the hand has done.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Count {
    /// Clicks and drags on the photographs.
    pub(crate) points: usize,
    /// Drags on the footfall bar.
    pub(crate) contacts: usize,
    /// Keys.
    pub(crate) keys: usize,
}

impl Count {
    /// Gestures of the pointer.
    pub(crate) fn clicks(&self) -> usize {
        self.points + self.contacts
    }
}

/// A person, who knows the truth but for the hand.
pub(crate) struct Person {
    truth: Annotation,
    withers_px: f64,
    /// Where this person sees a point, in standard deviations from where it is; the same whenever it is looked at.
    hand: Vec<[f64; 2]>,
    pub(crate) count: Count,
}

fn distance([ax, ay]: [f64; 2], [bx, by]: [f64; 2]) -> f64 {
    (ax - bx).hypot(ay - by)
}

impl Person {
    pub(crate) fn new(truth: Annotation, withers_px: f64, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let count = truth.panels.len() * muybridge_capture::KEYPOINT_COUNT;
        let hand = (0..count).map(|_| [random.normal(), random.normal()]).collect();
        Self { truth, withers_px, hand, count: Count::default() }
    }

    fn true_panel(&self, panel: u32) -> &PanelAnnotation {
        self.truth.panels.iter().find(|p| p.panel == panel).unwrap()
    }

    pub(crate) fn true_px(&self, panel: u32, keypoint: Keypoint) -> [f64; 2] {
        self.true_panel(panel).keypoints.place(keypoint).unwrap()
    }

    fn sd_px(&self, panel: u32, keypoint: Keypoint) -> f64 {
        let state = self.true_panel(panel).keypoints.get(keypoint).unwrap().state;
        self.withers_px * HAND[usize::from(state != KeypointState::Visible)]
    }

    fn stride(&self) -> Vec<u32> {
        let used = self.truth.panels.iter().filter(|p| p.usage == PanelUse::Stride);
        used.map(|p| p.panel).collect()
    }

    /// What both ways of working share and the manifest does not hold: marks of the wall, standing panels, scatter, ground.
    pub(crate) fn prepares(&mut self, window: &mut Window) {
        let visible_sd_px = HAND[0] * self.withers_px;
        let occluded_sd_px = HAND[1] * self.withers_px;
        window.session().edit("Marks", |draft| {
            (draft.annotation.visible_sd_px, draft.annotation.occluded_sd_px) =
                (visible_sd_px, occluded_sd_px);
            draft.annotation.stride = self.truth.stride;
            for panel in &self.truth.panels {
                match panel.usage {
                    PanelUse::Stride => draft.panel_mut(panel.panel).marks.clone_from(&panel.marks),
                    _ => *draft.panel_mut(panel.panel) = panel.clone(),
                }
            }
        });
        window.run(Command::FindGround);
        self.count.keys += 1;
        self.draws_contacts(window);
    }

    /// One drag for each stance.
    fn draws_contacts(&mut self, window: &mut Window) {
        let numbers = self.stride();
        let count = numbers.len();
        for leg in LANES {
            let labels: Vec<StanceLabel> =
                numbers.iter().map(|panel| self.true_panel(*panel).contacts.of(leg.0, leg.1)).collect();
            let down = |i: usize| labels[i % count] == StanceLabel::Stance;
            let strikes: Vec<usize> = (0..count).filter(|i| down(*i) && !down(i + count - 1)).collect();
            for strike in strikes {
                let length = (0..count).take_while(|i| down(strike + i)).count();
                let from = f64::from(numbers[strike]) - 0.5;
                let session = window.session();
                let clock = session.derived.footfalls.as_ref().unwrap().clock.clone();
                session.edit("Footfall", |draft| {
                    for panel in &numbers {
                        draft.panel_mut(*panel);
                    }
                    let span = [from, from + length as f64];
                    draft.annotation = with_span(&draft.annotation, &clock, leg, span);
                });
                window.settle();
                self.count.contacts += 1;
            }
        }
    }

    /// Every point of every panel by a click.
    pub(crate) fn places_all(&mut self, window: &mut Window) {
        for panel in self.stride() {
            self.places_panel(window, panel);
        }
    }

    fn places_panel(&mut self, window: &mut Window, panel: u32) {
        self.goes_to(window, panel);
        for keypoint in Keypoint::all() {
            let state = self.true_panel(panel).keypoints.get(keypoint).unwrap().state;
            self.count.keys += usize::from(state == KeypointState::Occluded);
            self.puts(window, panel, keypoint, state);
        }
        window.settle();
    }

    fn goes_to(&mut self, window: &mut Window, panel: u32) {
        if window.session().panel != panel {
            self.count.keys += 1;
            window.session().go_to(panel);
            window.settle();
        }
    }

    /// A click that places a point, or the drag that corrects it.
    fn puts(&mut self, window: &mut Window, panel: u32, keypoint: Keypoint, state: KeypointState) {
        let ([x, y], sd) = (self.true_px(panel, keypoint), self.sd_px(panel, keypoint));
        let [a, b] = self.hand[(panel as usize - 1) * muybridge_capture::KEYPOINT_COUNT + keypoint.index()];
        let placed = Placed { at_px: Some([x + sd * a, y + sd * b]), state, by: PlacedBy::Hand, sd_px: None };
        window.session().edit("Place", |draft| draft.panel_mut(panel).keypoints.insert(keypoint, placed));
        self.count.points += 1;
    }

    /// The first panel by hand, every other one proposed and looked over.
    pub(crate) fn corrects_proposals(&mut self, window: &mut Window) {
        let stride = self.stride();
        self.places_panel(window, stride[0]);
        for panel in &stride[1..] {
            self.looks_over(window, *panel);
        }
    }

    fn looks_over(&mut self, window: &mut Window, panel: u32) {
        self.goes_to(window, panel);
        self.proposes(window);
        let mut wrong = self.wrong(window, panel);
        while wrong.len() >= MANY {
            self.corrects(window, panel, &wrong[..WORST]);
            self.proposes(window);
            wrong = self.wrong(window, panel);
        }
        self.corrects(window, panel, &wrong);
    }

    fn proposes(&mut self, window: &mut Window) {
        window.run(Command::ProposeTracked);
        self.count.keys += 1;
    }

    fn corrects(&mut self, window: &mut Window, panel: u32, keypoints: &[Keypoint]) {
        for keypoint in keypoints {
            let placed =
                window.session().draft().panel(panel).and_then(|p| p.keypoints.get(*keypoint).copied());
            self.puts(window, panel, *keypoint, placed.map_or(KeypointState::Visible, |placed| placed.state));
        }
        window.settle();
    }

    /// Proposed points that are visibly wrong, worst first.
    fn wrong(&self, window: &mut Window, panel: u32) -> Vec<Keypoint> {
        let draft = window.session().draft();
        let keypoints = &draft.panel(panel).unwrap().keypoints;
        let off = |keypoint: Keypoint| match keypoints.get(keypoint) {
            Some(Placed { by: PlacedBy::Hand, .. }) => 0.0,
            Some(Placed { at_px: Some(at_px), .. }) => {
                distance(*at_px, self.true_px(panel, keypoint)) / self.sd_px(panel, keypoint)
            }
            _ => f64::INFINITY,
        };
        let mut wrong: Vec<(Keypoint, f64)> = Keypoint::all().map(|k| (k, off(k))).collect();
        wrong.retain(|(_, off)| *off > LEFT_ALONE);
        wrong.sort_by(|a, b| b.1.total_cmp(&a.1));
        wrong.into_iter().map(|(keypoint, _)| keypoint).collect()
    }

    /// Root mean square distance of the placed points of the stride from the truth, as a share of the withers height.
    pub(crate) fn rms_of_points(&self, window: &mut Window) -> f64 {
        let draft = window.session().draft().clone();
        let off = |panel: u32, keypoint: Keypoint| {
            let at_px = draft.panel(panel).unwrap().keypoints.place(keypoint).unwrap();
            distance(at_px, self.true_px(panel, keypoint))
        };
        self.rms(
            self.stride()
                .into_iter()
                .flat_map(|p| Keypoint::all().map(move |k| (p, k)))
                .map(|(p, k)| off(p, k)),
        )
    }

    /// The same of the fitted joints.
    pub(crate) fn rms_of_joints(&self, fit: &muybridge_fitting::stride_fit::StrideFit) -> f64 {
        let kinematics = fit.kinematics();
        let slots = fit.problem.order.iter().map(|i| fit.observation.panels[*i].camera.panel).enumerate();
        let places = slots.flat_map(|(slot, panel)| Keypoint::all().map(move |k| (slot, panel, k)));
        self.rms(places.map(|(slot, panel, k)| {
            distance(fit.place_px(slot, &kinematics[slot], k), self.true_px(panel, k))
        }))
    }

    fn rms(&self, distances_px: impl Iterator<Item = f64>) -> f64 {
        muybridge_fitting::stride_fit::rms(distances_px) / self.withers_px
    }
}
