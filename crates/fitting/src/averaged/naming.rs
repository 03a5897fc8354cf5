//! What the points of known tables are called, and which of our keypoints they are.
//!
//! A table names the horse's own sides or the rider's near side (left); ours are near and off of the camera, so the
//! direction of travel decides. Points that are another landmark than ours are left out: a skeleton fitted to them would
//! be another animal's.

use muybridge_capture::{BodyPoint, Facing, Keypoint, LimbJoint, NearOff, PlacedBy};
use muybridge_core::{Pair, Side};

use BodyPoint::{Croup, Muzzle, Poll, Withers};
use LimbJoint::{Fetlock, Hoof, Middle, Root, Upper};
use Pair::{Fore, Hind};
use Side::{Left, Right};

/// Where a table's point sits on the horse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Landmark {
    /// On head or trunk.
    Body(BodyPoint),
    /// On one of the horse's own sides.
    Own(Side, Pair, LimbJoint),
    /// On the side towards the camera, whichever it is.
    Near(Pair, LimbJoint),
}

impl Landmark {
    /// The keypoint of an animal that faces so.
    pub(super) fn keypoint(self, facing: Facing) -> Keypoint {
        match self {
            Self::Body(point) => Keypoint::Body(point),
            Self::Own(side, pair, joint) => Keypoint::Limb(facing.near_off(side), pair, joint),
            Self::Near(pair, joint) => Keypoint::Limb(NearOff::Near, pair, joint),
        }
    }
}

/// A known kind of table.
#[derive(Debug)]
pub struct Naming {
    /// What it is called in messages.
    pub name: &'static str,
    /// The plate's title.
    pub title: &'static str,
    /// The animal.
    pub animal: &'static str,
    /// Where the table is from.
    pub source: &'static str,
    /// How its points were placed.
    pub placed_by: PlacedBy,
    /// Who placed them.
    pub annotator: &'static str,
    /// What was left out and why, for the notes.
    pub left_out: &'static str,
    /// Where the table has the eye in place of the poll: the poll lies on the line from the nose through the eye, this many
    /// times as far. It counts as guessed.
    pub poll_beyond_eye: Option<f64>,
    pub(super) points: &'static [(&'static str, Landmark)],
}

/// The tables that can be read.
pub(super) static NAMINGS: [Naming; 2] = [IN_HAND_TROT, LABELLED_WALK];

/// Points of a trot tracked by `DeepLabCut`: `right` and `left` are the horse's own, for as it passes to the right its `right`
/// legs overtake its `left` ones.
///
/// - `nostril` lies 8 to 10 cm behind the tip of the nose on the line to the poll; poll to nostril measures 0.36 of the
///   withers height, as the reference's head does from poll to tip, so it serves as the muzzle.
/// - `croup` is the top of the rump, as high as the withers, straight above the stifle by 0.38 of the withers height (the
///   reference horse: 0.39).
/// - `hip` is the point of the hip (tuber coxae): in front of the croup by 0.12 of the withers height and under it by 0.09.
///   The hip joint is behind it and lower by 0.1. Left out.
/// - `pointofbuttock` is the ischium, 0.18 of the withers height under the croup; the root of the tail is at 0.08. Left out.
/// - `midback` is at 0.27 of the way from withers to croup; ours is half way. Left out.
/// - shoulder, elbow and stifle are there once: the camera's side.
const IN_HAND_TROT: Naming = Naming {
    name: "in-hand trot",
    title: "A horse trotting in hand: the mean stride of a tracked film",
    animal: "horse of an in-hand trot",
    source: "point coordinates tracked by machine (DeepLabCut) in a film of a horse trotting in hand; repository jakeshirey/DeepLabCut-Display, written for the University of Florida's Department of Animal Sciences",
    placed_by: PlacedBy::Tracked,
    annotator: "DeepLabCut",
    left_out: "hip (point of the hip, not the hip joint), pointofbuttock (ischium, not the root of the tail), midback (a quarter, not half of the way to the croup), the handler's points",
    poll_beyond_eye: None,
    points: &[
        ("nostril", Landmark::Body(Muzzle)),
        ("poll", Landmark::Body(Poll)),
        ("withers", Landmark::Body(Withers)),
        ("croup", Landmark::Body(Croup)),
        ("shoulder", Landmark::Near(Fore, Root)),
        ("elbow", Landmark::Near(Fore, Upper)),
        ("rightknee", Landmark::Own(Right, Fore, Middle)),
        ("rightFfetlock", Landmark::Own(Right, Fore, Fetlock)),
        ("rightFhoof", Landmark::Own(Right, Fore, Hoof)),
        ("leftknee", Landmark::Own(Left, Fore, Middle)),
        ("leftFfetlock", Landmark::Own(Left, Fore, Fetlock)),
        ("leftFhoof", Landmark::Own(Left, Fore, Hoof)),
        ("stifle", Landmark::Near(Hind, Upper)),
        ("righthock", Landmark::Own(Right, Hind, Middle)),
        ("rightHfetlock", Landmark::Own(Right, Hind, Fetlock)),
        ("rightHhoof", Landmark::Own(Right, Hind, Hoof)),
        ("lefthock", Landmark::Own(Left, Hind, Middle)),
        ("leftHfetlock", Landmark::Own(Left, Hind, Fetlock)),
        ("leftHhoof", Landmark::Own(Left, Hind, Hoof)),
    ],
};

/// Points of the Horse-10 and Horse-30 sets, placed by hand.
///
/// - `Near` is the rider's near side, the left, and `Off` the right, not the camera's. This horse moves right: its `Off` legs
///   overtake its `Near` ones by 0.05 of the withers height a stride as it passes, as legs nearer to the camera do, and their
///   soles are lower in the picture by 0.04.
/// - `Hip` is at the height of the withers and 0.72 of the way from withers to ischium, where the other horse's croup is
///   (its point of the hip is at 0.57): it serves as the croup.
/// - `Eye` stands for the poll, which lies on the line from the nose through the eye: nose to eye measures 0.246 of the withers
///   height, the reference's head 0.363 from tip to poll, 1.48 times as much. Guessed, good to a few centimetres, but without
///   it the head would have no direction.
/// - `Ischium` is lower than the root of the tail, `Midshoulder` is on the shoulder blade, `Girth` on the belly. Left out.
const LABELLED_WALK: Naming = Naming {
    name: "Horse-10",
    title: "A brown horse walking: the mean stride of a film labelled by hand",
    animal: "brown horse of Horse-30",
    source: "point coordinates placed by hand in consecutive frames of a film of a walking horse; repository AdaptiveMotorControlLab/modelzoo-figures (clip of Horse-30, Mathis et al. 2021)",
    placed_by: PlacedBy::Hand,
    annotator: "labellers of Horse-30",
    left_out: "Ischium (under the root of the tail), Midshoulder, Girth (no keypoints of ours); the poll is guessed from nose and eye",
    poll_beyond_eye: Some(1.48),
    points: &[
        ("Nose", Landmark::Body(Muzzle)),
        ("Eye", Landmark::Body(Poll)),
        ("Wither", Landmark::Body(Withers)),
        ("Hip", Landmark::Body(Croup)),
        ("Shoulder", Landmark::Near(Fore, Root)),
        ("Elbow", Landmark::Near(Fore, Upper)),
        ("Offknee", Landmark::Own(Right, Fore, Middle)),
        ("Offfrontfetlock", Landmark::Own(Right, Fore, Fetlock)),
        ("Offfrontfoot", Landmark::Own(Right, Fore, Hoof)),
        ("Nearknee", Landmark::Own(Left, Fore, Middle)),
        ("Nearfrontfetlock", Landmark::Own(Left, Fore, Fetlock)),
        ("Nearfrontfoot", Landmark::Own(Left, Fore, Hoof)),
        ("Stifle", Landmark::Near(Hind, Upper)),
        ("Offhindhock", Landmark::Own(Right, Hind, Middle)),
        ("Offhindfetlock", Landmark::Own(Right, Hind, Fetlock)),
        ("Offhindfoot", Landmark::Own(Right, Hind, Hoof)),
        ("Nearhindhock", Landmark::Own(Left, Hind, Middle)),
        ("Nearhindfetlock", Landmark::Own(Left, Hind, Fetlock)),
        ("Nearhindfoot", Landmark::Own(Left, Hind, Hoof)),
    ],
};
