//! The known motions under one roof: pose and stances as functions of time.

use muybridge_core::Limb;

use super::hurdle::Hurdle;
use super::leap::Leap;
use super::legs::{PoseVector, Stance};
use super::motion::Motion;
use super::stepping::Stepping;

/// A motion as a function of time.
#[derive(Clone, Debug)]
pub(super) enum Source {
    Harmonic(Box<Motion>),
    Stepping(Box<Stepping>),
    Leap(Box<Leap>),
}

impl Source {
    pub(super) fn speed_m_s(&self) -> f64 {
        match self {
            Self::Harmonic(motion) => motion.gait.speed_m_s,
            Self::Stepping(stepping) => stepping.gait.speed_m_s,
            Self::Leap(leap) => leap.speed_m_s(),
        }
    }

    /// Duration of the stride or the leap, s.
    pub(super) fn duration_s(&self) -> f64 {
        match self {
            Self::Harmonic(motion) => motion.gait.stride_time_s,
            Self::Stepping(stepping) => stepping.gait.stride_time_s,
            Self::Leap(leap) => leap.duration_s(),
        }
    }

    pub(super) fn hurdle(&self) -> Option<Hurdle> {
        match self {
            Self::Harmonic(_) | Self::Stepping(_) => None,
            Self::Leap(leap) => Some(leap.hurdle),
        }
    }

    pub(super) fn pose(&self, time_s: f64) -> PoseVector {
        match self {
            Self::Harmonic(motion) => motion.pose(time_s / motion.gait.stride_time_s),
            Self::Stepping(stepping) => stepping.pose(time_s),
            Self::Leap(leap) => leap.pose(time_s),
        }
    }

    pub(super) fn down(&self, time_s: f64) -> [bool; 4] {
        Limb::ALL.map(|limb| {
            let stance = self.last_stance(limb, time_s);
            stance.is_some_and(|stance| time_s < stance.lift_off_s)
        })
    }

    /// The stance of a leg that began last, at a time or before it; none before a leap's first.
    pub(super) fn last_stance(&self, limb: Limb, time_s: f64) -> Option<Stance> {
        match self {
            Self::Harmonic(motion) => Some(motion.last_stance(limb, time_s)),
            Self::Stepping(stepping) => Some(stepping.stance(limb, time_s)),
            Self::Leap(leap) => leap.last_stance(limb, time_s),
        }
    }
}
