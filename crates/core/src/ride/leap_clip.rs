//! The leap ready to be played: a push of the hind legs, a flight of any length, a landing on the forelegs (spec 6.5).

use super::clip::Clip;
use super::retarget::{GRAVITY_M_S2, retarget};
use super::rig::Rig;
use crate::database::{DataError, Database};
use crate::gait::Gait;
use crate::limb::{Limb, Pair};
use crate::skeleton::{BONE_COUNT, Skeleton, bone};
use crate::stride::Stride;

/// The feet of a leap stand for the stored time up to this share of the stored speed; beyond it their steps would be too long.
const REACHING: f32 = 1.1;
/// Phases at which a gait's section is tried.
const PHASES: u32 = 24;

/// The leap's stride with what is to be known of its flight.
#[derive(Clone, Debug)]
pub(super) struct LeapClip {
    pub(super) clip: Clip,
    /// Phase at which the last hind hoof leaves the ground; the first strikes at zero.
    pub(super) take_off: f32,
    /// Phase at which the first forehoof lands.
    pub(super) landing: f32,
    /// Duration of the stored flight, s.
    pub(super) flight_s: f32,
    /// Height of the root at take-off and landing, metres.
    pub(super) heights_m: [f32; 2],
    /// The gait whose postures come nearest to the leap's beginning and end.
    pub(super) approach: Gait,
}

impl LeapClip {
    pub(super) fn new(
        database: &Database,
        reference: &Skeleton,
        skeleton: &Skeleton,
        rig: &Rig,
    ) -> Result<Self, DataError> {
        let missing = || DataError::Invalid("the database has no leap".to_owned());
        let stride = database.strides_of(Gait::Leap).next().ok_or_else(missing)?;
        let clip = retarget(stride, reference, rig).ok_or_else(|| {
            DataError::Invalid(format!("{}: a leg cannot reach the ground in the leap", skeleton.name))
        })?;
        let of = |pair: Pair| Limb::ALL.into_iter().filter(move |limb| limb.pair() == pair).map(Limb::index);
        let take_off =
            of(Pair::Hind).map(|i| (clip.strikes[i] + clip.duties[i]).rem_euclid(1.0)).fold(0.0, f32::max);
        let landing = of(Pair::Fore).map(|i| clip.strikes[i]).fold(1.0, f32::min);
        if landing <= take_off {
            return Err(DataError::Invalid(format!("{}: the leap has no flight", stride.id)));
        }
        let flight_s = (landing - take_off) * clip.stride_time_s;
        let heights_m = [take_off, landing].map(|phase| {
            let mut row = [0.0; super::clip::BODY_CHANNELS];
            clip.add_body(phase, 1.0, &mut row);
            row[super::clip::body::HEIGHT]
        });
        let approach = nearest_gait(stride, database);
        Ok(Self { clip, take_off, landing, flight_s, heights_m, approach })
    }

    /// Strides per second on the ground at a speed, m/s: faster than the stored leap, the feet stand for a shorter time.
    pub(super) fn rate_hz(&self, speed_m_s: f32) -> f32 {
        (speed_m_s / (REACHING * self.clip.speed_m_s)).max(1.0) / self.clip.stride_time_s
    }

    /// Duration of a flight that rises by a height, s.
    pub(super) fn flight_of_height_s(height_m: f32) -> f32 {
        (8.0 * height_m / GRAVITY_M_S2).sqrt()
    }
}

/// Moments of the leap's beginning and end that are compared: from a quarter of its stride before the hind feet strike to their
/// push.
const SECTION: [f32; 5] = [-0.25, -0.15, -0.05, 0.05, 0.15];

/// The gait with a lead whose section, at its speed nearest to the leap's, is most like the leap's own, by the bends of all leg
/// bones: mean square over section and legs, at the phase and side where it is least.
fn nearest_gait(leap: &Stride, database: &Database) -> Gait {
    let distance = |stride: &Stride, phase: f32, is_mirrored: bool| -> f32 {
        let moment = |offset: f32| {
            let (a, b) = (leap.pose(offset), stride.pose(phase + offset));
            let b = if is_mirrored { b.mirrored() } else { b };
            (bone::LIMBS..BONE_COUNT).map(|i| (a.bends_rad[i] - b.bends_rad[i]).powi(2)).sum::<f32>()
        };
        SECTION.into_iter().map(moment).sum()
    };
    let nearest = |gait: Gait| -> f32 {
        let off = |stride: &&Stride| (stride.speed_m_s / leap.speed_m_s - 1.0).abs();
        // Horses leap with the hind feet nearly together, out of a gait that has a lead.
        let strides = database.strides_of(gait).filter(|stride| stride.lead.is_some());
        let Some(stride) = strides.min_by(|a, b| off(a).total_cmp(&off(b))) else { return f32::INFINITY };
        let phases = (0..PHASES).map(|k| k as f32 / PHASES as f32);
        phases
            .flat_map(|phase| [false, true].map(|side| distance(stride, phase, side)))
            .fold(f32::INFINITY, f32::min)
    };
    let gaits = Gait::ALL.into_iter().filter(|gait| *gait != Gait::Leap);
    gaits.min_by(|a, b| nearest(*a).total_cmp(&nearest(*b))).unwrap_or(Gait::Canter)
}
