//! A panel made ready for tracking: turned to face right, measured in body heights, at two resolutions.

use image::GrayImage;
use image::imageops::{FilterType, flip_horizontal, resize};
use imageproc::filter::gaussian_blur_f32;

use crate::PanelView;

/// A place or a step in *body heights*: panel px over the animal's height at the withers in panel px, x towards the side
/// the animal faces, y down.
pub(super) type Place = [f64; 2];

/// Resolution of the search, px per body height: a cannon is 14 px long, pastern and hoof together 10.
const COARSE_PX: f64 = 78.0;
/// Most resolution of the refinement, px per body height: 2 % of the height are 2.4 px; more costs time and finds no more.
const FINE_PX: f64 = 120.0;
/// Blur at either resolution, px: less than a limb's width, more than the grain.
const BLUR_PX: f32 = 0.8;

/// How far two places are from each other.
pub(super) fn distance(a: Place, b: Place) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The step from one place to another.
pub(super) fn step(from: Place, to: Place) -> Place {
    [to[0] - from[0], to[1] - from[1]]
}

/// Pixels of a panel at one resolution.
pub(super) struct Level {
    /// Resolution.
    pub(super) px_per_height: f64,
    /// Width and height, px.
    pub(super) size_px: [i32; 2],
    /// 1 for the photograph alone, 2 with a silhouette.
    pub(super) layers: usize,
    /// Row by row, photograph and silhouette.
    pub(super) pixels: Vec<[u8; 2]>,
}

impl Level {
    fn new(pictures: &[GrayImage], px_per_height: f64) -> Self {
        let size_px = [pictures[0].width() as i32, pictures[0].height() as i32];
        let mut pixels = vec![[0; 2]; pictures[0].len()];
        for (layer, picture) in pictures.iter().enumerate() {
            for (pixel, value) in pixels.iter_mut().zip(gaussian_blur_f32(picture, BLUR_PX).iter()) {
                pixel[layer] = *value;
            }
        }
        Self { px_per_height, size_px, layers: pictures.len(), pixels }
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
    /// `height_plate_px` is the animal's height in plate px; `mirrored` is for an animal that faces left. A silhouette of
    /// another size than the view's is left out.
    pub(super) fn new(
        view: &'a PanelView,
        silhouette: Option<&GrayImage>,
        height_plate_px: f64,
        mirrored: bool,
    ) -> Self {
        let native_px = height_plate_px * view.scale;
        let silhouette = silhouette.filter(|mask| mask.dimensions() == view.image.dimensions());
        let pictures = std::iter::once(&view.image).chain(silhouette);
        let turned =
            pictures.map(|picture| if mirrored { flip_horizontal(picture) } else { picture.clone() });
        let (fine, fine_px) = reduced(&turned.collect::<Vec<_>>(), native_px, FINE_PX);
        let (coarse, coarse_px) = reduced(&fine, fine_px, COARSE_PX);
        let (coarse, fine) = (Level::new(&coarse, coarse_px), Level::new(&fine, fine_px));
        Self { view, native_px, mirrored, coarse, fine }
    }

    /// A plate point in body heights.
    pub(super) fn place(&self, at_px: [f64; 2]) -> Place {
        let [x, y] = self.view.transform.panel_from_plate(at_px);
        [self.turned(x) / self.native_px, y / self.native_px]
    }

    /// A place in plate px.
    pub(super) fn plate_px(&self, [x, y]: Place) -> [f64; 2] {
        self.view.transform.plate_from_panel([self.turned(x * self.native_px), y * self.native_px])
    }

    fn turned(&self, x: f64) -> f64 {
        if self.mirrored { f64::from(self.view.image.width()) - x } else { x }
    }
}

/// The pictures at a resolution of at most `most_px` per body height, and that resolution.
fn reduced(pictures: &[GrayImage], px_per_height: f64, most_px: f64) -> (Vec<GrayImage>, f64) {
    let factor = most_px / px_per_height;
    if factor >= 1.0 {
        return (pictures.to_vec(), px_per_height);
    }
    let size = |length: u32| ((f64::from(length) * factor).round() as u32).max(1);
    let small = |picture: &GrayImage| {
        resize(picture, size(picture.width()), size(picture.height()), FilterType::Triangle)
    };
    (pictures.iter().map(small).collect(), px_per_height * factor)
}
