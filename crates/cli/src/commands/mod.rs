//! `muybridge`: one file a subcommand.

mod animation;
mod annotations;
mod average;
mod canvas;
mod contact_sheet;
mod exchange;
mod footprints;
mod motion;
mod output;
mod palette;
mod plates;
mod tracks;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

use crate::{EXIT_FAILED, report_error};

/// Muybridge's horse plates: look at them, check them, work with what was captured from them.
#[derive(Debug, Parser)]
#[command(name = "muybridge", version)]
pub struct Muybridge {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Look at annotations and exchange them: `show`, `check`, `compare`, `export`, `import`.
    #[command(subcommand)]
    Annotations(annotations::AnnotationsCommand),
    /// Average the strides of a tracked clip into one, written as a plate to fit.
    Average(average::AverageArguments),
    /// Motion from footprints, on two legs and on four: `solve`, `lay`, `picture`, `gif`, `wander`, `river`.
    #[command(subcommand)]
    Footprints(footprints::FootprintsCommand),
    /// The horse in motion: `play`, `strip`, `gif`, `gaits`.
    #[command(subcommand)]
    Motion(motion::MotionCommand),
    /// Which plates there are: `list`.
    #[command(subcommand)]
    Plates(plates::PlatesCommand),
    /// Strides and contacts out of machine-tracked films: `measure`, `contacts`.
    #[command(subcommand)]
    Tracks(tracks::TracksCommand),
}

/// Runs the program.
pub fn run(arguments: &Muybridge) -> ExitCode {
    let result = match &arguments.command {
        Command::Annotations(command) => command.run(),
        Command::Average(arguments) => arguments.run(),
        Command::Footprints(command) => command.run(),
        Command::Motion(command) => command.run(),
        Command::Plates(command) => command.run(),
        Command::Tracks(command) => command.run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => report_error(&error, EXIT_FAILED),
    }
}
