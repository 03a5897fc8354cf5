//! From annotated plates to fitted strides, contacts, gait laws, the motion database and the report.

pub mod chain;
pub mod checks;
pub mod contacts;
pub mod expansion;
pub mod export_problem;
pub mod fit_document;
pub mod footfalls;
pub mod gait_analysis;
pub mod held_out;
pub mod law;
pub mod layout;
pub mod levenberg;
pub mod motion_database;
pub mod normal_matrix;
pub mod observation;
pub mod periodic;
pub mod pipeline;
pub mod posing;
pub mod problem;
pub mod published;
pub mod repeatability;
pub mod report;
pub mod stride_curves;
pub mod stride_fit;
pub mod synthetic;
pub mod weights;
