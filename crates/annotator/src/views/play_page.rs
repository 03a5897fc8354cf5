//! The fitted stride, moving: over the photographs, as a figure, and as a footfall diagram.

mod diagram;
mod motion;

use std::sync::Arc;

use egui::{Color32, FontId, Painter, Pos2, Rect, Slider, Stroke, Ui, vec2};
use muybridge_capture::NearOff;
use muybridge_core::Limb;
use muybridge_fitting::layout::ROOT_X;
use muybridge_fitting::posing::PanelPose;

use crate::app::PageContext;
use crate::canvas::PanelCanvas;
use crate::colors;
use crate::command::Command;
use crate::figure::FigurePose;
use crate::fit_state::Fitted;
use crate::session::Session;
use crate::views::figure_box::{figure_colors, joints, skeleton};
use motion::{DrawnBone, Motion};

/// Slowest and fastest, against the real speed.
const RATES: std::ops::RangeInclusive<f64> = 0.05..=2.0;
/// Longest step in time, s: after a pause of the window the stride goes on where it was.
const LONGEST_STEP_S: f64 = 0.1;
/// The ghosts are this far before and after, strides.
const GHOSTS: f64 = 1.0 / 12.0;
/// Height of the figure against its width.
const FIGURE_ASPECT: f32 = 0.85;

/// The moving stride.
#[derive(Clone, Debug)]
pub struct PlayState {
    /// Whether it moves.
    pub is_playing: bool,
    /// Phase, strides, in `[0, 1)`.
    pub phase: f64,
    /// Speed against the real one.
    pub rate: f64,
    /// Whether the figure has its neighbours in time beside it.
    pub ghosts: bool,
    /// The panel whose photograph the phase belongs to; another panel looked at takes the phase along.
    panel: Option<u32>,
}

impl Default for PlayState {
    fn default() -> Self {
        Self { is_playing: false, phase: 0.0, rate: 0.25, ghosts: false, panel: None }
    }
}

/// The photograph nearest in phase, its own points faintly, and the fitted skeleton at the phase.
pub fn canvas(ui: &mut Ui, session: &mut Session, _page: &mut PageContext<'_>) {
    let Some(canvas) = PanelCanvas::show(ui, session) else { return };
    let Some(fitted) = shown_fit(session) else { return };
    let screen = |at_px: [f64; 2]| canvas.view.screen_from_plate(at_px);
    if session.shown.marks {
        draw_points(&canvas.painter, session, screen);
    }
    let panel = session.panel;
    let motion = Motion::new(&fitted.plate, session.derived.skeleton());
    let bones = motion.bones_px(panel, session.play.phase);
    let text = match &bones {
        Some(bones) => {
            draw_bones(&canvas.painter, bones, 1.0, screen);
            format!("Phase {:.3}, photograph of panel {panel}", session.play.phase)
        }
        None => format!("Panel {panel} is not of the fitted stride"),
    };
    let at = canvas.painter.clip_rect().left_top() + vec2(12.0, 10.0);
    let galley = canvas.painter.layout_no_wrap(text, FontId::proportional(13.0), Color32::WHITE);
    let back = Rect::from_min_size(at, galley.size()).expand(6.0);
    canvas.painter.rect_filled(back, 4.0, Color32::from_black_alpha(170));
    canvas.painter.galley(at, galley, Color32::WHITE);
}

/// The fitted skeleton over one photograph of the contact sheet.
pub fn draw_on_sheet(painter: &Painter, session: &Session, photograph: Rect) {
    let (Some(fitted), Some(place)) = (shown_fit(session), session.panel_place()) else { return };
    let Some(transform) = muybridge_imaging::PanelTransform::new(place.quad_px, [1.0, 1.0]) else { return };
    let motion = Motion::new(&fitted.plate, session.derived.skeleton());
    if let Some(bones) = motion.bones_px(session.panel, session.play.phase) {
        let width = (photograph.width() / 500.0).clamp(0.5, 1.0);
        draw_bones(&painter.with_clip_rect(photograph), &bones, width, |at_px| {
            let [u, v] = transform.panel_from_plate(at_px);
            photograph.lerp_inside(vec2(u as f32, v as f32))
        });
    }
}

/// The fit, unless points are being placed blindly.
fn shown_fit(session: &Session) -> Option<Arc<Fitted>> {
    session.fit.latest().filter(|_| session.second_pass.is_none()).cloned()
}

/// The panel's own points and their lines, faintly.
fn draw_points(painter: &Painter, session: &Session, screen: impl Fn([f64; 2]) -> Pos2) {
    let Some(panel) = session.panel_annotation() else { return };
    for [from, to] in colors::edges() {
        if let Some((a, b)) = panel.keypoints.place(from).zip(panel.keypoints.place(to)) {
            let stroke = Stroke::new(1.2, colors::keypoint(to).gamma_multiply(0.45));
            painter.line_segment([screen(a), screen(b)], stroke);
        }
    }
}

/// Off limbs first and thinner; a dark edge keeps every line visible on light photographs.
fn draw_bones(painter: &Painter, bones: &[DrawnBone], width: f32, screen: impl Fn([f64; 2]) -> Pos2) {
    let sides = [Some(NearOff::Off), None, Some(NearOff::Near)];
    for side in sides {
        let (thick, color) = match side {
            Some(NearOff::Off) => (2.2, colors::OFF),
            Some(NearOff::Near) => (3.0, colors::NEAR),
            None => (3.0, colors::TRUNK),
        };
        for (wider, color) in [(2.0, Color32::from_black_alpha(150)), (0.0, color)] {
            for bone in bones.iter().filter(|bone| bone.place.side == side) {
                let ends = bone.place.ends_px.map(&screen);
                painter.line_segment(ends, Stroke::new(width * (thick + wider), color));
                if bone.stands {
                    painter.circle_filled(ends[1], width * (4.0 + 0.5 * wider), color);
                }
            }
        }
    }
}

/// The panel at the right.
pub fn inspector(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    if session.second_pass.is_some() {
        ui.label("Hidden during the blind second pass: who sees the fit does not place points blindly.");
        return;
    }
    let Some(fitted) = shown_fit(session) else {
        session.play.is_playing = false;
        ui.label("There is no fit yet; the Gait page says what is missing.");
        return;
    };
    let reference = session.derived.skeleton().clone();
    let motion = Motion::new(&fitted.plate, &reference);
    advance(ui, session, &motion);
    controls(ui, session, page, &motion);
    if fitted.revision != session.document.revision() {
        ui.weak("This is the fit of earlier points: something was changed since.");
    }
    ui.separator();
    if let Some(phase) = diagram::show(ui, &fitted.plate, session.play.phase) {
        set_phase(session, &motion, phase);
    }
    ui.separator();
    figure(ui, session, &motion);
}

/// Moves on with the time that has passed, and follows a panel that was chosen elsewhere.
fn advance(ui: &Ui, session: &mut Session, motion: &Motion<'_>) {
    if session.play.panel != Some(session.panel) {
        session.play.panel = Some(session.panel);
        session.play.phase = motion.phase_of(session.panel).unwrap_or(session.play.phase);
    }
    if session.play.is_playing {
        let passed_s = f64::from(ui.input(|input| input.stable_dt)).min(LONGEST_STEP_S);
        let phase = session.play.phase + session.play.rate * passed_s / motion.stride_s();
        set_phase(session, motion, phase);
        ui.ctx().request_repaint();
    }
}

/// Goes to a phase and to the photograph nearest to it.
fn set_phase(session: &mut Session, motion: &Motion<'_>, phase: f64) {
    session.play.phase = phase.rem_euclid(1.0);
    if let Some(panel) = motion.panel_near(session.play.phase)
        && panel != session.panel
        && session.place_of(panel).is_some()
    {
        session.go_to(panel);
    }
    session.play.panel = Some(session.panel);
}

fn controls(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>, motion: &Motion<'_>) {
    ui.horizontal(|ui| {
        let title = if session.play.is_playing { "Pause" } else { "Play" };
        let button = egui::Button::new(title).min_size(vec2(64.0, 0.0));
        if ui.add(button).on_hover_text(page.settings.keys.shown(Command::PlayStride)).clicked() {
            page.commands.push(Command::PlayStride);
        }
        for (title, steps) in [("Panel before", -1), ("Panel after", 1)] {
            if ui.button(title).clicked()
                && let Some(panel) = motion.panel_after(session.panel, steps)
                && session.place_of(panel).is_some()
            {
                session.play.is_playing = false;
                session.go_to(panel);
                ui.ctx().request_repaint();
            }
        }
    });
    let mut phase = session.play.phase;
    let slider = Slider::new(&mut phase, 0.0..=0.999).text("Phase").fixed_decimals(3);
    if ui.add(slider).on_hover_text("Strides since the first panel").changed() {
        set_phase(session, motion, phase);
        ui.ctx().request_repaint();
    }
    ui.add(Slider::new(&mut session.play.rate, RATES).text("Speed").logarithmic(true).fixed_decimals(2))
        .on_hover_text("1 is the real speed");
    let (real_s, shown_s) = (motion.stride_s(), motion.stride_s() / session.play.rate);
    ui.weak(format!("One stride took {real_s:.3} s; here it takes {shown_s:.2} s."));
}

/// The figure at the phase, its hooves standing where the contacts say.
fn figure(ui: &mut Ui, session: &mut Session, motion: &Motion<'_>) {
    let skeleton = skeleton(session.derived.skeleton(), motion.lengths());
    let phase = session.play.phase;
    let pose = |at: f64| -> Option<PanelPose> {
        let mut pose = motion.pose(at)?;
        // Neighbours in time are seen from the horse, so that the limbs fan out and the trunks do not.
        pose[ROOT_X] -= (at - phase) * motion.stride_length_m();
        Some(pose)
    };
    let standing = Limb::ALL.map(|limb| motion.stands(limb, phase));
    let now = pose(phase).map(|pose| FigurePose { joints: joints(&skeleton, &pose), standing, ghost: false });
    let mut poses: Vec<FigurePose> = now.into_iter().collect();
    // In motion they would only blur, and cost more than the figure itself.
    if session.play.ghosts && !session.play.is_playing {
        let ghosts = [-GHOSTS, GHOSTS].into_iter().filter_map(|by| pose(phase + by));
        let standing = [false; 4];
        poses.extend(ghosts.map(|pose| FigurePose {
            joints: joints(&skeleton, &pose),
            standing,
            ghost: true,
        }));
    }
    session.figure.set_filmed(motion.facing().side(NearOff::Near));
    let width = ui.available_width();
    session.figure.ui(ui, vec2(width, FIGURE_ASPECT * width), &poses, &figure_colors());
    ui.checkbox(&mut session.play.ghosts, "A twelfth of a stride before and after, while paused");
}
