//! Labels against the ground: hooves that stand in the air, hooves that swing lying still.

use muybridge_capture::{Keypoint, NearOff, StanceLabel};
use muybridge_core::Pair;

use super::view::PlateView;
use super::{Concern, ConcernKind};
use crate::footfalls::{LANES, leg_name};
use crate::held_out::quantile;

/// A stance toe this far over or under the ground line is doubted, withers heights: 3 %, twice what `contacts.rs` takes
/// for the air, because the line has its own error.
const OFF_GROUND: f64 = 0.03;
/// ... and never less than this many standard deviations of the hand that placed it.
const HAND_SIGMAS: f64 = 3.5;
/// A toe within this of the ground may stand, withers heights: the scatter of a placed toe.
const ON_GROUND: f64 = 0.012;
/// A toe that moves less than this from panel to panel lies still, withers heights.
const STILL: f64 = 0.02;

pub(super) fn concerns(view: &PlateView<'_>) -> Vec<Concern> {
    LANES
        .into_iter()
        .flat_map(|(side, pair)| {
            let mut concerns = stance_off_ground(view, side, pair);
            concerns.extend(swing_on_ground(view, side, pair));
            concerns
        })
        .collect()
}

fn stance_off_ground(view: &PlateView<'_>, side: NearOff, pair: Pair) -> Vec<Concern> {
    let stances: Vec<(usize, f64)> = view
        .panels
        .iter()
        .enumerate()
        .filter(|(_, panel)| panel.label(side, pair) == StanceLabel::Stance)
        .filter_map(|(k, panel)| Some((k, view.toe_height(panel, side, pair)?)))
        .collect();
    // Without cameras it is not known how much higher the off hooves appear.
    let calibrated = view.panels.iter().all(|panel| panel.camera.is_some());
    let heights: Vec<f64> = stances.iter().map(|(_, height)| *height).collect();
    let ground = if calibrated || side == NearOff::Near { 0.0 } else { quantile(&heights, 0.5) };
    stances
        .into_iter()
        .map(|(k, height)| (&view.panels[k], height - ground))
        .map(|(panel, height)| {
            let sd = view.sd_px(panel, Keypoint::hoof(side, pair)) / panel.height_px;
            (panel, height, OFF_GROUND.max(HAND_SIGMAS * sd))
        })
        .filter(|(_, height, limit)| height.abs() > *limit)
        .map(|(panel, height, limit)| {
            let way = if height > 0.0 { "over" } else { "under" };
            let text = format!(
                "{} is labelled stance, but its toe is {:.0} px ({:.1} % of withers height) {way} the ground line; \
                 check the label, the toe and the line",
                leg_name(side, pair),
                height.abs() * panel.height_px,
                100.0 * height.abs()
            );
            let keypoints = vec![Keypoint::hoof(side, pair)];
            let size = height.abs() / limit;
            Concern::of_limb(ConcernKind::StanceOffGround, (panel.panel, (side, pair)), keypoints, size, text)
        })
        .collect()
}

/// A toe on the ground and in the place where it is in a neighbouring panel: surely standing when it is there in both.
fn swing_on_ground(view: &PlateView<'_>, side: NearOff, pair: Pair) -> Vec<Concern> {
    let toes: Vec<Option<[f64; 2]>> = view.panels.iter().map(|panel| view.toe(panel, side, pair)).collect();
    let still = |k: usize, other: usize| {
        let (Some([x, y]), Some(Some([ox, oy]))) = (toes[k], toes.get(other)) else { return false };
        y.abs() < ON_GROUND && oy.abs() < 2.0 * ON_GROUND && (x - ox).abs() < STILL
    };
    let mut concerns = Vec::new();
    for (k, panel) in view.panels.iter().enumerate() {
        let both = k > 0 && still(k, k - 1) && still(k, k + 1);
        if panel.label(side, pair) == StanceLabel::Swing && both {
            let text = format!(
                "{} is labelled swing, but its toe lies on the ground and stays where it is in the panels before and after; \
                 label it stance",
                leg_name(side, pair)
            );
            let at = (panel.panel, (side, pair));
            let keypoints = vec![Keypoint::hoof(side, pair)];
            concerns.push(Concern::of_limb(ConcernKind::SwingOnGround, at, keypoints, 2.0, text));
        }
    }
    concerns
}
