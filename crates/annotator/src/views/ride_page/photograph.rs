//! The photograph of the open plate that is nearest in phase, beside the horse from the same side.

use egui::{Color32, FontId, Rect, RichText, Ui, UiBuilder, vec2};
use glam::Quat;
use muybridge_capture::NearOff;
use muybridge_core::{Joints, Limb};

use super::Ride;
use super::plate_phase::Nearest;
use crate::figure::FigurePose;
use crate::picture::Look;
use crate::ride::Which;
use crate::session::Session;

/// Width of the photograph, points, at most, and against the width of the view.
const WIDTH: f32 = 270.0;
const WIDTH_SHARE: f32 = 0.27;
/// Height against the width: the plates' photographs are wider than high.
const ASPECT: f32 = 0.72;
/// Free around the boxes.
const MARGIN: f32 = 10.0;
/// Height of a caption.
const CAPTION: f32 = 20.0;

/// The two pictures in the upper left corner of the view.
pub(super) fn show(
    ui: &mut Ui,
    view: Rect,
    session: &mut Session,
    ride: &mut Ride,
    nearest: Option<Nearest>,
) {
    let Some(nearest) = nearest else { return };
    let width = WIDTH.min(WIDTH_SHARE * view.width());
    let corner = view.min + vec2(MARGIN, MARGIN);
    let (panel, phase) = match nearest {
        Nearest::Panel { panel, phase } => (panel, phase),
        Nearest::None(why) => {
            let galley = ui.painter().layout_no_wrap(why.into(), FontId::proportional(12.5), Color32::WHITE);
            let rect = Rect::from_min_size(corner, galley.size() + vec2(12.0, 8.0));
            ui.painter().rect_filled(rect, 4.0, Color32::from_black_alpha(150));
            ui.painter().galley(rect.min + vec2(6.0, 4.0), galley, Color32::WHITE);
            return;
        }
    };
    let height = ASPECT * width;
    let photograph = Rect::from_min_size(corner, vec2(width, height));
    let figure = photograph.translate(vec2(width + 4.0, 0.0));
    let back = Rect::from_min_max(photograph.min, figure.max + vec2(0.0, CAPTION)).expand(4.0);
    ui.painter().rect_filled(back, 5.0, ui.visuals().panel_fill);
    draw_photograph(ui, session, panel, photograph);
    caption(ui, photograph, format!("Panel {panel} at phase {:.2} of the plate", phase.phase));
    let facing = session.facing();
    let filmed = facing.side(NearOff::Near);
    let Some(rider) = &ride.session.shown().riders[Which::A.index()] else { return };
    let heading_rad = rider.readout.heading_rad as f32;
    let Some(joints) = ride.session.joints(Which::A) else { return };
    let mut pose = FigurePose {
        joints: facing_along_x(&joints, heading_rad),
        standing: rider.readout.on_ground,
        ghost: false,
    };
    if phase.is_mirrored {
        pose = mirrored(&pose);
    }
    ride.beside.set_filmed(filmed);
    let content = UiBuilder::new().max_rect(figure).id_salt("beside the photograph");
    let colors = super::scene::scene_colors(ui.visuals().dark_mode);
    ui.scope_builder(content, |ui| ride.beside.ui(ui, figure.size(), &[pose], &colors));
    let lead = if phase.is_mirrored { "The horse, mirrored: it is on the other lead" } else { "The horse" };
    caption(ui, figure, lead.to_string());
}

fn caption(ui: &mut Ui, below: Rect, text: String) {
    let rect = Rect::from_min_size(below.left_bottom(), vec2(below.width(), CAPTION));
    ui.put(rect, egui::Label::new(RichText::new(text).size(11.5)).truncate());
}

fn draw_photograph(ui: &Ui, session: &mut Session, panel: u32, into: Rect) {
    let painter = ui.painter().with_clip_rect(into.intersect(ui.clip_rect()));
    painter.rect_filled(into, 0.0, ui.visuals().extreme_bg_color);
    let Some(place) = session.place_of(panel).cloned() else { return };
    session.images.want(place.image);
    if let Some((textures, source)) = session.picture(place.image) {
        textures.draw_quad(&painter, source, place.quad_px, into, Look::default());
    }
}

/// The joints of a horse that goes along X with its root over the origin, on the plane of height zero under its lowest toe.
fn facing_along_x(joints: &Joints, heading_rad: f32) -> Joints {
    let turn = Quat::from_rotation_y(-heading_rad);
    let lowest_m = Limb::ALL.map(|limb| joints.toe(limb).y).into_iter().fold(f32::INFINITY, f32::min);
    let origin = joints.root.with_y(lowest_m);
    mapped(joints, |at| turn * (at - origin))
}

fn mapped(joints: &Joints, map: impl Fn(glam::Vec3) -> glam::Vec3) -> Joints {
    Joints {
        root: map(joints.root),
        dock: map(joints.dock),
        bases: joints.bases.map(&map),
        tips: joints.tips.map(&map),
    }
}

/// The same pose in a mirror: left and right change places.
fn mirrored(pose: &FigurePose) -> FigurePose {
    let mut joints = mapped(&pose.joints, |at| at * glam::Vec3::new(1.0, 1.0, -1.0));
    let [lf, rf, lh, rh] = Limb::ALL.map(Limb::first_bone);
    for (left, right) in [(lf, rf), (lh, rh)] {
        for i in 0..5 {
            joints.bases.swap(left + i, right + i);
            joints.tips.swap(left + i, right + i);
        }
    }
    let [a, b, c, d] = pose.standing;
    FigurePose { joints, standing: [b, a, d, c], ghost: pose.ghost }
}
