//! A picture put together from tiles, each kept in a file until all are there.

use std::path::PathBuf;

use image::DynamicImage;
use image::imageops::replace;
use muybridge_capture::{to_stable_json, write_atomically};
use serde::{Deserialize, Serialize};

use super::client::Client;
use super::jpeg;
use super::place::{Place, write_error};
use super::{FetchError, Job, Progress};

/// Most tiles of a picture: 200 megapixels in tiles of 128 px are 12 000. More would be a burden to any server.
const MOST_TILES: u64 = 20_000;
/// Name of the file that says what the tiles are tiles of.
const ORIGIN: &str = "service.json";

/// What tiles are tiles of: a service and its whole description, so that those of a changed picture are not mixed.
#[derive(PartialEq, Serialize, Deserialize)]
pub(super) struct Origin {
    pub(super) service: String,
    pub(super) description: String,
}

impl Origin {
    /// Whether tiles of the same picture are there.
    pub(super) fn is_at(&self, place: &Place) -> bool {
        let there = std::fs::read(place.tiles().join(ORIGIN)).ok();
        there.is_some_and(|text| serde_json::from_slice(&text).is_ok_and(|origin: Self| origin == *self))
    }

    /// Makes the folder of tiles, empty unless it holds tiles of the same picture.
    fn prepare(&self, place: &Place) -> Result<(), FetchError> {
        if self.is_at(place) {
            return Ok(());
        }
        place.remove_tiles()?;
        let folder = place.tiles();
        std::fs::create_dir_all(&folder).map_err(|error| write_error(&folder, error))?;
        Ok(write_atomically(&folder.join(ORIGIN), to_stable_json(self).as_bytes())?)
    }
}

/// One tile.
struct Tile {
    at_px: [u32; 2],
    size_px: [u32; 2],
    url: String,
    path: PathBuf,
}

impl Tile {
    /// The tile that an earlier run has kept, with its bytes.
    fn kept(&self, most_pixels: u64) -> Option<(DynamicImage, u64)> {
        let bytes = std::fs::read(&self.path).ok()?;
        Some((self.decode(&bytes, most_pixels).ok()?, bytes.len() as u64))
    }

    /// Fetches the tile and keeps it; `already` bytes came before it.
    fn fetch(&self, client: &mut Client, already: u64) -> Result<(DynamicImage, u64), FetchError> {
        let limits = client.limits;
        let (picture, bytes) = client.persist(|client| {
            let bytes = client.get_bytes(&self.url, [already, limits.bytes])?;
            Ok((self.decode(&bytes, limits.pixels)?, bytes))
        })?;
        write_atomically(&self.path, &bytes)?;
        Ok((picture, bytes.len() as u64))
    }

    fn decode(&self, bytes: &[u8], most_pixels: u64) -> Result<DynamicImage, FetchError> {
        let picture = jpeg::decode(&self.url, bytes, most_pixels)?;
        let ([width, height], [w, h]) = (self.size_px, [picture.width(), picture.height()]);
        if [w, h] == [width, height] {
            return Ok(picture);
        }
        let found = format!("a tile of {w} x {h} px, not {width} x {height} px,");
        Err(FetchError::WrongContent { url: self.url.clone(), found })
    }
}

/// Fetches a picture in tiles of `tile_px`, those at the right and lower border being smaller, and puts it together.
/// Returns it with the number of tiles.
///
/// # Errors
/// When a tile cannot be had within the limits, or is not what was asked for.
pub(super) fn fetch_tiles(
    client: &mut Client,
    job: &Job,
    tile_px: [u32; 2],
) -> Result<(DynamicImage, u32), FetchError> {
    let [width, height] = job.description.full_px;
    let total = u64::from(width.div_ceil(tile_px[0])) * u64::from(height.div_ceil(tile_px[1]));
    if total > MOST_TILES {
        let fault = format!("{total} tiles, more than {MOST_TILES}");
        return Err(FetchError::NotIiif { url: job.address.info(), fault });
    }
    job.origin.prepare(job.place)?;
    let total = total as u32;
    let mut canvas = DynamicImage::new_luma8(width, height);
    let mut bytes = 0;
    (client.progress)(Progress::Tiles { done: 0, total, bytes });
    for (tile, done) in tiles(job, tile_px).zip(1..) {
        let (picture, its_bytes) = match tile.kept(client.limits.pixels) {
            Some(kept) => kept,
            None => tile.fetch(client, bytes)?,
        };
        bytes += its_bytes;
        canvas = paste(canvas, picture, tile.at_px);
        (client.progress)(Progress::Tiles { done, total, bytes });
    }
    Ok((canvas, total))
}

/// The tiles row by row.
fn tiles<'a>(job: &'a Job, [tile_width, tile_height]: [u32; 2]) -> impl Iterator<Item = Tile> + 'a {
    let [width, height] = job.description.full_px;
    let starts = move |length: u32, step: u32| (0..length.div_ceil(step)).map(move |i| i * step);
    starts(height, tile_height).flat_map(move |y| {
        starts(width, tile_width).map(move |x| {
            let at_px = [x, y];
            let size_px = [tile_width.min(width - x), tile_height.min(height - y)];
            let (region, size) = job.description.region(at_px, size_px);
            let url = job.address.picture(&region, &size);
            // The size is part of the name, so that tiles of another grid are not taken for these.
            let name = format!("{x}-{y}-{}-{}.jpg", size_px[0], size_px[1]);
            Tile { at_px, size_px, url, path: job.place.tiles().join(name) }
        })
    })
}

/// Puts a tile where it belongs; one that has colour makes the whole picture a picture in colour.
fn paste(canvas: DynamicImage, tile: DynamicImage, [x, y]: [u32; 2]) -> DynamicImage {
    let (x, y) = (i64::from(x), i64::from(y));
    match canvas {
        DynamicImage::ImageLuma8(mut grey) if !tile.color().has_color() => {
            replace(&mut grey, &tile.into_luma8(), x, y);
            grey.into()
        }
        canvas => {
            let mut coloured = canvas.into_rgb8();
            replace(&mut coloured, &tile.into_rgb8(), x, y);
            coloured.into()
        }
    }
}

#[cfg(test)]
mod tests {
    use image::{GrayImage, Luma, Rgb, RgbImage};

    use super::*;

    #[test]
    fn one_coloured_tile_makes_a_coloured_picture() {
        let grey = |value| DynamicImage::from(GrayImage::from_pixel(2, 2, Luma([value])));
        let canvas = paste(DynamicImage::new_luma8(6, 2), grey(10), [0, 0]);
        assert!(matches!(canvas, DynamicImage::ImageLuma8(_)));
        let canvas = paste(canvas, RgbImage::from_pixel(2, 2, Rgb([1, 2, 3])).into(), [2, 0]);
        let picture = paste(canvas, grey(30), [4, 0]).into_rgb8();
        assert_eq!([0, 2, 5].map(|x| picture.get_pixel(x, 1).0), [[10, 10, 10], [1, 2, 3], [30, 30, 30]]);
    }
}
