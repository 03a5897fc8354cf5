//! A panel made ready for tracking: turned to face right, measured in body heights, at two resolutions.

use image::GrayImage;
use image::imageops::{FilterType, flip_horizontal, resize};
use imageproc::filter::gaussian_blur_f32;

use crate::PanelView;

/// A place or direction in *body heights*: panel px over the animal's height at the withers in panel px, x towards the
/// side the animal faces, y down.
pub(super) type Place = [f64; 2];

/// Resolution of the search, px per body height: a cannon is 11 px long, a pastern with its hoof 8.
const COARSE_PX: f64 = 64.0;
/// Most resolution of the refinement, px per body height: 2 % of the height are 4 px.
const FINE_PX: f64 = 200.0;
/// Blur of either resolution, px: less than a limb's width, more than the grain.
const BLUR_PX: f32 = 0.8;

/// Pixels of a panel at one resolution.
pub(super) struct Level {
    /// Resolution, px per body height.
    pub(super) px_per_height: f64,
    /// The photograph, and the silhouette where there is one.
    pub(super) layers: Vec<GrayImage>,
}

impl Level {
    fn new(pictures: &[&GrayImage], native_px: f64, most_px: f64, mirrored: bool) -> Self {
        let factor = (most_px / native_px).min(1.0);
        let layers = pictures.iter().map(|picture| {
            let size = |length: u32| ((f64::from(length) * factor).round() as u32).max(1);
            let small = resize(*picture, size(picture.width()), size(picture.height()), FilterType::Triangle);
            gaussian_blur_f32(&if mirrored { flip_horizontal(&small) } else { small }, BLUR_PX)
        });
        Self { px_per_height: native_px * factor, layers: layers.collect() }
    }

    /// Width and height, px.
    pub(super) fn size(&self) -> [i32; 2] {
        [self.layers[0].width() as i32, self.layers[0].height() as i32]
    }

    /// The centre of a pixel.
    pub(super) fn place_of_pixel(&self, pixel: [i32; 2]) -> Place {
        pixel.map(|v| (f64::from(v) + 0.5) / self.px_per_height)
    }

    /// The pixel a place lies in; it may be outside the picture.
    pub(super) fn pixel_of_place(&self, place: Place) -> [i32; 2] {
        place.map(|v| (v * self.px_per_height).floor() as i32)
    }
}

/// A panel made ready.
pub(super) struct Frame<'a> {
    view: &'a PanelView,
    /// Panel px per body height.
    native_px: f64,
    mirrored: bool,
    /// For the search.
    pub(super) coarse: Level,
    /// For the refinement.
    pub(super) fine: Level,
}

impl<'a> Frame<'a> {
    /// `height_plate_px` is the animal's height in plate px; `mirrored` is for an animal that faces left. A silhouette
    /// of another size than the view's is left out.
    pub(super) fn new(
        view: &'a PanelView,
        silhouette: Option<&GrayImage>,
        height_plate_px: f64,
        mirrored: bool,
    ) -> Self {
        let native_px = height_plate_px * view.scale;
        let silhouette = silhouette.filter(|mask| mask.dimensions() == view.image.dimensions());
        let pictures: Vec<&GrayImage> = std::iter::once(&view.image).chain(silhouette).collect();
        let level = |most_px| Level::new(&pictures, native_px, most_px, mirrored);
        Self { view, native_px, mirrored, coarse: level(COARSE_PX), fine: level(FINE_PX) }
    }

    /// A plate point in body heights.
    pub(super) fn place(&self, at_px: [f64; 2]) -> Place {
        let [x, y] = self.view.transform.panel_from_plate(at_px);
        let x = if self.mirrored { f64::from(self.view.image.width()) - x } else { x };
        [x / self.native_px, y / self.native_px]
    }

    /// A place in plate px.
    pub(super) fn plate_px(&self, [x, y]: Place) -> [f64; 2] {
        let [x, y] = [x * self.native_px, y * self.native_px];
        let x = if self.mirrored { f64::from(self.view.image.width()) - x } else { x };
        self.view.transform.plate_from_panel([x, y])
    }
}
