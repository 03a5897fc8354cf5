//! What the horse is doing, for displays, sounds, planners and tests.

use glam::DVec3;

use crate::gait::Gait;
use crate::limb::Side;

/// A change from one gait to another, under way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChangeReadout {
    /// The gait it began in.
    pub from: Gait,
    /// How much of the change is done, 0 to 1.
    pub share: f32,
}

/// What the horse is doing after its last step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Readout {
    /// The gait it is in or changing to; [`Gait::Leap`] while it leaps, [`Gait::Walk`] while it stands.
    pub gait: Gait,
    /// Leading side; none in a symmetrical gait.
    pub lead: Option<Side>,
    /// Whether it stands, or is coming to a stand.
    pub is_standing: bool,
    /// The change under way.
    pub change: Option<ChangeReadout>,
    /// Speed along its heading, m/s.
    pub speed_m_s: f32,
    /// Heading about the world's Y axis, radians, to the left positive; counts whole turns.
    pub heading_rad: f64,
    /// Turn rate, rad/s.
    pub turn_rate_rad_s: f32,
    /// Duration of a stride as it goes now, s; infinite when it stands.
    pub stride_time_s: f32,
    /// Strides gone since it was placed.
    pub strides: f64,
    /// Phase of the stride, `[0, 1)`: zero where the left hind strikes (the right one on the mirrored lead). Exact when no change is
    /// under way; during one the legs have phases of their own.
    pub phase: f32,
    /// How far each leg is in its own cycle from strike to strike, `[0, 1)`.
    pub leg_cycles: [f32; 4],
    /// Share of that cycle in which the hoof is down.
    pub duty_factors: [f32; 4],
    /// Hooves that bear weight, in the order of [`crate::Limb::ALL`].
    pub on_ground: [bool; 4],
    /// Where each hoof stands, or stood last, world space, metres.
    pub prints: [DVec3; 4],
    /// How far the body was let down so that every standing hoof keeps its place, metres.
    pub lowered_m: f32,
}
