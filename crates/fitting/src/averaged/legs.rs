//! Every detection with its own leg: jumps dropped, left-right swaps mended.
//!
//! A tracker gives each leg a detection in every frame; where one leg hides the other, both detections sit on one leg, or
//! change places. What a leg does in all strides tells which it is. In symmetrical gaits the other leg does the same half a
//! stride later, which doubles what is known before anything is dropped.

use muybridge_capture::{BodyPoint, Keypoint, LimbJoint, NearOff, PlacedBy};
use muybridge_core::Gait;

use super::clip::Clip;
use super::harmonics::{Periodic, Sample};
use super::rectify::Picture;

/// Harmonics of the first guess, and of the second: hooves' heights need six.
const HARMONICS: [usize; 2] = [4, 6];
/// Least standard deviation of a point about its stride, withers heights: a placed point's own scatter.
const LEAST_SD: f64 = 0.006;
/// A point this far from where its stride says is none of this leg, withers heights: two thirds of a hoof.
const GATES: [f64; 2] = [0.1, 0.07];
/// The same for the head, as a multiple: no two nods are alike.
const HEAD_GATE: f64 = 2.0;

/// A point farther from its own leg's way than this, and less than half as far from the other's, is the other's, withers
/// heights: twice the spread between strides.
const CLEARLY: f64 = 0.025;

/// Two tracked points of a pair nearer to each other than this show one leg, and nobody knows which, withers heights: a third
/// of a hoof. Crossing hooves pass each other at twice the distance.
const ONE_LEG: f64 = 0.035;
/// Time before and after in which the tracker was already, or still, drawn from one leg to the other, strides.
const AROUND: f64 = 0.025;

/// A point in a frame, in withers heights forward of the trunk's middle and above the ground.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Seen {
    /// Strides since the first frame.
    pub(super) turns: f64,
    /// Place.
    pub(super) at: [f64; 2],
}

/// A keypoint through the clip.
#[derive(Clone, Debug)]
pub(super) struct Course {
    /// The keypoint.
    pub(super) keypoint: Keypoint,
    /// Its place by frame.
    pub(super) seen: Vec<Option<Seen>>,
    /// Frames in which it was there, but no place of this point.
    pub(super) jumps: usize,
    /// Frames in which it was under the name of the other leg.
    pub(super) swaps: usize,
}

/// What a point does in every stride.
#[derive(Clone, Debug)]
pub(super) struct Habit {
    axes: [Periodic; 2],
}

impl Habit {
    /// From the places where a point was seen; none where it was hardly ever.
    pub(super) fn new(seen: &[Seen], middle: f64) -> Option<Self> {
        Self::of_harmonics(HARMONICS[1], seen, middle)
    }

    fn of_harmonics(harmonics: usize, seen: &[Seen], middle: f64) -> Option<Self> {
        let axis = |axis: usize| {
            let samples: Vec<Sample> =
                seen.iter().map(|s| Sample { turns: s.turns, value: s.at[axis] }).collect();
            Periodic::robust(harmonics, middle, &samples, LEAST_SD)
        };
        Some(Self { axes: [axis(0)?, axis(1)?] })
    }

    /// Expected place.
    pub(super) fn at(&self, turns: f64) -> [f64; 2] {
        [self.axes[0].at(turns), self.axes[1].at(turns)]
    }

    /// What a slow change of the picture has added.
    pub(super) fn drift_at(&self, turns: f64) -> [f64; 2] {
        [self.axes[0].drift_at(turns), self.axes[1].drift_at(turns)]
    }

    /// The slow change of the place forward, a stride.
    pub(super) fn drift_forward(&self) -> f64 {
        self.axes[0].drift_per_turn()
    }

    fn distance(&self, seen: Seen) -> f64 {
        let [x, y] = self.at(seen.turns);
        (seen.at[0] - x).hypot(seen.at[1] - y)
    }
}

/// Every keypoint's course, mended.
pub(super) fn courses(clip: &Clip, picture: &Picture, gait: Gait) -> Vec<Course> {
    let mut courses: Vec<Course> = clip
        .tracks
        .iter()
        .map(|(landmark, track)| course(landmark.keypoint(picture.facing), track, picture))
        .collect();
    courses.sort_by_key(|course| course.keypoint);
    if clip.naming.placed_by == PlacedBy::Tracked {
        drop_doubles(&mut courses, picture.strides.period_frames);
    }
    let middle = picture.turns(picture.middle);
    for round in 0..GATES.len() {
        let habits: Vec<Option<Habit>> = (0..courses.len())
            .map(|i| {
                let own = known(&courses[i], 0.0);
                let other = other(&courses, i).filter(|_| round == 0 && is_symmetrical(gait));
                let mirrored = other.map_or(Vec::new(), |other| known(&courses[other], 0.5));
                Habit::of_harmonics(HARMONICS[round], &[own, mirrored].concat(), middle)
            })
            .collect();
        mend(&mut courses, &habits, GATES[round]);
    }
    courses
}

/// Whether the two legs of a pair do the same half a stride apart.
fn is_symmetrical(gait: Gait) -> bool {
    matches!(gait, Gait::Walk | Gait::Amble | Gait::Trot | Gait::Rack)
}

fn course(keypoint: Keypoint, track: &[Option<[f64; 2]>], picture: &Picture) -> Course {
    let place = |(frame, at_px): (usize, &Option<[f64; 2]>)| {
        let at = picture.place(frame, (*at_px)?)?;
        Some(Seen { turns: picture.turns(frame as f64), at })
    };
    Course { keypoint, seen: track.iter().enumerate().map(place).collect(), jumps: 0, swaps: 0 }
}

/// The places of a course, so many strides later.
fn known(course: &Course, later: f64) -> Vec<Seen> {
    course.seen.iter().flatten().map(|seen| Seen { turns: seen.turns + later, at: seen.at }).collect()
}

/// The same joint of the pair's other leg.
fn other(courses: &[Course], of: usize) -> Option<usize> {
    let Keypoint::Limb(side, pair, joint) = courses[of].keypoint else { return None };
    let side = if side == NearOff::Near { NearOff::Off } else { NearOff::Near };
    courses.iter().position(|course| course.keypoint == Keypoint::Limb(side, pair, joint))
}

/// Drops what a tracker saw where one leg hid the other: both names in one place, and what it saw just before and after.
fn drop_doubles(courses: &mut [Course], period_frames: f64) {
    let around = (AROUND * period_frames).round() as usize;
    // Knees and hocks of the two legs do pass each other so near.
    let is_low = |course: &Course| {
        matches!(course.keypoint, Keypoint::Limb(_, _, LimbJoint::Fetlock | LimbJoint::Hoof))
    };
    for i in 0..courses.len() {
        let Some(j) = other(courses, i).filter(|j| *j > i && is_low(&courses[i])) else { continue };
        let is_double = |frame: &usize| match (courses[i].seen[*frame], courses[j].seen[*frame]) {
            (Some(a), Some(b)) => (a.at[0] - b.at[0]).hypot(a.at[1] - b.at[1]) < ONE_LEG,
            _ => false,
        };
        let frames = courses[i].seen.len();
        let doubles: Vec<usize> = (0..frames).filter(is_double).collect();
        for frame in doubles.iter().flat_map(|f| f.saturating_sub(around)..(f + around + 1).min(frames)) {
            for course in [i, j] {
                courses[course].jumps += usize::from(courses[course].seen[frame].take().is_some());
            }
        }
    }
}

/// Gives each detection to the leg it fits, or drops it.
fn mend(courses: &mut [Course], habits: &[Option<Habit>], gate: f64) {
    let partners: Vec<Option<usize>> =
        (0..courses.len()).map(|i| other(courses, i).filter(|j| habits[*j].is_some())).collect();
    let is_head = |keypoint| matches!(keypoint, Keypoint::Body(BodyPoint::Muzzle | BodyPoint::Poll));
    let gates: Vec<f64> =
        courses.iter().map(|c| if is_head(c.keypoint) { HEAD_GATE * gate } else { gate }).collect();
    // Whether a place is one of this leg, and no better one of its partner.
    let fits = |i: usize, seen: Seen| {
        let Some(own) = habits[i].as_ref().map(|habit| habit.distance(seen)) else { return true };
        let others = partners[i].and_then(|j| habits[j].as_ref()).map(|habit| habit.distance(seen));
        own <= gates[i] && !(own > CLEARLY && others.is_some_and(|others| others < 0.5 * own))
    };
    for i in 0..courses.len() {
        for frame in 0..courses[i].seen.len() {
            let Some(seen) = courses[i].seen[frame].filter(|seen| !fits(i, *seen)) else { continue };
            courses[i].seen[frame] = None;
            courses[i].jumps += 1;
            // It may be the other leg's, which then has none of its own, or has this one's.
            let Some(j) = partners[i] else { continue };
            let held = courses[j].seen[frame];
            if !fits(j, seen) || held.is_some_and(|held| fits(j, held)) {
                continue;
            }
            courses[i].jumps -= 1;
            courses[j].seen[frame] = Some(seen);
            courses[j].swaps += 1;
            match held {
                Some(held) if fits(i, held) => {
                    courses[i].seen[frame] = Some(held);
                    courses[i].swaps += 1;
                }
                Some(_) => courses[j].jumps += 1,
                None => {}
            }
        }
    }
}
