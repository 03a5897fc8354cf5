//! The numbers that tell one gait from another, for a horse of the reference's size.
//!
//! Speeds, stride times and duty factors lie within the bands of the literature named at each gait; angles of the
//! joints in the air follow the fitted gallop of 1878 and the plates of the other gaits.

use muybridge_core::Gait;

use super::legs::{Fold, LegStyle};

/// A harmonic of the stride: greatest at the phase `peak`, counted from the strike of the trailing left hind.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wave {
    pub(super) amplitude: f64,
    /// Cycles per stride.
    pub(super) per_stride: f64,
    pub(super) peak: f64,
}

const fn wave(amplitude: f64, per_stride: f64, peak: f64) -> Wave {
    Wave { amplitude, per_stride, peak }
}

const fn fold(degrees: f64, at: f64) -> Fold {
    Fold { degrees, at }
}

/// One gait.
#[derive(Clone, Copy, Debug)]
pub(super) struct GaitNumbers {
    pub(super) speed_m_s: f64,
    pub(super) stride_time_s: f64,
    /// Share of the stride that fore and hind hooves are down.
    pub(super) duty_factor: [f64; 2],
    /// Phase of each strike, in the order of `Limb::ALL`; asymmetrical gaits on the right lead.
    pub(super) strikes: [f64; 4],
    pub(super) asymmetrical: bool,
    /// Height of the middle of the trunk, m.
    pub(super) bounce_m: Wave,
    /// Nose up, degrees.
    pub(super) pitch_deg: Wave,
    /// Rounding of the loins, degrees: the croup tucks under.
    pub(super) rounding_deg: Wave,
    /// Raising of the neck, degrees.
    pub(super) nod_deg: Wave,
    /// Carriage of neck and head from rest, degrees.
    pub(super) neck_deg: f64,
    pub(super) head_deg: f64,
    /// In the middle of a stance the toe stands this far ahead of the scapula's upper end, or of the croup, m.
    pub(super) toe_ahead_m: [f64; 2],
    pub(super) fore: LegStyle,
    pub(super) hind: LegStyle,
}

/// Four beats a quarter apart; the fore pair follows its hind by a little less. The trunk vaults over each standing
/// leg in turn, so it rocks rather than bounces, and the neck nods with each foreleg.
const WALK: GaitNumbers = GaitNumbers {
    speed_m_s: 1.55,
    stride_time_s: 1.08,
    duty_factor: [0.61, 0.61],
    strikes: [0.25, 0.75, 0.0, 0.5],
    asymmetrical: false,
    bounce_m: wave(0.006, 2.0, 0.30),
    pitch_deg: wave(0.8, 2.0, 0.04),
    rounding_deg: wave(0.8, 2.0, 0.0),
    nod_deg: wave(6.5, 2.0, 0.08),
    neck_deg: -12.0,
    head_deg: 6.0,
    toe_ahead_m: [0.12, -0.09],
    fore: LegStyle {
        girdle_deg: 2.0,
        girdle_swing_deg: 9.0,
        pastern_deg: [-56.0, -48.0, -92.0],
        folds: [fold(-3.0, 0.4), fold(34.0, 0.46), fold(-58.0, 0.40)],
    },
    hind: LegStyle {
        girdle_deg: -10.0,
        girdle_swing_deg: 6.0,
        pastern_deg: [-56.0, -48.0, -94.0],
        folds: [fold(12.0, 0.5), fold(-36.0, 0.42), fold(46.0, 0.42)],
    },
};

/// The walk's sequence hurried: on two feet and on one in turn.
const AMBLE: GaitNumbers = GaitNumbers {
    speed_m_s: 3.0,
    stride_time_s: 0.62,
    duty_factor: [0.42, 0.43],
    strikes: [0.24, 0.74, 0.0, 0.5],
    asymmetrical: false,
    bounce_m: wave(0.008, 4.0, 0.08),
    pitch_deg: wave(0.7, 2.0, 0.2),
    rounding_deg: wave(0.8, 2.0, 0.0),
    nod_deg: wave(3.0, 2.0, 0.1),
    neck_deg: 6.0,
    head_deg: -4.0,
    toe_ahead_m: [0.12, -0.09],
    fore: LegStyle {
        girdle_deg: 2.0,
        girdle_swing_deg: 9.0,
        pastern_deg: [-54.0, -44.0, -96.0],
        folds: [fold(-4.0, 0.4), fold(50.0, 0.46), fold(-78.0, 0.41)],
    },
    hind: LegStyle {
        girdle_deg: -10.0,
        girdle_swing_deg: 6.0,
        pastern_deg: [-54.0, -44.0, -96.0],
        folds: [fold(12.0, 0.5), fold(-44.0, 0.44), fold(58.0, 0.44)],
    },
};

/// Diagonal pairs half a stride apart, a short suspension after each.
const TROT: GaitNumbers = GaitNumbers {
    speed_m_s: 3.5,
    stride_time_s: 0.70,
    duty_factor: [0.39, 0.39],
    strikes: [0.5, 0.0, 0.0, 0.5],
    asymmetrical: false,
    bounce_m: wave(0.03, 2.0, 0.445),
    pitch_deg: wave(0.6, 2.0, 0.1),
    rounding_deg: wave(1.0, 2.0, 0.0),
    nod_deg: wave(1.5, 2.0, 0.45),
    neck_deg: 6.0,
    head_deg: -4.0,
    toe_ahead_m: [0.12, -0.09],
    fore: LegStyle {
        girdle_deg: 2.0,
        girdle_swing_deg: 10.0,
        pastern_deg: [-54.0, -42.0, -98.0],
        folds: [fold(-4.0, 0.4), fold(58.0, 0.47), fold(-86.0, 0.41)],
    },
    hind: LegStyle {
        girdle_deg: -10.0,
        girdle_swing_deg: 6.0,
        pastern_deg: [-54.0, -42.0, -98.0],
        folds: [fold(12.0, 0.5), fold(-48.0, 0.44), fold(64.0, 0.44)],
    },
};

/// Lateral pairs half a stride apart, the hind a little first, as pacers go.
const RACK: GaitNumbers = GaitNumbers {
    speed_m_s: 5.0,
    stride_time_s: 0.58,
    duty_factor: [0.36, 0.37],
    strikes: [0.025, 0.525, 0.0, 0.5],
    asymmetrical: false,
    bounce_m: wave(0.02, 2.0, 0.44),
    pitch_deg: wave(0.5, 2.0, 0.1),
    rounding_deg: wave(1.0, 2.0, 0.0),
    nod_deg: wave(1.5, 2.0, 0.45),
    neck_deg: 2.0,
    head_deg: 0.0,
    toe_ahead_m: [0.12, -0.09],
    fore: LegStyle {
        girdle_deg: 2.0,
        girdle_swing_deg: 10.0,
        pastern_deg: [-54.0, -41.0, -100.0],
        folds: [fold(-4.0, 0.4), fold(58.0, 0.48), fold(-88.0, 0.41)],
    },
    hind: LegStyle {
        girdle_deg: -10.0,
        girdle_swing_deg: 7.0,
        pastern_deg: [-54.0, -41.0, -102.0],
        folds: [fold(14.0, 0.5), fold(-50.0, 0.45), fold(68.0, 0.45)],
    },
};

/// Three beats: trailing hind, the leading hind with the trailing fore, leading fore; then one suspension.
const CANTER: GaitNumbers = GaitNumbers {
    speed_m_s: 5.4,
    stride_time_s: 0.58,
    duty_factor: [0.33, 0.34],
    strikes: [0.23, 0.46, 0.0, 0.21],
    asymmetrical: true,
    bounce_m: wave(0.04, 1.0, 0.90),
    pitch_deg: wave(4.5, 1.0, 0.03),
    rounding_deg: wave(5.0, 1.0, 0.95),
    nod_deg: wave(4.0, 1.0, 0.0),
    neck_deg: 0.0,
    head_deg: 0.0,
    toe_ahead_m: [0.12, -0.09],
    fore: LegStyle {
        girdle_deg: 2.0,
        girdle_swing_deg: 10.0,
        pastern_deg: [-54.0, -40.0, -100.0],
        folds: [fold(-4.0, 0.4), fold(60.0, 0.50), fold(-92.0, 0.41)],
    },
    hind: LegStyle {
        girdle_deg: -10.0,
        girdle_swing_deg: 7.0,
        pastern_deg: [-54.0, -41.0, -102.0],
        folds: [fold(14.0, 0.5), fold(-50.0, 0.46), fold(72.0, 0.46)],
    },
};

/// Four beats, transverse, and one gathered suspension. Stance times are those of Witte et al. 2006 at this speed.
const GALLOP: GaitNumbers = GaitNumbers {
    speed_m_s: 11.5,
    stride_time_s: 0.465,
    duty_factor: [0.22, 0.235],
    strikes: [0.33, 0.50, 0.0, 0.13],
    asymmetrical: true,
    bounce_m: wave(0.02, 1.0, 0.87),
    pitch_deg: wave(3.5, 1.0, 0.0),
    rounding_deg: wave(7.0, 1.0, 0.93),
    nod_deg: wave(5.0, 1.0, 0.95),
    neck_deg: -14.0,
    head_deg: 14.0,
    toe_ahead_m: [0.12, -0.09],
    fore: LegStyle {
        girdle_deg: 4.0,
        girdle_swing_deg: 11.0,
        pastern_deg: [-52.0, -38.0, -102.0],
        folds: [fold(-4.0, 0.4), fold(76.0, 0.52), fold(-102.0, 0.41)],
    },
    hind: LegStyle {
        girdle_deg: -10.0,
        girdle_swing_deg: 9.0,
        pastern_deg: [-52.0, -40.0, -104.0],
        folds: [fold(16.0, 0.55), fold(-54.0, 0.50), fold(84.0, 0.50)],
    },
};

impl GaitNumbers {
    /// The numbers of a gait; none for the leap, which is no cycle.
    pub(super) fn of(gait: Gait) -> Option<Self> {
        match gait {
            Gait::Walk => Some(WALK),
            Gait::Amble => Some(AMBLE),
            Gait::Trot => Some(TROT),
            Gait::Rack => Some(RACK),
            Gait::Canter => Some(CANTER),
            Gait::Gallop => Some(GALLOP),
            Gait::Leap => None,
        }
    }

    /// The same gait of a horse of another size, dynamically similar: equal Froude number.
    pub(super) fn scaled(self, size: f64) -> Self {
        Self {
            speed_m_s: self.speed_m_s * size.sqrt(),
            stride_time_s: self.stride_time_s * size.sqrt(),
            bounce_m: Wave { amplitude: self.bounce_m.amplitude * size, ..self.bounce_m },
            toe_ahead_m: self.toe_ahead_m.map(|v| v * size),
            ..self
        }
    }

    /// The same gait a little faster or slower: the stride shortens as the speed rises, as in the trot.
    pub(super) fn hurried(self, factor: f64) -> Self {
        Self {
            speed_m_s: self.speed_m_s * factor,
            stride_time_s: self.stride_time_s * factor.powf(-0.4),
            ..self
        }
    }

    /// The same gait on the other lead, or begun with the other foot.
    pub(super) fn mirrored(self) -> Self {
        let [lf, rf, lh, rh] = self.strikes;
        Self { strikes: [rf, lf, rh, lh], ..self }
    }
}
