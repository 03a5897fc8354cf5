//! The horse's body over its joints. Thicknesses are those of the 1.60 m reference horse, by eye from side and front
//! views of light riding horses; they are for looking at, nothing is computed from them.

use glam::Vec3;
use muybridge_core::{BONE_COUNT, Joints, Limb, Pair, Skeleton, bone};

use super::loft::{Ring, Surface, loft, rod};
use super::pose::Frame;

/// What colours a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tone {
    /// Neck, head, barrel.
    Trunk,
    /// Tail and ears.
    Hair,
    /// A leg from the shoulder or hip down.
    Limb(Limb),
}

/// A part of the body.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub(super) surface: Surface,
    pub(super) tone: Tone,
}

/// Half thicknesses of a bone at base and tip, metres.
struct Thickness {
    deep: [f32; 2],
    wide: [f32; 2],
}

const fn round(base: f32, tip: f32) -> Thickness {
    Thickness { deep: [base, tip], wide: [base, tip] }
}

/// Humerus, radius, metacarpal, pastern; the shoulder blade is under the skin of the trunk.
const FORE: [Thickness; 4] = [
    Thickness { deep: [0.12, 0.085], wide: [0.065, 0.06] },
    Thickness { deep: [0.085, 0.043], wide: [0.06, 0.04] },
    round(0.036, 0.03),
    round(0.034, 0.03),
];
/// Femur, tibia, metatarsal, pastern; the pelvis is under the skin.
const HIND: [Thickness; 4] = [
    Thickness { deep: [0.2, 0.12], wide: [0.1, 0.08] },
    Thickness { deep: [0.11, 0.045], wide: [0.075, 0.04] },
    round(0.042, 0.032),
    round(0.036, 0.03),
];
/// The hoof begins here on its bone, which runs from the fetlock to the toe.
const HOOF_FROM: f32 = 0.62;
/// And ends here: its wall is around the bone's tip.
const HOOF_TO: f32 = 0.9;
const HOOF: Thickness = round(0.038, 0.048);
/// Half thickness of a ghost's bones, metres.
const GHOST_M: f32 = 0.022;
/// Corners of a ring: legs are a few pixels wide, the barrel is large.
const LIMB_SEGMENTS: u32 = 8;
const TRUNK_SEGMENTS: u32 = 16;

/// How far below the joint (away from the back) the ring's middle is, and its half axes in and across the median plane,
/// metres.
struct Section {
    drop: f32,
    deep: f32,
    wide: f32,
}

const fn section(drop: f32, deep: f32, wide: f32) -> Section {
    Section { drop, deep, wide }
}

/// Dock, croup, the four spine tips (the last the withers), breast.
const TRUNK: [Section; 7] = [
    section(0.1, 0.15, 0.13),
    section(0.25, 0.26, 0.23),
    section(0.27, 0.27, 0.26),
    section(0.31, 0.31, 0.28),
    section(0.34, 0.345, 0.26),
    section(0.36, 0.36, 0.2),
    section(0.46, 0.21, 0.16),
];
/// The breast is this far before the withers.
const BREAST_M: f32 = 0.2;
/// Withers, two joints of the neck, poll.
const NECK: [Section; 4] = [
    section(0.25, 0.26, 0.12),
    section(0.15, 0.18, 0.095),
    section(0.09, 0.13, 0.08),
    section(0.05, 0.1, 0.07),
];
/// Share of the head's length from poll to muzzle, and the section there.
const HEAD: [(f32, Section); 5] = [
    (0.0, section(0.03, 0.085, 0.07)),
    (0.22, section(0.07, 0.14, 0.085)),
    (0.5, section(0.05, 0.105, 0.065)),
    (0.78, section(0.035, 0.078, 0.05)),
    (0.95, section(0.04, 0.072, 0.052)),
];

/// The parts of a horse; a ghost is its bones alone.
pub(super) fn parts(joints: &Joints, frame: &Frame, ghost: bool) -> Vec<Part> {
    if ghost {
        return (0..BONE_COUNT).map(|i| bone_rod(joints, frame, i, &round(GHOST_M, GHOST_M))).collect();
    }
    let mut parts = vec![trunk(joints, frame), neck(joints, frame), head(joints, frame)];
    parts.extend(hair(joints, frame));
    for limb in Limb::ALL {
        let shapes = if limb.pair() == Pair::Fore { &FORE } else { &HIND };
        let bones = limb.first_bone() + 1..=limb.hoof_bone();
        parts.extend(bones.zip(shapes).map(|(index, shape)| bone_rod(joints, frame, index, shape)));
        let (fetlock, toe) = (joints.bases[limb.hoof_bone()], joints.toe(limb));
        let wall = [HOOF_FROM, HOOF_TO].map(|share| fetlock.lerp(toe, share));
        parts.push(rod_part(wall, frame, &HOOF, Tone::Limb(limb)));
    }
    parts
}

fn bone_rod(joints: &Joints, frame: &Frame, index: usize, shape: &Thickness) -> Part {
    let tone = Skeleton::limb_of(index).map_or(Tone::Trunk, Tone::Limb);
    rod_part([joints.bases[index], joints.tips[index]], frame, shape, tone)
}

fn rod_part(ends: [Vec3; 2], frame: &Frame, shape: &Thickness, tone: Tone) -> Part {
    let scaled = |axes: [f32; 2]| axes.map(|v| v * frame.size);
    let surface = rod(ends, frame.across, scaled(shape.deep), scaled(shape.wide), LIMB_SEGMENTS);
    Part { surface, tone }
}

/// A ring below a joint, across the direction of the body there.
fn ring(at: Vec3, along: Vec3, section: &Section, frame: &Frame) -> Ring {
    let down = along.cross(frame.across);
    Ring {
        centre: at + down * (section.drop * frame.size),
        along,
        deep: down * (section.deep * frame.size),
        wide: frame.across * (section.wide * frame.size),
    }
}

fn direction(from: Vec3, to: Vec3) -> Vec3 {
    (to - from).normalize_or(Vec3::X)
}

/// Rings at the joints of a chain, each halfway between the directions before and after it.
fn rings_along<'a>(chain: &[Vec3], sections: impl Iterator<Item = &'a Section>, frame: &Frame) -> Vec<Ring> {
    let last = chain.len() - 1;
    let along = |i: usize| direction(chain[i.saturating_sub(1)], chain[(i + 1).min(last)]);
    sections.zip(chain).enumerate().map(|(i, (section, &at))| ring(at, along(i), section, frame)).collect()
}

fn trunk(joints: &Joints, frame: &Frame) -> Part {
    let spine = &joints.tips[bone::SPINE..=bone::SPINE_LAST];
    let withers = joints.tips[bone::SPINE_LAST];
    let forward = direction(joints.bases[bone::SPINE_LAST], withers);
    let mut chain = vec![joints.root];
    chain.extend(spine);
    let mut rings = vec![ring(joints.dock, direction(joints.root, withers), &TRUNK[0], frame)];
    rings.extend(rings_along(&chain, TRUNK[1..].iter(), frame));
    rings.push(ring(withers + forward * (BREAST_M * frame.size), forward, &TRUNK[6], frame));
    let caps = [0.08, 0.1].map(|v| v * frame.size);
    Part { surface: loft(&rings, caps, TRUNK_SEGMENTS), tone: Tone::Trunk }
}

fn neck(joints: &Joints, frame: &Frame) -> Part {
    let mut chain = vec![joints.bases[bone::NECK]];
    chain.extend(&joints.tips[bone::NECK..=bone::NECK_LAST]);
    let rings = rings_along(&chain, NECK.iter(), frame);
    let caps = [0.08, 0.05].map(|v| v * frame.size);
    Part { surface: loft(&rings, caps, TRUNK_SEGMENTS), tone: Tone::Trunk }
}

fn head(joints: &Joints, frame: &Frame) -> Part {
    let (poll, muzzle) = (joints.bases[bone::HEAD], joints.tips[bone::HEAD]);
    let along = direction(poll, muzzle);
    let rings: Vec<Ring> =
        HEAD.iter().map(|(share, section)| ring(poll.lerp(muzzle, *share), along, section, frame)).collect();
    Part { surface: loft(&rings, [0.05, 0.04].map(|v| v * frame.size), TRUNK_SEGMENTS), tone: Tone::Trunk }
}

/// Ears and tail, so that it is plain which end is which.
fn hair(joints: &Joints, frame: &Frame) -> Vec<Part> {
    let metres = frame.size;
    let (poll, muzzle) = (joints.bases[bone::HEAD], joints.tips[bone::HEAD]);
    let along_head = direction(poll, muzzle);
    let ear =
        (along_head.cross(frame.across) + along_head * 0.6).normalize_or(Vec3::NEG_Y) * (-0.13 * metres);
    let ears = [-0.045, 0.045].map(|side| {
        let from = poll + frame.across * (side * metres) + ear * 0.2;
        rod_part([from, from + ear], frame, &round(0.032, 0.008), Tone::Hair)
    });
    let forward = direction(joints.root, joints.tips[bone::SPINE_LAST]);
    let down = forward.cross(frame.across);
    let tail = |back: f32, below: f32| joints.dock + (down * below - forward * back) * metres;
    let tail = [tail(0.02, 0.03), tail(0.2, 0.1), tail(0.3, 0.35), tail(0.33, 0.7)];
    let widths = [round(0.04, 0.055), round(0.055, 0.06), round(0.06, 0.02)];
    let tail = tail
        .windows(2)
        .zip(widths)
        .map(|(ends, width)| rod_part([ends[0], ends[1]], frame, &width, Tone::Hair));
    ears.into_iter().chain(tail).collect()
}
