//! The plate as a pyramid of tiles, and what of it is on the graphics card.
//!
//! [`PlateImages`] reads the plate's pictures in a thread and makes a [`Pyramid`] of each; [`PlateTextures`] draws the
//! part that is seen, as tiles of the level that matches the screen, and uploads few of them in one frame.
//! [`ViewTransform`] leads from plate px to screen points and back.

mod adjustment;
mod loader;
mod paint;
mod patch;
mod pyramid;
#[cfg(test)]
mod tests;
mod textures;
mod tiles;
mod view_transform;

pub use adjustment::Adjustment;
pub use loader::{ImageState, PlateImages};
pub use paint::{Look, Source};
pub use pyramid::Pyramid;
pub use textures::PlateTextures;
pub use view_transform::ViewTransform;
