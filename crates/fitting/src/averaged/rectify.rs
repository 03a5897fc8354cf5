//! From a picture in which the animal grows, shrinks and goes uphill to one seen squarely from the side.
//!
//! An animal that comes nearer as it passes a camera that stands still is drawn larger, its feet lower, its withers higher.
//! Ground line and withers line are straight lines in the picture; between them is its height. Its length changes by another
//! ratio, because the angle of view changes, too; that is read off the trunk.

use muybridge_capture::{BodyPoint, Facing, Keypoint, NearOff};
use muybridge_core::Pair;

use super::AverageFault;
use super::clip::{Clip, Track};
use super::naming::Landmark;
use super::robust::{Line, median, quantile};
use super::strides::{Strides, Sweep, find};

/// Hooves of a stride this low or lower, as a share of its frames, stand on the ground: under every duty factor.
const LOWEST: f64 = 0.2;
/// Sizes outside of these, against the middle of the clip, are no size of the same animal.
const SIZES: [f64; 2] = [0.3, 3.0];
/// Least way of the trunk through the picture during a stride, in trunk lengths: a walk makes two.
const LEAST_ADVANCE: f64 = 0.5;

/// How the animal stands in the picture, frame by frame.
#[derive(Clone, Debug)]
pub(super) struct Picture {
    /// Which way it goes.
    pub(super) facing: Facing,
    /// Its strides.
    pub(super) strides: Strides,
    /// Middle of the frames in which the trunk is seen.
    pub(super) middle: f64,
    /// Place in x and speed of the trunk's middle, averaged over a stride, px and px/frame; none where it is not seen.
    trunk_px: Vec<Option<[f64; 2]>>,
    /// Length of the trunk in x by frame, height of withers and ground (y) by the frame in which the trunk is above, px.
    length_px: Line,
    withers_px: Line,
    ground_px: Line,
}

impl Picture {
    /// Looks at a clip.
    pub(super) fn new(clip: &Clip) -> Result<Self, AverageFault> {
        let body = |point| clip.track(Landmark::Body(point)).ok_or(AverageFault::NoTrunk);
        let (withers, croup) = (body(BodyPoint::Withers)?, body(BodyPoint::Croup)?);
        let both =
            withers.iter().zip(croup).enumerate().filter_map(|(frame, (w, c))| Some((frame, (*w)?, (*c)?)));
        let lengths: Vec<[f64; 2]> = both.map(|(frame, w, c)| [frame as f64, w[0] - c[0]]).collect();
        let length_px = Line::through(&lengths).ok_or(AverageFault::NoTrunk)?;
        let middle =
            median(lengths.iter().map(|[frame, _]| *frame).collect()).ok_or(AverageFault::NoTrunk)?;
        let facing = if length_px.at(middle) < 0.0 { Facing::Left } else { Facing::Right };
        let middles = trunk_middles(withers, croup, length_px);
        let strides = find(&sweeps(clip, &middles, facing), length_px.at(middle).abs())?;
        let trunk_px: Vec<_> =
            (0..clip.frames).map(|frame| local_line(&middles, frame, strides.period_frames)).collect();
        let speed = median(trunk_px.iter().flatten().map(|[_, speed]| *speed).collect()).unwrap_or(0.0);
        if facing.sign() * speed * strides.period_frames < LEAST_ADVANCE * length_px.at(middle).abs() {
            return Err(AverageFault::NoAdvance);
        }
        let line = |points: Vec<[f64; 2]>| Line::through(&points).ok_or(AverageFault::NoTrunk);
        let above = |track: &Track| above_frames(track, &trunk_px);
        let withers_px = line(above(withers))?;
        let ground_px = line(soles(clip, facing, &trunk_px, strides.period_frames))?;
        let picture = Self { facing, strides, middle, trunk_px, length_px, withers_px, ground_px };
        if picture.height_px(middle) > 0.0 { Ok(picture) } else { Err(AverageFault::NoTrunk) }
    }

    /// Height of the withers over the ground where the trunk is in a frame, px.
    fn height_px(&self, frame: f64) -> f64 {
        self.ground_px.at(frame) - self.withers_px.at(frame)
    }

    /// Strides since the first frame.
    pub(super) fn turns(&self, frame: f64) -> f64 {
        frame / self.strides.period_frames
    }

    /// A place in a frame, forward of the trunk's middle and above the ground, in withers heights; none without a trunk.
    pub(super) fn place(&self, frame: usize, at_px: [f64; 2]) -> Option<[f64; 2]> {
        let [trunk_px, speed] = self.trunk_px[frame]?;
        let now = frame as f64;
        // When the trunk is, or was, where this point is: there the ground is as high as under the point.
        let above = now + (at_px[0] - trunk_px) / speed;
        let sizes = [
            self.length_px.at(0.5 * (now + above)) / self.length_px.at(self.middle),
            self.height_px(above) / self.height_px(self.middle),
        ];
        if sizes.iter().any(|size| !(SIZES[0]..=SIZES[1]).contains(size)) {
            return None;
        }
        let in_px = [
            self.facing.sign() * (at_px[0] - trunk_px) / sizes[0],
            (self.ground_px.at(above) - at_px[1]) / sizes[1],
        ];
        Some(in_px.map(|px| px / self.height_px(self.middle)))
    }

    /// Distance of the trunk during a stride, withers heights.
    pub(super) fn advance(&self) -> f64 {
        let near = self.trunk_px.iter().enumerate().filter_map(|(frame, trunk)| {
            let size = self.length_px.at(frame as f64) / self.length_px.at(self.middle);
            trunk.map(|[_, speed]| speed.abs() / size)
        });
        median(near.collect()).unwrap_or(0.0) * self.strides.period_frames / self.height_px(self.middle)
    }

    /// Length and height of the animal in the first and the last frame of its trunk, against the middle.
    pub(super) fn sizes(&self) -> [[f64; 2]; 2] {
        let seen = |frame: &usize| self.trunk_px[*frame].is_some();
        let first = (0..self.trunk_px.len()).find(seen).unwrap_or(0) as f64;
        let last = (0..self.trunk_px.len()).rfind(seen).unwrap_or(0) as f64;
        [first, last].map(|frame| {
            [
                self.length_px.at(frame) / self.length_px.at(self.middle),
                self.height_px(frame) / self.height_px(self.middle),
            ]
        })
    }
}

/// Middle of the trunk in x, px, by frame: from both its ends, or from one and the length.
fn trunk_middles(withers: &Track, croup: &Track, length_px: Line) -> Vec<Option<f64>> {
    let middle = |frame: usize| {
        let half = 0.5 * length_px.at(frame as f64);
        match (withers[frame], croup[frame]) {
            (Some(withers), Some(croup)) => Some(0.5 * (withers[0] + croup[0])),
            (Some(withers), None) => Some(withers[0] - half),
            (None, Some(croup)) => Some(croup[0] + half),
            (None, None) => None,
        }
    };
    (0..withers.len()).map(middle).collect()
}

/// Hooves against the middle of the trunk.
fn sweeps(clip: &Clip, middles: &[Option<f64>], facing: Facing) -> Vec<Sweep> {
    let is_hoof = |landmark: Landmark| {
        let sides = [NearOff::Near, NearOff::Off];
        let hooves =
            sides.into_iter().flat_map(|side| [Pair::Fore, Pair::Hind].map(|p| Keypoint::hoof(side, p)));
        hooves.into_iter().any(|hoof| hoof == landmark.keypoint(facing))
    };
    let hooves = clip.tracks.iter().filter(|(landmark, _)| is_hoof(*landmark));
    let sweep = |track: &Track| {
        let places = track.iter().zip(middles).enumerate();
        places.filter_map(|(frame, (hoof, middle))| Some((frame, (*hoof)?[0] - (*middle)?))).collect()
    };
    hooves.map(|(_, track)| sweep(track)).collect()
}

/// Value and slope in a frame of the straight line through a stride's frames around it; none where none is known near.
fn local_line(values: &[Option<f64>], frame: usize, period: f64) -> Option<[f64; 2]> {
    values[frame]?;
    let known = |i: &usize| values[*i].is_some();
    let (first, last) = ((0..values.len()).find(known)?, (0..values.len()).rfind(known)?);
    let width = (period.round() as usize).min(last - first);
    // Always a whole stride, so that its swaying averages out; at the ends it lies to one side.
    let start = frame.saturating_sub(width / 2).clamp(first, last - width);
    let points = (start..=start + width).filter_map(|i| Some([i as f64 - frame as f64, values[i]?]));
    let sums =
        points.fold([0.0; 5], |[n, x, y, xx, xy], [a, b]| [n + 1.0, x + a, y + b, xx + a * a, xy + a * b]);
    let [n, x, y, xx, xy] = sums;
    let slope = (n * xy - x * y) / (n * xx - x * x);
    (slope.is_finite() && slope != 0.0).then(|| [(y - slope * x) / n, slope])
}

/// A track's heights (y) against the frames in which the trunk is above.
fn above_frames(track: &[Option<[f64; 2]>], trunk_px: &[Option<[f64; 2]>]) -> Vec<[f64; 2]> {
    let places = track.iter().zip(trunk_px).enumerate();
    places
        .filter_map(|(frame, (place, trunk))| {
            let ([x, y], [trunk_px, speed]) = ((*place)?, (*trunk)?);
            Some([frame as f64 + (x - trunk_px) / speed, y])
        })
        .collect()
}

/// Heights (y) of near soles on the ground against the frames in which the trunk is above: the lowest of every stride.
fn soles(clip: &Clip, facing: Facing, trunk_px: &[Option<[f64; 2]>], period: f64) -> Vec<[f64; 2]> {
    let mut lowest = Vec::new();
    let near = [Pair::Fore, Pair::Hind].map(|pair| Keypoint::hoof(NearOff::Near, pair));
    for (_, track) in clip.tracks.iter().filter(|(landmark, _)| near.contains(&landmark.keypoint(facing))) {
        let width = (period.round() as usize).min(track.len());
        for start in (0..=track.len() - width).step_by((width / 4).max(1)) {
            let window = start..start + width;
            let part: Vec<[f64; 2]> = above_frames(&track[window.clone()], &trunk_px[window]);
            // A window with most of a stride missing may lack its stance.
            if part.len() * 4 < width * 3 {
                continue;
            }
            let Some(floor) = quantile(part.iter().map(|p| p[1]).collect(), 1.0 - LOWEST) else { continue };
            let standing = part.into_iter().filter(|p| p[1] >= floor);
            lowest.extend(standing.map(|[above, y]| [above + start as f64, y]));
        }
    }
    lowest
}
