//! `muybridge motion warping`, `foot-phase` and `changes`: the horse against the paper it comes from.

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::Context;
use clap::Args;
use muybridge_capture::write_atomically;
use muybridge_core::{Database, Repertoire, Skeleton};
use muybridge_fitting::foot_phase_check::foot_phase_table;
use muybridge_fitting::report::time_warping_plot::warping_plot;
use muybridge_fitting::ride_checks::changes::{ChangeTable, START_PHASES};

use super::super::output::print;

/// Arguments of `warping`.
#[derive(Debug, Args)]
pub(in crate::commands) struct WarpingArguments {
    /// Picture to write (SVG).
    #[arg(long, value_name = "FILE", default_value = "warping.svg")]
    out: PathBuf,
}

impl WarpingArguments {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        let plot = warping_plot(&Database::embedded());
        write_atomically(&self.out, plot.as_bytes())?;
        print(|out| Ok(writeln!(out, "{}", self.out.display())?))
    }
}

/// Prints how well the paper's foot-phase test finds the contacts of the database.
pub(super) fn foot_phase() -> anyhow::Result<()> {
    let table = foot_phase_table(&Database::embedded(), &Skeleton::reference());
    print(|out| Ok(out.write_all(table.as_bytes())?))
}

/// Prints every change of gait beside a plain cross-fade.
pub(super) fn changes() -> anyhow::Result<()> {
    let repertoire = Repertoire::new(&Database::embedded(), &Skeleton::reference())
        .context("the embedded database does not serve the reference horse")?;
    let table = ChangeTable::measure(&repertoire.into(), START_PHASES);
    print(|out| Ok(writeln!(out, "{table}")?))
}
