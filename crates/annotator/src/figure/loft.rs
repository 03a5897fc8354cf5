//! Surfaces: rings of an ellipse, joined one to the next, with rounded ends.

use glam::Vec3;

/// Rings of a rounded end beyond the last one: 30, 60 and 90 degrees.
const CAP_RINGS: i32 = 3;

/// One ellipse across a limb or the trunk.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring {
    /// Middle, world space.
    pub(super) centre: Vec3,
    /// Direction in which the rings follow one another, unit length.
    pub(super) along: Vec3,
    /// Half axis in the median plane.
    pub(super) deep: Vec3,
    /// Half axis across.
    pub(super) wide: Vec3,
}

/// Triangles with a normal at each vertex, world space.
#[derive(Clone, Debug, Default)]
pub(super) struct Surface {
    pub(super) points: Vec<Vec3>,
    pub(super) normals: Vec<Vec3>,
    /// Counter-clockwise as seen from outside.
    pub(super) triangles: Vec<[u32; 3]>,
}

/// The surface through rings, closed by half ellipsoids of the given lengths (metres).
pub(super) fn loft(rings: &[Ring], [start_m, end_m]: [f32; 2], segments: u32) -> Surface {
    let (Some(first), Some(last)) = (rings.first(), rings.last()) else { return Surface::default() };
    let start = (1..=CAP_RINGS).rev().map(|i| cap(first, -start_m, i));
    let end = (1..=CAP_RINGS).map(|i| cap(last, end_m, i));
    let rings: Vec<Ring> = start.chain(rings.iter().copied()).chain(end).collect();
    let mut surface = Surface::default();
    for ring in &rings {
        surface.points.extend((0..segments).map(|k| {
            let (sin, cos) = (std::f32::consts::TAU * k as f32 / segments as f32).sin_cos();
            ring.centre + ring.deep * cos + ring.wide * sin
        }));
    }
    for ring in 0..rings.len() as u32 - 1 {
        for k in 0..segments {
            let (a, b) = (ring * segments + k, ring * segments + (k + 1) % segments);
            surface.triangles.extend([[a, a + segments, b], [b, a + segments, b + segments]]);
        }
    }
    surface.find_normals(&rings, segments);
    surface
}

/// A tapered rod with round ends: `deep` and `wide` are its half axes at base and tip, metres.
pub(super) fn rod(
    [base, tip]: [Vec3; 2],
    across: Vec3,
    deep: [f32; 2],
    wide: [f32; 2],
    segments: u32,
) -> Surface {
    let along = (tip - base).normalize_or(Vec3::NEG_Y);
    let wide_axis = (across - along * across.dot(along)).normalize_or(along.any_orthonormal_vector());
    let deep_axis = along.cross(wide_axis);
    let ring =
        |centre, i: usize| Ring { centre, along, deep: deep_axis * deep[i], wide: wide_axis * wide[i] };
    loft(&[ring(base, 0), ring(tip, 1)], [0, 1].map(|i| deep[i].min(wide[i])), segments)
}

fn cap(ring: &Ring, length_m: f32, step: i32) -> Ring {
    let (sin, cos) = (std::f32::consts::FRAC_PI_2 * step as f32 / CAP_RINGS as f32).sin_cos();
    let centre = ring.centre + ring.along * (length_m * sin);
    Ring { centre, along: ring.along, deep: ring.deep * cos, wide: ring.wide * cos }
}

impl Surface {
    fn find_normals(&mut self, rings: &[Ring], segments: u32) {
        let mut normals = vec![Vec3::ZERO; self.points.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|i| self.points[i as usize]);
            // As long as twice the area: large faces count more.
            let normal = (b - a).cross(c - a);
            triangle.iter().for_each(|&i| normals[i as usize] += normal);
        }
        // All points of an end are one.
        let ends = [(0, -rings[0].along), (rings.len() - 1, rings[rings.len() - 1].along)];
        for (ring, outward) in ends {
            let from = ring * segments as usize;
            normals[from..from + segments as usize].fill(outward);
        }
        self.normals = normals.into_iter().map(Vec3::normalize_or_zero).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rod_is_closed_and_faces_outwards() {
        for tip in [Vec3::X, Vec3::new(0.3, -1.0, 0.2), Vec3::Z] {
            let surface = rod([Vec3::ZERO, tip], Vec3::Z, [0.1, 0.1], [0.1, 0.1], 24);
            let volume: f32 = surface
                .triangles
                .iter()
                .map(|t| t.map(|i| surface.points[i as usize]))
                .map(|[a, b, c]| a.dot(b.cross(c)) / 6.0)
                .sum();
            let expected = std::f32::consts::PI * (0.01 * tip.length() + 4.0 / 3.0 * 0.001);
            assert!((volume / expected - 1.0).abs() < 0.05, "{volume} {expected}");
            for (point, normal) in surface.points.iter().zip(&surface.normals) {
                let axis = tip * (point.dot(tip) / tip.length_squared()).clamp(0.0, 1.0);
                assert!((*point - axis).dot(*normal) > 0.09, "{point} {normal}");
            }
        }
    }
}
