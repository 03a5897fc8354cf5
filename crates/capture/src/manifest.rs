//! What is known of a plate before anybody places a point: origin, panels, and how scale and time are known.

use muybridge_core::{Gait, Limb, Pair, Side};
use serde::{Deserialize, Serialize};

use crate::keypoint::NearOff;

/// Schema version of a manifest file.
pub const MANIFEST_SCHEMA: u32 = 1;

/// Which way the animal faces in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Facing {
    /// Head to the left: its left side is near.
    Left,
    /// Head to the right: its right side is near.
    Right,
}

impl Facing {
    /// +1 when forward is towards larger x, -1 otherwise.
    pub fn sign(self) -> f64 {
        match self {
            Self::Left => -1.0,
            Self::Right => 1.0,
        }
    }

    /// The horse's own side of a near or off limb.
    pub fn side(self, near_off: NearOff) -> Side {
        let near = match self {
            Self::Left => Side::Left,
            Self::Right => Side::Right,
        };
        match near_off {
            NearOff::Near => near,
            NearOff::Off => near.opposite(),
        }
    }

    /// Near or off, of one of the horse's own sides.
    pub fn near_off(self, side: Side) -> NearOff {
        if self.side(NearOff::Near) == side { NearOff::Near } else { NearOff::Off }
    }

    /// The leg of a pair on the near or off side.
    pub fn limb(self, near_off: NearOff, pair: Pair) -> Limb {
        Limb::new(pair, self.side(near_off))
    }
}

/// A plate: one image of many panels, or one image per panel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// [`MANIFEST_SCHEMA`].
    pub schema: u32,
    /// Short name, the file's stem: `sallie-gardner-1878`.
    pub id: String,
    /// Plate number in *Animal Locomotion*, where it has one.
    pub catalogue_number: Option<String>,
    /// Title as printed.
    pub title: String,
    /// The animal's name.
    pub animal: String,
    /// Gait as titled.
    pub gait: Gait,
    /// Date as printed.
    pub date: String,
    /// Where the file came from.
    pub source: String,
    /// Who holds the original.
    pub holder: String,
    /// Licence or rights statement.
    pub licence: String,
    /// Statements printed on the plate, word for word.
    pub printed: Vec<String>,
    /// Which way the animal faces; none until somebody has looked.
    pub facing: Option<Facing>,
    /// The image files.
    pub images: Vec<PlateImage>,
    /// The panels in order of time.
    pub panels: Vec<Panel>,
    /// How scale, position and time are known; none until somebody has said.
    pub calibration: Option<Calibration>,
}

/// One image file, not committed with the project; the hash says which one was used.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PlateImage {
    /// Path relative to the plates folder.
    pub file: String,
    /// SHA-256 of the file, lower-case hexadecimal.
    pub sha256: String,
    /// Width, px.
    pub width_px: u32,
    /// Height, px.
    pub height_px: u32,
}

/// One photograph of the sequence.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Panel {
    /// Number, from 1, as people count them on the plate.
    pub panel: u32,
    /// Index into `images`.
    pub image: usize,
    /// Corners of the photograph in plate px: top left, top right, bottom right, bottom left.
    pub quad_px: [[f64; 2]; 4],
}

impl Panel {
    /// Whether a point of the plate lies in the panel, with a margin in px for points on the edge.
    pub fn contains(&self, point_in_plate_px: [f64; 2], margin_px: f64) -> bool {
        let [x, y] = point_in_plate_px;
        (0..4).all(|i| {
            let ([ax, ay], [bx, by]) = (self.quad_px[i], self.quad_px[(i + 1) % 4]);
            let (dx, dy) = (bx - ax, by - ay);
            dx * (y - ay) - dy * (x - ax) >= -margin_px * dx.hypot(dy)
        })
    }

    /// Centre of the panel in plate px.
    pub fn centre_px(&self) -> [f64; 2] {
        [0, 1].map(|axis| self.quad_px.iter().map(|corner| corner[axis]).sum::<f64>() / 4.0)
    }
}

/// A value with its standard deviation and where it is from.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Known {
    /// The value, in the unit the field's name says.
    pub value: f64,
    /// Standard deviation, same unit.
    pub sd: f64,
    /// Assumed by the person rather than stated with the plate.
    pub assumed: bool,
    /// In words: printed where, or assumed why.
    pub from: String,
}

/// How scale, position and time are known.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Calibration {
    /// Pixels per metre.
    pub scale: Scale,
    /// Where each panel's camera stands along the track.
    pub position: Position,
    /// When each panel was taken.
    pub time: Time,
    /// Camera distance and height, for the perspective of the off side.
    pub camera: Camera,
}

/// Which of the scales drives the fit; any other that is given is compared with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ScaleSource {
    /// A known length in the picture.
    KnownLength,
    /// The animal's height at the withers.
    WithersHeight,
}

/// Scale.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Scale {
    /// The one to use.
    pub driven_by: ScaleSource,
    /// Distance between neighbouring numbered marks.
    pub known_length: Option<KnownLength>,
    /// Withers height of the animal, m.
    pub withers_height_m: Option<Known>,
}

/// A known length in the picture: the distance between marks numbered n and n + 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KnownLength {
    /// Distance between neighbouring marks, m.
    pub mark_spacing_m: Known,
    /// The plane the marks lie in.
    pub plane: Plane,
}

/// Where marks stand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Plane {
    /// In the plane the animal moves in.
    Track,
    /// On a wall behind; the animal stands nearer and so appears larger.
    Wall(Parallax),
}

/// How much larger things on the track appear than things on the wall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Parallax {
    /// Distances are known, m.
    Distances {
        /// Camera to the middle of the track.
        camera_to_track_m: f64,
        /// Camera to the wall.
        camera_to_wall_m: f64,
    },
    /// The ratio of scales, track over wall.
    Ratio(Known),
    /// Measured from the plate: a hoof in stance must stay where it is while the camera changes.
    FromStance,
}

/// Where each panel's camera stands.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case", tag = "kind")]
pub enum Position {
    /// A battery: each panel is another camera, evenly spaced along the track.
    CameraSpacing {
        /// Distance between neighbouring cameras.
        spacing_m: Known,
        /// Number of the mark opposite the first panel's camera.
        first_axis_mark: f64,
    },
    /// A battery of unknown spacing: positions are measured from one mark seen in every panel.
    FixedMark {
        /// Number of the mark.
        mark: f64,
    },
    /// One camera that does not move.
    FixedCamera,
    /// Pictures cut out around the animal, or a stride averaged over many: only that the trunk moves on evenly is known.
    EvenAdvance {
        /// Distance the trunk moves from panel to panel; none to have it measured from the hooves in stance, which stay where
        /// they are while the trunk passes over them.
        per_panel_m: Option<Known>,
    },
}

/// Which of the times drives the fit; any other that is given is compared with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TimeSource {
    /// Interval between panels.
    Interval,
    /// Speed: each interval is the distance covered over the speed.
    Speed,
    /// Duration of one stride, spread evenly over its panels.
    StrideTime,
    /// Nothing is known: the speed at which horses have a stride of this length (dynamic similarity), panels evenly spaced in
    /// time. Every number that rests on it is inferred.
    DynamicSimilarity,
}

/// Time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Time {
    /// The one to use.
    pub driven_by: TimeSource,
    /// Interval between neighbouring panels, s.
    pub interval_s: Option<Known>,
    /// Intervals that differ: one for each gap between neighbouring panels of the stride, s. Replaces
    /// `interval_s.value`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub intervals_s: Option<Vec<f64>>,
    /// Speed of the animal, m/s.
    pub speed_m_s: Option<Known>,
    /// Duration of a stride, s.
    pub stride_time_s: Option<Known>,
}

/// The camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Camera {
    /// Distance from the near legs' plane, m.
    pub distance_m: Known,
    /// Height of the lens over the track, m.
    pub height_m: Known,
}
