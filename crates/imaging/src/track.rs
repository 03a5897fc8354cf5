//! Points from one panel to the next.
