//! Posture that a rider sees first: a loaded foreleg is straight, and a walking horse steps into its own prints.

use muybridge_core::{Gait, Limb, Pair, Side};

use super::super::{Check, Deviation, Subject};

/// Bone of a foreleg, from the scapula, whose bend is the knee's (carpus).
const METACARPAL: usize = 3;
/// The knee's bend from straight while the leg carries, degrees: the fitted photographs show 15 forward to 14 back, and a marker
/// beside the joint's axis shifts it by some degrees.
const STRAIGHT_DEG: f64 = 20.0;
/// Share of the stance at each end that is left out: the leg is being loaded or is breaking over.
const EDGE: f64 = 0.1;
/// Poses looked at over the middle of a stance.
const SAMPLES: usize = 80;
/// Below this speed a walk is a dawdle, whose hind feet fall short, m/s (the slowest walk published is 1.1).
const WALKING_M_S: f64 = 1.1;
/// The hind print may lie this far behind the fore print, m: a toe is placed to about 0.04, and a hoof is 0.13 long.
const SHORTEST_OVERSTEP_M: f64 = -0.05;
/// Longest overstep, m: captured walks reach 0.3, 0.5 where they are made faster; more is a wrong print.
const LONGEST_OVERSTEP_M: f64 = 0.6;

pub(super) fn check(subject: &Subject<'_>) -> Vec<Deviation> {
    let mut deviations: Vec<Deviation> =
        [Limb::LF, Limb::RF].into_iter().filter_map(|limb| foreleg(subject, limb)).collect();
    if subject.stride.gait == Gait::Walk && f64::from(subject.stride.speed_m_s) >= WALKING_M_S {
        deviations.extend([Side::Left, Side::Right].into_iter().filter_map(|side| overstep(subject, side)));
    }
    deviations
}

fn foreleg(subject: &Subject<'_>, limb: Limb) -> Option<Deviation> {
    let contact = subject.stride.contacts[limb.index()];
    let bend_at = |k: usize| {
        let share = EDGE + (1.0 - 2.0 * EDGE) * k as f64 / SAMPLES as f64;
        let phase = contact.strike_phase + contact.duty_factor() * share as f32;
        f64::from(subject.stride.pose(phase).bends_rad[limb.first_bone() + METACARPAL]).to_degrees()
    };
    let most = (0..=SAMPLES).map(bend_at).max_by(|a, b| a.abs().total_cmp(&b.abs()))?;
    let text = format!(
        "the knee of {} is bent by {most:.0} degrees in the middle of its stance; at most {STRAIGHT_DEG:.0}",
        limb.abbreviation()
    );
    subject.require(Check::ForelegBent, most, [-STRAIGHT_DEG, STRAIGHT_DEG], text)
}

/// From the fore print to the print of the hind foot that steps after it, on one side.
fn overstep(subject: &Subject<'_>, side: Side) -> Option<Deviation> {
    let stride = subject.stride;
    let [fore, hind] = [Pair::Fore, Pair::Hind].map(|pair| {
        let leg = Limb::new(pair, side).index();
        (stride.contacts[leg].strike_phase, f64::from(stride.prints_m[leg]))
    });
    // The fore print before the hind's strike is one stride back where the fore strikes later in the stride.
    let back = if fore.0 > hind.0 { f64::from(stride.stride_length_m()) } else { 0.0 };
    let overstep = hind.1 - (fore.1 - back);
    let text = format!(
        "the hind print lies {:.0} mm ahead of the fore print on the {side:?} side; at a walk {:.0} to {:.0}",
        1e3 * overstep,
        1e3 * SHORTEST_OVERSTEP_M,
        1e3 * LONGEST_OVERSTEP_M
    );
    subject.require(Check::HindPrint, overstep, [SHORTEST_OVERSTEP_M, LONGEST_OVERSTEP_M], text)
}

#[cfg(test)]
mod tests {
    use super::super::super::specimen::{Specimen, checks_of};
    use super::*;

    #[test]
    fn a_bent_foreleg_is_found() {
        let stride = Specimen { knee_deg: -26.0, ..Specimen::trot() }.stride();
        assert_eq!(checks_of(&stride), [Check::ForelegBent]);
    }

    #[test]
    fn a_walk_that_steps_short_is_found() {
        let stride = Specimen { speed_m_s: 1.2, hind_ahead_m: -0.2, ..Specimen::walk() }.stride();
        assert_eq!(checks_of(&stride), [Check::HindPrint]);
    }
}
