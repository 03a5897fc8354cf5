//! Two classes on a grid of pixels: each pixel's own evidence, and neighbours of like tone that pull together.
//!
//! ## References
//! Mean field for the model of Boykov & Jolly, *Interactive graph cuts for optimal boundary and region segmentation of
//! objects in N-D images* (2001).

use super::Plane;

/// Pull of a neighbour of the same tone, in units of log odds.
const PULL: f32 = 0.9;
/// Rounds: what changes later changes less than a pixel in a hundred.
const ROUNDS: usize = 12;

/// The probability of the first class, from its log odds by the pixel alone. `noise` is the difference of tone between
/// neighbours of one class, standard deviation.
pub(super) fn relaxed(log_odds: &Plane, tone: &Plane, noise: f32) -> Plane {
    let (width, height) = (log_odds.width() as usize, log_odds.height() as usize);
    let pulls = Pulls::new(tone, noise);
    let own = log_odds.as_raw();
    // Spins: probability times two less one.
    let mut spins: Vec<f32> = own.iter().map(|v| spin(*v)).collect();
    for _ in 0..ROUNDS {
        let mut field = own.clone();
        for y in 0..height {
            let row = y * width;
            if width > 1 {
                for i in row..row + width - 1 {
                    let pull = pulls.right[i];
                    field[i] += pull * spins[i + 1];
                    field[i + 1] += pull * spins[i];
                }
            }
            if y + 1 < height {
                for i in row..row + width {
                    let pull = pulls.down[i];
                    field[i] += pull * spins[i + width];
                    field[i + width] += pull * spins[i];
                }
            }
        }
        for (spin_, field) in spins.iter_mut().zip(&field) {
            *spin_ = 0.5 * (*spin_ + spin(*field));
        }
    }
    let probabilities = spins.iter().map(|s| 0.5 * (s + 1.0)).collect();
    Plane::from_raw(log_odds.width(), log_odds.height(), probabilities).unwrap_or_default()
}

/// `tanh(x / 2)`, closely: the spin of these log odds.
fn spin(log_odds: f32) -> f32 {
    let x = (0.5 * log_odds).clamp(-3.0, 3.0);
    x * (27.0 + x * x) / (27.0 + 9.0 * x * x)
}

/// The pull between each pixel and its right and lower neighbours.
struct Pulls {
    right: Vec<f32>,
    down: Vec<f32>,
}

impl Pulls {
    fn new(tone: &Plane, noise: f32) -> Self {
        let width = tone.width() as usize;
        let tones = tone.as_raw();
        let scale = 0.25 / (noise * noise).max(1e-6);
        let pull = |a: f32, b: f32| {
            let unlike = 1.0 + scale * (a - b) * (a - b);
            PULL * (0.1 + 0.9 / (unlike * unlike))
        };
        let right = (0..tones.len())
            .map(|i| if (i + 1) % width == 0 { 0.0 } else { pull(tones[i], tones[i + 1]) })
            .collect();
        let down = (0..tones.len())
            .map(|i| tones.get(i + width).map_or(0.0, |below| pull(tones[i], *below)))
            .collect();
        Self { right, down }
    }
}
