//! `muybridge motion gif`: a ride as an animation, the camera moving along.

use std::path::PathBuf;

use anyhow::bail;
use clap::Args;
use image::{Rgb, RgbImage, imageops};
use muybridge_capture::write_atomically;

use super::super::animation::{animation, check_size, delay, fps, slow};
use super::super::canvas::Canvas;
use super::options::RideOptions;
use super::picture::{Photographer, ViewOptions, caption, write_line};
use super::ride::Ride;
use super::strip::moment;

const PAPER: Rgb<u8> = Rgb([246, 243, 236]);
const INK: Rgb<u8> = Rgb([40, 36, 30]);
/// Height of the line under the picture, px.
const CAPTION: u32 = 24;
/// Width and height of the picture.
const ASPECT: [u32; 2] = [8, 5];
/// A gait is shown for about so long when nothing is said, s, and of a ride so much at most.
const GAIT_S: f64 = 2.0;
const RIDE_S: f64 = 6.0;
/// Lines on the ground are about so far apart, m; a loop goes over a whole number of them.
const GRID_M: f64 = 1.0;

/// Arguments of `gif`.
#[derive(Debug, Args)]
pub(in crate::commands) struct GifArguments {
    #[command(flatten)]
    ride: RideOptions,
    #[command(flatten)]
    view: ViewOptions,
    /// Animation to write.
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Pictures a second; the nearest that a GIF can have, whose pictures last whole hundredths of a second.
    #[arg(long, default_value_t = 16.0, value_parser = fps)]
    fps: f64,
    /// Width, px.
    #[arg(long, default_value_t = 360, value_parser = clap::value_parser!(u32).range(80..=1920))]
    width: u32,
    /// First moment, s after the start.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = moment)]
    from: f64,
    /// How much is shown, s of the ride: 6 when nothing is said; of one gait whole strides, as many as come nearest to 2.
    #[arg(long, value_parser = moment)]
    seconds: Option<f64>,
    /// Slow motion: so many times slower.
    #[arg(long, value_name = "TIMES", default_value_t = 1.0, value_parser = slow)]
    slow: f64,
}

/// Which pictures are taken.
struct Plan {
    pictures: u32,
    /// From one to the next, s of the ride.
    every_s: f64,
    /// Duration of a picture, hundredths of a second.
    delay: u16,
    grid_m: f32,
}

impl GifArguments {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        let mut ride = Ride::start(&self.ride)?;
        if self.from > 0.0 {
            ride.advance(self.from);
        }
        let plan = self.plan(&ride)?;
        let size = [self.width, self.width * ASPECT[1] / ASPECT[0]];
        check_size(plan.pictures, [size[0], size[1] + CAPTION])?;
        let photographer = Photographer::new(self.view, &ride, size).with_grid(plan.grid_m);
        let mut pictures = Vec::new();
        for index in 0..plan.pictures {
            if index > 0 {
                ride.advance(plan.every_s);
            }
            pictures.push(with_caption(&photographer, &ride));
        }
        let bytes = animation(&pictures, plan.delay)?;
        write_atomically(&self.out, &bytes)?;
        println!(
            "{}: {} pictures, {:.2} s, {:.0} kB",
            self.out.display(),
            pictures.len(),
            0.01 * f64::from(plan.delay) * pictures.len() as f64,
            bytes.len() as f64 / 1000.0
        );
        Ok(())
    }

    fn plan(&self, ride: &Ride) -> anyhow::Result<Plan> {
        let delay = delay(self.fps);
        let wanted_every_s = 0.01 * f64::from(delay) / self.slow;
        let plan = |pictures: f64, every_s: f64, grid_m: f64| Plan {
            pictures: pictures.max(1.0) as u32,
            every_s,
            delay,
            grid_m: grid_m as f32,
        };
        if !ride.is_one_gait() {
            let rest_s = (ride.duration_s(1.0) - self.from).max(0.0);
            let shown_s = self.seconds.map_or(rest_s.min(RIDE_S), |seconds| seconds.min(rest_s));
            if shown_s == 0.0 {
                bail!("nothing of the ride is left to be shown after {} s", self.from);
            }
            return Ok(plan((shown_s / wanted_every_s).round(), wanted_every_s, GRID_M));
        }
        // Whole strides in whole pictures: the tempo is off by less than half a picture.
        let stride_s = ride.duration_s(1.0);
        let strides = (self.seconds.unwrap_or(GAIT_S / self.slow.max(1.0)) / stride_s).round().max(1.0);
        let pictures = (strides * stride_s / wanted_every_s).round().max(2.0);
        let length_m = f64::from(ride.frame().readout.speed_m_s) * strides * stride_s;
        let grid_m = length_m / (length_m / GRID_M).round().max(1.0);
        Ok(plan(pictures, strides * stride_s / pictures, grid_m))
    }
}

fn with_caption(photographer: &Photographer, ride: &Ride) -> RgbImage {
    let frame = ride.frame();
    let picture = photographer.shoot(&frame, 0.0);
    let mut canvas = Canvas::new(picture.width(), picture.height() + CAPTION, PAPER);
    imageops::replace(&mut canvas.picture, &picture, 0, 0);
    let [time, speed, doing, _] = caption(&frame);
    // A time has no place in a loop.
    let words =
        if ride.is_one_gait() { format!("{doing}  {speed}") } else { format!("{time}  {speed}  {doing}") };
    write_line(&mut canvas, [4, picture.height() + 3], picture.width() - 4, &words, INK);
    canvas.picture
}
