//! A body that heads where its feet do, sways with its steps and never jumps.

use std::f64::consts::{PI, TAU};

use glam::DVec3;

use super::*;
use crate::track::Foot;

const STILL: Sway = Sway { amplitude_deg: 0.0, greatest_at: 0.0 };
const PITCH: Sway = Sway { amplitude_deg: 4.0, greatest_at: 0.2 };
const ROLL: Sway = Sway { amplitude_deg: 6.0, greatest_at: 0.75 };

fn print(foot: Foot, heading_rad: f64, strike_s: f64, lift_off_s: f64) -> PlacedPrint {
    let world_from_foot = DQuat::from_rotation_y(heading_rad);
    PlacedPrint { foot, middle: DVec3::ZERO, world_from_foot, strike_s, lift_off_s }
}

/// A walk of half-second steps that turns by so much at each.
fn walk(steps: usize, turn_rad: f64) -> Vec<PlacedPrint> {
    let step = |i: usize| {
        let strike_s = 0.5 * i as f64;
        print(Foot::BIPED[i % 2], turn_rad * i as f64, strike_s, strike_s + 0.62)
    };
    (0..steps).map(step).collect()
}

/// Angle between two orientations, radians.
fn angle(a: DQuat, b: DQuat) -> f64 {
    a.angle_between(b)
}

#[test]
fn a_body_heads_where_its_feet_do_and_turns_with_them() {
    let straight = Orientation::plan(&walk(8, 0.0), 4.0, 1.0, STILL, STILL);
    assert!(straight.world_from_body.iter().all(|turn| angle(*turn, DQuat::IDENTITY) < 1e-9));
    let turning = Orientation::plan(&walk(13, 0.2), 6.5, 1.0, STILL, STILL);
    let heading = heading_rad(turning.at(3.0));
    assert!((heading - 1.2).abs() < 0.15, "{heading}");
    assert!((turning.at(3.0) * DVec3::Y).distance(DVec3::Y) < 1e-9);
}

#[test]
fn a_heading_goes_on_counting_beyond_half_a_turn_and_never_jumps() {
    for turn_rad in [0.5, -0.5] {
        let prints = walk(40, turn_rad);
        let headings = Headings::of(&prints, 20.0, 1.0);
        let most = headings.radians.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert!(most < 3.0 * turn_rad.abs() * 2.0 / 60.0, "{most}");
        let all = headings.radians.last().unwrap() - headings.radians[0];
        assert!((all - 38.5 * turn_rad).abs() < 0.6 && all.abs() > 2.0 * TAU);
    }
}

#[test]
fn the_moving_mean_spreads_a_turn_over_the_window() {
    let prints = [print(Foot::Left, 0.0, 0.0, 2.0), print(Foot::Left, 1.0, 2.0, 4.0)];
    for window_s in [0.5, 1.0] {
        let headings = Headings::of(&prints, 4.0, window_s);
        let at = |time_s: f64| headings.radians[(time_s * 60.0).round() as usize];
        assert!(at(2.0 - window_s / 2.0 - 0.05).abs() < 1e-9);
        assert!((at(2.0) - 0.5).abs() < 0.02 && (at(2.0 + window_s / 2.0 + 0.05) - 1.0).abs() < 1e-9);
    }
    assert_eq!(Headings::of(&prints, 4.0, 0.0).radians[119], 0.0);
}

#[test]
fn four_feet_are_averaged_as_two_are() {
    let prints: Vec<_> = Foot::QUADRUPED.iter().map(|&foot| print(foot, 0.3, 0.0, 1.0)).collect();
    let headings = Headings::of(&prints, 1.0, 0.5);
    assert!(headings.radians.iter().all(|heading| (heading - 0.3).abs() < 1e-9));
}

#[test]
fn pitch_has_two_periods_a_stride_and_roll_one() {
    let planned = Orientation::plan(&walk(20, 0.0), 10.0, 1.0, PITCH, ROLL);
    let [pitch, roll] = [(PITCH, DVec3::X, 1.0), (ROLL, DVec3::Z, -1.0)].map(|(sway, axis, sign)| {
        let at = |time_s: f64| sign * (planned.at(time_s) * axis).y.asin().to_degrees() / sway.amplitude_deg;
        [4.0, 4.1, 4.2, 4.35, 4.5, 4.75, 5.0].map(at)
    });
    // Left strikes at 4.0 and 5.0 s, the right foot at 4.5 s.
    let wanted =
        |share: f64, greatest_at: f64, per_stride: f64| (per_stride * TAU * (share - greatest_at)).cos();
    for (i, share) in [0.0, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0].into_iter().enumerate() {
        assert!((pitch[i] - wanted(share, PITCH.greatest_at, 2.0)).abs() < 0.02, "{share}: {pitch:?}");
        assert!((roll[i] - wanted(share, ROLL.greatest_at, 1.0)).abs() < 0.02, "{share}: {roll:?}");
    }
}

#[test]
fn a_figure_that_stands_does_not_sway_and_nothing_jumps() {
    let mut hops = walk(6, 0.0);
    hops.extend([3.0, 3.4, 3.8].map(|at_s| print(Foot::Right, 0.0, at_s, at_s + 0.2)));
    hops.extend([4.3, 4.8].iter().flat_map(|&at_s| Foot::BIPED.map(|f| print(f, 0.0, at_s, at_s + 0.3))));
    hops.push(print(Foot::Left, 0.0, 12.0, 20.0));
    let planned = Orientation::plan(&hops, 20.0, 1.0, PITCH, ROLL);
    for time_s in [0.0, 5.5, 8.0, 11.0, 15.0] {
        assert!(angle(planned.at(time_s), DQuat::IDENTITY) < 1e-9, "{time_s}");
    }
    // Sways of 4 and 6 degrees within 0.4 and 0.8 s: at most some 100 degrees a second.
    let all: Vec<DQuat> = (0..4800).map(|i| planned.at(i as f64 / 240.0)).collect();
    let most = all.windows(2).map(|pair| angle(pair[0], pair[1]).to_degrees()).fold(0.0, f64::max);
    assert!(most < 150.0 / 240.0, "{most}");
    let swaying = all[1000..1100].iter().map(|turn| angle(*turn, DQuat::IDENTITY).to_degrees());
    assert!(swaying.fold(0.0, f64::max) > 1.0);
}

#[test]
fn tables_are_bounded_and_take_what_comes() {
    let prints: Vec<_> =
        (0..10_000).map(|i| print(Foot::BIPED[i % 2], 0.1, 600.0 * i as f64, 600.0 * i as f64)).collect();
    let planned = Orientation::plan(&prints, 6e6, 1.0, PITCH, ROLL);
    assert!(planned.world_from_body.len() < 400_000);
    let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -1.0, 0.0, 1e300];
    for a in odd {
        for b in odd {
            let sway = Sway { amplitude_deg: a, greatest_at: b };
            let prints =
                [print(Foot::Left, a, b, a), print(Foot::Right, PI, a, b), print(Foot::LeftHind, b, a, a)];
            Orientation::plan(&prints, a, b, sway, sway).at(b);
            Orientation::plan(&prints, 1.0, b, sway, sway).at(a);
            Orientation { from_s: a, step_s: b, world_from_body: vec![DQuat::IDENTITY; 3] }.at(1.0);
        }
    }
    assert_eq!(Orientation::plan(&[], 1.0, 1.0, PITCH, ROLL).at(0.5), DQuat::IDENTITY);
}
