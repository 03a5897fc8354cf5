//! Horses of other proportions: from a pony to very long legs.

use std::sync::Arc;

use muybridge_core::{DataError, Database, Limb, Pose, Repertoire, Skeleton, bone};

/// Factors on the length of the legs.
pub const LEG_FACTORS: [f32; 5] = [0.7, 0.85, 1.0, 1.2, 1.4];
/// Size of the pony: 1.2 m at the withers.
pub const PONY: f32 = 0.75;

/// The skeleton with every leg bone so many times as long, standing on its hind feet as before.
pub fn with_legs(skeleton: &Skeleton, factor: f32) -> Skeleton {
    let mut other = skeleton.clone();
    other.name = format!("{} with legs x {factor:.2}", skeleton.name);
    for limb in Limb::ALL {
        for bone in limb.first_bone()..=limb.hoof_bone() {
            other.bones[bone].length_m *= factor;
        }
    }
    let lowest = |skeleton: &Skeleton| Pose::standing(skeleton).joints(skeleton).toe(Limb::LH).y;
    other.croup_height_m += lowest(skeleton) - lowest(&other);
    other.withers_height_m = Pose::standing(&other).joints(&other).tips[bone::SPINE_LAST].y;
    other
}

/// Every build that is ridden: the reference horse with each of [`LEG_FACTORS`], and the pony.
pub fn all() -> Vec<Skeleton> {
    let reference = Skeleton::reference();
    let mut pony = reference.scaled(PONY);
    pony.name = "pony".into();
    LEG_FACTORS.iter().map(|&factor| with_legs(&reference, factor)).chain([pony]).collect()
}

/// The motion of every build, made ready once.
///
/// # Errors
/// Those of [`Repertoire::new`].
pub fn repertoires(database: &Database) -> Result<Vec<Arc<Repertoire>>, DataError> {
    all().iter().map(|skeleton| Ok(Arc::new(Repertoire::new(database, skeleton)?))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn longer_legs_lift_the_horse_and_leave_its_hind_feet_where_they_were() {
        let reference = Skeleton::reference();
        for skeleton in all() {
            let toe = Pose::standing(&skeleton).joints(&skeleton).toe(Limb::RH);
            assert!(toe.y.abs() < 0.02, "{}: {}", skeleton.name, toe.y);
        }
        let long = with_legs(&reference, 1.4);
        assert!(long.withers_height_m > reference.withers_height_m + 0.5, "{}", long.withers_height_m);
        assert!((with_legs(&reference, 1.0).croup_height_m - reference.croup_height_m).abs() < 1e-6);
    }
}
