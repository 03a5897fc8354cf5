//! When a hoof is on the ground: it stands still in the picture, because the camera does.
//!
//! The core of a stance is found by the hoof's speed; strike and lift-off by how far it is from where it rests. Where
//! that distance passes its limit is interpolated between frames in its square root, because a hoof comes to rest, and
//! leaves it, at about constant acceleration.

use super::robust::median;

/// A hoof stands still below this share of the trunk's speed. In swing it is three times as fast as the trunk.
const STILL: f64 = 0.3;
/// Shortest stance, s; a stance of the walk lasts two to four times as long.
const SHORTEST_CORE_S: f64 = 0.25;
/// A hoof is on the same print when it is within this many frames of the trunk's motion: a tenth of a stride. No hoof
/// comes back to its print, so whatever lies between is a disturbance.
const SAME_PRINT: f64 = 2.0;
/// Most frames between the two places that an instant is interpolated from: one may be missing.
const WIDEST_BRACKET: usize = 2;
/// Frames at either end of a core that say where the hoof rests there.
const REST_FRAMES: usize = 4;
/// Distance from its print, withers heights, at which a hoof comes down: 4 cm. In photographs of one of the clips
/// (a horse at 1.3 m/s) hooves at 0.07 or more have a shadow under them, those at 0.03 or less have none.
const STRIKE_DISTANCE: f64 = 0.025;
/// Distance from its print, withers heights, at which the toe leaves the ground: 14 cm. The tracked point is above
/// the sole; while the hoof rolls over its toe until it points down, the point moves forward and up. In the same
/// photographs the toe is in the sand at 0.08, at its surface at 0.09 and 0.12, and off it at 0.17. With half the
/// distance, where the heel is up, stances would be 4 % shorter and their laws' exponents the same.
const LIFT_OFF_DISTANCE: f64 = 0.09;

/// The instant at which a stance begins or ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Edge {
    /// At this frame, fractional, from 0.
    At(f64),
    /// Before the hoof is first seen in the clip, or after it is last seen.
    Cut,
    /// While the hoof was not seen, or not where it could have been.
    Unseen,
}

impl Edge {
    /// The frame, where it is known.
    pub fn frame(self) -> Option<f64> {
        match self {
            Self::At(frame) => Some(frame),
            Self::Cut | Self::Unseen => None,
        }
    }
}

/// A stance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stance {
    /// The hoof comes down.
    pub strike: Edge,
    /// The toe leaves the ground.
    pub lift_off: Edge,
    /// First and last frame in which the hoof stands still.
    pub core: [usize; 2],
    /// Where it rests: along the track and above the ground, withers heights.
    pub rest: [f64; 2],
}

/// First and last frames in which a hoof stands still. Places along the track and the trunk's advance per frame may be
/// in any one unit.
pub(super) fn cores(along: &[Option<f64>], trunk_advance: &[f64], frames_per_s: f64) -> Vec<[usize; 2]> {
    let shortest = (SHORTEST_CORE_S * frames_per_s).ceil() as usize;
    let mut cores: Vec<[usize; 2]> = Vec::new();
    for frame in 1..along.len() {
        let (Some(from), Some(to)) = (along[frame - 1], along[frame]) else { continue };
        let advance = trunk_advance[frame];
        if (to - from).abs() >= STILL * advance {
            continue;
        }
        let joins =
            |core: &[usize; 2]| along[core[1]].is_some_and(|end| (from - end).abs() < SAME_PRINT * advance);
        match cores.last_mut() {
            Some(core) if joins(core) => core[1] = frame,
            _ => cores.push([frame - 1, frame]),
        }
    }
    cores.retain(|[first, last]| last - first + 1 >= shortest);
    cores
}

/// A hoof in every frame.
pub(super) struct HoofPath<'c> {
    /// Along the track and above the ground, withers heights; none where it is unknown.
    pub(super) places: &'c [Option<[f64; 2]>],
    /// Whether a place is only filled in.
    pub(super) filled: &'c [bool],
}

impl HoofPath<'_> {
    /// The stances of the hoof, in order.
    pub(super) fn stances(&self, trunk_advance: &[f64], frames_per_s: f64) -> Vec<Stance> {
        let along: Vec<Option<f64>> = self.places.iter().map(|place| place.map(|[along, _]| along)).collect();
        let cores = cores(&along, trunk_advance, frames_per_s);
        let stance = |core: &[usize; 2]| {
            let [first, last] = *core;
            // The outermost frames may belong to landing or breaking over already.
            let early = self.rest(first + 1..last.min(first + 1 + REST_FRAMES))?;
            let late = self.rest(first.max(last.saturating_sub(REST_FRAMES))..last)?;
            Some(Stance {
                strike: self.edge(first + 1, false, early, STRIKE_DISTANCE),
                lift_off: self.edge(last - 1, true, late, LIFT_OFF_DISTANCE),
                core: *core,
                rest: self.rest(first..last + 1)?,
            })
        };
        cores.iter().filter_map(stance).collect()
    }

    /// Median place in some frames.
    fn rest(&self, frames: std::ops::Range<usize>) -> Option<[f64; 2]> {
        let places: Vec<[f64; 2]> = self.places[frames].iter().flatten().copied().collect();
        let axis = |axis: usize| median(places.iter().map(|place| place[axis]).collect());
        Some([axis(0)?, axis(1)?])
    }

    /// The instant at which the distance from the rest passes the limit, looking outward from a frame in the core.
    fn edge(&self, from: usize, later: bool, rest: [f64; 2], limit: f64) -> Edge {
        // Distances in the frames in which the hoof was seen, outward.
        let outward: Box<dyn Iterator<Item = usize>> =
            if later { Box::new(from..self.places.len()) } else { Box::new((0..=from).rev()) };
        let seen: Vec<(usize, f64, bool)> = outward
            .filter(|frame| !self.filled[*frame])
            .filter_map(|frame| {
                let [along, above] = self.places[frame]?;
                let outside = (along > rest[0]) == later;
                Some((frame, (along - rest[0]).hypot(above - rest[1]), outside))
            })
            .collect();
        // One frame alone outside is a bad detection, and at the clip's end it may be one.
        let Some(three) = seen.windows(3).find(|three| three[1].1 > limit && three[2].1 > limit) else {
            return Edge::Cut;
        };
        let [(inner, near, _), (outer, far, outside), _] = [three[0], three[1], three[2]];
        if inner.abs_diff(outer) > WIDEST_BRACKET || !outside {
            return Edge::Unseen;
        }
        let [near, far, limit] = [near, far, limit].map(f64::sqrt);
        let share = ((limit - near) / (far - near)).clamp(0.0, 1.0);
        Edge::At(inner as f64 + share * (outer as f64 - inner as f64))
    }
}
