//! The skeleton in three dimensions, drawn by our own z-buffer.
//!
//! [`FigureView`] shows poses with a body around their joints on a ground with a grid. Pixels are computed only when a
//! pose, the view or the size changes, and kept as a texture.

mod body;
mod camera;
mod ground;
mod loft;
mod pose;
mod raster;
mod scene;
#[cfg(test)]
mod tests;

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use egui::accesskit::Role;
use egui::{Rect, Response, Sense, TextureHandle, TextureOptions, Ui, UiBuilder, Vec2, WidgetInfo, pos2};
use glam::Vec3;
use muybridge_core::{Side, bone};

use camera::Camera;
use ground::Ground;
use pose::Frame;

pub use pose::FigurePose;
pub use scene::FigureColors;

/// Turned by this for each point of a drag, radians: half a turn over 300 points.
const TURN_PER_POINT: f32 = PI / 300.0;
/// Scrolled so far, the figure is e times as large, points.
const SCROLL_PER_ZOOM: f32 = 300.0;
/// The camera stays above the ground and below the zenith, radians.
const PITCH: std::ops::RangeInclusive<f32> = 0.02..=1.5;
/// Least and greatest zoom.
const ZOOM: std::ops::RangeInclusive<f32> = 0.4..=6.0;
/// The camera looks at this height, metres per reference horse: half way up to the poll.
const LOOK_AT_M: f32 = 1.08;
/// A little from above, so that the ground is seen as an area.
const USUAL_PITCH: f32 = 0.16;
/// Screens with fewer pixels a point than this get pixels averaged from four.
const SMOOTHED_BELOW: f32 = 1.5;

/// A view to return to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamedView {
    /// From the filmed side.
    Side,
    /// From before the horse.
    Front,
    /// From before the horse on the filmed side.
    ThreeQuarter,
}

impl NamedView {
    const ALL: [(Self, &'static str, &'static str); 3] = [
        (Self::Side, "Side", "See the horse from the filmed side (or double-click)"),
        (Self::Front, "Front", "See the horse from the front"),
        (Self::ThreeQuarter, "3/4", "See the horse from the front quarter of the filmed side"),
    ];
}

/// A view of the horse that can be turned and zoomed.
pub struct FigureView {
    /// Camera's turn about the vertical, radians: 0 sees the horse's right side, pi its left, half of it its front.
    pub yaw: f32,
    /// Camera's height as an angle, radians.
    pub pitch: f32,
    /// 1 shows the whole horse.
    pub zoom: f32,
    filmed: Side,
    drawn: Option<Drawn>,
}

/// Everything the pixels depend on.
#[derive(Clone, Debug, PartialEq)]
struct Input {
    poses: Vec<FigurePose>,
    camera: Camera,
    size: [usize; 2],
    smooth: bool,
    colors: FigureColors,
    filmed: Side,
}

struct Drawn {
    input: Input,
    texture: TextureHandle,
}

impl FigureView {
    /// The side view of a horse whose side `filmed` was towards the cameras.
    pub fn new(filmed: Side) -> Self {
        let mut view = Self { yaw: 0.0, pitch: USUAL_PITCH, zoom: 1.0, filmed, drawn: None };
        view.look(NamedView::Side);
        view
    }

    /// Says which side of the horse was filmed, and goes there when it was another.
    pub fn set_filmed(&mut self, filmed: Side) {
        if self.filmed != filmed {
            self.filmed = filmed;
            self.look(NamedView::Side);
        }
    }

    /// Goes to a view.
    pub fn look(&mut self, view: NamedView) {
        let right_yaw = match view {
            NamedView::Side => 0.0,
            NamedView::Front => FRAC_PI_2,
            NamedView::ThreeQuarter => FRAC_PI_4,
        };
        self.yaw = if self.filmed == Side::Right { right_yaw } else { PI - right_yaw };
        (self.pitch, self.zoom) = (USUAL_PITCH, 1.0);
    }

    /// Shows poses: the camera follows the first that is no ghost. Poses with joints that are no numbers are left out.
    pub fn ui(&mut self, ui: &mut Ui, size: Vec2, poses: &[FigurePose], colors: &FigureColors) -> Response {
        let size = if size.is_finite() { size.max(Vec2::ZERO) } else { Vec2::ZERO };
        let (rect, response) = ui.allocate_exact_size(size, Sense::click_and_drag());
        let name = "Figure of the horse: drag to turn, scroll to zoom, double-click for the side view";
        response.widget_info(|| WidgetInfo::labeled(Role::Canvas, true, name));
        self.turn(ui, &response);
        if !ui.is_rect_visible(rect) || rect.width() < 1.0 || rect.height() < 1.0 {
            return response;
        }
        let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
        painter.rect_filled(rect, 4.0, ui.visuals().extreme_bg_color);
        let poses: Vec<FigurePose> =
            poses.iter().filter(|pose| Frame::of(&pose.joints).is_some()).copied().collect();
        let shown = poses.iter().find(|pose| !pose.ghost).or(poses.first()).copied();
        if let Some((pose, frame)) = shown.and_then(|pose| Some((pose, Frame::of(&pose.joints)?))) {
            let trunk = (pose.joints.root + pose.joints.tips[bone::SPINE_LAST]) / 2.0;
            // Towards the head, which is before the trunk as much as the croup is behind it.
            let target = (trunk + Vec3::X * (0.2 * frame.size)).with_y(LOOK_AT_M * frame.size);
            let seen = glam::Vec2::new(rect.width(), rect.height());
            let camera = Camera::new(target, [self.yaw, self.pitch, self.zoom], frame.size, seen);
            let ground = Ground { painter: &painter, camera: &camera, at: rect.min.to_vec2() };
            ground.grid(target, ui.visuals().weak_text_color());
            poses.iter().filter(|p| !p.ghost).for_each(|pose| ground.stance(pose, colors, self.filmed));
            self.horse(ui, &painter, rect, &camera, poses, colors);
        }
        self.buttons(ui, rect);
        response
    }

    fn turn(&mut self, ui: &Ui, response: &Response) {
        if response.dragged() {
            let by = response.drag_delta() * TURN_PER_POINT;
            (self.yaw, self.pitch) = (self.yaw - by.x, self.pitch + by.y);
        }
        if response.contains_pointer() {
            let (scrolled, pinched) =
                ui.input_mut(|input| (std::mem::take(&mut input.smooth_scroll_delta).y, input.zoom_delta()));
            self.zoom *= (scrolled / SCROLL_PER_ZOOM).exp() * pinched;
        }
        if response.double_clicked() {
            self.look(NamedView::Side);
        }
        let number = |value: f32, otherwise: f32| if value.is_finite() { value } else { otherwise };
        self.yaw = number(self.yaw, 0.0).rem_euclid(2.0 * PI);
        self.pitch = number(self.pitch, USUAL_PITCH).clamp(*PITCH.start(), *PITCH.end());
        self.zoom = number(self.zoom, 1.0).clamp(*ZOOM.start(), *ZOOM.end());
    }

    /// Draws the texture, made anew when something has changed.
    fn horse(
        &mut self,
        ui: &Ui,
        painter: &egui::Painter,
        rect: Rect,
        camera: &Camera,
        poses: Vec<FigurePose>,
        colors: &FigureColors,
    ) {
        let most = ui.input(|input| input.max_texture_side) as f32;
        let pixels_per_point = ui.pixels_per_point().min(most / rect.width().max(rect.height()));
        let smooth = pixels_per_point < SMOOTHED_BELOW;
        let size = [rect.width(), rect.height()].map(|points| (points * pixels_per_point) as usize);
        let camera = camera.finer(pixels_per_point);
        let input = Input { poses, camera, size, smooth, colors: *colors, filmed: self.filmed };
        if self.drawn.as_ref().is_none_or(|drawn| drawn.input != input) {
            let picture = scene::render(&input.poses, &camera, size, smooth, colors, self.filmed);
            let texture = match self.drawn.take() {
                Some(Drawn { mut texture, .. }) => {
                    texture.set(picture, TextureOptions::LINEAR);
                    texture
                }
                None => ui.ctx().load_texture("figure", picture, TextureOptions::LINEAR),
            };
            self.drawn = Some(Drawn { input, texture });
        }
        if let Some(drawn) = &self.drawn {
            let pixels = Vec2::new(size[0] as f32, size[1] as f32);
            let place = Rect::from_min_size(rect.min, pixels / pixels_per_point);
            let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
            painter.image(drawn.texture.id(), place, whole, egui::Color32::WHITE);
        }
    }

    /// The named views, in the lower left corner.
    fn buttons(&mut self, ui: &mut Ui, rect: Rect) {
        let height = ui.spacing().interact_size.y;
        let row = Rect::from_min_max(pos2(rect.left(), rect.bottom() - height), rect.max).shrink(2.0);
        if row.width() < 4.0 * height || rect.height() < 3.0 * height {
            return;
        }
        ui.scope_builder(UiBuilder::new().max_rect(row), |ui| {
            ui.horizontal(|ui| {
                for (view, label, explanation) in NamedView::ALL {
                    let button = ui.small_button(label).on_hover_text(explanation);
                    button.widget_info(|| {
                        WidgetInfo::labeled(Role::Button, true, format!("{label} view of the figure"))
                    });
                    if button.clicked() {
                        self.look(view);
                    }
                }
            });
        });
    }
}
