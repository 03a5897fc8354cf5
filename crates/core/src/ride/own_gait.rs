//! A gait at a speed on one skeleton, to be read at any phase: what the ride mixes, for others who make motion.

use glam::{Quat, Vec3};

use super::clip::{BODY_CHANNELS, Clip, LEG_CHANNELS, LegRow, body, leg};
use super::repertoire::{Paced, Repertoire};
use crate::gait::Gait;
use crate::limb::{Limb, Pair, Side};
use crate::pose::Pose;
use crate::skeleton::bone;
use crate::stride::Contact;

/// A gait at a speed as one horse does it: the database's strides solved for its skeleton, every standing hoof within a millimetre
/// of its print.
#[derive(Clone, Copy, Debug)]
pub struct OwnGait<'a> {
    repertoire: &'a Repertoire,
    paced: Paced<'a>,
}

impl Repertoire {
    /// A gait at a speed in m/s, held within [`Repertoire::speed_range_m_s`]; the lead counts where the gait has one. Not a number
    /// counts as the slowest speed; the leap is always the same.
    pub fn own_gait(&self, gait: Gait, lead: Side, speed_m_s: f32) -> OwnGait<'_> {
        OwnGait { repertoire: self, paced: self.paced(self.way(gait, lead), speed_m_s) }
    }
}

impl OwnGait<'_> {
    fn clips(&self) -> [(&Clip, f32); 2] {
        [(self.paced.slower, 1.0 - self.paced.share), (self.paced.faster, self.paced.share)]
    }

    fn mix(&self, of: impl Fn(&Clip) -> f32) -> f32 {
        self.clips().into_iter().map(|(clip, share)| share * of(clip)).sum()
    }

    /// Side of the leading foreleg; none in a symmetrical gait.
    pub fn lead(&self) -> Option<Side> {
        self.repertoire.lead(self.paced.way)
    }

    /// Duration of a stride, s.
    pub fn stride_time_s(&self) -> f32 {
        self.mix(|clip| clip.stride_time_s)
    }

    /// Distance covered in a stride, metres.
    pub fn stride_length_m(&self) -> f32 {
        self.paced.length_m()
    }

    /// When a leg's hoof is down; phase 0 is the strike of the left hind, of the right hind where the lead is not the database's.
    pub fn contact(&self, limb: Limb) -> Contact {
        let strike_phase = self.paced.strike(limb.index());
        let duty = self.paced.duty(limb.index());
        Contact { strike_phase, lift_off_phase: (strike_phase + duty).rem_euclid(1.0) }
    }

    /// Where a leg's standing toe is at the middle of its stance, ahead of the root's uniform advance, metres.
    pub fn print_m(&self, limb: Limb) -> f32 {
        self.paced.print_m(limb.index())
    }

    fn leg_row(&self, limb: Limb, phase: f32) -> LegRow {
        let mut row = [0.0; LEG_CHANNELS];
        let (strike, duty) = (self.paced.strike(limb.index()), self.paced.duty(limb.index()));
        let cycle = (phase - strike).rem_euclid(1.0);
        self.paced.add_leg(limb.index(), cycle, duty, 1.0, &mut row);
        row
    }

    /// A leg's toe at a phase (any real number): ahead of the root's uniform advance, and over the ground, metres.
    pub fn toe_m(&self, limb: Limb, phase: f32) -> [f32; 2] {
        let row = self.leg_row(limb, phase);
        [row[leg::TOE_AHEAD], row[leg::TOE_HEIGHT]]
    }

    /// Pose at a phase of the body and one of each leg (any real numbers; all the same in the gait itself), within the limits of the
    /// joints. The root is at its place against its uniform advance: surge ahead, height over the ground. Allocates nothing.
    pub fn pose(&self, body_phase: f32, leg_phases: [f32; 4]) -> Pose {
        let mut row = [0.0; BODY_CHANNELS];
        for (clip, share) in self.clips().into_iter().filter(|(_, share)| *share > 0.0) {
            clip.add_body(body_phase.rem_euclid(1.0), share, &mut row);
        }
        let mut pose = Pose {
            root_in_world: Vec3::new(row[body::SURGE], row[body::HEIGHT], 0.0),
            world_from_root: Quat::from_rotation_z(row[body::PITCH]),
            ..Pose::default()
        };
        pose.bends_rad[..bone::LIMBS].copy_from_slice(&row[..bone::LIMBS]);
        for (limb, phase) in Limb::ALL.into_iter().zip(leg_phases) {
            let (first, row) = (limb.first_bone(), self.leg_row(limb, phase));
            pose.bends_rad[first..first + 5].copy_from_slice(&row[..5]);
            if limb.pair() == Pair::Fore {
                pose.scapula_slides_m[limb.index()] = row[leg::SLIDE];
            }
        }
        // A curve between its samples may swing past a limit that the samples keep.
        for (bend, [low, high]) in pose.bends_rad.iter_mut().zip(self.repertoire.rig.limits_rad) {
            *bend = bend.clamp(low, high);
        }
        pose
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::database::Database;
    use crate::skeleton::Skeleton;

    #[test]
    fn a_standing_toe_stands_on_its_print_at_every_phase() {
        let skeleton = Skeleton::reference();
        let repertoire = Repertoire::new(&Database::embedded(), &skeleton).unwrap();
        for (gait, lead) in
            [(Gait::Walk, Side::Left), (Gait::Canter, Side::Left), (Gait::Gallop, Side::Right)]
        {
            let [low, high] = repertoire.speed_range_m_s(gait);
            let own = repertoire.own_gait(gait, lead, 0.3 * low + 0.7 * high);
            assert_eq!(own.lead(), (gait != Gait::Walk).then_some(lead));
            for limb in Limb::ALL {
                let contact = own.contact(limb);
                for k in 0..=20 {
                    let since = contact.duty_factor() * k as f32 / 20.0;
                    let phase = contact.strike_phase + since;
                    let toe = own.pose(phase, [phase; 4]).joints(&skeleton).toe(limb);
                    let gone_m = own.stride_length_m() * (since - 0.5 * contact.duty_factor());
                    assert!((toe.x + gone_m - own.print_m(limb)).abs() < 6e-3, "{gait} {limb:?} {k}: {toe}");
                    assert!(toe.y.abs() < 6e-3, "{gait} {limb:?} {k}: {toe}");
                }
            }
        }
    }
}
