//! Colours that mean something. Orange and blue are told apart by everybody, on dark photographs and on light ones.

use egui::Color32;
use muybridge_capture::{BodyPoint, Keypoint, NearOff};
use muybridge_footprints::Foot;

/// Near legs.
pub const NEAR: Color32 = Color32::from_rgb(255, 150, 30);
/// Off legs.
pub const OFF: Color32 = Color32::from_rgb(70, 165, 255);
/// Head, neck and trunk.
pub const TRUNK: Color32 = Color32::from_rgb(250, 240, 150);
/// The fitted skeleton.
pub const FIT: Color32 = Color32::from_rgb(120, 235, 130);
/// Ground line.
pub const GROUND: Color32 = Color32::from_rgb(200, 130, 255);
/// Marks of known length, uprights.
pub const MARK: Color32 = Color32::from_rgb(255, 90, 160);
/// The panel before.
pub const BEFORE: Color32 = Color32::from_rgb(200, 120, 120);
/// The panel after.
pub const AFTER: Color32 = Color32::from_rgb(120, 190, 160);

/// Colour of a side.
pub fn side(side: NearOff) -> Color32 {
    match side {
        NearOff::Near => NEAR,
        NearOff::Off => OFF,
    }
}

/// Colour of a point.
pub fn keypoint(keypoint: Keypoint) -> Color32 {
    match keypoint {
        Keypoint::Body(_) => TRUNK,
        Keypoint::Limb(near_off, ..) => side(near_off),
    }
}

/// Colour of a point on the background of the window: darker on a light one.
pub fn on_background(keypoint: Keypoint, dark: bool) -> Color32 {
    let darken = if matches!(keypoint, Keypoint::Body(_)) { 0.6 } else { 0.4 };
    let color = self::keypoint(keypoint);
    if dark { color } else { color.lerp_to_gamma(Color32::BLACK, darken) }
}

/// Pairs of points that are joined by a line.
pub fn edges() -> impl Iterator<Item = [Keypoint; 2]> {
    use BodyPoint as B;
    let trunk = [
        [B::Muzzle, B::Poll],
        [B::Poll, B::Withers],
        [B::Withers, B::Back],
        [B::Back, B::Croup],
        [B::Croup, B::Dock],
    ];
    let trunk = trunk.map(|pair| pair.map(Keypoint::Body));
    let all: Vec<Keypoint> = Keypoint::all().collect();
    let limbs = all.windows(2).filter_map(|pair| match (pair[0], pair[1]) {
        (Keypoint::Limb(side, limb, _), Keypoint::Limb(other_side, other_limb, _)) => {
            (side == other_side && limb == other_limb).then_some([pair[0], pair[1]])
        }
        _ => None,
    });
    trunk.into_iter().chain(limbs.collect::<Vec<_>>())
}

/// A point's name for people: `near hock`.
pub fn name(keypoint: Keypoint) -> String {
    keypoint.name().replace('_', " ")
}

/// Colour of a footprint: left as the off legs, right as the near ones, which the usual cameras see.
pub fn foot(foot: Foot) -> Color32 {
    match foot {
        Foot::Left | Foot::LeftFore | Foot::LeftHind => OFF,
        Foot::Right | Foot::RightFore | Foot::RightHind => NEAR,
    }
}

/// Colour of a phase of support: in flight, on one foot (that foot's), on two, on three, on four.
pub fn support(down: &[Foot]) -> Color32 {
    match down {
        [] => MARK,
        [one] => foot(*one),
        [_, _] => FIT,
        [_, _, _] => TRUNK,
        _ => Color32::from_gray(190),
    }
}
