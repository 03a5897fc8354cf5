//! A chart on a sheet: two axes, a title, a legend.

use super::sheet::{Anchor, Color, INK, MUTED, RULE, SMALL_PX, Sheet, TEXT_PX, TITLE_PX};

/// Room at the left for numbers, at the right, at the top for title and legend, and at the bottom for the axis, px.
const LEFT_PX: f64 = 64.0;
const RIGHT_PX: f64 = 24.0;
const TOP_PX: f64 = 76.0;
const BOTTOM_PX: f64 = 46.0;
/// The line under the axis: what it is, and at the right what else there is to say, px under the inner part.
pub(super) const FOOT_PX: f64 = 36.0;
/// About so many px are between two numbers of an axis.
const TICK_PX: f64 = 72.0;
/// Width of a character of small words, about, px.
const CHARACTER_PX: f64 = 6.9;
/// A sample of a colour in the legend, px.
const SAMPLE_PX: [f64; 2] = [18.0, 10.0];

/// A range of numbers, which may fall, and what they are.
#[derive(Clone, Debug)]
pub(super) struct Axis {
    pub(super) from: f64,
    pub(super) to: f64,
    pub(super) label: &'static str,
}

/// The middle part of a sheet, and its scales. The second axis points up.
#[derive(Clone, Debug)]
pub(super) struct Chart {
    pub(super) axes: [Axis; 2],
    /// Left and top of the inner part, px.
    pub(super) at: [f64; 2],
    /// Its width and height, px.
    pub(super) size: [f64; 2],
}

impl Axis {
    pub(super) fn new([from, to]: [f64; 2], label: &'static str) -> Self {
        Self { from, to, label }
    }

    fn length(&self) -> f64 {
        (self.to - self.from).abs().max(1e-9)
    }

    /// Round numbers on the axis when it is so long, px.
    fn ticks(&self, length_px: f64) -> Vec<f64> {
        let step = round_step(self.length() * TICK_PX / length_px);
        let first = (self.from.min(self.to) / step - 1e-6).ceil() as i64;
        let last = (self.from.max(self.to) / step + 1e-6).floor() as i64;
        (first..=last).map(|i| i as f64 * step).collect()
    }
}

/// The next number of 1, 2, 5, 10, 20, 50 ...
pub(super) fn round_step(least: f64) -> f64 {
    let ten = 10_f64.powf(least.max(1e-9).log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * ten >= least * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * ten
}

/// A number of an axis, without more decimals than it needs.
fn number(value: f64) -> String {
    let text = format!("{value:.3}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.replace('-', "\u{2212}") }
}

impl Chart {
    /// A chart as wide as a sheet of `width_px`; a second axis in the units of the first has its scale, else the height is given, px.
    pub(super) fn new(width_px: f64, axes: [Axis; 2], height_px: Option<f64>) -> Self {
        let inner_px = Self::inner_px(width_px);
        let height_px = height_px.unwrap_or(inner_px * axes[1].length() / axes[0].length());
        Self { axes, at: [LEFT_PX, TOP_PX], size: [inner_px, height_px] }
    }

    /// Width of the inner part of a chart, px.
    pub(super) fn inner_px(width_px: f64) -> f64 {
        width_px - LEFT_PX - RIGHT_PX
    }

    /// A sheet that it fits on.
    pub(super) fn sheet(&self) -> Sheet {
        Sheet::new([self.at[0] + self.size[0] + RIGHT_PX, self.at[1] + self.size[1] + BOTTOM_PX])
    }

    /// Px for each unit of an axis.
    pub(super) fn scale(&self, axis: usize) -> f64 {
        self.size[axis] / self.axes[axis].length()
    }

    /// The place of two numbers, px.
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [left, top] = self.at;
        let share =
            |axis: &Axis, value: f64| (value - axis.from) / axis.length() * (axis.to - axis.from).signum();
        let (right, up) = (share(&self.axes[0], x) * self.size[0], share(&self.axes[1], y) * self.size[1]);
        [left + right, top + self.size[1] - up]
    }

    /// The two numbers at a place, px.
    pub(super) fn value(&self, [x_px, y_px]: [f64; 2]) -> [f64; 2] {
        let shares = [(x_px - self.at[0]) / self.size[0], 1.0 - (y_px - self.at[1]) / self.size[1]];
        [0, 1].map(|i| self.axes[i].from + (self.axes[i].to - self.axes[i].from) * shares[i])
    }

    /// Draws grid and numbers of the first axis, and of the second if it has any.
    pub(super) fn draw_axes(&self, sheet: &mut Sheet, with_second: bool) {
        let ([left, top], [width, height]) = (self.at, self.size);
        let bottom = top + height;
        for value in self.axes[0].ticks(width) {
            let x = self.place([value, 0.0])[0];
            sheet.line(vec![[x, top], [x, bottom]], RULE, 1.0);
            sheet.text([x, bottom + 17.0], &number(value), MUTED, SMALL_PX, Anchor::Middle);
        }
        if with_second {
            for value in self.axes[1].ticks(height) {
                let y = self.place([0.0, value])[1];
                sheet.line(vec![[left, y], [left + width, y]], RULE, 1.0);
                sheet.text([left - 9.0, y + 4.5], &number(value), MUTED, SMALL_PX, Anchor::End);
            }
            sheet.text([8.0, top - 9.0], self.axes[1].label, MUTED, SMALL_PX, Anchor::Start);
        }
        sheet.text([left, bottom + FOOT_PX], self.axes[0].label, MUTED, SMALL_PX, Anchor::Start);
    }

    /// Writes the title, with lesser words after it.
    pub(super) fn draw_title(&self, sheet: &mut Sheet, title: &str, about: &str) {
        sheet.text([self.at[0], 26.0], title, INK, TITLE_PX, Anchor::Start);
        sheet.text([self.at[0] + self.size[0], 26.0], about, MUTED, SMALL_PX, Anchor::End);
    }

    /// Draws samples of colours and what they mean, under the title.
    pub(super) fn draw_legend(&self, sheet: &mut Sheet, entries: &[(Color, String)]) {
        let mut x = self.at[0];
        for (color, words) in entries {
            sheet.rectangle([x, 39.0], SAMPLE_PX, *color);
            x += SAMPLE_PX[0] + 6.0;
            sheet.text([x, 49.0], words, MUTED, SMALL_PX, Anchor::Start);
            x += CHARACTER_PX * words.chars().count() as f64 + 18.0;
        }
    }

    /// Words at the start of a row, to the left of the inner part.
    pub(super) fn draw_row_name(&self, sheet: &mut Sheet, y: f64, name: &str) {
        sheet.text([self.at[0] - 12.0, y + 5.0], name, INK, TEXT_PX, Anchor::End);
    }
}
