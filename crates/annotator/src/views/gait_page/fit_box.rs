//! The fit: its state, why it cannot be made, how good it is.

use egui::{Grid, RichText, Ui};
use muybridge_capture::Document;
use muybridge_fitting::pipeline::PlateFit;
use muybridge_fitting::stride_fit::rms;

use super::plus_minus;
use crate::app::PageContext;
use crate::command::Command;
use crate::session::Session;

/// Faults shown at most; the rest are counted. Who repairs these sees the others next.
const MOST_FAULTS: usize = 8;

/// State, buttons, faults, quality.
pub(super) fn show(ui: &mut Ui, session: &Session, page: &mut PageContext<'_>) {
    if session.second_pass.is_some() {
        ui.label("Hidden during the blind second pass: who sees the fit does not place points blindly.");
        return;
    }
    ui.label(state_in_words(session));
    ui.horizontal(|ui| {
        let button = egui::Button::new("Fit the stride");
        let keys = page.settings.keys.shown(Command::FitNow);
        if ui.add_enabled(!session.fit.is_running(), button).on_hover_text(keys).clicked() {
            page.commands.push(Command::FitNow);
        }
        let mut always = page.settings.fit_always;
        if ui.checkbox(&mut always, "Fit while working").changed() {
            page.commands.push(Command::FitAlways);
        }
    });
    if let Some(fault) = session.fit.fault() {
        faults(ui, fault, &session.document);
    }
    if let Some(fitted) = session.fit.latest() {
        quality(ui, &fitted.plate);
    }
}

fn state_in_words(session: &Session) -> &'static str {
    let present = session.document.revision();
    let of_present = session.fit.latest().map(|fitted| fitted.revision == present && !session.is_dragging());
    match (session.fit.is_running(), session.fit.fault(), of_present) {
        (true, ..) => "Being fitted now; go on working.",
        (_, Some(_), None) => "Cannot be fitted yet.",
        (_, Some(_), Some(_)) => {
            "The points cannot be fitted as they are now; below is the fit of earlier points."
        }
        (_, None, Some(true)) => "Fit of the present points.",
        (_, None, Some(false)) => "Fit of earlier points: something was changed since.",
        (_, None, None) => "Not fitted yet.",
    }
}

/// One line each, without the names of the files that are open anyway.
fn faults(ui: &mut Ui, fault: &str, document: &Document) {
    let paths = [document.annotation_path(), document.manifest_path()];
    let prefixes = paths.map(|path| format!("{}: ", path.display()));
    let lines: Vec<&str> = fault.lines().filter(|line| !line.trim().is_empty()).collect();
    for line in lines.iter().take(MOST_FAULTS) {
        let line =
            prefixes.iter().fold(*line, |line, prefix| line.strip_prefix(prefix.as_str()).unwrap_or(line));
        ui.label(RichText::new(line).color(ui.visuals().warn_fg_color));
    }
    if lines.len() > MOST_FAULTS {
        ui.weak(format!("and {} more", lines.len() - MOST_FAULTS));
    }
}

fn quality(ui: &mut Ui, plate: &PlateFit) {
    let px = rms(plate.residuals.iter().map(muybridge_fitting::stride_fit::PointResidual::px));
    let metres = rms(plate.residuals.iter().map(muybridge_fitting::stride_fit::PointResidual::metres));
    let share = 100.0 * metres / plate.withers_height_m;
    let converged = if plate.fit.optimum.converged { "yes" } else { "no, it stopped before" };
    let rows = [
        ("RMS distance", format!("{px:.2} px, {:.2} cm", 100.0 * metres)),
        ("", format!("{share:.2} % of withers height")),
        ("Points", format!("{} in {} panels", plate.residuals.len(), plate.fit.problem.layout.panels)),
        ("Stride time", format!("{} s", plus_minus(plate.analysis.stride_time_s, 3))),
        ("Stride length", format!("{} m", plus_minus(plate.stride_length_m(), 2))),
        ("Withers height", format!("{:.2} m", plate.withers_height_m)),
        ("Converged", converged.to_string()),
    ];
    Grid::new("quality of the fit").num_columns(2).spacing([12.0, 2.0]).show(ui, |ui| {
        for (name, value) in rows {
            ui.weak(name);
            ui.label(value);
            ui.end_row();
        }
    });
}
