//! A horse and a stride whose truth is known exactly, for tests and benchmarks.
//!
//! Bends are a few harmonics around the rest pose, as a trotting or cantering horse has them. A leg's toe is then
//! brought to one place on the ground for the length of its stance, so that contact labels are true as well: within a
//! stance it neither slides nor sinks.

mod motion;

use std::f64::consts::TAU;

use muybridge_capture::{Facing, KEYPOINT_COUNT, Keypoint, KeypointState, PanelCamera, StanceLabel};
use muybridge_core::{Limb, Skeleton};

use crate::chain::{Chain, Kinematics};
use crate::layout::{LOG_DOCK, PANEL_DOF, SHARED, log_length};
use crate::observation::{PanelObservation, PointObservation, StrideObservation, attachment, depth_m};
use muybridge_core::Random;
use crate::weights::Weights;
use motion::{CANTER, Motion, TROT};

/// Scale of every panel, px/m: a plate's panel of 300 px shows three metres of track.
const PX_PER_M: f64 = 100.0;
/// Camera to the near legs' plane and lens over the track, m, about as at Palo Alto in 1878.
const CAMERA_DISTANCE_M: f64 = 12.0;
const CAMERA_HEIGHT_M: f64 = 1.1;
/// Gross outliers lie this far from the point, px.
const OUTLIER_PX: f64 = 25.0;

/// How a person placed points on the panels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placing {
    /// Standard deviation of a coordinate, px.
    pub scatter_px: f64,
    /// Keypoint types seen in a panel, at most [`KEYPOINT_COUNT`]; the others are left out at random.
    pub seen: usize,
    /// Share of points that lie 25 px off in a random direction.
    pub outlier_share: f64,
    /// Whether legs are labelled stance and swing, rather than unknown.
    pub labelled: bool,
}

impl Default for Placing {
    /// A careful person: 2 px of scatter, 21 of 26 points seen, no outliers, legs labelled.
    fn default() -> Self {
        Self { scatter_px: 2.0, seen: 21, outlier_share: 0.0, labelled: true }
    }
}

/// A stride with exact truth.
#[derive(Clone, Debug)]
pub struct SyntheticStride {
    /// The horse.
    pub horse: Skeleton,
    /// Which way it faces.
    pub facing: Facing,
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Duration of the stride, s; the panels share it evenly.
    pub stride_time_s: f64,
    /// Root place, pitch, bends and slides of each panel, in the layout of the fit's unknowns.
    pub poses: Vec<[f64; PANEL_DOF]>,
    /// Whether each leg is down in each panel, in the order of [`Limb::ALL`].
    pub down: Vec<[bool; 4]>,
    chain: Chain,
    seed: u64,
}

impl SyntheticStride {
    /// A horse, its gait and its motion from a seed; even seeds trot, odd ones canter.
    pub fn new(seed: u64, panels: usize) -> Self {
        let mut random = Random::new(seed);
        let horse = random_horse(&mut random);
        let chain = Chain::new(&horse);
        let reference = if seed.is_multiple_of(2) { TROT } else { CANTER };
        let gait =
            reference.scaled(f64::from(horse.withers_height_m / Skeleton::reference().withers_height_m));
        let mut motion = Motion::new(gait, chain.clone(), &mut random);
        motion.stand_on_the_ground();
        let phases: Vec<f64> = (0..panels).map(|k| k as f64 / panels as f64).collect();
        Self {
            facing: if seed % 4 < 2 { Facing::Right } else { Facing::Left },
            speed_m_s: gait.speed_m_s,
            stride_time_s: gait.stride_time_s,
            poses: phases.iter().map(|phase| motion.pose(*phase)).collect(),
            down: phases.iter().map(|phase| Limb::ALL.map(|limb| gait.down(limb, *phase))).collect(),
            horse,
            chain,
            seed,
        }
    }

    /// True places of a panel's joints, m.
    pub fn kinematics(&self, panel: usize) -> Kinematics {
        self.chain.kinematics(&self.poses[panel], &[0.0; SHARED])
    }

    /// What a person would place on the plate. Equal seeds and ways of placing give equal points.
    pub fn observe(&self, placing: &Placing, weights: &Weights) -> StrideObservation {
        // Another stream than the motion's, so that the way of placing leaves the motion alone.
        let mut random = Random::new(!self.seed);
        let panels =
            (0..self.poses.len()).map(|panel| self.observe_panel(panel, placing, weights, &mut random));
        StrideObservation { facing: self.facing, speed_m_s: self.speed_m_s, panels: panels.collect() }
    }

    /// A battery of cameras that the horse trips as it passes each.
    fn camera(&self, panel: usize) -> PanelCamera {
        let share = panel as f64 / self.poses.len() as f64;
        let time_s = self.stride_time_s * share;
        PanelCamera {
            panel: panel as u32 + 1,
            time_s,
            px_per_m: PX_PER_M,
            axis_foot_px: [200.0, 250.0],
            forward: [self.facing.sign(), 0.0],
            up: [0.0, -1.0],
            camera_x_m: self.speed_m_s * time_s,
            distance_m: CAMERA_DISTANCE_M,
            height_m: CAMERA_HEIGHT_M,
        }
    }

    fn observe_panel(
        &self,
        panel: usize,
        placing: &Placing,
        weights: &Weights,
        random: &mut Random,
    ) -> PanelObservation {
        let (camera, kinematics) = (self.camera(panel), self.kinematics(panel));
        let mut points = Vec::with_capacity(placing.seen);
        let seen = random.choose(placing.seen, KEYPOINT_COUNT);
        for (keypoint, _) in Keypoint::all().zip(seen).filter(|(_, seen)| *seen) {
            let on = attachment(keypoint, self.facing);
            let [x, y] = kinematics.place(on);
            let mut at_px = camera.plate_from_world([x, y, depth_m(&self.chain, on, self.facing)]);
            at_px.iter_mut().for_each(|v| *v += placing.scatter_px * random.normal());
            if random.uniform() < placing.outlier_share {
                let (sin, cos) = (TAU * random.uniform()).sin_cos();
                at_px = [at_px[0] + OUTLIER_PX * cos, at_px[1] + OUTLIER_PX * sin];
            }
            let sd_px = placing.scatter_px.hypot(weights.landmark_sd_m * PX_PER_M);
            points.push(PointObservation { keypoint, at_px, sd_px, state: KeypointState::Visible });
        }
        let label = |down| if down { StanceLabel::Stance } else { StanceLabel::Swing };
        let contacts = if placing.labelled { self.down[panel].map(label) } else { [StanceLabel::Unknown; 4] };
        PanelObservation { camera, points, contacts }
    }
}

/// The reference horse, 0.9 to 1.1 times as large, each bone up to 8 % longer or shorter than that.
fn random_horse(random: &mut Random) -> Skeleton {
    let mut horse = Skeleton::reference().scaled(random.between(0.9, 1.1) as f32);
    let factors: [f64; SHARED] = std::array::from_fn(|_| random.between(0.92, 1.08));
    for (i, bone) in horse.bones.iter_mut().enumerate() {
        bone.length_m *= factors[log_length(i)] as f32;
    }
    horse.dock_from_croup_m = horse.dock_from_croup_m.map(|v| v * factors[LOG_DOCK] as f32);
    horse
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chain::Attachment;
    use crate::layout::{BENDS, SLIDES};
    use muybridge_core::BONE_COUNT;

    #[test]
    fn stance_toes_rest_on_the_ground_and_swing_toes_are_over_it() {
        for seed in 0..20 {
            let stride = SyntheticStride::new(seed, 24);
            let mut prints: [Option<f64>; 4] = [None; 4];
            for panel in 0..48 {
                let (turn, panel) = (panel / 24, panel % 24);
                let k = stride.kinematics(panel);
                for limb in Limb::ALL {
                    let [x, y] = k.place(Attachment::Tip(limb.hoof_bone()));
                    let x = x + turn as f64 * stride.speed_m_s * stride.stride_time_s;
                    let print = &mut prints[limb.index()];
                    if !stride.down[panel][limb.index()] {
                        assert!(y > -0.01, "seed {seed} {limb:?} panel {panel}: {y:.3} m");
                        *print = None;
                        continue;
                    }
                    let slid = x - *print.get_or_insert(x);
                    assert!(
                        y.abs() < 1e-6 && slid.abs() < 1e-6,
                        "seed {seed} {limb:?} panel {panel}: {y} {slid}"
                    );
                }
            }
        }
    }

    #[test]
    fn bends_and_slides_stay_within_the_limits() {
        for seed in 0..20 {
            let stride = SyntheticStride::new(seed, 24);
            let chain = &stride.chain;
            for (panel, pose) in stride.poses.iter().enumerate() {
                for i in 0..BONE_COUNT {
                    let [low, high] = chain.limits_rad[i];
                    let (bend, name) = (pose[BENDS + i], &stride.horse.bones[i].name);
                    assert!(
                        (low..=high).contains(&bend),
                        "seed {seed} panel {panel} {name}: {:.0}",
                        bend.to_degrees()
                    );
                }
                assert!(pose[SLIDES..].iter().all(|slide| slide.abs() < 0.06));
            }
        }
    }
}
