//! The segments of a leg on its virtual leg (van de Panne 1997, 2.5): exact inverse kinematics.
//!
//! The virtual leg is the straight line from hip to ankle. Its segments lie in one plane with it; knee and hock bend in a fixed
//! proportion, so that one number, the fold, says it all: the leg is straight at 0 and folded at 1, and shorter the more it is folded.

use glam::{DVec2, DVec3};

use crate::model::LegModel;

/// Most segments of a leg.
const MOST_SEGMENTS: usize = 3;
/// The squared length of the leg is met to this share of the squared longest one: lengths to 1e-14 of it.
const SOLVED: f64 = 1e-14;
/// Newton steps or bisections at most; bisections alone find the fold to 2^-60.
const MOST_ITERATIONS: usize = 60;

/// The segments of a leg and how they fold.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Chain {
    /// Lengths, metres; those beyond `count` are 0.
    lengths_m: [f64; MOST_SEGMENTS],
    /// Flexion of knee and hock in the folded leg, radians.
    fold_rad: [f64; MOST_SEGMENTS - 1],
    count: usize,
}

/// A leg that is bent.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct BentLeg {
    /// From hip to ankle.
    pub(crate) joints: Vec<DVec3>,
    /// How far the ankle is from where it was wanted, metres.
    pub(crate) miss_m: f64,
}

impl Chain {
    /// The segments of a leg; none after the third.
    pub(crate) fn of(leg: &LegModel) -> Self {
        let at = |list: &[f64], i: usize| list.get(i).copied().unwrap_or(0.0);
        Self {
            lengths_m: std::array::from_fn(|i| at(&leg.segments_m, i)),
            fold_rad: std::array::from_fn(|i| at(&leg.fold_deg, i).to_radians()),
            count: leg.segments_m.len().clamp(1, MOST_SEGMENTS),
        }
    }

    /// Length of the straight leg, metres.
    pub(crate) fn longest_m(&self) -> f64 {
        self.lengths_m.iter().sum()
    }

    /// Length of the folded leg, metres.
    pub(crate) fn shortest_m(&self) -> f64 {
        self.squared_length(1.0).0.max(0.0).sqrt()
    }

    /// The squared length of the leg at a fold, and its derivative.
    fn squared_length(&self, fold: f64) -> (f64, f64) {
        let [a, b, c] = self.lengths_m;
        let [knee, hock] = self.fold_rad;
        let (knee_sin, knee_cos) = (knee * fold).sin_cos();
        let (hock_sin, hock_cos) = (hock * fold).sin_cos();
        let (both_sin, both_cos) = ((knee - hock) * fold).sin_cos();
        let squared = a * a + b * b + c * c + 2.0 * (a * b * knee_cos + b * c * hock_cos + a * c * both_cos);
        let slope =
            -2.0 * (a * b * knee * knee_sin + b * c * hock * hock_sin + a * c * (knee - hock) * both_sin);
        (squared, slope)
    }

    /// The fold at which the leg is so long: Newton's method, kept between folds that are too little and too much.
    fn fold(&self, length_m: f64) -> f64 {
        let (wanted, longest, shortest) = (length_m * length_m, self.longest_m(), self.shortest_m());
        let (mut least, mut most) = (0.0, 1.0);
        // The squared length falls with the square of the fold at first.
        let range = longest * longest - shortest * shortest;
        let mut fold = ((longest * longest - wanted) / range).max(0.0).sqrt().min(1.0);
        for _ in 0..MOST_ITERATIONS {
            let (squared, slope) = self.squared_length(fold);
            let excess = squared - wanted;
            if excess.abs() <= SOLVED * longest * longest {
                break;
            }
            if excess > 0.0 {
                least = fold;
            } else {
                most = fold;
            }
            let next = fold - excess / slope;
            fold = if next > least && next < most { next } else { (least + most) / 2.0 };
        }
        fold
    }

    /// Ends of the segments at a fold: along the virtual leg, and forwards across it.
    fn ends(&self, fold: f64) -> [DVec2; MOST_SEGMENTS] {
        let angles = [0.0, -self.fold_rad[0] * fold, (self.fold_rad[1] - self.fold_rad[0]) * fold];
        let mut end = DVec2::ZERO;
        let ends = std::array::from_fn(|i| {
            end += self.lengths_m[i] * DVec2::from_angle(angles[i]);
            end
        });
        let back = DVec2::from_angle(-end.to_angle());
        ends.map(|end| back.rotate(end))
    }

    /// The joints of the leg between hip and ankle, its knee bent forwards as seen with the axis across the leg to the right; an ankle
    /// out of reach is missed, in its direction.
    pub(crate) fn bent(&self, hip: DVec3, ankle: DVec3, right: DVec3) -> BentLeg {
        let (along, forward) = plane(ankle - hip, right);
        let wanted_m = (ankle - hip).length();
        let length_m = wanted_m.max(self.shortest_m()).min(self.longest_m());
        let ends = self.ends(self.fold(length_m));
        let miss_m = (wanted_m - length_m).abs();
        let reached = if miss_m > 0.0 { hip + along * length_m } else { ankle };
        let mut joints = Vec::with_capacity(MOST_SEGMENTS + 1);
        joints.push(hip);
        joints.extend(ends[..self.count - 1].iter().map(|end| hip + along * end.x + forward * end.y));
        joints.push(reached);
        BentLeg { joints, miss_m }
    }
}

/// Direction of a leg, and forwards across it. The axis to the right is what says where forwards is: unlike a direction ahead it is
/// never along a leg that walks, and so a knee does not flip when its leg is straight.
pub(crate) fn plane(leg: DVec3, right: DVec3) -> (DVec3, DVec3) {
    let along = leg.try_normalize().unwrap_or(DVec3::NEG_Y);
    let forward = right.cross(along).try_normalize().unwrap_or_else(|| along.any_orthonormal_vector());
    (along, forward)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Model;
    use muybridge_core::Random;

    fn chains() -> [Chain; 3] {
        ["bird", "dinosaur", "human"].map(|name| Chain::of(&Model::named(name).unwrap().leg))
    }

    fn random_vector(random: &mut Random) -> DVec3 {
        DVec3::from_array(std::array::from_fn(|_| 2.0 * random.uniform() - 1.0))
    }

    #[test]
    fn joints_reach_the_ankle_with_segments_of_their_length() {
        let mut random = Random::new(7);
        for chain in chains() {
            for _ in 0..2000 {
                let (hip, right) = (random_vector(&mut random), random_vector(&mut random));
                let between = random.uniform() * (chain.longest_m() - chain.shortest_m());
                let length_m = chain.shortest_m() + between;
                let ankle = hip + random_vector(&mut random).normalize_or(DVec3::X) * length_m;
                let leg = chain.bent(hip, ankle, right);
                assert_eq!(leg.joints.len(), chain.count + 1);
                assert_eq!((leg.joints[0], leg.joints[chain.count]), (hip, hip + (ankle - hip)));
                assert!(leg.miss_m < 1e-9);
                for i in 0..chain.count {
                    let length_m = leg.joints[i].distance(leg.joints[i + 1]);
                    assert!((length_m - chain.lengths_m[i]).abs() < 1e-9, "{length_m} {chain:?}");
                }
            }
        }
    }

    #[test]
    fn the_leg_is_shorter_the_more_it_is_folded() {
        for chain in chains() {
            let lengths: Vec<f64> = (0..=1000).map(|i| chain.squared_length(i as f64 / 1000.0).0).collect();
            assert!(lengths.windows(2).all(|pair| pair[1] < pair[0]));
        }
    }

    #[test]
    fn knees_point_forwards_and_hocks_backwards() {
        for chain in chains() {
            let length_m = 0.9 * chain.longest_m();
            for lean in [-0.6, 0.0, 0.6f64] {
                let ankle = DVec3::new(lean.sin(), -lean.cos(), 0.0) * length_m;
                let leg = chain.bent(DVec3::ZERO, ankle, DVec3::Z);
                let (_, forward) = plane(ankle, DVec3::Z);
                assert!(forward.x > 0.0 && leg.joints[1].dot(forward) > 0.05 * length_m);
                assert!(leg.joints[1..chain.count].iter().all(|joint| joint.z.abs() < 1e-12));
                if chain.count == 3 {
                    assert!(leg.joints[2].dot(forward) < -0.02 * length_m);
                }
            }
        }
    }

    #[test]
    fn out_of_reach_the_leg_is_straight_towards_its_ankle() {
        for chain in chains() {
            let ankle = DVec3::new(1.0, -3.0, 0.5);
            let leg = chain.bent(DVec3::ZERO, ankle, DVec3::Z);
            let foot = *leg.joints.last().unwrap();
            assert!((leg.miss_m - (ankle.length() - chain.longest_m())).abs() < 1e-9);
            assert!(foot.cross(ankle).length() < 1e-9 && (foot.length() - chain.longest_m()).abs() < 1e-9);
            let near = chain.bent(DVec3::ZERO, DVec3::NEG_Y * 1e-3, DVec3::Z);
            assert!((near.miss_m - (chain.shortest_m() - 1e-3)).abs() < 1e-9);
        }
    }

    #[test]
    fn numbers_that_are_none_do_not_stop_it() {
        let nothing = Chain { lengths_m: [0.0; 3], fold_rad: [f64::NAN, 0.0], count: 3 };
        for value in [f64::NAN, f64::INFINITY, 0.0, 1e300] {
            for chain in chains().into_iter().chain([nothing]) {
                chain.bent(DVec3::ZERO, DVec3::splat(value), DVec3::Z);
                chain.bent(DVec3::splat(value), DVec3::NEG_Y, DVec3::splat(value));
            }
        }
    }
}
