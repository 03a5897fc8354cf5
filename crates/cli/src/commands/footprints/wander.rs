//! `muybridge footprints wander`: a figure that chooses its prints as it goes, each step planned when the next print is known.

use clap::Args;
use muybridge_footprints::{Meadow, Print, Wanderer};

use super::planned::{PlannerOptions, Thing, circle, metres, rectangle};
use super::sheet::Color;

const MEADOW: Color = [236, 240, 226];
const TREE: Color = [122, 158, 104];
/// Side of the square, and distance between trees, for each metre of the figure's step.
const SIDE_STEPS: f64 = 30.0;
const GAP_STEPS: f64 = 3.2;

/// Arguments of `wander`.
#[derive(Debug, Args)]
pub(in crate::commands) struct WanderArguments {
    #[command(flatten)]
    planner: PlannerOptions,
    /// Number of steps.
    #[arg(long, default_value_t = 60, value_parser = clap::value_parser!(u32).range(2..=5000))]
    steps: u32,
    /// Number of trees that are planted; fewer where there is no room.
    #[arg(long, default_value_t = 9, value_parser = clap::value_parser!(u32).range(0..=200))]
    trees: u32,
    /// Side of the square, metres; some steps of the figure when it is left out.
    #[arg(long, value_name = "METRES", value_parser = metres)]
    side: Option<f64>,
}

impl WanderArguments {
    pub(super) fn run(&self) -> anyhow::Result<()> {
        let PlannerOptions { model: name, seed, out, .. } = &self.planner;
        let model = self.planner.model()?;
        let step_m = model.step_m[0];
        let side_m = self.side.unwrap_or(SIDE_STEPS * step_m);
        let meadow = Meadow::planted(side_m, self.trees as usize, GAP_STEPS * step_m, *seed)?;
        let trees = meadow.trees().len();
        let things = things(&meadow);
        let prints: Vec<Print> =
            Wanderer::new(meadow, &model, *seed)?.take(self.steps as usize + 1).collect();
        self.planner.write(&format!("A {name} that wanders (seed {seed})"), prints, things)?;
        println!("{}: {} steps among {trees} trees", out.display(), self.steps);
        Ok(())
    }
}

/// The square and its trees.
fn things(meadow: &Meadow) -> Vec<Thing> {
    let half_m = meadow.side_m() / 2.0;
    let square = rectangle([-half_m; 2], [half_m; 2], MEADOW, "");
    let trees = meadow.trees().iter().map(|tree| circle(tree.at_m, tree.radius_m, TREE, "trees"));
    std::iter::once(square).chain(trees).collect()
}
