//! What no rider would ask, no clock would tell and no ground would be: the horse stays finite and is itself again soon.

use std::sync::Arc;

use muybridge_core::{Command, FlatGround, Gait, Horse, Leap, MPS_PER_MPH, Repertoire, Turn};

use super::findings::Limits;
use super::inspector::{Inspector, numbers_missing};
use super::terrain::Terrain;

/// Steps of the sane time before and after, s.
const STEP_S: f32 = 1.0 / 60.0;
/// Sane time before, s.
const BEFORE_S: f64 = 4.0;
/// Hostile steps.
const STEPS: usize = 240;
/// Sane time after which the horse must be itself again, s.
pub const RECOVERY_S: f64 = 10.0;
/// Time that is then inspected, s.
const INSPECTED_S: f64 = 3.0;
/// The speed must then be the commanded one to this share over a step.
const SPEED_SHARE: f32 = 0.05;
/// Sane speed, mph.
const SANE_MPH: f64 = 12.0;

/// A hostile input.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Hostile {
    /// Time steps, s.
    Dt(f32),
    /// A wanted speed, m/s.
    Speed(f32),
    /// A wanted turn.
    Turning(Turn),
    /// A wanted leap.
    Leaping(Leap),
    /// The leap as a gait.
    LeapAsGait,
    /// A ground.
    On(Terrain),
    /// All gaits in turn, another one each step, the speed from one end to the other.
    Restless,
    /// The last of everything at once.
    Everything,
}

/// Every hostile input that is tried.
pub fn all() -> Vec<Hostile> {
    let strange = [
        0.0,
        -1.0,
        -0.0,
        1e9,
        1e-30,
        f32::MIN_POSITIVE,
        f32::MAX,
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
    ];
    let speeds = [1e9, -5.0, 0.0, 1e-30, f32::MAX, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let headings = [f32::NAN, f32::INFINITY, 1e9, f32::MAX];
    let turns = headings
        .into_iter()
        .flat_map(|angle| [Turn::Heading(angle), Turn::Rate(angle), Turn::Rate(-angle)])
        .chain([Turn::Steps(i32::MAX), Turn::Steps(i32::MIN)]);
    let leaps = [
        [f32::NAN, 1.0],
        [1.0, f32::NAN],
        [1e9, 1e9],
        [-1.0, -1.0],
        [f32::INFINITY, 0.0],
        [0.0, f32::INFINITY],
    ];
    let grounds = [
        Terrain::Level(f32::NAN),
        Terrain::Level(f32::INFINITY),
        Terrain::Level(f32::NEG_INFINITY),
        Terrain::Level(1e9),
        Terrain::Level(-1e9),
        Terrain::Level(f32::MAX),
        Terrain::Holes,
        Terrain::Cliffs,
        Terrain::Slope([1e6, 0.0]),
        Terrain::Slope([3.0, -3.0]),
        Terrain::Slope([f32::NAN, 0.0]),
    ];
    let mut all: Vec<Hostile> = strange.into_iter().map(Hostile::Dt).collect();
    all.extend(speeds.into_iter().map(Hostile::Speed));
    all.extend(turns.map(Hostile::Turning));
    all.extend(leaps.into_iter().map(|[height_m, length_m]| Hostile::Leaping(Leap { height_m, length_m })));
    all.extend(grounds.into_iter().map(Hostile::On));
    all.extend([Hostile::LeapAsGait, Hostile::Restless, Hostile::Everything]);
    all
}

fn sane() -> Command {
    Command { speed_m_s: (SANE_MPH * MPS_PER_MPH) as f32, gait: Some(Gait::Trot), ..Command::default() }
}

impl Hostile {
    /// The input of a step.
    fn input(self, step: usize) -> (Command, f32, Terrain) {
        let (mut command, mut dt_s, mut ground) = (sane(), STEP_S, Terrain::Flat);
        match self {
            Self::Dt(strange) => dt_s = strange,
            Self::Speed(speed) => command.speed_m_s = speed,
            Self::Turning(turn) => command.turn = turn,
            // Asked for anew every half second.
            Self::Leaping(leap) => command.leap = (step / 15).is_multiple_of(2).then_some(leap),
            Self::LeapAsGait => command.gait = Some(Gait::Leap),
            Self::On(terrain) => ground = terrain,
            Self::Restless => {
                command.gait = Some(Gait::ALL[step % 6]);
                command.speed_m_s = [0.0, 18.0, 2.0][step % 3];
            }
            Self::Everything => {
                let all = [f32::NAN, f32::INFINITY, -1e9, 1e9];
                dt_s = [STEP_S, f32::NAN, 1e9, -1.0][step % 4];
                command.speed_m_s = all[step % 4];
                command.turn = Turn::Rate(all[(step + 1) % 4]);
                command.gait = Some(Gait::ALL[step % 7]);
                let number = all[(step + 2) % 4];
                command.leap = Some(Leap { height_m: number, length_m: number });
                ground = Terrain::Level(all[step / 7 % 4]);
            }
        }
        (command, dt_s, ground)
    }

    /// Rides through it.
    ///
    /// # Errors
    /// In plain words, when a number is none, or the horse is not itself again in time.
    pub fn ride(self, repertoire: &Arc<Repertoire>) -> Result<(), String> {
        let mut horse = Horse::of(Arc::clone(repertoire), 7);
        let flat_steps = |seconds: f64| (seconds / f64::from(STEP_S)) as usize;
        for _ in 0..flat_steps(BEFORE_S) {
            horse.step(&sane(), STEP_S, &FlatGround);
        }
        for step in 0..STEPS {
            let (command, dt_s, ground) = self.input(step);
            horse.step(&command, dt_s, &ground);
            if !is_finite(&horse) {
                return Err(format!("{self:?}: no number after {} hostile steps", step + 1));
            }
        }
        for step in 0..flat_steps(RECOVERY_S) {
            horse.step(&sane(), STEP_S, &FlatGround);
            if !is_finite(&horse) {
                return Err(format!("{self:?}: no number after {} sane steps", step + 1));
            }
        }
        self.recovered(horse)
    }

    /// A clean trot from now on.
    fn recovered(self, mut horse: Horse) -> Result<(), String> {
        let mut inspector = Inspector::new(horse.skeleton());
        for _ in 0..(INSPECTED_S / f64::from(STEP_S)) as usize {
            horse.step(&sane(), STEP_S, &FlatGround);
            inspector.look(&horse, STEP_S, &FlatGround);
        }
        let seen = horse.readout();
        let mut faults: Vec<String> =
            inspector.findings().broken(&Limits::flat()).iter().map(ToString::to_string).collect();
        if seen.gait != Gait::Trot || seen.change.is_some() || seen.is_standing {
            faults.push(format!("{} (change {:?}, standing {})", seen.gait, seen.change, seen.is_standing));
        }
        if (seen.speed_m_s / sane().speed_m_s - 1.0).abs() > SPEED_SHARE {
            faults.push(format!("{:.2} m/s of {:.2}", seen.speed_m_s, sane().speed_m_s));
        }
        if faults.is_empty() {
            Ok(())
        } else {
            Err(format!("{self:?}, {RECOVERY_S} s after: {}", faults.join("; ")))
        }
    }
}

fn is_finite(horse: &Horse) -> bool {
    numbers_missing(horse.pose(), &horse.readout()) == 0
}
