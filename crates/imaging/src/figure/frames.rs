//! A frame for every bone, found from the joints alone.
//!
//! Bones are straight lines: how each is turned about itself has to be seen from others. The skeleton helps. Dock and hips lie in
//! the median plane of the root, the shoulder blades in that of the withers, and a leg stays in one plane of its own.

use glam::Vec3;
use muybridge_core::{BONE_COUNT, Joints, Limb, Pair, Side, bone};

/// From the croup to the withers of the reference horse, metres: what the body's thickness is measured by.
const REFERENCE_TRUNK_M: f32 = 0.81;
/// A cross product smaller than this share of squared metres gives no direction.
const LEAST_CROSS_M2: f32 = 1e-4;
/// Share that a bone of the body takes from the one before it: what is left where a bone stands upright and shows no turn.
const HANDED_ON: f32 = 0.15;
/// A leg as straight as this shows no turn, square metres: half of what pastern and hoof show in a straight leg.
const STRAIGHT_LEG_M2: f32 = 0.004;

/// Index of the line from the dock to the root, after the bones.
pub(super) const CROUP: usize = BONE_COUNT;

/// A bone in world space.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoneFrame {
    pub(super) base: Vec3,
    pub(super) tip: Vec3,
    /// To the horse's right, at right angles to the bone, unit length.
    pub(super) across: Vec3,
    /// At right angles to both: to the front of a leg, up from the body.
    pub(super) fore: Vec3,
}

/// What is needed to give the joints a body.
#[derive(Clone, Debug)]
pub(super) struct Frames {
    bones: [BoneFrame; BONE_COUNT + 1],
    /// Size of the horse in reference horses.
    pub(super) size: f32,
}

impl Frames {
    /// The frames of a body; none when a joint is no number or the trunk has no length.
    pub(super) fn of(joints: &Joints) -> Option<Self> {
        let points = joints.bases.iter().chain(&joints.tips).chain([&joints.root, &joints.dock]);
        if !points.into_iter().all(|point| point.is_finite()) {
            return None;
        }
        let trunk = joints.tips[bone::SPINE_LAST] - joints.root;
        let size = trunk.length() / REFERENCE_TRUNK_M;
        if !(size > 0.01 && size < 100.0) {
            return None;
        }
        let root = root_across(joints);
        let girdle = girdle_across(joints, root);
        let mut bones = [BoneFrame::new([joints.dock, joints.root], root); BONE_COUNT + 1];
        let up = (root + girdle).cross(trunk).normalize_or(Vec3::Y);
        body_frames(joints, root, up, &mut bones);
        for limb in Limb::ALL {
            let girdle = if limb.pair() == Pair::Fore { girdle } else { root };
            let across = leg_across(joints, limb, girdle, size);
            for i in limb.first_bone()..=limb.hoof_bone() {
                let across = if i == limb.first_bone() { girdle } else { across };
                bones[i] = BoneFrame::new([joints.bases[i], joints.tips[i]], across);
            }
        }
        Some(Self { bones, size })
    }

    /// A bone, or the [`CROUP`].
    pub(super) fn bone(&self, index: usize) -> &BoneFrame {
        &self.bones[index]
    }
}

impl BoneFrame {
    fn new([base, tip]: [Vec3; 2], across: Vec3) -> Self {
        let along = (tip - base).normalize_or(across.any_orthonormal_vector());
        let across = across.reject_from_normalized(along).normalize_or(along.any_orthonormal_vector());
        Self { base, tip, across, fore: across.cross(along) }
    }

    /// The bone's direction, unit length.
    pub(super) fn along(&self) -> Vec3 {
        self.fore.cross(self.across)
    }
}

/// A normal pointing to the horse's right.
fn towards_right(normal: Vec3, to_right: Vec3, otherwise: Vec3) -> Vec3 {
    let normal = if normal.length() > LEAST_CROSS_M2 { normal.normalize_or(otherwise) } else { otherwise };
    if normal.dot(to_right) < 0.0 { -normal } else { normal }
}

/// The tips of a pair's first bones, right less left, and their middle.
fn pair_tips(joints: &Joints, pair: Pair) -> [Vec3; 2] {
    let [right, left] = [Side::Right, Side::Left].map(|side| joints.tips[Limb::new(pair, side).first_bone()]);
    [right - left, (right + left) / 2.0]
}

fn root_across(joints: &Joints) -> Vec3 {
    let [to_right, hips] = pair_tips(joints, Pair::Hind);
    let normal = (joints.dock - joints.root).cross(hips - joints.root);
    towards_right(normal, to_right, to_right.normalize_or(Vec3::Z))
}

fn girdle_across(joints: &Joints, root: Vec3) -> Vec3 {
    let [to_right, shoulders] = pair_tips(joints, Pair::Fore);
    let [right, left] = [Limb::RF, Limb::LF].map(|limb| joints.bases[limb.first_bone()]);
    let spine = joints.tips[bone::SPINE_LAST] - joints.bases[bone::SPINE_LAST];
    towards_right((shoulders - (right + left) / 2.0).cross(spine), to_right, root)
}

/// Frames of spine, neck and head: each bone turns about the root's vertical against the one before it.
fn body_frames(joints: &Joints, root: Vec3, up: Vec3, bones: &mut [BoneFrame]) {
    let mut across = root;
    for i in 0..bone::LIMBS {
        let along = (joints.tips[i] - joints.bases[i]).normalize_or(Vec3::X);
        let level = along.cross(up);
        // Beyond the vertical, as a chin behind it, the cross product points to the left.
        let level = if level.dot(across) < 0.0 { -level } else { level };
        bones[i] = BoneFrame::new([joints.bases[i], joints.tips[i]], level + across * HANDED_ON);
        across = bones[i].across;
    }
}

/// The normal of a leg's plane: that of the girdle, abducted so that it is at right angles to the leg, and turned about the leg so
/// that its bones lie in the plane.
fn leg_across(joints: &Joints, limb: Limb, girdle: Vec3, size: f32) -> Vec3 {
    let bones = limb.first_bone() + 1..=limb.hoof_bone();
    let leg = joints.bases[limb.hoof_bone()] - joints.bases[limb.first_bone() + 1];
    let axis = leg.normalize_or(Vec3::NEG_Y);
    let across = girdle.reject_from_normalized(axis).normalize_or(girdle);
    let forward = across.cross(axis);
    let (mut both, mut squares) = (0.0, STRAIGHT_LEG_M2 * size * size);
    for i in bones {
        let along = joints.tips[i] - joints.bases[i];
        both += along.dot(across) * along.dot(forward);
        squares += along.dot(forward) * along.dot(forward);
    }
    (across - forward * (both / squares)).normalize_or(across)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;
    use muybridge_core::{Pose, Skeleton};

    #[test]
    fn the_frames_turn_with_the_horse() {
        let skeleton = Skeleton::reference();
        let mut pose = Pose::standing(&skeleton);
        for yaw in [0.0, 1.0, 3.0, -2.0] {
            pose.world_from_root =
                Quat::from_rotation_y(yaw) * Quat::from_rotation_x(0.2) * Quat::from_rotation_z(0.2);
            let frames = Frames::of(&pose.joints(&skeleton)).unwrap();
            let right = pose.world_from_root * Vec3::Z;
            // Shoulder blades lean inwards.
            for i in (0..=CROUP).filter(|&i| !Limb::ALL.iter().any(|limb| limb.first_bone() == i)) {
                assert!(
                    frames.bone(i).across.dot(right) > 0.97,
                    "bone {i} at {yaw}: {}",
                    frames.bone(i).across
                );
            }
            assert!(frames.bone(CROUP).across.distance(right) < 1e-4);
            assert!((frames.size - 1.0).abs() < 0.02, "{}", frames.size);
        }
    }

    #[test]
    fn bends_and_abductions_turn_the_bones_they_should() {
        let skeleton = Skeleton::reference();
        let mut pose = Pose::standing(&skeleton);
        pose.lateral_bends_rad[bone::NECK] = 0.4;
        pose.lateral_bends_rad[bone::HEAD] = 0.2;
        pose.abductions_rad[Limb::RF.index()] = -0.3;
        pose.limb_turns_rad[Limb::LH.index()] = 0.25;
        let frames = Frames::of(&pose.joints(&skeleton)).unwrap();
        let off = |bone: usize, expected: Quat| frames.bone(bone).across.angle_between(expected * Vec3::Z);
        assert!(off(bone::SPINE_LAST, Quat::IDENTITY) < 1e-3);
        assert!(off(bone::NECK_LAST, Quat::from_rotation_y(0.4)) < 0.08);
        assert!(off(bone::HEAD, Quat::from_rotation_y(0.6)) < 0.08);
        // Bones run to the side a little where the leg is neither abducted nor turned: stifles turn out by eight degrees.
        assert!(off(Limb::RF.first_bone() + 2, Quat::from_rotation_x(-0.3)) < 0.12);
        assert!(off(Limb::LH.first_bone() + 2, Quat::from_rotation_y(0.25)) < 0.2);
        assert!(off(Limb::RH.first_bone() + 2, Quat::IDENTITY) < 0.2);
    }

    #[test]
    fn what_is_no_horse_has_no_frames() {
        let skeleton = Skeleton::reference();
        let mut joints = Pose::standing(&skeleton).joints(&skeleton);
        joints.tips[20].y = f32::NAN;
        assert!(Frames::of(&joints).is_none());
        (joints.bases, joints.tips) = ([Vec3::ZERO; BONE_COUNT], [Vec3::ZERO; BONE_COUNT]);
        joints.root = Vec3::ZERO;
        assert!(Frames::of(&joints).is_none());
    }
}
