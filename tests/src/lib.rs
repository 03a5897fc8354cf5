//! Helpers of the whole-program tests: the built programs, a copy of the repository's documents that may be damaged,
//! and comparison with golden files.

#![allow(clippy::unwrap_used, reason = "a test stops at the first thing it cannot do")]

mod golden;
mod program;
mod repository;
mod workspace;

pub use golden::assert_golden;
pub use program::{Run, program};
pub use repository::{repository, shared_folder};
pub use workspace::{SALLIE, Workspace, write};
