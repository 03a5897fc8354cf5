//! `muybridge motion strip`: moments of a ride side by side, as Muybridge printed them.

use std::f64::consts::TAU;
use std::path::PathBuf;

use anyhow::bail;
use clap::Args;
use image::{Rgb, RgbImage, imageops};
use muybridge_core::Limb;

use super::super::canvas::{Canvas, write_few_colors};
use super::options::RideOptions;
use super::picture::{CHANGE, Photographer, ViewOptions, caption, write_line};
use super::ride::{Frame, Ride};

const PAPER: Rgb<u8> = Rgb([246, 243, 236]);
const INK: Rgb<u8> = Rgb([40, 36, 30]);
/// Between two pictures, and the border of a picture in a change of gait, px.
const GAP: u32 = 6;
const BORDER: u32 = 4;
/// Height of the two lines under a picture and of one of them, px.
const CAPTION: u32 = 42;
const LINE: u32 = 19;
/// Room for the hooves beside the lines, px.
const HOOVES: u32 = 30;
/// Width and height of a picture.
const ASPECT: [u32; 2] = [4, 3];
/// Side of the square that stands for a hoof, px.
const HOOF: u32 = 9;
/// Largest strip, px.
const LARGEST_PX: u64 = 50_000_000;

/// Arguments of `strip`.
#[derive(Debug, Args)]
pub(in crate::commands) struct StripArguments {
    #[command(flatten)]
    ride: RideOptions,
    #[command(flatten)]
    view: ViewOptions,
    /// Picture to write (PNG).
    #[arg(long, value_name = "FILE")]
    out: PathBuf,
    /// Number of pictures; those of one gait are spread over one stride.
    #[arg(long, default_value_t = 12, value_parser = clap::value_parser!(u32).range(1..=200))]
    moments: u32,
    /// Pictures in a row.
    #[arg(long, default_value_t = 6, value_parser = clap::value_parser!(u32).range(1..=50))]
    columns: u32,
    /// First moment, s after the start.
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = moment)]
    from: f64,
    /// Last moment; the end of the ride unless something else is said.
    #[arg(long, value_name = "SECONDS", value_parser = moment)]
    to: Option<f64>,
    /// Width of a picture, px.
    #[arg(long, default_value_t = 240, value_parser = clap::value_parser!(u32).range(80..=2000))]
    width: u32,
    /// One moment, that of `--from`, seen from all around.
    #[arg(long, conflicts_with = "to")]
    turntable: bool,
}

pub(super) fn moment(text: &str) -> Result<f64, String> {
    let seconds: f64 = text.parse().map_err(|_| "not a number".to_string())?;
    if (0.0..=3600.0).contains(&seconds) { Ok(seconds) } else { Err("between 0 and 3600 s".into()) }
}

impl StripArguments {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        let cell = [self.width, self.width * ASPECT[1] / ASPECT[0]];
        let columns = self.columns.min(self.moments);
        let rows = self.moments.div_ceil(columns);
        let size = [columns * (cell[0] + GAP) + GAP, rows * (cell[1] + CAPTION + GAP) + GAP];
        if u64::from(size[0]) * u64::from(size[1]) > LARGEST_PX {
            bail!(
                "{} x {} px is too large a picture; take fewer moments or a smaller width",
                size[0],
                size[1]
            );
        }
        let mut ride = Ride::start(&self.ride)?;
        let times = self.times(&ride)?;
        let photographer = Photographer::new(self.view, &ride, cell);
        let mut canvas = Canvas::new(size[0], size[1], PAPER);
        for (index, time_s) in times.into_iter().enumerate() {
            let by_s = time_s - ride.frame().time_s;
            if by_s > 0.0 {
                ride.advance(by_s);
            }
            let index = index as u32;
            let around = if self.turntable { f64::from(index) / f64::from(self.moments) } else { 0.0 };
            let frame = ride.frame();
            let picture = photographer.shoot(&frame, (TAU * around) as f32);
            let at =
                [GAP + index % columns * (cell[0] + GAP), GAP + index / columns * (cell[1] + CAPTION + GAP)];
            let [time, speed, mut doing, share] = caption(&frame);
            doing += &share;
            let lines = if self.turntable {
                [format!("{:.0}° to its left", 360.0 * around), doing]
            } else {
                [format!("{time}  {speed}"), doing]
            };
            place(&mut canvas, at, &picture, &frame, &lines);
        }
        write_few_colors(&self.out, &canvas.picture)?;
        println!("{}", self.out.display());
        Ok(())
    }

    /// When the pictures are taken: evenly from the first to the last, or over one stride that begins anew after the last.
    fn times(&self, ride: &Ride) -> anyhow::Result<Vec<f64>> {
        let n = self.moments;
        if self.turntable {
            return Ok(vec![self.from; n as usize]);
        }
        let whole_s = ride.duration_s(1.0);
        let usual_end_s = if ride.is_one_gait() { self.from + whole_s } else { whole_s };
        let end_s = self.to.unwrap_or(usual_end_s);
        if end_s < self.from || !end_s.is_finite() {
            bail!("the last moment, {end_s} s, is before the first, {} s", self.from);
        }
        let closes = ride.is_one_gait() && self.to.is_none();
        let parts = if closes { n } else { (n - 1).max(1) };
        let part_s = (end_s - self.from) / f64::from(parts);
        Ok((0..n).map(|i| self.from + f64::from(i) * part_s).collect())
    }
}

/// Puts a picture on the strip, with what it shows under it and a border while the gait changes.
fn place(canvas: &mut Canvas, at: [u32; 2], picture: &RgbImage, frame: &Frame, lines: &[String; 2]) {
    let [width, height] = [picture.width(), picture.height()];
    if frame.readout.change.is_some() {
        let around = [at[0].saturating_sub(BORDER), at[1].saturating_sub(BORDER)];
        fill(canvas, around, [width + 2 * BORDER, height + CAPTION + BORDER], CHANGE);
        fill(canvas, [at[0], at[1] + height], [width, CAPTION - BORDER], PAPER);
    }
    imageops::replace(&mut canvas.picture, picture, i64::from(at[0]), i64::from(at[1]));
    for (row, line) in (0..).zip(lines) {
        let left_top = [at[0] + 4, at[1] + height + 2 + LINE * row];
        write_line(canvas, left_top, width.saturating_sub(HOOVES), line, INK);
    }
    let hooves = [at[0] + width - 3 * HOOF, at[1] + height + CAPTION - 3 * HOOF - BORDER / 2];
    for limb in Limb::ALL {
        let index = limb.index() as u32;
        let square = [hooves[0] + index % 2 * (HOOF + 2), hooves[1] + index / 2 * (HOOF + 2)];
        fill(canvas, square, [HOOF; 2], INK);
        if !frame.readout.on_ground[limb.index()] {
            fill(canvas, square.map(|side| side + 1), [HOOF - 2; 2], PAPER);
        }
    }
}

fn fill(canvas: &mut Canvas, [x, y]: [u32; 2], [width, height]: [u32; 2], colour: Rgb<u8>) {
    let area = imageproc::rect::Rect::at(x as i32, y as i32).of_size(width, height);
    imageproc::drawing::draw_filled_rect_mut(&mut canvas.picture, area, colour);
}
