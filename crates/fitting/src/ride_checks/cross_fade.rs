//! The plain cross-fade that our changes are compared with: poses of both gaits mixed by weights that rise evenly, each gait running on at
//! its own phase, the root at the mean of their speeds, no foot pinned.

use muybridge_core::{BONE_COUNT, Limb, Pose, Skeleton, Stride};

use super::changes::{Accelerations, STEP_S};

/// A change by cross-fade.
#[derive(Clone, Copy)]
pub struct CrossFade<'a> {
    /// The gait at first.
    pub from: &'a Stride,
    /// The gait in the end.
    pub to: &'a Stride,
    /// Phase of both at the beginning.
    pub start_phase: f64,
    /// Duration, s.
    pub duration_s: f64,
}

/// What a cross-fade shows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FadeCase {
    /// Farthest a toe slides in a stance of the gait that weighs more, m.
    pub slide_m: f64,
    /// Acceleration of joints at the 99th percentile, rad/s^2.
    pub acceleration_p99: f64,
    /// Share of the legs' time in which a leg stands in one gait and swings in the other: it is in neither.
    pub torn: f64,
}

impl CrossFade<'_> {
    fn phases(&self, time_s: f64) -> [f64; 2] {
        [self.from, self.to].map(|stride| self.start_phase + time_s / f64::from(stride.stride_time_s))
    }

    /// The pose at a time since the beginning, s.
    pub fn pose(&self, time_s: f64) -> Pose {
        let share = (time_s / self.duration_s).clamp(0.0, 1.0);
        let mix = |a: f32, b: f32| (f64::from(a) + share * (f64::from(b) - f64::from(a))) as f32;
        let phases = self.phases(time_s).map(|phase| phase.rem_euclid(1.0) as f32);
        let (a, b) = (self.from.pose(phases[0]), self.to.pose(phases[1]));
        let mut pose = a;
        for bone in 0..BONE_COUNT {
            pose.bends_rad[bone] = mix(a.bends_rad[bone], b.bends_rad[bone]);
        }
        for side in 0..2 {
            pose.scapula_slides_m[side] = mix(a.scapula_slides_m[side], b.scapula_slides_m[side]);
        }
        // The speeds' mean, integrated: the weight has risen to half the share on the way.
        let [slow, fast] = [self.from, self.to].map(|stride| f64::from(stride.speed_m_s));
        let even = time_s * (slow + 0.5 * share * (fast - slow));
        let surge = |stride: &Stride, pose: &Pose, phase: f32| {
            pose.root_in_world.x - stride.stride_length_m() * phase
        };
        let surges = mix(surge(self.from, &a, phases[0]), surge(self.to, &b, phases[1]));
        pose.root_in_world.x = even as f32 + surges;
        pose.root_in_world.y = mix(a.root_in_world.y, b.root_in_world.y);
        pose.world_from_root = a.world_from_root.slerp(b.world_from_root, share as f32);
        pose
    }

    /// Which legs stand in each gait.
    fn supports(&self, time_s: f64) -> [[bool; 4]; 2] {
        let [a, b] = self.phases(time_s).map(|phase| phase.rem_euclid(1.0) as f32);
        [self.from.support(a), self.to.support(b)]
    }

    /// Measures it.
    pub fn measure(&self, skeleton: &Skeleton) -> FadeCase {
        let mut accelerations = Accelerations::default();
        let mut places: [Option<[f64; 2]>; 4] = [None; 4];
        let (mut slide_m, mut torn) = (0.0f64, 0);
        let steps = (self.duration_s / f64::from(STEP_S)).ceil().max(1.0) as usize;
        for step in 0..steps {
            let time_s = step as f64 * f64::from(STEP_S);
            let pose = self.pose(time_s);
            accelerations.take(&pose.bends_rad);
            let joints = pose.joints(skeleton);
            let [from, to] = self.supports(time_s);
            torn += (0..4).filter(|&leg| from[leg] != to[leg]).count();
            let stands = if time_s < 0.5 * self.duration_s { from } else { to };
            for limb in Limb::ALL {
                let leg = limb.index();
                let toe = joints.toe(limb);
                let toe = [f64::from(toe.x), f64::from(toe.z)];
                let place = if stands[leg] { Some(places[leg].unwrap_or(toe)) } else { None };
                if let Some([x, z]) = place {
                    slide_m = slide_m.max((toe[0] - x).hypot(toe[1] - z));
                }
                places[leg] = place;
            }
        }
        FadeCase { slide_m, acceleration_p99: accelerations.p99(), torn: torn as f64 / (4 * steps) as f64 }
    }
}

#[cfg(test)]
mod tests {
    use muybridge_core::{Database, Gait};

    use super::*;

    #[test]
    fn a_fade_from_a_stride_to_itself_is_that_stride() {
        let database = Database::embedded();
        let trot = database.strides_of(Gait::Trot).nth(3).unwrap();
        let skeleton = trot.skeleton(&Skeleton::reference());
        let fade = CrossFade { from: trot, to: trot, start_phase: 0.3, duration_s: 1.5 };
        let case = fade.measure(&skeleton);
        assert!(case.slide_m < 0.006 && case.torn == 0.0, "{case:?}");
        let ahead = fade.pose(1.5).root_in_world.x - fade.pose(0.0).root_in_world.x;
        assert!((ahead / (1.5 * trot.speed_m_s) - 1.0).abs() < 0.05, "{ahead}");
    }

    #[test]
    fn a_fade_from_walk_to_gallop_slides_and_tears() {
        let database = Database::embedded();
        let of = |gait| database.strides_of(gait).nth(3).unwrap();
        let (walk, gallop) = (of(Gait::Walk), of(Gait::Gallop));
        let fade = CrossFade { from: walk, to: gallop, start_phase: 0.0, duration_s: 1.5 };
        let case = fade.measure(&walk.skeleton(&Skeleton::reference()));
        assert!(case.slide_m > 0.1 && case.torn > 0.2, "{case:?}");
    }
}
