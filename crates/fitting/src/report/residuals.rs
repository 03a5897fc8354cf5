//! How far the fit is from the placed points: by keypoint, by panel, and the worst in words.

use muybridge_capture::{Keypoint, KeypointState};

use super::page::{figure, list, table};
use super::plot::{Anchor, Axis, Drawn, FULL_WIDTH_PX, Ink, LABEL_PX, Mark, Pen, svg, tick_label};
use crate::held_out::quantile;
use crate::pipeline::PlateFit;
use crate::stride_fit::{PointResidual, rms};

const ROW_PX: f64 = 19.0;
const TOP_PX: f64 = 42.0;
/// Left and right end of the two panels of the plot, px.
const FITTED_PX: [f64; 2] = [150.0, 600.0];
const HELD_OUT_PX: [f64; 2] = [634.0, 1064.0];
/// Points told in words.
const WORST: usize = 5;
/// The heat table's full colour, px: several times a person's own scatter.
const FULL_HEAT_PX: f64 = 12.0;
/// Heat below this share of full colour is left white, so that the eye goes to what matters.
const LEAST_HEAT: f64 = 0.05;

/// The plot, the table of panels, and the worst points.
pub(super) fn residuals(fit: &PlateFit) -> String {
    let caption = "Distance of the fitted joint from the placed point, in percent of withers height. On \
     the left all placed points: the bar is the root mean square over the panels, dots are single panels \
     (hollow where the point was guessed). On the right the error of visible points when the fit sees no \
     point of that keypoint in any panel: the diamond is the median, dots are single panels.";
    let worst = worst_points(fit);
    let told = list("worst", &worst);
    format!(
        "{}<p>The {} points that fit worst:</p>\n{told}{}",
        figure(&by_keypoint(fit), caption),
        worst.len(),
        heat_table(fit)
    )
}

/// Residual in percent of the plate's withers height.
fn percent(fit: &PlateFit, residual: &PointResidual) -> f64 {
    100.0 * residual.metres() / fit.withers_height_m
}

fn by_keypoint(fit: &PlateFit) -> String {
    let used: Vec<Keypoint> =
        Keypoint::all().filter(|k| fit.residuals.iter().any(|r| r.keypoint == *k)).collect();
    let greatest = fit.residuals.iter().chain(&fit.held_out).map(|r| percent(fit, r)).fold(1.0, f64::max);
    let bottom = TOP_PX + used.len() as f64 * ROW_PX;
    let axes = [FITTED_PX, HELD_OUT_PX].map(|px| Axis { values: [0.0, 1.03 * greatest], px });
    svg("Residuals and held-out errors by keypoint", [FULL_WIDTH_PX, bottom + 24.0], |pen| {
        for (axis, name) in
            axes.iter().zip(["residual, % of withers height", "held-out error, % of withers height"])
        {
            pen.text([axis.px[0], 12.0], name, LABEL_PX, Ink::Text, Anchor::Start)?;
            let ticks = axis.ticks(9);
            for tick in &ticks {
                let x = axis.at(*tick);
                pen.line(&[[x, TOP_PX - 4.0], [x, bottom]], Ink::Rule, 0.75)?;
                for y in [TOP_PX - 13.0, bottom + 12.0] {
                    pen.label([x, y], &tick_label(*tick, &ticks), Anchor::Middle)?;
                }
            }
        }
        used.iter().enumerate().try_for_each(|(row, keypoint)| {
            let y = TOP_PX + (row as f64 + 0.5) * ROW_PX;
            keypoint_row(pen, fit, *keypoint, y, axes)
        })
    })
}

fn keypoint_row(
    pen: &Pen<'_>,
    fit: &PlateFit,
    keypoint: Keypoint,
    y: f64,
    [fitted, held_out]: [Axis; 2],
) -> Drawn {
    let ink = super::ink_of(keypoint);
    pen.text([FITTED_PX[0] - 10.0, y], &super::name_of(keypoint), LABEL_PX, ink, Anchor::End)?;
    let of = |all: &[PointResidual]| -> Vec<(f64, KeypointState)> {
        all.iter().filter(|r| r.keypoint == keypoint).map(|r| (percent(fit, r), r.state)).collect()
    };
    let points = of(&fit.residuals);
    let mean = rms(points.iter().map(|(value, _)| *value));
    pen.rectangle([fitted.at(0.0), y - 6.0], [fitted.at(mean), y + 6.0], ink, 0.3)?;
    for (value, state) in points {
        let at = [fitted.at(value), y];
        if state == KeypointState::Visible { pen.dot(at, 2.4, ink, 0.85)? } else { pen.ring(at, 2.2, ink)? }
    }
    let points: Vec<f64> = of(&fit.held_out).into_iter().map(|(value, _)| value).collect();
    if points.is_empty() {
        return pen.label([held_out.px[0] + 4.0, y], "seen in no panel", Anchor::Start);
    }
    for value in &points {
        pen.dot([held_out.at(*value), y], 2.4, ink, 0.45)?;
    }
    pen.mark([held_out.at(quantile(&points, 0.5)), y], Mark::Diamond, 5.0, ink)
}

/// The worst points with the direction in which the fit is off.
fn worst_points(fit: &PlateFit) -> Vec<String> {
    let mut order: Vec<&PointResidual> = fit.residuals.iter().collect();
    order.sort_by(|a, b| b.px().total_cmp(&a.px()));
    order.into_iter().take(WORST).map(|residual| told(fit, residual)).collect()
}

fn told(fit: &PlateFit, residual: &PointResidual) -> String {
    let guessed = if residual.state == KeypointState::Visible { "" } else { " (guessed)" };
    let camera = fit.calibration.stride.iter().find(|camera| camera.panel == residual.panel);
    let direction = camera.map_or(String::new(), |camera| {
        let off = [0, 1].map(|axis| residual.fitted_px[axis] - residual.placed_px[axis]);
        let along = |unit: [f64; 2]| off[0] * unit[0] + off[1] * unit[1];
        format!("; the fit lies {}", in_words(along(camera.forward), along(camera.up)))
    });
    format!(
        "panel {}, {}{guessed}: {:.1} px = {:.1} cm = {:.1} % of withers height{direction}",
        residual.panel,
        super::name_of(residual.keypoint),
        residual.px(),
        100.0 * residual.metres(),
        percent(fit, residual)
    )
}

/// Where a point lies, from its px ahead and above; a component below a third of the other is not told.
fn in_words(ahead_px: f64, above_px: f64) -> String {
    let along = if ahead_px > 0.0 { "ahead" } else { "behind" };
    let upright = if above_px > 0.0 { "above" } else { "below" };
    match (ahead_px.abs() * 3.0 > above_px.abs(), above_px.abs() * 3.0 > ahead_px.abs()) {
        (true, true) => format!("{along} and {upright}"),
        (true, false) => along.to_string(),
        _ => upright.to_string(),
    }
}

fn heat_table(fit: &PlateFit) -> String {
    let panels: Vec<u32> = fit.calibration.stride.iter().map(|camera| camera.panel).collect();
    let heads: Vec<String> = panels.iter().map(ToString::to_string).collect();
    let mut head = vec!["px, by panel"];
    head.extend(heads.iter().map(String::as_str));
    head.push("RMS");
    let rows: Vec<Vec<String>> = Keypoint::all()
        .filter_map(|keypoint| {
            let of: Vec<&PointResidual> = fit.residuals.iter().filter(|r| r.keypoint == keypoint).collect();
            if of.is_empty() {
                return None;
            }
            let mut row = vec![super::name_of(keypoint)];
            row.extend(panels.iter().map(|panel| {
                of.iter().find(|r| r.panel == *panel).map_or("<span>·</span>".into(), |r| heat_cell(r))
            }));
            row.push(format!("<span><b>{:.1}</b></span>", rms(of.iter().map(|r| r.px()))));
            Some(row)
        })
        .collect();
    format!(
        "{}<p class=\"note\">Residuals in px of the plate, keypoint by panel; guessed points in italics. \
         One px is {:.1} mm on the track.</p>\n",
        table("heat", &head, &rows),
        mean_mm_per_px(fit)
    )
}

fn heat_cell(residual: &PointResidual) -> String {
    let heat = (residual.px() / FULL_HEAT_PX).min(1.0).powi(2);
    let class = if residual.state == KeypointState::Visible { "seen" } else { "occluded" };
    // The background is mixed in the style sheet's colours, so that it suits light and dark paper.
    let style = if heat < LEAST_HEAT {
        String::new()
    } else {
        format!(" style=\"background:color-mix(in srgb, var(--near) {:.0}%, transparent)\"", 75.0 * heat)
    };
    format!("<span class=\"{class}\"{style}>{:.1}</span>", residual.px())
}

fn mean_mm_per_px(fit: &PlateFit) -> f64 {
    let cameras = &fit.calibration.stride;
    1000.0 * cameras.iter().map(|camera| 1.0 / camera.px_per_m).sum::<f64>() / cameras.len().max(1) as f64
}
