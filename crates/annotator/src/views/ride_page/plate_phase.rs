//! Where in the stride of the open plate the horse is.

use muybridge_core::Limb;
use muybridge_fitting::pipeline::PlateFit;

use crate::ride::RideSession;
use crate::ride::phase_match::{PhaseMatch, matched};
use crate::session::Session;

/// A photograph whose strides lie this little before the whole turn belongs to the next one: rounding of the stride time.
const SAME_PHASE: f64 = 1e-6;
/// Legs that disagree more than this have no common phase: a change of gait, or another sequence.
const MOST_SPREAD: f64 = 0.12;

/// The photograph nearest to the horse, or why there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Nearest {
    /// This panel.
    Panel {
        /// Its number.
        panel: u32,
        /// The match.
        phase: PhaseMatch,
    },
    /// None, because of this.
    None(&'static str),
}

/// The photograph of the open plate that is nearest in phase to horse A.
pub(super) fn of(session: &Session, ride: &RideSession) -> Option<Nearest> {
    let rider = ride.shown().riders[0].as_ref()?;
    let readout = &rider.readout;
    if session.second_pass.is_some() {
        return Some(Nearest::None("Hidden during the blind second pass."));
    }
    let Some(fitted) = session.fit.latest() else {
        return Some(Nearest::None("The open plate has no fitted stride yet."));
    };
    let draft = session.draft();
    if readout.is_standing || draft.annotation.gait(&draft.manifest) != readout.gait {
        return Some(Nearest::None("The horse goes another gait than the plate."));
    }
    let plate = &fitted.plate;
    let strikes = Limb::ALL.map(|limb| plate.analysis.contacts[limb.index()].strike.phase);
    let phase = matched(readout.leg_cycles, strikes);
    if phase.spread > MOST_SPREAD {
        return Some(Nearest::None("The legs follow one another otherwise than on the plate."));
    }
    let near = panel_near(plate, phase.phase).filter(|panel| session.place_of(*panel).is_some());
    Some(
        near.map_or(Nearest::None("The plate's panels were changed."), |panel| Nearest::Panel {
            panel,
            phase,
        }),
    )
}

/// The panel nearest in phase, of those of the first turn.
fn panel_near(plate: &PlateFit, phase: f64) -> Option<u32> {
    let fit = &plate.fit;
    let apart = |turns: f64| {
        let after = (phase - turns).rem_euclid(1.0);
        after.min(1.0 - after)
    };
    (0..fit.problem.layout.panels)
        .map(|slot| (fit.observation.panels[fit.problem.order[slot]].camera.panel, fit.turns(slot)))
        .filter(|(_, turns)| *turns < 1.0 - SAME_PHASE)
        .min_by(|a, b| apart(a.1).total_cmp(&apart(b.1)))
        .map(|(panel, _)| panel)
}
