//! A foot in the air.
//!
//! The toe goes from where it left one print to where it meets the next one, at rest at both ends; the foot turns about one axis; the
//! leg is retracted on the way. A foot that is long in the air (the other one hops) or has no print before or after hangs below its
//! hip, folded.

use std::f64::consts::PI;

use glam::{DQuat, DVec3};

use super::{Biped, FootPlace, ankle_from_toe};
use crate::orientation::smooth;
use crate::placed::PlacedPrint;

/// Standard gravity, m/s².
const GRAVITY_M_S2: f64 = 9.806_65;
/// A swing takes this long at most, in periods of a pendulum as long as the leg over 2 pi (0.9 s for a human): half of its period. A
/// foot that is longer in the air hangs between, all the way when it is there half as long again.
const LONGEST_SWING: f64 = PI;
/// Speeds of a swinging foot in units of the square root of leg length times gravity: walking below, running above.
const WALKING_SWING: f64 = 1.3;
const RUNNING_SWING: f64 = 2.1;
/// The leg is shortest at 0.5 to this power's inverse of the swing (0.4): knees bend most early. Chosen.
const EARLY: f64 = 0.75;
/// A foot that climbs is at its new height after this share of the swing, so that it clears the edge; one that goes down begins as late.
const CLIMB: f64 = 0.6;
/// A hanging leg leans backwards by so much, and its foot points down by so much, radians.
const HANGING_LEAN_RAD: f64 = 0.25;
const HANGING_FOOT_RAD: f64 = 0.6;

/// Times of a foot in the air.
#[derive(Clone, Copy)]
struct Swing {
    /// How far it has gone to where it hangs, 0 to 1.
    to_hanging: f64,
    /// How much it hangs at all between two prints, 0 to 1.
    hanging: f64,
    /// How far it has come to its next print, from 0 to 1 and evenly.
    arriving: f64,
}

impl Swing {
    fn at(prints: [Option<&PlacedPrint>; 2], longest_s: f64, time_s: f64) -> Self {
        let share = |from_s: f64, for_s: f64| {
            let share = (time_s - from_s) / for_s;
            if share.is_nan() { 1.0 } else { share.clamp(0.0, 1.0) }
        };
        match prints.map(|print| print.map(|print| (print.strike_s, print.lift_off_s))) {
            [Some((_, from_s)), Some((to_s, _))] => {
                let whole_s = to_s - from_s;
                let swing_s = whole_s.min(longest_s);
                Self {
                    to_hanging: smooth(share(from_s, swing_s)),
                    hanging: smooth(2.0 * (whole_s / longest_s - 1.0)),
                    arriving: share(to_s - swing_s, swing_s),
                }
            }
            [Some((_, from_s)), None] => {
                Self { to_hanging: smooth(share(from_s, longest_s)), hanging: 1.0, arriving: 0.0 }
            }
            [None, Some((to_s, _))] => {
                Self { to_hanging: 1.0, hanging: 1.0, arriving: share(to_s - longest_s, longest_s) }
            }
            [None, None] => Self { to_hanging: 1.0, hanging: 1.0, arriving: 0.0 },
        }
    }
}

impl Biped<'_> {
    /// The foot between its prints, with how far it has come.
    pub(super) fn swinging(
        &self,
        prints: [Option<&PlacedPrint>; 2],
        hip: DVec3,
        heading: DQuat,
        time_s: f64,
    ) -> (FootPlace, f64) {
        let longest_s = LONGEST_SWING * (self.model.leg.nominal_m / GRAVITY_M_S2).sqrt();
        let swing = Swing::at(prints, longest_s, time_s);
        let hanging = self.hanging(hip, heading);
        let at =
            |print: &PlacedPrint, time_s| self.planted(print, self.hip(print.foot, time_s), time_s).place;
        let [from, to] = [
            prints[0].map_or(hanging, |print| at(print, print.lift_off_s)),
            prints[1].map_or(hanging, |print| at(print, print.strike_s)),
        ];
        let left =
            between(&from, &hanging, swing.hanging * swing.to_hanging, swing.hanging * swing.to_hanging);
        let mut place =
            between(&left, &to, smooth(swing.arriving), climbed(swing.arriving, to.toe.y - left.toe.y));
        self.droop(&mut place, swing);
        self.retract(&mut place, hip, swing, self.running(&from, &to, prints));
        (place, swing.arriving)
    }

    /// A foot that has nothing to do.
    fn hanging(&self, hip: DVec3, heading: DQuat) -> FootPlace {
        let leg = &self.model.leg;
        let length_m = leg.nominal_m * leg.retracted_running;
        let ankle = hip + heading * DQuat::from_rotation_z(-HANGING_LEAN_RAD) * DVec3::NEG_Y * length_m;
        let world_from_foot = heading * DQuat::from_rotation_z(-HANGING_FOOT_RAD);
        FootPlace { toe: ankle - world_from_foot * ankle_from_toe(self.model), world_from_foot }
    }

    /// Raises the sole and lets the toes hang.
    fn droop(&self, place: &mut FootPlace, swing: Swing) {
        let foot = &self.model.leg.foot;
        let (share, middle) = (swing.arriving, (PI * swing.arriving).sin().powi(2));
        let droop_rad = foot.swing_droop_deg.to_radians() * (PI * share.powf(EARLY)).sin().powi(2);
        place.world_from_foot *= DQuat::from_rotation_z(-droop_rad);
        place.toe.y += foot.swing_clearance_m * middle;
    }

    /// How much of a running step it is, 0 to 1.
    fn running(&self, from: &FootPlace, to: &FootPlace, prints: [Option<&PlacedPrint>; 2]) -> f64 {
        let [Some(before), Some(after)] = prints else { return 0.0 };
        let way = to.toe - from.toe;
        let speed_m_s = way.x.hypot(way.z) / (after.strike_s - before.lift_off_s);
        let speed = speed_m_s / (self.model.leg.nominal_m * GRAVITY_M_S2).sqrt();
        smooth((speed - WALKING_SWING) / (RUNNING_SWING - WALKING_SWING))
    }

    /// Shortens the leg in the middle of the swing, and always to what it can reach.
    fn retract(&self, place: &mut FootPlace, hip: DVec3, swing: Swing, running: f64) {
        let leg = &self.model.leg;
        let ankle = place.ankle(self.model);
        let length_m = (ankle - hip).length();
        let retracted = leg.retracted + (leg.retracted_running - leg.retracted) * running;
        let shorter_m = (length_m - leg.nominal_m * retracted).max(0.0);
        let middle = (PI * swing.arriving.powf(EARLY)).sin().powi(2) * (1.0 - swing.hanging);
        let wanted_m = (length_m - shorter_m * middle).min(leg.longest_m);
        place.toe += (hip - ankle).normalize_or_zero() * (length_m - wanted_m);
    }
}

/// From one place of a foot to another: over the ground and turned by one share, its height by another.
fn between(from: &FootPlace, to: &FootPlace, share: f64, height_share: f64) -> FootPlace {
    let mut toe = from.toe.lerp(to.toe, share);
    toe.y = from.toe.y + (to.toe.y - from.toe.y) * height_share;
    FootPlace { toe, world_from_foot: from.world_from_foot.slerp(to.world_from_foot, share) }
}

/// Share of the height after a share of a swing that goes up by so much, metres.
fn climbed(share: f64, up_m: f64) -> f64 {
    if up_m > 0.0 { smooth(share / CLIMB) } else { smooth((share - (1.0 - CLIMB)) / CLIMB) }
}
