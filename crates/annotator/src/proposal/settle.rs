//! Tracked points laid on the skeleton, between what the photograph shows and what the animal can do.
//!
//! Tracking sees knees, hocks and hooves well, and guesses hips, shoulders and the back, which show nothing of their own. The
//! skeleton, with the bone lengths of the panels that are done, knows the latter better. So it is posed through the tracked
//! points, and each point goes towards it as far as its kind is better known from there. Points placed by hand count in the
//! pose and stay where they are, so that a second proposal after a correction takes along what the correction implies.

use std::collections::BTreeMap;

use muybridge_capture::{
    BodyPoint, Draft, Facing, KEYPOINT_COUNT, Keypoint, LimbJoint, PanelAnnotation, PanelCamera, Placed,
    PlacedBy,
};
use muybridge_core::Skeleton;
use muybridge_fitting::layout::SHARED;
use muybridge_fitting::posing::PanelPoser;
use muybridge_imaging::track::Proposal;

use crate::derived::{Derived, scatter};

/// Way from the tracked place to the skeleton's for knees, hocks, fetlocks and hooves: on drawn plates both are equally
/// good, and their errors have different causes.
const LOWER_LIMB_SHARE: f64 = 0.5;

type Places = [[f64; 2]; KEYPOINT_COUNT];

/// What the skeleton's places are worked out from, besides the documents.
pub(super) struct Settling {
    skeleton: Skeleton,
    cameras: BTreeMap<u32, PanelCamera>,
    lengths: [f64; SHARED],
}

impl Settling {
    pub(super) fn new(derived: &Derived) -> Self {
        Self {
            skeleton: derived.skeleton().clone(),
            cameras: derived.cameras.clone(),
            lengths: derived.lengths,
        }
    }

    /// The tracked points of a panel, moved towards the skeleton posed through them.
    ///
    /// A stride fitted to all panels spared no more clicks on drawn plates, and pulled what was left alone to itself: joints
    /// came out up to a tenth farther off.
    pub(super) fn settle(&self, draft: &Draft, panel: u32, tracked: &[Proposal]) -> Vec<Proposal> {
        let mut draft = draft.clone();
        let keypoints = &mut draft.panel_mut(panel).keypoints;
        for proposal in tracked {
            if keypoints.get(proposal.keypoint).is_none_or(|placed| placed.by != PlacedBy::Hand) {
                keypoints.insert(proposal.keypoint, proposal.placed);
            }
        }
        match self.posed_px(&draft, panel) {
            Some(places) => tracked.iter().map(|proposal| towards(proposal, &places)).collect(),
            None => tracked.to_vec(),
        }
    }

    /// Places of the skeleton through this panel's points.
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
