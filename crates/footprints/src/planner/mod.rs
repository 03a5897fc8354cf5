//! Planning while moving (van de Panne 1997, section 4): prints that come one after another, and two that make them up.

mod crossing;
mod meadow;
mod online;
mod plan;
mod river;
mod wanderer;

pub use meadow::{Meadow, Tree, WanderError};
pub use online::{Planner, PlannerError};
pub use river::{River, RiverError, Stone};
pub use wanderer::Wanderer;

#[cfg(test)]
mod tests {
    use crate::model::Model;

    /// Someone to walk.
    pub(super) fn walker() -> Model {
        Model::named("bird").unwrap()
    }
}
