//! The leap's ballistic body by itself, for whoever puts other legs under it.

use muybridge_core::{Limb, Pair, Side, Skeleton};

use super::leap::Leap;
use super::leap_numbers::{PLANTED, TAKE_OFF_S, TOUCH_DOWN_S};
use super::legs::PoseVector;
use super::size;

/// Of the plan's stances of a leg, the one that pushes off (hinds) or lands (fores).
const HIND_PUSH: usize = 1;

/// The leap as the plan has it, without the habits of one horse. Times are in the plan's frame; the jump begins with the
/// strike of the trailing hind for the push.
pub(crate) struct LeapBody {
    leap: Leap,
}

/// Where and when a leg of the leap stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LeapStance {
    /// When the hoof is down, s.
    pub(crate) strike_s: f64,
    /// See `strike_s`.
    pub(crate) lift_off_s: f64,
    /// How far ahead of scapula (fore) or croup (hind) the toe stands in the middle of that, m.
    pub(crate) toe_ahead_m: f64,
}

impl LeapBody {
    /// The leap of a horse on a lead.
    pub(crate) fn new(horse: &Skeleton, lead: Side) -> Self {
        Self { leap: Leap::of_habit(horse, lead, size(horse), 0.0, 1.0) }
    }

    /// Speed along the track, m/s; the centre of mass keeps it.
    pub(crate) fn speed_m_s(&self) -> f64 {
        self.leap.speed_m_s()
    }

    /// From the strike of the trailing hind for the push to its strike after the landing, s.
    pub(crate) fn span_s(&self, trailing_hind: Limb) -> [f64; 2] {
        let hind = PLANTED[self.leap.part(trailing_hind).index()];
        [HIND_PUSH, HIND_PUSH + 1].map(|stance| hind[stance].span_s[0] * self.leap.pace())
    }

    /// Take-off and touch-down, s: between them the centre of mass follows a parabola.
    pub(crate) fn flight_s(&self) -> [f64; 2] {
        [TAKE_OFF_S, TOUCH_DOWN_S].map(|time_s| time_s * self.leap.pace())
    }

    /// The stance in which a hind pushes off or a fore lands.
    pub(crate) fn stance(&self, limb: Limb) -> LeapStance {
        let planned = PLANTED[self.leap.part(limb).index()];
        let planted = match limb.pair() {
            Pair::Hind => &planned[HIND_PUSH],
            Pair::Fore => planned.iter().find(|p| p.span_s[0] >= TOUCH_DOWN_S).unwrap_or(&planned[0]),
        };
        let [strike_s, lift_off_s] = planted.span_s.map(|time_s| time_s * self.leap.pace());
        LeapStance { strike_s, lift_off_s, toe_ahead_m: planted.toe_ahead_m * self.leap.size() }
    }

    /// Height of the centre of mass over the ground, m.
    pub(crate) fn mass_height_m(&self, time_s: f64) -> f64 {
        self.leap.path(time_s)[1]
    }

    /// The whole pose, in the layout of the fit's unknowns, with the legs as the plan folds them.
    pub(crate) fn pose(&self, time_s: f64) -> PoseVector {
        self.leap.pose(time_s)
    }
}
