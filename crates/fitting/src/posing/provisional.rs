//! Cameras for posing while a plate is still being calibrated.

use muybridge_capture::{
    Annotation, BodyPoint, Calibration, Facing, Keypoint, Keypoints, LimbJoint, Manifest, NearOff, Panel,
    PanelCamera, Position,
};
use muybridge_core::{Pair, Skeleton};

use super::lengths::median;

/// Withers height of an animal that nobody has measured, m: assumed, the reference horse's.
pub const ASSUMED_WITHERS_M: f64 = 1.60;
/// Height of the withers as a share of a panel's height, where nothing else tells: assumed, a horse and its rider fill
/// most of a panel.
const WITHERS_SHARE: f64 = 0.5;
/// Height of the ground over a panel's lower edge as a share of its height, until the line is drawn.
const GROUND_SHARE: f64 = 0.13;
/// Distance of the camera from the track, m, and height of its lens, m, where the manifest says nothing: the great battery
/// stood about forty feet from the track, with its lenses at the height of the animal's trunk.
const CAMERA_DISTANCE_M: f64 = 12.0;
const CAMERA_HEIGHT_M: f64 = 1.2;
/// Depth of the withers behind the plane of the near hooves, m: half a horse's track width.
const WITHERS_DEPTH_M: f64 = 0.12;
/// A scale below this, px/m, or above its inverse shows no horse.
const LEAST_SCALE: f64 = 1e-3;

/// Where a plate's scale is from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScaleOrigin {
    /// Given, for instance by the panels that can be calibrated.
    Given,
    /// Withers over drawn ground lines, at the manifest's withers height or at [`ASSUMED_WITHERS_M`].
    Withers,
    /// Placed limb joints against the reference skeleton.
    LimbLengths,
    /// The height of the panels.
    PanelHeight,
}

/// One scale for a plate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlateScale {
    /// In the near legs' plane, px/m.
    pub px_per_m: f64,
    /// Where it is from.
    pub from: ScaleOrigin,
}

/// The best scale there is: a given one in px/m, else withers, else limbs, else the panels' height.
pub fn plate_scale(
    skeleton: &Skeleton,
    manifest: &Manifest,
    annotation: &Annotation,
    facing: Facing,
    given_px_per_m: Option<f64>,
) -> PlateScale {
    let possible = |px_per_m: &f64| (LEAST_SCALE..1.0 / LEAST_SCALE).contains(px_per_m);
    let sources: [(ScaleOrigin, &dyn Fn() -> Option<f64>); 3] = [
        (ScaleOrigin::Given, &|| given_px_per_m),
        (ScaleOrigin::Withers, &|| from_withers(manifest, annotation, facing)),
        (ScaleOrigin::LimbLengths, &|| from_limbs(skeleton, manifest, annotation)),
    ];
    let best = sources.iter().find_map(|(from, scale)| {
        let px_per_m = scale().filter(possible)?;
        Some(PlateScale { px_per_m, from: *from })
    });
    let mut heights: Vec<f64> = manifest.panels.iter().map(height_px).collect();
    let from_panels = median(&mut heights).map(|px| px * WITHERS_SHARE / ASSUMED_WITHERS_M);
    best.unwrap_or(PlateScale {
        px_per_m: from_panels.filter(possible).unwrap_or(1.0),
        from: ScaleOrigin::PanelHeight,
    })
}

/// A camera for any panel of a manifest, none for a number it does not have.
///
/// The ground line is the drawn one, else a level one; the camera stands opposite the panel's middle. Its place along
/// the track is known from camera spacing only, and zero otherwise; `time_s` is zero and means nothing.
pub fn provisional_camera(
    manifest: &Manifest,
    annotation: &Annotation,
    facing: Facing,
    panel: u32,
    scale: PlateScale,
) -> Option<PanelCamera> {
    let index = manifest.panels.iter().position(|p| p.panel == panel)?;
    let ([origin, along], middle) =
        (ground(annotation, &manifest.panels[index]), manifest.panels[index].centre_px());
    let to_foot = (middle[0] - origin[0]) * along[0] + (middle[1] - origin[1]) * along[1];
    let calibration = manifest.calibration.as_ref();
    let (distance_m, height_m) = camera_place(calibration);
    let camera_x_m = match calibration.map(|c| &c.position) {
        Some(Position::CameraSpacing { spacing_m, .. }) => spacing_m.value * index as f64,
        _ => 0.0,
    };
    Some(PanelCamera {
        panel,
        time_s: 0.0,
        px_per_m: scale.px_per_m,
        axis_foot_px: [0, 1].map(|axis| origin[axis] + to_foot * along[axis]),
        forward: along.map(|a| a * facing.sign()),
        up: [along[1], -along[0]],
        camera_x_m: if camera_x_m.is_finite() { camera_x_m } else { 0.0 },
        distance_m,
        height_m,
    })
}

fn camera_place(calibration: Option<&Calibration>) -> (f64, f64) {
    let camera = calibration.map(|c| &c.camera);
    let distance_m = camera.map(|c| c.distance_m.value).filter(|d| d.is_finite() && *d > 1.0);
    let height_m = camera.map(|c| c.height_m.value).filter(|h| h.is_finite());
    (distance_m.unwrap_or(CAMERA_DISTANCE_M), height_m.unwrap_or(CAMERA_HEIGHT_M))
}

/// A point of a panel's ground line, and the line's direction to the right.
fn ground(annotation: &Annotation, panel: &Panel) -> [[f64; 2]; 2] {
    if let Some(line) = drawn_ground(annotation, panel.panel) {
        return line;
    }
    let [left, right] = [[0, 3], [1, 2]].map(|[top, bottom]| {
        let (top, bottom) = (panel.quad_px[top], panel.quad_px[bottom]);
        [0, 1].map(|axis| bottom[axis] + GROUND_SHARE * (top[axis] - bottom[axis]))
    });
    [[0, 1].map(|axis| 0.5 * (left[axis] + right[axis])), [1.0, 0.0]]
}

/// The drawn ground line in the same form; none when it is missing or has no direction.
fn drawn_ground(annotation: &Annotation, panel: u32) -> Option<[[f64; 2]; 2]> {
    let [a, b] = annotation.panels.iter().find(|p| p.panel == panel)?.ground_px?;
    let (dx, dy) = (b[0] - a[0], b[1] - a[1]);
    let along = [dx / dx.hypot(dy), dy / dx.hypot(dy)];
    along.iter().chain(&a).all(|v| v.is_finite()).then_some([a, along])
}

fn height_px(panel: &Panel) -> f64 {
    let side = |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]);
    0.5 * (side(panel.quad_px[0], panel.quad_px[3]) + side(panel.quad_px[1], panel.quad_px[2]))
}

/// Withers height over the drawn ground, px, against what it is or is assumed to be, m: the median of the panels.
fn from_withers(manifest: &Manifest, annotation: &Annotation, facing: Facing) -> Option<f64> {
    let unit = PlateScale { px_per_m: 1.0, from: ScaleOrigin::Given };
    let withers = Keypoint::Body(BodyPoint::Withers);
    let mut scales: Vec<f64> = annotation
        .panels
        .iter()
        .filter_map(|panel| {
            drawn_ground(annotation, panel.panel)?;
            let camera = provisional_camera(manifest, annotation, facing, panel.panel, unit)?;
            let at_px = panel.keypoints.place(withers)?;
            let above = |p: [f64; 2]| {
                (0..2).map(|axis| (p[axis] - camera.axis_foot_px[axis]) * camera.up[axis]).sum::<f64>()
            };
            let per_px = above(camera.plate_from_world([0.0, withers_m(manifest), -WITHERS_DEPTH_M]));
            Some(above(at_px) / per_px)
        })
        .collect();
    median(&mut scales)
}

/// The manifest's withers height where it drives the scale or is known at all, else the assumed one, m.
fn withers_m(manifest: &Manifest) -> f64 {
    let scale = manifest.calibration.as_ref().map(|c| &c.scale);
    let known = scale.and_then(|s| s.withers_height_m.as_ref());
    known.map(|k| k.value).filter(|h| h.is_finite() && *h > 0.0).unwrap_or(ASSUMED_WITHERS_M)
}

/// Distances of neighbouring joints of near limbs against the reference's, sized to the same withers height.
fn from_limbs(skeleton: &Skeleton, manifest: &Manifest, annotation: &Annotation) -> Option<f64> {
    let size = withers_m(manifest) / f64::from(skeleton.withers_height_m);
    let mut ratios: Vec<f64> = annotation
        .panels
        .iter()
        .flat_map(|panel| limb_distances_px(&panel.keypoints))
        .map(|(bone, px)| px / (size * f64::from(skeleton.bones[bone].length_m)))
        .filter(|ratio| ratio.is_finite() && *ratio > 0.0)
        .collect();
    median(&mut ratios)
}

/// Bones of near limbs, both of whose ends are placed, with the distance, px.
fn limb_distances_px(keypoints: &Keypoints) -> Vec<(usize, f64)> {
    use LimbJoint::{Fetlock, Hoof, Middle, Root, Upper};
    let pairs = [Pair::Fore, Pair::Hind].into_iter().flat_map(|pair| {
        [[Root, Upper], [Upper, Middle], [Middle, Fetlock], [Fetlock, Hoof]].map(move |ends| (pair, ends))
    });
    let distances = pairs.filter_map(|(pair, ends)| {
        let [upper, lower] = ends.map(|joint| Keypoint::Limb(NearOff::Near, pair, joint));
        let ([ax, ay], [bx, by]) = (keypoints.place(upper)?, keypoints.place(lower)?);
        // Left and right bones are alike, so either facing will do.
        Some((lower.bone(Facing::Left)?, (ax - bx).hypot(ay - by)))
    });
    distances.collect()
}
