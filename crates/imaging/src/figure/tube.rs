//! Bodies made of tubes: figures that are not horses.

use glam::{Vec2, Vec3};

use super::Tube;
use super::body::{Part, Tone};
use super::loft::{Mesh, Ring, loft};

/// Rings drawn for each section, and corners of a ring.
const STEPS: u32 = 3;
const SEGMENTS: u32 = 14;
/// A rounded end is so long, in mean radii of its section.
const CAP: f32 = 0.8;

/// A section whose numbers are numbers.
#[derive(Clone, Copy)]
struct Section {
    at: Vec3,
    radii_m: Vec2,
}

impl Tube {
    /// Sections that can be drawn.
    fn sections(&self) -> Vec<Section> {
        let all = self
            .points
            .iter()
            .zip(&self.radii_m)
            .map(|(&at, &radii_m)| Section { at, radii_m: radii_m.abs() });
        all.filter(|section| section.at.is_finite() && section.radii_m.is_finite()).collect()
    }

    /// Its surface; none when fewer than two sections can be drawn.
    pub(super) fn part(&self) -> Option<Part> {
        let sections = self.sections();
        let [first, .., last] = sections.as_slice() else { return None };
        let caps_m = [first, last].map(|section| CAP * section.radii_m.element_sum() / 2.0);
        let rings: Vec<Ring> = (0..sections.len()).map(|i| self.ring(&sections, i)).collect();
        let surface = loft(&rings, Mesh { steps: STEPS, segments: SEGMENTS, caps_m });
        Some(Part::plain(surface, Tone::Own(self.color)))
    }

    /// The ring of a section, across the way from the section before to the one after.
    fn ring(&self, sections: &[Section], i: usize) -> Ring {
        let (before, after) = (sections[i.saturating_sub(1)], sections[(i + 1).min(sections.len() - 1)]);
        let whole = sections[sections.len() - 1].at - sections[0].at;
        let along = (after.at - before.at).normalize_or(whole.normalize_or(Vec3::X));
        let wanted = if self.up.is_finite() { self.up } else { Vec3::Y };
        let deep = wanted.reject_from_normalized(along).try_normalize();
        let deep = deep.unwrap_or_else(|| along.any_orthonormal_vector());
        let Section { at, radii_m: Vec2 { x: wide_m, y: deep_m } } = sections[i];
        Ring::plain(at, deep * deep_m, along.cross(deep) * wide_m)
    }

    /// Both ends and the widest section's half width, metres; none when it cannot be drawn.
    pub(super) fn extent(&self) -> Option<([Vec3; 2], f32)> {
        let sections = self.sections();
        let [first, .., last] = sections.as_slice() else { return None };
        let wide_m = sections.iter().map(|section| section.radii_m.x).fold(0.0, f32::max);
        Some(([first.at, last.at], wide_m))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tube(points: &[Vec3], radius_m: Vec2) -> Tube {
        Tube {
            points: points.to_vec(),
            radii_m: vec![radius_m; points.len()],
            up: Vec3::Y,
            color: [200, 90, 40],
        }
    }

    #[test]
    fn a_straight_tube_is_as_wide_high_and_long_as_asked_and_faces_outwards() {
        let part = tube(&[Vec3::ZERO, Vec3::X, Vec3::X * 2.0], Vec2::new(0.2, 0.1)).part().unwrap();
        let surface = part.surface;
        let reach = |axis: Vec3| surface.points.iter().map(|p| p.dot(axis)).fold(f32::NEG_INFINITY, f32::max);
        assert!((reach(Vec3::Z) - 0.2).abs() < 0.01 && (reach(Vec3::Y) - 0.1).abs() < 1e-3);
        assert!((reach(Vec3::X) - 2.12).abs() < 1e-3 && (reach(Vec3::NEG_X) - 0.12).abs() < 1e-3);
        for (point, normal) in surface.points.iter().zip(&surface.normals) {
            let axis = Vec3::X * point.x.clamp(0.0, 2.0);
            assert!((*point - axis).dot(*normal) > 0.0, "{point} {normal}");
        }
    }

    #[test]
    fn sections_that_are_no_numbers_are_left_out() {
        let broken = tube(&[Vec3::ZERO, Vec3::NAN, Vec3::X, Vec3::splat(f32::INFINITY)], Vec2::splat(0.1));
        let whole = tube(&[Vec3::ZERO, Vec3::X], Vec2::splat(0.1));
        assert_eq!(broken.part().unwrap().surface.points, whole.part().unwrap().surface.points);
        assert!(tube(&[Vec3::ZERO, Vec3::NAN], Vec2::ONE).part().is_none());
        assert!(tube(&[Vec3::ZERO], Vec2::ONE).part().is_none() && tube(&[], Vec2::ONE).part().is_none());
    }

    #[test]
    fn points_that_coincide_and_an_up_along_the_tube_give_numbers() {
        let mut odd = tube(&[Vec3::ZERO, Vec3::ZERO, Vec3::Y, Vec3::Y, Vec3::ZERO], Vec2::splat(0.1));
        for up in [Vec3::Y, Vec3::ZERO, Vec3::NAN] {
            odd.up = up;
            let surface = odd.part().unwrap().surface;
            assert!(surface.points.iter().chain(&surface.normals).all(|v| v.is_finite()));
        }
    }
}
