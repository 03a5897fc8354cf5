//! The mean stride as a plate: a manifest and an annotation that the fit reads like any other.
//!
//! The picture is a virtual one, in which the withers stand 400 px over the ground; every panel is the whole of it.

use muybridge_capture::{
    ANNOTATION_SCHEMA, Annotation, BodyPoint, Calibration, Camera, Facing, Keypoint, KeypointState,
    Keypoints, Known, LegContacts, MANIFEST_SCHEMA, Manifest, Panel, PanelAnnotation, PanelUse, Placed,
    PlacedBy, PlateImage, Position, Scale, ScaleSource, StanceLabel, StrideSpan, Time, TimeSource,
};
use muybridge_core::{Gait, Limb, Skeleton};

use super::clip::Clip;
use super::mean::{MeanPlace, PHASES};
use super::notes::notes;
use super::{HoofStance, MeanStride};

/// Withers height in the virtual picture, px: a plate's, so that numbers in px mean what they mean there.
const WITHERS_PX: f64 = 400.0;
/// Free paper around the points, px: twice what a point may lie outside of its panel.
const MARGIN_PX: f64 = 24.0;
/// What a mean over strides does not take away, withers heights: a tracker, like a person, puts a point off its landmark in
/// the same way in every stride. About half the scatter of single points placed by hand on the plate of 1878.
pub(super) const BIAS: f64 = 0.006;
/// The same for a poll guessed from nose and eye: skulls differ by a twelfth of the head's length.
const GUESS: f64 = 0.03;
/// A point of more spread than the first is as good as guessed, of more than the second it is left out, withers heights.
pub(super) const WIDE_SPREADS: [f64; 2] = [0.04, 0.08];
/// Standard deviation of an assumed withers height, m: riding horses of one kind.
const WITHERS_SD_M: f64 = 0.08;
/// Camera distance that is assumed where the parallax of near and off legs does not tell it, m.
const CAMERA_DISTANCE_M: f64 = 8.0;
/// Standard deviation of either, as a share: joints are not as far apart as hooves, and a lens is not known.
const CAMERA_DISTANCE_SD: f64 = 0.35;
/// Camera distances that are believed, m.
const CAMERA_DISTANCES_M: [f64; 2] = [3.0, 40.0];
/// Heights of a camera that are believed, m: between a tripod's lowest and a person's highest.
const CAMERA_HEIGHTS_M: [f64; 2] = [0.3, 2.0];
/// Its standard deviation, m.
const CAMERA_HEIGHT_SD_M: f64 = 0.6;

/// What a person says of a clip.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// Identifier of the plate.
    pub id: String,
    /// The gait.
    pub gait: Gait,
    /// Withers height, m; assumed.
    pub withers_height_m: f64,
    /// Path of the manifest from the annotation.
    pub plate: String,
}

/// Manifest and annotation of a mean stride. Equal inputs give equal documents.
pub fn documents(clip: &Clip, mean: &MeanStride, plan: &Plan) -> (Manifest, Annotation) {
    let frame = Frame::around(mean);
    (manifest(clip, mean, plan, &frame), annotation(clip, mean, plan, &frame))
}

/// The virtual picture.
struct Frame {
    facing: Facing,
    /// Trunk's middle and ground in the picture, px.
    origin_px: [f64; 2],
    /// Height of the ground line, withers heights.
    ground: f64,
    size_px: [u32; 2],
}

impl Frame {
    /// Holds all points.
    fn around(mean: &MeanStride) -> Self {
        let all = || mean.points.iter().flat_map(|point| point.places.iter().flatten()).map(|place| place.at);
        let sign = mean.facing.sign();
        let bounds = |values: &mut dyn Iterator<Item = f64>| {
            values.fold([0.0f64, 0.0f64], |[low, high], v| [low.min(v), high.max(v)])
        };
        let [left, right] = bounds(&mut all().map(|[x, _]| sign * x));
        let [low, high] = bounds(&mut all().map(|[_, y]| y));
        let px = |share: f64| share * WITHERS_PX;
        let size_px = [px(right - left), px(high - low)].map(|size| (size + 2.0 * MARGIN_PX).ceil() as u32);
        // Near fore and near hind.
        let ground = 0.5 * (mean.hooves[0].level + mean.hooves[2].level);
        let origin_px = [MARGIN_PX - px(left), MARGIN_PX + px(high)].map(f64::round);
        Self { facing: mean.facing, origin_px, ground, size_px }
    }

    /// A place, px, to a hundredth.
    fn at_px(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let x_px = self.origin_px[0] + self.facing.sign() * x * WITHERS_PX;
        [x_px, self.origin_px[1] - y * WITHERS_PX].map(hundredth)
    }

    fn corners_px(&self) -> [[f64; 2]; 4] {
        let [width, height] = self.size_px.map(f64::from);
        [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]]
    }
}

fn hundredth(value: f64) -> f64 {
    (100.0 * value).round() / 100.0
}

fn manifest(clip: &Clip, mean: &MeanStride, plan: &Plan, frame: &Frame) -> Manifest {
    let naming = clip.naming;
    let image = PlateImage {
        file: clip.file.clone(),
        sha256: clip.sha256.clone(),
        width_px: frame.size_px[0],
        height_px: frame.size_px[1],
    };
    let panel = |panel| Panel { panel, image: 0, quad_px: frame.corners_px() };
    Manifest {
        schema: MANIFEST_SCHEMA,
        id: plan.id.clone(),
        catalogue_number: None,
        title: naming.title.into(),
        animal: naming.animal.into(),
        gait: plan.gait,
        date: "not stated".into(),
        source: format!(
            "{}; the file named is that table, the picture of {WITHERS_PX} px withers height is a virtual one",
            naming.source
        ),
        holder: "the repository".into(),
        licence: "none stated with the table; only means over strides are kept here".into(),
        printed: Vec::new(),
        facing: Some(mean.facing),
        images: vec![image],
        panels: (1..=PHASES as u32).map(panel).collect(),
        calibration: Some(calibration(mean, plan)),
    }
}

fn calibration(mean: &MeanStride, plan: &Plan) -> Calibration {
    let assumed =
        |value, sd, from: &str| Known { value: hundredth(value), sd, assumed: true, from: from.into() };
    // While the animal passes, its near legs overtake its off legs by their distance over that of the camera.
    let parallax = mean.parallax().unwrap_or(0.0);
    let by_parallax = hoof_track_width_m() * mean.advance / parallax;
    let is_told = (CAMERA_DISTANCES_M[0]..=CAMERA_DISTANCES_M[1]).contains(&by_parallax);
    let distance_m = if is_told { by_parallax } else { CAMERA_DISTANCE_M };
    let distance_from = if is_told {
        "not stated; near legs overtake off legs so far while the animal passes, at the reference horse's distance between them"
    } else {
        "not stated; of the order at which a film shows two to four strides"
    };
    // Off soles are seen this much higher per metre of camera height.
    let rise_per_m = 1.0 - distance_m / (distance_m + hoof_track_width_m());
    let height_m = mean.off_rise() * plan.withers_height_m / rise_per_m;
    let height_m = height_m.clamp(CAMERA_HEIGHTS_M[0], CAMERA_HEIGHTS_M[1]);
    Calibration {
        scale: Scale {
            driven_by: ScaleSource::WithersHeight,
            known_length: None,
            withers_height_m: Some(assumed(
                plan.withers_height_m,
                WITHERS_SD_M,
                "a usual riding horse's; the film shows no known length",
            )),
        },
        position: Position::EvenAdvance { per_panel_m: None },
        time: Time {
            driven_by: TimeSource::DynamicSimilarity,
            interval_s: None,
            intervals_s: None,
            speed_m_s: None,
            stride_time_s: None,
        },
        camera: Camera {
            distance_m: assumed(distance_m, hundredth(CAMERA_DISTANCE_SD * distance_m), distance_from),
            height_m: assumed(
                height_m,
                CAMERA_HEIGHT_SD_M,
                "not stated; at that distance off soles then appear as far above near ones as they do, within what is possible",
            ),
        },
    }
}

/// Distance between the planes of near and off hooves, m: the reference horse's.
fn hoof_track_width_m() -> f64 {
    let horse = Skeleton::reference();
    let lateral_m = |limb: Limb| f64::from(horse.bones[limb.hoof_bone()].lateral_m);
    lateral_m(Limb::RF) - lateral_m(Limb::LF)
}

fn annotation(clip: &Clip, mean: &MeanStride, plan: &Plan, frame: &Frame) -> Annotation {
    let panels = (0..PHASES).map(|phase| panel(clip, mean, frame, phase)).collect();
    Annotation {
        schema: ANNOTATION_SCHEMA,
        plate: plan.plate.clone(),
        images_sha256: vec![clip.sha256.clone()],
        annotator: format!("{}; mean over strides by muybridge average", clip.naming.annotator),
        visible_sd_px: hundredth(BIAS * WITHERS_PX),
        occluded_sd_px: hundredth(WIDE_SPREADS[0] * WITHERS_PX),
        gait: None,
        stride: StrideSpan { first: 1, last: PHASES as u32, closes_after_panels: Some(PHASES as f64) },
        notes: notes(clip, mean),
        panels,
        instants: Vec::new(),
    }
}

fn panel(clip: &Clip, mean: &MeanStride, frame: &Frame, phase: usize) -> PanelAnnotation {
    let mut keypoints = Keypoints::default();
    for point in &mean.points {
        if let Some(place) = point.places[phase].filter(|place| place.spread <= WIDE_SPREADS[1]) {
            let guessed =
                clip.naming.poll_beyond_eye.is_some() && point.keypoint == Keypoint::Body(BodyPoint::Poll);
            keypoints.insert(point.keypoint, placed(&place, guessed, frame, clip.naming.placed_by));
        }
    }
    let unknown = StanceLabel::Unknown;
    let mut contacts =
        LegContacts { near_fore: unknown, off_fore: unknown, near_hind: unknown, off_hind: unknown };
    for hoof in &mean.hooves {
        contacts.set(hoof.side, hoof.pair, hoof.labels[phase]);
    }
    let ground_px = frame.at_px([0.0, frame.ground])[1];
    PanelAnnotation {
        panel: phase as u32 + 1,
        usage: PanelUse::Stride,
        ground_px: Some([[0.0, ground_px], [f64::from(frame.size_px[0]), ground_px]]),
        marks: Vec::new(),
        contacts,
        keypoints,
    }
}

fn placed(place: &MeanPlace, guessed: bool, frame: &Frame, by: PlacedBy) -> Placed {
    let doubtful = guessed || place.spread > WIDE_SPREADS[0];
    let bias = if guessed { GUESS } else { BIAS };
    Placed {
        at_px: Some(frame.at_px(place.at)),
        state: if doubtful { KeypointState::Occluded } else { KeypointState::Visible },
        by,
        sd_px: Some(hundredth(place.standard_error.hypot(bias) * WITHERS_PX)),
    }
}

impl HoofStance {
    /// Its labels as a line of signs, one a panel: `#` stance, `.` swing, `?` unknown.
    pub fn lane(&self) -> String {
        let sign = |label: &StanceLabel| match label {
            StanceLabel::Stance => '#',
            StanceLabel::Swing => '.',
            StanceLabel::Unknown => '?',
        };
        self.labels.iter().map(sign).collect()
    }
}
