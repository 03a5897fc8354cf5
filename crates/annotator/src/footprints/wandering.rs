//! A bird that wanders among trees: prints come as it goes, and only the step before the newest is planned.

use muybridge_footprints::{
    BipedPose, Meadow, Model, Planner, Print, Terrain, Track, Tree, Wanderer, Weights,
};

/// Who wanders.
const MODEL: &str = "bird";
/// Side of the square, in steps of the model: half a minute from border to border.
const SIDE_STEPS: f64 = 40.0;
/// Trees in the square.
const TREES: usize = 14;
/// Trees are apart by so many steps: room to turn about in.
const GAP_STEPS: f64 = 4.5;
/// What is planned is so far ahead of what is shown, s.
const AHEAD_S: f64 = 0.1;
/// Prints laid in one frame at most.
const MOST_AT_ONCE: usize = 6;
/// The walk ends by itself after so many prints: a track holds no more.
const MOST_PRINTS: usize = 9_000;
/// Longest time that is caught up with, s.
const LONGEST_S: f64 = 0.1;

/// A walk under way.
pub struct Wandering {
    model: Model,
    planner: Planner,
    wanderer: Wanderer,
    prints: Vec<Print>,
    time_s: f64,
    is_paused: bool,
    fault: Option<String>,
}

impl Wandering {
    /// A bird in a meadow of this seed.
    ///
    /// # Errors
    /// In words, when it cannot begin.
    pub fn new(seed: u64) -> Result<Self, String> {
        let model = Model::named(MODEL).ok_or("There is no bird")?;
        let step_m = model.step_m[0];
        let meadow = Meadow::planted(SIDE_STEPS * step_m, TREES, GAP_STEPS * step_m, seed)
            .map_err(|error| error.to_string())?;
        let wanderer = Wanderer::new(meadow, &model, seed).map_err(|error| error.to_string())?;
        let planner = Planner::new(model.clone(), Terrain::Flat, Weights::default())
            .map_err(|error| error.to_string())?;
        let (prints, time_s) = (Vec::new(), 0.0);
        Ok(Self { model, planner, wanderer, prints, time_s, is_paused: false, fault: None })
    }

    /// Lets real time pass, seconds.
    pub fn advance(&mut self, passed_s: f64) {
        if self.is_paused || self.fault.is_some() || passed_s.is_nan() {
            return;
        }
        let wanted_s = self.time_s + passed_s.clamp(0.0, LONGEST_S);
        for _ in 0..MOST_AT_ONCE {
            let is_planned = self.planner.final_s().is_some_and(|final_s| final_s > wanted_s + AHEAD_S);
            if is_planned || !self.lay_next() {
                break;
            }
        }
        self.time_s = wanted_s.min(self.planner.final_s().unwrap_or(0.0));
    }

    fn lay_next(&mut self) -> bool {
        if self.prints.len() >= MOST_PRINTS {
            self.fault = Some("The walk is as long as a track can be; keep it, or begin another one".into());
            return false;
        }
        let Some(print) = self.wanderer.next() else { return false };
        match self.planner.push(print) {
            Ok(()) => self.prints.push(print),
            Err(error) => self.fault = Some(error.to_string()),
        }
        self.fault.is_none()
    }

    /// Stops, or goes on.
    pub fn pause(&mut self, is_paused: bool) {
        self.is_paused = is_paused;
    }

    /// Whether it stands.
    pub fn is_paused(&self) -> bool {
        self.is_paused || self.fault.is_some()
    }

    /// Why it went no farther.
    pub fn fault(&self) -> Option<&str> {
        self.fault.as_deref()
    }

    /// The moment, s.
    pub fn time_s(&self) -> f64 {
        self.time_s
    }

    /// What was planned so far.
    pub fn planner(&self) -> &Planner {
        &self.planner
    }

    /// Who wanders.
    pub fn model(&self) -> &Model {
        &self.model
    }

    /// The prints so far.
    pub fn prints(&self) -> &[Print] {
        &self.prints
    }

    /// The pose now; none before the first step is planned.
    pub fn pose(&self) -> Option<BipedPose> {
        self.planner.pose(self.time_s)
    }

    /// The trees.
    pub fn trees(&self) -> &[Tree] {
        self.wanderer.meadow().trees()
    }

    /// Side of the square around the origin, metres.
    pub fn side_m(&self) -> f64 {
        self.wanderer.meadow().side_m()
    }

    /// The walk as a track: the prints that were stepped on.
    pub fn to_track(&self) -> Track {
        let placed = &self.planner.placed().prints;
        let stepped = placed.iter().take_while(|print| print.strike_s <= self.time_s).count();
        let prints = self.prints.iter().take(stepped).copied().collect();
        Track { name: Some("A walk among trees".into()), prints, ..Track::new(MODEL) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_walk_goes_on_pauses_and_becomes_a_track() {
        let mut walk = Wandering::new(3).unwrap();
        for _ in 0..600 {
            walk.advance(1.0 / 60.0);
        }
        assert!(walk.fault().is_none(), "{:?}", walk.fault());
        assert!((walk.time_s() - 10.0).abs() < 0.5, "{}", walk.time_s());
        let pose = walk.pose().unwrap();
        let half_m = walk.side_m() / 2.0;
        assert!(pose.centre_of_mass.x.abs() < half_m && pose.centre_of_mass.z.abs() < half_m);
        walk.pause(true);
        walk.advance(1.0);
        walk.advance(f64::NAN);
        assert!((walk.time_s() - 10.0).abs() < 0.5);
        let track = walk.to_track();
        assert!(track.prints.len() > 5 && track.prints.len() <= walk.prints().len());
        assert!(track.place(&walk.model().timing).is_ok());
        let again = Wandering::new(3).unwrap();
        assert_eq!(again.trees(), walk.trees());
    }
}
