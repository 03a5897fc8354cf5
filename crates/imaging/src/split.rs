//! Finding the panels of a plate.
