//! Where each point is on the animal: in words, and in a small picture of a standing horse.

use std::sync::LazyLock;

use egui::{Color32, Painter, Pos2, Rect, Sense, Stroke, Ui, pos2, vec2};
use muybridge_capture::{BodyPoint, Facing, KEYPOINT_COUNT, Keypoint, LimbJoint};
use muybridge_core::{Joints, Limb, Pair, Pose, Skeleton, bone};

use crate::colors;

/// Where to click, for people who know horses, and those who do not.
pub fn where_it_is(keypoint: Keypoint) -> &'static str {
    match keypoint {
        Keypoint::Body(BodyPoint::Muzzle) => "Foremost tip of the nose",
        Keypoint::Body(BodyPoint::Poll) => "Top of the head, between the ears",
        Keypoint::Body(BodyPoint::Withers) => "Top of the shoulder blades, where the neck meets the back",
        Keypoint::Body(BodyPoint::Back) => "Upper outline, half way from withers to croup",
        Keypoint::Body(BodyPoint::Croup) => "Highest point of the rump",
        Keypoint::Body(BodyPoint::Dock) => "Root of the tail",
        Keypoint::Limb(_, Pair::Fore, LimbJoint::Root) => "Point of the shoulder, foremost bone of the chest",
        Keypoint::Limb(_, Pair::Fore, LimbJoint::Upper) => "Elbow, where the foreleg leaves the chest",
        Keypoint::Limb(_, Pair::Fore, LimbJoint::Middle) => "Knee (carpus), middle of the joint",
        Keypoint::Limb(_, Pair::Hind, LimbJoint::Root) => "Hip joint, a hand below and before the dock",
        Keypoint::Limb(_, Pair::Hind, LimbJoint::Upper) => "Stifle, at the flank where the thigh ends",
        Keypoint::Limb(_, Pair::Hind, LimbJoint::Middle) => "Hock, middle of the joint",
        Keypoint::Limb(_, _, LimbJoint::Fetlock) => "Fetlock, middle of the joint above the pastern",
        Keypoint::Limb(_, _, LimbJoint::Hoof) => "Tip of the toe, at the sole",
    }
}

/// The standing reference horse, seen from the side it is filmed from.
pub struct AnatomyPicture {
    joints: Joints,
    bones: Vec<(usize, f32)>,
    places: [[f32; 2]; KEYPOINT_COUNT],
    facing: Facing,
}

/// Half the thickness of the flesh around a bone, m: of the reference horse's outline, by eye.
fn thickness_m(bone: usize) -> f32 {
    match bone {
        bone::SPINE..bone::NECK => 0.0,
        bone::NECK..=bone::NECK_LAST => 0.14,
        bone::HEAD => 0.11,
        limb => match (limb - bone::LIMBS) % 5 {
            0 => 0.14,
            1 => 0.11,
            2 => 0.07,
            3 => 0.035,
            _ => 0.04,
        },
    }
}

impl AnatomyPicture {
    /// The picture for an animal that faces one way.
    pub fn new(facing: Facing) -> Self {
        // Made anew in every frame: the skeleton's file is read once.
        static SKELETON: LazyLock<Skeleton> = LazyLock::new(Skeleton::reference);
        let joints = Pose::standing(&SKELETON).joints(&SKELETON);
        let mut places = [[0.0; 2]; KEYPOINT_COUNT];
        for keypoint in Keypoint::all() {
            let at = match (keypoint, keypoint.bone(facing)) {
                (Keypoint::Body(BodyPoint::Dock), _) => joints.dock,
                (_, Some(bone)) => joints.tips[bone],
                (_, None) => joints.root,
            };
            // Off legs stand a little farther forward, so that both of a pair are seen.
            let off = matches!(keypoint, Keypoint::Limb(muybridge_capture::NearOff::Off, ..));
            places[keypoint.index()] = [at.x + if off { 0.16 } else { 0.0 }, at.y];
        }
        let bones = (0..muybridge_core::BONE_COUNT).map(|bone| (bone, thickness_m(bone))).collect();
        Self { joints, bones, places, facing }
    }

    /// Draws it as wide as there is room, with the placed points filled and one of them ringed. A point that was clicked.
    pub fn show(
        &self,
        ui: &mut Ui,
        placed: impl Fn(Keypoint) -> bool,
        ringed: Option<Keypoint>,
    ) -> Option<Keypoint> {
        let width = ui.available_width();
        let (rect, response) = ui.allocate_exact_size(vec2(width, 0.8 * width), Sense::click());
        response.widget_info(|| {
            egui::WidgetInfo::labeled(
                egui::accesskit::Role::Image,
                true,
                "Picture of the horse with its points",
            )
        });
        let painter = ui.painter_at(rect);
        let to_screen = self.to_screen(rect);
        let dark = ui.visuals().dark_mode;
        self.draw_flesh(&painter, &to_screen, dark);
        for pair in colors::edges() {
            let ends = pair.map(|keypoint| to_screen(self.places[keypoint.index()]));
            painter.line_segment(ends, Stroke::new(1.5, colors::on_background(pair[1], dark)));
        }
        for keypoint in Keypoint::all() {
            let (at, color) =
                (to_screen(self.places[keypoint.index()]), colors::on_background(keypoint, dark));
            if placed(keypoint) {
                painter.circle_filled(at, 3.5, color);
            } else {
                painter.circle(at, 3.5, ui.visuals().extreme_bg_color, Stroke::new(1.2, color));
            }
            if ringed == Some(keypoint) {
                painter.circle_stroke(at, 8.0, Stroke::new(2.5, ui.visuals().strong_text_color()));
            }
        }
        let clicked = response.interact_pointer_pos().filter(|_| response.clicked())?;
        let distance = |keypoint: &Keypoint| to_screen(self.places[keypoint.index()]).distance(clicked);
        Keypoint::all().min_by(|a, b| distance(a).total_cmp(&distance(b))).filter(|k| distance(k) < 14.0)
    }

    /// From metres of the sagittal plane to the screen.
    fn to_screen(&self, rect: Rect) -> impl Fn([f32; 2]) -> Pos2 + use<> {
        let (least, greatest) = ([-0.55f32, -0.08], [2.05f32, 2.3]);
        let scale = (rect.width() / (greatest[0] - least[0])).min(rect.height() / (greatest[1] - least[1]));
        let (sign, centre) = (self.facing.sign() as f32, rect.center());
        let middle = [0.5 * (least[0] + greatest[0]), 0.5 * (least[1] + greatest[1])];
        move |[x, y]| pos2(centre.x + sign * scale * (x - middle[0]), centre.y - scale * (y - middle[1]))
    }

    fn draw_flesh(&self, painter: &Painter, to_screen: &impl Fn([f32; 2]) -> Pos2, dark: bool) {
        let color = if dark { Color32::from_gray(62) } else { Color32::from_gray(205) };
        let scale = to_screen([1.0, 0.0]).distance(to_screen([0.0, 0.0]));
        let capsule = |a: [f32; 2], b: [f32; 2], half_m: f32| {
            let (a, b, half) = (to_screen(a), to_screen(b), half_m * scale);
            painter.line_segment([a, b], Stroke::new(2.0 * half, color));
            painter.circle_filled(a, half, color);
            painter.circle_filled(b, half, color);
        };
        let near = Limb::new(Pair::Fore, self.facing.side(muybridge_capture::NearOff::Near)).first_bone();
        let near_hind =
            Limb::new(Pair::Hind, self.facing.side(muybridge_capture::NearOff::Near)).first_bone();
        for (bone, half_m) in &self.bones {
            let off_limb = *bone >= bone::LIMBS
                && !(near..near + 5).contains(bone)
                && !(near_hind..near_hind + 5).contains(bone);
            if *half_m > 0.0 && !off_limb {
                let [a, b] = [self.joints.bases[*bone], self.joints.tips[*bone]].map(|p| [p.x, p.y]);
                capsule(a, b, *half_m);
            }
        }
        // The barrel hangs below the spine.
        let [croup, withers] = [self.joints.root, self.joints.tips[bone::SPINE_LAST]];
        capsule([croup.x + 0.05, croup.y - 0.3], [withers.x - 0.02, withers.y - 0.36], 0.29);
    }
}
