//! The gait in numbers: from the footfall bar as it is now, and from the fit.

use egui::{Grid, RichText, Ui};
use muybridge_capture::Facing;
use muybridge_core::{Gait, MPS_PER_MPH, Pair, Side};
use muybridge_fitting::contacts::LegContact;
use muybridge_fitting::footfalls::{LANES, LiveGait, Missing};
use muybridge_fitting::gait_analysis::GaitAnalysis;
use muybridge_fitting::pipeline::PlateFit;

use super::plus_minus;
use crate::session::Session;

/// km/h in one m/s.
const KMH_PER_M_S: f64 = 3.6;
/// What stands where a number is not known.
const UNKNOWN: &str = "–";

/// What one source says, in the order of [`NAMES`] and then of the lanes.
struct Column {
    values: [Option<String>; NAMES.len()],
    duty: [Option<String>; 4],
}

/// Names of the rows before the duty factors.
const NAMES: [&str; 10] = [
    "Contact, fore (s)",
    "Contact, hind (s)",
    "Support (s)",
    "Stride time (s)",
    "Stride length (m)",
    "Closes after panels",
    "Speed (m/s)",
    "Speed (km/h)",
    "Speed (mph)",
    "Froude number",
];
/// Names of the duty factors, in the order of the lanes.
const DUTY: [&str; 4] = ["Duty, near fore", "Duty, off fore", "Duty, near hind", "Duty, off hind"];

/// The table, and what is missing for it.
pub(super) fn show(ui: &mut Ui, session: &Session, fit: Option<&PlateFit>) {
    let facing = session.facing();
    let manifest = &session.draft().manifest;
    let live = session.derived.gait.as_ref();
    let now = live.ok().map(|live| of_footfalls(live, facing));
    let fitted = fit.map(of_fit);
    if now.is_some() || fitted.is_some() {
        table(ui, now.as_ref(), fitted.as_ref());
        let analyses = [live.ok().map(|live| &live.analysis), fit.map(|fit| &fit.analysis)];
        against_title(ui, analyses, manifest.gait);
    }
    let missing: &[Missing] = live.map_or_else(|missing| missing, |live| &live.missing);
    for missing in missing {
        ui.weak(capitalized(&missing.to_string()));
    }
}

fn table(ui: &mut Ui, now: Option<&Column>, fitted: Option<&Column>) {
    Grid::new("gait in numbers").num_columns(3).striped(true).spacing([8.0, 2.0]).show(ui, |ui| {
        ui.weak("");
        ui.weak("Footfall bar").on_hover_text("From labels and edges of the footfall bar as it is now");
        ui.weak(if fitted.is_some() { "Fit" } else { "" })
            .on_hover_text("From the toe paths of the fitted skeleton");
        ui.end_row();
        let mut row = |name: &str, pick: &dyn Fn(&Column) -> Option<String>| {
            let text = |column: Option<&Column>, none: &str| column.and_then(pick).unwrap_or(none.into());
            ui.label(RichText::new(name).weak());
            ui.label(text(now, UNKNOWN));
            ui.label(text(fitted, if fitted.is_some() { UNKNOWN } else { "" }));
            ui.end_row();
        };
        for (at, name) in NAMES.iter().enumerate() {
            row(name, &|column| column.values[at].clone());
            // Duty factors stand with the contact times.
            if at == 2 {
                for (lane, name) in DUTY.iter().enumerate() {
                    row(name, &|column| column.duty[lane].clone());
                }
            }
        }
    });
}

fn of_footfalls(live: &LiveGait, facing: Facing) -> Column {
    let seconds = |value: Option<[f64; 2]>| value.map(|value| plus_minus(value, 3));
    let speed = live.speed_m_s.map(|speed| [speed.value, speed.sd]);
    let [m_s, km_h, mph] = speeds(speed);
    let values = [
        seconds(live.fore_contact_s),
        seconds(live.hind_contact_s),
        seconds(live.support_s),
        seconds(live.stride_time_s),
        live.stride_length_m.map(|length| plus_minus(length, 2)),
        Some(format!("{:.2}", live.stride_panels)),
        m_s,
        km_h,
        mph,
        live.froude.map(|froude| format!("{froude:.2}")),
    ];
    Column { values, duty: duty(&live.analysis, facing) }
}

fn of_fit(fit: &PlateFit) -> Column {
    let analysis = &fit.analysis;
    let seconds = |value: [f64; 2]| Some(plus_minus(value, 3));
    let speed = fit.calibration.speed_m_s;
    let [m_s, km_h, mph] = speeds(Some([speed.value, speed.sd]));
    let closes_after = fit.fit.stride_time.seconds / fit.calibration.interval_s.value;
    let values = [
        seconds(analysis.stance_s(Pair::Fore)),
        seconds(analysis.stance_s(Pair::Hind)),
        seconds(analysis.support_s()),
        seconds(analysis.stride_time_s),
        Some(plus_minus(fit.stride_length_m(), 2)),
        Some(format!("{closes_after:.2}")),
        m_s,
        km_h,
        mph,
        Some(format!("{:.2}", fit.froude())),
    ];
    Column { values, duty: duty(analysis, fit.plate.facing) }
}

fn speeds(m_s: Option<[f64; 2]>) -> [Option<String>; 3] {
    let units = [(1.0, 2), (KMH_PER_M_S, 1), (1.0 / MPS_PER_MPH, 1)];
    units.map(|(per_m_s, decimals)| m_s.map(|speed| plus_minus(speed.map(|v| v * per_m_s), decimals)))
}

fn duty(analysis: &GaitAnalysis, facing: Facing) -> [Option<String>; 4] {
    LANES.map(|(side, pair)| {
        let contact: &LegContact = &analysis.contacts[facing.limb(side, pair).index()];
        Some(plus_minus([contact.duty_factor(), contact.duty_factor_sd()], 3))
    })
}

/// `transverse gallop, lead right`.
fn in_words(analysis: &GaitAnalysis) -> String {
    let name = |side: Side| if side == Side::Left { "left" } else { "right" };
    let implied = analysis.implied.name();
    match analysis.lead {
        None => implied.into(),
        Some(lead) if lead.is_transverse() => format!("{implied}, lead {}", name(lead.fore)),
        Some(lead) => format!("{implied}, lead {} fore, {} hind", name(lead.fore), name(lead.hind)),
    }
}

/// What gait the footfalls of the bar and of the fit imply, and whether that is the title's.
fn against_title(ui: &mut Ui, [now, fitted]: [Option<&GaitAnalysis>; 2], title: Gait) {
    let Some(analysis) = now.or(fitted) else { return };
    ui.label(format!("The footfalls imply: {}.", in_words(analysis)));
    if let Some(fitted) = fitted.filter(|fitted| in_words(fitted) != in_words(analysis)) {
        ui.label(format!("Those of the fit imply: {}.", in_words(fitted)));
    }
    if analysis.implied.agrees_with(title) {
        ui.weak(format!("The title says {title}: they agree."));
    } else {
        let text = format!("The title says {title}: they do not agree.");
        ui.label(RichText::new(text).color(ui.visuals().warn_fg_color));
    }
}

fn capitalized(text: &str) -> String {
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().chain(letters).collect())
}
