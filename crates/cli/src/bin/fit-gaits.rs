//! `fit-gaits`: annotated plates in, fitted strides, gait laws, motion database and report out.

use std::process::ExitCode;

use clap::Parser;
use muybridge_cli::fit_gaits::{Arguments, run};

fn main() -> ExitCode {
    run(&Arguments::parse())
}
