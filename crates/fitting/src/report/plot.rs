//! Pen and axes for the report's plots, and their two sets of colours.
//!
//! Plots are drawn in px of the page's full width. `plotters` draws at whole units, so a px is several of
//! them, and the picture's `viewBox` brings them back to px.

use plotters::coord::Shift;
use plotters::coord::ranged1d::Ranged;
use plotters::coord::types::RangedCoordf64;
use plotters::element::DashedPathElement;
use plotters::prelude::{
    Circle, DrawingArea, DrawingAreaErrorKind, IntoDrawingArea, IntoTextStyle, PathElement, Polygon,
    RGBAColor, SVGBackend, ShapeStyle, Text,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::page::{escape, number};

/// Whole units of the backend per px: an eighth of a px keeps a hoof on its ground line.
const UNITS_PER_PX: f64 = 8.0;
/// `plotters` divides font sizes by this when it writes SVG.
const PLOTTERS_FONT_FACTOR: f64 = 1.24;
/// Size of labels, px.
pub(super) const LABEL_PX: f64 = 12.0;
/// Width of a plot that spans the page, px.
pub(super) const FULL_WIDTH_PX: f64 = 1080.0;
/// Width of one of two plots that stand side by side, px.
pub(super) const HALF_WIDTH_PX: f64 = 530.0;

/// What drawing returns.
pub(super) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// A colour by its role. Near and off, and the three laws, differ in lightness as well as in hue; on a contact sheet
/// the near limbs stand out as the darker (on dark paper the brighter) ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Ink {
    Paper,
    Text,
    Body,
    Muted,
    Rule,
    Near,
    Off,
    NearDark,
    OffLight,
    Ground,
    Flight,
    Support,
    LimbFore,
    LimbHind,
}

impl Ink {
    pub(super) const ALL: [Self; 14] = [
        Self::Paper,
        Self::Text,
        Self::Body,
        Self::Muted,
        Self::Rule,
        Self::Near,
        Self::Off,
        Self::NearDark,
        Self::OffLight,
        Self::Ground,
        Self::Flight,
        Self::Support,
        Self::LimbFore,
        Self::LimbHind,
    ];

    /// Name of the style sheet's variable.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Paper => "paper",
            Self::Text => "text",
            Self::Body => "body",
            Self::Muted => "muted",
            Self::Rule => "rule",
            Self::Near => "near",
            Self::Off => "off",
            Self::NearDark => "near-dark",
            Self::OffLight => "off-light",
            Self::Ground => "ground",
            Self::Flight => "flight",
            Self::Support => "support",
            Self::LimbFore => "limb-fore",
            Self::LimbHind => "limb-hind",
        }
    }

    /// Red, green and blue on light paper; no two inks share them.
    pub(super) fn light(self) -> [u8; 3] {
        match self {
            Self::Paper => [0xFC, 0xFB, 0xF8],
            Self::Text => [0x1D, 0x1D, 0x1F],
            Self::Body => [0x3A, 0x3A, 0x3D],
            Self::Muted => [0x66, 0x62, 0x5B],
            Self::Rule => [0xDD, 0xD8, 0xCE],
            Self::Near => [0xC8, 0x4E, 0x16],
            Self::Off => [0x1C, 0x6C, 0xB0],
            Self::NearDark => [0x8F, 0x35, 0x08],
            Self::OffLight => [0x5A, 0x98, 0xD0],
            Self::Ground => [0x8A, 0x7B, 0x62],
            Self::Flight => [0xEF, 0xE3, 0xC4],
            Self::Support => [0x14, 0x77, 0x55],
            Self::LimbFore => [0x8B, 0x3A, 0xA3],
            Self::LimbHind => [0xB5, 0x7E, 0x0A],
        }
    }

    /// Red, green and blue on dark paper.
    pub(super) fn dark(self) -> [u8; 3] {
        match self {
            Self::Paper => [0x17, 0x19, 0x1C],
            Self::Text => [0xE9, 0xE6, 0xE0],
            Self::Body => [0xD3, 0xD0, 0xC9],
            Self::Muted => [0xA6, 0xA1, 0x98],
            Self::Rule => [0x3A, 0x3D, 0x42],
            Self::Near => [0xF7, 0x9A, 0x5C],
            Self::Off => [0x66, 0xB0, 0xF2],
            Self::NearDark => [0xFF, 0xBA, 0x8C],
            Self::OffLight => [0x41, 0x7C, 0xB4],
            Self::Ground => [0x9C, 0x8F, 0x78],
            Self::Flight => [0x3D, 0x37, 0x24],
            Self::Support => [0x58, 0xCB, 0x9D],
            Self::LimbFore => [0xD3, 0x98, 0xE6],
            Self::LimbHind => [0xE8, 0xBC, 0x4F],
        }
    }

    fn style(self, opacity: f64) -> ShapeStyle {
        let [r, g, b] = self.light();
        ShapeStyle { color: RGBAColor(r, g, b, opacity), filled: true, stroke_width: 1 }
    }
}

/// Where a label's text stands against its point.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

/// Shape of a data point.
#[derive(Clone, Copy)]
pub(super) enum Mark {
    Dot,
    Triangle,
    Square,
    Diamond,
}

/// Draws in px, x right, y down.
pub(super) struct Pen<'a> {
    area: DrawingArea<SVGBackend<'a>, Shift>,
}

fn units([x, y]: [f64; 2]) -> (i32, i32) {
    ((x * UNITS_PER_PX).round() as i32, (y * UNITS_PER_PX).round() as i32)
}

fn length_in_units(px: f64) -> u32 {
    (px * UNITS_PER_PX).round().max(1.0) as u32
}

impl Pen<'_> {
    /// A line through points.
    pub(super) fn line(&self, points: &[[f64; 2]], ink: Ink, width_px: f64) -> Drawn {
        let style = ink.style(1.0).stroke_width(length_in_units(width_px));
        self.area.draw(&PathElement::new(points.iter().copied().map(units).collect::<Vec<_>>(), style))
    }

    /// A dashed line through points.
    pub(super) fn dashed(&self, points: &[[f64; 2]], ink: Ink, width_px: f64) -> Drawn {
        let style = ink.style(1.0).stroke_width(length_in_units(width_px));
        let points: Vec<(i32, i32)> = points.iter().copied().map(units).collect();
        let [dash, gap] = [6.0, 4.0].map(length_in_units);
        self.area.draw(&DashedPathElement::new(points, dash, gap, style))
    }

    /// A filled area.
    pub(super) fn area(&self, outline: &[[f64; 2]], ink: Ink, opacity: f64) -> Drawn {
        self.area
            .draw(&Polygon::new(outline.iter().copied().map(units).collect::<Vec<_>>(), ink.style(opacity)))
    }

    /// A filled rectangle between two corners.
    pub(super) fn rectangle(&self, [x0, y0]: [f64; 2], [x1, y1]: [f64; 2], ink: Ink, opacity: f64) -> Drawn {
        self.area(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]], ink, opacity)
    }

    /// A filled dot.
    pub(super) fn dot(&self, at: [f64; 2], radius_px: f64, ink: Ink, opacity: f64) -> Drawn {
        self.area.draw(&Circle::new(units(at), length_in_units(radius_px), ink.style(opacity)))
    }

    /// A hollow dot, filled with paper.
    pub(super) fn ring(&self, at: [f64; 2], radius_px: f64, ink: Ink) -> Drawn {
        self.dot(at, radius_px, Ink::Paper, 1.0)?;
        let style = ShapeStyle { filled: false, ..ink.style(1.0).stroke_width(length_in_units(1.0)) };
        self.area.draw(&Circle::new(units(at), length_in_units(radius_px), style))
    }

    /// A data point with a rim of paper, so that it stands out from its curve.
    pub(super) fn mark(&self, [x, y]: [f64; 2], mark: Mark, radius_px: f64, ink: Ink) -> Drawn {
        let outline = |r: f64| -> Vec<[f64; 2]> {
            let corner = |angle_deg: f64, r: f64| {
                let (sin, cos) = angle_deg.to_radians().sin_cos();
                [x + r * cos, y + r * sin]
            };
            match mark {
                Mark::Dot => (0..24).map(|i| corner(15.0 * f64::from(i), r)).collect(),
                Mark::Triangle => [-90.0, 30.0, 150.0].map(|a| corner(a, 1.25 * r)).to_vec(),
                Mark::Square => [45.0, 135.0, 225.0, 315.0].map(|a| corner(a, 1.2 * r)).to_vec(),
                Mark::Diamond => [0.0, 90.0, 180.0, 270.0].map(|a| corner(a, 1.2 * r)).to_vec(),
            }
        };
        self.area(&outline(radius_px + 1.2), Ink::Paper, 1.0)?;
        self.area(&outline(radius_px), ink, 1.0)
    }

    /// A label, centred on its point in height.
    pub(super) fn text(&self, at: [f64; 2], text: &str, size_px: f64, ink: Ink, anchor: Anchor) -> Drawn {
        let h_pos = match anchor {
            Anchor::Start => HPos::Left,
            Anchor::Middle => HPos::Center,
            Anchor::End => HPos::Right,
        };
        let font = ("sans-serif", size_px * UNITS_PER_PX * PLOTTERS_FONT_FACTOR).into_text_style(&self.area);
        let color = ink.style(1.0).color;
        let style = font.color(&color).pos(Pos::new(h_pos, VPos::Center));
        self.area.draw(&Text::new(text.to_string(), units(at), style))
    }

    /// An ordinary label.
    pub(super) fn label(&self, at: [f64; 2], text: &str, anchor: Anchor) -> Drawn {
        self.text(at, text, LABEL_PX, Ink::Muted, anchor)
    }
}

/// An inline picture with a title that screen readers speak; should drawing fail, a sentence that says so.
pub(super) fn svg(
    title: &str,
    [width_px, height_px]: [f64; 2],
    draw: impl FnOnce(&Pen<'_>) -> Drawn,
) -> String {
    let size = [width_px, height_px].map(length_in_units);
    let mut drawn = String::new();
    let result = {
        let pen = Pen { area: SVGBackend::with_string(&mut drawn, (size[0], size[1])).into_drawing_area() };
        draw(&pen).and_then(|()| pen.area.present())
    };
    if let Err(error) = result {
        return format!(
            "<p class=\"warning\">{}: the plot was not drawn: {}</p>",
            escape(title),
            escape(&error.to_string())
        );
    }
    // The backend's own opening tag fixes the size in px; this one lets the picture follow the page.
    let content = drawn.split_once('>').map_or("", |(_, content)| content);
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {} {}\" style=\"max-width:{width_px}px\" role=\"img\" \
         aria-label=\"{title}\"><title>{title}</title>{content}",
        size[0],
        size[1],
        title = escape(title)
    )
}

/// A linear axis: values to px.
#[derive(Clone, Copy)]
pub(super) struct Axis {
    pub(super) values: [f64; 2],
    pub(super) px: [f64; 2],
}

impl Axis {
    /// Px of a value.
    pub(super) fn at(&self, value: f64) -> f64 {
        let share = (value - self.values[0]) / (self.values[1] - self.values[0]);
        self.px[0] + share * (self.px[1] - self.px[0])
    }

    /// At most `count` round values on the axis.
    pub(super) fn ticks(&self, count: usize) -> Vec<f64> {
        RangedCoordf64::from(self.values[0]..self.values[1]).key_points(count)
    }
}

/// A tick's label, with as many decimals as neighbouring ticks need to differ.
pub(super) fn tick_label(value: f64, ticks: &[f64]) -> String {
    let step = ticks.windows(2).map(|w| (w[1] - w[0]).abs()).fold(f64::INFINITY, f64::min);
    let decimals = match step {
        s if s >= 0.999 => 0,
        s if s >= 0.0999 => 1,
        _ => 2,
    };
    number(value, decimals)
}

/// A frame of two axes with grid lines and labels at the bottom and on the left.
pub(super) struct Frame {
    pub(super) x: Axis,
    pub(super) y: Axis,
}

impl Frame {
    /// Px of a point.
    pub(super) fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.x.at(x), self.y.at(y)]
    }

    /// Grid, tick labels, and what the axes show.
    pub(super) fn draw(
        &self,
        pen: &Pen<'_>,
        [x_ticks, y_ticks]: [usize; 2],
        [x_name, y_name]: [&str; 2],
    ) -> Drawn {
        let ([left, right], [bottom, top]) = (self.x.px, self.y.px);
        let ticks = self.x.ticks(x_ticks);
        for value in &ticks {
            let x = self.x.at(*value);
            pen.line(&[[x, bottom], [x, top]], Ink::Rule, 0.75)?;
            pen.label([x, bottom + 12.0], &tick_label(*value, &ticks), Anchor::Middle)?;
        }
        let ticks = self.y.ticks(y_ticks);
        for value in &ticks {
            let y = self.y.at(*value);
            pen.line(&[[left, y], [right, y]], Ink::Rule, 0.75)?;
            pen.label([left - 6.0, y], &tick_label(*value, &ticks), Anchor::End)?;
        }
        pen.label([right, bottom + 28.0], x_name, Anchor::End)?;
        pen.label([left - 6.0, top - 16.0], y_name, Anchor::Start)
    }
}
