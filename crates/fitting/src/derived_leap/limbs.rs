//! The legs of the leap: toes that stand still, and the gallop's folding between.

use std::f64::consts::PI;

use muybridge_core::{CURVE_SAMPLES, Contact, Limb, Pair, Skeleton, Stride};

use super::body::Body;
use super::plan::{Plan, SAMPLE};
use crate::leg_reach::{LegBends, leg_bends, reach_from, willingness};
use crate::synthetic::eased;

/// Joints lose what a stance leaves them within this share of the swing.
const FADE: f64 = 0.3;
/// A sample this near after a stance is its end, share of the stride: phases are stored in single precision.
const EDGE: f64 = 1e-6;
/// Step of the differences that give the joints' speeds at the ends of a stance, share of the stride.
const STEP: f64 = 0.004;
/// Swinging toes clear the ground by at least half of this in the middle of the swing, share of withers height.
const CLEARANCE: f64 = 0.03;
/// When the legs are to be folded most, share of the flight: the fores pass the fence early in it, the hinds late.
const FOLDED_AT: [f64; 2] = [0.35, 0.85];
/// Steps from the gallop's folding to the drawn leap's where a toe does not clear the fence.
const FOLDING_STEPS: u32 = 10;
/// Joints keep this far from their limits at the samples, rad: two degrees, for a curve overshoots between them.
const LIMIT_MARGIN_RAD: f32 = 0.035;
/// Looks at a gallop's swing for the moment in which it is folded most.
const LOOKS: usize = 200;

/// How far each pair of legs is folded as in the drawn leap rather than as in the gallop, 0 to 1.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Folding {
    steps: [u32; 2],
}

impl Folding {
    /// Folds a pair further by a step; false where it is folded as far as it can be.
    pub(super) fn add(&mut self, pair: Pair) -> bool {
        let steps = &mut self.steps[pair as usize];
        *steps += 1;
        *steps <= FOLDING_STEPS
    }

    fn share(self, pair: Pair) -> f64 {
        f64::from(self.steps[pair as usize]) / f64::from(FOLDING_STEPS)
    }

    /// The pairs folded further, and how far; none where none is.
    pub(super) fn description(self) -> Option<String> {
        let pairs = [(Pair::Fore, "forelegs"), (Pair::Hind, "hind legs")].into_iter();
        let folded = pairs.filter(|(pair, _)| self.share(*pair) > 0.0);
        let named: Vec<String> =
            folded.map(|(pair, legs)| format!("{legs} by {:.0} %", 100.0 * self.share(pair))).collect();
        (!named.is_empty()).then(|| named.join(", "))
    }
}

/// What the legs are made from.
pub(super) struct Legs<'a> {
    pub(super) skeleton: Skeleton,
    gallop: &'a Stride,
    body: &'a Body,
    /// Exponents that bring the gallop's most folded moment to where the leap needs it.
    hurry: [f64; 4],
}

impl<'a> Legs<'a> {
    pub(super) fn new(gallop: &'a Stride, skeleton: &'a Skeleton, body: &'a Body) -> Self {
        let hurry = Limb::ALL.map(|limb| {
            let wanted = wanted_share(&body.plan, limb);
            // An exponent below 1 would begin the swing with a jerk.
            (most_folded_share(gallop, skeleton, limb).ln() / wanted.ln()).max(1.0)
        });
        Self { skeleton: stiffer(skeleton), gallop, body, hurry }
    }

    /// The gallop's bends at the same point of each leg's step, folded further as wished: of each leg, at every sample.
    pub(super) fn folded(&self, folding: Folding) -> [Vec<LegBends>; 4] {
        Limb::ALL.map(|limb| {
            let share = folding.share(limb.pair());
            let bends = |k: usize| {
                let phase = k as f64 * SAMPLE;
                let galloping = self.galloping(limb, phase);
                let Some(drawn) = self.drawn(limb, phase).filter(|_| share > 0.0) else { return galloping };
                let hump = share * (PI * drawn.share).sin().powi(2);
                std::array::from_fn(|joint| galloping[joint] + hump * (drawn.bends[joint] - galloping[joint]))
            };
            (0..CURVE_SAMPLES).map(bends).collect()
        })
    }

    /// Bends the legs as folded, and slides the scapulae as in the gallop.
    pub(super) fn shape(&self, stride: &mut Stride, folded: &[Vec<LegBends>; 4]) {
        for limb in Limb::ALL {
            for (k, bends) in folded[limb.index()].iter().enumerate() {
                set_bends(stride, limb, k, *bends);
                if limb.pair() == Pair::Fore {
                    let pose = self.gallop.pose(self.gallop_phase(limb, k as f64 * SAMPLE));
                    stride.curves.scapula_slides_m[limb.index()][k] = pose.scapula_slides_m[limb.index()];
                }
            }
        }
    }

    /// Sets each print so that the toe is as far ahead of scapula or croup in the middle of its stance as planned.
    pub(super) fn set_prints(&self, stride: &mut Stride) {
        for limb in Limb::ALL {
            let contact = stride.contacts[limb.index()];
            let middle =
                stride.pose(contact.strike_phase + 0.5 * contact.duty_factor()).joints(&self.skeleton);
            let from = match limb.pair() {
                Pair::Fore => middle.bases[limb.first_bone()],
                Pair::Hind => middle.root,
            };
            stride.prints_m[limb.index()] = from.x + self.body.plan.toe_ahead_m[limb.index()] as f32;
        }
    }

    /// Puts every leg to its place at every sample; returns what the worst standing one lacks, m.
    pub(super) fn solve(&self, stride: &mut Stride, folded: &[Vec<LegBends>; 4]) -> f64 {
        let lacks = Limb::ALL.into_iter().map(|limb| self.solve_leg(stride, limb, &folded[limb.index()]));
        lacks.fold(0.0, f64::max)
    }

    fn solve_leg(&self, stride: &mut Stride, limb: Limb, folded: &[LegBends]) -> f64 {
        let contact = self.body.plan.held[limb.index()];
        let duty = f64::from(contact.duty_factor());
        let swing = self.swing(stride, limb);
        let mut lacking_m: f64 = 0.0;
        for (k, folded) in folded.iter().enumerate() {
            let phase = k as f64 * SAMPLE;
            let since = (phase - f64::from(contact.strike_phase)).rem_euclid(1.0);
            let bends = if since <= duty + EDGE {
                let (bends, left_m) = self.standing(stride, limb, since);
                lacking_m = lacking_m.max(left_m);
                bends
            } else {
                let share = (since - duty) / (1.0 - duty);
                let bends = swing.at(share, folded);
                self.over_ground(stride, limb, phase, share, bends)
            };
            set_bends(stride, limb, k, bends);
        }
        lacking_m
    }

    /// Bends of a standing leg at a phase since its toe came down, and what it lacks, m.
    fn standing(&self, stride: &Stride, limb: Limb, since: f64) -> (LegBends, f64) {
        // Counted from the strike in [0, 1), whose print is stored.
        let early = SAMPLE - since;
        let phase = f64::from(stride.contacts[limb.index()].strike_phase) - early;
        let pose = stride.pose(phase as f32);
        let start = self.galloping(limb, phase);
        let at_m = [f64::from(stride.prints_m[limb.index()]), 0.0];
        reach_from(start, &pose, &self.skeleton, limb, willingness(limb, true), at_m)
    }

    /// What the stances leave to the swing between them.
    fn swing(&self, stride: &Stride, limb: Limb) -> Swing {
        let contact = self.body.plan.held[limb.index()];
        let duty = f64::from(contact.duty_factor());
        let swing = 1.0 - duty;
        let standing = |since: f64| self.standing(stride, limb, since).0;
        let (start, before) = (standing(duty), standing(duty - STEP));
        let (end, after) = (standing(0.0), standing(STEP));
        let strike = f64::from(contact.strike_phase);
        let folded = |since: f64| self.galloping(limb, strike + since);
        let (left, leaving) = (folded(duty), folded(duty + STEP));
        let (come, coming) = (folded(1.0), folded(1.0 - STEP));
        let scale = swing / STEP;
        Swing {
            misses: std::array::from_fn(|j| [start[j] - left[j], end[j] - come[j]]),
            slopes: std::array::from_fn(|j| {
                [
                    scale * ((start[j] - before[j]) - (leaving[j] - left[j])),
                    scale * ((after[j] - end[j]) - (come[j] - coming[j])),
                ]
            }),
        }
    }

    /// Lifts a swinging toe that would touch the ground.
    fn over_ground(&self, stride: &Stride, limb: Limb, phase: f64, share: f64, bends: LegBends) -> LegBends {
        let mut pose = stride.pose(phase as f32);
        for (joint, bend) in bends.iter().enumerate() {
            pose.bends_rad[limb.first_bone() + joint] = *bend as f32;
        }
        let toe = pose.joints(&self.skeleton).toe(limb);
        let y = f64::from(toe.y);
        let clearance_m =
            CLEARANCE * f64::from(self.skeleton.withers_height_m) * 16.0 * (share * (1.0 - share)).powi(2);
        let at_m = [f64::from(toe.x), 0.5 * (y + y.hypot(clearance_m))];
        reach_from(bends, &pose, &self.skeleton, limb, willingness(limb, false), at_m).0
    }

    /// The gallop's bends at the same point of a leg's step.
    fn galloping(&self, limb: Limb, phase: f64) -> LegBends {
        leg_bends(&self.gallop.pose(self.gallop_phase(limb, phase)), limb)
    }

    /// The drawn leap's bends at the same share of the swing; none in stance.
    fn drawn(&self, limb: Limb, phase: f64) -> Option<Drawn> {
        let plan = &self.body.plan;
        let share = swing_share(plan.held[limb.index()], phase)?;
        let stance = self.body.drawn.stance(limb);
        let swing_s = plan.stride_time_s - (stance.lift_off_s - stance.strike_s);
        // The hinds swing after the take-off's stance, the fores before the landing's.
        let time_s = match limb.pair() {
            Pair::Hind => stance.lift_off_s + share * swing_s,
            Pair::Fore => stance.strike_s - (1.0 - share) * swing_s,
        };
        Some(Drawn { share, bends: self.body.drawn_bends(limb, time_s) })
    }

    /// Phase of the gallop at the same point of a leg's step.
    fn gallop_phase(&self, limb: Limb, phase: f64) -> f32 {
        let (new, old) = (self.body.plan.held[limb.index()], self.gallop.contacts[limb.index()]);
        let hurried = swing_share(new, phase).map_or(phase, |share| {
            let duty = f64::from(new.duty_factor());
            f64::from(new.strike_phase) + duty + share.powf(self.hurry[limb.index()]) * (1.0 - duty)
        });
        new.same_step(old, hurried as f32)
    }
}

/// The same horse with joints that do not bend quite to their limits.
fn stiffer(skeleton: &Skeleton) -> Skeleton {
    let mut stiffer = skeleton.clone();
    for bone in &mut stiffer.bones {
        bone.limits_rad = [bone.limits_rad[0] + LIMIT_MARGIN_RAD, bone.limits_rad[1] - LIMIT_MARGIN_RAD];
    }
    stiffer
}

/// A leg of the drawn leap at a share of its swing.
struct Drawn {
    share: f64,
    bends: LegBends,
}

/// What is added to a leg's folding through the air so that it leaves one stance and comes to the next without a jerk.
struct Swing {
    /// What each joint misses at lift-off and at strike, rad.
    misses: [[f64; 2]; 5],
    /// Its speed there, rad per swing.
    slopes: [[f64; 2]; 5],
}

impl Swing {
    fn at(&self, share: f64, folded: &LegBends) -> LegBends {
        std::array::from_fn(|joint| {
            folded[joint] + eased(self.misses[joint], self.slopes[joint], share, FADE)
        })
    }
}

/// Share of the swing at a phase; none in stance.
fn swing_share(contact: Contact, phase: f64) -> Option<f64> {
    let duty = f64::from(contact.duty_factor());
    let since = (phase - f64::from(contact.strike_phase)).rem_euclid(1.0);
    (since > duty).then(|| (since - duty) / (1.0 - duty))
}

/// Share of a leg's swing at which it is to be folded most.
fn wanted_share(plan: &Plan, limb: Limb) -> f64 {
    let instants = |pair: Pair, instant: fn(&Contact) -> f32| {
        let of_pair = Limb::ALL.into_iter().filter(move |limb| limb.pair() == pair);
        of_pair.map(move |limb| f64::from(instant(&plan.contacts[limb.index()])))
    };
    let take_off = instants(Pair::Hind, |hind| hind.lift_off_phase).fold(0.0, f64::max);
    let touch_down = instants(Pair::Fore, |fore| fore.strike_phase).fold(1.0, f64::min);
    let at = take_off + FOLDED_AT[limb.pair() as usize] * (touch_down - take_off);
    swing_share(plan.contacts[limb.index()], at).unwrap_or(0.5)
}

/// Share of the gallop's swing at which a leg's toe is nearest to its shoulder or hip.
fn most_folded_share(gallop: &Stride, skeleton: &Skeleton, limb: Limb) -> f64 {
    let contact = gallop.contacts[limb.index()];
    let height = |share: f64| {
        let phase = contact.lift_off_phase + (share as f32) * (1.0 - contact.duty_factor());
        let joints = gallop.pose(phase).joints(skeleton);
        joints.toe(limb).y - joints.bases[limb.first_bone()].y
    };
    let shares = (1..LOOKS).map(|k| k as f64 / LOOKS as f64);
    shares.max_by(|a, b| height(*a).total_cmp(&height(*b))).unwrap_or(0.5)
}

fn set_bends(stride: &mut Stride, limb: Limb, sample: usize, bends: LegBends) {
    for (joint, bend) in bends.iter().enumerate() {
        stride.curves.bends_rad[limb.first_bone() + joint][sample] = *bend as f32;
    }
}
