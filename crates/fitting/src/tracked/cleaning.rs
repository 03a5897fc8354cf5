//! A clip made usable: the direction of travel, the trunk without jumps, every hoof with its own leg.

use muybridge_core::{Limb, Pair, Side};

use super::assignment::{PairTracks, TRUSTED_LIKELIHOOD};
use super::clip::{Clip, TrackedPoint};
use super::robust::{median, slope};

/// Frames to either side that say where a point of the trunk should be.
const NEIGHBOURS: usize = 4;
/// A point of the trunk further from there than this many robust standard deviations is a jump.
const JUMP: f64 = 4.0;
/// Nor is anything a jump that is smaller than this, px: the tracker's own scatter on the outline of the trunk.
const LEAST_JUMP_PX: f64 = 15.0;
/// Factor from a median absolute deviation to a standard deviation of normal errors.
const MAD_TO_SD: f64 = 1.4826;
/// Frames to either side over which the trunk's speed is averaged: the withers surge twice a stride.
const SPEED_NEIGHBOURS: usize = 6;
/// Least speed of the trunk by which others are measured, px/frame.
const LEAST_SPEED_PX: f64 = 1.0;
/// Longest gap in a hoof's track that is filled, s: a third of a swing could be hidden in more.
const LONGEST_FILLED_S: f64 = 0.4;

/// What was found wrong in a clip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Faults {
    /// Detections of hooves, withers or croup that the tracker itself does not trust (likelihood under 0.6).
    pub drop_outs: usize,
    /// Trusted detections of them that cannot be where they are, and were left out.
    pub jumps: usize,
    /// Runs of frames in which left and right of a pair were exchanged and have been put right.
    pub swaps: usize,
    /// Frames in these runs.
    pub swapped_frames: usize,
}

/// The trunk: withers and croup, jumps replaced by what their neighbours say.
#[derive(Clone, Debug)]
pub struct Trunk {
    /// Withers in each frame, px.
    pub withers_px: Vec<[f64; 2]>,
    /// Croup in each frame, px.
    pub croup_px: Vec<[f64; 2]>,
    /// Share of the frames in which both had to be replaced.
    pub missing: f64,
}

/// A leg's hoof.
#[derive(Clone, Debug)]
pub struct HoofTrack {
    /// Place in each frame, px; none where it is unknown over too long a time.
    pub at_px: Vec<Option<[f64; 2]>>,
    /// Whether the place is filled in between two known ones.
    pub filled: Vec<bool>,
    /// Whether the place was found under the name of the other leg.
    pub swapped: Vec<bool>,
}

/// A clip made usable.
#[derive(Clone, Debug)]
pub struct CleanClip {
    /// 1 when x grows in the direction of travel, -1 otherwise.
    pub direction: f64,
    /// The trunk.
    pub trunk: Trunk,
    /// Speed of the trunk in each frame, px/frame, at least one.
    pub trunk_speed_px: Vec<f64>,
    /// Hooves in the order of [`Limb::ALL`].
    pub hooves: [HoofTrack; 4],
    /// What was wrong.
    pub faults: Faults,
}

impl CleanClip {
    /// Cleans a clip; none when withers or croup are hardly ever seen.
    pub fn new(clip: &Clip, frames_per_s: f64) -> Option<Self> {
        let mut faults = Faults::default();
        let [(withers_px, withers_kept), (croup_px, croup_kept)] =
            [smooth(clip.withers(), &mut faults)?, smooth(clip.croup(), &mut faults)?];
        let lost = withers_kept.iter().zip(&croup_kept).filter(|(a, b)| !**a && !**b).count();
        let missing = lost as f64 / clip.frames() as f64;
        let trunk = Trunk { withers_px, croup_px, missing };
        let speeds = trunk.speeds_px();
        let direction = if median(speeds.clone()).unwrap_or(0.0) < 0.0 { -1.0 } else { 1.0 };
        let trunk_speed_px: Vec<f64> = speeds.iter().map(|v| (direction * v).max(LEAST_SPEED_PX)).collect();
        let longest_gap = (LONGEST_FILLED_S * frames_per_s).round() as usize;
        let [fore, hind] = [Pair::Fore, Pair::Hind].map(|pair| {
            let labels = [Side::Left, Side::Right].map(|side| clip.hoof(Limb::new(pair, side)));
            let shown = PairTracks { labels, trunk_px: &trunk_speed_px, direction }.assign();
            count_faults(labels, &shown, &mut faults);
            [0, 1].map(|leg| hoof_track(labels, &shown, leg, longest_gap))
        });
        let ([left_fore, right_fore], [left_hind, right_hind]) = (fore, hind);
        let hooves = [left_fore, right_fore, left_hind, right_hind];
        Some(Self { direction, trunk, trunk_speed_px, hooves, faults })
    }
}

impl Trunk {
    /// Speed of the middle of the trunk in x in each frame, px/frame.
    fn speeds_px(&self) -> Vec<f64> {
        let middle: Vec<f64> =
            self.withers_px.iter().zip(&self.croup_px).map(|(w, c)| 0.5 * (w[0] + c[0])).collect();
        (0..middle.len())
            .map(|frame| {
                let near =
                    frame.saturating_sub(SPEED_NEIGHBOURS)..middle.len().min(frame + SPEED_NEIGHBOURS + 1);
                let points: Vec<[f64; 2]> = near.map(|i| [i as f64, middle[i]]).collect();
                slope(&points).unwrap_or(0.0)
            })
            .collect()
    }
}

/// A point of the trunk without jumps, and which frames were kept; none when hardly any was.
fn smooth(track: &[TrackedPoint], faults: &mut Faults) -> Option<(Vec<[f64; 2]>, Vec<bool>)> {
    let trusted: Vec<bool> = track.iter().map(|point| point.likelihood >= TRUSTED_LIKELIHOOD).collect();
    let kept: Vec<bool> =
        (0..track.len()).map(|frame| trusted[frame] && !is_jump(track, &trusted, frame)).collect();
    faults.drop_outs += trusted.iter().filter(|trusted| !**trusted).count();
    faults.jumps += trusted.iter().zip(&kept).filter(|(trusted, kept)| **trusted && !**kept).count();
    let known: Vec<(usize, [f64; 2])> =
        (0..track.len()).filter(|i| kept[*i]).map(|i| (i, track[i].at_px)).collect();
    let (first, last) = (known.first()?, known.last()?);
    let mut filled = vec![first.1; track.len()];
    for pair in known.windows(2) {
        for frame in pair[0].0..pair[1].0 {
            filled[frame] = between(pair[0], pair[1], frame);
        }
    }
    filled[last.0..].fill(last.1);
    Some((filled, kept))
}

/// Whether a point lies off the line through its neighbours.
fn is_jump(track: &[TrackedPoint], trusted: &[bool], frame: usize) -> bool {
    let near = frame.saturating_sub(NEIGHBOURS)..track.len().min(frame + NEIGHBOURS + 1);
    let near: Vec<usize> = near.filter(|&i| i != frame && trusted[i]).collect();
    // Only the way forward counts: up and down the outline of the trunk is a matter of taste to the tracker.
    let points: Vec<[f64; 2]> = near.iter().map(|&i| [i as f64 - frame as f64, track[i].at_px[0]]).collect();
    let Some(slope) = slope(&points) else { return false };
    let rests: Vec<f64> = points.iter().map(|[time, x]| x - slope * time).collect();
    let Some(expected) = median(rests.clone()) else { return false };
    let scatter = median(rests.iter().map(|rest| (rest - expected).abs()).collect()).unwrap_or(0.0);
    (track[frame].at_px[0] - expected).abs() > (JUMP * MAD_TO_SD * scatter).max(LEAST_JUMP_PX)
}

/// Place at a frame on the straight line between two known ones.
fn between(from: (usize, [f64; 2]), to: (usize, [f64; 2]), frame: usize) -> [f64; 2] {
    let share = (frame - from.0) as f64 / (to.0 - from.0) as f64;
    [0, 1].map(|axis| from.1[axis] + share * (to.1[axis] - from.1[axis]))
}

fn count_faults(labels: [&[TrackedPoint]; 2], shown: &[[Option<usize>; 2]], faults: &mut Faults) {
    let mut before = false;
    for (frame, shown) in shown.iter().enumerate() {
        for (label, track) in labels.iter().enumerate() {
            let trusted = track[frame].likelihood >= TRUSTED_LIKELIHOOD;
            faults.drop_outs += usize::from(!trusted);
            faults.jumps += usize::from(trusted && !shown.contains(&Some(label)));
        }
        let swapped = shown[0] == Some(1) || shown[1] == Some(0);
        faults.swapped_frames += usize::from(swapped);
        faults.swaps += usize::from(swapped && !before);
        // A frame that shows neither leg does not end a run.
        before = if *shown == [None, None] { before } else { swapped };
    }
}

/// A leg's own track, short gaps filled.
fn hoof_track(
    labels: [&[TrackedPoint]; 2],
    shown: &[[Option<usize>; 2]],
    leg: usize,
    longest_gap: usize,
) -> HoofTrack {
    let seen: Vec<Option<[f64; 2]>> =
        shown.iter().enumerate().map(|(i, s)| s[leg].map(|label| labels[label][i].at_px)).collect();
    let swapped = shown.iter().map(|shown| shown[leg] == Some(1 - leg)).collect();
    let mut track = HoofTrack { filled: vec![false; seen.len()], at_px: seen.clone(), swapped };
    let known: Vec<(usize, [f64; 2])> =
        seen.iter().enumerate().filter_map(|(i, at)| at.map(|at| (i, at))).collect();
    for pair in known.windows(2) {
        if pair[1].0 - pair[0].0 - 1 <= longest_gap {
            for frame in pair[0].0 + 1..pair[1].0 {
                track.at_px[frame] = Some(between(pair[0], pair[1], frame));
                track.filled[frame] = true;
            }
        }
    }
    track
}
