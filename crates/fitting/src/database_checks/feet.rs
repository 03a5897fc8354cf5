//! Feet: a standing toe neither slides nor sinks nor floats, stands on its print, and nothing goes through the ground.

use muybridge_core::{Limb, Skeleton, Stride};

use super::{Check, Deviation, STRIDE_SAMPLES, Subject};

/// Poses looked at over a stance, strike and lift-off included.
const STANCE_SAMPLES: usize = 241;
/// A made stride's toe is on the ground to this, m: half the thickness of a shoe, nobody sees it.
const MADE_HEIGHT_M: f64 = 0.005;
/// A made stride's toe keeps its mean place to this, m: below what shows against a texture at the eye's distance.
const MADE_SLIDE_M: f64 = 0.002;
/// A capture is a fit to points that a person placed on a photograph, good to 1 or 2 % of withers height, on soft ground, with instants
/// known to a fraction of a panel: the toe may stand this far over or under the ground, m (3 % of withers height; the worst of the
/// plates, 48 mm, is a hind toe in the dust of 1878).
const CAPTURED_HEIGHT_M: f64 = 0.050;
/// For the same reason the toe may stand this far from its mean place, m (5 % of withers height; the worst is 63 mm).
const CAPTURED_SLIDE_M: f64 = 0.080;
/// Share of a capture's stance at each end that these limits leave out: instants lie between panels, and a galloping hoof whose
/// strike is set a hundredth of a stride too early is still 70 mm away.
const CAPTURED_EDGE: f64 = 0.1;
/// A toe in the air or another joint may be this many times deeper than a standing toe: it is there for an instant.
const PASSING_FACTOR: f64 = 2.0;

/// How far a toe is from standing still on the ground, over one stance or the worst of several, m.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FootErrors {
    /// Farthest from its mean place along the track.
    pub slide_m: f64,
    /// Deepest under the ground.
    pub sink_m: f64,
    /// Highest over the ground.
    pub float_m: f64,
    /// From the stored print to the mean place.
    pub print_m: f64,
}

impl FootErrors {
    /// The greater of each number.
    pub fn worst(self, other: Self) -> Self {
        Self {
            slide_m: self.slide_m.max(other.slide_m),
            sink_m: self.sink_m.max(other.sink_m),
            float_m: self.float_m.max(other.float_m),
            print_m: self.print_m.max(other.print_m),
        }
    }
}

/// Errors of one leg's stance, strike and lift-off included; `reference` is the skeleton that the stride's own animal is scaled from.
pub fn foot_errors(stride: &Stride, reference: &Skeleton, limb: Limb) -> FootErrors {
    of_limb(stride, &stride.skeleton(reference), limb, 0.0)
}

/// The worst of the four legs.
pub fn worst_foot_errors(stride: &Stride, reference: &Skeleton) -> FootErrors {
    let skeleton = stride.skeleton(reference);
    Limb::ALL
        .into_iter()
        .map(|limb| of_limb(stride, &skeleton, limb, 0.0))
        .fold(FootErrors::default(), FootErrors::worst)
}

/// Errors of one leg over its stance without a share `edge` at each end.
fn of_limb(stride: &Stride, skeleton: &Skeleton, limb: Limb, edge: f64) -> FootErrors {
    let contact = stride.contacts[limb.index()];
    let duty = contact.duty_factor();
    let (start, step) = (
        contact.strike_phase + duty * edge as f32,
        duty * (1.0 - 2.0 * edge) as f32 / (STANCE_SAMPLES - 1) as f32,
    );
    let toes: Vec<[f64; 2]> = (0..STANCE_SAMPLES)
        .map(|k| {
            let toe = stride.pose(start + k as f32 * step).joints(skeleton).toe(limb);
            [f64::from(toe.x), f64::from(toe.y)]
        })
        .collect();
    let mean = toes.iter().map(|toe| toe[0]).sum::<f64>() / toes.len() as f64;
    let greatest = |value: &dyn Fn(&[f64; 2]) -> f64| toes.iter().map(value).fold(0.0, f64::max);
    let print = f64::from(stride.pose(0.0).root_in_world.x + stride.prints_m[limb.index()]);
    FootErrors {
        slide_m: greatest(&|toe| (toe[0] - mean).abs()),
        sink_m: greatest(&|toe| -toe[1]),
        float_m: greatest(&|toe| toe[1]),
        print_m: (print - mean).abs(),
    }
}

pub(super) fn check(subject: &Subject<'_>) -> Vec<Deviation> {
    let (height, slide, edge) = if subject.is_captured() {
        (CAPTURED_HEIGHT_M, CAPTURED_SLIDE_M, CAPTURED_EDGE)
    } else {
        (MADE_HEIGHT_M, MADE_SLIDE_M, 0.0)
    };
    let mut deviations = Vec::new();
    for limb in Limb::ALL {
        let errors = of_limb(subject.stride, &subject.skeleton, limb, edge);
        let rows = [
            (Check::ToeSlides, errors.slide_m, slide, "slides from its mean place by"),
            (Check::ToeSinks, errors.sink_m, height, "sinks into the ground by"),
            (Check::ToeFloats, errors.float_m, height, "stands over the ground by"),
            (Check::PrintMisplaced, errors.print_m, slide, "stands away from its stored print by"),
        ];
        for (check, value, limit, what) in rows {
            let text = format!(
                "the toe of {} {what} {:.1} mm in stance; at most {:.0}",
                limb.abbreviation(),
                1e3 * value,
                1e3 * limit
            );
            deviations.extend(subject.require(check, value, [0.0, limit], text));
        }
    }
    deviations.extend(under_ground(subject, PASSING_FACTOR * height));
    deviations
}

/// The deepest joint of the stride, but for standing toes, which have their own limit.
fn under_ground(subject: &Subject<'_>, limit: f64) -> Option<Deviation> {
    let mut deepest = (0.0, 0.0, 0);
    for k in 0..STRIDE_SAMPLES {
        let phase = k as f32 / STRIDE_SAMPLES as f32;
        let (joints, support) =
            (subject.stride.pose(phase).joints(&subject.skeleton), subject.stride.support(phase));
        for (bone, tip) in joints.tips.iter().enumerate() {
            let standing =
                Limb::ALL.into_iter().any(|limb| limb.hoof_bone() == bone && support[limb.index()]);
            let depth = -f64::from(tip.y);
            if depth > deepest.0 && !standing {
                deepest = (depth, phase, bone);
            }
        }
    }
    let (depth, phase, bone) = deepest;
    let name = subject.bone_name(bone);
    let text = format!("the tip of {name} is {:.0} mm under the ground at phase {phase:.2}", 1e3 * depth);
    subject.require(Check::UnderGround, depth, [0.0, limit], text)
}

#[cfg(test)]
mod tests {
    use muybridge_core::{Provenance, SpeedSource};

    use super::super::specimen::{Specimen, checks_of};
    use super::*;

    #[test]
    fn a_good_trot_stands_still() {
        let errors = worst_foot_errors(&Specimen::trot().stride(), &Skeleton::reference());
        assert!(errors.slide_m < 0.5 * MADE_SLIDE_M && errors.sink_m < 0.5 * MADE_HEIGHT_M, "{errors:?}");
    }

    #[test]
    fn a_toe_that_slides_5_mm_is_found() {
        let stride = Specimen { toe_slide_m: 0.005, ..Specimen::trot() }.stride();
        assert_eq!(checks_of(&stride), [Check::ToeSlides]);
    }

    #[test]
    fn a_toe_8_mm_under_or_over_the_ground_is_found() {
        let at = |toe_height_m| Specimen { toe_height_m, ..Specimen::trot() }.stride();
        assert_eq!(checks_of(&at(-0.008)), [Check::ToeSinks]);
        assert_eq!(checks_of(&at(0.008)), [Check::ToeFloats]);
    }

    #[test]
    fn a_capture_may_scatter_as_placed_points_do() {
        let provenance = Provenance::Captured {
            plates: vec!["a plate".into()],
            annotations_sha256: vec![String::new()],
            speed: SpeedSource::Stated,
        };
        let at = |toe_height_m| Stride {
            provenance: provenance.clone(),
            ..Specimen { toe_height_m, ..Specimen::trot() }.stride()
        };
        assert_eq!(checks_of(&at(0.03)), []);
        assert_eq!(checks_of(&at(0.07)), [Check::ToeFloats]);
    }

    #[test]
    fn a_print_beside_the_toe_and_a_hoof_that_swings_through_the_ground_are_found() {
        let mut beside = Specimen::trot().stride();
        beside.prints_m[2] += 0.004;
        assert_eq!(checks_of(&beside), [Check::PrintMisplaced]);
        let through = Specimen { clearance_m: -0.05, ..Specimen::trot() }.stride();
        assert_eq!(checks_of(&through), [Check::UnderGround]);
    }
}
