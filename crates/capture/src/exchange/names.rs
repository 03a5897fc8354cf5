//! Names of keypoints: ours, those of known vocabularies, and a person's own table.

use std::collections::BTreeMap;

use muybridge_core::{Pair, Side};

use super::ExchangeError;
use crate::keypoint::{BodyPoint, Keypoint, LimbJoint, NearOff};
use crate::manifest::Facing;

/// What a name in a file means.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Meaning {
    /// One of our points.
    Point(Keypoint),
    /// A person has said to leave it away.
    Skip,
    /// Left or right, and nobody has said yet which side is near.
    NeedsFacing,
    /// No point of ours.
    Unknown,
}

/// From names in files to our keypoints: a person's own table, then our names, then those of Horse-10 (22) and of
/// `SuperAnimal-Quadruped` (39), as far as they mark the same anatomical point. Case, spaces and hyphens do not matter.
///
/// Horse-10 and `SuperAnimal` follow the conversion table of `DeepLabCut`'s model zoo: near and off are the horseman's (the
/// horse's left and right), points without a side are seen on the side of the camera, `thai` is elbow or stifle.
/// Its hip and ischium are points of the pelvis that we do not mark.
#[derive(Clone, Debug)]
pub struct NameTable {
    facing: Option<Facing>,
    own: BTreeMap<String, Option<Keypoint>>,
}

/// Points of other vocabularies on the body, or on the side of the camera.
const UNSIDED: [(&str, Keypoint); 7] = [
    ("nose", Keypoint::Body(BodyPoint::Muzzle)),
    ("wither", Keypoint::Body(BodyPoint::Withers)),
    ("back_base", Keypoint::Body(BodyPoint::Withers)),
    ("tail_base", Keypoint::Body(BodyPoint::Dock)),
    ("shoulder", Keypoint::Limb(NearOff::Near, Pair::Fore, LimbJoint::Root)),
    ("elbow", Keypoint::Limb(NearOff::Near, Pair::Fore, LimbJoint::Upper)),
    ("stifle", Keypoint::Limb(NearOff::Near, Pair::Hind, LimbJoint::Upper)),
];

/// Joints of Horse-10 after `near` or `off`.
const HORSE_10: [(&str, Pair, LimbJoint); 6] = [
    ("knee", Pair::Fore, LimbJoint::Middle),
    ("frontfetlock", Pair::Fore, LimbJoint::Fetlock),
    ("frontfoot", Pair::Fore, LimbJoint::Hoof),
    ("hindhock", Pair::Hind, LimbJoint::Middle),
    ("hindfetlock", Pair::Hind, LimbJoint::Fetlock),
    ("hindfoot", Pair::Hind, LimbJoint::Hoof),
];

impl NameTable {
    /// A table for a plate on which the animal faces that way, with a person's own names.
    ///
    /// # Errors
    /// When an own name leads to no keypoint of ours.
    pub fn new(
        facing: Option<Facing>,
        own_names: &BTreeMap<String, Option<String>>,
    ) -> Result<Self, ExchangeError> {
        let mut own = BTreeMap::new();
        for (theirs, ours) in own_names {
            let keypoint = match ours {
                None => None,
                Some(ours) => Some(
                    Keypoint::from_name(ours)
                        .ok_or_else(|| ExchangeError::Name { theirs: theirs.clone(), ours: ours.clone() })?,
                ),
            };
            own.insert(plain(theirs), keypoint);
        }
        Ok(Self { facing, own })
    }

    pub(super) fn meaning(&self, name: &str) -> Meaning {
        let name = plain(name);
        if let Some(own) = self.own.get(&name) {
            return own.map_or(Meaning::Skip, Meaning::Point);
        }
        if let Some(keypoint) = Keypoint::from_name(&name) {
            return Meaning::Point(keypoint);
        }
        if let Some((_, keypoint)) = UNSIDED.iter().find(|(known, _)| *known == name) {
            return Meaning::Point(*keypoint);
        }
        let Some((side, pair, joint)) = horse_10(&name).or_else(|| super_animal(&name)) else {
            return Meaning::Unknown;
        };
        match self.facing {
            Some(facing) => Meaning::Point(Keypoint::Limb(facing.near_off(side), pair, joint)),
            None => Meaning::NeedsFacing,
        }
    }
}

/// A name without what people write differently.
fn plain(name: &str) -> String {
    name.trim().to_lowercase().replace([' ', '-'], "_")
}

fn horse_10(name: &str) -> Option<(Side, Pair, LimbJoint)> {
    let (side, rest) = match name.strip_prefix("near") {
        Some(rest) => (Side::Left, rest),
        None => (Side::Right, name.strip_prefix("off")?),
    };
    HORSE_10.into_iter().find(|(joint, ..)| *joint == rest).map(|(_, pair, joint)| (side, pair, joint))
}

fn super_animal(name: &str) -> Option<(Side, Pair, LimbJoint)> {
    let mut words = name.split('_');
    let pair = match words.next()? {
        "front" => Pair::Fore,
        "back" => Pair::Hind,
        _ => return None,
    };
    let side = match words.next()? {
        "left" => Side::Left,
        "right" => Side::Right,
        _ => return None,
    };
    let joint = match (words.next()?, words.next()) {
        ("thai", None) => LimbJoint::Upper,
        ("knee", None) => LimbJoint::Middle,
        ("paw", None) => LimbJoint::Hoof,
        _ => return None,
    };
    Some((side, pair, joint))
}

/// The 25 lines that join the 26 keypoints, from the head backwards and from root to hoof.
pub fn skeleton_edges() -> impl Iterator<Item = [Keypoint; 2]> {
    Keypoint::all().filter_map(|keypoint| Some([before(keypoint)?, keypoint]))
}

/// The point that a point hangs on; none for the muzzle.
fn before(keypoint: Keypoint) -> Option<Keypoint> {
    use BodyPoint::{Back, Croup, Dock, Muzzle, Poll, Withers};
    use LimbJoint::{Fetlock, Hoof, Middle, Root, Upper};
    Some(match keypoint {
        Keypoint::Body(point) => Keypoint::Body(match point {
            Muzzle => return None,
            Poll => Muzzle,
            Withers => Poll,
            Back => Withers,
            Croup => Back,
            Dock => Croup,
        }),
        Keypoint::Limb(_, Pair::Fore, Root) => Keypoint::Body(Withers),
        Keypoint::Limb(_, Pair::Hind, Root) => Keypoint::Body(Croup),
        Keypoint::Limb(side, pair, joint) => Keypoint::Limb(
            side,
            pair,
            match joint {
                Root | Upper => Root,
                Middle => Upper,
                Fetlock => Middle,
                Hoof => Fetlock,
            },
        ),
    })
}
