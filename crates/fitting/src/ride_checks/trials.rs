//! Rides of a minute each, drawn from a seed: any command, any time step, any ground, any build.

use std::fmt::{Display, Formatter, Result as FormatResult};
use std::ops::Range;
use std::sync::Arc;

use muybridge_core::{Command, Gait, Horse, Random, Repertoire};

use super::findings::{Broken, Findings, Limits, Part, Quantity};
use super::inspector::Inspector;
use super::scripts::{Clock, Rider};
use super::terrain::Terrain;

/// Duration of a ride, s.
pub const RIDE_S: f64 = 60.0;

/// One ride: everything that follows from its seed.
#[derive(Clone, Debug)]
pub struct Trial {
    /// The seed.
    pub seed: u64,
    /// Index of the build.
    pub build: usize,
    /// The ground.
    pub terrain: Terrain,
    /// The time steps.
    pub clock: Clock,
}

impl Trial {
    /// The ride of a seed, with one of so many builds.
    pub fn of(seed: u64, builds: usize) -> Self {
        let mut random = Random::new(seed);
        let build = (random.uniform() * builds as f64) as usize;
        Self { seed, build, terrain: Terrain::draw(&mut random), clock: Clock::draw(&mut random) }
    }

    /// Rides it.
    pub fn ride(&self, repertoire: &Arc<Repertoire>) -> Findings {
        self.ride_seeing(repertoire, |_| {})
    }

    /// Rides it and shows every step to `see`.
    pub fn ride_seeing(&self, repertoire: &Arc<Repertoire>, mut see: impl FnMut(&Seen<'_>)) -> Findings {
        let mut horse = Horse::of(Arc::clone(repertoire), self.seed);
        let mut inspector = Inspector::new(repertoire.skeleton());
        let (mut random, mut rider) = (Random::new(!self.seed), Rider::new(self.seed));
        let origin = horse.readout().prints[0] * 0.0;
        horse.place(origin, 0.0, &self.terrain);
        let mut time_s = 0.0;
        while time_s < RIDE_S {
            let dt_s = self.clock.next_s(&mut random);
            let command = rider.ask(dt_s);
            horse.step(&command, dt_s, &self.terrain);
            let before = *inspector.findings();
            inspector.look(&horse, dt_s, &self.terrain);
            time_s += f64::from(dt_s);
            see(&Seen {
                time_s,
                dt_s,
                command,
                horse: &horse,
                findings: inspector.findings(),
                before: &before,
            });
        }
        *inspector.findings()
    }

    /// The limits of its ground.
    pub fn limits(&self) -> Limits {
        if self.terrain == Terrain::Flat { Limits::flat() } else { Limits::terrain() }
    }
}

/// A step of a ride, to be shown.
pub struct Seen<'a> {
    /// Time since the start, s.
    pub time_s: f64,
    /// Duration of the step, s.
    pub dt_s: f32,
    /// What was asked.
    pub command: Command,
    /// The horse after it.
    pub horse: &'a Horse,
    /// The worst so far.
    pub findings: &'a Findings,
    /// The worst before it.
    pub before: &'a Findings,
}

impl Display for Seen<'_> {
    fn fmt(&self, f: &mut Formatter<'_>) -> FormatResult {
        let (readout, command) = (self.horse.readout(), self.command);
        let leap = if command.leap.is_some() { " leap" } else { "" };
        let asked = format!(
            "{:5.1} {} {:?}{leap}",
            command.speed_m_s,
            command.gait.map_or("-", Gait::name),
            command.turn
        );
        let change = readout.change.map_or(String::new(), |c| format!("{} {:.2}", c.from, c.share));
        let down: String = readout.on_ground.iter().map(|down| if *down { 'x' } else { '.' }).collect();
        let root = self.horse.pose().root_in_world;
        write!(
            f,
            "{:7.3} {:.4} {asked:<30} {:<7} {}{change:<12} {:6.2} {:6.3} {:6.3} {down} {:.3?} {:7.3} [{:.3} {:.3} {:.3}]",
            self.time_s,
            self.dt_s,
            readout.gait,
            if readout.is_standing { "standing " } else { "" },
            readout.speed_m_s,
            1.0 / readout.stride_time_s,
            readout.turn_rate_rad_s,
            readout.leg_cycles,
            readout.lowered_m,
            root.x,
            root.y,
            root.z
        )?;
        for broken in self.findings.broken(&Limits::smooth()) {
            if self.before.worst(broken.quantity) != broken.worst {
                let part = broken.worst.part.name(self.horse.skeleton());
                let (k, unit) = (broken.quantity.per_unit(), broken.quantity.unit());
                write!(f, " | {} {part} {:.3} {unit}", broken.quantity.name(), broken.worst.value * k)?;
            }
        }
        Ok(())
    }
}

/// The worst of a quantity on one kind of ground, and the seed that showed it.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Case {
    /// The value.
    pub value: f64,
    /// The ride.
    pub seed: u64,
    /// When in that ride, s.
    pub at_s: f64,
    /// Where on the horse.
    pub part: Part,
    /// How many rides broke the limit.
    pub broken: usize,
}

/// The worst of many rides, by kind of ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Summary {
    worst: [[Case; Quantity::COUNT]; Terrain::DRAWN.len()],
    /// Rides by kind of ground, in the order of [`Terrain::DRAWN`].
    pub rides: [usize; Terrain::DRAWN.len()],
    /// Seeds of rides that broke a limit, with what they broke first in the order of the table.
    pub broken: Vec<(u64, Broken)>,
    /// Steps, stances and time of all.
    pub steps: u64,
    /// Stances of all.
    pub stances: u64,
    /// Time of all, s.
    pub time_s: f64,
}

impl Default for Summary {
    fn default() -> Self {
        Self {
            worst: [[Case::default(); Quantity::COUNT]; Terrain::DRAWN.len()],
            rides: [0; Terrain::DRAWN.len()],
            broken: Vec::new(),
            steps: 0,
            stances: 0,
            time_s: 0.0,
        }
    }
}

impl Summary {
    /// Rides the trials of a range of seeds, one after the other, on builds that are ready.
    pub fn ride(seeds: Range<u64>, repertoires: &[Arc<Repertoire>]) -> Self {
        let mut summary = Self::default();
        for seed in seeds {
            let trial = Trial::of(seed, repertoires.len());
            if let Some(repertoire) = repertoires.get(trial.build) {
                summary.take(&trial, &trial.ride(repertoire));
            }
        }
        summary
    }

    fn take(&mut self, trial: &Trial, findings: &Findings) {
        let kind = Terrain::DRAWN.iter().position(|name| *name == trial.terrain.name()).unwrap_or(0);
        self.rides[kind] += 1;
        self.steps += findings.steps;
        self.stances += findings.stances;
        self.time_s += findings.time_s;
        let limits = trial.limits();
        for quantity in Quantity::ALL {
            let worst = findings.worst(quantity);
            let case = &mut self.worst[kind][quantity as usize];
            let broken = case.broken + usize::from(worst.value > limits.of(quantity));
            if worst.value > case.value {
                let (value, at_s, part) = (worst.value, worst.at_s, worst.part);
                *case = Case { value, seed: trial.seed, at_s, part, broken };
            }
            case.broken = broken;
        }
        if let Some(first) = findings.broken(&limits).first() {
            self.broken.push((trial.seed, *first));
        }
    }

    /// Takes in the rides of another.
    pub fn merge(&mut self, other: Self) {
        for kind in 0..Terrain::DRAWN.len() {
            self.rides[kind] += other.rides[kind];
            for (mine, theirs) in self.worst[kind].iter_mut().zip(other.worst[kind]) {
                let broken = mine.broken + theirs.broken;
                if theirs.value > mine.value {
                    *mine = theirs;
                }
                mine.broken = broken;
            }
        }
        self.broken.extend(other.broken);
        self.broken.sort_by_key(|row| row.0);
        self.steps += other.steps;
        self.stances += other.stances;
        self.time_s += other.time_s;
    }

    /// The worst of a quantity on a kind of ground, by its index in [`Terrain::DRAWN`].
    pub fn worst(&self, kind: usize, quantity: Quantity) -> Case {
        self.worst[kind][quantity as usize]
    }
}

impl Display for Summary {
    fn fmt(&self, f: &mut Formatter<'_>) -> FormatResult {
        let rides: usize = self.rides.iter().sum();
        writeln!(
            f,
            "{rides} rides of {RIDE_S:.0} s, {:.1} hours, {} steps, {} stances; {} rides broke a limit",
            self.time_s / 3600.0,
            self.steps,
            self.stances,
            self.broken.len()
        )?;
        writeln!(
            f,
            "ground  quantity                         worst unit        limit  rides over  seed      at s  part"
        )?;
        for (kind, name) in Terrain::DRAWN.into_iter().enumerate().filter(|(kind, _)| self.rides[*kind] > 0) {
            let limits = if name == "flat" { Limits::flat() } else { Limits::terrain() };
            for quantity in Quantity::ALL {
                let (case, k) = (self.worst(kind, quantity), quantity.per_unit());
                writeln!(
                    f,
                    "{name:<7} {:<31} {:9.4} {:<8} {:8.3} {:6}/{:<5} {:5}  {:8.3}  {:?}",
                    quantity.name(),
                    case.value * k,
                    quantity.unit(),
                    limits.of(quantity) * k,
                    case.broken,
                    self.rides[kind],
                    case.seed,
                    case.at_s,
                    case.part
                )?;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_worst_ride_is_named_and_summaries_add_up() {
        let trial = |seed| Trial { seed, build: 0, terrain: Terrain::Flat, clock: Clock::Jittered };
        let seen = |slide_m| {
            let mut findings = Findings::default();
            findings.see(Quantity::StanceSlide, slide_m, 7.0, Part::Body);
            findings
        };
        let (mut first, mut second) = (Summary::default(), Summary::default());
        first.take(&trial(1), &seen(0.00005));
        first.take(&trial(2), &seen(0.0004));
        second.take(&trial(3), &seen(0.003));
        first.merge(second);
        let worst = first.worst(0, Quantity::StanceSlide);
        assert_eq!((worst.seed, worst.value, worst.broken), (3, 0.003, 2));
        assert_eq!(first.broken.iter().map(|row| row.0).collect::<Vec<_>>(), [2, 3]);
        assert_eq!(first.rides, [3, 0, 0, 0]);
    }

    #[test]
    fn trials_use_every_build_and_every_ground() {
        let trials: Vec<Trial> = (0..200).map(|seed| Trial::of(seed, 6)).collect();
        for build in 0..6 {
            assert!(trials.iter().any(|trial| trial.build == build));
        }
        for name in Terrain::DRAWN {
            assert!(trials.iter().any(|trial| trial.terrain.name() == name));
        }
    }
}
