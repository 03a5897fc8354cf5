//! Whether the horse goes as fast and where it was told to go.

use std::f64::consts::PI;
use std::sync::Arc;

use muybridge_core::{Command, FlatGround, Gait, Horse, MPS_PER_MPH, Repertoire, Turn};

use super::steady::{command, settled, step_to_strike};

/// Whole strides that a mean speed is taken over.
const STRIDES: usize = 4;
/// Steps while it turns, s.
const STEP_S: f32 = 1.0 / 120.0;
/// Time after which a turn must be done, s: half a circle at the walk's least rate.
const TURNING_S: f64 = 40.0;
/// Time that it has gone straight on before its heading is measured, s.
const STRAIGHT_S: f64 = 4.0;

/// A mean speed beside the one that was commanded.
#[derive(Clone, Debug)]
pub struct SpeedRow {
    /// The gait asked for, none where the speed chose.
    pub asked: Option<Gait>,
    /// The gait it went.
    pub gait: Gait,
    /// Commanded speed, mph.
    pub mph: f64,
    /// Mean speed of the root over whole strides less the command, as a share of it.
    pub error: f64,
}

/// Mean speed of the root over whole strides, m/s.
///
/// # Errors
/// When the left hind does not strike.
pub fn mean_speed_m_s(horse: &Horse, command: &Command) -> Result<f64, String> {
    let mut horse = horse.clone();
    step_to_strike(&mut horse, command)?;
    let start = horse.pose().root_in_world;
    let mut time_s = 0.0;
    for _ in 0..STRIDES {
        time_s += step_to_strike(&mut horse, command)?;
    }
    let end = horse.pose().root_in_world;
    let way = (f64::from(end.x) - f64::from(start.x)).hypot(f64::from(end.z) - f64::from(start.z));
    Ok(way / time_s)
}

/// Speed at a commanded one.
///
/// # Errors
/// When the horse takes no steady gait.
pub fn speed_row(repertoire: &Arc<Repertoire>, asked: Option<Gait>, mph: f64) -> Result<SpeedRow, String> {
    let speed_m_s = mph * MPS_PER_MPH;
    let command = command(asked, speed_m_s, None);
    let horse = settled(repertoire, &command, 1)?;
    let error = mean_speed_m_s(&horse, &command)? / speed_m_s - 1.0;
    Ok(SpeedRow { asked, gait: horse.readout().gait, mph, error })
}

/// Where a horse went that was told to turn.
#[derive(Clone, Copy, Debug)]
pub struct HeadingRow {
    /// Gait.
    pub gait: Gait,
    /// Speed, m/s.
    pub speed_m_s: f64,
    /// Wanted heading, rad.
    pub wanted_rad: f64,
    /// Stated heading less the wanted one, rad.
    pub stated_error_rad: f64,
    /// Direction that the root moved in over whole strides less the wanted one, rad.
    pub moved_error_rad: f64,
}

/// An angle brought between minus and plus half a turn.
fn wrapped(angle_rad: f64) -> f64 {
    (angle_rad + PI).rem_euclid(2.0 * PI) - PI
}

/// Turns a steady horse to a heading and measures where it goes then.
///
/// # Errors
/// When it takes no steady gait or does not strike.
pub fn heading_row(
    repertoire: &Arc<Repertoire>,
    gait: Gait,
    speed_m_s: f64,
    turn: Turn,
    wanted_rad: f64,
) -> Result<HeadingRow, String> {
    let straight = command(Some(gait), speed_m_s, None);
    let mut horse = settled(repertoire, &straight, 1)?;
    let turning = Command { turn, ..straight };
    let (mut time_s, mut since_s) = (0.0, 0.0);
    while time_s < TURNING_S && since_s < STRAIGHT_S {
        horse.step(&turning, STEP_S, &FlatGround);
        time_s += f64::from(STEP_S);
        let straight_now = horse.readout().turn_rate_rad_s.abs() < 1e-3;
        since_s = if straight_now && time_s > 1.0 { since_s + f64::from(STEP_S) } else { 0.0 };
    }
    step_to_strike(&mut horse, &turning)?;
    let start = horse.pose().root_in_world;
    for _ in 0..STRIDES {
        step_to_strike(&mut horse, &turning)?;
    }
    let end = horse.pose().root_in_world;
    let moved_rad = (f64::from(start.z) - f64::from(end.z)).atan2(f64::from(end.x) - f64::from(start.x));
    Ok(HeadingRow {
        gait,
        speed_m_s,
        wanted_rad,
        stated_error_rad: wrapped(horse.readout().heading_rad - wanted_rad),
        moved_error_rad: wrapped(moved_rad - wanted_rad),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_compared_by_the_shorter_way() {
        assert!((wrapped(2.0 * PI + 0.1) - 0.1).abs() < 1e-12);
        assert!((wrapped(-PI - 0.1) - (PI - 0.1)).abs() < 1e-12);
    }
}
