//! `muybridge footprints lay`: prints along a path, written as a track.

use std::path::PathBuf;

use anyhow::bail;
use clap::Args;
use muybridge_capture::write_atomically;
use muybridge_core::{Gait, Lead, MPS_PER_MPH, Side};
use muybridge_footprints::{Laying, MODEL_NAMES, Method, PathPoint, StepTiming, Track, TrackGait};

use super::walk::{Walk, read_track};

/// Gait of a horse when only its speed is said.
const USUAL_GAIT: Gait = Gait::Walk;

/// Arguments of `lay`.
#[derive(Debug, Args)]
pub(in crate::commands) struct LayArguments {
    /// Track to start from: its ground, figure, gait and path hold where nothing else is said here.
    track: Option<PathBuf>,
    /// Who walks.
    #[arg(long, value_parser = clap::builder::PossibleValuesParser::new(MODEL_NAMES))]
    model: Option<String>,
    /// Points that the path goes through, metres: x ahead, z to the right. Where one begins with a minus, put them all in quotation
    /// marks: --path "0,0 -3,2".
    #[arg(long, value_name = "X,Z", num_args = 1.., value_parser = points)]
    path: Vec<Points>,
    /// Distance between successive prints, metres; of a horse the gait says it.
    #[arg(long, value_name = "METRES", value_parser = metres)]
    step_length: Option<f64>,
    /// Distance between the lines of left and right prints, metres.
    #[arg(long, value_name = "METRES", value_parser = metres)]
    step_width: Option<f64>,
    /// How long each foot stands, s; the distances say it when it is left out.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, requires = "step_time")]
    stance_time: Option<f64>,
    /// From one footfall to the next, s.
    #[arg(long, value_name = "SECONDS", value_parser = seconds, requires = "stance_time")]
    step_time: Option<f64>,
    /// Gait of a horse.
    #[arg(long, value_parser = gait)]
    gait: Option<Gait>,
    /// Speed of a horse, m/s.
    #[arg(long, value_name = "M/S", value_parser = speed)]
    speed: Option<f64>,
    /// Leading side of a horse in canter and gallop: left or right.
    #[arg(long, value_name = "SIDE", value_parser = side)]
    lead: Option<Side>,
    /// Name of the track.
    #[arg(long)]
    name: Option<String>,
    /// Track to write.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
}

fn number(text: &str) -> Result<f64, String> {
    let number: f64 = text.trim().parse().map_err(|_| format!("{text:?} is not a number"))?;
    if number.is_finite() { Ok(number) } else { Err("not a number".into()) }
}

/// Some points of a path, x and z, metres.
#[derive(Clone, Debug)]
struct Points(Vec<[f64; 2]>);

fn points(text: &str) -> Result<Points, String> {
    text.split_whitespace().map(point).collect::<Result<_, _>>().map(Points)
}

fn point(text: &str) -> Result<[f64; 2], String> {
    let (x, z) = text.split_once(',').ok_or("two numbers with a comma between them, such as 1.5,-0.2")?;
    Ok([number(x)?, number(z)?])
}

fn within(text: &str, range: std::ops::RangeInclusive<f64>, unit: &str) -> Result<f64, String> {
    let value = number(text)?;
    let wrong = || format!("between {} and {} {unit}", range.start(), range.end());
    if range.contains(&value) { Ok(value) } else { Err(wrong()) }
}

fn metres(text: &str) -> Result<f64, String> {
    within(text, 0.0..=20.0, "m")
}

fn seconds(text: &str) -> Result<f64, String> {
    within(text, 0.01..=600.0, "s")
}

fn speed(text: &str) -> Result<f64, String> {
    within(text, 0.1..=30.0, "m/s")
}

fn gait(text: &str) -> Result<Gait, String> {
    let names = || Gait::ALL.map(Gait::name).join(", ");
    Gait::from_name(text).ok_or_else(|| format!("no such gait; the names are {}", names()))
}

fn side(text: &str) -> Result<Side, String> {
    match text {
        "left" => Ok(Side::Left),
        "right" => Ok(Side::Right),
        _ => Err("left or right".into()),
    }
}

impl LayArguments {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        let wanted = self.track()?;
        // Solved at once: a path that nobody can walk is refused here, not when it is to be seen.
        let walk = Walk::solve(&wanted, Method::Gradient)?;
        let track = Track { path: wanted.path, ..walk.motion.track.clone() };
        write_atomically(&self.out, track.to_json().as_bytes())?;
        println!("{}: {} prints, {:.2} s", self.out.display(), track.prints.len(), walk.motion.duration_s());
        Ok(())
    }

    /// The track with a path and without prints.
    fn track(&self) -> anyhow::Result<Track> {
        let mut track = match (&self.track, &self.model) {
            (Some(path), _) => read_track(path)?,
            (None, Some(model)) => Track::new(model),
            (None, None) => {
                bail!("say who walks: a track to start from, or --model {}", MODEL_NAMES.join("|"))
            }
        };
        track.prints.clear();
        if let Some(model) = &self.model {
            track.model.clone_from(model);
        }
        track.name = self.name.clone().or(track.name);
        let mut laying = track.path.take().unwrap_or(Laying {
            points: Vec::new(),
            step_length_m: None,
            step_width_m: None,
            timing: None,
        });
        if !self.path.is_empty() {
            let all = self.path.iter().flat_map(|points| &points.0);
            laying.points = all.map(|&at_m| PathPoint { at_m, tangent_m: None }).collect();
        }
        if laying.points.is_empty() {
            bail!("no path; give points such as --path 0,0 3,0 5,2");
        }
        laying.step_length_m = self.step_length.or(laying.step_length_m);
        laying.step_width_m = self.step_width.or(laying.step_width_m);
        if let (Some(stance_time_s), Some(step_time_s)) = (self.stance_time, self.step_time) {
            laying.timing = Some(StepTiming { stance_time_s, step_time_s });
        }
        track.path = Some(laying);
        self.choose_gait(&mut track);
        Ok(track)
    }

    fn choose_gait(&self, track: &mut Track) {
        if self.gait.is_none() && self.speed.is_none() && self.lead.is_none() {
            return;
        }
        let before = track.gait;
        let lead = self.lead.map(|side| Lead { fore: side, hind: side });
        let gait = self.gait.or(before.map(|before| before.gait)).unwrap_or(USUAL_GAIT);
        let usual_m_s = gait.speed_range_mph().map(|[low, high]| 0.5 * (low + high) * MPS_PER_MPH);
        let speed_m_s = self.speed.or(before.map(|before| before.speed_m_s)).or(usual_m_s).unwrap_or(1.5);
        track.gait =
            Some(TrackGait { gait, speed_m_s, lead: lead.or(before.and_then(|before| before.lead)) });
    }
}
