//! How well the fit predicts points it has not seen: each keypoint type left out of all panels in turn.
//!
//! On the plate of 1878 this is not wholly independent: the shares of the swing fetlock (`horse.json`) and the Cauchy
//! scale were chosen with its errors in view. A second gallop will tell what they are worth elsewhere.

use muybridge_capture::{Keypoint, KeypointState};
use muybridge_core::Skeleton;
use rayon::prelude::*;

use crate::stride_fit::{PointResidual, StrideFit, refit_stride};
use crate::weights::Weights;

/// Errors of all visible points of a plate, each predicted by a fit that saw no point of its type in any panel.
///
/// Occluded points are guesses themselves and are not predicted against. In the order of keypoint, then panel.
pub fn held_out_errors(skeleton: &Skeleton, fit: &StrideFit, weights: &Weights) -> Vec<PointResidual> {
    let types: Vec<Keypoint> = Keypoint::all().collect();
    let per_type: Vec<Vec<PointResidual>> = types
        .par_iter()
        .map(|keypoint| {
            let left = fit.observation.without(*keypoint);
            let refit = refit_stride(skeleton, &left, fit.stride_time, weights, fit);
            let residuals = refit.residuals_of(&fit.observation).into_iter();
            residuals.filter(|r| r.keypoint == *keypoint && r.state == KeypointState::Visible).collect()
        })
        .collect();
    per_type.into_iter().flatten().collect()
}

/// The value below which a share of the values lies, 0 to 1, linear between neighbours; zero for no values.
pub fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    let Some(last) = sorted.len().checked_sub(1) else { return 0.0 };
    let at = share.clamp(0.0, 1.0) * last as f64;
    let low = at.floor() as usize;
    let high = (low + 1).min(last);
    sorted[low] + (sorted[high] - sorted[low]) * (at - low as f64)
}
