//! A hoof's way through the air from print to print: the database's, laid between them.

use glam::DVec3;
use muybridge_core::{Ground, Limb, OwnGait};

use super::gait::HorseGait;
use super::leg::{LegCourse, Stand};

/// Places at which a swing is held against the ground.
const LOOKED_AT: usize = 12;
/// Height a toe keeps over the ground in the middle of its swing, metres: less than the database's strides do.
const CLEARANCE_M: f64 = 0.02;
/// No foot is lifted by more than this over what stands in its way, metres.
const MOST_LIFTED_M: f64 = 0.5;
/// Heights beyond this are no ground, metres.
const MOST_HEIGHT_M: f64 = 1e5;

/// How a swing differs from the database's.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Swing {
    /// How much higher it is in its middle, metres.
    lift_m: f64,
}

/// A limb's way in the database, from lift-off to strike.
#[derive(Clone, Copy, Debug)]
pub(super) struct SwingPath {
    limb: Limb,
    lift_off_phase: f64,
    /// Share of the stride it takes.
    swing: f64,
    stride_length_m: f64,
    /// Toe at lift-off and at the strike after it: ahead of the root's advance, and height, metres.
    ends_m: [[f64; 2]; 2],
}

/// Rises from 0 to 1 in the middle of a swing and falls again.
fn arc(share: f64) -> f64 {
    4.0 * share * (1.0 - share)
}

impl SwingPath {
    pub(super) fn new(gait: &HorseGait, own: &OwnGait<'_>, limb: Limb) -> Self {
        let leg = gait.legs[limb.index()];
        let lift_off_phase = leg.strike_phase + leg.duty;
        let toe_m = |phase: f64| own.toe_m(limb, phase as f32).map(f64::from);
        Self {
            limb,
            lift_off_phase,
            swing: 1.0 - leg.duty,
            stride_length_m: gait.stride_length_m,
            ends_m: [toe_m(lift_off_phase), toe_m(leg.strike_phase)],
        }
    }

    /// At a share of the swing: the share of the way from print to print that is gone, and the toe's height over the line between them,
    /// metres. Both are exactly at their prints at the ends.
    fn at(&self, own: &OwnGait<'_>, share: f64) -> [f64; 2] {
        let [[left_m, left_height_m], [struck_m, struck_height_m]] = self.ends_m;
        let phase = self.lift_off_phase + self.swing * share;
        let [ahead_m, height_m] = own.toe_m(self.limb, phase as f32).map(f64::from);
        let gone = |ahead_m: f64, share: f64| ahead_m - left_m + self.stride_length_m * self.swing * share;
        let lacking_m = self.stride_length_m - gone(struck_m, 1.0);
        let gone = (gone(ahead_m, share) + share * lacking_m) / self.stride_length_m;
        let ground_m = left_height_m + share * (struck_height_m - left_height_m);
        [gone, (height_m - ground_m).max(0.0)]
    }

    /// The toe between two stands, world space, metres.
    pub(super) fn toe(&self, own: &OwnGait<'_>, [from, to]: [&Stand; 2], swing: &Swing, share: f64) -> DVec3 {
        let [gone, height_m] = self.at(own, share);
        from.toe.lerp(to.toe, gone) + DVec3::Y * (height_m + swing.lift_m * arc(share))
    }

    /// Lifts the swings of a leg over what the ground has between its prints.
    pub(super) fn plan(&self, own: &OwnGait<'_>, course: &mut LegCourse, ground: &impl Ground) {
        let lift = |pair: &[Stand]| {
            let mut lift_m = 0.0f64;
            for k in 1..LOOKED_AT {
                let share = k as f64 / LOOKED_AT as f64;
                let toe = self.toe(own, [&pair[0], &pair[1]], &Swing::default(), share);
                let ground_m = f64::from(ground.surface(toe.x as f32, toe.z as f32).height_m);
                if ground_m.abs() < MOST_HEIGHT_M {
                    lift_m = lift_m.max((ground_m - toe.y) / arc(share) + CLEARANCE_M * arc(share));
                }
            }
            Swing { lift_m: lift_m.clamp(0.0, MOST_LIFTED_M) }
        };
        course.swings = course.stands.windows(2).map(lift).collect();
    }
}
