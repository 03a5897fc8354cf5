//! The gait of a track, checked: what the database says of it for one horse.

use glam::DVec3;
use muybridge_core::{Contact, Gait, Limb, OwnGait, Pose, Side};

use super::model::HorseModel;
use crate::track::TrackGait;

/// A speed beyond a gait's range by no more than this share counts as its end: ranges are told with two decimals.
const SPEED_TOLERANCE: f32 = 0.01;
/// Samples of a stride for the range of the root's height.
const STRIDE_SAMPLES: usize = 48;
/// Samples of a leg's stance for its means.
const STANCE_SAMPLES: usize = 24;

/// A gait at a speed, of one horse.
#[derive(Clone, Debug)]
pub(super) struct HorseGait {
    pub(super) model: HorseModel,
    gait: Gait,
    lead: Side,
    speed_m_s: f32,
    /// Duration of a stride, s.
    pub(super) stride_time_s: f64,
    /// Distance covered in it, metres.
    pub(super) stride_length_m: f64,
    /// Least and greatest height of the root over the ground, metres.
    pub(super) heights_m: [f64; 2],
    /// The four legs.
    pub(super) legs: [GaitLeg; 4],
}

/// What a leg does in the gait.
#[derive(Clone, Copy, Debug)]
pub(super) struct GaitLeg {
    /// Phase of the stride at which it strikes, `[0, 1)`.
    pub(super) strike_phase: f64,
    /// Share of the stride it is down.
    pub(super) duty: f64,
    /// Its print ahead of the root's place at the middle of the stance, metres.
    pub(super) print_m: f64,
    /// Its print from the median plane, metres, to the right positive.
    pub(super) lateral_m: f64,
    /// Shoulder or hip from the centre of mass in the root's frame, mean over the stance, metres.
    pub(super) hip_from_com_m: DVec3,
    /// From shoulder or hip to toe, mean over the stance, metres.
    pub(super) nominal_m: f64,
}

impl HorseGait {
    /// The gait of a track for a horse, or what is wrong with it.
    pub(super) fn new(model: &HorseModel, gait: &TrackGait) -> Result<Self, String> {
        let TrackGait { gait: name, speed_m_s, lead } = *gait;
        if name == Gait::Leap {
            return Err(
                "gait: a leap has no strides; choose walk, amble, trot, rack, canter or gallop".into()
            );
        }
        let [low, high] = model.speed_range_m_s(name);
        let speed = speed_m_s as f32;
        let within = low * (1.0 - SPEED_TOLERANCE)..=high * (1.0 + SPEED_TOLERANCE);
        if !within.contains(&speed) {
            return Err(format!(
                "gait: the {name} is known from {low:.2} to {high:.2} m/s; speed_m_s is {speed_m_s}"
            ));
        }
        let side = lead.map_or(Side::Right, |lead| lead.fore);
        let own = model.repertoire().own_gait(name, side, speed);
        match lead {
            Some(_) if own.lead().is_none() => {
                return Err(format!("gait: the {name} has no lead; leave it out"));
            }
            Some(lead) if !lead.is_transverse() => {
                return Err(format!(
                    "gait: no {name} is known that leads with one side before and the other behind; give both the same side"
                ));
            }
            _ => {}
        }
        let legs = Limb::ALL.map(|limb| GaitLeg::new(model, &own, limb));
        let (stride_time_s, stride_length_m) =
            (f64::from(own.stride_time_s()), f64::from(own.stride_length_m()));
        Ok(Self {
            model: model.clone(),
            gait: name,
            lead: side,
            speed_m_s: speed,
            stride_time_s,
            stride_length_m,
            heights_m: heights_m(&own),
            legs,
        })
    }

    /// The database's motion.
    pub(super) fn own(&self) -> OwnGait<'_> {
        self.model.repertoire().own_gait(self.gait, self.lead, self.speed_m_s)
    }

    /// From the hind prints to the fore ones, metres: how far the legs' places on the ground are apart.
    pub(super) fn wheelbase_m(&self) -> f64 {
        let [lf, rf, lh, rh] = self.legs.map(|leg| leg.print_m);
        0.5 * (lf + rf - lh - rh)
    }
}

/// Least and greatest height of the root over the ground, metres.
fn heights_m(own: &OwnGait<'_>) -> [f64; 2] {
    let phases = (0..STRIDE_SAMPLES).map(|k| k as f32 / STRIDE_SAMPLES as f32);
    let heights = phases.map(|phase| f64::from(own.pose(phase, [phase; 4]).root_in_world.y));
    heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], height_m| {
        [low.min(height_m), high.max(height_m)]
    })
}

impl GaitLeg {
    fn new(model: &HorseModel, own: &OwnGait<'_>, limb: Limb) -> Self {
        let contact: Contact = own.contact(limb);
        let (strike, duty) = (contact.strike_phase, contact.duty_factor());
        let (mut hip_from_com_m, mut lean_m, mut reaches) = (DVec3::ZERO, 0.0, Vec::new());
        for k in 0..STANCE_SAMPLES {
            let phase = strike + duty * (k as f32 + 0.5) / STANCE_SAMPLES as f32;
            let pose: Pose = own.pose(phase, [phase; 4]);
            let joints = pose.joints(model.skeleton());
            let hip = joints.bases[limb.first_bone() + 1];
            let from_com = pose.world_from_root.inverse() * (hip - pose.centre_of_mass(model.skeleton()));
            let toe_from_hip = joints.toe(limb) - hip;
            hip_from_com_m += from_com.as_dvec3() / STANCE_SAMPLES as f64;
            lean_m += f64::from(toe_from_hip.x) / STANCE_SAMPLES as f64;
            reaches.push(toe_from_hip.as_dvec3());
        }
        // The upper end of the virtual leg is over the print in the mean: nothing else draws the body along.
        hip_from_com_m.x += lean_m;
        let length_m = |toe_from_hip: &DVec3| (*toe_from_hip - DVec3::X * lean_m).length();
        let nominal_m = reaches.iter().map(length_m).sum::<f64>() / STANCE_SAMPLES as f64;
        Self {
            strike_phase: f64::from(strike),
            duty: f64::from(duty),
            print_m: f64::from(own.print_m(limb)),
            lateral_m: f64::from(model.reach().toe_lateral_m(limb)),
            hip_from_com_m,
            nominal_m,
        }
    }
}
