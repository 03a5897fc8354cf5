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
    BodyPoint, Draft, Facing, KEYPOINT_COUNT, Keypoint, LimbJoint, NearOff, PanelAnnotation, PanelCamera,
    PanelUse, Placed, PlacedBy, Plate, calibrate,
};
use muybridge_core::{Pair, Skeleton};
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

/// A tracked point farther than this from where a person puts it, m, was something else: twice the width of a cannon.
const ASTRAY_M: f64 = 0.1;

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
        let astray = self.astray(draft, panel, tracked);
        let is_astray = |keypoint: Keypoint| limb(keypoint).is_some_and(|limb| astray.contains(&limb));
        let mut draft = draft.clone();
        let keypoints = &mut draft.panel_mut(panel).keypoints;
        for proposal in tracked {
            if keypoints.get(proposal.keypoint).is_some_and(|placed| placed.by == PlacedBy::Hand) {
                continue;
            }
            if is_astray(proposal.keypoint) {
                keypoints.remove(proposal.keypoint);
            } else {
                keypoints.insert(proposal.keypoint, proposal.placed);
            }
        }
        let Some(places) = self.fitted_px(&draft, panel).or_else(|| self.posed_px(&draft, panel)) else {
            return tracked.to_vec();
        };
        let settled = |proposal: &Proposal| {
            let share = if is_astray(proposal.keypoint) { 1.0 } else { share(proposal.keypoint) };
            towards(proposal, share, places[proposal.keypoint.index()])
        };
        tracked.iter().map(settled).collect()
    }

    /// Limbs of which a person has put a point far from where it was tracked: what was tracked of them is another limb, or
    /// none.
    fn astray(&self, draft: &Draft, panel: u32, tracked: &[Proposal]) -> Vec<(NearOff, Pair)> {
        let (Some(annotation), Some(camera)) = (draft.panel(panel), self.cameras.get(&panel)) else {
            return Vec::new();
        };
        let is_off = |proposal: &&Proposal| {
            let placed =
                annotation.keypoints.get(proposal.keypoint).filter(|placed| placed.by == PlacedBy::Hand);
            let both = placed.and_then(|placed| placed.at_px).zip(proposal.placed.at_px);
            both.is_some_and(|([ax, ay], [bx, by])| {
                (ax - bx).hypot(ay - by)
                    > std::env::var("ASTRAY").map_or(ASTRAY_M, |v| v.parse().unwrap()) * camera.px_per_m
            })
        };
        tracked.iter().filter(is_off).filter_map(|proposal| limb(proposal.keypoint)).collect()
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

fn limb(keypoint: Keypoint) -> Option<(NearOff, Pair)> {
    match keypoint {
        Keypoint::Body(_) => None,
        Keypoint::Limb(side, pair, _) => Some((side, pair)),
    }
}

fn towards(proposal: &Proposal, share: f64, place: [f64; 2]) -> Proposal {
    let between = |at: [f64; 2]| [0, 1].map(|axis| at[axis] + share * (place[axis] - at[axis]));
    let by = if share < 1.0 { PlacedBy::Tracked } else { PlacedBy::Fitted };
    let placed = Placed { at_px: proposal.placed.at_px.map(between), by, ..proposal.placed };
    Proposal { placed, ..*proposal }
}
