//! Pose of a two-legged figure: hips from the centre of mass, feet from their prints, legs between them (van de Panne 1997, 2.5).

mod planted;
mod swing;

use glam::{DQuat, DVec3};

use crate::knots::Trajectory;
use crate::leg::{Chain, plane};
use crate::model::Model;
use crate::orientation::{Orientation, heading_rad};
use crate::placed::{Placed, PlacedPrint};
use crate::pose::{BipedPose, FootState, LegPose};
use crate::stance::Stance;
use crate::track::Foot;

/// The body's share of the direction of a knee; the rest is the foot's. More than a half: whatever the foot does, the knee keeps to the
/// body's side.
const BODY_SHARE: f64 = 0.6;

/// A two-legged figure on its prints.
#[derive(Clone, Copy)]
pub(crate) struct Biped<'a> {
    /// Its body.
    pub(crate) model: &'a Model,
    /// Its prints.
    pub(crate) placed: &'a Placed,
    /// The orientation of its body.
    pub(crate) orientation: &'a Orientation,
    /// Its centre of mass.
    pub(crate) trajectory: &'a Trajectory,
}

/// What the energy knows of a two-legged figure's prints.
pub(crate) fn stances(model: &Model, placed: &Placed) -> Vec<Stance> {
    let stance = |print: &PlacedPrint| {
        let on_print = |ahead_m, up_m| print.middle + print.world_from_foot * DVec3::new(ahead_m, up_m, 0.0);
        let [ahead_m, up_m] = model.leg.foot.ankle_m;
        Stance {
            foot: print.foot.index(),
            from_s: print.strike_s,
            to_s: print.lift_off_s,
            ankle: on_print(ahead_m, up_m),
            middle: print.middle,
            toe: on_print(model.leg.foot.toe_ahead_m, 0.0),
            hip_from_com: hip_from_com(model, print.foot),
            nominal_m: model.leg.nominal_m,
            longest_m: model.leg.longest_m,
            force_through_hip: 0.0,
        }
    };
    placed.prints.iter().map(stance).collect()
}

/// Hip of a foot's leg from the centre of mass, body frame, metres.
fn hip_from_com(model: &Model, foot: Foot) -> DVec3 {
    let side = if foot == Foot::Left { -1.0 } else { 1.0 };
    DVec3::from_array(model.leg.hip_from_com_m) * DVec3::new(1.0, 1.0, side)
}

/// Where a foot is.
#[derive(Clone, Copy)]
struct FootPlace {
    /// Toe on the sole, world space, metres.
    toe: DVec3,
    world_from_foot: DQuat,
}

impl FootPlace {
    fn ankle(&self, model: &Model) -> DVec3 {
        self.toe + self.world_from_foot * ankle_from_toe(model)
    }
}

/// The ankle from the toe, foot frame, metres.
fn ankle_from_toe(model: &Model) -> DVec3 {
    let [ahead_m, up_m] = model.leg.foot.ankle_m;
    DVec3::new(ahead_m - model.leg.foot.toe_ahead_m, up_m, 0.0)
}

/// A foot with what it does.
struct FootNow {
    place: FootPlace,
    state: FootState,
    miss_m: f64,
}

impl Biped<'_> {
    /// The figure at a time, s.
    pub(crate) fn pose(&self, time_s: f64) -> BipedPose {
        let centre_of_mass = self.trajectory.at(time_s).at;
        let world_from_body = self.orientation.at(time_s);
        let chain = Chain::of(&self.model.leg);
        let legs = Foot::BIPED.map(|foot| {
            let hip = centre_of_mass + world_from_body * hip_from_com(self.model, foot);
            let now = self.foot(foot, hip, world_from_body, time_s);
            self.leg(&chain, hip, world_from_body, &now)
        });
        BipedPose { centre_of_mass, world_from_body, legs }
    }

    /// A hip at a time.
    fn hip(&self, foot: Foot, time_s: f64) -> DVec3 {
        self.trajectory.at(time_s).at + self.orientation.at(time_s) * hip_from_com(self.model, foot)
    }

    /// The prints of a foot before and after a time.
    fn prints_around(&self, foot: Foot, time_s: f64) -> [Option<&PlacedPrint>; 2] {
        let prints = &self.placed.prints;
        let (before, after) = prints.split_at(prints.partition_point(|print| print.strike_s <= time_s));
        let of_foot = |print: &&PlacedPrint| print.foot == foot;
        [before.iter().rev().find(of_foot), after.iter().find(of_foot)]
    }

    /// A foot at a time, with the hip above it and the body's orientation.
    fn foot(&self, foot: Foot, hip: DVec3, world_from_body: DQuat, time_s: f64) -> FootNow {
        let [before, after] = self.prints_around(foot, time_s);
        match before {
            Some(print) if time_s <= print.lift_off_s => self.planted(print, hip, time_s),
            _ => {
                let heading = DQuat::from_rotation_y(heading_rad(world_from_body));
                let (place, share) = self.swinging([before, after], hip, heading, time_s);
                FootNow { place, state: FootState::Swing { share }, miss_m: 0.0 }
            }
        }
    }

    /// The leg from its hip to a foot.
    fn leg(&self, chain: &Chain, hip: DVec3, world_from_body: DQuat, now: &FootNow) -> LegPose {
        let FootPlace { toe, world_from_foot } = now.place;
        let across = world_from_foot * DVec3::Z;
        let right = (world_from_body * DVec3::Z).lerp(across, 1.0 - BODY_SHARE);
        let ankle = now.place.ankle(self.model);
        let bent = chain.bent(hip, ankle, right);
        // What the segments cannot reach the foot follows.
        let followed = bent.joints.last().map_or(DVec3::ZERO, |reached| *reached - ankle);
        let toe = toe + followed;
        let miss_m = match now.state {
            FootState::Swing { .. } => 0.0,
            FootState::Flat | FootState::OnToes { .. } => now.miss_m + bent.miss_m,
        };
        let heel = toe - world_from_foot * DVec3::X * (2.0 * self.model.leg.foot.toe_ahead_m);
        LegPose { joints: bent.joints, world_from_foot, heel, toe, state: now.state, miss_m }
    }
}

impl LegPose {
    /// Direction of the virtual leg, and forwards across it.
    pub(crate) fn plane(&self, right: DVec3) -> (DVec3, DVec3) {
        let ends = self.joints.first().zip(self.joints.last());
        plane(ends.map_or(DVec3::NEG_Y, |(hip, ankle)| *ankle - *hip), right)
    }
}

#[cfg(test)]
mod tests;
