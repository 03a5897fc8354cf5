//! Points from one panel to the next.
//!
//! Plates have 8 to 24 panels a stride, and each may be from another camera, so that a hoof moves by a quarter of the
//! animal's height between panels and turns as it goes. So nothing is followed in small steps. The trunk is found first, by
//! correlation over the whole panel; it carries the roots of neck and limbs. Each of these is then sought as a chain of
//! segments: expectation from the two panels before ([`expectation`]), normalised correlation with the segments' looks
//! there turned to every angle ([`template`]), all postures by dynamic programming at low resolution ([`search`]), the best
//! ones refined at full resolution ([`chain`]), and the four limbs chosen together ([`together`]). What each of these steps
//! leaves in doubt makes the quality.

mod chain;
mod climb;
mod expectation;
mod figure;
mod frame;
mod looks;
mod quality;
mod search;
mod template;
mod together;
mod trunk;

use image::GrayImage;
use muybridge_capture::{Keypoint, Keypoints};

use crate::PanelView;
use chain::Posture;
use figure::{BACK, Figure};
use frame::{Frame, Place};
use looks::{Seen, Sought};
use together::{Candidates, Choice, choose};
use trunk::TrunkMotion;

/// A panel whose points are known.
#[derive(Clone, Copy, Debug)]
pub struct PanelPoints<'a> {
    /// The photograph.
    pub view: &'a PanelView,
    /// 255 where the animal is, as large as the view's picture; one of another size is not used.
    pub silhouette: Option<&'a GrayImage>,
    /// Its points, plate px, by hand, from a fit or tracked before.
    pub points: &'a Keypoints,
}

/// A point found in the next panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tracked {
    /// Which.
    pub keypoint: Keypoint,
    /// Place, plate px.
    pub at_px: [f64; 2],
    /// 0..1.
    pub quality: f64,
    /// TEMP
    pub debug: [f64; 4],
}

/// Tracks.
pub fn track(known: &[PanelPoints], next: &PanelView, next_silhouette: Option<&GrayImage>) -> Vec<Tracked> {
    let Some(last) = known.last() else { return Vec::new() };
    let Some(height_px) = figure::height_plate_px(last.points) else { return Vec::new() };
    let mirrored = figure::faces_left(last.points);
    // No more than two panels are looked back to.
    let known = &known[known.len().saturating_sub(2)..];
    let frames: Vec<Frame> =
        known.iter().map(|panel| Frame::new(panel.view, panel.silhouette, height_px, mirrored)).collect();
    let next = Frame::new(next, next_silhouette, height_px, mirrored);
    let figures: Vec<Figure> =
        known.iter().zip(&frames).map(|(panel, frame)| Figure::new(panel.points, frame)).collect();
    let trunk = TrunkMotion::find(&figures, &frames[frames.len() - 1], &next);
    let seen = Seen { frames, figures, trunk };
    let mut out = Vec::new();
    let last = &seen.figures[seen.figures.len() - 1];
    for p in BACK {
        if let Some(place) = last.place(Keypoint::Body(p)) {
            out.push((Keypoint::Body(p), trunk.apply(place), [trunk.likeness; 4]));
        }
    }
    let sought = seen.sought();
    let postures: Vec<Vec<Posture>> = sought.iter().map(|sought| sought.chain.find(&next)).collect();
    let (neck, limbs): (Vec<_>, Vec<_>) = sought.iter().zip(&postures).filter(|(_, p)| !p.is_empty()).partition(|(s, _)| matches!(s.keypoints[0], Keypoint::Body(_)));
    for group in [neck, limbs] {
        let c: Vec<Candidates> = group.iter().map(|(s, p)| Candidates { chain: &s.chain, postures: p }).collect();
        for ((s, p), choice) in group.iter().zip(choose(&c)) {
            let posture = &p[choice.posture];
            for (i, k) in s.keypoints.iter().enumerate() {
                if i == 0 && matches!(k, Keypoint::Body(_)) { continue }
                out.push((*k, posture.joints[i], [choice.share, posture.likeness[i.saturating_sub(1)], posture.concentration, posture.score]));
            }
        }
    }
    out.into_iter().map(|(keypoint, place, debug)| Tracked { keypoint, at_px: next.plate_px(place), quality: debug[0], debug }).collect()
}
/// TEMP
pub fn track_debug(known: &[PanelPoints], next: &PanelView, next_silhouette: Option<&GrayImage>, truth: Option<&Keypoints>) -> Vec<Tracked> {
    track(known, next, next_silhouette)
}
