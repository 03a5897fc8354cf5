//! What a fit shows: points it cannot meet, a stride that does not close, hooves that slide, joints at their limits.

use muybridge_capture::{BodyPoint, Keypoint, KeypointState, LimbJoint, NearOff, StanceLabel};
use muybridge_core::{Gait, Limb, Pair};

use super::view::{PanelView, PlateView};
use super::{Concern, ConcernKind, Severity, name, worst_first};
use crate::footfalls::{LANES, StrideClock, leg_name};
use crate::held_out::quantile;
use crate::layout::BENDS;
use crate::levenberg::LeastSquares;
use crate::pipeline::PlateFit;
use crate::stride_fit::{PointResidual, SEARCH_SPAN, SEARCH_STEP_SHARE};

/// A point farther from the fit than this many standard deviations of a coordinate is worth a look: one in 90 by chance.
const RESIDUAL_NOTE: f64 = 3.0;
/// ... and is almost certainly wrong from here on: one in 270 000.
const RESIDUAL_WARNING: f64 = 5.0;
/// A stance toe farther than this from where it stands in the other panels slides, withers heights.
const SLIP: f64 = 0.06;
/// The trunk may stand this much higher in the last phase than the first phase continues, withers heights.
const JUMP: f64 = 0.03;
/// A bend within this of its limit is at it, rad.
const AT_LIMIT_RAD: f64 = 1e-6;
/// Trunk points that ride with the body.
const TRUNK: [BodyPoint; 4] = [BodyPoint::Withers, BodyPoint::Back, BodyPoint::Croup, BodyPoint::Dock];

/// Concerns that a fit raises, worst first.
pub fn after_fit(fit: &PlateFit) -> Vec<Concern> {
    let mut concerns: Vec<Concern> = fit.residuals.iter().filter_map(|point| residual(fit, point)).collect();
    concerns.extend(loop_open(fit));
    concerns.extend(slips(fit));
    concerns.extend(at_limits(fit));
    concerns.extend(own_warnings(fit));
    worst_first(&mut concerns);
    concerns
}

fn residual(fit: &PlateFit, point: &PointResidual) -> Option<Concern> {
    let panel = fit.fit.observation.panels.iter().find(|panel| panel.camera.panel == point.panel)?;
    let sd_px = panel.points.iter().find(|p| p.keypoint == point.keypoint)?.sd_px;
    let sigmas = point.px() / sd_px;
    // A leap is fitted as if it closed on itself, and cannot meet the points at its ends.
    let sure = sigmas > RESIDUAL_WARNING && fit.gait() != Gait::Leap;
    let severity = if sure { Severity::Warning } else { Severity::Note };
    (sigmas > RESIDUAL_NOTE).then(|| {
        let text = format!(
            "{} lies {:.1} px ({:.1} cm) from where the fit has it; look at it again",
            name(point.keypoint),
            point.px(),
            100.0 * point.metres()
        );
        let limb = match point.keypoint {
            Keypoint::Limb(side, pair, _) => Some((side, pair)),
            Keypoint::Body(_) => None,
        };
        Concern {
            kind: ConcernKind::Residual,
            severity,
            panel: Some(point.panel),
            keypoints: vec![point.keypoint],
            limb,
            text,
            size: sigmas / RESIDUAL_NOTE,
        }
    })
}

/// A stride time at the end of the search, or a trunk that jumps from the last phase to the first. A leap closes on nothing.
fn loop_open(fit: &PlateFit) -> Vec<Concern> {
    if fit.gait() == Gait::Leap {
        return Vec::new();
    }
    let mut concerns = Vec::new();
    let stated = fit.plate.annotation.stride.closes_after_panels.is_some()
        || fit.plate.calibration.time.stride_time_s.is_some();
    let share = fit.fit.stride_time.seconds / fit.fit.observation.duration_s();
    if !stated && SEARCH_SPAN.iter().any(|end| (share - end).abs() < SEARCH_STEP_SHARE) {
        let text = format!(
            "the movement closes on itself nowhere in the panels (stride time {:.3} s is the end of the search); \
             say after how many panels it closes",
            fit.fit.stride_time.seconds
        );
        concerns.push(Concern::of_stride(ConcernKind::LoopOpen, Severity::Warning, 2.0, text));
    }
    let jump = trunk_jump(fit).unwrap_or(0.0);
    if jump.abs() > JUMP {
        let text = format!(
            "the trunk stands {:.1} % of withers height {} in the last phase of the stride than the first continues; \
             check after how many panels it closes, and the ground lines",
            100.0 * jump.abs(),
            if jump > 0.0 { "higher" } else { "lower" }
        );
        concerns.push(Concern::of_stride(ConcernKind::LoopOpen, Severity::Warning, jump.abs() / JUMP, text));
    }
    concerns
}

/// How much more the trunk's points lie over the fit in the last phase than in the first, withers heights.
fn trunk_jump(fit: &PlateFit) -> Option<f64> {
    let over = |slot: usize| {
        let panel = fit.fit.observation.panels[fit.fit.problem.order[slot]].camera;
        let of_trunk = |point: &&PointResidual| {
            point.panel == panel.panel && TRUNK.iter().any(|trunk| point.keypoint == Keypoint::Body(*trunk))
        };
        let heights: Vec<f64> = fit
            .residuals
            .iter()
            .filter(of_trunk)
            .map(|point| {
                let away = [0, 1].map(|axis| point.placed_px[axis] - point.fitted_px[axis]);
                (away[0] * panel.up[0] + away[1] * panel.up[1]) / point.px_per_m
            })
            .collect();
        (!heights.is_empty()).then(|| heights.iter().sum::<f64>() / heights.len() as f64)
    };
    let last = fit.fit.problem.order.len().checked_sub(1)?;
    Some((over(last)? - over(0)?) / fit.withers_height_m)
}

/// Visible stance toes that do not stay in one place on the track.
fn slips(fit: &PlateFit) -> Vec<Concern> {
    let (plate, calibration) = (&fit.plate, Some(&fit.calibration));
    let clock = StrideClock::new(&plate.annotation, calibration, Some(fit.fit.stride_time));
    let Some(mut view) = PlateView::new(&plate.annotation, &plate.manifest, calibration, &clock) else {
        return Vec::new();
    };
    view.panels.sort_by_key(|panel| panel.panel);
    LANES
        .into_iter()
        .flat_map(|(side, pair)| {
            let mut stance: Vec<(u32, f64)> = Vec::new();
            let mut concerns = Vec::new();
            for panel in &view.panels {
                let next = stance.last().is_none_or(|(last, _)| last + 1 == panel.panel);
                let along = standing(&view, panel, (side, pair));
                if !next || along.is_none() {
                    concerns.extend(slips_of(fit, (side, pair), &std::mem::take(&mut stance)));
                }
                stance.extend(along.map(|along| (panel.panel, along)));
            }
            concerns.extend(slips_of(fit, (side, pair), &stance));
            concerns
        })
        .collect()
}

/// Place along the track of a visible stance toe, withers heights.
fn standing(view: &PlateView<'_>, panel: &PanelView<'_>, (side, pair): (NearOff, Pair)) -> Option<f64> {
    let placed = panel.annotation.keypoints.get(Keypoint::hoof(side, pair))?;
    let stands = placed.state == KeypointState::Visible && panel.label(side, pair) == StanceLabel::Stance;
    view.toe(panel, side, pair).filter(|_| stands).map(|[along, _]| along)
}

/// Panels of one stance in which the toe is not where it mostly is.
fn slips_of(fit: &PlateFit, (side, pair): (NearOff, Pair), stance: &[(u32, f64)]) -> Vec<Concern> {
    let places: Vec<f64> = stance.iter().map(|(_, along)| *along).collect();
    let rest = match places.as_slice() {
        [first, _] => *first,
        places => quantile(places, 0.5),
    };
    let slipped =
        stance.iter().map(|(panel, along)| (*panel, along - rest)).filter(|(_, slip)| slip.abs() > SLIP);
    slipped
        .map(|(panel, slip)| {
            let way = if slip > 0.0 { "ahead of" } else { "behind" };
            let text = format!(
                "{} stands, but is {:.0} cm {way} its place in the panels around; check the toe, its label and the marks",
                leg_name(side, pair),
                100.0 * slip.abs() * fit.withers_height_m
            );
            let keypoints = vec![Keypoint::hoof(side, pair)];
            let size = slip.abs() / SLIP;
            Concern::of_limb(ConcernKind::StanceSlip, (panel, (side, pair)), keypoints, size, text)
        })
        .collect()
}

/// One note for each joint of a limb that is held at a limit, with all its panels.
fn at_limits(fit: &PlateFit) -> Vec<Concern> {
    const JOINTS: [LimbJoint; 4] = [LimbJoint::Root, LimbJoint::Upper, LimbJoint::Middle, LimbJoint::Fetlock];
    let (problem, x) = (&fit.fit.problem, &fit.fit.optimum.x);
    let bounds = LeastSquares::bounds(&problem);
    let held = |slot: usize, bone: usize| {
        let index = problem.layout.panel(slot, BENDS + bone);
        bounds[index].iter().any(|limit| (x[index] - limit).abs() < AT_LIMIT_RAD)
    };
    let mut concerns = Vec::new();
    for limb in Limb::ALL {
        let leg = (fit.plate.facing.near_off(limb.side()), limb.pair());
        for (k, joint) in JOINTS.into_iter().enumerate() {
            let slots = (0..problem.layout.panels).filter(|slot| held(*slot, limb.first_bone() + 1 + k));
            let mut panels: Vec<u32> =
                slots.map(|slot| fit.fit.observation.panels[problem.order[slot]].camera.panel).collect();
            panels.sort_unstable();
            if let Some(first) = panels.first() {
                let keypoint = Keypoint::Limb(leg.0, leg.1, joint);
                let numbers: Vec<String> = panels.iter().map(ToString::to_string).collect();
                let text = format!(
                    "the {} is bent to its limit (panels {}); look at the points around it",
                    name(keypoint),
                    numbers.join(", ")
                );
                let size = panels.len() as f64 / problem.layout.panels as f64;
                let mut concern =
                    Concern::of_limb(ConcernKind::JointAtLimit, (*first, leg), vec![keypoint], size, text);
                concern.severity = Severity::Note;
                concerns.push(concern);
            }
        }
    }
    concerns
}

/// What the fit says itself. A leap has none of the numbers by which a stride is judged.
fn own_warnings(fit: &PlateFit) -> Vec<Concern> {
    let implied = fit.analysis.implied;
    let leaps = fit.gait() == Gait::Leap;
    let severity = if leaps { Severity::Note } else { Severity::Warning };
    let mut concerns: Vec<Concern> = fit
        .warnings
        .iter()
        // The gait is told once, below.
        .filter(|warning| !warning.starts_with("footfalls imply"))
        .map(|warning| Concern::of_stride(ConcernKind::FitWarning, severity, 1.0, warning.clone()))
        .collect();
    if !leaps && !implied.agrees_with(fit.gait()) {
        let text = format!(
            "the fitted footfalls are those of a {}, the title says {}; check the contacts, or the title",
            implied.name(),
            fit.gait()
        );
        concerns.push(Concern::of_stride(ConcernKind::GaitAgainstTitle, Severity::Warning, 1.5, text));
    }
    concerns
}
