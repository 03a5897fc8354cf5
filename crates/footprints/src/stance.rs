//! What the energy knows of a foot on the ground.

use glam::DVec3;

/// One foot on one print.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    /// Place of the foot among the figure's feet.
    pub foot: usize,
    /// Footfall, s.
    pub from_s: f64,
    /// Lift-off, s.
    pub to_s: f64,
    /// Ankle (of a horse: toe of the hoof) while the foot is flat on its print, world space, metres.
    pub ankle: DVec3,
    /// Point of support while the foot is flat, world space, metres.
    pub middle: DVec3,
    /// Point of support on the toes, world space, metres.
    pub toe: DVec3,
    /// Hip from the centre of mass, body frame, metres.
    pub hip_from_com: DVec3,
    /// Comfortable length of the virtual leg, metres.
    pub nominal_m: f64,
    /// Longest virtual leg with the foot flat, metres; beyond it the foot is on its toes.
    pub longest_m: f64,
    /// Where the leg's force goes through: 0 the centre of mass (the paper), 1 the hip.
    pub force_through_hip: f64,
}
