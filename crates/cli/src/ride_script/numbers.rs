//! The numbers of a ride script, each held to what it can be while the reader still knows line and column.

use std::ops::RangeInclusive;

use serde::{Deserialize, Deserializer, de};

/// Ranges are wide: the horse holds itself to what it can do, and only what must be a slip of the pen is refused.
pub(super) const STEP_S: RangeInclusive<f64> = 0.1..=super::LONGEST_RIDE_S;
const SPEED_M_S: RangeInclusive<f64> = 0.0..=30.0;
const SPEED_MPH: RangeInclusive<f64> = 0.0..=60.0;
const TURN_DEG_S: RangeInclusive<f64> = -360.0..=360.0;
const HEADING_DEG: RangeInclusive<f64> = -3600.0..=3600.0;
const PLACE_M: RangeInclusive<f64> = -10_000.0..=10_000.0;
/// Factors of bone lengths: from a toy to an elephant.
pub const RIDE_FACTORS: RangeInclusive<f64> = 0.2..=3.0;
const LEAP_HEIGHT_M: RangeInclusive<f64> = 0.05..=3.0;
const LEAP_LENGTH_M: RangeInclusive<f64> = 0.0..=15.0;

/// A number within a range, with words for what is wrong with others.
fn within<'de, D: Deserializer<'de>>(
    deserializer: D,
    range: &RangeInclusive<f64>,
    unit: &str,
) -> Result<f64, D::Error> {
    let number = f64::deserialize(deserializer)?;
    let (least, most) = (range.start(), range.end());
    if range.contains(&number) {
        Ok(number)
    } else {
        Err(de::Error::custom(format!("{number} is out of range; it is between {least} and {most} {unit}")))
    }
}

/// Duration of a step, s.
pub(super) fn step_s<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    within(deserializer, &STEP_S, "s")
}

/// Speed, m/s.
pub(super) fn speed_m_s<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    within(deserializer, &SPEED_M_S, "m/s").map(Some)
}

/// Speed, mph.
pub(super) fn speed_mph<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    within(deserializer, &SPEED_MPH, "mph").map(Some)
}

/// Turn rate, degrees/s.
pub(super) fn turn_deg_s<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    within(deserializer, &TURN_DEG_S, "degrees/s").map(Some)
}

/// Heading to turn to, degrees.
pub(super) fn to_heading_deg<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
    within(deserializer, &HEADING_DEG, "degrees").map(Some)
}

/// Heading, degrees.
pub(super) fn heading_deg<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f32, D::Error> {
    within(deserializer, &HEADING_DEG, "degrees").map(|degrees| degrees as f32)
}

/// Place, m.
pub(super) fn place_m<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    within(deserializer, &PLACE_M, "m")
}

/// Factor of lengths.
pub(super) fn factor<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f32, D::Error> {
    within(deserializer, &RIDE_FACTORS, "times the length").map(|factor| factor as f32)
}

/// The factor that changes nothing.
pub(super) fn one() -> f32 {
    1.0
}

/// Height of a leap, m.
pub(super) fn leap_height_m<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f32, D::Error> {
    within(deserializer, &LEAP_HEIGHT_M, "m").map(|metres| metres as f32)
}

/// Length of a leap, m.
pub(super) fn leap_length_m<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f32, D::Error> {
    within(deserializer, &LEAP_LENGTH_M, "m").map(|metres| metres as f32)
}
