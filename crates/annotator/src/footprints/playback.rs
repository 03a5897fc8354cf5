//! The moment that is looked at, and how it moves on.

/// Speeds of play against the real one.
pub const RATES: [(f64, &str); 4] = [(0.125, "1/8"), (0.25, "1/4"), (0.5, "1/2"), (1.0, "1×")];
/// Longest time that is caught up with, s: after a pause of the window the play goes on where it was.
const LONGEST_S: f64 = 0.1;
/// A single step, s.
pub const STEP_S: f64 = 1.0 / 60.0;

/// The moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Playback {
    time_s: f64,
    /// Whether time passes.
    pub is_playing: bool,
    /// Whether it begins again at the end.
    pub is_looped: bool,
    /// Speed of time against the real one.
    pub rate: f64,
}

impl Default for Playback {
    fn default() -> Self {
        Self { time_s: 0.0, is_playing: false, is_looped: true, rate: 1.0 }
    }
}

impl Playback {
    /// The moment, s.
    pub fn time_s(&self) -> f64 {
        self.time_s
    }

    /// Stands at the beginning, for another motion.
    pub fn begin_again(&mut self) {
        (self.time_s, self.is_playing) = (0.0, false);
    }

    /// Goes to a moment of a motion that lasts so long.
    pub fn go_to(&mut self, time_s: f64, end_s: f64) {
        if time_s.is_finite() {
            self.time_s = time_s.clamp(0.0, end_s.max(0.0));
        }
    }

    /// Stops, and goes on by so many single steps.
    pub fn step(&mut self, steps: f64, end_s: f64) {
        self.is_playing = false;
        self.go_to(self.time_s + steps * STEP_S, end_s);
    }

    /// Plays or pauses; from the end it begins again.
    pub fn toggle(&mut self, end_s: f64) {
        self.is_playing = !self.is_playing;
        if self.is_playing && self.time_s >= end_s {
            self.time_s = 0.0;
        }
    }

    /// Lets real time pass, seconds.
    pub fn advance(&mut self, passed_s: f64, end_s: f64) {
        self.go_to(self.time_s, end_s);
        if !self.is_playing || passed_s.is_nan() {
            return;
        }
        let time_s = self.time_s + passed_s.clamp(0.0, LONGEST_S) * self.rate;
        if time_s < end_s {
            self.time_s = time_s;
        } else if self.is_looped && end_s > 0.0 {
            self.time_s = time_s % end_s;
        } else {
            (self.time_s, self.is_playing) = (end_s.max(0.0), false);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn play_ends_or_begins_again() {
        let mut play = Playback { is_playing: true, is_looped: false, ..Playback::default() };
        for _ in 0..30 {
            play.advance(0.05, 1.0);
        }
        assert_eq!((play.time_s(), play.is_playing), (1.0, false));
        play.toggle(1.0);
        assert_eq!((play.time_s(), play.is_playing), (0.0, true));
        play.is_looped = true;
        for _ in 0..30 {
            play.advance(0.05, 1.0);
        }
        assert!((play.time_s() - 0.5).abs() < 1e-9);
        play.advance(f64::NAN, 1.0);
        play.go_to(f64::NAN, 1.0);
        assert!((play.time_s() - 0.5).abs() < 1e-9);
        play.advance(0.05, 0.2);
        assert!(play.time_s() <= 0.2);
    }
}
