//! What the horse does, in words and numbers.

use egui::{Grid, ProgressBar, RichText, Ui, vec2};
use muybridge_core::{Gait, MPS_PER_MPH, Readout, Side};

use super::speed;
use crate::ride::build::hip_height_m;
use crate::ride::record::{RiderFrame, STEP_S};
use crate::ride::{RideSession, Which};

/// Acceleration of gravity, m/s², for the Froude number.
const GRAVITY_M_S2: f32 = 9.81;
/// Height of the bar of a change, points.
const BAR: f32 = 17.0;
/// What stands where a number is not known.
const UNKNOWN: &str = "–";

/// Gait and speed in large letters, and the change under way.
pub(super) fn headline(ui: &mut Ui, ride: &RideSession) {
    let Some(rider) = &ride.shown().riders[0] else { return };
    let readout = &rider.readout;
    let color = super::legible(ui, speed::color(readout.gait));
    ui.add_space(4.0);
    ui.horizontal(|ui| {
        ui.label(RichText::new(gait_in_words(readout)).size(22.0).strong().color(color));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let mph = f64::from(readout.speed_m_s) / MPS_PER_MPH;
            ui.label(RichText::new(format!("{mph:.1} mph")).size(22.0).strong());
        });
    });
    match readout.change {
        Some(change) => {
            let from =
                if change.from == readout.gait { String::new() } else { format!("from {}: ", change.from) };
            let text = format!("{from}{:.0} % of the change", 100.0 * change.share);
            let text = RichText::new(text).size(11.5).color(ui.visuals().strong_text_color());
            let fill = speed::color(readout.gait).gamma_multiply(0.5);
            let bar = ProgressBar::new(change.share).desired_height(BAR).corner_radius(3.0);
            ui.add(bar.fill(fill).text(text));
        }
        None => {
            let text = format!("{:.2} m/s, steady", readout.speed_m_s);
            ui.allocate_ui(vec2(ui.available_width(), BAR), |ui| ui.weak(text));
        }
    }
    ui.add_space(4.0);
}

/// `canter, left lead`.
fn gait_in_words(readout: &Readout) -> String {
    let mut words = if readout.is_standing { "stands".to_string() } else { readout.gait.to_string() };
    if let Some(lead) = readout.lead.filter(|_| matches!(readout.gait, Gait::Canter | Gait::Gallop)) {
        words += match lead {
            Side::Left => ", left lead",
            Side::Right => ", right lead",
        };
    }
    words
}

/// What a row says of a horse.
type Says = fn(&RiderFrame) -> String;

/// Names of the rows with what they say.
const ROWS: [(&str, Says); 12] = [
    ("Gait", |rider| gait_in_words(&rider.readout)),
    ("Speed", |rider| {
        let speed = f64::from(rider.readout.speed_m_s);
        format!("{speed:.2} m/s, {:.1} mph", speed / MPS_PER_MPH)
    }),
    ("Stride time", |rider| number(rider.readout.stride_time_s, 3, " s")),
    ("Stride length", |rider| number(rider.readout.stride_time_s * rider.readout.speed_m_s, 2, " m")),
    ("Strides per second", |rider| number(rider.readout.stride_time_s.recip(), 2, "")),
    ("Duty, fore and hind", |rider| {
        let duty = rider.readout.duty_factors;
        format!("{:.2}, {:.2}", (duty[0] + duty[1]) / 2.0, (duty[2] + duty[3]) / 2.0)
    }),
    ("Feet down", |rider| {
        let down = rider.readout.on_ground.iter().filter(|down| **down).count();
        down.to_string()
    }),
    ("Froude number", |rider| {
        let hip_m = hip_height_m(rider.repertoire.skeleton());
        number(rider.readout.speed_m_s.powi(2) / (GRAVITY_M_S2 * hip_m), 2, "")
    }),
    ("Heading", |rider| {
        // Half a turn either way, and no minus before a zero.
        let degrees = (rider.readout.heading_rad.to_degrees() + 180.0).rem_euclid(360.0) - 180.0;
        format!("{:.0}°", degrees + 0.0)
    }),
    ("Turn rate", |rider| number(rider.readout.turn_rate_rad_s.to_degrees(), 1, "°/s")),
    ("Height at withers", |rider| number(rider.repertoire.skeleton().withers_height_m, 2, " m")),
    ("Body let down by", |rider| number(100.0 * rider.readout.lowered_m, 1, " cm")),
];

/// A number with its unit; a dash for what is none.
fn number(value: f32, decimals: usize, unit: &str) -> String {
    // Adding zero takes the minus from a zero.
    let rounded = format!("{:.decimals$}", value + 0.0);
    let is_zero = rounded.trim_matches(['-', '0', '.']).is_empty();
    match (value.is_finite(), is_zero) {
        (false, _) => UNKNOWN.into(),
        (true, true) => format!("{}{unit}", rounded.trim_start_matches('-')),
        (true, false) => format!("{rounded}{unit}"),
    }
}

/// One column, or two beside each other.
pub(super) fn table(ui: &mut Ui, ride: &RideSession) {
    let frame = ride.shown();
    let riders: Vec<(Which, &RiderFrame)> = Which::ALL
        .into_iter()
        .filter_map(|which| Some((which, frame.riders[which.index()].as_ref()?)))
        .collect();
    Grid::new("ride numbers").num_columns(3).striped(true).spacing([10.0, 2.0]).show(ui, |ui| {
        if riders.len() > 1 {
            ui.label("");
            riders.iter().for_each(|(which, _)| {
                ui.label(RichText::new(which.name()).strong());
            });
            ui.end_row();
        }
        for (name, of) in ROWS {
            ui.label(name);
            for (_, rider) in &riders {
                // The width stays while numbers change.
                ui.label(RichText::new(of(rider)).monospace().size(12.0));
            }
            ui.end_row();
        }
    });
    ui.weak(format!("{:.2} s since it began", frame.step as f64 * STEP_S));
}
