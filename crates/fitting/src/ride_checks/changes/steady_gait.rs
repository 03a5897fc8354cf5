//! A gait at its usual speed, ready to be changed from and compared with.

use std::sync::Arc;

use muybridge_core::{
    Command, FlatGround, Gait, Horse, Limb, MPS_PER_MPH, Provenance, Repertoire, Side, Stride,
};

use super::super::steady::{command, record, settled, step_to_strike};
use super::{Accelerations, STEP_S, usual_mph};

/// Strides that the acceleration is taken over.
const STRIDES: f64 = 4.0;

/// A horse in a steady gait, just after a strike of its left hind.
#[derive(Clone)]
pub struct SteadyGait {
    /// The gait.
    pub gait: Gait,
    /// What it was asked for with.
    pub command: Command,
    /// The horse.
    pub horse: Horse,
    /// One stride of it.
    pub stride: Stride,
    /// How far each leg is ahead of the left hind in its own cycle, share of a stride.
    pub lags: [f64; 4],
    /// Acceleration of joints at the 99th percentile, rad/s^2.
    pub acceleration_p99: f64,
}

impl SteadyGait {
    /// Rides a gait at its usual speed until it is steady; canter and gallop on the right lead.
    ///
    /// # Errors
    /// When it does not become steady or takes no whole stride.
    pub fn ride(repertoire: &Arc<Repertoire>, gait: Gait) -> Result<Self, String> {
        let command = command(Some(gait), usual_mph(gait) * MPS_PER_MPH, Some(Side::Right));
        let mut horse = settled(repertoire, &command, 1)?;
        let how = "synthesised at run time".into();
        let provenance = Provenance::Derived { from: Vec::new(), how };
        let recorded = record(&horse, &command, gait.name(), provenance)?;
        step_to_strike(&mut horse, &command)?;
        let lags = lags(horse.readout().leg_cycles);
        let mut accelerations = Accelerations::default();
        let mut ahead = horse.clone();
        let steps = STRIDES * f64::from(recorded.stride.stride_time_s / STEP_S);
        for _ in 0..steps as usize {
            accelerations.take(&ahead.step(&command, STEP_S, &FlatGround).bends_rad);
        }
        Ok(Self {
            gait,
            command,
            horse,
            stride: recorded.stride,
            lags,
            acceleration_p99: accelerations.p99(),
        })
    }

    /// The horse at a phase.
    pub fn at_phase(&self, phase: f64) -> Horse {
        let mut horse = self.horse.clone();
        let mut left_s = (phase * f64::from(self.stride.stride_time_s)) as f32;
        while left_s > 0.0 {
            horse.step(&self.command, left_s.min(STEP_S), &FlatGround);
            left_s -= STEP_S;
        }
        horse
    }
}

/// How far each leg is ahead of the left hind, in `[0, 1)`.
pub(super) fn lags(leg_cycles: [f32; 4]) -> [f64; 4] {
    let hind = f64::from(leg_cycles[Limb::LH.index()]);
    leg_cycles.map(|cycle| (f64::from(cycle) - hind).rem_euclid(1.0))
}
