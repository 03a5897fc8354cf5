//! What a game relies on: equal bytes, saved states, clamped numbers, the right foot first, leads changed in the air.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

use muybridge_core::{
    Command, Database, FlatGround, Gait, Horse, HorseState, Leap, Limb, Readout, Side, Skeleton, Turn,
};

const STEP_S: f32 = 1.0 / 60.0;

fn horse(seed: u64) -> Horse {
    Horse::new(&Database::embedded(), &Skeleton::reference(), seed).unwrap()
}

fn at(speed_m_s: f32) -> Command {
    Command { speed_m_s, ..Command::default() }
}

/// Something of everything, at a step of a ride.
fn asked(step: usize) -> Command {
    Command {
        speed_m_s: [0.0, 2.0, 6.0, 13.0, 4.0][step / 120 % 5],
        turn: if (step / 90).is_multiple_of(2) { Turn::Rate(0.3) } else { Turn::Steps((step / 200) as i32) },
        leap: (step % 400 > 380).then_some(Leap { height_m: 0.5, length_m: 3.0 }),
        ..Command::default()
    }
}

fn hills(x: f32, z: f32) -> f32 {
    0.3 * (0.4 * x).sin() + 0.2 * (0.3 * z).cos()
}

#[test]
fn equal_horses_do_the_same_to_the_bit_and_a_kept_state_goes_on_as_it_was() {
    let (mut one, mut other) = (horse(7), horse(7));
    for step in 0..900 {
        one.step(&asked(step), STEP_S, &hills);
        other.step(&asked(step), STEP_S, &hills);
    }
    assert_eq!(one.state(), other.state());
    let value = serde_json::to_value(one.state()).unwrap();
    let kept: HorseState = serde_json::from_value(value).unwrap();
    assert_eq!(&kept, one.state(), "a save game holds every bit");
    let mut back = Horse::of(one.repertoire().clone(), 99);
    back.restore(&kept);
    for step in 900..1500 {
        assert_eq!(one.step(&asked(step), STEP_S, &hills), back.step(&asked(step), STEP_S, &hills));
    }
    assert!(std::mem::size_of::<HorseState>() <= 2048);
}

#[test]
fn no_time_is_no_change_and_numbers_that_are_none_are_clamped() {
    let mut horse = horse(1);
    (0..300).for_each(|_| _ = horse.step(&at(5.0), STEP_S, &FlatGround));
    let before = *horse.state();
    for dt_s in [0.0, -1.0, f32::NAN, f32::NEG_INFINITY] {
        horse.step(&at(5.0), dt_s, &FlatGround);
        assert_eq!(*horse.state(), before, "{dt_s}");
    }
    let mut long = Horse::of(horse.repertoire().clone(), 1);
    long.restore(&before);
    horse.step(&at(5.0), f32::INFINITY, &FlatGround);
    long.step(&at(5.0), 0.25, &FlatGround);
    assert_eq!(horse.state(), long.state(), "a quarter of a second is the longest");
    for speed_m_s in [1e9, f32::INFINITY, f32::NAN, -3.0] {
        (0..200).for_each(|_| _ = horse.step(&at(speed_m_s), STEP_S, &FlatGround));
        assert!(horse.pose().root_in_world.is_finite() && horse.readout().speed_m_s < 25.0);
    }
}

/// Rides on until something is seen, at most for so many seconds.
fn ride_until(
    horse: &mut Horse,
    command: &Command,
    seconds: f32,
    seen: impl Fn(&Readout) -> bool,
) -> Readout {
    for _ in 0..(seconds / STEP_S) as usize {
        horse.step(command, STEP_S, &FlatGround);
        if seen(&horse.readout()) {
            return horse.readout();
        }
    }
    panic!("not seen within {seconds} s of {command:?}: {:?}", horse.readout());
}

#[test]
fn a_horse_sets_out_with_a_hind_leg_and_the_fore_of_its_side_follows() {
    for seed in 0..4 {
        let mut horse = horse(seed);
        let first = ride_until(&mut horse, &at(1.4), 3.0, |r| r.on_ground.contains(&false));
        let hind = first.on_ground.iter().position(|down| !down).unwrap();
        assert!(hind >= 2, "leg {hind} went first");
        let second = ride_until(&mut horse, &at(1.4), 3.0, |r| !r.on_ground[0] || !r.on_ground[1]);
        assert_eq!(second.on_ground.iter().position(|down| !down), Some(hind - 2));
    }
}

#[test]
fn a_horse_halts_and_stands_on_four_feet() {
    let mut horse = horse(3);
    ride_until(&mut horse, &at(12.0), 12.0, |r| r.gait == Gait::Gallop && r.change.is_none());
    let halted =
        ride_until(&mut horse, &at(0.0), 12.0, |r| r.speed_m_s == 0.0 && r.stride_time_s.is_infinite());
    assert_eq!(halted.on_ground, [true; 4]);
    let still = *horse.pose();
    (0..300).for_each(|_| _ = horse.step(&at(0.0), STEP_S, &FlatGround));
    assert!(horse.pose().root_in_world.distance(still.root_in_world) < 0.01, "it stands still");
}

#[test]
fn the_turn_chooses_the_lead_and_the_lead_changes_when_the_leading_foreleg_leaves() {
    let mut horse = horse(5);
    let canter = |rate| Command { gait: Some(Gait::Canter), turn: Turn::Rate(rate), ..at(6.5) };
    for (rate, side) in [(0.3, Side::Left), (-0.3, Side::Right), (0.3, Side::Left)] {
        ride_until(&mut horse, &canter(rate), 12.0, |r| r.lead == Some(side) && r.change.is_none());
        // At the beginning of a change of lead the foreleg that led has just left the ground.
        let other = Command { lead: Some(side.opposite()), ..canter(0.0) };
        let begun = ride_until(&mut horse, &other, 5.0, |r| r.change.is_some());
        assert!(!begun.on_ground[Limb::new(muybridge_core::Pair::Fore, side).index()], "{side:?}");
    }
}

#[test]
fn a_leap_rises_and_reaches_as_asked() {
    for (height_m, length_m) in [(0.4, 3.5), (0.9, 6.0)] {
        let mut horse = horse(2);
        let canter = Command { gait: Some(Gait::Canter), lead: Some(Side::Right), ..at(6.0) };
        ride_until(&mut horse, &canter, 12.0, |r| r.gait == Gait::Canter && r.change.is_none());
        let leap = Command { leap: Some(Leap { height_m, length_m }), ..canter };
        ride_until(&mut horse, &leap, 12.0, |r| r.gait == Gait::Leap && r.change.is_none());
        ride_until(&mut horse, &leap, 2.0, |r| r.on_ground == [false; 4]);
        let from = horse.pose().root_in_world;
        let mut top_m = from.y;
        while horse.readout().on_ground == [false; 4] {
            horse.step(&leap, STEP_S, &FlatGround);
            top_m = top_m.max(horse.pose().root_in_world.y);
        }
        let to = horse.pose().root_in_world;
        let flown_m = (to - from).with_y(0.0).length();
        // The arc is over the line from take-off to landing; the croup lands higher than it took off.
        let rise_m = top_m - 0.5 * (from.y + to.y);
        assert!((flown_m / length_m - 1.0).abs() < 0.12, "{length_m}: {flown_m}");
        assert!((rise_m / height_m - 1.0).abs() < 0.25, "{height_m}: {rise_m}");
        ride_until(&mut horse, &canter, 6.0, |r| r.gait == Gait::Canter && r.change.is_none());
    }
}

#[test]
fn hooves_take_the_slope_of_the_ground_they_stand_on() {
    let rises = [-0.2f32, 0.0, 0.2];
    let tilts = rises.map(|rise| {
        let mut horse = horse(4);
        let ground = move |x: f32, _z: f32| rise * x;
        horse.place(glam::DVec3::ZERO, 0.0, &ground);
        (0..120).for_each(|_| _ = horse.step(&at(0.0), STEP_S, &ground));
        let joints = horse.pose().joints(horse.skeleton());
        Limb::ALL.map(|limb| {
            let hoof = joints.toe(limb) - joints.bases[limb.hoof_bone()];
            hoof.y.atan2(hoof.x)
        })
    });
    for limb in 0..4 {
        for slope in [0, 2] {
            let turned = tilts[slope][limb] - tilts[1][limb];
            let share = turned / rises[slope].atan();
            assert!((0.4..1.6).contains(&share), "leg {limb} on {}: {share} of the slope", rises[slope]);
        }
    }
}

#[test]
fn walk_gives_way_near_a_froude_number_of_a_third_and_at_the_same_one_whatever_the_size() {
    for factor in [0.6, 1.0, 1.4] {
        let skeleton = Skeleton::reference().scaled(factor);
        let mut horse = Horse::new(&Database::embedded(), &skeleton, 1).unwrap();
        let leg_m = horse.pose().joints(&skeleton).tips[Limb::LH.first_bone()].y;
        let mut speed_m_s = 0.8 * factor.sqrt();
        while horse.readout().gait == Gait::Walk {
            speed_m_s += 0.02;
            (0..30).for_each(|_| _ = horse.step(&at(speed_m_s), STEP_S, &FlatGround));
        }
        let froude = speed_m_s * speed_m_s / (9.81 * leg_m);
        assert!((0.28..0.48).contains(&froude), "size {factor}: {froude}");
        assert_eq!(horse.readout().gait, Gait::Amble, "the table has the amble between walk and trot");
    }
}
