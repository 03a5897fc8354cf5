//! One step: what is wanted, how far the clock goes, where the feet are to be, and the body over them.

use super::command::Command;
use super::feet::{Foot, Going, LegNow};
use super::ground::Ground;
use super::horse::Horse;
use super::leaping::Stage;
use super::mixture::Mixture;
use super::repertoire::Way;
use super::stillness;
use super::track::Track;
use super::warp::CHANGE_STRIDES;
use crate::gait::Gait;
use crate::limb::Side;

/// Acceleration and deceleration within a gait, m/s^2: brisk, but no racehorse's start. During a change the gaits decide.
const ACCELERATION_M_S2: [f32; 2] = [3.0, 4.0];
/// Wanted speeds below this share of the slowest walk mean to halt.
const HALT_SHARE: f32 = 0.5;
/// The walk from which a horse halts and into which it sets out, miles per hour of a reference horse: a slower one takes seconds.
const HALTING_MPH: f32 = 2.5;
/// Strides of a change of lead.
const LEAD_STRIDES: f32 = 1.5;
/// A turn at this rate asks for the lead on its side, rad/s.
const LEADING_TURN_RAD_S: f32 = 0.12;

impl Horse {
    pub(super) fn mixture(&self) -> Mixture<'_> {
        Mixture::new(&self.repertoire, &self.state.warp.weights, self.state.speeds_m_s(), self.step_share())
    }

    fn step_share(&self) -> f32 {
        self.state.terrain.step_share(self.repertoire.rig.trunk_m)
    }

    pub(super) fn is_halting_or_still(&self) -> bool {
        self.state.is_halting
    }

    /// Whether it stands with every foot in its place.
    pub(super) fn is_at_rest(&self) -> bool {
        self.state.stillness >= 1.0 && self.state.rate_hz == 0.0
    }

    /// Moves on by a part of a step.
    pub(super) fn advance(&mut self, command: &Command, dt_s: f32, ground: &impl Ground) {
        self.state.leaping.ask(command.leap, self.repertoire.size);
        let wanted_m_s = self.decide(command);
        self.pace(wanted_m_s, dt_s);
        let (repertoire, state) = (&*self.repertoire, &mut self.state);
        let trunk_m = repertoire.rig.trunk_m;
        let level = 1.0 / state.terrain.slope(trunk_m).hypot(1.0);
        let forward_m_s = state.speed_m_s * level;
        let most = Track::most_rad_s(state.speed_m_s, repertoire.size);
        let flies = state.leaping.flies(repertoire, &state.warp);
        let sought = if flies { 0.0 } else { state.track.sought_rad_s(command.turn, most) };
        state.track.advance(forward_m_s, state.speed_m_s, sought, trunk_m, dt_s);
        state.terrain.advance(&state.track, forward_m_s * dt_s, trunk_m, repertoire.size, ground, dt_s);
        state.warp.advance(repertoire, state.rate_hz * dt_s);
        self.pose_now(ground, dt_s);
    }

    /// Chooses gait and lead; returns the speed to go at, m/s.
    fn decide(&mut self, command: &Command) -> f32 {
        let repertoire = &*self.repertoire;
        let state = &mut self.state;
        let [slowest, _] = repertoire.playable_m_s(Gait::Walk);
        let [_, fastest] = repertoire.playable_m_s(Gait::Gallop);
        let asked_m_s = if command.speed_m_s.is_nan() { 0.0 } else { command.speed_m_s.clamp(0.0, fastest) };
        let halts = asked_m_s < HALT_SHARE * slowest;
        let halting_m_s = repertoire.speed_m_s(HALTING_MPH);
        let gait = command.gait.filter(|gait| *gait != Gait::Leap);
        let mph = repertoire.equivalent_mph(asked_m_s);
        let random = &mut state.random;
        state.choice = match gait {
            Some(gait) => super::gait_choice::Choice::of(gait),
            None => state.choice.at(mph, || random.uniform() as f32),
        };
        let approach = state.leaping.approach(repertoire);
        state.is_halting = halts && state.leaping.stage == Stage::None;
        // From a stand a horse walks off before it does anything else.
        let (gait, asked_m_s) = match approach {
            _ if state.is_halting => (Gait::Walk, halting_m_s),
            _ if state.stillness > 0.0 => (Gait::Walk, asked_m_s.max(halting_m_s)),
            Some(approach) => approach,
            None if halts => (Gait::Walk, halting_m_s),
            None => (state.choice.gait, asked_m_s),
        };
        self.seek(gait, command);
        let [least, most] = self.repertoire.playable_m_s(gait);
        asked_m_s.clamp(least, most)
    }

    /// Begins a change of gait or of lead where one is wanted.
    fn seek(&mut self, gait: Gait, command: &Command) {
        let (repertoire, state) = (&*self.repertoire, &mut self.state);
        let turn = state.track.turn_rate_rad_s;
        let by_turn =
            (turn.abs() > LEADING_TURN_RAD_S).then_some(if turn > 0.0 { Side::Left } else { Side::Right });
        let lead = command.lead.or(by_turn).unwrap_or(state.lead);
        let to = repertoire.way(gait, lead);
        state.leaping.advance(repertoire, &mut state.warp, state.wished_m_s, to);
        if state.leaping.is_under_way() {
            return;
        }
        if gait != state.warp.to.gait {
            state.lead = lead;
            state.warp.begin(repertoire, to, CHANGE_STRIDES);
        } else if to != state.warp.to && state.warp.is_steady() {
            // The leading foreleg leaves the ground: the suspension, or what there is of it, begins.
            let leading = state.lead;
            let fore = usize::from(leading == Side::Right);
            if state.has_left[fore] {
                state.lead = lead;
                state.warp.begin(repertoire, to, LEAD_STRIDES);
            }
        }
    }

    /// Finds the pace of the clock and the speed of the body.
    fn pace(&mut self, wanted_m_s: f32, dt_s: f32) {
        let step_share = self.step_share();
        let (repertoire, state) = (&*self.repertoire, &mut self.state);
        let [up, down] = ACCELERATION_M_S2.map(|a| a * dt_s);
        let wanted_m_s = if state.leaping.is_under_way() { state.wished_m_s } else { wanted_m_s };
        state.wished_m_s += (wanted_m_s - state.wished_m_s).clamp(-down, up);
        if state.warp.is_steady() && state.warp.to.gait != Gait::Leap {
            let [least, most] = repertoire.playable_m_s(state.warp.to.gait);
            state.wished_m_s = state.wished_m_s.clamp(least, most);
        }
        let walks = state.warp.is_steady() && state.warp.to == Way::of(Gait::Walk);
        let may_halt = state.is_halting && walks && state.wished_m_s <= wanted_m_s;
        let timing = Mixture::new(repertoire, &state.warp.weights, state.speeds_m_s(), step_share).timing;
        if state.stillness >= 1.0 && !state.is_halting && state.feet.iter().all(|foot| foot.is_planted) {
            state.set_out(timing.duties);
        }
        if may_halt || state.stillness > 0.0 {
            let strides = timing.rate_hz * dt_s;
            state.stillness = stillness::after(state.stillness, may_halt, strides);
        }
        state.speed_m_s = timing.speed_m_s * stillness::going(state.stillness);
        let rate_hz = state.leaping.rate_hz(repertoire, &state.warp, timing.rate_hz, dt_s);
        let rests = state.stillness >= 1.0 && !state.is_stepping;
        state.rate_hz = if rests { 0.0 } else { rate_hz };
    }
}

impl super::state::HorseState {
    /// Sets the clock so that a hind leg leaves the ground next: the one that stands farther behind.
    fn set_out(&mut self, duties: [f32; 4]) {
        let forward = super::track::ahead(self.track.heading_rad);
        let ahead = |foot: &Foot| foot.print.x * forward.x + foot.print.z * forward.y;
        let hind = if ahead(&self.feet[3]) < ahead(&self.feet[2]) { 3 } else { 2 };
        self.warp.set_cycle(hind, duties[hind] - 1e-3);
        let cycles = self.warp.cycles();
        for limb in 0..4 {
            self.feet[limb].generic = super::feet::generic_time(cycles[limb], duties[limb]);
        }
    }
}

impl Horse {
    /// What every leg does now: the rows of its posture and its place in its cycle.
    pub(super) fn legs_now(
        &self,
        rows: &[super::clip::LegRow; 4],
        prints_m: &[f32; 4],
        standing: f32,
    ) -> [LegNow; 4] {
        let step_share = self.step_share();
        let (cycles, paces) = (self.state.warp.cycles(), self.state.warp.paces());
        std::array::from_fn(|limb| {
            let [ahead, height] =
                [rows[limb][super::clip::leg::TOE_AHEAD], rows[limb][super::clip::leg::TOE_HEIGHT]];
            let ahead = prints_m[limb] + step_share * (ahead - prints_m[limb]);
            let still = self.repertoire.standing_toes_m[limb];
            LegNow {
                limb,
                cycle: cycles[limb],
                pace: paces[limb],
                toe_m: [ahead + standing * (still - ahead), height * (1.0 - standing)],
                lateral_m: self.repertoire.rig.legs[limb].toe_lateral_m,
                standing_m: still,
            }
        })
    }

    /// Takes every foot to its place in its cycle.
    pub(super) fn advance_feet(
        &mut self,
        legs: &[LegNow; 4],
        mut feet: [Foot; 4],
        going: &Going<'_>,
        ground: &impl Ground,
    ) -> [Foot; 4] {
        let still = self.state.stillness > 0.5 && self.state.is_halting;
        let tolerance_m = stillness::MISPLACED_M * self.repertoire.size;
        let mut left = [false; 4];
        for leg in legs {
            let foot = &mut feet[leg.limb];
            let stood = foot.is_planted;
            foot.advance(leg, going, ground, |foot| !still || going.misplaced_m(foot, leg) > tolerance_m);
            left[leg.limb] = stood && !foot.is_planted;
        }
        self.state.has_left = left;
        self.state.is_stepping = still
            && legs.iter().any(|leg| {
                let foot = &feet[leg.limb];
                !foot.is_planted || going.misplaced_m(foot, leg) > tolerance_m
            });
        feet
    }
}
