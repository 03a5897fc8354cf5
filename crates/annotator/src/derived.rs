//! What follows from the documents: cameras, lengths, poses, footfalls, warnings. Worked out anew when something changed,
//! and only what changed.

use std::collections::BTreeMap;
use std::sync::Arc;

use muybridge_capture::{Draft, Facing, PanelAnnotation, PanelCamera, PlateCalibration, calibrate};
use muybridge_core::{ContactLaw, Database, Skeleton};
use muybridge_fitting::checks::{Concern, before_fit};
use muybridge_fitting::footfalls::{Footfalls, LiveGait, Missing, StrideClock};
use muybridge_fitting::layout::SHARED;
use muybridge_fitting::posing::{
    HandScatter, PanelPose, PanelPoser, PlacedPanel, PlateScale, plate_lengths, plate_scale,
    provisional_camera,
};

use crate::fit_state::Fitted;

/// Fewest points from which a pose is worked out for the skeleton that is drawn and dragged.
const LEAST_POINTS: usize = 3;

/// The pose of one panel, and from what it was worked out.
struct CachedPose {
    annotation: PanelAnnotation,
    camera: PanelCamera,
    lengths: [f64; SHARED],
    pose: PanelPose,
}

/// What follows from the documents.
pub struct Derived {
    state: Option<(u64, u64)>,
    skeleton: Skeleton,
    laws: Vec<ContactLaw>,
    /// Cameras and times, or why there are none.
    pub calibration: Result<PlateCalibration, String>,
    /// A camera for every panel: calibrated, else provisional.
    pub cameras: BTreeMap<u32, PanelCamera>,
    /// Scale of the provisional cameras.
    pub scale: Option<PlateScale>,
    /// Lengths of the animal's bones, shared by all panels: the fit's where there is one.
    pub lengths: [f64; SHARED],
    /// The four lanes.
    pub footfalls: Option<Footfalls>,
    /// Gait in numbers, or what is missing.
    pub gait: Result<LiveGait, Vec<Missing>>,
    /// What to look at again, worst first.
    pub concerns: Vec<Concern>,
    poses: BTreeMap<u32, CachedPose>,
}

impl Default for Derived {
    fn default() -> Self {
        Self {
            state: None,
            skeleton: Skeleton::reference(),
            laws: Database::embedded().laws.clone(),
            calibration: Err("not worked out yet".into()),
            cameras: BTreeMap::new(),
            scale: None,
            lengths: [0.0; SHARED],
            footfalls: None,
            gait: Err(Vec::new()),
            concerns: Vec::new(),
            poses: BTreeMap::new(),
        }
    }
}

impl Derived {
    /// The reference skeleton.
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// Laws of contact time of the database.
    pub fn laws(&self) -> &[ContactLaw] {
        &self.laws
    }

    /// Works out what changed since the last call. `state` changes with the draft, `fits` with the fit.
    pub fn update(&mut self, draft: &Draft, state: u64, fitted: Option<&Arc<Fitted>>, dragging: bool) {
        let fits = fitted.map_or(0, |fitted| fitted.number);
        if self.state == Some((state, fits)) {
            return;
        }
        self.state = Some((state, fits));
        let Draft { manifest, annotation } = draft;
        let facing = manifest.facing.unwrap_or(Facing::Right);
        let calibrated = calibrate(manifest, annotation);
        self.calibration = calibrated.map_err(|error| error.to_string());
        self.find_cameras(draft, facing);
        self.lengths = match fitted {
            Some(fitted) => std::array::from_fn(|i| fitted.plate.fit.shared()[i]),
            None => self.placed_lengths(draft, facing),
        };
        let calibration = self.calibration.as_ref().ok();
        let stride_time = fitted.map(|fitted| fitted.plate.fit.stride_time);
        let clock = StrideClock::new(annotation, calibration, stride_time);
        let footfalls = Footfalls::new(annotation, clock);
        let withers_height_m = fitted.map(|fitted| fitted.plate.withers_height_m);
        self.gait = LiveGait::new(
            &footfalls,
            (manifest, annotation.gait(manifest)),
            calibration,
            withers_height_m,
            &self.laws,
        );
        self.footfalls = Some(footfalls);
        if !dragging {
            self.concerns = before_fit(annotation, manifest, self.calibration.as_ref().ok());
        }
    }

    fn find_cameras(&mut self, draft: &Draft, facing: Facing) {
        let Draft { manifest, annotation } = draft;
        self.cameras.clear();
        if let Ok(calibration) = &self.calibration {
            let known = calibration.stride.iter().chain(&calibration.standing);
            self.cameras.extend(known.map(|camera| (camera.panel, *camera)));
        }
        let given = self.cameras.values().next().map(|camera| camera.px_per_m);
        let scale = plate_scale(&self.skeleton, manifest, annotation, facing, given);
        self.scale = Some(scale);
        for panel in &manifest.panels {
            if !self.cameras.contains_key(&panel.panel)
                && let Some(camera) = provisional_camera(manifest, annotation, facing, panel.panel, scale)
            {
                self.cameras.insert(panel.panel, camera);
            }
        }
    }

    fn placed_lengths(&self, draft: &Draft, facing: Facing) -> [f64; SHARED] {
        let placed = draft.annotation.panels.iter().filter_map(|panel| {
            Some(PlacedPanel { camera: self.cameras.get(&panel.panel)?, keypoints: &panel.keypoints })
        });
        plate_lengths(&self.skeleton, facing, &placed.collect::<Vec<_>>())
    }

    /// Poses the skeleton in a panel; none for a panel that the plate does not have.
    pub fn poser(&self, draft: &Draft, panel: u32) -> Option<PanelPoser> {
        let facing = draft.manifest.facing.unwrap_or(Facing::Right);
        let camera = *self.cameras.get(&panel)?;
        let empty = PanelAnnotation::empty(panel);
        let contacts = &draft.panel(panel).unwrap_or(&empty).contacts;
        Some(PanelPoser::new(&self.skeleton, facing, &self.lengths, camera, contacts))
    }

    /// The pose through a panel's points, kept until something it depends on changes; none with too few points.
    pub fn pose(&mut self, draft: &Draft, panel: u32) -> Option<PanelPose> {
        let annotation = draft.panel(panel)?;
        let placed = annotation.keypoints.iter().filter(|(_, placed)| placed.place().is_some()).count();
        if placed < LEAST_POINTS {
            return None;
        }
        let camera = *self.cameras.get(&panel)?;
        if let Some(cached) = self.poses.get(&panel)
            && cached.annotation == *annotation
            && cached.camera == camera
            && cached.lengths == self.lengths
        {
            return Some(cached.pose);
        }
        let poser = self.poser(draft, panel)?;
        let pose = poser.pose_from_points(&annotation.keypoints, scatter(draft), None);
        let (annotation, lengths) = (annotation.clone(), self.lengths);
        self.poses.insert(panel, CachedPose { annotation, camera, lengths, pose });
        Some(pose)
    }

    /// The similarity that lays one panel over another: scale and slope by their cameras, ground on ground, withers on
    /// withers (or, where they are not placed, the middle of what is placed). As `[px] -> [px]`.
    pub fn registration(
        &self,
        draft: &Draft,
        from: u32,
        to: u32,
    ) -> Option<impl Fn([f64; 2]) -> [f64; 2] + use<>> {
        let (source, target) = (*self.cameras.get(&from)?, *self.cameras.get(&to)?);
        let anchor = |panel: u32, camera: &PanelCamera| {
            let keypoints = draft.panel(panel).map(|panel| &panel.keypoints);
            let withers = muybridge_capture::Keypoint::Body(muybridge_capture::BodyPoint::Withers);
            let withers = keypoints.and_then(|keypoints| keypoints.place(withers));
            withers.map(|at| camera.world_from_plate(at, 0.0)[0])
        };
        let here = anchor(from, &source).zip(anchor(to, &target));
        let (from_m, to_m) = here.unwrap_or((source.camera_x_m, target.camera_x_m));
        Some(move |at_px: [f64; 2]| {
            let [x, y, z] = source.world_from_plate(at_px, 0.0);
            target.plate_from_world([x - from_m + to_m, y, z])
        })
    }
}

/// How well points are placed, as the annotation says.
pub fn scatter(draft: &Draft) -> HandScatter {
    let annotation = &draft.annotation;
    HandScatter { visible_px: annotation.visible_sd_px, occluded_px: annotation.occluded_sd_px }
}
