//! How much each kind of evidence counts in the stride fit.

use muybridge_core::{BONE_COUNT, Limb, Pair, bone};
use serde::Serialize;

/// Standard deviations and limits of the fit. Angles in radians, lengths in metres.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Weights {
    /// Distance of a placed point from the joint it stands for, beyond the person's own scatter: skin, hair, and a
    /// planar skeleton that is not a horse. 0.012 m, about the "bony landmark" error of marker studies.
    pub landmark_sd_m: f64,
    /// Cauchy scale of the reprojection loss, in standard deviations: 2.5 keeps 5 % of gross outliers from pulling and
    /// gave the least held-out error on the plate of 1878 among 2, 2.5 and 3.
    pub cauchy: f64,
    /// Angular acceleration per bone, rad per stride squared. 6 degrees of second difference at 24 panels a stride,
    /// measured as the best trade between noise and detail; see [`Weights::default`] for the factors per bone.
    pub bend_acceleration_sd: [f64; BONE_COUNT],
    /// Pitch acceleration, rad per stride squared.
    pub pitch_acceleration_sd: f64,
    /// Acceleration of the root against uniform advance, and of the scapula slides, m per stride squared.
    pub root_acceleration_sd: f64,
    /// Bend against rest, rad.
    pub bend_prior_sd: [f64; BONE_COUNT],
    /// Pitch against level, rad.
    pub pitch_prior_sd: f64,
    /// Direction of the head in the world, rad from level: horses carry it steadily, from -50 degrees standing to -35
    /// at racing speed.
    pub head_direction: f64,
    /// Standard deviation of the head's direction, rad.
    pub head_direction_sd: f64,
    /// Difference of neighbouring neck bones in their bends from rest, rad: 20 degrees, so that the neck curves instead of folding.
    pub neck_evenness_sd: f64,
    /// Scapula slide against none, m.
    pub slide_prior_sd: f64,
    /// Log-length against the scaled reference.
    pub log_length_sd: f64,
    /// Log-scale against the reference, where nothing tells the animal's size.
    pub log_scale_sd: f64,
    /// Log-scale against the withers height, where the pictures tell it: a moving horse's withers are within a few hundredths of
    /// their standing height, and proportions differ by as much.
    pub log_size_sd: f64,
    /// Toe over the ground in a stance panel, m.
    pub stance_height_sd: f64,
    /// Toe of neighbouring panels of one stance against each other, m.
    pub stance_slip_sd: f64,
}

/// Panels per stride at which the smoothness was tuned.
pub(crate) const TUNED_PANELS: f64 = 24.0;

impl Default for Weights {
    fn default() -> Self {
        // Second difference at 24 panels, converted to an acceleration per stride squared.
        let per_stride_squared = TUNED_PANELS * TUNED_PANELS;
        let acceleration = |degrees: f64| degrees.to_radians() * per_stride_squared;
        let mut bend_acceleration_sd = [acceleration(6.0); BONE_COUNT];
        let mut bend_prior_sd = [30f64.to_radians(); BONE_COUNT];
        // The spine and neck of a moving horse bend slowly and little.
        for i in bone::SPINE..=bone::SPINE_LAST {
            bend_acceleration_sd[i] = acceleration(2.0);
            bend_prior_sd[i] = 6f64.to_radians();
        }
        // Flexion of the back is mostly at the lumbosacral joint, where the first spine bone meets the root.
        bend_acceleration_sd[bone::SPINE] = acceleration(4.0);
        bend_prior_sd[bone::SPINE] = 15f64.to_radians();
        for i in bone::NECK..=bone::HEAD {
            bend_acceleration_sd[i] = acceleration(4.0);
            bend_prior_sd[i] = 22f64.to_radians();
        }
        // The neck is raised and lowered at its base, and the head hangs or is stretched out from the poll.
        bend_prior_sd[bone::NECK] = 30f64.to_radians();
        bend_prior_sd[bone::HEAD] = 60f64.to_radians();
        for limb in Limb::ALL {
            let first = limb.first_bone();
            bend_acceleration_sd[first] = acceleration(3.0);
            // The pelvis is one with the sacrum, so it turns with the root; the scapula swings on the rib cage.
            let root_joint = if limb.pair() == Pair::Hind { 6f64 } else { 15f64 };
            bend_prior_sd[first] = root_joint.to_radians();
            // Distal bones are light and whip; their rest pose says little of them.
            bend_acceleration_sd[first + 3] = acceleration(8.0);
            bend_acceleration_sd[first + 4] = acceleration(6.0);
            bend_prior_sd[first + 3] = 45f64.to_radians();
            bend_prior_sd[first + 4] = 60f64.to_radians();
        }
        Self {
            landmark_sd_m: 0.012,
            cauchy: 2.5,
            bend_acceleration_sd,
            pitch_acceleration_sd: acceleration(4.0),
            root_acceleration_sd: 0.01 * per_stride_squared,
            bend_prior_sd,
            pitch_prior_sd: 15f64.to_radians(),
            head_direction: (-42f64).to_radians(),
            head_direction_sd: 12f64.to_radians(),
            neck_evenness_sd: 20f64.to_radians(),
            slide_prior_sd: 0.03,
            log_length_sd: 0.10,
            log_scale_sd: 0.2,
            log_size_sd: 0.04,
            stance_height_sd: 0.025,
            stance_slip_sd: 0.02,
        }
    }
}
