//! Motion from footprints, for two legs and for four (van de Panne, *From Footprints to Animation*, 1997).
//!
//! A [`Track`] of footprints with their times becomes stances; a centre-of-mass curve is found over them that asks as little as
//! possible of forces that nobody exerts and of uncomfortable legs; legs and body follow from it.
//!
//! ```text
//! path -> prints -> timing -> stances -> problem -> centre of mass -> pose
//! ```
//!
//! World space as in the core crate: X forward, Y up, Z to the right of one who faces X; metres, seconds; headings about Y, to the
//! left of X positive. The plan is (x, z). Masses are one: energies are in m/s (accelerations times seconds).
//! f64 throughout; nothing here opens a file, reads a clock or draws chance but from a seed that is given.

mod biped;
mod bounds;
mod energy;
mod greedy;
mod horse;
mod knots;
mod lay;
mod leg;
mod model;
mod motion;
mod newton;
mod orientation;
mod path;
mod pendulum;
mod placed;
mod planner;
mod pose;
mod problem;
mod random_tracks;
mod shape;
mod solve;
mod stance;
mod supports;
mod terrain;
mod timing;
mod track;

pub use horse::{HOOF_OUTLINE_M, HorseModel};
pub use knots::{CentreOfMass, Knot, Trajectory};
pub use lay::{LayError, Laying};
pub use model::{FootModel, LegModel, MODEL_NAMES, MODEL_SCHEMA, Model, ModelError, Sway};
pub use motion::{Character, Figure, Motion, Remark};
pub use orientation::Orientation;
pub use path::{Path, PathPoint};
pub use placed::{Placed, PlacedPrint};
pub use planner::{Meadow, Planner, PlannerError, River, RiverError, Stone, Tree, WanderError, Wanderer};
pub use pose::{BipedPose, FootState, LegPose};
pub use problem::{CURVE_SAMPLES, Energy, ExportedProblem, Problem, Weights};
pub use random_tracks::random_track;
pub use shape::{SegmentShape, Shape, Tube, TubeModel, tubes};
pub use solve::{Method, Solved, descend, resolve, solve, solve_from};
pub use stance::Stance;
pub use supports::Support;
pub use terrain::Terrain;
pub use timing::{StepTiming, TimingRule};
pub use track::{Foot, Print, TRACK_SCHEMA, Track, TrackError, TrackGait};
