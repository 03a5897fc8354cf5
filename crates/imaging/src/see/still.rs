//! Frames of one camera that stands still: what does not move is the background.

use image::Luma;

use super::background::Background;
use super::lines::Tone;
use super::{Plane, quantile};

/// Fewer frames may all show the horse in one place.
const FEWEST: usize = 8;
/// Width of the strips at the sides where frames are compared, share of the width.
const SIDE: f64 = 0.08;
/// Frames differ there by less than this part of what a smooth wall leaves unexplained.
const MOST_CHANGE: f32 = 0.15;
/// Of a pixel's tones over time, the one that is the background's, counted from the horse's end.
const SEEN: f64 = 0.8;
/// Clouds, leaves and coding change the background by this many grey values.
const LEAST_NOISE: f32 = 3.0;

/// The background of all frames, if the camera stood still. `walls` are the frames' backgrounds each by itself.
pub(super) fn background(frames: &[Plane], walls: &[Background], horse: Tone) -> Option<Background> {
    let size = frames.first()?.dimensions();
    if frames.len() < FEWEST || frames.iter().any(|frame| frame.dimensions() != size) {
        return None;
    }
    let side = (SIDE * f64::from(size.0)).ceil() as u32;
    let at_side = |x: u32| x < side || x + side >= size.0;
    let middle_difference = |pairs: &mut dyn Iterator<Item = (&Plane, &Plane)>| {
        let mut all: Vec<f32> = Vec::new();
        for (a, b) in pairs {
            let sides = a.enumerate_pixels().filter(|(x, _, _)| at_side(*x));
            all.extend(sides.map(|(x, y, tone)| (tone.0[0] - b.get_pixel(x, y).0[0]).abs()));
        }
        quantile(&mut all, 0.5)
    };
    let change = middle_difference(&mut frames.iter().zip(&frames[1..]));
    let unexplained = middle_difference(&mut frames.iter().zip(walls.iter().map(|wall| &wall.tone)));
    if change >= MOST_CHANGE * unexplained {
        return None;
    }
    let share = if horse == Tone::Dark { SEEN } else { 1.0 - SEEN };
    let tone = Plane::from_fn(size.0, size.1, |x, y| {
        let mut tones: Vec<f32> = frames.iter().map(|frame| frame.get_pixel(x, y).0[0]).collect();
        Luma([quantile(&mut tones, share)])
    });
    Some(Background { tone, noise: (1.5 * change).max(LEAST_NOISE), track: size.1 })
}
