//! What is drawn in the plan: prints in the model's outline, the centre of mass, the path, where it is now.

use egui::{Align2, Color32, FontId, Pos2, Shape, Stroke, Ui, Vec2, vec2};
use muybridge_footprints::{Foot, HOOF_OUTLINE_M, Model, Path, Print, Track};

use super::curve::Curve;
use super::plan_view::{Canvas, tame};
use crate::colors;
use crate::footprints::edits::{direction, is_left};
use crate::toast::trouble_color;

/// Prints are drawn as dots where a foot is shorter than this, points.
const LEAST_FOOT: f32 = 5.0;
/// Dots of prints that are too small to be seen as feet, points.
const DOT: f32 = 2.5;
/// Numbers are drawn where prints are so far apart on the screen, points.
const NUMBERED: f64 = 14.0;
/// Velocity of a knot is drawn as the way of so long a time, s.
const TANGENT_S: f64 = 0.2;
/// And never longer than this, points: knots of a fast motion lie close.
const TANGENT: f32 = 24.0;
/// Tangents are drawn when so many knots or fewer are there.
const MOST_TANGENTS: usize = 200;
/// The path is drawn as so many pieces a window's width, points each.
const PIECE: f64 = 6.0;
/// Pieces of a path at most.
const MOST_PIECES: usize = 4000;

/// The foot of a model, seen from above.
pub(super) struct FootShape {
    model: String,
    /// Outline of a right print, x ahead and z to the right, metres.
    outline_m: Vec<[f64; 2]>,
    /// From the middle to the toe, metres.
    pub(super) toe_m: f64,
    /// Half the width, metres.
    pub(super) half_width_m: f64,
}

impl FootShape {
    /// The foot of a model that is built in; a hoof for any other.
    pub(super) fn of(model: &str) -> Self {
        let outline_m = match Model::named(model) {
            Some(model) if model.leg.foot.outline_m.len() > 2 => model.leg.foot.outline_m,
            _ => HOOF_OUTLINE_M.to_vec(),
        };
        let most = |i: usize| outline_m.iter().map(|corner| corner[i].abs()).fold(0.01, f64::max);
        Self { model: model.into(), toe_m: most(0), half_width_m: most(1), outline_m }
    }

    pub(super) fn is_of(&self, model: &str) -> bool {
        self.model == model
    }

    /// The outline of a print in the plan (x, z), metres.
    pub(super) fn outline(&self, print: &Print) -> Vec<[f64; 2]> {
        let [x, z] = direction(print.heading_deg);
        let side = if is_left(print.foot) { -1.0 } else { 1.0 };
        let corner = |[ahead, right]: &[f64; 2]| {
            let right = right * side;
            [print.at_m[0] + ahead * x - right * z, print.at_m[1] + ahead * z + right * x]
        };
        self.outline_m.iter().map(corner).collect()
    }
}

/// How a print is to be drawn.
#[derive(Clone, Copy, Default)]
pub(super) struct Look {
    pub(super) is_selected: bool,
    pub(super) is_hovered: bool,
    pub(super) is_down: bool,
    pub(super) is_laid: bool,
    pub(super) is_remarked: bool,
    pub(super) is_faulty: bool,
}

/// One print.
pub(super) fn print(ui: &Ui, canvas: &Canvas, shape: &FootShape, number: usize, print: &Print, look: Look) {
    let at = canvas.screen(print.at_m);
    let color = colors::foot(print.foot);
    let foot = (shape.toe_m * canvas.view.points_per_m) as f32;
    let rim = match look {
        Look { is_faulty: true, .. } => Stroke::new(2.5, trouble_color(ui.visuals().dark_mode)),
        Look { is_selected: true, .. } => Stroke::new(2.5, ui.visuals().strong_text_color()),
        Look { is_hovered: true, .. } => Stroke::new(1.8, ui.visuals().strong_text_color()),
        _ => Stroke::new(1.2, color),
    };
    let opacity: f32 = match look {
        Look { is_laid: true, .. } => 0.18,
        Look { is_down: true, .. } => 0.95,
        _ => 0.45,
    };
    if foot < LEAST_FOOT {
        canvas.painter.circle(at, DOT, color.gamma_multiply(opacity.max(0.6)), rim);
    } else {
        let corners: Vec<Pos2> =
            shape.outline(print).into_iter().map(|corner| canvas.screen(corner)).collect();
        fill(canvas, at, &corners, color.gamma_multiply(opacity));
        canvas.painter.add(Shape::closed_line(corners, rim));
    }
    if look.is_remarked {
        let stroke = Stroke::new(1.8, trouble_color(ui.visuals().dark_mode));
        canvas.painter.circle_stroke(at, foot.max(DOT) + 5.0, stroke);
    }
    if f64::from(foot) * 2.0 > NUMBERED || look.is_selected {
        let font = FontId::proportional(12.0);
        let text = ui.visuals().strong_text_color();
        canvas.painter.text(at, Align2::CENTER_CENTER, (number + 1).to_string(), font, text);
    }
}

/// A star-shaped outline, such as that of a foot, filled from its middle.
fn fill(canvas: &Canvas, middle: Pos2, corners: &[Pos2], color: Color32) {
    let mut mesh = egui::Mesh::default();
    mesh.colored_vertex(middle, color);
    corners.iter().for_each(|corner| mesh.colored_vertex(*corner, color));
    let count = corners.len() as u32;
    for i in 0..count {
        mesh.add_triangle(0, 1 + i, 1 + (i + 1) % count);
    }
    canvas.painter.add(Shape::mesh(mesh));
}

/// The curve of the centre of mass, coloured by the feet on the ground, with the velocities at its knots.
pub(super) fn curve(ui: &Ui, canvas: &Canvas, curve: &Curve) {
    for run in &curve.runs {
        let points: Vec<Pos2> = run.points.iter().map(|at| tame(canvas.screen([at.x, at.z]))).collect();
        let bounds = egui::Rect::from_points(&points);
        if bounds.intersects(canvas.rect) {
            canvas.painter.add(Shape::line(points, Stroke::new(2.5, run.color)));
        }
    }
    if curve.knots.len() > MOST_TANGENTS {
        return;
    }
    for (at, velocity) in &curve.knots {
        let from = canvas.screen([at.x, at.z]);
        let end = canvas.screen([at.x + TANGENT_S * velocity.x, at.z + TANGENT_S * velocity.z]);
        let way = end - from;
        let to = from + way * (TANGENT / way.length().max(TANGENT));
        if canvas.sees(from, 50.0) {
            let color = ui.visuals().strong_text_color().gamma_multiply(0.75);
            canvas.painter.line_segment([from, tame(to)], Stroke::new(1.0, color));
            canvas.painter.circle_filled(from, 2.2, color);
        }
    }
}

/// The centre of mass at this moment, and which way it goes.
pub(super) fn present(ui: &Ui, canvas: &Canvas, at_m: [f64; 2], heading: Vec2, down: &[Foot]) {
    let at = canvas.screen(at_m);
    let text = ui.visuals().strong_text_color();
    canvas.painter.circle(at, 5.0, colors::support(down), Stroke::new(1.8, text));
    if heading.length() > 1e-6 {
        let tip = at + heading.normalized() * 13.0;
        canvas.painter.line_segment([at + heading.normalized() * 5.0, tip], Stroke::new(2.0, text));
    }
}

/// The path.
pub(super) fn path(ui: &Ui, canvas: &Canvas, track: &Track) {
    let Some(path) = track.path.as_ref().and_then(|laying| Path::through(&laying.points)) else { return };
    let length_m = path.length_m();
    let pieces = ((length_m * canvas.view.points_per_m / PIECE) as usize).clamp(2, MOST_PIECES);
    let at = |i: usize| {
        let (at, _) = path.at(length_m * i as f64 / pieces as f64);
        tame(canvas.screen([at.x, at.y]))
    };
    let points: Vec<Pos2> = (0..=pieces).map(at).collect();
    let stroke =
        Stroke::new(1.5, colors::GROUND.gamma_multiply(if ui.visuals().dark_mode { 0.9 } else { 0.7 }));
    canvas.painter.extend(Shape::dashed_line(&points, stroke, 6.0, 4.0));
}

/// A text beside something, on a ground of its own.
pub(super) fn note(ui: &Ui, canvas: &Canvas, at: Pos2, text: &str, color: Color32) {
    let painter = &canvas.painter;
    let galley = painter.layout(text.into(), FontId::proportional(13.0), color, 260.0);
    let size = galley.size() + vec2(12.0, 8.0);
    let corner = canvas.rect.max - size;
    let at = (at + vec2(14.0, 14.0)).min(corner).max(canvas.rect.min);
    let rect = egui::Rect::from_min_size(at, size);
    painter.rect(rect, 4.0, ui.visuals().window_fill, Stroke::new(1.0, color), egui::StrokeKind::Inside);
    painter.galley(at + vec2(6.0, 4.0), galley, color);
}
