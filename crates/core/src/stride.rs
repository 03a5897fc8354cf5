//! A stride as a value: periodic curves over phase, with contacts and footprints.

use glam::{Quat, Vec3};
use serde::{Deserialize, Serialize};

use crate::gait::{Gait, Lead};
use crate::limb::Limb;
use crate::pose::Pose;
use crate::provenance::Provenance;
use crate::skeleton::{BONE_COUNT, Skeleton};

/// Samples per periodic curve. A stride's distal joints hold about six harmonics, but a hoof comes to rest within a few
/// hundredths of a stride: 96 samples keep a standing toe within 2 mm of its print between them, 48 within 6 mm.
pub const CURVE_SAMPLES: usize = 96;
/// Curves per stride: root surge, height and pitch, 28 bends, two scapula slides.
pub const CHANNEL_COUNT: usize = 3 + BONE_COUNT + 2;

/// When a hoof is down, as phases of the stride.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Contact {
    /// Phase of foot strike, in `[0, 1)`.
    pub strike_phase: f32,
    /// Phase of lift-off, in `[0, 1)`; smaller than the strike when the stance runs through the wrap.
    pub lift_off_phase: f32,
}

impl Contact {
    /// Share of the stride the hoof is down, 0 to 1.
    pub fn duty_factor(self) -> f32 {
        (self.lift_off_phase - self.strike_phase).rem_euclid(1.0)
    }

    /// The phase at which another stride's step cycle of this leg is as far as this one is at `phase`: stance to stance and swing to
    /// swing, linearly.
    pub fn same_step(self, other: Self, phase: f32) -> f32 {
        let since = (phase - self.strike_phase).rem_euclid(1.0);
        let (duty, other_duty) = (self.duty_factor(), other.duty_factor());
        let other_since = if since < duty {
            since / duty * other_duty
        } else {
            other_duty + (since - duty) / (1.0 - duty) * (1.0 - other_duty)
        };
        other.strike_phase + other_since
    }

    /// Whether the hoof is down at a phase (any real number).
    pub fn contains(self, phase: f32) -> bool {
        (phase - self.strike_phase).rem_euclid(1.0) < self.duty_factor()
    }
}

/// The stride's periodic channels, each [`CURVE_SAMPLES`] values at phases `k / CURVE_SAMPLES`.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    /// Root ahead of the uniform advance `stride length * phase`, metres.
    pub surge_m: Vec<f32>,
    /// Root height over the ground, metres.
    pub height_m: Vec<f32>,
    /// Root pitch, nose up positive, radians.
    pub pitch_rad: Vec<f32>,
    /// One curve per bone: bend from straight, radians.
    pub bends_rad: Vec<Vec<f32>>,
    /// Left and right scapula slide, metres.
    pub scapula_slides_m: Vec<Vec<f32>>,
}

impl Curves {
    /// Every channel in the fixed order surge, height, pitch, bends, slides.
    pub fn channels(&self) -> impl Iterator<Item = &Vec<f32>> {
        [&self.surge_m, &self.height_m, &self.pitch_rad]
            .into_iter()
            .chain(&self.bends_rad)
            .chain(&self.scapula_slides_m)
    }
}

/// One stride of one horse at one speed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Stride {
    /// Name, unique in its database; for captures the plate's identifier.
    pub id: String,
    /// Gait.
    pub gait: Gait,
    /// Lead; none in symmetrical gaits.
    pub lead: Option<Lead>,
    /// Speed, m/s.
    pub speed_m_s: f32,
    /// Duration of the stride, s.
    pub stride_time_s: f32,
    /// Size of the animal: withers height of the reference skeleton scaled to it, metres. Its own bones are `bone_lengths_m`.
    pub withers_height_m: f32,
    /// Length of each bone, metres.
    pub bone_lengths_m: Vec<f32>,
    /// Contacts in the order of [`Limb::ALL`]. Phase 0 is the strike of the left hind.
    pub contacts: [Contact; 4],
    /// Toe position at strike for each leg: metres ahead of the root's position at phase 0, of the strike in
    /// `[0, 1)`.
    pub prints_m: [f32; 4],
    /// Joint and root curves.
    pub curves: Curves,
    /// Where it comes from.
    pub provenance: Provenance,
}

impl Stride {
    /// Distance covered in one stride, metres.
    pub fn stride_length_m(&self) -> f32 {
        self.speed_m_s * self.stride_time_s
    }

    /// The animal: the reference skeleton scaled to the withers height, with the stride's own bone lengths.
    pub fn skeleton(&self, reference: &Skeleton) -> Skeleton {
        let mut skeleton = reference.scaled(self.withers_height_m / reference.withers_height_m);
        for (bone, &length_m) in skeleton.bones.iter_mut().zip(&self.bone_lengths_m) {
            bone.length_m = length_m;
        }
        skeleton
    }

    /// Pose at a phase (any real number; whole strides add their length). Allocates nothing.
    pub fn pose(&self, phase: f32) -> Pose {
        let at = |curve: &[f32]| sample_periodic(curve, phase);
        let mut bends_rad = [0.0; BONE_COUNT];
        for (bend, curve) in bends_rad.iter_mut().zip(&self.curves.bends_rad) {
            *bend = at(curve);
        }
        let mut scapula_slides_m = [0.0; 2];
        for (slide, curve) in scapula_slides_m.iter_mut().zip(&self.curves.scapula_slides_m) {
            *slide = at(curve);
        }
        let x = self.stride_length_m() * phase + at(&self.curves.surge_m);
        Pose {
            root_in_world: Vec3::new(x, at(&self.curves.height_m), 0.0),
            world_from_root: Quat::from_rotation_z(at(&self.curves.pitch_rad)),
            bends_rad,
            scapula_slides_m,
            ..Pose::default()
        }
    }

    /// Legs on the ground at a phase, in the order of [`Limb::ALL`].
    pub fn support(&self, phase: f32) -> [bool; 4] {
        Limb::ALL.map(|limb| self.contacts[limb.index()].contains(phase))
    }

    /// What is wrong with the stride's shape or numbers, if anything.
    pub(crate) fn fault(&self) -> Option<String> {
        let shapes = self.bone_lengths_m.len() == BONE_COUNT
            && self.curves.bends_rad.len() == BONE_COUNT
            && self.curves.scapula_slides_m.len() == 2;
        if !shapes {
            return Some(format!("stride {}: expected {BONE_COUNT} bones and 2 slides", self.id));
        }
        if self.curves.channels().any(|curve| curve.len() != CURVE_SAMPLES) {
            return Some(format!("stride {}: every curve needs {CURVE_SAMPLES} samples", self.id));
        }
        if !(self.speed_m_s > 0.0 && self.stride_time_s > 0.0 && self.withers_height_m > 0.0) {
            return Some(format!(
                "stride {}: speed, stride time and withers height must be positive",
                self.id
            ));
        }
        None
    }
}

/// Value of a periodic curve between its samples: Catmull-Rom cubic, continuous in value and slope.
fn sample_periodic(curve: &[f32], phase: f32) -> f32 {
    let n = curve.len();
    let at = phase.rem_euclid(1.0) * n as f32;
    let i = (at as usize).min(n - 1);
    let t = at - i as f32;
    let [p0, p1, p2, p3] = [n - 1, 0, 1, 2].map(|k| curve[(i + k) % n]);
    let (a, b, c) = (-p0 + 3.0 * p1 - 3.0 * p2 + p3, 2.0 * p0 - 5.0 * p1 + 4.0 * p2 - p3, p2 - p0);
    p1 + 0.5 * t * (c + t * (b + t * a))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn periodic_sampling_passes_through_samples_and_closes() {
        let curve: Vec<f32> = (0..CURVE_SAMPLES)
            .map(|k| (k as f32 / CURVE_SAMPLES as f32 * 2.0 * std::f32::consts::TAU).sin())
            .collect();
        for k in 0..CURVE_SAMPLES {
            let phase = k as f32 / CURVE_SAMPLES as f32;
            assert!((sample_periodic(&curve, phase) - curve[k]).abs() < 1e-5);
            assert!((sample_periodic(&curve, phase + 3.0) - curve[k]).abs() < 1e-4);
            let between = phase + 0.5 / CURVE_SAMPLES as f32;
            assert!(
                (sample_periodic(&curve, between) - (between * 2.0 * std::f32::consts::TAU).sin()).abs()
                    < 2e-3
            );
        }
    }

    #[test]
    fn contact_through_the_wrap_contains_phase_zero() {
        let contact = Contact { strike_phase: 0.9, lift_off_phase: 0.2 };
        assert!((contact.duty_factor() - 0.3).abs() < 1e-6);
        assert!(contact.contains(0.0) && contact.contains(0.95) && contact.contains(1.1));
        assert!(!contact.contains(0.5) && !contact.contains(-0.2));
    }
}
