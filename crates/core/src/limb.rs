//! The four legs, in the one order used everywhere.

use serde::{Deserialize, Serialize};

use crate::skeleton::bone;

/// Fore or hind pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Pair {
    /// Forelimbs.
    Fore,
    /// Hind limbs.
    Hind,
}

/// The horse's own left or right.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Side {
    /// The horse's left, -Z.
    Left,
    /// The horse's right, +Z.
    Right,
}

impl Side {
    /// The other side.
    pub fn opposite(self) -> Self {
        match self {
            Self::Left => Self::Right,
            Self::Right => Self::Left,
        }
    }
}

/// One of the four legs. The discriminant is the index in every array of four.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Limb {
    /// Left fore.
    LF,
    /// Right fore.
    RF,
    /// Left hind.
    LH,
    /// Right hind.
    RH,
}

impl Limb {
    /// All legs in storage order.
    pub const ALL: [Self; 4] = [Self::LF, Self::RF, Self::LH, Self::RH];

    /// The leg of a pair on a side.
    pub fn new(pair: Pair, side: Side) -> Self {
        match (pair, side) {
            (Pair::Fore, Side::Left) => Self::LF,
            (Pair::Fore, Side::Right) => Self::RF,
            (Pair::Hind, Side::Left) => Self::LH,
            (Pair::Hind, Side::Right) => Self::RH,
        }
    }

    /// Index in arrays of four, 0 to 3.
    pub fn index(self) -> usize {
        self as usize
    }

    /// Fore or hind.
    pub fn pair(self) -> Pair {
        if self.index() < 2 { Pair::Fore } else { Pair::Hind }
    }

    /// Left or right.
    pub fn side(self) -> Side {
        if self.index().is_multiple_of(2) { Side::Left } else { Side::Right }
    }

    /// Index of the leg's first bone (scapula or pelvis); its five bones follow one another.
    pub fn first_bone(self) -> usize {
        bone::LIMBS + 5 * self.index()
    }

    /// Index of the leg's hoof bone, whose tip is the toe.
    pub fn hoof_bone(self) -> usize {
        self.first_bone() + 4
    }

    /// The field's abbreviation: LF, RF, LH or RH.
    pub fn abbreviation(self) -> &'static str {
        ["LF", "RF", "LH", "RH"][self.index()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pair_and_side_name_each_leg_once() {
        for limb in Limb::ALL {
            assert_eq!(Limb::new(limb.pair(), limb.side()), limb);
            assert_eq!(Limb::ALL[limb.index()], limb);
        }
    }
}
