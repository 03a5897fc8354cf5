//! Bone lengths: the fitted animal's against the reference horse of the same size.

use muybridge_core::{Limb, Pair, Skeleton, bone};

use super::page::{escape, number, plus_minus, signed, table};
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
        vec![
            name,
            number(100.0 * reference_m, 1),
            fitted_cm,
            signed(100.0 * (fitted_m - reference_m), 1),
            percent,
        ]
    };
    let legs = [Limb::LF, Limb::LH].map(|limb| limb.first_bone()..=limb.hoof_bone());
    let bones = (bone::SPINE..=bone::HEAD).chain(legs.into_iter().flatten());
    let mut rows: Vec<Vec<String>> = bones
        .map(|i| {
            let reference_m = f64::from(skeleton.bones[i].length_m) * scale;
            row(name_of(skeleton, i), reference_m, problem.bone_length_m(i, shared), problem.length_index(i))
        })
        .collect();
    let [x, y] = skeleton.dock_from_croup_m.map(f64::from);
    let dock_m = x.hypot(y);
    let dock_index = problem.layout.shared(LOG_DOCK);
    rows.push(row("croup to dock".into(), dock_m * scale, dock_m * shared[LOG_DOCK].exp(), dock_index));
    let head = ["Bone", "Reference, cm", "Fitted, cm", "Difference, cm", "Difference, %"];
    format!(
        "<p class=\"note\">Left and right share their lengths. The reference is the {} scaled by \
         {scale:.3}, which makes it {:.2} m at the withers; percentages in this report refer to {:.3} m. \
         Each length is held to the scaled reference with a standard deviation of {:.0} %; what the \
         points do not tell stays near it. &#8220;Hoof&#8221; is fetlock to toe.</p>\n{}",
        escape(&skeleton.name),
        fit.fit.withers_height_m(skeleton),
        fit.withers_height_m,
        100.0 * problem.weights.log_length_sd,
        table("numbers", &head, &rows)
    )
}

/// A bone's name; with its pair where fore and hind have a bone of the same name.
fn name_of(skeleton: &Skeleton, bone: usize) -> String {
    let name = &skeleton.bones[bone].name;
    // A bone, its twin on the other side, and any of another pair.
    let namesakes = skeleton.bones.iter().filter(|other| other.name == *name).count();
    match Skeleton::limb_of(bone) {
        Some(limb) if namesakes > 2 => {
            let pair = if limb.pair() == Pair::Fore { "fore" } else { "hind" };
            format!("{pair} {}", escape(name))
        }
        _ => escape(name),
    }
}
