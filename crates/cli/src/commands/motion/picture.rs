//! One moment of a ride as a picture.

use clap::{Args, ValueEnum};
use glam::{Vec2, Vec3};
use image::{Rgb, RgbImage, buffer::ConvertBuffer};
use muybridge_core::{BONE_COUNT, Limb, Pose, Side, Skeleton, bone};
use muybridge_imaging::figure::{Camera, Figure, FigureColors, Scene, Terrain, render};

use super::super::canvas::Canvas;
use super::ride::{Frame, Ride};
use crate::ride_script::RideGround;

/// How the horse is seen.
#[derive(Clone, Copy, Debug, Args)]
pub(super) struct ViewOptions {
    /// From where.
    #[arg(long, value_enum, default_value = "side")]
    view: View,
    /// Draw bones as lines, without a body.
    #[arg(long)]
    sticks: bool,
    /// Do not turn with the horse: keep looking in the direction of the start.
    #[arg(long)]
    keep_direction: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum View {
    /// The horse's right side.
    Side,
    /// From before, on its right.
    ThreeQuarter,
    /// From before.
    Front,
    /// From behind, a little above.
    Follow,
}

impl View {
    /// Yaw from the horse's heading, and pitch, rad.
    fn angles(self) -> [f32; 2] {
        use std::f32::consts::{FRAC_PI_2, FRAC_PI_4};
        match self {
            Self::Side => [0.0, 0.12],
            Self::ThreeQuarter => [FRAC_PI_4, 0.2],
            Self::Front => [FRAC_PI_2, 0.16],
            Self::Follow => [-FRAC_PI_2, 0.35],
        }
    }
}

/// The horse's right side is seen in the side view.
const FILMED: Side = Side::Right;
/// A galloping horse with room around it: metres across for each metre from croup to withers, standing.
const SEEN_ACROSS: f32 = 4.8;
/// Metres up for each metre of height to the poll, standing: on the flat, and where the ground rises and falls in the picture.
const SEEN_UP: [f32; 2] = [1.3, 1.42];
/// From the croup to the middle of the horse, nose to tail, as a share of the way from croup to withers.
const MIDDLE: f32 = 0.75;
/// The camera looks at this share of the height to the poll.
const LOOK_AT: f32 = 0.5;
/// From behind, the hind legs are nearer than the middle of the horse and take more room.
const NEAR_END: f32 = 1.25;
/// The camera follows this share of a rise of croup or withers beyond so many heights to the poll: a leap, not the bounce of a gait.
const FOLLOWED: f32 = 0.85;
const BOUNCE: f32 = 0.06;
/// The ground's height is averaged over this many heights to the poll before and behind the trunk.
const GROUND_REACH: f32 = 0.8;
/// A horse that changes gait is tinted with this, so much (Huang 2012, Fig. 4.1, draws it yellow).
pub(super) const CHANGE: Rgb<u8> = Rgb([240, 190, 20]);
const TINT: f32 = 0.75;
/// Width of a character of the captions.
const CHARACTER_PX: f64 = 9.64;
/// Lines of a stick figure.
const STICK_BODY: Rgb<u8> = Rgb([60, 48, 40]);
const STICK_NEAR: Rgb<u8> = Rgb([176, 60, 20]);
const STICK_OFF: Rgb<u8> = Rgb([40, 90, 150]);
/// Thickness of a stick and radius of a joint for each pixel of the picture's height.
const STICK: f64 = 0.016;

/// A camera that goes along with a horse.
pub(super) struct Photographer {
    options: ViewOptions,
    ground: RideGround,
    skeleton: Skeleton,
    /// Height of the poll, of the withers, and the way from croup to withers in the standing pose, m.
    poll_m: f32,
    withers_m: f32,
    trunk_m: f32,
    heading_rad: f32,
    size_px: [u32; 2],
    grid_m: f32,
}

impl Photographer {
    /// A camera for pictures of a size, at the start of a ride.
    pub(super) fn new(options: ViewOptions, ride: &Ride, size_px: [u32; 2]) -> Self {
        let skeleton = ride.horse.skeleton().clone();
        let joints = Pose::standing(&skeleton).joints(&skeleton);
        Self {
            options,
            ground: ride.script().ground,
            poll_m: joints.tips[bone::NECK_LAST].y,
            withers_m: joints.tips[bone::SPINE_LAST].y,
            trunk_m: joints.root.distance(joints.tips[bone::SPINE_LAST]),
            skeleton,
            heading_rad: ride.frame().readout.heading_rad as f32,
            size_px,
            grid_m: 1.0,
        }
    }

    /// Sets the distance of the lines on the ground, m.
    pub(super) fn with_grid(self, grid_m: f32) -> Self {
        Self { grid_m, ..self }
    }

    /// The picture of a moment, the camera turned to the left around the horse by an angle, rad.
    pub(super) fn shoot(&self, frame: &Frame, turned_rad: f32) -> RgbImage {
        let camera = self.camera(frame, turned_rad);
        let joints = frame.pose.joints(&self.skeleton);
        let figure = Figure { joints, standing: frame.readout.on_ground, ghost: false };
        let height = |x_m: f32, z_m: f32| self.ground.height_m(x_m, z_m);
        let colors = colors(frame.readout.change.is_some());
        let scene = Scene {
            figures: if self.options.sticks { &[] } else { std::slice::from_ref(&figure) },
            tubes: &[],
            decals: &[],
            filmed: FILMED,
            terrain: if self.ground == RideGround::Flat { Terrain::Flat } else { Terrain::Height(&height) },
            grid_m: self.grid_m,
            traces: &[],
            support_polygon: false,
            colors: &colors,
        };
        let picture = render(&scene, &camera, self.size_px.map(|side| side as usize), true).convert();
        if self.options.sticks { self.with_sticks(picture, &figure, &camera, frame) } else { picture }
    }

    fn camera(&self, frame: &Frame, turned_rad: f32) -> Camera {
        let [yaw, pitch] = self.options.view.angles();
        let heading =
            if self.options.keep_direction { self.heading_rad } else { frame.readout.heading_rad as f32 };
        let size_px = self.size_px.map(|side| side as f32);
        let up_m = self.poll_m * SEEN_UP[usize::from(self.ground != RideGround::Flat)];
        let widened = if self.options.view == View::Follow { NEAR_END } else { 1.0 };
        let seen_m = widened * (SEEN_ACROSS * self.trunk_m).max(up_m * size_px[0] / size_px[1]);
        Camera::orbit(self.target(frame), heading + yaw + turned_rad, pitch, seen_m, size_px)
    }

    /// What the camera looks at: the horse's middle, as high over the ground as that of a standing horse, or higher in a leap.
    fn target(&self, frame: &Frame) -> Vec3 {
        let joints = frame.pose.joints(&self.skeleton);
        let along = joints.tips[bone::SPINE_LAST] - joints.root;
        let along = Vec2::new(along.x, along.z).normalize_or_zero();
        let root = Vec2::new(joints.root.x, joints.root.z);
        let middle = root + along * (MIDDLE * self.trunk_m);
        let reach_m = GROUND_REACH * self.poll_m;
        let ground_m = (-4..=4)
            .map(|k| middle + along * (reach_m * k as f32 / 4.0))
            .map(|place| self.ground.height_m(place.x, place.y))
            .sum::<f32>()
            / 9.0;
        let rise_m = |joint: Vec3, usual_m: f32| joint.y - self.ground.height_m(joint.x, joint.z) - usual_m;
        let risen_m = rise_m(joints.root, self.skeleton.croup_height_m)
            .max(rise_m(joints.tips[bone::SPINE_LAST], self.withers_m));
        let followed_m = FOLLOWED * (risen_m - BOUNCE * self.poll_m).max(0.0);
        Vec3::new(middle.x, ground_m + LOOK_AT * self.poll_m + followed_m, middle.y)
    }

    fn with_sticks(&self, picture: RgbImage, figure: &Figure, camera: &Camera, frame: &Frame) -> RgbImage {
        let mut canvas = Canvas::of(picture);
        let place = |point: Vec3| camera.project(point).map(|at| [f64::from(at.x), f64::from(at.y)]);
        let thickness = (STICK * f64::from(self.size_px[1])).max(1.5);
        let joints = &figure.joints;
        let body = if frame.readout.change.is_some() { CHANGE } else { STICK_BODY };
        let far_side_first = [(STICK_OFF, Some(FILMED.opposite())), (body, None), (STICK_NEAR, Some(FILMED))];
        for (colour, side) in far_side_first {
            let bones = (0..BONE_COUNT).filter(|bone| Skeleton::limb_of(*bone).map(Limb::side) == side);
            let bones = bones.map(|bone| [joints.bases[bone], joints.tips[bone]]);
            let dock = side.is_none().then_some([joints.root, joints.dock]);
            for [from, to] in bones.chain(dock) {
                if let (Some(from), Some(to)) = (place(from), place(to)) {
                    canvas.line(from, to, thickness, colour);
                    canvas.dot(to, (0.6 * thickness) as i32, colour);
                }
            }
        }
        canvas.picture
    }
}

/// The colours of a horse; yellow while it changes gait.
fn colors(changing: bool) -> FigureColors {
    let usual = FigureColors::default();
    if !changing {
        return usual;
    }
    let tinted = |color: [u8; 3]| {
        let mix = |i: usize| f32::from(color[i]) + TINT * (f32::from(CHANGE.0[i]) - f32::from(color[i]));
        [0, 1, 2].map(|i| mix(i) as u8)
    };
    FigureColors { trunk: tinted(usual.trunk), near: tinted(usual.near), off: tinted(usual.off), ..usual }
}

/// What is seen: time, speed, what the horse does, and how much of a change is done.
pub(super) fn caption(frame: &Frame) -> [String; 4] {
    let doing = match (frame.readout.change, frame.lead()) {
        (Some(change), _) if change.from == frame.readout.gait => format!("{}: lead", frame.doing()),
        (Some(change), _) => format!("{} > {}", change.from, frame.doing()),
        (None, Some(lead)) => format!("{} {lead}", frame.doing()),
        (None, None) => frame.doing().to_string(),
    };
    let share = frame.readout.change.map(|change| format!(" {:.0} %", 100.0 * change.share));
    [
        format!("{:.2} s", frame.time_s),
        format!("{:.2} m/s", frame.readout.speed_m_s),
        doing,
        share.unwrap_or_default(),
    ]
}

/// Writes a line of text, as much of it as there is room for.
pub(super) fn write_line(canvas: &mut Canvas, at: [u32; 2], width_px: u32, line: &str, colour: Rgb<u8>) {
    let room = (f64::from(width_px) / CHARACTER_PX) as usize;
    let line: String = line.chars().take(room).collect();
    canvas.text(at.map(f64::from), &line, colour);
}
