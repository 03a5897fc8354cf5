//! Feet on their prints, legs that reach them, and nothing that jumps.

use super::*;
use crate::knots::Knot;

const NAMES: [&str; 3] = ["bird", "dinosaur", "human"];
const DT_S: f64 = 1.0 / 240.0;

/// A model with prints and a curve made by hand.
struct Walk {
    model: Model,
    placed: Placed,
    orientation: Orientation,
    trajectory: Trajectory,
}

impl Walk {
    /// Prints (side, middle, heading, footfall, lift-off), a curve between their middles at a comfortable height.
    fn of(name: &str, prints: &[(usize, DVec3, f64, f64, f64)]) -> Self {
        let model = Model::named(name).unwrap();
        let print =
            |&(side, middle, heading, strike_s, lift_off_s): &(usize, DVec3, f64, f64, f64)| PlacedPrint {
                foot: Foot::BIPED[side],
                middle,
                world_from_foot: DQuat::from_rotation_y(heading),
                strike_s,
                lift_off_s,
            };
        let prints: Vec<_> = prints.iter().map(print).collect();
        let end_s = prints.iter().map(|print| print.lift_off_s).fold(0.0, f64::max);
        let placed = Placed { prints, end_s };
        let orientation =
            Orientation::plan(&placed.prints, end_s, model.body_window_s, model.pitch, model.roll);
        let trajectory = curve(&model, &placed);
        Self { model, placed, orientation, trajectory }
    }

    /// Steps of its model's own length and width along X, up by so much each, with so much of a stride on the ground.
    fn straight(name: &str, steps: usize, up_m: f64, step_s: f64, duty: f64) -> Self {
        let [length_m, width_m] = Model::named(name).unwrap().step_m;
        let step = |i: usize| {
            let z_m = if i.is_multiple_of(2) { -width_m / 2.0 } else { width_m / 2.0 };
            let from_s = i as f64 * step_s;
            let to_s = if i + 1 == steps { from_s + 1.0 } else { from_s + 2.0 * duty * step_s };
            (i % 2, DVec3::new(i as f64 * length_m, i as f64 * up_m, z_m), 0.0, from_s, to_s)
        };
        Self::of(name, &(0..steps).map(step).collect::<Vec<_>>())
    }

    fn biped(&self) -> Biped<'_> {
        let Self { model, placed, orientation, trajectory } = self;
        Biped { model, placed, orientation, trajectory }
    }

    fn poses(&self) -> Vec<BipedPose> {
        let last = ((self.placed.end_s + 0.5) / DT_S) as usize;
        (0..last).map(|i| self.biped().pose(i as f64 * DT_S - 0.2)).collect()
    }
}

/// A curve through points between each print and the one before it.
fn curve(model: &Model, placed: &Placed) -> Trajectory {
    let prints = &placed.prints;
    let height_m = model.leg.foot.ankle_m[1] + 0.95 * model.leg.nominal_m - model.leg.hip_from_com_m[1];
    let at = |i: usize| prints[i.saturating_sub(1)].middle.midpoint(prints[i].middle) + DVec3::Y * height_m;
    let last = prints.len() - 1;
    let knot = |i: usize| {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(last));
        let over_s = (prints[after].strike_s - prints[before].strike_s).max(0.1);
        Knot { at: at(i), velocity: (at(after) - at(before)) / over_s }
    };
    let mut trajectory = Trajectory::default();
    for i in 0..prints.len() {
        if trajectory.times_s.last().is_none_or(|&at_s| prints[i].strike_s > at_s) {
            trajectory.times_s.push(prints[i].strike_s);
            trajectory.knots.push(knot(i));
        }
    }
    trajectory
}

/// The greatest speed of any joint, toe or heel, m/s.
fn fastest_m_s(poses: &[BipedPose]) -> f64 {
    let points = |pose: &BipedPose| -> Vec<DVec3> {
        let legs = pose.legs.iter();
        legs.flat_map(|leg| leg.joints.iter().copied().chain([leg.toe, leg.heel])).collect()
    };
    let step = |pair: &[BipedPose]| {
        let (from, to) = (points(&pair[0]), points(&pair[1]));
        from.iter().zip(&to).map(|(a, b)| a.distance(*b) / DT_S).fold(0.0, f64::max)
    };
    poses.windows(2).map(step).fold(0.0, f64::max)
}

/// Times of a model's walk: a step, s.
fn step_s(name: &str) -> f64 {
    [0.42, 0.66, 0.52][NAMES.iter().position(|other| *other == name).unwrap()]
}

#[test]
fn feet_in_stance_are_exactly_on_their_prints() {
    for name in NAMES {
        let walk = Walk::straight(name, 8, 0.0, step_s(name), 0.62);
        let foot = &walk.model.leg.foot;
        let mut flat = 0;
        for pose in walk.poses() {
            for (leg, side) in pose.legs.iter().zip(Foot::BIPED) {
                if matches!(leg.state, FootState::Swing { .. }) {
                    continue;
                }
                assert!(leg.miss_m < 1e-9, "{name}: {}", leg.miss_m);
                let on_a_print = walk.placed.prints.iter().filter(|print| print.foot == side).any(|print| {
                    let toe = print.middle + print.world_from_foot * DVec3::X * foot.toe_ahead_m;
                    let ankle = print.middle
                        + print.world_from_foot * DVec3::new(foot.ankle_m[0], foot.ankle_m[1], 0.0);
                    let flat = leg.state != FootState::Flat
                        || leg.joints.last().unwrap().distance(ankle) < 1e-9 && leg.heel.y.abs() < 1e-9;
                    leg.toe.distance(toe) < 1e-9 && flat
                });
                assert!(on_a_print, "{name}: {leg:?}");
                flat += usize::from(leg.state == FootState::Flat);
            }
        }
        assert!(flat > 500, "{name}: {flat}");
    }
}

#[test]
fn segments_keep_their_lengths_and_virtual_legs_their_longest() {
    for name in NAMES {
        let walk = Walk::straight(name, 8, 0.1, step_s(name), 0.62);
        for leg in walk.poses().iter().flat_map(|pose| &pose.legs) {
            for (pair, length_m) in leg.joints.windows(2).zip(&walk.model.leg.segments_m) {
                assert!((pair[0].distance(pair[1]) - length_m).abs() < 1e-9, "{name}");
            }
            let virtual_m = leg.joints[0].distance(*leg.joints.last().unwrap());
            assert!(virtual_m < walk.model.leg.longest_m + 1e-9, "{name}: {virtual_m}");
        }
    }
}

#[test]
fn nothing_jumps_in_walking_running_hopping_and_climbing() {
    for name in NAMES {
        let (step_s, length_m) = (step_s(name), Model::named(name).unwrap().step_m[0]);
        let hops: Vec<_> = (0..12)
            .map(|i| {
                let at_s = i as f64 * step_s;
                let side = usize::from(!(3..9).contains(&i)) * (i % 2);
                (side, DVec3::new(i as f64 * length_m, 0.0, 0.0), 0.1 * i as f64, at_s, at_s + 0.6 * step_s)
            })
            .collect();
        let cases = [
            ("walk", Walk::straight(name, 8, 0.0, step_s, 0.62)),
            ("run", Walk::straight(name, 8, 0.0, 0.7 * step_s, 0.35)),
            ("up", Walk::straight(name, 8, 0.17 * length_m, step_s, 0.62)),
            ("down", Walk::straight(name, 8, -0.17 * length_m, step_s, 0.62)),
            ("hop", Walk::of(name, &hops)),
        ];
        for (what, walk) in cases {
            let fastest = fastest_m_s(&walk.poses());
            // The foot swings twice as far as the body goes, in less time; knees and hocks are faster when the leg is nearly straight.
            let most = 6.0 * length_m / step_s + 3.0;
            assert!(fastest < most, "{name} {what}: {fastest} m/s, {most} at most");
        }
    }
}

#[test]
fn the_heel_rises_before_the_foot_leaves_and_is_down_in_the_middle_of_the_stance() {
    for name in NAMES {
        let walk = Walk::straight(name, 8, 0.0, step_s(name), 0.62);
        let print = walk.placed.prints[4];
        let leg = |share: f64| {
            let time_s = print.strike_s + share * (print.lift_off_s - print.strike_s);
            walk.biped().pose(time_s).legs[0].clone()
        };
        assert_eq!(leg(0.4).state, FootState::Flat, "{name}");
        let FootState::OnToes { rise_rad } = leg(0.999).state else { panic!("{name}: {:?}", leg(0.999)) };
        assert!(rise_rad > 0.4 && rise_rad < 1.3, "{name}: {rise_rad}");
        assert!(leg(0.999).heel.y > 0.3 * walk.model.leg.foot.toe_ahead_m);
    }
}

#[test]
fn a_swinging_leg_is_retracted_and_its_foot_clears_the_ground() {
    for name in NAMES {
        let walk = Walk::straight(name, 8, 0.0, step_s(name), 0.62);
        let (nominal_m, retracted) = (walk.model.leg.nominal_m, walk.model.leg.retracted);
        let mut shortest = f64::INFINITY;
        for leg in walk.poses().iter().skip(200).flat_map(|pose| &pose.legs) {
            if matches!(leg.state, FootState::Swing { .. }) {
                assert!(leg.toe.y > -1e-9 && leg.heel.y > -1e-9, "{name}: {} {}", leg.toe.y, leg.heel.y);
                shortest = shortest.min(leg.joints[0].distance(*leg.joints.last().unwrap()) / nominal_m);
            }
        }
        assert!(shortest < retracted + 0.03, "{name}: {shortest}");
    }
}

#[test]
fn a_foot_that_climbs_stairs_cuts_no_tread() {
    // Treads 0.3 m deep and 0.17 m high, one foot on each; of a dinosaur twice as large.
    for (name, size) in [("human", 1.0), ("dinosaur", 2.0), ("bird", 0.7)] {
        for way in [1.0, -1.0] {
            let (deep_m, high_m) = (0.3 * size, 0.17 * size);
            let step = |i: usize| {
                let at_s = i as f64 * 0.6;
                let (side, z_m) = (i % 2, [-0.08, 0.08][i % 2] * size);
                let middle = DVec3::new(i as f64 * deep_m, way * i as f64 * high_m, z_m);
                (side, middle, 0.0, at_s, at_s + 0.75)
            };
            let walk = Walk::of(name, &(0..10).map(step).collect::<Vec<_>>());
            let tread_m = |x_m: f64| way * (x_m / deep_m + 0.5).floor().clamp(0.0, 9.0) * high_m;
            let swinging = |leg: &&LegPose| matches!(leg.state, FootState::Swing { .. });
            let poses = walk.poses();
            let legs = poses.iter().filter(|pose| pose.centre_of_mass.x > deep_m);
            let ahead = DVec3::X * 0.1 * deep_m;
            // The ends of the feet are longer than the treads; what counts is the ball of the foot.
            let cut_m = |leg: &LegPose| {
                let ball = leg.toe.lerp(leg.heel, 0.3);
                (tread_m(ball.x) - ball.y).min(tread_m((ball - ahead).x) - ball.y)
            };
            let most_m = legs.flat_map(|pose| &pose.legs).filter(swinging).map(cut_m).fold(0.0, f64::max);
            assert!(most_m < 0.2 * high_m, "{name} {way}: {most_m}");
        }
    }
}

#[test]
fn left_and_right_are_mirror_images() {
    for name in NAMES {
        let there = Walk::straight(name, 7, 0.05, step_s(name), 0.62);
        let mut back = Walk::straight(name, 7, 0.05, step_s(name), 0.62);
        for print in &mut back.placed.prints {
            print.foot = if print.foot == Foot::Left { Foot::Right } else { Foot::Left };
            print.middle.z *= -1.0;
        }
        let mirrored = |v: DVec3| v * DVec3::new(1.0, 1.0, -1.0);
        for knot in &mut back.trajectory.knots {
            (knot.at, knot.velocity) = (mirrored(knot.at), mirrored(knot.velocity));
        }
        for turn in &mut back.orientation.world_from_body {
            *turn = DQuat::from_xyzw(-turn.x, -turn.y, turn.z, turn.w);
        }
        for (pose, other) in there.poses().iter().zip(back.poses()) {
            for side in 0..2 {
                let (leg, mirror) = (&pose.legs[side], &other.legs[1 - side]);
                for (a, b) in leg.joints.iter().zip(&mirror.joints).chain([(&leg.toe, &mirror.toe)]) {
                    assert!(a.distance(mirrored(*b)) < 1e-9, "{name}");
                }
            }
        }
    }
}

#[test]
fn a_print_out_of_reach_is_reached_for_and_missed_by_as_much_as_is_missing() {
    for name in NAMES {
        let mut walk = Walk::straight(name, 6, 0.0, step_s(name), 0.62);
        for knot in &mut walk.trajectory.knots {
            knot.at.y += walk.model.leg.nominal_m;
        }
        for pose in walk.poses() {
            for leg in &pose.legs {
                let virtual_m = leg.joints[0].distance(*leg.joints.last().unwrap());
                if !matches!(leg.state, FootState::Swing { .. }) {
                    assert!(leg.miss_m > 0.1 && (virtual_m - walk.model.leg.longest_m).abs() < 1e-9);
                }
            }
        }
        assert!(fastest_m_s(&walk.poses()) < 6.0 * walk.model.step_m[0] / step_s(name) + 3.0, "{name}");
    }
}

#[test]
fn a_foot_without_prints_hangs_folded_below_its_hip() {
    for name in NAMES {
        let hop = |i: usize| (0, DVec3::X * 0.2 * i as f64, 0.0, 0.5 * i as f64, 0.5 * i as f64 + 0.3);
        let walk = Walk::of(name, &(0..6).map(hop).collect::<Vec<_>>());
        let leg = &walk.model.leg;
        for pose in walk.poses() {
            let [_, right] = &pose.legs;
            let along = *right.joints.last().unwrap() - right.joints[0];
            assert!((along.length() - leg.nominal_m * leg.retracted_running).abs() < 1e-9);
            assert!(along.y < -0.9 * along.length() && right.toe.y > 0.0, "{name}");
        }
    }
}

#[test]
fn stances_are_those_of_the_prints() {
    let walk = Walk::straight("human", 4, 0.0, 0.5, 0.6);
    let all = stances(&walk.model, &walk.placed);
    assert_eq!(all.len(), 4);
    let [left, right] = [all[0], all[1]];
    assert_eq!((left.foot, right.foot), (0, 1));
    assert_eq!(left.hip_from_com, DVec3::new(0.0, -0.05, -0.09));
    assert_eq!(right.hip_from_com, DVec3::new(0.0, -0.05, 0.09));
    assert!(right.ankle.distance(DVec3::new(0.64, 0.07, 0.06)) < 1e-12);
    assert!(right.toe.distance(DVec3::new(0.825, 0.0, 0.06)) < 1e-12 && right.middle.x == 0.7);
    assert_eq!((right.from_s, right.to_s, right.force_through_hip), (0.5, 1.1, 0.0));
}

#[test]
fn numbers_that_are_none_do_not_stop_it() {
    let odd = [f64::NAN, f64::INFINITY, -1.0, 0.0, 1e300];
    for a in odd {
        for b in odd {
            let mut walk = Walk::straight("bird", 4, 0.0, 0.5, 0.6);
            (walk.placed.prints[1].strike_s, walk.placed.prints[2].lift_off_s) = (a, b);
            walk.placed.prints[3].middle = DVec3::new(a, b, a);
            walk.trajectory.knots[0].at.y = b;
            for time_s in [a, b, 0.3, 0.9, 1.2] {
                crate::shape::tubes(&walk.model, &walk.biped().pose(time_s));
            }
        }
    }
    let empty = Placed { prints: Vec::new(), end_s: 0.0 };
    let walk = Walk::straight("human", 2, 0.0, 0.5, 0.6);
    let pose = Biped { placed: &empty, trajectory: &Trajectory::default(), ..walk.biped() }.pose(0.0);
    assert!(pose.legs.iter().all(|leg| leg.toe.is_finite()));
}

#[test]
fn a_pose_is_found_among_ten_thousand_prints_in_no_time() {
    let walk = Walk::straight("bird", 10_000, 0.0, 0.4, 0.62);
    let from = std::time::Instant::now();
    let poses = 20_000;
    let sum: f64 = (0..poses).map(|i| walk.biped().pose(0.2 * f64::from(i)).legs[0].toe.x).sum();
    let each_us = from.elapsed().as_secs_f64() * 1e6 / f64::from(poses);
    println!("{each_us:.2} us for a pose");
    assert!(sum.is_finite() && each_us < 100.0, "{each_us} us");
}
