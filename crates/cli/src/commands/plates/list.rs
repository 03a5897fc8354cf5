//! `muybridge plates list`: the catalogue.

use std::path::PathBuf;

use anyhow::bail;
use clap::Args;
use comfy_table::{Table, presets::NOTHING};
use muybridge_capture::{Catalogue, CataloguePlate};
use muybridge_core::Gait;

use super::{CATALOGUE, gait};

/// Arguments of `list`.
#[derive(Debug, Args)]
pub(in crate::commands) struct ListArguments {
    /// Only plates titled with this gait: walk, amble, trot, rack, canter, gallop or leap.
    #[arg(long, value_parser = gait)]
    gait: Option<Gait>,
    /// Only plates of this animal (any case, a part of the name will do).
    #[arg(long, value_name = "NAME")]
    animal: Option<String>,
    /// The catalogue file.
    #[arg(long, value_name = "FILE", default_value = CATALOGUE)]
    catalogue: PathBuf,
}

pub(super) fn list(arguments: &ListArguments) -> anyhow::Result<()> {
    let catalogue = Catalogue::read(&arguments.catalogue)?;
    let animal = arguments.animal.as_ref().map(|name| name.to_lowercase());
    let wanted = |plate: &&CataloguePlate| {
        arguments.gait.is_none_or(|gait| plate.gait == gait)
            && animal.as_ref().is_none_or(|name| plate.animal.to_lowercase().contains(name))
    };
    let mut table = Table::new();
    table.load_style(NOTHING).set_header(["plate", "gait", "animal", "action"]);
    for plate in catalogue.plates.iter().filter(wanted) {
        table.add_row([&plate.number.to_string(), plate.gait.name(), &plate.animal, &plate.action]);
    }
    if table.is_empty() {
        bail!("no plate of the catalogue is like that; `muybridge plates list` shows all");
    }
    println!("{}", table.trim_fmt());
    Ok(())
}
