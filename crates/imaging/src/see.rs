//! What is in a panel: silhouette, ground, wall, hooves.

mod background;
mod erase;
mod evidence;
mod lines;
mod outline;
mod relax;
mod silhouette;

use image::{GrayImage, ImageBuffer, Luma};

use crate::PanelView;

/// Grey values that are not whole.
type Plane = ImageBuffer<Luma<f32>, Vec<f32>>;

/// Horse and rider of a panel.
#[derive(Clone, Debug)]
pub struct Silhouette {
    /// Same size as the panel: 255 horse or rider, 0 anything else.
    pub mask: GrayImage,
    /// 0 to 1.
    pub confidence: f64,
}

/// The horse, with its rider, of every panel of a plate, given in order of time.
pub fn silhouettes(views: &[PanelView]) -> Vec<Silhouette> {
    silhouette::find(views)
}

/// The value below which a share of the values lies; 0 for none. Reorders the values.
fn quantile(values: &mut [f32], share: f64) -> f32 {
    if values.is_empty() {
        return 0.0;
    }
    let index = (share * (values.len() - 1) as f64).round() as usize;
    *values.select_nth_unstable_by(index, f32::total_cmp).1
}
