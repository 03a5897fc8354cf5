//! `muybridge footprints picture`: a track and its motion as a picture.

use std::path::PathBuf;

use clap::{Args, ValueEnum};
use muybridge_footprints::Method;

use super::plan::View;
use super::sheet::Sheet;
use super::side::side;
use super::strip::{scene, strip};
use super::timing::timing;
use super::walk::Walk;

/// Arguments of `picture`.
#[derive(Debug, Args)]
pub(in crate::commands) struct PictureArguments {
    /// Track to draw (see docs/footprints/tracks/).
    track: PathBuf,
    /// Picture to write; of plan, timing and side also as SVG, by the ending.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// What is drawn.
    #[arg(long, value_enum, default_value = "all")]
    what: What,
    /// Width of the picture, px.
    #[arg(long, default_value_t = 1200, value_parser = clap::value_parser!(u32).range(480..=4000))]
    width: u32,
    /// Moments on the strip.
    #[arg(long, default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=60))]
    moments: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum What {
    /// From above: prints with timing daggers and heading handles, the way of the centre of mass.
    Plan,
    /// When each foot is down.
    Timing,
    /// From the right, turns laid out straight: the curve of the centre of mass, its tangents, figures.
    Side,
    /// Moments in three dimensions, side by side.
    Strip,
    /// The whole way in three dimensions.
    Scene,
    /// All of these, one below the other.
    All,
}

impl PictureArguments {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        let walk = Walk::read(&self.track, Method::Gradient)?;
        self.draw(&walk).write(&self.out)?;
        println!("{}", self.out.display());
        Ok(())
    }

    fn draw(&self, walk: &Walk) -> Sheet {
        let width_px = f64::from(self.width);
        let title = walk.title();
        match self.what {
            What::Plan => View::of(walk, &title).draw(width_px),
            What::Timing => timing(walk, &title, width_px),
            What::Side => side(walk, &title, width_px),
            What::Strip => strip(walk, &title, width_px, self.moments),
            What::Scene => scene(walk, &title, width_px),
            What::All => {
                let mut sheet = View::of(walk, &title).draw(width_px);
                sheet.append(timing(walk, "", width_px));
                sheet.append(side(walk, "", width_px));
                sheet.append(scene(walk, "", width_px));
                sheet.append(strip(walk, "", width_px, self.moments));
                sheet
            }
        }
    }
}
