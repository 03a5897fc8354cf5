//! `muybridge plates`: which plates there are, getting them, splitting them, seeing in them, and drawing specimens.

mod acquire;
mod list;
mod show;
mod source;
mod specimen;
mod split;

use clap::Subcommand;
use muybridge_core::Gait;

/// The catalogue of the repository.
const CATALOGUE: &str = "plates/catalogue.toml";

/// The subcommands.
#[derive(Debug, Subcommand)]
pub(super) enum PlatesCommand {
    /// List the catalogue. Example: `muybridge plates list --gait canter`
    List(list::ListArguments),
    /// Download plates of the catalogue and write their manifests. Example: `muybridge plates fetch 616`
    Fetch(acquire::FetchArguments),
    /// Add a scan, or a folder of frames, of one's own. Example: `muybridge plates add scan.tif --gait trot`
    Add(acquire::AddArguments),
    /// Find the panels of a plate, print and draw them. Example: `muybridge plates split scan.tif`
    Split(split::SplitArguments),
    /// Draw what is seen in the panels over them. Example: `muybridge plates show sallie-gardner-1878`
    Show(show::ShowArguments),
    /// Draw a plate whose truth is known. Example: `muybridge plates specimen canter`
    Specimen(specimen::SpecimenArguments),
}

impl PlatesCommand {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        match self {
            Self::List(arguments) => list::list(arguments),
            Self::Fetch(arguments) => acquire::run_fetch(arguments),
            Self::Add(arguments) => acquire::run_add(arguments),
            Self::Split(arguments) => split::run_split(arguments),
            Self::Show(arguments) => show::run_show(arguments),
            Self::Specimen(arguments) => specimen::run_specimen(arguments),
        }
    }
}

fn gait(name: &str) -> Result<Gait, String> {
    Gait::from_name(name).ok_or_else(|| {
        let names: Vec<&str> = Gait::ALL.into_iter().map(Gait::name).collect();
        format!("there is {}", names.join(", "))
    })
}
