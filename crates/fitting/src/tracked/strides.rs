//! Strides from contacts: times, duty factor, speed, stride length, and what is wrong with each.

use muybridge_core::{Limb, Side};

use super::cleaning::{CleanClip, HoofTrack};
use super::contacts::{Edge, Stance};
use super::ground::Ground;
use super::robust::{median, slope};

/// Largest share of a stride's frames in which the hoof's place may be filled in.
const MOST_FILLED: f64 = 0.3;
/// Two legs of a pair never step on the same print: their prints lie half a stride (0.6 withers heights) apart.
const SAME_PRINT: f64 = 0.15;
/// Duty factors of a walk, wider than any that is published (0.55 to 0.75), so that the median is not made here.
const DUTY_FACTORS: [f64; 2] = [0.45, 0.9];
/// Most by which the distance between two prints may differ from the trunk's advance in the same time, as a share.
const MOST_DISAGREEMENT: f64 = 0.2;
/// Range of the distance between two prints as a share of the trunk's advance that says something about scale.
const SCALES: [f64; 2] = [0.75, 1.25];
/// Factor of the numbers that are kept: a tenth of a millisecond, a ten-thousandth of a withers height.
const PRECISION: f64 = 1e4;

/// Why a stride cannot be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Flag {
    /// The clip begins or ends within it.
    CutByClip,
    /// The hoof was not seen at strike or lift-off, or in too many frames.
    HoofNotTracked,
    /// Both legs of the pair seem to stand on one print: left and right are exchanged somewhere.
    SwapNotResolved,
    /// The share of the stride in stance is none of a walk; most often a stance was missed.
    ImplausibleDutyFactor,
    /// The prints are not as far apart as the trunk has moved.
    PrintsDisagree,
    /// The leg was never seen to stand.
    NoStance,
    /// The horse stands.
    Standing,
    /// The horse turns.
    Turning,
    /// The horse comes towards the camera or walks away from it.
    TowardsOrAway,
    /// The horse walks backwards.
    Backwards,
    /// Withers or croup were not tracked.
    TrunkNotTracked,
    /// Too few hooves were seen to stand to know where the ground is.
    NoGround,
}

impl Flag {
    /// All flags.
    pub const ALL: [Self; 12] = [
        Self::CutByClip,
        Self::HoofNotTracked,
        Self::SwapNotResolved,
        Self::ImplausibleDutyFactor,
        Self::PrintsDisagree,
        Self::NoStance,
        Self::Standing,
        Self::Turning,
        Self::TowardsOrAway,
        Self::Backwards,
        Self::TrunkNotTracked,
        Self::NoGround,
    ];

    /// Name in the table.
    pub fn name(self) -> &'static str {
        match self {
            Self::CutByClip => "cut_by_clip",
            Self::HoofNotTracked => "hoof_not_tracked",
            Self::SwapNotResolved => "swap_not_resolved",
            Self::ImplausibleDutyFactor => "implausible_duty_factor",
            Self::PrintsDisagree => "prints_disagree",
            Self::NoStance => "no_stance",
            Self::Standing => "standing",
            Self::Turning => "turning",
            Self::TowardsOrAway => "towards_or_away",
            Self::Backwards => "backwards",
            Self::TrunkNotTracked => "trunk_not_tracked",
            Self::NoGround => "no_ground",
        }
    }
}

/// One leg's stride, from strike to strike, as far as it is known; a row of the table. A number is there when what it
/// is made of was seen; a stride without flags has them all.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredStride {
    /// Name of the clip.
    pub clip: String,
    /// The leg.
    pub limb: Limb,
    /// Strike, s from the clip's first frame.
    pub strike_s: Option<f64>,
    /// Strike to lift-off, s.
    pub stance_s: Option<f64>,
    /// Lift-off to the next strike, s.
    pub swing_s: Option<f64>,
    /// Strike to strike, s.
    pub stride_s: Option<f64>,
    /// Stance as a share of the stride.
    pub duty_factor: Option<f64>,
    /// Mean speed of the trunk over the stride, withers heights per second.
    pub speed_withers_heights_per_s: Option<f64>,
    /// Advance of the trunk in the stride, withers heights.
    pub stride_length_withers_heights: Option<f64>,
    /// Frames of the stride in which the hoof's place is filled in.
    pub frames_interpolated: usize,
    /// Runs of frames in which the leg had the other leg's name.
    pub swaps_mended: usize,
    /// What is wrong, in the order of [`Flag::ALL`]; nothing in a usable stride.
    pub flags: Vec<Flag>,
}

impl MeasuredStride {
    /// A row that says only why there is no stride.
    pub(super) fn refused(clip: &str, limb: Limb, flag: Flag) -> Self {
        Self {
            clip: clip.to_string(),
            limb,
            strike_s: None,
            stance_s: None,
            swing_s: None,
            stride_s: None,
            duty_factor: None,
            speed_withers_heights_per_s: None,
            stride_length_withers_heights: None,
            frames_interpolated: 0,
            swaps_mended: 0,
            flags: vec![flag],
        }
    }

    /// Whether nothing is wrong with it.
    pub fn is_usable(&self) -> bool {
        self.flags.is_empty()
    }
}

/// What the strides of a clip are made from.
pub(super) struct StrideMaker<'c> {
    pub(super) name: &'c str,
    pub(super) clean: &'c CleanClip,
    pub(super) ground: &'c Ground,
    /// In the order of [`Limb::ALL`].
    pub(super) stances: &'c [Vec<Stance>; 4],
    pub(super) frames_per_s: f64,
}

impl StrideMaker<'_> {
    /// A stride for every stance of every leg.
    pub(super) fn strides(&self) -> Vec<MeasuredStride> {
        let scale = self.scale();
        let of_limb = |limb: Limb| -> Vec<MeasuredStride> {
            let stances = &self.stances[limb.index()];
            if stances.is_empty() {
                return vec![MeasuredStride::refused(self.name, limb, Flag::NoStance)];
            }
            let next = stances.iter().skip(1).map(Some).chain([None]);
            stances.iter().zip(next).map(|(stance, next)| self.stride(limb, stance, next, scale)).collect()
        };
        Limb::ALL.into_iter().flat_map(of_limb).collect()
    }

    /// What the trunk's advance must be multiplied with to be that of the feet.
    ///
    /// The points of the trunk are tracked on its near surface and higher in the picture, so they seem to move faster
    /// than the feet, by 7 % in the mean of our clips; but no trunk outruns its feet. Near prints seem further apart
    /// than off ones, by 5 %; the animal's middle is between the two.
    fn scale(&self) -> f64 {
        let of_side = |side: Side| {
            let limbs = Limb::ALL.into_iter().filter(|limb| limb.side() == side);
            let ratios = limbs.flat_map(|limb| self.stances[limb.index()].windows(2)).filter_map(|two| {
                let (from, to) = (two[0].strike.frame()?, two[1].strike.frame()?);
                let advance = self.trunk_speed(from, to)? * (to - from) / self.frames_per_s;
                Some((two[1].rest[0] - two[0].rest[0]) / advance)
            });
            median(ratios.filter(|ratio| (SCALES[0]..=SCALES[1]).contains(ratio)).collect())
        };
        match [Side::Left, Side::Right].map(of_side) {
            [Some(left), Some(right)] => 0.5 * (left + right),
            [one, other] => one.or(other).unwrap_or(1.0),
        }
    }

    fn stride(&self, limb: Limb, stance: &Stance, next: Option<&Stance>, scale: f64) -> MeasuredStride {
        let strike = stance.strike.frame();
        let lift_off = stance.lift_off.frame();
        let next_strike = next.and_then(|next| next.strike.frame());
        let seconds = |from: Option<f64>, to: Option<f64>| positive((to? - from?) / self.frames_per_s);
        let stance_s = seconds(strike, lift_off);
        let stride_s = seconds(strike, next_strike);
        let speed = strike
            .zip(next_strike)
            .and_then(|(from, to)| self.trunk_speed(from, to))
            .and_then(|speed| positive(scale * speed));
        let track = &self.clean.hooves[limb.index()];
        let first = strike.map_or(stance.core[0], |frame| frame.floor() as usize);
        let last = next_strike.map_or(stance.core[1], |frame| frame.ceil() as usize);
        let frames = first..=last.max(first);
        let mut stride = MeasuredStride {
            strike_s: strike.map(|frame| round(frame / self.frames_per_s)),
            stance_s,
            swing_s: seconds(lift_off, next_strike),
            stride_s,
            duty_factor: stance_s.zip(stride_s).and_then(|(stance, stride)| positive(stance / stride)),
            speed_withers_heights_per_s: speed,
            stride_length_withers_heights: speed
                .zip(stride_s)
                .and_then(|(speed, stride)| positive(speed * stride)),
            frames_interpolated: track.filled[frames.clone()].iter().filter(|filled| **filled).count(),
            swaps_mended: swaps(track, frames.clone()),
            ..MeasuredStride::refused(self.name, limb, Flag::NoStance)
        };
        stride.flags = self.flags(&stride, stance, next, frames.count());
        stride
    }

    fn flags(
        &self,
        stride: &MeasuredStride,
        stance: &Stance,
        next: Option<&Stance>,
        frames: usize,
    ) -> Vec<Flag> {
        let edges = [stance.strike, stance.lift_off, next.map_or(Edge::Cut, |next| next.strike)];
        // Instants in the wrong order, or a trunk that does not advance, leave numbers out.
        let seen = edges.iter().all(|edge| edge.frame().is_some());
        let whole = stride.swing_s.and(stride.stride_length_withers_heights).is_some();
        let lost = edges.contains(&Edge::Unseen) || (seen && !whole);
        let filled = stride.frames_interpolated as f64 > MOST_FILLED * frames as f64;
        let shared = self.shares_print(stride.limb, stance)
            || next.is_some_and(|next| self.shares_print(stride.limb, next));
        let duty =
            stride.duty_factor.is_some_and(|duty| !(DUTY_FACTORS[0]..=DUTY_FACTORS[1]).contains(&duty));
        let apart = stride.stride_length_withers_heights.zip(next).is_some_and(|(length, next)| {
            ((next.rest[0] - stance.rest[0]) / length - 1.0).abs() > MOST_DISAGREEMENT
        });
        let found = [
            (Flag::CutByClip, edges.contains(&Edge::Cut)),
            (Flag::HoofNotTracked, lost || filled),
            (Flag::SwapNotResolved, shared),
            (Flag::ImplausibleDutyFactor, duty),
            (Flag::PrintsDisagree, apart),
        ];
        found.into_iter().filter_map(|(flag, there)| there.then_some(flag)).collect()
    }

    /// Whether the other leg of the pair stands where this one does.
    fn shares_print(&self, limb: Limb, stance: &Stance) -> bool {
        let other = Limb::new(limb.pair(), limb.side().opposite());
        self.stances[other.index()].iter().any(|of| (of.rest[0] - stance.rest[0]).abs() < SAME_PRINT)
    }

    /// Speed of the trunk between two instants, in frames: the mean of withers and croup, withers heights per second.
    fn trunk_speed(&self, from: f64, to: f64) -> Option<f64> {
        let trunk = &self.clean.trunk;
        let of = |track: &[[f64; 2]]| {
            let frames = from.ceil() as usize..=to.floor() as usize;
            let points: Vec<[f64; 2]> =
                frames.map(|frame| [frame as f64, self.ground.place(track[frame])[0]]).collect();
            slope(&points)
        };
        Some(0.5 * (of(&trunk.withers_px)? + of(&trunk.croup_px)?) * self.frames_per_s)
    }
}

/// Runs of frames in which the leg had the other leg's name.
fn swaps(track: &HoofTrack, frames: std::ops::RangeInclusive<usize>) -> usize {
    let mut before = false;
    let mut runs = 0;
    for frame in frames.filter(|frame| track.at_px[*frame].is_some() && !track.filled[*frame]) {
        runs += usize::from(track.swapped[frame] && !before);
        before = track.swapped[frame];
    }
    runs
}

fn round(value: f64) -> f64 {
    (value * PRECISION).round() / PRECISION
}

/// A number as it is kept, if there is anything left of it.
fn positive(value: f64) -> Option<f64> {
    Some(round(value)).filter(|value| *value > 0.0 && value.is_finite())
}

/// Where the hooves rested, px, by side: what the ground is found from.
pub(super) fn prints_px(clean: &CleanClip, cores: &[Vec<[usize; 2]>; 4]) -> Vec<(Side, [f64; 2])> {
    let mut prints = Vec::new();
    for limb in Limb::ALL {
        let track = &clean.hooves[limb.index()];
        for [first, last] in &cores[limb.index()] {
            let places: Vec<[f64; 2]> = track.at_px[*first..=*last].iter().flatten().copied().collect();
            let axis = |axis: usize| median(places.iter().map(|at| at[axis]).collect());
            if let (Some(x), Some(y)) = (axis(0), axis(1)) {
                prints.push((limb.side(), [x, y]));
            }
        }
    }
    prints
}
