//! Pixels: loading and fetching plates, finding panels, seeing horse and wall in them, tracking points from panel to
//! panel, drawing specimen plates whose truth is known, and drawing the horse in three dimensions ([`figure`]).
//!
//! Spaces: *plate px* (origin at the top left of the image file, x right, y down, the centre of the first pixel at
//! (0.5, 0.5)) and *panel px* (the same for a [`PanelView`], one photograph cut out and squared up). Pictures are grey: the
//! plates are.
//! Equal inputs give equal results; nothing here reads a clock or uses chance that is not seeded.

pub mod acquire;
mod cutouts;
pub mod fetch;
pub mod figure;
mod frames;
mod panel_view;
mod picture;
pub mod see;
pub mod specimen;
pub mod split;
pub mod track;

pub use cutouts::Cutouts;
pub use frames::frames;
pub use panel_view::{PanelTransform, PanelView};
pub use picture::{LoadLimits, PictureError, load_gray, load_rgb};
