//! What of the pictures is on the graphics card.

use std::collections::BTreeMap;

use egui::{Context, TextureHandle, TextureId};

use super::adjustment::Adjustment;
use super::pyramid::Pyramid;
use super::tiles::TileKey;

/// Textures beyond this are given back, the longest unused first. A screen of 4k pixels needs about 100 MB.
const TEXTURE_BYTES: usize = 192 << 20;
/// Uploaded in one frame at most: four whole tiles, about 2 ms.
const UPLOAD_BYTES_PER_FRAME: usize = 4 << 20;

#[derive(Debug)]
struct Tile {
    texture: Texture,
    bytes: usize,
    last_used_frame: u64,
    /// Counts changes of the adjustment.
    generation: u64,
    /// Of the coarsest level: never given back.
    stays: bool,
}

/// A handle that can be debugged.
struct Texture(TextureHandle);

impl std::fmt::Debug for Texture {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.0.id().fmt(f)
    }
}

/// The tiles of one plate's pictures on the graphics card. Make a new one for another plate.
///
/// Drawing uploads what is seen, four tiles a frame at most; until all are there a coarser level is shown in their place
/// and another frame is asked for.
#[derive(Debug)]
pub struct PlateTextures {
    tiles: BTreeMap<TileKey, Tile>,
    adjustment: Adjustment,
    tones: [u8; 256],
    generation: u64,
    frame: u64,
    uploaded_bytes: usize,
    pub(super) most_bytes: usize,
}

impl Default for PlateTextures {
    fn default() -> Self {
        let adjustment = Adjustment::default();
        Self {
            tiles: BTreeMap::new(),
            adjustment,
            tones: adjustment.tones(),
            generation: 0,
            frame: 0,
            uploaded_bytes: 0,
            most_bytes: TEXTURE_BYTES,
        }
    }
}

impl PlateTextures {
    /// How the tones are shown.
    pub fn adjustment(&self) -> Adjustment {
        self.adjustment
    }

    /// Shows the tones differently: tiles that are seen are replaced over the next frames.
    pub fn set_adjustment(&mut self, adjustment: Adjustment) {
        if self.adjustment != adjustment {
            (self.adjustment, self.tones) = (adjustment, adjustment.tones());
            self.generation += 1;
        }
    }

    /// Bytes of textures that are on the graphics card.
    pub fn resident_bytes(&self) -> usize {
        self.tiles.values().map(|tile| tile.bytes).sum()
    }

    /// Makes tiles of a picture resident, so far as this frame's uploads allow, and asks for another frame otherwise.
    pub(super) fn provide(&mut self, ctx: &Context, pyramid: &Pyramid, image: usize, wanted: &[TileKey]) {
        let frame = ctx.cumulative_frame_nr();
        if self.frame != frame {
            (self.frame, self.uploaded_bytes) = (frame, 0);
        }
        let coarsest = TileKey::coarsest(image, pyramid);
        if !self.tiles.contains_key(&coarsest) {
            self.upload(ctx, pyramid, coarsest);
        }
        // What is missing first, then what has been out of date for longest.
        let mut uploads: Vec<(Option<u64>, TileKey)> = Vec::new();
        for &key in std::iter::once(&coarsest).chain(wanted) {
            let tile = self.tiles.get_mut(&key);
            let generation = tile.map(|tile| {
                tile.last_used_frame = frame;
                tile.generation
            });
            if generation != Some(self.generation) {
                uploads.push((generation, key));
            }
        }
        uploads.sort_unstable();
        uploads.dedup();
        for (_, key) in uploads {
            if self.uploaded_bytes > 0 && self.uploaded_bytes + key.bytes(pyramid) > UPLOAD_BYTES_PER_FRAME {
                ctx.request_repaint();
                break;
            }
            self.upload(ctx, pyramid, key);
        }
        self.evict();
    }

    /// The tile to draw in the place of a wanted one, its texture and that texture's size.
    pub(super) fn best(
        &mut self,
        pyramid: &Pyramid,
        wanted: TileKey,
    ) -> Option<(TileKey, TextureId, [usize; 2])> {
        let mut key = wanted;
        while key.level < pyramid.levels().len() {
            if let Some(tile) = self.tiles.get_mut(&key) {
                tile.last_used_frame = self.frame;
                return Some((key, tile.texture.0.id(), tile.texture.0.size()));
            }
            key = key.substitute();
        }
        None
    }

    fn upload(&mut self, ctx: &Context, pyramid: &Pyramid, key: TileKey) {
        let Some(texels) = key.cut(pyramid, &self.tones) else { return };
        let bytes = key.bytes(pyramid);
        self.uploaded_bytes += bytes;
        let (frame, generation) = (self.frame, self.generation);
        if let Some(tile) = self.tiles.get_mut(&key) {
            tile.texture.0.set(texels, key.options());
            (tile.last_used_frame, tile.generation) = (frame, generation);
            return;
        }
        let texture = Texture(ctx.load_texture("plate tile", texels, key.options()));
        let stays = key == TileKey::coarsest(key.image, pyramid);
        self.tiles.insert(key, Tile { texture, bytes, last_used_frame: frame, generation, stays });
    }

    /// Gives back the longest unused tiles until the rest is within bounds. What this frame shows is kept.
    fn evict(&mut self) {
        let mut resident = self.resident_bytes();
        while resident > self.most_bytes {
            let unused = self.tiles.iter().filter(|(_, t)| !t.stays && t.last_used_frame < self.frame);
            let Some(key) = unused.min_by_key(|(_, tile)| tile.last_used_frame).map(|(key, _)| *key) else {
                return;
            };
            resident -= self.tiles.remove(&key).map_or(0, |tile| tile.bytes);
        }
    }
}
