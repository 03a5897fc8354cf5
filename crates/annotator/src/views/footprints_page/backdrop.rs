//! What lies below the prints in the plan: heights of the terrain, edges of stairs, the grid and its scale.

use egui::{Align2, Color32, FontId, Mesh, Rect, Shape, Stroke, Ui, pos2, vec2};
use muybridge_footprints::Terrain;

use super::plan_view::{Canvas, line_distance_m, tame};
use crate::footprints::edits::direction;

/// Side of the squares in which heights are shown, points.
const CELL: f32 = 14.0;
/// Grid lines are at least so far apart, points.
const GRID: f64 = 45.0;
/// How much lighter or darker the highest ground is than the lowest.
const SHADE: f32 = 0.34;
/// Edges drawn at most: of a staircase without end those that are seen.
const MOST_EDGES: u32 = 400;

/// Draws it.
pub(super) fn show(ui: &Ui, canvas: &Canvas, terrain: &Terrain) {
    canvas.painter.rect_filled(canvas.rect, 0.0, ui.visuals().extreme_bg_color);
    if *terrain != Terrain::Flat {
        heights(ui, canvas, terrain);
    }
    grid(ui, canvas);
    edges(ui, canvas, terrain);
    scale(ui, canvas);
}

/// The higher, the lighter on a dark background, the darker on a light one.
fn heights(ui: &Ui, canvas: &Canvas, terrain: &Terrain) {
    let (rect, side) = (canvas.rect, CELL);
    let columns = (rect.width() / side).ceil() as usize + 1;
    let rows = (rect.height() / side).ceil() as usize + 1;
    let corner = |column: usize, row: usize| rect.min + vec2(column as f32, row as f32) * side;
    let mut heights_m = Vec::with_capacity(columns * rows);
    for row in 0..rows {
        for column in 0..columns {
            let [x, z] = canvas.plan(corner(column, row) + vec2(side, side) / 2.0);
            heights_m.push(terrain.at(x, z).0 as f32);
        }
    }
    let is_number = |height: &&f32| height.is_finite();
    let least = heights_m.iter().filter(is_number).copied().fold(f32::INFINITY, f32::min);
    let most = heights_m.iter().filter(is_number).copied().fold(f32::NEG_INFINITY, f32::max);
    if most - least < 1e-6 {
        return;
    }
    let color = ui.visuals().text_color();
    let mut mesh = Mesh::default();
    for (i, height_m) in heights_m.iter().enumerate() {
        let share = (height_m - least) / (most - least);
        let cell = Rect::from_min_size(corner(i % columns, i / columns), vec2(side, side));
        mesh.add_colored_rect(cell, color.gamma_multiply(SHADE * share.clamp(0.0, 1.0)));
    }
    canvas.painter.add(Shape::mesh(mesh));
}

fn grid(ui: &Ui, canvas: &Canvas) {
    let distance_m = line_distance_m(canvas.view.points_per_m, GRID);
    let [least, most] = canvas.view.seen(canvas.rect);
    let color = ui.visuals().text_color();
    for axis in 0..2 {
        let from = (least[axis] / distance_m).ceil() as i64;
        let to = (most[axis] / distance_m).floor() as i64;
        for number in from..=to {
            let mut at_m = [0.0; 2];
            at_m[axis] = number as f64 * distance_m;
            let strength = match number {
                0 => 0.35,
                number if number % 5 == 0 => 0.2,
                _ => 0.11,
            };
            let at = canvas.screen(at_m);
            let stroke = Stroke::new(1.0, color.gamma_multiply(strength));
            if axis == 0 {
                canvas.painter.vline(at.x, canvas.rect.y_range(), stroke);
            } else {
                canvas.painter.hline(canvas.rect.x_range(), at.y, stroke);
            }
        }
    }
}

/// Edges of stairs, and which way up a slope goes.
fn edges(ui: &Ui, canvas: &Canvas, terrain: &Terrain) {
    let stroke = Stroke::new(1.2, ui.visuals().text_color().gamma_multiply(0.55));
    match terrain {
        Terrain::Stairs { tread_m, steps, towards_deg, from_m, .. } => {
            stairs(canvas, stroke, [*tread_m, f64::from(*steps)], *towards_deg, *from_m);
        }
        Terrain::SpiralStairs {
            centre_m,
            inner_m,
            outer_m,
            steps_per_turn,
            turns,
            from_deg,
            clockwise,
            ..
        } => {
            let middle = canvas.screen(*centre_m);
            for radius_m in [inner_m, outer_m] {
                let radius = (radius_m * canvas.view.points_per_m) as f32;
                canvas.painter.circle_stroke(middle, radius, stroke);
            }
            let steps = (turns * f64::from(*steps_per_turn)).round().clamp(0.0, f64::from(MOST_EDGES)) as u32;
            for step in 0..=steps {
                let around_deg = 360.0 * f64::from(step) / f64::from((*steps_per_turn).max(1));
                let [x, z] = direction(from_deg + if *clockwise { -around_deg } else { around_deg });
                let end =
                    |radius_m: f64| canvas.screen([centre_m[0] + radius_m * x, centre_m[1] + radius_m * z]);
                canvas.painter.line_segment([tame(end(*inner_m)), tame(end(*outer_m))], stroke);
            }
        }
        Terrain::Slope { rise_deg, towards_deg } => {
            let way = canvas.along(direction(*towards_deg)) * 36.0;
            let from = canvas.rect.right_top() + vec2(-60.0, 50.0) - way / 2.0;
            canvas.painter.arrow(from, way, stroke);
            let text = format!("{rise_deg:.0}° up");
            label(canvas, from + way / 2.0 + vec2(0.0, 26.0), Align2::CENTER_TOP, &text, stroke.color);
        }
        Terrain::Flat | Terrain::HeightField { .. } => {}
    }
}

/// Edges run across; of each the part beside the middle of the screen is drawn.
fn stairs(canvas: &Canvas, stroke: Stroke, [tread_m, steps]: [f64; 2], towards_deg: f64, from_m: [f64; 2]) {
    let far_m = f64::from(canvas.rect.width() + canvas.rect.height()) / canvas.view.points_per_m;
    let [x, z] = direction(towards_deg);
    let middle = canvas.view.middle_m;
    let aside_m = (middle[0] - from_m[0]) * -z + (middle[1] - from_m[1]) * x;
    let along_m = (middle[0] - from_m[0]) * x + (middle[1] - from_m[1]) * z;
    let seen = |step: &f64| (step * tread_m - along_m).abs() <= far_m;
    let edges = (0..steps as u32).map(f64::from).filter(seen).take(MOST_EDGES as usize);
    for way_m in edges.map(|step| step * tread_m) {
        let end = |aside_m: f64| {
            canvas.screen([from_m[0] + way_m * x - aside_m * z, from_m[1] + way_m * z + aside_m * x])
        };
        canvas.painter.line_segment([end(aside_m - far_m), end(aside_m + far_m)].map(tame), stroke);
    }
}

fn label(canvas: &Canvas, at: egui::Pos2, align: Align2, text: &str, color: Color32) {
    canvas.painter.text(at, align, text, FontId::proportional(12.0), color);
}

/// A length to compare with.
fn scale(ui: &Ui, canvas: &Canvas) {
    let distance_m = line_distance_m(canvas.view.points_per_m, 2.0 * GRID);
    let length = (distance_m * canvas.view.points_per_m) as f32;
    let right = canvas.rect.right_bottom() + vec2(-16.0, -14.0);
    let left = pos2(right.x - length, right.y);
    let color = ui.visuals().text_color();
    let stroke = Stroke::new(2.0, color);
    canvas.painter.line_segment([left, right], stroke);
    for end in [left, right] {
        canvas.painter.line_segment([end - vec2(0.0, 4.0), end + vec2(0.0, 4.0)], stroke);
    }
    let text =
        if distance_m < 1.0 { format!("{:.0} cm", distance_m * 100.0) } else { format!("{distance_m:.0} m") };
    label(canvas, pos2((left.x + right.x) / 2.0, right.y - 5.0), Align2::CENTER_BOTTOM, &text, color);
}
