//! `muybridge average`: one stride from the many of a tracked clip, written as a plate.

use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;
use muybridge_capture::{NearOff, relative_path, write_json};
use muybridge_core::{Gait, Pair};
use muybridge_fitting::averaged::{Clip, HoofStance, MeanStride, Plan, documents};

/// Average the strides of a tracked clip into one, written as a plate to fit. Example: `muybridge average in-hand-trot.csv --id in-hand-trot --gait trot`
#[derive(Debug, Args)]
pub(super) struct AverageArguments {
    /// Table of points by frame (CSV: `NAME_x`, `NAME_y`, perhaps `NAME_likelihood`).
    table: PathBuf,
    /// Identifier of the plate to write.
    #[arg(long, value_parser = identifier)]
    id: String,
    /// Gait, by name.
    #[arg(long, value_parser = gait)]
    gait: Gait,
    /// Height of the animal at the withers, m; assumed, for a film shows no lengths.
    #[arg(long, value_name = "M", default_value_t = 1.60, value_parser = withers_height)]
    withers: f64,
    /// Folder of manifests.
    #[arg(long, value_name = "FOLDER", default_value = "plates")]
    plates: PathBuf,
    /// Folder of annotations.
    #[arg(long, value_name = "FOLDER", default_value = "annotations")]
    annotations: PathBuf,
}

fn identifier(text: &str) -> Result<String, String> {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
    let good = !text.is_empty() && text.chars().all(plain);
    if good { Ok(text.into()) } else { Err("lower-case letters, digits and hyphens only".into()) }
}

fn gait(text: &str) -> Result<Gait, String> {
    let strides = |gait: &Gait| *gait != Gait::Leap;
    let names = || Gait::ALL.into_iter().filter(strides).map(Gait::name).collect::<Vec<_>>().join(", ");
    Gait::from_name(text)
        .filter(strides)
        .ok_or_else(|| format!("no gait of strides; the names are {}", names()))
}

fn withers_height(text: &str) -> Result<f64, String> {
    let height: f64 = text.parse().map_err(|_| "not a number".to_string())?;
    if (0.5..=2.2).contains(&height) { Ok(height) } else { Err("no horse's; between 0.5 and 2.2 m".into()) }
}

impl AverageArguments {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        let clip = Clip::read(&self.table)?;
        let mean = MeanStride::new(&clip, self.gait).with_context(|| self.table.display().to_string())?;
        let file = |folder: &Path| folder.join(format!("{}.json", self.id));
        let (manifest_path, annotation_path) = (file(&self.plates), file(&self.annotations));
        let plan = Plan {
            id: self.id.clone(),
            gait: self.gait,
            withers_height_m: self.withers,
            plate: relative_path(&annotation_path, &manifest_path),
        };
        let (manifest, annotation) = documents(&clip, &mean, &plan);
        write_json(&manifest_path, &manifest)?;
        write_json(&annotation_path, &annotation)?;
        print!("{}", told(&mean));
        println!("{}\n{}", manifest_path.display(), annotation_path.display());
        Ok(())
    }
}

/// What was found, in words.
fn told(mean: &MeanStride) -> String {
    let strides = mean.strides;
    let [median, worst] = mean.spread().map(|spread| 100.0 * spread);
    let mut text = format!(
        "{:.1} strides of {:.2} frames; a stride explains {:.1} % of the hooves' movement and covers {:.2} withers heights\n",
        strides.count,
        strides.period_frames,
        100.0 * strides.explained,
        mean.advance
    );
    text += &format!("spread between strides: median {median:.2} %, worst {worst:.2} % of withers height\n");
    text += &format!("{} places dropped, {} moved to the other leg\n", mean.jumps, mean.swaps);
    text += &format!(
        "near legs overtake off legs by {:.1} % of withers height a stride, off soles appear {:.1} % higher\n",
        100.0 * mean.parallax().unwrap_or(f64::NAN),
        100.0 * mean.off_rise()
    );
    for hoof in &mean.hooves {
        let side = if hoof.side == NearOff::Near { "near" } else { "off" };
        let pair = if hoof.pair == Pair::Fore { "fore" } else { "hind" };
        let duty = hoof.duty_factor().unwrap_or(f64::NAN);
        text += &format!("{:>9}  {}  duty factor {duty:.2}\n", format!("{side} {pair}"), hoof.lane());
    }
    if let Some([duty, lag]) = hildebrand(&mean.hooves) {
        text += &format!(
            "Hildebrand's point: hind duty factor {:.0} %, lateral lag {:.0} %\n",
            100.0 * duty,
            100.0 * lag
        );
    }
    text
}

/// Mean hind duty factor, and how much of a stride the fore hoof of a side strikes after the hind one.
fn hildebrand(hooves: &[HoofStance]) -> Option<[f64; 2]> {
    let find = |side, pair| hooves.iter().find(|hoof| hoof.side == side && hoof.pair == pair);
    let mut sums = [0.0; 3];
    for side in [NearOff::Near, NearOff::Off] {
        let (fore, hind) = (find(side, Pair::Fore)?, find(side, Pair::Hind)?);
        let lag = std::f64::consts::TAU * (fore.instants()?[0] - hind.instants()?[0]);
        sums = [sums[0] + hind.duty_factor()?, sums[1] + lag.cos(), sums[2] + lag.sin()];
    }
    // The mean of two phases, which lie on a circle.
    let lag = sums[2].atan2(sums[1]) / std::f64::consts::TAU;
    Some([0.5 * sums[0], lag.rem_euclid(1.0)])
}
