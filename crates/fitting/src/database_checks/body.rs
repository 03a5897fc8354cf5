//! The body: numbers are finite, curves close, joints keep their limits and bones their lengths.

use muybridge_core::{BONE_COUNT, Database, Limb, Skeleton, Stride};

use super::{Check, Deviation, STRIDE_SAMPLES, Subject, family, require};

/// Greatest difference of the poses at phases 0 and 1 but for the advance, m and rad.
const CLOSING: f64 = 1e-6;
/// A curve may bend at the seam this many times as sharply as at its sharpest elsewhere, on this leg or its twin.
const SEAM_FACTOR: f64 = 2.0;
/// Second difference that is allowed at the seam in any case, m and rad: 0.3 mm or degrees over a sample.
const SEAM_FLOOR: f64 = 0.005;
/// Bends may pass a limit by this, rad: half a degree, for curves overshoot between their samples.
const BEND_TOLERANCE_RAD: f64 = 0.5 * std::f64::consts::PI / 180.0;
/// A capture's curves are drawn through poses a tenth of a stride apart, which keep the limits; between them they may pass by
/// this, rad: 3 degrees.
const CAPTURED_BEND_TOLERANCE_RAD: f64 = 6.0 * BEND_TOLERANCE_RAD;
/// The scapula may pass the end of its slide by this, m.
const SLIDE_TOLERANCE_M: f64 = 0.002;
/// Greatest change of a bone's length, m.
const LENGTH_TOLERANCE_M: f64 = 1e-4;

/// The first number that is infinite or none.
pub(super) fn not_finite(stride: &Stride) -> Option<Deviation> {
    let curves = stride.curves.channels().flatten();
    let edges = stride.contacts.iter().flat_map(|c| [&c.strike_phase, &c.lift_off_phase]);
    let scalars = [&stride.speed_m_s, &stride.stride_time_s, &stride.withers_height_m];
    let mut numbers =
        curves.chain(&stride.bone_lengths_m).chain(edges).chain(&stride.prints_m).chain(scalars);
    let value = f64::from(*numbers.find(|number| !number.is_finite())?);
    let text = format!("a number of this stride is {value}");
    Some(Deviation {
        stride: stride.id.clone(),
        gait: stride.gait,
        check: Check::NotFinite,
        value,
        allowed: [f64::from(f32::MIN), f64::from(f32::MAX)],
        text,
    })
}

pub(super) fn check(subject: &Subject<'_>) -> Vec<Deviation> {
    let mut deviations = Vec::new();
    deviations.extend(poses_meet(subject));
    deviations.extend(seam(subject));
    deviations.extend(bends(subject));
    deviations.extend(slides(subject));
    deviations.extend(lengths(subject));
    deviations
}

/// The pose at phase 1 is the pose at phase 0, one stride on.
fn poses_meet(subject: &Subject<'_>) -> Option<Deviation> {
    let (start, end) = (subject.stride.pose(0.0), subject.stride.pose(1.0));
    let advance = end.root_in_world - start.root_in_world;
    let bends = start.bends_rad.iter().zip(&end.bends_rad).map(|(a, b)| f64::from(b - a));
    let slides = start.scapula_slides_m.iter().zip(&end.scapula_slides_m).map(|(a, b)| f64::from(b - a));
    let root = [
        f64::from(advance.x) - f64::from(subject.stride.stride_length_m()),
        f64::from(advance.y),
        f64::from(advance.z),
        2.0 * f64::from((start.world_from_root - end.world_from_root).length()),
    ];
    let gap = bends.chain(slides).chain(root).map(f64::abs).fold(0.0, f64::max);
    let text = format!("the end of the stride misses its beginning by {gap:.2e} m or rad");
    subject.require(Check::NotClosed, gap, [0.0, CLOSING], text)
}

/// No curve is bent at the seam as it is nowhere else: the sign of a motion that was cut open and closed by force.
fn seam(subject: &Subject<'_>) -> Option<Deviation> {
    let curves = &subject.stride.curves;
    let single = [("surge", &curves.surge_m), ("height", &curves.height_m), ("pitch", &curves.pitch_rad)];
    let slides = &curves.scapula_slides_m;
    let paired = [("left slide", &slides[0], &slides[1]), ("right slide", &slides[1], &slides[0])];
    let bends = &curves.bends_rad;
    let named = single.map(|(name, curve)| (name.to_string(), curve, curve)).into_iter();
    let all = named
        .chain(paired.map(|(name, curve, other)| (name.to_string(), curve, other)))
        .chain((0..BONE_COUNT).map(|bone| (subject.bone_name(bone), &bends[bone], &bends[twin(bone)])));
    let (name, found, allowed) = all
        .map(|(name, curve, twin)| {
            let sharpest = sharpest_inside(curve).max(sharpest_inside(twin));
            (name, at_seam(curve), SEAM_FACTOR * sharpest + SEAM_FLOOR)
        })
        .max_by(|a, b| (a.1 / a.2).total_cmp(&(b.1 / b.2)))?;
    let text =
        format!("the curve of {name} turns by {found:.4} at the seam, elsewhere by less than {allowed:.4}");
    subject.require(Check::NotClosed, found, [0.0, allowed], text)
}

/// The same bone on the other side; a bone of the trunk itself.
fn twin(bone: usize) -> usize {
    Skeleton::limb_of(bone).map_or(bone, |limb| {
        Limb::new(limb.pair(), limb.side().opposite()).first_bone() + bone - limb.first_bone()
    })
}

fn second_difference(curve: &[f32], k: usize) -> f64 {
    let n = curve.len();
    let at = |k: usize| f64::from(curve[k % n]);
    (at(k + n - 1) - 2.0 * at(k) + at(k + 1)).abs()
}

fn at_seam(curve: &[f32]) -> f64 {
    second_difference(curve, 0).max(second_difference(curve, curve.len() - 1))
}

fn sharpest_inside(curve: &[f32]) -> f64 {
    (1..curve.len() - 1).map(|k| second_difference(curve, k)).fold(0.0, f64::max)
}

/// Bends outside the skeleton's limits, the worst of each bone.
fn bends(subject: &Subject<'_>) -> Vec<Deviation> {
    let tolerance = if subject.is_captured() { CAPTURED_BEND_TOLERANCE_RAD } else { BEND_TOLERANCE_RAD };
    let mut ranges = [[f64::INFINITY, f64::NEG_INFINITY]; BONE_COUNT];
    for k in 0..STRIDE_SAMPLES {
        let pose = subject.stride.pose(k as f32 / STRIDE_SAMPLES as f32);
        for (range, &bend) in ranges.iter_mut().zip(&pose.bends_rad) {
            *range = [range[0].min(f64::from(bend)), range[1].max(f64::from(bend))];
        }
    }
    let bones = subject.skeleton.bones.iter().enumerate().zip(ranges);
    bones
        .flat_map(|((index, bone), range)| {
            let [low, high] = bone.limits_rad.map(f64::from);
            range.map(|bend| {
                let text = format!(
                    "{} bends to {:.1} degrees; its limits are {:.0} to {:.0}",
                    subject.bone_name(index),
                    bend.to_degrees(),
                    low.to_degrees(),
                    high.to_degrees()
                );
                let allowed = [low - tolerance, high + tolerance];
                subject.require(Check::BendLimit, bend, allowed, text)
            })
        })
        .flatten()
        .collect()
}

/// Scapulae slid beyond the rib cage.
fn slides(subject: &Subject<'_>) -> Vec<Deviation> {
    let [low, high] = subject.skeleton.scapula_slide_limits_m.map(f64::from);
    let curves = subject.stride.curves.scapula_slides_m.iter();
    curves
        .filter_map(|curve| {
            let farthest = curve.iter().copied().map(f64::from).max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
            let text = format!(
                "a scapula slides {:.0} mm; at most {:.0} to {:.0}",
                1e3 * farthest,
                1e3 * low,
                1e3 * high
            );
            subject.require(
                Check::BendLimit,
                farthest,
                [low - SLIDE_TOLERANCE_M, high + SLIDE_TOLERANCE_M],
                text,
            )
        })
        .collect()
}

/// The bone whose length in the sagittal plane differs most from the stored one, over the whole stride.
fn lengths(subject: &Subject<'_>) -> Option<Deviation> {
    let mut worst = (0.0, 0);
    for k in 0..STRIDE_SAMPLES {
        let joints = subject.stride.pose(k as f32 / STRIDE_SAMPLES as f32).joints(&subject.skeleton);
        for bone in 0..BONE_COUNT {
            let along = joints.tips[bone] - joints.bases[bone];
            let error = (f64::from(along.x).hypot(f64::from(along.y))
                - f64::from(subject.stride.bone_lengths_m[bone]))
            .abs();
            if error > worst.0 {
                worst = (error, bone);
            }
        }
    }
    let (error, bone) = worst;
    let text = format!("{} changes its length by {:.2} mm", subject.bone_name(bone), 1e3 * error);
    subject.require(Check::BoneLength, error, [0.0, LENGTH_TOLERANCE_M], text)
}

/// Strides of one plate are one animal: bone lengths are the same at every speed.
pub(super) fn check_families(database: &Database) -> Vec<Deviation> {
    let first_of = |stride: &Stride| database.strides.iter().find(|other| family(other) == family(stride));
    let strides = database.strides.iter().filter(|stride| not_finite(stride).is_none());
    strides
        .filter_map(|stride| {
            let lengths = stride.bone_lengths_m.iter().zip(&first_of(stride)?.bone_lengths_m);
            let error = lengths.map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
            let text =
                format!("a bone is {:.2} mm longer or shorter than at the plate's other speeds", 1e3 * error);
            require(stride, Check::BoneLength, error, [0.0, LENGTH_TOLERANCE_M], text)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::specimen::{Specimen, checks_of, checks_of_all};
    use super::*;

    #[test]
    fn a_curve_that_does_not_close_is_found() {
        let mut stride = Specimen::trot().stride();
        let neck = &mut stride.curves.bends_rad[muybridge_core::bone::NECK];
        let n = neck.len() as f32;
        neck.iter_mut().enumerate().for_each(|(k, bend)| *bend += 0.02 * k as f32 / n);
        assert_eq!(checks_of(&stride), [Check::NotClosed]);
    }

    #[test]
    fn a_joint_beyond_its_limit_and_a_number_that_is_none_are_found() {
        let mut stride = Specimen::trot().stride();
        stride.curves.bends_rad[muybridge_core::bone::HEAD].fill(-0.5);
        assert_eq!(checks_of(&stride), [Check::BendLimit]);
        stride.curves.bends_rad[3][7] = f32::NAN;
        assert_eq!(checks_of(&stride), [Check::NotFinite]);
    }

    #[test]
    fn a_horse_whose_bones_grow_with_speed_is_found() {
        let slow = Specimen::trot().stride();
        let mut fast = Specimen { id: "trot@8mph", ..Specimen::trot() }.stride();
        assert_eq!(checks_of_all(&[slow.clone(), fast.clone()]), []);
        fast.bone_lengths_m[muybridge_core::bone::HEAD] += 0.01;
        assert_eq!(checks_of_all(&[slow, fast]), [Check::BoneLength]);
    }

    #[test]
    fn a_bone_of_negative_length_is_found() {
        let mut stride = Specimen::trot().stride();
        stride.bone_lengths_m[muybridge_core::bone::HEAD] *= -1.0;
        assert_eq!(checks_of(&stride), [Check::BoneLength]);
    }
}
