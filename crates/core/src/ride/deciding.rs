//! What the horse makes of a command: gait, lead and speed (spec 3.1, 6.1).

use super::command::Command;
use super::gait_choice::Choice;
use super::leaping::Stage;
use super::repertoire::Repertoire;
use super::state::HorseState;
use super::warp::CHANGE_STRIDES;
use crate::gait::Gait;
use crate::limb::Side;

/// Wanted speeds below this share of the slowest walk mean to halt.
const HALT_SHARE: f32 = 0.5;
/// The walk from which a horse halts and into which it sets out, miles per hour of a reference horse: a slower one takes seconds.
const HALTING_MPH: f32 = 2.5;
/// Strides of a change of lead.
const LEAD_STRIDES: f32 = 1.5;
/// A turn at this rate asks for the lead on its side, rad/s.
const LEADING_TURN_RAD_S: f32 = 0.12;

impl HorseState {
    /// Chooses gait and lead; returns the speed to go at, m/s.
    pub(super) fn decide(&mut self, repertoire: &Repertoire, command: &Command) -> f32 {
        self.leaping.ask(command.leap, repertoire.size);
        let [slowest, _] = repertoire.playable_m_s(Gait::Walk);
        let [_, fastest] = repertoire.playable_m_s(Gait::Gallop);
        let asked_m_s = if command.speed_m_s.is_nan() { 0.0 } else { command.speed_m_s.clamp(0.0, fastest) };
        let mph = repertoire.equivalent_mph(asked_m_s);
        let random = &mut self.random;
        self.choice = match command.gait.filter(|gait| *gait != Gait::Leap) {
            Some(gait) => Choice::of(gait),
            None => self.choice.at(mph, || random.uniform() as f32),
        };
        let halts = asked_m_s < HALT_SHARE * slowest;
        let halting_m_s = repertoire.speed_m_s(HALTING_MPH);
        self.is_halting = halts && self.leaping.stage == Stage::None;
        // From a stand a horse walks off before it does anything else.
        let (gait, asked_m_s) = match self.leaping.approach(repertoire, self.warp.to.gait) {
            _ if self.is_halting => (Gait::Walk, halting_m_s),
            _ if self.stillness > 0.0 => (Gait::Walk, asked_m_s.max(halting_m_s)),
            Some(approach) => approach,
            None if halts => (Gait::Walk, halting_m_s),
            None => (self.choice.gait, asked_m_s),
        };
        self.seek(repertoire, gait, command.lead);
        let [least, most] = repertoire.playable_m_s(gait);
        asked_m_s.clamp(least, most)
    }

    /// Begins a change of gait or of lead where one is wanted.
    fn seek(&mut self, repertoire: &Repertoire, gait: Gait, lead: Option<Side>) {
        let turn = self.track.turn_rate_rad_s;
        let inside = if turn > 0.0 { Side::Left } else { Side::Right };
        let by_turn = (turn.abs() > LEADING_TURN_RAD_S).then_some(inside);
        let lead = lead.or(by_turn).unwrap_or(self.lead);
        let to = repertoire.way(gait, lead);
        self.leaping.advance(repertoire, &mut self.warp, &mut self.wished_m_s);
        if self.leaping.is_under_way() {
            return;
        }
        // A change of lead waits until the leading foreleg leaves the ground: the suspension, or what there is of it, begins.
        let is_leading_up = self.has_left[usize::from(self.lead == Side::Right)];
        if gait != self.warp.to.gait {
            self.lead = lead;
            self.warp.begin(repertoire, to, CHANGE_STRIDES);
        } else if to != self.warp.to && self.warp.is_steady() && is_leading_up {
            self.lead = lead;
            self.warp.begin(repertoire, to, LEAD_STRIDES);
        }
    }
}
