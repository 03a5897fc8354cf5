//! The points of a panel as a figure: its places, its chains of segments, its size.

use std::f64::consts::TAU;

use muybridge_capture::{BodyPoint, KEYPOINT_COUNT, Keypoint, Keypoints, LimbJoint, NearOff};
use muybridge_core::{Limb, Pair, Side, Skeleton, bone};

use super::frame::{Frame, Place, distance};

/// A segment longer than this is a slip of the hand, body heights: the longest real one, the neck, has 0.5.
const LONGEST: f64 = 1.5;
/// Places farther off than this are slips, body heights.
const FARTHEST: f64 = 50.0;

pub(super) const JOINTS: [LimbJoint; 5] =
    [LimbJoint::Root, LimbJoint::Upper, LimbJoint::Middle, LimbJoint::Fetlock, LimbJoint::Hoof];
/// Points of the back, hind end first.
pub(super) const BACK: [BodyPoint; 4] =
    [BodyPoint::Dock, BodyPoint::Croup, BodyPoint::Back, BodyPoint::Withers];
/// The neck and the four limbs; near and off limb of a pair follow one another.
pub(super) const CHAINS: usize = 5;

/// The keypoints of a chain, root to tip: chain 0 is the neck.
pub(super) fn chain_keypoints(chain: usize) -> Vec<Keypoint> {
    let limb = |side, pair| JOINTS.map(|joint| Keypoint::Limb(side, pair, joint)).to_vec();
    match chain {
        0 => [BodyPoint::Withers, BodyPoint::Poll, BodyPoint::Muzzle].map(Keypoint::Body).to_vec(),
        1 => limb(NearOff::Near, Pair::Fore),
        2 => limb(NearOff::Off, Pair::Fore),
        3 => limb(NearOff::Near, Pair::Hind),
        _ => limb(NearOff::Off, Pair::Hind),
    }
}

/// The same point of the other limb of the pair.
pub(super) fn contralateral(keypoint: Keypoint) -> Option<Keypoint> {
    match keypoint {
        Keypoint::Body(_) => None,
        Keypoint::Limb(NearOff::Near, pair, joint) => Some(Keypoint::Limb(NearOff::Off, pair, joint)),
        Keypoint::Limb(NearOff::Off, pair, joint) => Some(Keypoint::Limb(NearOff::Near, pair, joint)),
    }
}

/// An angle in -pi..pi.
pub(super) fn wrapped(angle: f64) -> f64 {
    angle - TAU * (angle / TAU).round()
}

/// From a proximal to a distal end.
#[derive(Clone, Copy, Debug)]
pub(super) struct Segment {
    pub(super) from: Place,
    pub(super) to: Place,
}

impl Segment {
    /// Direction, radians, clockwise from where the animal faces.
    pub(super) fn angle(&self) -> f64 {
        (self.to[1] - self.from[1]).atan2(self.to[0] - self.from[0])
    }

    pub(super) fn length(&self) -> f64 {
        distance(self.from, self.to)
    }

    /// Distance of a place from the segment.
    pub(super) fn distance(&self, [x, y]: Place) -> f64 {
        let ([ax, ay], [bx, by]) = (self.from, self.to);
        let (dx, dy) = (bx - ax, by - ay);
        let along = ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy).max(f64::MIN_POSITIVE);
        let t = along.clamp(0.0, 1.0);
        (x - ax - t * dx).hypot(y - ay - t * dy)
    }
}

/// The points of one panel.
pub(super) struct Figure {
    places: [Option<Place>; KEYPOINT_COUNT],
}

impl Figure {
    /// Points that are placed, in the frame's body heights; places that are no numbers or far off are left out.
    pub(super) fn new(points: &Keypoints, frame: &Frame) -> Self {
        let mut places = [None; KEYPOINT_COUNT];
        for keypoint in Keypoint::all() {
            let place = points.place(keypoint).map(|at_px| frame.place(at_px));
            places[keypoint.index()] = place.filter(|place| place.iter().all(|v| v.abs() < FARTHEST));
        }
        Self { places }
    }

    pub(super) fn place(&self, keypoint: Keypoint) -> Option<Place> {
        self.places[keypoint.index()]
    }

    pub(super) fn segment(&self, from: Keypoint, to: Keypoint) -> Option<Segment> {
        let segment = Segment { from: self.place(from)?, to: self.place(to)? };
        (segment.length() < LONGEST).then_some(segment)
    }

    /// Segments between neighbours of a chain.
    pub(super) fn segments(&self, chain: &[Keypoint]) -> Vec<Segment> {
        chain.windows(2).filter_map(|ends| self.segment(ends[0], ends[1])).collect()
    }

    /// Segments of all limbs but one.
    pub(super) fn other_limbs(&self, chain: usize) -> Vec<Segment> {
        (1..CHAINS)
            .filter(|other| chain != 0 && *other != chain)
            .flat_map(|other| self.segments(&chain_keypoints(other)))
            .collect()
    }

    /// From the hindmost to the foremost point of the back.
    pub(super) fn trunk(&self) -> Option<Segment> {
        let mut placed = BACK.into_iter().map(Keypoint::Body).filter(|k| self.place(*k).is_some());
        let (first, last) = (placed.next()?, placed.next_back()?);
        self.segment(first, last)
    }
}

/// The animal's standing height at the withers in plate px, from the lengths of its limbs and back against those of the
/// reference horse; none when nothing can be measured.
pub(super) fn height_plate_px(points: &Keypoints) -> Option<f64> {
    let horse = Skeleton::reference();
    let length = |bone: usize| f64::from(horse.bones[bone].length_m);
    let back =
        (bone::SPINE..=bone::SPINE_LAST).map(length).sum::<f64>() - f64::from(horse.dock_from_croup_m[0]);
    let mut pairs = vec![(Keypoint::Body(BodyPoint::Dock), Keypoint::Body(BodyPoint::Withers), back)];
    for chain in 1..CHAINS {
        let joints = chain_keypoints(chain);
        let pair = if chain < 3 { Pair::Fore } else { Pair::Hind };
        let first = Limb::new(pair, Side::Left).first_bone();
        pairs.extend((1..5).map(|i| (joints[i - 1], joints[i], length(first + i))));
    }
    let (mut seen_px, mut reference_m) = (0.0, 0.0);
    for (from, to, length_m) in pairs {
        if let (Some(from), Some(to)) = (points.place(from), points.place(to)) {
            seen_px += distance(from, to);
            reference_m += length_m;
        }
    }
    let height_px = seen_px / reference_m * f64::from(horse.withers_height_m);
    // A pixel's height shows nothing; this also refuses no points and points that are no numbers.
    (height_px > 1.0 && height_px.is_finite()).then_some(height_px)
}

/// Whether the animal faces left: its fore end lies left of its hind end.
pub(super) fn faces_left(points: &Keypoints) -> bool {
    let mean = |keypoints: &[Keypoint]| {
        let xs: Vec<f64> = keypoints.iter().filter_map(|k| points.place(*k)).map(|at_px| at_px[0]).collect();
        (!xs.is_empty()).then(|| xs.iter().sum::<f64>() / xs.len() as f64)
    };
    let roots = |pair| [NearOff::Near, NearOff::Off].map(|side| Keypoint::Limb(side, pair, LimbJoint::Root));
    let fore = [BodyPoint::Muzzle, BodyPoint::Poll, BodyPoint::Withers].map(Keypoint::Body);
    let hind = [BodyPoint::Croup, BodyPoint::Dock].map(Keypoint::Body);
    let fore = mean(&[&fore[..], &roots(Pair::Fore)].concat());
    let hind = mean(&[&hind[..], &roots(Pair::Hind)].concat());
    matches!((fore, hind), (Some(fore), Some(hind)) if fore < hind)
}
