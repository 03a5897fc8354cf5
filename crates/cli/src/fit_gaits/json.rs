//! The `--json` document.

use muybridge_core::{Interval, LawKind, Limb, Pair, Provenance};
use muybridge_fitting::fit_document::rounded;
use muybridge_fitting::gait_analysis::GaitAnalysis;
use muybridge_fitting::held_out::quantile;
use muybridge_fitting::pipeline::PlateFit;
use muybridge_fitting::stride_fit::{PointResidual, rms};
use serde::Serialize;
use serde_json::{Value, json};

use super::Outcome;

/// Version of the document.
const JSON_SCHEMA: u32 = 1;

#[derive(Serialize)]
pub(super) struct Document<'a> {
    schema: u32,
    gaits: Vec<GaitEntry<'a>>,
    strides: Vec<Value>,
    failures: &'a [String],
}

#[derive(Serialize)]
struct GaitEntry<'a> {
    gait: &'static str,
    law: LawKind,
    a: f64,
    b: f64,
    n: usize,
    interval: Option<Interval>,
    provenance: &'a Provenance,
}

pub(super) fn document(outcome: &Outcome) -> Document<'_> {
    let gaits = outcome.laws.iter().map(|law| GaitEntry {
        gait: law.law.gait.name(),
        law: law.law.law,
        a: law.law.curve.a,
        b: law.law.curve.b,
        n: law.law.n,
        interval: law.law.interval,
        provenance: &law.law.provenance,
    });
    Document {
        schema: JSON_SCHEMA,
        gaits: gaits.collect(),
        strides: outcome.fits.iter().map(stride).collect(),
        failures: &outcome.failures,
    }
}

fn with_sd([value, sd]: [f64; 2]) -> Value {
    json!({ "value": rounded(value, 5), "sd": rounded(sd, 5) })
}

fn stride(fitted: &PlateFit) -> Value {
    let analysis = &fitted.analysis;
    let speed = fitted.calibration.speed_m_s;
    json!({
        "plate": fitted.id(),
        "gait": fitted.gait().name(),
        "implied_gait": analysis.implied.name(),
        "agrees_with_title": analysis.implied.agrees_with(fitted.titled()),
        "lead": analysis.lead,
        "speed_m_s": with_sd([speed.value, speed.sd]),
        "speed_source": fitted.calibration.speed_source,
        "interval_s": with_sd([fitted.calibration.interval_s.value, fitted.calibration.interval_s.sd]),
        "stride_time_s": with_sd(analysis.stride_time_s),
        "stride_length_m": with_sd(fitted.stride_length_m()),
        "stance_fore_s": with_sd(analysis.stance_s(Pair::Fore)),
        "stance_hind_s": with_sd(analysis.stance_s(Pair::Hind)),
        "support_s": with_sd(analysis.support_s()),
        "hind_duty_factor": rounded(analysis.hind_duty_factor(), 5),
        "lateral_lag": rounded(analysis.lateral_lag(), 5),
        "footfall_order": analysis.footfall_order().map(Limb::abbreviation),
        "suspensions": analysis.suspensions.iter().map(|s| json!({
            "share": with_sd([s.share, s.sd]),
            "gathered": s.is_gathered(),
        })).collect::<Vec<_>>(),
        "limbs": limbs(analysis),
        "froude": rounded(fitted.froude(), 3),
        "withers_height_m": rounded(fitted.withers_height_m, 4),
        "residual": errors(&fitted.residuals, fitted.withers_height_m),
        "held_out": errors(&fitted.held_out, fitted.withers_height_m),
        "disagreements": disagreements(fitted),
        "warnings": fitted.warnings,
        "annotation_sha256": fitted.plate.annotation_sha256,
    })
}

fn limbs(analysis: &GaitAnalysis) -> Vec<Value> {
    analysis
        .contacts
        .iter()
        .map(|contact| {
            json!({
                "limb": contact.limb.abbreviation(),
                "lag": rounded(analysis.lags[contact.limb.index()], 5),
                "stance_s": rounded(contact.duty_factor() * analysis.stride_time_s[0], 5),
                "swing_s": rounded((1.0 - contact.duty_factor()) * analysis.stride_time_s[0], 5),
                "duty_factor": with_sd([contact.duty_factor(), contact.duty_factor_sd()]),
            })
        })
        .collect()
}

fn disagreements(fitted: &PlateFit) -> Vec<Value> {
    fitted
        .calibration
        .disagreements
        .iter()
        .map(|d| {
            json!({
                "quantity": d.quantity,
                "used": { "from": d.used.0, "value": rounded(d.used.1.value, 5), "sd": rounded(d.used.1.sd, 5) },
                "other": { "from": d.other.0, "value": rounded(d.other.1.value, 5), "sd": rounded(d.other.1.sd, 5) },
                "percent": rounded(d.percent(), 2),
            })
        })
        .collect()
}

fn errors(residuals: &[PointResidual], withers_height_m: f64) -> Value {
    let percent: Vec<f64> = residuals.iter().map(|r| 100.0 * r.metres() / withers_height_m).collect();
    let worst = residuals.iter().max_by(|a, b| a.metres().total_cmp(&b.metres()));
    json!({
        "n": residuals.len(),
        "rms_px": rounded(rms(residuals.iter().map(PointResidual::px)), 3),
        "rms_cm": rounded(100.0 * rms(residuals.iter().map(PointResidual::metres)), 3),
        "rms_percent_of_withers": rounded(rms(percent.iter().copied()), 3),
        "median_percent_of_withers": rounded(quantile(&percent, 0.5), 3),
        "p90_percent_of_withers": rounded(quantile(&percent, 0.9), 3),
        "worst": worst.map(|r| json!({
            "panel": r.panel,
            "keypoint": r.keypoint.name(),
            "px": rounded(r.px(), 2),
            "cm": rounded(100.0 * r.metres(), 2),
            "percent_of_withers": rounded(100.0 * r.metres() / withers_height_m, 2),
        })),
    })
}
