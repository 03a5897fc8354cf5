//! Which of a pair's two detections is which leg: left-right swaps, false detections, drop-outs.
//!
//! The tracker gives every leg a detection in every frame. Some belong to the other leg of the pair, some to no leg at
//! all. Both legs are followed at once: the least expensive story counts, in which legs move like legs (forward, at the
//! speeds and accelerations of a walk), labels are rarely exchanged, and few detections are thrown away. A beam search
//! keeps the best beginnings of a story from frame to frame.

use std::collections::BTreeMap;

use super::clip::TrackedPoint;

/// Price of a leg that is not seen in a frame; the other prices are measured against it.
const MISSING: f64 = 1.5;
/// Price of labels changing legs, or changing back: two changes cost less than two frames without both legs.
const EXCHANGE: f64 = 1.0;
/// Price of a frame with exchanged labels, so that of two equal stories the one that believes the labels wins.
const EXCHANGED: f64 = 0.05;
/// Likelihood below which a detection is no place at all, only the least bad one of the picture.
const LEAST_LIKELIHOOD: f64 = 0.1;
/// Likelihood from which `DeepLabCut` itself draws a prediction (`pcutoff` of its configuration).
pub(super) const TRUSTED_LIKELIHOOD: f64 = 0.6;
/// Price of a detection for each unit of likelihood below the trusted one.
const DOUBT: f64 = 0.8;
/// Speeds of a hoof in trunk speeds. The mean over a swing is 1 / (1 - duty factor), about 3; its peak half as much
/// again; a hoof nearer to the camera than the trunk looks faster.
const SPEEDS: [f64; 2] = [-0.25, 5.5];
/// Price of each trunk speed outside of these, for each of at most [`LONGEST_OFFENCE`] frames.
const OFFENCE: f64 = 3.0;
const LONGEST_OFFENCE: f64 = 3.0;
/// Price of a squared acceleration in trunk speeds per frame: legs reach 2, wrong exchanges 4 and more.
const ACCELERATION: f64 = 0.13;
/// Acceleration from which the price only grows in proportion.
const HUBER: f64 = 5.0;
/// Longest gap over which an acceleration says something, frames.
const LONGEST_GAP: usize = 8;
/// Stories kept from frame to frame; with twice as many none of our clips changes.
const BEAM: usize = 80;

/// The detection (0 the left one's, 1 the right one's) that shows the left and the right leg in a frame.
pub(super) type Shown = [Option<usize>; 2];

/// All that a frame can show.
const CHOICES: [Shown; 7] = [
    [Some(0), Some(1)],
    [Some(1), Some(0)],
    [Some(0), None],
    [None, Some(1)],
    [Some(1), None],
    [None, Some(0)],
    [None, None],
];

/// A detection by its frame and label.
type Seen = (usize, usize);

/// What decides how a story goes on: each leg's last and last but one detections, and whether labels are exchanged.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
struct State {
    last: [Option<Seen>; 2],
    before: [Option<Seen>; 2],
    exchanged: bool,
}

/// The beginning of a story: its state, its price, and its last step among all steps.
#[derive(Clone, Copy, Debug)]
struct Story {
    state: State,
    price: f64,
    step: Option<usize>,
}

/// The two detections of a pair, and what speeds are measured by.
pub(super) struct PairTracks<'c> {
    /// Detections named left and right, one a frame.
    pub(super) labels: [&'c [TrackedPoint]; 2],
    /// Speed of the trunk in each frame, px/frame, positive.
    pub(super) trunk_px: &'c [f64],
    /// 1 when x grows in the direction of travel, -1 otherwise.
    pub(super) direction: f64,
}

impl PairTracks<'_> {
    /// What each frame shows.
    pub(super) fn assign(&self) -> Vec<Shown> {
        // Steps of all stories: what the frame shows, and the step before.
        let mut steps: Vec<(Shown, Option<usize>)> = Vec::new();
        let mut stories = vec![Story { state: State::default(), price: 0.0, step: None }];
        for frame in 0..self.trunk_px.len() {
            // Of stories that will go on alike only the least expensive one is of use.
            let mut next: BTreeMap<State, (f64, Shown, Option<usize>)> = BTreeMap::new();
            for story in &stories {
                for shown in CHOICES {
                    let Some((state, price)) = self.step(story.state, frame, shown) else { continue };
                    let price = story.price + price;
                    if next.get(&state).is_none_or(|known| price < known.0) {
                        next.insert(state, (price, shown, story.step));
                    }
                }
            }
            let mut next: Vec<_> = next.into_iter().collect();
            next.sort_by(|a, b| a.1.0.total_cmp(&b.1.0));
            next.truncate(BEAM);
            stories = next
                .into_iter()
                .map(|(state, (price, shown, before))| {
                    steps.push((shown, before));
                    Story { state, price, step: Some(steps.len() - 1) }
                })
                .collect();
        }
        let mut told = Vec::with_capacity(self.trunk_px.len());
        let mut step = stories.first().and_then(|story| story.step);
        while let Some((shown, before)) = step.map(|index| steps[index]) {
            told.push(shown);
            step = before;
        }
        told.reverse();
        told
    }

    /// The state after a frame and the frame's price; none where a detection is no place at all.
    fn step(&self, mut state: State, frame: usize, shown: Shown) -> Option<(State, f64)> {
        let mut price = 0.0;
        let mut exchanged = state.exchanged;
        for leg in [0, 1] {
            let Some(label) = shown[leg] else {
                price += MISSING;
                continue;
            };
            let likelihood = self.labels[label][frame].likelihood;
            if likelihood < LEAST_LIKELIHOOD {
                return None;
            }
            exchanged = label != leg;
            price += DOUBT * (TRUSTED_LIKELIHOOD - likelihood).max(0.0);
            price += if exchanged { EXCHANGED } else { 0.0 };
            if let Some(last) = state.last[leg] {
                price += self.movement(state.before[leg], last, (frame, label));
            }
            state.before[leg] = state.last[leg];
            state.last[leg] = Some((frame, label));
        }
        if exchanged != state.exchanged {
            price += EXCHANGE;
        }
        state.exchanged = exchanged;
        Some((state, price))
    }

    /// Price of a leg's movement from its last place to a new one.
    fn movement(&self, before: Option<Seen>, last: Seen, now: Seen) -> f64 {
        let frames = (now.0 - last.0) as f64;
        let speed = self.speed(last, now);
        let offence = (SPEEDS[0] - speed[0]).max(speed[0] - SPEEDS[1]).max(0.0);
        let mut price = OFFENCE * offence * frames.min(LONGEST_OFFENCE);
        if let Some(before) = before.filter(|_| now.0 - last.0 <= LONGEST_GAP) {
            let earlier = self.speed(before, last);
            let time = 0.5 * (now.0 - before.0) as f64;
            let acceleration = (speed[0] - earlier[0]).hypot(speed[1] - earlier[1]) / time;
            price += ACCELERATION
                * if acceleration < HUBER {
                    acceleration * acceleration
                } else {
                    HUBER * (2.0 * acceleration - HUBER)
                };
        }
        price
    }

    /// Mean speed between two detections, forward and down, in trunk speeds.
    fn speed(&self, from: Seen, to: Seen) -> [f64; 2] {
        let [a, b] = [from, to].map(|(frame, label)| self.labels[label][frame].at_px);
        let trunk_px = self.trunk_px[(from.0 + to.0) / 2] * (to.0 - from.0) as f64;
        [self.direction * (b[0] - a[0]) / trunk_px, (b[1] - a[1]) / trunk_px]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(xs: &[f64]) -> Vec<TrackedPoint> {
        xs.iter().map(|&x| TrackedPoint { at_px: [x, 0.0], likelihood: 0.9 }).collect()
    }

    #[test]
    fn an_exchange_is_found_and_a_false_detection_dropped() {
        let mut left = points(&[100.0; 12]);
        let mut right =
            points(&[10.0, 40.0, 70.0, 100.0, 130.0, 160.0, 190.0, 210.0, 215.0, 215.0, 215.0, 215.0]);
        for frame in 6..9 {
            std::mem::swap(&mut left[frame], &mut right[frame]);
        }
        left[10].at_px[0] = 700.0;
        let trunk_px = [10.0; 12];
        let tracks = PairTracks { labels: [&left, &right], trunk_px: &trunk_px, direction: 1.0 };
        let told = tracks.assign();
        for (frame, shown) in told.iter().enumerate() {
            let expected = match frame {
                6..=8 => [Some(1), Some(0)],
                10 => [None, Some(1)],
                _ => [Some(0), Some(1)],
            };
            assert_eq!(*shown, expected, "frame {frame}");
        }
    }
}
