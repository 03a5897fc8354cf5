//! What must hold of a horse that is ridden: measured step by step, stride by stride, change by change, and in thousands of rides.
//!
//! [`Inspector`] looks at every step of a [`muybridge_core::Horse`] and keeps the worst of each [`Quantity`].
//! [`steady`] records one stride of a steady gait, and [`steady_strides`] every gait at every speed, so that the rules of
//! [`crate::database_checks`] judge the synthesised motion, too; [`speeds`] measures how fast and where the horse goes.
//! [`situations`] are single things, one at a time; [`changes`] measures every change of gait beside a plain cross-fade, [`trials`] rides
//! command sequences drawn from a seed over rough ground, and [`hostile`] asks what no rider would.

pub mod builds;
pub mod changes;
pub mod cross_fade;
pub mod findings;
pub mod hostile;
mod inspector;
pub mod scripts;
pub mod situations;
pub mod speeds;
pub mod steady;
pub mod steady_strides;
pub mod terrain;
pub mod trials;

pub use findings::{Broken, Findings, Limits, Part, Quantity, Worst};
pub use inspector::Inspector;
