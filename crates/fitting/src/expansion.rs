//! A stride at another speed (Huang 2012, Eq. 3.3 and 3.4; spec 4.4).
//!
//! The stance time of each pair follows its law; swing keeps the duration of the capture, so that the stride becomes
//! their sum and the duty factor falls with speed. Strikes keep their phases. Each toe's path relative to its shoulder
//! or hip is scaled by `D'/D` along the track and over the ground, the stance toe stands still, and the leg is solved
//! anew by damped least squares.

use muybridge_core::{CURVE_SAMPLES, Contact, Limb, Pair, Pose, PowerLaw, Provenance, Skeleton, Stride};
use nalgebra::{Matrix2, SMatrix, Vector2};

/// Damping of the leg solution, m per rad: large enough to stay calm at full stretch, small against a leg of a metre.
const DAMPING_M: f64 = 0.02;
/// Willingness of each joint to turn, root to fetlock: scapula and pelvis carry the trunk and give way last.
const WILLING: [f64; 5] = [0.3, 1.0, 1.0, 1.0, 1.0];
/// Solver steps per sample; errors fall by more than half at each.
const STEPS: usize = 40;
/// A toe farther than this from its wanted place after solving makes the speed unreachable, m.
const REACH_TOLERANCE_M: f64 = 0.015;

/// A captured stride at another speed, under the stance laws of fore and hind limbs; none where a leg cannot reach.
pub fn expand(
    captured: &Stride,
    reference: &Skeleton,
    laws: [PowerLaw; 2],
    speed_m_s: f64,
) -> Option<Stride> {
    let timing = Timing::new(captured, laws, speed_m_s);
    let skeleton = captured.skeleton(reference);
    let mut stride = captured.clone();
    stride.speed_m_s = speed_m_s as f32;
    stride.stride_time_s = timing.stride_time_s as f32;
    stride.contacts = timing.contacts;
    stride.curves.surge_m.iter_mut().for_each(|surge| *surge *= timing.mean_step_ratio as f32);
    stride.provenance = Provenance::Derived {
        from: vec![captured.id.clone()],
        how: format!(
            "expanded from {:.1} to {speed_m_s:.1} m/s by its gait's stance laws",
            captured.speed_m_s
        ),
    };
    let stride_length_m = speed_m_s * timing.stride_time_s;
    for limb in Limb::ALL {
        let path = ToePath::new(captured, &skeleton, &stride, limb, &timing, stride_length_m);
        stride.prints_m[limb.index()] = path.print_m as f32;
        solve_leg(&mut stride, &skeleton, limb, &path)?;
    }
    Some(stride)
}

/// Stance and stride times at the new speed.
struct Timing {
    stride_time_s: f64,
    contacts: [Contact; 4],
    /// `D'/D` for fore and hind.
    step_ratios: [f64; 2],
    mean_step_ratio: f64,
}

impl Timing {
    fn new(captured: &Stride, laws: [PowerLaw; 2], speed_m_s: f64) -> Self {
        let (old_speed, old_stride) = (f64::from(captured.speed_m_s), f64::from(captured.stride_time_s));
        let time_ratio = |pair: Pair| {
            let law = laws[pair as usize];
            law.contact_time_s(speed_m_s) / law.contact_time_s(old_speed)
        };
        let duty = |limb: Limb| f64::from(captured.contacts[limb.index()].duty_factor());
        let stance_s = Limb::ALL.map(|limb| duty(limb) * old_stride * time_ratio(limb.pair()));
        let swing_s = Limb::ALL.map(|limb| (1.0 - duty(limb)) * old_stride);
        let stride_time_s = (0..4).map(|i| stance_s[i] + swing_s[i]).sum::<f64>() / 4.0;
        let contacts = Limb::ALL.map(|limb| {
            let strike_phase = captured.contacts[limb.index()].strike_phase;
            let duty = (stance_s[limb.index()] / stride_time_s) as f32;
            Contact { strike_phase, lift_off_phase: (strike_phase + duty).rem_euclid(1.0) }
        });
        let step_ratios = [Pair::Fore, Pair::Hind].map(|pair| speed_m_s / old_speed * time_ratio(pair));
        let mean_step_ratio = 0.5 * (step_ratios[0] + step_ratios[1]);
        Self { stride_time_s, contacts, step_ratios, mean_step_ratio }
    }
}

/// Where a toe is to be at each sample: metres along the track from the root's place at phase 0, and height.
struct ToePath {
    places: Vec<[f64; 2]>,
    print_m: f64,
}

impl ToePath {
    fn new(
        captured: &Stride,
        skeleton: &Skeleton,
        new: &Stride,
        limb: Limb,
        timing: &Timing,
        stride_length_m: f64,
    ) -> Self {
        let ratio = timing.step_ratios[limb.pair() as usize];
        let (old, contact) = (captured.contacts[limb.index()], timing.contacts[limb.index()]);
        let strike = f64::from(contact.strike_phase);
        let duty = f64::from(contact.duty_factor());
        // Toe ahead of its shoulder or hip in the capture at the same point of its own step cycle.
        let ahead = |phase: f64| {
            let old_phase = same_step(phase, contact, old);
            let joints = captured.pose(old_phase as f32).joints(skeleton);
            let (toe, root) = (joints.toe(limb), joints.tips[limb.first_bone()]);
            [f64::from(toe.x - root.x), f64::from(toe.y)]
        };
        let root_x = |phase: f64| {
            let joints = new.pose(phase as f32).joints(skeleton);
            f64::from(joints.tips[limb.first_bone()].x)
        };
        let scaled_x = |phase: f64| root_x(phase) + ratio * ahead(phase)[0];
        let print_m = scaled_x(strike + 0.5 * duty);
        // What the scaled path misses the prints by, at lift-off and at the next strike; spread over the swing.
        let leaving = print_m - scaled_x(strike + duty);
        let arriving = print_m + stride_length_m - scaled_x(strike + 1.0);
        let stance_y = ahead(strike + 0.5 * duty)[1];
        let places = (0..CURVE_SAMPLES)
            .map(|k| {
                let phase = k as f64 / CURVE_SAMPLES as f64;
                let since = (phase - strike).rem_euclid(1.0);
                let turn = phase - strike - since;
                if since < duty {
                    return [print_m + turn * stride_length_m, 0.0];
                }
                let swing = (since - duty) / (1.0 - duty);
                let x = scaled_x(phase) + leaving + (arriving - leaving) * swing;
                [x, (ratio * (ahead(phase)[1] - stance_y)).max(0.0)]
            })
            .collect();
        Self { places, print_m }
    }
}

/// The phase of the old stride at the same point of a leg's step cycle: stance to stance, swing to swing, linearly.
fn same_step(phase: f64, new: Contact, old: Contact) -> f64 {
    let since = (phase - f64::from(new.strike_phase)).rem_euclid(1.0);
    let (new_duty, old_duty) = (f64::from(new.duty_factor()), f64::from(old.duty_factor()));
    let old_since = if since < new_duty {
        since / new_duty * old_duty
    } else {
        old_duty + (since - new_duty) / (1.0 - new_duty) * (1.0 - old_duty)
    };
    f64::from(old.strike_phase) + old_since
}

/// Solves a leg's five joints for every sample of the path, starting from the captured bends.
fn solve_leg(stride: &mut Stride, skeleton: &Skeleton, limb: Limb, path: &ToePath) -> Option<()> {
    let first = limb.first_bone();
    for (k, target) in path.places.iter().enumerate() {
        let mut pose = stride.pose(k as f32 / CURVE_SAMPLES as f32);
        let error = reach(&mut pose, skeleton, limb, *target);
        if error > REACH_TOLERANCE_M {
            return None;
        }
        for bone in first..first + 5 {
            stride.curves.bends_rad[bone][k] = pose.bends_rad[bone];
        }
    }
    Some(())
}

/// Moves a leg's toe to a place by damped least squares within the joint limits; returns what is left, m.
fn reach(pose: &mut Pose, skeleton: &Skeleton, limb: Limb, [x, y]: [f64; 2]) -> f64 {
    let first = limb.first_bone();
    let mut left = f64::INFINITY;
    for _ in 0..STEPS {
        let joints = pose.joints(skeleton);
        let toe = joints.toe(limb);
        let miss = Vector2::new(x - f64::from(toe.x), y - f64::from(toe.y));
        left = miss.norm();
        if left < 1e-5 {
            break;
        }
        let jacobian = SMatrix::<f64, 2, 5>::from_fn(|axis, joint| {
            let lever = toe - joints.bases[first + joint];
            WILLING[joint] * f64::from(if axis == 0 { -lever.y } else { lever.x })
        });
        let damped = jacobian * jacobian.transpose() + Matrix2::identity() * DAMPING_M * DAMPING_M;
        let Some(solved) = damped.lu().solve(&miss) else { break };
        let turn = jacobian.transpose() * solved;
        for joint in 0..5 {
            let [low, high] = skeleton.bones[first + joint].limits_rad;
            let bend = &mut pose.bends_rad[first + joint];
            *bend = (*bend + (WILLING[joint] * turn[joint]) as f32).clamp(low, high);
        }
    }
    left
}
