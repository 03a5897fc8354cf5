//! The head of the report: what was fitted, what failed, and the table of results.

use muybridge_core::{Lead, MPS_PER_MPH, Pair, Side};

use super::page::{escape, list, number, plus_minus, table};
use crate::held_out::quantile;
use crate::pipeline::PlateFit;
use crate::stride_fit::{PointResidual, rms};

/// Title, contents, failures and the summary table.
pub(super) fn summary(fits: &[PlateFit], failures: &[String]) -> String {
    let failed: Vec<String> = failures.iter().map(|failure| escape(failure)).collect();
    let failed = match failed.as_slice() {
        [] => String::new(),
        found => format!("<h3>Not fitted</h3>\n{}", list("failures", found)),
    };
    let links: String = fits
        .iter()
        .enumerate()
        .map(|(i, fit)| format!("<a href=\"#plate-{i}\">{}</a>", escape(fit.id())))
        .collect();
    let results = if fits.is_empty() { String::new() } else { results(fits) };
    format!(
        "<header><h1>Horses in motion, fitted</h1>\n<p class=\"lede\">{} to a planar skeleton of 28 \
         bones, all panels of a stride at once. Each number says how sure it is; each plot says what it \
         rests on.</p>\n\
         <nav class=\"contents\"><a href=\"#sheets\">contact sheets</a>{links}\
         <a href=\"#laws\">laws of speed</a><a href=\"#reading\">how to \
         read this</a></nav>\n\
         {failed}{results}</header>\n",
        counts(fits.len(), failures.len())
    )
}

fn counts(fitted: usize, failed: usize) -> String {
    let plates = |n: usize| if n == 1 { "1 plate".to_string() } else { format!("{n} plates") };
    match (fitted, failed) {
        (n, 0) => format!("{} fitted", plates(n)),
        (n, failed) => format!("{} fitted, {failed} not (see below),", plates(n)),
    }
}

const HEAD: [&str; 13] = [
    "Gait, plate",
    "Speed",
    "Stride time, s",
    "Stride length, m",
    "Stance fore, ms",
    "Stance hind, ms",
    "Support, ms",
    "Duty factor hind",
    "Lateral lag",
    "Footfalls, lead",
    "Residual RMS",
    "Worst residual",
    "Held out, median and 90th percentile",
];

fn results(fits: &[PlateFit]) -> String {
    let rows: Vec<Vec<String>> = fits.iter().enumerate().map(|(i, fit)| row(i, fit)).collect();
    format!(
        "{}<p class=\"note\">± is one standard deviation. Residuals in px, cm and percent of withers \
         height over all placed points; held-out errors in percent of withers height over visible \
         points.</p>\n",
        table("summary", &HEAD, &rows)
    )
}

fn row(index: usize, fit: &PlateFit) -> Vec<String> {
    let analysis = &fit.analysis;
    let speed = fit.calibration.speed_m_s;
    let spread =
        |[value, sd]: [f64; 2], unit: f64, decimals: usize| plus_minus(unit * value, unit * sd, decimals);
    vec![
        format!("{}<br/><small><a href=\"#plate-{index}\">{}</a></small>", fit.gait(), escape(fit.id())),
        format!(
            "{}&#160;m/s<br/><small>{}&#160;mph</small>",
            plus_minus(speed.value, speed.sd, 1),
            plus_minus(speed.value / MPS_PER_MPH, speed.sd / MPS_PER_MPH, 1)
        ),
        spread(analysis.stride_time_s, 1.0, 3),
        spread(fit.stride_length_m(), 1.0, 2),
        spread(analysis.stance_s(Pair::Fore), 1000.0, 0),
        spread(analysis.stance_s(Pair::Hind), 1000.0, 0),
        spread(analysis.support_s(), 1000.0, 0),
        number(analysis.hind_duty_factor(), 2),
        number(analysis.lateral_lag(), 2),
        footfalls(fit),
        residual(fit, |values| rms(values.iter().copied())),
        residual(fit, |values| values.iter().copied().fold(0.0, f64::max)),
        held_out(fit),
    ]
}

fn footfalls(fit: &PlateFit) -> String {
    let implied = fit.analysis.implied;
    let verdict = if implied.agrees_with(fit.titled()) {
        "as titled".into()
    } else {
        format!("titled {}", fit.titled())
    };
    let class = if implied.agrees_with(fit.gait()) { "unit" } else { "warning" };
    let lead = fit.analysis.lead.map_or("no lead".to_string(), lead_name);
    format!(
        "{}<br/><small class=\"{class}\">{verdict}</small><br/><small>{lead}</small>",
        escape(implied.name())
    )
}

/// A lead in words.
pub(super) fn lead_name(lead: Lead) -> String {
    let name = |side: Side| if side == Side::Left { "left" } else { "right" };
    if lead.is_transverse() {
        format!("{} lead", name(lead.fore))
    } else {
        format!("{} fore, {} hind lead", name(lead.fore), name(lead.hind))
    }
}

/// One figure of all residuals in px, cm, and percent of withers height.
fn residual(fit: &PlateFit, of: fn(&[f64]) -> f64) -> String {
    let all = |f: fn(&PointResidual) -> f64| of(&fit.residuals.iter().map(f).collect::<Vec<_>>());
    let (px, metres) = (all(PointResidual::px), all(PointResidual::metres));
    let percent = 100.0 * metres / fit.withers_height_m;
    format!("{px:.1} px<br/><small>{:.1} cm<br/>{percent:.1} %</small>", 100.0 * metres)
}

fn held_out(fit: &PlateFit) -> String {
    let errors: Vec<f64> = fit.held_out.iter().map(|r| 100.0 * r.metres() / fit.withers_height_m).collect();
    if errors.is_empty() {
        return "nothing visible".into();
    }
    format!("{:.1} %<br/><small>{:.1} %</small>", quantile(&errors, 0.5), quantile(&errors, 0.9))
}
