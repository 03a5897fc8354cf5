//! Deviations that the photographs really show, and the bookkeeping that keeps their list true.

use super::{Check, Deviation};

/// A deviation that is known and stays: what one horse did before the cameras, not a fault of the database.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// Beginning of the identifiers of the strides concerned; a plate's identifier covers all its speeds.
    pub stride_prefix: &'static str,
    /// The check that finds it.
    pub check: Check,
    /// Why it is right to leave it, with the plate's evidence.
    pub reason: &'static str,
}

impl Known {
    fn covers(&self, deviation: &Deviation) -> bool {
        deviation.check == self.check && deviation.stride.starts_with(self.stride_prefix)
    }
}

/// Known deviations of the embedded database.
pub const KNOWN_DEVIATIONS: &[Known] = &[
    Known {
        stride_prefix: "labelled-walk",
        check: Check::ForelegBent,
        reason: "a picture of 100 px from sole to withers: knee and fetlock of the standing off fore are 2 to 3 px apart from straight",
    },
    Known {
        stride_prefix: "in-hand-trot",
        check: Check::StrideTime,
        reason: "the film's rate is not stated, so its speed is inferred to a quarter; at 3.7 m/s, within that, its rate is the published one",
    },
    Known {
        stride_prefix: "flode-holden-614",
        check: Check::Suspension,
        reason: "captured at 7.7 m/s before a sulky with long hind stances and a suspension of 5 % of the stride; slower, where hooves \
                 stand longer, the same footfalls leave none",
    },
    Known {
        stride_prefix: "sallie-gardner-1878",
        check: Check::Suspension,
        reason: "at 16.1 m/s her trailing fore leaves as the leading fore comes down; at 39 and 40 mph, where hooves stand shorter, the same \
                 footfalls leave a gap of 3 % between the two",
    },
];

/// Deviations that no entry covers.
pub fn unexplained(deviations: &[Deviation], known: &[Known]) -> Vec<Deviation> {
    deviations.iter().filter(|d| !known.iter().any(|k| k.covers(d))).cloned().collect()
}

/// Entries that cover nothing any more and must go.
pub fn stale(deviations: &[Deviation], known: &[Known]) -> Vec<Known> {
    known.iter().filter(|k| !deviations.iter().any(|d| k.covers(d))).copied().collect()
}

#[cfg(test)]
mod tests {
    use muybridge_core::Gait;

    use super::*;

    #[test]
    fn an_entry_covers_its_check_on_its_plate_and_nothing_else() {
        let deviation = |stride: &str, check| Deviation {
            stride: stride.into(),
            gait: Gait::Trot,
            check,
            value: 1.0,
            allowed: [0.0, 0.5],
            text: String::new(),
        };
        let found = [
            deviation("edgington@12mph", Check::DutyFactor),
            deviation("edgington@12mph", Check::ToeSlides),
            deviation("daisy", Check::DutyFactor),
        ];
        let entry = |stride_prefix, check| Known { stride_prefix, check, reason: "seen on the plate" };
        let known = [entry("edgington", Check::DutyFactor), entry("pronto", Check::DutyFactor)];
        assert_eq!(unexplained(&found, &known), found[1..]);
        assert_eq!(stale(&found, &known), known[1..]);
    }
}
