//! Curves as one line of text: steps of a ten-thousandth as 16-bit integers, little-endian, in base 64.
//!
//! The first character says how often the step is doubled: not at all (`A`) for any horse; curves that swing wider than three
//! metres, as of a plate whose scale is wrong, are kept more coarsely.
//!
//! A ten-thousandth of a radian moves the end of a leg of a metre by a tenth of a millimetre; 33 curves of 48 samples take 4 kB
//! and are read in microseconds, where decimal numbers took five times as much of either.

use std::fmt;

use serde::de::Visitor;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::skeleton::BONE_COUNT;
use crate::stride::{CHANNEL_COUNT, CURVE_SAMPLES, Curves};

/// What one step is worth, metres or radians.
pub const CURVE_STEP: f32 = 1e-4;

/// Bytes of all channels; a multiple of three, so that base 64 needs no padding.
const BYTES: usize = 2 * CHANNEL_COUNT * CURVE_SAMPLES;
const _: () = assert!(BYTES.is_multiple_of(3));
/// Characters of the text.
const LENGTH: usize = 1 + BYTES / 3 * 4;
/// Doublings of the step that are never needed: values beyond a million.
const MOST_DOUBLINGS: i32 = 20;
const ALPHABET: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

impl Serialize for Curves {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let fits = |doublings: &i32| {
            let most = f32::from(i16::MAX) * CURVE_STEP * 2f32.powi(*doublings);
            self.channels().flatten().all(|value| value.abs() <= most)
        };
        let Some(doublings) = (0..MOST_DOUBLINGS).find(fits) else {
            return Err(serde::ser::Error::custom("a curve's value is no number, or beyond a million"));
        };
        let step = CURVE_STEP * 2f32.powi(doublings);
        let mut bytes = Vec::with_capacity(BYTES);
        for value in self.channels().flatten() {
            bytes.extend(((value / step).round() as i16).to_le_bytes());
        }
        let mut text = String::with_capacity(LENGTH);
        text.push(char::from(ALPHABET[doublings as usize]));
        for three in bytes.chunks(3) {
            let word = three.iter().fold(0u32, |word, byte| word << 8 | u32::from(*byte));
            for shift in [18, 12, 6, 0] {
                text.push(char::from(ALPHABET[(word >> shift & 63) as usize]));
            }
        }
        serializer.serialize_str(&text)
    }
}

impl<'de> Deserialize<'de> for Curves {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_str(Unpack)
    }
}

struct Unpack;

impl Visitor<'_> for Unpack {
    type Value = Curves;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{CHANNEL_COUNT} curves of {CURVE_SAMPLES} samples as {LENGTH} characters")
    }

    fn visit_str<E: serde::de::Error>(self, text: &str) -> Result<Curves, E> {
        let (doublings, bytes) =
            decode(text).ok_or_else(|| E::invalid_value(serde::de::Unexpected::Str("..."), &self))?;
        let step = CURVE_STEP * 2f32.powi(doublings);
        let values = bytes.chunks_exact(2).map(|two| f32::from(i16::from_le_bytes([two[0], two[1]])) * step);
        let values: Vec<f32> = values.collect();
        let mut channels = values.chunks_exact(CURVE_SAMPLES).map(<[f32]>::to_vec);
        let mut next = || channels.next().unwrap_or_default();
        Ok(Curves {
            surge_m: next(),
            height_m: next(),
            pitch_rad: next(),
            bends_rad: (0..BONE_COUNT).map(|_| next()).collect(),
            scapula_slides_m: vec![next(), next()],
        })
    }
}

/// Doublings of the step and the bytes, of a text of the right length and alphabet.
fn decode(text: &str) -> Option<(i32, Vec<u8>)> {
    const NONE: u8 = 64;
    const VALUES: [u8; 256] = {
        let mut values = [NONE; 256];
        let mut i = 0;
        while i < ALPHABET.len() {
            values[ALPHABET[i] as usize] = i as u8;
            i += 1;
        }
        values
    };
    let (first, rest) = text.as_bytes().split_first()?;
    let doublings = i32::from(VALUES[usize::from(*first)]);
    if text.len() != LENGTH || doublings >= MOST_DOUBLINGS {
        return None;
    }
    let mut bytes = Vec::with_capacity(BYTES);
    for four in rest.chunks_exact(4) {
        let digits = [0, 1, 2, 3].map(|i| VALUES[usize::from(four[i])]);
        if digits.contains(&NONE) {
            return None;
        }
        let word = digits.iter().fold(0u32, |word, digit| word << 6 | u32::from(*digit));
        bytes.extend([(word >> 16) as u8, (word >> 8) as u8, word as u8]);
    }
    Some((doublings, bytes))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curves() -> Curves {
        let curve = |offset: usize| -> Vec<f32> {
            (0..CURVE_SAMPLES).map(|k| ((k * 7 + offset * 13) as f32).sin() * 3.2).collect()
        };
        Curves {
            surge_m: curve(0),
            height_m: curve(1),
            pitch_rad: curve(2),
            bends_rad: (0..BONE_COUNT).map(|i| curve(3 + i)).collect(),
            scapula_slides_m: vec![curve(40), curve(41)],
        }
    }

    #[test]
    fn curves_come_back_within_half_a_step_and_then_exactly() {
        let written = serde_json::to_string(&curves()).unwrap();
        let read: Curves = serde_json::from_str(&written).unwrap();
        for (a, b) in curves().channels().flatten().zip(read.channels().flatten()) {
            assert!((a - b).abs() <= 0.5001 * CURVE_STEP, "{a} {b}");
        }
        assert_eq!(serde_json::to_string(&read).unwrap(), written);
    }

    #[test]
    fn other_texts_are_refused_with_what_is_expected() {
        let written = serde_json::to_string(&curves()).unwrap();
        for wrong in
            [r#""""#.to_string(), written.replace("A\"", "?\""), written.replacen('A', "", 1), "[]".into()]
        {
            if wrong != written {
                assert!(serde_json::from_str::<Curves>(&wrong).is_err());
            }
        }
        let mut far = curves();
        far.height_m[3] = 40.0;
        let back: Curves = serde_json::from_str(&serde_json::to_string(&far).unwrap()).unwrap();
        assert!((back.height_m[3] - 40.0).abs() < 1e-2, "kept, if coarsely");
        far.height_m[3] = f32::NAN;
        assert!(serde_json::to_string(&far).is_err());
    }
}
