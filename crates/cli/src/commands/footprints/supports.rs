//! Which feet are down when, and the colours of that.

use muybridge_footprints::{Foot, Placed};

use super::sheet::Color;

/// Colours of the paper's figures, a little calmer: right, left, both, none.
const RIGHT: Color = [208, 32, 38];
const LEFT: Color = [190, 40, 178];
const BOTH: Color = [28, 38, 134];
const FLIGHT: Color = [118, 178, 236];
/// One to four hooves.
const HOOVES: [Color; 4] = [[222, 138, 32], [190, 40, 90], [28, 38, 134], [24, 110, 84]];
/// Times as near as this are one, s.
const SAME_S: f64 = 1e-9;

/// A time in which the same feet are down.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Support {
    pub(super) from_s: f64,
    pub(super) to_s: f64,
    /// Feet that are down, in their order.
    pub(super) down: Vec<Foot>,
}

/// The feet that are down at a time.
pub(super) fn feet_down(placed: &Placed, time_s: f64) -> Vec<Foot> {
    Sweep::new(placed).down(time_s)
}

/// The whole motion in times of equal support.
pub(super) fn supports(placed: &Placed) -> Vec<Support> {
    let mut changes: Vec<f64> =
        placed.prints.iter().flat_map(|print| [print.strike_s, print.lift_off_s]).collect();
    changes.extend([0.0, placed.end_s]);
    changes.retain(|time_s| (0.0..=placed.end_s).contains(time_s));
    changes.sort_by(f64::total_cmp);
    changes.dedup_by(|a, b| (*a - *b).abs() < SAME_S);
    let mut all: Vec<Support> = Vec::new();
    // A print is down from its strike: of many prints only those near a time can be.
    let mut sweep = Sweep::new(placed);
    for pair in changes.windows(2) {
        let down = sweep.down(0.5 * (pair[0] + pair[1]));
        match all.last_mut() {
            Some(last) if last.down == down => last.to_s = pair[1],
            _ => all.push(Support { from_s: pair[0], to_s: pair[1], down }),
        }
    }
    all
}

/// Goes through the prints once, in the order of their strikes.
pub(super) struct Sweep<'a> {
    placed: &'a Placed,
    next: usize,
    standing: Vec<(Foot, f64)>,
}

impl<'a> Sweep<'a> {
    pub(super) fn new(placed: &'a Placed) -> Self {
        Self { placed, next: 0, standing: Vec::new() }
    }

    /// The feet down at a time, not before those asked for earlier.
    pub(super) fn down(&mut self, time_s: f64) -> Vec<Foot> {
        // At the end stands what stood until then.
        let time_s = time_s.min(self.placed.end_s - 2.0 * SAME_S);
        while let Some(print) = self.placed.prints.get(self.next).filter(|print| print.strike_s <= time_s) {
            self.standing.push((print.foot, print.lift_off_s));
            self.next += 1;
        }
        self.standing.retain(|(_, lift_off_s)| time_s < *lift_off_s);
        let mut down: Vec<Foot> = self.standing.iter().map(|(foot, _)| *foot).collect();
        down.sort_unstable();
        down.dedup();
        down
    }
}

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
    use glam::{DQuat, DVec3};
    use muybridge_footprints::PlacedPrint;

    #[test]
    fn a_hop_is_stance_flight_and_stance() {
        let print = |foot, strike_s, lift_off_s| PlacedPrint {
            foot,
            middle: DVec3::ZERO,
            world_from_foot: DQuat::IDENTITY,
            strike_s,
            lift_off_s,
        };
        let prints =
            vec![print(Foot::Left, 0.0, 0.5), print(Foot::Right, 0.3, 0.6), print(Foot::Left, 0.8, 1.5)];
        let all = supports(&Placed { prints: prints.clone(), end_s: 1.2 });
        let words: Vec<(f64, f64, usize)> = all.iter().map(|s| (s.from_s, s.to_s, s.down.len())).collect();
        assert_eq!(words, [(0.0, 0.3, 1), (0.3, 0.5, 2), (0.5, 0.6, 1), (0.6, 0.8, 0), (0.8, 1.2, 1)]);
        assert_eq!(feet_down(&Placed { prints, end_s: 1.2 }, 0.55), [Foot::Right]);
        let meanings: Vec<String> = legend(&all).into_iter().map(|(_, words)| words).collect();
        assert_eq!(meanings, ["double stance", "right stance", "left stance", "flight"]);
    }
}
