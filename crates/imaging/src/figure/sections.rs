//! The shape of the body: where its outline runs beside the bones. Metres of the 1.60 m reference horse, by eye from side and
//! front views of light riding horses; they are for looking at, nothing is computed from them.

use super::frames::CROUP;

/// A point of the outline in the plane of a bone.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    /// The bone; one of a leg counts from the leg's first one, and what is more than a leg has is a bone of the body.
    pub(super) bone: usize,
    /// Share of the bone's length from its base.
    pub(super) share: f32,
    /// From the bone forward (of a leg) or up (of the body), metres.
    pub(super) off: f32,
}

/// One ring of the body between two points of the outline.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    /// In front of a leg, on top of the body.
    pub(super) fore: Edge,
    /// Behind a leg, under the body.
    pub(super) aft: Edge,
    /// A second place for `aft`, and how much it counts, 0 to 1: skin between two bones follows both.
    pub(super) aft_also: (Edge, f32),
    /// Half thickness to the outside and to the median plane, metres.
    pub(super) wide: [f32; 2],
    /// See [`super::loft::Ring::egg`].
    pub(super) egg: f32,
    /// How much of the leg's own colour, 0 to 1.
    pub(super) tint: f32,
    /// How much the skin is that of the trunk, 0 to 1: no part of it stands out then.
    pub(super) flow: f32,
}

type Place = (usize, f32, f32);

const fn edge((bone, share, off): Place) -> Edge {
    Edge { bone, share, off }
}

const fn leg(fore: Place, aft: Place, wide: [f32; 2], [tint, flow]: [f32; 2]) -> Section {
    Section { fore: edge(fore), aft: edge(aft), aft_also: (edge(aft), 0.0), wide, egg: 0.0, tint, flow }
}

const fn body(top: Place, bottom: Place, wide: f32, egg: f32) -> Section {
    throat(top, bottom, (bottom, 0.0), wide, egg)
}

const fn throat(top: Place, bottom: Place, (also, weight): (Place, f32), wide: f32, egg: f32) -> Section {
    Section {
        fore: edge(top),
        aft: edge(bottom),
        aft_also: (edge(also), weight),
        wide: [wide, wide],
        egg,
        tint: 0.0,
        flow: 0.0,
    }
}

/// Buttock, loin, back, withers, breast, neck up to the poll.
pub(super) const BODY: [Section; 18] = [
    body((CROUP, -0.02, 0.0), (CROUP, -0.3, -0.22), 0.1, -0.1),
    body((CROUP, 0.3, 0.012), (CROUP, -0.1, -0.38), 0.19, -0.1),
    body((CROUP, 0.7, 0.018), (CROUP, 0.5, -0.5), 0.232, -0.1),
    body((0, 0.0, 0.012), (0, 0.6, -0.555), 0.245, -0.05),
    body((0, 1.0, 0.01), (1, 0.4, -0.585), 0.258, -0.05),
    body((1, 1.0, 0.01), (2, 0.2, -0.63), 0.272, -0.08),
    body((2, 0.6, 0.004), (2, 0.8, -0.675), 0.268, -0.12),
    body((3, 0.15, 0.012), (3, 0.0, -0.7), 0.245, -0.2),
    body((3, 0.65, 0.022), (3, 0.5, -0.735), 0.215, -0.3),
    body((3, 1.0, 0.016), (3, 0.98, -0.7), 0.195, -0.4),
    body((4, 0.3, 0.004), (3, 1.68, -0.62), 0.18, -0.4),
    throat((4, 0.65, 0.005), (3, 2.2, -0.5), ((4, 0.31, -0.56), 0.2), 0.158, -0.25),
    throat((4, 1.0, 0.012), (4, 0.85, -0.43), ((3, 2.5, -0.34), 0.68), 0.132, -0.15),
    throat((5, 0.45, 0.02), (5, 0.3, -0.375), ((3, 3.19, -0.167), 0.36), 0.108, -0.1),
    throat((5, 1.0, 0.03), (6, 0.0, -0.295), ((4, 2.0, -0.32), 0.2), 0.087, -0.05),
    body((6, 0.45, 0.035), (6, 0.5, -0.228), 0.078, 0.0),
    body((6, 0.85, 0.03), (6, 0.9, -0.18), 0.071, 0.0),
    body((6, 1.02, 0.01), (6, 1.02, -0.12), 0.06, 0.0),
];

/// Poll, jowl and eye, nose, nostrils, lips.
pub(super) const HEAD: [Section; 8] = [
    body((7, -0.04, 0.035), (7, 0.06, -0.09), 0.062, 0.0),
    body((7, 0.1, 0.075), (7, 0.16, -0.15), 0.082, 0.0),
    body((7, 0.28, 0.083), (7, 0.32, -0.17), 0.09, 0.1),
    body((7, 0.43, 0.072), (7, 0.45, -0.13), 0.077, 0.05),
    body((7, 0.6, 0.055), (7, 0.6, -0.082), 0.057, 0.0),
    body((7, 0.76, 0.046), (7, 0.76, -0.066), 0.05, 0.0),
    body((7, 0.9, 0.046), (7, 0.9, -0.07), 0.056, 0.0),
    body((7, 0.985, 0.024), (7, 0.97, -0.062), 0.046, 0.0),
];

/// Shoulder blade to coronet: scapula 0, humerus 1, radius 2, metacarpal 3, pastern 4.
pub(super) const FORE: [Section; 14] = [
    leg((0, 0.28, 0.06), (0, 0.18, -0.16), [0.085, 0.04], [0.0, 1.0]),
    leg((0, 0.6, 0.085), (0, 0.52, -0.2), [0.1, 0.06], [0.0, 0.95]),
    leg((0, 0.98, 0.07), (1, 0.5, -0.2), [0.076, 0.08], [0.0, 0.75]),
    leg((1, 0.55, 0.078), (2, -0.1, -0.1), [0.072, 0.08], [0.1, 0.35]),
    leg((2, 0.1, 0.083), (2, 0.06, -0.09), [0.066, 0.066], [0.35, 0.15]),
    leg((2, 0.32, 0.07), (2, 0.3, -0.072), [0.058, 0.056], [0.75, 0.0]),
    leg((2, 0.6, 0.05), (2, 0.6, -0.052), [0.045, 0.044], [1.0, 0.0]),
    leg((2, 0.86, 0.042), (2, 0.86, -0.038), [0.041, 0.041], [1.0, 0.0]),
    leg((2, 1.0, 0.05), (2, 1.0, -0.044), [0.047, 0.047], [1.0, 0.0]),
    leg((3, 0.14, 0.04), (3, 0.14, -0.042), [0.04, 0.04], [1.0, 0.0]),
    leg((3, 0.36, 0.028), (3, 0.36, -0.037), [0.03, 0.03], [1.0, 0.0]),
    leg((3, 0.76, 0.028), (3, 0.76, -0.038), [0.03, 0.03], [1.0, 0.0]),
    leg((3, 1.0, 0.036), (3, 0.98, -0.05), [0.037, 0.037], [1.0, 0.0]),
    leg((4, 0.32, 0.03), (4, 0.26, -0.034), [0.031, 0.031], [1.0, 0.0]),
];

/// Croup and buttock to coronet: pelvis 0, femur 1, tibia 2, metatarsal 3, pastern 4.
pub(super) const HIND: [Section; 16] = [
    leg((CROUP, 1.15, -0.15), (CROUP, 0.0, -0.05), [0.085, 0.03], [0.0, 1.0]),
    leg((0, 0.85, 0.19), (CROUP, -0.31, -0.15), [0.1, 0.08], [0.0, 0.85]),
    leg((1, 0.42, 0.165), (1, 0.13, -0.375), [0.085, 0.1], [0.0, 0.5]),
    leg((1, 0.98, 0.085), (1, 0.48, -0.33), [0.075, 0.1], [0.05, 0.15]),
    leg((2, 0.12, 0.072), (2, 0.5, -0.235), [0.068, 0.07], [0.2, 0.0]),
    leg((2, 0.42, 0.07), (2, 0.68, -0.145), [0.058, 0.056], [0.55, 0.0]),
    leg((2, 0.75, 0.048), (2, 0.84, -0.092), [0.044, 0.042], [1.0, 0.0]),
    leg((2, 0.94, 0.046), (3, -0.17, -0.098), [0.038, 0.036], [1.0, 0.0]),
    leg((3, 0.04, 0.05), (3, 0.03, -0.088), [0.045, 0.045], [1.0, 0.0]),
    leg((3, 0.18, 0.037), (3, 0.18, -0.056), [0.038, 0.038], [1.0, 0.0]),
    leg((3, 0.4, 0.031), (3, 0.4, -0.042), [0.031, 0.031], [1.0, 0.0]),
    leg((3, 0.8, 0.031), (3, 0.8, -0.04), [0.03, 0.03], [1.0, 0.0]),
    leg((3, 0.93, 0.036), (3, 0.92, -0.048), [0.035, 0.035], [1.0, 0.0]),
    leg((3, 1.0, 0.038), (3, 0.99, -0.053), [0.038, 0.038], [1.0, 0.0]),
    leg((4, 0.14, 0.034), (4, 0.12, -0.042), [0.034, 0.034], [1.0, 0.0]),
    leg((4, 0.34, 0.03), (4, 0.28, -0.035), [0.031, 0.031], [1.0, 0.0]),
];
