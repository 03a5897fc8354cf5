//! Every point of every panel as a small square: the farther from the fit, the hotter.

use egui::accesskit::Role;
use egui::{
    Align2, Color32, FontId, Mesh, Pos2, Rect, Sense, Stroke, StrokeKind, Ui, WidgetInfo, pos2, vec2,
};
use muybridge_capture::{KEYPOINT_COUNT, Keypoint};
use muybridge_fitting::pipeline::PlateFit;
use muybridge_fitting::stride_fit::PointResidual;

use super::jump;
use crate::colors;
use crate::session::Session;

/// Width of the groups' names, screen points.
const NAMES: f32 = 62.0;
/// Height of a row.
const ROW: f32 = 8.0;
/// Space between groups.
const GAP: f32 = 4.0;
/// The groups of rows: first row and name.
const GROUPS: [(usize, &str); 5] =
    [(0, "trunk"), (6, "near fore"), (11, "off fore"), (16, "near hind"), (21, "off hind")];
/// Distances from here on are all the same colour, share of the withers height: 4 %, 6 cm of a horse.
const HOTTEST: f64 = 0.04;
/// The colours from no distance to the hottest, on dark background and on light: few distances stand out from it.
const HEAT: [[[u8; 3]; 4]; 2] = [
    [[30, 32, 78], [122, 40, 120], [222, 82, 70], [250, 226, 110]],
    [[226, 228, 238], [250, 196, 130], [222, 82, 60], [96, 10, 60]],
];

/// Where rows and columns are.
struct Squares {
    at: Pos2,
    width: f32,
    panels: Vec<u32>,
}

impl Squares {
    fn top(&self, row: usize) -> f32 {
        let group = GROUPS.iter().rposition(|(first, _)| *first <= row).unwrap_or(0);
        self.at.y + ROW * row as f32 + GAP * group as f32
    }

    fn rect(&self, column: usize, row: usize) -> Rect {
        let at = pos2(self.at.x + self.width * column as f32, self.top(row));
        Rect::from_min_size(at, vec2(self.width - 1.0, ROW - 1.0))
    }

    /// Column and row under a place.
    fn under(&self, at: Pos2) -> Option<(usize, usize)> {
        let column = ((at.x - self.at.x) / self.width).floor();
        let row = (0..KEYPOINT_COUNT).find(|row| (0.0..ROW).contains(&(at.y - self.top(*row))))?;
        (column >= 0.0 && (column as usize) < self.panels.len()).then_some((column as usize, row))
    }
}

/// The squares, what is under the pointer, and the scale.
pub(super) fn show(ui: &mut Ui, session: &mut Session, plate: &PlateFit) {
    let mut panels: Vec<u32> = plate.fit.observation.panels.iter().map(|panel| panel.camera.panel).collect();
    panels.sort_unstable();
    let height = ROW * KEYPOINT_COUNT as f32 + GAP * (GROUPS.len() - 1) as f32 + 14.0;
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::click());
    response.widget_info(|| WidgetInfo::labeled(Role::Image, true, "Distance of every point from the fit"));
    let width = (rect.width() - NAMES - 4.0) / panels.len().max(1) as f32;
    let squares = Squares { at: pos2(rect.left() + NAMES, rect.top()), width, panels };
    if ui.is_rect_visible(rect) {
        draw(ui, &squares, plate, session);
    }
    let under = response.hover_pos().and_then(|at| squares.under(at));
    if let Some((column, row)) = under
        && let Some(keypoint) = Keypoint::all().nth(row)
    {
        let panel = squares.panels[column];
        ui.painter().rect_stroke(squares.rect(column, row).expand(1.0), 0.0, ring(ui), StrokeKind::Outside);
        if response.clicked() {
            jump(session, panel, Some(keypoint));
        }
        let residual = plate.residuals.iter().find(|r| r.panel == panel && r.keypoint == keypoint);
        let distance = residual.map_or("not placed".into(), in_words);
        let text = format!("Panel {panel}, {}: {distance}", colors::name(keypoint));
        response.on_hover_text_at_pointer(text);
    }
    scale(ui, plate.withers_height_m);
}

fn in_words(residual: &PointResidual) -> String {
    format!("{:.2} px, {:.2} cm", residual.px(), 100.0 * residual.metres())
}

fn ring(ui: &Ui) -> Stroke {
    Stroke::new(1.5, ui.visuals().strong_text_color())
}

fn draw(ui: &Ui, squares: &Squares, plate: &PlateFit, session: &Session) {
    let (painter, visuals) = (ui.painter(), ui.visuals());
    let mut mesh = Mesh::default();
    for column in 0..squares.panels.len() {
        for row in 0..KEYPOINT_COUNT {
            mesh.add_colored_rect(squares.rect(column, row), visuals.faint_bg_color);
        }
    }
    for residual in &plate.residuals {
        if let Ok(column) = squares.panels.binary_search(&residual.panel) {
            let share = residual.metres() / (HOTTEST * plate.withers_height_m);
            mesh.add_colored_rect(squares.rect(column, residual.keypoint.index()), heat(ui, share));
        }
    }
    painter.add(egui::Shape::mesh(mesh));
    let font = FontId::proportional(11.0);
    for (first, name) in GROUPS {
        let at = pos2(squares.at.x - 6.0, squares.top(first));
        painter.text(at, Align2::RIGHT_TOP, name, font.clone(), visuals.text_color());
    }
    for (column, panel) in squares.panels.iter().enumerate() {
        let at = pos2(squares.rect(column, 0).center().x, squares.top(KEYPOINT_COUNT - 1) + ROW + 1.0);
        let color =
            if *panel == session.panel { visuals.strong_text_color() } else { visuals.weak_text_color() };
        painter.text(at, Align2::CENTER_TOP, panel.to_string(), font.clone(), color);
    }
}

/// The colour of a share of the hottest.
fn heat(ui: &Ui, share: f64) -> Color32 {
    let colors = HEAT[usize::from(!ui.visuals().dark_mode)];
    let at = share.clamp(0.0, 1.0) * (colors.len() - 1) as f64;
    let from = (at as usize).min(colors.len() - 2);
    let mix = |i: usize| {
        let [a, b] = [colors[from][i], colors[from + 1][i]].map(f64::from);
        (a + (b - a) * (at - from as f64)).round() as u8
    };
    Color32::from_rgb(mix(0), mix(1), mix(2))
}

/// What the colours mean.
fn scale(ui: &mut Ui, withers_height_m: f64) {
    ui.horizontal(|ui| {
        ui.weak("0");
        let (rect, _) = ui.allocate_exact_size(vec2(120.0, 8.0), Sense::hover());
        let mut mesh = Mesh::default();
        let steps = 24;
        for i in 0..steps {
            let left = rect.left() + rect.width() * i as f32 / steps as f32;
            let step =
                Rect::from_min_size(pos2(left, rect.top()), vec2(rect.width() / steps as f32, rect.height()));
            mesh.add_colored_rect(step, heat(ui, (f64::from(i) + 0.5) / f64::from(steps)));
        }
        ui.painter().add(egui::Shape::mesh(mesh));
        ui.weak(format!("{:.0} cm and more", 100.0 * HOTTEST * withers_height_m));
    });
}
