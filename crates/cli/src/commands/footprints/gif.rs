//! `muybridge footprints gif`: a motion as an animation, the camera going along.

use std::path::PathBuf;

use clap::Args;
use muybridge_capture::write_atomically;
use muybridge_footprints::Method;

use super::super::animation::{animation, check_size, delay, fps, slow};
use super::shot::Photographer;
use super::unrolled::Unrolled;
use super::walk::Walk;

/// Arguments of `gif`.
#[derive(Debug, Args)]
pub(in crate::commands) struct GifArguments {
    /// Track to show (see docs/footprints/tracks/).
    track: PathBuf,
    /// Animation to write.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Pictures a second; the nearest that a GIF can have, whose pictures last whole hundredths of a second.
    #[arg(long, default_value_t = 16.0, value_parser = fps)]
    fps: f64,
    /// Width, px.
    #[arg(long, default_value_t = 400, value_parser = clap::value_parser!(u32).range(80..=1920))]
    width: u32,
    /// Slow motion: so many times slower.
    #[arg(long, value_name = "TIMES", default_value_t = 1.0, value_parser = slow)]
    slow: f64,
    /// Turn with the figure, instead of looking in one direction.
    #[arg(long)]
    turn: bool,
}

impl GifArguments {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        let walk = Walk::read(&self.track, Method::Gradient)?;
        let size = [self.width, self.width * 4 / 5];
        let delay = delay(self.fps);
        let every_s = 0.01 * f64::from(delay) / self.slow;
        let pictures = (walk.motion.duration_s() / every_s).floor() as u32 + 1;
        check_size(pictures, size)?;
        let photographer = Photographer::new(&walk, &Unrolled::of(&walk));
        let shoot = |i: u32| {
            let time_s = f64::from(i) * every_s;
            photographer.shoot(&photographer.along(time_s, size, self.turn), &[time_s], size)
        };
        let pictures: Vec<_> = (0..pictures).map(shoot).collect();
        let bytes = animation(&pictures, delay)?;
        write_atomically(&self.out, &bytes)?;
        println!(
            "{}: {} pictures, {:.2} s, {:.0} kB",
            self.out.display(),
            pictures.len(),
            0.01 * f64::from(delay) * pictures.len() as f64,
            bytes.len() as f64 / 1000.0
        );
        Ok(())
    }
}
