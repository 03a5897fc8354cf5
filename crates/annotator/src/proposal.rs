//! Proposals: points tracked from known panels, and what is seen in the photographs without points. In the background.

mod settle;

use std::collections::BTreeMap;
use std::sync::Arc;

use egui::Context;
use image::GrayImage;
use muybridge_capture::{Draft, Keypoint, Keypoints, Panel, Placed};
use muybridge_imaging::PanelView;
use muybridge_imaging::acquire::{FoundPanels, find_panels};
use muybridge_imaging::see::{Silhouette, Wall, silhouettes, walls};
use muybridge_imaging::track::{PanelPoints, Proposal, propose};

use crate::derived::Derived;
use crate::job::{Job, take_answer};
use crate::picture::{PlateImages, Pyramid};
use crate::toast::Messages;
use settle::Settling;

/// Longer side of the views that are looked at, px: silhouettes and tracking are as good as at full size (docs/plates.md).
const VIEW_PX: u32 = 700;

/// All panels of a plate as they are looked at.
struct Looked {
    quads_px: Vec<[[f64; 2]; 4]>,
    views: Vec<PanelView>,
    silhouettes: Vec<Silhouette>,
    walls: Vec<Wall>,
}

/// What tracking has found in a panel, and from what.
struct Evidence {
    panels: Vec<Panel>,
    known: Vec<(u32, Keypoints)>,
    tracked: Vec<Proposal>,
}

/// What background work brings back.
enum Answer {
    Tracked { panel: u32, proposals: Vec<Proposal>, evidence: Evidence, looked: Arc<Looked> },
    Ground { lines: Vec<(u32, [[f64; 2]; 2])>, looked: Arc<Looked> },
    Uprights { lines: Uprights, looked: Arc<Looked> },
    Split(FoundPanels),
    Failed(String),
}

/// What is to be done with an answer.
pub enum Found {
    /// Points for a panel.
    Points(u32, Vec<Proposal>),
    /// Ground lines by panel, left to right, plate px.
    Ground(Vec<(u32, [[f64; 2]; 2])>),
    /// Panels, and every reason to doubt them.
    Panels(FoundPanels),
}

/// Uprights of the wall by panel, each from its top to its foot, plate px.
pub type Uprights = Vec<(u32, Vec<[[f64; 2]; 2]>)>;

/// Proposals of a session.
#[derive(Default)]
pub struct Proposals {
    running: Option<Job<Answer>>,
    looked: Option<Arc<Looked>>,
    uprights: Option<Uprights>,
    quality: BTreeMap<(u32, Keypoint), (Placed, f64)>,
    evidence: BTreeMap<u32, Evidence>,
}

/// Documents keep a hundredth of a pixel.
const ROUNDED_PX: f64 = 0.0051;

/// Whether a point is still where and what it was, to the precision of the documents.
fn is_unmoved(was: &Placed, is: &Placed) -> bool {
    let near = |(a, b): ([f64; 2], [f64; 2])| a.iter().zip(&b).all(|(a, b)| (a - b).abs() < ROUNDED_PX);
    was.by == is.by && was.at_px.zip(is.at_px).is_some_and(near)
}

/// The pictures of a plate, all read.
fn pyramids(images: &PlateImages) -> Option<Vec<Arc<Pyramid>>> {
    (0..images.states().len()).map(|index| images.ready(index).cloned()).collect()
}

impl Proposals {
    /// What is under way.
    pub fn work(&self) -> Option<&str> {
        self.running.as_ref().map(|job| job.what.as_str())
    }

    /// How sure tracking was of a point, 0 to 1, as long as nobody has moved it.
    pub fn quality(&self, panel: u32, keypoint: Keypoint, placed: &Placed) -> Option<f64> {
        let (was, quality) = self.quality.get(&(panel, keypoint))?;
        is_unmoved(was, placed).then_some(*quality)
    }

    /// Looks for the panels of a plate.
    pub fn split(&mut self, images: &PlateImages, context: &Context) {
        let Some(pyramids) = pyramids(images).filter(|_| self.running.is_none()) else { return };
        self.running = Some(Job::start("Finding panels", context, move || {
            let pictures: Vec<&GrayImage> = pyramids.iter().map(|pyramid| pyramid.gray()).collect();
            find_panels(&pictures).map_or_else(|error| Answer::Failed(error.to_string()), Answer::Split)
        }));
    }

    /// Tracks from known panels, the one beside `panel` last, into it, and lays what is found on the skeleton. What was tracked
    /// before from the same points is only laid on the skeleton anew.
    pub fn track(
        &mut self,
        (draft, derived): (&Draft, &Derived),
        known: &[u32],
        panel: u32,
        images: &PlateImages,
        context: &Context,
    ) {
        let Some(pyramids) = pyramids(images).filter(|_| self.running.is_none()) else { return };
        let points = |number: &u32| Some((*number, draft.panel(*number)?.keypoints.clone()));
        let known: Vec<(u32, Keypoints)> = known.iter().filter_map(points).collect();
        let panels = draft.manifest.panels.clone();
        let before = self.evidence.remove(&panel);
        let before = before.filter(|before| before.known == known && before.panels == panels);
        let (draft, looked, settling) = (draft.clone(), self.looked.clone(), Settling::new(derived));
        self.running = Some(Job::start(format!("Tracking into panel {panel}"), context, move || {
            let Some(looked) = look(&draft, &pyramids, looked) else { return no_view() };
            let tracked = match before {
                Some(before) => Some(before.tracked),
                None => tracked(&panels, &looked, &known, panel),
            };
            let Some(tracked) = tracked else { return no_view() };
            let proposals = settling.settle(&draft, panel, &tracked);
            Answer::Tracked { panel, proposals, evidence: Evidence { panels, known, tracked }, looked }
        }));
    }

    /// Looks for the ground line of every panel.
    pub fn find_ground(&mut self, draft: &Draft, images: &PlateImages, context: &Context) {
        let Some(pyramids) = pyramids(images).filter(|_| self.running.is_none()) else { return };
        let (draft, looked) = (draft.clone(), self.looked.clone());
        self.running = Some(Job::start("Finding ground lines", context, move || {
            let Some(looked) = look(&draft, &pyramids, looked) else { return no_view() };
            let lines = draft.manifest.panels.iter().zip(&looked.walls).zip(&looked.views);
            let lines = lines.filter_map(|((panel, wall), view)| {
                Some((panel.panel, wall.ground.as_ref()?.on_plate_px(view)))
            });
            Answer::Ground { lines: lines.collect(), looked: Arc::clone(&looked) }
        }));
    }

    /// Looks for the uprights of every panel's wall; [`Proposals::take_uprights`] has them when they are found.
    pub fn find_uprights(&mut self, draft: &Draft, images: &PlateImages, context: &Context) {
        let Some(pyramids) = pyramids(images).filter(|_| self.running.is_none()) else { return };
        let (draft, looked) = (draft.clone(), self.looked.clone());
        self.running = Some(Job::start("Finding uprights", context, move || {
            let Some(looked) = look(&draft, &pyramids, looked) else { return no_view() };
            let walls = draft.manifest.panels.iter().zip(&looked.walls).zip(&looked.views);
            let lines = walls.map(|((panel, wall), view)| {
                (panel.panel, wall.uprights.iter().map(|line| line.on_plate_px(view)).collect())
            });
            Answer::Uprights { lines: lines.collect(), looked: Arc::clone(&looked) }
        }));
    }

    /// Uprights that were found since the last call.
    pub fn take_uprights(&mut self) -> Option<Uprights> {
        self.uprights.take()
    }

    /// Takes what has been found.
    pub fn finish(&mut self, messages: &mut Messages) -> Option<Found> {
        let answer = take_answer(&mut self.running)?.unwrap_or_else(Answer::Failed);
        match answer {
            Answer::Tracked { panel, proposals, evidence, looked } => {
                self.looked = Some(looked);
                self.evidence.insert(panel, evidence);
                for proposal in &proposals {
                    self.quality.insert((panel, proposal.keypoint), (proposal.placed, proposal.quality));
                }
                Some(Found::Points(panel, proposals))
            }
            Answer::Ground { lines, looked } => {
                self.looked = Some(looked);
                Some(Found::Ground(lines))
            }
            Answer::Uprights { lines, looked } => {
                self.looked = Some(looked);
                self.uprights = Some(lines);
                None
            }
            Answer::Split(found) => Some(Found::Panels(found)),
            Answer::Failed(trouble) => {
                messages.trouble(trouble);
                None
            }
        }
    }
}

/// Points of a panel, tracked from known ones; none for a panel that the plate does not have.
fn tracked(
    panels: &[Panel],
    looked: &Looked,
    known: &[(u32, Keypoints)],
    panel: u32,
) -> Option<Vec<Proposal>> {
    let index = |number: u32| panels.iter().position(|p| p.panel == number);
    let known = known.iter().filter_map(|(number, points)| {
        let at = index(*number)?;
        let silhouette = Some(&looked.silhouettes[at].mask);
        Some(PanelPoints { view: &looked.views[at], silhouette, points })
    });
    let next = index(panel)?;
    let known: Vec<PanelPoints> = known.collect();
    Some(propose(&known, &looked.views[next], Some(&looked.silhouettes[next].mask)))
}

fn no_view() -> Answer {
    Answer::Failed("A panel's corners do not make a quadrilateral; correct them on the Plate page".into())
}

/// Views and silhouettes of all panels: those made before, if the panels are the same.
fn look(draft: &Draft, pyramids: &[Arc<Pyramid>], before: Option<Arc<Looked>>) -> Option<Arc<Looked>> {
    let quads_px: Vec<_> = draft.manifest.panels.iter().map(|panel| panel.quad_px).collect();
    if let Some(before) = before.filter(|before| before.quads_px == quads_px) {
        return Some(before);
    }
    let view = |panel: &muybridge_capture::Panel| {
        PanelView::new(pyramids.get(panel.image)?.gray(), panel.quad_px, VIEW_PX)
    };
    let views: Vec<PanelView> = draft.manifest.panels.iter().map(view).collect::<Option<_>>()?;
    let silhouettes = silhouettes(&views);
    let walls = walls(&views, &silhouettes);
    Some(Arc::new(Looked { quads_px, views, silhouettes, walls }))
}
