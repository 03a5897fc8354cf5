//! The horse's body over its joints.

use glam::Vec3;
use muybridge_core::{BONE_COUNT, Joints, Limb, Pair, Side, Skeleton};

use super::frames::{BoneFrame, Frames};
use super::hair;
use super::hoof::Hoof;
use super::loft::{Mesh, Ring, Surface, Trunk, loft, loft_onto, rod};
use super::sections::{BODY, Edge, FORE, HEAD, HIND, Section};
use super::terrain::Floor;

/// What colours a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Tone {
    /// Neck, head, barrel.
    Trunk,
    /// Mane and tail.
    Hair,
    /// Horn of the hooves.
    Hoof,
    /// Eyes.
    Eye,
    /// A leg from elbow or gaskin down.
    Limb(Limb),
    /// A colour of its own.
    Own([u8; 3]),
}

/// A part of the body.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub(super) surface: Surface,
    /// Colours where the surface's tint is 0 and 1.
    pub(super) tones: [Tone; 2],
}

/// Bones of a leg.
const BONES_OF_LEG: usize = 5;
/// Half thickness of a ghost's bones, metres.
const GHOST_M: f32 = 0.022;
/// Corners of a ghost's bone.
const GHOST_SEGMENTS: u32 = 8;
/// The skin is drawn at this many rings for each section, with so many corners: legs are a few pixels wide, the barrel is large.
const BODY_MESH: [u32; 2] = [3, 20];
const HEAD_MESH: [u32; 2] = [2, 16];
const LEG_MESH: [u32; 2] = [2, 10];

impl Part {
    pub(super) fn plain(surface: Surface, tone: Tone) -> Self {
        Self { surface, tones: [tone; 2] }
    }
}

/// The parts of a horse.
pub(super) fn parts(frames: &Frames, standing: [bool; 4], floor: &Floor<'_>) -> Vec<Part> {
    let rings: Vec<Ring> = BODY.iter().map(|section| frames.ring(0, section, 0.0)).collect();
    let mesh = mesh(BODY_MESH, [0.07, 0.03], frames);
    let body = loft(&rings, mesh);
    let trunk = Trunk { rings: &rings, mesh, surface: &body };
    let mut parts = vec![head(frames)];
    hair::add(frames, floor, &mut parts);
    for limb in Limb::ALL {
        let hoof = Hoof::of(frames, limb, standing[limb.index()], floor);
        parts.push(leg(frames, limb, hoof.coronet(), trunk));
        parts.push(hoof.part());
    }
    parts.push(Part::plain(body, Tone::Trunk));
    parts
}

/// The bones of a horse alone.
pub(super) fn bones(joints: &Joints, frames: &Frames) -> Vec<Part> {
    let thick = [GHOST_M * frames.size; 2];
    let part = |i| {
        let tone = Skeleton::limb_of(i).map_or(Tone::Trunk, Tone::Limb);
        Part::plain(rod([joints.bases[i], joints.tips[i]], thick, GHOST_SEGMENTS), tone)
    };
    (0..BONE_COUNT).map(part).collect()
}

fn mesh([steps, segments]: [u32; 2], caps: [f32; 2], frames: &Frames) -> Mesh {
    Mesh { steps, segments, caps_m: caps.map(|v| v * frames.size) }
}

impl Frames {
    /// A point of the outline; bones of the edge are counted from `first`.
    fn edge(&self, first: usize, edge: Edge) -> Vec3 {
        let bone = self.edge_bone(first, edge);
        bone.base.lerp(bone.tip, edge.share) + bone.fore * (edge.off * self.size)
    }

    fn edge_bone(&self, first: usize, edge: Edge) -> &BoneFrame {
        self.bone(if edge.bone < BONES_OF_LEG { first + edge.bone } else { edge.bone })
    }

    /// A ring of the body or of a leg whose outside is on the side `outside` of the horse.
    fn ring(&self, first: usize, section: &Section, outside: f32) -> Ring {
        let (also, weight) = section.aft_also;
        let fore = self.edge(first, section.fore);
        let aft = self.edge(first, section.aft).lerp(self.edge(first, also), weight);
        let [front, behind] = [section.fore, section.aft].map(|edge| self.edge_bone(first, edge).across);
        let across = (front + behind).normalize_or(front);
        let [outer, inner] = section.wide.map(|v| v * self.size);
        Ring {
            centre: (fore + aft) / 2.0 + across * (outside * (outer - inner) / 2.0),
            deep: (fore - aft) / 2.0,
            wide: across * ((outer + inner) / 2.0),
            egg: section.egg,
            tint: section.tint,
            flow: section.flow,
        }
    }
}

fn head(frames: &Frames) -> Part {
    let rings: Vec<Ring> = HEAD.iter().map(|section| frames.ring(0, section, 0.0)).collect();
    Part::plain(loft(&rings, mesh(HEAD_MESH, [0.04, 0.03], frames)), Tone::Trunk)
}

fn leg(frames: &Frames, limb: Limb, coronet: Ring, trunk: Trunk<'_>) -> Part {
    let sections: &[Section] = if limb.pair() == Pair::Fore { &FORE } else { &HIND };
    let outside = if limb.side() == Side::Right { 1.0 } else { -1.0 };
    let ring = |section: &Section| frames.ring(limb.first_bone(), section, outside);
    let rings: Vec<Ring> = sections.iter().map(ring).chain([coronet]).collect();
    let surface = loft_onto(&rings, mesh(LEG_MESH, [0.05, 0.01], frames), Some(trunk));
    Part { surface, tones: [Tone::Trunk, Tone::Limb(limb)] }
}
