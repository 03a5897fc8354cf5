//! Changes of a track: what dragging, typing and commands do to its prints. All results are within what a track file may hold.

use std::collections::BTreeSet;

use muybridge_footprints::{Foot, PathPoint, Print, StepTiming, Track};

/// Farthest a print or a point of the path is from the origin, metres.
pub const FARTHEST_M: f64 = 10_000.0;
/// Longest time of a print, s.
pub const LONGEST_S: f64 = 600.0;
/// Shortest stance that a drag leaves, s: a shorter one is no footfall that a person would see.
pub const SHORTEST_STANCE_S: f64 = 0.02;
/// Step length of a track whose prints do not tell one, metres.
const STEP_M: f64 = 0.4;
/// Half the distance between the lines of left and right prints of such a track, metres.
const HALF_WIDTH_M: f64 = 0.1;

/// A number within the bounds of a track; what is no number stays what it was.
fn bounded(value: f64, was: f64, [least, most]: [f64; 2]) -> f64 {
    if value.is_finite() { value.clamp(least, most) } else { was }
}

fn place(at_m: [f64; 2], was_m: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|i| bounded(at_m[i], was_m[i], [-FARTHEST_M, FARTHEST_M]))
}

/// A place moved by a way, within the bounds of a track; what is no number stays.
pub fn moved_place(at_m: [f64; 2], by_m: [f64; 2]) -> [f64; 2] {
    place([at_m[0] + by_m[0], at_m[1] + by_m[1]], at_m)
}

/// An angle between -180 and 180 degrees.
pub fn wrapped_deg(angle_deg: f64) -> f64 {
    180.0 - (180.0 - angle_deg).rem_euclid(360.0)
}

/// Direction of a heading in the plan (x, z).
pub fn direction(heading_deg: f64) -> [f64; 2] {
    let (sin, cos) = heading_deg.to_radians().sin_cos();
    [cos, -sin]
}

/// Heading of a direction in the plan, degrees; zero for none.
pub fn heading_deg([x, z]: [f64; 2]) -> f64 {
    if x == 0.0 && z == 0.0 { 0.0 } else { (-z).atan2(x).to_degrees() }
}

/// Puts a print at a place.
pub fn put(track: &mut Track, print: usize, at_m: [f64; 2]) {
    if let Some(print) = track.prints.get_mut(print) {
        print.at_m = place(at_m, print.at_m);
    }
}

/// Moves prints together.
pub fn move_by(track: &mut Track, prints: &BTreeSet<usize>, by_m: [f64; 2]) {
    for (_, print) in track.prints.iter_mut().enumerate().filter(|(i, _)| prints.contains(i)) {
        print.at_m = moved_place(print.at_m, by_m);
    }
}

/// Turns a print's toes, and those of other prints by as much.
pub fn turn_to(track: &mut Track, print: usize, others: &BTreeSet<usize>, heading_deg: f64) {
    let Some(was) = track.prints.get(print).map(|print| print.heading_deg) else { return };
    if !heading_deg.is_finite() {
        return;
    }
    let turned = |i: &usize| *i == print || others.contains(i);
    for (_, print) in track.prints.iter_mut().enumerate().filter(|(i, _)| turned(i)) {
        print.heading_deg = wrapped_deg(print.heading_deg + heading_deg - was);
    }
}

/// Says how long a foot stands.
pub fn set_stance(track: &mut Track, print: usize, was: StepTiming, stance_time_s: f64) {
    let stance_time_s = bounded(stance_time_s, was.stance_time_s, [SHORTEST_STANCE_S, LONGEST_S]);
    if let Some(print) = track.prints.get_mut(print) {
        print.timing = Some(StepTiming { stance_time_s, ..was });
    }
}

/// Says when the next foot falls.
pub fn set_step(track: &mut Track, print: usize, was: StepTiming, step_time_s: f64) {
    let step_time_s = bounded(step_time_s, was.step_time_s, [0.0, LONGEST_S]);
    if let Some(print) = track.prints.get_mut(print) {
        print.timing = Some(StepTiming { step_time_s, ..was });
    }
}

/// Moves a footfall in time and leaves all others where they are; the foot leaves the ground as much later, or when it did.
/// `was` are the times of the print before and of this one.
pub fn shift_footfall(
    track: &mut Track,
    print: usize,
    was: [StepTiming; 2],
    by_s: f64,
    lift_off_stays: bool,
) {
    if print == 0 || print >= track.prints.len() || !by_s.is_finite() {
        return;
    }
    let most_s = if lift_off_stays {
        was[1].step_time_s.min((was[1].stance_time_s - SHORTEST_STANCE_S).max(0.0))
    } else {
        was[1].step_time_s
    };
    let by_s = by_s.clamp(-was[0].step_time_s, most_s);
    set_step(track, print - 1, was[0], was[0].step_time_s + by_s);
    let stance_time_s = was[1].stance_time_s - if lift_off_stays { by_s } else { 0.0 };
    set_step(track, print, StepTiming { stance_time_s, ..was[1] }, was[1].step_time_s - by_s);
}

/// Takes prints away; the time to the next footfall goes with them.
pub fn delete(track: &mut Track, prints: &BTreeSet<usize>) {
    let mut at = 0;
    track.prints.retain(|_| {
        at += 1;
        !prints.contains(&(at - 1))
    });
}

/// The foot that falls after the last print.
fn next_foot(track: &Track) -> Foot {
    let prints = &track.prints;
    match prints.last().map(|last| last.foot) {
        None if track.model == "horse" => Foot::LeftHind,
        None | Some(Foot::Right) => Foot::Left,
        Some(Foot::Left) => Foot::Right,
        // Four feet go on in the order in which they fell.
        Some(_) if prints.len() >= 4 => prints[prints.len() - 4].foot,
        Some(Foot::LeftHind) => Foot::LeftFore,
        Some(Foot::LeftFore) => Foot::RightHind,
        Some(Foot::RightHind) => Foot::RightFore,
        Some(Foot::RightFore) => Foot::LeftHind,
    }
}

/// The print that goes on from the last ones, for the foot whose turn it is.
pub fn next_print(track: &Track) -> Print {
    let (prints, foot) = (&track.prints, next_foot(track));
    let count = prints.len();
    let Some(last) = prints.last() else {
        return Print { foot, at_m: [0.0, -HALF_WIDTH_M], heading_deg: 0.0, timing: None };
    };
    // The way from the print of the last foot before this one to the last one.
    let way_m = prints[..count - 1]
        .iter()
        .rev()
        .find(|print| print.foot == last.foot)
        .map(|before| [last.at_m[0] - before.at_m[0], last.at_m[1] - before.at_m[1]]);
    let same = prints.iter().rev().find(|print| print.foot == foot);
    let [ahead_x, ahead_z] = direction(last.heading_deg);
    let at_m = match (same, way_m) {
        (Some(same), Some(way_m)) => [same.at_m[0] + way_m[0], same.at_m[1] + way_m[1]],
        (Some(same), None) => [same.at_m[0] + 2.0 * STEP_M * ahead_x, same.at_m[1] + 2.0 * STEP_M * ahead_z],
        (None, _) => {
            let aside = 2.0 * HALF_WIDTH_M * if is_left(foot) { 1.0 } else { -1.0 };
            let at = [STEP_M * ahead_x + aside * ahead_z, STEP_M * ahead_z - aside * ahead_x];
            [last.at_m[0] + at[0], last.at_m[1] + at[1]]
        }
    };
    Print { foot, at_m: place(at_m, last.at_m), heading_deg: last.heading_deg, timing: last.timing }
}

/// The next print, put at a place of the plan and turned the way there.
pub fn next_print_at(track: &Track, at_m: [f64; 2]) -> Print {
    let print = next_print(track);
    Print { at_m: place(at_m, print.at_m), ..print }
}

/// Whether a foot is on the left.
pub fn is_left(foot: Foot) -> bool {
    matches!(foot, Foot::Left | Foot::LeftFore | Foot::LeftHind)
}

/// A path through the middle between successive prints.
pub fn path_of_prints(track: &Track) -> Vec<PathPoint> {
    let pairs = track.prints.windows(2).step_by(2);
    let middle = |pair: &[Print]| [0, 1].map(|i| (pair[0].at_m[i] + pair[1].at_m[i]) / 2.0);
    let mut points: Vec<PathPoint> =
        pairs.map(|pair| PathPoint { at_m: middle(pair), tangent_m: None }).collect();
    points.dedup_by(|b, a| (b.at_m[0] - a.at_m[0]).hypot(b.at_m[1] - a.at_m[1]) < STEP_M / 4.0);
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track() -> Track {
        let mut track = Track::new("bird");
        for i in 0..5 {
            let print = Print { heading_deg: 170.0, ..next_print(&track) };
            let timing = StepTiming { stance_time_s: 0.4, step_time_s: 0.3 };
            track.prints.push(Print { timing: (i % 2 == 0).then_some(timing), ..print });
        }
        track
    }

    #[test]
    fn prints_go_on_with_the_other_foot_in_the_same_stride() {
        let mut track = track();
        track.prints.iter_mut().for_each(|print| print.heading_deg = 0.0);
        assert_eq!(track.prints.iter().map(|p| p.foot.abbreviation()).collect::<String>(), "LRLRL");
        let next = next_print(&track);
        assert_eq!(next.foot, Foot::Right);
        let (before, stride) = (track.prints[3], track.prints[4].at_m[0] - track.prints[2].at_m[0]);
        assert!((next.at_m[0] - before.at_m[0] - stride).abs() < 1e-12);
    }

    #[test]
    fn a_heading_goes_round_and_takes_the_selected_with_it() {
        let mut track = track();
        turn_to(&mut track, 1, &BTreeSet::from([1, 3]), 190.0);
        let headings: Vec<f64> = track.prints.iter().map(|print| print.heading_deg).collect();
        assert_eq!(headings, [170.0, -170.0, 170.0, -170.0, 170.0]);
        assert_eq!((wrapped_deg(180.0), wrapped_deg(-180.0), wrapped_deg(540.0)), (180.0, 180.0, 180.0));
        assert!((heading_deg(direction(33.0)) - 33.0).abs() < 1e-9);
    }

    #[test]
    fn a_footfall_moves_between_its_neighbours_only() {
        let was = [StepTiming { stance_time_s: 0.4, step_time_s: 0.3 }; 2];
        for (by_s, steps, stance) in
            [(0.1, [0.4, 0.2], 0.3), (-0.1, [0.2, 0.4], 0.5), (-9.0, [0.0, 0.6], 0.7), (9.0, [0.6, 0.0], 0.1)]
        {
            let mut track = track();
            shift_footfall(&mut track, 2, was, by_s, true);
            let [a, b] = [1, 2].map(|i| track.prints[i].timing.unwrap());
            assert!((a.step_time_s - steps[0]).abs() < 1e-12 && (b.step_time_s - steps[1]).abs() < 1e-12);
            assert!((b.stance_time_s - stance).abs() < 1e-12 && a.stance_time_s == 0.4);
        }
    }

    #[test]
    fn what_is_no_number_changes_nothing() {
        let before = track();
        let was = StepTiming { stance_time_s: 0.4, step_time_s: 0.3 };
        let mut track = before.clone();
        put(&mut track, 0, [f64::NAN, f64::INFINITY]);
        put(&mut track, 99, [0.0; 2]);
        turn_to(&mut track, 0, &BTreeSet::new(), f64::NAN);
        move_by(&mut track, &BTreeSet::from([1]), [f64::NAN; 2]);
        set_stance(&mut track, 2, was, f64::NAN);
        set_step(&mut track, 2, was, f64::NAN);
        shift_footfall(&mut track, 2, [was; 2], f64::NAN, false);
        assert_eq!(track, before);
        delete(&mut track, &(0..5).collect());
        assert!(track.prints.is_empty());
        assert!(path_of_prints(&track).is_empty());
    }
}
