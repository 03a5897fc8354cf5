//! `muybridge tracks`: strides and contacts out of machine-tracked films of walking horses.

use std::path::{Path, PathBuf};

use anyhow::{Context, bail};
use clap::{Args, Subcommand};
use muybridge_capture::write_atomically;
use muybridge_core::{Limb, Pair};
use muybridge_fitting::law::LawFit;
use muybridge_fitting::tracked::clip::Clip;
use muybridge_fitting::tracked::contacts::Edge;
use muybridge_fitting::tracked::strides::{Flag, MeasuredStride};
use muybridge_fitting::tracked::table::write_table;
use muybridge_fitting::tracked::walk_law::{WITHERS_HEIGHT_M, WITHERS_HEIGHT_SD_M, WalkLaws};
use muybridge_fitting::tracked::{FRAMES_PER_S, Film, Measurement, measure, median};

/// Frame rates that a film can have.
const RATES: std::ops::RangeInclusive<f64> = 1.0..=1000.0;

/// The subcommands.
#[derive(Debug, Subcommand)]
pub(super) enum TracksCommand {
    /// Measure the strides of a folder of clips and write their table. Example: `muybridge tracks measure ../tracked-walks`
    Measure(MeasureArguments),
    /// Print when each hoof of a clip is on the ground. Example: `muybridge tracks contacts walk.csv`
    Contacts(ContactsArguments),
}

/// Arguments of `measure`.
#[derive(Debug, Args)]
pub(super) struct MeasureArguments {
    /// Folder of clips: tables with x, y and likelihood, as `DeepLabCut` writes them (`*.csv`).
    folder: PathBuf,
    /// Frames per second of the clips.
    #[arg(long, default_value_t = FRAMES_PER_S, value_parser = rate)]
    fps: f64,
    /// Table to write.
    #[arg(long, value_name = "FILE", default_value = "annotations/tracked-walks.csv")]
    out: PathBuf,
}

/// Arguments of `contacts`.
#[derive(Debug, Args)]
pub(super) struct ContactsArguments {
    /// A clip.
    clip: PathBuf,
    /// Frames per second of the clip.
    #[arg(long, default_value_t = FRAMES_PER_S, value_parser = rate)]
    fps: f64,
}

impl TracksCommand {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        match self {
            Self::Measure(arguments) => measure_folder(arguments),
            Self::Contacts(arguments) => contacts(arguments),
        }
    }
}

fn rate(text: &str) -> Result<f64, String> {
    let rate: f64 = text.parse().map_err(|_| "not a number".to_string())?;
    if RATES.contains(&rate) { Ok(rate) } else { Err("between 1 and 1000 frames per second".into()) }
}

/// The tables of a folder in the order of their names.
fn clip_paths(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    let name = || folder.display().to_string();
    for entry in std::fs::read_dir(folder).with_context(name)? {
        let path = entry.with_context(name)?.path();
        if path.extension().is_some_and(|ending| ending == "csv") {
            paths.push(path);
        }
    }
    paths.sort();
    if paths.is_empty() {
        bail!("{}: no clips (*.csv) in this folder", folder.display());
    }
    Ok(paths)
}

fn measure_folder(arguments: &MeasureArguments) -> anyhow::Result<()> {
    let paths = clip_paths(&arguments.folder)?;
    let film = Film::at_rate(arguments.fps);
    let mut measurements = Vec::new();
    for path in &paths {
        match Clip::read(path) {
            Ok(clip) => measurements.push(measure(&clip, &film)),
            Err(error) => eprintln!("error: {error}"),
        }
    }
    let strides: Vec<MeasuredStride> = measurements.iter().flat_map(|m| m.strides.iter().cloned()).collect();
    if !strides.is_empty() {
        write_atomically(&arguments.out, &write_table(&strides)?)?;
    }
    print_summary(&measurements, &strides);
    if !strides.is_empty() {
        println!("{}", arguments.out.display());
    }
    let unread = paths.len() - measurements.len();
    if unread > 0 {
        bail!("{unread} of {} clips could not be read", paths.len());
    }
    Ok(())
}

fn print_summary(measurements: &[Measurement], strides: &[MeasuredStride]) {
    let sum = |count: &dyn Fn(&Measurement) -> usize| measurements.iter().map(count).sum::<usize>();
    println!(
        "{} clips: {} drop-outs, {} jumps, {} left-right swaps put right ({} frames)",
        measurements.len(),
        sum(&|m| m.faults.drop_outs),
        sum(&|m| m.faults.jumps),
        sum(&|m| m.faults.swaps),
        sum(&|m| m.faults.swapped_frames),
    );
    let usable: Vec<&MeasuredStride> = strides.iter().filter(|stride| stride.is_usable()).collect();
    println!(
        "{} usable strides of {} stances; the others (a stride may have several reasons):",
        usable.len(),
        strides.len()
    );
    for flag in Flag::ALL {
        let flagged = strides.iter().filter(|stride| stride.flags.contains(&flag)).count();
        if flagged > 0 {
            let only = strides.iter().filter(|stride| stride.flags == [flag]).count();
            println!("  {:24} {flagged:4}  ({only} for this reason alone)", flag.name());
        }
    }
    for (pair, name) in [(Pair::Fore, "fore"), (Pair::Hind, "hind")] {
        let of_pair = usable.iter().filter(|stride| stride.limb.pair() == pair);
        let duty = median(of_pair.clone().filter_map(|stride| stride.duty_factor).collect());
        if let Some(duty) = duty {
            println!("{name}: {} strides, median duty factor {duty:.3}", of_pair.count());
        }
    }
    let mut speeds: Vec<f64> = usable
        .iter()
        .filter_map(|stride| stride.speed_withers_heights_per_s)
        .map(|v| v * WITHERS_HEIGHT_M)
        .collect();
    speeds.sort_by(f64::total_cmp);
    if let (Some(low), Some(high)) = (speeds.first(), speeds.last()) {
        println!(
            "speeds {low:.2} to {high:.2} m/s, withers assumed {WITHERS_HEIGHT_M} m high (sd {WITHERS_HEIGHT_SD_M} m)"
        );
    }
    match WalkLaws::new(strides) {
        Some(laws) => {
            print_law("stance, fore", &laws.fore);
            print_law("stance, hind", &laws.hind);
            print_law("stride time", &laws.stride_time);
        }
        None => println!("too few clips with usable strides for a law"),
    }
}

fn print_law(name: &str, fit: &LawFit) {
    let interval = fit.interval.map_or("no interval".into(), |interval| {
        let [[a0, a1], [b0, b1]] = [interval.a, interval.b];
        format!("95 %: a {a0:.3} to {a1:.3}, b {b0:.3} to {b1:.3}")
    });
    let explained = fit.r_squared.map_or(String::new(), |share| format!(", R^2 {share:.2}"));
    println!(
        "{name}: {:.3} s (v / 1 m/s)^{:.3}, {} clips, {interval}{explained}",
        fit.curve.a, fit.curve.b, fit.n
    );
}

fn contacts(arguments: &ContactsArguments) -> anyhow::Result<()> {
    let clip = Clip::read(&arguments.clip)?;
    let measurement = measure(&clip, &Film::at_rate(arguments.fps));
    println!("limb,strike_frame,lift_off_frame");
    let cell = |edge: Edge| edge.frame().map(|frame| format!("{frame:.2}")).unwrap_or_default();
    for limb in Limb::ALL {
        for stance in &measurement.stances[limb.index()] {
            println!("{},{},{}", limb.abbreviation(), cell(stance.strike), cell(stance.lift_off));
        }
    }
    if measurement.stances.iter().all(Vec::is_empty) {
        let reasons: Vec<&str> = measurement
            .strides
            .iter()
            .take(1)
            .flat_map(|stride| &stride.flags)
            .map(|flag| flag.name())
            .collect();
        bail!("{}: no contacts: {}", arguments.clip.display(), reasons.join(", "));
    }
    Ok(())
}
