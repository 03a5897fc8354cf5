//! `muybridge footprints`: motion from footprints, on two legs and on four (van de Panne, *From Footprints to Animation*, 1997).

mod chart;
mod gif;
mod lay;
mod picture;
mod pixels;
mod plan;
mod planned;
mod relief;
mod river;
mod sheet;
mod shot;
mod side;
mod silhouette;
mod solution;
mod solve;
mod strip;
mod summary;
mod supports;
mod svg;
mod timing;
mod unrolled;
mod walk;
mod wander;

use clap::Subcommand;

/// The subcommands.
#[derive(Debug, Subcommand)]
pub(super) enum FootprintsCommand {
    /// Find the motion over a track. Example: `muybridge footprints solve docs/footprints/tracks/bird-walk.json`
    Solve(solve::SolveArguments),
    /// Lay prints along a path. Example: `muybridge footprints lay --model human --path 0,0 3,0 5,2 --out track.json`
    Lay(lay::LayArguments),
    /// Draw a track and its motion. Example: `muybridge footprints picture docs/footprints/tracks/human-run.json --out run.png`
    Picture(picture::PictureArguments),
    /// Draw a motion as an animation. Example: `muybridge footprints gif docs/footprints/tracks/bird-walk.json --out bird.gif`
    Gif(gif::GifArguments),
    /// Let a bird wander among trees. Example: `muybridge footprints wander --seed 7 --steps 60 --out wander.png`
    Wander(wander::WanderArguments),
    /// Let a bird cross a river from stone to stone. Example: `muybridge footprints river --seed 7 --out river.png`
    River(river::RiverArguments),
}

impl FootprintsCommand {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        match self {
            Self::Solve(arguments) => arguments.run(),
            Self::Lay(arguments) => arguments.run(),
            Self::Picture(arguments) => arguments.run(),
            Self::Gif(arguments) => arguments.run(),
            Self::Wander(arguments) => arguments.run(),
            Self::River(arguments) => arguments.run(),
        }
    }
}
