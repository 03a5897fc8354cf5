//! An open plate: its document, its pictures, what is looked at, and the change that is under way.

use std::path::PathBuf;

use egui::Context;
use muybridge_capture::{
    Document, Draft, Facing, Keypoint, KeypointState, Panel, PanelAnnotation, locate_image,
};

use crate::canvas::PanelZoom;
use crate::derived::Derived;
use crate::figure::FigureView;
use crate::fit_state::FitState;
use crate::picture::{PlateImages, PlateTextures, Source, ViewTransform};
use crate::proposal::Proposals;
use crate::second_pass::SecondPass;
use crate::views::calibrate_page::CalibrateState;
use crate::views::footfall_bar::BarDrag;
use crate::views::play_page::PlayState;
use crate::views::pose_page::PoseDrag;

/// What the window shows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Page {
    /// Panels and their order.
    #[default]
    Plate,
    /// Scale, position, time.
    Calibrate,
    /// Points and skeleton.
    Pose,
    /// Footfalls and numbers.
    Gait,
    /// The fitted stride, moving.
    Play,
}

/// What a click or drag does on the pose page.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Tool {
    /// Places the next point of the drawn order.
    #[default]
    Guided,
    /// Places the selected point.
    Free,
    /// Moves the skeleton.
    Skeleton,
}

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Shown {
    /// Points and lines at all.
    pub marks: bool,
    /// Skeletons of the neighbouring panels.
    pub ghost_skeletons: bool,
    /// Photograph of the panel before.
    pub ghost_photograph: bool,
    /// Paths of the hooves.
    pub hoof_trails: bool,
    /// The fit and its residuals.
    pub fit: bool,
    /// The glass beside the pointer.
    pub magnifier: bool,
    /// All panels at once.
    pub sheet: bool,
}

impl Default for Shown {
    fn default() -> Self {
        Self {
            marks: true,
            ghost_skeletons: true,
            ghost_photograph: false,
            hoof_trails: false,
            fit: true,
            magnifier: false,
            sheet: false,
        }
    }
}

/// A change that is shown but not made yet: a drag under way.
struct Preview {
    label: String,
    draft: Draft,
}

/// An open plate.
pub struct Session {
    /// Its documents.
    pub document: Document,
    /// Its pictures.
    pub images: PlateImages,
    /// What of them is on the graphics card.
    pub textures: PlateTextures,
    /// Page looked at.
    pub page: Page,
    /// Number of the panel looked at.
    pub panel: u32,
    /// Selected point.
    pub selected: Option<Keypoint>,
    /// What a click does.
    pub tool: Tool,
    /// What is drawn.
    pub shown: Shown,
    /// How close one looks.
    pub zoom: PanelZoom,
    /// What follows from the documents.
    pub derived: Derived,
    /// The fit.
    pub fit: FitState,
    /// Proposals under way and how sure they were.
    pub proposals: Proposals,
    /// A blind second pass.
    pub second_pass: Option<SecondPass>,
    /// How well points were placed twice, after a second pass.
    pub repeatability: Option<muybridge_fitting::repeatability::Repeatability>,
    /// State of the point that the next click places.
    pub next_state: KeypointState,
    /// Where the plate is on the Plate page; none while the whole of it is shown.
    pub plate_view: Option<ViewTransform>,
    /// A drag on the photograph.
    pub pose_drag: Option<PoseDrag>,
    /// A drag on the footfall bar.
    pub bar_drag: Option<BarDrag>,
    /// Tools of the Calibrate page.
    pub calibrate: CalibrateState,
    /// The small figure.
    pub figure: FigureView,
    /// The moving stride.
    pub play: PlayState,
    preview: Option<Preview>,
    state: u64,
}

impl Session {
    /// Shows a document; its pictures are read in the background.
    pub fn new(document: Document, context: &Context) -> Self {
        let manifest = &document.draft().manifest;
        let paths: Vec<PathBuf> =
            manifest.images.iter().map(|image| locate_image(document.manifest_path(), &image.file)).collect();
        let context = context.clone();
        let images = PlateImages::load(paths, 0, move || context.request_repaint());
        let panel = manifest.panels.first().map_or(1, |panel| panel.panel);
        let page = if manifest.panels.is_empty() { Page::Plate } else { Page::Pose };
        Self {
            images,
            textures: PlateTextures::default(),
            page,
            panel,
            selected: None,
            tool: Tool::default(),
            shown: Shown::default(),
            zoom: PanelZoom::default(),
            derived: Derived::default(),
            fit: FitState::default(),
            proposals: Proposals::default(),
            second_pass: None,
            repeatability: None,
            next_state: KeypointState::Visible,
            plate_view: None,
            pose_drag: None,
            bar_drag: None,
            calibrate: CalibrateState::default(),
            figure: FigureView::new(muybridge_core::Side::Right),
            play: PlayState::default(),
            preview: None,
            state: 0,
            document,
        }
    }

    /// The documents as they are shown: with the change under way.
    pub fn draft(&self) -> &Draft {
        self.preview.as_ref().map_or(self.document.draft(), |preview| &preview.draft)
    }

    /// A number that changes whenever [`Session::draft`] does.
    pub fn state(&self) -> u64 {
        self.state
    }

    /// Whether a drag is under way.
    pub fn is_dragging(&self) -> bool {
        self.preview.is_some()
    }

    /// Makes a change at once, as one step. What is being typed or dragged is a step of its own before it.
    pub fn edit(&mut self, label: &str, change: impl FnOnce(&mut Draft)) {
        self.commit();
        self.document.edit(label, change);
        self.note_change();
    }

    /// Shows what a drag would make of the document as it was before the drag.
    pub fn preview(&mut self, label: &str, change: impl FnOnce(&mut Draft)) {
        let mut draft = self.document.draft().clone();
        change(&mut draft);
        self.preview = Some(Preview { label: label.into(), draft });
        self.state += 1;
    }

    /// Makes the change under way, as one step.
    pub fn commit(&mut self) {
        if let Some(preview) = self.preview.take() {
            self.document.edit(&preview.label, |draft| *draft = preview.draft);
            self.note_change();
        }
    }

    /// Forgets the change under way.
    pub fn cancel(&mut self) {
        (self.pose_drag, self.bar_drag) = (None, None);
        self.calibrate.let_go();
        if self.preview.take().is_some() {
            self.state += 1;
        }
    }

    /// To be called after the document was changed directly: undo, redo, saving under another name.
    pub fn note_change(&mut self) {
        self.state += 1;
        if !self.draft().manifest.panels.iter().any(|panel| panel.panel == self.panel) {
            self.panel = self.draft().manifest.panels.first().map_or(1, |panel| panel.panel);
        }
    }

    /// Which way the animal faces; to the right until somebody has said.
    pub fn facing(&self) -> Facing {
        self.draft().manifest.facing.unwrap_or(Facing::Right)
    }

    /// The panel looked at.
    pub fn panel_place(&self) -> Option<&Panel> {
        self.place_of(self.panel)
    }

    /// A panel's place on the plate.
    pub fn place_of(&self, panel: u32) -> Option<&Panel> {
        self.draft().manifest.panels.iter().find(|p| p.panel == panel)
    }

    /// The annotation of the panel looked at.
    pub fn panel_annotation(&self) -> Option<&PanelAnnotation> {
        self.draft().panel(self.panel)
    }

    /// Numbers of all panels, in order.
    pub fn panel_numbers(&self) -> Vec<u32> {
        self.draft().manifest.panels.iter().map(|panel| panel.panel).collect()
    }

    /// Numbers of the panels of the stride, in order: all, while none is excluded.
    pub fn stride_numbers(&self) -> Vec<u32> {
        let draft = self.draft();
        let span = draft.annotation.stride;
        let used = |panel: &u32| {
            let usage = draft.panel(*panel).map(|p| p.usage);
            (span.first..=span.last).contains(panel)
                && usage.is_none_or(|usage| usage == muybridge_capture::PanelUse::Stride)
        };
        self.panel_numbers().into_iter().filter(used).collect()
    }

    /// The panel so many steps on, around the plate; none without panels.
    pub fn panel_after(&self, steps: i64) -> Option<u32> {
        let numbers = self.panel_numbers();
        let at = numbers.iter().position(|number| *number == self.panel).unwrap_or(0) as i64;
        let count = numbers.len() as i64;
        (count > 0).then(|| numbers[(at + steps).rem_euclid(count) as usize])
    }

    /// The panel so many steps on in the stride, around its end; around the plate for a panel that is not of the stride.
    pub fn neighbour(&self, steps: i64) -> Option<u32> {
        let stride = self.stride_numbers();
        let Some(at) = stride.iter().position(|number| *number == self.panel) else {
            return self.panel_after(steps);
        };
        Some(stride[(at as i64 + steps).rem_euclid(stride.len() as i64) as usize])
    }

    /// Looks at another panel.
    pub fn go_to(&mut self, panel: u32) {
        self.commit();
        self.panel = panel;
        self.selected = self.selected.filter(|_| self.tool != Tool::Guided);
        if let Some(image) = self.panel_place().map(|place| place.image) {
            self.images.want(image);
        }
    }

    /// The picture of a panel, once it has been read, with the textures to draw it.
    pub fn picture(&mut self, image: usize) -> Option<(&mut PlateTextures, Source<'_>)> {
        let pyramid = self.images.ready(image)?;
        Some((&mut self.textures, Source { image, pyramid }))
    }
}
