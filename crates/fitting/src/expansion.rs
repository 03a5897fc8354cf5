//! A stride at another speed (Huang 2012, Eq. 3.3 and 3.4; spec 4.4).
//!
//! The stance time of each pair follows its law; swing keeps the duration of the capture, so that the stride becomes
//! their sum and the duty factor falls with speed. Strikes keep their phases. Each toe's path relative to its shoulder
//! or hip is scaled by `D'/D` along the track and over the ground; a standing toe stands still on the ground exactly, leaves it
//! and comes to it without a jerk, and the leg is solved anew by damped least squares. Where a leg would have to
//! be stretched to its last hundredth, a toe in the air is drawn in and for a standing one the body is lowered: the body gives way, not
//! the foot.

use muybridge_core::{CURVE_SAMPLES, Contact, Limb, Pair, Pose, Provenance, Skeleton, Stride};

use crate::leg_reach::{LegBends, Willingness, leg_bends, reach_from};

/// Greatest stretch of a standing leg before the body gives way, root to toe as a share of its bones' lengths. Joints turn ever faster as
/// a leg comes to its last hundredth; the plates that stand for their gaits show standing legs stretched to 0.983 at most.
const STRETCH: f64 = 0.985;
/// Width of the rounding with which a leg in the air comes to that stretch, as a share of its length.
const STRETCH_EDGE: f64 = 0.05;
/// Samples on either side of a stance over which a toe that is held near its print comes to yield to the leg's stretch.
const YIELDING_SAMPLES: f64 = 3.5;
/// A toe in the air that yields may be this far beyond the leg's stretch before the body gives way, m.
const SLACK_M: f64 = 0.06;
/// A standing toe farther than this from its print makes the body give way, m.
const REACH_TOLERANCE_M: f64 = 2e-4;
/// Rounds of lowering the body; each takes away what the worst leg lacks and a little more.
const LOWERING_ROUNDS: usize = 12;
/// How much more than what is lacking the body is lowered: a leg that slants gains less than the body falls.
const LOWERING: f64 = 1.3;
/// Share of the swing, at either end, in which the toe's speed over the ground is led to zero and the loaded foreleg's carpus is
/// freed or locked.
const EASING: f64 = 0.12;

/// Share of a toe's speed along the track and over the ground that is taken away at the ends of its swing. A hoof that slid would be
/// seen at once; one that comes down without any speed would have to hang over its print while the body is still high.
const EASED: [f64; 2] = [1.0, 0.5];

/// Height over the ground that a toe keeps in the middle of its swing, m. Points placed on a sole are good to a centimetre or two, and
/// a hoof that ploughs the ground is seen at once.
const CLEARANCE_M: f64 = 0.025;
/// Samples on either side of a stance over which the toe is let go of its print.
const HELD_SAMPLES: f64 = 4.0;

/// Share of a sample's turn that the next begins with; after a swing's half nothing of an old turn is left.
const CARRIED: f64 = 0.85;

/// How a capture is to go: at which speed, and how long its limbs stand against the capture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pace {
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Stance time over the capture's, of a fore and of a hind limb.
    pub stance_ratios: [f64; 2],
}

/// A captured stride at another pace; none where a standing leg cannot reach even with the body lowered.
pub fn expand(captured: &Stride, reference: &Skeleton, pace: Pace) -> Option<Stride> {
    let timing = Timing::new(captured, pace);
    let skeleton = captured.skeleton(reference);
    let mut stride = captured.clone();
    stride.speed_m_s = pace.speed_m_s as f32;
    stride.stride_time_s = timing.stride_time_s as f32;
    stride.contacts = timing.contacts;
    stride.curves.surge_m.iter_mut().for_each(|surge| *surge *= timing.mean_step_ratio as f32);
    stride.provenance = Provenance::Derived {
        from: vec![captured.id.clone()],
        how: format!(
            "expanded from {:.1} to {:.1} m/s by its gait's stance laws",
            captured.speed_m_s, pace.speed_m_s
        ),
    };
    Limb::ALL.into_iter().for_each(|limb| warp_leg(&mut stride, captured, limb));
    for _ in 0..LOWERING_ROUNDS {
        let mut solved = stride.clone();
        let lacking_m = Limb::ALL
            .into_iter()
            .map(|limb| {
                let path = ToePath::new(captured, &skeleton, &stride, limb, &timing);
                solved.prints_m[limb.index()] = path.print_m as f32;
                solve_leg(&mut solved, &stride, &skeleton, limb, &path)
            })
            .fold(0.0, f64::max);
        if lacking_m < REACH_TOLERANCE_M {
            return Some(solved);
        }
        stride.curves.height_m.iter_mut().for_each(|height| *height -= (LOWERING * lacking_m) as f32);
    }
    None
}

/// Stance and stride times at the new pace.
struct Timing {
    stride_time_s: f64,
    contacts: [Contact; 4],
    /// `D'/D` for fore and hind.
    step_ratios: [f64; 2],
    mean_step_ratio: f64,
}

impl Timing {
    fn new(captured: &Stride, pace: Pace) -> Self {
        let (old_speed, old_stride) = (f64::from(captured.speed_m_s), f64::from(captured.stride_time_s));
        let ratio = |pair: Pair| pace.stance_ratios[pair as usize];
        let duty = |limb: Limb| f64::from(captured.contacts[limb.index()].duty_factor());
        let stance_s = Limb::ALL.map(|limb| duty(limb) * old_stride * ratio(limb.pair()));
        let swing_s = Limb::ALL.map(|limb| (1.0 - duty(limb)) * old_stride);
        let stride_time_s = (0..4).map(|i| stance_s[i] + swing_s[i]).sum::<f64>() / 4.0;
        let contacts = Limb::ALL.map(|limb| {
            let strike_phase = captured.contacts[limb.index()].strike_phase;
            let duty = (stance_s[limb.index()] / stride_time_s) as f32;
            Contact { strike_phase, lift_off_phase: (strike_phase + duty).rem_euclid(1.0) }
        });
        let step_ratios = [Pair::Fore, Pair::Hind].map(|pair| pace.speed_m_s / old_speed * ratio(pair));
        let mean_step_ratio = 0.5 * (step_ratios[0] + step_ratios[1]);
        Self { stride_time_s, contacts, step_ratios, mean_step_ratio }
    }
}

/// A leg's bends, and its scapula's slide, at the same point of its step cycle as in the capture.
fn warp_leg(stride: &mut Stride, captured: &Stride, limb: Limb) {
    let (new, old) = (stride.contacts[limb.index()], captured.contacts[limb.index()]);
    for k in 0..CURVE_SAMPLES {
        let pose = captured.pose(new.same_step(old, sample_phase(k) as f32));
        for bone in limb.first_bone()..=limb.hoof_bone() {
            stride.curves.bends_rad[bone][k] = pose.bends_rad[bone];
        }
        if limb.pair() == Pair::Fore {
            stride.curves.scapula_slides_m[limb.index()][k] = pose.scapula_slides_m[limb.index()];
        }
    }
}

fn sample_phase(k: usize) -> f64 {
    k as f64 / CURVE_SAMPLES as f64
}

/// Where a toe is to be at each sample.
struct ToePath {
    places: Vec<Place>,
    print_m: f64,
}

#[derive(Clone, Copy)]
struct Place {
    /// Metres along the track from the root's place at phase 0, and over the ground.
    at_m: [f64; 2],
    /// 1 in stance, falling to 0 over the ends of the swing.
    load: f64,
    /// How far the toe yields where the leg would be stretched too far: 0 in stance, 1 in the air.
    yielding: f64,
}

impl ToePath {
    fn new(captured: &Stride, skeleton: &Skeleton, new: &Stride, limb: Limb, timing: &Timing) -> Self {
        let ratio = timing.step_ratios[limb.pair() as usize];
        let (old, contact) = (captured.contacts[limb.index()], timing.contacts[limb.index()]);
        let strike = f64::from(contact.strike_phase);
        let duty = f64::from(contact.duty_factor());
        let stride_length_m = f64::from(new.stride_length_m());
        let old_toe = |phase: f64| {
            let joints = captured.pose(contact.same_step(old, phase as f32)).joints(skeleton);
            let (toe, root) = (joints.toe(limb), joints.bases[limb.first_bone()]);
            [f64::from(toe.x - root.x), f64::from(toe.y)]
        };
        let ground_m = old_toe(strike + 0.5 * duty)[1];
        // The toe as it would go by similar triangles alone, at any real phase.
        let similar = |phase: f64| {
            let root = new.pose(phase as f32).joints(skeleton).bases[limb.first_bone()];
            let [ahead_m, height_m] = old_toe(phase);
            [f64::from(root.x) + ratio * ahead_m, ratio * (height_m - ground_m)]
        };
        let print_m = similar(strike + 0.5 * duty)[0];
        let swing = Swing::new([[print_m, 0.0], [print_m + stride_length_m, 0.0]], |share| {
            similar(strike + duty + share * (1.0 - duty))
        });
        let places = (0..CURVE_SAMPLES)
            .map(|k| {
                let phase = sample_phase(k);
                let since = (phase - strike).rem_euclid(1.0);
                let turns_m = (phase - strike - since) * stride_length_m;
                if since <= duty {
                    return Place { at_m: [print_m + turns_m, 0.0], load: 1.0, yielding: 0.0 };
                }
                let share = (since - duty) / (1.0 - duty);
                let free = swing.at(share, similar(strike + since));
                // The curve between samples bends over a contact's edge, so a sample next to it is held near the print.
                let (left, to_come) = (since - duty, 1.0 - since);
                let print = [print_m + if left < to_come { 0.0 } else { stride_length_m }, 0.0];
                let samples = left.min(to_come) * CURVE_SAMPLES as f64;
                let away = smooth(samples / HELD_SAMPLES);
                let [x, y] = [0, 1].map(|axis| print[axis] + away * (free[axis] - print[axis]));
                Place {
                    at_m: [x + turns_m, cleared(y, share)],
                    load: 1.0 - smooth(share.min(1.0 - share) / EASING),
                    yielding: smooth(samples / YIELDING_SAMPLES),
                }
            })
            .collect();
        Self { places, print_m }
    }
}

/// What is added to a toe's path through the air so that it leaves one print and comes to the next at rest.
struct Swing {
    /// What the path misses at lift-off and at strike, m.
    misses_m: [[f64; 2]; 2],
    /// Its speed there, m per swing: as much as [`EASED`] says.
    speeds_m: [[f64; 2]; 2],
}

impl Swing {
    fn new(prints_m: [[f64; 2]; 2], path: impl Fn(f64) -> [f64; 2]) -> Self {
        const STEP: f64 = 0.01;
        let [start, end] = [path(0.0), path(1.0)];
        let (after, before) = (path(STEP), path(1.0 - STEP));
        let each = |f: &dyn Fn(usize) -> f64| [f(0), f(1)];
        Self {
            misses_m: [
                each(&|axis| prints_m[0][axis] - start[axis]),
                each(&|axis| prints_m[1][axis] - end[axis]),
            ],
            speeds_m: [
                each(&|axis| EASED[axis] * (after[axis] - start[axis]) / STEP),
                each(&|axis| EASED[axis] * (end[axis] - before[axis]) / STEP),
            ],
        }
    }

    /// The place at a share of the swing, where the path is at `raw_m`.
    fn at(&self, share: f64, raw_m: [f64; 2]) -> [f64; 2] {
        let (early, late) = (smooth(1.0 - share), smooth(share));
        let [leaving, arriving] = [ease(share), -ease(1.0 - share)];
        let [x, y] = [0, 1].map(|axis| {
            raw_m[axis] + early * self.misses_m[0][axis] + late * self.misses_m[1][axis]
                - leaving * self.speeds_m[0][axis]
                - arriving * self.speeds_m[1][axis]
        });
        [x, y.max(0.0)]
    }
}

/// A height over the ground, m, that is at least the clearance of this share of the swing, without a corner where it takes over.
fn cleared(height_m: f64, share: f64) -> f64 {
    let least_m = CLEARANCE_M * smooth(4.0 * share * (1.0 - share));
    let half = 0.5 * (height_m - least_m);
    0.5 * (height_m + least_m) + half.hypot(0.25 * least_m) - 0.125 * least_m
}

/// From 0 to 1 without a slope at either end.
fn smooth(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Rises with slope 1 from 0 and is back at 0, without a slope, after [`EASING`].
fn ease(share: f64) -> f64 {
    let rest = 1.0 - (share / EASING).clamp(0.0, 1.0);
    share * rest * rest
}

/// Solves a leg's five joints for every sample of its path; returns by how much the worst of those at or near the ground is stretched too
/// far or misses its place, m.
///
/// Samples are taken in turn from the middle of the swing, each beginning with most of what the last one was turned by, so
/// that neighbours find neighbouring solutions.
fn solve_leg(solved: &mut Stride, from: &Stride, skeleton: &Skeleton, limb: Limb, path: &ToePath) -> f64 {
    let contact = from.contacts[limb.index()];
    let middle = contact.lift_off_phase + 0.5 * (1.0 - contact.duty_factor());
    let first = (middle * CURVE_SAMPLES as f32) as usize;
    let mut lacking_m: f64 = 0.0;
    let mut turned: LegBends = [0.0; 5];
    for k in (first..first + CURVE_SAMPLES).map(|k| k % CURVE_SAMPLES) {
        let place = path.places[k];
        let pose = from.pose(sample_phase(k) as f32);
        let captured = leg_bends(&pose, limb);
        let start = std::array::from_fn(|joint| captured[joint] + CARRIED * turned[joint]);
        let willing = Willingness::under(limb, place.load);
        let reach = Reach::new(&pose, skeleton, limb, place.at_m);
        let at_m = reach.drawn_in(place.yielding);
        let (bends, left_m) = reach_from(start, &pose, skeleton, limb, willing, at_m);
        lacking_m = lacking_m.max(left_m.max(reach.beyond_m()) - SLACK_M * place.yielding);
        turned = std::array::from_fn(|joint| bends[joint] - captured[joint]);
        for (joint, bend) in bends.iter().enumerate() {
            solved.curves.bends_rad[limb.first_bone() + joint][k] = *bend as f32;
        }
    }
    lacking_m
}

/// A place seen from the root of a leg.
struct Reach {
    root_m: [f64; 2],
    at_m: [f64; 2],
    distance_m: f64,
    leg_m: f64,
}

impl Reach {
    fn new(pose: &Pose, skeleton: &Skeleton, limb: Limb, at_m: [f64; 2]) -> Self {
        let bones = limb.first_bone()..=limb.hoof_bone();
        let base = pose.joints(skeleton).bases[limb.first_bone()];
        let root_m = [f64::from(base.x), f64::from(base.y)];
        let distance_m = (at_m[0] - root_m[0]).hypot(at_m[1] - root_m[1]);
        let leg_m = skeleton.bones[bones].iter().map(|bone| f64::from(bone.length_m)).sum();
        Self { root_m, at_m, distance_m, leg_m }
    }

    /// How far the place is beyond [`STRETCH`], m; negative within it.
    fn beyond_m(&self) -> f64 {
        self.distance_m - STRETCH * self.leg_m
    }

    /// The place drawn towards the root, all the way to what a leg reaches at ease where it yields fully. It depends on the place
    /// alone and without a corner, so that neighbouring samples are drawn in alike.
    fn drawn_in(&self, yielding: f64) -> [f64; 2] {
        let half_m = 0.5 * self.beyond_m();
        let over_m = half_m + half_m.hypot(0.5 * STRETCH_EDGE * self.leg_m);
        let share = 1.0 - yielding * over_m / self.distance_m;
        [0, 1].map(|axis| self.root_m[axis] + share * (self.at_m[axis] - self.root_m[axis]))
    }
}

#[cfg(test)]
mod tests {
    use muybridge_core::{Database, MPS_PER_MPH};

    use super::*;
    use crate::database_checks::{Check, check_database};

    #[test]
    fn no_joint_snaps_and_no_hoof_slides_when_a_gallop_or_canter_is_made_faster() {
        let (database, reference) = (Database::embedded(), Skeleton::reference());
        let paces = [
            ("sallie-gardner-1878", 40.0, 0.91),
            ("sallie-gardner-1878", 36.0, 1.0),
            ("flode-holden-614", 25.0, 0.72),
        ];
        for (plate, mph, ratio) in paces {
            let captured = database.strides.iter().find(|stride| stride.id == plate).unwrap();
            let pace = Pace { speed_m_s: mph * MPS_PER_MPH, stance_ratios: [ratio; 2] };
            let made = Stride { id: "made".into(), ..expand(captured, &reference, pace).unwrap() };
            let pair = Database { strides: vec![captured.clone(), made], ..database.clone() };
            let found = check_database(&pair, &reference).into_iter().filter(|d| d.stride == "made");
            let wrong: Vec<String> = found
                .filter(|d| matches!(d.check, Check::BendJump | Check::ToeSlides | Check::BendLimit))
                .map(|d| d.to_string())
                .collect();
            assert_eq!(wrong, [""; 0], "{plate} at {mph} mph");
        }
    }

    #[test]
    fn easing_takes_the_speed_away_and_nothing_else() {
        let straight = |share: f64| [3.0 * share, 0.5 * share * (1.0 - share)];
        let swing = Swing::new([[0.1, 0.0], [2.8, 0.0]], straight);
        let at = |share: f64| swing.at(share, straight(share));
        assert!((at(0.0)[0] - 0.1).abs() < 1e-12 && (at(1.0)[0] - 2.8).abs() < 1e-12);
        let speed = |a: f64, b: f64| (at(b)[0] - at(a)[0]) / (b - a);
        assert!(speed(0.0, 1e-4).abs() < 0.05 && speed(1.0 - 1e-4, 1.0).abs() < 0.05);
        assert!((0..=1000).all(|k| at(f64::from(k) / 1000.0)[1] >= 0.0), "never below the ground");
    }
}
