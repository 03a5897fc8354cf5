//! The six gaits, the leap, and the lead of an asymmetrical gait.

use serde::{Deserialize, Serialize};

use crate::limb::Side;

/// A gait as a rider or a plate's title names it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Gait {
    /// Four beats, lateral sequence, one or more feet always down.
    Walk,
    /// The walk's sequence at a higher rate, on one and two feet in turn.
    Amble,
    /// Diagonal pairs half a stride apart.
    Trot,
    /// Lateral pairs half a stride apart (Muybridge's rack; the pace).
    Rack,
    /// Three beats and one suspension.
    Canter,
    /// Four beats and one gathered suspension.
    Gallop,
    /// A single jump.
    Leap,
}

impl Gait {
    /// Every gait, slowest first.
    pub const ALL: [Self; 7] =
        [Self::Walk, Self::Amble, Self::Trot, Self::Rack, Self::Canter, Self::Gallop, Self::Leap];

    /// Lower-case name as written in files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Walk => "walk",
            Self::Amble => "amble",
            Self::Trot => "trot",
            Self::Rack => "rack",
            Self::Canter => "canter",
            Self::Gallop => "gallop",
            Self::Leap => "leap",
        }
    }

    /// The gait of this name, any case.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|gait| gait.name().eq_ignore_ascii_case(name))
    }

    /// Range of speeds the gait is used at, in miles per hour (Huang 2012, Fig. 3.6); none for the leap.
    pub fn speed_range_mph(self) -> Option<[f64; 2]> {
        match self {
            Self::Walk => Some([1.0, 5.0]),
            Self::Amble => Some([6.0, 9.0]),
            Self::Trot | Self::Rack => Some([10.0, 20.0]),
            Self::Canter => Some([10.0, 25.0]),
            Self::Gallop => Some([26.0, 40.0]),
            Self::Leap => None,
        }
    }
}

impl std::fmt::Display for Gait {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.pad(self.name())
    }
}

/// The leading side of a canter or gallop: the foreleg that strikes last before the suspension.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub struct Lead {
    /// Side of the leading foreleg.
    pub fore: Side,
    /// Side of the leading hind leg; the same side in a transverse gallop, the other in a rotary one.
    pub hind: Side,
}

impl Lead {
    /// Fore and hind lead on the same side, as in the horse's usual gallop.
    pub fn is_transverse(self) -> bool {
        self.fore == self.hind
    }
}
