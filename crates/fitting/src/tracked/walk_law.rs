//! The walk's laws from the table: stance of a fore and of a hind limb, and stride time, each as a power of speed.
//!
//! Strides of one clip are of one horse at one speed and so are not independent. Each clip gives one point, the median
//! of its usable strides, and the intervals count clips. Some horses were filmed more than once, which the intervals do
//! not know.

use muybridge_core::Pair;

use super::robust::median;
use super::strides::MeasuredStride;
use crate::law::{ContactPoint, LawFit, fit_law};

/// Withers height by which withers heights become metres: 15 hands, an assumed mean of riding horses such as were
/// filmed. No height is stated. Single horses may differ with a standard deviation of [`WITHERS_HEIGHT_SD_M`], 4 %. Such
/// errors of the speeds bring a law's exponent nearer to zero by their share of the speeds' variance (our clips spread
/// by 16 %, so by about a tenth), which the intervals do not know.
pub const WITHERS_HEIGHT_M: f64 = 1.52;
/// Assumed standard deviation of the horses' withers heights, m.
pub const WITHERS_HEIGHT_SD_M: f64 = 0.06;

/// The laws of the walk, one point a clip.
#[derive(Clone, Debug)]
pub struct WalkLaws {
    /// Stance time of a forelimb, s, by speed, m/s.
    pub fore: LawFit,
    /// Stance time of a hind limb, s, by speed, m/s.
    pub hind: LawFit,
    /// Stride time, s, by speed, m/s.
    pub stride_time: LawFit,
    /// Points of [`WalkLaws::fore`].
    pub fore_points: Vec<ContactPoint>,
    /// Points of [`WalkLaws::hind`].
    pub hind_points: Vec<ContactPoint>,
    /// Points of [`WalkLaws::stride_time`]: stride times, not contact times.
    pub stride_time_points: Vec<ContactPoint>,
}

impl WalkLaws {
    /// The laws of a table; none when it has fewer than two clips of different speeds with usable strides of each
    /// pair.
    pub fn new(strides: &[MeasuredStride]) -> Option<Self> {
        let fore_points = contact_points(strides, Pair::Fore);
        let hind_points = contact_points(strides, Pair::Hind);
        let stride_time_points = points(strides, |stride| stride.stride_s);
        Some(Self {
            fore: fit_law(&fore_points)?,
            hind: fit_law(&hind_points)?,
            stride_time: fit_law(&stride_time_points)?,
            fore_points,
            hind_points,
            stride_time_points,
        })
    }
}

/// One point for each clip with usable strides of a pair: medians of speed, m/s, and stance time, s; in the table's
/// order of clips.
pub fn contact_points(strides: &[MeasuredStride], pair: Pair) -> Vec<ContactPoint> {
    points(strides, |stride| stride.stance_s.filter(|_| stride.limb.pair() == pair))
}

/// One point for each clip, of its usable strides that have a time.
fn points(strides: &[MeasuredStride], time_s: impl Fn(&MeasuredStride) -> Option<f64>) -> Vec<ContactPoint> {
    strides
        .chunk_by(|a, b| a.clip == b.clip)
        .filter_map(|clip| {
            let pairs: Vec<(f64, f64)> = clip
                .iter()
                .filter(|stride| stride.is_usable())
                .filter_map(|stride| stride.speed_withers_heights_per_s.zip(time_s(stride)))
                .collect();
            Some(ContactPoint {
                speed_m_s: WITHERS_HEIGHT_M * median(pairs.iter().map(|(speed, _)| *speed).collect())?,
                contact_time_s: median(pairs.iter().map(|(_, time)| *time).collect())?,
            })
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use muybridge_core::Limb;

    use super::*;
    use crate::tracked::strides::Flag;

    /// A usable stride of a limb at a speed, withers heights per second, with a stance time.
    fn stride(clip: &str, limb: Limb, speed: f64, stance_s: f64) -> MeasuredStride {
        MeasuredStride {
            stance_s: Some(stance_s),
            stride_s: Some(1.5 * stance_s),
            speed_withers_heights_per_s: Some(speed),
            flags: Vec::new(),
            ..MeasuredStride::refused(clip, limb, Flag::NoStance)
        }
    }

    #[test]
    fn each_clip_counts_once_with_the_median_of_its_usable_strides() {
        let mut strides: Vec<MeasuredStride> =
            [0.7, 0.9, 0.8].map(|stance| stride("a", Limb::LF, 1.0, stance)).into();
        strides.push(stride("a", Limb::LH, 1.1, 0.5));
        strides.push(MeasuredStride { flags: vec![Flag::CutByClip], ..stride("b", Limb::LF, 2.0, 0.1) });
        let fore = contact_points(&strides, Pair::Fore);
        assert_eq!(fore, [ContactPoint { speed_m_s: WITHERS_HEIGHT_M, contact_time_s: 0.8 }]);
        assert_eq!(contact_points(&strides, Pair::Hind).len(), 1);
        assert!(WalkLaws::new(&strides).is_none());
    }

    #[test]
    fn a_law_is_found_again() {
        let clips = ["a", "b", "c", "d", "e", "f"];
        let strides: Vec<MeasuredStride> = clips
            .iter()
            .enumerate()
            .flat_map(|(index, clip)| {
                let speed = 0.6 + 0.1 * index as f64;
                let stance =
                    |a: f64| a * (speed * WITHERS_HEIGHT_M).powf(-0.7) + 0.001 * (index as f64).sin();
                [(Limb::RF, 1.0), (Limb::LH, 1.1)].map(|(limb, a)| stride(clip, limb, speed, stance(a)))
            })
            .collect();
        let laws = WalkLaws::new(&strides).unwrap();
        assert!((laws.fore.curve.b + 0.7).abs() < 0.02 && (laws.hind.curve.a - 1.1).abs() < 0.01);
        assert_eq!((laws.fore.n, laws.stride_time_points.len()), (6, 6));
        assert!(laws.fore.interval.is_some());
    }
}
