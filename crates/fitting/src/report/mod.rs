//! The fit report: one HTML page with every plate's stride, footfalls and residuals, and the laws of speed.
//!
//! The page loads nothing: the style sheet and the plots (SVG) are in it, and it needs no script. It follows
//! the reader's choice of light or dark, and prints. Equal fits give equal bytes.

pub mod captures;
mod contact_sheet;
mod footfalls;
mod hoof_paths;
mod laws;
mod lengths;
mod page;
mod plate;
mod plot;
mod posture;
mod reading;
mod residuals;
mod strip;
mod summary;
mod supports;
#[cfg(test)]
mod tests;
pub mod time_warping_plot;

use muybridge_capture::{Keypoint, NearOff};
use muybridge_core::{Database, Skeleton};

use crate::gait_laws::GaitLaw;
use crate::pipeline::PlateFit;
use plot::Ink;

/// The report on a set of fitted plates and the laws made of them, as a self-contained HTML page.
///
/// `database` is what was made of the plates; its strides stand beside them on the contact sheets. `failures` are the
/// causes why other plates were not fitted, in words, one for each. `skeleton` is the reference the plates were fitted
/// with.
pub fn html(
    fits: &[PlateFit],
    laws: &[GaitLaw],
    database: &Database,
    failures: &[String],
    skeleton: &Skeleton,
) -> String {
    let mut body = summary::summary(fits, failures);
    body.push_str(&contact_sheet::sheets(fits, database, skeleton));
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
