//! Figures in three dimensions, on a ground with a grid, in one z-buffer: the horse, a body skinned on the skeleton's joints, and others,
//! made of tubes.
//!
//! World space as everywhere: X forward, Y up, Z to the right of a horse that faces X, metres.
//! Equal scenes give equal pixels: in a window, in a test and on the command line.

mod body;
mod camera;
mod canvas;
mod frames;
mod ground;
mod hair;
mod hoof;
mod loft;
mod scene;
mod sections;
mod stepped;
mod terrain;
#[cfg(test)]
mod tests;
mod tube;

use glam::{Vec2, Vec3};
use image::RgbaImage;
use muybridge_core::{Joints, Side};

pub use camera::Camera;

/// One horse to draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// World positions, metres.
    pub joints: Joints,
    /// Hooves that bear weight, in the order of [`muybridge_core::Limb::ALL`].
    pub standing: [bool; 4],
    /// Drawn as a thin transparent skeleton: another moment, for comparison.
    pub ghost: bool,
}

impl Figure {
    /// Size of the horse in reference horses, by its trunk; none when it cannot be drawn, as a joint is no number.
    pub fn size(&self) -> Option<f32> {
        frames::Frames::of(&self.joints).map(|frames| frames.size)
    }
}

/// The colours of a scene: red, green and blue, 0 to 255.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FigureColors {
    /// Legs on the filmed side.
    pub near: [u8; 3],
    /// Legs on the other side.
    pub off: [u8; 3],
    /// Neck, head and barrel; mane and tail are darker.
    pub trunk: [u8; 3],
    /// Ground.
    pub ground: [u8; 3],
    /// What is behind everything, with its opacity; none leaves it transparent, and the ground fades into nothing.
    pub sky: Option<[u8; 4]>,
}

impl Default for FigureColors {
    /// A chestnut on sand.
    fn default() -> Self {
        Self {
            near: [158, 88, 48],
            off: [124, 68, 40],
            trunk: [164, 92, 50],
            ground: [196, 178, 146],
            sky: Some([206, 219, 231, 255]),
        }
    }
}

/// The ground of a scene.
#[derive(Clone, Copy, Default)]
pub enum Terrain<'a> {
    /// None is drawn; hooves stand on the plane of height zero.
    Hidden,
    /// The endless plane of height zero.
    #[default]
    Flat,
    /// Height (metres) over x and z (metres). Places whose height is not finite are holes.
    Height(&'a dyn Fn(f32, f32) -> f32),
    /// The same with edges, such as stairs: where it is not smooth it is looked at closely, which takes longer.
    Stepped(&'a dyn Fn(f32, f32) -> f32),
}

/// A line in world space, such as the way of a hoof.
#[derive(Clone, Copy, Debug)]
pub struct Trace<'a> {
    /// Corners, metres; a corner that is no number interrupts the line.
    pub points: &'a [Vec3],
    /// Red, green and blue.
    pub color: [u8; 3],
}

/// A body, or a part of one: elliptical sections with a smooth skin over them, and rounded ends.
#[derive(Clone, Debug, PartialEq)]
pub struct Tube {
    /// Middles of the sections, world space, metres. Those that are no numbers are left out; fewer than two are not drawn.
    pub points: Vec<Vec3>,
    /// Half width (across `up`) and half height (along it) of each section, metres.
    pub radii_m: Vec<Vec2>,
    /// What is up for the sections.
    pub up: Vec3,
    /// Red, green and blue.
    pub color: [u8; 3],
}

/// A shape painted on the ground, such as a footprint.
#[derive(Clone, Debug, PartialEq)]
pub struct Decal {
    /// Its outline, world space, metres; the ground below it is painted. Corners that are no numbers are left out.
    pub points: Vec<Vec3>,
    /// Red, green and blue.
    pub color: [u8; 3],
}

/// All that is in a picture.
#[derive(Clone, Copy)]
pub struct Scene<'a> {
    /// The horses. One with joints that are no numbers is left out.
    pub figures: &'a [Figure],
    /// Bodies that are no horses, lit as these are.
    pub tubes: &'a [Tube],
    /// Shapes on the ground.
    pub decals: &'a [Decal],
    /// Which side of the horse has the colour [`FigureColors::near`].
    pub filmed: Side,
    /// The ground.
    pub terrain: Terrain<'a>,
    /// Lines of the ground's grid are this far apart, metres; 0 draws none.
    pub grid_m: f32,
    /// Lines in space.
    pub traces: &'a [Trace<'a>],
    /// Whether the polygon between the standing hooves is drawn, and a disc under each.
    pub support_polygon: bool,
    /// Colours.
    pub colors: &'a FigureColors,
}

/// Draws a scene into a picture of `size_px` (width, height); `smooth` averages four samples a pixel along the horse's edges.
/// The camera is that of the picture. Transparent pixels are black; alpha is not premultiplied.
pub fn render(scene: &Scene<'_>, camera: &Camera, size_px: [usize; 2], smooth: bool) -> RgbaImage {
    scene::render(scene, camera, size_px, smooth)
}
