//! `muybridge`: everything around the plates that is not fitting all of them.

use std::process::ExitCode;

use clap::Parser;
use muybridge_cli::commands::{Muybridge, run};

fn main() -> ExitCode {
    run(&Muybridge::parse())
}
