//! Strides out of machine-tracked films of walking horses: the way from a table of points to contact times.
//!
//! A clip is read ([`clip`]), cleaned ([`cleaning`]), its ground found ([`ground`]), its contacts ([`contacts`]) and
//! strides ([`strides`]) measured. The table of all strides ([`table`]) is what is kept, and what the walk's laws
//! ([`walk_law`]) come from.

mod assignment;
pub mod cleaning;
pub mod clip;
pub mod contacts;
pub mod ground;
mod robust;
pub mod strides;
pub mod table;
pub mod walk_law;

use muybridge_core::Limb;

use self::cleaning::{CleanClip, Faults};
use self::clip::Clip;
use self::contacts::{HoofPath, Stance, cores};
use self::ground::Ground;
pub use self::robust::median;
use self::strides::{Flag, MeasuredStride, StrideMaker, prints_px};

/// Frames per second of the tracked walks.
pub const FRAMES_PER_S: f64 = 15.0;
/// Middle of the picture, px: the pictures are 2208 px wide.
const CENTRE_X_PX: f64 = 1104.0;
/// Focal length, px. Not stated. Pictures of 2208 x 1242 at 15 frames/s are those of a ZED stereo camera, of which one
/// model has 1400 px and the next, with a wider lens, about 1060. Seen more or less obliquely, the same horse has the
/// same length from withers to croup best with 1000. With 1400 speeds would be 0 to 8 % higher, 3 % in the mean.
const FOCAL_LENGTH_PX: f64 = 1060.0;
/// A horse whose trunk moves less than this in the whole clip stands, in lengths from withers to croup.
const STANDING: f64 = 0.5;
/// A horse whose withers and croup are closer in x than this share of its height is seen from front or behind; seen
/// from the side they are 0.6 to 0.9 apart.
const LEAST_LENGTH: f64 = 0.35;
/// Largest angle between track and picture plane, in the median: at 45 degrees speeds hang on the focal length.
const MOST_OBLIQUE_RAD: f64 = std::f64::consts::FRAC_PI_4;
/// Largest difference of these angles within the clip, from the first tenth to the last.
const MOST_TURNED_RAD: f64 = std::f64::consts::FRAC_PI_4;
/// Largest median distance of prints from the track, withers heights; further off, it is no plain curve.
const MOST_SCATTERED: f64 = 0.05;
/// Largest share of the frames that may lack both withers and croup.
const MOST_TRUNK_MISSING: f64 = 0.3;

/// How the clips were filmed: a camera that does not move, upright, at an even rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Frames per second.
    pub frames_per_s: f64,
    /// Focal length, px.
    pub focal_length_px: f64,
    /// Middle of the picture, px.
    pub centre_x_px: f64,
}

impl Film {
    /// The camera of the tracked walks at another rate, frames/s.
    pub fn at_rate(frames_per_s: f64) -> Self {
        Self { frames_per_s, focal_length_px: FOCAL_LENGTH_PX, centre_x_px: CENTRE_X_PX }
    }
}

/// What a clip gives.
#[derive(Clone, Debug)]
pub struct Measurement {
    /// What was wrong with the tracks.
    pub faults: Faults,
    /// Stances of each leg in the order of [`Limb::ALL`]; none in a clip that cannot be measured.
    pub stances: [Vec<Stance>; 4],
    /// A row for each stance of each leg, in the order of legs and time; in a clip that cannot be measured one for
    /// each leg, with the reason.
    pub strides: Vec<MeasuredStride>,
}

/// Measures a clip.
pub fn measure(clip: &Clip, film: &Film) -> Measurement {
    let clean = CleanClip::new(clip, film.frames_per_s);
    let faults = clean.as_ref().map(|clean| clean.faults).unwrap_or_default();
    match clean.ok_or(Flag::TrunkNotTracked).and_then(|clean| measure_clean(clip, &clean, film)) {
        Ok((stances, strides)) => Measurement { faults, stances, strides },
        Err(flag) => Measurement {
            faults,
            stances: Default::default(),
            strides: Limb::ALL.map(|limb| MeasuredStride::refused(&clip.name, limb, flag)).into(),
        },
    }
}

type Measured = ([Vec<Stance>; 4], Vec<MeasuredStride>);

fn measure_clean(clip: &Clip, clean: &CleanClip, film: &Film) -> Result<Measured, Flag> {
    check_trunk(clip, clean)?;
    let cores = Limb::ALL.map(|limb| {
        let track = &clean.hooves[limb.index()];
        let along: Vec<Option<f64>> =
            track.at_px.iter().map(|at| at.map(|at| clean.direction * at[0])).collect();
        cores(&along, &clean.trunk_speed_px, film.frames_per_s)
    });
    let prints = prints_px(clean, &cores);
    let ground =
        Ground::new(clean.direction, &clean.trunk.withers_px, &prints, film).ok_or(Flag::NoGround)?;
    check_track(&clean.trunk.withers_px, &ground)?;
    let trunk_advance: Vec<f64> = clean
        .trunk
        .withers_px
        .iter()
        .zip(&clean.trunk_speed_px)
        .map(|(at, speed_px)| {
            let ahead = [at[0] + clean.direction * speed_px, at[1]];
            ground.place(ahead)[0] - ground.place(*at)[0]
        })
        .collect();
    let stances = Limb::ALL.map(|limb| {
        let track = &clean.hooves[limb.index()];
        let places: Vec<Option<[f64; 2]>> =
            track.at_px.iter().map(|at| at.map(|at| ground.place(at))).collect();
        HoofPath { places: &places, filled: &track.filled }.stances(&trunk_advance, film.frames_per_s)
    });
    let maker = StrideMaker {
        name: &clip.name,
        clean,
        ground: &ground,
        stances: &stances,
        frames_per_s: film.frames_per_s,
    };
    let strides = maker.strides();
    Ok((stances, strides))
}

/// Whether the track leads across the picture and hardly turns.
fn check_track(withers_px: &[[f64; 2]], ground: &Ground) -> Result<(), Flag> {
    let mut angles: Vec<f64> = withers_px.iter().map(|at| ground.obliqueness_rad(at[0])).collect();
    angles.sort_by(f64::total_cmp);
    let at = |share: f64| angles[(share * (angles.len() - 1) as f64).round() as usize];
    if at(0.5).abs() > MOST_OBLIQUE_RAD {
        Err(Flag::TowardsOrAway)
    } else if at(0.9) - at(0.1) > MOST_TURNED_RAD || ground.scatter > MOST_SCATTERED {
        Err(Flag::Turning)
    } else {
        Ok(())
    }
}

/// Whether the trunk moves forward across the picture.
fn check_trunk(clip: &Clip, clean: &CleanClip) -> Result<(), Flag> {
    let trunk = &clean.trunk;
    if trunk.missing > MOST_TRUNK_MISSING {
        return Err(Flag::TrunkNotTracked);
    }
    let middle = |of: &dyn Fn(usize) -> f64| median((0..clip.frames()).map(of).collect()).unwrap_or(0.0);
    let length_px = middle(&|i| (trunk.withers_px[i][0] - trunk.croup_px[i][0]).abs());
    let hooves_y = |i: usize| {
        let hooves = clean.hooves.iter().filter_map(|hoof| hoof.at_px[i].map(|at| at[1]));
        hooves.fold(trunk.withers_px[i][1], f64::max)
    };
    let height_px = middle(&|i| hooves_y(i) - trunk.withers_px[i][1]);
    if length_px < LEAST_LENGTH * height_px {
        return Err(Flag::TowardsOrAway);
    }
    let travel_px = trunk.withers_px[clip.frames() - 1][0] - trunk.withers_px[0][0];
    if travel_px.abs() < STANDING * length_px {
        return Err(Flag::Standing);
    }
    let facing = middle(&|i| clip.nostril()[i].at_px[0] - trunk.croup_px[i][0]);
    if facing * clean.direction < 0.0 { Err(Flag::Backwards) } else { Ok(()) }
}
