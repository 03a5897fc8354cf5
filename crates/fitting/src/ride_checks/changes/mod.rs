//! Every change of gait from every phase: how long, how smooth, and whether every leg arrives.

mod measure;
mod steady_gait;
mod table;

pub use measure::{ChangeCase, Fault, Interrupted, measure, measure_interrupted};
pub use steady_gait::SteadyGait;
pub use table::{ChangeTable, PairRow};

use muybridge_core::Gait;

/// Steps of all measurements of changes, s.
pub const STEP_S: f32 = 1.0 / 240.0;
/// Start phases of each pair.
pub const START_PHASES: usize = 40;
/// Greatest difference of a leg's phase from that of the same gait ridden steadily, strides.
pub const CONVERGENCE: f64 = 1e-5;
/// Least and greatest duration, strides.
pub const DURATION_STRIDES: [f64; 2] = [2.0, 3.0];
/// Greatest acceleration of joints during a change against the larger of the two steady gaits, both at the 99th percentile.
pub const ACCELERATION_RATIO: f64 = 2.5;

/// The speed a gait is changed to at, mph: the middle of what it is used at.
pub fn usual_mph(gait: Gait) -> f64 {
    match gait {
        Gait::Walk => 3.0,
        Gait::Amble => 7.5,
        Gait::Trot | Gait::Rack => 12.0,
        Gait::Canter => 16.0,
        Gait::Gallop | Gait::Leap => 30.0,
    }
}

/// The six gaits.
pub const GAITS: [Gait; 6] = [Gait::Walk, Gait::Amble, Gait::Trot, Gait::Rack, Gait::Canter, Gait::Gallop];

/// All 30 ordered pairs of gaits.
pub fn pairs() -> impl Iterator<Item = [Gait; 2]> {
    GAITS
        .into_iter()
        .flat_map(|from| GAITS.into_iter().filter(move |to| *to != from).map(move |to| [from, to]))
}

/// Second differences of bends, collected for a percentile.
#[derive(Clone, Debug, Default)]
pub struct Accelerations {
    before: Option<[f32; muybridge_core::BONE_COUNT]>,
    rates: Option<[f32; muybridge_core::BONE_COUNT]>,
    values: Vec<f32>,
}

impl Accelerations {
    /// Takes the bends of a step in, [`STEP_S`] after the last ones.
    pub fn take(&mut self, bends_rad: &[f32; muybridge_core::BONE_COUNT]) {
        if let Some(before) = self.before {
            let rates = std::array::from_fn(|bone| (bends_rad[bone] - before[bone]) / STEP_S);
            if let Some(rates_before) = self.rates {
                let changes = (0..rates.len()).map(|bone| (rates[bone] - rates_before[bone]).abs() / STEP_S);
                self.values.extend(changes);
            }
            self.rates = Some(rates);
        }
        self.before = Some(*bends_rad);
    }

    /// The 99th percentile over all bones and steps, rad/s^2; zero without any.
    pub fn p99(&mut self) -> f64 {
        if self.values.is_empty() {
            return 0.0;
        }
        let index = (self.values.len() * 99 / 100).min(self.values.len() - 1);
        f64::from(*self.values.select_nth_unstable_by(index, f32::total_cmp).1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_thirty_pairs() {
        assert_eq!(pairs().count(), 30);
        assert!(GAITS.iter().all(|gait| {
            let range = gait.speed_range_mph().unwrap();
            (range[0]..=range[1]).contains(&usual_mph(*gait))
        }));
    }

    #[test]
    fn the_acceleration_of_a_swing_is_that_of_the_swing() {
        let mut accelerations = Accelerations::default();
        let omega = 10.0f32;
        for k in 0..2400 {
            let bend = (omega * k as f32 * STEP_S).sin();
            accelerations.take(&[bend; muybridge_core::BONE_COUNT]);
        }
        assert!((accelerations.p99() / 100.0 - 1.0).abs() < 0.01, "{}", accelerations.p99());
    }
}
