//! A picture and its halves: each level is the one before at half the size.

use std::sync::OnceLock;

use image::{GrayImage, Pixel, RgbImage};

/// Halving stops at this size: one small texture that is always there, 256 kB.
const COARSEST_PX: u32 = 256;

/// Box-filtered levels of a picture. Texel `(x, y)` of level `l` is the mean of the `2^l` x `2^l` plate px from
/// `(x 2^l, y 2^l)` on, so far as they are inside the picture. Takes four bytes a pixel.
#[derive(Debug)]
pub struct Pyramid {
    levels: Vec<RgbImage>,
    gray: OnceLock<GrayImage>,
}

impl Pyramid {
    /// Builds the levels, down to 256 px at most. 50 megapixels take about 0.2 s: not for the thread that draws.
    pub fn new(picture: RgbImage) -> Self {
        let mut levels = vec![picture];
        while let Some(last) = levels.last().filter(|last| last.width().max(last.height()) > COARSEST_PX) {
            levels.push(half(last));
        }
        Self { levels, gray: OnceLock::new() }
    }

    /// The picture itself, without adjustments.
    pub fn picture(&self) -> &RgbImage {
        &self.levels[0]
    }

    /// Width and height, px.
    pub fn size_px(&self) -> [u32; 2] {
        self.picture().dimensions().into()
    }

    /// The picture in grey, made at the first call: 50 megapixels take about 0.2 s and 50 MB.
    pub fn gray(&self) -> &GrayImage {
        self.gray.get_or_init(|| {
            let [width, height] = self.size_px();
            let mut gray = GrayImage::new(width, height);
            gray.pixels_mut().zip(self.picture().pixels()).for_each(|(to, from)| *to = from.to_luma());
            gray
        })
    }

    pub(super) fn levels(&self) -> &[RgbImage] {
        &self.levels
    }
}

/// The picture at half the size, rounded up.
fn half(from: &RgbImage) -> RgbImage {
    let row_bytes = 3 * from.width() as usize;
    let size = [from.width().div_ceil(2), from.height().div_ceil(2)];
    let mut to = RgbImage::new(size[0], size[1]);
    let below = from.as_raw().chunks(2 * row_bytes.max(1));
    for (pair, row) in below.zip(to.chunks_exact_mut(3 * size[0].max(1) as usize)) {
        let (upper, lower) = pair.split_at(row_bytes);
        // An odd last row is its own neighbour.
        half_row(upper, if lower.is_empty() { upper } else { lower }, row);
    }
    to
}

fn half_row(upper: &[u8], lower: &[u8], to: &mut [u8]) {
    let (pairs, _) = upper.as_chunks::<6>();
    let (pairs_below, _) = lower.as_chunks::<6>();
    for ((a, b), mean) in pairs.iter().zip(pairs_below).zip(to.as_chunks_mut::<3>().0) {
        for i in 0..3 {
            let sum = u16::from(a[i]) + u16::from(a[i + 3]) + u16::from(b[i]) + u16::from(b[i + 3]);
            mean[i] = ((sum + 2) / 4) as u8;
        }
    }
    let odd = upper.len() / 6 * 6;
    for (i, byte) in (odd..upper.len()).zip(to.iter_mut().skip(odd / 2)) {
        *byte = (u16::from(upper[i]) + u16::from(lower[i])).div_ceil(2) as u8;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_level_is_the_mean_of_the_one_before() {
        let picture = RgbImage::from_fn(515, 301, |x, y| image::Rgb([(x % 256) as u8, (y % 256) as u8, 77]));
        let pyramid = Pyramid::new(picture.clone());
        let sizes: Vec<_> = pyramid.levels().iter().map(RgbImage::dimensions).collect();
        assert_eq!(sizes, [(515, 301), (258, 151), (129, 76)]);
        let [a, b, c, d] = [(20, 40), (21, 40), (20, 41), (21, 41)].map(|(x, y)| picture.get_pixel(x, y).0);
        let mean = pyramid.levels()[1].get_pixel(10, 20).0;
        for i in 0..3 {
            let sum: u32 = [a, b, c, d].iter().map(|p| u32::from(p[i])).sum();
            assert_eq!(u32::from(mean[i]), (sum + 2) / 4);
        }
        // The odd last column and row.
        assert_eq!(pyramid.levels()[1].get_pixel(257, 150).0, picture.get_pixel(514, 300).0);
    }

    #[test]
    fn any_size_will_do() {
        for (width, height) in [(0, 0), (0, 9), (1, 1), (1, 3000), (60_000, 10), (257, 1)] {
            let pyramid = Pyramid::new(RgbImage::new(width, height));
            let last = pyramid.levels().last().unwrap();
            assert!(last.width() <= 256 && last.height() <= 256, "{width} x {height}");
            assert_eq!(pyramid.gray().dimensions(), (width, height));
        }
    }

    #[test]
    fn fifty_megapixels_take_well_under_a_second() {
        // Written to, as a decoded picture is.
        let picture = RgbImage::from_pixel(8192, 6144, image::Rgb([90, 80, 70]));
        let start = std::time::Instant::now();
        let pyramid = Pyramid::new(picture);
        let built = start.elapsed();
        let _ = pyramid.gray();
        println!("50 megapixels: levels {built:?}, grey {:?}", start.elapsed() - built);
        let bytes: usize = pyramid.levels().iter().map(|level| level.as_raw().len()).sum();
        assert!(bytes < 4 * 8192 * 6144 + 1000, "{bytes}");
        assert!(built.as_secs_f64() < 5.0, "{built:?}");
    }
}
