//! A step of the horse takes no memory from the heap, whatever it is asked to do.

use glam::DVec3;
use muybridge_core::{Command, Database, FlatGround, Gait, Horse, Leap, MPS_PER_MPH, Side, Skeleton, Turn};

const STEPS: usize = 10_000;
/// Steps between one wish and the next: two and a half seconds, so that some changes are done and some are cut short.
const STEPS_OF_A_WISH: usize = 150;

/// Wishes of every kind in turn.
fn command(step: usize) -> Command {
    let wish = step / STEPS_OF_A_WISH;
    let mph = [4.0, 8.0, 12.0, 0.0, 15.0, 30.0, 18.0, -1.0, f32::NAN, 22.0, 38.0][wish % 11];
    let turn = match wish % 4 {
        0 => Turn::Rate(0.4),
        1 => Turn::Heading(2.0),
        2 => Turn::Steps(-3),
        _ => Turn::Rate(0.0),
    };
    let gait = [None, None, Some(Gait::Trot), None, Some(Gait::Rack), None][wish % 6];
    let lead = [None, Some(Side::Left), Some(Side::Right)][wish % 3];
    let leap = (wish % 5 == 2).then_some(Leap { height_m: 0.6, length_m: 3.0 });
    Command { speed_m_s: mph * MPS_PER_MPH as f32, turn, gait, lead, leap }
}

/// Hills, a step and a hole.
fn terrain(x_m: f32, z_m: f32) -> f32 {
    if (x_m.rem_euclid(60.0) - 30.0).hypot(z_m.rem_euclid(60.0) - 30.0) < 0.5 {
        return f32::NAN;
    }
    let stair = if x_m.rem_euclid(40.0) < 20.0 { 0.15 } else { 0.0 };
    0.6 * (0.1 * x_m).sin() * (0.07 * z_m).cos() + stair
}

/// What was seen to happen.
#[derive(Default)]
struct Seen {
    gaits: [bool; 7],
    changes: usize,
    stands: usize,
    turned_rad: f64,
    not_finite: usize,
}

fn ride(horse: &mut Horse, seen: &mut Seen) {
    for step in 0..STEPS {
        // Uneven time steps, as a game has them.
        let dt_s = if step % 7 == 0 { 1.0 / 30.0 } else { 1.0 / 60.0 };
        let pose = if step / 1000 % 2 == 0 {
            *horse.step(&command(step), dt_s, &FlatGround)
        } else {
            *horse.step(&command(step), dt_s, &terrain)
        };
        let readout = horse.readout();
        seen.gaits[Gait::ALL.iter().position(|gait| *gait == readout.gait).unwrap_or(0)] = true;
        seen.changes += usize::from(readout.change.is_some());
        seen.stands += usize::from(readout.is_standing);
        seen.turned_rad += f64::from(readout.turn_rate_rad_s.abs() * dt_s);
        seen.not_finite += usize::from(!pose.root_in_world.is_finite());
        if step % 1111 == 0 {
            let state = *horse.state();
            horse.restore(&state);
        }
    }
}

#[test]
fn ten_thousand_steps_allocate_nothing() {
    let mut horse = Horse::new(&Database::embedded(), &Skeleton::reference(), 7).unwrap();
    horse.place(DVec3::new(3.0, 0.0, -2.0), 0.3, &FlatGround);
    let mut seen = Seen::default();
    let counted = allocation_counter::measure(|| ride(&mut horse, &mut seen));
    assert_eq!(counted.count_total, 0, "{counted:?}");
    // That nothing was left out.
    assert_eq!(seen.gaits, [true; 7], "not every gait was ridden");
    assert!(seen.changes > 500 && seen.stands > 100 && seen.turned_rad > 5.0);
    assert_eq!(seen.not_finite, 0);
}

#[test]
fn the_counter_counts() {
    let counted = allocation_counter::measure(|| drop(std::hint::black_box(vec![1, 2, 3])));
    assert_eq!(counted.count_total, 1);
}
