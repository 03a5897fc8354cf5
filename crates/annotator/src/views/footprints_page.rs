//! The Footprints page: a motion made from footprints, which can be grasped; it needs no plate.

mod backdrop;
mod curve;
mod drawing;
mod fields;
mod gesture;
mod grips;
mod inspector;
mod plan;
mod plan_view;
mod scene;
mod selection_box;
mod terrain_box;
mod timing;
mod transport;
mod wander;

use std::path::PathBuf;
use std::sync::Arc;

use egui::{CentralPanel, Context, Panel, ScrollArea, Ui};

use crate::app::PageContext;
use crate::command::Command;
use crate::footprints::Editor;
use crate::footprints::document::TrackDocument;
use crate::footprints::edits;
use crate::footprints::solving::Waker;
use crate::footprints::wandering::Wandering;
use crate::views::ride_page::{command_button, with_key};
use crate::views::tabs;
use curve::Curve;
use drawing::FootShape;
use gesture::Gesture;
use plan::{Plan, Tool};
use scene::SceneView;
use timing::TimingView;

/// Way of an arrow key, metres.
const NUDGE_M: f64 = 0.01;
/// Zoom of a key.
const ZOOM: f64 = 1.25;

/// The Footprints page with everything that stays while another page is looked at.
pub struct FootprintsPage {
    is_open: bool,
    editor: Editor,
    plan: Plan,
    timing: TimingView,
    scene: SceneView,
    curve: Curve,
    shape: FootShape,
    gesture: Option<Gesture>,
    walk: Option<Wandering>,
    /// Seed of the next walk.
    seed: u64,
    waker: Option<Waker>,
    /// egui's time at the frame before, s.
    last_s: Option<f64>,
}

impl Default for FootprintsPage {
    fn default() -> Self {
        let editor = Editor::default();
        Self {
            is_open: false,
            shape: FootShape::of(&editor.track().model),
            editor,
            plan: Plan::default(),
            timing: TimingView::default(),
            scene: SceneView::default(),
            curve: Curve::default(),
            gesture: None,
            walk: None,
            seed: 1,
            waker: None,
            last_s: None,
        }
    }
}

impl FootprintsPage {
    /// Whether the page is looked at.
    pub fn is_open(&self) -> bool {
        self.is_open
    }

    /// Goes to the page; changes are kept in a folder until they are saved.
    pub fn open(&mut self, context: &Context, safe_folder: Option<PathBuf>) {
        self.is_open = true;
        if self.waker.is_none() {
            let context = context.clone();
            self.waker = Some(Arc::new(move || context.request_repaint()));
            self.editor.keep_safe_in(safe_folder);
        }
    }

    /// Leaves the page; time stands still until it is opened again.
    pub fn close(&mut self) {
        self.commit();
        (self.is_open, self.last_s) = (false, None);
    }

    /// The track and its motion.
    pub fn editor(&self) -> &Editor {
        &self.editor
    }

    /// The same, to be changed.
    pub fn editor_mut(&mut self) -> &mut Editor {
        &mut self.editor
    }

    /// The walk under way.
    pub fn walk(&self) -> Option<&Wandering> {
        self.walk.as_ref()
    }

    /// Shows another track; what was there is forgotten as it is.
    pub fn show_document(&mut self, document: TrackDocument) {
        self.editor.show(document);
        (self.gesture, self.walk) = (None, None);
        self.plan = Plan::default();
        self.timing.show_all();
    }

    /// Whether the track has changes that are not saved, what is being dragged among them.
    pub fn has_unsaved_work(&mut self) -> bool {
        self.commit();
        self.editor.document.is_changed()
    }

    /// Makes the change under way.
    pub fn commit(&mut self) {
        self.gesture = None;
        self.editor.commit();
    }

    /// Waits until the motion of the track as it is was found: for programs without a window.
    pub fn wait(&mut self) {
        let waker: Waker = Arc::new(|| {});
        for _ in 0..2 {
            self.editor.solve(&waker);
            self.editor.solving.wait();
        }
    }

    /// Why a command of this page cannot act now.
    pub fn why_not(&self, command: Command) -> Option<&'static str> {
        use Command as C;
        let editor = &self.editor;
        let nothing = editor.selected.is_empty();
        match command {
            _ if !self.is_open => Some("Go to the Footprints page first"),
            C::FootprintsLeave | C::FootprintsWander | C::FootprintsCamera => None,
            C::FootprintsKeepWalk if self.walk.is_none() => Some("No bird wanders"),
            C::FootprintsPlay | C::FootprintsKeepWalk if self.walk.is_some() => None,
            _ if self.walk.is_some() => Some("Stop the walk, or keep it as a track, first"),
            C::FootprintsUndo if editor.document.undo_label().is_none() => Some("There is nothing to undo"),
            C::FootprintsRedo if editor.document.redo_label().is_none() => Some("There is nothing to redo"),
            C::FootprintsDelete if nothing && editor.path_point.is_none() => {
                Some("Select prints or a point of the path first")
            }
            C::FootprintsNudgeLeft
            | C::FootprintsNudgeRight
            | C::FootprintsNudgeUp
            | C::FootprintsNudgeDown
                if nothing =>
            {
                Some("Select prints first")
            }
            C::FootprintsLay if editor.track().path.is_none() => Some("Draw a path first"),
            C::FootprintsPlay | C::FootprintsStepForward | C::FootprintsStepBack
                if editor.motion().is_none() =>
            {
                Some("There is no motion yet")
            }
            _ => None,
        }
    }

    /// Does a command of this page; false when it is another's.
    pub fn run(&mut self, command: Command) -> bool {
        use Command as C;
        if command != C::FootprintsLeave {
            self.commit();
        }
        let end_s = self.editor.end_s();
        let editor = &mut self.editor;
        match command {
            C::FootprintsLeave => self.step_out(),
            C::FootprintsUndo => editor.undo(),
            C::FootprintsRedo => editor.redo(),
            C::FootprintsAdd => editor.add_print(None),
            C::FootprintsDelete => editor.delete_selected(),
            C::FootprintsSelectAll => editor.selected = (0..editor.prints().len()).collect(),
            C::FootprintsNextPrint => editor.select_next(1),
            C::FootprintsPreviousPrint => editor.select_next(-1),
            C::FootprintsNudgeLeft => self.nudge([-NUDGE_M, 0.0]),
            C::FootprintsNudgeRight => self.nudge([NUDGE_M, 0.0]),
            C::FootprintsNudgeUp => self.nudge([0.0, -NUDGE_M]),
            C::FootprintsNudgeDown => self.nudge([0.0, NUDGE_M]),
            C::FootprintsPath => {
                self.plan.tool = if self.plan.tool == Tool::Path { Tool::Prints } else { Tool::Path };
            }
            C::FootprintsLay => editor.lay_prints(),
            C::FootprintsPlay => match &mut self.walk {
                Some(walk) => walk.pause(!walk.is_paused()),
                None => editor.playback.toggle(end_s),
            },
            C::FootprintsStepForward => editor.playback.step(1.0, end_s),
            C::FootprintsStepBack => editor.playback.step(-1.0, end_s),
            C::FootprintsBegin => editor.playback.go_to(0.0, end_s),
            C::FootprintsShowAll => {
                self.plan.show_all();
                self.timing.show_all();
            }
            C::FootprintsZoomIn => self.plan.zoom_by(ZOOM),
            C::FootprintsZoomOut => self.plan.zoom_by(1.0 / ZOOM),
            C::FootprintsCamera => self.scene.next_camera(),
            C::FootprintsWander => self.wander(),
            _ => return false,
        }
        true
    }

    fn nudge(&mut self, by_m: [f64; 2]) {
        let prints = self.editor.selected.clone();
        self.editor.edit("Nudge", |track| edits::move_by(track, &prints, by_m));
    }

    /// Ends what is under way, then the tool, then the selection, then the page.
    fn step_out(&mut self) {
        if self.editor.document.is_changing() {
            self.gesture = None;
            self.editor.document.cancel();
        } else if self.plan.tool == Tool::Path {
            self.plan.tool = Tool::Prints;
        } else if !self.editor.selected.is_empty() || self.editor.path_point.is_some() {
            self.editor.deselect();
        } else {
            self.close();
        }
    }

    /// Begins a walk, or ends it.
    fn wander(&mut self) {
        if self.walk.take().is_some() {
            self.plan = Plan::default();
            return;
        }
        self.editor.playback.is_playing = false;
        match Wandering::new(self.seed) {
            Ok(walk) => {
                self.seed += 1;
                (self.walk, self.plan) = (Some(walk), Plan::default());
            }
            Err(fault) => self.editor.solving.note_fault(fault),
        }
    }

    /// The whole page.
    pub fn show(&mut self, ui: &mut Ui, has_plate: bool, page: &mut PageContext<'_>) {
        let leave = (Command::PageFootprints, Command::FootprintsLeave);
        Panel::top("pages").show(ui, |ui| tabs::show_other(ui, leave, has_plate, page));
        self.advance(ui);
        if self.walk.is_some() {
            self.show_walk(ui, page);
            return;
        }
        if let Some(waker) = self.waker.clone() {
            self.editor.solve(&waker);
        }
        let version = self.editor.solving.version();
        self.curve.follow(self.editor.motion(), version);
        if !self.shape.is_of(&self.editor.track().model) {
            self.shape = FootShape::of(&self.editor.track().model);
        }
        let revision = self.editor.document.revision();
        let Self { editor, plan, timing, scene, curve, shape, gesture, .. } = self;
        Panel::bottom("footprints time").resizable(false).show(ui, |ui| {
            transport::show(ui, editor, page);
            timing::show(ui, timing, editor, gesture, curve);
            ui.add_space(4.0);
        });
        Panel::right("footprints inspector").default_size(300.0).size_range(260.0..=440.0).show(ui, |ui| {
            let scroll = ScrollArea::vertical().id_salt("footprints").auto_shrink(false);
            scroll.show(ui, |ui| inspect(ui, editor, curve, plan.tool == Tool::Path, page));
        });
        figure_panel(ui, |ui| {
            scene.controls(ui, &with_key(page, Command::FootprintsCamera));
            scene.show(ui, editor, curve, shape);
        });
        CentralPanel::no_frame().show(ui, |ui| plan::show(ui, plan, editor, gesture, curve, shape));
        if editor.document.revision() != revision {
            ui.ctx().request_repaint();
        }
    }

    fn show_walk(&mut self, ui: &mut Ui, page: &mut PageContext<'_>) {
        let Some(walk) = &self.walk else { return };
        if !self.shape.is_of(&walk.model().name) {
            self.shape = FootShape::of(&walk.model().name);
        }
        let Self { plan, scene, shape, .. } = self;
        let mut keeps = false;
        Panel::right("walk inspector").default_size(300.0).size_range(260.0..=440.0).show(ui, |ui| {
            keeps = wander::inspector(ui, walk, page);
        });
        figure_panel(ui, |ui| {
            scene.controls(ui, &with_key(page, Command::FootprintsCamera));
            scene.show_wandering(ui, walk, shape);
        });
        CentralPanel::no_frame().show(ui, |ui| wander::show(ui, plan, walk, shape));
        if keeps {
            page.commands.push(Command::FootprintsKeepWalk);
        }
    }

    /// The walk so far as a track, and the walk is over; none without one.
    pub fn take_walk(&mut self) -> Option<TrackDocument> {
        let walk = self.walk.take()?;
        self.plan = Plan::default();
        Some(TrackDocument::new(walk.to_track()).unsaved())
    }

    /// Moves on with the time that has passed.
    fn advance(&mut self, ui: &Ui) {
        let now_s = ui.input(|input| input.time);
        let passed_s = self.last_s.map_or(0.0, |last_s| now_s - last_s);
        let end_s = self.editor.end_s();
        let moves = match &mut self.walk {
            Some(walk) => {
                walk.advance(passed_s);
                !walk.is_paused()
            }
            None => {
                self.editor.playback.advance(passed_s, end_s);
                self.editor.playback.is_playing
            }
        };
        self.last_s = moves.then_some(now_s);
        if moves {
            ui.ctx().request_repaint();
        }
    }
}

/// The figure beside the plan.
fn figure_panel(ui: &mut Ui, content: impl FnOnce(&mut Ui)) {
    let width = ui.available_width();
    Panel::right("footprints figure")
        .default_size(0.42 * width)
        .size_range(120.0..=(0.75 * width).max(130.0))
        .show(ui, content);
}

fn inspect(ui: &mut Ui, editor: &mut Editor, curve: &Curve, draws: bool, page: &mut PageContext<'_>) {
    section(ui, "Track", |ui| wander::files(ui, editor, page));
    section(ui, "Selected", |ui| selection_box::show(ui, editor));
    section(ui, "What to look at", |ui| inspector::concerns(ui, editor, curve));
    section(ui, "Who walks", |ui| inspector::model(ui, editor));
    section(ui, "Path", |ui| inspector::path(ui, editor, draws, page));
    section(ui, "Ground", |ui| terrain_box::show(ui, editor));
    section(ui, "Energy", |ui| inspector::energy(ui, editor));
}

/// A part of the inspector that can be folded away.
fn section(ui: &mut Ui, title: &str, content: impl FnOnce(&mut Ui)) {
    let heading = egui::RichText::new(title).strong().size(14.0);
    egui::CollapsingHeader::new(heading)
        .id_salt(("footprints", title))
        .default_open(true)
        .show_unindented(ui, content);
    ui.add_space(6.0);
}
