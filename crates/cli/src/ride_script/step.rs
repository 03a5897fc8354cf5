//! One step of a ride script: a command and how long it holds.

use muybridge_core::{Gait, Leap, MPS_PER_MPH, Side, Turn};
use serde::Deserialize;

use super::numbers;

/// A command that holds for a time.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(try_from = "StepFile")]
pub struct RideStep {
    /// How long, s.
    pub for_s: f64,
    /// Wanted speed, m/s; none to keep what was wanted before.
    pub speed_m_s: Option<f32>,
    /// Wanted gait; none lets the speed choose.
    pub gait: Option<Gait>,
    /// Wanted lead at canter and gallop; none lets the turn choose.
    pub lead: Option<Side>,
    /// Wanted turn; straight on where the script says nothing.
    pub turn: Turn,
    /// A leap, taken once.
    pub leap: Option<Leap>,
    /// A remark for people.
    pub note: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StepFile {
    #[serde(deserialize_with = "numbers::step_s")]
    for_s: f64,
    #[serde(default, deserialize_with = "numbers::speed_m_s")]
    speed_m_s: Option<f64>,
    #[serde(default, deserialize_with = "numbers::speed_mph")]
    speed_mph: Option<f64>,
    #[serde(default)]
    gait: Option<Gait>,
    #[serde(default)]
    lead: Option<Side>,
    #[serde(default, deserialize_with = "numbers::turn_deg_s")]
    turn_deg_s: Option<f64>,
    #[serde(default, deserialize_with = "numbers::to_heading_deg")]
    heading_deg: Option<f64>,
    #[serde(default)]
    leap: Option<LeapFile>,
    #[serde(default)]
    note: Option<String>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LeapFile {
    #[serde(deserialize_with = "numbers::leap_height_m")]
    height_m: f32,
    #[serde(deserialize_with = "numbers::leap_length_m")]
    length_m: f32,
}

impl TryFrom<StepFile> for RideStep {
    type Error = String;

    fn try_from(file: StepFile) -> Result<Self, String> {
        let speed_m_s = match (file.speed_m_s, file.speed_mph) {
            (Some(_), Some(_)) => return Err("speed_m_s and speed_mph in one step; give one of them".into()),
            (Some(speed), None) => Some(speed as f32),
            (None, mph) => mph.map(|mph| (mph * MPS_PER_MPH) as f32),
        };
        let turn = match (file.turn_deg_s, file.heading_deg) {
            (Some(_), Some(_)) => {
                return Err("turn_deg_s and heading_deg in one step; give one of them".into());
            }
            (Some(rate), None) => Turn::Rate(rate.to_radians() as f32),
            (None, Some(heading)) => Turn::Heading(heading.to_radians() as f32),
            (None, None) => Turn::default(),
        };
        if file.gait == Some(Gait::Leap) {
            return Err(
                "gait: a leap is asked for by \"leap\": { \"height_m\": 0.6, \"length_m\": 3 }".into()
            );
        }
        let leap = file.leap.map(|LeapFile { height_m, length_m }| Leap { height_m, length_m });
        let (for_s, gait, lead, note) = (file.for_s, file.gait, file.lead, file.note);
        Ok(Self { for_s, speed_m_s, gait, lead, turn, leap, note })
    }
}
