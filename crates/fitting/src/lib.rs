//! From annotated plates to fitted strides, contacts, gait laws, the motion database and the report.

pub mod chain;
pub mod held_out;
pub mod layout;
pub mod levenberg;
pub mod normal_matrix;
pub mod observation;
pub mod problem;
pub mod stride_fit;
pub mod weights;
