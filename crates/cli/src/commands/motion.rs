//! `muybridge motion`: the horse in motion without any window, as tables, pictures and animations.

mod compare;
mod gaits;
mod gif;
mod options;
mod picture;
mod play;
mod records;
mod ride;
mod strip;
mod table;

use clap::Subcommand;

/// The subcommands.
#[derive(Debug, Subcommand)]
pub(super) enum MotionCommand {
    /// Play a ride and print it. Example: `muybridge motion play docs/rides/walk-to-gallop.json`
    Play(play::PlayArguments),
    /// Draw moments of a ride side by side. Example: `muybridge motion strip --gait trot --speed 5.2 --out trot.png`
    Strip(strip::StripArguments),
    /// Draw a ride as an animation. Example: `muybridge motion gif --gait canter --slow 4 --out canter.gif`
    Gif(gif::GifArguments),
    /// Which gait the horse goes at which speed, and how. Example: `muybridge motion gaits --size 0.7`
    Gaits(gaits::GaitsArguments),
    /// Every change from gait to gait, from 40 phases each, beside a plain cross-fade
    Changes,
    /// Draw how far the legs are from one moment of the new gait during a change: the paper's two ways of warping, and the horse
    Warping(compare::WarpingArguments),
    /// How well the paper's foot-phase test finds the contacts of the database
    FootPhase,
}

impl MotionCommand {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        match self {
            Self::Play(arguments) => arguments.run(),
            Self::Strip(arguments) => arguments.run(),
            Self::Gif(arguments) => arguments.run(),
            Self::Gaits(arguments) => arguments.run(),
            Self::Changes => compare::changes(),
            Self::Warping(arguments) => arguments.run(),
            Self::FootPhase => compare::foot_phase(),
        }
    }
}
