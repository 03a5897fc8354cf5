//! Which feet are on the ground when: the phases of a motion.

use muybridge_footprints::{Foot, Placed};

/// Shorter phases are rounding of times that should be equal, s.
const ROUNDING_S: f64 = 1e-9;

/// A time in which the same feet are on the ground.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    /// From, s.
    pub from_s: f64,
    /// To, s.
    pub to_s: f64,
    /// The feet on the ground, in order.
    pub down: Vec<Foot>,
}

/// The phases of a motion, without gaps from its beginning to its end.
pub fn phases(placed: &Placed) -> Vec<Phase> {
    let strikes = placed.prints.iter().map(|print| (print.strike_s, 1, print.foot));
    let lift_offs = placed.prints.iter().map(|print| (print.lift_off_s, -1, print.foot));
    let mut events: Vec<(f64, i32, Foot)> =
        strikes.chain(lift_offs).filter(|event| event.0.is_finite()).collect();
    events.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut standing: std::collections::BTreeMap<Foot, i32> = std::collections::BTreeMap::new();
    let (mut phases, mut from_s): (Vec<Phase>, f64) = (Vec::new(), 0.0);
    let mut close = |standing: &std::collections::BTreeMap<Foot, i32>, from_s: f64, to_s: f64| {
        let down: Vec<Foot> =
            standing.iter().filter(|(_, count)| **count > 0).map(|(foot, _)| *foot).collect();
        match phases.last_mut() {
            Some(last) if last.down == down => last.to_s = to_s,
            _ => phases.push(Phase { from_s, to_s, down }),
        }
    };
    for (at_s, change, foot) in events {
        let to_s = at_s.clamp(0.0, placed.end_s);
        if to_s > from_s + ROUNDING_S {
            close(&standing, from_s, to_s);
            from_s = to_s;
        }
        *standing.entry(foot).or_default() += change;
    }
    if placed.end_s > from_s + ROUNDING_S {
        close(&standing, from_s, placed.end_s);
    }
    phases
}

#[cfg(test)]
mod tests {
    use glam::{DQuat, DVec3};
    use muybridge_footprints::PlacedPrint;

    use super::*;

    #[test]
    fn double_support_and_flight_are_phases_of_their_own() {
        let print = |foot, strike_s, lift_off_s| PlacedPrint {
            foot,
            middle: DVec3::ZERO,
            world_from_foot: DQuat::IDENTITY,
            strike_s,
            lift_off_s,
        };
        let prints =
            vec![print(Foot::Left, 0.0, 0.6), print(Foot::Right, 0.5, 0.9), print(Foot::Left, 1.0, 1.4)];
        let phases = phases(&Placed { prints, end_s: 1.4 });
        let shown: Vec<(f64, Vec<Foot>)> =
            phases.iter().map(|phase| (phase.to_s, phase.down.clone())).collect();
        let (left, right) = (Foot::Left, Foot::Right);
        let wanted = [
            (0.5, vec![left]),
            (0.6, vec![left, right]),
            (0.9, vec![right]),
            (1.0, vec![]),
            (1.4, vec![left]),
        ];
        assert_eq!(shown, wanted);
    }
}
