//! Everything a horse of one build can do: the database's strides made ready for its skeleton.

use super::clip::Clip;
use super::leap_clip::LeapClip;
use super::retarget::retarget;
use super::rig::Rig;
use crate::database::{DataError, Database};
use crate::gait::Gait;
use crate::law::MPS_PER_MPH;
use crate::limb::{Limb, Side};
use crate::pose::Pose;
use crate::provenance::Provenance;
use crate::skeleton::Skeleton;

/// How far below its slowest and above its fastest stride a gait is played at a changed rate: what the gaps between the gaits'
/// ranges need (Huang 2012, Fig. 3.6 has none between 5 and 6, 9 and 10, 25 and 26 miles per hour).
const RATE_MARGIN: [f32; 2] = [0.8, 1.12];
/// The slowest walk is played down to this share of its speed: slower, a horse stands between its steps.
const SLOWEST_WALK: f32 = 0.6;

/// A way of moving: a gait, with its lead.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub(super) struct Way {
    pub(super) gait: Gait,
    /// Played as seen in a mirror: the database's asymmetric strides have one lead.
    pub(super) is_mirrored: bool,
}

impl Way {
    /// Number of ways: six gaits and the leap, each either way round.
    pub(super) const COUNT: usize = 14;

    pub(super) fn of(gait: Gait) -> Self {
        Self { gait, is_mirrored: false }
    }

    pub(super) fn index(self) -> usize {
        2 * self.gait as usize + usize::from(self.is_mirrored)
    }

    pub(super) fn from_index(index: usize) -> Self {
        Self { gait: Gait::ALL[index / 2], is_mirrored: index % 2 == 1 }
    }

    /// The leg of the stored stride that this leg does.
    pub(super) fn stored(self, limb: usize) -> usize {
        if self.is_mirrored { limb ^ 1 } else { limb }
    }
}

/// The strides of a gait, slowest first.
#[derive(Clone, Debug)]
struct Strides {
    clips: Vec<Clip>,
    lead: Option<Side>,
}

/// The database's motion made ready for one skeleton: every gait at every speed, solved for its legs. Horses of one build share it.
#[derive(Clone, Debug)]
pub struct Repertoire {
    skeleton: Skeleton,
    pub(super) rig: Rig,
    pub(super) standing: Pose,
    /// Toes of the standing pose ahead of the root, metres.
    pub(super) standing_toes_m: [f32; 4],
    gaits: [Strides; 6],
    pub(super) leap: LeapClip,
    /// Leg length over the reference horse's: lengths go with it, times and speeds with its root.
    pub(super) size: f32,
}

/// A way of moving at a speed: two strides and the share between them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Paced<'a> {
    pub(super) way: Way,
    pub(super) slower: &'a Clip,
    pub(super) faster: &'a Clip,
    pub(super) share: f32,
}

impl Repertoire {
    /// Makes the motion ready: some tens of milliseconds.
    ///
    /// # Errors
    /// When the database lacks one of the six gaits or the leap, or a leg cannot reach the ground with this skeleton.
    pub fn new(database: &Database, skeleton: &Skeleton) -> Result<Self, DataError> {
        let (reference, rig) = (Skeleton::reference(), Rig::new(skeleton));
        let strides = |gait| Strides::new(database, gait, &reference, skeleton, &rig);
        let gaits = [
            strides(Gait::Walk)?,
            strides(Gait::Amble)?,
            strides(Gait::Trot)?,
            strides(Gait::Rack)?,
            strides(Gait::Canter)?,
            strides(Gait::Gallop)?,
        ];
        let leg_m = |rig: &Rig| rig.legs.iter().map(super::rig::LegRig::length_m).sum::<f32>();
        let size = leg_m(&rig) / leg_m(&Rig::new(&reference));
        let leap = LeapClip::new(database, &reference, skeleton, &rig)?;
        let standing = standing(skeleton, &rig);
        let girdles = rig.girdles(&standing);
        let standing_toes_m = Limb::ALL.map(|limb| {
            let bends = super::retarget::leg_bends(&standing, limb);
            rig.legs[limb.index()].toe(&girdles[limb.index()], &bends).x
        });
        Ok(Self { skeleton: skeleton.clone(), rig, standing, standing_toes_m, gaits, leap, size })
    }

    /// The skeleton it is made for.
    pub fn skeleton(&self) -> &Skeleton {
        &self.skeleton
    }

    /// Slowest and fastest stride of a gait, m/s; for the leap those of the gallop.
    pub fn speed_range_m_s(&self, gait: Gait) -> [f32; 2] {
        let clips = &self.gaits[(gait as usize).min(5)].clips;
        [clips[0].speed_m_s, clips[clips.len() - 1].speed_m_s]
    }

    /// The speeds a gait is played at without changing to another, m/s.
    pub(super) fn playable_m_s(&self, gait: Gait) -> [f32; 2] {
        let [low, high] = self.speed_range_m_s(gait);
        let least = if gait == Gait::Walk { SLOWEST_WALK } else { RATE_MARGIN[0] };
        let most = if gait == Gait::Gallop { 1.0 } else { RATE_MARGIN[1] };
        [low * least, high * most]
    }

    /// Miles per hour of a reference horse at an equal Froude number.
    pub(super) fn equivalent_mph(&self, speed_m_s: f32) -> f32 {
        speed_m_s / (self.size.sqrt() * MPS_PER_MPH as f32)
    }

    /// Speed of this horse at an equal Froude number as a reference horse's in miles per hour, m/s.
    pub(super) fn speed_m_s(&self, mph: f32) -> f32 {
        mph * self.size.sqrt() * MPS_PER_MPH as f32
    }

    /// The way of a gait with a lead on this side.
    pub(super) fn way(&self, gait: Gait, lead: Side) -> Way {
        match self.gaits.get(gait as usize).and_then(|strides| strides.lead) {
            Some(stored) => Way { gait, is_mirrored: stored != lead },
            None => Way::of(gait),
        }
    }

    /// Leading side of a way.
    pub(super) fn lead(&self, way: Way) -> Option<Side> {
        let stored = self.gaits.get(way.gait as usize)?.lead?;
        Some(if way.is_mirrored { stored.opposite() } else { stored })
    }

    /// A way of moving at a speed, held within the strides there are.
    pub(super) fn paced(&self, way: Way, speed_m_s: f32) -> Paced<'_> {
        let Some(strides) = self.gaits.get(way.gait as usize) else {
            let clip = &self.leap.clip;
            return Paced { way, slower: clip, faster: clip, share: 0.0 };
        };
        let clips = &strides.clips;
        let above =
            clips.partition_point(|clip| clip.speed_m_s <= speed_m_s).clamp(1, clips.len().max(2) - 1);
        let (slower, faster) = (&clips[above - 1], clips.get(above).unwrap_or(&clips[above - 1]));
        let between = faster.speed_m_s - slower.speed_m_s;
        let share =
            if between > 0.0 { ((speed_m_s - slower.speed_m_s) / between).clamp(0.0, 1.0) } else { 0.0 };
        Paced { way, slower, faster, share }
    }
}

/// The rest pose with every toe on the ground.
fn standing(skeleton: &Skeleton, rig: &Rig) -> Pose {
    let mut pose = Pose::standing(skeleton);
    let girdles = rig.girdles(&pose);
    let toes = Limb::ALL.map(|limb| {
        rig.legs[limb.index()].toe(&girdles[limb.index()], &super::retarget::leg_bends(&pose, limb))
    });
    // The shortest leg decides; the others bend until their toes are there.
    let height_m = toes.iter().map(|toe| -toe.y).fold(f32::INFINITY, f32::min);
    pose.root_in_world.y = height_m;
    for limb in Limb::ALL {
        let leg = &rig.legs[limb.index()];
        let toe = toes[limb.index()].with_y(-height_m);
        let aim = super::rig::Aim { toe, hoof_turn_rad: 0.0, load: 1.0, keeps_hoof: 0.0 };
        let start = super::retarget::leg_bends(&pose, limb);
        let reached = leg.solve(&girdles[limb.index()], &start, &aim);
        let first = limb.first_bone() + 1;
        pose.bends_rad[first..first + 4].copy_from_slice(&reached.bends_rad);
    }
    pose
}

impl Strides {
    fn new(
        database: &Database,
        gait: Gait,
        reference: &Skeleton,
        skeleton: &Skeleton,
        rig: &Rig,
    ) -> Result<Self, DataError> {
        let made: Vec<_> = database
            .strides_of(gait)
            .filter(|stride| !matches!(stride.provenance, Provenance::Captured { .. }))
            .collect();
        let clips: Option<Vec<Clip>> = made.iter().map(|stride| retarget(stride, reference, rig)).collect();
        let clips = clips.ok_or_else(|| {
            DataError::Invalid(format!("{}: a leg cannot reach the ground at the {gait}", skeleton.name))
        })?;
        if clips.is_empty() {
            return Err(DataError::Invalid(format!("the database has no {gait} at whole miles per hour")));
        }
        Ok(Self { clips, lead: made[0].lead.map(|lead| lead.fore) })
    }
}
