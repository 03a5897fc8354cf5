//! Bones that change their length, joints that bend the wrong way, points on top of each other.

use muybridge_capture::{BodyPoint, Keypoint, LimbJoint, NearOff};
use muybridge_core::Pair;

use super::view::{PanelView, PlateView};
use super::{Concern, ConcernKind, Severity, name};
use crate::footfalls::LANES;
use crate::held_out::quantile;

/// From a median absolute deviation to a standard deviation of normal errors.
const MAD_TO_SD: f64 = 1.4826;
/// A bone is doubted from this many robust standard deviations on: one in 15 000 by chance.
const LENGTH_SIGMAS: f64 = 4.0;
/// ... and only when it is longer or shorter by this share: less does not hurt the fit.
const LEAST_STRETCH: f64 = 0.15;
/// No bone is placed better than this share of its length, however small the scatter.
const LENGTH_SD_SHARE: f64 = 0.03;
/// Fewest panels that show a bone, for a median to mean something.
const LEAST_PANELS: usize = 5;
/// A knee that is straight to this much beyond is a knee, degrees: the skeleton's limit of 12 and as much for the hand.
const KNEE_LIMIT_DEG: f64 = 24.0;
/// A hock never opens beyond straight, but for the hand, degrees.
const HOCK_LIMIT_DEG: f64 = -12.0;
/// Points of one limb closer than this are on top of each other, withers heights: 2 cm.
const ON_TOP: f64 = 0.0125;

const JOINTS: [LimbJoint; 5] =
    [LimbJoint::Root, LimbJoint::Upper, LimbJoint::Middle, LimbJoint::Fetlock, LimbJoint::Hoof];

pub(super) fn concerns(view: &PlateView<'_>) -> Vec<Concern> {
    let mut concerns = Vec::new();
    for (side, pair) in LANES {
        let joints = JOINTS.map(|joint| Keypoint::Limb(side, pair, joint));
        concerns.extend(lengths(view, &joints));
    }
    concerns.extend(lengths(view, &[BodyPoint::Poll, BodyPoint::Muzzle].map(Keypoint::Body)));
    concerns.extend(lengths(view, &[BodyPoint::Croup, BodyPoint::Dock].map(Keypoint::Body)));
    for panel in &view.panels {
        concerns.extend(LANES.iter().filter_map(|(side, pair)| bent(panel, *side, *pair)));
        concerns.extend(on_top(panel));
    }
    concerns
}

/// A bone that stands out in a panel.
#[derive(Clone, Copy)]
struct Odd {
    stretch: f64,
    px: f64,
    sigmas: f64,
}

/// Concerns about a chain of bones; two neighbouring bones that both stand out have their common joint in the wrong place.
fn lengths(view: &PlateView<'_>, chain: &[Keypoint]) -> Vec<Concern> {
    let bones: Vec<Vec<Option<Odd>>> =
        chain.windows(2).map(|ends| odd_lengths(view, [ends[0], ends[1]])).collect();
    let mut concerns = Vec::new();
    for (k, panel) in view.panels.iter().enumerate() {
        let mut bone = 0;
        while bone < bones.len() {
            let next = bones.get(bone + 1).and_then(|lengths| lengths[k]);
            match (bones[bone][k], next) {
                (Some(odd), Some(other)) if odd.stretch * other.stretch < 0.0 => {
                    concerns.push(wrong_joint(panel, chain[bone + 1], odd, other));
                    bone += 1;
                }
                (Some(odd), _) => concerns.push(wrong_length(panel, [chain[bone], chain[bone + 1]], odd)),
                (None, _) => {}
            }
            bone += 1;
        }
    }
    concerns
}

fn odd_lengths(view: &PlateView<'_>, [a, b]: [Keypoint; 2]) -> Vec<Option<Odd>> {
    let length = |panel: &PanelView<'_>| {
        let (a, b) = panel.point(a).zip(panel.point(b))?;
        Some((a[0] - b[0]).hypot(a[1] - b[1]))
    };
    let seen: Vec<f64> = view.panels.iter().filter_map(length).collect();
    let median = quantile(&seen, 0.5);
    if seen.len() < LEAST_PANELS || median <= 0.0 {
        return vec![None; view.panels.len()];
    }
    let deviations: Vec<f64> = seen.iter().map(|l| (l - median).abs()).collect();
    let spread = MAD_TO_SD * quantile(&deviations, 0.5);
    let odd = |panel: &PanelView<'_>| {
        let away = length(panel)? - median;
        let hand = view.sd_px(panel, a).hypot(view.sd_px(panel, b)) / panel.height_px;
        let sd = spread.max(hand).max(LENGTH_SD_SHARE * median);
        let (stretch, sigmas) = (away / median, away.abs() / sd);
        let doubtful = sigmas > LENGTH_SIGMAS && stretch.abs() > LEAST_STRETCH;
        doubtful.then_some(Odd { stretch, px: away * panel.height_px, sigmas })
    };
    view.panels.iter().map(odd).collect()
}

fn wrong_length(panel: &PanelView<'_>, ends: [Keypoint; 2], odd: Odd) -> Concern {
    let [a, b] = ends.map(name);
    let more = if odd.stretch > 0.0 { "longer" } else { "shorter" };
    let text = format!(
        "{a} to {b} is {:.0} px ({:.0} %) {more} than in the other panels; look at both points",
        odd.px.abs(),
        100.0 * odd.stretch.abs()
    );
    concern(panel, ends[1], ends.to_vec(), odd.sigmas / LENGTH_SIGMAS, text)
}

fn wrong_joint(panel: &PanelView<'_>, joint: Keypoint, above: Odd, below: Odd) -> Concern {
    let words = |odd: Odd| {
        format!("{:.0} % too {}", 100.0 * odd.stretch.abs(), if odd.stretch > 0.0 { "long" } else { "short" })
    };
    let text = format!(
        "the bone above the {} is {} and the one below {}; move this point along the limb",
        name(joint),
        words(above),
        words(below)
    );
    concern(panel, joint, vec![joint], above.sigmas.max(below.sigmas) / LENGTH_SIGMAS, text)
}

fn concern(
    panel: &PanelView<'_>,
    on: Keypoint,
    keypoints: Vec<Keypoint>,
    size: f64,
    text: String,
) -> Concern {
    let mut concern = Concern::of_stride(ConcernKind::BoneLength, Severity::Warning, size, text);
    (concern.panel, concern.keypoints) = (Some(panel.panel), keypoints);
    if let Keypoint::Limb(side, pair, _) = on {
        concern.limb = Some((side, pair));
    }
    concern
}

/// A knee opens backwards only, a hock forwards only.
fn bent(panel: &PanelView<'_>, side: NearOff, pair: Pair) -> Option<Concern> {
    let joints =
        [LimbJoint::Upper, LimbJoint::Middle, LimbJoint::Fetlock].map(|j| Keypoint::Limb(side, pair, j));
    let [Some(a), Some(b), Some(c)] = joints.map(|joint| panel.point(joint)) else { return None };
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
    // Positive when the lower bone is turned forward against the upper one.
    let bend_deg = (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1]).to_degrees();
    let (over_deg, way) = match pair {
        Pair::Fore => (bend_deg - KNEE_LIMIT_DEG, "forwards"),
        Pair::Hind => (HOCK_LIMIT_DEG - bend_deg, "backwards"),
    };
    // Folded all but flat, a limb may seem to have passed the half turn by the hand's error.
    let folded = bend_deg.abs() > 165.0;
    (over_deg > 0.0 && !folded).then(|| {
        let text = format!(
            "the {} bends {way} by {:.0} degrees, which it cannot; look at the points around it",
            name(joints[1]),
            bend_deg.abs()
        );
        let size = 1.0 + over_deg / KNEE_LIMIT_DEG;
        Concern::of_limb(ConcernKind::BentWrongWay, (panel.panel, (side, pair)), joints.to_vec(), size, text)
    })
}

/// Neighbouring joints of a limb, or points of the body, in one place.
fn on_top(panel: &PanelView<'_>) -> Vec<Concern> {
    let limbs = LANES.iter().flat_map(|(side, pair)| {
        JOINTS.windows(2).map(|two| [0, 1].map(|i| Keypoint::Limb(*side, *pair, two[i])))
    });
    let body: Vec<Keypoint> = Keypoint::all().filter(|k| matches!(k, Keypoint::Body(_))).collect();
    let bodies =
        (0..body.len()).flat_map(|i| body[i + 1..].iter().map(|b| [body[i], *b]).collect::<Vec<_>>());
    let mut concerns = Vec::new();
    for [a, b] in limbs.chain(bodies) {
        let Some((pa, pb)) = panel.point(a).zip(panel.point(b)) else { continue };
        let apart = (pa[0] - pb[0]).hypot(pa[1] - pb[1]);
        if apart < ON_TOP {
            let text = format!("{} and {} lie in one place; move one of the two", name(a), name(b));
            let mut concern = concern(panel, a, vec![a, b], 2.0 - apart / ON_TOP, text);
            concern.kind = ConcernKind::OnTop;
            concerns.push(concern);
        }
    }
    concerns
}
