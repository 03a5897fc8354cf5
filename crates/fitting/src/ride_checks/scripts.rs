//! What a rider asks for over a minute, drawn from a seed.

use muybridge_core::{Command, Gait, Leap, MPS_PER_MPH, Random, Side, Turn};

/// Fastest speed that is asked for, mph: half as fast again as the fastest gallop.
const FASTEST_MPH: f64 = 60.0;
/// Chance of each part of the command to change when it changes.
const SPEED_CHANGES: f64 = 0.6;
const GAIT_CHANGES: f64 = 0.4;
const TURN_CHANGES: f64 = 0.5;
const LEAPS: f64 = 0.12;
const HALTS: f64 = 0.12;
/// Chance that the next change follows at once.
const QUICK: f64 = 0.35;
/// Quick changes follow within this, s; others later.
const QUICK_S: f64 = 0.4;
const SLOW_S: f64 = 5.0;

/// How long steps last.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clock {
    /// Always so long, s.
    Fixed(f32),
    /// Between a hundred and fiftieth and a twenty-fifth of a second.
    Jittered,
}

impl Clock {
    /// One of 30, 60 and 120 steps a second, or jittered.
    pub fn draw(random: &mut Random) -> Self {
        match (random.uniform() * 4.0) as usize {
            0 => Self::Fixed(1.0 / 30.0),
            1 => Self::Fixed(1.0 / 60.0),
            2 => Self::Fixed(1.0 / 120.0),
            _ => Self::Jittered,
        }
    }

    /// The next step, s.
    pub fn next_s(self, random: &mut Random) -> f32 {
        match self {
            Self::Fixed(dt_s) => dt_s,
            Self::Jittered => random.between(1.0 / 150.0, 1.0 / 25.0) as f32,
        }
    }
}

/// A rider who changes his mind.
#[derive(Clone, Debug)]
pub struct Rider {
    random: Random,
    command: Command,
    until_s: f64,
    at_s: f64,
}

impl Rider {
    /// A rider of a seed.
    pub fn new(seed: u64) -> Self {
        let mut random = Random::new(seed ^ 0x51ed_270b);
        let speed_m_s = (random.between(0.0, 40.0) * MPS_PER_MPH) as f32;
        Self { random, command: Command { speed_m_s, ..Command::default() }, until_s: 0.0, at_s: 0.0 }
    }

    /// What he asks for now, and `dt_s` later the next thing.
    pub fn ask(&mut self, dt_s: f32) -> Command {
        if self.at_s >= self.until_s {
            self.change();
        }
        self.at_s += f64::from(dt_s);
        self.command
    }

    fn chance(&mut self, share: f64) -> bool {
        self.random.uniform() < share
    }

    fn change(&mut self) {
        let quick = self.chance(QUICK);
        let range = if quick { [0.0, QUICK_S] } else { [QUICK_S, SLOW_S] };
        self.until_s = self.at_s + self.random.between(range[0], range[1]);
        if self.chance(SPEED_CHANGES) {
            self.command.speed_m_s = (self.random.between(-2.0, FASTEST_MPH) * MPS_PER_MPH) as f32;
        }
        if self.chance(HALTS) {
            self.command.speed_m_s = 0.0;
        }
        if self.chance(GAIT_CHANGES) {
            self.command.gait = self.gait();
            let drawn = self.random.uniform();
            self.command.lead = [None, Some(Side::Left), Some(Side::Right)][(drawn * 3.0) as usize];
        }
        if self.chance(TURN_CHANGES) {
            self.command.turn = self.turn();
        }
        let leap = Leap {
            height_m: self.random.between(0.0, 1.4) as f32,
            length_m: self.random.between(0.0, 8.0) as f32,
        };
        self.command.leap = self.chance(LEAPS).then_some(leap);
    }

    /// A gait with a usual speed half of the time, the speed's own otherwise.
    fn gait(&mut self) -> Option<Gait> {
        let gait = Gait::ALL[(self.random.uniform() * 6.0) as usize];
        let range = gait.speed_range_mph()?;
        if self.chance(0.5) {
            return None;
        }
        if self.chance(0.7) {
            self.command.speed_m_s = (self.random.between(range[0], range[1]) * MPS_PER_MPH) as f32;
        }
        Some(gait)
    }

    fn turn(&mut self) -> Turn {
        match (self.random.uniform() * 4.0) as usize {
            0 => Turn::default(),
            1 => Turn::Rate(self.random.between(-2.0, 2.0) as f32),
            2 => Turn::Heading(self.random.between(-4.0, 4.0) as f32),
            _ => Turn::Steps(self.random.between(-14.0, 14.0) as i32),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_minute_holds_every_gait_a_leap_a_halt_and_quick_changes_and_is_the_same_each_time() {
        let (mut gaits, mut leaps, mut halts, mut quick) = ([false; 6], 0, 0, 0);
        for seed in 0..40 {
            let (mut rider, mut twin) = (Rider::new(seed), Rider::new(seed));
            let (mut before, mut since) = (Command::default(), 0);
            for _ in 0..3600 {
                let command = rider.ask(1.0 / 60.0);
                assert_eq!(command, twin.ask(1.0 / 60.0));
                if command != before {
                    quick += usize::from(since < 12);
                    since = 0;
                    leaps += usize::from(command.leap.is_some());
                    halts += usize::from(command.speed_m_s == 0.0);
                }
                since += 1;
                before = command;
                if let Some(gait) = command.gait {
                    gaits[gait as usize] = true;
                }
            }
        }
        assert_eq!(gaits, [true; 6]);
        assert!(leaps > 20 && halts > 20 && quick > 20, "{leaps} {halts} {quick}");
    }
}
