//! Prints that a planner was told one after another, as a plan of what it executed or as a track.

use std::f64::consts::TAU;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use anyhow::anyhow;
use clap::Args;
use muybridge_capture::write_atomically;
use muybridge_footprints::{Character, Model, Placed, Planner, Print, Terrain, Track, Weights};

use super::plan::View;
use super::sheet::Color;

/// Corners of a circle.
const CORNERS: u32 = 40;
/// Figures that plan: those on two legs.
const PLANNERS: [&str; 3] = ["bird", "dinosaur", "human"];

/// Options of all that plan.
#[derive(Debug, Args)]
pub(super) struct PlannerOptions {
    /// Who goes.
    #[arg(long, default_value = "bird", value_parser = clap::builder::PossibleValuesParser::new(PLANNERS))]
    pub(super) model: String,
    /// Seed of all chance.
    #[arg(long, default_value_t = 1)]
    pub(super) seed: u64,
    /// The plan as a picture (PNG, SVG), or the prints as a track (JSON).
    #[arg(long, value_name = "FILE")]
    pub(super) out: PathBuf,
    /// Width of the picture, px.
    #[arg(long, default_value_t = 1000, value_parser = clap::value_parser!(u32).range(480..=4000))]
    width: u32,
}

/// An area of the plan: its corners (x and z, metres), colour, and what it is.
pub(super) type Thing = (Vec<[f64; 2]>, Color, &'static str);

/// A round thing.
pub(super) fn circle(at_m: [f64; 2], radius_m: f64, color: Color, name: &'static str) -> Thing {
    let corner = |i: u32| {
        let (sin, cos) = (TAU * f64::from(i) / f64::from(CORNERS)).sin_cos();
        [at_m[0] + radius_m * cos, at_m[1] + radius_m * sin]
    };
    ((0..CORNERS).map(corner).collect(), color, name)
}

/// A rectangle between two corners.
pub(super) fn rectangle(
    [left, top]: [f64; 2],
    [right, bottom]: [f64; 2],
    color: Color,
    name: &'static str,
) -> Thing {
    (vec![[left, top], [right, top], [right, bottom], [left, bottom]], color, name)
}

/// A length in metres, as an argument.
pub(super) fn metres(text: &str) -> Result<f64, String> {
    let metres: f64 = text.parse().map_err(|_| "not a number".to_string())?;
    if (0.1..=1000.0).contains(&metres) { Ok(metres) } else { Err("between 0.1 and 1000 m".into()) }
}

impl PlannerOptions {
    pub(super) fn model(&self) -> anyhow::Result<Model> {
        Model::named(&self.model).ok_or_else(|| anyhow!("there is no {:?}", self.model))
    }

    /// Writes the track or the plan, by the ending of the file.
    pub(super) fn write(&self, title: &str, prints: Vec<Print>, things: Vec<Thing>) -> anyhow::Result<()> {
        let is_track = Path::new(&self.out).extension().is_some_and(|ending| ending == "json");
        if is_track {
            let track = Track { name: Some(title.into()), prints, ..Track::new(&self.model) };
            return Ok(write_atomically(&self.out, track.to_json().as_bytes())?);
        }
        let model = self.model()?;
        let mut planner = Planner::new(model.clone(), Terrain::Flat, Weights::default())?;
        for print in prints {
            planner.push(print)?;
        }
        let trajectory = planner.trajectory();
        let end_s = trajectory.times_s.last().copied().unwrap_or(0.0);
        let placed = Placed { end_s, ..planner.placed().clone() };
        let view = View {
            title: title.into(),
            about: "planned step by step".into(),
            character: &Character::Biped(Arc::new(model)),
            terrain: &Terrain::Flat,
            placed: &placed,
            trajectory,
            things,
        };
        view.draw(f64::from(self.width)).write(&self.out)
    }
}
