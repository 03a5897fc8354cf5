//! The fit report: one HTML page with every plate's stride, footfalls and residuals, and the laws of speed.
//!
//! The page loads nothing: the style sheet and the plots (SVG) are in it, and it needs no script. It follows
//! the reader's choice of light or dark, and prints. Equal fits give equal bytes.

mod footfalls;
mod hoof_paths;
mod laws;
mod lengths;
mod page;
mod plate;
mod plot;
mod reading;
mod residuals;
mod strip;
mod summary;
#[cfg(test)]
mod tests;

use muybridge_capture::{Keypoint, NearOff};
use muybridge_core::Skeleton;

use crate::motion_database::GaitLaw;
use crate::pipeline::PlateFit;
use plot::Ink;

/// The report on a set of fitted plates and the laws made of them, as a self-contained HTML page.
///
/// `failures` are the causes why other plates were not fitted, in words, one for each. `skeleton` is the
/// reference the plates were fitted with.
pub fn html(fits: &[PlateFit], laws: &[GaitLaw], failures: &[String], skeleton: &Skeleton) -> String {
    let mut body = summary::summary(fits, failures);
    for (index, fit) in fits.iter().enumerate() {
        body.push_str(&plate::section(index, fit, skeleton));
    }
    body.push_str(&laws::laws(laws));
    body.push_str(&reading::reading());
    page::document("Horses in motion, fitted", &body)
}

/// Colour of a side.
fn ink_of_side(side: NearOff) -> Ink {
    match side {
        NearOff::Near => Ink::Near,
        NearOff::Off => Ink::Off,
    }
}

/// Colour of a keypoint: its limb's, or the body's.
fn ink_of(keypoint: Keypoint) -> Ink {
    match keypoint {
        Keypoint::Body(_) => Ink::Body,
        Keypoint::Limb(side, ..) => ink_of_side(side),
    }
}

/// Name of a keypoint for people.
fn name_of(keypoint: Keypoint) -> String {
    keypoint.name().replace('_', " ")
}
