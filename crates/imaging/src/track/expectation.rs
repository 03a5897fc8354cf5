//! Where a limb's segments are expected to point in the next panel, from the two panels before.
//!
//! A limb goes through its cycle much as a pendulum does, so that its next angles are nearly linear in its angles and in
//! their last turns. The shares below were fitted by ridge regression to the angles of the drawn strides of all gaits
//! (12 and 24 panels a stride), to the hand-placed points of plate "Sallie Gardner" and to a trot tracked from video
//! (11 to 23 frames a stride), forwards and backwards in time; a gait left out of the fit is predicted almost as well.
//! The root mean square error of a cannon's angle, its gait left out, is 3 to 10 degrees in the drawn gaits at 12 panels
//! a stride and 20 in the gallop of 1878, against 6 to 16 and 28 for equal turns. A leap is foreseen badly, 20.

use std::f64::consts::FRAC_PI_2;

use muybridge_capture::{Keypoint, LimbJoint};
use muybridge_core::{Limb, Pair, Side, Skeleton};

use super::figure::{Figure, wrapped};

/// Share of the four segments' last turns, root to tip, of the first segment's angle from square to the trunk, and of the
/// three bends between segments, in the next turn of each segment; and a constant, radians. Fore, then hind. Turns and
/// angles are against the line from dock to withers.
const TURN_SHARES: [[[f64; 9]; 4]; 2] = [
    [
        [0.29, 0.07, 0.16, 0.00, -0.24, 0.05, 0.00, 0.03, 0.26],
        [0.12, 0.75, -0.05, 0.01, -0.29, -0.24, 0.13, -0.19, -0.08],
        [0.38, 0.07, 0.39, 0.18, -0.24, -0.20, -0.25, 0.02, 0.15],
        [0.24, -0.35, 0.65, 0.33, -0.35, -0.30, -0.13, -0.41, -0.02],
    ],
    [
        [0.38, 0.04, 0.27, 0.02, -0.21, -0.12, -0.15, -0.03, -0.04],
        [0.30, 0.40, -0.20, 0.12, -0.26, -0.33, 0.11, 0.12, 0.38],
        [0.23, -0.05, 0.62, 0.03, -0.24, -0.15, -0.30, -0.10, -0.14],
        [0.06, 0.13, 0.09, 0.55, -0.21, -0.20, -0.45, -0.38, -0.24],
    ],
];
/// Scatter about that: radians at rest, and more per radian of the limb's last turns (root mean square). Fitted to the
/// errors for gaits left out, and a fifth wider, which tracks best.
const SCATTER: [[[f64; 2]; 4]; 2] = [
    [[0.070, 0.20], [0.074, 0.37], [0.103, 0.37], [0.203, 0.70]],
    [[0.055, 0.34], [0.097, 0.53], [0.058, 0.38], [0.138, 0.61]],
];
/// Turn between panels where nothing is known of the one before, radians: what 12 panels a stride of a gallop show.
const LONE_SCATTER: [f64; 4] = [0.30, 0.45, 0.55, 0.80];
/// The same for neck and head.
const NECK_SCATTER: f64 = 0.17;
/// Share of a turn of neck and head that goes on.
const NECK_GOES_ON: f64 = 0.3;
/// Angle of the line from dock to withers where it is not placed, radians.
const LEVEL_TRUNK: f64 = -0.16;
/// Degrees of freedom of Student's distribution of turns: strikes and lift-offs come suddenly.
const FREEDOM: f64 = 4.0;
/// Farthest turn that is searched, in scatters, and in radians.
const REACH: f64 = 5.0;
const FARTHEST_TURN: f64 = 2.8;
/// Least share of probability of a fetlock's bend, for what none of its habits explains.
const ODD_BEND: f64 = 1e-6;

/// What is expected of a segment's angle.
#[derive(Clone, Debug)]
pub(super) struct Expectation {
    /// Radians, clockwise from where the animal faces.
    pub(super) angle: f64,
    scatter: f64,
    /// What a fetlock does; empty for other joints.
    habits: Vec<Habit>,
}

/// One way a fetlock bends.
#[derive(Clone, Copy, Debug)]
struct Habit {
    share: f64,
    /// Turn of the hoof against the cannon, radians, clockwise.
    bend: f64,
    /// More of it per radian of the cannon's turn against the segment before.
    per_cannon_bend: f64,
    scatter: f64,
}

impl Expectation {
    /// Farthest angle from the expected one worth a look, radians.
    pub(super) fn reach(&self) -> f64 {
        (REACH * self.scatter).min(FARTHEST_TURN)
    }

    /// Log probability of an angle after those of the segments before it, nearest last, up to a constant.
    pub(super) fn log_probability(&self, angle: f64, before: &[f64]) -> f64 {
        let off = wrapped(angle - self.angle) / self.scatter;
        let turn = -0.5 * (FREEDOM + 1.0) * (1.0 + off * off / FREEDOM).ln();
        let Some((nearest, earlier)) = before.split_last() else { return turn };
        let cannon_bend = earlier.last().map_or(0.0, |earlier| wrapped(nearest - earlier));
        turn + self.habitual(wrapped(angle - nearest), cannon_bend)
    }

    fn habitual(&self, bend: f64, cannon_bend: f64) -> f64 {
        if self.habits.is_empty() {
            return 0.0;
        }
        let density = |habit: &Habit| {
            let off = wrapped(bend - habit.bend - habit.per_cannon_bend * cannon_bend) / habit.scatter;
            habit.share / habit.scatter * (-0.5 * off * off).exp()
        };
        self.habits.iter().map(density).sum::<f64>().max(ODD_BEND).ln()
    }
}

/// What is expected of each segment of a chain that is whole in the last figure; `pitch` is the trunk's turn since.
pub(super) fn expectations(figures: &[Figure], chain: &[Keypoint], pitch: f64) -> Vec<Expectation> {
    let Some((last, earlier)) = figures.split_last() else { return Vec::new() };
    let trunk_angle = |figure: &Figure| figure.trunk().map_or(LEVEL_TRUNK, |trunk| trunk.angle());
    let angles = |figure: &Figure| -> Vec<f64> {
        figure.segments(chain).iter().map(|segment| segment.angle() - trunk_angle(figure)).collect()
    };
    let now = angles(last);
    let before = earlier.last().map(angles).filter(|before| before.len() == now.len());
    let whole = match (chain.first(), <[f64; 4]>::try_from(now.as_slice())) {
        (Some(Keypoint::Limb(_, pair, _)), Ok(now)) => Some((*pair, now)),
        _ => None,
    };
    let before_whole = before.as_ref().and_then(|before| <[f64; 4]>::try_from(before.as_slice()).ok());
    (0..now.len())
        .map(|i| {
            let [turn, scatter] = match (whole, before_whole, &before) {
                (Some((pair, now)), Some(before), _) => cyclic_turn(pair, i, now, before),
                (None, _, Some(before)) if matches!(chain[i], Keypoint::Body(_)) => {
                    [NECK_GOES_ON * wrapped(now[i] - before[i]), NECK_SCATTER]
                }
                _ => [0.0, lone_scatter(chain[i + 1])],
            };
            Expectation {
                angle: trunk_angle(last) + pitch + now[i] + turn,
                scatter,
                habits: whole.filter(|_| i == 3).map_or(Vec::new(), |(pair, now)| fetlock_habits(pair, now)),
            }
        })
        .collect()
}

fn lone_scatter(distal: Keypoint) -> f64 {
    match distal {
        Keypoint::Body(_) => NECK_SCATTER,
        Keypoint::Limb(_, _, LimbJoint::Root | LimbJoint::Upper) => LONE_SCATTER[0],
        Keypoint::Limb(_, _, LimbJoint::Middle) => LONE_SCATTER[1],
        Keypoint::Limb(_, _, LimbJoint::Fetlock) => LONE_SCATTER[2],
        Keypoint::Limb(_, _, LimbJoint::Hoof) => LONE_SCATTER[3],
    }
}

/// Next turn of a segment and its scatter.
fn cyclic_turn(pair: Pair, segment: usize, now: [f64; 4], before: [f64; 4]) -> [f64; 2] {
    let turns: [f64; 4] = std::array::from_fn(|i| wrapped(now[i] - before[i]));
    let mut features = [1.0; 9];
    features[..4].copy_from_slice(&turns);
    features[4] = wrapped(now[0] - FRAC_PI_2);
    for i in 1..4 {
        features[4 + i] = wrapped(now[i] - now[i - 1]);
    }
    let shares = &TURN_SHARES[pair as usize][segment];
    let turn = shares.iter().zip(features).map(|(share, feature)| share * feature).sum();
    let pace = (turns.iter().map(|turn| turn * turn).sum::<f64>() / 4.0).sqrt();
    let [at_rest, per_turn] = SCATTER[pair as usize][segment];
    [turn, at_rest.hypot(per_turn * pace)]
}

/// A fetlock stays as it was, follows the limb through the air, or gives under the load. Bends of the skeleton are
/// anticlockwise for an animal that faces right.
fn fetlock_habits(pair: Pair, now: [f64; 4]) -> Vec<Habit> {
    /// How often each, and the scatter of the first two, radians: they track best.
    const SHARES: [f64; 3] = [0.3, 0.4, 0.3];
    const AIR_SCATTER: f64 = 0.35;
    let horse = Skeleton::reference();
    let fetlock = &horse.fetlock;
    let swing = if pair == Pair::Fore { fetlock.fore } else { fetlock.hind };
    let cannon = &horse.bones[Limb::new(pair, Side::Left).first_bone() + 3];
    let in_air = swing.swing_bend_rad - swing.per_cannon_bend * cannon.rest_bend_rad;
    let loaded = Habit {
        share: SHARES[2],
        bend: -f64::from(fetlock.stance_bend_rad),
        per_cannon_bend: 0.0,
        scatter: f64::from(fetlock.stance_sd_rad),
    };
    let as_before =
        Habit { share: SHARES[0], bend: wrapped(now[3] - now[2]), scatter: AIR_SCATTER, ..loaded };
    let swinging = Habit {
        share: SHARES[1],
        bend: -f64::from(in_air),
        per_cannon_bend: f64::from(swing.per_cannon_bend),
        scatter: AIR_SCATTER,
    };
    vec![as_before, swinging, loaded]
}
