//! Comparison with files that hold what a program should print; `UPDATE_GOLDEN=1` writes them anew.

use crate::{repository, write};

/// Units of the last printed digit by which a number may differ: another processor may round otherwise.
const UNITS: f64 = 2.0;
/// Decimals compared at most; what follows them is arithmetic noise, not a result.
const MOST_DECIMALS: i32 = 9;

/// Compares a text with `tests/golden/<name>`: words and lay-out exactly, numbers within two units of the last digit.
///
/// # Panics
/// When they differ, with the first line that does.
#[track_caller]
pub fn assert_golden(name: &str, text: &str) {
    let path = repository().join("tests/golden").join(name);
    if std::env::var_os("UPDATE_GOLDEN").is_some_and(|value| value == "1") {
        write(&path, text);
        return;
    }
    let hint = "if the change is meant, run the tests with UPDATE_GOLDEN=1 and commit the file";
    let golden = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{name}: {error}; {hint}"));
    for (number, (expected, found)) in golden.lines().zip(text.lines()).enumerate() {
        let line = number + 1;
        assert!(same(expected, found), "{name}, line {line}:\nexpected {expected}\nfound    {found}\n{hint}");
    }
    assert_eq!(golden.lines().count(), text.lines().count(), "{name}: number of lines; {hint}");
}

fn same(expected: &str, found: &str) -> bool {
    let (expected, found) = (pieces(expected), pieces(found));
    expected.len() == found.len() && expected.iter().zip(&found).all(|(a, b)| a == b || close(a, b))
}

/// A line cut where numbers begin and end.
fn pieces(line: &str) -> Vec<&str> {
    let mut cuts = vec![0];
    let mut inside = false;
    for (at, character) in line.char_indices() {
        let numeric = character.is_ascii_digit() || (inside && character == '.');
        if numeric != inside {
            cuts.push(at);
            inside = numeric;
        }
    }
    cuts.push(line.len());
    cuts.windows(2).map(|two| &line[two[0]..two[1]]).collect()
}

/// Numbers of equally many printed decimals, within [`UNITS`] of the last.
fn close(a: &str, b: &str) -> bool {
    let decimals = |text: &str| text.split_once('.').map_or(0, |(_, fraction)| fraction.len() as i32);
    let (Ok(x), Ok(y)) = (a.parse::<f64>(), b.parse::<f64>()) else { return false };
    // Only fractions are results; a whole number is a count or a name.
    let kept = decimals(a).min(MOST_DECIMALS);
    let comparable = kept > 0 && kept == decimals(b).min(MOST_DECIMALS);
    comparable && (x - y).abs() <= (UNITS + 0.1) * 10f64.powi(-kept)
}

#[cfg(test)]
mod tests {
    use super::same;

    #[test]
    fn only_the_last_digit_may_differ() {
        assert!(same("stride 0.412 ± 0.021 (12)", "stride 0.414 ± 0.020 (12)"));
        assert!(!same("stride 0.412", "stride 0.415"));
        assert!(!same("stride 0.412", "stride 0.41"));
        assert!(!same("panel 4", "panel 5"));
        assert!(!same("walk 0.412", "trot 0.412"));
        assert!(same("1.6881120787286406", "1.68811207872864"));
    }
}
