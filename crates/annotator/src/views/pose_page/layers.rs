//! What is drawn over the photograph: ghosts, trails, ground, fit, lines between points.

use egui::{Align2, Color32, FontId, Pos2, Stroke};
use muybridge_capture::{Keypoint, Keypoints, NearOff};
use muybridge_core::Pair;

use crate::canvas::{PanelCanvas, line_across};
use crate::colors;
use crate::picture::Look;
use crate::session::{Session, Tool};

/// How much of the neighbour's photograph is seen.
const GHOST_OPACITY: f32 = 0.5;

/// The neighbour's photograph, registered on ground and withers.
pub(super) fn draw_behind(canvas: &PanelCanvas, session: &mut Session) {
    if !session.shown.ghost_photograph || session.second_pass.is_some() {
        return;
    }
    let Some(from) = session.neighbour(-1).filter(|from| *from != session.panel) else { return };
    let Some(place) = session.derived.registration(session.draft(), from, session.panel) else { return };
    let Some(panel) = session.place_of(from).cloned() else { return };
    let look = Look { opacity: GHOST_OPACITY, ..Look::default() };
    let view = canvas.view;
    if let Some((textures, source)) = session.picture(panel.image) {
        let screen = |at_px| view.screen_from_plate(place(at_px));
        textures.draw_mapped(&canvas.painter, source, panel.quad_px, screen, look);
    }
}

/// Lines and skeletons.
pub(super) fn draw_marks(canvas: &PanelCanvas, session: &mut Session) {
    draw_ground(canvas, session);
    let blind = session.second_pass.is_some();
    if session.shown.hoof_trails && !blind {
        draw_trails(canvas, session);
    }
    if session.shown.ghost_skeletons && !blind {
        for (steps, color) in [(-1, colors::BEFORE), (1, colors::AFTER)] {
            draw_ghost(canvas, session, steps, color);
        }
    }
    if session.shown.fit && !blind {
        draw_fit(canvas, session);
    }
    if session.tool != Tool::Skeleton
        && let Some(panel) = session.panel_annotation()
    {
        let screen = |at_px| canvas.view.screen_from_plate(at_px);
        draw_edges(canvas, &panel.keypoints, screen, |k| Stroke::new(2.2, colors::keypoint(k)));
    }
}

fn draw_ground(canvas: &PanelCanvas, session: &Session) {
    if let Some(line) = session.panel_annotation().and_then(|panel| panel.ground_px) {
        let ends = line.map(|at| canvas.view.screen_from_plate(at));
        line_across(&canvas.painter, ends, Stroke::new(1.2, colors::GROUND.gamma_multiply(0.8)));
    }
}

/// Lines between neighbouring points, off legs first.
fn draw_edges(
    canvas: &PanelCanvas,
    keypoints: &Keypoints,
    screen: impl Fn([f64; 2]) -> Pos2,
    stroke: impl Fn(Keypoint) -> Stroke,
) {
    let mut edges: Vec<[Keypoint; 2]> = colors::edges().collect();
    edges.sort_by_key(|[_, to]| !matches!(to, Keypoint::Limb(NearOff::Off, ..)));
    for [from, to] in edges {
        if let Some((a, b)) = keypoints.place(from).zip(keypoints.place(to)) {
            canvas.painter.line_segment([screen(a), screen(b)], stroke(to));
        }
    }
}

fn draw_ghost(canvas: &PanelCanvas, session: &Session, steps: i64, color: Color32) {
    let Some(from) = session.neighbour(steps).filter(|from| *from != session.panel) else { return };
    let Some(place) = session.derived.registration(session.draft(), from, session.panel) else { return };
    let Some(panel) = session.draft().panel(from) else { return };
    let screen = |at_px| canvas.view.screen_from_plate(place(at_px));
    draw_edges(canvas, &panel.keypoints, screen, |_| Stroke::new(1.2, color));
}

/// Where each hoof is in every panel, seen from the animal; the last panel leads back to the first.
fn draw_trails(canvas: &PanelCanvas, session: &Session) {
    let numbers = session.stride_numbers();
    for side in [NearOff::Near, NearOff::Off] {
        for pair in [Pair::Fore, Pair::Hind] {
            let hoof = Keypoint::hoof(side, pair);
            let place = |number: &u32| {
                let at_px = session.draft().panel(*number)?.keypoints.place(hoof)?;
                let register = session.derived.registration(session.draft(), *number, session.panel)?;
                Some(canvas.view.screen_from_plate(register(at_px)))
            };
            let mut trail: Vec<Pos2> = numbers.iter().filter_map(place).collect();
            let closed = trail.len() == numbers.len();
            trail.extend(closed.then(|| trail.first().copied()).flatten());
            let color = colors::side(side);
            for at in &trail {
                canvas.painter.circle_filled(*at, 2.2, color);
            }
            canvas.painter.line(trail, Stroke::new(1.0, color.gamma_multiply(0.7)));
        }
    }
}

/// The fitted skeleton, and a line from every placed point to where the fit has it.
fn draw_fit(canvas: &PanelCanvas, session: &Session) {
    let Some(fitted) = session.fit.latest() else { return };
    let (fit, panel) = (&fitted.plate.fit, session.panel);
    let slot = fit.problem.order.iter().position(|i| fit.observation.panels[*i].camera.panel == panel);
    let (Some(slot), Some(poser)) = (slot, session.derived.poser(session.draft(), panel)) else { return };
    let Ok(pose) = fit.pose(slot).try_into() else { return };
    for bone in poser.bones_px(&pose) {
        let ends = bone.ends_px.map(|at| canvas.view.screen_from_plate(at));
        let faint = bone.side == Some(NearOff::Off);
        let color = colors::FIT.gamma_multiply(if faint { 0.55 } else { 0.9 });
        canvas.painter.line_segment(ends, Stroke::new(1.4, color));
    }
    for residual in fitted.plate.residuals.iter().filter(|residual| residual.panel == panel) {
        let ends = [residual.placed_px, residual.fitted_px].map(|at| canvas.view.screen_from_plate(at));
        canvas.painter.line_segment(ends, Stroke::new(2.0, Color32::from_rgb(255, 60, 60)));
        if session.selected == Some(residual.keypoint) {
            let text = format!("{:.1} px, {:.1} cm", residual.px(), 100.0 * residual.metres());
            let at = ends[1] + egui::vec2(10.0, -10.0);
            canvas.painter.text(at, Align2::LEFT_BOTTOM, text, FontId::proportional(13.0), Color32::WHITE);
        }
    }
}
