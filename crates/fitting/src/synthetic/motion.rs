//! The motion of a synthetic horse: harmonics of the joints, and legs that stand still while they carry.

use std::f64::consts::TAU;

use muybridge_core::{BONE_COUNT, Limb, Pair, bone};
use nalgebra::{Matrix2, SMatrix, Vector2};

use super::legs::Stance;
use crate::chain::{Attachment, Chain, Unknown, Vec2};
use crate::layout::{BENDS, PANEL_DOF, PITCH, ROOT_X, ROOT_Y, SHARED, SLIDES};
use muybridge_core::Random;

/// The croup stands this much higher than where the freely swinging hind legs would set it, m; they stretch by it. More
/// would straighten a hock beyond its limit, less would fold an elbow beyond its own.
const STRETCH_M: f64 = 0.025;
/// Share of the stride over which a toe passes between its free path and its place on the ground.
const BLEND: f64 = 0.15;
/// Share of the stride past a stance for which a toe's free path still counts as that of the stance.
const LINGER: f64 = 0.03;
/// A swinging toe clears the ground by about this, m.
const CLEARANCE_M: f64 = 0.03;
/// Steps of the leg solution; its error falls by more than ten times at each.
const REACH_STEPS: usize = 25;
/// Damping of the leg solution, m^2 per rad^2: a hundredth of a leg's squared length keeps it calm near full stretch.
const REACH_DAMPING: f64 = 0.01;

/// What tells one gait from another, for a horse of the reference's size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gait {
    pub(super) speed_m_s: f64,
    pub(super) stride_time_s: f64,
    /// Share of the stride each hoof is down.
    duty_factor: f64,
    /// Phase of the middle of each leg's stance, in the order of [`Limb::ALL`].
    mid_stance: [f64; 4],
    /// Height of the root over its mean, first and second harmonic, m.
    bounce_m: [f64; 2],
    /// Pitch, first and second harmonic, degrees.
    pitch_deg: [f64; 2],
    /// Bend of the lumbosacral joint, first harmonic, degrees.
    back_deg: f64,
}

/// Diagonal pairs half a stride apart; the trunk rises twice a stride.
pub(super) const TROT: Gait = Gait {
    speed_m_s: 3.3,
    stride_time_s: 0.70,
    duty_factor: 0.34,
    mid_stance: [0.5, 0.0, 0.0, 0.5],
    bounce_m: [0.0, 0.035],
    pitch_deg: [0.0, 1.5],
    back_deg: 1.0,
};

/// Right lead, three beats; the trunk rises and pitches once a stride.
pub(super) const CANTER: Gait = Gait {
    speed_m_s: 4.8,
    stride_time_s: 0.56,
    duty_factor: 0.31,
    mid_stance: [0.27, 0.48, 0.0, 0.25],
    bounce_m: [0.04, 0.01],
    pitch_deg: [4.0, 1.0],
    back_deg: 5.0,
};

impl Gait {
    /// The same gait of a horse of another size, dynamically similar: equal Froude number.
    pub(super) fn scaled(self, size: f64) -> Self {
        Self {
            speed_m_s: self.speed_m_s * size.sqrt(),
            stride_time_s: self.stride_time_s * size.sqrt(),
            bounce_m: self.bounce_m.map(|v| v * size),
            ..self
        }
    }

    /// Phase within a leg's own cycle, in `[-0.5, 0.5)` with zero at mid-stance.
    fn limb_phase(&self, limb: Limb, phase: f64) -> f64 {
        (phase - self.mid_stance[limb.index()] + 0.5).rem_euclid(1.0) - 0.5
    }

    pub(super) fn down(&self, limb: Limb, phase: f64) -> bool {
        self.limb_phase(limb, phase).abs() < 0.5 * self.duty_factor
    }

    /// How much a toe belongs to its stance: one in stance, zero in swing, and smooth between. With the phase of that
    /// stance that counts.
    fn grounded(&self, limb: Limb, phase: f64) -> (f64, f64) {
        let at = self.limb_phase(limb, phase);
        let past = (at.abs() - 0.5 * self.duty_factor).max(0.0);
        let t = 1.0 - (past / BLEND).min(1.0);
        let lingering = at - at.signum() * (past - LINGER * (past / LINGER).tanh());
        (t * t * t * (10.0 + t * (6.0 * t - 15.0)), phase - at + lingering)
    }
}

/// Degrees by which the first four joints of a leg swing with it (to and fro) and flex in the air (once).
const FORE_SWING: [f64; 4] = [9.0, 9.0, 5.0, 0.0];
const FORE_FLEXION: [f64; 4] = [0.0, 12.0, 25.0, -75.0];
const HIND_SWING: [f64; 4] = [2.0, 19.0, 0.0, 0.0];
const HIND_FLEXION: [f64; 4] = [0.0, 15.0, -33.0, 33.0];
/// A leg is flexed most a little before the middle of its swing.
const FLEXED_AT: f64 = 0.45;

/// Turns of the five joints by which a leg gives under load. The knee stays straight; stifle and hock fold together.
const FORE_YIELD: [[f64; 5]; 4] = [
    [0.3, 0.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 0.0, 0.0, 0.5],
];
const HIND_YIELD: [[f64; 5]; 4] = [
    [0.1, 0.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0, 0.0],
    [0.0, 0.0, -1.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 0.0, 0.5],
];

/// What is particular to one channel of one horse: a lasting offset, a strength, a delay, and two small harmonics.
#[derive(Clone, Copy, Debug)]
struct Habit {
    offset: f64,
    strength: f64,
    delay: f64,
    /// Sine and cosine of the second and third harmonic.
    harmonics: [f64; 4],
}

impl Habit {
    fn new(random: &mut Random, offset_sd: f64, harmonic_sd: f64) -> Self {
        Self {
            offset: offset_sd * random.normal().clamp(-2.0, 2.0),
            strength: random.between(0.85, 1.15),
            delay: random.between(-0.03, 0.03),
            harmonics: std::array::from_fn(|_| harmonic_sd * random.normal().clamp(-2.0, 2.0)),
        }
    }

    /// Offset and harmonics at a phase.
    fn ripple(&self, phase: f64) -> f64 {
        let [a, b, c, d] = self.harmonics;
        let ((s2, c2), (s3, c3)) = ((2.0 * TAU * phase).sin_cos(), (3.0 * TAU * phase).sin_cos());
        self.offset + a * s2 + b * c2 + c * s3 + d * c3
    }
}

/// A periodic motion of a horse.
#[derive(Clone, Debug)]
pub(super) struct Motion {
    pub(super) gait: Gait,
    chain: Chain,
    /// One for each bend, then pitch, height, surge and the two slides.
    bends: [Habit; BONE_COUNT],
    pitch: Habit,
    height: Habit,
    surge: Habit,
    slides: [Habit; 2],
    standing_height_m: f64,
    /// Swing of each leg against [`FORE_SWING`] and [`HIND_SWING`].
    reach: [f64; 4],
}

impl Motion {
    pub(super) fn new(gait: Gait, chain: Chain, random: &mut Random) -> Self {
        let bends = std::array::from_fn(|i| {
            // Carriage of the neck differs most between horses; spines hardly differ.
            let (offset_deg, harmonic_deg): (f64, f64) = match i {
                bone::SPINE..=bone::SPINE_LAST => (1.5, 0.4),
                bone::NECK..=bone::HEAD => (5.0, 0.8),
                _ => (3.0, 1.0),
            };
            Habit::new(random, offset_deg.to_radians(), harmonic_deg.to_radians())
        });
        Self {
            gait,
            chain,
            bends,
            pitch: Habit::new(random, 0.02, 0.003),
            height: Habit::new(random, 0.0, 0.002),
            surge: Habit::new(random, 0.0, 0.005),
            slides: [Habit::new(random, 0.01, 0.002), Habit::new(random, 0.01, 0.002)],
            standing_height_m: 0.0,
            reach: [1.0; 4],
        }
    }

    /// Swings each leg so far that its toe ends a stance where it began it, and sets the root's mean height and pitch
    /// so that fore and hind legs reach the ground then.
    pub(super) fn stand_on_the_ground(&mut self) {
        for limb in Limb::ALL {
            for _ in 0..10 {
                let [strike, lift_off] = self.stance_ends(limb);
                let stance_m = self.gait.speed_m_s * self.gait.stride_time_s * self.gait.duty_factor;
                self.reach[limb.index()] *= stance_m / (stance_m - (lift_off[0] - strike[0]));
            }
        }
        let over_ground = Limb::ALL.map(|limb| self.stance_ends(limb).map(|[_, y]| y));
        let fore_m = over_ground[..2].as_flattened().iter().sum::<f64>() / 4.0;
        let hind_m = over_ground[2..].as_flattened().iter().copied().fold(f64::MIN, f64::max);
        let trunk_m: f64 = self.chain.reference_lengths_m[bone::SPINE..=bone::SPINE_LAST].iter().sum();
        self.standing_height_m -= hind_m - STRETCH_M;
        self.pitch.offset -= (fore_m - hind_m) / trunk_m;
    }

    /// Where a leg's toe is at strike and at lift-off without regard to the ground.
    fn stance_ends(&self, limb: Limb) -> [Vec2; 2] {
        [-0.5, 0.5]
            .map(|end| self.free_toe(limb, self.gait.mid_stance[limb.index()] + end * self.gait.duty_factor))
    }

    /// Unknowns of the fit at a phase.
    pub(super) fn pose(&self, phase: f64) -> [f64; PANEL_DOF] {
        let mut pose = self.free_pose(phase);
        for limb in Limb::ALL {
            let print_x = self.print_x(limb, phase);
            let (grounded, stance_phase) = self.gait.grounded(limb, phase);
            let [stance_x, _] = self.free_toe(limb, stance_phase);
            let [x, y] = self.free_toe(limb, phase);
            let over_ground = 0.5 * (y + y.hypot(CLEARANCE_M));
            let target = [x + grounded * (print_x - stance_x), (1.0 - grounded) * over_ground];
            self.reach(&mut pose, limb, target);
        }
        pose
    }

    /// The stance of a leg that began last before a time.
    pub(super) fn last_stance(&self, limb: Limb, time_s: f64) -> Stance {
        let (gait, stride_s) = (&self.gait, self.gait.stride_time_s);
        let strike = gait.mid_stance[limb.index()] - 0.5 * gait.duty_factor;
        let strike_s = (strike + (time_s / stride_s - strike).floor()) * stride_s;
        let stance_s = gait.duty_factor * stride_s;
        let print_x_m = self.print_x(limb, (strike_s + 0.5 * stance_s) / stride_s);
        Stance { strike_s, lift_off_s: strike_s + stance_s, print_x_m }
    }

    /// Where a hoof stands in the stance nearest to a phase: in its middle, as far from hip or shoulder as at rest.
    fn print_x(&self, limb: Limb, phase: f64) -> f64 {
        let (root, toe) = (Attachment::Tip(limb.first_bone()), Attachment::Tip(limb.hoof_bone()));
        let mut standing = [0.0; PANEL_DOF];
        standing[BENDS..SLIDES].copy_from_slice(&self.chain.rest_rad);
        let rest = self.chain.kinematics(&standing, &[0.0; SHARED]);
        let middle = self.free_pose(phase - self.gait.limb_phase(limb, phase));
        let root_x = self.chain.kinematics(&middle, &[0.0; SHARED]).place(root)[0];
        root_x + rest.place(toe)[0] - rest.place(root)[0]
    }

    fn free_toe(&self, limb: Limb, phase: f64) -> Vec2 {
        let kinematics = self.chain.kinematics(&self.free_pose(phase), &[0.0; SHARED]);
        kinematics.place(Attachment::Tip(limb.hoof_bone()))
    }

    /// The harmonics alone, without regard to the ground.
    fn free_pose(&self, phase: f64) -> [f64; PANEL_DOF] {
        let gait = &self.gait;
        let wave = |h: f64, habit: &Habit| (TAU * h * (phase + habit.delay)).cos() * habit.strength;
        let mut pose = [0.0; PANEL_DOF];
        let advance_m = gait.speed_m_s * gait.stride_time_s * phase;
        pose[ROOT_X] = advance_m + self.surge.ripple(phase);
        let bounce_m =
            -gait.bounce_m[0] * wave(1.0, &self.height) - gait.bounce_m[1] * wave(2.0, &self.height);
        pose[ROOT_Y] = self.standing_height_m + bounce_m + self.height.ripple(phase);
        let [first, second] = gait.pitch_deg.map(f64::to_radians);
        pose[PITCH] =
            first * wave(1.0, &self.pitch) + second * wave(2.0, &self.pitch) + self.pitch.ripple(phase);
        for i in 0..BONE_COUNT {
            pose[BENDS + i] = self.chain.rest_rad[i] + self.bends[i].ripple(phase);
        }
        pose[BENDS + bone::SPINE] -= gait.back_deg.to_radians() * wave(1.0, &self.bends[bone::SPINE]);
        // The head nods against the trunk's pitch.
        pose[BENDS + bone::NECK] -= 0.8 * first * wave(1.0, &self.bends[bone::NECK]);
        pose[BENDS + bone::HEAD] -= 0.5 * first * wave(1.0, &self.bends[bone::HEAD]);
        for limb in Limb::ALL {
            self.swing_leg(&mut pose, limb, phase);
        }
        for (side, limb) in [Limb::LF, Limb::RF].into_iter().enumerate() {
            let protraction = -(TAU * gait.limb_phase(limb, phase)).sin();
            pose[SLIDES + side] = 0.015 * protraction + self.slides[side].ripple(phase);
        }
        pose
    }

    /// Swings a leg to and fro, flexes it in the air, and lets the fetlock follow load and cannon.
    fn swing_leg(&self, pose: &mut [f64; PANEL_DOF], limb: Limb, phase: f64) {
        let at = self.gait.limb_phase(limb, phase);
        let first = limb.first_bone();
        let (swing, flexion) = match limb.pair() {
            Pair::Fore => (FORE_SWING, FORE_FLEXION),
            Pair::Hind => (HIND_SWING, HIND_FLEXION),
        };
        let mut turned = [0.0; 4];
        for joint in 0..4 {
            // Stifle and hock have one habit, because the reciprocal apparatus moves them as one.
            let shared = if limb.pair() == Pair::Hind && joint == 3 { 2 } else { joint };
            let habit = &self.bends[first + shared];
            let to_and_fro = -(TAU * (at + habit.delay)).sin();
            let flexed = (0.5 + 0.5 * (TAU * (at + habit.delay - FLEXED_AT)).cos()).powi(2);
            let degrees = self.reach[limb.index()] * swing[joint] * to_and_fro + flexion[joint] * flexed;
            turned[joint] = (degrees * habit.strength).to_radians();
            pose[BENDS + first + joint] += turned[joint];
        }
        let in_the_air = match limb.pair() {
            Pair::Fore => 20f64.to_radians() + 0.5 * turned[3],
            Pair::Hind => (-3f64).to_radians() + 0.5 * turned[1] - 0.6 * turned[3],
        };
        // A fetlock is unloaded soon after lift-off.
        let load = (0.5 + 0.5 * (TAU * at).cos()).powi(2);
        let fetlock = in_the_air + load * (52f64.to_radians() - in_the_air);
        pose[BENDS + first + 4] += fetlock - self.chain.rest_rad[first + 4];
    }

    /// Brings a toe to a place by the least turn of the joints that give under load.
    fn reach(&self, pose: &mut [f64; PANEL_DOF], limb: Limb, target: Vec2) {
        let first = limb.first_bone();
        let toe = Attachment::Tip(limb.hoof_bone());
        let directions = if limb.pair() == Pair::Fore { FORE_YIELD } else { HIND_YIELD };
        let yields = SMatrix::<f64, 5, 4>::from_fn(|joint, k| directions[k][joint]);
        for _ in 0..REACH_STEPS {
            let kinematics = self.chain.kinematics(pose, &[0.0; SHARED]);
            let [x, y] = kinematics.place(toe);
            let miss = Vector2::new(target[0] - x, target[1] - y);
            let mut jacobian = SMatrix::<f64, 2, 5>::zeros();
            self.chain.derivatives(&kinematics, toe, |unknown, [dx, dy]| match unknown {
                Unknown::Panel(dof) if (BENDS + first..BENDS + first + 5).contains(&dof) => {
                    jacobian.set_column(dof - BENDS - first, &Vector2::new(dx, dy));
                }
                Unknown::Panel(_) | Unknown::Shared(_) => {}
            });
            let along = jacobian * yields;
            let square = along * along.transpose() + Matrix2::identity() * REACH_DAMPING;
            let Some(solved) = square.try_inverse().map(|inverse| inverse * miss) else { return };
            let turn = yields * (along.transpose() * solved);
            for joint in 0..5 {
                pose[BENDS + first + joint] += turn[joint];
            }
        }
    }
}
