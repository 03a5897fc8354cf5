//! The stride's panels in the animal's own frame and in withers heights, with or without a calibration.

use muybridge_capture::{
    Annotation, BodyPoint, KEYPOINT_COUNT, Keypoint, KeypointState, LimbJoint, Manifest, NearOff,
    PanelAnnotation, PanelCamera, PlateCalibration, StanceLabel,
};
use muybridge_core::{Pair, Skeleton};

use crate::chain::{Attachment, Chain};
use crate::footfalls::{ClosedBy, StrideClock, stride_panels};
use crate::held_out::quantile;
use crate::observation::depth_m;

/// Trunk points that ride with the body.
const TRUNK: [BodyPoint; 4] = [BodyPoint::Withers, BodyPoint::Back, BodyPoint::Croup, BodyPoint::Dock];

/// A panel.
pub(super) struct PanelView<'a> {
    pub(super) annotation: &'a PanelAnnotation,
    pub(super) panel: u32,
    /// Place on the ring, panels.
    pub(super) at_panel: f64,
    /// Withers height in the near legs' plane, px.
    pub(super) height_px: f64,
    /// Forward and up from the trunk, withers heights.
    pub(super) points: [Option<[f64; 2]>; KEYPOINT_COUNT],
    pub(super) camera: Option<PanelCamera>,
    frame: Frame,
}

/// All of them in order of time.
pub(super) struct PlateView<'a> {
    pub(super) panels: Vec<PanelView<'a>>,
    /// Panels after which the first follows the last, where that is known.
    pub(super) closes_after_panels: Option<f64>,
    /// Standard deviation of a coordinate of a visible and an occluded point, px.
    pub(super) hand_sd_px: [f64; 2],
    /// Depth of the off hooves, fore and hind, m.
    off_depth_m: [f64; 2],
}

/// Directions of a panel, plate px.
#[derive(Clone, Copy)]
struct Frame {
    forward: [f64; 2],
    up: [f64; 2],
    /// A point of the ground line.
    ground_px: Option<[f64; 2]>,
}

impl Frame {
    fn new(panel: &PanelAnnotation, camera: Option<&PanelCamera>, sign: f64) -> Self {
        if let Some(camera) = camera {
            return Self { forward: camera.forward, up: camera.up, ground_px: Some(camera.axis_foot_px) };
        }
        let drawn = panel.ground_px.and_then(|[a, b]| {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            (length > 0.0).then(|| (a, [0, 1].map(|axis| (b[axis] - a[axis]) / length)))
        });
        let (ground_px, along) = drawn.map_or((None, [1.0, 0.0]), |(a, along)| (Some(a), along));
        Self { forward: along.map(|v| v * sign), up: [along[1], -along[0]], ground_px }
    }

    fn of(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let dot = |direction: [f64; 2]| x * direction[0] + y * direction[1];
        [dot(self.forward), dot(self.up)]
    }
}

impl<'a> PlateView<'a> {
    /// None when no panel shows how large the animal is.
    pub(super) fn new(
        annotation: &'a Annotation,
        manifest: &Manifest,
        calibration: Option<&PlateCalibration>,
        clock: &StrideClock,
    ) -> Option<Self> {
        let sign = manifest.facing.map_or_else(|| faces(annotation), muybridge_capture::Facing::sign);
        let camera = |panel: u32| calibration?.stride.iter().find(|c| c.panel == panel).copied();
        let used: Vec<(&PanelAnnotation, Option<PanelCamera>, Frame)> = stride_panels(annotation, clock)
            .into_iter()
            .map(|(_, index)| {
                let panel = &annotation.panels[index];
                let camera = camera(panel.panel);
                (panel, camera, Frame::new(panel, camera.as_ref(), sign))
            })
            .collect();
        let scale = |camera: &Option<PanelCamera>| camera.map_or(1.0, |c| c.px_per_m);
        let heights: Vec<f64> = used
            .iter()
            .filter_map(|(panel, camera, frame)| Some(withers_px(panel, frame)? / scale(camera)))
            .collect();
        let height = Some(quantile(&heights, 0.5)).filter(|height| *height > 0.0)?;
        let mut panels: Vec<PanelView<'a>> = used
            .into_iter()
            .map(|(annotation, camera, frame)| PanelView {
                annotation,
                panel: annotation.panel,
                at_panel: clock.wrapped(f64::from(annotation.panel)),
                height_px: height * scale(&camera),
                points: [None; KEYPOINT_COUNT],
                camera,
                frame,
            })
            .collect();
        centre(&mut panels);
        let chain = Chain::new(&Skeleton::reference());
        let off_depth_m = [Pair::Fore, Pair::Hind].map(|pair| {
            let facing = muybridge_capture::Facing::Right;
            depth_m(&chain, Attachment::Tip(facing.limb(NearOff::Off, pair).hoof_bone()), facing)
        });
        let closes = (clock.closed_by() != ClosedBy::PanelCount).then(|| clock.closes_after_panels());
        let hand_sd_px = [annotation.visible_sd_px, annotation.occluded_sd_px];
        Some(Self { panels, closes_after_panels: closes, hand_sd_px, off_depth_m })
    }

    /// Standard deviation of a placed coordinate, px.
    pub(super) fn sd_px(&self, panel: &PanelView<'_>, keypoint: Keypoint) -> f64 {
        let visible =
            panel.annotation.keypoints.get(keypoint).map(|p| p.state) == Some(KeypointState::Visible);
        self.hand_sd_px[usize::from(!visible)]
    }

    /// Where a toe is on the track with a camera, `[along, above]` the ground in withers heights.
    pub(super) fn toe(&self, panel: &PanelView<'_>, side: NearOff, pair: Pair) -> Option<[f64; 2]> {
        let at_px = panel.annotation.keypoints.place(Keypoint::hoof(side, pair))?;
        let camera = panel.camera?;
        let depth_m = match side {
            NearOff::Near => 0.0,
            NearOff::Off => self.off_depth_m[usize::from(pair == Pair::Hind)],
        };
        let [x_m, y_m, _] = camera.world_from_plate(at_px, depth_m);
        let height_m = panel.height_px / camera.px_per_m;
        Some([x_m / height_m, y_m / height_m])
    }

    /// Height of a toe over the ground line, withers heights; without a camera the off toes are as high as they appear.
    pub(super) fn toe_height(&self, panel: &PanelView<'_>, side: NearOff, pair: Pair) -> Option<f64> {
        if panel.camera.is_some() {
            return self.toe(panel, side, pair).map(|[_, above]| above);
        }
        let at_px = panel.annotation.keypoints.place(Keypoint::hoof(side, pair))?;
        let ground = panel.frame.ground_px?;
        let above = panel.frame.of([at_px[0] - ground[0], at_px[1] - ground[1]])[1];
        Some(above / panel.height_px)
    }
}

impl PanelView<'_> {
    pub(super) fn point(&self, keypoint: Keypoint) -> Option<[f64; 2]> {
        self.points[keypoint.index()]
    }

    pub(super) fn label(&self, side: NearOff, pair: Pair) -> StanceLabel {
        self.annotation.contacts.of(side, pair)
    }
}

/// +1 when the animal's head is on the right in most panels.
fn faces(annotation: &Annotation) -> f64 {
    let x = |panel: &PanelAnnotation, point| panel.keypoints.place(Keypoint::Body(point)).map(|at| at[0]);
    let votes = annotation.panels.iter().filter_map(|panel| {
        let rear = x(panel, BodyPoint::Dock).or_else(|| x(panel, BodyPoint::Croup))?;
        let front = x(panel, BodyPoint::Muzzle).or_else(|| x(panel, BodyPoint::Withers))?;
        Some((front - rear).signum())
    });
    if votes.sum::<f64>() < 0.0 { -1.0 } else { 1.0 }
}

/// Height of the withers over the ground line, or over the lowest toe where no line is drawn, px.
fn withers_px(panel: &PanelAnnotation, frame: &Frame) -> Option<f64> {
    let withers = frame.of(panel.keypoints.place(Keypoint::Body(BodyPoint::Withers))?)[1];
    let toes = Keypoint::all()
        .filter(|keypoint| matches!(keypoint, Keypoint::Limb(_, _, LimbJoint::Hoof)))
        .filter_map(|keypoint| Some(frame.of(panel.keypoints.place(keypoint)?)[1]));
    let ground = match frame.ground_px {
        Some(ground) => frame.of(ground)[1],
        None => toes.min_by(f64::total_cmp)?,
    };
    Some(withers - ground)
}

/// Sets the points of all panels relative to the trunk: an additive fit (panel + trunk point), so that a point that is
/// missing in one panel does not shift it.
fn centre(panels: &mut [PanelView<'_>]) {
    let place = |panel: &PanelView<'_>, keypoint: Keypoint| {
        let at_px = panel.annotation.keypoints.place(keypoint)?;
        Some(panel.frame.of(at_px).map(|v| v / panel.height_px))
    };
    let trunk: Vec<[Option<[f64; 2]>; TRUNK.len()]> =
        panels.iter().map(|panel| TRUNK.map(|point| place(panel, Keypoint::Body(point)))).collect();
    let mut offsets = [[0.0; 2]; TRUNK.len()];
    let mut origins: Vec<Option<[f64; 2]>> = vec![None; panels.len()];
    // Alternating means converge geometrically; ten rounds leave nothing that matters here.
    for _ in 0..10 {
        for (origin, row) in origins.iter_mut().zip(&trunk) {
            let seen = row.iter().zip(&offsets).filter_map(|(p, o)| p.map(|p| [p[0] - o[0], p[1] - o[1]]));
            *origin = mean(seen);
        }
        for (k, offset) in offsets.iter_mut().enumerate() {
            let seen = trunk.iter().zip(&origins).filter_map(|(row, origin)| {
                let (p, o) = row[k].zip(*origin)?;
                Some([p[0] - o[0], p[1] - o[1]])
            });
            *offset = mean(seen).unwrap_or_default();
        }
    }
    for (panel, origin) in panels.iter_mut().zip(&origins) {
        let Some([x, y]) = *origin else { continue };
        for keypoint in Keypoint::all() {
            panel.points[keypoint.index()] = place(panel, keypoint).map(|p| [p[0] - x, p[1] - y]);
        }
    }
}

fn mean(points: impl Iterator<Item = [f64; 2]>) -> Option<[f64; 2]> {
    let (n, sum) = points.fold((0.0, [0.0; 2]), |(n, sum), p| (n + 1.0, [sum[0] + p[0], sum[1] + p[1]]));
    (n > 0.0).then(|| sum.map(|v| v / n))
}
