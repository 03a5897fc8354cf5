//! What the rider asks for, and how keys and sliders change it.

use std::f64::consts::PI;
use std::ops::RangeInclusive;

use muybridge_core::{Command, Gait, Leap, MPS_PER_MPH, Side, TURN_STEP_RAD, Turn};

/// One press of the speed, miles per hour.
const SPEED_STEP_MPH: f32 = 1.0;
/// A rein that is held turns the horse at this rate, radians per second.
pub const HELD_RATE_RAD_S: f32 = 40.0 * std::f32::consts::PI / 180.0;
/// A rein is held after so long, seconds: a shorter press is a step.
const HELD_AFTER_S: f64 = 0.3;

/// What the rider asks for from now on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wants {
    /// Speed, miles per hour; zero halts.
    pub speed_mph: f32,
    /// Turn.
    pub turn: Turn,
    /// Gait; none lets the speed choose.
    pub gait: Option<Gait>,
    /// Lead; none lets the turn choose.
    pub lead: Option<Side>,
    /// Size of the leaps.
    pub leap: Leap,
    /// Whether a leap is asked for in the coming step.
    pub leaps: bool,
}

impl Default for Wants {
    fn default() -> Self {
        let leap = Leap { height_m: 0.4, length_m: 3.0 };
        Self { speed_mph: 4.0, turn: Turn::Heading(0.0), gait: None, lead: None, leap, leaps: false }
    }
}

/// One change of what is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// A mile per hour more.
    Faster,
    /// A mile per hour less.
    Slower,
    /// This speed, miles per hour.
    Speed(f32),
    /// A step of 15 degrees to a side.
    Tap(Side),
    /// This turn.
    Turn(Turn),
    /// This gait; none lets the speed choose.
    Gait(Option<Gait>),
    /// The next of: as the turn asks, left, right.
    NextLead,
    /// This lead.
    Lead(Option<Side>),
    /// One leap.
    Leap,
    /// Leaps of another size.
    LeapSize(Leap),
    /// Stand.
    Halt,
}

impl Wants {
    /// Speeds that can be asked for, miles per hour.
    pub const SPEED_MPH: RangeInclusive<f32> = 0.0..=40.0;
    /// Turn rates that can be asked for, degrees per second.
    pub const TURN_DEG_S: RangeInclusive<f32> = -60.0..=60.0;
    /// Heights of a leap, metres.
    pub const LEAP_HEIGHT_M: RangeInclusive<f32> = 0.05..=1.2;
    /// Lengths of a leap, metres.
    pub const LEAP_LENGTH_M: RangeInclusive<f32> = 0.5..=6.0;

    /// What the horse is told; `own_gait` is kept whatever the rider asks for.
    pub fn command(&self, own_gait: Option<Gait>) -> Command {
        Command {
            speed_m_s: self.speed_mph * MPS_PER_MPH as f32,
            turn: self.turn,
            gait: own_gait.or(self.gait),
            lead: self.lead,
            leap: self.leaps.then_some(self.leap),
        }
    }

    /// Takes an order of a horse that now has this heading, radians.
    pub fn take(&mut self, order: Order, heading_rad: f64) {
        match order {
            Order::Faster => self.speed_mph = self.next_speed(SPEED_STEP_MPH),
            Order::Slower => self.speed_mph = self.next_speed(-SPEED_STEP_MPH),
            Order::Speed(mph) => self.speed_mph = held(mph, &Self::SPEED_MPH),
            Order::Tap(side) => self.turn = Turn::Heading(self.tapped(side, heading_rad)),
            Order::Turn(turn) => self.turn = turn,
            Order::Gait(gait) => {
                self.gait = gait;
                if let Some([low, high]) = self.gait_range().filter(|_| self.speed_mph > 0.0) {
                    self.speed_mph = self.speed_mph.clamp(low, high);
                }
            }
            Order::NextLead => {
                self.lead = match self.lead {
                    None => Some(Side::Left),
                    Some(Side::Left) => Some(Side::Right),
                    Some(Side::Right) => None,
                }
            }
            Order::Lead(lead) => self.lead = lead,
            Order::Leap => self.leaps = true,
            Order::LeapSize(leap) => self.leap = leap,
            Order::Halt => self.speed_mph = 0.0,
        }
    }

    /// Speeds of the gait that is asked for, miles per hour; none while the speed chooses.
    fn gait_range(&self) -> Option<[f32; 2]> {
        Some(self.gait?.speed_range_mph()?.map(|mph| mph as f32))
    }

    /// The speed after a press: whole miles per hour within the gait that is asked for, and below its slowest a halt.
    fn next_speed(&self, by_mph: f32) -> f32 {
        let next = (self.speed_mph + by_mph).round();
        let Some([low, high]) = self.gait_range() else { return held(next, &Self::SPEED_MPH) };
        if by_mph < 0.0 && next < low { 0.0 } else { next.clamp(low, high) }
    }

    /// The heading after a press of a rein: from the heading wanted before, and never more than half round.
    fn tapped(&self, side: Side, heading_rad: f64) -> f32 {
        let from = match self.turn {
            Turn::Heading(wanted) => f64::from(wanted),
            Turn::Steps(steps) => f64::from(steps) * f64::from(TURN_STEP_RAD),
            Turn::Rate(_) => (heading_rad / f64::from(TURN_STEP_RAD)).round() * f64::from(TURN_STEP_RAD),
        };
        let step = f64::from(TURN_STEP_RAD) * if side == Side::Left { 1.0 } else { -1.0 };
        // From the horse as it stands, by the shorter way; asking for more than half round would turn it the other way.
        let ahead = (from - heading_rad + PI).rem_euclid(2.0 * PI) - PI + step;
        let most = PI - f64::from(TURN_STEP_RAD);
        (heading_rad + ahead.clamp(-most, most)) as f32
    }
}

fn held(value: f32, range: &RangeInclusive<f32>) -> f32 {
    if value.is_finite() { value.clamp(*range.start(), *range.end()) } else { *range.start() }
}

/// A rein that is held down.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct HeldRein {
    side: Option<Side>,
    held_s: f64,
}

impl HeldRein {
    /// Says which rein is down after some more seconds; the turn that follows from it, where one does. `heading_rad` is the
    /// horse's: letting a held rein go keeps it.
    pub fn hold(&mut self, side: Option<Side>, passed_s: f64, heading_rad: f64) -> Option<Turn> {
        let was_held = self.is_held();
        if side != self.side {
            (self.side, self.held_s) = (side, 0.0);
        } else if side.is_some() {
            self.held_s += passed_s;
        }
        match self.side {
            Some(side) if self.is_held() => {
                Some(Turn::Rate(if side == Side::Left { HELD_RATE_RAD_S } else { -HELD_RATE_RAD_S }))
            }
            _ => was_held.then_some(Turn::Heading(heading_rad as f32)),
        }
    }

    /// Whether a rein is down, for however short a time.
    pub fn is_down(&self) -> bool {
        self.side.is_some()
    }

    fn is_held(&self) -> bool {
        self.side.is_some() && self.held_s >= HELD_AFTER_S
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heading(wants: &Wants) -> f32 {
        match wants.turn {
            Turn::Heading(heading) => heading.to_degrees(),
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn speed_goes_by_whole_miles_within_the_gait() {
        let mut wants = Wants::default();
        (0..100).for_each(|_| wants.take(Order::Faster, 0.0));
        assert_eq!(wants.speed_mph, 40.0);
        wants.take(Order::Gait(Some(Gait::Trot)), 0.0);
        assert_eq!(wants.speed_mph, 20.0);
        wants.take(Order::Speed(10.4), 0.0);
        wants.take(Order::Slower, 0.0);
        assert_eq!(wants.speed_mph, 0.0, "below the slowest trot it halts");
        wants.take(Order::Faster, 0.0);
        assert_eq!(wants.speed_mph, 10.0);
        wants.take(Order::Speed(f32::NAN), 0.0);
        assert_eq!(wants.speed_mph, 0.0);
        wants.take(Order::Gait(Some(Gait::Gallop)), 0.0);
        assert_eq!(wants.speed_mph, 0.0, "choosing a gait does not start a standing horse");
    }

    #[test]
    fn taps_add_up_to_less_than_half_round() {
        let mut wants = Wants::default();
        wants.take(Order::Tap(Side::Left), 0.0);
        wants.take(Order::Tap(Side::Left), 0.0);
        assert!((heading(&wants) - 30.0).abs() < 1e-3);
        (0..40).for_each(|_| wants.take(Order::Tap(Side::Right), 0.0));
        assert!((heading(&wants) + 165.0).abs() < 1e-3);
        wants.take(Order::Turn(Turn::Rate(0.3)), 0.0);
        wants.take(Order::Tap(Side::Left), 7.0 * PI / 180.0);
        assert!((heading(&wants) - 15.0).abs() < 1e-3, "{}", heading(&wants));
    }

    #[test]
    fn a_rein_is_held_after_a_moment_and_keeps_the_heading_when_let_go() {
        let mut rein = HeldRein::default();
        assert_eq!(rein.hold(Some(Side::Left), 0.1, 0.0), None);
        assert_eq!(rein.hold(Some(Side::Left), 0.1, 0.0), None);
        assert_eq!(rein.hold(Some(Side::Left), 0.25, 0.0), Some(Turn::Rate(HELD_RATE_RAD_S)));
        assert_eq!(rein.hold(None, 0.1, 0.5), Some(Turn::Heading(0.5)));
        assert_eq!(rein.hold(None, 0.1, 0.5), None);
    }

    #[test]
    fn leads_go_round() {
        let mut wants = Wants::default();
        let mut seen = Vec::new();
        for _ in 0..3 {
            wants.take(Order::NextLead, 0.0);
            seen.push(wants.lead);
        }
        assert_eq!(seen, [Some(Side::Left), Some(Side::Right), None]);
    }
}
