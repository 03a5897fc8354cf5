//! The table for people.

use comfy_table::{Table, presets::UTF8_FULL};
use muybridge_core::{MPS_PER_MPH, Pair, Provenance, SpeedSource};
use muybridge_fitting::gait_laws::GaitLaw;
use muybridge_fitting::held_out::quantile;
use muybridge_fitting::pipeline::PlateFit;
use muybridge_fitting::stride_fit::{PointResidual, rms};

use super::{Outcome, compare};

const HEADER: [&str; 13] = [
    "gait",
    "plate",
    "speed\nm/s (mph)",
    "stride\ns",
    "limb stance s\nfore\nhind",
    "support\ns",
    "duty\nhind",
    "Hildebrand gait\nvs title",
    "RMS\npx / cm / % withers",
    "worst\npx / cm / % withers",
    "law\nT_c = a v^b",
    "a\nb",
    "95 % interval\n(n points)",
];

/// The table, the comparison of sources, warnings and notes.
pub(super) fn text(outcome: &Outcome) -> String {
    let mut table = Table::new();
    table.load_style(UTF8_FULL).set_header(HEADER);
    for fitted in &outcome.fits {
        let laws: Vec<&GaitLaw> = outcome.laws.iter().filter(|law| law.law.gait == fitted.gait()).collect();
        table.add_row(plate_row(fitted, &laws));
    }
    for law in outcome.laws.iter().filter(|law| !outcome.fits.iter().any(|f| f.gait() == law.law.gait)) {
        table.add_row(law_row(law));
    }
    let mut text = format!("{table}\n");
    for fitted in &outcome.fits {
        text.push_str(&plate_notes(fitted));
    }
    text.push_str(&compare::text(&outcome.fits, &outcome.database));
    text.push_str(
        "Speeds marked inferred follow from the stride's length by dynamic similarity, and all times of such a plate with them.\n\
         A borrowed b is not the gait's own: its captures cannot tell it, and a alone is theirs.\n\
         A law by one or two points has no interval; an error of 1 % in each T_c moves b by 0.03 to 0.08.\n\
         Support is the time in which at least one hoof is down (what the published numbers most likely are);\n\
         limb stance is a single limb's. They differ by a factor of up to four at the gallop.\n",
    );
    text
}

fn pm([value, sd]: [f64; 2], decimals: usize) -> String {
    format!("{value:.decimals$} ± {sd:.decimals$}")
}

fn errors(r: &PointResidual, withers_height_m: f64) -> String {
    format!(
        "{:.1} / {:.1} / {:.1}\n{} in {}",
        r.px(),
        100.0 * r.metres(),
        100.0 * r.metres() / withers_height_m,
        r.keypoint,
        r.panel
    )
}

fn plate_row(fitted: &PlateFit, laws: &[&GaitLaw]) -> Vec<String> {
    let analysis = &fitted.analysis;
    let (speed, withers) = (fitted.calibration.speed_m_s, fitted.withers_height_m);
    let rms_m = rms(fitted.residuals.iter().map(PointResidual::metres));
    let rms_px = rms(fitted.residuals.iter().map(PointResidual::px));
    let worst = fitted.residuals.iter().max_by(|a, b| a.metres().total_cmp(&b.metres()));
    let agreement = if analysis.implied.agrees_with(fitted.titled()) { "agrees" } else { "DIFFERS" };
    let lead = analysis.lead.map_or(String::new(), |lead| format!("\n{:?} lead", lead.fore).to_lowercase());
    vec![
        fitted.gait().to_string(),
        fitted.id().to_string(),
        format!(
            "{}\n({:.1}){}",
            pm([speed.value, speed.sd], 2),
            speed.value / MPS_PER_MPH,
            if fitted.calibration.speed_source == SpeedSource::Inferred { "\ninferred" } else { "" }
        ),
        pm(analysis.stride_time_s, 3),
        format!("{}\n{}", pm(analysis.stance_s(Pair::Fore), 3), pm(analysis.stance_s(Pair::Hind), 3)),
        pm(analysis.support_s(), 3),
        format!("{:.2}", analysis.hind_duty_factor()),
        format!("{}{lead}\n{agreement}", analysis.implied.name()),
        format!("{rms_px:.1} / {:.1} / {:.1}", 100.0 * rms_m, 100.0 * rms_m / withers),
        worst.map_or(String::new(), |r| errors(r, withers)),
        lines(laws, |law| law.law.law.name().to_string()),
        lines(laws, |law| format!("{:.4}  {:.4}", law.law.curve.a, law.law.curve.b)),
        lines(laws, interval),
    ]
}

fn lines(laws: &[&GaitLaw], cell: impl Fn(&GaitLaw) -> String) -> String {
    laws.iter().map(|law| cell(law)).collect::<Vec<_>>().join("\n")
}

fn interval(law: &GaitLaw) -> String {
    match &law.law.interval {
        Some(i) => format!("a {:.3}..{:.3}, b {:.3}..{:.3} ({})", i.a[0], i.a[1], i.b[0], i.b[1], law.law.n),
        None if law.law.borrowed.is_some() => format!("none ({}, b borrowed)", law.law.n),
        None => format!("none ({}, {})", law.law.n, law.law.provenance.kind()),
    }
}

/// A law without a plate of its gait.
fn law_row(law: &GaitLaw) -> Vec<String> {
    let speeds: Vec<String> =
        law.points.iter().map(|p| format!("{:.2} ({:.0})", p.speed_m_s, p.speed_m_s / MPS_PER_MPH)).collect();
    let times: Vec<String> = law.points.iter().map(|p| format!("{:.3}", p.contact_time_s)).collect();
    let source = match &law.law.provenance {
        Provenance::Published { .. } => "huang-2012 (published)".to_string(),
        Provenance::Derived { from, .. } => format!("derived from\n{}", from.join("\n")),
        Provenance::Captured { plates, .. } => plates.join("\n"),
    };
    let mut row = vec![law.law.gait.to_string(), source, speeds.join("\n")];
    row.extend(["".into(), "".into(), times.join("\n")]);
    row.extend(std::iter::repeat_n(String::new(), 4));
    row.push(law.law.law.name().into());
    row.push(format!("{:.6}  {:.5}", law.law.curve.a, law.law.curve.b));
    row.push(interval(law));
    row
}

/// What the sources disagree on, how well unseen points are predicted, and what looks implausible.
fn plate_notes(fitted: &PlateFit) -> String {
    let mut text = format!("{}:\n", fitted.id());
    for d in &fitted.calibration.disagreements {
        text.push_str(&format!(
            "  {}: {} by {}; {} by {} ({:+.1} %, {:.1} sd)\n",
            d.quantity,
            pm([d.used.1.value, d.used.1.sd], 4),
            d.used.0,
            pm([d.other.1.value, d.other.1.sd], 4),
            d.other.0,
            d.percent(),
            d.sigmas(),
        ));
    }
    if let Some(parallax) = fitted.calibration.parallax {
        text.push_str(&format!(
            "  scale on the track over scale on the wall: {}\n",
            pm([parallax.value, parallax.sd], 3)
        ));
    }
    text.push_str(&format!(
        "  stride length {} m, Froude number {:.1}\n",
        pm(fitted.stride_length_m(), 2),
        fitted.froude()
    ));
    let unseen: Vec<f64> =
        fitted.held_out.iter().map(|r| 100.0 * r.metres() / fitted.withers_height_m).collect();
    text.push_str(&format!(
        "  held-out keypoints ({}): median {:.1} %, 90th percentile {:.1} % of withers height ({:.2} m)\n",
        unseen.len(),
        quantile(&unseen, 0.5),
        quantile(&unseen, 0.9),
        fitted.withers_height_m,
    ));
    for warning in &fitted.warnings {
        text.push_str(&format!("  warning: {warning}\n"));
    }
    text
}
