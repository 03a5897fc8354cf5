//! Points from one panel to the next.

mod chain;
mod climb;
mod expectation;
mod frame;
mod template;
mod trunk;

use image::GrayImage;
use muybridge_capture::{Keypoint, Keypoints};

use crate::PanelView;

/// A panel whose points are known.
#[derive(Clone, Copy, Debug)]
pub struct PanelPoints<'a> {
    /// The photograph.
    pub view: &'a PanelView,
    /// 255 where the animal is, as large as the view's picture.
    pub silhouette: Option<&'a GrayImage>,
    /// Its points, plate px.
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
    expectation::track(known, next, next_silhouette, None).unwrap_or_default()
}
/// TEMP
pub fn track_debug(known: &[PanelPoints], next: &PanelView, next_silhouette: Option<&GrayImage>, truth: Option<&Keypoints>) -> Vec<Tracked> {
    expectation::track(known, next, next_silhouette, truth).unwrap_or_default()
}
