//! Tracked points laid on the skeleton, between what the photograph shows and what the animal can do.
//!
//! Tracking sees knees, hocks and hooves well, and guesses hips, shoulders and the back, which show nothing of their own.
//! The fit of all panels with points knows the latter better: bone lengths, contacts and the swing of the neighbouring
//! panels. So it is worked out with the tracked points in it, and each point goes towards it as far as its kind is better
//! known from there. Points placed by hand count in the fit and stay where they are, so that a second proposal after a
//! correction takes along what the correction implies.

use std::collections::BTreeMap;
use std::path::Path;

use muybridge_capture::{
    BodyPoint, Draft, Facing, KEYPOINT_COUNT, Keypoint, LimbJoint, PanelAnnotation, PanelCamera, PanelUse,
    Placed, PlacedBy, Plate, calibrate,
};
use muybridge_core::Skeleton;
use muybridge_fitting::layout::SHARED;
use muybridge_fitting::observation::StrideObservation;
use muybridge_fitting::posing::PanelPoser;
use muybridge_fitting::stride_fit::{StrideTime, fit_stride};
use muybridge_fitting::weights::Weights;
use muybridge_imaging::track::Proposal;

use crate::derived::{Derived, scatter};

/// Fewest points of a panel that counts, as in a validated plate.
const LEAST_POINTS: usize = 6;
/// Way from the tracked place to the skeleton's for knees, hocks, fetlocks and hooves: on drawn plates both are equally
/// good, and their errors have different causes.
const LOWER_LIMB_SHARE: f64 = 0.5;

type Places = [[f64; 2]; KEYPOINT_COUNT];

/// What the skeleton's places are worked out from, besides the documents.
pub(super) struct Settling {
    skeleton: Skeleton,
    cameras: BTreeMap<u32, PanelCamera>,
    lengths: [f64; SHARED],
    closes_after_panels: Option<f64>,
}

impl Settling {
    pub(super) fn new(derived: &Derived) -> Self {
        Self {
            skeleton: derived.skeleton().clone(),
            cameras: derived.cameras.clone(),
            lengths: derived.lengths,
            closes_after_panels: derived.footfalls.as_ref().map(|f| f.clock.closes_after_panels()),
        }
    }

    /// The tracked points of a panel, moved towards the skeleton that the points of all panels make.
    pub(super) fn settle(&self, draft: &Draft, panel: u32, tracked: &[Proposal]) -> Vec<Proposal> {
        let mut draft = draft.clone();
        let keypoints = &mut draft.panel_mut(panel).keypoints;
        for proposal in tracked {
            if keypoints.get(proposal.keypoint).is_none_or(|placed| placed.by != PlacedBy::Hand) {
                keypoints.insert(proposal.keypoint, proposal.placed);
            }
        }
        match self.fitted_px(&draft, panel).or_else(|| self.posed_px(&draft, panel)) {
            Some(places) => tracked.iter().map(|proposal| towards(proposal, &places)).collect(),
            None => tracked.to_vec(),
        }
    }

    /// Places of the stride fitted to the panels that have points; none while it cannot be fitted.
    fn fitted_px(&self, draft: &Draft, panel: u32) -> Option<Places> {
        let mut annotation = draft.annotation.clone();
        for panel in &mut annotation.panels {
            if panel.keypoints.iter().filter(|(_, placed)| placed.place().is_some()).count() < LEAST_POINTS {
                panel.usage = PanelUse::Unused;
            }
        }
        let nowhere = Path::new("");
        let plate = Plate::from_documents((nowhere, draft.manifest.clone()), (nowhere, annotation)).ok()?;
        let calibration = calibrate(&plate.manifest, &plate.annotation).ok()?;
        let weights = Weights::default();
        let observation = StrideObservation::new(&plate, &calibration, &weights);
        // A few panels do not tell where the stride closes.
        let seconds = calibration.interval_s.value * self.closes_after_panels?;
        let fit = fit_stride(&self.skeleton, &observation, StrideTime { seconds, sd_s: 0.0 }, &weights);
        let slot = fit.problem.order.iter().position(|i| fit.observation.panels[*i].camera.panel == panel)?;
        let kinematics = fit.kinematics();
        let mut places = [[0.0; 2]; KEYPOINT_COUNT];
        for keypoint in Keypoint::all() {
            places[keypoint.index()] = fit.place_px(slot, &kinematics[slot], keypoint);
        }
        Some(places)
    }

    /// Places of the skeleton through this panel's points alone.
    fn posed_px(&self, draft: &Draft, panel: u32) -> Option<Places> {
        let facing = draft.manifest.facing.unwrap_or(Facing::Right);
        let annotation: &PanelAnnotation = draft.panel(panel)?;
        let camera = *self.cameras.get(&panel)?;
        let poser = PanelPoser::new(&self.skeleton, facing, &self.lengths, camera, &annotation.contacts);
        let pose = poser.pose_from_points(&annotation.keypoints, scatter(draft), None);
        Some(poser.keypoints_px(&pose))
    }
}

/// How far a kind of point goes from its tracked place to the skeleton's.
fn share(keypoint: Keypoint) -> f64 {
    match keypoint {
        // Head and neck are seen against the sky.
        Keypoint::Body(BodyPoint::Muzzle | BodyPoint::Poll) => 0.0,
        Keypoint::Body(_) | Keypoint::Limb(_, _, LimbJoint::Root | LimbJoint::Upper) => 1.0,
        Keypoint::Limb(..) => LOWER_LIMB_SHARE,
    }
}

fn towards(proposal: &Proposal, places: &Places) -> Proposal {
    let (share, place) = (share(proposal.keypoint), places[proposal.keypoint.index()]);
    let between = |at: [f64; 2]| [0, 1].map(|axis| at[axis] + share * (place[axis] - at[axis]));
    let by = if share < 1.0 { PlacedBy::Tracked } else { PlacedBy::Fitted };
    let placed = Placed { at_px: proposal.placed.at_px.map(between), by, ..proposal.placed };
    Proposal { placed, ..*proposal }
}
