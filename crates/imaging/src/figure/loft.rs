//! Surfaces: rings joined one to the next by smooth curves, with rounded ends.

use std::f32::consts::{FRAC_PI_2, TAU};

use glam::Vec3;

/// Rings of a rounded end beyond the last one: 30, 60 and 90 degrees.
const CAP_RINGS: i32 = 3;

/// One closed curve across a limb or the trunk: an ellipse, or an egg.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    /// Middle, world space.
    pub(super) centre: Vec3,
    /// From the middle to the front of a leg, or to the top of the body.
    pub(super) deep: Vec3,
    /// Half axis across.
    pub(super) wide: Vec3,
    /// How much wider the ring is where it points along `deep` than in its middle, as a share; negative is wider at the other end.
    pub(super) egg: f32,
    /// How much of the part's second colour, 0 to 1.
    pub(super) tint: f32,
    /// How much the surface is drawn to that of the trunk, 0 to 1.
    pub(super) flow: f32,
}

impl Ring {
    /// An ellipse in the part's first colour.
    pub(super) const fn plain(centre: Vec3, deep: Vec3, wide: Vec3) -> Self {
        Self { centre, deep, wide, egg: 0.0, tint: 0.0, flow: 0.0 }
    }
}

/// Triangles with a normal and a tint at each vertex, world space.
#[derive(Clone, Debug, Default)]
pub(super) struct Surface {
    pub(super) points: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    pub(super) tints: Vec<f32>,
    /// Counter-clockwise as seen from outside.
    pub(super) triangles: Vec<[u32; 3]>,
}

/// How a loft is made of its rings.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mesh {
    /// Rings drawn for each given one, on a smooth curve through them.
    pub(super) steps: u32,
    /// Corners of a ring.
    pub(super) segments: u32,
    /// Lengths of the rounded ends, metres.
    pub(super) caps_m: [f32; 2],
}

/// The closed surface through rings.
pub(super) fn loft(rings: &[Ring], mesh: Mesh) -> Surface {
    loft_onto(rings, mesh, None)
}

/// The trunk: what legs are drawn to.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trunk<'a> {
    pub(super) rings: &'a [Ring],
    pub(super) mesh: Mesh,
    /// The surface through the rings with this mesh.
    pub(super) surface: &'a Surface,
}

/// The closed surface through rings, drawn to a trunk where these flow.
pub(super) fn loft_onto(rings: &[Ring], mesh: Mesh, trunk: Option<Trunk<'_>>) -> Surface {
    let [first, second, ..] = rings else { return Surface::default() };
    let last = [rings[rings.len() - 1], rings[rings.len() - 2]];
    let outward = [first.outward(second), last[0].outward(&last[1])];
    let mut all: Vec<Ring> = Vec::new();
    all.extend((1..=CAP_RINGS).rev().map(|i| first.cap(outward[0] * mesh.caps_m[0], i)));
    for i in 0..rings.len() - 1 {
        let at = |k: usize| &rings[k.min(rings.len() - 1)];
        let four = [at(i.saturating_sub(1)), at(i), at(i + 1), at(i + 2)];
        all.extend((0..mesh.steps).map(|step| between(four, step as f32 / mesh.steps as f32)));
    }
    all.push(last[0]);
    all.extend((1..=CAP_RINGS).map(|i| last[0].cap(outward[1] * mesh.caps_m[1], i)));
    let trunk = trunk.filter(|trunk| trunk.rings.len() > 1);
    Surface::through(&all, mesh.segments, outward, trunk)
}

impl Trunk<'_> {
    /// The ring beside a point, the number of the one before it, and the point in it: its shares of the half axes.
    fn beside(&self, point: Vec3) -> (Ring, usize, [f32; 2]) {
        let along = |pair: &[Ring]| {
            let axis = pair[1].centre - pair[0].centre;
            let share = (point - pair[0].centre).dot(axis) / axis.length_squared().max(1e-9);
            let share = share.clamp(0.0, 1.0);
            ((pair[0].centre + axis * share).distance_squared(point), share)
        };
        let nearest = self.rings.windows(2).map(along).enumerate().min_by(|a, b| a.1.0.total_cmp(&b.1.0));
        let (i, (_, share)) = nearest.unwrap_or_default();
        let (from, to) = (&self.rings[i], &self.rings[i + 1]);
        let ring = Ring {
            centre: from.centre.lerp(to.centre, share),
            deep: from.deep.lerp(to.deep, share),
            wide: from.wide.lerp(to.wide, share),
            egg: from.egg + (to.egg - from.egg) * share,
            ..*from
        };
        let within = point - ring.centre;
        let deep = within.dot(ring.deep) / ring.deep.length_squared().max(1e-9);
        let wide = within.dot(ring.wide) / ring.wide.length_squared().max(1e-9);
        (ring, i, [deep, wide / (1.0 + ring.egg * deep.clamp(-1.0, 1.0)).max(0.1)])
    }

    /// Lets a point down on the trunk as far as it stands out of it.
    fn draw(&self, point: &mut Vec3, flow: f32) {
        let (beside, _, [deep, wide]) = self.beside(*point);
        let out = deep.hypot(wide);
        if out > 1.0 {
            let kept = 1.0 + (out - 1.0) * (1.0 - flow);
            let wider = 1.0 + beside.egg * deep.clamp(-1.0, 1.0);
            let in_ring = beside.deep * deep + beside.wide * (wide * wider);
            *point += in_ring * (kept / out - 1.0);
        }
    }

    /// Turns a normal to those of the trunk around the point.
    fn turn(&self, point: Vec3, normal: &mut Vec3, flow: f32) {
        let (_, ring, _) = self.beside(point);
        let first = CAP_RINGS as usize + ring.saturating_sub(1) * self.mesh.steps as usize;
        let last = CAP_RINGS as usize + (ring + 2).min(self.rings.len() - 1) * self.mesh.steps as usize;
        let corners = self.mesh.segments as usize;
        let around = first * corners..((last + 1) * corners).min(self.surface.points.len());
        let weighted = around.map(|at| {
            let nearness = 1.0 / (self.surface.points[at].distance_squared(point) + self.nearest_m2());
            self.surface.normals[at] * (nearness * nearness)
        });
        let trunk = weighted.sum::<Vec3>().normalize_or(*normal);
        *normal = normal.lerp(trunk, flow).normalize_or(*normal);
    }

    /// Nearer than the root of this, all points count the same.
    fn nearest_m2(&self) -> f32 {
        self.rings[0].deep.length_squared() * 0.05
    }
}

/// The ring at a share of the way from the second to the third of four, on a Catmull-Rom curve.
fn between([a, b, c, d]: [&Ring; 4], t: f32) -> Ring {
    let weights = [
        t * (-0.5 + t * (1.0 - 0.5 * t)),
        1.0 + t * t * (-2.5 + 1.5 * t),
        t * (0.5 + t * (2.0 - 1.5 * t)),
        t * t * (-0.5 + 0.5 * t),
    ];
    let [u, v, w, x] = weights;
    let mix = |of: fn(&Ring) -> Vec3| of(a) * u + of(b) * v + of(c) * w + of(d) * x;
    let linear = |of: fn(&Ring) -> f32| of(b) + (of(c) - of(b)) * t;
    Ring {
        centre: mix(|ring| ring.centre),
        deep: mix(|ring| ring.deep),
        wide: mix(|ring| ring.wide),
        egg: linear(|ring| ring.egg),
        tint: linear(|ring| ring.tint),
        flow: linear(|ring| ring.flow),
    }
}

/// A tapered round rod with round ends: `thick_m` are its half thicknesses at base and tip.
pub(super) fn rod([base, tip]: [Vec3; 2], thick_m: [f32; 2], segments: u32) -> Surface {
    let along = (tip - base).normalize_or(Vec3::NEG_Y);
    let wide = along.any_orthonormal_vector();
    let deep = along.cross(wide);
    let ring = |centre, thick: f32| Ring::plain(centre, deep * thick, wide * thick);
    let rings = [ring(base, thick_m[0]), ring(tip, thick_m[1])];
    loft(&rings, Mesh { steps: 1, segments, caps_m: thick_m })
}

impl Ring {
    /// The unit normal of the ring that points away from its neighbour.
    fn outward(&self, neighbour: &Self) -> Vec3 {
        let away = self.centre - neighbour.centre;
        let normal = self.deep.cross(self.wide).normalize_or(away.normalize_or(Vec3::Y));
        if normal.dot(away) < 0.0 { -normal } else { normal }
    }

    fn cap(&self, reach: Vec3, step: i32) -> Self {
        let (sin, cos) = (FRAC_PI_2 * step as f32 / CAP_RINGS as f32).sin_cos();
        Self { centre: self.centre + reach * sin, deep: self.deep * cos, wide: self.wide * cos, ..*self }
    }
}

impl Surface {
    fn through(rings: &[Ring], segments: u32, outward: [Vec3; 2], trunk: Option<Trunk<'_>>) -> Self {
        let mut surface = Self::default();
        let circle: Vec<[f32; 2]> =
            (0..segments).map(|k| (TAU * k as f32 / segments as f32).sin_cos().into()).collect();
        for ring in rings {
            surface.points.extend(circle.iter().map(|&[sin, cos]| {
                ring.centre + ring.deep * cos + ring.wide * (sin * (1.0 + ring.egg * cos))
            }));
            surface.tints.extend(circle.iter().map(|_| ring.tint));
        }
        let corners = segments as usize;
        let flowing = || {
            let flows = rings.iter().enumerate().filter(|(_, ring)| ring.flow > 0.0);
            flows.flat_map(|(i, ring)| (i * corners..(i + 1) * corners).map(|at| (at, ring.flow)))
        };
        if let Some(trunk) = trunk {
            flowing().for_each(|(at, flow)| trunk.draw(&mut surface.points[at], flow));
        }
        for ring in 0..rings.len() as u32 - 1 {
            for k in 0..segments {
                let (a, b) = (ring * segments + k, ring * segments + (k + 1) % segments);
                surface.triangles.extend([[a, a + segments, b], [b, a + segments, b + segments]]);
            }
        }
        // A mirrored leg is wound the other way round.
        if surface.volume() < 0.0 {
            surface.triangles.iter_mut().for_each(|triangle| triangle.swap(1, 2));
        }
        surface.find_normals(corners, outward);
        if let Some(trunk) = trunk {
            let Self { points, normals, .. } = &mut surface;
            flowing().for_each(|(at, flow)| trunk.turn(points[at], &mut normals[at], flow));
        }
        surface
    }

    /// Six times the volume within, positive when the triangles face outwards.
    fn volume(&self) -> f32 {
        let middle = self.points[0];
        let corners = |t: &[u32; 3]| t.map(|i| self.points[i as usize] - middle);
        self.triangles.iter().map(corners).map(|[a, b, c]| a.dot(b.cross(c))).sum()
    }

    fn find_normals(&mut self, segments: usize, outward: [Vec3; 2]) {
        let mut normals = vec![Vec3::ZERO; self.points.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|i| self.points[i as usize]);
            // As long as twice the area: large faces count more.
            let normal = (b - a).cross(c - a);
            triangle.iter().for_each(|&i| normals[i as usize] += normal);
        }
        // All points of an end are one.
        let last = normals.len() - segments;
        normals[..segments].fill(outward[0]);
        normals[last..].fill(outward[1]);
        self.normals = normals.into_iter().map(Vec3::normalize_or_zero).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rod_is_closed_and_faces_outwards() {
        for tip in [Vec3::X, Vec3::new(0.3, -1.0, 0.2), Vec3::Z] {
            let surface = rod([Vec3::ZERO, tip], [0.1, 0.1], 24);
            let volume = surface.volume() / 6.0;
            let expected = std::f32::consts::PI * (0.01 * tip.length() + 4.0 / 3.0 * 0.001);
            assert!((volume / expected - 1.0).abs() < 0.05, "{volume} {expected}");
            for (point, normal) in surface.points.iter().zip(&surface.normals) {
                let axis = tip * (point.dot(tip) / tip.length_squared()).clamp(0.0, 1.0);
                assert!((*point - axis).dot(*normal) > 0.09, "{point} {normal}");
            }
        }
    }
}
