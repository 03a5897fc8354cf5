//! Rows and groups of the page's forms, all of one width.

use egui::{Align, CollapsingHeader, ComboBox, Label, Layout, RichText, Ui, vec2};

/// Width of the names at the left, screen points.
const NAMES: f32 = 92.0;
/// Height of a row.
const ROW: f32 = 22.0;
/// Width of a number's field.
pub(super) const FIELD: f32 = 56.0;

/// A part of the form that can be folded.
pub(super) fn group(ui: &mut Ui, title: &str, open: bool, content: impl FnOnce(&mut Ui)) {
    let heading = RichText::new(title).strong().size(15.0);
    CollapsingHeader::new(heading).default_open(open).show_unindented(ui, |ui| {
        ui.add_space(2.0);
        content(ui);
        ui.add_space(6.0);
    });
}

/// A name and what belongs to it.
pub(super) fn row<R>(ui: &mut Ui, name: &str, explanation: &str, content: impl FnOnce(&mut Ui) -> R) -> R {
    ui.horizontal(|ui| {
        // Narrow, so that a number with its longest unit fits beside its name.
        ui.spacing_mut().item_spacing.x = 6.0;
        ui.allocate_ui_with_layout(vec2(NAMES, ROW), Layout::left_to_right(Align::Center), |ui| {
            ui.set_min_width(NAMES);
            let label = ui.add(Label::new(name).truncate());
            if !explanation.is_empty() {
                label.on_hover_text(explanation);
            }
        });
        content(ui)
    })
    .inner
}

/// One of several: what it is, its name, and why it cannot be chosen now.
pub(super) type Choice<'a, T> = (T, &'a str, Option<&'a str>);

/// A list to choose from; the new choice, once.
pub(super) fn choose<T: PartialEq + Copy>(
    ui: &mut Ui,
    name: &str,
    now: T,
    choices: &[Choice<'_, T>],
    width: f32,
) -> Option<T> {
    let shown = choices.iter().find(|(choice, ..)| *choice == now).map_or("", |(_, title, _)| title);
    let list = ComboBox::from_id_salt(name).selected_text(shown).width(width).truncate();
    let mut chosen = None;
    let response = list.show_ui(ui, |ui| {
        for (choice, title, why_not) in choices {
            let button = egui::Button::selectable(*choice == now, *title);
            let response = ui.add_enabled(why_not.is_none(), button);
            if response.on_disabled_hover_text(why_not.unwrap_or_default()).clicked() && *choice != now {
                chosen = Some(*choice);
            }
        }
    });
    let label = format!("{name}: {shown}");
    response
        .response
        .widget_info(|| egui::WidgetInfo::labeled(egui::accesskit::Role::ComboBox, true, &label));
    chosen
}

/// What is explained in passing, in a weak colour.
pub(super) fn remark(ui: &mut Ui, text: impl Into<String>) {
    ui.label(RichText::new(text).weak().size(12.0));
}
