//! One plate: what it is, how scale and time are known, and where its sources disagree.

use muybridge_capture::{
    Disagreement, Estimate, Known, NearOff, Parallax, Plane, Position, ScaleSource, TimeSource,
};
use muybridge_core::{Skeleton, SpeedSource};

use super::page::{escape, list, plus_minus_fitting, signed, table};
use super::{footfalls, hoof_paths, lengths, residuals, strip};
use crate::pipeline::PlateFit;

/// A difference beyond this many standard deviations is called one.
const SIGMAS_THAT_DISAGREE: f64 = 2.0;

/// The section of the plate at an index (for its anchor).
pub(super) fn section(index: usize, fit: &PlateFit, skeleton: &Skeleton) -> String {
    let manifest = &fit.plate.manifest;
    let warnings: Vec<String> = fit.warnings.iter().map(|warning| escape(warning)).collect();
    let warnings = match warnings.as_slice() {
        [] => "<p>Nothing lies outside what horses do at this gait.</p>\n".to_string(),
        found => list("warnings", found),
    };
    let parts = [
        ("Calibration", calibration(fit)),
        ("Warnings", warnings),
        ("The stride, panel by panel", strip::strip(fit)),
        ("Footfalls", footfalls::footfalls(fit)),
        ("Paths of the hooves", hoof_paths::hoof_paths(fit)),
        ("Residuals", residuals::residuals(fit)),
        ("Bone lengths", lengths::bone_lengths(fit, skeleton)),
    ];
    let parts: String = parts.iter().map(|(name, content)| format!("<h3>{name}</h3>\n{content}")).collect();
    format!(
        "<section id=\"plate-{index}\"><h2>{}</h2>\n{}{parts}</section>\n",
        escape(&manifest.title),
        facts(fit)
    )
}

fn facts(fit: &PlateFit) -> String {
    let (manifest, annotation) = (&fit.plate.manifest, &fit.plate.annotation);
    let plate = manifest
        .catalogue_number
        .as_ref()
        .map_or(String::new(), |number| format!(", plate {}", escape(number)));
    let printed: String = manifest.printed.iter().map(|line| format!("<p>{}</p>", escape(line))).collect();
    let printed = if printed.is_empty() { printed } else { format!("<blockquote>{printed}</blockquote>\n") };
    format!(
        "<p class=\"facts\">{}, {}{plate}. Titled {}, facing {}.<br/>Source: {}. Held by {}. Rights: \
         {}.<br/>{} panels fitted, {} points placed by {}.</p>\n{printed}",
        escape(&manifest.animal),
        escape(&manifest.date),
        manifest.gait,
        format!("{:?}", fit.plate.facing).to_lowercase(),
        escape(&manifest.source),
        escape(&manifest.holder),
        escape(&manifest.licence),
        fit.calibration.stride.len(),
        fit.residuals.len(),
        escape(&annotation.annotator),
    )
}

fn calibration(fit: &PlateFit) -> String {
    let of = &fit.calibration;
    let speed = match of.speed_source {
        SpeedSource::Stated => "is stated with the plate",
        SpeedSource::Measured => "follows from distance and time",
        SpeedSource::Inferred => "is inferred from the stride length",
    };
    let parallax = of.parallax.map_or(String::new(), |ratio| {
        format!(" Things on the track appear {} times as large as on the wall of marks.", estimate(ratio))
    });
    format!(
        "<p>The fit is driven by {} for scale and by {} for time. The speed of {} m/s {speed}; the mean \
         interval between panels is {} ms.{parallax}</p>\n{}{}",
        scale_name(fit.plate.calibration.scale.driven_by),
        time_name(fit.plate.calibration.time.driven_by),
        estimate(of.speed_m_s),
        estimate(Estimate { value: 1000.0 * of.interval_s.value, sd: 1000.0 * of.interval_s.sd }),
        known_table(fit),
        disagreements(fit)
    )
}

fn scale_name(source: ScaleSource) -> &'static str {
    match source {
        ScaleSource::KnownLength => "a known length in the picture",
        ScaleSource::WithersHeight => "the withers height",
    }
}

fn time_name(source: TimeSource) -> &'static str {
    match source {
        TimeSource::Interval => "the interval between panels",
        TimeSource::Speed => "the speed",
        TimeSource::StrideTime => "the stride time",
        TimeSource::DynamicSimilarity => "dynamic similarity (speed inferred from the stride's length)",
    }
}

fn estimate(estimate: Estimate) -> String {
    plus_minus_fitting(estimate.value, estimate.sd)
}

/// What is known, how well, from where, and whether the fit rests on it.
fn known_table(fit: &PlateFit) -> String {
    let calibration = &fit.plate.calibration;
    let (scale, time) = (&calibration.scale, &calibration.time);
    let by_length = scale.driven_by == ScaleSource::KnownLength;
    let mut rows = Vec::new();
    let mut add = |name: &str, known: Option<&Known>, drives: bool| {
        if let Some(known) = known {
            let assumed = if known.assumed { " <span class=\"badge\">assumed</span>" } else { "" };
            let role = if drives { "<span class=\"badge drives\">drives the fit</span>" } else { "compared" };
            let value = plus_minus_fitting(known.value, known.sd);
            rows.push(vec![name.to_string(), value, role.into(), escape(&known.from) + assumed]);
        }
    };
    add("distance of marks, m", scale.known_length.as_ref().map(|length| &length.mark_spacing_m), by_length);
    if let Some(Plane::Wall(Parallax::Ratio(ratio))) = scale.known_length.as_ref().map(|length| &length.plane)
    {
        add("track over wall, ratio of scales", Some(ratio), by_length);
    }
    add("withers height, m", scale.withers_height_m.as_ref(), !by_length);
    if let Position::CameraSpacing { spacing_m, .. } = &calibration.position {
        add("distance of cameras, m", Some(spacing_m), true);
    }
    if let Position::EvenAdvance { per_panel_m } = &calibration.position {
        add("advance of the trunk per panel, m", per_panel_m.as_ref(), true);
    }
    add("interval, s", time.interval_s.as_ref(), time.driven_by == TimeSource::Interval);
    add("speed, m/s", time.speed_m_s.as_ref(), time.driven_by == TimeSource::Speed);
    add("stride time, s", time.stride_time_s.as_ref(), time.driven_by == TimeSource::StrideTime);
    add("camera to near legs, m", Some(&calibration.camera.distance_m), true);
    add("height of the lens, m", Some(&calibration.camera.height_m), true);
    table("known", &["Known", "Value ± sd", "Role", "From"], &rows)
}

fn disagreements(fit: &PlateFit) -> String {
    let found = &fit.calibration.disagreements;
    if found.is_empty() {
        return "<p>No quantity is known from two sources, so nothing could disagree.</p>\n".into();
    }
    let rows: Vec<Vec<String>> = found
        .iter()
        .map(|d| {
            let sigmas = d.sigmas();
            let apart = if sigmas.is_finite() { format!("{sigmas:.1}") } else { "both exact".into() };
            let apart = if sigmas > SIGMAS_THAT_DISAGREE {
                format!("<span class=\"warning\">{apart}</span>")
            } else {
                apart
            };
            let source = |(name, value): &(String, Estimate)| {
                format!("{}<br/><small>{}</small>", estimate(*value), escape(name))
            };
            vec![escape(d.quantity), source(&d.used), source(&d.other), signed(d.percent(), 1), apart]
        })
        .collect();
    let head =
        ["Quantity", "Drives the fit", "The other source", "Difference, %", "Standard deviations apart"];
    format!("<p>{}</p>\n{}", verdict(found), table("disagreements", &head, &rows))
}

/// Which quantities two sources disagree on.
fn verdict(found: &[Disagreement]) -> String {
    let apart: Vec<String> =
        found.iter().filter(|d| d.sigmas() > SIGMAS_THAT_DISAGREE).map(|d| escape(d.quantity)).collect();
    let verdict = if apart.is_empty() {
        "All agree within two standard deviations.".to_string()
    } else {
        format!(
            "<span class=\"warning\">More than two standard deviations apart: {}.</span>",
            apart.join("; ")
        )
    };
    format!(
        "Some quantities are known twice. The fit rests on the source named first; the other is only \
         compared. {verdict}"
    )
}

/// The animal's near side in a word.
pub(super) fn near_side(fit: &PlateFit) -> String {
    format!("{:?}", fit.plate.facing.side(NearOff::Near)).to_lowercase()
}
