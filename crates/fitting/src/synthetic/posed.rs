//! A known motion in the frame of the plate's cameras, for whoever draws it.

use muybridge_core::{BONE_COUNT, Limb};

use super::SyntheticStride;
use crate::chain::{Attachment, Chain, Vec2};
use crate::layout::SHARED;
use crate::observation::depth_m;

/// A horse at one moment. Places are `[x, y, z]` in metres: x forward along the track, y up from the ground, z towards
/// the camera with the near hooves' plane at zero, as `muybridge_capture::PanelCamera::plate_from_world` takes them.
#[derive(Clone, Debug, PartialEq)]
pub struct Posed {
    /// Seconds since the first panel.
    pub time_s: f64,
    /// Proximal and distal end of each bone, in the order of `muybridge_core::bone`.
    pub bones: [[[f64; 3]; 2]; BONE_COUNT],
    /// Top of the croup.
    pub croup: [f64; 3],
    /// Root of the tail.
    pub dock: [f64; 3],
    /// Whether each hoof is on the ground, in the order of [`Limb::ALL`].
    pub down: [bool; 4],
}

/// One stance of one hoof.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoofPrint {
    /// The leg.
    pub limb: Limb,
    /// When the hoof strikes and leaves the ground, seconds since the first panel; a stance that the first panel
    /// finds under way began before zero.
    pub strike_s: f64,
    /// See `strike_s`.
    pub lift_off_s: f64,
    /// Where the toe stands, in the frame of [`Posed`].
    pub toe: [f64; 3],
}

impl SyntheticStride {
    /// The horse as a panel shows it.
    pub fn posed(&self, panel: usize) -> Posed {
        let time_s = self.stride_time_s * panel as f64 / self.poses.len() as f64;
        self.placed(time_s, &self.poses[panel], self.down[panel])
    }

    /// The horse at any time, seconds since the first panel. The gaits go on for ever both ways; a leap is known from
    /// zero to `stride_time_s`.
    pub fn posed_at(&self, time_s: f64) -> Posed {
        self.placed(time_s, &self.source.pose(time_s), self.source.down(time_s))
    }

    /// Every stance of which some falls between zero and `stride_time_s`, leg by leg and in order of time.
    pub fn hoof_prints(&self) -> Vec<HoofPrint> {
        let mut prints = Vec::new();
        for limb in Limb::ALL {
            let tip = Attachment::Tip(limb.hoof_bone());
            let z_m = depth_m(&self.chain, tip, self.facing);
            let first = prints.len();
            let mut at_s = self.stride_time_s;
            while let Some(stance) = self.source.last_stance(limb, at_s).filter(|s| s.lift_off_s > 0.0) {
                prints.push(HoofPrint {
                    limb,
                    strike_s: stance.strike_s,
                    lift_off_s: stance.lift_off_s,
                    toe: [stance.print_x_m, 0.0, z_m],
                });
                // Just before the strike, the stance before is the last one.
                at_s = stance.strike_s - 0.1 * (stance.lift_off_s - stance.strike_s);
            }
            prints[first..].reverse();
        }
        prints
    }

    fn placed(&self, time_s: f64, pose: &[f64], down: [bool; 4]) -> Posed {
        let kinematics = self.chain.kinematics(pose, &[0.0; SHARED]);
        let put = |[x, y]: Vec2, point: Attachment| [x, y, depth_m(&self.chain, point, self.facing)];
        Posed {
            time_s,
            bones: std::array::from_fn(|i| {
                let [base, tip] = kinematics.bone(i);
                [put(base, proximal(&self.chain, i)), put(tip, Attachment::Tip(i))]
            }),
            croup: put(kinematics.place(Attachment::Root), Attachment::Root),
            dock: put(kinematics.place(Attachment::Dock), Attachment::Dock),
            down,
        }
    }
}

/// The point that a bone's proximal end coincides with, or lies beside (a scapula's upper end beside the withers).
fn proximal(chain: &Chain, bone: usize) -> Attachment {
    chain.parents[bone].map_or(Attachment::Root, Attachment::Tip)
}
