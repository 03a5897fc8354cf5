//! Ground line and marks: what draws them, finds them, copies them.

use egui::{Button, DragValue, Grid, Ui, WidgetInfo, accesskit::Role};
use muybridge_capture::Draft;

use super::layout::{FIELD, group, remark, row};
use super::numbers::Number;
use super::units::number;
use super::{Tool, entry, marks};
use crate::app::PageContext;
use crate::command::Command;
use crate::session::Session;
use crate::toast::Messages;

/// Takes over the uprights that were looked for in the background.
pub(super) fn take_found(session: &mut Session, messages: &mut Messages) {
    let Some(found) = session.proposals.take_uprights() else { return };
    let first = session.calibrate.first_mark;
    session.commit();
    let mut after = session.draft().clone();
    let taken = marks::take_uprights(&mut after, &found, first);
    let none = found.iter().filter(|(_, uprights)| uprights.is_empty()).count();
    let unseen = if none > 0 { format!("; none seen in {none}") } else { String::new() };
    messages.note(format!("Uprights taken as marks in {taken} panels{unseen}; drag or delete wrong ones"));
    session.edit("Find uprights", |draft| *draft = after);
}

/// What a click on the photograph does.
pub(super) fn choose(ui: &mut Ui, session: &mut Session) {
    ui.horizontal_wrapped(|ui| {
        for (tool, title) in
            [(Tool::Ground, "Ground line"), (Tool::Length, "Draw a known length"), (Tool::Marks, "Marks")]
        {
            if ui.selectable_label(session.calibrate.tool == tool, title).clicked() {
                session.calibrate.tool = tool;
                session.calibrate.let_go();
            }
        }
    });
    ui.separator();
}

/// Both groups.
pub(super) fn show(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    group(ui, "Ground line", true, |ui| ground(ui, session, page));
    let open = session.calibrate.tool == Tool::Marks;
    group(ui, "Marks of this panel", true, |ui| marks_of_panel(ui, session, page, open));
}

fn small(ui: &mut Ui, title: &str, hover: &str, why_not: Option<&str>) -> bool {
    let button = ui.add_enabled(why_not.is_none(), Button::new(title));
    button.on_hover_text(hover).on_disabled_hover_text(why_not.unwrap_or_default()).clicked()
}

/// Why the photographs cannot be looked at now.
fn busy(session: &Session) -> Option<&'static str> {
    let missing = session.picture_is_missing().then_some("The photograph is not read yet");
    missing.or(session.proposals.work().is_some().then_some("Something else is under way"))
}

fn ground(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    let panel = session.panel;
    let drawn = |number: u32| session.draft().panel(number).is_some_and(|p| p.ground_px.is_some());
    let numbers = session.panel_numbers();
    let count = numbers.iter().filter(|number| drawn(**number)).count();
    let here = drawn(panel);
    ui.label(format!(
        "Drawn in {count} of {} panels, {}in this one",
        numbers.len(),
        if here { "" } else { "not " }
    ));
    let why_not = (!here).then_some("Draw the ground line of this panel first");
    let bare: Vec<u32> = marks::others(session.draft(), panel).into_iter().filter(|n| !drawn(*n)).collect();
    let in_row = marks::same_row(session.draft(), panel);
    let full = bare.is_empty().then_some("Every other panel has its ground line");
    let alone = in_row.is_empty().then_some("No other panel stands in the same row of the plate");
    ui.horizontal_wrapped(|ui| {
        if small(
            ui,
            "Find the ground lines",
            "Where none is drawn, looked for in the photographs",
            busy(session),
        ) {
            page.commands.push(Command::FindGround);
        }
        if small(ui, "Copy to panels without", "At the same place of each panel", why_not.or(full)) {
            session.commit();
            session.edit("Copy the ground line", |d| marks::copy_ground(d, panel, &bare, false));
        }
        let hover =
            "At the same place of all panels of this row of the plate, in place of what is drawn there";
        if small(ui, "Copy to this row", hover, why_not.or(alone)) {
            session.commit();
            session.edit("Copy the ground line to the row", |d| marks::copy_ground(d, panel, &in_row, true));
        }
        if small(ui, "Delete", "The ground line of this panel", why_not) {
            session.commit();
            session.edit("Delete the ground line", |draft| draft.panel_mut(panel).ground_px = None);
        }
    });
}

fn marks_of_panel(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>, placing: bool) {
    row(ui, "First mark", "Number of a panel's first mark, from the left", |ui| {
        let mut first = session.calibrate.first_mark;
        let value = DragValue::new(&mut first).range(-9999.0..=9999.0).speed(0.1).max_decimals(2);
        let response = ui.add_sized([FIELD, 20.0], value);
        response.widget_info(|| WidgetInfo::labeled(Role::SpinButton, true, "Number of the first mark"));
        session.calibrate.first_mark = first;
        if placing {
            let next = marks::next_number(session.panel_annotation(), first);
            ui.label(format!("next: {}", number(next)));
        }
    });
    buttons(ui, session, page);
    list(ui, session);
}

fn buttons(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    let (panel, first) = (session.panel, session.calibrate.first_mark);
    let count = session.panel_annotation().map_or(0, |panel| panel.marks.len());
    let none = (count == 0).then_some("This panel has no marks");
    let few = (count < 2).then_some("This panel needs two marks");
    let mut counted = None;
    let mut edit = |session: &mut Session, label: &str, change: &mut dyn FnMut(&mut Draft)| {
        entry::attempt(session, page.messages, label, change);
    };
    ui.horizontal_wrapped(|ui| {
        let working = busy(session);
        let hover =
            "Upright lines of the wall become marks where they cross the ground line, in panels without";
        if small(ui, "Find uprights", hover, working) {
            let draft = session.document.draft().clone();
            session.proposals.find_uprights(&draft, &session.images, ui.ctx());
        }
        if small(ui, "Number from the left", "From the first mark on, one by one", none) {
            edit(session, "Number the marks", &mut |draft| marks::renumber(draft, panel, first));
        }
        let hover =
            "The same upright gets the same number in all panels, following the cameras from this panel on";
        if small(ui, "Number all panels alike", hover, few) {
            let mut count = 0;
            edit(session, "Number all panels alike", &mut |draft| count = marks::number_alike(draft, panel));
            counted = Some(format!("Marks of {count} other panels numbered; look at the last one"));
        }
        let hover = "To panels without marks, at the same place: the scale is taken to be the same in all";
        if small(ui, "Copy to panels without", hover, few) {
            let targets = marks::others(session.draft(), panel);
            let mut count = 0;
            edit(session, "Copy the marks", &mut |draft| count = marks::copy_marks(draft, panel, &targets));
            counted = Some(format!("Marks copied to {count} panels"));
        }
        if small(ui, "Delete all", "All marks of this panel", none) {
            edit(session, "Delete the marks", &mut |draft| draft.panel_mut(panel).marks.clear());
        }
    });
    if let Some(counted) = counted {
        page.messages.note(counted);
    }
}

/// The marks in the order of the file, with their numbers to be changed.
fn list(ui: &mut Ui, session: &mut Session) {
    let panel = session.panel;
    let marks = session.panel_annotation().map(|panel| panel.marks.clone()).unwrap_or_default();
    if marks.is_empty() {
        remark(
            ui,
            "None yet. Marks are numbered points of known spacing: two ends of a length, uprights of a wall.",
        );
        return;
    }
    let mut gone = None;
    Grid::new("marks").num_columns(3).spacing([10.0, 3.0]).show(ui, |ui| {
        for (index, mark) in marks.iter().enumerate() {
            entry::number(ui, session, Number::Mark(panel, index), 44.0);
            ui.label(format!("at {:.1}, {:.1} px", mark.at_px[0], mark.at_px[1]));
            if ui.small_button("Delete").clicked() {
                gone = Some(index);
            }
            ui.end_row();
        }
    });
    let numbers: Vec<Number> = (0..marks.len()).map(|index| Number::Mark(panel, index)).collect();
    entry::refused(ui, session, &numbers);
    if let Some(index) = gone {
        delete(session, index);
    }
}

/// Deletes a mark of the panel looked at.
pub(super) fn delete(session: &mut Session, index: usize) {
    let panel = session.panel;
    let Some(mark) = session.panel_annotation().and_then(|panel| panel.marks.get(index)).copied() else {
        return;
    };
    session.commit();
    session.edit(&format!("Delete mark {}", number(mark.mark)), |draft| {
        draft.panel_mut(panel).marks.remove(index);
    });
}
