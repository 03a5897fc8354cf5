//! What is in a panel: the silhouette of horse and rider, the ground line, the lines of the wall, and where hooves may be.
//!
//! Works on all panels of a plate at once: they share the horse and the wall, so that each is judged by the others. Every finding
//! has a confidence between 0 and 1; below about 0.5 a person should look. A picture without a horse gives empty masks of
//! confidence 0.

mod background;
mod erase;
mod evidence;
mod ground;
mod hooves;
mod lines;
mod outline;
mod relax;
mod silhouette;
mod spacing;
mod still;
mod trust;
mod wall;

use image::{GrayImage, ImageBuffer, Luma};

use crate::PanelView;

/// Grey values that are not whole.
type Plane = ImageBuffer<Luma<f32>, Vec<f32>>;

/// A straight line in a panel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Line {
    /// Its ends, panel px: left to right, or top to bottom for an upright.
    pub ends_px: [[f64; 2]; 2],
    /// 0 to 1.
    pub confidence: f64,
}

impl Line {
    /// Height of a line that is not upright at a column, panel px.
    pub fn y_at(&self, x_px: f64) -> f64 {
        let [[x0, y0], [x1, y1]] = self.ends_px;
        if x1 == x0 { y0 } else { y0 + (y1 - y0) * (x_px - x0) / (x1 - x0) }
    }

    /// Column of a line that is not level at a height, panel px.
    pub fn x_at(&self, y_px: f64) -> f64 {
        let [[x0, y0], [x1, y1]] = self.ends_px;
        if y1 == y0 { x0 } else { x0 + (x1 - x0) * (y_px - y0) / (y1 - y0) }
    }

    /// Its ends in plate px.
    pub fn on_plate_px(&self, view: &PanelView) -> [[f64; 2]; 2] {
        self.ends_px.map(|end| view.transform.plate_from_panel(end))
    }
}

/// What is fixed in a panel.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wall {
    /// The line under the near hooves, across the whole panel: parallel to the edges of wall and track, through the lowest
    /// hooves of all panels. None where no horse is found.
    pub ground: Option<Line>,
    /// Uprights of the wall, as far as they are seen, left to right.
    pub uprights: Vec<Line>,
    /// Level lines of wall and track, as far as they are seen, from the top down.
    pub horizontals: Vec<Line>,
}

/// Horse and rider of a panel, with what they are harnessed to.
#[derive(Clone, Debug, PartialEq)]
pub struct Silhouette {
    /// Same size as the panel: 255 horse or rider, 0 anything else.
    pub mask: GrayImage,
    /// 0 to 1: by the steps of tone along the outline, the contrast, the area next to that of the other panels, and how much
    /// of the outline the panel's edge cuts off.
    pub confidence: f64,
}

/// A place that may be a hoof.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoofCandidate {
    /// Middle of the lowest part of the outline, panel px.
    pub at_px: [f64; 2],
    /// Height over the ground line, panel px, negative below; none without a ground line.
    pub height_px: Option<f64>,
    /// 0 to 1: by how far the outline points down there, and by the silhouette's own.
    pub confidence: f64,
}

/// The horse, with its rider, of every panel of a plate, given in order of time.
pub fn silhouettes(views: &[PanelView]) -> Vec<Silhouette> {
    silhouette::find(views)
}

/// Ground and wall of every panel of a plate. `silhouettes` are those of [`silhouettes`], one for each view.
pub fn walls(views: &[PanelView], silhouettes: &[Silhouette]) -> Vec<Wall> {
    let grounds = ground::find(views, silhouettes);
    let wall = |((view, horse), ground)| {
        let [uprights, horizontals] = wall::lines(view, horse);
        Wall { ground, uprights, horizontals }
    };
    views.iter().zip(silhouettes).zip(grounds).map(wall).collect()
}

/// Places where the outline points down as a hoof does, left to right: at most one for each leg that is seen apart, and now
/// and then a toe, a tail or a wheel.
pub fn hoof_candidates(silhouette: &Silhouette, ground: Option<&Line>) -> Vec<HoofCandidate> {
    hooves::find(silhouette, ground)
}

/// The value below which a share of the values lies; 0 for none. Reorders the values.
fn quantile(values: &mut [f32], share: f64) -> f32 {
    if values.is_empty() {
        return 0.0;
    }
    let index = (share * (values.len() - 1) as f64).round() as usize;
    *values.select_nth_unstable_by(index, f32::total_cmp).1
}
