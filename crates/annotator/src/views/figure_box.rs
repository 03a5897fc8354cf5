//! The small three-dimensional figure that can be turned.

use egui::{Ui, vec2};
use muybridge_capture::{NearOff, StanceLabel};
use muybridge_core::{Joints, Limb, Pose, Skeleton};
use muybridge_fitting::layout::{BENDS, PITCH, ROOT_X, ROOT_Y, SHARED, SLIDES, log_length};
use muybridge_fitting::posing::PanelPose;

use crate::colors;
use crate::figure::{FigureColors, FigurePose};
use crate::session::Session;

/// Neck, head and barrel: bay.
const TRUNK: [u8; 3] = [176, 128, 84];
/// The ground: between a dark and a light window.
const GROUND: [u8; 3] = [126, 120, 112];

/// The skeleton of a plate's animal: the reference with the plate's lengths.
pub fn skeleton(reference: &Skeleton, lengths: &[f64; SHARED]) -> Skeleton {
    let mut skeleton = reference.clone();
    for (index, bone) in skeleton.bones.iter_mut().enumerate() {
        bone.length_m *= lengths[log_length(index)].exp() as f32;
    }
    skeleton
}

/// Joints of a pose of the fit, root over the origin of the track.
pub fn joints(skeleton: &Skeleton, pose: &PanelPose) -> Joints {
    let pose = Pose {
        root_in_world: glam::Vec3::new(pose[ROOT_X] as f32, pose[ROOT_Y] as f32, 0.0),
        world_from_root: glam::Quat::from_rotation_z(pose[PITCH] as f32),
        bends_rad: std::array::from_fn(|i| pose[BENDS + i] as f32),
        scapula_slides_m: [pose[SLIDES] as f32, pose[SLIDES + 1] as f32],
        ..Pose::default()
    };
    pose.joints(skeleton)
}

/// The colours of the window.
pub fn figure_colors() -> FigureColors {
    let [near, off] = [colors::NEAR, colors::OFF].map(|color| [color.r(), color.g(), color.b()]);
    FigureColors { near, off, trunk: TRUNK, ground: GROUND, sky: None }
}

/// The present panel's skeleton, as far as there are points.
pub fn show(ui: &mut Ui, session: &mut Session) {
    let (draft, panel) = (session.draft().clone(), session.panel);
    let Some(pose) = session.derived.pose(&draft, panel) else {
        ui.label("Place three points to see the skeleton here.");
        return;
    };
    let skeleton = skeleton(session.derived.skeleton(), &session.derived.lengths);
    let facing = session.facing();
    let contacts = session.panel_annotation().map(|panel| panel.contacts);
    let standing = Limb::ALL.map(|limb| {
        let label = contacts.map(|contacts| contacts.of(facing.near_off(limb.side()), limb.pair()));
        label == Some(StanceLabel::Stance)
    });
    let figure = FigurePose { joints: joints(&skeleton, &pose), standing, ghost: false };
    session.figure.set_filmed(facing.side(NearOff::Near));
    let width = ui.available_width();
    session.figure.ui(ui, vec2(width, 0.7 * width), &[figure], &figure_colors());
}
