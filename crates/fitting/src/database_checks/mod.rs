//! What a rider or a biomechanist would look at in a motion database: feet, body, and what real horses do.
//!
//! [`check_database`] measures every stride and lists what lies outside its limits, each with the number, the limits and
//! where they come from. What a photograph really shows although no book has it is kept in [`KNOWN_DEVIATIONS`].

mod biomechanics;
mod body;
mod feet;
mod jumps;
mod known;
#[cfg(test)]
mod specimen;

use muybridge_core::{CURVE_SAMPLES, Database, Gait, Limb, Provenance, Skeleton, Stride};

pub use feet::{FootErrors, foot_errors, worst_foot_errors};
pub use known::{KNOWN_DEVIATIONS, Known, stale, unexplained};

use crate::contacts::{ContactInstant, LegContact};
use crate::gait_analysis::GaitAnalysis;

/// Uncertainty given to a stored strike or lift-off, share of the stride: gaps in support of less than 0.7 % of the stride
/// (4 ms at the trot), which come from rounding and from edges that meet, are then no suspensions.
const INSTANT_SD: f64 = 0.0025;
/// Poses looked at over a stride: four to each sample of its curves.
const STRIDE_SAMPLES: usize = 4 * CURVE_SAMPLES;

/// What is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Check {
    /// A standing toe keeps its place along the track.
    ToeSlides,
    /// A standing toe stays above the ground.
    ToeSinks,
    /// A standing toe stays down on the ground.
    ToeFloats,
    /// The stored print is where the toe stands.
    PrintMisplaced,
    /// No joint and no swinging toe goes through the ground.
    UnderGround,
    /// Every number is finite.
    NotFinite,
    /// The stride's end is its beginning, in value and slope.
    NotClosed,
    /// Every joint stays within the skeleton's limits.
    BendLimit,
    /// No bend of a made stride changes much faster than those of the stride it comes from.
    BendJump,
    /// Every bone keeps its length over the stride and at every speed.
    BoneLength,
    /// Share of the stride a hoof is down.
    DutyFactor,
    /// Time a hoof is down.
    StanceTime,
    /// Time a hoof is in the air.
    SwingTime,
    /// Duration or rate of the stride.
    StrideTime,
    /// Stride length, in metres or against the leg's length.
    StrideLength,
    /// The speed is one at which a horse of this size uses the gait.
    GaitSpeed,
    /// Order and spacing of the footfalls.
    Footfalls,
    /// The lead is the one the footfalls have, and the gait has one at all.
    Lead,
    /// Number of feet on the ground.
    Support,
    /// Number and kind of the suspensions.
    Suspension,
    /// A loaded foreleg is straight.
    ForelegBent,
    /// At the walk the hind print lies on or ahead of the fore print.
    HindPrint,
    /// The force that the duty factor implies.
    PeakForce,
    /// A body in the air moves as a thrown body does.
    Ballistics,
    /// Stance time falls as speed rises.
    StanceTrend,
    /// Duty factor falls as speed rises.
    DutyTrend,
    /// Swing time of a gallop hardly changes with speed.
    SwingTrend,
}

impl Check {
    /// Plain name for tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::ToeSlides => "toe slides",
            Self::ToeSinks => "toe sinks",
            Self::ToeFloats => "toe floats",
            Self::PrintMisplaced => "print misplaced",
            Self::UnderGround => "under the ground",
            Self::NotFinite => "not finite",
            Self::NotClosed => "not closed",
            Self::BendLimit => "bend limit",
            Self::BendJump => "bend jump",
            Self::BoneLength => "bone length",
            Self::DutyFactor => "duty factor",
            Self::StanceTime => "stance time",
            Self::SwingTime => "swing time",
            Self::StrideTime => "stride time",
            Self::StrideLength => "stride length",
            Self::GaitSpeed => "speed of the gait",
            Self::Footfalls => "footfalls",
            Self::Lead => "lead",
            Self::Support => "support",
            Self::Suspension => "suspension",
            Self::ForelegBent => "foreleg bent",
            Self::HindPrint => "hind print",
            Self::PeakForce => "peak force",
            Self::Ballistics => "ballistics",
            Self::StanceTrend => "stance trend",
            Self::DutyTrend => "duty factor trend",
            Self::SwingTrend => "swing trend",
        }
    }
}

/// A number outside its limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Deviation {
    /// Identifier of the stride.
    pub stride: String,
    /// Its gait.
    pub gait: Gait,
    /// What was checked.
    pub check: Check,
    /// What was found; the unit is in `text`.
    pub value: f64,
    /// Least and greatest value allowed.
    pub allowed: [f64; 2],
    /// One sentence: what, how much, and by whose numbers.
    pub text: String,
}

impl std::fmt::Display for Deviation {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} ({}): {}: {}", self.stride, self.gait, self.check.name(), self.text)
    }
}

/// Everything in a database that lies outside its limits, in the order of the strides, then what concerns several.
pub fn check_database(database: &Database, reference: &Skeleton) -> Vec<Deviation> {
    let mut deviations = Vec::new();
    for stride in &database.strides {
        deviations.extend(check_stride(stride, reference));
    }
    deviations.extend(body::check_families(database));
    deviations.extend(jumps::check(database, reference));
    deviations.extend(biomechanics::check_trends(database));
    deviations
}

/// Everything about one stride that can be told without the others.
fn check_stride(stride: &Stride, reference: &Skeleton) -> Vec<Deviation> {
    if let Some(deviation) = body::not_finite(stride) {
        // Every other number would be wrong with it.
        return vec![deviation];
    }
    let subject = Subject::new(stride, reference);
    let mut deviations = feet::check(&subject);
    deviations.extend(body::check(&subject));
    deviations.extend(biomechanics::check(&subject));
    deviations
}

/// A stride with what several checks need of it.
struct Subject<'a> {
    stride: &'a Stride,
    /// The stride's own animal.
    skeleton: Skeleton,
    footfalls: GaitAnalysis,
}

impl<'a> Subject<'a> {
    fn new(stride: &'a Stride, reference: &Skeleton) -> Self {
        let instant = |phase: f32| ContactInstant { phase: f64::from(phase), sd: INSTANT_SD };
        let contacts = Limb::ALL.map(|limb| {
            let contact = stride.contacts[limb.index()];
            LegContact {
                limb,
                strike: instant(contact.strike_phase),
                lift_off: instant(contact.lift_off_phase),
            }
        });
        let footfalls = GaitAnalysis::new(contacts, [f64::from(stride.stride_time_s), 0.0]);
        Self { stride, skeleton: stride.skeleton(reference), footfalls }
    }

    fn is_captured(&self) -> bool {
        matches!(self.stride.provenance, Provenance::Captured { .. })
    }

    fn duty_factor(&self, limb: Limb) -> f64 {
        self.footfalls.contacts[limb.index()].duty_factor()
    }

    /// A bone's name with its leg.
    fn bone_name(&self, bone: usize) -> String {
        bone_name(&self.skeleton, bone)
    }

    /// A deviation if `value` is outside `allowed`; `text` says what it is, its unit and its source.
    fn require(&self, check: Check, value: f64, allowed: [f64; 2], text: String) -> Option<Deviation> {
        require(self.stride, check, value, allowed, text)
    }
}

/// A bone's name with its leg.
fn bone_name(skeleton: &Skeleton, bone: usize) -> String {
    let limb = Skeleton::limb_of(bone).map_or("", Limb::abbreviation);
    format!("{limb} {}", skeleton.bones[bone].name).trim().to_string()
}

/// A deviation if `value` is outside `allowed` or no number.
fn require(stride: &Stride, check: Check, value: f64, allowed: [f64; 2], text: String) -> Option<Deviation> {
    let [low, high] = allowed;
    (!(low..=high).contains(&value)).then(|| Deviation {
        stride: stride.id.clone(),
        gait: stride.gait,
        check,
        value,
        allowed,
        text,
    })
}

/// The plate or clip a stride comes from: what stands before the `@` of an expanded one.
fn family(stride: &Stride) -> &str {
    stride.id.split_once('@').map_or(stride.id.as_str(), |(family, _)| family)
}
