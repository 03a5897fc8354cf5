//! The feet of the whole horse: where each leg is, which feet leave and which strike.

use super::clip::{LegRow, leg};
use super::feet::{Foot, Going, LegNow};
use super::ground::Ground;
use super::mixture::Timing;
use super::repertoire::Repertoire;
use super::retarget::smooth;
use super::state::HorseState;
use super::stillness;
use super::track::Facing;

impl HorseState {
    /// What the feet need to know of the horse's way.
    pub(super) fn going<'a>(&'a self, repertoire: &'a Repertoire, timing: &'a Timing) -> Going<'a> {
        let trunk_m = repertoire.rig.trunk_m;
        Going {
            at_m: self.track.at_m,
            heading_rad: self.track.heading_rad,
            facing: Facing::new(self.track.heading_rad),
            timing,
            stride_m: timing.stride_m(),
            standing: smooth(self.stillness),
            stillness: self.stillness,
            is_halting: self.is_halting,
            gain_m: self.gain_m,
            leap: self.leaping.leads_feet().then_some((&self.leaping, repertoire, &self.warp)),
            falls_m: self.leaping.falls_m(repertoire, &self.warp),
            heeds: self.leaping.heeds(),
            turn_rad: self.track.turn_rate_rad_s / timing.rate_hz,
            slope: self.terrain.slope(trunk_m),
            level: self.terrain.level(trunk_m),
            size: repertoire.size,
        }
    }

    /// What every leg does now: its place in its cycle, and where the rows of its posture have the toe.
    pub(super) fn legs_now(
        &self,
        repertoire: &Repertoire,
        rows: &[LegRow; 4],
        timing: &Timing,
        cycles: &[f32; 4],
    ) -> [LegNow; 4] {
        let step_share = self.terrain.step_share(repertoire.rig.trunk_m);
        let (paces, standing) = (self.warp.paces(), smooth(self.stillness));
        std::array::from_fn(|limb| {
            let (print, still) = (timing.prints_m[limb], repertoire.standing_toes_m[limb]);
            let ahead = print + step_share * (rows[limb][leg::TOE_AHEAD] - print);
            LegNow {
                limb,
                cycle: cycles[limb],
                pace: paces[limb],
                toe_m: [ahead + standing * (still - ahead), rows[limb][leg::TOE_HEIGHT] * (1.0 - standing)],
                lateral_m: repertoire.rig.legs[limb].toe_lateral_m,
                standing_m: still,
            }
        })
    }

    /// Takes every foot to its place in its cycle. A horse that comes to a stand leaves feet where they are that stand well.
    pub(super) fn stepped(
        &self,
        legs: &[LegNow; 4],
        going: &Going<'_>,
        ground: &impl Ground,
    ) -> ([Foot; 4], bool) {
        let mut feet = self.feet;
        let comes_to_stand = self.stillness > 0.5 && self.is_halting;
        let tolerance_m = stillness::MISPLACED_M * going.size;
        let mut has_to_step = false;
        for leg in legs {
            let foot = &mut feet[leg.limb];
            foot.advance(leg, going, ground, |foot| {
                !comes_to_stand || going.misplaced_m(foot, leg) > tolerance_m
            });
            has_to_step |= comes_to_stand && (!foot.is_planted || going.misplaced_m(foot, leg) > tolerance_m);
        }
        (feet, has_to_step)
    }
}
