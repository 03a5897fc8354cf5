//! The skeleton: 28 bones, their proportions, limits and couplings, all of it data (Huang 2012, section 3.1).

use serde::{Deserialize, Serialize};

use crate::database::DataError;
use crate::limb::{Limb, Side};

/// Schema version of a skeleton file.
pub const SKELETON_SCHEMA: u32 = 1;
/// Number of bones.
pub const BONE_COUNT: usize = 28;
/// Number of bones of spine, neck and head; they come first.
pub const BODY_BONE_COUNT: usize = bone::LIMBS;

/// Bone indices. The legs follow the body in the order of [`Limb::ALL`], five bones each, root to hoof.
pub mod bone {
    /// First of four spine bones, croup to withers.
    pub const SPINE: usize = 0;
    /// Last spine bone; its tip is the withers.
    pub const SPINE_LAST: usize = 3;
    /// First of three neck bones.
    pub const NECK: usize = 4;
    /// Last neck bone; its tip is the poll.
    pub const NECK_LAST: usize = 6;
    /// Head; its tip is the muzzle.
    pub const HEAD: usize = 7;
    /// First bone of the first leg.
    pub const LIMBS: usize = 8;
}

/// One bone.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Bone {
    /// Anatomical name, the same on both sides.
    pub name: String,
    /// Parent bone, none where the bone hangs on the root (first spine bone and both pelves).
    pub parent: Option<usize>,
    /// Length in metres in the sagittal plane.
    pub length_m: f32,
    /// Bend from straight in the standing pose, radians.
    pub rest_bend_rad: f32,
    /// Least and greatest bend from straight, radians.
    pub limits_rad: [f32; 2],
    /// Distance of the bone's tip from the median plane, metres, positive to the horse's right.
    pub lateral_m: f32,
    /// Share of the body's mass, 0 to 1.
    pub mass_fraction: f32,
}

/// Reciprocal apparatus of the hind limb: hock and stifle flex together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReciprocalCoupling {
    /// Hock bend from rest per stifle bend from rest; negative, because the two bend in opposite senses.
    pub ratio: f32,
    /// Standard deviation of the hock bend about that line, radians.
    pub sd_rad: f32,
}

/// The passive fetlock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FetlockCoupling {
    /// Expected bend under load, radians (dorsiflexion positive).
    pub stance_bend_rad: f32,
    /// Standard deviation of the loaded bend, radians.
    pub stance_sd_rad: f32,
    /// Standard deviation of the unloaded bend, radians.
    pub swing_sd_rad: f32,
    /// Unloaded bend of the fore fetlock.
    pub fore: SwingFetlock,
    /// Unloaded bend of the hind fetlock.
    pub hind: SwingFetlock,
}

/// Bend of a fetlock in the air: `swing_bend + per_upper * upper + per_cannon * cannon`, the bends from rest of the
/// limb's second bone (humerus, femur) and of its cannon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SwingFetlock {
    /// Bend while the limb is otherwise at rest, radians (dorsiflexion positive).
    pub swing_bend_rad: f32,
    /// Share of the second bone's bend from rest.
    pub per_upper_bend: f32,
    /// Share of the cannon's bend from rest.
    pub per_cannon_bend: f32,
}

/// A horse's proportions and limits. [`Skeleton::reference`] is compiled in; any other is a file of the same form.
#[derive(Clone, Debug, PartialEq)]
pub struct Skeleton {
    /// Name for people.
    pub name: String,
    /// Height of the withers in the standing pose, metres.
    pub withers_height_m: f32,
    /// Height of the root (top of the croup) in the standing pose, metres.
    pub croup_height_m: f32,
    /// Root of the tail seen from the root joint, in the root's frame, metres.
    pub dock_from_croup_m: [f32; 2],
    /// Where the scapula hangs, seen from the withers in the frame of the last spine bone, metres.
    pub scapula_attachment_from_withers_m: [f32; 2],
    /// How far the scapula slides along the rib cage, metres (there is no clavicle).
    pub scapula_slide_limits_m: [f32; 2],
    /// The 28 bones.
    pub bones: Vec<Bone>,
    /// Stifle and hock.
    pub reciprocal: ReciprocalCoupling,
    /// Fetlock and load.
    pub fetlock: FetlockCoupling,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SkeletonFile {
    schema: u32,
    name: String,
    #[serde(rename = "about")]
    _about: String,
    withers_height_m: f32,
    croup_height_m: f32,
    dock_from_croup_m: [f32; 2],
    scapula_attachment_from_withers_m: [f32; 2],
    scapula_slide_limits_m: [f32; 2],
    body: [BoneFile; 8],
    fore: [BoneFile; 5],
    hind: [BoneFile; 5],
    reciprocal: ReciprocalFile,
    fetlock: FetlockFile,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct BoneFile {
    name: String,
    length_m: f32,
    rest_bend_deg: f32,
    limits_deg: [f32; 2],
    lateral_m: f32,
    mass_fraction: f32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ReciprocalFile {
    #[serde(rename = "about")]
    _about: String,
    ratio: f32,
    sd_deg: f32,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct FetlockFile {
    #[serde(rename = "about")]
    _about: String,
    stance_bend_deg: f32,
    stance_sd_deg: f32,
    swing_sd_deg: f32,
    fore: SwingFetlockFile,
    hind: SwingFetlockFile,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SwingFetlockFile {
    swing_bend_deg: f32,
    per_upper_bend: f32,
    per_cannon_bend: f32,
}

impl SwingFetlockFile {
    fn coupling(&self) -> SwingFetlock {
        SwingFetlock {
            swing_bend_rad: self.swing_bend_deg.to_radians(),
            per_upper_bend: self.per_upper_bend,
            per_cannon_bend: self.per_cannon_bend,
        }
    }
}

impl BoneFile {
    fn bone(&self, parent: Option<usize>, side_sign: f32) -> Bone {
        Bone {
            name: self.name.clone(),
            parent,
            length_m: self.length_m,
            rest_bend_rad: self.rest_bend_deg.to_radians(),
            limits_rad: self.limits_deg.map(f32::to_radians),
            lateral_m: side_sign * self.lateral_m,
            mass_fraction: self.mass_fraction,
        }
    }
}

impl Skeleton {
    /// The reference horse: 1.60 m at the withers, proportions of a light riding horse.
    pub fn reference() -> Self {
        Self::from_json(include_str!("../data/horse.json"))
            .unwrap_or_else(|error| unreachable!("the compiled-in skeleton is tested: {error}"))
    }

    /// Reads a skeleton file.
    ///
    /// # Errors
    /// When the text is no JSON of this form, has another schema, or holds a length that is not positive,
    /// limits in the wrong order, or a rest bend outside its limits.
    pub fn from_json(text: &str) -> Result<Self, DataError> {
        let file: SkeletonFile = serde_json::from_str(text).map_err(DataError::Parse)?;
        if file.schema != SKELETON_SCHEMA {
            return Err(DataError::Schema { found: file.schema, expected: SKELETON_SCHEMA });
        }
        let skeleton = file.into_skeleton();
        skeleton.validate()?;
        Ok(skeleton)
    }

    fn validate(&self) -> Result<(), DataError> {
        for (index, bone) in self.bones.iter().enumerate() {
            let [low, high] = bone.limits_rad;
            let fault = if !(bone.length_m > 0.0 && bone.length_m.is_finite()) {
                "length_m must be positive"
            } else if low.is_nan() || high.is_nan() || low >= high {
                "limits_deg must be two rising angles"
            } else if !(low..=high).contains(&bone.rest_bend_rad) {
                "rest_bend_deg must lie within limits_deg"
            } else {
                continue;
            };
            return Err(DataError::Invalid(format!("bone {index} ({}): {fault}", bone.name)));
        }
        Ok(())
    }

    /// The leg a bone belongs to, none for the body's eight.
    pub fn limb_of(bone: usize) -> Option<Limb> {
        bone.checked_sub(bone::LIMBS).map(|offset| Limb::ALL[offset / 5])
    }

    /// The same horse with every length multiplied by `factor`.
    pub fn scaled(&self, factor: f32) -> Self {
        let mut scaled = self.clone();
        scaled.withers_height_m *= factor;
        scaled.croup_height_m *= factor;
        scaled.dock_from_croup_m = self.dock_from_croup_m.map(|v| v * factor);
        scaled.scapula_attachment_from_withers_m = self.scapula_attachment_from_withers_m.map(|v| v * factor);
        scaled.scapula_slide_limits_m = self.scapula_slide_limits_m.map(|v| v * factor);
        for bone in &mut scaled.bones {
            bone.length_m *= factor;
            bone.lateral_m *= factor;
        }
        scaled
    }
}

impl SkeletonFile {
    fn into_skeleton(self) -> Skeleton {
        let body = self.body.iter().enumerate().map(|(i, b)| b.bone(i.checked_sub(1), 0.0));
        let legs = Limb::ALL.into_iter().flat_map(|limb| {
            let (chain, parent) = match limb.pair() {
                crate::Pair::Fore => (&self.fore, Some(bone::SPINE_LAST)),
                crate::Pair::Hind => (&self.hind, None),
            };
            let sign = if limb.side() == Side::Right { 1.0 } else { -1.0 };
            let first = limb.first_bone();
            chain
                .iter()
                .enumerate()
                .map(move |(i, b)| b.bone(if i == 0 { parent } else { Some(first + i - 1) }, sign))
        });
        let bones = body.chain(legs).collect();
        Skeleton {
            name: self.name,
            withers_height_m: self.withers_height_m,
            croup_height_m: self.croup_height_m,
            dock_from_croup_m: self.dock_from_croup_m,
            scapula_attachment_from_withers_m: self.scapula_attachment_from_withers_m,
            scapula_slide_limits_m: self.scapula_slide_limits_m,
            bones,
            reciprocal: ReciprocalCoupling {
                ratio: self.reciprocal.ratio,
                sd_rad: self.reciprocal.sd_deg.to_radians(),
            },
            fetlock: FetlockCoupling {
                stance_bend_rad: self.fetlock.stance_bend_deg.to_radians(),
                stance_sd_rad: self.fetlock.stance_sd_deg.to_radians(),
                swing_sd_rad: self.fetlock.swing_sd_deg.to_radians(),
                fore: self.fetlock.fore.coupling(),
                hind: self.fetlock.hind.coupling(),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pose;

    #[test]
    fn reference_has_28_bones_in_parent_first_order() {
        let horse = Skeleton::reference();
        assert_eq!(horse.bones.len(), BONE_COUNT);
        for (i, bone) in horse.bones.iter().enumerate() {
            assert!(bone.parent.is_none_or(|parent| parent < i), "{}", bone.name);
        }
        let mass: f32 = horse.bones.iter().map(|b| b.mass_fraction).sum();
        assert!((mass - 1.0).abs() < 1e-5, "mass fractions add up to {mass}");
    }

    #[test]
    fn left_and_right_mirror_each_other() {
        let horse = Skeleton::reference();
        for (left, right) in [(Limb::LF, Limb::RF), (Limb::LH, Limb::RH)] {
            for i in 0..5 {
                let (l, r) = (&horse.bones[left.first_bone() + i], &horse.bones[right.first_bone() + i]);
                assert_eq!((l.length_m, l.lateral_m), (r.length_m, -r.lateral_m));
            }
        }
    }

    #[test]
    fn standing_reference_horse_has_its_hooves_on_the_ground_and_its_withers_at_height() {
        let horse = Skeleton::reference();
        let joints = Pose::standing(&horse).joints(&horse);
        for limb in Limb::ALL {
            let toe = joints.toe(limb);
            assert!(toe.y.abs() < 0.02, "{limb:?} toe at {toe}");
        }
        assert!((joints.tips[bone::SPINE_LAST].y - horse.withers_height_m).abs() < 0.02);
    }

    #[test]
    fn bad_skeletons_are_refused_with_the_bone_named() {
        let good = include_str!("../data/horse.json");
        let bad = good.replacen("\"length_m\": 0.42", "\"length_m\": -0.42", 1);
        assert!(Skeleton::from_json(&bad).unwrap_err().to_string().contains("radius"));
        let old = good.replacen("\"schema\": 1", "\"schema\": 7", 1);
        assert!(matches!(Skeleton::from_json(&old), Err(DataError::Schema { found: 7, expected: 1 })));
    }
}
