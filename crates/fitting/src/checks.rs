//! What a person should look at again: doubtful points, legs and panels, before and after the fit.
//!
//! A concern is raised only where the documents contradict each other far beyond the scatter of a careful hand; a list
//! of false alarms is not read. Lengths are in withers heights, so that they mean the same on every plate.

mod bones;
mod fitted;
mod hooves;
mod order;
mod points;
mod swaps;
mod view;

use std::fmt;

use muybridge_capture::{Annotation, Keypoint, Manifest, NearOff, PlateCalibration};
use muybridge_core::Pair;

use crate::footfalls::{Footfalls, StrideClock};
pub use fitted::after_fit;
use view::PlateView;

/// How sure the doubt is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Worth a look.
    Note,
    /// Almost certainly wrong.
    Warning,
}

/// What is doubted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum ConcernKind {
    /// Near and off limb of both pairs exchanged in a panel.
    SwappedPanel,
    /// Near and off limb of one pair exchanged in a panel.
    SwappedLimbs,
    /// Points of the near limb are called hidden, those of the off limb seen.
    HiddenNear,
    /// A bone longer or shorter than in the other panels.
    BoneLength,
    /// A knee or hock bent the way it cannot bend.
    BentWrongWay,
    /// A hoof labelled stance that is not on the ground line.
    StanceOffGround,
    /// A hoof labelled swing that lies still on the ground.
    SwingOnGround,
    /// A point outside its panel.
    OutsidePanel,
    /// Two points of one limb or of the body on top of each other.
    OnTop,
    /// Points of a panel that nobody has placed or called absent.
    MissingPoints,
    /// A leg that comes down twice in a stride, or never, or is never up.
    LegContacts,
    /// An instant that the labels contradict.
    ContradictingInstant,
    /// Footfalls in an order the titled gait does not have.
    FootfallOrder,
    /// Footfalls of another gait than the title's.
    GaitAgainstTitle,
    /// A point far from where the fit has it.
    Residual,
    /// First and last phase of the stride do not join.
    LoopOpen,
    /// A hoof that slides while it stands.
    StanceSlip,
    /// A joint that the fit holds at its limit.
    JointAtLimit,
    /// Any other doubt of the fit's own.
    FitWarning,
}

/// One thing to look at again.
#[derive(Clone, Debug, PartialEq)]
pub struct Concern {
    /// What is doubted.
    pub kind: ConcernKind,
    /// How sure the doubt is.
    pub severity: Severity,
    /// The panel; none when it concerns the stride.
    pub panel: Option<u32>,
    /// The points.
    pub keypoints: Vec<Keypoint>,
    /// The limb.
    pub limb: Option<(NearOff, Pair)>,
    /// One plain sentence that says what is seen and what to do.
    pub text: String,
    /// How many times over the threshold, for the order: the worst first.
    pub size: f64,
}

impl Concern {
    fn of_stride(kind: ConcernKind, severity: Severity, size: f64, text: String) -> Self {
        Self { kind, severity, panel: None, keypoints: Vec::new(), limb: None, text, size }
    }

    fn of_limb(
        kind: ConcernKind,
        (panel, limb): (u32, (NearOff, Pair)),
        keypoints: Vec<Keypoint>,
        size: f64,
        text: String,
    ) -> Self {
        let severity = Severity::Warning;
        Self { kind, severity, panel: Some(panel), keypoints, limb: Some(limb), text, size }
    }
}

impl fmt::Display for Concern {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.panel {
            Some(panel) => write!(f, "panel {panel}: {}", self.text),
            None => f.write_str(&self.text),
        }
    }
}

/// `near hind fetlock` for `near_hind_fetlock`.
fn name(keypoint: Keypoint) -> String {
    keypoint.name().replace('_', " ")
}

/// Concerns that need no fit, worst first; without a calibration those that compare places on the track are left out.
pub fn before_fit(
    annotation: &Annotation,
    manifest: &Manifest,
    calibration: Option<&PlateCalibration>,
) -> Vec<Concern> {
    let clock = StrideClock::new(annotation, calibration, None);
    let footfalls = Footfalls::new(annotation, clock);
    let mut concerns = points::concerns(annotation, manifest);
    if let Some(view) = PlateView::new(annotation, manifest, calibration, &footfalls.clock) {
        concerns.extend(swaps::concerns(annotation, &view));
        concerns.extend(bones::concerns(&view));
        concerns.extend(hooves::concerns(&view));
    }
    concerns.extend(order::concerns(annotation, manifest, &footfalls));
    let doubted = concerns.clone();
    concerns.retain(|concern| !doubted.iter().any(|other| explains(other, concern)));
    worst_first(&mut concerns);
    concerns
}

/// Whether one doubt is the reason of another: exchanged limbs make everything odd about them in that panel, a point
/// outside its panel, on top of another or off the ground makes its bones too long or too short.
fn explains(reason: &Concern, concern: &Concern) -> bool {
    use ConcernKind::{BoneLength, OnTop, OutsidePanel, StanceOffGround, SwappedLimbs, SwappedPanel};
    if reason.kind >= concern.kind && reason.kind != OutsidePanel {
        return concern.kind == BoneLength
            && shares_point(reason, concern)
            && reason.panel == concern.panel
            && matches!(reason.kind, OnTop | StanceOffGround);
    }
    let limb = concern.limb.map(|(_, pair)| pair);
    reason.panel == concern.panel
        && match reason.kind {
            SwappedPanel => limb.is_some(),
            SwappedLimbs => limb.is_some() && limb == reason.limb.map(|(_, pair)| pair),
            OutsidePanel => concern.kind != OutsidePanel && shares_point(reason, concern),
            _ => false,
        }
}

fn shares_point(a: &Concern, b: &Concern) -> bool {
    a.keypoints.iter().any(|keypoint| b.keypoints.contains(keypoint))
}

fn worst_first(concerns: &mut [Concern]) {
    concerns.sort_by(|a, b| {
        let size = b.size.total_cmp(&a.size);
        b.severity.cmp(&a.severity).then(size).then(a.kind.cmp(&b.kind)).then(a.panel.cmp(&b.panel))
    });
}

#[cfg(test)]
mod tests;
