//! What follows from the calibration, and where its sources disagree.

use egui::{Grid, Label, RichText, ScrollArea, Ui, vec2};
use muybridge_capture::{BodyPoint, Disagreement, Estimate, Keypoint, PlateCalibration};

use super::layout::remark;
use super::marks::MarkRow;
use super::numbers::{Number, Quantity};
use super::trouble;
use super::units::number;
use crate::session::Session;

/// Standard deviations beyond which two sources are not both right.
const SUSPECT_SIGMAS: f64 = 2.0;
/// Longest name of a source that is shown whole, characters.
const SOURCE_CHARS: usize = 25;
/// Columns of the scales by panel.
const SCALE_COLUMNS: usize = 2;
/// Height of a row of numbers, screen points.
const ROW: f32 = 15.0;
/// A panel whose scale differs by more from the middle one has a wrong mark: panels of one plate are printed alike.
const ODD_SCALE: f64 = 0.06;

/// Numbers, disagreements, scales of the panels: side by side.
pub(super) fn show(ui: &mut Ui, session: &Session) {
    ScrollArea::both().auto_shrink(false).show(ui, |ui| {
        ui.add_space(4.0);
        ui.horizontal_top(|ui| {
            ui.spacing_mut().item_spacing.x = 12.0;
            ui.spacing_mut().interact_size.y = ROW;
            ui.vertical(|ui| match &session.derived.calibration {
                Ok(plate) => results(ui, session, plate),
                Err(error) => not_yet(ui, session, error),
            });
            if let Ok(plate) = &session.derived.calibration {
                ui.separator();
                ui.vertical(|ui| disagreements(ui, &plate.disagreements));
            }
            ui.separator();
            ui.vertical(|ui| scales(ui, session));
        });
    });
}

fn heading(ui: &mut Ui, title: &str) {
    ui.label(RichText::new(title).strong());
}

fn not_yet(ui: &mut Ui, session: &Session, error: &str) {
    ui.set_width(380.0);
    heading(ui, "Not calibrated yet");
    let [what, next] = trouble::words(session.draft()).unwrap_or([error.into(), String::new()]);
    ui.label(RichText::new(what).color(ui.visuals().warn_fg_color));
    ui.label(next);
}

/// A value and its standard deviation, to two digits of the latter.
fn with_sd(Estimate { value, sd }: Estimate) -> String {
    if !(sd.is_finite() && sd > 0.0) {
        return number(value);
    }
    let digits = (1.0 - sd.log10().floor()).clamp(0.0, 6.0) as usize;
    format!("{value:.digits$} ± {sd:.digits$}")
}

fn results(ui: &mut Ui, session: &Session, plate: &PlateCalibration) {
    heading(ui, "What follows");
    let line = |ui: &mut Ui, name: &str, value: String| {
        ui.label(name);
        ui.add(Label::new(value).extend());
        ui.end_row();
    };
    Grid::new("results").num_columns(2).spacing([12.0, 2.0]).show(ui, |ui| {
        let count = plate.stride.len() as f64;
        let mean = plate.stride.iter().map(|camera| camera.px_per_m).sum::<f64>() / count;
        let scale = Estimate { value: mean, sd: mean * plate.scale_relative_sd };
        line(ui, "Scale on the track", format!("{} px/m", with_sd(scale)));
        if let Some(parallax) = plate.parallax {
            line(ui, "Track larger than wall", format!("{} times", with_sd(parallax)));
        }
        if let Some((name, height)) = withers(session, plate) {
            line(ui, name, format!("{} m", with_sd(height)));
        }
        line(ui, "Speed", format!("{} m/s", with_sd(plate.speed_m_s)));
        line(ui, "Interval", format!("{} s", with_sd(plate.interval_s)));
        let relative = |estimate: Estimate| estimate.sd / estimate.value;
        let times = |value: f64, relative: f64| with_sd(Estimate { value, sd: value * relative });
        if let Some(last) = plate.stride.last() {
            let total = times(last.time_s, relative(plate.interval_s));
            line(ui, "First to last panel", format!("{total} s"));
        }
        if let Some(fitted) = session.fit.latest() {
            let fit = fitted.plate.fit.stride_time;
            let stride_time = Estimate { value: fit.seconds, sd: fit.sd_s };
            line(ui, "Stride time, fitted", format!("{} s", with_sd(stride_time)));
            let length_m = stride_time.value * plate.speed_m_s.value;
            let length = times(length_m, relative(stride_time).hypot(relative(plate.speed_m_s)));
            line(ui, "Stride length", format!("{length} m"));
        }
    });
}

/// Withers height of the standing panels; else over the stride, where they rise and fall.
fn withers(session: &Session, plate: &PlateCalibration) -> Option<(&'static str, Estimate)> {
    if let Some(standing) = plate.withers_height_m {
        return Some(("Withers, standing", standing));
    }
    let withers = Keypoint::Body(BodyPoint::Withers);
    let height = |camera: &muybridge_capture::PanelCamera| {
        let place = session.draft().panel(camera.panel)?.keypoints.place(withers)?;
        Some(camera.world_from_plate(place, 0.0)[1])
    };
    let heights: Vec<f64> = plate.stride.iter().filter_map(height).collect();
    let value = heights.iter().sum::<f64>() / heights.len() as f64;
    (!heights.is_empty())
        .then_some(("Withers, over the stride", Estimate { value, sd: value * plate.scale_relative_sd }))
}

fn disagreements(ui: &mut Ui, found: &[Disagreement]) {
    heading(ui, "Where sources can be compared");
    if found.is_empty() {
        remark(ui, "Each quantity has one source only.");
        return;
    }
    Grid::new("disagreements").num_columns(4).striped(true).spacing([12.0, 3.0]).show(ui, |ui| {
        for title in ["Quantity", "Used", "Other source", "Differs by"] {
            remark(ui, title);
        }
        ui.end_row();
        for disagreement in found {
            ui.label(disagreement.quantity);
            source(ui, &disagreement.used);
            source(ui, &disagreement.other);
            differs(ui, disagreement);
            ui.end_row();
        }
    });
}

/// A source's value, and under it its name.
fn source(ui: &mut Ui, (name, estimate): &(String, Estimate)) {
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing = vec2(4.0, 0.0);
        ui.add(Label::new(with_sd(*estimate)).extend());
        let short: String = name.chars().take(SOURCE_CHARS).collect();
        let dots = if short.len() < name.len() { "..." } else { "" };
        let small = RichText::new(format!("{short}{dots}")).weak().size(12.0);
        ui.add(Label::new(small).extend()).on_hover_text(name);
    });
}

fn differs(ui: &mut Ui, disagreement: &Disagreement) {
    let sigmas = disagreement.sigmas();
    let suspect = sigmas > SUSPECT_SIGMAS;
    let color = if suspect { ui.visuals().warn_fg_color } else { ui.visuals().text_color() };
    ui.vertical(|ui| {
        ui.spacing_mut().item_spacing = vec2(4.0, 0.0);
        let percent = RichText::new(format!("{:+.1} %", disagreement.percent())).color(color);
        ui.add(Label::new(percent).extend());
        let words = match (sigmas.is_finite(), suspect) {
            (false, _) => "both said to be exact".to_string(),
            (true, false) => format!("{sigmas:.1} sigma"),
            (true, true) => format!("{sigmas:.1} sigma: look again"),
        };
        let hover = "Difference over its standard deviation; more than 2 is hardly chance";
        ui.add(Label::new(RichText::new(words).color(color).size(12.0)).extend()).on_hover_text(hover);
    });
}

/// Scale of each panel: on the track where it is calibrated, else what its marks say by themselves.
fn scales(ui: &mut Ui, session: &Session) {
    let calibrated = session.derived.calibration.as_ref().ok();
    heading(ui, if calibrated.is_some() { "Scale by panel, px/m" } else { "Scale on the marks, px/m" });
    let spacing_m = Number::Value(Quantity::MarkSpacing).get(session.draft());
    let scale = |panel: u32| match calibrated {
        Some(plate) => {
            let cameras = plate.stride.iter().chain(&plate.standing);
            cameras.into_iter().find(|camera| camera.panel == panel).map(|camera| camera.px_per_m)
        }
        None => {
            let row = MarkRow::through(session.draft().panel(panel)?)?;
            spacing_m.map(|spacing_m| row.px_per_mark.abs() / spacing_m)
        }
    };
    let scales: Vec<(u32, Option<f64>)> =
        session.panel_numbers().into_iter().map(|panel| (panel, scale(panel))).collect();
    let mut sorted: Vec<f64> = scales.iter().filter_map(|(_, scale)| *scale).collect();
    sorted.sort_by(f64::total_cmp);
    let middle = sorted.get(sorted.len() / 2).copied().unwrap_or(f64::NAN);
    let grid = Grid::new("scales").num_columns(2 * SCALE_COLUMNS).min_col_width(14.0).spacing([10.0, 2.0]);
    grid.show(ui, |ui| {
        for (at, (panel, scale)) in scales.into_iter().enumerate() {
            ui.label(RichText::new(panel.to_string()).weak());
            match scale {
                Some(px) if (px / middle - 1.0).abs() > ODD_SCALE => {
                    let text = RichText::new(format!("{px:.1}")).color(ui.visuals().warn_fg_color);
                    ui.label(text).on_hover_text("Unlike the other panels: look at its marks");
                }
                Some(px) => drop(ui.label(format!("{px:.1}"))),
                None => drop(ui.label(RichText::new("none").weak())),
            }
            if (at + 1) % SCALE_COLUMNS == 0 {
                ui.end_row();
            }
        }
    });
}
