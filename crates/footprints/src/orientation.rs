//! The planned orientation of the body: it follows the feet (van de Panne 1997, 2.6).

mod headings;
mod sways;

use glam::DQuat;

use crate::model::Sway;
use crate::placed::PlacedPrint;

pub(crate) use headings::{Headings, heading_rad};

/// Orientation of the body over time, at fixed steps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Orientation {
    /// Time of the first one, s.
    pub from_s: f64,
    /// Time between two, s.
    pub step_s: f64,
    /// Turns the body's frame (X ahead, Y up, Z right) into world space. One stands for all times.
    pub world_from_body: Vec<DQuat>,
}

impl Orientation {
    /// One orientation for all times.
    pub fn fixed(world_from_body: DQuat) -> Self {
        Self { from_s: 0.0, step_s: 1.0, world_from_body: vec![world_from_body] }
    }

    /// The orientation of an upright body over prints in the order of their footfalls, up to the end of the motion, s: its heading is
    /// the moving mean of those of the feet over a window, s, and it pitches twice a stride and rolls once.
    pub fn plan(prints: &[PlacedPrint], end_s: f64, window_s: f64, pitch: Sway, roll: Sway) -> Self {
        let headings = Headings::of(prints, end_s, window_s);
        let sways = sways::table(prints, &headings, window_s, [pitch, roll]);
        let turned = |(heading_rad, [pitch_rad, roll_rad]): (&f64, &[f64; 2])| {
            DQuat::from_rotation_y(*heading_rad)
                * DQuat::from_rotation_z(*pitch_rad)
                * DQuat::from_rotation_x(*roll_rad)
        };
        let world_from_body = headings.radians.iter().zip(&sways).map(turned).collect();
        Self { from_s: 0.0, step_s: headings.step_s, world_from_body }
    }

    /// The orientation at a time, s; held at its ends.
    pub fn at(&self, time_s: f64) -> DQuat {
        let (Some(first), last) =
            (self.world_from_body.first(), self.world_from_body.len().saturating_sub(1))
        else {
            return DQuat::IDENTITY;
        };
        let at = ((time_s - self.from_s) / self.step_s).clamp(0.0, last as f64);
        let (i, share) = (at as usize, at.fract());
        let Some(next) = self.world_from_body.get(i + 1) else {
            return *self.world_from_body.last().unwrap_or(first);
        };
        self.world_from_body[i].slerp(*next, share)
    }
}

/// From 0 to 1 over the range from 0 to 1, flat at both ends; held outside.
pub(crate) fn smooth(share: f64) -> f64 {
    let share = share.clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

#[cfg(test)]
mod tests;
