//! Which panels make up the stride, and after how many it closes.

use egui::{Ui, WidgetInfo, accesskit::Role};

use super::entry;
use super::layout::{FIELD, choose, row};
use super::numbers::Number;
use crate::app::PageContext;
use crate::session::Session;

/// First and last panel, and when the movement repeats.
pub(super) fn show(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    let (numbers, span) = (session.panel_numbers(), session.draft().annotation.stride);
    let time = session.draft().manifest.calibration.as_ref().map(|calibration| &calibration.time);
    let uneven = time.is_some_and(|time| time.intervals_s.is_some());
    let fixed = uneven.then_some("The manifest gives an interval for each gap of the present stride");
    let titles: Vec<(u32, String)> =
        numbers.iter().map(|number| (*number, format!("panel {number}"))).collect();
    let mut chosen = span;
    for (name, end, is_first) in [("First", span.first, true), ("Last", span.last, false)] {
        let choices: Vec<(u32, &str, Option<&str>)> = titles
            .iter()
            .map(|(number, title)| {
                let before = if is_first { *number < span.last } else { *number > span.first };
                let why_not = fixed.or((!before).then_some("The first panel must come before the last"));
                (*number, title.as_str(), why_not)
            })
            .collect();
        let label = format!("{name} panel of the stride");
        let picked = row(ui, name, &label, |ui| choose(ui, &label, end, &choices, 100.0));
        match picked {
            Some(number) if is_first => chosen.first = number,
            Some(number) => chosen.last = number,
            None => {}
        }
    }
    if chosen != span {
        entry::attempt(session, page.messages, "Panels of the stride", |draft| {
            draft.annotation.stride = chosen;
        });
    }
    closes(ui, session, page);
}

fn closes(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    let span = session.draft().annotation.stride;
    let why = "Panels after which the movement repeats, where it can be told; otherwise it is searched for";
    row(ui, "Closes after", why, |ui| {
        let mut known = span.closes_after_panels.is_some();
        let response = ui.checkbox(&mut known, "");
        response.widget_info(|| {
            WidgetInfo::selected(Role::CheckBox, true, known, "It is known when the stride closes")
        });
        if response.changed() {
            let panels = f64::from(span.last.saturating_sub(span.first) + 1).max(2.0);
            entry::attempt(session, page.messages, "When the stride closes", |draft| {
                draft.annotation.stride.closes_after_panels = known.then_some(panels);
            });
        }
        if span.closes_after_panels.is_some() {
            entry::number(ui, session, Number::ClosesAfter, FIELD);
            ui.label("panels");
        } else {
            ui.label("not known: searched for");
        }
    });
    entry::refused(ui, session, &[Number::ClosesAfter]);
}
