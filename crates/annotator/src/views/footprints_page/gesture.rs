//! What a drag does to the track, in the plan and in the timing diagram: always from what was there when it began.

use egui::{Pos2, Vec2};
use muybridge_footprints::{PathPoint, StepTiming};

use super::plan_view::Canvas;
use crate::footprints::Editor;
use crate::footprints::edits::{
    self, direction, heading_deg, is_left, move_by, set_stance, set_step, shift_footfall, turn_to,
};

/// Headings go by these steps while Shift is held, degrees.
const SNAP_DEG: f64 = 15.0;
/// A tangent's handle is at this share of it from its point: Hermite's tangent as Bézier's handle.
pub(super) const TANGENT_SHARE: f64 = 1.0 / 3.0;

/// What is grasped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Grasp {
    /// The selected prints.
    Prints,
    /// Where a print's toes point.
    Heading(usize),
    /// The end of a dagger's bar.
    Stance(usize),
    /// A dagger's crossbar.
    Step(usize),
    /// A point of the path.
    PathPoint(usize),
    /// The tangent of a point, its end ahead or its end behind.
    Tangent(usize, f64),
    /// A bar of the timing diagram: the footfall and the lift-off move together.
    Bar(usize),
    /// The beginning of a bar: the lift-off stays.
    Footfall(usize),
}

/// A drag under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gesture {
    grasp: Grasp,
    /// Where the button went down.
    from: Pos2,
    /// Whether it is in the timing diagram.
    in_time: bool,
    /// Times of the print before and of the print as they were.
    was: [StepTiming; 2],
}

impl Gesture {
    /// Begins a drag where the button went down.
    pub(super) fn new(editor: &Editor, grasp: Grasp, from: Pos2) -> Self {
        let print = match grasp {
            Grasp::Stance(print) | Grasp::Step(print) | Grasp::Bar(print) | Grasp::Footfall(print) => print,
            _ => 0,
        };
        let timing = |print: usize| {
            editor.timing(print).unwrap_or(StepTiming { stance_time_s: 0.5, step_time_s: 0.5 })
        };
        Self { grasp, from, in_time: false, was: [timing(print.saturating_sub(1)), timing(print)] }
    }

    /// Begins a drag in the timing diagram.
    pub(super) fn in_time(editor: &Editor, grasp: Grasp, from: Pos2) -> Self {
        Self { in_time: true, ..Self::new(editor, grasp, from) }
    }

    /// Whether this is the drag of a handle in the plan.
    pub(super) fn is_in_plan(&self, grasp: Grasp) -> bool {
        self.grasp == grasp && !self.in_time
    }

    /// Whether this is the drag of a handle in the timing diagram.
    pub(super) fn is_in_time(&self, grasp: Grasp) -> bool {
        self.grasp == grasp && self.in_time
    }

    /// Follows the pointer in the plan; `points_per_s` is the scale of the daggers.
    pub(super) fn follow_in_plan(
        &self,
        editor: &mut Editor,
        canvas: &Canvas,
        to: Pos2,
        points_per_s: f64,
        snaps: bool,
    ) {
        let (from_m, to_m) = (canvas.plan(self.from), canvas.plan(to));
        let by_m = [to_m[0] - from_m[0], to_m[1] - from_m[1]];
        match self.grasp {
            Grasp::Prints => {
                let prints = editor.selected.clone();
                let label = if prints.len() == 1 { "Move a print" } else { "Move prints" };
                editor.preview(label, |track| move_by(track, &prints, by_m));
            }
            Grasp::Heading(print) => self.turn(editor, print, [from_m, to_m], snaps),
            Grasp::Stance(print) | Grasp::Step(print) => {
                let by_s = dagger_way(editor, canvas, print).dot(to - self.from);
                self.retime(editor, f64::from(by_s) / points_per_s);
            }
            Grasp::PathPoint(point) => editor.document.preview("Move a point of the path", |track| {
                if let Some(point) = track.path.as_mut().and_then(|path| path.points.get_mut(point)) {
                    point.at_m = edits::moved_place(point.at_m, by_m);
                }
            }),
            Grasp::Tangent(point, end) => drag_tangent(editor, point, end, by_m),
            Grasp::Bar(_) | Grasp::Footfall(_) => {}
        }
    }

    /// Follows the pointer in the timing diagram.
    pub(super) fn follow_in_time(&self, editor: &mut Editor, to: Pos2, points_per_s: f64) {
        self.retime(editor, f64::from(to.x - self.from.x) / points_per_s);
    }

    fn retime(&self, editor: &mut Editor, by_s: f64) {
        let was = self.was;
        match self.grasp {
            Grasp::Stance(print) => editor.preview("Stance time", |track| {
                set_stance(track, print, was[1], was[1].stance_time_s + by_s);
            }),
            Grasp::Step(print) => editor.preview("Step time", |track| {
                set_step(track, print, was[1], was[1].step_time_s + by_s);
            }),
            Grasp::Bar(print) => {
                editor.preview("Move a stance", |track| shift_footfall(track, print, was, by_s, false));
            }
            Grasp::Footfall(print) => {
                editor.preview("Move a footfall", |track| shift_footfall(track, print, was, by_s, true));
            }
            _ => {}
        }
    }

    fn turn(&self, editor: &mut Editor, print: usize, [from_m, to_m]: [[f64; 2]; 2], snaps: bool) {
        let Some(at_m) = editor.prints().get(print).map(|print| print.at_m) else { return };
        let angle = |to: [f64; 2]| heading_deg([to[0] - at_m[0], to[1] - at_m[1]]);
        let (others, by_deg) = (editor.selected.clone(), angle(to_m) - angle(from_m));
        editor.preview("Turn a print", |track| {
            let Some(was_deg) = track.prints.get(print).map(|print| print.heading_deg) else { return };
            let heading_deg = was_deg + by_deg;
            let snapped = (heading_deg / SNAP_DEG).round() * SNAP_DEG;
            turn_to(track, print, &others, if snaps { snapped } else { heading_deg });
        });
    }
}

fn drag_tangent(editor: &mut Editor, point: usize, end: f64, by_m: [f64; 2]) {
    let tangent_m = editor.document.committed().path.as_ref().and_then(|path| tangent(&path.points, point));
    let Some(tangent_m) = tangent_m else { return };
    editor.document.preview("Turn the path", |track| {
        if let Some(point) = track.path.as_mut().and_then(|path| path.points.get_mut(point)) {
            let turned = [0, 1].map(|i| tangent_m[i] + end * by_m[i] / TANGENT_SHARE);
            point.tangent_m = Some(edits::moved_place(turned, [0.0; 2]));
        }
    });
}

/// The tangent of a point of a path: its own, or half the way between its neighbours.
pub(super) fn tangent(points: &[PathPoint], point: usize) -> Option<[f64; 2]> {
    let this = points.get(point)?;
    if this.tangent_m.is_some() {
        return this.tangent_m;
    }
    let before = &points[point.saturating_sub(1)];
    let after = &points[(point + 1).min(points.len() - 1)];
    let share = if point == 0 || point + 1 == points.len() { 1.0 } else { 0.5 };
    Some([0, 1].map(|i| (after.at_m[i] - before.at_m[i]) * share))
}

/// Where a print's dagger points on the screen: away from the other feet.
pub(super) fn dagger_way(editor: &Editor, canvas: &Canvas, print: usize) -> Vec2 {
    let Some(print) = editor.prints().get(print) else { return Vec2::ZERO };
    let [x, z] = direction(print.heading_deg);
    canvas.along(if is_left(print.foot) { [z, -x] } else { [-z, x] })
}
