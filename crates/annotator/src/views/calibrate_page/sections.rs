//! The forms of the calibration: scale, position, time, camera.

use egui::Ui;
use muybridge_capture::{Calibration, Draft, Parallax, Plane, Position, ScaleSource, TimeSource};

use super::layout::{FIELD, choose, group, remark, row};
use super::numbers::{Number, Quantity};
use super::{defaults, entry};
use crate::app::PageContext;
use crate::session::Session;

/// Width of a list beside a name, screen points.
const LIST: f32 = 160.0;

/// A change of the calibration by a click.
pub(super) fn change(
    session: &mut Session,
    page: &mut PageContext<'_>,
    label: &str,
    change: impl FnOnce(&mut Calibration),
) {
    entry::attempt(session, page.messages, label, |draft: &mut Draft| {
        if let Some(calibration) = &mut draft.manifest.calibration {
            change(calibration);
        }
    });
}

/// All forms.
pub(super) fn show(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    group(ui, "Scale", true, |ui| scale(ui, session, page));
    group(ui, "Position of the cameras", true, |ui| super::position::show(ui, session, page));
    group(ui, "Time", true, |ui| time(ui, session, page));
    group(ui, "Stride", true, |ui| super::stride::show(ui, session, page));
    group(ui, "Camera", false, |ui| {
        known(ui, session, page, Quantity::CameraDistance);
        known(ui, session, page, Quantity::CameraHeight);
        remark(ui, "They give the perspective of the off side: good to a few metres is enough.");
    });
}

pub(super) fn calibration(session: &Session) -> Option<&Calibration> {
    session.draft().manifest.calibration.as_ref()
}

/// A value with its unit, its standard deviation, and where it is from.
pub(super) fn known(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>, quantity: Quantity) {
    let Some(was_assumed) = calibration(session).and_then(|c| quantity.of(c)).map(|known| known.assumed)
    else {
        return;
    };
    let [value, spread] = [Number::Value(quantity), Number::Spread(quantity)];
    row(ui, quantity.name(), quantity.explanation(), |ui| {
        entry::number(ui, session, value, FIELD);
        unit(ui, session, value);
    });
    let meaning = "Standard deviation: two times out of three the truth is no farther off than this";
    row(ui, "give or take", meaning, |ui| {
        entry::number(ui, session, spread, FIELD);
        ui.label(session.calibrate.unit(spread).sign());
        let mut assumed = was_assumed;
        let hover = "Nobody stated it with the plate: a person assumed it";
        if ui.checkbox(&mut assumed, "assumed").on_hover_text(hover).changed() {
            let label = format!("{}, assumed", quantity.name());
            change(session, page, &label, |calibration| {
                if let Some(known) = quantity.of_mut(calibration) {
                    known.assumed = assumed;
                }
            });
        }
    });
    entry::refused(ui, session, &[value, spread]);
    row(ui, "from", "Printed where, or assumed why", |ui| entry::origin(ui, session, quantity));
    ui.add_space(6.0);
}

/// The unit in which a number is typed; the files stay in metres and seconds.
fn unit(ui: &mut Ui, session: &mut Session, number: Number) {
    let now = session.calibrate.unit(number);
    if number.units().len() > 1 {
        let choices: Vec<_> = number.units().iter().map(|unit| (*unit, unit.sign(), None)).collect();
        let name = format!("Unit of {}", number.name());
        if let Some(unit) = choose(ui, &name, now, &choices, 62.0) {
            session.calibrate.set_unit(number, unit);
        }
    } else {
        ui.label(now.sign());
    }
}

/// A button that takes a source away, or says why it cannot go.
fn remove(ui: &mut Ui, name: &str, drives: bool) -> bool {
    let button = ui.add_enabled(!drives, egui::Button::new(format!("Remove {name}")).small());
    let clicked = button.on_disabled_hover_text("It is what drives; choose another one first").clicked();
    ui.add_space(6.0);
    clicked
}

fn scale(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    let Some(now) = calibration(session).map(|c| c.scale.driven_by) else { return };
    let sources = [
        (ScaleSource::KnownLength, "the known length", None),
        (ScaleSource::WithersHeight, "the withers height", None),
    ];
    let why = "What the fit uses; the other is compared with it";
    let chosen = row(ui, "Driven by", why, |ui| choose(ui, "Scale driven by", now, &sources, LIST));
    if let Some(source) = chosen {
        change(session, page, "Source of scale", |c| defaults::give_scale(c, source));
    }
    if calibration(session).is_some_and(|c| c.scale.known_length.is_some()) {
        known(ui, session, page, Quantity::MarkSpacing);
        plane(ui, session, page);
        if remove(ui, "the known length", now == ScaleSource::KnownLength) {
            change(session, page, "Remove the known length", |c| c.scale.known_length = None);
        }
    } else if ui.button("Add a known length").clicked() {
        change(session, page, "Known length", |c| {
            c.scale.known_length = Some(defaults::known_length());
        });
    }
    if calibration(session).is_some_and(|c| c.scale.withers_height_m.is_some()) {
        known(ui, session, page, Quantity::WithersHeight);
        if remove(ui, "the withers height", now == ScaleSource::WithersHeight) {
            change(session, page, "Remove the withers height", |c| c.scale.withers_height_m = None);
        }
    } else if ui.button("Add the withers height").clicked() {
        change(session, page, "Withers height", |c| {
            c.scale.withers_height_m = Some(defaults::known(Quantity::WithersHeight));
        });
    }
}

/// Where marks stand.
#[derive(Clone, Copy, PartialEq)]
enum Stand {
    Track,
    Distances,
    Ratio,
    Stance,
}

impl Stand {
    fn of(plane: &Plane) -> Self {
        match plane {
            Plane::Track => Self::Track,
            Plane::Wall(Parallax::Distances { .. }) => Self::Distances,
            Plane::Wall(Parallax::Ratio(_)) => Self::Ratio,
            Plane::Wall(Parallax::FromStance) => Self::Stance,
        }
    }

    fn plane(self) -> Plane {
        match self {
            Self::Track => Plane::Track,
            Self::Distances => Plane::Wall(defaults::distances()),
            Self::Ratio => Plane::Wall(Parallax::Ratio(defaults::known(Quantity::ScaleRatio))),
            Self::Stance => Plane::Wall(Parallax::FromStance),
        }
    }
}

fn plane(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    let Some(calibration) = calibration(session) else { return };
    let Some(now) = calibration.scale.known_length.as_ref().map(|length| Stand::of(&length.plane)) else {
        return;
    };
    let battery = matches!(calibration.position, Position::CameraSpacing { .. });
    let why_not = (!battery).then_some("Needs a row of cameras with a known spacing");
    let choices = [
        (Stand::Track, "on the animal's track", None),
        (Stand::Distances, "on a wall: distances", None),
        (Stand::Ratio, "on a wall: ratio", None),
        (Stand::Stance, "on a wall: from stance", why_not),
    ];
    let why = "A wall is farther away than the animal, which so appears larger (parallax)";
    let chosen = row(ui, "Marks stand", why, |ui| choose(ui, "Marks stand", now, &choices, LIST));
    if let Some(stand) = chosen {
        change(session, page, "Where the marks stand", |c| {
            if let Some(length) = &mut c.scale.known_length {
                length.plane = stand.plane();
            }
        });
    }
    match now {
        Stand::Track => {}
        Stand::Distances => {
            let both = [Number::CameraToTrack, Number::CameraToWall];
            for number in both {
                let name = if number == Number::CameraToTrack { "Lens to track" } else { "Lens to wall" };
                row(ui, name, "From the lens, straight across the track", |ui| {
                    entry::number(ui, session, number, FIELD);
                    unit(ui, session, number);
                });
            }
            entry::refused(ui, session, &both);
        }
        Stand::Ratio => known(ui, session, page, Quantity::ScaleRatio),
        Stand::Stance => remark(
            ui,
            "Measured on the plate: a hoof in stance stays where it is while the cameras change. Needs hooves \
             placed and labelled stance in neighbouring panels.",
        ),
    }
}

fn time(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    let Some(now) = calibration(session).map(|c| c.time.driven_by) else { return };
    let sources = [
        (TimeSource::Interval, "the interval", Quantity::Interval),
        (TimeSource::Speed, "the speed", Quantity::Speed),
        (TimeSource::StrideTime, "the stride time", Quantity::StrideTime),
    ];
    let similarity = (TimeSource::DynamicSimilarity, "dynamic similarity", None);
    let [a, b, c] = sources.map(|(source, title, _)| (source, title, None));
    let choices = [a, b, c, similarity];
    let why = "What the fit uses; the others are compared with it";
    let chosen = row(ui, "Driven by", why, |ui| choose(ui, "Time driven by", now, &choices, LIST));
    if let Some(source) = chosen {
        change(session, page, "Source of time", |c| defaults::give_time(c, source));
    }
    if now == TimeSource::DynamicSimilarity {
        remark(
            ui,
            "The speed at which horses have a stride of this length, by the published relation of Froude number and \
             relative stride length. Needs to know after how many panels the stride closes. All that rests on it is inferred.",
        );
    }
    for (source, title, quantity) in sources {
        if calibration(session).is_some_and(|c| quantity.of(c).is_some()) {
            known(ui, session, page, quantity);
            if now != source && remove(ui, title, false) {
                change(session, page, &format!("Remove {title}"), |c| match source {
                    TimeSource::Interval => c.time.interval_s = None,
                    TimeSource::Speed => c.time.speed_m_s = None,
                    TimeSource::StrideTime => c.time.stride_time_s = None,
                    TimeSource::DynamicSimilarity => {}
                });
            }
        } else if ui.button(format!("Add {title}")).clicked() {
            change(session, page, quantity.name(), |c| {
                let driven_by = c.time.driven_by;
                defaults::give_time(c, source);
                c.time.driven_by = driven_by;
            });
        }
    }
    uneven(ui, session, page);
}

/// Intervals that differ stand in the manifest; here they can only be given up.
fn uneven(ui: &mut Ui, session: &mut Session, page: &mut PageContext<'_>) {
    let Some(count) = calibration(session).and_then(|c| c.time.intervals_s.as_ref()).map(Vec::len) else {
        return;
    };
    remark(ui, format!("The manifest gives {count} intervals that differ; they replace the interval above."));
    if ui.button("Use the one interval instead").clicked() {
        change(session, page, "One interval", |c| c.time.intervals_s = None);
    }
}
