//! Which feet are on the ground when.

use crate::placed::Placed;
use crate::track::Foot;

/// Shorter times are rounding of times that should be equal, s.
const ROUNDING_S: f64 = 1e-9;

/// A time in which the same feet are on the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Support {
    /// From, s.
    pub from_s: f64,
    /// To, s.
    pub to_s: f64,
    /// The feet on the ground, in order; none in a flight.
    pub down: Vec<Foot>,
}

impl Support {
    /// Whether no foot is on the ground.
    pub fn is_flight(&self) -> bool {
        self.down.is_empty()
    }

    /// The support at a time, s, of those of a motion; the first or the last one outside it, none when there are none.
    pub fn at(supports: &[Self], time_s: f64) -> Option<&Self> {
        let after = supports.partition_point(|support| support.to_s <= time_s);
        supports.get(after).or(supports.last())
    }
}

impl Placed {
    /// The supports of the motion, without gaps from its beginning to its end.
    pub fn supports(&self) -> Vec<Support> {
        let strikes = self.prints.iter().map(|print| (print.strike_s, 1, print.foot));
        let lift_offs = self.prints.iter().map(|print| (print.lift_off_s, -1, print.foot));
        let mut events: Vec<(f64, i32, Foot)> = strikes.chain(lift_offs).collect();
        events.sort_by(|a, b| a.0.total_cmp(&b.0));
        events.push((self.end_s, 0, Foot::Left));
        let (mut supports, mut from_s): (Vec<Support>, f64) = (Vec::new(), 0.0);
        let mut standing = [(Foot::Left, 0); 4];
        for (at_s, change, foot) in events {
            let to_s = at_s.clamp(0.0, self.end_s);
            if to_s > from_s + ROUNDING_S {
                let down: Vec<Foot> =
                    standing.iter().filter(|(_, stances)| *stances > 0).map(|(foot, _)| *foot).collect();
                match supports.last_mut() {
                    Some(last) if last.down == down => last.to_s = to_s,
                    _ => supports.push(Support { from_s, to_s, down }),
                }
                from_s = to_s;
            }
            if change != 0 {
                let (name, stances) = &mut standing[foot.index()];
                (*name, *stances) = (foot, *stances + change);
            }
        }
        supports
    }
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};

    use super::*;
    use crate::placed::PlacedPrint;

    #[test]
    fn double_stance_and_flight_are_supports_of_their_own() {
        let print = |foot, strike_s, lift_off_s| PlacedPrint {
            foot,
            middle: DVec3::ZERO,
            world_from_foot: DQuat::IDENTITY,
            strike_s,
            lift_off_s,
        };
        let (left, right) = (Foot::Left, Foot::Right);
        let prints = vec![print(left, 0.0, 0.6), print(right, 0.5, 0.9), print(left, 1.0, 1.4)];
        let supports = Placed { prints, end_s: 1.4 }.supports();
        let shown: Vec<(f64, Vec<Foot>)> =
            supports.iter().map(|support| (support.to_s, support.down.clone())).collect();
        let wanted = [
            (0.5, vec![left]),
            (0.6, vec![left, right]),
            (0.9, vec![right]),
            (1.0, vec![]),
            (1.4, vec![left]),
        ];
        assert_eq!(shown, wanted);
        let down = |time_s: f64| Support::at(&supports, time_s).unwrap().down.clone();
        assert_eq!((down(0.95), down(1.4), down(-1.0)), (vec![], vec![left], vec![left]));
        assert_eq!(Support::at(&[], 0.0), None);
    }
}
