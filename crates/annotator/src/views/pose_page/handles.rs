//! What can be grasped on the photograph: points, joints of the skeleton, the skeleton as a whole.

use egui::{Color32, CursorIcon, Pos2, Rect, Response, Sense, Stroke, Ui, Vec2};
use muybridge_capture::{BodyPoint, Draft, Keypoint, KeypointState, Placed, PlacedBy};
use muybridge_fitting::posing::{Drag, DragOptions, PanelPose, PanelPoser, Reach};

use super::points;
use crate::canvas::PanelCanvas;
use crate::colors;
use crate::session::{Session, Tool};

/// Half the side of the square in which a point is grasped, screen points.
const GRASP: f32 = 7.0;

/// A drag under way on the pose page.
#[derive(Clone, Debug)]
pub enum PoseDrag {
    /// A point.
    Point {
        /// Which.
        keypoint: Keypoint,
        /// From where it was grasped to its centre, px.
        grasp_px: [f64; 2],
    },
    /// A joint of the skeleton.
    Joint {
        /// Which.
        keypoint: Keypoint,
        /// What follows it.
        drag: Box<Drag>,
        /// The pose before.
        before: Box<PanelPose>,
        /// From where it was grasped to its centre, px.
        grasp_px: [f64; 2],
    },
    /// The whole skeleton.
    Whole {
        /// The pose before.
        before: Box<PanelPose>,
        /// Where it was grasped, plate px.
        from_px: [f64; 2],
    },
}

/// Shows the handles of the present tool and does what is done with them.
pub(super) fn show(ui: &mut Ui, canvas: &PanelCanvas, session: &mut Session) {
    match session.tool {
        Tool::Guided | Tool::Free => show_points(ui, canvas, session),
        Tool::Skeleton => show_skeleton(ui, canvas, session),
    }
}

fn handle(ui: &Ui, canvas: &PanelCanvas, at: Pos2, name: &str) -> Response {
    let rect = Rect::from_center_size(at, Vec2::splat(2.0 * GRASP)).intersect(canvas.painter.clip_rect());
    let response = ui.interact(rect, ui.scope_id().with(("handle", name)), Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Button, true, name));
    response.on_hover_cursor(CursorIcon::Grab)
}

/// The pointer on the plate, px, wherever it is.
fn pointer_px(ui: &Ui, canvas: &PanelCanvas) -> Option<[f64; 2]> {
    ui.input(|input| input.pointer.latest_pos()).map(|at| canvas.view.plate_from_screen(at))
}

/// Where the button went down, on the plate, px: a drag begins a little later, when the pointer has moved on.
fn pressed_px(ui: &Ui, canvas: &PanelCanvas) -> Option<[f64; 2]> {
    ui.input(|input| input.pointer.press_origin()).map(|at| canvas.view.plate_from_screen(at))
}

fn show_points(ui: &mut Ui, canvas: &PanelCanvas, session: &mut Session) {
    let keypoints = session.panel_annotation().map(|panel| panel.keypoints.clone()).unwrap_or_default();
    for (keypoint, placed) in keypoints.iter() {
        let Some(at_px) = placed.place() else { continue };
        let at = canvas.view.screen_from_plate(at_px);
        let response = handle(ui, canvas, at, &colors::name(keypoint));
        draw_point(canvas, at, keypoint, placed, session.selected == Some(keypoint) || response.hovered());
        if response.clicked() {
            // Near and off joints lie close together: a click places what is asked for, also beside another point.
            let asked = session
                .selected
                .filter(|next| session.tool == Tool::Guided && keypoints.get(*next).is_none());
            match asked {
                Some(next) => place_at(canvas, session, next, &response),
                None => session.selected = Some(keypoint),
            }
        }
        if response.drag_started_by(egui::PointerButton::Primary)
            && let Some([x, y]) = pressed_px(ui, canvas)
        {
            session.selected = Some(keypoint);
            let grasp_px = [at_px[0] - x, at_px[1] - y];
            session.pose_drag = Some(PoseDrag::Point { keypoint, grasp_px });
        }
        follow(ui, canvas, session, &response);
        if response.hovered() {
            response.on_hover_text(colors::name(keypoint));
        }
    }
    place_by_click(ui, canvas, session);
}

/// A click on the photograph places the selected point.
fn place_by_click(ui: &Ui, canvas: &PanelCanvas, session: &mut Session) {
    if session.tool == Tool::Guided && session.selected.is_none() {
        session.select_unplaced();
    }
    let clicked = canvas.response.clicked_by(egui::PointerButton::Primary);
    let alt = ui.input(|input| input.modifiers.alt);
    if let Some(keypoint) = session.selected.filter(|_| clicked && !alt) {
        place_at(canvas, session, keypoint, &canvas.response);
    }
}

/// Places a point where something was clicked; guided, the next one is selected.
fn place_at(canvas: &PanelCanvas, session: &mut Session, keypoint: Keypoint, clicked: &Response) {
    let Some(at) = clicked.interact_pointer_pos() else { return };
    let (at_px, panel, state) = (canvas.view.plate_from_screen(at), session.panel, session.next_state);
    let label = format!("Place {}", colors::name(keypoint));
    session.edit(&label, |draft| points::place(draft, panel, keypoint, at_px, state));
    session.next_state = KeypointState::Visible;
    if session.tool == Tool::Guided {
        session.select_unplaced();
    }
}

fn show_skeleton(ui: &mut Ui, canvas: &PanelCanvas, session: &mut Session) {
    let draft = session.document.draft().clone();
    let panel = session.panel;
    let Some(poser) = session.derived.poser(&draft, panel) else { return };
    let placed = session.derived.pose(&draft, panel);
    let before = placed.unwrap_or_else(|| poser.rest_pose());
    let shown = match &session.pose_drag {
        Some(PoseDrag::Joint { drag, .. }) => *drag.pose(),
        _ => before,
    };
    draw_skeleton(canvas, &poser, &shown);
    let places = poser.keypoints_px(&shown);
    for keypoint in Keypoint::all() {
        let at_px = places[keypoint.index()];
        let at = canvas.view.screen_from_plate(at_px);
        let response = handle(ui, canvas, at, &colors::name(keypoint));
        let strong = session.selected == Some(keypoint) || response.hovered();
        draw_joint(canvas, at, keypoint, strong);
        if response.clicked() {
            session.selected = Some(keypoint);
        }
        if response.drag_started_by(egui::PointerButton::Primary)
            && let Some([x, y]) = pressed_px(ui, canvas)
        {
            session.selected = Some(keypoint);
            let whole = ui.input(|input| input.modifiers.shift);
            let reach = if whole { Reach::Whole } else { Reach::Limb };
            let options = DragOptions { reach, pins: Vec::new() };
            session.pose_drag = Some(PoseDrag::Joint {
                keypoint,
                drag: Box::new(Drag::begin(&poser, &before, keypoint, &options)),
                before: Box::new(before),
                grasp_px: [at_px[0] - x, at_px[1] - y],
            });
        }
        follow(ui, canvas, session, &response);
    }
    whole_skeleton(ui, canvas, session, &places, &before);
}

/// The square below the back that moves the whole figure.
fn whole_skeleton(
    ui: &Ui,
    canvas: &PanelCanvas,
    session: &mut Session,
    places: &[[f64; 2]],
    before: &PanelPose,
) {
    let [withers, croup] =
        [BodyPoint::Withers, BodyPoint::Croup].map(|point| places[Keypoint::Body(point).index()]);
    let length = (withers[0] - croup[0]).hypot(withers[1] - croup[1]);
    let middle = [0.5 * (withers[0] + croup[0]), 0.5 * (withers[1] + croup[1]) + 0.35 * length];
    let at = canvas.view.screen_from_plate(middle);
    let response = handle(ui, canvas, at, "Whole skeleton");
    let fill = if response.hovered() { Color32::WHITE } else { Color32::from_white_alpha(120) };
    let square = Rect::from_center_size(at, Vec2::splat(11.0));
    canvas.painter.rect(square, 2.0, fill, Stroke::new(1.5, Color32::BLACK), egui::StrokeKind::Outside);
    if response.drag_started_by(egui::PointerButton::Primary)
        && let Some(from_px) = pressed_px(ui, canvas)
    {
        session.pose_drag = Some(PoseDrag::Whole { before: Box::new(*before), from_px });
    }
    follow(ui, canvas, session, &response);
}

/// Follows a drag while it lasts; makes the change when it ends.
fn follow(ui: &Ui, canvas: &PanelCanvas, session: &mut Session, response: &Response) {
    if response.dragged_by(egui::PointerButton::Primary)
        && let Some(pointer_px) = pointer_px(ui, canvas)
        && let Some(mut drag) = session.pose_drag.take()
    {
        move_to(session, &mut drag, pointer_px);
        session.pose_drag = Some(drag);
    }
    if response.drag_stopped() {
        session.pose_drag = None;
        session.commit();
    }
}

fn move_to(session: &mut Session, drag: &mut PoseDrag, [x, y]: [f64; 2]) {
    let panel = session.panel;
    let poser = session.derived.poser(session.document.draft(), panel);
    match drag {
        PoseDrag::Point { keypoint, grasp_px } => {
            let (keypoint, at_px) = (*keypoint, [x + grasp_px[0], y + grasp_px[1]]);
            let known = session.document.draft().panel(panel).and_then(|p| p.keypoints.get(keypoint));
            let state = known.map_or(KeypointState::Visible, |placed| placed.state);
            let label = format!("Move {}", colors::name(keypoint));
            session.preview(&label, |draft| points::place(draft, panel, keypoint, at_px, state));
        }
        PoseDrag::Joint { keypoint, drag, before, grasp_px } => {
            let Some(poser) = poser else { return };
            let after = *drag.to([x + grasp_px[0], y + grasp_px[1]]);
            let label = format!("Drag {}", colors::name(*keypoint));
            let change = |draft: &mut Draft| {
                points::follow_skeleton(draft, panel, &poser, [before, &after], Some(*keypoint));
            };
            session.preview(&label, change);
        }
        PoseDrag::Whole { before, from_px } => {
            let Some(poser) = poser else { return };
            let after = poser.moved(before, [x - from_px[0], y - from_px[1]]);
            session.preview("Move the skeleton", |draft| {
                points::follow_skeleton(draft, panel, &poser, [before, &after], None);
            });
        }
    }
}

/// A placed point: filled when seen, a ring when guessed; smaller and square when a person has not placed it.
fn draw_point(canvas: &PanelCanvas, at: Pos2, keypoint: Keypoint, placed: &Placed, strong: bool) {
    let (painter, color) = (&canvas.painter, colors::keypoint(keypoint));
    let radius = if strong { 6.0 } else { 4.5 };
    let edge = Stroke::new(1.0, Color32::from_black_alpha(200));
    match (placed.by == PlacedBy::Hand, placed.state) {
        (true, KeypointState::Visible) => drop(painter.circle(at, radius, color, edge)),
        (true, _) => {
            painter.circle_stroke(at, radius, Stroke::new(3.0, Color32::from_black_alpha(160)));
            painter.circle_stroke(at, radius, Stroke::new(1.8, color));
        }
        (false, state) => {
            let square = Rect::from_center_size(at, Vec2::splat(1.7 * radius));
            let fill = if state == KeypointState::Visible { color } else { Color32::TRANSPARENT };
            painter.rect(square, 1.0, fill, Stroke::new(1.6, color), egui::StrokeKind::Middle);
        }
    }
    if strong {
        painter.circle_stroke(at, radius + 3.5, Stroke::new(1.2, Color32::WHITE));
    }
}

fn draw_joint(canvas: &PanelCanvas, at: Pos2, keypoint: Keypoint, strong: bool) {
    let radius = if strong { 6.0 } else { 4.0 };
    canvas.painter.circle(
        at,
        radius,
        Color32::from_black_alpha(140),
        Stroke::new(2.0, colors::keypoint(keypoint)),
    );
}

/// The bones through the plate's camera, off legs first; joints at their limit in white.
fn draw_skeleton(canvas: &PanelCanvas, poser: &PanelPoser, pose: &PanelPose) {
    use muybridge_capture::NearOff;
    let limits: Vec<usize> = poser.at_limits(pose).into_iter().map(|(bone, _)| bone).collect();
    let mut bones: Vec<_> = poser.bones_px(pose).into_iter().enumerate().collect();
    bones.sort_by_key(|(_, bone)| bone.side != Some(NearOff::Off));
    let tail =
        [BodyPoint::Croup, BodyPoint::Dock].map(|point| poser.keypoint_px(pose, Keypoint::Body(point)));
    let tail = tail.map(|at| canvas.view.screen_from_plate(at));
    canvas.painter.line_segment(tail, Stroke::new(2.6, colors::TRUNK));
    for (index, bone) in bones {
        let ends = bone.ends_px.map(|at| canvas.view.screen_from_plate(at));
        let color = bone.side.map_or(colors::TRUNK, colors::side);
        canvas.painter.line_segment(ends, Stroke::new(5.0, Color32::from_black_alpha(110)));
        canvas.painter.line_segment(ends, Stroke::new(2.6, color));
        if limits.contains(&index) {
            canvas.painter.circle_filled(ends[0], 3.0, Color32::WHITE);
        }
    }
}
