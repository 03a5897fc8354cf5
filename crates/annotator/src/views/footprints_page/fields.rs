//! Numbers of a track that are typed or dragged: a wrong one changes nothing, a field is one step of undo.

use std::ops::RangeInclusive;

use egui::accesskit::Role;
use egui::{DragValue, Response, Slider, Ui, WidgetInfo};
use muybridge_footprints::Track;

use crate::footprints::Editor;

/// How a number is shown.
pub(super) struct Number<'a> {
    pub(super) name: &'a str,
    pub(super) suffix: &'a str,
    pub(super) range: RangeInclusive<f64>,
    /// Change for a point of a drag.
    pub(super) speed: f64,
    pub(super) decimals: usize,
}

impl Number<'_> {
    /// Whether a number was typed or dragged to: what is only rounded to be shown is the same.
    fn is_another(&self, value: f64, typed: f64) -> bool {
        let unit = 10.0_f64.powi(-(self.decimals as i32));
        typed.is_finite() && (typed - value).abs() > 0.6 * unit
    }
}

/// A number of prints, without a name of its own beside it.
pub(super) fn drag_value(
    ui: &mut Ui,
    editor: &mut Editor,
    value: f64,
    number: &Number<'_>,
    set: impl FnOnce(&mut Track, f64),
) -> Response {
    let mut typed = value;
    let field = DragValue::new(&mut typed)
        .range(number.range.clone())
        .clamp_existing_to_range(false)
        .speed(number.speed)
        .suffix(number.suffix)
        .max_decimals(number.decimals);
    let response = ui.add(field);
    response.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, number.name));
    if response.changed() && number.is_another(value, typed) {
        editor.preview(number.name, |track| set(track, typed));
    }
    commit_at_end(editor, &response);
    response
}

/// A number of the whole track with a slider and its name: prints that are laid along the path go on being laid.
pub(super) fn slider(
    ui: &mut Ui,
    editor: &mut Editor,
    value: f64,
    number: &Number<'_>,
    set: impl FnOnce(&mut Track, f64),
) -> Response {
    let mut typed = value;
    let is_wide = *number.range.start() == 0.0 && *number.range.end() >= 100.0;
    let slider = Slider::new(&mut typed, number.range.clone())
        .text(number.name)
        .suffix(number.suffix)
        .logarithmic(is_wide)
        .clamping(egui::SliderClamping::Edits)
        .max_decimals(number.decimals);
    let response = ui.add(slider);
    if response.changed() && number.is_another(value, typed) {
        editor.document.preview(number.name, |track| set(track, typed));
    }
    commit_at_end(editor, &response);
    response
}

fn commit_at_end(editor: &mut Editor, response: &Response) {
    if response.drag_stopped() || response.lost_focus() {
        editor.commit();
    }
}
