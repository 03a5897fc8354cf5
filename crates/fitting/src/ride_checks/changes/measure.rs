//! One change of gait, from the command until every leg is on the new gait and a stride beyond.

use muybridge_core::{FlatGround, Horse, Limb};

use super::super::findings::{Findings, Quantity};
use super::super::inspector::Inspector;
use super::steady_gait::{SteadyGait, lags};
use super::{ACCELERATION_RATIO, Accelerations, CONVERGENCE, DURATION_STRIDES, STEP_S};
use crate::ride_checks::Limits;

/// A change must be over after this, s.
const PATIENCE_S: f64 = 20.0;
/// Time looked at after the change, s: a stride of the slowest gait's usual speed.
const AFTER_S: f64 = 1.3;
/// Rounding of a duration, strides: one step at the gallop.
const DURATION_ROUNDING: f64 = 0.02;

/// What one change showed.
#[derive(Clone, Debug)]
pub struct ChangeCase {
    /// Phase of the old gait at which the new one was asked for.
    pub start_phase: f64,
    /// From the command to the beginning of the change, s.
    pub wait_s: f64,
    /// Duration, s.
    pub duration_s: f64,
    /// Strides of the left hind during the change.
    pub strides: f64,
    /// Least and greatest number of strides of any leg.
    pub leg_strides: [f64; 2],
    /// Greatest difference of a leg's phase from the steady gait's when the change was over, strides.
    pub convergence: f64,
    /// Acceleration of joints at the 99th percentile against the larger of the two steady gaits.
    pub acceleration_ratio: f64,
    /// What the inspector saw, from the command to a stride after the change.
    pub findings: Findings,
}

impl ChangeCase {
    /// What is wrong with it: of which kind, how much beyond its limit as a factor, and in plain words.
    pub fn faults(&self) -> Vec<Fault> {
        let broken = self.findings.broken(&Limits::smooth());
        let mut faults: Vec<Fault> = broken
            .iter()
            .map(|b| Fault { kind: b.quantity.name(), size: b.worst.value, text: b.to_string() })
            .collect();
        let mut fault = |kind, size, text| faults.push(Fault { kind, size, text });
        if self.convergence > CONVERGENCE {
            let text = format!(
                "a leg is {:.2e} of a stride from the new gait; at most {CONVERGENCE:.0e}",
                self.convergence
            );
            fault("convergence", self.convergence, text);
        }
        let [least, most] = DURATION_STRIDES;
        if !(least - DURATION_ROUNDING..=most + DURATION_ROUNDING).contains(&self.strides) {
            fault(
                "duration",
                self.strides,
                format!("it lasts {:.2} strides; {least:.0} to {most:.0}", self.strides),
            );
        }
        if self.acceleration_ratio > ACCELERATION_RATIO {
            let ratio = self.acceleration_ratio;
            fault(
                "acceleration",
                ratio,
                format!("joints are accelerated {ratio:.2} times as much; at most {ACCELERATION_RATIO}"),
            );
        }
        faults
    }

    /// The worst value of a quantity.
    pub fn worst(&self, quantity: Quantity) -> f64 {
        self.findings.worst(quantity).value
    }
}

/// Something wrong with a change.
#[derive(Clone, Debug)]
pub struct Fault {
    /// Which limit.
    pub kind: &'static str,
    /// The value that breaks it.
    pub size: f64,
    /// In plain words.
    pub text: String,
}

/// Follows one horse through its change.
struct Follower<'a> {
    horse: Horse,
    to: &'a SteadyGait,
    inspector: Inspector,
    accelerations: Accelerations,
    cycles: [f32; 4],
    strides: [f64; 4],
    time_s: f64,
    began_s: Option<f64>,
}

impl<'a> Follower<'a> {
    fn new(horse: Horse, to: &'a SteadyGait) -> Self {
        let inspector = Inspector::new(horse.skeleton());
        let mut follower = Self {
            cycles: horse.readout().leg_cycles,
            horse,
            to,
            inspector,
            accelerations: Accelerations::default(),
            strides: [0.0; 4],
            time_s: 0.0,
            began_s: None,
        };
        // The last pose of the old gait, so that a jump at the command is seen.
        follower.inspector.look(&follower.horse, 0.0, &FlatGround);
        follower.accelerations.take(&follower.horse.pose().bends_rad);
        follower
    }

    fn step(&mut self) {
        self.horse.step(&self.to.command, STEP_S, &FlatGround);
        self.time_s += f64::from(STEP_S);
        self.inspector.look(&self.horse, STEP_S, &FlatGround);
        let cycles = self.horse.readout().leg_cycles;
        for leg in 0..4 {
            if self.began_s.is_some() {
                self.strides[leg] += f64::from((cycles[leg] - self.cycles[leg]).rem_euclid(1.0));
            }
        }
        self.cycles = cycles;
    }

    /// Steps until the change is over, or `share` of it is done; false when it does not happen.
    fn follow(&mut self, share: f32) -> bool {
        while self.time_s < PATIENCE_S {
            self.step();
            self.accelerations.take(&self.horse.pose().bends_rad);
            let seen = self.horse.readout();
            match seen.change {
                Some(change) => {
                    if self.began_s.is_none() {
                        self.began_s = Some(self.time_s - f64::from(STEP_S));
                    }
                    if seen.gait == self.to.gait && change.share >= share {
                        return true;
                    }
                }
                None if self.began_s.is_some() && seen.gait == self.to.gait => return true,
                None => {}
            }
        }
        false
    }

    fn finish(mut self, start_phase: f64, from_p99: f64) -> Result<ChangeCase, String> {
        if !self.follow(f32::INFINITY) {
            let seen = self.horse.readout();
            return Err(format!(
                "to {} from phase {start_phase:.3}: not done after {PATIENCE_S:.0} s ({} at {:.2} m/s, change {:?})",
                self.to.gait, seen.gait, seen.speed_m_s, seen.change
            ));
        }
        let (over_s, began_s) = (self.time_s, self.began_s.unwrap_or(0.0));
        let convergence = apart(lags(self.horse.readout().leg_cycles), self.to.lags);
        let strides = self.strides;
        while self.time_s < over_s + AFTER_S {
            self.step();
        }
        let steady_p99 = from_p99.max(self.to.acceleration_p99);
        Ok(ChangeCase {
            start_phase,
            wait_s: began_s,
            duration_s: over_s - began_s,
            strides: strides[Limb::LH.index()],
            leg_strides: [
                strides.into_iter().fold(f64::INFINITY, f64::min),
                strides.into_iter().fold(0.0, f64::max),
            ],
            convergence,
            acceleration_ratio: self.accelerations.p99() / steady_p99,
            findings: *self.inspector.findings(),
        })
    }
}

/// Greatest difference of two sets of lags, strides.
fn apart(a: [f64; 4], b: [f64; 4]) -> f64 {
    let wrapped = |d: f64| ((d + 0.5).rem_euclid(1.0) - 0.5).abs();
    a.into_iter().zip(b).map(|(a, b)| wrapped(a - b)).fold(0.0, f64::max)
}

/// Changes from one steady gait to another, beginning at a phase.
///
/// # Errors
/// When the change does not come to an end.
pub fn measure(from: &SteadyGait, to: &SteadyGait, start_phase: f64) -> Result<ChangeCase, String> {
    let follower = Follower::new(from.at_phase(start_phase), to);
    follower.finish(start_phase, from.acceleration_p99).map_err(|fault| format!("{} {fault}", from.gait))
}

/// Two changes, the second begun during the first.
#[derive(Clone, Copy)]
pub struct Interrupted<'a> {
    /// The gait at first.
    pub from: &'a SteadyGait,
    /// The gait that is not reached.
    pub by: &'a SteadyGait,
    /// The gait in the end.
    pub to: &'a SteadyGait,
    /// Share of the first change that is done when the second begins.
    pub share: f32,
}

/// Changes gait, and again before that is done.
///
/// # Errors
/// When the first change does not begin, or the second does not come to an end.
pub fn measure_interrupted(case: Interrupted<'_>, start_phase: f64) -> Result<ChangeCase, String> {
    let mut first = Follower::new(case.from.at_phase(start_phase), case.by);
    if !first.follow(case.share) {
        return Err(format!("{} to {}: no change", case.from.gait, case.by.gait));
    }
    let before = *first.inspector.findings();
    let second = Follower::new(first.horse, case.to);
    let from_p99 = case.from.acceleration_p99.max(case.by.acceleration_p99);
    let fault = |text| format!("{} by {} {text}", case.from.gait, case.by.gait);
    let mut measured = second.finish(start_phase, from_p99).map_err(fault)?;
    measured.findings.merge(&before);
    Ok(measured)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lags_are_compared_round_the_circle() {
        assert!((apart([0.0, 0.999, 0.0, 0.5], [0.0, 0.001, 0.0, 0.5]) - 0.002).abs() < 1e-12);
    }
}
