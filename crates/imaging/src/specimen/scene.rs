//! The wall with its lines and numbers, the track, the hurdle and the shadow under the horse.

use muybridge_core::{Limb, Random};

use super::PosedHorse;
use super::layout::{GROUND_SHARE, PanelLayout};
use super::limb::Viewer;
use super::paint::Canvas;
use super::photograph::mottle;
use super::print::{Script, text};
use super::raster::{Mask, Point, Shape, add, scaled, sub};
use super::style::{Grid, SpecimenStyle};

/// Lines are drawn this far along the wall to either side of the camera and up it, m: beyond any panel.
const BEYOND_M: f64 = 40.0;
/// Width of a fine line, m.
const GRID_WIDTH_M: f64 = 0.006;
/// Height of the band with the uprights' numbers, as a share of the panel's.
const BAND_SHARE: f64 = 0.085;
/// How soft the shadow's edge is, m.
const SHADOW_EDGE_M: f64 = 0.05;
/// Lines at the foot of the wall.
const FOOT_LINES: i32 = 4;
/// Most lines of a kind in a panel: closer ones would be finer than a pixel.
const MOST_LINES: f64 = 500.0;
/// Half the width of the hurdle across the track, m, about the plane of the horse's middle.
const HURDLE_HALF_WIDTH_M: f64 = 1.2;
/// Depth of the near hooves' plane before the horse's middle, m.
const MIDDLE_Z_M: f64 = -0.12;

/// A panel's surroundings.
pub(super) struct Scene<'a> {
    pub(super) panel: &'a PanelLayout,
    pub(super) style: &'a SpecimenStyle,
    pub(super) view: &'a Viewer<'a>,
}

/// A numbered line of the wall inside the panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Upright {
    pub(super) mark: f64,
    /// Foot and top, plate px.
    pub(super) ends_px: [Point; 2],
}

impl Scene<'_> {
    /// A point of the wall, plate px.
    fn wall(&self, x_m: f64, y_m: f64) -> Point {
        self.view.px([x_m, y_m], -self.style.wall_distance_m)
    }

    /// Px per metre on the wall.
    fn wall_scale(&self) -> f64 {
        let camera = &self.panel.camera;
        camera.px_per_m * camera.distance_m / (camera.distance_m + self.style.wall_distance_m)
    }

    /// A horizontal line at a height on the wall, cut to the panel, the left end first.
    pub(super) fn level(&self, y_m: f64) -> Option<[Point; 2]> {
        let x_m = self.panel.camera.camera_x_m;
        let ends = [x_m - BEYOND_M, x_m + BEYOND_M].map(|x| self.wall(x, y_m));
        let line = self.panel.clip(ends)?;
        Some(if line[0][0] <= line[1][0] { line } else { [line[1], line[0]] })
    }

    /// Height of the wall's top on the wall, m: the lower edge of the number band, or beyond the panel.
    fn top_m(&self) -> f64 {
        let style = self.style;
        if !style.upright_numbers {
            return BEYOND_M;
        }
        let camera = &self.panel.camera;
        let over_axis_px = (1.0 - GROUND_SHARE - BAND_SHARE) * style.panel_px[1];
        let at_px = add(camera.axis_foot_px, scaled(camera.up, over_axis_px));
        camera.world_from_plate(at_px, -style.wall_distance_m)[1].max(0.1)
    }

    /// Width of an upright, px.
    fn upright_px(&self) -> f64 {
        (self.style.upright_width_m * self.wall_scale()).max(1.0)
    }

    /// How many lines of a spacing fit along a length in px on the wall.
    fn lines_along(&self, length_px: f64, spacing_m: f64) -> i32 {
        (length_px / self.wall_scale() / spacing_m).ceil().clamp(0.0, MOST_LINES) as i32
    }

    /// The uprights that are seen.
    pub(super) fn uprights(&self) -> Vec<Upright> {
        let (style, camera) = (self.style, &self.panel.camera);
        let reach = self.lines_along(style.panel_px[0], style.upright_spacing_m);
        let middle = (style.first_axis_mark + camera.camera_x_m / style.upright_spacing_m).round();
        (-reach..=reach)
            .filter_map(|i| {
                let mark = middle + f64::from(i);
                let x_m = (mark - style.first_axis_mark) * style.upright_spacing_m;
                let ends_px = self.panel.clip([self.wall(x_m, 0.0), self.wall(x_m, self.top_m())])?;
                let [a, b] = ends_px;
                // A stump in a corner, or one that runs into the mount, is not seen as an upright.
                let height = sub(a, b)[0].hypot(sub(a, b)[1]);
                let from_side_px = self.panel.side_distance_px(a).min(self.panel.side_distance_px(b));
                let seen = height > 0.5 * style.panel_px[1] && from_side_px > 2.0 * self.upright_px() + 2.0;
                seen.then_some(Upright { mark, ends_px })
            })
            .collect()
    }

    /// Heights of the fine horizontal lines, m.
    fn grid_heights(&self) -> Vec<f64> {
        let spacing = self.style.grid_spacing_m;
        let count = match self.style.grid {
            Grid::None => 0,
            Grid::Foot => FOOT_LINES,
            Grid::Full => self.lines_along(self.style.panel_px[1], spacing),
        };
        let top_m = self.top_m();
        (1..=count).map(|i| f64::from(i) * spacing).filter(|y| *y < top_m).collect()
    }

    /// The fine horizontal lines that are seen, from the lowest up.
    pub(super) fn grid_lines(&self) -> Vec<[Point; 2]> {
        self.grid_heights().into_iter().filter_map(|y| self.level(y)).collect()
    }

    pub(super) fn paint(&self, canvas: &mut Canvas, random: &mut Random) {
        let (width, height) = (canvas.window.width, canvas.window.height);
        if width == 0 || height == 0 {
            return;
        }
        let stains = mottle(width, height, [f64::from(width) / 5.0, f64::from(height) / 4.0], random);
        for (tone, stain) in canvas.tones.pixels_mut().zip(stains.pixels()) {
            tone.0[0] += 2.5 * stain.0[0];
        }
        self.paint_lines(canvas);
        if self.style.upright_numbers {
            self.paint_band(canvas);
        }
        self.paint_ground(canvas, random);
    }

    fn paint_lines(&self, canvas: &mut Canvas) {
        let (style, tones) = (self.style, &self.style.tones);
        let fine_px = (GRID_WIDTH_M * self.wall_scale()).max(0.5);
        let mut fine: Vec<Shape> =
            self.grid_lines().into_iter().map(|[a, b]| Shape::stroke(a, b, fine_px)).collect();
        if style.grid == Grid::Full {
            let camera = &self.panel.camera;
            let reach = self.lines_along(style.panel_px[0], style.grid_spacing_m);
            let middle = (camera.camera_x_m / style.grid_spacing_m).round();
            fine.extend((-reach..=reach).filter_map(|i| {
                let x_m = (middle + f64::from(i)) * style.grid_spacing_m;
                let [a, b] = self.panel.clip([self.wall(x_m, 0.0), self.wall(x_m, self.top_m())])?;
                Some(Shape::stroke(a, b, fine_px))
            }));
        }
        for line in fine {
            canvas.fill(&[line], tones.grid, 0.75);
        }
        for Upright { ends_px: [a, b], .. } in self.uprights() {
            canvas.fill(&[Shape::stroke(a, b, self.upright_px())], tones.uprights, 1.0);
        }
    }

    /// The light band with the uprights' numbers, and the rail under it.
    fn paint_band(&self, canvas: &mut Canvas) {
        let (camera, tones) = (&self.panel.camera, &self.style.tones);
        let (left, right) = (camera.camera_x_m - BEYOND_M, camera.camera_x_m + BEYOND_M);
        let top_m = self.top_m();
        let [a, b] = [left, right].map(|x| self.wall(x, top_m));
        let [c, d] = [right, left].map(|x| self.wall(x, top_m + BEYOND_M));
        canvas.fill(&[Shape::polygon(vec![a, b, c, d])], 0.5 * (tones.wall + 235.0), 1.0);
        let band_px = BAND_SHARE * self.style.panel_px[1];
        canvas.fill(&[Shape::stroke(a, b, (0.1 * band_px).max(1.2))], 0.5 * tones.uprights, 1.0);
        let script = Script {
            height_px: 0.95 * band_px,
            right: scaled(camera.forward, if camera.forward[0] < 0.0 { -1.0 } else { 1.0 }),
            down: scaled(camera.up, -1.0),
        };
        for Upright { mark, .. } in self.uprights() {
            let x_m = (mark - self.style.first_axis_mark) * self.style.upright_spacing_m;
            let middle = add(self.wall(x_m, top_m), scaled(camera.up, 0.5 * band_px));
            canvas.fill(&text(&format!("{mark}"), middle, &script), 0.4 * tones.uprights, 1.0);
        }
    }

    /// The track from the foot of the wall to the lower edge, streaked along its length.
    fn paint_ground(&self, canvas: &mut Canvas, random: &mut Random) {
        let camera = &self.panel.camera;
        let (left, right) = (camera.camera_x_m - BEYOND_M, camera.camera_x_m + BEYOND_M);
        let [a, b] = [left, right].map(|x| self.wall(x, 0.0));
        let below = scaled(camera.up, -BEYOND_M * camera.px_per_m);
        let region = [Shape::polygon(vec![a, b, add(b, below), add(a, below)])];
        let mask = Mask::of(&region, canvas.window, 1.0);
        let streaks = mottle(mask.window.width, mask.window.height, [14.0, 1.6], random);
        let tone = self.style.tones.ground;
        canvas.lay(&mask, |x, y| tone as f32 + 5.0 * streaks.get_pixel(x, y).0[0], 1.0);
        canvas.fill(&[Shape::stroke(a, b, 1.2)], 0.55 * tone, 0.8);
    }

    /// The horse's shadow: thin under the trunk, darker at each hoof that stands.
    pub(super) fn paint_shadow(&self, canvas: &mut Canvas, pose: &PosedHorse) {
        let (view, tone) = (self.view, 0.35 * self.style.tones.ground);
        let ground = |x: f64, z: f64| view.px([x, 0.0], z);
        let size = view.size;
        let [back, front] = [pose.croup[0] - 0.4 * size, pose.withers()[0] + 0.5 * size];
        let radius = view.length_px(0.03);
        let trunk = Shape::Capsule([(ground(back, MIDDLE_Z_M), radius), (ground(front, MIDDLE_Z_M), radius)]);
        canvas.shade(&[trunk], tone, 0.45, view.length_px(SHADOW_EDGE_M));
        let hooves = Limb::ALL.into_iter().filter(|limb| pose.down[limb.index()]).map(|limb| {
            let [x, _, z] = pose.tip(limb.hoof_bone());
            let radius = view.length_px(0.02);
            Shape::Capsule([(ground(x - 0.13 * size, z), radius), (ground(x + 0.02 * size, z), radius)])
        });
        canvas.shade(&hooves.collect::<Vec<_>>(), tone, 0.6, view.length_px(0.3 * SHADOW_EDGE_M));
    }

    /// Two posts and three bars across the track.
    pub(super) fn hurdle(&self, x_m: f64, height_m: f64) -> Vec<Shape> {
        let scale = self.panel.camera.px_per_m;
        let [near, far] = [HURDLE_HALF_WIDTH_M, -HURDLE_HALF_WIDTH_M].map(|z| MIDDLE_Z_M + z);
        let mut shapes: Vec<Shape> = [near, far]
            .map(|z| {
                Shape::stroke(self.view.px([x_m, 0.0], z), self.view.px([x_m, height_m], z), 0.06 * scale)
            })
            .to_vec();
        shapes.extend([0.35, 0.65, 0.95].map(|share| {
            let y = share * height_m;
            Shape::stroke(self.view.px([x_m, y], near), self.view.px([x_m, y], far), 0.05 * scale)
        }));
        shapes
    }
}
