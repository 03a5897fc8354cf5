//! `muybridge footprints river`: a figure that crosses a river from stone to stone.

use clap::Args;
use muybridge_footprints::River;

use super::planned::{PlannerOptions, Thing, circle, metres, rectangle};
use super::sheet::Color;

const BANK: Color = [236, 240, 226];
const WATER: Color = [214, 229, 240];
const STONE: Color = [190, 184, 174];
/// Width of the river, its length with stones, and the square of a stone, for each metre of the figure's step.
const WIDTH_STEPS: f64 = 11.0;
const LENGTH_STEPS: f64 = 6.5;
const CELL_STEPS: f64 = 1.1;
/// So much of the banks is drawn, for each metre of the step.
const BANK_STEPS: f64 = 1.5;

/// Arguments of `river`.
#[derive(Debug, Args)]
pub(in crate::commands) struct RiverArguments {
    #[command(flatten)]
    planner: PlannerOptions,
    /// Width of the river, metres; some steps of the figure when it is left out.
    #[arg(long = "across", value_name = "METRES", value_parser = metres)]
    across: Option<f64>,
    /// About one stone is in each square with this side, metres.
    #[arg(long, value_name = "METRES", value_parser = metres)]
    cell: Option<f64>,
}

impl RiverArguments {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        let PlannerOptions { model: name, seed, out, .. } = &self.planner;
        let model = self.planner.model()?;
        let step_m = model.step_m[0];
        let width_m = self.across.unwrap_or(WIDTH_STEPS * step_m);
        let cell_m = self.cell.unwrap_or(CELL_STEPS * step_m);
        let river = River::scattered(width_m, LENGTH_STEPS * step_m, cell_m, *seed)?;
        let prints = river.cross(&model)?;
        let (count, stones) = (prints.len(), river.stones.len());
        let title = format!("A {name} crosses a river (seed {seed})");
        self.planner.write(&title, prints, things(&river, step_m))?;
        println!("{}: {count} prints, {stones} stones", out.display());
        Ok(())
    }
}

/// Banks, water and stones.
fn things(river: &River, step_m: f64) -> Vec<Thing> {
    let [near, far] = river.banks_m;
    let (half_m, bank_m) = (0.5 * LENGTH_STEPS * step_m, BANK_STEPS * step_m);
    let all = rectangle([near - bank_m, -half_m], [far + bank_m, half_m], BANK, "");
    let water = rectangle([near, -half_m], [far, half_m], WATER, "water");
    let stones = river.stones.iter().map(|stone| circle(stone.at_m, stone.radius_m, STONE, "stones"));
    [all, water].into_iter().chain(stones).collect()
}
