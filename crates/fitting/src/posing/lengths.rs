//! Bone lengths of a plate's animal from placed points, before there is a fit.

use muybridge_capture::{BodyPoint, Facing, Keypoint, Keypoints, LimbJoint, NearOff, PanelCamera};
use muybridge_core::{Pair, Skeleton};

use crate::chain::Chain;
use crate::layout::{BENDS, LOG_DOCK, PANEL_DOF, SHARED, SLIDES, log_length};
use crate::observation::{attachment, depth_m};
use crate::weights::Weights;

/// The placed points of a panel, and its camera.
#[derive(Clone, Copy, Debug)]
pub struct PlacedPanel<'a> {
    /// Calibrated or provisional.
    pub camera: &'a PanelCamera,
    /// The points.
    pub keypoints: &'a Keypoints,
}

/// Bounds of a log-length: those of the stride fit.
const LOG_BOUNDS: [f64; 2] = [-1.1, 1.1];
/// From the median absolute deviation to a standard deviation, for normal scatter.
const SD_PER_MAD: f64 = 1.4826;
/// Variance of a median over that of a mean, for normal scatter.
const MEDIAN_VARIANCE: f64 = std::f64::consts::FRAC_PI_2;

/// Two neighbouring keypoints, and the log-lengths of the bones between them.
struct Span {
    ends: [Keypoint; 2],
    bones: Vec<usize>,
}

/// A log-length as the placed points show it.
struct Shown {
    shared: Vec<usize>,
    log_ratio: f64,
    variance: f64,
}

/// The shared log-lengths of a plate: what the fit calls [`shared`](crate::stride_fit::StrideFit::shared).
///
/// Each distance between neighbouring keypoints counts by the median over the panels, of near limbs, or of off limbs
/// where no near one is placed. All of them together give the overall scale, which is held to the reference by
/// `log_scale_sd`; each is then drawn to that scale by `log_length_sd` (0.10), the more the fewer and the more scattered
/// its points are. What is not placed has the reference's proportion.
pub fn plate_lengths(skeleton: &Skeleton, facing: Facing, panels: &[PlacedPanel<'_>]) -> [f64; SHARED] {
    let weights = Weights::default();
    let chain = Chain::new(skeleton);
    let mut rest = [0.0; PANEL_DOF];
    rest[BENDS..SLIDES].copy_from_slice(&chain.rest_rad);
    let at_rest = chain.kinematics(&rest, &[0.0; SHARED]);
    let shown = spans().into_iter().filter_map(|sides| {
        sides.iter().find_map(|span| {
            let [a, b] = span.ends.map(|end| at_rest.place(attachment(end, facing)));
            let rest_m = (a[0] - b[0]).hypot(a[1] - b[1]);
            let logs = panels.iter().filter_map(|panel| {
                let [a, b] = span.ends.map(|end| place_m(&chain, facing, panel, end));
                let ([ax, ay], [bx, by]) = (a?, b?);
                let ratio = (ax - bx).hypot(ay - by) / rest_m;
                (ratio > 0.0 && ratio.is_finite()).then(|| ratio.ln())
            });
            // A landmark stands off its joint in the same way in every panel, so this part is no smaller for many panels.
            let landmarks = 2.0 * (weights.landmark_sd_m / rest_m).powi(2);
            let (log_ratio, variance) = median_and_variance(logs.collect(), landmarks)?;
            Some(Shown { shared: span.bones.clone(), log_ratio, variance: variance + landmarks })
        })
    });
    shrunk(&shown.collect::<Vec<_>>(), &weights)
}

fn place_m(chain: &Chain, facing: Facing, panel: &PlacedPanel<'_>, keypoint: Keypoint) -> Option<[f64; 2]> {
    let depth = depth_m(chain, attachment(keypoint, facing), facing);
    let [x, y, _] = panel.camera.world_from_plate(panel.keypoints.place(keypoint)?, depth);
    Some([x, y])
}

/// All spans, near limbs before off ones. Back and neck bend a little between their keypoints, but about as much at rest.
fn spans() -> Vec<Vec<Span>> {
    use BodyPoint::{Back, Croup, Dock, Muzzle, Poll, Withers};
    let body = [
        ([Croup, Back], vec![0, 1]),
        ([Back, Withers], vec![2, 3]),
        ([Withers, Poll], vec![4, 5, 6]),
        ([Poll, Muzzle], vec![7]),
        ([Croup, Dock], vec![LOG_DOCK]),
    ];
    let body = body.map(|(ends, bones)| vec![Span { ends: ends.map(Keypoint::Body), bones }]);
    let joints = [LimbJoint::Root, LimbJoint::Upper, LimbJoint::Middle, LimbJoint::Fetlock, LimbJoint::Hoof];
    let limbs = [Pair::Fore, Pair::Hind].into_iter().flat_map(|pair| {
        (0..5).filter_map(move |i| {
            let sides = [NearOff::Near, NearOff::Off].into_iter().filter_map(|side| {
                let lower = Keypoint::Limb(side, pair, joints[i]);
                let upper = match (i.checked_sub(1), pair) {
                    (Some(above), _) => Keypoint::Limb(side, pair, joints[above]),
                    (None, Pair::Hind) => Keypoint::Body(Croup),
                    // The scapula slides, so that no keypoint marks its upper end.
                    (None, Pair::Fore) => return None,
                };
                let bones = vec![log_length(lower.bone(Facing::Left)?)];
                Some(Span { ends: [upper, lower], bones })
            });
            let sides: Vec<Span> = sides.collect();
            (!sides.is_empty()).then_some(sides)
        })
    });
    body.into_iter().chain(limbs).collect()
}

/// Median, and its variance from the scatter, which is taken as no less than that of landmarks; none without values.
fn median_and_variance(mut values: Vec<f64>, least_variance: f64) -> Option<(f64, f64)> {
    let middle = median(&mut values)?;
    let mut strays: Vec<f64> = values.iter().map(|value| (value - middle).abs()).collect();
    let sd = SD_PER_MAD * median(&mut strays)?;
    Some((middle, MEDIAN_VARIANCE * (sd * sd).max(least_variance) / values.len() as f64))
}

/// The median; the mean of the middle two where their number is even. None without values.
pub(super) fn median(values: &mut [f64]) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let (low, high) = (values.len().checked_sub(1)? / 2, values.len() / 2);
    Some(0.5 * (values[low] + values[high]))
}

/// The scale of all, and each log-length drawn to it.
fn shrunk(shown: &[Shown], weights: &Weights) -> [f64; SHARED] {
    let between = weights.log_length_sd.powi(2);
    let (mut sum, mut precision) = (0.0, weights.log_scale_sd.powi(-2));
    for one in shown {
        sum += one.log_ratio / (one.variance + between);
        precision += 1.0 / (one.variance + between);
    }
    let scale = sum / precision;
    let mut lengths = [scale; SHARED];
    for one in shown {
        let drawn = (one.log_ratio / one.variance + scale / between) / (1.0 / one.variance + 1.0 / between);
        for index in &one.shared {
            lengths[*index] = drawn;
        }
    }
    lengths.map(|value| value.clamp(LOG_BOUNDS[0], LOG_BOUNDS[1]))
}
