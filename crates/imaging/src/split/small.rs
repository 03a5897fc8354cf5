//! A small copy of a plate, on which panels are first looked for.

use image::{GrayImage, Luma};
use imageproc::filter::median_filter;

/// Longest side of a copy, px: gutters of half a percent of the plate's width are still several pixels wide.
const LONGEST_PX: u32 = 2000;
/// Plate px to one of the copy from which on grain is averaged away and needs no filter.
const SMOOTH_FROM: u32 = 3;

/// A small copy.
pub(super) struct Small {
    /// Tones, with little grain.
    pub(super) picture: GrayImage,
    /// Plate px to one of the copy.
    pub(super) factor: u32,
}

impl Small {
    /// Means of square blocks of the plate. What is left over at the right and at the bottom is not looked at.
    pub(super) fn new(plate: &GrayImage) -> Self {
        let factor = plate.width().max(plate.height()).div_ceil(LONGEST_PX).max(1);
        let picture = if factor == 1 { plate.clone() } else { block_means(plate, factor) };
        let picture = if factor < SMOOTH_FROM { median_filter(&picture, 1, 1) } else { picture };
        Self { picture, factor }
    }

    /// Difference between the lightest and the darkest tone.
    pub(super) fn range(&self) -> u8 {
        let tones = self.picture.as_raw();
        let (low, high) = tones.iter().fold((u8::MAX, 0), |(low, high), v| (low.min(*v), high.max(*v)));
        high.saturating_sub(low)
    }
}

fn block_means(plate: &GrayImage, factor: u32) -> GrayImage {
    let (side, stride) = (factor as usize, plate.width() as usize);
    let mut means = GrayImage::new((plate.width() / factor).max(1), (plate.height() / factor).max(1));
    let columns = means.width() as usize;
    for (lines, means) in plate.as_raw().chunks_exact(stride * side).zip(means.chunks_exact_mut(columns)) {
        let mut sums = vec![0u32; columns];
        for line in lines.chunks_exact(stride) {
            for (sum, block) in sums.iter_mut().zip(line.chunks_exact(side)) {
                *sum += block.iter().map(|tone| u32::from(*tone)).sum::<u32>();
            }
        }
        for (mean, sum) in means.iter_mut().zip(sums) {
            *mean = (sum / (factor * factor)) as u8;
        }
    }
    means
}

/// White where a picture's tone lies within a range.
pub(super) fn within(picture: &GrayImage, darkest: u8, lightest: u8) -> GrayImage {
    let mut mask = picture.clone();
    for Luma([tone]) in mask.pixels_mut() {
        *tone = if (darkest..=lightest).contains(tone) { u8::MAX } else { 0 };
    }
    mask
}
