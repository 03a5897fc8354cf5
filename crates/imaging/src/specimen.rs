//! Drawing plates whose truth is known: a horse in motion before a ruled wall, photographed by a battery of cameras, mounted,
//! captioned and aged.
//!
//! A specimen is for tests and lessons. Each one says on its mount that it is a drawing, and its truth says so too.
//!
//! Every photograph is a similarity of [`PanelCamera`](muybridge_capture::PanelCamera): a panel's quadrilateral is how the
//! print was cut, not how its content is bent, so that the truth of every point is `plate_from_world` to the last digit.
//! World of the truth: metres, x forward along the track with the first camera at zero, y up, z towards the camera with the
//! near hooves' plane at zero.

mod documents;
mod horse;
mod layout;
mod limb;
mod paint;
mod photograph;
mod print;
mod raster;
mod rider;
mod scene;
mod style;
mod swung;
mod truth;

use image::GrayImage;
use image::codecs::jpeg::JpegEncoder;
use muybridge_capture::Facing;
use muybridge_core::{BONE_COUNT, Gait, Random, bone};
use serde::{Deserialize, Serialize};

pub use style::{Grid, Mount, SpecimenStyle, Tones};
pub use swung::swung_legs;
pub use truth::{PanelTruth, SPECIMEN_SCHEMA, SpecimenTruth, UprightTruth};

use layout::Layout;
use photograph::Photograph;

/// Printed on the mount of every specimen.
pub const NOTICE: &str = "DRAWN SPECIMEN - NOT A PHOTOGRAPH";
/// JPEG quality of [`encode`]: grain costs most of the bytes, and above 80 a plate of 1600 px exceeds 250 KB.
const JPEG_QUALITY: u8 = 80;

/// One horse at one instant: x forward along the track, y up from the ground, z towards the camera with the near hooves'
/// plane at zero, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct PosedHorse {
    /// When, s.
    pub time_s: f64,
    /// Proximal and distal end of each bone, in the order of the core skeleton.
    pub bones: [[[f64; 3]; 2]; BONE_COUNT],
    /// Top of the croup.
    pub croup: [f64; 3],
    /// Root of the tail.
    pub dock: [f64; 3],
    /// Whether each leg is on the ground, in the order of [`Limb::ALL`](muybridge_core::Limb::ALL).
    pub down: [bool; 4],
}

impl PosedHorse {
    /// The same horse farther along the track.
    fn moved(&self, by_m: f64) -> Self {
        let moved = |[x, y, z]: [f64; 3]| [x + by_m, y, z];
        let mut pose = self.clone();
        pose.bones = pose.bones.map(|ends| ends.map(moved));
        (pose.croup, pose.dock) = (moved(pose.croup), moved(pose.dock));
        pose
    }

    fn tip(&self, bone: usize) -> [f64; 3] {
        self.bones[bone][1]
    }

    fn withers(&self) -> [f64; 3] {
        self.tip(bone::SPINE_LAST)
    }

    /// Place of the trunk along the track, m.
    fn trunk_x_m(&self) -> f64 {
        0.5 * (self.withers()[0] + self.croup[0])
    }
}

/// An obstacle across the track.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Hurdle {
    /// Place along the track, m: the motion's in a [`SpecimenMotion`], the plate's in a [`SpecimenTruth`].
    pub x_m: f64,
    /// Height over the track, m.
    pub height_m: f64,
}

/// What the cameras see.
#[derive(Clone, Debug, PartialEq)]
pub struct SpecimenMotion {
    /// The gait.
    pub gait: Gait,
    /// Which way the horse faces.
    pub facing: Facing,
    /// Height of the withers when it stands, m.
    pub withers_height_m: f64,
    /// Mean speed, m/s.
    pub speed_m_s: f64,
    /// Poses after which the movement repeats; none for a leap.
    pub closes_after_panels: Option<f64>,
    /// One pose per panel, in order of time.
    pub poses: Vec<PosedHorse>,
    /// An obstacle, for a leap.
    pub hurdle: Option<Hurdle>,
}

/// Which pixels of a plate show the horse and its rider, within one panel.
#[derive(Clone, Debug, PartialEq)]
pub struct Silhouette {
    /// Column of the plate of the mask's first column.
    pub left_px: u32,
    /// Row of the plate of the mask's first row.
    pub top_px: u32,
    /// 0 outside to 255 inside; between them on the outline.
    pub mask: GrayImage,
}

impl Silhouette {
    /// The mask's value at a point of the plate; zero beyond the panel.
    pub fn at(&self, [x, y]: [f64; 2]) -> u8 {
        let (x, y) = (x - f64::from(self.left_px), y - f64::from(self.top_px));
        if x < 0.0 || y < 0.0 {
            return 0;
        }
        self.mask.get_pixel_checked(x as u32, y as u32).map_or(0, |pixel| pixel.0[0])
    }
}

/// A drawn plate.
#[derive(Clone, Debug)]
pub struct Specimen {
    /// The plate.
    pub picture: GrayImage,
    /// What is on it.
    pub truth: SpecimenTruth,
    /// The horse of each panel, in panel order.
    pub silhouettes: Vec<Silhouette>,
}

/// Draws a plate. Panels are filled in reading order, one pose each, until poses or cells run out. Equal motions and styles
/// give equal plates.
pub fn draw(motion: &SpecimenMotion, style: &SpecimenStyle) -> Specimen {
    let mut random = Random::new(style.seed);
    let layout = Layout::new(motion, style, &mut random);
    let mut plate = print::mounted(&layout, style);
    let mut silhouettes = Vec::with_capacity(layout.panels.len());
    let mut panels = Vec::with_capacity(layout.panels.len());
    for (panel, pose) in layout.panels.iter().zip(&motion.poses) {
        let pose = &pose.moved(-layout.origin_x_m);
        let photograph = Photograph::take(&layout, panel, pose, motion, style, &mut random);
        photograph.paste(&mut plate);
        panels.push(truth::panel_truth(panel, pose, motion, style, &photograph));
        silhouettes.push(photograph.silhouette());
    }
    print::ink(&mut plate, &layout, motion, style, &mut random);
    let picture = photograph::developed(plate, &layout, style, &mut random);
    let truth = SpecimenTruth::new(&layout, motion, style, panels);
    Specimen { picture, truth, silhouettes }
}

/// The plate as a file: a grey JPEG, the same bytes for equal pictures.
pub fn encode(specimen: &Specimen) -> Vec<u8> {
    let mut bytes = Vec::new();
    let picture = &specimen.picture;
    let encoded = JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY).encode_image(picture);
    // Writing to memory fails only for pictures beyond JPEG's 65535 px, which then have no bytes.
    if encoded.is_err() {
        bytes.clear();
    }
    bytes
}
