//! Where the scene is seen from.

use std::ops::Range;

use glam::{Vec2, Vec3};

/// The camera's distance per metre seen across the picture: like standing at the rail of a small arena.
const DISTANCE_PER_SEEN: f32 = 2.1;
/// Nothing nearer than this share of the camera's distance is drawn.
const NEAREST: f32 = 0.03;

/// A pinhole camera that looks at a point, always upright.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    target: Vec3,
    distance_m: f32,
    right: Vec3,
    up: Vec3,
    /// From the target to the camera, unit length.
    back: Vec3,
    /// Pixels per metre at the target's distance.
    px_per_m: f32,
    middle_px: Vec2,
}

impl Camera {
    /// A camera around a target. Yaw zero looks along -Z and sees the right side of a horse that faces X; a quarter turn sees it
    /// from before, minus a quarter from behind. For a horse with another heading add the heading to the yaw. `pitch_rad` is the
    /// camera's height as an angle; `seen_m` metres at the target fit across the width of a picture of `size_px`.
    pub fn orbit(target: Vec3, yaw_rad: f32, pitch_rad: f32, seen_m: f32, size_px: [f32; 2]) -> Self {
        let ((sin_yaw, cos_yaw), (sin_pitch, cos_pitch)) = (yaw_rad.sin_cos(), pitch_rad.sin_cos());
        Self {
            target,
            distance_m: DISTANCE_PER_SEEN * seen_m,
            right: Vec3::new(cos_yaw, 0.0, -sin_yaw),
            up: Vec3::new(-sin_yaw * sin_pitch, cos_pitch, -cos_yaw * sin_pitch),
            back: Vec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch),
            px_per_m: size_px[0] / seen_m,
            middle_px: Vec2::from(size_px) / 2.0,
        }
    }

    /// The same camera with a picture of `factor` times the pixels along each side.
    #[must_use]
    pub fn finer(self, factor: f32) -> Self {
        Self { px_per_m: self.px_per_m * factor, middle_px: self.middle_px * factor, ..self }
    }

    /// The same picture of the target from another distance, metres: nearer makes near things larger against far ones.
    #[must_use]
    pub fn from_distance(self, distance_m: f32) -> Self {
        Self { distance_m, ..self }
    }

    /// Where the camera is, world space, metres.
    pub fn eye(&self) -> Vec3 {
        self.target + self.back * self.distance_m
    }

    /// Picture x and y (px) and one over the distance along the line of sight (1/m); none behind the camera.
    pub fn project(&self, point: Vec3) -> Option<Vec3> {
        let from_target = point - self.target;
        let depth = self.distance_m - from_target.dot(self.back);
        (depth > NEAREST * self.distance_m).then(|| {
            let scale = self.px_per_m * self.distance_m / depth;
            let (x, y) = (from_target.dot(self.right), from_target.dot(self.up));
            Vec3::new(self.middle_px.x + scale * x, self.middle_px.y - scale * y, 1.0 / depth)
        })
    }

    /// Columns and rows of the picture in which a ball is seen, from the picture's edge on; none when it is behind the camera.
    pub(super) fn around(&self, middle: Vec3, radius_m: f32) -> Option<[Range<usize>; 2]> {
        let depth = self.distance_m - (middle - self.target).dot(self.back);
        let near = depth - radius_m;
        if near <= NEAREST * self.distance_m {
            return (depth + radius_m > 0.0).then_some([0..usize::MAX, 0..usize::MAX]);
        }
        let at = self.project(middle)?;
        let reach = self.px_per_m * self.distance_m * radius_m / near;
        // Seen askew, a ball is a little wider than from straight ahead.
        let around =
            |at: f32| (at - 1.5 * reach).max(0.0) as usize..(at + 1.5 * reach + 1.0).max(0.0) as usize;
        Some([around(at.x), around(at.y)])
    }

    /// The line of sight through a place in the picture, as long as to go one metre away from the camera.
    pub(super) fn ray(&self, [x_px, y_px]: [f32; 2]) -> Vec3 {
        let focal_px = self.px_per_m * self.distance_m;
        let (x, y) = ((x_px - self.middle_px.x) / focal_px, (self.middle_px.y - y_px) / focal_px);
        self.right * x + self.up * y - self.back
    }

    /// What the camera looks at.
    pub(super) fn target(&self) -> Vec3 {
        self.target
    }

    /// From the camera to its target, metres.
    pub(super) fn distance_m(&self) -> f32 {
        self.distance_m
    }

    /// How far a point is from being too near to be drawn, metres; negative is too near.
    pub(super) fn clearance_m(&self, point: Vec3) -> f32 {
        self.distance_m * (1.0 - NEAREST) - (point - self.target).dot(self.back)
    }

    /// How bright a coat with this normal is, and how much it shines, 0 to 1. The light comes from above the viewer's left
    /// shoulder, so that the horse is lit from every side; rims and undersides are darker.
    pub(super) fn light(&self, normal: Vec3) -> [f32; 2] {
        let key = (self.back * 0.55 + Vec3::Y * 0.75 - self.right * 0.4).normalize_or(Vec3::Y);
        let lit = normal.dot(key).max(0.0);
        let open_sky = 0.5 + 0.5 * normal.y;
        let facing = normal.dot(self.back).max(0.0);
        let half = (key + self.back).normalize_or(key);
        let shine = normal.dot(half).max(0.0).powi(24) * 0.13;
        [(0.24 + 0.26 * open_sky + 0.66 * lit) * (0.7 + 0.3 * facing), shine]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_side_view_has_the_head_on_the_right_and_up_above() {
        let size = [360.0, 260.0];
        let camera = Camera::orbit(Vec3::Y, 0.0, 0.1, 3.3, size);
        let at = |x: f32, y: f32, z: f32| camera.project(Vec3::new(x, y, z)).unwrap();
        assert!(at(0.0, 1.0, 0.0).truncate().distance(Vec2::from(size) / 2.0) < 1e-3);
        assert!(at(1.0, 1.0, 0.0).x > 200.0 && at(0.0, 2.0, 0.0).y < 100.0);
        assert!(at(0.0, 1.0, 1.0).z > at(0.0, 1.0, -1.0).z, "the horse's right is nearer");
        let front = Camera::orbit(Vec3::Y, std::f32::consts::FRAC_PI_2, 0.1, 3.3, size);
        assert!(front.project(Vec3::new(0.0, 1.0, 1.0)).unwrap().x < 180.0, "its right is on our left");
        assert!(camera.project(Vec3::new(0.0, 1.0, 50.0)).is_none());
    }
}
