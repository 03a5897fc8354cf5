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
pub const KNOWN_DEVIATIONS: &[Known] = &[];

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
