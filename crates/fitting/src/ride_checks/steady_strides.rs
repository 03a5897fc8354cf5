//! Every gait at every speed as the horse goes it, judged by the rules that the database's strides are judged by.

use std::sync::Arc;

use muybridge_core::{Database, Gait, MPS_PER_MPH, Provenance, Repertoire, Skeleton};

use super::findings::{Findings, Limits, Part};
use super::steady::{Recorded, command, record, settled};
use crate::database_checks::{Check, Deviation, KNOWN_DEVIATIONS, Known, check_database, stale, unexplained};

/// Between its samples the curve of a recorded stride misses the motion: by so much at a strike, m. The feet themselves are inspected at
/// every step.
const RESAMPLED_SLIDE_M: f64 = 0.005;
/// The same over the ground at a lift-off, m: a toe leaves it within a sample.
const RESAMPLED_FLOAT_M: f64 = 0.007;
/// Greatest difference of a bend from one stride to the next, rad.
const UNSTEADY_RAD: f64 = 0.005;

/// What the reference horse does and the horses of the plates do not.
pub const KNOWN_WHEN_RIDDEN: &[Known] = &[Known {
    stride_prefix: "chopper-walking@5mph",
    check: Check::HindPrint,
    reason: "the walker's trunk is 0.62 of his height, the reference horse's 0.51: in the same stride its hind feet step 0.19 m farther",
}];

/// What the strides of every gait at every whole and half mile per hour show.
#[derive(Clone, Debug)]
pub struct SteadyStrides {
    /// The strides, as a database of their own.
    pub database: Database,
    /// What keeps a gait from being recorded, in plain words.
    pub faults: Vec<String>,
    /// Greatest angle out of the planes along the track of any stride, rad.
    pub sideways_rad: f64,
    /// The worst of what the inspector saw.
    pub findings: Findings,
}

impl SteadyStrides {
    /// Rides and records every gait at every `every_mph` of its range.
    pub fn ride(repertoire: &Arc<Repertoire>, source: &Database, every_mph: f64) -> Self {
        let database = Database {
            schema: source.schema,
            generator: "synthesised at run time".into(),
            laws: Vec::new(),
            strides: Vec::new(),
        };
        let (faults, findings) = (Vec::new(), Findings::default());
        let mut found = Self { database, faults, sideways_rad: 0.0, findings };
        for (gait, mph) in gaits_and_speeds(every_mph) {
            match ride_one(repertoire, source, gait, mph) {
                Ok(recorded) => {
                    let broken = recorded.findings.broken(&Limits::smooth());
                    found.faults.extend(broken.iter().map(|b| format!("{gait} at {mph} mph: {b}")));
                    let (bone, rad) = recorded.unsteady;
                    if rad > UNSTEADY_RAD {
                        let bone = Part::Bone(bone).name(repertoire.skeleton());
                        found.faults.push(format!(
                            "{gait} at {mph} mph: {bone} is bent {rad:.4} rad otherwise a stride later"
                        ));
                    }
                    found.findings.merge(&recorded.findings);
                    found.sideways_rad = found.sideways_rad.max(recorded.sideways_rad);
                    found.database.strides.push(recorded.stride);
                }
                Err(fault) => found.faults.push(fault),
            }
        }
        found
    }

    /// What no horse does, but for what the photographs of the gait's own horse show, too.
    pub fn deviations(&self) -> Vec<Deviation> {
        unexplained(&unexplained(&self.judged(), KNOWN_DEVIATIONS), KNOWN_WHEN_RIDDEN)
    }

    /// Entries of [`KNOWN_WHEN_RIDDEN`] that occur no more and must go.
    pub fn stale(&self) -> Vec<Known> {
        stale(&self.judged(), KNOWN_WHEN_RIDDEN)
    }

    /// What the database's rules find, but for what recording a motion in samples adds to it.
    fn judged(&self) -> Vec<Deviation> {
        let resampled = |deviation: &Deviation| match deviation.check {
            Check::ToeSlides | Check::PrintMisplaced => deviation.value < RESAMPLED_SLIDE_M,
            Check::ToeFloats => deviation.value < RESAMPLED_FLOAT_M,
            // A recorded stride has not been cut open: its end is compared with its beginning directly, and a strike or a lift-off may
            // well lie at its seam.
            Check::NotClosed => true,
            _ => false,
        };
        let found = check_database(&self.database, &Skeleton::reference());
        found.into_iter().filter(|deviation| !resampled(deviation)).collect()
    }
}

/// Every gait at every `every_mph` of its range, mph.
pub fn gaits_and_speeds(every_mph: f64) -> impl Iterator<Item = (Gait, f64)> {
    let ranged = Gait::ALL.into_iter().filter_map(|gait| Some((gait, gait.speed_range_mph()?)));
    ranged.flat_map(move |(gait, [low, high])| {
        let steps = ((high - low) / every_mph).round() as usize;
        (0..=steps).map(move |k| (gait, low + every_mph * k as f64))
    })
}

fn ride_one(
    repertoire: &Arc<Repertoire>,
    source: &Database,
    gait: Gait,
    mph: f64,
) -> Result<Recorded, String> {
    let speed_m_s = mph * MPS_PER_MPH;
    let command = command(Some(gait), speed_m_s, None);
    let horse = settled(repertoire, &command, 1)?;
    let blend =
        source.at_speed(gait, speed_m_s as f32).ok_or_else(|| format!("{gait}: not in the database"))?;
    let from = vec![blend.slower.id.clone(), blend.faster.id.clone()];
    // The name of the plate it comes from, so that what that plate is known for is known of it.
    let family = from[0].split('@').next().unwrap_or_default();
    let id = format!("{family}@{mph}mph");
    let how = "synthesised at run time and recorded over one stride".into();
    record(&horse, &command, &id, Provenance::Derived { from, how })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_gait_has_whole_and_half_miles_per_hour() {
        let rows: Vec<_> = gaits_and_speeds(0.5).collect();
        assert_eq!(rows.iter().filter(|row| row.0 == Gait::Walk).count(), 9);
        assert_eq!(rows.last(), Some(&(Gait::Gallop, 40.0)));
    }
}
