//! Random work on a plate, the same for the same seed.
