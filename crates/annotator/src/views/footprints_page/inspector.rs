//! The right side of the page: file, model, what is selected, ground, path, energy.

use egui::{Grid, RichText, Ui};
use muybridge_core::Gait;
use muybridge_footprints::{Character, Energy, Laying, MODEL_NAMES, Motion, Track, TrackGait};

use super::command_button;
use super::curve::Curve;
use super::fields::{Number, slider};
use crate::app::PageContext;
use crate::command::Command;
use crate::footprints::Editor;
use crate::footprints::edits::path_of_prints;
use crate::toast::trouble_color;

/// Width of a slider's rail, points.
const SLIDER: f32 = 120.0;
/// Speed of a horse that nobody has said, m/s: a trot.
const SPEED_M_S: f64 = 4.6;
/// Speeds while the horse is not ready to tell its own, m/s.
const SPEEDS_M_S: [f64; 2] = [0.5, 15.0];
/// Faults and remarks that are listed.
const MOST_LISTED: usize = 8;
/// Gaits that can be laid along a path.
const GAITS: [Gait; 6] = [Gait::Walk, Gait::Amble, Gait::Trot, Gait::Rack, Gait::Canter, Gait::Gallop];

/// What cannot be walked, and what the prints ask too much of.
pub(super) fn concerns(ui: &mut Ui, editor: &mut Editor, curve: &Curve) {
    let color = trouble_color(ui.visuals().dark_mode);
    let faults = editor.solving.faults().to_vec();
    if !faults.is_empty() {
        ui.label(RichText::new("This cannot be walked yet; the last motion that could stays:").strong());
        for fault in faults.iter().take(MOST_LISTED) {
            ui.label(RichText::new(fault).color(color));
        }
    }
    let mut chosen = None;
    for remark in curve.remarks.iter().take(MOST_LISTED) {
        let text = RichText::new(&remark.text).color(color);
        if ui.link(text).on_hover_text("Select the print").clicked() {
            chosen = Some(remark.print);
        }
    }
    let more = (faults.len().max(MOST_LISTED) + curve.remarks.len().max(MOST_LISTED)) - 2 * MOST_LISTED;
    if more > 0 {
        ui.weak(format!("and {more} more"));
    }
    if let Some(print) = chosen {
        editor.select(print, false);
    }
    if faults.is_empty() && curve.remarks.is_empty() && editor.motion().is_some() {
        ui.weak("Every print is within reach");
    }
}

/// Who walks.
pub(super) fn model(ui: &mut Ui, editor: &mut Editor) {
    let now = editor.track().model.clone();
    ui.horizontal_wrapped(|ui| {
        for name in MODEL_NAMES {
            let button = egui::Button::selectable(now == name, name).frame_when_inactive(true);
            if ui.add(button).clicked() && now != name {
                let laid = editor.are_laid();
                editor.document.edit("Model", |track| change_model(track, name, laid));
                editor.deselect();
            }
        }
    });
    if now == "horse" {
        gait(ui, editor);
    }
}

/// Between two legs and four, prints cannot stay: they are laid anew along the path, or along the way they went.
fn change_model(track: &mut Track, name: &str, are_laid: bool) {
    let changes_legs = (track.model == "horse") != (name == "horse");
    track.model = name.into();
    track.gait =
        (name == "horse").then_some(TrackGait { gait: Gait::Trot, speed_m_s: SPEED_M_S, lead: None });
    if changes_legs && !are_laid {
        let points = path_of_prints(track);
        let none = || Laying { points, step_length_m: None, step_width_m: None, timing: None };
        track.path.get_or_insert_with(none);
        track.prints.clear();
    }
    if let (true, Some(path)) = (changes_legs, &mut track.path) {
        (path.step_length_m, path.step_width_m, path.timing) = (None, None, None);
    }
}

/// Gait and speed of a horse: its prints are laid anew.
fn gait(ui: &mut Ui, editor: &mut Editor) {
    let Some(now) = editor.track().gait else { return };
    let horse = match editor.motion().map(Motion::character) {
        Some(Character::Horse(horse)) => Some(horse),
        _ => None,
    };
    let range_m_s =
        |gait: Gait| horse.as_ref().map_or(SPEEDS_M_S, |h| h.speed_range_m_s(gait).map(f64::from));
    ui.horizontal_wrapped(|ui| {
        for gait in GAITS {
            let button = egui::Button::selectable(now.gait == gait, gait.name()).frame_when_inactive(true);
            if ui.add(button).clicked() && now.gait != gait {
                let [least, most] = range_m_s(gait);
                let speed_m_s = now.speed_m_s.max(least).min(most);
                let lead = now.lead.filter(|_| matches!(gait, Gait::Canter | Gait::Gallop));
                let gait = TrackGait { gait, speed_m_s, lead };
                editor.document.edit("Gait", |track| set_gait(track, gait));
            }
        }
    });
    ui.spacing_mut().slider_width = SLIDER;
    let [least, most] = range_m_s(now.gait);
    let number = Number { name: "Speed", suffix: " m/s", range: least..=most, speed: 0.05, decimals: 2 };
    slider(ui, editor, now.speed_m_s, &number, |track, speed_m_s| {
        set_gait(track, TrackGait { speed_m_s, ..now });
    });
}

/// Prints of another gait are laid elsewhere: where there is a path, along it.
fn set_gait(track: &mut Track, gait: TrackGait) {
    track.gait = Some(gait);
    if track.path.is_some() {
        track.prints.clear();
    }
}

/// The path and how prints are laid along it.
pub(super) fn path(ui: &mut Ui, editor: &mut Editor, draws: bool, page: &mut PageContext<'_>) {
    ui.horizontal(|ui| {
        command_button(ui, page, Command::FootprintsPath, "Draw a path", draws);
        let title = if editor.are_laid() { "Keep the prints as they lie" } else { "Lay prints along it" };
        ui.add_enabled_ui(editor.track().path.is_some(), |ui| {
            command_button(ui, page, Command::FootprintsLay, title, false);
        });
    });
    if draws {
        ui.weak("Click the ground: each click is a point of the path. Esc ends it.");
    }
    let Some(laying) = editor.track().path.clone() else { return };
    let points = laying.points.len();
    ui.horizontal(|ui| {
        ui.weak(format!("{points} points, {} prints", editor.prints().len()));
        if ui.button("Forget the path").on_hover_text("The prints stay").clicked() {
            editor.edit("Forget the path", |track| track.path = None);
            editor.path_point = None;
        }
    });
    if editor.track().model == "horse" || !editor.are_laid() {
        return;
    }
    let automatic =
        muybridge_footprints::Model::named(&editor.track().model).map_or([0.4, 0.2], |m| m.step_m);
    ui.spacing_mut().slider_width = SLIDER;
    let metres = |name, range| Number { name, suffix: " m", range, speed: 0.01, decimals: 3 };
    let [step_m, width_m] = automatic;
    let number = metres("Step length", 0.2 * step_m..=4.0 * step_m);
    lay_number(ui, editor, laying.step_length_m.unwrap_or(step_m), &number, |laying, value| {
        laying.step_length_m = Some(value);
    });
    let number = metres("Step width", 0.01..=3.0 * width_m);
    lay_number(ui, editor, laying.step_width_m.unwrap_or(width_m), &number, |laying, value| {
        laying.step_width_m = Some(value);
    });
}

fn lay_number(
    ui: &mut Ui,
    editor: &mut Editor,
    value: f64,
    number: &Number<'_>,
    set: impl FnOnce(&mut Laying, f64),
) {
    slider(ui, editor, value, number, |track, value| {
        if let Some(path) = &mut track.path {
            set(path, value);
        }
    });
}

/// What the motion asks of forces that nobody exerts and of uncomfortable legs.
pub(super) fn energy(ui: &mut Ui, editor: &mut Editor) {
    if let Some((now, before)) = editor.energies() {
        Grid::new("energy").num_columns(3).striped(true).show(ui, |ui| {
            for title in ["Energy, m/s", "now", "before"] {
                ui.label(RichText::new(title).strong());
            }
            ui.end_row();
            row(ui, "physics", [Some(now.physics), before.map(|energy| energy.physics)]);
            row(ui, "comfort", [Some(now.comfort), before.map(|energy| energy.comfort)]);
            row(ui, "both", [Some(now.total()), before.map(Energy::total)]);
        });
        let solved = editor.motion().map(|motion| (motion.solved.steps, motion.solved.converged));
        if let Some((steps, converged)) = solved {
            let end = if converged { "" } else { ", stopped before its end" };
            ui.weak(format!("{steps} steps in {:.2} ms{end}", editor.solving.took_s() * 1e3));
        }
    }
    weights(ui, editor);
}

fn row(ui: &mut Ui, title: &str, energies: [Option<f64>; 2]) {
    ui.label(title);
    for energy in energies {
        ui.label(energy.map_or("–".into(), |energy| format!("{energy:.3}")));
    }
    ui.end_row();
}

fn weights(ui: &mut Ui, editor: &mut Editor) {
    ui.spacing_mut().slider_width = SLIDER;
    let now = editor.track().weights;
    let number =
        Number { name: "Weight of physics", suffix: "", range: 0.0..=100.0, speed: 0.01, decimals: 3 };
    weight(ui, editor, now.physics, &number, "Of forces that nobody exerts", |weights, value| {
        weights.physics = value;
    });
    let number =
        Number { name: "k of comfort", suffix: "/s²", range: 0.0..=5000.0, speed: 1.0, decimals: 1 };
    let hover = "The paper's k: of the squared difference of a leg from its comfortable length";
    weight(ui, editor, now.comfort_per_s2, &number, hover, |weights, value| weights.comfort_per_s2 = value);
    let number = Number { name: "Toe band", suffix: " m", range: 0.0..=0.2, speed: 0.001, decimals: 3 };
    let hover = "Way of the leg's length over which the support goes to the toe; 0 as in the paper";
    weight(ui, editor, now.toe_band_m, &number, hover, |weights, value| weights.toe_band_m = value);
}

fn weight(
    ui: &mut Ui,
    editor: &mut Editor,
    value: f64,
    number: &Number<'_>,
    hover: &str,
    set: impl FnOnce(&mut muybridge_footprints::Weights, f64),
) {
    slider(ui, editor, value, number, |track, value| set(&mut track.weights, value)).on_hover_text(hover);
}
