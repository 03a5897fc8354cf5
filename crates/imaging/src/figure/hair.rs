//! Mane, forelock, tail, ears and eyes: so that it is plain which end is which.

use glam::Vec3;
use muybridge_core::bone;

use super::body::{Part, Tone};
use super::frames::{CROUP, Frames};
use super::loft::{Mesh, Ring, loft, rod};
use super::terrain::Floor;

/// Length of an ear, metres, and half its thickness at base and tip.
const EAR_M: f32 = 0.13;
const EAR_THICK_M: [f32; 2] = [0.033, 0.006];
/// An eye: share of the head's length, above the head's line, and from the median plane, metres; half its size.
const EYE: [f32; 3] = [0.27, 0.038, 0.077];
const EYE_M: f32 = 0.02;
/// The tail hangs so: behind the dock and below it, and half its thickness, metres.
const TAIL: [[f32; 3]; 7] = [
    [-0.04, 0.03, 0.035],
    [0.04, 0.03, 0.045],
    [0.12, 0.1, 0.055],
    [0.17, 0.26, 0.07],
    [0.185, 0.5, 0.075],
    [0.19, 0.74, 0.06],
    [0.2, 0.95, 0.02],
];
/// The tail ends so far above the ground, metres.
const TAIL_OVER_GROUND_M: f32 = 0.12;
/// Half thickness of the mane, metres.
const MANE_THICK_M: f32 = 0.02;
/// The mane along the neck: bone, share of it, height over the line of the joints, and how far it hangs down the side, metres.
const MANE: [(usize, f32, f32, f32); 8] = [
    (bone::NECK, 0.15, 0.0, 0.03),
    (bone::NECK, 0.55, 0.022, 0.08),
    (bone::NECK, 1.0, 0.034, 0.12),
    (bone::NECK + 1, 0.5, 0.042, 0.14),
    (bone::NECK + 1, 1.0, 0.052, 0.125),
    (bone::NECK_LAST, 0.45, 0.057, 0.12),
    (bone::NECK_LAST, 0.85, 0.055, 0.11),
    (bone::NECK_LAST, 1.06, 0.045, 0.06),
];

pub(super) fn add(frames: &Frames, floor: &Floor<'_>, parts: &mut Vec<Part>) {
    parts.push(mane(frames));
    parts.push(tail(frames, floor));
    parts.push(forelock(frames));
    for side in [-1.0, 1.0] {
        parts.push(ear(frames, side));
        parts.push(eye(frames, side));
    }
}

fn ear(frames: &Frames, side: f32) -> Part {
    let (head, metres) = (frames.bone(bone::HEAD), frames.size);
    let towards =
        (head.fore * 0.75 - head.along() * 0.75 + head.across * (0.25 * side)).normalize_or(Vec3::Y);
    let from = head.base + (head.across * (0.042 * side) + head.fore * 0.045 + head.along() * 0.02) * metres;
    Part::plain(
        rod([from, from + towards * (EAR_M * metres)], EAR_THICK_M.map(|v| v * metres), 10),
        Tone::Trunk,
    )
}

fn eye(frames: &Frames, side: f32) -> Part {
    let (head, metres) = (frames.bone(bone::HEAD), frames.size);
    let at = head.base.lerp(head.tip, EYE[0]) + (head.fore * EYE[1] + head.across * (EYE[2] * side)) * metres;
    let ends = [at - head.along() * (0.008 * metres), at + head.along() * (0.008 * metres)];
    Part::plain(rod(ends, [EYE_M * metres; 2], 8), Tone::Eye)
}

fn forelock(frames: &Frames) -> Part {
    let (head, metres) = (frames.bone(bone::HEAD), frames.size);
    let at = |share: f32, off: f32| head.base.lerp(head.tip, share) + head.fore * (off * metres);
    let thick = [0.028, 0.01].map(|v| v * metres);
    Part::plain(rod([at(0.0, 0.05), at(0.27, 0.085)], thick, 8), Tone::Hair)
}

/// On the crest, fallen to the right side.
fn mane(frames: &Frames) -> Part {
    let metres = frames.size;
    let ring = |&(bone, share, over, hangs): &(usize, f32, f32, f32)| {
        let bone = frames.bone(bone);
        let crest = bone.base.lerp(bone.tip, share) + bone.fore * (over * metres);
        let side = bone.across * ((0.05 + 0.5 * hangs) * metres) - bone.fore * (hangs * metres);
        let thick = bone.along().cross(side).normalize_or(bone.across) * (MANE_THICK_M * metres);
        Ring::plain(crest + side * 0.5 + bone.across * (0.018 * metres), side * -0.5, thick)
    };
    let rings: Vec<Ring> = MANE.iter().map(ring).collect();
    Part::plain(loft(&rings, Mesh { steps: 2, segments: 10, caps_m: [0.02 * metres; 2] }), Tone::Hair)
}

/// The tail follows the croup at its root and hangs down plumb.
fn tail(frames: &Frames, floor: &Floor<'_>) -> Part {
    let (croup, metres) = (frames.bone(CROUP), frames.size);
    let backwards = -croup.along();
    let level = backwards.with_y(0.0).normalize_or(backwards);
    let lowest = floor.surface(croup.base).height_m + TAIL_OVER_GROUND_M * metres;
    let longest = TAIL[TAIL.len() - 1][1] * metres;
    let length = (croup.base.y - lowest).clamp(0.3 * longest, longest) / longest;
    let at = |[behind, below, _]: [f32; 3]| {
        let plumb = (below / 0.3).clamp(0.0, 1.0);
        let back = backwards.lerp(level, plumb);
        let down = (-croup.fore).lerp(Vec3::NEG_Y, plumb);
        croup.base + (back * behind + down * (below * length)) * metres
    };
    let rings: Vec<Ring> = (0..TAIL.len())
        .map(|i| {
            let along = at(TAIL[(i + 1).min(TAIL.len() - 1)]) - at(TAIL[i.saturating_sub(1)]);
            let deep = croup.across.cross(along).normalize_or(croup.fore);
            let thick = TAIL[i][2] * metres;
            let (deep, wide) = (deep * thick, croup.across * (thick * 0.8));
            Ring::plain(at(TAIL[i]), deep, wide)
        })
        .collect();
    Part::plain(loft(&rings, Mesh { steps: 2, segments: 10, caps_m: [0.02 * metres; 2] }), Tone::Hair)
}
