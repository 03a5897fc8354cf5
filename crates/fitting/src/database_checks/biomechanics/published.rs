//! Published times and lengths against speed and Froude number, as bands.

use muybridge_capture::LEG_SHARE;
use muybridge_core::{Gait, Limb, Pair};

use super::super::{Check, Deviation, Subject};

/// Standard gravity, m/s^2.
const GRAVITY: f64 = 9.80665;
/// Width of a band unless its row says otherwise: an instant labelled from a hoof marker is good to 26 ms (Starke & Clayton
/// 2015), and one horse is not the mean horse.
const GENEROUS: f64 = 0.2;

/// A number of a stride.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Quantity {
    /// Mean stance time of a pair, s.
    Stance(Pair),
    /// Mean swing time of a pair, s.
    Swing(Pair),
    /// Mean duty factor of a pair.
    Duty(Pair),
    /// Mean duty factor of the four legs.
    MeanDuty,
    /// Stride time, s.
    StrideTime,
    /// Strides a minute.
    StrideRate,
    /// Stride length, m.
    StrideLength,
    /// Stride length over leg length.
    RelativeStrideLength,
}

impl Quantity {
    fn check(self) -> Check {
        match self {
            Self::Stance(_) => Check::StanceTime,
            Self::Swing(_) => Check::SwingTime,
            Self::Duty(_) | Self::MeanDuty => Check::DutyFactor,
            Self::StrideTime | Self::StrideRate => Check::StrideTime,
            Self::StrideLength | Self::RelativeStrideLength => Check::StrideLength,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Stance(Pair::Fore) => "stance of the forelimbs in s",
            Self::Stance(Pair::Hind) => "stance of the hind limbs in s",
            Self::Swing(Pair::Fore) => "swing of the forelimbs in s",
            Self::Swing(Pair::Hind) => "swing of the hind limbs in s",
            Self::Duty(Pair::Fore) => "duty factor of the forelimbs",
            Self::Duty(Pair::Hind) => "duty factor of the hind limbs",
            Self::MeanDuty => "mean duty factor",
            Self::StrideTime => "stride time in s",
            Self::StrideRate => "strides a minute",
            Self::StrideLength => "stride length in m",
            Self::RelativeStrideLength => "stride length over leg length",
        }
    }

    fn of(self, subject: &Subject<'_>) -> f64 {
        let stride_s = f64::from(subject.stride.stride_time_s);
        let mean_duty = |pair| pair_duty_factor(subject, pair);
        match self {
            Self::Stance(pair) => mean_duty(pair) * stride_s,
            Self::Swing(pair) => (1.0 - mean_duty(pair)) * stride_s,
            Self::Duty(pair) => mean_duty(pair),
            Self::MeanDuty => 0.5 * (mean_duty(Pair::Fore) + mean_duty(Pair::Hind)),
            Self::StrideTime => stride_s,
            Self::StrideRate => 60.0 / stride_s,
            Self::StrideLength => f64::from(subject.stride.stride_length_m()),
            Self::RelativeStrideLength => f64::from(subject.stride.stride_length_m()) / leg_length_m(subject),
        }
    }
}

/// What a band's points are given against.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Against {
    /// Speed, m/s.
    Speed,
    /// Froude number `v^2 / (g L)`.
    Froude,
}

/// One published line.
struct Band {
    gait: Gait,
    quantity: Quantity,
    against: Against,
    /// Abscissa and value, rising; between them straight in logarithms, as all powers of speed are.
    points: &'static [[f64; 2]],
    /// Factor by which the line is trusted beyond its first and last abscissa.
    reach: f64,
    /// Share by which a stride may differ.
    margin: f64,
    source: &'static str,
}

const CLAYTON: &str = "Clayton 1995";
const BULLIMORE: &str = "Bullimore & Burn 2006, J Exp Biol 209:455";
const WITTE: &str = "Witte et al. 2006, J Exp Biol 209:4389";
const RACING_TROT: &str = "Equine Vet J 1980 12:60";
/// Beyond 9 to 17 m/s Witte's lines are followed by this factor: the gallop's speeds end at 17.9.
const GALLOP_REACH: f64 = 1.1;
/// Bullimore's lines are followed no farther than this factor of the Froude number, because trots of other kinds lie there.
const TROT_REACH: f64 = 1.5;
/// A racing trotter's numbers hold within 8 % of his 12 m/s.
const RACING_REACH: f64 = 1.08;
/// The trot's line of stride times is followed by this factor beyond 3.3 and 12 m/s.
const TROT_TIME_REACH: f64 = 1.1;
/// Riding horses' trots (Clayton 1995) last up to 28 % longer than the line through all published trots.
const TROT_TIME_MARGIN: f64 = 0.3;
/// The walk's duty factors 0.55 to 0.75, a tenth wider at both ends; with less than a half it would be no walk.
const WALK_DUTY: [[f64; 2]; 1] = [[1.5, 0.66]];
const WALK_DUTY_MARGIN: f64 = 0.25;

const fn band(gait: Gait, quantity: Quantity, points: &'static [[f64; 2]], source: &'static str) -> Band {
    Band { gait, quantity, against: Against::Speed, points, reach: 1.0, margin: GENEROUS, source }
}

const fn trot_by_froude(quantity: Quantity, points: &'static [[f64; 2]]) -> Band {
    let against = Against::Froude;
    Band { against, reach: TROT_REACH, ..band(Gait::Trot, quantity, points, BULLIMORE) }
}

const fn gallop(quantity: Quantity, points: &'static [[f64; 2]]) -> Band {
    Band { reach: GALLOP_REACH, ..band(Gait::Gallop, quantity, points, WITTE) }
}

const fn racing_trot(quantity: Quantity, points: &'static [[f64; 2]]) -> Band {
    Band { reach: RACING_REACH, ..band(Gait::Trot, quantity, points, RACING_TROT) }
}

/// Horses change from walk to trot at this Froude number (Griffin et al. 2004, J Exp Biol 207:4215).
const WALK_TROT_FROUDE: f64 = 0.35;
/// They may be asked to walk faster or trot slower: by this factor of the Froude number, 22 % of speed.
const WALK_TROT_OVERLAP: f64 = 1.5;

/// Duty factors of galloping forelimbs, from stance and swing.
pub(super) const GALLOP_FORE_DUTY: [[f64; 2]; 2] = [[9.0, 0.26], [17.0, 0.18]];

const BANDS: [Band; 18] = [
    Band {
        reach: f64::INFINITY,
        margin: WALK_DUTY_MARGIN,
        ..band(Gait::Walk, Quantity::MeanDuty, &WALK_DUTY, "a wide band, for no primary number is at hand")
    },
    band(Gait::Walk, Quantity::StrideRate, &[[1.1, 51.0], [2.0, 57.0]], CLAYTON),
    trot_by_froude(Quantity::MeanDuty, &[[0.5, 0.47], [0.75, 0.44], [1.0, 0.39]]),
    trot_by_froude(Quantity::RelativeStrideLength, &[[0.5, 1.43], [0.75, 1.49], [1.0, 1.66]]),
    band(Gait::Trot, Quantity::StrideRate, &[[4.0, 75.0], [5.0, 84.0]], CLAYTON),
    Band {
        reach: TROT_TIME_REACH,
        margin: TROT_TIME_MARGIN,
        // 1.11 v^-0.39, the line through the trots of both studies and the racing trotter.
        ..band(
            Gait::Trot,
            Quantity::StrideTime,
            &[[3.3, 0.697], [12.0, 0.421]],
            "1.11 v^-0.39 through published trots",
        )
    },
    racing_trot(Quantity::StrideLength, &[[12.0, 5.45]]),
    racing_trot(Quantity::StrideTime, &[[12.0, 0.455]]),
    racing_trot(Quantity::Stance(Pair::Fore), &[[12.0, 0.100]]),
    racing_trot(Quantity::Stance(Pair::Hind), &[[12.0, 0.177]]),
    band(Gait::Canter, Quantity::StrideRate, &[[3.0, 89.0], [7.0, 102.0]], CLAYTON),
    gallop(Quantity::Stance(Pair::Fore), &[[9.0, 0.131], [17.0, 0.077]]),
    gallop(Quantity::Stance(Pair::Hind), &[[9.0, 0.143], [17.0, 0.094]]),
    gallop(Quantity::Swing(Pair::Fore), &[[9.0, 0.364], [17.0, 0.342]]),
    gallop(Quantity::Swing(Pair::Hind), &[[9.0, 0.355], [17.0, 0.326]]),
    gallop(Quantity::Duty(Pair::Fore), &GALLOP_FORE_DUTY),
    gallop(Quantity::Duty(Pair::Hind), &[[9.0, 0.29], [17.0, 0.22]]),
    gallop(Quantity::StrideTime, &[[9.0, 0.497], [17.0, 0.420]]),
];

pub(super) fn check(subject: &Subject<'_>) -> Vec<Deviation> {
    let bands = BANDS.iter().filter(|band| band.gait == subject.stride.gait);
    bands.filter_map(|band| band.deviation(subject)).chain(walk_or_trot(subject)).collect()
}

/// A walk too fast for a walk, or a trot too slow for a trot.
fn walk_or_trot(subject: &Subject<'_>) -> Option<Deviation> {
    let allowed = match subject.stride.gait {
        Gait::Walk => [0.0, WALK_TROT_FROUDE * WALK_TROT_OVERLAP],
        Gait::Trot => [WALK_TROT_FROUDE / WALK_TROT_OVERLAP, f64::MAX],
        _ => return None,
    };
    let (froude, gait) = (froude(subject), subject.stride.gait);
    let text = format!(
        "a {gait} at a Froude number of {froude:.2}; walk turns to trot at {WALK_TROT_FROUDE} (Griffin et al. 2004)"
    );
    subject.require(Check::GaitSpeed, froude, allowed, text)
}

impl Band {
    fn deviation(&self, subject: &Subject<'_>) -> Option<Deviation> {
        let (at, symbol) = match self.against {
            Against::Speed => (f64::from(subject.stride.speed_m_s), "v = "),
            Against::Froude => (froude(subject), "Fr = "),
        };
        let expected = self.expected(at)?;
        let value = self.quantity.of(subject);
        let allowed = [expected * (1.0 - self.margin), expected * (1.0 + self.margin)];
        let text = format!(
            "{} is {value:.3} at {symbol}{at:.2}; published {expected:.3}, +- {:.0} % ({})",
            self.quantity.name(),
            100.0 * self.margin,
            self.source
        );
        subject.require(self.quantity.check(), value, allowed, text)
    }

    /// The line's value; none out of its reach.
    fn expected(&self, at: f64) -> Option<f64> {
        let (first, last) = (self.points.first()?[0], self.points.last()?[0]);
        (first / self.reach..=last * self.reach).contains(&at).then(|| power_through(self.points, at))
    }
}

/// The value at `at` of powers joined at points of rising abscissa; beyond the ends the last one goes on, a single point
/// stays as it is.
pub(super) fn power_through(points: &[[f64; 2]], at: f64) -> f64 {
    let segment = points.windows(2).find(|w| at <= w[1][0]).or(points.windows(2).last());
    match segment {
        Some([[x0, y0], [x1, y1]]) => y0 * (y1 / y0).powf((at / x0).ln() / (x1 / x0).ln()),
        _ => points.first().map_or(f64::NAN, |point| point[1]),
    }
}

/// Mean duty factor of a pair.
pub(super) fn pair_duty_factor(subject: &Subject<'_>, pair: Pair) -> f64 {
    let legs = Limb::ALL.into_iter().filter(|limb| limb.pair() == pair);
    legs.map(|limb| subject.duty_factor(limb)).sum::<f64>() / 2.0
}

fn leg_length_m(subject: &Subject<'_>) -> f64 {
    LEG_SHARE * f64::from(subject.stride.withers_height_m)
}

fn froude(subject: &Subject<'_>) -> f64 {
    f64::from(subject.stride.speed_m_s).powi(2) / (GRAVITY * leg_length_m(subject))
}

#[cfg(test)]
mod tests {
    use super::super::super::specimen::{Specimen, checks_of};
    use super::*;

    #[test]
    fn lines_meet_their_points_and_the_published_powers() {
        let stance = [[9.0, 0.131], [17.0, 0.077]];
        assert!((power_through(&stance, 17.0) - 0.077).abs() < 1e-12);
        // The table's own power for the same numbers, rounded.
        assert!((power_through(&stance, 12.0) / (0.82 * 12f64.powf(-0.84)) - 1.0).abs() < 0.02);
        let three = [[0.5, 1.43], [0.75, 1.49], [1.0, 1.66]];
        assert!(three.iter().all(|&[x, y]| (power_through(&three, x) - y).abs() < 1e-12));
        assert_eq!(power_through(&[[12.0, 5.45]], 12.5), 5.45);
    }

    #[test]
    fn a_trot_that_keeps_its_feet_down_too_long_for_its_froude_number_is_found() {
        let stride = Specimen { duties: [0.54; 4], ..Specimen::trot() }.stride();
        assert_eq!(checks_of(&stride), [Check::DutyFactor]);
    }

    #[test]
    fn a_hurried_walk_is_found() {
        let stride = Specimen { stride_time_s: 0.85, ..Specimen::walk() }.stride();
        assert_eq!(checks_of(&stride), [Check::StrideTime]);
    }

    #[test]
    fn a_trot_at_a_walking_speed_is_found() {
        let trot = Specimen { speed_m_s: 1.5, stride_time_s: 0.85, ..Specimen::trot() };
        assert_eq!(checks_of(&trot.stride()), [Check::GaitSpeed]);
    }

    #[test]
    fn a_gallop_whose_forefeet_leave_too_early_is_found() {
        let stride = Specimen { duties: [0.222, 0.222, 0.28, 0.28], ..Specimen::gallop() }.stride();
        assert_eq!(checks_of(&stride), [Check::StanceTime]);
    }
}
