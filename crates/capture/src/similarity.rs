//! The speed that goes with a stride's length, by dynamic similarity: horses of any size that move at equal Froude numbers
//! take strides of equal relative length.
//!
//! `S / L = c Fr^d` with stride length `S`, leg length `L` (shoulder or hip joint over the ground) and `Fr = v^2 / (g L)`,
//! fitted in logarithms to published points of each family of gaits; how far those points lie from the line is the
//! uncertainty.

use muybridge_core::Gait;

use crate::calibration::Estimate;

/// Standard gravity, m/s^2.
const GRAVITY: f64 = 9.80665;
/// Leg length as a share of the withers height: the joints where limbs meet the trunk stand at about 0.77 of it.
pub const LEG_SHARE: f64 = 0.77;
/// Leg length of the riding horses and racehorses whose strides were published in metres, m: withers at 1.60 m.
const PUBLISHED_LEG_M: f64 = LEG_SHARE * 1.60;

/// Walk: 1.1 to 2 m/s at 51 to 57 strides a minute (Clayton 1995, as tabulated).
const WALK: [[f64; 2]; 2] = [of_rate(1.1, 51.0), of_rate(2.0, 57.0)];
/// Trot and rack: relative lengths at three Froude numbers over species (Bullimore & Burn 2006), riding horses at 4 and 5
/// m/s (Clayton 1995), a racing trotter at 12 m/s (Equine Vet J 1980 12:60).
const TROT: [[f64; 2]; 6] =
    [[0.5, 1.43], [0.75, 1.49], [1.0, 1.66], of_rate(4.0, 75.0), of_rate(5.0, 84.0), of_length(12.0, 5.45)];
/// Canter and gallop: 3 to 7 m/s at 89 to 102 strides a minute (Clayton 1995), racehorses at 9 and 17 m/s (Witte et al.
/// 2006).
const GALLOP: [[f64; 2]; 4] =
    [of_rate(3.0, 89.0), of_rate(7.0, 102.0), of_length(9.0, 4.47), of_length(17.0, 7.14)];
/// Least relative spread about a line that so few points can vouch for.
const LEAST_SPREAD: f64 = 0.08;

/// Froude number and relative stride length at a speed (m/s) and a rate (strides per minute).
const fn of_rate(speed_m_s: f64, per_minute: f64) -> [f64; 2] {
    of_length(speed_m_s, speed_m_s * 60.0 / per_minute)
}

/// Froude number and relative stride length at a speed (m/s) and a stride length (m).
const fn of_length(speed_m_s: f64, stride_m: f64) -> [f64; 2] {
    [speed_m_s * speed_m_s / (GRAVITY * PUBLISHED_LEG_M), stride_m / PUBLISHED_LEG_M]
}

/// `S / L = c Fr^d` with its relative spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SimilarityLaw {
    /// Relative stride length at Froude number 1.
    pub c: f64,
    /// Exponent.
    pub d: f64,
    /// Relative standard deviation of a published point about the curve.
    pub spread: f64,
}

impl SimilarityLaw {
    /// The law of a gait; none for the leap, whose length the obstacle decides. The amble steps as the walk does, the rack
    /// as the trot, the canter as the gallop.
    pub fn of(gait: Gait) -> Option<Self> {
        match gait {
            Gait::Walk | Gait::Amble => Some(Self::through(&WALK)),
            Gait::Trot | Gait::Rack => Some(Self::through(&TROT)),
            Gait::Canter | Gait::Gallop => Some(Self::through(&GALLOP)),
            Gait::Leap => None,
        }
    }

    /// Least squares in logarithms.
    fn through(points: &[[f64; 2]]) -> Self {
        let n = points.len() as f64;
        let logs: Vec<[f64; 2]> = points.iter().map(|point| point.map(f64::ln)).collect();
        let mean = [0, 1].map(|axis| logs.iter().map(|p| p[axis]).sum::<f64>() / n);
        let sum = |a: usize, b: usize| logs.iter().map(|p| (p[a] - mean[a]) * (p[b] - mean[b])).sum::<f64>();
        let d = sum(0, 1) / sum(0, 0);
        let rest = (sum(1, 1) - d * sum(0, 1)).max(0.0);
        let spread = (rest / (n - 2.0).max(1.0)).sqrt().max(LEAST_SPREAD);
        Self { c: (mean[1] - d * mean[0]).exp(), d, spread }
    }

    /// Relative stride length at a Froude number.
    pub fn relative_length(self, froude: f64) -> f64 {
        self.c * froude.powf(self.d)
    }

    /// Speed, m/s, at which a horse of this leg length (m) takes strides of this length (as a share of the leg's), with its
    /// standard deviation. The relative length does not depend on the scale of the picture, the leg's does.
    pub fn speed_m_s(self, relative_length: Estimate, leg_m: Estimate) -> Estimate {
        let froude = (relative_length.value / self.c).powf(1.0 / self.d);
        let value = (froude * GRAVITY * leg_m.value).sqrt();
        // v grows with (S/L)^(1/2d) and with L^(1/2).
        let by_length = 0.5 / self.d;
        let relative = (by_length * relative_length.sd / relative_length.value)
            .hypot(0.5 * leg_m.sd / leg_m.value)
            .hypot(by_length * self.spread);
        Estimate { value, sd: value * relative }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exact(value: f64) -> Estimate {
        Estimate { value, sd: 0.0 }
    }

    #[test]
    fn published_strides_give_back_their_speeds() {
        // (gait, stride in m, speed in m/s): the sources named above, a horse of 1.60 m.
        let cases = [
            (Gait::Walk, 2.0 * 60.0 / 57.0, 2.0),
            (Gait::Trot, 5.45, 12.0),
            (Gait::Gallop, 4.47, 9.0),
            (Gait::Gallop, 7.14, 17.0),
        ];
        for (gait, stride_m, speed_m_s) in cases {
            let law = SimilarityLaw::of(gait).unwrap();
            let found = law.speed_m_s(exact(stride_m / PUBLISHED_LEG_M), exact(PUBLISHED_LEG_M));
            assert!(
                (found.value - speed_m_s).abs() < 1.5 * found.sd,
                "{gait}: {found:?} against {speed_m_s}"
            );
        }
    }

    #[test]
    fn a_horse_twice_as_large_goes_faster_by_the_root_of_two() {
        let law = SimilarityLaw::of(Gait::Trot).unwrap();
        let small = law.speed_m_s(exact(2.0), exact(1.0)).value;
        let large = law.speed_m_s(exact(2.0), exact(2.0)).value;
        assert!((large / small - 2f64.sqrt()).abs() < 1e-12);
    }

    #[test]
    fn the_leap_has_no_law() {
        assert!(SimilarityLaw::of(Gait::Leap).is_none());
    }
}
