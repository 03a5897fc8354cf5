//! The horse of a ride: a skeleton file, long or short legs, large or small.

use anyhow::Context;
use muybridge_capture::read_text;
use muybridge_core::{Limb, Pose, Skeleton, bone};

use super::RideScript;

impl RideScript {
    /// The skeleton of the ride's horse.
    ///
    /// # Errors
    /// When its file cannot be read or is no skeleton.
    pub fn skeleton(&self) -> anyhow::Result<Skeleton> {
        let skeleton = match &self.skeleton {
            Some(path) => {
                Skeleton::from_json(&read_text(path)?).with_context(|| path.display().to_string())?
            }
            None => Skeleton::reference(),
        };
        Ok(with_legs(skeleton, self.legs).scaled(self.size))
    }
}

/// The same horse with all leg bones `factor` times as long, the trunk let down or lifted so that its hooves stand on the ground.
fn with_legs(mut skeleton: Skeleton, factor: f32) -> Skeleton {
    let sole_height = |skeleton: &Skeleton| {
        let joints = Pose::standing(skeleton).joints(skeleton);
        Limb::ALL.map(|limb| joints.toe(limb).y).iter().sum::<f32>() / 4.0
    };
    let before_m = sole_height(&skeleton);
    for bone in &mut skeleton.bones[bone::LIMBS..] {
        bone.length_m *= factor;
    }
    let lowered_m = sole_height(&skeleton) - before_m;
    skeleton.croup_height_m -= lowered_m;
    skeleton.withers_height_m -= lowered_m;
    skeleton
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_horse_with_other_legs_still_stands_on_the_ground() {
        let reference = Skeleton::reference();
        for factor in [0.6, 1.0, 1.4] {
            let horse = with_legs(reference.clone(), factor);
            let joints = Pose::standing(&horse).joints(&horse);
            for limb in Limb::ALL {
                let toe = joints.toe(limb);
                assert!(toe.y.abs() < 0.08, "{factor}: {limb:?} toe at {toe}");
            }
            assert!((joints.root.y - horse.croup_height_m).abs() < 1e-6);
        }
        assert!(with_legs(reference.clone(), 0.6).croup_height_m < 0.75 * reference.croup_height_m);
    }
}
