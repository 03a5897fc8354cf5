//! The panels of a plate as pictures of their own, for exchange with tools that know one animal a picture.

use std::collections::BTreeMap;

use muybridge_capture::Manifest;
use muybridge_capture::exchange::PanelPictures;

use crate::panel_view::{PanelTransform, side_lengths_px};

/// Where the cut-outs of a plate's panels lie on it, as [`PanelView`](crate::PanelView) makes them at full size.
#[derive(Clone, Debug)]
pub struct Cutouts(BTreeMap<u32, ([u32; 2], PanelTransform)>);

impl Cutouts {
    /// Cut-outs of all panels that have a convex quadrilateral.
    pub fn new(manifest: &Manifest) -> Self {
        let cutout = |quad_px: [[f64; 2]; 4]| {
            let size = side_lengths_px(&quad_px).map(|v| v.round().max(1.0));
            Some((size.map(|v| v as u32), PanelTransform::new(quad_px, size)?))
        };
        let panels = manifest.panels.iter();
        Self(panels.filter_map(|panel| Some((panel.panel, cutout(panel.quad_px)?))).collect())
    }
}

impl PanelPictures for Cutouts {
    fn size_px(&self, panel: u32) -> Option<[u32; 2]> {
        self.0.get(&panel).map(|(size, _)| *size)
    }

    fn plate_from_panel(&self, panel: u32, point_in_panel_px: [f64; 2]) -> Option<[f64; 2]> {
        self.0.get(&panel).map(|(_, transform)| transform.plate_from_panel(point_in_panel_px))
    }

    fn panel_from_plate(&self, panel: u32, point_in_plate_px: [f64; 2]) -> Option<[f64; 2]> {
        self.0.get(&panel).map(|(_, transform)| transform.panel_from_plate(point_in_plate_px))
    }
}
