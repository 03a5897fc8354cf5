//! Which gait at which speed (Huang 2012, Fig. 3.6), with hysteresis and the drawn choice among trot, rack and canter.

use serde::{Deserialize, Serialize};

use crate::gait::Gait;

/// Walk gives way to amble above the first, and comes back below the second, miles per hour of a reference horse.
///
/// Real horses leave the walk near a Froude number of 0.35 (Griffin et al. 2004): 2.1 m/s or 4.8 mph for the reference horse's leg. The
/// two bounds lie about it. They leave it for the trot; here, as in the paper's table, the amble stands between, and the trot's
/// slowest stride is one of 10 mph.
const WALK_AMBLE_MPH: [f32; 2] = [5.1, 4.6];
/// The same from amble to trot, rack or canter: the middle of the gap between 9 and 10 mph, and a little to either side.
const AMBLE_TROT_MPH: [f32; 2] = [9.7, 9.3];
/// The same from trot or rack to canter alone: above the 20 mph the paper has them to.
const TROT_CANTER_MPH: [f32; 2] = [20.5, 20.1];
/// The same from canter to gallop: the gap between 25 and 26 mph.
const CANTER_GALLOP_MPH: [f32; 2] = [25.7, 25.3];
/// A change of speed smaller than this keeps the gait where there is a choice, miles per hour.
const SMALL_CHANGE_MPH: f32 = 3.0;

/// The gait chosen, and the speed last wanted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Choice {
    pub(super) gait: Gait,
    wanted_mph: f32,
}

impl Choice {
    pub(super) fn of(gait: Gait) -> Self {
        Self { gait, wanted_mph: 0.0 }
    }

    /// The gait for a wanted speed in miles per hour of a reference horse; `draw` gives a number in `[0, 1)` and is asked once for
    /// every choice.
    pub(super) fn at(self, mph: f32, draw: impl FnOnce() -> f32) -> Self {
        let band = |[up, down]: [f32; 2], is_above: bool| mph > if is_above { down } else { up };
        let gait = self.gait;
        let free: &[Gait] = if !band(WALK_AMBLE_MPH, gait != Gait::Walk) {
            &[Gait::Walk]
        } else if !band(AMBLE_TROT_MPH, !matches!(gait, Gait::Walk | Gait::Amble)) {
            &[Gait::Amble]
        } else if band(CANTER_GALLOP_MPH, gait == Gait::Gallop) {
            &[Gait::Gallop]
        } else if band(TROT_CANTER_MPH, matches!(gait, Gait::Canter | Gait::Gallop)) {
            &[Gait::Canter]
        } else {
            &[Gait::Trot, Gait::Rack, Gait::Canter]
        };
        let is_small = (mph - self.wanted_mph).abs() < SMALL_CHANGE_MPH;
        if free.contains(&gait) && (free.len() == 1 || is_small) {
            return Self { gait, wanted_mph: mph };
        }
        let index = if free.len() == 1 { 0 } else { (draw() * free.len() as f32) as usize };
        Self { gait: free[index.min(free.len() - 1)], wanted_mph: mph }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ride(speeds: impl IntoIterator<Item = f32>, draws: &[f32]) -> Vec<Gait> {
        let mut choice = Choice::of(Gait::Walk);
        let mut draws = draws.iter().cycle();
        let step = |mph: f32| {
            choice = choice.at(mph, || *draws.next().unwrap());
            choice.gait
        };
        speeds.into_iter().map(step).collect()
    }

    #[test]
    fn every_mile_per_hour_has_the_papers_gait() {
        for mph in 1..=40u8 {
            let gait = ride([f32::from(mph)], &[0.0, 0.4, 0.9])[0];
            let [low, high] = gait.speed_range_mph().unwrap();
            assert!((low..=high).contains(&f64::from(mph)), "{gait} at {mph}");
        }
    }

    #[test]
    fn a_speed_that_trembles_about_a_bound_changes_the_gait_once() {
        for bound in [5.0, 9.5, 20.2, 25.5] {
            let gaits = ride((0..100).map(|k| bound + 0.15 * (k as f32).sin()), &[0.0]);
            let changes = gaits.windows(2).filter(|pair| pair[0] != pair[1]).count();
            assert!(changes <= 1, "{bound}: {changes} changes");
        }
    }

    #[test]
    fn a_small_change_keeps_the_gait_and_a_large_one_draws() {
        assert_eq!(ride([12.0, 14.0, 13.0], &[0.0, 0.9]), [Gait::Trot; 3]);
        assert_eq!(ride([12.0, 16.0], &[0.0, 0.9]), [Gait::Trot, Gait::Canter]);
        assert_eq!(ride([12.0, 12.0, 12.0], &[0.5]), [Gait::Rack; 3]);
    }
}
