//! One panel on the screen: how close one looks, and the photograph itself.

use egui::{Color32, CursorIcon, Painter, PointerButton, Rect, Response, Sense, Ui, pos2};
use muybridge_capture::Panel;

use crate::picture::{ImageState, Look, ViewTransform};
use crate::session::Session;

/// Share of the canvas a whole panel fills.
const FILLED: f64 = 0.94;
/// Closest look: the panel this many times as large as the canvas.
const CLOSEST: f64 = 60.0;
/// Points of scrolling for a factor of e.
const SCROLL_POINTS: f64 = 240.0;

/// How close one looks at a panel and where: the same for all panels, so that stepping keeps the place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PanelZoom {
    /// 1 shows the whole panel.
    closeness: f64,
    /// What is in the middle of the canvas, as shares of the panel's width and height.
    centre: [f64; 2],
}

impl Default for PanelZoom {
    fn default() -> Self {
        Self { closeness: 1.0, centre: [0.5, 0.5] }
    }
}

/// Least and greatest corner of a panel, plate px.
fn bounds(panel: &Panel) -> [[f64; 2]; 2] {
    let along = |axis: usize| panel.quad_px.iter().map(move |corner| corner[axis]);
    let least = [0, 1].map(|axis| along(axis).fold(f64::INFINITY, f64::min));
    let greatest = [0, 1].map(|axis| along(axis).fold(f64::NEG_INFINITY, f64::max));
    [least, greatest]
}

impl PanelZoom {
    /// The whole panel.
    pub fn reset(&mut self) {
        *self = Self::default();
    }

    /// Closer or farther, about the middle.
    pub fn zoom_by(&mut self, factor: f64) {
        self.closeness = (self.closeness * factor).clamp(0.3, CLOSEST);
    }

    /// Where a panel's photograph is on the screen.
    pub fn view(&self, panel: &Panel, canvas: Rect) -> ViewTransform {
        let [least, greatest] = bounds(panel);
        let fitted = ViewTransform::fit([least, greatest], canvas);
        let zoom = fitted.zoom * FILLED * self.closeness;
        let middle = [0, 1].map(|axis| least[axis] + self.centre[axis] * (greatest[axis] - least[axis]));
        ViewTransform { zoom, origin: [0.0, 0.0] }.with_at(middle, canvas.center())
    }

    /// Takes over a view that a gesture has led to.
    fn take(&mut self, view: &ViewTransform, panel: &Panel, canvas: Rect) {
        let [least, greatest] = bounds(panel);
        let fitted = ViewTransform::fit([least, greatest], canvas);
        let middle = view.plate_from_screen(canvas.center());
        self.closeness = (view.zoom / (fitted.zoom * FILLED)).clamp(0.3, CLOSEST);
        self.centre = [0, 1].map(|axis| {
            let share = (middle[axis] - least[axis]) / (greatest[axis] - least[axis]);
            if share.is_finite() { share.clamp(-0.2, 1.2) } else { 0.5 }
        });
    }
}

/// A panel on the screen.
pub struct PanelCanvas {
    /// Clicks and drags on the photograph.
    pub response: Response,
    /// Clipped to the canvas.
    pub painter: Painter,
    /// From plate px to the screen.
    pub view: ViewTransform,
}

impl PanelCanvas {
    /// Shows the panel looked at over all the space there is; none while the plate has no panels.
    pub fn show(ui: &mut Ui, session: &mut Session) -> Option<Self> {
        let rect = ui.available_rect_before_wrap();
        let Some(panel) = session.panel_place().cloned() else {
            ui.centered_and_justified(|ui| ui.label("This plate has no panels yet: go to the Plate page."));
            return None;
        };
        let response = ui.allocate_rect(rect, Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::Canvas, true, "Photograph"));
        let view = moved(ui, &response, session.zoom.view(&panel, rect));
        session.zoom.take(&view, &panel, rect);
        let view = session.zoom.view(&panel, rect);
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
        draw_photograph(&painter, session, &panel, &view);
        Some(Self { response, painter, view })
    }

    /// The pointer on the plate, px; none while it is elsewhere.
    pub fn pointer_px(&self) -> Option<[f64; 2]> {
        self.response.hover_pos().map(|at| self.view.plate_from_screen(at))
    }
}

/// Wheel and pinch zoom about the pointer; the middle or right button, or Alt and the left, pan.
pub fn moved(ui: &Ui, response: &Response, view: ViewTransform) -> ViewTransform {
    let mut view = view;
    if let Some(pointer) = response.hover_pos() {
        let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        if scroll != 0.0 || pinch != 1.0 {
            view = view.zoomed((f64::from(scroll) / SCROLL_POINTS).exp() * f64::from(pinch), pointer);
        }
    }
    let alt = ui.input(|input| input.modifiers.alt);
    let pans = response.dragged_by(PointerButton::Middle)
        || response.dragged_by(PointerButton::Secondary)
        || (alt && response.dragged_by(PointerButton::Primary));
    if pans {
        ui.ctx().set_cursor_icon(CursorIcon::Grabbing);
        view = view.panned(response.drag_delta());
    }
    view
}

/// The photograph, what is around it dimmed; in its place the reason when it cannot be shown.
fn draw_photograph(painter: &Painter, session: &mut Session, panel: &Panel, view: &ViewTransform) {
    let rect = painter.clip_rect();
    let corners = panel.quad_px.map(|corner| view.screen_from_plate(corner));
    match session.images.states().get(panel.image) {
        Some(ImageState::Ready(_)) => {}
        state => {
            let text = match state {
                Some(ImageState::Failed(trouble)) => trouble.clone(),
                _ => "Reading the photograph…".into(),
            };
            painter.add(egui::Shape::convex_polygon(
                corners.into(),
                Color32::from_gray(90),
                egui::Stroke::NONE,
            ));
            let font = egui::FontId::proportional(14.0);
            let galley = painter.layout(text, font, Color32::WHITE, rect.width() * 0.6);
            painter.galley(rect.center() - galley.size() / 2.0, galley, Color32::WHITE);
            return;
        }
    }
    if let Some((textures, source)) = session.picture(panel.image) {
        textures.draw(painter, source, view, Look::default());
    }
    dim_around(painter, corners);
}

/// Dims the canvas outside a quadrilateral.
fn dim_around(painter: &Painter, corners: [egui::Pos2; 4]) {
    let rect = painter.clip_rect().expand(2000.0);
    let frame = [rect.left_top(), rect.right_top(), rect.right_bottom(), rect.left_bottom()];
    let mut mesh = egui::Mesh::default();
    for at in frame.into_iter().chain(corners) {
        mesh.colored_vertex(at, Color32::from_black_alpha(150));
    }
    for i in 0..4u32 {
        let j = (i + 1) % 4;
        mesh.add_triangle(i, j, 4 + i);
        mesh.add_triangle(j, 4 + j, 4 + i);
    }
    painter.add(egui::Shape::mesh(mesh));
}

/// A straight line through two points, drawn across the canvas.
pub fn line_across(painter: &Painter, [a, b]: [egui::Pos2; 2], stroke: egui::Stroke) {
    let rect = painter.clip_rect();
    let (dx, dy) = (b.x - a.x, b.y - a.y);
    if dx.abs() < 1e-3 {
        painter.line_segment([pos2(a.x, rect.top()), pos2(a.x, rect.bottom())], stroke);
        return;
    }
    let at = |x: f32| pos2(x, a.y + (x - a.x) * dy / dx);
    painter.line_segment([at(rect.left()), at(rect.right())], stroke);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn panel(left: f64) -> Panel {
        let (right, top, bottom) = (left + 300.0, 40.0, 240.0);
        Panel { panel: 1, image: 0, quad_px: [[left, top], [right, top], [right, bottom], [left, bottom]] }
    }

    #[test]
    fn stepping_to_the_next_panel_keeps_the_place_that_is_looked_at() {
        let canvas = Rect::from_min_max(pos2(0.0, 0.0), pos2(900.0, 700.0));
        let mut zoom = PanelZoom::default();
        let closer = zoom.view(&panel(10.0), canvas).zoomed(4.0, pos2(100.0, 600.0));
        zoom.take(&closer, &panel(10.0), canvas);
        let (here, there) = (zoom.view(&panel(10.0), canvas), zoom.view(&panel(400.0), canvas));
        let (a, b) =
            (here.plate_from_screen(pos2(450.0, 350.0)), there.plate_from_screen(pos2(450.0, 350.0)));
        assert!((here.zoom - there.zoom).abs() < 1e-9);
        assert!((b[0] - a[0] - 390.0).abs() < 1e-6 && (b[1] - a[1]).abs() < 1e-6);
    }
}
