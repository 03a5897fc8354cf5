//! Points from one panel to the next.
//!
//! Plates have 8 to 24 panels a stride, and each may be from another camera, so that a hoof moves by a quarter of the
//! animal's height between panels and turns as it goes. So nothing is followed in small steps. The trunk is found first, by
//! correlation over the whole panel; it carries the roots of neck and limbs. Each of these is then sought as a chain of
//! segments: expectation from the two panels before (`expectation`), normalised correlation with the segments' looks
//! there turned to every angle (`template`), all postures by dynamic programming at low resolution (`search`), the best
//! ones refined at full resolution (`chain`), and the four limbs chosen together (`together`). What these steps leave in
//! doubt makes the quality (`quality`).

mod chain;
mod climb;
mod expectation;
mod figure;
mod frame;
mod looks;
mod proposal;
mod quality;
mod search;
mod template;
mod together;
mod trunk;

use image::GrayImage;
use muybridge_capture::{Keypoint, Keypoints};

use crate::PanelView;
use figure::{BACK, Figure};
use frame::{Frame, Place};
use looks::{Seen, Sought};
use together::{Candidates, choose};
use trunk::TrunkMotion;

pub use proposal::{Proposal, propose};

/// Panels looked back to: a turn takes two.
const LOOKED_BACK: usize = 2;

/// A panel whose points are known.
#[derive(Clone, Copy, Debug)]
pub struct PanelPoints<'a> {
    /// The photograph.
    pub view: &'a PanelView,
    /// 255 where the animal is, as large as the view's picture; one of another size is not used.
    pub silhouette: Option<&'a GrayImage>,
    /// Its points, plate px: placed by hand, taken from a fit, or tracked before.
    pub points: &'a Keypoints,
}

/// A point found in the next panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracked {
    /// Which.
    pub keypoint: Keypoint,
    /// Place, plate px.
    pub at_px: [f64; 2],
    /// From 0, no idea, to 1, sure: for knees, hocks, fetlocks and hooves of a drawn plate the probability that they are
    /// within 2 % of the height at the withers. On photographs it orders the points, but is too hopeful.
    pub quality: f64,
}

/// Finds the points of the last known panel in the next one. Known panels are neighbours in order, evenly spaced in time, the
/// one beside the next panel last; one is enough, two do much better. Tracking backwards is the same with the order
/// turned round. Silhouettes help where both the last and the next panel have one.
///
/// Points come in the order of [`Keypoint::all`]. The back's points and all limbs and neck of at least two neighbouring points are
/// tracked; other points are left out, and all are when the animal's size cannot be told from the last panel's points.
pub fn track(known: &[PanelPoints], next: &PanelView, next_silhouette: Option<&GrayImage>) -> Vec<Tracked> {
    let Some(last) = known.last() else { return Vec::new() };
    let Some(height_px) = figure::height_plate_px(last.points) else { return Vec::new() };
    let mirrored = figure::faces_left(last.points);
    let known = &known[known.len().saturating_sub(LOOKED_BACK)..];
    let frames: Vec<Frame> =
        known.iter().map(|panel| Frame::new(panel.view, panel.silhouette, height_px, mirrored)).collect();
    let figures: Vec<Figure> =
        known.iter().zip(&frames).map(|(panel, frame)| Figure::new(panel.points, frame)).collect();
    let next = Frame::new(next, next_silhouette, height_px, mirrored);
    let Some(trunk) = frames.last().map(|last| TrunkMotion::find(&figures, last, &next)) else {
        return Vec::new();
    };
    let seen = Seen { frames, figures, trunk };
    let mut found = found_on_back(&seen);
    let (neck, limbs): (Vec<Sought>, Vec<Sought>) =
        seen.sought().into_iter().partition(|sought| matches!(sought.keypoints[0], Keypoint::Body(_)));
    found.extend(found_together(&neck, &next));
    found.extend(found_together(&limbs, &next));
    found.sort_by_key(|(keypoint, ..)| keypoint.index());
    // The withers are on the back and at the root of the neck.
    found.dedup_by_key(|(keypoint, ..)| *keypoint);
    let tracked = |(keypoint, place, quality)| Tracked { keypoint, at_px: next.plate_px(place), quality };
    found.into_iter().map(tracked).collect()
}

type Found = (Keypoint, Place, f64);

fn found_on_back(seen: &Seen) -> Vec<Found> {
    let Some(last) = seen.figures.last() else { return Vec::new() };
    let quality = quality::of_trunk(seen.trunk.likeness);
    let found = |point| {
        let keypoint = Keypoint::Body(point);
        Some((keypoint, seen.trunk.apply(last.place(keypoint)?), quality))
    };
    BACK.into_iter().filter_map(found).collect()
}

/// The joints of chains whose postures are chosen together.
fn found_together(sought: &[Sought], next: &Frame) -> Vec<Found> {
    let postures: Vec<_> = sought.iter().map(|sought| sought.chain.find(next)).collect();
    let found: Vec<_> = sought.iter().zip(&postures).filter(|(_, postures)| !postures.is_empty()).collect();
    let candidates: Vec<Candidates> =
        found.iter().map(|(sought, postures)| Candidates { chain: &sought.chain, postures }).collect();
    let mut joints = Vec::new();
    for ((sought, postures), choice) in found.iter().zip(choose(&candidates)) {
        let posture = &sought.chain.settle(next, &postures[choice.posture]);
        let quality = quality::of_posture(posture, choice);
        joints.extend(sought.keypoints.iter().zip(&posture.joints).map(|(k, place)| (*k, *place, quality)));
    }
    joints
}
