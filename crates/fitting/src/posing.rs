//! Posing one panel: the skeleton through the placed points, and the skeleton that follows a drag.
//!
//! A pose is the 33 unknowns of one panel in the order of [`layout`](crate::layout). Bone lengths are given and never
//! change here, bends never leave the joint limits, and numbers that are not finite leave a pose as it is.

mod damped;
mod drag;
mod from_points;
mod interpolation;
mod lengths;
mod plan;
mod provisional;
#[cfg(test)]
mod tests;

use muybridge_capture::{Facing, KEYPOINT_COUNT, Keypoint, LegContacts, NearOff, PanelCamera, StanceLabel};
use muybridge_core::{BONE_COUNT, Limb, Skeleton, bone};

use crate::chain::{Attachment, Chain, Vec2};
use crate::layout::{BENDS, PANEL_DOF, PITCH, ROOT_X, ROOT_Y, SHARED, SLIDES};
use crate::observation::{attachment, depth_m};
use crate::problem::{LinearRow, fetlock_row, reciprocal_row};

pub use drag::{Drag, DragOptions, Reach};
pub use from_points::HandScatter;
pub use interpolation::{SequencePanel, interpolate};
pub use lengths::{PlacedPanel, plate_lengths};
pub use provisional::{ASSUMED_WITHERS_M, PlateScale, ScaleOrigin, plate_scale, provisional_camera};

/// The unknowns of one panel: metres and radians, in the order of [`layout`](crate::layout).
pub type PanelPose = [f64; PANEL_DOF];

/// Bounds of a root's place along the track and over the ground, m, and of its pitch, rad: those of the stride fit.
const ROOT_BOUNDS: [f64; 2] = [-1e4, 1e4];
const PITCH_BOUNDS: [f64; 2] = [-1.0, 1.0];

/// How near a bend counts as being at its limit, rad: a tenth of a degree is less than anybody can see.
const AT_LIMIT_RAD: f64 = 0.002;

/// A bone as it is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BonePlace {
    /// Proximal and distal end, plate px.
    pub ends_px: [[f64; 2]; 2],
    /// Side of the limb it belongs to; none for head, neck and trunk.
    pub side: Option<NearOff>,
}

/// Which end of its range a joint has come to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LimitEnd {
    /// The least bend.
    Least,
    /// The greatest bend.
    Greatest,
}

/// Poses the skeleton in one panel.
#[derive(Clone, Debug)]
pub struct PanelPoser {
    chain: Chain,
    facing: Facing,
    lengths: [f64; SHARED],
    camera: PanelCamera,
    /// Contact label of each leg, in the order of [`Limb::ALL`].
    contacts: [StanceLabel; 4],
    reciprocal: Vec<LinearRow>,
    fetlock: Vec<LinearRow>,
}

impl PanelPoser {
    /// Prepares a skeleton with a plate's shared log-lengths for one panel.
    pub fn new(
        skeleton: &Skeleton,
        facing: Facing,
        lengths: &[f64; SHARED],
        camera: PanelCamera,
        contacts: &LegContacts,
    ) -> Self {
        let contacts = Limb::ALL.map(|limb| contacts.of(facing.near_off(limb.side()), limb.pair()));
        let fetlock = |limb: Limb| fetlock_row(skeleton, limb, contacts[limb.index()]);
        Self {
            chain: Chain::new(skeleton),
            facing,
            lengths: *lengths,
            camera,
            contacts,
            reciprocal: Limb::ALL.into_iter().filter_map(|limb| reciprocal_row(skeleton, limb)).collect(),
            fetlock: Limb::ALL.into_iter().filter_map(fetlock).collect(),
        }
    }

    /// The camera of the panel.
    pub fn camera(&self) -> &PanelCamera {
        &self.camera
    }

    /// The standing pose in the middle of the picture, hooves on the ground.
    pub fn rest_pose(&self) -> PanelPose {
        let mut pose = [0.0; PANEL_DOF];
        pose[BENDS..SLIDES].copy_from_slice(&self.chain.rest_rad);
        let k = self.chain.kinematics(&pose, &self.lengths);
        let toes = Limb::ALL.map(|limb| k.place(Attachment::Tip(limb.hoof_bone()))[1]);
        let withers_x = k.place(Attachment::Tip(bone::SPINE_LAST))[0];
        pose[ROOT_Y] = -toes.into_iter().fold(f64::INFINITY, f64::min);
        pose[ROOT_X] = self.camera.camera_x_m - 0.5 * withers_x;
        pose
    }

    /// Places of the keypoints, plate px, in the order of [`Keypoint::all`].
    pub fn keypoints_px(&self, pose: &PanelPose) -> [[f64; 2]; KEYPOINT_COUNT] {
        let k = self.chain.kinematics(pose, &self.lengths);
        let mut places = [[0.0; 2]; KEYPOINT_COUNT];
        for keypoint in Keypoint::all() {
            let on = attachment(keypoint, self.facing);
            places[keypoint.index()] = self.plate_px(k.place(on), self.depth_m(on));
        }
        places
    }

    /// Place of one keypoint, plate px.
    pub fn keypoint_px(&self, pose: &PanelPose, keypoint: Keypoint) -> [f64; 2] {
        let on = attachment(keypoint, self.facing);
        self.plate_px(self.chain.kinematics(pose, &self.lengths).place(on), self.depth_m(on))
    }

    /// Both ends of every bone, in the order of [`muybridge_core::bone`].
    pub fn bones_px(&self, pose: &PanelPose) -> [BonePlace; BONE_COUNT] {
        let k = self.chain.kinematics(pose, &self.lengths);
        std::array::from_fn(|bone| {
            let [base, tip] = k.bone(bone);
            let limb = Skeleton::limb_of(bone);
            let tip_depth = self.depth_m(Attachment::Tip(bone));
            // The scapula lies along the rib cage; every other bone starts where its parent ends.
            let on_ribs = limb.is_some() && self.chain.parents[bone] == Some(bone::SPINE_LAST);
            let base_depth = match self.chain.parents[bone] {
                _ if on_ribs => tip_depth,
                Some(parent) => self.depth_m(Attachment::Tip(parent)),
                None => self.depth_m(Attachment::Root),
            };
            BonePlace {
                ends_px: [self.plate_px(base, base_depth), self.plate_px(tip, tip_depth)],
                side: limb.map(|limb| self.facing.near_off(limb.side())),
            }
        })
    }

    /// Bones whose bend against their parent is at a joint limit.
    pub fn at_limits(&self, pose: &PanelPose) -> Vec<(usize, LimitEnd)> {
        let ends = (0..BONE_COUNT).filter_map(|bone| {
            let ([least, greatest], bend) = (self.chain.limits_rad[bone], pose[BENDS + bone]);
            if bend <= least + AT_LIMIT_RAD {
                Some((bone, LimitEnd::Least))
            } else {
                (bend >= greatest - AT_LIMIT_RAD).then_some((bone, LimitEnd::Greatest))
            }
        });
        ends.collect()
    }

    /// The whole figure moved by so many plate px.
    pub fn moved(&self, pose: &PanelPose, by_px: [f64; 2]) -> PanelPose {
        let camera = &self.camera;
        let along =
            |axis: [f64; 2]| (by_px[0] * axis[0] + by_px[1] * axis[1]) / self.px_per_m(Attachment::Root);
        let mut moved = *pose;
        moved[ROOT_X] += along(camera.forward);
        moved[ROOT_Y] += along(camera.up);
        self.within_limits(&moved).unwrap_or(*pose)
    }

    /// The whole figure turned about a point of the plate; a positive angle, rad, raises the head.
    pub fn tilted(&self, pose: &PanelPose, about_px: [f64; 2], angle_rad: f64) -> PanelPose {
        let pivot = self.world_m(about_px, Attachment::Root);
        let mut tilted = *pose;
        tilted[PITCH] = (pose[PITCH] + angle_rad).clamp(PITCH_BOUNDS[0], PITCH_BOUNDS[1]);
        let (sin, cos) = (tilted[PITCH] - pose[PITCH]).sin_cos();
        let [x, y] = [pose[ROOT_X] - pivot[0], pose[ROOT_Y] - pivot[1]];
        tilted[ROOT_X] = pivot[0] + cos * x - sin * y;
        tilted[ROOT_Y] = pivot[1] + sin * x + cos * y;
        self.within_limits(&tilted).unwrap_or(*pose)
    }

    /// A pose with every unknown within its bounds; none when a number is not finite.
    pub fn within_limits(&self, pose: &PanelPose) -> Option<PanelPose> {
        let bounds = self.bounds();
        let finite = pose.iter().all(|value| value.is_finite());
        finite.then(|| std::array::from_fn(|i| pose[i].clamp(bounds[i][0], bounds[i][1])))
    }

    /// Least and greatest value of each unknown.
    fn bounds(&self) -> [[f64; 2]; PANEL_DOF] {
        let mut bounds = [ROOT_BOUNDS; PANEL_DOF];
        bounds[PITCH] = PITCH_BOUNDS;
        bounds[BENDS..SLIDES].copy_from_slice(&self.chain.limits_rad);
        bounds[SLIDES..].fill(self.chain.slide_limits_m);
        bounds
    }

    fn depth_m(&self, on: Attachment) -> f64 {
        depth_m(&self.chain, on, self.facing)
    }

    fn plate_px(&self, [x_m, y_m]: Vec2, depth_m: f64) -> [f64; 2] {
        self.camera.plate_from_world([x_m, y_m, depth_m])
    }

    /// The place in the sagittal plane of a point that is seen at a plate px, m.
    fn world_m(&self, at_px: [f64; 2], on: Attachment) -> Vec2 {
        let [x, y, _] = self.camera.world_from_plate(at_px, self.depth_m(on));
        [x, y]
    }

    /// Scale in the plane of a point, px/m.
    fn px_per_m(&self, on: Attachment) -> f64 {
        let distance_m = self.camera.distance_m;
        self.camera.px_per_m * distance_m / (distance_m - self.depth_m(on))
    }
}
