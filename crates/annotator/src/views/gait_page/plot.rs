//! Axes of a small plot, painted by hand.

use egui::accesskit::Role;
use egui::{
    Align2, Color32, FontId, Painter, Pos2, Rect, Response, Sense, Stroke, Ui, WidgetInfo, pos2, vec2,
};

/// Space for the numbers beside and below the plot, and for the name of the vertical axis above it, screen points.
const LEFT: f32 = 34.0;
const BELOW: f32 = 32.0;
const ABOVE: f32 = 18.0;
/// About so many ticks to an axis.
const TICKS: f64 = 5.0;
/// Size of numbers and names.
const FONT: f32 = 11.5;

/// One axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    /// What is along it, with its unit.
    pub(super) name: &'static str,
    /// Value at the left or lower end and at the other.
    pub(super) range: [f64; 2],
}

impl Axis {
    fn share(&self, value: f64) -> f32 {
        ((value - self.range[0]) / (self.range[1] - self.range[0])) as f32
    }

    /// Round values within the range, and the decimals to write them with.
    fn ticks(&self) -> (Vec<f64>, usize) {
        let [low, high] = self.range;
        let step = round_step((high - low) / TICKS);
        let decimals = (-step.log10().floor()).max(0.0) as usize;
        let (first, last) = ((low / step).ceil() as i64, (high / step + 1e-9).floor() as i64);
        ((first..=last).map(|i| i as f64 * step).collect(), decimals)
    }
}

/// The least of 1, 2, 5, 10, ... that is not below a value.
pub(super) fn round_step(value: f64) -> f64 {
    let power = 10f64.powf(value.max(1e-12).log10().floor());
    [1.0, 2.0, 5.0, 10.0]
        .into_iter()
        .map(|factor| factor * power)
        .find(|step| *step >= 0.999 * value)
        .unwrap_or(power)
}

/// A plot under way.
pub(super) struct Plot {
    /// Clipped to the plot's area.
    pub(super) painter: Painter,
    /// The area.
    pub(super) rect: Rect,
    x: Axis,
    y: Axis,
}

impl Plot {
    /// Makes room, draws background, grid and numbers.
    pub(super) fn new(ui: &mut Ui, height: f32, name: &str, x: Axis, y: Axis) -> (Self, Response) {
        let (outer, response) = ui.allocate_exact_size(vec2(ui.available_width(), height), Sense::hover());
        response.widget_info(|| WidgetInfo::labeled(Role::Image, true, name));
        let rect = Rect::from_min_max(outer.min + vec2(LEFT, ABOVE), outer.max - vec2(8.0, BELOW));
        let plot = Self { painter: ui.painter_at(rect.expand(1.0)), rect, x, y };
        if ui.is_rect_visible(outer) {
            plot.draw_axes(ui, outer);
        }
        (plot, response)
    }

    fn draw_axes(&self, ui: &Ui, outer: Rect) {
        let (painter, visuals) = (ui.painter(), ui.visuals());
        let (weak, font) = (visuals.weak_text_color(), FontId::proportional(FONT));
        let grid = Stroke::new(1.0, visuals.weak_text_color().gamma_multiply(0.25));
        self.painter.rect_filled(self.rect, 2.0, visuals.extreme_bg_color);
        let (values, decimals) = self.x.ticks();
        for value in values {
            let x = self.at([value, 0.0]).x;
            self.painter.vline(x, self.rect.y_range(), grid);
            let at = pos2(x, self.rect.bottom() + 2.0);
            painter.text(at, Align2::CENTER_TOP, format!("{value:.decimals$}"), font.clone(), weak);
        }
        let (values, decimals) = self.y.ticks();
        for value in values {
            let y = self.at([0.0, value]).y;
            self.painter.hline(self.rect.x_range(), y, grid);
            let at = pos2(self.rect.left() - 4.0, y);
            painter.text(at, Align2::RIGHT_CENTER, format!("{value:.decimals$}"), font.clone(), weak);
        }
        let [above, below] = [outer.left_top(), outer.right_bottom() - vec2(8.0, 1.0)];
        painter.text(above, Align2::LEFT_TOP, self.y.name, font.clone(), visuals.text_color());
        painter.text(below, Align2::RIGHT_BOTTOM, self.x.name, font, visuals.text_color());
    }

    /// Where a pair of values is on the screen.
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> Pos2 {
        self.rect.lerp_inside(vec2(self.x.share(x), 1.0 - self.y.share(y)))
    }

    /// A point with its standard deviations: filled, or a ring for the fit's.
    pub(super) fn point(&self, at: [f64; 2], sd: [f64; 2], color: Color32, is_fit: bool) {
        let stroke = Stroke::new(if is_fit { 1.0 } else { 1.5 }, color);
        for by in [[sd[0], 0.0], [0.0, sd[1]]] {
            let ends = [-1.0, 1.0].map(|sign| self.at([at[0] + sign * by[0], at[1] + sign * by[1]]));
            self.painter.line_segment(ends, stroke);
        }
        if is_fit {
            self.painter.circle_stroke(self.at(at), 6.0, Stroke::new(1.8, color));
        } else {
            self.painter.circle_filled(self.at(at), 4.0, color);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_within_the_range() {
        for (range, count) in [([0.0, 0.23], 5), ([11.6, 18.9], 4), ([0.0, 100.0], 6)] {
            let (ticks, decimals) = Axis { name: "", range }.ticks();
            assert_eq!(ticks.len(), count, "{ticks:?}");
            assert!(ticks.iter().all(|t| range[0] <= *t && *t <= range[1] + 1e-9) && decimals <= 2);
        }
    }
}
