//! When each hoof is down: instants between panels, from the fitted toe paths within the brackets that labels leave.
//!
//! A person's labels say between which panels a hoof struck or left. Inside that bracket the toe path of the fitted
//! curves decides: a hoof is down while its toe stands where it stands in the stance panels. Without labels the toe
//! path decides alone. An instant the person placed by hand overrides both.

use muybridge_capture::{Event, Instant, StanceLabel};
use muybridge_core::Limb;

use crate::chain::Attachment;
use crate::observation::PanelObservation;
use crate::stride_curves::StrideCurves;
use crate::stride_fit::StrideFit;

/// A toe this much above its stance height is in the air, as a share of withers height: 1.5 %, about twice the
/// scatter of a placed toe.
const LIFT: f64 = 0.015;
/// A toe this far along the track from its stance place has left it (or has not arrived), share of withers height.
const SLIP: f64 = 0.04;
/// Vertical scatter of a fitted toe, share of withers height: sets the uncertainty of an instant found inside a bracket.
const TOE_SD: f64 = 0.012;
/// A toe that never comes lower than this share of withers height does not stand: five times the scatter of a ground line.
const GROUNDED: f64 = 0.1;
/// Samples of the toe path per stride.
const SAMPLES: usize = 960;

/// A strike or lift-off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactInstant {
    /// Phase in strides since the first panel's phase, `[0, 1)`.
    pub phase: f64,
    /// Standard deviation, as a share of the stride.
    pub sd: f64,
}

/// Stance of one leg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LegContact {
    /// The leg.
    pub limb: Limb,
    /// Foot strike.
    pub strike: ContactInstant,
    /// Lift-off.
    pub lift_off: ContactInstant,
}

impl LegContact {
    /// Share of the stride the hoof is down.
    pub fn duty_factor(&self) -> f64 {
        (self.lift_off.phase - self.strike.phase).rem_euclid(1.0)
    }

    /// Standard deviation of the duty factor.
    pub fn duty_factor_sd(&self) -> f64 {
        self.strike.sd.hypot(self.lift_off.sd)
    }

    /// Whether the hoof is down at a phase.
    pub fn contains(&self, phase: f64) -> bool {
        (phase - self.strike.phase).rem_euclid(1.0) < self.duty_factor()
    }
}

/// Why contacts cannot be told.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ContactError {
    /// The leg is never down.
    #[error("contacts: {} is labelled stance in no panel and its toe never rests on the ground; label at least one stance panel", .0.abbreviation())]
    NeverDown(Limb),
    /// The leg is always down.
    #[error("contacts: {} is never off the ground; label at least one swing panel", .0.abbreviation())]
    AlwaysDown(Limb),
}

/// Contacts of the four legs, in the order of [`Limb::ALL`].
///
/// # Errors
/// When a leg is never down or never up.
pub fn find_contacts(
    fit: &StrideFit,
    instants: &[Instant],
    withers_height_m: f64,
) -> Result<[LegContact; 4], ContactError> {
    let curves = StrideCurves::new(fit);
    let paths = ToePaths::new(fit, &curves);
    let mut contacts = Vec::with_capacity(4);
    for limb in Limb::ALL {
        contacts.push(leg_contact(fit, &paths, limb, instants, withers_height_m)?);
    }
    Ok([contacts[0], contacts[1], contacts[2], contacts[3]])
}

/// Toe places over the stride, at phases `k / SAMPLES`.
struct ToePaths {
    /// `[limb][sample]`: surge along the track against uniform advance, and height, m.
    places: [Vec<[f64; 2]>; 4],
    stride_length_m: f64,
}

impl ToePaths {
    fn new(fit: &StrideFit, curves: &StrideCurves<'_>) -> Self {
        let mut places: [Vec<[f64; 2]>; 4] = Default::default();
        for k in 0..SAMPLES {
            let kinematics = curves.kinematics(k as f64 / SAMPLES as f64);
            for limb in Limb::ALL {
                let [x, y] = kinematics.place(Attachment::Tip(limb.hoof_bone()));
                let advance = k as f64 / SAMPLES as f64 * fit.problem.stride_length_m;
                places[limb.index()].push([x - advance, y]);
            }
        }
        Self { places, stride_length_m: fit.problem.stride_length_m }
    }

    /// World place at a phase (nearest sample), with the phase's whole strides in it.
    fn at(&self, limb: Limb, phase: f64) -> [f64; 2] {
        let k = (phase.rem_euclid(1.0) * SAMPLES as f64).round() as usize % SAMPLES;
        let [surge, y] = self.places[limb.index()][k];
        [surge + phase * self.stride_length_m, y]
    }
}

fn leg_contact(
    fit: &StrideFit,
    paths: &ToePaths,
    limb: Limb,
    instants: &[Instant],
    withers_height_m: f64,
) -> Result<LegContact, ContactError> {
    let always = |panel: &PanelObservation| panel.contacts[limb.index()] == StanceLabel::Stance;
    if fit.observation.panels.iter().all(always) {
        return Err(ContactError::AlwaysDown(limb));
    }
    let run = stance_run(fit, limb)
        .or_else(|| lowest_run(paths, limb, withers_height_m))
        .ok_or(ContactError::NeverDown(limb))?;
    // Where the toe rests: the mean over the stance panels.
    let rests: Vec<[f64; 2]> = run.stances.iter().map(|phase| paths.at(limb, *phase)).collect();
    let n = rests.len() as f64;
    let rest = [0, 1].map(|axis| rests.iter().map(|place| place[axis]).sum::<f64>() / n);
    let down = |phase: f64| {
        let [x, y] = paths.at(limb, phase);
        y - rest[1] < LIFT * withers_height_m && (x - rest[0]).abs() < SLIP * withers_height_m
    };
    let vertical_speed = |phase: f64| {
        let h = 2.0 / SAMPLES as f64;
        (paths.at(limb, phase + h)[1] - paths.at(limb, phase - h)[1]).abs() / (2.0 * h)
    };
    let instant = |from_stance: f64, to_swing: f64| {
        let width = (to_swing - from_stance).abs();
        let steps = (width * SAMPLES as f64).ceil().max(1.0);
        let at = |i: f64| from_stance + (to_swing - from_stance) * i / steps;
        let widest = width / 12f64.sqrt();
        match (0..=steps as usize).map(|i| at(i as f64)).find(|phase| !down(*phase)) {
            // Not at rest even in the stance panel itself: the label says more than the toe path.
            Some(phase) if phase == from_stance => {
                ContactInstant { phase: phase.rem_euclid(1.0), sd: widest }
            }
            Some(phase) => {
                let sd = (TOE_SD * withers_height_m / vertical_speed(phase).max(1e-9)).min(widest);
                ContactInstant { phase: phase.rem_euclid(1.0), sd }
            }
            // The toe rests all through the bracket: the label says it had left by its end.
            None => ContactInstant { phase: to_swing.rem_euclid(1.0), sd: widest },
        }
    };
    let strike =
        by_hand(fit, limb, Event::Strike, instants).unwrap_or_else(|| instant(run.first, run.swing_before));
    let lift_off =
        by_hand(fit, limb, Event::LiftOff, instants).unwrap_or_else(|| instant(run.last, run.swing_after));
    Ok(LegContact { limb, strike, lift_off })
}

/// A stance between two swings, as rising phases (beyond 1 after a wrap).
struct StanceRun {
    swing_before: f64,
    first: f64,
    last: f64,
    swing_after: f64,
    stances: Vec<f64>,
}

/// The longest run of stance labels around the ring; labels that say unknown neither make nor break it.
fn stance_run(fit: &StrideFit, limb: Limb) -> Option<StanceRun> {
    let n = fit.problem.layout.panels;
    let label = |slot: usize| fit.observation.panels[fit.problem.order[slot % n]].contacts[limb.index()];
    let phase = |slot: usize| fit.problem.phases[slot % n] + (slot / n) as f64;
    let swing = (0..n).find(|slot| label(*slot) == StanceLabel::Swing)?;
    let mut best: Option<StanceRun> = None;
    let mut swing_before = swing;
    let mut stances: Vec<f64> = Vec::new();
    // Once around, from a swing panel to itself.
    for slot in swing + 1..=swing + n {
        match label(slot) {
            StanceLabel::Stance => stances.push(phase(slot)),
            StanceLabel::Unknown => {}
            StanceLabel::Swing => {
                if let (Some(&first), Some(&last)) = (stances.first(), stances.last()) {
                    let run = StanceRun {
                        swing_before: phase(swing_before),
                        first,
                        last,
                        swing_after: phase(slot),
                        stances: std::mem::take(&mut stances),
                    };
                    if best.as_ref().is_none_or(|b| run.last - run.first > b.last - b.first) {
                        best = Some(run);
                    }
                }
                swing_before = slot;
            }
        }
    }
    best
}

/// Without labels: around the phase at which the toe is lowest, half a stride either way; none when even there it is
/// far over the ground.
fn lowest_run(paths: &ToePaths, limb: Limb, withers_height_m: f64) -> Option<StanceRun> {
    let heights = paths.places[limb.index()].iter().map(|place| place[1]).enumerate();
    let (k, height_m) = heights.min_by(|a, b| a.1.total_cmp(&b.1))?;
    if height_m > GROUNDED * withers_height_m {
        return None;
    }
    let lowest = 1.0 + k as f64 / SAMPLES as f64;
    Some(StanceRun {
        swing_before: lowest - 0.5,
        first: lowest,
        last: lowest,
        swing_after: lowest + 0.5,
        stances: vec![lowest],
    })
}

/// An instant placed by a person, good to a tenth of a panel.
fn by_hand(fit: &StrideFit, limb: Limb, event: Event, instants: &[Instant]) -> Option<ContactInstant> {
    let facing = fit.observation.facing;
    let instant = instants.iter().find(|i| facing.limb(i.side, i.pair) == limb && i.event == event)?;
    let time = |panel: f64| {
        fit.observation.panels.iter().find(|p| f64::from(p.camera.panel) == panel).map(|p| p.camera.time_s)
    };
    let (before, after) = (time(instant.at_panel.floor())?, time(instant.at_panel.ceil())?);
    let seconds = before + (after - before) * instant.at_panel.fract();
    let start = fit.observation.panels.first().map_or(0.0, |p| p.camera.time_s);
    let stride_s = fit.stride_time.seconds;
    Some(ContactInstant {
        phase: ((seconds - start) / stride_s).rem_euclid(1.0),
        sd: 0.1 * (after - before) / stride_s,
    })
}
