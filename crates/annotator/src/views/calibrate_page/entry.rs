//! Fields in which numbers and words are typed: a wrong number is red and changes nothing, a field is one step of undo.

use std::path::Path;

use egui::text::{CCursor, CCursorRange};
use egui::widgets::text_edit::TextEditState;
use egui::{Id, Key, Response, RichText, TextEdit, Ui, WidgetInfo, accesskit::Role};
use muybridge_capture::{Draft, Fault, Plate, PlateError};

use super::numbers::{Number, Quantity};
use super::units::Unit;
use crate::session::Session;
use crate::toast::Messages;

/// What has been typed into a field that is not left yet, or that holds a wrong number.
#[derive(Clone, Debug)]
pub(super) struct Typing {
    number: Number,
    text: String,
    refusal: Option<String>,
}

/// Faults of a calibration and of marks; all others are nothing to do with this page.
fn faults(draft: &Draft) -> Vec<Fault> {
    let concerns = |fault: &Fault| {
        ["calibration.", "stride.closes", "marks["].iter().any(|start| fault.field.starts_with(start))
    };
    let manifest = (Path::new("manifest"), draft.manifest.clone());
    match Plate::from_documents(manifest, (Path::new("annotation"), draft.annotation.clone())) {
        Err(PlateError::Faults(found)) => found.into_iter().filter(concerns).collect(),
        _ => Vec::new(),
    }
}

/// Why a change cannot be made: the first fault that it would bring.
pub(super) fn refusal(before: &Draft, after: &Draft) -> Option<String> {
    let known = faults(before);
    let is_new = |fault: &Fault| !known.iter().any(|k| k.panel == fault.panel && k.field == fault.field);
    faults(after).into_iter().find(is_new).map(|fault| fault.message)
}

/// Makes a change by a click, or says why not.
pub(super) fn attempt(
    session: &mut Session,
    messages: &mut Messages,
    label: &str,
    change: impl FnOnce(&mut Draft),
) {
    session.commit();
    let mut after = session.draft().clone();
    change(&mut after);
    match refusal(session.draft(), &after) {
        Some(reason) => messages.trouble(format!("{label}: {reason}")),
        None => session.edit(label, |draft| *draft = after),
    }
}

/// A typed number as the file has it.
///
/// # Errors
/// In words, when it is no number or not a possible one.
fn checked(draft: &Draft, number: Number, unit: Unit, text: &str) -> Result<f64, String> {
    let value = unit.value(text)?;
    let mut after = draft.clone();
    number.set(&mut after, value);
    let Some(reason) = refusal(draft, &after) else { return Ok(value) };
    let file = number.units()[0].sign();
    Err(match (unit == number.units()[0], file) {
        (_, "") => reason,
        (true, file) => format!("{reason} {file}"),
        (false, file) => format!("{} {} are {reason} {file}", text.trim(), unit.sign()),
    })
}

/// A field for a number; nothing where the documents have no place for it.
pub(super) fn number(ui: &mut Ui, session: &mut Session, number: Number, width: f32) {
    let Some(value) = number.get(session.document.draft()) else { return };
    let (unit, id) = (session.calibrate.unit(number), Id::unique(("calibration", number)));
    let typing = session.calibrate.typing.take_if(|typing| typing.number == number);
    let is_typed = typing.is_some();
    let (mut text, mut refused) = match typing {
        Some(Typing { text, refusal, .. }) => (text, refusal),
        None => (unit.text(value), None),
    };
    if session.calibrate.wants_focus.take_if(|wanted| *wanted == number).is_some() {
        select_all(ui, id, &text);
    }
    let mut edit = TextEdit::singleline(&mut text).id(id).desired_width(width);
    if refused.is_some() {
        edit = edit.text_color(ui.visuals().error_fg_color);
    }
    let response = ui.add(edit);
    let name = number.name();
    response.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, &name));
    if response.changed() {
        refused = None;
        match checked(session.document.draft(), number, unit, &text) {
            Ok(value) => session.preview(&name, |draft| number.set(draft, value)),
            Err(reason) => {
                session.cancel();
                refused = Some(reason);
            }
        }
    }
    let ended = is_left(ui, &response);
    let escaped = ended && ui.input(|input| input.key_pressed(Key::Escape));
    if escaped {
        session.cancel();
    } else if ended {
        session.commit();
    }
    // A wrong number stays to be seen until it is corrected or something else is typed.
    let keeps = refused.is_some() || !ended;
    if (is_typed || response.changed()) && keeps && !escaped {
        session.calibrate.typing = Some(Typing { number, text, refusal: refused });
    }
}

/// Whether a field is left in this frame: by a key, or by the button going down somewhere else.
fn is_left(ui: &Ui, response: &Response) -> bool {
    let elsewhere = ui.input(|input| {
        let at = input.pointer.interact_pos();
        input.pointer.any_pressed() && at.is_some_and(|at| !response.rect.contains(at))
    });
    response.lost_focus() || (response.has_focus() && elsewhere)
}

fn select_all(ui: &Ui, id: Id, text: &str) {
    ui.memory_mut(|memory| memory.request_focus(id));
    let mut state = TextEditState::load(ui.ctx(), id).unwrap_or_default();
    let range = CCursorRange::two(CCursor::new(0), CCursor::new(text.chars().count()));
    state.cursor.set_char_range(Some(range));
    state.store(ui.ctx(), id);
}

/// Why what was typed into one of these fields is not taken over, in red.
pub(super) fn refused(ui: &mut Ui, session: &Session, numbers: &[Number]) {
    let typing = session.calibrate.typing.as_ref().filter(|typing| numbers.contains(&typing.number));
    if let Some(reason) = typing.and_then(|typing| typing.refusal.as_ref()) {
        ui.label(RichText::new(format!("Not taken over: {reason}")).color(ui.visuals().error_fg_color));
    }
}

/// The words that say where a quantity is from.
pub(super) fn origin(ui: &mut Ui, session: &mut Session, quantity: Quantity) {
    let known = session.draft().manifest.calibration.as_ref().and_then(|c| quantity.of(c));
    let Some(mut text) = known.map(|known| known.from.clone()) else { return };
    let label = format!("{}, where from", quantity.name());
    let id = Id::unique(("origin", quantity));
    // The scroll bar needs the rest.
    let width = ui.available_width() - 14.0;
    let edit = TextEdit::multiline(&mut text).id(id).desired_rows(1).desired_width(width);
    let response = ui.add(edit.return_key(None).hint_text("printed where, or assumed why"));
    response.widget_info(|| WidgetInfo::labeled(Role::TextInput, true, &label));
    if response.changed() {
        session.preview(&label, |draft| {
            let calibration = draft.manifest.calibration.as_mut();
            if let Some(known) = calibration.and_then(|calibration| quantity.of_mut(calibration)) {
                known.from = text;
            }
        });
    }
    if is_left(ui, &response) {
        session.commit();
    }
}
