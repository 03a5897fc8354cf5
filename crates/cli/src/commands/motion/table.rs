//! A ride as a table for people, with a lane for each hoof.

use std::io::Write;

use muybridge_core::{Limb, MPS_PER_MPH};

use super::ride::{Frame, Ride};

/// Most characters of a hoof's lane in a row.
const LANE: f64 = 6.0;

/// A row every `row_s` seconds: what the horse does at its beginning, and when each hoof is down until the next.
pub(super) fn write_table(
    out: &mut impl Write,
    ride: &mut Ride,
    duration_s: f64,
    row_s: f64,
    frame_s: f64,
) -> anyhow::Result<()> {
    let samples = (row_s / frame_s).round().clamp(1.0, LANE);
    let rows = (duration_s / row_s - 1e-6).ceil().max(1.0) as u64;
    let lanes = Limb::ALL.map(|limb| format!("{:1$}", limb.abbreviation(), samples as usize)).join(" ");
    writeln!(out, "{HEADER}  {lanes}")?;
    for _ in 0..rows {
        let first = ride.frame();
        let mut lanes = [const { String::new() }; 4];
        for _ in 0..samples as u32 {
            let down = ride.frame().readout.on_ground;
            for (lane, down) in lanes.iter_mut().zip(down) {
                lane.push(if down { '#' } else { '.' });
            }
            ride.advance(row_s / samples);
        }
        writeln!(out, "{}  {}", cells(&first), lanes.join(" "))?;
    }
    Ok(())
}

/// A row for each moment at which a hoof strikes the ground.
pub(super) fn write_footfalls(
    out: &mut impl Write,
    ride: &mut Ride,
    duration_s: f64,
    frame_s: f64,
) -> anyhow::Result<()> {
    writeln!(out, "{HEADER}  down         strikes")?;
    let mut before = ride.frame().readout.on_ground;
    for _ in 0..(duration_s / frame_s - 1e-6).ceil() as u64 {
        ride.advance(frame_s);
        let frame = ride.frame();
        let down = frame.readout.on_ground;
        let strikes: Vec<&str> = Limb::ALL
            .into_iter()
            .filter(|limb| down[limb.index()] && !before[limb.index()])
            .map(Limb::abbreviation)
            .collect();
        if !strikes.is_empty() {
            writeln!(out, "{}  {}  {}", cells(&frame), frame.hooves(), strikes.join(" "))?;
        }
        before = down;
    }
    Ok(())
}

const HEADER: &str = "  time_s  gait    lead   change          m/s   mph  heading";

fn cells(frame: &Frame) -> String {
    let readout = &frame.readout;
    let speed_mph = f64::from(readout.speed_m_s) / MPS_PER_MPH;
    format!(
        "{:8.2}  {:6}  {:5}  {:12}  {:5.2}  {:4.1}  {:7.1}",
        frame.time_s,
        frame.doing(),
        frame.lead().unwrap_or_default(),
        frame.change().unwrap_or_default(),
        readout.speed_m_s,
        speed_mph,
        tidy_degrees(readout.heading_rad),
    )
}

/// Degrees, without a minus before what is printed as zero.
fn tidy_degrees(angle_rad: f64) -> f64 {
    let degrees = angle_rad.to_degrees();
    if degrees.abs() < 0.05 { 0.0 } else { degrees }
}
