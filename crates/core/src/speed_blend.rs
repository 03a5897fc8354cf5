//! A gait at any speed: between the strides of the database at whole miles per hour.

use crate::database::Database;
use crate::gait::Gait;
use crate::limb::Limb;
use crate::pose::Pose;
use crate::provenance::Provenance;
use crate::skeleton::BONE_COUNT;
use crate::stride::{Contact, Stride};

/// A gait between two neighbouring speeds of the database.
///
/// Neighbours are a mile per hour apart and made from one capture, so that their mean keeps a standing hoof within a millimetre of
/// its print.
#[derive(Clone, Copy, Debug)]
pub struct SpeedBlend<'a> {
    /// The stride at the speed below or at the wanted one.
    pub slower: &'a Stride,
    /// The stride at the speed above it; the same at the ends of the gait's range.
    pub faster: &'a Stride,
    /// How far from `slower` to `faster`, 0 to 1.
    pub share: f32,
}

impl Database {
    /// A gait at a speed in m/s, held within the range the database has; none for a gait without strides at whole miles per
    /// hour. Not a number counts as the slowest speed.
    pub fn at_speed(&self, gait: Gait, speed_m_s: f32) -> Option<SpeedBlend<'_>> {
        let made = |stride: &&Stride| !matches!(stride.provenance, Provenance::Captured { .. });
        let strides = || self.strides_of(gait).filter(made);
        let first = strides().next()?;
        let slower = strides().take_while(|stride| stride.speed_m_s <= speed_m_s).last().unwrap_or(first);
        let faster = strides().find(|stride| stride.speed_m_s > slower.speed_m_s).unwrap_or(slower);
        let apart = faster.speed_m_s - slower.speed_m_s;
        let share = if apart > 0.0 { ((speed_m_s - slower.speed_m_s) / apart).clamp(0.0, 1.0) } else { 0.0 };
        Some(SpeedBlend { slower, faster, share: if share.is_nan() { 0.0 } else { share } })
    }
}

impl SpeedBlend<'_> {
    fn mix(&self, slower: f32, faster: f32) -> f32 {
        slower + self.share * (faster - slower)
    }

    /// Speed, m/s.
    pub fn speed_m_s(&self) -> f32 {
        self.stride_length_m() / self.stride_time_s()
    }

    /// Duration of a stride, s.
    pub fn stride_time_s(&self) -> f32 {
        self.mix(self.slower.stride_time_s, self.faster.stride_time_s)
    }

    /// Distance covered in one stride, m.
    pub fn stride_length_m(&self) -> f32 {
        self.mix(self.slower.stride_length_m(), self.faster.stride_length_m())
    }

    /// When each hoof is down, in the order of [`Limb::ALL`].
    pub fn contacts(&self) -> [Contact; 4] {
        Limb::ALL.map(|limb| {
            let [a, b] = [self.slower, self.faster].map(|stride| stride.contacts[limb.index()]);
            // The shorter way around the circle.
            let turn =
                |a: f32, b: f32| (a + self.share * ((b - a + 0.5).rem_euclid(1.0) - 0.5)).rem_euclid(1.0);
            Contact {
                strike_phase: turn(a.strike_phase, b.strike_phase),
                lift_off_phase: turn(a.lift_off_phase, b.lift_off_phase),
            }
        })
    }

    /// Pose at a phase (any real number; whole strides add their length). Allocates nothing.
    pub fn pose(&self, phase: f32) -> Pose {
        let (a, b) = (self.slower.pose(phase), self.faster.pose(phase));
        let mut pose = a;
        pose.root_in_world = a.root_in_world.lerp(b.root_in_world, self.share);
        pose.world_from_root = a.world_from_root.slerp(b.world_from_root, self.share);
        for i in 0..BONE_COUNT {
            pose.bends_rad[i] = self.mix(a.bends_rad[i], b.bends_rad[i]);
        }
        for i in 0..2 {
            pose.scapula_slides_m[i] = self.mix(a.scapula_slides_m[i], b.scapula_slides_m[i]);
        }
        pose
    }
}
