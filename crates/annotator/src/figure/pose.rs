//! A pose to draw, and the frame of its body.

use glam::Vec3;
use muybridge_core::{Joints, Limb, bone};

/// From the croup to the withers of the reference horse, metres: what the body's thickness is measured by.
const REFERENCE_TRUNK_M: f32 = 0.81;
/// A cross product smaller than this share of squared metres gives no direction.
const LEAST_CROSS_M2: f32 = 1e-4;

/// One pose of the horse in a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FigurePose {
    /// World positions; the ground is the plane of height zero, and the horse faces along X.
    pub joints: Joints,
    /// Hooves that bear weight, in the order of [`Limb::ALL`].
    pub standing: [bool; 4],
    /// Drawn as a thin transparent skeleton: another moment, for comparison.
    pub ghost: bool,
}

/// What is needed to give the joints a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// To the horse's right, unit length.
    pub(super) across: Vec3,
    /// Size of the horse in reference horses.
    pub(super) size: f32,
}

impl Frame {
    /// The frame of a body; none when a joint is no number or the trunk has no length.
    pub(super) fn of(joints: &Joints) -> Option<Self> {
        let points = joints.bases.iter().chain(&joints.tips).chain([&joints.root, &joints.dock]);
        if !points.into_iter().all(|point| point.is_finite()) {
            return None;
        }
        let trunk = joints.tips[bone::SPINE_LAST] - joints.root;
        let size = trunk.length() / REFERENCE_TRUNK_M;
        (size > 0.01 && size < 100.0).then(|| Self { across: across(joints), size })
    }
}

/// The normal of the median plane, in which spine, neck, head and dock lie, towards the right limbs.
fn across(joints: &Joints) -> Vec3 {
    let withers = joints.tips[bone::SPINE_LAST];
    let poll = joints.tips[bone::NECK_LAST];
    let trunk = withers - joints.root;
    let along = [joints.dock - joints.root, poll - withers, joints.tips[bone::HEAD] - poll];
    let crosses = along.map(|part| trunk.cross(part));
    let widest = crosses.into_iter().max_by(|a, b| a.length_squared().total_cmp(&b.length_squared()));
    let normal = widest.filter(|normal| normal.length() > LEAST_CROSS_M2).unwrap_or(Vec3::Z);
    let right = |right: Limb, left: Limb| joints.tips[right.first_bone()] - joints.tips[left.first_bone()];
    let to_right = right(Limb::RF, Limb::LF) + right(Limb::RH, Limb::LH);
    let towards = if to_right.dot(normal) == 0.0 { normal.z } else { to_right.dot(normal) };
    normal.normalize_or(Vec3::Z) * if towards < 0.0 { -1.0 } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Quat;
    use muybridge_core::{Pose, Skeleton};

    #[test]
    fn the_frame_turns_with_the_horse() {
        let skeleton = Skeleton::reference();
        let mut pose = Pose::standing(&skeleton);
        for yaw in [0.0, 1.0, 3.0, -2.0] {
            pose.world_from_root = Quat::from_rotation_y(yaw) * Quat::from_rotation_z(0.2);
            let frame = Frame::of(&pose.joints(&skeleton)).unwrap();
            assert!(frame.across.distance(pose.world_from_root * Vec3::Z) < 1e-4);
            assert!((frame.size - 1.0).abs() < 0.02, "{}", frame.size);
        }
    }
}
