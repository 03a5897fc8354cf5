//! The colours of an animation or of a strip, chosen once for all its pictures by median cut.

use image::{Rgb, RgbImage};

/// Colours are told apart by so many bits of each channel.
const BITS: u32 = 6;
const BINS: usize = 1 << (3 * BITS);

/// The palette.
pub(super) struct Palette {
    colors: Vec<[u8; 3]>,
    /// The place of each bin's colour.
    nearest: Vec<u8>,
}

/// Most places of a palette.
pub(super) const MOST_COLORS: usize = 256;

/// Colours of the pictures that share a place of the palette.
struct Cut {
    /// Bins and how often they occur.
    bins: Vec<(usize, u64)>,
}

impl Palette {
    /// Chooses at most so many colours (2 to [`MOST_COLORS`]) for pictures.
    pub(super) fn choose(pictures: &[RgbImage], most: usize) -> Self {
        let mut counts = vec![0u64; BINS];
        for pixel in pictures.iter().flat_map(RgbImage::pixels) {
            counts[bin(*pixel)] += 1;
        }
        let bins = counts.into_iter().enumerate().filter(|(_, count)| *count > 0).collect();
        let mut cuts = vec![Cut { bins }];
        while cuts.len() < most.min(MOST_COLORS) {
            let widest = (0..cuts.len()).max_by(|a, b| cuts[*a].spread().total_cmp(&cuts[*b].spread()));
            let Some(widest) = widest.filter(|widest| cuts[*widest].bins.len() > 1) else { break };
            let upper = cuts[widest].split();
            cuts.push(upper);
        }
        let mut nearest = vec![0; BINS];
        for (index, cut) in cuts.iter().enumerate() {
            for (bin, _) in &cut.bins {
                nearest[*bin] = index as u8;
            }
        }
        Self { colors: cuts.iter().map(Cut::mean).collect(), nearest }
    }

    /// The places of a picture's pixels in the palette.
    pub(super) fn indices(&self, picture: &RgbImage) -> Vec<u8> {
        picture.pixels().map(|pixel| self.nearest[bin(*pixel)]).collect()
    }

    /// Red, green and blue of every colour.
    pub(super) fn bytes(&self) -> Vec<u8> {
        self.colors.concat()
    }

    /// The number of colours.
    pub(super) fn len(&self) -> usize {
        self.colors.len()
    }
}

impl Cut {
    /// How much its colours differ, the frequent ones more: the square root keeps the horse from losing all to the sky.
    fn spread(&self) -> f64 {
        let count: u64 = self.bins.iter().map(|(_, count)| count).sum();
        self.extent().1 * (count as f64).sqrt()
    }

    /// The channel that varies most, and by how much.
    fn extent(&self) -> (usize, f64) {
        let range = |channel: usize| {
            let values = || self.bins.iter().map(|(bin, _)| channels(*bin)[channel]);
            f64::from(values().max().unwrap_or(0)) - f64::from(values().min().unwrap_or(0))
        };
        let wider = |a: (usize, f64), b: (usize, f64)| if b.1 > a.1 { b } else { a };
        (0..3).map(|channel| (channel, range(channel))).fold((0, -1.0), wider)
    }

    /// Keeps the lower half of the pixels along the widest channel, and returns the upper one.
    fn split(&mut self) -> Self {
        let (channel, _) = self.extent();
        self.bins.sort_by_key(|(bin, _)| (channels(*bin)[channel], *bin));
        let total: u64 = self.bins.iter().map(|(_, count)| count).sum();
        let mut below = 0;
        let middle = self.bins.iter().take_while(|(_, count)| {
            below += count;
            2 * below <= total
        });
        let middle = middle.count().clamp(1, self.bins.len() - 1);
        Self { bins: self.bins.split_off(middle) }
    }

    fn mean(&self) -> [u8; 3] {
        let total: u64 = self.bins.iter().map(|(_, count)| count).sum();
        [0, 1, 2].map(|channel| {
            let sum: u64 =
                self.bins.iter().map(|(bin, count)| u64::from(channels(*bin)[channel]) * count).sum();
            (sum as f64 / total.max(1) as f64).round() as u8
        })
    }
}

fn bin(Rgb([r, g, b]): Rgb<u8>) -> usize {
    [r, g, b].into_iter().fold(0, |bin, channel| bin << BITS | usize::from(channel >> (8 - BITS)))
}

/// The middle colour of a bin.
fn channels(bin: usize) -> [u8; 3] {
    [2, 1, 0].map(|place| {
        let high = (bin >> (place * BITS) & ((1 << BITS) - 1)) as u8;
        // Spread over the whole range, so that white stays white.
        high << (8 - BITS) | high >> (2 * BITS - 8)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_colours_are_kept_and_many_come_near() {
        let few = RgbImage::from_fn(8, 8, |x, _| Rgb([if x < 4 { 255 } else { 0 }, 0, 255]));
        let palette = Palette::choose(std::slice::from_ref(&few), 255);
        assert_eq!(palette.len(), 2);
        assert!(palette.colors.contains(&[255, 0, 255]) && palette.colors.contains(&[0, 0, 255]));

        let many = RgbImage::from_fn(256, 64, |x, y| Rgb([x as u8, (4 * y) as u8, (x / 2) as u8]));
        let palette = Palette::choose(std::slice::from_ref(&many), 255);
        assert_eq!((palette.colors.len(), palette.bytes().len()), (255, 765));
        for (pixel, index) in many.pixels().zip(palette.indices(&many)) {
            let found = palette.colors[usize::from(index)];
            let off = (0..3).map(|c| pixel.0[c].abs_diff(found[c])).max();
            assert!(off < Some(24), "{pixel:?} became {found:?}");
        }
    }
}
