//! The four feet: where they stand, when they leave, and where in the air they are wanted.

use glam::{DVec2, DVec3, Vec2};
use serde::{Deserialize, Serialize};

use super::ground::Ground;
use super::mixture::Timing;
use super::retarget::smooth;
use super::terrain::height_m;
use super::track::{Track, beside};

/// Share of the swing by which a foot that steps up has risen to the new height; one that steps down keeps the old for as long.
const RISEN_BY: f32 = 0.6;
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
    pub(super) is_planted: bool,
    /// Generic time (Huang 2012, Eq. 3.5): strike 0, lift-off 0.5, next strike 1.
    pub(super) generic: f32,
    /// Generic time at which it left the ground: 0.5 but for a foot that had to leave early.
    left: f32,
    /// From where the stride has a foot that leaves the ground to where it really stood, world x and z, metres.
    behind_m: Vec2,
}

/// What all feet need to know of the horse's way.
pub(super) struct Going<'a> {
    pub(super) track: &'a Track,
    pub(super) timing: &'a Timing,
    /// How far the horse goes in so many strides from now, metres.
    pub(super) distance_m: &'a dyn Fn(f32) -> f32,
    /// How much the horse stands, 0 to 1, so many strides from now.
    pub(super) standing: &'a dyn Fn(f32) -> f32,
    /// Turn in a stride, rad.
    pub(super) turn_rad: f32,
    /// Horizontal over real distance on a slope.
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
}

impl Going<'_> {
    /// Place and heading so many strides from now.
    fn after(&self, strides: f32) -> (DVec2, f64) {
        self.track.after((self.distance_m)(strides) * self.level, self.turn_rad * strides)
    }

    /// Where a leg's toe is now by the stride alone.
    pub(super) fn own_place(&self, leg: &LegNow) -> DVec2 {
        let ahead_right = Vec2::new(leg.toe_m[0] * self.level, leg.lateral_m);
        beside(self.track.at_m, self.track.heading_rad, ahead_right)
    }

    /// The leg's next print, or the one it makes now, with the hoof's heading, `strides` before the strike (negative after it): where
    /// the toe stands at the middle of the stance to come.
    fn next_print(&self, leg: &LegNow, strides: f32) -> (DVec2, f64) {
        let middle = strides + 0.5 * self.timing.duties[leg.limb] / leg.pace;
        let (at, heading) = self.after(middle);
        let standing = (self.standing)(middle);
        let ahead = self.timing.prints_m[leg.limb];
        let ahead = ahead + standing * (leg.standing_m - ahead);
        (beside(at, heading, Vec2::new(ahead * self.level, leg.lateral_m)), heading)
    }

    /// Where the stride alone would bring the toe at its strike.
    fn own_strike(&self, leg: &LegNow, strides: f32) -> DVec2 {
        let (at, heading) = self.after(strides);
        let standing = (self.standing)(strides);
        let ahead = self.timing.prints_m[leg.limb] + 0.5 * self.timing.steps_m[leg.limb];
        let ahead = ahead + standing * (leg.standing_m - ahead);
        beside(at, heading, Vec2::new(ahead * self.level, leg.lateral_m))
    }

    /// How far a planted foot is from where it would stand when the horse has come to rest, metres.
    pub(super) fn misplaced_m(&self, foot: &Foot, leg: &LegNow) -> f32 {
        let (at, heading) = self.after(1e3);
        let place = beside(at, heading, Vec2::new(leg.standing_m * self.level, leg.lateral_m));
        place.distance(DVec2::new(foot.print.x, foot.print.z)) as f32
    }
}

/// Generic time of a place in the cycle.
pub(super) fn generic_time(cycle: f32, duty: f32) -> f32 {
    if cycle < duty { 0.5 * cycle / duty } else { 0.5 + 0.5 * (cycle - duty) / (1.0 - duty) }
}

impl Foot {
    /// A foot on the ground.
    pub(super) fn standing(print: DVec3, heading_rad: f64) -> Self {
        Self { print, heading_rad, is_planted: true, ..Self::default() }
    }

    /// Takes the foot to its place in the cycle: it may leave the ground, or strike. `may_leave` is asked when it would leave.
    pub(super) fn advance(
        &mut self,
        leg: &LegNow,
        going: &Going<'_>,
        ground: &impl Ground,
        may_leave: impl FnOnce(&Self) -> bool,
    ) {
        let before = self.generic;
        self.generic = generic_time(leg.cycle, going.timing.duties[leg.limb]);
        let is_round = self.generic + 0.5 < before;
        if self.is_planted {
            if before < 0.5 && (self.generic >= 0.5 || is_round) && may_leave(self) {
                self.leave(leg, going);
            }
        } else if is_round {
            let (at, heading_rad) = going.next_print(leg, -leg.cycle / leg.pace);
            let height = height_m(ground, at).map_or(self.print.y, f64::from);
            self.print = DVec3::new(at.x, height, at.y);
            (self.heading_rad, self.is_planted) = (heading_rad, true);
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
            (self.is_planted, self.left) = (false, self.generic.min(0.5));
        }
    }

    /// Where the toe is wanted now.
    pub(super) fn wanted(
        &self,
        leg: &LegNow,
        going: &Going<'_>,
        ground: &impl Ground,
        standing: f32,
    ) -> Wanted {
        if self.is_planted {
            return Wanted { toe: self.print, heading_rad: self.heading_rad, load: 1.0 };
        }
        let share = ((self.generic - self.left) / (1.0 - self.left)).max(0.0);
        let strides = (1.0 - leg.cycle) / leg.pace;
        let (next, next_heading) = going.next_print(leg, strides);
        let late = smooth(share);
        let ahead_m = next - going.own_strike(leg, strides);
        let at = going.own_place(leg) + (self.behind_m * (1.0 - late)).as_dvec2() + ahead_m * f64::from(late);
        let from = self.print.y as f32;
        let to = height_m(ground, next).unwrap_or(from);
        let step = if to > from { share / RISEN_BY } else { (share - 1.0) / RISEN_BY + 1.0 };
        let base = from + (to - from) * smooth(step);
        let arc = 4.0 * share * (1.0 - share);
        let early = 1.0 - 2.0 * self.left;
        let least = standing.max(early) * SMALL_STEP_M * going.size * arc * arc;
        let path = base + leg.toe_m[1].max(least);
        let over = height_m(ground, at).unwrap_or(base) + CLEARANCE_M * going.size * arc * arc;
        let height = path.max(over);
        let turned = (next_heading - self.heading_rad) * f64::from(late);
        Wanted {
            toe: DVec3::new(at.x, f64::from(height), at.y),
            heading_rad: self.heading_rad + turned,
            load: 1.0 - smooth(share.min(1.0 - share) / super::retarget::EASING),
        }
    }
}
