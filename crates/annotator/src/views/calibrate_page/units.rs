//! Units a person types numbers in; the files are in metres, seconds and metres per second.

/// A unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    Metre,
    Centimetre,
    Millimetre,
    Foot,
    Inch,
    /// Of four inches. Horse people write inches after the point: 15.3 are fifteen hands and three inches.
    Hand,
    Second,
    Millisecond,
    MetrePerSecond,
    KilometrePerHour,
    MilePerHour,
    /// A plain number, of what the name says.
    Plain,
}

/// Metres of an inch, by definition.
const INCH_M: f64 = 0.0254;
/// Inches of a hand.
const HAND_IN: f64 = 4.0;
/// Metres of a mile, by definition.
const MILE_M: f64 = 1609.344;
/// Digits after the point with which a number between 1 and 10 is shown.
const DIGITS: i32 = 4;

/// Units of lengths, the file's first.
pub(super) const LENGTHS: &[Unit] =
    &[Unit::Metre, Unit::Centimetre, Unit::Millimetre, Unit::Foot, Unit::Inch, Unit::Hand];
/// Units of durations, the file's first.
pub(super) const DURATIONS: &[Unit] = &[Unit::Second, Unit::Millisecond];
/// Units of speeds, the file's first.
pub(super) const SPEEDS: &[Unit] = &[Unit::MetrePerSecond, Unit::KilometrePerHour, Unit::MilePerHour];
/// Numbers without a unit.
pub(super) const PLAIN: &[Unit] = &[Unit::Plain];

impl Unit {
    /// Its sign; empty for plain numbers.
    pub(super) fn sign(self) -> &'static str {
        match self {
            Self::Metre => "m",
            Self::Centimetre => "cm",
            Self::Millimetre => "mm",
            Self::Foot => "ft",
            Self::Inch => "in",
            Self::Hand => "hands",
            Self::Second => "s",
            Self::Millisecond => "ms",
            Self::MetrePerSecond => "m/s",
            Self::KilometrePerHour => "km/h",
            Self::MilePerHour => "mph",
            Self::Plain => "",
        }
    }

    /// One of it in the file's unit.
    fn size(self) -> f64 {
        match self {
            Self::Metre | Self::Second | Self::MetrePerSecond | Self::Plain => 1.0,
            Self::Centimetre => 0.01,
            Self::Millimetre | Self::Millisecond => 0.001,
            Self::Foot => 12.0 * INCH_M,
            Self::Inch => INCH_M,
            Self::Hand => HAND_IN * INCH_M,
            Self::KilometrePerHour => 1.0 / 3.6,
            Self::MilePerHour => MILE_M / 3600.0,
        }
    }

    /// A value in the file's unit, as it is typed in this one.
    pub(super) fn text(self, value: f64) -> String {
        if self == Self::Hand {
            // Hundredths of an inch first, so that 3.999 inches become the next hand.
            let hundredths = (value / INCH_M * 100.0).round();
            let (sign, hundredths) = (if hundredths < 0.0 { "-" } else { "" }, hundredths.abs());
            let hands = (hundredths / (100.0 * HAND_IN)).floor();
            let inches = hundredths - 100.0 * HAND_IN * hands;
            let text = format!("{sign}{hands:.0}.{inches:03.0}");
            return text.trim_end_matches('0').trim_end_matches('.').into();
        }
        number(value / self.size())
    }

    /// What was typed, in the file's unit. A comma may be the point, and `1/25` is a number.
    ///
    /// # Errors
    /// In words, when it is no number.
    pub(super) fn value(self, text: &str) -> Result<f64, String> {
        let text = text.trim().replace(',', ".");
        let value = match self {
            Self::Hand => hands_in(&text)? * INCH_M,
            _ => plain(&text)? * self.size(),
        };
        if value.is_finite() { Ok(value) } else { Err(format!("{text:?} is not a number")) }
    }
}

fn plain(text: &str) -> Result<f64, String> {
    let parse = |part: &str| part.trim().parse::<f64>().ok().filter(|value| value.is_finite());
    let value = match text.split_once('/') {
        Some((over, under)) => parse(over).zip(parse(under)).map(|(over, under)| over / under),
        None => parse(text),
    };
    match value {
        Some(value) => Ok(value),
        None if text.is_empty() => Err("Type a number".into()),
        None => Err(format!("{text:?} is not a number")),
    }
}

/// Inches of `15.3`: what is after the point are inches, then their decimals.
fn hands_in(text: &str) -> Result<f64, String> {
    let (hands, after) = text.split_once('.').unwrap_or((text, ""));
    let (sign, hands) = hands.strip_prefix('-').map_or((1.0, hands), |rest| (-1.0, rest));
    let hands = plain(if hands.is_empty() && !after.is_empty() { "0" } else { hands })?;
    if hands.is_sign_negative() {
        return Err(format!("{text:?} is not a number"));
    }
    if after.is_empty() {
        return Ok(sign * HAND_IN * hands);
    }
    let refusal = || "After the point of hands are inches: .0, .1, .2 or .3".to_string();
    let mut digits = after.chars();
    let inch = digits.next().filter(|digit| ('0'..='3').contains(digit)).ok_or_else(refusal)?;
    let decimals = digits.as_str();
    if !decimals.chars().all(|digit| digit.is_ascii_digit()) {
        return Err(refusal());
    }
    Ok(sign * (HAND_IN * hands + plain(&format!("{inch}.{decimals}0"))?))
}

/// A number with [`DIGITS`] digits after its first, without idle zeros.
pub(super) fn number(value: f64) -> String {
    let size = if value == 0.0 { 0 } else { value.abs().log10().floor() as i32 };
    let digits = (DIGITS - size).clamp(0, 9) as usize;
    let text = format!("{value:.digits$}");
    match text.contains('.') {
        true => text.trim_end_matches('0').trim_end_matches('.').into(),
        false => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_shown_can_be_typed_again() {
        for units in [LENGTHS, DURATIONS, SPEEDS, PLAIN] {
            for unit in units {
                for value in [0.6858, 1.6, 0.04, 16.09344, 12.0, 0.0, 0.305, 1.5239] {
                    let again = unit.value(&unit.text(value)).unwrap();
                    let limit = if *unit == Unit::Hand { 2e-4 } else { 1e-4 * value + 1e-9 };
                    assert!((again - value).abs() <= limit, "{unit:?}: {value}, again {again}");
                }
            }
        }
    }

    #[test]
    fn units_are_the_defined_ones() {
        assert!((Unit::Inch.value("27").unwrap() - 0.6858).abs() < 1e-12);
        assert!((Unit::Foot.value("2,25").unwrap() - 0.6858).abs() < 1e-12);
        assert!((Unit::Second.value("1/25").unwrap() - 0.04).abs() < 1e-12);
        assert!((Unit::MilePerHour.value("36").unwrap() - 16.09344).abs() < 1e-9);
        assert_eq!(Unit::Foot.text(0.6858), "2.25");
    }

    #[test]
    fn hands_have_inches_after_the_point() {
        assert!((Unit::Hand.value("15.3").unwrap() - 63.0 * INCH_M).abs() < 1e-12);
        assert!((Unit::Hand.value("15.25").unwrap() - 62.5 * INCH_M).abs() < 1e-12);
        assert_eq!(Unit::Hand.text(63.0 * INCH_M), "15.3");
        assert_eq!(Unit::Hand.text(64.0 * INCH_M), "16");
        assert!(Unit::Hand.value("15.4").is_err() && Unit::Hand.value("15.3 and").is_err());
    }

    #[test]
    fn what_is_no_number_is_refused_in_words() {
        for text in ["", "abc", "1e400", "nan", "inf", "1/0", "/", "1//2", "1.2.3", "-", "--1", "é"] {
            for units in [LENGTHS, DURATIONS, SPEEDS] {
                assert!(units.iter().all(|unit| unit.value(text).is_err()), "{text:?}");
            }
        }
    }
}
