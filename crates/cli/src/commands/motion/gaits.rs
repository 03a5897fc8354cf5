//! `muybridge motion gaits`: which gait at which speed, measured on the horse as it goes.

use clap::Args;
use comfy_table::{CellAlignment, Table, presets::UTF8_FULL_CONDENSED};
use muybridge_core::{Command, Gait, Limb, MPS_PER_MPH, Pair, Pose, Skeleton};

use super::super::output::print;
use super::options::HorseOptions;
use super::ride::Ride;
use crate::ride_script::{RideScript, RideStep};

/// Standard gravity, m/s^2.
const GRAVITY_M_S2: f32 = 9.806_65;
/// Strides that are measured at each speed.
const STRIDES: f64 = 10.0;
/// Faster than any horse: it goes as fast as the gait does.
const FASTEST_M_S: f32 = 40.0;
/// Slower than the gait's slowest by this, but not so slow that it means to halt: it goes as slowly as the gait does.
const SLOWER: f32 = 0.8;
/// At each speed of the horse that chooses its gait by itself, s.
const CHOICE_S: f64 = 5.0;
const FASTEST_MPH: u32 = 40;

const HEADER: [&str; 9] = [
    "gait",
    "speed\nm/s",
    "\nmph",
    "Froude\nv²/(g L)",
    "stride\ns",
    "\nm",
    "duty factor\nfore",
    "\nhind",
    "hooves down\nleast to most",
];

/// Arguments of `gaits`.
#[derive(Debug, Args)]
pub(in crate::commands) struct GaitsArguments {
    #[command(flatten)]
    horse: HorseOptions,
}

/// A gait at a speed as it was seen.
struct Seen {
    gait: Gait,
    speed_m_s: f32,
    stride_time_s: f64,
    /// Fore and hind.
    duty_factors: [f64; 2],
    /// Least and greatest number of hooves on the ground.
    down: [usize; 2],
}

impl GaitsArguments {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        let mut script = RideScript::of(RideStep::default());
        self.horse.choose(&mut script);
        let standing = Ride::of(script, self.horse.rate)?;
        let leg_m = hind_leg_m(standing.horse.skeleton());
        let mut table = Table::new();
        table.load_style(UTF8_FULL_CONDENSED).set_header(HEADER);
        for gait in Gait::ALL.into_iter().filter(|gait| *gait != Gait::Leap) {
            for seen in measure_range(&standing, gait)? {
                table.add_row(seen.row(leg_m));
            }
        }
        for column in table.column_iter_mut().skip(1) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        let [faster, slower] = choices(&standing);
        print(|out| {
            use std::io::Write;
            writeln!(out, "{table}")?;
            writeln!(out, "The hind leg is {leg_m:.2} m long, from the hip to the ground, standing.")?;
            writeln!(out, "Left to choose, getting faster: {faster}.")?;
            writeln!(out, "Left to choose, getting slower: {slower}.")?;
            Ok(())
        })
    }
}

impl Seen {
    fn row(&self, leg_m: f32) -> [String; 9] {
        let speed = f64::from(self.speed_m_s);
        let [fore, hind] = self.duty_factors;
        let [least, most] = self.down;
        [
            self.gait.name().into(),
            format!("{speed:.2}"),
            format!("{:.1}", speed / MPS_PER_MPH),
            format!("{:.2}", self.speed_m_s.powi(2) / (GRAVITY_M_S2 * leg_m)),
            format!("{:.3}", self.stride_time_s),
            format!("{:.2}", speed * self.stride_time_s),
            format!("{fore:.2}"),
            format!("{hind:.2}"),
            format!("{least} to {most}"),
        ]
    }
}

/// From the left hip to the ground under it in the standing pose, m.
fn hind_leg_m(skeleton: &Skeleton) -> f32 {
    let joints = Pose::standing(skeleton).joints(skeleton);
    joints.tips[Limb::LH.first_bone()].y - joints.toe(Limb::LH).y
}

/// A gait at its slowest, at the speed between, and at its fastest.
fn measure_range(standing: &Ride, gait: Gait) -> anyhow::Result<[Seen; 3]> {
    let [low_mph, _] = gait.speed_range_mph().unwrap_or_default();
    let skeleton = standing.horse.skeleton();
    // Horses of other sizes go alike at equal Froude numbers.
    let like = (skeleton.withers_height_m / Skeleton::reference().withers_height_m).sqrt();
    let slowest = measure(standing, gait, SLOWER * like * (low_mph * MPS_PER_MPH) as f32)?;
    let fastest = measure(standing, gait, FASTEST_M_S)?;
    let between = measure(standing, gait, 0.5 * (slowest.speed_m_s + fastest.speed_m_s))?;
    Ok([slowest, between, fastest])
}

/// Lets the horse come to a gait and counts over some strides.
fn measure(standing: &Ride, gait: Gait, speed_m_s: f32) -> anyhow::Result<Seen> {
    let mut ride = standing.clone();
    ride.become_steady(Command { speed_m_s, gait: Some(gait), ..Command::default() })?;
    let first = ride.frame();
    let (mut frames, mut down, mut range) = (0.0, [0.0; 4], [4, 0]);
    while ride.frame().readout.strides - first.readout.strides < STRIDES {
        let on_ground = ride.frame().readout.on_ground;
        frames += 1.0;
        let count = on_ground.into_iter().filter(|down| *down).count();
        range = [range[0].min(count), range[1].max(count)];
        for limb in Limb::ALL.into_iter().filter(|limb| on_ground[limb.index()]) {
            down[limb.index()] += 1.0;
        }
        ride.step();
    }
    let last = ride.frame();
    let strides = last.readout.strides - first.readout.strides;
    let of_pair = |pair: Pair| {
        let legs = Limb::ALL.into_iter().filter(|limb| limb.pair() == pair);
        legs.map(|limb| down[limb.index()] / frames).sum::<f64>() / 2.0
    };
    Ok(Seen {
        gait,
        speed_m_s: (last.pose.root_in_world - first.pose.root_in_world).length()
            / (last.time_s - first.time_s) as f32,
        stride_time_s: (last.time_s - first.time_s) / strides,
        duty_factors: [Pair::Fore, Pair::Hind].map(of_pair),
        down: range,
    })
}

/// The gaits of a horse that is asked for nothing but speeds, mile per hour by mile per hour up and down again.
fn choices(standing: &Ride) -> [String; 2] {
    let mut ride = standing.clone();
    let mut chosen = |mph: u32| {
        let speed_m_s = (f64::from(mph) * MPS_PER_MPH) as f32;
        ride.command_always(Command { speed_m_s, ..Command::default() });
        ride.advance(CHOICE_S);
        (mph, ride.frame().readout.gait)
    };
    let faster: Vec<(u32, Gait)> = (1..=FASTEST_MPH).map(&mut chosen).collect();
    let slower: Vec<(u32, Gait)> = (1..=FASTEST_MPH).rev().map(&mut chosen).collect();
    [faster, slower].map(|choices| {
        let runs = choices.chunk_by(|a, b| a.1 == b.1);
        let told: Vec<String> = runs
            .map(|run| match run {
                [(mph, gait)] => format!("{gait} at {mph} mph"),
                _ => format!("{} {} to {} mph", run[0].1, run[0].0, run[run.len() - 1].0),
            })
            .collect();
        told.join(", ")
    })
}
