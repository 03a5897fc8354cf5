//! Bone lengths: the fitted animal's against the reference horse of the same size.

use muybridge_core::{Limb, Skeleton, bone};

use super::page::{number, plus_minus, signed, table};
use crate::layout::{LOG_DOCK, LOG_SCALE};
use crate::pipeline::PlateFit;

/// The table.
pub(super) fn bone_lengths(fit: &PlateFit, skeleton: &Skeleton) -> String {
    let (problem, shared) = (&fit.fit.problem, fit.fit.shared());
    let scale = shared[LOG_SCALE].exp();
    let errors = fit.fit.standard_errors();
    let sd_of = |index: usize| errors.as_ref().and_then(|all| all.get(index).copied());
    let row = |name: String, reference_m: f64, fitted_m: f64, log_length: usize| {
        let fitted_cm = match sd_of(log_length) {
            Some(sd) => plus_minus(100.0 * fitted_m, 100.0 * fitted_m * sd, 1),
            None => number(100.0 * fitted_m, 1),
        };
        let percent = signed(100.0 * (fitted_m / reference_m - 1.0), 1);
        vec![name, number(100.0 * reference_m, 1), fitted_cm, signed(100.0 * (fitted_m - reference_m), 1), percent]
    };
    let body = (bone::SPINE..=bone::HEAD).map(|i| (i, String::new()));
    let fore = (0..5).map(|i| (Limb::LF.first_bone() + i, " (fore)".to_string()));
    let hind = (0..5).map(|i| (Limb::LH.first_bone() + i, " (hind)".to_string()));
    let mut rows: Vec<Vec<String>> = body
        .chain(fore)
        .chain(hind)
        .map(|(i, of)| {
            let reference_m = f64::from(skeleton.bones[i].length_m) * scale;
            let name = super::page::escape(&skeleton.bones[i].name) + &of;
            row(name, reference_m, problem.bone_length_m(i, shared), problem.length_index(i))
        })
        .collect();
    let [x, y] = skeleton.dock_from_croup_m.map(f64::from);
    let dock_m = x.hypot(y);
    let dock_index = problem.layout.shared(LOG_DOCK);
    rows.push(row("croup to dock".into(), dock_m * scale, dock_m * shared[LOG_DOCK].exp(), dock_index));
    let head = ["Bone", "Reference, cm", "Fitted, cm", "Difference, cm", "Difference, %"];
    format!(
        "<p class=\"note\">Left and right share their lengths. The reference is the {} scaled by {scale:.3}, which makes it {:.2} m \
         at the withers; percentages in this report refer to {:.3} m. Each length is held to the scaled reference with a standard \
         deviation of {:.0} %; what the points do not tell stays near it. &#8220;Hoof&#8221; is fetlock to toe.</p>\n{}",
        super::page::escape(&skeleton.name),
        fit.fit.withers_height_m(skeleton),
        fit.withers_height_m,
        100.0 * problem.weights.log_length_sd,
        table("numbers", &head, &rows)
    )
}
