//! The horse in three dimensions in a widget that can be turned and zoomed.
//!
//! [`FigureView`] shows a scene of [`muybridge_imaging::figure`]. Pixels are computed only when the scene, the view or the size
//! changes, and kept as a texture.

#[cfg(test)]
mod tests;

use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use egui::accesskit::Role;
use egui::{
    ColorImage, Rect, Response, Sense, TextureHandle, TextureOptions, Ui, UiBuilder, Vec2, WidgetInfo, pos2,
};
use glam::Vec3;
use muybridge_core::{Side, bone};
use muybridge_imaging::figure::{Camera, Decal, Scene, Terrain, Trace, Tube, render};

pub use muybridge_imaging::figure::{Figure as FigurePose, FigureColors};

/// Turned by this for each point of a drag, radians: half a turn over 300 points.
const TURN_PER_POINT: f32 = PI / 300.0;
/// Scrolled so far, the figure is e times as large, points.
const SCROLL_PER_ZOOM: f32 = 300.0;
/// The camera stays above the ground and below the zenith, radians.
const PITCH: std::ops::RangeInclusive<f32> = 0.02..=1.5;
/// Least and greatest zoom.
const ZOOM: std::ops::RangeInclusive<f32> = 0.2..=6.0;
/// The camera looks at this height, metres per reference horse: half way up to the poll.
const LOOK_AT_M: f32 = 1.08;
/// And so far before the middle of the trunk: the head is before it as much as the croup is behind it.
const LOOK_BEFORE_M: f32 = 0.2;
/// Distance from the horse, metres per reference horse: like standing at the rail of a small arena.
const DISTANCE_M: f32 = 7.0;
/// What is seen at the horse's distance without zoom, across and up, metres: a galloping horse with room around it.
const SEEN_M: [f32; 2] = [3.3, 2.7];
/// A little from above, so that the ground is seen as an area.
const USUAL_PITCH: f32 = 0.16;
/// From behind, the way ahead is to be seen over the horse.
const FOLLOW_PITCH: f32 = 0.42;
const FOLLOW_ZOOM: f32 = 0.7;
/// The camera stays so far above uneven ground, metres per reference horse, and is raised in such steps, radians.
const OVER_GROUND_M: f32 = 0.5;
const RAISED_BY: f32 = 0.04;
/// Screens with fewer pixels a point than this get pixels averaged from four.
const SMOOTHED_BELOW: f32 = 1.5;
/// Lines of the ground under a single figure are this far apart, metres.
const GRID_M: f32 = 0.5;

/// A view to return to. All of them turn with the horse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NamedView {
    /// From the filmed side.
    Side,
    /// From before the horse.
    Front,
    /// From before the horse on the filmed side.
    ThreeQuarter,
    /// From behind and above.
    Follow,
}

impl NamedView {
    const ALL: [(Self, &'static str, &'static str); 4] = [
        (Self::Side, "Side", "See the horse from the filmed side (or double-click)"),
        (Self::Front, "Front", "See the horse from the front"),
        (Self::ThreeQuarter, "3/4", "See the horse from the front quarter of the filmed side"),
        (Self::Follow, "Follow", "See the horse from behind and above"),
    ];
}

/// Whom the camera looks at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Follow {
    /// The ground below the middle of the horse's trunk, metres.
    pub at: Vec3,
    /// Where it faces, about the world's Y axis, to the left positive, radians.
    pub heading_rad: f32,
    /// Its size in reference horses.
    pub size: f32,
}

impl Follow {
    /// The middle of a figure's trunk over ground of a height, facing a heading; none for joints that are no numbers.
    pub fn figure(figure: &FigurePose, ground_m: f32, heading_rad: f32) -> Option<Self> {
        let trunk = (figure.joints.root + figure.joints.tips[bone::SPINE_LAST]) / 2.0;
        Some(Self { at: trunk.with_y(ground_m), heading_rad, size: figure.size()? })
    }
}

/// What a [`FigureView`] shows.
#[derive(Clone, Copy)]
pub struct SceneParts<'a> {
    /// The horses.
    pub figures: &'a [FigurePose],
    /// Bodies that are no horses.
    pub tubes: &'a [Tube],
    /// Shapes on the ground, such as footprints.
    pub decals: &'a [Decal],
    /// The ground.
    pub terrain: Terrain<'a>,
    /// Another number when the height function is another one: functions cannot be compared.
    pub terrain_version: u64,
    /// Lines of the ground's grid are this far apart, metres; 0 draws none.
    pub grid_m: f32,
    /// Lines in space, such as the ways of the hooves.
    pub traces: &'a [Trace<'a>],
    /// Whether the polygon between the standing hooves is drawn, and a disc under each.
    pub support_polygon: bool,
    /// Colours.
    pub colors: &'a FigureColors,
    /// Whom the camera looks at.
    pub follow: Follow,
}

/// A view of the horse that can be turned and zoomed.
pub struct FigureView {
    /// Camera's turn about the vertical against the horse's heading, radians: 0 sees its right side, pi its left, half of it its
    /// front.
    pub yaw: f32,
    /// Camera's height as an angle, radians.
    pub pitch: f32,
    /// 1 shows the whole horse.
    pub zoom: f32,
    /// Whether the named views have buttons in the lower left corner.
    pub buttons: bool,
    filmed: Side,
    drawn: Option<Drawn>,
    camera: Option<Camera>,
}

/// Everything the pixels depend on.
#[derive(Clone, Debug, PartialEq)]
struct Input {
    figures: Vec<FigurePose>,
    tubes: Vec<Tube>,
    decals: Vec<Decal>,
    traces: Vec<(Vec<Vec3>, [u8; 3])>,
    /// None when hidden, then none when flat, or whether it has edges and the version.
    terrain: Option<Option<(bool, u64)>>,
    grid_m: f32,
    support_polygon: bool,
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
        let mut view = Self {
            yaw: 0.0,
            pitch: USUAL_PITCH,
            zoom: 1.0,
            buttons: true,
            filmed,
            drawn: None,
            camera: None,
        };
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
            NamedView::Follow => -FRAC_PI_2,
        };
        self.yaw = if self.filmed == Side::Right { right_yaw } else { PI - right_yaw };
        let follows = view == NamedView::Follow;
        (self.pitch, self.zoom) = if follows { (FOLLOW_PITCH, FOLLOW_ZOOM) } else { (USUAL_PITCH, 1.0) };
    }

    /// Shows poses of a horse that faces X on the plane of height zero: the camera follows the first that is no ghost. Poses with
    /// joints that are no numbers are left out.
    pub fn ui(&mut self, ui: &mut Ui, size: Vec2, poses: &[FigurePose], colors: &FigureColors) -> Response {
        let follow = |pose: &FigurePose| Follow::figure(pose, 0.0, 0.0);
        let solid = poses.iter().filter(|pose| !pose.ghost).find_map(follow);
        let follow = solid.or_else(|| poses.iter().find_map(follow));
        let parts = SceneParts {
            figures: poses,
            tubes: &[],
            decals: &[],
            terrain: Terrain::Flat,
            terrain_version: 0,
            grid_m: GRID_M,
            traces: &[],
            support_polygon: true,
            colors,
            follow: follow.unwrap_or(Follow { at: Vec3::NAN, heading_rad: 0.0, size: 1.0 }),
        };
        self.ui_scene(ui, size, &parts)
    }

    /// Shows a scene. The camera is kept above the ground. Nothing is drawn when what it follows is no number.
    pub fn ui_scene(&mut self, ui: &mut Ui, size: Vec2, parts: &SceneParts<'_>) -> Response {
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
        let Follow { at, heading_rad, size } = parts.follow;
        self.camera = None;
        if at.is_finite() && heading_rad.is_finite() && (0.01..100.0).contains(&size) {
            self.picture(ui, &painter, rect, parts);
        }
        if self.buttons {
            self.named_views(ui, rect);
        }
        response
    }

    /// The camera of what was shown last, in points from the top left of the widget; none when nothing was.
    pub fn camera(&self) -> Option<Camera> {
        self.camera
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

    /// The camera of a picture of `size` pixels.
    fn camera_of(&self, parts: &SceneParts<'_>, size: [usize; 2]) -> Camera {
        let Follow { at, heading_rad, size: horse } = parts.follow;
        let forward = Vec3::new(heading_rad.cos(), 0.0, -heading_rad.sin());
        let target = at + (Vec3::Y * LOOK_AT_M + forward * LOOK_BEFORE_M) * horse;
        let size = size.map(|v| v as f32);
        let seen_m = SEEN_M[0].max(SEEN_M[1] * size[0] / size[1]) * horse / self.zoom;
        // To see more, the camera goes back; to see less it stays, as a wide view from near is out of shape.
        let distance_m = DISTANCE_M * horse / self.zoom.min(1.0);
        let pitched = |pitch: f32| {
            Camera::orbit(target, self.yaw + heading_rad, pitch, seen_m, size).from_distance(distance_m)
        };
        let is_above = |camera: &Camera| match parts.terrain {
            Terrain::Height(height) | Terrain::Stepped(height) => {
                let eye = camera.eye();
                let ground_m = height(eye.x, eye.z);
                !ground_m.is_finite() || eye.y > ground_m + OVER_GROUND_M * horse
            }
            Terrain::Hidden | Terrain::Flat => true,
        };
        let steps = ((PITCH.end() - self.pitch) / RAISED_BY).max(0.0) as usize;
        let raised = (0..=steps).map(|step| pitched(self.pitch + RAISED_BY * step as f32));
        raised.into_iter().find(is_above).unwrap_or(pitched(*PITCH.end()))
    }

    /// Draws the texture, made anew when something has changed.
    fn picture(&mut self, ui: &Ui, painter: &egui::Painter, rect: Rect, parts: &SceneParts<'_>) {
        let most = ui.input(|input| input.max_texture_side) as f32;
        let pixels_per_point = ui.pixels_per_point().min(most / rect.width().max(rect.height()));
        let size = [rect.width(), rect.height()].map(|points| (points * pixels_per_point) as usize);
        if size.contains(&0) {
            return;
        }
        let input = Input {
            figures: parts.figures.iter().filter(|figure| figure.size().is_some()).copied().collect(),
            tubes: parts.tubes.to_vec(),
            decals: parts.decals.to_vec(),
            traces: parts.traces.iter().map(|trace| (trace.points.to_vec(), trace.color)).collect(),
            terrain: match parts.terrain {
                Terrain::Hidden => None,
                Terrain::Flat => Some(None),
                Terrain::Height(_) => Some(Some((false, parts.terrain_version))),
                Terrain::Stepped(_) => Some(Some((true, parts.terrain_version))),
            },
            grid_m: parts.grid_m,
            support_polygon: parts.support_polygon,
            camera: self.camera_of(parts, size),
            size,
            smooth: pixels_per_point < SMOOTHED_BELOW,
            colors: *parts.colors,
            filmed: self.filmed,
        };
        self.camera = Some(input.camera.finer(1.0 / pixels_per_point));
        if self.drawn.as_ref().is_none_or(|drawn| drawn.input != input) {
            let picture = drawn(&input, parts);
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
    fn named_views(&mut self, ui: &mut Ui, rect: Rect) {
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

fn drawn(input: &Input, parts: &SceneParts<'_>) -> ColorImage {
    let scene = Scene {
        figures: &input.figures,
        tubes: &input.tubes,
        decals: &input.decals,
        filmed: input.filmed,
        terrain: parts.terrain,
        grid_m: input.grid_m,
        traces: parts.traces,
        support_polygon: input.support_polygon,
        colors: &input.colors,
    };
    let picture = render(&scene, &input.camera, input.size, input.smooth);
    ColorImage::from_rgba_unmultiplied(input.size, picture.as_raw())
}
