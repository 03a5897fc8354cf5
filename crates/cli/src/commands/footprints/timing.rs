//! The timing diagram: when each foot is down.

use muybridge_footprints::Foot;

use super::chart::{Axis, Chart};
use super::sheet::{Anchor, PAPER, RULE, SMALL_PX, Sheet};
use super::supports::{color, foot_color, legend};
use super::walk::Walk;

/// Height of a row, and of the bar in it, px.
const ROW_PX: f64 = 34.0;
const BAR_PX: f64 = 20.0;
/// The strip of all feet together under the rows, px.
const STRIP_PX: f64 = 12.0;

/// The timing diagram on a sheet of a width, px.
pub(super) fn timing(walk: &Walk, title: &str, width_px: f64) -> Sheet {
    let placed = &walk.motion.placed;
    let is_biped = placed.prints.first().is_none_or(|print| print.foot.is_biped());
    let feet: &[Foot] = if is_biped { &Foot::BIPED } else { &Foot::QUADRUPED };
    let axes = [Axis::new([0.0, placed.end_s], "time (s)"), Axis::new([0.0, 1.0], "")];
    let height_px = ROW_PX * feet.len() as f64 + STRIP_PX + 10.0;
    let chart = Chart::new(width_px, axes, Some(height_px));
    let mut sheet = chart.sheet();
    chart.draw_axes(&mut sheet, false);
    let x = |time_s: f64| chart.place([time_s.clamp(0.0, placed.end_s), 0.0])[0];
    let middle = |row: usize| chart.at[1] + ROW_PX * (row as f64 + 0.5);
    for (row, foot) in feet.iter().enumerate() {
        let y = middle(row);
        sheet.line(vec![[chart.at[0], y], [chart.at[0] + chart.size[0], y]], RULE, 1.0);
        chart.draw_row_name(&mut sheet, y, foot.abbreviation());
    }
    for (number, print) in placed.prints.iter().enumerate() {
        let row = feet.iter().position(|foot| *foot == print.foot).unwrap_or(0);
        let (from, to) = (x(print.strike_s), x(print.lift_off_s));
        let at = [from, middle(row) - BAR_PX / 2.0];
        sheet.rectangle(at, [(to - from).max(1.0), BAR_PX], foot_color(print.foot));
        let words = (number + 1).to_string();
        if to - from > 9.0 * words.len() as f64 + 4.0 {
            sheet.text([0.5 * (from + to), middle(row) + 4.5], &words, PAPER, SMALL_PX, Anchor::Middle);
        }
    }
    let supports = placed.supports();
    let top = chart.at[1] + chart.size[1] - STRIP_PX;
    for support in &supports {
        let (from, to) = (x(support.from_s), x(support.to_s));
        sheet.rectangle([from, top], [to - from, STRIP_PX], color(&support.down));
    }
    chart.draw_title(&mut sheet, title, "timing");
    chart.draw_legend(&mut sheet, &legend(&supports));
    sheet
}
