//! The ground under the figure: grid, shadow, standing hooves and the polygon between them.

use egui::{Color32, Painter, Pos2, Shape, Stroke, Vec2};
use glam::Vec3;
use muybridge_core::{Limb, Side, bone};

use super::camera::Camera;
use super::pose::FigurePose;
use super::scene::FigureColors;

/// Lines of the grid are this far apart, metres.
const GRID_M: f32 = 0.5;
/// The grid reaches so far from the horse, along and across, metres.
const REACH_M: [f32; 2] = [2.5, 1.5];
/// A disc under a standing hoof, and a dot under one in the air, metres.
const DISC_M: f32 = 0.1;
const DOT_M: f32 = 0.035;
/// Half axes of the shadow under the trunk, along and across, metres.
const SHADOW_M: [f32; 2] = [0.85, 0.32];
/// Ellipses of the shadow from its rim to its middle.
const SHADOW_RINGS: u32 = 5;
const SHADOW: Color32 = Color32::from_black_alpha(14);
const CIRCLE_CORNERS: u32 = 24;

/// Where the ground is drawn.
pub(super) struct Ground<'a> {
    pub(super) painter: &'a Painter,
    pub(super) camera: &'a Camera,
    /// Top left of the camera's picture on the screen, points.
    pub(super) at: Vec2,
}

impl Ground<'_> {
    /// Draws the grid around a point.
    pub(super) fn grid(&self, around: Vec3, color: Color32) {
        let middle = [around.x, around.z].map(|v| (v / GRID_M).round() as i32);
        let steps = REACH_M.map(|reach| (reach / GRID_M) as i32);
        let node = |i: i32, k: i32| Vec3::new((middle[0] + i) as f32, 0.0, (middle[1] + k) as f32) * GRID_M;
        for i in -steps[0]..=steps[0] {
            for k in -steps[1]..=steps[1] {
                if i < steps[0] {
                    self.grid_line([node(i, k), node(i + 1, k)], around, color);
                }
                if k < steps[1] {
                    self.grid_line([node(i, k), node(i, k + 1)], around, color);
                }
            }
        }
    }

    /// A piece of the grid, fainter towards its edge.
    fn grid_line(&self, ends: [Vec3; 2], around: Vec3, color: Color32) {
        let away = (ends[0] + ends[1]) / 2.0 - around.with_y(0.0);
        let faint = 1.0 - Vec2::new(away.x / (REACH_M[0] + GRID_M), away.z / (REACH_M[1] + GRID_M)).length();
        if let [Some(from), Some(to)] = ends.map(|end| self.place(end))
            && faint > 0.0
        {
            self.painter.line_segment([from, to], Stroke::new(1.0, color.gamma_multiply(faint.min(0.7))));
        }
    }

    /// Draws shadow, hooves and the support polygon of a pose.
    pub(super) fn stance(&self, pose: &FigurePose, colors: &FigureColors, filmed: Side) {
        let joints = &pose.joints;
        let trunk = (joints.root + joints.tips[bone::SPINE_LAST]) / 2.0;
        for ring in 1..=SHADOW_RINGS {
            let share = ring as f32 / SHADOW_RINGS as f32;
            self.ellipse(trunk, SHADOW_M.map(|axis| axis * share), SHADOW, Stroke::NONE);
        }
        self.support(pose, colors);
        for limb in Limb::ALL {
            let color = colors.limb(limb, filmed);
            if pose.standing[limb.index()] {
                let line = Stroke::new(1.5, color);
                self.ellipse(joints.toe(limb), [DISC_M; 2], color.gamma_multiply(0.45), line);
            } else {
                self.ellipse(joints.toe(limb), [DOT_M; 2], color.gamma_multiply(0.3), Stroke::NONE);
            }
        }
    }

    /// The polygon between the standing hooves; a line for two of them.
    fn support(&self, pose: &FigurePose, colors: &FigureColors) {
        let standing = Limb::ALL.into_iter().filter(|limb| pose.standing[limb.index()]);
        let mut feet: Vec<Vec3> = standing.map(|limb| pose.joints.toe(limb)).collect();
        let middle = feet.iter().sum::<Vec3>() / feet.len().max(1) as f32;
        let angle = |foot: &Vec3| (foot.z - middle.z).atan2(foot.x - middle.x);
        feet.sort_by(|a, b| angle(a).total_cmp(&angle(b)));
        let Some(points) = feet.into_iter().map(|foot| self.place(foot)).collect::<Option<Vec<Pos2>>>()
        else {
            return;
        };
        let line = Stroke::new(1.5, colors.trunk);
        match points[..] {
            [] | [_] => {}
            [from, to] => _ = self.painter.line_segment([from, to], line),
            _ => _ = self.painter.add(Shape::convex_polygon(points, colors.trunk.gamma_multiply(0.4), line)),
        }
    }

    /// An ellipse on the ground below a point.
    fn ellipse(&self, below: Vec3, half_axes_m: [f32; 2], fill: Color32, line: Stroke) {
        let corner = |i: u32| {
            let (sin, cos) = (std::f32::consts::TAU * i as f32 / CIRCLE_CORNERS as f32).sin_cos();
            self.place(below + Vec3::new(half_axes_m[0] * cos, 0.0, half_axes_m[1] * sin))
        };
        if let Some(points) = (0..CIRCLE_CORNERS).map(corner).collect::<Option<Vec<Pos2>>>() {
            self.painter.add(Shape::convex_polygon(points, fill, line));
        }
    }

    /// A point on the screen, let down to the ground.
    fn place(&self, point: Vec3) -> Option<Pos2> {
        let at = self.camera.project(point.with_y(0.0))?;
        Some(Pos2::new(at.x, at.y) + self.at)
    }
}
