//! A ride as a person drives it.

use muybridge_core::{Database, Skeleton, Turn};

use super::build::Build;
use super::*;

fn repertoire() -> Arc<Repertoire> {
    Arc::new(Repertoire::new(&Database::embedded(), &Skeleton::reference()).unwrap())
}

fn ride_s(ride: &mut RideSession, seconds: f64) {
    (0..(seconds * 60.0) as usize).for_each(|_| ride.advance(STEP_S));
}

fn root(ride: &RideSession) -> Vec3 {
    ride.joints(Which::A).unwrap().root
}

#[test]
fn a_single_step_back_shows_exactly_what_was_and_forward_again_what_came() {
    let mut ride = RideSession::new(repertoire());
    ride_s(&mut ride, 2.0);
    ride.pause(true);
    let mut seen = Vec::new();
    for _ in 0..30 {
        seen.push(ride.joints(Which::A).unwrap());
        ride.step_forward();
    }
    for joints in seen.iter().rev() {
        ride.step_back();
        assert_eq!(ride.joints(Which::A).unwrap(), *joints);
    }
    for joints in &seen {
        assert_eq!(ride.joints(Which::A).unwrap(), *joints);
        ride.step_forward();
    }
}

#[test]
fn what_is_recorded_is_ridden_again_exactly_by_the_same_orders() {
    let mut ride = RideSession::new(repertoire());
    for order in [Order::Speed(12.0), Order::Tap(Side::Left), Order::Speed(30.0), Order::Leap] {
        ride.give(order);
        ride_s(&mut ride, 1.5);
    }
    let frames: Vec<Frame> = ride.record().between(usize::MAX, 0).cloned().collect();
    let start = frames[100].riders[0].clone().unwrap();
    let mut horse = Horse::of(start.repertoire, 0);
    horse.restore(&start.state);
    for frame in &frames[101..] {
        horse.step(&frame.wants.command(None), STEP_S as f32, &frame.terrain);
        assert_eq!(*horse.state(), frame.riders[0].as_ref().unwrap().state, "step {}", frame.step);
    }
}

#[test]
fn an_order_from_an_earlier_moment_rides_on_from_there() {
    let mut ride = RideSession::new(repertoire());
    ride.give(Order::Speed(12.0));
    ride_s(&mut ride, 3.0);
    ride.go_back(60);
    let then = root(&ride);
    let step = ride.shown().step;
    ride.give(Order::Halt);
    assert_eq!((ride.back(), ride.shown().step, root(&ride)), (0, step, then));
    assert_eq!(ride.wants().speed_mph, 0.0);
    ride.pause(false);
    ride_s(&mut ride, 0.5);
    assert_eq!(ride.shown().step, step + 30);
}

#[test]
fn after_a_look_back_the_record_plays_to_its_end_and_the_ride_goes_on() {
    let mut ride = RideSession::new(repertoire());
    ride_s(&mut ride, 2.0);
    let newest = ride.shown().step;
    ride.go_back(30);
    ride.pause(false);
    ride_s(&mut ride, 0.25);
    assert!(ride.back() > 0 && ride.record().back(0).step == newest);
    ride_s(&mut ride, 1.0);
    assert!(ride.back() == 0 && ride.shown().step > newest);
}

#[test]
fn time_passes_at_the_rate_in_whole_steps_and_not_while_paused() {
    let mut ride = RideSession::new(repertoire());
    ride.rate = 1.0 / 16.0;
    (0..160).for_each(|_| ride.advance(1.0 / 60.0));
    assert!((9..=10).contains(&ride.shown().step), "{}", ride.shown().step);
    ride.advance(1e9);
    assert!(ride.shown().step < 12, "a long wait is not caught up with");
    ride.pause(true);
    let step = ride.shown().step;
    ride.advance(1.0);
    ride.advance(f64::NAN);
    assert_eq!(ride.shown().step, step);
}

#[test]
fn slow_motion_moves_between_the_steps() {
    let mut ride = RideSession::new(repertoire());
    ride.give(Order::Speed(12.0));
    ride_s(&mut ride, 3.0);
    ride.rate = 1.0 / 16.0;
    let mut last = root(&ride).x;
    let mut moves = 0;
    for _ in 0..160 {
        ride.advance(1.0 / 60.0);
        let now = root(&ride).x;
        moves += usize::from(now > last);
        last = now;
    }
    assert!(moves > 140, "{moves} of 160 pictures are new");
}

#[test]
fn twenty_seconds_are_kept_and_no_more() {
    let mut ride = RideSession::new(repertoire());
    ride_s(&mut ride, 23.0);
    assert_eq!(ride.record().depth(), 1200);
    ride.go_back(usize::MAX);
    assert_eq!((ride.back(), ride.shown().step), (1200, 1380 - 1200));
    ride.step_back();
    assert_eq!(ride.back(), 1200);
}

#[test]
fn a_second_horse_goes_beside_the_first_with_its_own_gait_and_build() {
    let mut ride = RideSession::new(repertoire());
    ride.give(Order::Speed(12.0));
    ride.give(Order::Gait(Some(Gait::Trot)));
    ride_s(&mut ride, 1.0);
    ride.bring_second();
    let foal = Build { legs: 0.8, size: 0.7, ..Build::default() }.skeleton(&Skeleton::reference());
    ride.set_build(Which::B, Arc::new(Repertoire::new(&Database::embedded(), &foal).unwrap()));
    ride.set_own_gait(Which::B, Some(Gait::Rack));
    ride_s(&mut ride, 4.0);
    let [a, b] = Which::ALL.map(|which| ride.joints(which).unwrap());
    assert!(b.root.y < 0.8 * a.root.y, "{} {}", a.root.y, b.root.y);
    assert!((b.root.z - a.root.z).abs() > 1.0 && (b.root.x - a.root.x).abs() < 4.0, "{} {}", a.root, b.root);
    let [a, b] = [0, 1].map(|i: usize| ride.shown().riders[i].as_ref().unwrap().readout.gait);
    assert_eq!((a, b), (Gait::Trot, Gait::Rack));
    ride.go_back(1200);
    assert!(ride.joints(Which::B).is_none(), "it was not there yet");
    ride.give(Order::Faster);
    ride.pause(false);
    ride_s(&mut ride, 0.2);
    ride.take_second_away();
    assert!(ride.joints(Which::B).is_none());
}

#[test]
fn the_ground_the_build_and_a_reset_never_leave_a_pose_that_is_no_number() {
    let mut ride = RideSession::new(repertoire());
    let reference = Skeleton::reference();
    ride.give(Order::Turn(Turn::Rate(0.5)));
    for (round, (shape, _)) in Shape::ALL.into_iter().chain(Shape::ALL).enumerate() {
        ride.give(Order::Speed(6.0 * round as f32));
        ride.set_shape(shape);
        ride_s(&mut ride, 2.0);
        let legs = if round % 2 == 0 { 0.6 } else { 1.5 };
        let skeleton = Build { legs, ..Build::default() }.skeleton(&reference);
        ride.set_build(Which::A, Arc::new(Repertoire::new(&Database::embedded(), &skeleton).unwrap()));
        ride_s(&mut ride, 1.0);
        let joints = ride.joints(Which::A).unwrap();
        assert!(joints.tips.iter().chain(&joints.bases).all(|at| at.is_finite()), "{shape:?}");
    }
    ride.reset();
    assert_eq!((ride.shown().step, ride.record().depth()), (0, 0));
    assert!(root(&ride).with_y(0.0).length() < 0.6);
}

#[test]
fn traces_follow_the_toes_and_end_at_the_moment_shown() {
    let mut ride = RideSession::new(repertoire());
    ride_s(&mut ride, 3.0);
    ride.go_back(40);
    let trace = ride.trace(Which::A, Limb::RF, 2.0);
    assert_eq!(trace.last().copied(), ride.joints(Which::A).map(|joints| joints.toe(Limb::RF)));
    assert!((100..=121).contains(&trace.len()));
}
