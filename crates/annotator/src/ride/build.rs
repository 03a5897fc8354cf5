//! The proportions of a ridden horse: the reference horse with other legs, trunk, neck or size.

use std::ops::RangeInclusive;

use glam::Vec3;
use muybridge_core::{Limb, Pair, Pose, Skeleton, bone};

/// Bones of a leg that belong to the trunk: the scapula and the pelvis.
const GIRDLE_BONES: usize = 1;

/// Factors against the reference horse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Build {
    /// Length of the legs below scapula and pelvis.
    pub legs: f32,
    /// Length of the trunk, croup to withers.
    pub trunk: f32,
    /// Length of the neck.
    pub neck: f32,
    /// Size of the whole horse.
    pub size: f32,
}

impl Default for Build {
    fn default() -> Self {
        Self { legs: 1.0, trunk: 1.0, neck: 1.0, size: 1.0 }
    }
}

impl Build {
    /// Shortest and longest legs.
    pub const LEGS: RangeInclusive<f32> = 0.6..=1.5;
    /// Shortest and longest trunk.
    pub const TRUNK: RangeInclusive<f32> = 0.8..=1.3;
    /// Shortest and longest neck.
    pub const NECK: RangeInclusive<f32> = 0.7..=1.4;
    /// Smallest and largest horse.
    pub const SIZE: RangeInclusive<f32> = 0.5..=1.4;

    /// The horse of these proportions, standing with all four hooves on one ground: a longer trunk lifts the withers, so the
    /// forelegs grow by what that asks for.
    pub fn skeleton(&self, reference: &Skeleton) -> Skeleton {
        let mut skeleton = reference.clone();
        let spine = &mut skeleton.bones[bone::SPINE..=bone::SPINE_LAST];
        spine.iter_mut().for_each(|spine| spine.length_m *= self.trunk);
        let neck = &mut skeleton.bones[bone::NECK..=bone::NECK_LAST];
        neck.iter_mut().for_each(|neck| neck.length_m *= self.neck);
        scale_legs(&mut skeleton, Pair::Hind, self.legs);
        scale_legs(&mut skeleton, Pair::Fore, self.legs);
        let [fore_m, hind_m] = [Limb::LF, Limb::LH].map(|limb| toe_from_croup(&skeleton, limb).y);
        let [as_fore_m, as_hind_m] = [Limb::LF, Limb::LH].map(|limb| toe_from_croup(reference, limb).y);
        let mut legless = skeleton.clone();
        scale_legs(&mut legless, Pair::Fore, 0.0);
        // A toe's height is linear in the length of its leg.
        let elbow_m = toe_from_croup(&legless, Limb::LF).y;
        let wanted_m = hind_m + (as_fore_m - as_hind_m);
        scale_legs(&mut skeleton, Pair::Fore, (wanted_m - elbow_m) / (fore_m - elbow_m));
        skeleton.croup_height_m += as_hind_m - hind_m;
        let withers = Pose::standing(&skeleton).joints(&skeleton).tips[bone::SPINE_LAST];
        let as_withers = Pose::standing(reference).joints(reference).tips[bone::SPINE_LAST];
        skeleton.withers_height_m += withers.y - as_withers.y;
        skeleton.scaled(self.size)
    }
}

fn scale_legs(skeleton: &mut Skeleton, pair: Pair, factor: f32) {
    for limb in Limb::ALL.into_iter().filter(|limb| limb.pair() == pair) {
        let bones = limb.first_bone() + GIRDLE_BONES..=limb.hoof_bone();
        skeleton.bones[bones].iter_mut().for_each(|bone| bone.length_m *= factor);
    }
}

/// A toe of the standing horse, seen from the croup, metres.
fn toe_from_croup(skeleton: &Skeleton, limb: Limb) -> Vec3 {
    let joints = Pose::standing(skeleton).joints(skeleton);
    joints.toe(limb) - joints.root
}

/// Height of the hip of the standing horse above the ground, metres: what Froude numbers are counted with.
pub fn hip_height_m(skeleton: &Skeleton) -> f32 {
    Pose::standing(skeleton).joints(skeleton).tips[Limb::LH.first_bone()].y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_change_is_the_reference_horse() {
        let reference = Skeleton::reference();
        let same = Build::default().skeleton(&reference);
        for (a, b) in reference.bones.iter().zip(&same.bones) {
            assert!((a.length_m - b.length_m).abs() < 1e-5, "{}", a.name);
        }
        assert!((same.croup_height_m - reference.croup_height_m).abs() < 1e-5);
    }

    #[test]
    fn every_build_stands_on_its_four_hooves() {
        let reference = Skeleton::reference();
        let ends = |range: RangeInclusive<f32>| [*range.start(), *range.end()];
        for legs in ends(Build::LEGS) {
            for trunk in ends(Build::TRUNK) {
                for size in ends(Build::SIZE) {
                    let skeleton = Build { legs, trunk, neck: 1.0, size }.skeleton(&reference);
                    let joints = Pose::standing(&skeleton).joints(&skeleton);
                    for limb in Limb::ALL {
                        assert!(joints.toe(limb).y.abs() < 0.03, "{legs} {trunk} {size} {limb:?}");
                    }
                    let withers = joints.tips[bone::SPINE_LAST].y;
                    assert!((withers - skeleton.withers_height_m).abs() < 0.03);
                    assert!(hip_height_m(&skeleton) > 0.2);
                }
            }
        }
    }

    #[test]
    fn longer_legs_lift_the_croup_by_what_they_grow() {
        let reference = Skeleton::reference();
        let tall = Build { legs: 1.5, ..Build::default() }.skeleton(&reference);
        let hip = hip_height_m(&reference);
        assert!((tall.croup_height_m - reference.croup_height_m - 0.5 * hip).abs() < 0.03);
    }
}
