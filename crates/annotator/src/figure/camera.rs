//! Where the figure is seen from.

use glam::{Vec2, Vec3};

/// Distance from the horse, metres per reference horse: like standing at the rail of a small arena.
const DISTANCE_M: f32 = 7.0;
/// What is seen at the horse's distance without zoom, metres: a galloping horse with room around it.
const SEEN_M: [f32; 2] = [3.3, 2.7];
/// Nothing nearer than this is drawn, metres.
const NEAREST_M: f32 = 0.2;

/// A pinhole camera that looks at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Camera {
    target: Vec3,
    distance_m: f32,
    right: Vec3,
    up: Vec3,
    /// From the target to the camera, unit length.
    pub(super) back: Vec3,
    pixels_per_m: f32,
    middle: Vec2,
}

impl Camera {
    /// A camera around a target. Yaw zero looks along -Z (the horse faces right), a quarter turn looks along -X.
    /// `horse` is the animal's size in reference horses, `size` that of the picture in pixels.
    pub(super) fn new(target: Vec3, [yaw, pitch, zoom]: [f32; 3], horse: f32, size: Vec2) -> Self {
        let ((sin_yaw, cos_yaw), (sin_pitch, cos_pitch)) = (yaw.sin_cos(), pitch.sin_cos());
        let fitted = (size.x / SEEN_M[0]).min(size.y / SEEN_M[1]) / horse;
        Self {
            target,
            distance_m: DISTANCE_M * horse,
            right: Vec3::new(cos_yaw, 0.0, -sin_yaw),
            up: Vec3::new(-sin_yaw * sin_pitch, cos_pitch, -cos_yaw * sin_pitch),
            back: Vec3::new(sin_yaw * cos_pitch, sin_pitch, cos_yaw * cos_pitch),
            pixels_per_m: fitted * zoom,
            middle: size / 2.0,
        }
    }

    /// The same camera with a picture of `factor` times the pixels along each side.
    pub(super) fn finer(self, factor: f32) -> Self {
        Self { pixels_per_m: self.pixels_per_m * factor, middle: self.middle * factor, ..self }
    }

    /// Picture x and y (px) and one over the distance along the line of sight (1/m); none behind the camera.
    pub(super) fn project(&self, point: Vec3) -> Option<Vec3> {
        let from_target = point - self.target;
        let depth = self.distance_m - from_target.dot(self.back);
        (depth > NEAREST_M).then(|| {
            let scale = self.pixels_per_m * self.distance_m / depth;
            let (x, y) = (from_target.dot(self.right), from_target.dot(self.up));
            Vec3::new(self.middle.x + scale * x, self.middle.y - scale * y, 1.0 / depth)
        })
    }

    /// How bright a surface with this normal is, 0 to 1: light from above the viewer's left shoulder, rims darker.
    pub(super) fn brightness(&self, normal: Vec3) -> f32 {
        let light = self.back * 0.62 + self.up * 0.7 - self.right * 0.35;
        let lit = 0.5 + 0.5 * normal.dot(light);
        let facing = normal.dot(self.back).max(0.0);
        (0.25 + 0.75 * lit) * (0.62 + 0.38 * facing)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_side_view_has_the_head_on_the_right_and_up_above() {
        let size = Vec2::new(360.0, 260.0);
        let camera = Camera::new(Vec3::Y, [0.0, 0.1, 1.0], 1.0, size);
        let at = |x: f32, y: f32, z: f32| camera.project(Vec3::new(x, y, z)).unwrap();
        assert!(at(0.0, 1.0, 0.0).truncate().distance(size / 2.0) < 1e-3);
        assert!(at(1.0, 1.0, 0.0).x > 200.0 && at(0.0, 2.0, 0.0).y < 100.0);
        assert!(at(0.0, 1.0, 1.0).z > at(0.0, 1.0, -1.0).z, "the horse's right is nearer");
        let front = Camera::new(Vec3::Y, [std::f32::consts::FRAC_PI_2, 0.1, 1.0], 1.0, size);
        assert!(front.project(Vec3::new(0.0, 1.0, 1.0)).unwrap().x < 180.0, "its right is on our left");
        assert!(camera.project(Vec3::new(0.0, 1.0, 50.0)).is_none());
    }
}
