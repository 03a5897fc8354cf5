//! Tiles: how a level is cut into textures.

use egui::{Color32, ColorImage, TextureOptions};
use image::RgbImage;

use super::adjustment::toned;
use super::pyramid::Pyramid;

/// Texels of a tile along a side. With the border 512, which every graphics driver takes.
pub(super) const TILE: u32 = 510;
/// Texels of the neighbouring tile on each side, so that filtering shows no seam.
const BORDER: u32 = 1;
/// Bytes of a texel on the graphics card.
const TEXEL_BYTES: usize = 4;

/// Which tile. Row and column count tiles of `TILE` texels; a tile covers those at twice its row and column, and one
/// more, of the next finer level.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct TileKey {
    /// Number of the picture.
    pub(super) image: usize,
    /// Level of the pyramid, 0 the finest.
    pub(super) level: usize,
    /// Tile row.
    pub(super) row: u32,
    /// Tile column.
    pub(super) column: u32,
    /// Shows the pixels as squares.
    pub(super) squares: bool,
}

impl TileKey {
    /// The single tile of a picture's coarsest level.
    pub(super) fn coarsest(image: usize, pyramid: &Pyramid) -> Self {
        Self { image, level: pyramid.levels().len() - 1, row: 0, column: 0, squares: false }
    }

    /// The tile to show in this one's place: first the same with smooth pixels, then the next coarser level.
    pub(super) fn substitute(self) -> Self {
        if self.squares {
            return Self { squares: false, ..self };
        }
        Self { level: self.level + 1, row: self.row / 2, column: self.column / 2, ..self }
    }

    /// How the tile is filtered.
    pub(super) fn options(self) -> TextureOptions {
        if self.squares { TextureOptions::NEAREST } else { TextureOptions::LINEAR }
    }

    /// First texel of the tile in the level and the one after its last, along x and y, without the border; none outside.
    fn span(self, level: &RgbImage) -> Option<[[u32; 2]; 2]> {
        let along = |index: u32, size: u32| {
            let first = index.checked_mul(TILE)?;
            (first < size).then(|| [first, size.min(first.saturating_add(TILE))])
        };
        Some([along(self.column, level.width())?, along(self.row, level.height())?])
    }

    /// Width and height of the texture with its border; none outside of the picture.
    pub(super) fn texture_size(self, pyramid: &Pyramid) -> Option<[usize; 2]> {
        let spans = self.span(pyramid.levels().get(self.level)?)?;
        Some(spans.map(|[first, end]| (end - first + 2 * BORDER) as usize))
    }

    /// Bytes of the texture.
    pub(super) fn bytes(self, pyramid: &Pyramid) -> usize {
        self.texture_size(pyramid).map_or(0, |[width, height]| width * height * TEXEL_BYTES)
    }

    /// Where a plate point is in the texture, 0 to 1.
    pub(super) fn uv(self, at_px: [f64; 2], texture_size: [usize; 2]) -> egui::Pos2 {
        let texels_per_px = (-(self.level as f64)).exp2();
        let first = [self.column, self.row].map(|index| f64::from(index) * f64::from(TILE));
        let [u, v] = [0, 1].map(|i| {
            (at_px[i] * texels_per_px - first[i] + f64::from(BORDER)) / texture_size[i].max(1) as f64
        });
        egui::pos2(u as f32, v as f32)
    }

    /// The texture's texels; at the picture's edge the border repeats the last ones.
    pub(super) fn cut(self, pyramid: &Pyramid, tones: &[u8; 256]) -> Option<ColorImage> {
        let level = pyramid.levels().get(self.level)?;
        let [[left, right], [top, _]] = self.span(level)?;
        let size = self.texture_size(pyramid)?;
        let mut texels: Vec<Color32> = Vec::with_capacity(size[0] * size[1]);
        let row_bytes = 3 * level.width() as usize;
        let first = left.saturating_sub(BORDER);
        let last = right.min(level.width() - 1);
        for y in (0..size[1] as u32).map(|y| (top + y).saturating_sub(BORDER).min(level.height() - 1)) {
            let start = row_bytes * y as usize;
            let row = &level.as_raw()[start + 3 * first as usize..start + 3 * (last as usize + 1)];
            push_row(&mut texels, row, tones, left == 0, right == level.width());
        }
        Some(ColorImage::new(size, texels))
    }
}

/// One row of texels; its first or last one twice where there is no neighbour.
fn push_row(texels: &mut Vec<Color32>, row: &[u8], tones: &[u8; 256], first_twice: bool, last_twice: bool) {
    let color = |rgb: &[u8]| toned([rgb[0], rgb[1], rgb[2]], tones);
    if first_twice {
        texels.extend(row.chunks_exact(3).next().map(color));
    }
    texels.extend(row.chunks_exact(3).map(color));
    if last_twice {
        texels.extend(row.chunks_exact(3).next_back().map(color));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn key(level: usize, row: u32, column: u32) -> TileKey {
        TileKey { image: 0, level, row, column, squares: false }
    }

    #[test]
    fn neighbouring_tiles_share_their_border_texels() {
        let picture = RgbImage::from_fn(1100, 600, |x, y| image::Rgb([(x % 251) as u8, (y % 241) as u8, 9]));
        let pyramid = Pyramid::new(picture.clone());
        let tones = std::array::from_fn(|i| i as u8);
        let tile = key(0, 0, 1).cut(&pyramid, &tones).unwrap();
        assert_eq!(tile.size, [512, 512]);
        let rgb = |x: u32, y: u32| toned(picture.get_pixel(x, y).0, &tones);
        assert_eq!(tile[(0, 1)], rgb(509, 0));
        assert_eq!(tile[(1, 0)], rgb(510, 0));
        assert_eq!(tile[(511, 511)], rgb(1020, 510));
        let last = key(0, 1, 2).cut(&pyramid, &tones).unwrap();
        assert_eq!(last.size, [1100 - 1020 + 2, 600 - 510 + 2]);
        assert_eq!(last[(81, 91)], rgb(1099, 599));
        assert!(key(0, 2, 0).cut(&pyramid, &tones).is_none() && key(7, 0, 0).cut(&pyramid, &tones).is_none());
    }

    #[test]
    fn a_substitute_shows_the_same_place() {
        let pyramid = Pyramid::new(RgbImage::new(3000, 2000));
        let (fine, at_px) = (key(0, 3, 5), [2555.0, 1540.0]);
        let coarse = fine.substitute();
        assert_eq!(coarse, key(1, 1, 2));
        let size = coarse.texture_size(&pyramid).unwrap();
        let uv = coarse.uv(at_px, size);
        assert!((f64::from(uv.x) * size[0] as f64 - (2555.0 / 2.0 - 1020.0 + 1.0)).abs() < 1e-3);
    }
}
