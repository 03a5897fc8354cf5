//! What is measured on a horse, and what it is measured against.

use muybridge_core::{Gait, Limb, Side};

use super::super::{HorseModel, HorseMotion};
use super::scene::Scene;

/// Step of measuring, s.
const STEP_S: f64 = 1.0 / 120.0;
/// Speeds and phases at which the database's range is read.
const SPEEDS: usize = 8;
const PHASES: usize = 48;
/// A standing hoof is this near its print, m.
const HIT_M: f64 = 1e-3;
/// The croup is no farther beyond the range of the database than this, m: on slopes and in turns the body is drawn to its feet.
const HEIGHT_MARGIN_M: f64 = 0.04;
/// The same for its pitch, rad.
const PITCH_MARGIN_RAD: f64 = 0.01;
/// The pose's centre of mass is this near the wanted one, m: the legs are not quite where the gait has them.
const MASS_M: f32 = 0.03;
/// No joint goes faster than this many times the fastest of the gait.
const FASTER: f32 = 3.0;

/// Ranges of root height over the ground (m) and pitch against it (rad).
#[derive(Clone, Copy, Debug)]
pub(crate) struct TrunkRange {
    pub(crate) height_m: [f64; 2],
    pub(crate) pitch_rad: [f64; 2],
    /// Greatest change of a bend in a step, rad.
    pub(crate) jump_rad: f32,
}

impl Default for TrunkRange {
    fn default() -> Self {
        let none = [f64::INFINITY, f64::NEG_INFINITY];
        Self { height_m: none, pitch_rad: none, jump_rad: 0.0 }
    }
}

impl TrunkRange {
    fn add(&mut self, height_m: f64, pitch_rad: f64) {
        let wider = |[low, high]: [f64; 2], value: f64| [low.min(value), high.max(value)];
        self.height_m = wider(self.height_m, height_m);
        self.pitch_rad = wider(self.pitch_rad, pitch_rad);
    }
}

/// The range of all strides of a gait in the database.
pub(crate) fn gait_range(model: &HorseModel, gait: Gait) -> TrunkRange {
    let [low, high] = model.speed_range_m_s(gait);
    let mut range = TrunkRange::default();
    for i in 0..=SPEEDS {
        let speed_m_s = low + (high - low) * i as f32 / SPEEDS as f32;
        let own = model.repertoire().own_gait(gait, Side::Right, speed_m_s);
        for k in 0..PHASES {
            let phase = k as f32 / PHASES as f32;
            let pose = own.pose(phase, [phase; 4]);
            let pitch = 2.0 * pose.world_from_root.z.atan2(pose.world_from_root.w);
            range.add(f64::from(pose.root_in_world.y), f64::from(pitch));
        }
        let steps = (f64::from(own.stride_time_s()) / STEP_S) as usize;
        for k in 0..steps {
            let at = |k: usize| own.pose(k as f32 / steps as f32, [k as f32 / steps as f32; 4]).bends_rad;
            range.jump_rad = range.jump_rad.max(farthest(&at(k), &at(k + 1)));
        }
    }
    range
}

fn farthest(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

/// The worst of a motion.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Measured {
    /// From a standing hoof to its print, m.
    pub(crate) miss_m: f64,
    /// A standing hoof's way from one step to the next, m.
    pub(crate) slide_m: f64,
    /// How far the body was drawn, m.
    pub(crate) drawn_m: f64,
    /// Root.
    pub(crate) trunk: TrunkRange,
    /// How far a bend is beyond its limits, rad.
    pub(crate) over_limit_rad: f32,
    /// From where the curve and the giving way have the centre of mass to the pose's, m.
    pub(crate) mass_off_m: f32,
}

impl Measured {
    pub(crate) fn new(scene: &Scene, motion: &HorseMotion) -> Self {
        let mut worst = Self::default();
        let skeleton = scene.plan.gait().model.skeleton();
        let mut before = None;
        for i in 0..=(scene.placed.end_s / STEP_S) as usize {
            let time_s = i as f64 * STEP_S;
            let pose = motion.pose(time_s);
            let joints = pose.joints(skeleton);
            assert!(joints.tips.iter().all(|tip| tip.is_finite()));
            let mut toes = [None; 4];
            for print in &scene.placed.prints {
                if (print.strike_s..=print.lift_off_s).contains(&time_s) {
                    let limb = Limb::ALL[print.foot.index()];
                    let toe = joints.toe(limb).as_dvec3();
                    worst.miss_m = worst.miss_m.max(toe.distance(print.middle));
                    toes[limb.index()] = Some((print.middle, toe));
                }
            }
            for (bend, bone) in pose.bends_rad.iter().zip(&skeleton.bones) {
                let [low, high] = bone.limits_rad;
                worst.over_limit_rad = worst.over_limit_rad.max(low - bend).max(bend - high);
            }
            if let Some((bends, stood)) = before.replace((pose.bends_rad, toes)) {
                worst.trunk.jump_rad = worst.trunk.jump_rad.max(farthest(&bends, &pose.bends_rad));
                for (a, b) in stood.into_iter().zip(toes) {
                    if let (Some((print, a)), Some((same, b))) = (a, b)
                        && print == same
                    {
                        worst.slide_m = worst.slide_m.max(a.distance(b));
                    }
                }
            }
            worst.measure_trunk(scene, time_s, &pose);
            worst.drawn_m = worst.drawn_m.max(motion.giving.at(time_s).length());
            let wanted = motion.trajectory.at(time_s).at + motion.giving.at(time_s);
            worst.mass_off_m = worst.mass_off_m.max(pose.centre_of_mass(skeleton).distance(wanted.as_vec3()));
        }
        worst
    }

    fn measure_trunk(&mut self, scene: &Scene, time_s: f64, pose: &muybridge_core::Pose) {
        let root = pose.root_in_world.as_dvec3();
        let rise_rad = scene.plan.trunk().rise_rad(time_s);
        let ahead = (pose.world_from_root * glam::Vec3::X).as_dvec3();
        let pitch_rad = ahead.y.atan2(ahead.x.hypot(ahead.z)) - rise_rad;
        let (ground_m, _) = scene.track.terrain.at(root.x, root.z);
        self.trunk.add(root.y - ground_m, pitch_rad);
    }

    pub(crate) fn and(mut self, other: &Self) -> Self {
        self.miss_m = self.miss_m.max(other.miss_m);
        self.slide_m = self.slide_m.max(other.slide_m);
        self.drawn_m = self.drawn_m.max(other.drawn_m);
        for i in 0..2 {
            self.trunk.add(other.trunk.height_m[i], other.trunk.pitch_rad[i]);
        }
        self.trunk.jump_rad = self.trunk.jump_rad.max(other.trunk.jump_rad);
        self.over_limit_rad = self.over_limit_rad.max(other.over_limit_rad);
        self.mass_off_m = self.mass_off_m.max(other.mass_off_m);
        self
    }

    /// Asserts what must be true of a horse on laid prints.
    pub(crate) fn assert_good(&self, gait: Gait, range: &TrunkRange) {
        assert!(self.miss_m < HIT_M && self.slide_m < HIT_M, "{gait}: {self:?}");
        let [low, high] = range.height_m;
        let [least, most] = self.trunk.height_m;
        assert!(least > low - HEIGHT_MARGIN_M && most < high + HEIGHT_MARGIN_M, "{gait}: {self:?} {range:?}");
        let [low, high] = range.pitch_rad;
        let [least, most] = self.trunk.pitch_rad;
        assert!(
            least > low - PITCH_MARGIN_RAD && most < high + PITCH_MARGIN_RAD,
            "{gait}: {self:?} {range:?}"
        );
        assert!(self.mass_off_m < MASS_M, "{gait}: {self:?}");
        assert!(self.over_limit_rad <= 1e-5, "{gait}: {self:?}");
        assert!(self.trunk.jump_rad < FASTER * range.jump_rad, "{gait}: {self:?} {range:?}");
    }
}
