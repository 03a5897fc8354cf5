//! The four feet: where they stand, when they leave, and where in the air they are wanted.

use glam::{DVec2, DVec3, Vec2};
use serde::{Deserialize, Serialize};

use super::ground::Ground;
use super::leaping::Leaping;
use super::mixture::Timing;
use super::repertoire::Repertoire;
use super::retarget::smooth;
use super::stillness;
use super::terrain::height_m;
use super::track::Facing;
use super::warp::Warp;

/// Share of the swing by which a foot that steps up has risen to the new height; one that steps down keeps the old for as long.
const RISEN_BY: f32 = 0.6;
/// Share of the stance from which the body makes ready for the foot to leave.
const LEAVING_FROM: f32 = 0.3;
/// Share of the swing from which the body makes ready for the strike.
const HEEDED_FROM: f32 = 0.35;
/// Places at which a foot in the air feels for risers, ahead of it, metres of a reference horse.
const LOOKED_AHEAD: [f32; 4] = [-0.12, 0.08, 0.16, 0.24];
/// A riser so far away is nothing to it.
const LOOKED_AT_MOST_M: f32 = 0.32;
/// Height a foot is lifted to for a step on the spot, metres of a reference horse.
const SMALL_STEP_M: f32 = 0.07;
/// Height a foot keeps over the ground in the middle of its swing, metres of a reference horse: less than the database's strides do.
const CLEARANCE_M: f32 = 0.02;

/// One foot.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Foot {
    /// Where it stands, or stood last, world space, metres.
    pub(super) print: DVec3,
    /// Heading of the hoof there, rad.
    pub(super) heading_rad: f64,
    /// Angle at which the ground rises under it along the hoof, rad.
    pub(super) rise_rad: f32,
    pub(super) is_planted: bool,
    /// Generic time (Huang 2012, Eq. 3.5): strike 0, lift-off 0.5, next strike 1.
    pub(super) generic: f32,
    /// Generic time at which it left the ground: 0.5 but for a foot that had to leave early.
    left: f32,
    /// Whether it had to leave the ground in the last step, from where it was.
    is_lost: bool,
    /// From where the stride has a foot that leaves the ground to where it really stood, world x and z, metres.
    behind_m: Vec2,
}

/// What all feet need to know of the horse's way.
pub(super) struct Going<'a> {
    pub(super) at_m: DVec2,
    pub(super) heading_rad: f64,
    pub(super) facing: Facing,
    pub(super) timing: &'a Timing,
    /// Length of a stride, metres.
    pub(super) stride_m: f32,
    /// How much the horse stands, as its posture does, and what makes it so.
    pub(super) standing: f32,
    pub(super) stillness: f32,
    pub(super) is_halting: bool,
    /// What a stride gains in length, metres.
    pub(super) gain_m: f32,
    /// In a leap: the leap, what there is to leap with, and the clock.
    pub(super) leap: Option<(&'a Leaping, &'a Repertoire, &'a Warp)>,
    /// How much higher the body is than it will be when it lands, metres, and how much it heeds that it will.
    pub(super) falls_m: f32,
    pub(super) heeds: f32,
    /// Turn in a stride, rad.
    pub(super) turn_rad: f32,
    /// Rise over run under the horse, and horizontal over real distance there.
    pub(super) slope: f32,
    pub(super) level: f32,
    pub(super) size: f32,
}

/// One leg at this moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct LegNow {
    pub(super) limb: usize,
    /// Place in its cycle, `[0, 1)`.
    pub(super) cycle: f32,
    /// Cycles per stride of the clock.
    pub(super) pace: f32,
    /// Toe against the horse's place: ahead and over the ground, metres; to the right.
    pub(super) toe_m: [f32; 2],
    pub(super) lateral_m: f32,
    /// Where the toe of a standing horse is, ahead, metres.
    pub(super) standing_m: f32,
}

/// Where a toe is wanted.
#[derive(Clone, Copy, Debug)]
pub(super) struct Wanted {
    pub(super) toe: DVec3,
    pub(super) heading_rad: f64,
    /// 1 in stance and near it.
    pub(super) load: f32,
    pub(super) is_planted: bool,
    /// The place that the leg will have to reach next: its print as the horse will see it when the foot leaves, or the next one when
    /// it strikes.
    pub(super) bears_at: DVec3,
    /// How much the body makes ready for that, 0 to 1.
    pub(super) bears: f32,
}

impl Going<'_> {
    /// How far the horse goes in so many strides from now, metres.
    fn distance_m(&self, strides: f32) -> f32 {
        if let Some((leaping, repertoire, warp)) = self.leap {
            return self.timing.speed_m_s * leaping.time_s(repertoire, warp, strides, self.timing.rate_hz);
        }
        if self.stillness == 0.0 && !self.is_halting {
            return self.stride_m * strides + 0.5 * self.gain_m * strides * strides.abs();
        }
        self.stride_m * stillness::stride_lengths(self.stillness, self.is_halting, strides)
    }

    /// Place, turn (rad) and direction so many strides from now.
    fn after(&self, strides: f32) -> (DVec2, f32, Facing) {
        let turned_rad = self.turn_rad * strides;
        let way = self.facing.turned(0.5 * turned_rad).ahead;
        let at_m = self.at_m + way * f64::from(self.distance_m(strides) * self.level);
        (at_m, turned_rad, self.facing.turned(turned_rad))
    }

    /// How much the horse stands so many strides from now, by what it is asked for.
    fn standing_after(&self, strides: f32) -> f32 {
        if self.stillness == 0.0 && !self.is_halting {
            return 0.0;
        }
        smooth(stillness::after(self.stillness, self.is_halting, strides))
    }

    /// Where a leg's toe is now by the stride alone.
    pub(super) fn own_place(&self, leg: &LegNow) -> DVec2 {
        self.facing.beside(self.at_m, Vec2::new(leg.toe_m[0] * self.level, leg.lateral_m))
    }

    /// The leg's next print, or the one it makes now, with the turn to the hoof's heading there, rad: where the toe stands at the middle
    /// of a stance that begins in so many strides (negative: began before).
    fn next_print(&self, leg: &LegNow, strides: f32) -> (DVec2, f32) {
        let middle = strides + 0.5 * self.timing.duties[leg.limb] / leg.pace;
        let (at, turned_rad, facing) = self.after(middle);
        let ahead = self.timing.prints_m[leg.limb];
        let ahead = ahead + self.standing_after(middle) * (leg.standing_m - ahead);
        (facing.beside(at, Vec2::new(ahead * self.level, leg.lateral_m)), turned_rad)
    }

    /// Where the stride alone would bring the toe at its strike, and how far the horse has gone by then, world x and z, metres.
    fn own_strike(&self, leg: &LegNow, strides: f32) -> (DVec2, DVec2) {
        let (at, _, facing) = self.after(strides);
        let ahead = self.timing.prints_m[leg.limb] + 0.5 * self.timing.own_steps_m[leg.limb];
        let ahead = ahead + self.standing_after(strides) * (leg.standing_m - ahead);
        (facing.beside(at, Vec2::new(ahead * self.level, leg.lateral_m)), at - self.at_m)
    }

    /// How far a planted foot is from where it would stand when the horse has come to rest, metres.
    pub(super) fn misplaced_m(&self, foot: &Foot, leg: &LegNow) -> f32 {
        let (at, _, facing) = self.after(stillness::HALT_STRIDES);
        let place = facing.beside(at, Vec2::new(leg.standing_m * self.level, leg.lateral_m));
        place.distance(DVec2::new(foot.print.x, foot.print.z)) as f32
    }
}

/// Generic time of a place in the cycle.
pub(super) fn generic_time(cycle: f32, duty: f32) -> f32 {
    if cycle < duty { 0.5 * cycle / duty } else { 0.5 + 0.5 * (cycle - duty) / (1.0 - duty) }
}

impl Foot {
    /// A foot on the ground.
    pub(super) fn standing(print: DVec3, heading_rad: f64, ground: &impl Ground) -> Self {
        let rise_rad = ground.surface(print.x as f32, print.z as f32).rise_rad(heading_rad);
        Self { print, heading_rad, rise_rad, is_planted: true, ..Self::default() }
    }

    /// Takes the foot to its place in the cycle: it may leave the ground, or strike. `may_leave` is asked when it would leave.
    pub(super) fn advance(
        &mut self,
        leg: &LegNow,
        going: &Going<'_>,
        ground: &impl Ground,
        may_leave: impl FnOnce(&Self) -> bool,
    ) {
        if std::mem::take(&mut self.is_lost) {
            let left = self.left;
            self.leave(leg, going);
            self.left = left;
        }
        let before = self.generic;
        self.generic = generic_time(leg.cycle, going.timing.duties[leg.limb]);
        let is_round = self.generic + 0.5 < before;
        if self.is_planted {
            if before < 0.5 && (self.generic >= 0.5 || is_round) && may_leave(self) {
                self.leave(leg, going);
            }
        } else if is_round {
            let (at, turned_rad) = going.next_print(leg, -leg.cycle / leg.pace);
            let heading_rad = going.heading_rad + f64::from(turned_rad);
            let height = height_m(ground, at).map_or(self.print.y, f64::from);
            self.print = DVec3::new(at.x, height, at.y);
            (self.heading_rad, self.is_planted) = (heading_rad, true);
            self.rise_rad = ground.surface(at.x as f32, at.y as f32).rise_rad(heading_rad);
        }
    }

    /// Leaves the ground.
    pub(super) fn leave(&mut self, leg: &LegNow, going: &Going<'_>) {
        let stood = DVec2::new(self.print.x, self.print.z);
        self.behind_m = (stood - going.own_place(leg)).as_vec2();
        (self.is_planted, self.left) = (false, 0.5);
    }

    /// Leaves the ground at once, because the leg cannot reach its print any more.
    pub(super) fn lose(&mut self) {
        if self.is_planted {
            (self.is_planted, self.is_lost, self.left) = (false, true, self.generic.min(0.5));
        }
    }

    /// Where the toe is wanted now.
    pub(super) fn wanted(&self, leg: &LegNow, going: &Going<'_>, ground: &impl Ground) -> Wanted {
        if self.is_planted {
            return self.wanted_planted(leg, going);
        }
        let heading_rad = self.heading_rad;
        let share = ((self.generic - self.left) / (1.0 - self.left)).max(0.0);
        let late = smooth(share);
        let strides = (1.0 - leg.cycle) / leg.pace;
        let (next, turned_rad) = going.next_print(leg, strides);
        let (own_strike, gone_m) = going.own_strike(leg, strides);
        let at = going.own_place(leg)
            + (self.behind_m * (1.0 - late)).as_dvec2()
            + (next - own_strike) * f64::from(late);
        let next_height = height_m(ground, next).unwrap_or(self.print.y as f32);
        let height = self.swing_height_m(leg, going, ground, [at, next], [share, next_height]);
        // As the horse will see it: from where it will be, and as high.
        let seen = next - gone_m;
        let risen_m = going.slope * gone_m.dot(going.facing.ahead) as f32 - going.falls_m;
        let turn = going.heading_rad + f64::from(turned_rad) - heading_rad;
        Wanted {
            is_planted: false,
            toe: DVec3::new(at.x, f64::from(height), at.y),
            heading_rad: heading_rad + turn * f64::from(late),
            load: 1.0 - smooth(share.min(1.0 - share) / super::retarget::EASING),
            bears_at: DVec3::new(seen.x, f64::from(next_height - risen_m), seen.y),
            bears: going.heeds * smooth((share - HEEDED_FROM) / (1.0 - HEEDED_FROM)),
        }
    }

    fn wanted_planted(&self, leg: &LegNow, going: &Going<'_>) -> Wanted {
        let duty = going.timing.duties[leg.limb];
        let strides = ((duty - leg.cycle) / leg.pace).max(0.0);
        let gone_m = going.after(strides).0 - going.at_m;
        let risen_m = f64::from(going.slope) * gone_m.dot(going.facing.ahead);
        let seen = self.print - DVec3::new(gone_m.x, risen_m, gone_m.y);
        let through = (leg.cycle / duty - LEAVING_FROM) / (1.0 - LEAVING_FROM);
        Wanted {
            is_planted: true,
            toe: self.print,
            heading_rad: self.heading_rad,
            load: 1.0,
            bears_at: seen,
            bears: going.heeds * smooth(through) * (1.0 - going.standing),
        }
    }

    /// Height of the toe in the air over the world's zero, metres: the stride's own over a line from print to print, which follows a
    /// slope evenly and a step early or late.
    fn swing_height_m(
        &self,
        leg: &LegNow,
        going: &Going<'_>,
        ground: &impl Ground,
        [at, next]: [DVec2; 2],
        [share, next_height]: [f32; 2],
    ) -> f32 {
        let from = self.print.y as f32;
        let stood = DVec2::new(self.print.x, self.print.z);
        let on_slope = going.slope * (next - stood).dot(going.facing.ahead) as f32;
        let step = next_height - from - on_slope;
        let risen = if step > 0.0 { share / RISEN_BY } else { (share - 1.0) / RISEN_BY + 1.0 };
        let base = from + on_slope * smooth(share) + step * smooth(risen);
        let arc = 4.0 * share * (1.0 - share);
        let early = 1.0 - 2.0 * self.left;
        let least = going.standing.max(early) * SMALL_STEP_M * going.size * arc * arc;
        let path = base + leg.toe_m[1].max(least);
        let here = height_m(ground, at).unwrap_or(base) + CLEARANCE_M * going.size * arc * arc;
        // A riser is seen before the toe is over it, and left behind as gently.
        let mut height = path.max(here);
        for step in LOOKED_AHEAD {
            let place = at + going.facing.ahead * f64::from(step * going.size);
            let there = height_m(ground, place).unwrap_or(base);
            let nearness = (1.0 - (step / LOOKED_AT_MOST_M).abs()) * smooth(2.0 * arc);
            height = height.max(path + (there - path) * nearness);
        }
        height
    }
}
