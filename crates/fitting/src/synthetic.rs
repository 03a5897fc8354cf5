//! Horses whose motion is known exactly, for tests, benchmarks and specimen plates.
//!
//! [`SyntheticStride::new`] makes a trot or a canter from a few harmonics around the rest pose;
//! [`SyntheticStride::of_gait`] makes each gait of the horse, and a leap over a hurdle, with the footfalls and joint
//! excursions that are known of it. In all of them a toe keeps one place on the ground for the length of its stance, so
//! that contact labels are true as well: it neither slides nor sinks.

mod carriage;
mod curve;
mod gaits;
mod hurdle;
mod leap;
mod leap_body;
mod leap_numbers;
mod legs;
mod motion;
mod posed;
mod source;
mod stepping;

use std::f64::consts::TAU;

use muybridge_capture::{Facing, KEYPOINT_COUNT, Keypoint, KeypointState, PanelCamera, StanceLabel};
use muybridge_core::{Gait, Lead, Limb, Side, Skeleton};

use crate::chain::{Chain, Kinematics};
use crate::layout::{LOG_DOCK, PANEL_DOF, SHARED, log_length};
use crate::observation::{PanelObservation, PointObservation, StrideObservation, attachment, depth_m};
use crate::weights::Weights;
use gaits::GaitNumbers;
pub use hurdle::Hurdle;
use leap::Leap;
pub(crate) use leap_body::{LeapBody, LeapStance};
pub(crate) use legs::eased;
use motion::{CANTER, Motion, TROT};
use muybridge_core::Random;
pub use posed::{HoofPrint, Posed};
use source::Source;
use stepping::Stepping;

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
    /// Speed, m/s; the mean speed of a leap.
    pub speed_m_s: f64,
    /// Duration of the stride or the leap, s; the panels share it evenly.
    pub stride_time_s: f64,
    /// Root place, pitch, bends and slides of each panel, in the layout of the fit's unknowns.
    pub poses: Vec<[f64; PANEL_DOF]>,
    /// Whether each leg is down in each panel, in the order of [`Limb::ALL`].
    pub down: Vec<[bool; 4]>,
    /// The gait.
    pub gait: Gait,
    /// Lead of an asymmetrical gait.
    pub lead: Option<Lead>,
    /// What is leapt over.
    pub hurdle: Option<Hurdle>,
    chain: Chain,
    source: Source,
    seed: u64,
}

impl SyntheticStride {
    /// A horse, its gait and its motion from a seed; even seeds trot, odd ones canter. Its poses are harmonics of few
    /// parameters, as the fit's own curves are; see [`Self::of_gait`] for motions that look like a horse's.
    pub fn new(seed: u64, panels: usize) -> Self {
        let mut random = Random::new(seed);
        let horse = random_horse(&mut random, 0.08);
        let trots = seed.is_multiple_of(2);
        let gait = if trots { TROT } else { CANTER }.scaled(size(&horse));
        let mut motion = Motion::new(gait, Chain::new(&horse), &mut random);
        motion.stand_on_the_ground();
        let phases: Vec<f64> = (0..panels).map(|k| k as f64 / panels as f64).collect();
        Self {
            facing: facing(seed),
            gait: if trots { Gait::Trot } else { Gait::Canter },
            lead: (!trots).then_some(Lead { fore: Side::Right, hind: Side::Right }),
            speed_m_s: gait.speed_m_s,
            stride_time_s: gait.stride_time_s,
            poses: phases.iter().map(|phase| motion.pose(*phase)).collect(),
            down: phases.iter().map(|phase| Limb::ALL.map(|limb| gait.down(limb, *phase))).collect(),
            hurdle: None,
            chain: Chain::new(&horse),
            horse,
            source: Source::Harmonic(Box::new(motion)),
            seed,
        }
    }

    /// A horse and its motion at a gait from a seed, with the footfalls, speeds and joint excursions that are known of
    /// that gait. A stride of the six gaits begins at any phase of it; a leap is a stretch of canter with a hurdle in
    /// its midst, from the last approach to the landing of the hinds. Seeds choose facing, lead, size and proportions.
    pub fn of_gait(gait: Gait, seed: u64, panels: usize) -> Self {
        let mut random = Random::new(seed);
        let horse = random_horse(&mut random, 0.04);
        let on_right = random.uniform() < 0.5;
        let hurry = random.between(0.96, 1.04);
        let side = if on_right { Side::Right } else { Side::Left };
        let lead = Some(Lead { fore: side, hind: side });
        let (source, lead) = match GaitNumbers::of(gait) {
            Some(numbers) => {
                let sided = if on_right { numbers } else { numbers.mirrored() };
                let gone = sided.scaled(size(&horse)).hurried(hurry);
                let lead = lead.filter(|_| numbers.asymmetrical);
                (Source::Stepping(Box::new(Stepping::new(&horse, gone, &mut random))), lead)
            }
            None => (Source::Leap(Box::new(Leap::new(&horse, side, size(&horse), &mut random))), lead),
        };
        let duration_s = source.duration_s();
        let times_s = (0..panels).map(|k| duration_s * k as f64 / panels as f64);
        Self {
            facing: facing(seed),
            gait,
            lead,
            speed_m_s: source.speed_m_s(),
            stride_time_s: duration_s,
            poses: times_s.clone().map(|time_s| source.pose(time_s)).collect(),
            down: times_s.map(|time_s| source.down(time_s)).collect(),
            hurdle: source.hurdle(),
            chain: Chain::new(&horse),
            horse,
            source,
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
        StrideObservation {
            facing: self.facing,
            speed_m_s: self.speed_m_s,
            withers_height_m: None,
            panels: panels.collect(),
        }
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

/// Withers height against the reference's.
fn size(horse: &Skeleton) -> f64 {
    f64::from(horse.withers_height_m / Skeleton::reference().withers_height_m)
}

fn facing(seed: u64) -> Facing {
    if seed % 4 < 2 { Facing::Right } else { Facing::Left }
}

/// The reference horse, 0.9 to 1.1 times as large, each bone longer or shorter than that by up to a share of it.
fn random_horse(random: &mut Random, share: f64) -> Skeleton {
    let mut horse = Skeleton::reference().scaled(random.between(0.9, 1.1) as f32);
    let factors: [f64; SHARED] = std::array::from_fn(|_| random.between(1.0 - share, 1.0 + share));
    for (i, bone) in horse.bones.iter_mut().enumerate() {
        bone.length_m *= factors[log_length(i)] as f32;
    }
    horse.dock_from_croup_m = horse.dock_from_croup_m.map(|v| v * factors[LOG_DOCK] as f32);
    horse
}

#[cfg(test)]
mod tests;
