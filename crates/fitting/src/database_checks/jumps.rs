//! Bends: none of a made stride snaps from one sample to the next.

use muybridge_core::{CURVE_SAMPLES, Database, Provenance, Skeleton, Stride};

use super::{Check, Deviation, body, bone_name, require};

/// A bend of a made stride may change this many times as fast as the fastest of the stride it comes from would at its pace: its toes
/// must stand where those of a photograph slide by some centimetres, and stretched legs turn for it.
const FACTOR: f64 = 2.0;
/// Change between two samples that is allowed in any case, rad: one degree.
const FLOOR_RAD: f64 = std::f64::consts::PI / 180.0;

/// Made strides with a bend that changes faster than any of the stride they come from.
pub(super) fn check(database: &Database, reference: &Skeleton) -> Vec<Deviation> {
    let strides = || database.strides.iter().filter(|stride| body::not_finite(stride).is_none());
    let source_of = |stride: &Stride| {
        let Provenance::Derived { from, .. } = &stride.provenance else { return None };
        strides().find(|source| from.contains(&source.id))
    };
    strides().filter_map(|stride| bend_jump(stride, source_of(stride)?, reference)).collect()
}

/// The greatest change of a bend between two samples, against what it is in the source at an equal pace.
fn bend_jump(stride: &Stride, source: &Stride, reference: &Skeleton) -> Option<Deviation> {
    let found = greatest_change(stride);
    // Swings last as long at every speed; under a faster body standing legs turn faster.
    let pace = f64::from(stride.speed_m_s / source.speed_m_s).max(1.0);
    let sample_ratio = f64::from(stride.stride_time_s / source.stride_time_s);
    let allowed_rad = FACTOR * pace * sample_ratio * greatest_change(source).change_rad + FLOOR_RAD;
    let text = format!(
        "{} turns by {:.1} degrees from phase {:.3} to the next sample; {} leaves it {:.1}",
        bone_name(reference, found.bone),
        found.change_rad.to_degrees(),
        found.sample as f64 / CURVE_SAMPLES as f64,
        source.id,
        allowed_rad.to_degrees()
    );
    require(stride, Check::BendJump, found.change_rad, [0.0, allowed_rad], text)
}

/// A bend's change from one sample to the next.
struct Change {
    change_rad: f64,
    bone: usize,
    sample: usize,
}

fn greatest_change(stride: &Stride) -> Change {
    let mut greatest = Change { change_rad: 0.0, bone: 0, sample: 0 };
    for (bone, curve) in stride.curves.bends_rad.iter().enumerate() {
        for sample in 0..curve.len() {
            let change_rad = f64::from((curve[(sample + 1) % curve.len()] - curve[sample]).abs());
            if change_rad > greatest.change_rad {
                greatest = Change { change_rad, bone, sample };
            }
        }
    }
    greatest
}

#[cfg(test)]
mod tests {
    use muybridge_core::Limb;

    use super::super::specimen::{Specimen, checks_of_all};
    use super::*;

    /// A gallop and the same one made from it.
    fn family() -> [Stride; 2] {
        let source = Stride { id: "plate".into(), ..Specimen::gallop().stride() };
        let provenance = Provenance::Derived { from: vec!["plate".into()], how: "made for a test".into() };
        [source.clone(), Stride { id: "plate@19mph".into(), provenance, ..source }]
    }

    #[test]
    fn a_hoof_that_snaps_in_swing_is_found() {
        let [source, mut made] = family();
        assert_eq!(checks_of_all(&[source.clone(), made.clone()]), []);
        let contact = made.contacts[Limb::LF.index()];
        let middle = contact.lift_off_phase + 0.5 * (1.0 - contact.duty_factor());
        let sample = (middle * CURVE_SAMPLES as f32) as usize % CURVE_SAMPLES;
        let bends = &mut made.curves.bends_rad[Limb::LF.hoof_bone()];
        bends[sample] -= 0.5;
        assert_eq!(checks_of_all(&[source, made]), [Check::BendJump]);
    }

    #[test]
    fn a_stride_played_faster_is_no_jump() {
        let [source, mut made] = family();
        let faster = |stride: &Stride| bend_jump(stride, &source, &Skeleton::reference()).is_some();
        made.speed_m_s *= 1.5;
        assert!(!faster(&made));
        made.stride_time_s *= 0.2;
        assert!(faster(&made), "the same change in a fifth of the time");
    }
}
