//! Strides with every number known: good ones of each gait, to be made wrong in one respect at a time.

use std::f64::consts::PI;

use muybridge_core::{
    CURVE_SAMPLES, Contact, Curves, DATABASE_SCHEMA, Database, Gait, Lead, Limb, Pair, Pose, Provenance,
    Side, Skeleton, Stride,
};
use nalgebra::{Matrix2, SMatrix, Vector2};

use super::{Check, check_database, check_stride};

/// Share of the stride a toe stays where it stands before its strike and after its lift-off, so that curves between their
/// samples do not cut the corner.
const LINGER: f64 = 2.0 / CURVE_SAMPLES as f64;
/// The croup is carried this much lower than in standing, so that legs reach forward and back, m.
const CROUCH_M: f64 = 0.14;
/// Steps, damping and turning of the leg solution; the knee does not take part.
const STEPS: usize = 200;
const DAMPING_M: f64 = 0.02;
const WILLING: [[f64; 5]; 2] = [[0.5, 1.0, 1.0, 0.0, 1.0], [0.5, 1.0, 1.0, 1.0, 1.0]];
/// The foreleg's bone that bends at the knee.
const METACARPAL: usize = 3;

/// What a stride is made from.
#[derive(Clone, Copy, Debug)]
pub(super) struct Specimen {
    pub(super) id: &'static str,
    pub(super) gait: Gait,
    pub(super) lead: Option<Lead>,
    pub(super) speed_m_s: f64,
    pub(super) stride_time_s: f64,
    pub(super) strikes: [f64; 4],
    pub(super) duties: [f64; 4],
    /// Bend of both knees, degrees.
    pub(super) knee_deg: f64,
    /// How far a toe slides over its stance, m.
    pub(super) toe_slide_m: f64,
    /// Height of standing toes, m.
    pub(super) toe_height_m: f64,
    /// Height of toes in the middle of their swing, m.
    pub(super) clearance_m: f64,
    /// Hind prints this far ahead of where standing hind feet would be, m.
    pub(super) hind_ahead_m: f64,
}

const RIGHT: Lead = Lead { fore: Side::Right, hind: Side::Right };

impl Specimen {
    pub(super) fn trot() -> Self {
        Self {
            id: "trot",
            gait: Gait::Trot,
            lead: None,
            speed_m_s: 3.0,
            stride_time_s: 0.65,
            strikes: [0.5, 0.0, 0.0, 0.5],
            duties: [0.38; 4],
            knee_deg: 0.0,
            toe_slide_m: 0.0,
            toe_height_m: 0.0,
            clearance_m: 0.06,
            hind_ahead_m: 0.0,
        }
    }

    pub(super) fn walk() -> Self {
        Self {
            id: "walk",
            gait: Gait::Walk,
            speed_m_s: 1.5,
            stride_time_s: 1.11,
            strikes: [0.25, 0.75, 0.0, 0.5],
            duties: [0.52; 4],
            ..Self::trot()
        }
    }

    pub(super) fn amble() -> Self {
        Self {
            id: "amble",
            gait: Gait::Amble,
            speed_m_s: 2.6,
            stride_time_s: 0.65,
            duties: [0.42; 4],
            ..Self::walk()
        }
    }

    pub(super) fn canter() -> Self {
        Self {
            id: "canter",
            gait: Gait::Canter,
            lead: Some(RIGHT),
            speed_m_s: 4.0,
            stride_time_s: 0.60,
            strikes: [0.3, 0.6, 0.0, 0.3],
            duties: [0.33; 4],
            ..Self::trot()
        }
    }

    pub(super) fn gallop() -> Self {
        Self {
            id: "gallop",
            gait: Gait::Gallop,
            speed_m_s: 8.3,
            stride_time_s: 0.45,
            strikes: [0.35, 0.52, 0.0, 0.15],
            duties: [0.26, 0.26, 0.28, 0.28],
            ..Self::canter()
        }
    }

    /// The stride of the reference horse.
    pub(super) fn stride(&self) -> Stride {
        let skeleton = Skeleton::reference();
        let mut stride = self.standing(&skeleton);
        for limb in Limb::ALL {
            let print_m = self.print_m(&skeleton, limb);
            stride.prints_m[limb.index()] = print_m as f32;
            for k in 0..CURVE_SAMPLES {
                let phase = k as f64 / CURVE_SAMPLES as f64;
                let mut pose = stride.pose(phase as f32);
                reach(&mut pose, &skeleton, limb, self.toe(limb, print_m, phase));
                for bone in limb.first_bone()..limb.first_bone() + 5 {
                    stride.curves.bends_rad[bone][k] = pose.bends_rad[bone];
                }
            }
        }
        stride
    }

    /// The horse as it stands, carried along.
    fn standing(&self, skeleton: &Skeleton) -> Stride {
        let flat = |value: f32| vec![value; CURVE_SAMPLES];
        let mut bends_rad: Vec<Vec<f32>> =
            skeleton.bones.iter().map(|bone| flat(bone.rest_bend_rad)).collect();
        for limb in [Limb::LF, Limb::RF] {
            bends_rad[limb.first_bone() + METACARPAL] = flat(self.knee_deg.to_radians() as f32);
        }
        let contact = |i: usize| Contact {
            strike_phase: self.strikes[i] as f32,
            lift_off_phase: (self.strikes[i] + self.duties[i]).rem_euclid(1.0) as f32,
        };
        Stride {
            id: self.id.into(),
            gait: self.gait,
            lead: self.lead,
            speed_m_s: self.speed_m_s as f32,
            stride_time_s: self.stride_time_s as f32,
            withers_height_m: skeleton.withers_height_m,
            bone_lengths_m: skeleton.bones.iter().map(|bone| bone.length_m).collect(),
            contacts: [0, 1, 2, 3].map(contact),
            prints_m: [0.0; 4],
            curves: Curves {
                surge_m: flat(0.0),
                height_m: flat(skeleton.croup_height_m - CROUCH_M as f32),
                pitch_rad: flat(0.0),
                bends_rad,
                scapula_slides_m: vec![flat(0.0); 2],
            },
            provenance: Provenance::Derived {
                from: vec!["reference horse".into()],
                how: "made for a test".into(),
            },
        }
    }

    fn stride_length_m(&self) -> f64 {
        self.speed_m_s * self.stride_time_s
    }

    /// A toe stands so that in the middle of its stance it is where it is in the standing horse.
    fn print_m(&self, skeleton: &Skeleton, limb: Limb) -> f64 {
        let rest = f64::from(Pose::standing(skeleton).joints(skeleton).toe(limb).x);
        let middle = self.strikes[limb.index()] + 0.5 * self.duties[limb.index()];
        let ahead = if limb.pair() == Pair::Hind { self.hind_ahead_m } else { 0.0 };
        middle * self.stride_length_m() + rest + ahead
    }

    /// Where a toe is at a phase: on its print, or from one print to the next on half a wave.
    fn toe(&self, limb: Limb, print_m: f64, phase: f64) -> [f64; 2] {
        let (strike, duty) = (self.strikes[limb.index()], self.duties[limb.index()]);
        let since = (phase - strike + LINGER).rem_euclid(1.0) - LINGER;
        let turns = (phase - strike - since).round();
        let slid = self.toe_slide_m * ((since / duty).clamp(0.0, 1.0) - 0.5);
        let swing = ((since - duty - LINGER) / (1.0 - duty - 2.0 * LINGER)).max(0.0);
        let forward = 0.5 * (1.0 - (PI * swing).cos());
        let x =
            print_m + turns * self.stride_length_m() + slid + forward * (self.stride_length_m() - 2.0 * slid);
        [x, self.toe_height_m + self.clearance_m * (PI * swing).sin().powi(2)]
    }
}

/// Moves a leg's toe to a place; panics where it cannot, for then the specimen is none.
fn reach(pose: &mut Pose, skeleton: &Skeleton, limb: Limb, [x, y]: [f64; 2]) {
    let first = limb.first_bone();
    let willing = WILLING[limb.pair() as usize];
    let mut left = f64::INFINITY;
    for _ in 0..STEPS {
        let joints = pose.joints(skeleton);
        let toe = joints.toe(limb);
        let miss = Vector2::new(x - f64::from(toe.x), y - f64::from(toe.y));
        left = miss.norm();
        if left < 2e-6 {
            break;
        }
        let jacobian = SMatrix::<f64, 2, 5>::from_fn(|axis, joint| {
            let lever = toe - joints.bases[first + joint];
            willing[joint] * f64::from(if axis == 0 { -lever.y } else { lever.x })
        });
        let damped = jacobian * jacobian.transpose() + Matrix2::identity() * DAMPING_M * DAMPING_M;
        let turn = jacobian.transpose() * damped.lu().solve(&miss).unwrap();
        for joint in 0..5 {
            let [low, high] = skeleton.bones[first + joint].limits_rad;
            let bend = &mut pose.bends_rad[first + joint];
            *bend = (*bend + (willing[joint] * turn[joint]) as f32).clamp(low, high);
        }
    }
    assert!(left < 1e-4, "{limb:?} misses {x:.3} {y:.3} by {left:.4} m");
}

/// What the checks find in one stride; each finding is printed for a failing test.
pub(super) fn checks_of(stride: &Stride) -> Vec<Check> {
    let found = check_stride(stride, &Skeleton::reference());
    found.iter().for_each(|deviation| println!("{deviation}"));
    distinct(found.into_iter().map(|deviation| deviation.check))
}

/// What the checks find in a database of these strides.
pub(super) fn checks_of_all(strides: &[Stride]) -> Vec<Check> {
    let database = Database {
        schema: DATABASE_SCHEMA,
        generator: "test".into(),
        laws: Vec::new(),
        strides: strides.to_vec(),
    };
    let found = check_database(&database, &Skeleton::reference());
    found.iter().for_each(|deviation| println!("{deviation}"));
    distinct(found.into_iter().map(|deviation| deviation.check))
}

/// Checks without repetition, in the order of [`Check`].
fn distinct(checks: impl Iterator<Item = Check>) -> Vec<Check> {
    checks.collect::<std::collections::BTreeSet<Check>>().into_iter().collect()
}
