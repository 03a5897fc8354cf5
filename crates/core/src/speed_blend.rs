//! A gait at any speed: between the strides of the database at whole miles per hour.

use crate::database::Database;
use crate::gait::Gait;
use crate::limb::Limb;
use crate::pose::Pose;
use crate::provenance::Provenance;
use crate::skeleton::BONE_COUNT;
use crate::stride::{Contact, Stride};

/// A gait between two neighbouring speeds of the database.
///
/// Neighbours are a mile per hour apart and made from one capture, so that their mean keeps a standing hoof within 4 mm of its print
/// and 7 mm of the ground. At the walk and amble, whose neighbours differ most, it is 6 and 20 mm; a run time that wants it exact
/// solves the legs anew.
#[derive(Clone, Copy, Debug)]
pub struct SpeedBlend<'a> {
    /// The stride at the speed below or at the wanted one.
    pub slower: &'a Stride,
    /// The stride at the speed above it; the same at the ends of the gait's range.
    pub faster: &'a Stride,
    /// How far from `slower` to `faster`, 0 to 1.
    pub share: f32,
}

impl Database {
    /// A gait at a speed in m/s, held within the range the database has; none for a gait without strides at whole miles per
    /// hour. Not a number counts as the slowest speed.
    pub fn at_speed(&self, gait: Gait, speed_m_s: f32) -> Option<SpeedBlend<'_>> {
        let made = |stride: &&Stride| !matches!(stride.provenance, Provenance::Captured { .. });
        let strides = || self.strides_of(gait).filter(made);
        let first = strides().next()?;
        let slower = strides().take_while(|stride| stride.speed_m_s <= speed_m_s).last().unwrap_or(first);
        let faster = strides().find(|stride| stride.speed_m_s > slower.speed_m_s).unwrap_or(slower);
        let speed_m_s = speed_m_s.clamp(slower.speed_m_s, faster.speed_m_s);
        // The share at which mixed length over mixed time is the speed.
        let lacking_m = speed_m_s * slower.stride_time_s - slower.stride_length_m();
        let gained_m = faster.stride_length_m()
            - slower.stride_length_m()
            - speed_m_s * (faster.stride_time_s - slower.stride_time_s);
        let share = lacking_m / gained_m;
        Some(SpeedBlend { slower, faster, share: if share.is_nan() { 0.0 } else { share.clamp(0.0, 1.0) } })
    }
}

impl SpeedBlend<'_> {
    fn mix(&self, slower: f32, faster: f32) -> f32 {
        slower + self.share * (faster - slower)
    }

    /// Speed, m/s.
    pub fn speed_m_s(&self) -> f32 {
        self.stride_length_m() / self.stride_time_s()
    }

    /// Duration of a stride, s.
    pub fn stride_time_s(&self) -> f32 {
        self.mix(self.slower.stride_time_s, self.faster.stride_time_s)
    }

    /// Distance covered in one stride, m.
    pub fn stride_length_m(&self) -> f32 {
        self.mix(self.slower.stride_length_m(), self.faster.stride_length_m())
    }

    /// When each hoof is down at both speeds, in the order of [`Limb::ALL`]: strikes keep their phases from speed to speed, and
    /// with the shorter of the two stances a hoof that is called down stands still.
    pub fn contacts(&self) -> [Contact; 4] {
        Limb::ALL.map(|limb| {
            let [a, b] = [self.slower, self.faster].map(|stride| stride.contacts[limb.index()]);
            if a.duty_factor() < b.duty_factor() { a } else { b }
        })
    }

    /// Pose at a phase (any real number; whole strides add their length). Allocates nothing.
    pub fn pose(&self, phase: f32) -> Pose {
        let (a, b) = (self.slower.pose(phase), self.faster.pose(phase));
        let mut pose = a;
        pose.root_in_world = a.root_in_world.lerp(b.root_in_world, self.share);
        pose.world_from_root = a.world_from_root.slerp(b.world_from_root, self.share);
        for i in 0..BONE_COUNT {
            pose.bends_rad[i] = self.mix(a.bends_rad[i], b.bends_rad[i]);
        }
        for i in 0..2 {
            pose.scapula_slides_m[i] = self.mix(a.scapula_slides_m[i], b.scapula_slides_m[i]);
        }
        pose
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::MPS_PER_MPH;
    use crate::skeleton::Skeleton;

    /// Gaits with a range of speeds.
    fn gaits() -> impl Iterator<Item = (Gait, [f32; 2])> {
        Gait::ALL
            .into_iter()
            .filter_map(|gait| Some((gait, gait.speed_range_mph()?.map(|mph| (mph * MPS_PER_MPH) as f32))))
    }

    #[test]
    fn every_gait_is_there_at_every_speed_of_its_range() {
        let database = Database::embedded();
        for (gait, [low, high]) in gaits() {
            for k in 0..=100 {
                let wanted = low + (high - low) * k as f32 / 100.0;
                let blend = database.at_speed(gait, wanted).unwrap();
                let found = blend.speed_m_s();
                assert!((found / wanted - 1.0).abs() < 5e-3, "{gait} at {wanted}: {found}");
            }
        }
    }

    #[test]
    fn a_standing_hoof_stands_between_whole_miles_per_hour_too() {
        let (database, reference) = (Database::embedded(), Skeleton::reference());
        for (gait, [low, high]) in gaits() {
            let [slide_m, height_m] =
                if matches!(gait, Gait::Walk | Gait::Amble) { [6e-3, 20e-3] } else { [4e-3, 7e-3] };
            for k in 0..20 {
                let blend = database.at_speed(gait, low + (high - low) * (k as f32 + 0.5) / 20.0).unwrap();
                let skeleton = blend.slower.skeleton(&reference);
                for (limb, contact) in Limb::ALL.into_iter().zip(blend.contacts()) {
                    let at = |share: f32| {
                        let phase = contact.strike_phase + share * contact.duty_factor();
                        blend.pose(phase).joints(&skeleton).toe(limb)
                    };
                    let middle = at(0.5);
                    for i in 0..=40 {
                        let toe = at(i as f32 / 40.0);
                        assert!(toe.y.abs() < height_m, "{gait} {limb:?}: {} m from the ground", toe.y);
                        assert!(
                            (toe.x - middle.x).abs() < slide_m,
                            "{gait} {limb:?}: slid {}",
                            toe.x - middle.x
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn speeds_beyond_the_range_and_no_number_are_held() {
        let database = Database::embedded();
        let slowest = database.at_speed(Gait::Walk, f32::NEG_INFINITY).unwrap().slower.id.clone();
        for speed in [f32::NAN, -1.0, 0.0] {
            let blend = database.at_speed(Gait::Walk, speed).unwrap();
            assert_eq!((blend.slower.id.as_str(), blend.share), (slowest.as_str(), 0.0));
        }
        let fast = database.at_speed(Gait::Walk, f32::INFINITY).unwrap();
        assert_eq!(fast.slower.id, fast.faster.id);
        assert!(fast.pose(0.3).root_in_world.is_finite());
    }
}
