//! The 26 anatomical points a person places on each panel.

use muybridge_core::Pair;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::manifest::Facing;
use muybridge_core::Limb;

/// Number of keypoint types.
pub const KEYPOINT_COUNT: usize = 26;

/// The side nearest the camera, or the one away from it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum NearOff {
    /// Nearest the camera.
    Near,
    /// Behind, seen past the near side.
    Off,
}

/// Points on the head, neck and trunk, all on the upper outline.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum BodyPoint {
    /// Foremost tip of the nose.
    Muzzle,
    /// Top of the head between the ears.
    Poll,
    /// Top of the shoulder blades, where neck meets back.
    Withers,
    /// Back, half way from withers to croup.
    Back,
    /// Highest point of the rump.
    Croup,
    /// Root of the tail.
    Dock,
}

/// The five joints of a limb, root to tip.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LimbJoint {
    /// Point of the shoulder, or hip joint.
    Root,
    /// Elbow, or stifle.
    Upper,
    /// Knee (carpus), or hock.
    Middle,
    /// Fetlock.
    Fetlock,
    /// Tip of the toe at the sole.
    Hoof,
}

/// One of the 26 keypoint types.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Keypoint {
    /// On the body.
    Body(BodyPoint),
    /// On a limb.
    Limb(NearOff, Pair, LimbJoint),
}

const NAMES: [&str; KEYPOINT_COUNT] = [
    "muzzle",
    "poll",
    "withers",
    "back",
    "croup",
    "dock",
    "near_shoulder",
    "near_elbow",
    "near_knee",
    "near_fore_fetlock",
    "near_fore_hoof",
    "off_shoulder",
    "off_elbow",
    "off_knee",
    "off_fore_fetlock",
    "off_fore_hoof",
    "near_hip",
    "near_stifle",
    "near_hock",
    "near_hind_fetlock",
    "near_hind_hoof",
    "off_hip",
    "off_stifle",
    "off_hock",
    "off_hind_fetlock",
    "off_hind_hoof",
];

const BODY: [BodyPoint; 6] = [
    BodyPoint::Muzzle,
    BodyPoint::Poll,
    BodyPoint::Withers,
    BodyPoint::Back,
    BodyPoint::Croup,
    BodyPoint::Dock,
];

const JOINTS: [LimbJoint; 5] =
    [LimbJoint::Root, LimbJoint::Upper, LimbJoint::Middle, LimbJoint::Fetlock, LimbJoint::Hoof];

impl Keypoint {
    /// All keypoints in drawing and file order.
    pub fn all() -> impl Iterator<Item = Self> {
        (0..KEYPOINT_COUNT).map(Self::from_index)
    }

    fn from_index(index: usize) -> Self {
        let Some(limb_index) = index.checked_sub(BODY.len()) else { return Self::Body(BODY[index]) };
        let pair = if limb_index < 10 { Pair::Fore } else { Pair::Hind };
        let side = if limb_index % 10 < 5 { NearOff::Near } else { NearOff::Off };
        Self::Limb(side, pair, JOINTS[limb_index % 5])
    }

    /// Place in drawing and file order, 0 to 25.
    pub fn index(self) -> usize {
        match self {
            Self::Body(point) => point as usize,
            Self::Limb(side, pair, joint) => 6 + 10 * pair as usize + 5 * side as usize + joint as usize,
        }
    }

    /// Name in files: `near_hock`, `off_fore_hoof`, ...
    pub fn name(self) -> &'static str {
        NAMES[self.index()]
    }

    /// The keypoint of this name.
    pub fn from_name(name: &str) -> Option<Self> {
        NAMES.iter().position(|n| *n == name).map(Self::from_index)
    }

    /// Tip of the toe of a limb.
    pub fn hoof(side: NearOff, pair: Pair) -> Self {
        Self::Limb(side, pair, LimbJoint::Hoof)
    }

    /// The bone whose tip this is, as an index into the core skeleton; none for croup and dock, which are fixed
    /// to the root.
    pub fn bone(self, facing: Facing) -> Option<usize> {
        use muybridge_core::bone;
        match self {
            Self::Body(BodyPoint::Muzzle) => Some(bone::HEAD),
            Self::Body(BodyPoint::Poll) => Some(bone::NECK_LAST),
            Self::Body(BodyPoint::Withers) => Some(bone::SPINE_LAST),
            Self::Body(BodyPoint::Back) => Some(bone::SPINE + 1),
            Self::Body(BodyPoint::Croup | BodyPoint::Dock) => None,
            Self::Limb(side, pair, joint) => {
                Some(Limb::new(pair, facing.side(side)).first_bone() + joint as usize)
            }
        }
    }
}

impl std::fmt::Display for Keypoint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

impl Serialize for Keypoint {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(self.name())
    }
}

impl<'de> Deserialize<'de> for Keypoint {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let name = String::deserialize(deserializer)?;
        Self::from_name(&name).ok_or_else(|| {
            serde::de::Error::custom(format!("unknown keypoint `{name}`; the names are {}", NAMES.join(", ")))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_indices_and_bones_agree() {
        for (index, keypoint) in Keypoint::all().enumerate() {
            assert_eq!(keypoint.index(), index);
            assert_eq!(Keypoint::from_name(keypoint.name()), Some(keypoint));
        }
        assert_eq!(Keypoint::Limb(NearOff::Off, Pair::Hind, LimbJoint::Middle).name(), "off_hock");
        let near_toe = Keypoint::hoof(NearOff::Near, Pair::Fore);
        assert_eq!(near_toe.bone(Facing::Right), Some(Limb::RF.hoof_bone()));
        assert_eq!(near_toe.bone(Facing::Left), Some(Limb::LF.hoof_bone()));
    }
}
