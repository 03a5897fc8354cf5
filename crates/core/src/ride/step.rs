//! One step: how far the clock goes, and the horse with it.

use super::command::Command;
use super::feet::{Foot, generic_time};
use super::ground::Ground;
use super::repertoire::{Repertoire, Way};
use super::state::HorseState;
use super::stillness;
use super::track::{Facing, Track, lagged};
use crate::gait::Gait;

/// Acceleration and deceleration within a gait, m/s^2: brisk, but no racehorse's start. During a change the gaits decide.
const ACCELERATION_M_S2: [f32; 2] = [3.0, 4.0];
/// A horse turns no farther than this in a stride, rad: a foot stands for more than half of a slow one, and the body turns over it.
const MOST_TURNED_RAD: f32 = 0.6;
/// A stride's length gains or loses at most this share of it in a stride, as far as the next prints are concerned.
const MOST_GAIN: f32 = 0.7;
/// Strides over which that gain is averaged.
const GAIN_STRIDES: f32 = 0.05;

impl HorseState {
    /// Moves on by a part of a step.
    pub(super) fn advance(
        &mut self,
        repertoire: &Repertoire,
        command: &Command,
        dt_s: f32,
        ground: &impl Ground,
    ) {
        let wanted_m_s = self.decide(repertoire, command);
        self.pace(repertoire, wanted_m_s, dt_s);
        let (trunk_m, size) = (repertoire.rig.trunk_m, repertoire.size);
        let forward_m_s = self.speed_m_s * self.terrain.level(trunk_m);
        let most = Track::most_rad_s(self.speed_m_s, size).min(MOST_TURNED_RAD * self.timing.rate_hz);
        let flies = self.leaping.flies(repertoire, &self.warp);
        let sought = if flies { 0.0 } else { self.track.sought_rad_s(command.turn, most) };
        self.track.advance(forward_m_s, self.speed_m_s, sought, trunk_m, dt_s);
        self.terrain.advance(&self.track, forward_m_s * dt_s, trunk_m, size, ground, dt_s);
        self.warp.advance(repertoire, self.rate_hz * dt_s);
        self.pose_now(repertoire, ground, dt_s);
    }

    /// Finds the pace of the clock and the speed of the body.
    fn pace(&mut self, repertoire: &Repertoire, wanted_m_s: f32, dt_s: f32) {
        let [up, down] = ACCELERATION_M_S2.map(|a| a * dt_s);
        let wanted_m_s = if self.leaping.is_under_way() { self.wished_m_s } else { wanted_m_s };
        self.wished_m_s += (wanted_m_s - self.wished_m_s).clamp(-down, up);
        if self.warp.is_steady() && self.warp.to.gait != Gait::Leap {
            let [least, most] = repertoire.playable_m_s(self.warp.to.gait);
            self.wished_m_s = self.wished_m_s.clamp(least, most);
        }
        let walks = self.warp.is_steady() && self.warp.to == Way::of(Gait::Walk);
        let may_halt = self.is_halting && walks && self.wished_m_s <= wanted_m_s;
        if self.stillness >= 1.0 && !self.is_halting && self.feet.iter().all(|foot| foot.is_planted) {
            self.set_out();
        }
        if may_halt || self.stillness > 0.0 {
            self.stillness = stillness::after(self.stillness, may_halt, self.timing.rate_hz * dt_s);
        }
        self.speed_m_s = self.timing.speed_m_s * stillness::going(self.stillness);
        let rests = self.stillness >= 1.0 && !self.is_stepping;
        let rate_hz = self.leaping.rate_hz(repertoire, &self.warp, self.timing.rate_hz, dt_s);
        self.rate_hz = if rests { 0.0 } else { rate_hz };
    }

    /// Notes what the stride's length gains, so that the next prints are where the horse will be.
    pub(super) fn lengthen(&mut self, before_m: f32, dt_s: f32) {
        let (stride_m, strides) = (self.timing.stride_m(), self.timing.rate_hz * dt_s);
        if before_m > 0.0 && strides > 0.0 {
            let most_m = MOST_GAIN * stride_m;
            let gain_m = ((stride_m - before_m) / strides).clamp(-most_m, most_m);
            self.gain_m += (gain_m - self.gain_m) * lagged(strides, GAIN_STRIDES);
        }
    }

    /// Sets the clock so that a hind leg leaves the ground next: the one that stands farther behind.
    fn set_out(&mut self) {
        let forward = Facing::new(self.track.heading_rad).ahead;
        let ahead = |foot: &Foot| foot.print.x * forward.x + foot.print.z * forward.y;
        let hind = if ahead(&self.feet[3]) < ahead(&self.feet[2]) { 3 } else { 2 };
        let duties = self.timing.duties;
        self.warp.set_cycle(hind, duties[hind] - 1e-3);
        let cycles = self.warp.cycles();
        for limb in 0..4 {
            self.feet[limb].generic = generic_time(cycles[limb], duties[limb]);
        }
    }
}
