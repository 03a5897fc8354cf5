//! Where each unknown of the stride fit stands in the parameter vector.
//!
//! `[panel 0 | panel 1 | ... | shared]`, panels in the order of their phase in the stride. A panel holds the root's
//! place, the root's pitch, 28 bends and two scapula slides; shared are the log-lengths and the overall log-scale.

use muybridge_core::{BONE_COUNT, Limb, Pair, bone};

/// Unknowns of one panel.
pub const PANEL_DOF: usize = 33;
/// Root place along the track, m.
pub const ROOT_X: usize = 0;
/// Root height over the ground, m.
pub const ROOT_Y: usize = 1;
/// Root pitch, rad.
pub const PITCH: usize = 2;
/// First of 28 bends, rad.
pub const BENDS: usize = 3;
/// First of two scapula slides (left, right), m.
pub const SLIDES: usize = BENDS + BONE_COUNT;
/// Shared unknowns: 18 log-lengths (body 8, fore 5, hind 5; left and right share theirs), that of the croup to the
/// dock, and the log-scale.
pub const SHARED: usize = 20;
/// The log-length from croup to dock, within the shared unknowns.
pub const LOG_DOCK: usize = SHARED - 2;
/// The log-scale of the whole animal against the reference, within the shared unknowns.
pub const LOG_SCALE: usize = SHARED - 1;

/// Index of a bone's log-length within the shared unknowns.
pub fn log_length(bone: usize) -> usize {
    let Some(offset) = bone.checked_sub(bone::LIMBS) else { return bone };
    let pair_start = match Limb::ALL[offset / 5].pair() {
        Pair::Fore => bone::LIMBS,
        Pair::Hind => bone::LIMBS + 5,
    };
    pair_start + offset % 5
}

/// The layout of a stride of `panels` panels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Number of panels.
    pub panels: usize,
}

impl Layout {
    /// Number of unknowns.
    pub fn dimension(self) -> usize {
        self.panels * PANEL_DOF + SHARED
    }

    /// Index of a panel's unknown.
    pub fn panel(self, slot: usize, dof: usize) -> usize {
        slot * PANEL_DOF + dof
    }

    /// Index of a shared unknown.
    pub fn shared(self, index: usize) -> usize {
        self.panels * PANEL_DOF + index
    }
}
