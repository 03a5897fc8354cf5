//! What a figure looks like: tubes along its body and its legs.

use glam::{DQuat, DVec3, Vec2, Vec3};
use serde::{Deserialize, Serialize};

use crate::model::Model;
use crate::pose::{BipedPose, LegPose};

/// A tube of elliptical sections, world space.
#[derive(Clone, Debug, PartialEq)]
pub struct Tube {
    /// Middles of the sections, at least two, metres.
    pub points: Vec<Vec3>,
    /// Half width (to the right) and half height (up) of each section, metres.
    pub radii_m: Vec<Vec2>,
    /// What is up for the sections.
    pub up: Vec3,
    /// Red, green and blue.
    pub color: [u8; 3],
}

/// Shape of a figure on two legs.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Shape {
    /// Tubes in the body's frame: ahead, up and to the right of the centre of mass.
    pub body: Vec<TubeModel>,
    /// The segments of a leg, from the hip.
    pub legs: Vec<SegmentShape>,
    /// Tubes of the right foot: ahead, up and to the right of the middle of its sole.
    pub foot: Vec<TubeModel>,
}

/// A tube that goes with the body or with a foot.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TubeModel {
    /// Middles of the sections, at least two, metres.
    pub points_m: Vec<[f64; 3]>,
    /// Half width and half height of each section, metres.
    pub radii_m: Vec<[f64; 2]>,
    /// What is up for the sections; absent: up.
    #[serde(default = "upwards", skip_serializing_if = "is_upwards")]
    pub up: [f64; 3],
    /// Red, green and blue.
    pub color: [u8; 3],
    /// Whether it is on the right and has a mirror image on the left. Not for feet, which are mirrored as a whole.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub mirrored: bool,
    /// How far it swings about its first point against the leg of its side, as an arm does, in angles of that leg.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub swing: f64,
}

/// Shape of a segment of a leg.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SegmentShape {
    /// Radius at its upper end, at a third of it and at its lower end, metres.
    pub radii_m: [f64; 3],
    /// Red, green and blue.
    pub color: [u8; 3],
}

/// Places of a segment's radii along it.
const ALONG_SEGMENT: [f64; 3] = [0.0, 1.0 / 3.0, 1.0];

fn upwards() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "the signature serde asks for")]
fn is_upwards(up: &[f64; 3]) -> bool {
    *up == upwards()
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "the signature serde asks for")]
fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

/// The tubes of a two-legged figure: its body, then its left and its right leg.
pub fn tubes(model: &Model, pose: &BipedPose) -> Vec<Tube> {
    let body = Placing { at: pose.centre_of_mass, turn: pose.world_from_body, side: 1.0 };
    let legs_rad = [&pose.legs[0], &pose.legs[1]].map(|leg| leg_angle(leg, pose.world_from_body));
    let mut tubes = Vec::new();
    for tube in &model.shape.body {
        let sides = if tube.mirrored { &[1.0, -1.0][..] } else { &[1.0] };
        for &side in sides {
            // An arm goes with the leg of the other side.
            let leg_rad = if side > 0.0 { legs_rad[0] } else { legs_rad[1] };
            tubes.push(Placing { side, ..body }.tube(tube, tube.swing * leg_rad));
        }
    }
    for (leg, side) in pose.legs.iter().zip([-1.0, 1.0]) {
        let ahead = leg.world_from_foot * DVec3::X * model.leg.foot.toe_ahead_m;
        let foot = Placing { at: leg.toe - ahead, turn: leg.world_from_foot, side };
        tubes.extend(segments(model, leg, pose.world_from_body * DVec3::Z));
        tubes.extend(model.shape.foot.iter().map(|tube| foot.tube(tube, 0.0)));
    }
    tubes
}

/// Angle of a leg ahead of straight down, radians.
fn leg_angle(leg: &LegPose, world_from_body: DQuat) -> f64 {
    let Some((hip, ankle)) = leg.joints.first().zip(leg.joints.last()) else { return 0.0 };
    let along = world_from_body.inverse() * (*ankle - *hip);
    f64::atan2(along.x, -along.y)
}

/// The tubes of a leg's segments.
fn segments(model: &Model, leg: &LegPose, right: DVec3) -> Vec<Tube> {
    let (_, forward) = leg.plane(right);
    let tube = |(shape, ends): (&SegmentShape, &[DVec3])| Tube {
        points: ALONG_SEGMENT.map(|share| ends[0].lerp(ends[1], share).as_vec3()).to_vec(),
        radii_m: shape.radii_m.map(|radius_m| Vec2::splat(radius_m as f32)).to_vec(),
        up: forward.as_vec3(),
        color: shape.color,
    };
    model.shape.legs.iter().zip(leg.joints.windows(2)).map(tube).collect()
}

/// Where tubes go: a place, a turn, and the side (1 right, -1 left: mirrored).
#[derive(Clone, Copy)]
struct Placing {
    at: DVec3,
    turn: DQuat,
    side: f64,
}

impl Placing {
    /// A tube, turned about the axis to the right through its first point by an angle forwards, radians.
    fn tube(&self, tube: &TubeModel, swing_rad: f64) -> Tube {
        let mirror = DVec3::new(1.0, 1.0, self.side);
        let swing = DQuat::from_rotation_z(swing_rad);
        let first = tube.points_m.first().copied().map_or(DVec3::ZERO, DVec3::from_array);
        let place = |point: &[f64; 3]| {
            let point = first + swing * (DVec3::from_array(*point) - first);
            (self.at + self.turn * (point * mirror)).as_vec3()
        };
        Tube {
            points: tube.points_m.iter().map(place).collect(),
            radii_m: tube
                .radii_m
                .iter()
                .map(|&[wide_m, high_m]| Vec2::new(wide_m as f32, high_m as f32))
                .collect(),
            up: (self.turn * swing * (DVec3::from_array(tube.up) * mirror)).as_vec3(),
            color: tube.color,
        }
    }
}
