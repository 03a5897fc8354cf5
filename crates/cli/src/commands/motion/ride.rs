//! A ride as it is ridden: the horse under the commands of a script, frame by frame.

use anyhow::{Context, bail};
use glam::DVec3;
use muybridge_core::{Command, Database, Gait, Horse, Limb, Pose, Readout, Side};

use super::options::RideOptions;
use crate::ride_script::RideScript;

/// A gait goes steadily when its speed has changed by less than this for [`STEADY_S`], m/s.
const STEADY_M_S: f32 = 0.02;
const STEADY_S: f64 = 2.0;
/// Slower than this, a horse that comes to a stand is there, m/s.
const STILL_M_S: f32 = 0.02;
/// The longest a horse may take to come to a gait from standing, s.
const LONGEST_START_S: f64 = 30.0;

/// A moment of a ride.
#[derive(Clone, Copy, Debug)]
pub(super) struct Frame {
    /// Since the start, s.
    pub(super) time_s: f64,
    pub(super) pose: Pose,
    pub(super) readout: Readout,
}

/// A horse under way.
#[derive(Clone)]
pub(super) struct Ride {
    pub(super) horse: Horse,
    script: RideScript,
    /// Longest step of the simulation, s.
    longest_step_s: f64,
    time_s: f64,
    /// The command that holds for ever, instead of the script.
    always: Option<Command>,
}

impl Ride {
    /// A ride at its start: a script's horse standing at its place, one gait's at the beginning of a stride.
    pub(super) fn start(options: &RideOptions) -> anyhow::Result<Self> {
        let mut ride = Self::of(options.ride()?, options.horse.rate)?;
        if options.is_one_gait() {
            let command = ride.script.command(0.0, ride.longest_step_s).unwrap_or_default();
            ride.become_steady(command)?;
        }
        Ok(ride)
    }

    /// A script's horse, standing.
    pub(super) fn of(script: RideScript, rate_hz: f64) -> anyhow::Result<Self> {
        let skeleton = script.skeleton()?;
        let name = || skeleton.name.clone();
        let mut horse = Horse::new(&Database::embedded(), &skeleton, script.seed).with_context(name)?;
        let start = script.start;
        let at = DVec3::new(start.x_m, 0.0, start.z_m);
        horse.place(at, start.heading_deg.to_radians(), &script.ground);
        Ok(Self { horse, script, longest_step_s: 1.0 / rate_hz, time_s: 0.0, always: None })
    }

    /// The script it follows.
    pub(super) fn script(&self) -> &RideScript {
        &self.script
    }

    /// Whether it is one gait that goes on and on.
    pub(super) fn is_one_gait(&self) -> bool {
        self.always.is_some()
    }

    /// The moment it is at.
    pub(super) fn frame(&self) -> Frame {
        Frame { time_s: self.time_s, pose: *self.horse.pose(), readout: self.horse.readout() }
    }

    /// How long it takes: the script, or so many whole strides of a steady gait.
    pub(super) fn duration_s(&self, strides: f64) -> f64 {
        match self.always {
            Some(_) => strides * f64::from(self.horse.readout().stride_time_s),
            None => self.script.duration_s(),
        }
    }

    /// Rides on for a time, in equal steps.
    pub(super) fn advance(&mut self, by_s: f64) {
        let steps = (by_s / self.longest_step_s - 1e-6).ceil().max(1.0);
        for _ in 0..steps as u64 {
            self.step_by(by_s / steps);
        }
    }

    /// Rides on for one step of the simulation.
    pub(super) fn step(&mut self) {
        self.step_by(self.longest_step_s);
    }

    fn step_by(&mut self, dt_s: f64) {
        let command = self.always.or_else(|| self.script.command(self.time_s, dt_s)).unwrap_or_default();
        self.horse.step(&command, dt_s as f32, &self.script.ground);
        self.time_s += dt_s;
    }

    /// From now on there is this command only.
    pub(super) fn command_always(&mut self, command: Command) {
        self.always = Some(command);
    }

    /// Rides until the gait of a command goes evenly, and on to the beginning of a stride; there the time is zero.
    ///
    /// # Errors
    /// When that takes too long.
    pub(super) fn become_steady(&mut self, command: Command) -> anyhow::Result<()> {
        self.command_always(command);
        let mut since = (0.0, self.horse.readout().speed_m_s);
        while self.time_s < LONGEST_START_S {
            self.step();
            let Readout { gait, change, speed_m_s, is_standing, stride_time_s, .. } = self.horse.readout();
            let other = is_standing || command.gait.is_some_and(|wanted| wanted != gait) || change.is_some();
            if other || (speed_m_s - since.1).abs() > STEADY_M_S {
                since = (self.time_s, speed_m_s);
            } else if self.time_s - since.0 >= STEADY_S && stride_time_s.is_finite() {
                self.begin_stride();
                return Ok(());
            }
        }
        let gait = command.gait.map_or("its gait", Gait::name);
        bail!("the horse has not come to {gait} at {:.1} m/s in {LONGEST_START_S} s", command.speed_m_s)
    }

    /// Rides on until the left hind strikes.
    fn begin_stride(&mut self) {
        let Readout { leg_cycles, stride_time_s, .. } = self.horse.readout();
        self.advance(f64::from((1.0 - leg_cycles[Limb::LH.index()]) * stride_time_s));
        self.time_s = 0.0;
    }
}

impl Frame {
    /// What the horse does, in a word.
    pub(super) fn doing(&self) -> &'static str {
        match self.readout.is_standing {
            true if self.readout.speed_m_s > STILL_M_S => "halt",
            true => "stand",
            false => self.readout.gait.name(),
        }
    }

    /// The leading side.
    pub(super) fn lead(&self) -> Option<&'static str> {
        self.readout.lead.map(|side| match side {
            Side::Left => "left",
            Side::Right => "right",
        })
    }

    /// The change under way: `walk  35 %`, with the gait it began in.
    pub(super) fn change(&self) -> Option<String> {
        let percent = |share: f32| (100.0 * share).round();
        self.readout.change.map(|change| format!("{} {:3} %", change.from, percent(change.share)))
    }

    /// The hooves that are down: `LF -- LH --`.
    pub(super) fn hooves(&self) -> String {
        let hoof = |limb: Limb| {
            if self.readout.on_ground[limb.index()] { limb.abbreviation() } else { "--" }
        };
        Limb::ALL.map(hoof).join(" ")
    }
}
