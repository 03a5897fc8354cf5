//! The colours of which feet are down, and their words.

use muybridge_footprints::{Foot, Support};

use super::sheet::Color;

/// Colours of the paper's figures, a little calmer: right, left, both, none.
const RIGHT: Color = [208, 32, 38];
const LEFT: Color = [190, 40, 178];
const BOTH: Color = [28, 38, 134];
const FLIGHT: Color = [118, 178, 236];
/// One to four hooves.
const HOOVES: [Color; 4] = [[222, 138, 32], [190, 40, 90], [28, 38, 134], [24, 110, 84]];

/// The colour of a support.
pub(super) fn color(down: &[Foot]) -> Color {
    match down {
        [] => FLIGHT,
        [Foot::Left] => LEFT,
        [Foot::Right] => RIGHT,
        [Foot::Left, Foot::Right] => BOTH,
        more => HOOVES[(more.len() - 1).min(3)],
    }
}

/// The colour of a foot in a timing diagram.
pub(super) fn foot_color(foot: Foot) -> Color {
    match foot {
        Foot::Left => LEFT,
        Foot::Right => RIGHT,
        Foot::LeftFore => [188, 94, 30],
        Foot::RightFore => [222, 150, 60],
        Foot::LeftHind => [36, 76, 140],
        Foot::RightHind => [88, 140, 200],
    }
}

/// What the colours of supports mean, for those that occur.
pub(super) fn legend(supports: &[Support]) -> Vec<(Color, String)> {
    let words = |down: &[Foot]| match down {
        [] => "flight".to_string(),
        [Foot::Left] => "left stance".to_string(),
        [Foot::Right] => "right stance".to_string(),
        [Foot::Left, Foot::Right] => "double stance".to_string(),
        [_] => "one hoof down".to_string(),
        more => format!("{} hooves down", more.len()),
    };
    let mut entries: Vec<(usize, Color, String)> = Vec::new();
    for support in supports {
        let entry = (support.down.len(), color(&support.down), words(&support.down));
        if !entries.contains(&entry) {
            entries.push(entry);
        }
    }
    entries.sort_by(|a, b| (b.0, &b.2).cmp(&(a.0, &a.2)));
    entries.into_iter().map(|(_, color, words)| (color, words)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hop_has_four_meanings_most_feet_first() {
        let support = |down: &[Foot]| Support { from_s: 0.0, to_s: 1.0, down: down.to_vec() };
        let (left, right) = (Foot::Left, Foot::Right);
        let all = [&[left][..], &[left, right], &[right], &[], &[left]].map(support);
        let meanings: Vec<String> = legend(&all).into_iter().map(|(_, words)| words).collect();
        assert_eq!(meanings, ["double stance", "right stance", "left stance", "flight"]);
    }
}
