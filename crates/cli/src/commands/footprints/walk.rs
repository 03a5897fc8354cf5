//! A track file and the motion over it.

use std::path::Path;

use anyhow::{Context, anyhow, bail};
use glam::{DVec2, DVec3};
use muybridge_core::Skeleton;
use muybridge_footprints::{Character, Figure, MODEL_NAMES, Method, Motion, PlacedPrint, Track, TrackError};

/// Largest track file: ten thousand prints and a million heights are far smaller.
const LARGEST_BYTES: u64 = 64 << 20;

/// A solved track and who walks.
pub(super) struct Walk {
    pub(super) character: Character,
    pub(super) motion: Motion,
}

/// Reads a track.
///
/// # Errors
/// When the file cannot be read or is no track; with its name.
pub(super) fn read_track(path: &Path) -> anyhow::Result<Track> {
    let name = || path.display().to_string();
    let size = std::fs::metadata(path).with_context(name)?.len();
    if size > LARGEST_BYTES {
        bail!("{}: {} MB are too many for a track; is this the right file?", name(), size >> 20);
    }
    let text = std::fs::read_to_string(path).with_context(name)?;
    Track::from_json(&text).map_err(|error| in_file(path, &error))
}

/// An error with the file's name before each of its lines.
pub(super) fn in_file(path: &Path, error: &TrackError) -> anyhow::Error {
    let lines: Vec<String> =
        error.to_string().lines().map(|line| format!("{}: {line}", path.display())).collect();
    anyhow!(lines.join("\n"))
}

impl Walk {
    /// The motion over a track file.
    ///
    /// # Errors
    /// When the file is no track, or the track cannot be walked.
    pub(super) fn read(path: &Path, method: Method) -> anyhow::Result<Self> {
        let track = read_track(path)?;
        Self::solve(&track, method).map_err(|error| match error.downcast::<TrackError>() {
            Ok(error) => in_file(path, &error),
            Err(error) => error.context(path.display().to_string()),
        })
    }

    /// The motion over a track.
    ///
    /// # Errors
    /// When it cannot be walked.
    pub(super) fn solve(track: &Track, method: Method) -> anyhow::Result<Self> {
        let names = || MODEL_NAMES.join(", ");
        let character = Character::named(&track.model)
            .ok_or_else(|| anyhow!("model: there is no {:?}; the names are {}", track.model, names()))?;
        let motion = Motion::solve(track, &character, method)?;
        Ok(Self { character, motion })
    }

    /// What it is called.
    pub(super) fn title(&self) -> String {
        let track = &self.motion.track;
        track.name.clone().unwrap_or_else(|| format!("A track of the {}", track.model))
    }

    /// The outline of a print on the ground, world space, metres.
    pub(super) fn outline(&self, print: &PlacedPrint) -> Vec<DVec3> {
        outline(&self.character, print)
    }

    /// The horse's bones; none of a figure on two legs.
    pub(super) fn skeleton(&self) -> Option<&Skeleton> {
        match &self.character {
            Character::Biped(_) => None,
            Character::Horse(horse) => Some(horse.skeleton()),
        }
    }

    /// Where the body faces at a time, in the plan (x and z), unit length.
    pub(super) fn facing(&self, time_s: f64) -> DVec2 {
        let ahead = match self.motion.figure(time_s) {
            Figure::Biped(pose) => pose.world_from_body * DVec3::X,
            Figure::Horse(pose) => (pose.world_from_root * glam::Vec3::X).as_dvec3(),
        };
        DVec2::new(ahead.x, ahead.z).normalize_or(DVec2::X)
    }

    /// The ground's height below a place, metres.
    pub(super) fn ground_m(&self, at: DVec2) -> f64 {
        self.motion.track.terrain.on_ground(at.to_array()).y
    }
}

/// The outline of a print on the ground, world space, metres.
pub(super) fn outline(character: &Character, print: &PlacedPrint) -> Vec<DVec3> {
    // The left foot's is the mirror image.
    let side = if print.foot.index().is_multiple_of(2) { -1.0 } else { 1.0 };
    let place = |[x, z]: &[f64; 2]| print.middle + print.world_from_foot * DVec3::new(*x, 0.0, side * z);
    character.outline_m().iter().map(place).collect()
}
