//! How far a tracked point may be trusted.
