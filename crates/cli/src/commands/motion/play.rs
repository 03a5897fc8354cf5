//! `muybridge motion play`: a ride as a table, or as every frame of it.

use anyhow::bail;
use clap::Args;

use super::super::output::print;
use super::options::RideOptions;
use super::records::{write_csv, write_json};
use super::ride::Ride;
use super::table::{write_footfalls, write_table};

/// Arguments of `play`.
#[derive(Debug, Args)]
pub(in crate::commands) struct PlayArguments {
    #[command(flatten)]
    ride: RideOptions,
    /// A line for each so many seconds, or for each `footfall`.
    #[arg(long, value_name = "SECONDS|footfall", default_value = "0.1", value_parser = each)]
    each: Each,
    /// Strides of a gait that is named with `--gait` or `--speed`.
    #[arg(long, default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=1000))]
    strides: u32,
    /// Every frame as one JSON document: root, joint angles, contacts.
    #[arg(long, conflicts_with_all = ["each", "csv"])]
    json: bool,
    /// Every frame as a line of a table (CSV): root, joint angles, contacts.
    #[arg(long, conflicts_with = "each")]
    csv: bool,
}

/// When a line is printed.
#[derive(Clone, Copy, Debug)]
enum Each {
    Seconds(f64),
    Footfall,
}

fn each(text: &str) -> Result<Each, String> {
    let wanted = || "a time between 0.01 and 60 s, or `footfall`".to_string();
    if text == "footfall" {
        return Ok(Each::Footfall);
    }
    let seconds: f64 = text.parse().map_err(|_| wanted())?;
    if (0.01..=60.0).contains(&seconds) { Ok(Each::Seconds(seconds)) } else { Err(wanted()) }
}

impl PlayArguments {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        let mut ride = Ride::start(&self.ride)?;
        let duration_s = ride.duration_s(f64::from(self.strides));
        let frame_s = 1.0 / self.ride.horse.rate;
        if !duration_s.is_finite() {
            bail!("the horse stands; give a ride or a speed");
        }
        print(|out| match self.each {
            _ if self.json => write_json(out, &mut ride, duration_s, frame_s),
            _ if self.csv => write_csv(out, &mut ride, duration_s, frame_s),
            Each::Footfall => write_footfalls(out, &mut ride, duration_s, frame_s),
            Each::Seconds(row_s) => write_table(out, &mut ride, duration_s, row_s, frame_s),
        })
    }
}
