//! Options that all of `muybridge motion` share: which ride, which horse, which ground.

use std::path::PathBuf;

use anyhow::Context;
use clap::Args;
use muybridge_core::{Gait, MPS_PER_MPH, Side};

use crate::ride_script::{RIDE_FACTORS, RideGround, RideScript, RideStep};

/// The ride that is taken when none is named.
const USUAL_RIDE: &str = include_str!("../../../../../docs/rides/walk-to-gallop.json");

/// The horse.
#[derive(Debug, Args)]
pub(super) struct HorseOptions {
    /// Skeleton file, in the form of `crates/core/data/horse.json`.
    #[arg(long, value_name = "FILE")]
    skeleton: Option<PathBuf>,
    /// Multiply all leg bones: 0.7 for short legs, 1.3 for long ones.
    #[arg(long, value_name = "FACTOR", value_parser = factor)]
    legs: Option<f32>,
    /// Multiply the whole horse: 0.7 for a pony.
    #[arg(long, value_name = "FACTOR", value_parser = factor)]
    size: Option<f32>,
    /// Seed of all chance.
    #[arg(long)]
    seed: Option<u64>,
    /// Steps of the simulation per second.
    #[arg(long, value_name = "HZ", default_value_t = 60.0, value_parser = rate)]
    pub(super) rate: f64,
}

/// What it does, and where.
#[derive(Debug, Args)]
pub(super) struct RideOptions {
    /// Ride script (see docs/rides/); without it, from walk to gallop through all gaits.
    #[arg(conflicts_with_all = ["gait", "speed", "lead"])]
    script: Option<PathBuf>,
    /// One gait as it goes on and on, instead of a script.
    #[arg(long, value_parser = gait)]
    gait: Option<Gait>,
    /// Its speed in m/s, or in miles per hour with `mph` after the number; without a gait, the one the horse chooses at it.
    #[arg(long, value_parser = speed)]
    speed: Option<f32>,
    /// Its leading side: left or right.
    #[arg(long, value_name = "SIDE", value_parser = side)]
    lead: Option<Side>,
    /// `flat`, `slope:DEGREES`, `ridge:DEGREES`, `steps:METRES` or `hills:METRES`.
    #[arg(long, allow_hyphen_values = true)]
    ground: Option<RideGround>,
    #[command(flatten)]
    pub(super) horse: HorseOptions,
}

impl HorseOptions {
    /// Gives a ride the horse that is asked for here.
    pub(super) fn choose(&self, ride: &mut RideScript) {
        if let Some(skeleton) = &self.skeleton {
            ride.skeleton = Some(skeleton.clone());
        }
        ride.legs = self.legs.unwrap_or(ride.legs);
        ride.size = self.size.unwrap_or(ride.size);
        ride.seed = self.seed.unwrap_or(ride.seed);
    }
}

impl RideOptions {
    /// The ride with everything that is asked for here.
    pub(super) fn ride(&self) -> anyhow::Result<RideScript> {
        let mut ride = match &self.script {
            Some(path) => RideScript::read(path)?,
            None if self.is_one_gait() => self.one_gait(),
            None => serde_json::from_str(USUAL_RIDE).context("the usual ride")?,
        };
        ride.ground = self.ground.unwrap_or(ride.ground);
        self.horse.choose(&mut ride);
        Ok(ride)
    }

    /// Whether it is one gait that goes on and on.
    pub(super) fn is_one_gait(&self) -> bool {
        self.gait.is_some() || self.speed.is_some() || self.lead.is_some()
    }

    fn one_gait(&self) -> RideScript {
        let middle_m_s = |[low, high]: [f64; 2]| (0.5 * (low + high) * MPS_PER_MPH) as f32;
        let gait = self.gait.unwrap_or(if self.lead.is_some() { Gait::Canter } else { Gait::Walk });
        let usual_m_s = gait.speed_range_mph().map(middle_m_s);
        let gait = if self.gait.is_none() && self.speed.is_some() { None } else { Some(gait) };
        RideScript::of(RideStep {
            speed_m_s: self.speed.or(usual_m_s),
            gait,
            lead: self.lead,
            ..RideStep::default()
        })
    }
}

fn number(text: &str) -> Result<f64, String> {
    text.trim().parse().map_err(|_| "not a number".into())
}

fn factor(text: &str) -> Result<f32, String> {
    let factor = number(text)?;
    let [least, most] = [RIDE_FACTORS.start(), RIDE_FACTORS.end()];
    if RIDE_FACTORS.contains(&factor) {
        Ok(factor as f32)
    } else {
        Err(format!("between {least} and {most}"))
    }
}

fn rate(text: &str) -> Result<f64, String> {
    let rate = number(text)?;
    if (10.0..=1000.0).contains(&rate) { Ok(rate) } else { Err("between 10 and 1000 steps a second".into()) }
}

/// A speed in m/s, from m/s or mph.
pub(super) fn speed(text: &str) -> Result<f32, String> {
    let m_s = match text.strip_suffix("mph") {
        Some(mph) => number(mph)? * MPS_PER_MPH,
        None => number(text.strip_suffix("m/s").unwrap_or(text))?,
    };
    if (0.1..=30.0).contains(&m_s) { Ok(m_s as f32) } else { Err("between 0.1 and 30 m/s (67 mph)".into()) }
}

fn gait(text: &str) -> Result<Gait, String> {
    let strides = |gait: &Gait| *gait != Gait::Leap;
    let names = || Gait::ALL.into_iter().filter(strides).map(Gait::name).collect::<Vec<_>>().join(", ");
    Gait::from_name(text)
        .filter(strides)
        .ok_or_else(|| format!("no gait of strides; the names are {}", names()))
}

fn side(text: &str) -> Result<Side, String> {
    match text {
        "left" => Ok(Side::Left),
        "right" => Ok(Side::Right),
        _ => Err("left or right".into()),
    }
}
