//! Hooves: their soles lie on the ground while they bear weight, and hang on the pastern in the air.

use glam::{Quat, Vec3};
use muybridge_core::Limb;

use super::body::{Part, Tone};
use super::frames::Frames;
use super::loft::{Mesh, Ring, loft};
use super::terrain::Floor;

/// Angle between the line from fetlock to toe and the sole of a hoof that stands square or hangs, radians.
const SOLE_ANGLE_RAD: f32 = 1.12;
/// Pastern and coffin joint give way this far, radians: further, and the heel comes off the ground.
const GIVES_WAY_RAD: f32 = 0.75;
/// A hoof in the air begins to turn to the ground at this height, metres.
const NEAR_GROUND_M: f32 = 0.1;
/// A hoof that is in the ground is raised at most so far, metres.
const RAISED_M: f32 = 0.05;
/// Length of the sole, and half its width, metres.
const SOLE_M: [f32; 2] = [0.128, 0.06];
/// The coronet over the sole: its front and its back from the toe's tip backwards and up, and half its width, metres.
const CORONET_FRONT_M: [f32; 2] = [0.052, 0.082];
const CORONET_BACK_M: [f32; 2] = [0.13, 0.05];
const CORONET_WIDE_M: f32 = 0.041;
/// Corners of a ring.
const SEGMENTS: u32 = 12;

/// A hoof in world space.
pub(super) struct Hoof {
    toe: Vec3,
    forward: Vec3,
    up: Vec3,
    across: Vec3,
    size: f32,
}

impl Hoof {
    pub(super) fn of(frames: &Frames, limb: Limb, stands: bool, floor: &Floor<'_>) -> Self {
        let pastern = frames.bone(limb.hoof_bone());
        let hanging = Quat::from_axis_angle(pastern.across, SOLE_ANGLE_RAD) * pastern.along();
        let ground = floor.surface(pastern.tip);
        // A pose measured a little into the ground stands on it.
        let sunk = (ground.height_m - pastern.tip.y).clamp(0.0, RAISED_M * frames.size);
        let toe = pastern.tip + Vec3::Y * sunk;
        let nearness = 1.0 - (toe.y - ground.height_m) / (NEAR_GROUND_M * frames.size);
        let share = if stands { 1.0 } else { nearness.clamp(0.0, 1.0) * 0.5 };
        // In the leg's plane: how far the sole is turned up at the toe against the ground.
        let level = pastern.across.cross(ground.normal) * -1.0;
        let turn = hanging.cross(level).dot(pastern.across).atan2(hanging.dot(level));
        let turned = turn.clamp(-GIVES_WAY_RAD, GIVES_WAY_RAD) * share;
        let forward = Quat::from_axis_angle(pastern.across, turned) * hanging;
        // Across, a hoof that stands follows the ground as well.
        let up = pastern.across.cross(forward).normalize_or(Vec3::Y);
        let sideways = ground.normal.reject_from(forward).normalize_or(up);
        let up = up.lerp(sideways, if stands && sideways.dot(up) > 0.7 { 1.0 } else { 0.0 });
        Self { toe, forward, up, across: forward.cross(up), size: frames.size }
    }

    /// So far behind the toe's tip and over the sole.
    fn at(&self, [behind, over]: [f32; 2]) -> Vec3 {
        self.toe + (self.up * over - self.forward * behind) * self.size
    }

    fn ring(&self, front: [f32; 2], back: [f32; 2], wide: f32) -> Ring {
        let (front, back) = (self.at(front), self.at(back));
        Ring {
            centre: (front + back) / 2.0,
            deep: (front - back) / 2.0,
            wide: self.across * (wide * self.size),
            egg: 0.0,
            tint: 1.0,
            flow: 0.0,
        }
    }

    /// Where the skin of the leg ends.
    pub(super) fn coronet(&self) -> Ring {
        self.ring(CORONET_FRONT_M, CORONET_BACK_M, CORONET_WIDE_M)
    }

    pub(super) fn part(&self) -> Part {
        let widest = 1.04;
        let rings = [
            self.ring(CORONET_FRONT_M, CORONET_BACK_M, CORONET_WIDE_M * widest),
            self.ring([0.0, 0.0], [SOLE_M[0], 0.0], SOLE_M[1]),
        ];
        let caps_m = [0.008 * self.size, 0.0];
        Part::plain(loft(&rings, Mesh { steps: 2, segments: SEGMENTS, caps_m }), Tone::Hoof)
    }
}
