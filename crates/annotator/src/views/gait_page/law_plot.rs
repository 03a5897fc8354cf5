//! The point on the curve `T_c = a v^b`: contact times against speed, with the laws of the titled gait.

use egui::{Color32, Grid, RichText, Stroke, Ui};
use muybridge_core::{ContactLaw, Gait, LawKind, MPS_PER_MPH, Pair, Provenance};
use muybridge_fitting::footfalls::LiveGait;
use muybridge_fitting::pipeline::PlateFit;

use super::plot::{Axis, Plot, round_step};
use crate::session::Session;

/// Height, screen points.
const HEIGHT: f32 = 210.0;
/// Samples of a curve.
const SAMPLES: usize = 48;
/// Speeds shown beyond the gait's usual ones and the plate's, as shares of the lowest and highest.
const BEYOND: [f64; 2] = [0.9, 1.06];
/// Speeds shown where nothing is known of a gait's usual ones, m/s: slow walk to racing gallop.
const ANY_SPEED_M_S: [f64; 2] = [0.5, 18.0];

/// A contact time with its standard deviations: speed, m/s, and time, s.
#[derive(Clone, Copy)]
struct Measured {
    kind: LawKind,
    at: [f64; 2],
    sd: [f64; 2],
}

/// Curves, points, and how far apart they are.
pub(super) fn show(ui: &mut Ui, session: &Session, fit: Option<&PlateFit>) {
    let gait = session.draft().annotation.gait(&session.draft().manifest);
    let laws: Vec<&ContactLaw> = session.derived.laws().iter().filter(|law| law.gait == gait).collect();
    let now = session.derived.gait.as_ref().map(of_footfalls).unwrap_or_default();
    let fitted = fit.map(of_fit).unwrap_or_default();
    if laws.is_empty() && now.is_empty() && fitted.is_empty() {
        ui.weak(format!("There is no contact-time law of the {gait} yet."));
        return;
    }
    let usual = gait.speed_range_mph().map(|range| range.map(|mph| mph * MPS_PER_MPH));
    let x = Axis { name: "speed, m/s", range: speeds(usual, now.iter().chain(&fitted)) };
    let y =
        Axis { name: "contact time, s", range: [0.0, highest(&laws, x.range, now.iter().chain(&fitted))] };
    let (plot, response) = Plot::new(ui, HEIGHT, "Contact time against speed", x, y);
    if ui.is_rect_visible(response.rect) {
        laws.iter().for_each(|law| draw_curve(ui, &plot, law, x.range, usual));
        for (points, is_fit) in [(&fitted, true), (&now, false)] {
            points.iter().for_each(|p| plot.point(p.at, p.sd, color(ui, p.kind), is_fit));
        }
    }
    distances(ui, &laws, [&now, &fitted]);
    parameters(ui, &laws, gait, usual);
}

fn of_footfalls(live: &LiveGait) -> Vec<Measured> {
    let Some(speed) = live.speed_m_s else { return Vec::new() };
    let times = [
        (LawKind::Support, live.support_s),
        (LawKind::LimbFore, live.fore_contact_s),
        (LawKind::LimbHind, live.hind_contact_s),
    ];
    let measured = times.into_iter().filter_map(|(kind, time)| {
        let [seconds, sd_s] = time?;
        Some(Measured { kind, at: [speed.value, seconds], sd: [speed.sd, sd_s] })
    });
    measured.collect()
}

fn of_fit(fit: &PlateFit) -> Vec<Measured> {
    let (speed, analysis) = (fit.calibration.speed_m_s, &fit.analysis);
    let times = [
        (LawKind::Support, analysis.support_s()),
        (LawKind::LimbFore, analysis.stance_s(Pair::Fore)),
        (LawKind::LimbHind, analysis.stance_s(Pair::Hind)),
    ];
    times
        .map(|(kind, [seconds, sd_s])| Measured { kind, at: [speed.value, seconds], sd: [speed.sd, sd_s] })
        .into()
}

fn speeds<'a>(usual: Option<[f64; 2]>, points: impl Iterator<Item = &'a Measured>) -> [f64; 2] {
    let all = usual.into_iter().flatten().chain(points.map(|point| point.at[0]));
    let all: Vec<f64> = all.filter(|speed| speed.is_finite() && *speed > 0.0).collect();
    let low = all.iter().copied().fold(f64::INFINITY, f64::min);
    let high = all.iter().copied().fold(0.0, f64::max);
    if low < high { [BEYOND[0] * low, BEYOND[1] * high] } else { ANY_SPEED_M_S }
}

/// Upper end of the times, rounded up, so that it stays where it is while a point is dragged.
fn highest<'a>(laws: &[&ContactLaw], range: [f64; 2], points: impl Iterator<Item = &'a Measured>) -> f64 {
    let curves = laws.iter().map(|law| law.curve.contact_time_s(range[0]));
    let highest = curves.chain(points.map(|point| point.at[1] + point.sd[1])).filter(|t| t.is_finite());
    let highest = highest.fold(0.02, f64::max);
    let step = round_step(0.1 * highest);
    (1.05 * highest / step).ceil() * step
}

/// Bold where horses usually go at this gait, faint beyond.
fn draw_curve(ui: &Ui, plot: &Plot, law: &ContactLaw, [low, high]: [f64; 2], usual: Option<[f64; 2]>) {
    let color = color(ui, law.law);
    let line = |from: f64, to: f64, stroke: Stroke| {
        let speed = |i: usize| from + (to - from) * i as f64 / SAMPLES as f64;
        let points = (0..=SAMPLES).map(|i| plot.at([speed(i), law.curve.contact_time_s(speed(i))]));
        plot.painter.line(points.collect(), stroke);
    };
    line(low, high, Stroke::new(1.0, color.gamma_multiply(0.6)));
    if let Some([from, to]) = usual {
        line(from.max(low), to.min(high), Stroke::new(2.0, color));
    }
}

/// Measured, the law's, and the distance in percent.
fn distances(ui: &mut Ui, laws: &[&ContactLaw], [now, fitted]: [&[Measured]; 2]) {
    let Some(speed_m_s) = now.iter().chain(fitted).map(|point| point.at[0]).next() else {
        ui.weak("The points are shown when contacts and speed are known.");
        return;
    };
    Grid::new("distances from laws").num_columns(4).striped(true).spacing([8.0, 2.0]).show(ui, |ui| {
        ["", "law (s)", "bar (s)", "fit (s)"].into_iter().for_each(|title| drop(ui.weak(title)));
        ui.end_row();
        for kind in LawKind::ALL {
            let law = laws.iter().find(|law| law.law == kind);
            let law_s = law.map(|law| law.curve.contact_time_s(speed_m_s));
            ui.label(RichText::new(name(kind)).color(color(ui, kind)));
            ui.label(law_s.map_or("no law".into(), |seconds| format!("{seconds:.3}")));
            for points in [now, fitted] {
                let measured = points.iter().find(|point| point.kind == kind).map(|point| point.at[1]);
                ui.label(measured.map_or(String::new(), |measured| with_percent(measured, law_s)));
            }
            ui.end_row();
        }
    });
}

fn with_percent(measured_s: f64, law_s: Option<f64>) -> String {
    match law_s {
        Some(law_s) => format!("{measured_s:.3} ({:+.1} %)", 100.0 * (measured_s / law_s - 1.0)),
        None => format!("{measured_s:.3}"),
    }
}

/// What each curve is and rests on.
fn parameters(ui: &mut Ui, laws: &[&ContactLaw], gait: Gait, usual: Option<[f64; 2]>) {
    for law in laws {
        let interval = match law.interval {
            Some(i) => format!("95 %: a {:.2} to {:.2}, b {:.2} to {:.2}", i.a[0], i.a[1], i.b[0], i.b[1]),
            None => "too few for an interval".into(),
        };
        let data = if law.n == 1 { "1 plate or clip".into() } else { format!("{} plates or clips", law.n) };
        let (a, b) = (law.curve.a, law.curve.b);
        let text = format!("{}: {a:.3} v^{b:.3}, {}", name(law.law), law.provenance.kind());
        let range = usual.map_or(String::new(), |[low, high]| {
            format!("\nUsual speeds of the {gait}: {low:.1} to {high:.1} m/s")
        });
        let hover = format!(
            "T_c = a v^b with a = {a:.4} s and b = {b:.4}\n{data}, {interval}\n{}{range}",
            source(law)
        );
        ui.label(RichText::new(text).weak()).on_hover_text(hover);
    }
}

fn source(law: &ContactLaw) -> String {
    match &law.provenance {
        Provenance::Published { source } => format!("Published: {source}"),
        Provenance::Captured { plates, .. } => format!("Captured: {}", plates.join(", ")),
        Provenance::Derived { from, how } => format!("Derived: {how}\nfrom {}", from.join("; ")),
    }
}

fn name(kind: LawKind) -> &'static str {
    match kind {
        LawKind::Support => "support",
        LawKind::LimbFore => "one fore",
        LawKind::LimbHind => "one hind",
    }
}

/// The colours of the report: they differ in lightness as well as in hue.
fn color(ui: &Ui, kind: LawKind) -> Color32 {
    let [dark, light] = match kind {
        LawKind::Support => [[0x58, 0xCB, 0x9D], [0x14, 0x77, 0x55]],
        LawKind::LimbFore => [[0xD3, 0x98, 0xE6], [0x8B, 0x3A, 0xA3]],
        LawKind::LimbHind => [[0xE8, 0xBC, 0x4F], [0xA0, 0x6C, 0x06]],
    };
    let [r, g, b] = if ui.visuals().dark_mode { dark } else { light };
    Color32::from_rgb(r, g, b)
}
