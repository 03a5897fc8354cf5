//! One stride from the many of a tracked clip: the mean over strides, written as a plate that the fit reads like any other.
//!
//! A clip is a table of points by frame ([`Clip`]). Its strides are found by what all hooves do under the trunk; the animal's
//! advance and its change of size in the picture are taken out; every detection is given to its own leg; and at 24 phases
//! each point gets a robust mean with the spread between strides ([`MeanStride`]). [`documents`] makes a manifest and an
//! annotation of it.

mod clip;
mod documents;
mod harmonics;
mod legs;
mod mean;
mod naming;
mod notes;
mod rectify;
mod robust;
mod stance;
mod strides;

use muybridge_capture::{Facing, Keypoint, LimbJoint, NearOff};
use muybridge_core::{Gait, Pair};

pub use clip::{Clip, TableError, TableFault};
pub use documents::{Plan, documents};
pub use mean::{MeanPlace, MeanPoint, PHASES};
pub use naming::Naming;
pub use stance::HoofStance;
pub use strides::Strides;

use legs::courses;
use mean::mean_points;
use rectify::Picture;
use robust::quantile;
use stance::hoof_stances;

/// Why a clip has no mean stride.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum AverageFault {
    /// Withers and croup are not seen together often enough.
    #[error(
        "withers and croup are seen together in too few frames, or not above the hooves; the trunk is what the strides are centred on"
    )]
    NoTrunk,
    /// Nothing repeats.
    #[error(
        "no stride: the hooves do not go forward and back under the trunk at least twice in a steady rhythm; does the animal stand?"
    )]
    NoStride,
    /// The picture follows the animal, or it walks on the spot or backwards.
    #[error(
        "the animal does not advance through the picture; a camera that stands still is needed to tell when hooves stand"
    )]
    NoAdvance,
    /// A hoof is missing, or never stands.
    #[error(
        "too few strides show every hoof at stance and swing; a longer clip, or one with fewer gaps, is needed"
    )]
    NoStance,
}

/// The mean stride of a clip.
#[derive(Clone, Debug)]
pub struct MeanStride {
    /// The strides it is the mean of.
    pub strides: Strides,
    /// Which way the animal goes.
    pub facing: Facing,
    /// Distance of the trunk during a stride, withers heights.
    pub advance: f64,
    /// Length and height of the animal in the first and in the last frame, against the middle of the clip.
    pub sizes: [[f64; 2]; 2],
    /// Its keypoints, in file order.
    pub points: Vec<MeanPoint>,
    /// Near fore, off fore, near hind, off hind.
    pub hooves: Vec<HoofStance>,
    /// Places dropped because no stride explains them.
    pub jumps: usize,
    /// Places moved to the other leg of the pair.
    pub swaps: usize,
}

impl MeanStride {
    /// Averages the strides of a clip.
    ///
    /// # Errors
    /// When there is no trunk, no stride, no advance, or a hoof is missing or never stands.
    pub fn new(clip: &Clip, gait: Gait) -> Result<Self, AverageFault> {
        let picture = Picture::new(clip)?;
        let courses = courses(clip, &picture, gait);
        let points = mean_points(&courses, picture.turns(picture.middle));
        let advance = picture.advance();
        let hooves = hoof_stances(&points, advance);
        if hooves.len() < 4 || hooves.iter().any(|hoof| hoof.instants().is_none()) {
            return Err(AverageFault::NoStance);
        }
        Ok(Self {
            strides: picture.strides,
            facing: picture.facing,
            advance,
            sizes: picture.sizes(),
            points,
            hooves,
            jumps: courses.iter().map(|course| course.jumps).sum(),
            swaps: courses.iter().map(|course| course.swaps).sum(),
        })
    }

    /// Spread between strides: median and worst over points and phases, withers heights.
    pub fn spread(&self) -> [f64; 2] {
        let all: Vec<f64> =
            self.points.iter().flat_map(|p| p.places.iter().flatten()).map(|p| p.spread).collect();
        [0.5, 1.0].map(|share| quantile(all.clone(), share).unwrap_or(0.0))
    }

    /// How much farther near legs drift forward in a stride than off legs, withers heights: the parallax of the two sides as
    /// the animal passes. Negative where the sides are confused; none without any pair of legs.
    pub fn parallax(&self) -> Option<f64> {
        let drift = |side, pair, joint| {
            let keypoint = Keypoint::Limb(side, pair, joint);
            self.points.iter().find(|point| point.keypoint == keypoint).map(|point| point.drift)
        };
        let mut differences = Vec::new();
        for pair in [Pair::Fore, Pair::Hind] {
            for joint in [LimbJoint::Middle, LimbJoint::Fetlock, LimbJoint::Hoof] {
                let [near, off] = [NearOff::Near, NearOff::Off].map(|side| drift(side, pair, joint));
                differences.extend(near.zip(off).map(|(near, off)| near - off));
            }
        }
        quantile(differences, 0.5)
    }

    /// How much higher in the picture off soles stand than near ones, withers heights: a camera over the ground sees them so.
    pub fn off_rise(&self) -> f64 {
        let [near_fore, off_fore, near_hind, off_hind] = [0, 1, 2, 3].map(|i| self.hooves[i].level);
        0.5 * (off_fore - near_fore + off_hind - near_hind)
    }
}

#[cfg(test)]
mod tests;
