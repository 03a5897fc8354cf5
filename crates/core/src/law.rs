//! Contact time as a power of speed: `T_c = a v^b` (Huang 2012, Eq. 3.1).

use serde::{Deserialize, Serialize};

use crate::{Gait, Provenance};

/// Metres per second in one mile per hour, exact.
pub const MPS_PER_MPH: f64 = 0.44704;

/// `T_c = a v^b`, v in m/s, `T_c` in s.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PowerLaw {
    /// Contact time at 1 m/s, in seconds.
    pub a: f64,
    /// Exponent; negative, and above -1 where the step grows with speed.
    pub b: f64,
}

impl PowerLaw {
    /// Contact time in seconds at a speed in m/s (Eq. 3.1).
    pub fn contact_time_s(self, speed_m_s: f64) -> f64 {
        self.a * speed_m_s.powf(self.b)
    }

    /// Step length `D = v T_c` in metres at a speed in m/s (Eq. 3.2).
    pub fn step_length_m(self, speed_m_s: f64) -> f64 {
        speed_m_s * self.contact_time_s(speed_m_s)
    }
}

/// Which contact time a law speaks of. They differ by a factor of up to four at the gallop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LawKind {
    /// Time per stride in which at least one hoof is down: what the paper's numbers most likely are.
    Support,
    /// Stance time of a single forelimb.
    LimbFore,
    /// Stance time of a single hind limb.
    LimbHind,
}

impl LawKind {
    /// All kinds in file order.
    pub const ALL: [Self; 3] = [Self::Support, Self::LimbFore, Self::LimbHind];

    /// Name as written in files: `support`, `limb_fore`, `limb_hind`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Support => "support",
            Self::LimbFore => "limb_fore",
            Self::LimbHind => "limb_hind",
        }
    }
}

/// 95 % confidence interval of a law's two parameters.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Interval {
    /// Lower and upper end for `a`.
    pub a: [f64; 2],
    /// Lower and upper end for `b`.
    pub b: [f64; 2],
}

/// A gait's law with what it rests on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ContactLaw {
    /// The gait.
    pub gait: Gait,
    /// The contact time meant.
    pub law: LawKind,
    /// The parameters.
    #[serde(flatten)]
    pub curve: PowerLaw,
    /// Number of data points.
    pub n: usize,
    /// 95 % interval; none with fewer than three points, where the data carry none.
    pub interval: Option<Interval>,
    /// Where the exponent is borrowed from, where the gait's own captures cannot tell it; `a` is then their own still.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub borrowed: Option<String>,
    /// Where it comes from.
    pub provenance: Provenance,
}
