//! What the contacts say: stance and swing, Hildebrand's two numbers, support sequence, lead, and the gait implied.

use muybridge_core::{Gait, Lead, Limb, Pair, Side};

use crate::contacts::LegContact;

/// A stride is symmetrical when left and right of each pair strike half a stride apart, give or take this share
/// (Hildebrand's own plots scatter by about a tenth).
const SYMMETRY_TOLERANCE: f64 = 0.12;
/// In a canter the leading hind and the trailing fore strike as one beat: closer than this share of the stride.
const ONE_BEAT: f64 = 0.07;
/// Width of Hildebrand's classes of the lateral lag: sixteen half-steps around the circle, pairs of them to a class.
const HALF_CLASS: f64 = 1.0 / 16.0;

/// The gait that footfalls imply.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ImpliedGait {
    /// Lateral sequence, each foot down more than half the time.
    Walk,
    /// Lateral sequence, each foot down less than half the time.
    Amble,
    /// Diagonal pairs together.
    Trot,
    /// Lateral pairs together.
    Pace,
    /// Symmetrical, but the fore follows the diagonal hind first, as in no common gait of the horse.
    DiagonalSequence,
    /// Three beats, one suspension.
    Canter,
    /// Four beats; fore and hind lead on the same side.
    TransverseGallop,
    /// Four beats; fore and hind lead on opposite sides.
    RotaryGallop,
}

impl ImpliedGait {
    /// Name for people.
    pub fn name(self) -> &'static str {
        match self {
            Self::Walk => "walk",
            Self::Amble => "amble",
            Self::Trot => "trot",
            Self::Pace => "pace (rack)",
            Self::DiagonalSequence => "diagonal sequence",
            Self::Canter => "canter",
            Self::TransverseGallop => "transverse gallop",
            Self::RotaryGallop => "rotary gallop",
        }
    }

    /// Whether a plate's title means this gait.
    pub fn agrees_with(self, title: Gait) -> bool {
        match title {
            Gait::Walk => self == Self::Walk,
            Gait::Amble => matches!(self, Self::Amble | Self::Walk),
            Gait::Trot => self == Self::Trot,
            Gait::Rack => self == Self::Pace,
            Gait::Canter => self == Self::Canter,
            Gait::Gallop => matches!(self, Self::TransverseGallop | Self::RotaryGallop),
            Gait::Leap => false,
        }
    }
}

/// A time in which no hoof is down, longer than twice its own uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Suspension {
    /// Phase at which it begins.
    pub start: f64,
    /// Share of the stride it lasts.
    pub share: f64,
    /// Standard deviation of the share.
    pub sd: f64,
    /// Last leg to leave the ground.
    pub left_by: Limb,
    /// First leg to come down.
    pub ended_by: Limb,
}

impl Suspension {
    /// Legs folded under the body: begun by a fore and ended by a hind. The other kind, extended, is the dog's.
    pub fn is_gathered(&self) -> bool {
        self.left_by.pair() == Pair::Fore && self.ended_by.pair() == Pair::Hind
    }
}

/// A stretch of the stride with the same feet down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Support {
    /// Phase at which it begins.
    pub start: f64,
    /// Share of the stride it lasts.
    pub share: f64,
    /// Feet down, in the order of [`Limb::ALL`].
    pub down: [bool; 4],
}

/// A stride's footfalls, analysed.
#[derive(Clone, Debug, PartialEq)]
pub struct GaitAnalysis {
    /// Stride time, s, and its standard deviation.
    pub stride_time_s: [f64; 2],
    /// Contacts in the order of [`Limb::ALL`].
    pub contacts: [LegContact; 4],
    /// Phase by which each leg's strike follows the left hind's.
    pub lags: [f64; 4],
    /// Support sequence over the stride.
    pub supports: Vec<Support>,
    /// Times without support.
    pub suspensions: Vec<Suspension>,
    /// The gait implied.
    pub implied: ImpliedGait,
    /// Lead of an asymmetrical gait.
    pub lead: Option<Lead>,
}

impl GaitAnalysis {
    /// Analyses the contacts of a stride.
    pub fn new(contacts: [LegContact; 4], stride_time_s: [f64; 2]) -> Self {
        let origin = contacts[Limb::LH.index()].strike.phase;
        let lags = contacts.map(|c| (c.strike.phase - origin).rem_euclid(1.0));
        let supports = support_sequence(&contacts);
        let suspensions = suspensions(&supports, &contacts);
        let apart = |a: Limb, b: Limb| (lags[b.index()] - lags[a.index()]).rem_euclid(1.0);
        let symmetrical = [(Limb::LH, Limb::RH), (Limb::LF, Limb::RF)]
            .iter()
            .all(|(a, b)| (apart(*a, *b) - 0.5).abs() < SYMMETRY_TOLERANCE);
        let second =
            |left: Limb, right: Limb| if apart(left, right) < 0.5 { Side::Right } else { Side::Left };
        let lead = (!symmetrical)
            .then(|| Lead { fore: second(Limb::LF, Limb::RF), hind: second(Limb::LH, Limb::RH) });
        let mut analysis =
            Self { stride_time_s, contacts, lags, supports, suspensions, implied: ImpliedGait::Walk, lead };
        analysis.implied = match lead {
            Some(lead) => analysis.asymmetrical(lead),
            None => analysis.symmetrical(),
        };
        analysis
    }

    /// Hildebrand's first number: mean share of the stride a hind foot is down.
    pub fn hind_duty_factor(&self) -> f64 {
        0.5 * (self.contacts[2].duty_factor() + self.contacts[3].duty_factor())
    }

    /// Hildebrand's second number: share of the stride by which the fore follows the hind of the same side, the
    /// circular mean of both sides.
    pub fn lateral_lag(&self) -> f64 {
        let lags = [self.lags[0], (self.lags[1] - self.lags[3]).rem_euclid(1.0)];
        let (sin, cos) = lags
            .iter()
            .map(|lag| (lag * std::f64::consts::TAU).sin_cos())
            .fold((0.0, 0.0), |(s, c), (sin, cos)| (s + sin, c + cos));
        (sin.atan2(cos) / std::f64::consts::TAU).rem_euclid(1.0)
    }

    fn symmetrical(&self) -> ImpliedGait {
        let lag = self.lateral_lag();
        if !(HALF_CLASS..1.0 - HALF_CLASS).contains(&lag) {
            ImpliedGait::Pace
        } else if lag < 0.5 - HALF_CLASS {
            if self.hind_duty_factor() > 0.5 { ImpliedGait::Walk } else { ImpliedGait::Amble }
        } else if lag <= 0.5 + HALF_CLASS {
            ImpliedGait::Trot
        } else {
            ImpliedGait::DiagonalSequence
        }
    }

    fn asymmetrical(&self, lead: Lead) -> ImpliedGait {
        let leading_hind = Limb::new(Pair::Hind, lead.hind);
        let trailing_fore = Limb::new(Pair::Fore, lead.fore.opposite());
        let apart = (self.lags[trailing_fore.index()] - self.lags[leading_hind.index()]).rem_euclid(1.0);
        if apart.min(1.0 - apart) < ONE_BEAT && lead.is_transverse() {
            ImpliedGait::Canter
        } else if lead.is_transverse() {
            ImpliedGait::TransverseGallop
        } else {
            ImpliedGait::RotaryGallop
        }
    }

    /// Legs in the order they strike, from the left hind.
    pub fn footfall_order(&self) -> [Limb; 4] {
        let mut order = Limb::ALL;
        order.sort_by(|a, b| self.lags[a.index()].total_cmp(&self.lags[b.index()]));
        order
    }

    /// Mean stance time of a pair, s, with its standard deviation.
    pub fn stance_s(&self, pair: Pair) -> [f64; 2] {
        let [stride_s, stride_sd] = self.stride_time_s;
        let legs: Vec<&LegContact> = self.contacts.iter().filter(|c| c.limb.pair() == pair).collect();
        let duty = legs.iter().map(|c| c.duty_factor()).sum::<f64>() / 2.0;
        let duty_sd = legs.iter().map(|c| c.duty_factor_sd().powi(2)).sum::<f64>().sqrt() / 2.0;
        [duty * stride_s, (duty_sd * stride_s).hypot(duty * stride_sd)]
    }

    /// Time per stride in which at least one hoof is down, s, with its standard deviation.
    pub fn support_s(&self) -> [f64; 2] {
        let [stride_s, stride_sd] = self.stride_time_s;
        let flight: f64 = self.suspensions.iter().map(|s| s.share).sum();
        let edges: f64 = self.suspensions.iter().map(|s| s.sd * s.sd).sum();
        let share = 1.0 - flight;
        [share * stride_s, (edges.sqrt() * stride_s).hypot(share * stride_sd)]
    }
}

/// The stride cut at every strike and lift-off, from the left hind's strike.
fn support_sequence(contacts: &[LegContact; 4]) -> Vec<Support> {
    let origin = contacts[Limb::LH.index()].strike.phase;
    let mut cuts: Vec<f64> = contacts
        .iter()
        .flat_map(|c| [c.strike.phase, c.lift_off.phase])
        .map(|phase| (phase - origin).rem_euclid(1.0))
        .collect();
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let ends = cuts.iter().skip(1).copied().chain([1.0 + cuts[0]]);
    cuts.iter()
        .zip(ends)
        .map(|(&start, end)| {
            let middle = origin + 0.5 * (start + end);
            let down = [0, 1, 2, 3].map(|i| contacts[i].contains(middle));
            Support { start: (origin + start).rem_euclid(1.0), share: end - start, down }
        })
        .collect()
}

fn suspensions(supports: &[Support], contacts: &[LegContact; 4]) -> Vec<Suspension> {
    let flights = supports.iter().filter(|s| s.down == [false; 4]);
    flights
        .map(|support| {
            let since = |phase: f64| (support.start - phase).rem_euclid(1.0);
            let until = |phase: f64| (phase - support.start - support.share + 1e-9).rem_euclid(1.0);
            let left_by = Limb::ALL.into_iter().min_by(|a, b| {
                let [a, b] = [a, b].map(|l| since(contacts[l.index()].lift_off.phase - 1e-9));
                a.total_cmp(&b)
            });
            let ended_by = Limb::ALL.into_iter().min_by(|a, b| {
                let [a, b] = [a, b].map(|l| until(contacts[l.index()].strike.phase));
                a.total_cmp(&b)
            });
            let (left_by, ended_by) = (left_by.unwrap_or(Limb::LF), ended_by.unwrap_or(Limb::LH));
            let sd = contacts[left_by.index()].lift_off.sd.hypot(contacts[ended_by.index()].strike.sd);
            Suspension { start: support.start, share: support.share, sd, left_by, ended_by }
        })
        // A gap that the uncertainty of its two edges explains is no suspension.
        .filter(|suspension| suspension.share > 2.0 * suspension.sd)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contacts::ContactInstant;

    /// Contacts from strike phases (LF, RF, LH, RH) and one duty factor.
    fn stride(strikes: [f64; 4], duty: f64) -> GaitAnalysis {
        let contacts = [0, 1, 2, 3].map(|i| LegContact {
            limb: Limb::ALL[i],
            strike: ContactInstant { phase: strikes[i], sd: 0.01 },
            lift_off: ContactInstant { phase: (strikes[i] + duty).rem_euclid(1.0), sd: 0.01 },
        });
        GaitAnalysis::new(contacts, [1.0, 0.01])
    }

    #[test]
    fn textbook_footfalls_get_their_names() {
        let cases = [
            ([0.25, 0.75, 0.0, 0.5], 0.62, ImpliedGait::Walk),
            ([0.25, 0.75, 0.0, 0.5], 0.42, ImpliedGait::Amble),
            ([0.5, 0.0, 0.0, 0.5], 0.4, ImpliedGait::Trot),
            ([0.0, 0.5, 0.0, 0.5], 0.4, ImpliedGait::Pace),
            ([0.75, 0.25, 0.0, 0.5], 0.5, ImpliedGait::DiagonalSequence),
            ([0.3, 0.6, 0.0, 0.3], 0.3, ImpliedGait::Canter),
            ([0.35, 0.5, 0.0, 0.15], 0.2, ImpliedGait::TransverseGallop),
            ([0.5, 0.35, 0.0, 0.15], 0.2, ImpliedGait::RotaryGallop),
        ];
        for (strikes, duty, expected) in cases {
            for shift in [0.0f64, 0.37, 0.91] {
                let analysis = stride(strikes.map(|s: f64| (s + shift).rem_euclid(1.0)), duty);
                assert_eq!(analysis.implied, expected, "{strikes:?} + {shift}");
            }
        }
    }

    #[test]
    fn lead_is_the_side_that_strikes_last() {
        let right = stride([0.35, 0.5, 0.0, 0.15], 0.2);
        assert_eq!(right.lead, Some(Lead { fore: Side::Right, hind: Side::Right }));
        assert_eq!(right.footfall_order(), [Limb::LH, Limb::RH, Limb::LF, Limb::RF]);
        let rotary = stride([0.5, 0.35, 0.0, 0.15], 0.2);
        assert_eq!(rotary.lead, Some(Lead { fore: Side::Left, hind: Side::Right }));
    }

    #[test]
    fn gallop_has_one_gathered_suspension_and_the_trot_two_that_are_not() {
        let gallop = stride([0.35, 0.5, 0.0, 0.15], 0.2);
        assert_eq!(gallop.suspensions.len(), 1);
        assert!(gallop.suspensions[0].is_gathered());
        assert!((gallop.suspensions[0].share - 0.3).abs() < 1e-9);
        assert!((gallop.support_s()[0] - 0.7).abs() < 1e-9);
        let trot = stride([0.5, 0.0, 0.0, 0.5], 0.4);
        assert_eq!(trot.suspensions.len(), 2);
        assert!((trot.support_s()[0] - 0.8).abs() < 1e-9);
    }

    #[test]
    fn supports_add_up_to_the_stride() {
        let walk = stride([0.25, 0.75, 0.0, 0.5], 0.62);
        assert!((walk.supports.iter().map(|s| s.share).sum::<f64>() - 1.0).abs() < 1e-9);
        assert!(walk.suspensions.is_empty());
        assert!(walk.supports.iter().all(|s| (2..=3).contains(&s.down.iter().filter(|d| **d).count())));
    }
}
